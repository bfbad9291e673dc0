"""Cards of results, scenes, studies and designs in notebooks: tables of reports and summaries, one small picture.

A card is HTML that needs neither scripts nor files. Its colours are those of the page around it, dark or light.
"""

from __future__ import annotations

import base64
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial, singledispatch
from html import escape
from typing import TYPE_CHECKING, Any

from loaded_tca.contact import ContactSolution
from loaded_tca.double_helical import DoubleHelicalRating, DoubleHelicalResult
from loaded_tca.double_helical.sensitivities import DoubleHelicalSensitivities
from loaded_tca.errors import InputError, LoadedTCAError, noted_accuracy_warnings
from loaded_tca.flank_maps.ease_off_map import ease_off_map
from loaded_tca.output.double_helical_overview import geometry_of_halves, pair_rows
from loaded_tca.output.double_helical_sensitivities import HEADS, figure_slopes
from loaded_tca.output.overview import scene_sections
from loaded_tca.output.stage_overview import geometry_of_meshes, stage_sections
from loaded_tca.plain import plain
from loaded_tca.plots import (
    COMPARISON_PICTURES,
    TRIBOLOGY_PICTURES,
    plot_before_and_after,
    plot_ease_off,
    plot_halves_shares,
    plot_pressure_envelope,
    plot_pressure_map,
    plot_revolution_error,
    plot_safeties,
    plot_solution,
    plot_stage_shares,
    plot_study,
    plot_teeth_in_mesh,
    plot_tornado,
    png_of,
)
from loaded_tca.plots.style import TITLE, label_of, note_of
from loaded_tca.rating import Rating, SpectrumRating
from loaded_tca.reports.comparison_page import differing_table, key_figure_tables
from loaded_tca.reports.page import Table, tables_of
from loaded_tca.reports.rating_page import safeties_table
from loaded_tca.reports.report import objectives_table, scatter_tables, values_table
from loaded_tca.reports.result_page import key_figures_table
from loaded_tca.results.comparison import Comparison
from loaded_tca.results.figure import in_percent
from loaded_tca.results.figures import FIGURES, key_figures
from loaded_tca.results.files import STUDY
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.result import Result
from loaded_tca.results.revolution import Revolution
from loaded_tca.results.sensitivities import Sensitivities
from loaded_tca.results.summary import shown
from loaded_tca.results.tolerances import key_figure_slopes
from loaded_tca.scene import Scene, parse_scene
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from loaded_tca.stages import Stage, StageResult
from loaded_tca.stages.rating import StageRating
from loaded_tca.studies import DesignResult, Study, study_summary
from loaded_tca.studies.stage import subject_of
from loaded_tca.studies.study import told_distribution
from loaded_tca.tribology import Tribology
from loaded_tca.units import unit_of

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from loaded_tca.arrays import Array

MOST_TORQUES = 4
"""With a column each; of more, the largest alone is shown."""
WIDTH = 680
"""Pixels of a picture."""
STYLE = (
    ".ltca{font:13px/1.4 sans-serif;color:inherit;max-width:900px}"
    ".ltca table{border-collapse:collapse;margin:6px 0;font-size:12px}"
    ".ltca caption{text-align:left;font-weight:bold}"
    ".ltca th,.ltca td{padding:1px 8px;border:0;border-bottom:1px solid rgba(128,128,128,.4);text-align:right;"
    "color:inherit;background:transparent;vertical-align:top}"
    ".ltca tbody th{white-space:nowrap}"
    ".ltca tbody th,.ltca .text,.ltca th:first-child{font-weight:normal;text-align:left}"
    ".ltca p{margin:2px 0}"
    ".ltca .ltca-warning{border-left:4px solid #d55e00;padding-left:6px}"
    ".ltca img{max-width:100%;height:auto;background:#fff;margin:6px 0}"
)
"""Of cards alone: colours but that of warnings are those around them."""
UNIT = re.compile(r"\[[^\]]*\]")


@dataclass(frozen=True)
class Card:
    """What a notebook shows of a result, scene, study or design.

    Attributes
    ----------
    title, about : str
        First lines: its title, and what it is.
    tables : tuple of Table
    folded : tuple of Table
        Behind a line that opens them.
    sentences : mapping of str to sequence of str
        Word that some sentences begin with -> the sentences; those of ``warning`` are marked.
    draw : callable, optional
        Makes the figure of its picture, or None.
    """

    title: str
    about: str
    tables: tuple[Table, ...] = ()
    folded: tuple[Table, ...] = ()
    sentences: Mapping[str, Sequence[str]] = field(default_factory=dict)
    draw: Callable[[], Figure | None] | None = None

    @property
    def html(self) -> str:
        """The card as HTML, below 60 kB but for long tables; all text in it is escaped."""
        return f'<div class="ltca"><style>{STYLE}</style>{"".join(self._parts())}</div>'

    def _repr_html_(self) -> str:
        return self.html

    def _parts(self) -> Iterator[str]:
        yield f"<p><b>{escape(self.title)}</b></p><p>{escape(self.about)}</p>"
        yield from map(_table, self.tables)
        for word, some in self.sentences.items():
            kind = "ltca-warning" if word == "warning" else "ltca-note"
            yield from (f'<p class="{kind}">{escape(f"{word}: {sentence}")}</p>' for sentence in some)
        yield self._picture()
        if self.folded:
            yield f"<details><summary>more</summary>{''.join(map(_table, self.folded))}</details>"

    def _picture(self) -> str:
        """The picture within the page, with its title and what stands below it as text; why there is none."""
        try:
            figure = None if self.draw is None else self.draw()
        except LoadedTCAError as error:
            return f'<p class="ltca-note">{escape(f"no picture: {error}")}</p>'
        if figure is None:
            return ""
        title = next((text.get_text() for text in figure.texts if text.get_gid() == TITLE), "")
        words = "; ".join(filter(None, (title, note_of(figure))))
        content = base64.b64encode(png_of(figure, WIDTH / figure.get_figwidth(), 0)).decode()
        return f'<img alt="{escape(words)}" src="data:image/png;base64,{content}">'


def _table(table: Table) -> str:
    """A table as HTML; what is to be known of a number, in a last column, is left-aligned."""
    last = table.columns - 1 if table.head and table.head[-1] == "accuracy" else -1

    def cells(row: Sequence[str], kind: str) -> str:
        filled = [*row, *[""] * (table.columns - len(row))]
        kinds = ["th", *[kind] * (len(filled) - 1)]
        marks = [' class="text"' if table.of_words or n == last else "" for n in range(len(filled))]
        parts = zip(kinds, marks, map(_cell, filled), strict=True)
        return "<tr>" + "".join(f"<{tag}{mark}>{text}</{tag}>" for tag, mark, text in parts) + "</tr>"

    caption = f"<caption>{escape(table.caption)}</caption>" if table.caption else ""
    head = f"<thead>{cells(table.head, 'th')}</thead>" if table.head else ""
    return f"<table>{caption}{head}<tbody>{''.join(cells(row, 'td') for row in table.rows)}</tbody></table>"


def _cell(text: str) -> str:
    """A cell whose unit in brackets stays in one line; a label that is set back keeps that."""
    indent = "&emsp;" if text.startswith(" ") else ""
    return indent + escape(UNIT.sub(lambda unit: unit[0].replace(" ", "\N{NO-BREAK SPACE}"), text.strip()))


def card_of(subject: Any) -> Card:
    """Return what a notebook shows of a subject; notebooks call it by themselves, except for the dataset of a study.

    Parameters
    ----------
    subject : result, rating, Scene, Stage, Study, Comparison, DesignResult, sensitivities, ContactSolution or dataset
        An ``xarray.Dataset`` is that of a study, as :func:`loaded_tca.studies.run_study` returns it.

    Returns
    -------
    Card
        Its picture is drawn when it is shown.

    Raises
    ------
    InputError
        If the subject is none of these.
    """
    if getattr(subject, "attrs", {}).get("kind") == STUDY:
        return _of_rows(subject)
    try:
        return _card(subject)
    except InputError:
        raise
    except LoadedTCAError as error:  # gears that cannot be
        return Card(getattr(subject, "title", "") or type(subject).__name__, str(error))


@singledispatch
def _card(subject: Any) -> Card:
    raise InputError(
        f"card: found a {type(subject).__name__}; allowed a result, a rating, a scene, a stage, a study, a comparison, "
        "a design, sensitivities or the solution of a contact"
    )


def _pattern(result: MeshCycle) -> Figure | None:
    """The contact pattern; of one tooth pair that carries all the pressure map of its peak, if there is any."""
    if result.scene.analysis.load_sharing:
        return plot_pressure_envelope(result)
    return plot_pressure_map(result) if result.peak_contact(index_or_largest(result.torque)) else None


PICTURES: dict[type[Result], Callable[[Any], Figure | None]] = {
    MeshCycle: _pattern,
    Revolution: plot_revolution_error,
    StageResult: plot_stage_shares,
    DoubleHelicalResult: plot_halves_shares,
    Rating: plot_safeties,
    StageRating: plot_safeties,
    DoubleHelicalRating: plot_safeties,
    Tribology: lambda tribology: next(
        (draw(tribology) for draw in TRIBOLOGY_PICTURES.values() if draw.has(tribology)), None
    ),
}
"""Kind of result -> its picture."""


@_card.register
def _of_result(result: Result) -> Card:
    """Key figures with their accuracy, notes and warnings; of ratings what decides."""
    figures, count = result.key_figures(), int(result.dataset.sizes.get("torque", result.dataset.sizes.get("case", 1)))
    largest = int(index_or_largest(result.values("torque")))
    part = slice(0, count) if count <= MOST_TORQUES else slice(largest, largest + 1)
    about = f"{result.WHAT}; {result.scope}"
    if isinstance(result, Rating):
        tables = (safeties_table(result),)
    elif isinstance(result, MeshCycle):
        tables = (key_figures_table(result, part, figures[part], main=True),)
    else:
        tables = (Table(tuple(result.rows(figures[part]))),)
    if count > MOST_TORQUES and not isinstance(result, SpectrumRating):
        about += f"; largest of {count} torques, key_figures() has all"
    draw = next((draw for kind, draw in PICTURES.items() if isinstance(result, kind)), None)
    picture = None if draw is None else partial(draw, result)
    return Card(result.title or result.TITLE, about, tables, sentences=result.sentences(), draw=picture)


@_card.register
def _of_scene(scene: Scene) -> Card:
    """What a scene asks for, and its geometry; warnings that concern whole gears."""
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_gears(scene, scene.pair())
        sections = scene_sections(scene)
    asked = [*sections["load and analysis"], *sections["mounting errors, edges and modifications"]]
    folded = [
        *tables_of(sections["geometry"], f"Geometry ({scene.geometry_standard})"),
        *tables_of(sections["ISO 6336"], "ISO 6336"),
        *tables_of(sections["flanks described by points"], "Flanks described by points"),
    ]
    warned = {"warning": [*dict.fromkeys(sentences)]}
    about = f"a scene of type {scene.geometry.type}"
    return Card(scene.title or "Scene", about, tables_of(asked), tuple(folded), warned, partial(_drawn, scene))


def _drawn(scene: Scene) -> Figure:
    """Teeth in mesh of cylindrical gears, of others the ease-off."""
    if isinstance(scene, CylindricalScene):
        return plot_teeth_in_mesh(scene)
    return plot_ease_off(ease_off_map(scene.pair()), scene.title)


@_card.register
def _of_double_helical(scene: DoubleHelicalScene) -> Card:
    geometry = geometry_of_halves(scene)
    folded = [table for name, rows, _ in geometry for table in tables_of(rows, f"{name}, z from the groove outwards")]
    warned = {"warning": [f"{name}: {sentence}" for name, _, some in geometry for sentence in some]}
    title, draw = scene.title or "Double helical pair", partial(_drawn, scene)
    return Card(title, "a scene of a double helical pair", tables_of(pair_rows(scene)), tuple(folded), warned, draw)


@_card.register
def _of_stage(stage: Stage) -> Card:
    stage.require_assembly()
    sections, geometry = stage_sections(stage), geometry_of_meshes(stage)
    asked = [*tables_of(sections["stage"]), *tables_of(sections["torques"])]
    folded = [table for name, rows, _ in geometry for table in tables_of(rows, f"Mesh of {name} (ISO 21771)")]
    warned = {"warning": [f"{name}: {sentence}" for name, _, some in geometry for sentence in some]}
    title, draw = stage.title or "Planetary stage", partial(_drawn, stage.sun_scene)
    return Card(title, "a planetary stage", tuple(asked), tuple(folded), warned, draw)


@_card.register
def _of_study(study: Study) -> Card:
    """What a study varies, before it is run."""
    given = [("table", study.table), ("factor", study.factors)]
    rows = [
        (key, way, f"{len(values)}", f"{values[0]} ... {values[-1]}" if len(values) > 1 else f"{values[0]}")
        for way, keys in given
        for key, values in keys.items()
    ]
    samples = f"{study.samples}"
    rows += [(key, "distribution", samples, told_distribution(one)) for key, one in study.distributions.items()]
    table = Table(tuple(rows), ("what varies", "how", "values", "first, last"), of_words=True)
    scene = study.scene.sun_scene if isinstance(study.scene, Stage) else study.scene
    draw = partial(_drawn, scene)
    return Card(study.scene.title or "Study", f"a study of {len(study)} variants", (table,), draw=draw)


def _of_rows(study: xarray.Dataset) -> Card:
    """Scatter of the main figures over the variants that were analysed, and what went wrong."""
    head, *lines = study_summary(study).splitlines()
    warned = [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")]
    failed = [line.partition(": ")[::2] for line in lines if line.startswith(("refused: ", "failed: "))]
    sentences = {"warning": warned, **{word: [one for kind, one in failed if kind == word] for word, _ in failed}}
    title = subject_of(study).title or "Study"
    draw = partial(_first_of_study, study)
    return Card(title, f"a study: {head}", tuple(scatter_tables(study, None)), sentences=sentences, draw=draw)


def _first_of_study(study: xarray.Dataset) -> Figure | None:
    """The first picture that is no table."""
    figures = plot_study(study)
    return next((figure for name, figure in figures.items() if name != "study_ranking"), None)


@_card.register
def _of_design(design: DesignResult) -> Card:
    """Objectives and values of start and optimum; what the analysis does not confirm."""
    scene = parse_scene(design.dataset.attrs["scene_toml"], source="scene_toml", folder=None)
    tables = objectives_table(design), values_table(design)
    sentences = {"not confirmed": design.unconfirmed, "warning": design.dataset.attrs["warnings"].splitlines()}
    about = f"a design: {design.dataset.attrs['objective']} of {design.dataset.attrs['figure']}"
    draw = partial(plot_before_and_after, design)
    return Card(scene.title or "Design", about, tables, sentences=sentences, draw=draw)


@_card.register
def _of_comparison(comparison: Comparison) -> Card:
    """What differs in the scenes, key figures side by side under the largest torque, warnings of each result."""
    differing = differing_table(comparison)
    tables = [*([differing] if differing else []), *key_figure_tables(comparison, comparison.index_of())]
    warned = [f"{name}: {one}" for name, result in comparison.results.items() for one in result.warnings or ()]
    draw = partial(COMPARISON_PICTURES["comparison"].draw, comparison, None)
    title, about = " | ".join(comparison.results), f"a comparison with {next(iter(comparison.results))}"
    return Card(title, about, tuple(tables), sentences={"warning": warned}, draw=draw)


@_card.register
def _of_sensitivities(sensitivities: Sensitivities) -> Card:
    """Changes of the key figures per unit of each key, under the largest torque."""
    result = sensitivities.result
    torque = int(index_or_largest(result.torque))
    with noted_accuracy_warnings() as warned:
        slopes = {name: values[torque] for name, values in key_figure_slopes(sensitivities).items()}
    heads = [slope.head for name in slopes if (slope := FIGURES[name].slope)]
    table = _slopes_table(sensitivities.keys, key_figures(result, torque), heads, slopes)
    return _of_slopes(result.scene.title, len(result.torque), table, warned, partial(plot_tornado, sensitivities))


@_card.register
def _of_sensitivities_of_halves(sensitivities: DoubleHelicalSensitivities) -> Card:
    result = sensitivities.result
    torque = int(index_or_largest(result.torque))
    with noted_accuracy_warnings() as warned:
        slopes = {name: values[torque] for name, values in figure_slopes(sensitivities).items()}
    table = _slopes_table(sensitivities.keys, result.key_figures()[torque], [*HEADS.values()], slopes)
    return _of_slopes(result.scene.title, len(result.torque), table, warned)


def _of_slopes(
    title: str, torques: int, table: Table, warned: Sequence[str], draw: Callable[[], Figure] | None = None
) -> Card:
    largest = f", largest of {torques} torques" if torques > 1 else ""
    sentences = {"warning": [*dict.fromkeys(warned)]}
    return Card(
        title or "Sensitivities", f"derivatives of key figures{largest}", (table,), sentences=sentences, draw=draw
    )


def _slopes_table(
    keys: Sequence[str], figures: Mapping[str, float], heads: Sequence[str], slopes: Mapping[str, Array]
) -> Table:
    """Figures under a torque, and by how much a unit of each key changes them."""
    units = (unit_of(name) for name in slopes)
    head = (f"under {plain(figures['pinion_torque_Nm'], 6)} N m", *map(_with_unit, heads, units))
    rows = [("this result", *(shown(figures[name], name) for name in slopes))]
    rows += [
        (f"per unit of {label_of(key)}", *(_slope(values[k]) for values in slopes.values()))
        for k, key in enumerate(keys)
    ]
    return Table(tuple(rows), head)


def _slope(value: float) -> str:
    return plain(value, 3, "+") if math.isfinite(value) else "-"


def _with_unit(label: str, unit: str) -> str:
    return f"{label} [{unit}]" if unit else label


@_card.register
def _of_contact(solution: ContactSolution) -> Card:
    """What a contact carries, how large it is, and how far off."""
    error, cells = solution.error_estimate, "x".join(map(str, solution.pressure.shape))
    rows = (
        ("load [N]", plain(solution.load)),
        ("approach from first contact [mm]", plain(solution.approach_under_load)),
        ("peak pressure [MPa]", plain(solution.peak_pressure)),
        ("contact area [mm^2]", plain(solution.contact_area)),
        ("semi-minor and semi-major axis [mm]", ", ".join(map(plain, solution.semi_axes))),
        ("cells under pressure along the two axes", ", ".join(map(str, solution.cells_across))),
        ("estimated error of the peak pressure", in_percent(error.peak_pressure)),
        ("estimated error of the approach", in_percent(error.approach)),
    )
    about = f"a contact of two half-spaces on {cells} cells"
    warned = {"note": (solution.status.value,), "warning": solution.accuracy_warnings}
    return Card("Contact", about, (Table(rows),), sentences=warned, draw=partial(plot_solution, solution))
