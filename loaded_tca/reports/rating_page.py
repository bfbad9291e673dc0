"""What the report of a result tells of its rating: tables as rating programs print them, what decides, pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, Any

from loaded_tca.arrays import GEARS
from loaded_tca.double_helical.rating import double_helical_rating_of
from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.plots import HALVES_RATING_PICTURES, RATING_PICTURES, rating_figures
from loaded_tca.plots.picture import captions_of
from loaded_tca.rating import rating_of
from loaded_tca.rating.findings import ALL_FAILURES, findings, of_all_bins
from loaded_tca.rating.quantities import OF_GEARS, OF_MODES, OF_SPECTRUM
from loaded_tca.rating.rating import WORDS, OfCases, rows_of
from loaded_tca.rating.spectrum import OfSpectrum
from loaded_tca.reports.page import Picture, Table, parts_of, pictures_of
from loaded_tca.results.figure import labelled
from loaded_tca.results.summary import shown
from loaded_tca.scene.rating import is_rated
from loaded_tca.stages.rating import MESHES, StageRating, stage_rating_of
from loaded_tca.stages.sections import MEMBERS, words_of

if TYPE_CHECKING:
    from loaded_tca.double_helical import DoubleHelicalRating, DoubleHelicalResult
    from loaded_tca.rating import Rating
    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.stages import StageResult

MOST_CASES = 2
"""With a column for each gear in one table of a page."""
BLOCKS = {
    "torque": "Loads and load factors",
    "Z_H": "Flanks, {}-2; at limited life sigma_HG lies between static and reference strength",
    "Y_F": "Roots, {}-3; at limited life sigma_FG lies between static and reference strength",
    "local_flank_stress": "Local",
    "damage": "Damage and lives",
}
STAGE_BLOCKS = {
    "torque": "Loads of sun, planets and ring",
    "flank_safety": "Safeties; of planets the smaller one of both meshes",
    "damage": "Damage and lives",
}
"""First number of each table, of pairs and of stages, and its caption with the standard."""


def rating_content(result: MeshCycle, coast: MeshCycle | None = None) -> dict[str, Any] | None:
    """Return what the template takes of the rating of a result; None if its scene has no strengths or no [rating].

    Parameters
    ----------
    result : MeshCycle
    coast : MeshCycle, optional
        Result of its coast side; both sides are then rated together.

    Raises
    ------
    InputError
        If both sides cannot be rated together.
    """
    if coast is not None:
        return _of_pair(rating_of(result, coast=coast, warn=False))
    return _rated(is_rated(result.scene), lambda: _of_pair(rating_of(result, warn=False)))


def halves_rating_content(result: DoubleHelicalResult) -> dict[str, Any] | None:
    """Return the same of a double helical pair: the safeties of both halves, then all of each half.

    Parameters
    ----------
    result : DoubleHelicalResult
    """
    return _rated(is_rated(result.scene), lambda: _of_halves(double_helical_rating_of(result, warn=False)))


def stage_rating_content(result: StageResult) -> dict[str, Any] | None:
    """Return the same of a planetary stage: its gears, then both meshes, under a spectrum in the worst bins.

    Parameters
    ----------
    result : StageResult
    """
    stage = result.stage
    asked = stage.rating is not None and all(getattr(stage, gear).strength is not None for gear in MEMBERS)
    return _rated(asked, lambda: _of_stage(stage_rating_of(result, warn=False)))


def _rated(asked: bool, content: Callable[[], dict[str, Any]]) -> dict[str, Any] | None:
    """The content of a rating, why there is none, or None where strengths or [rating] are not given."""
    if not asked:
        return None
    try:
        return content()
    except InputError as error:  # the report has what there is
        return {"refused": error.problems, "pictures": ()}


def _of_pair(rating: Rating) -> dict[str, Any]:
    return _told(rating, findings(rating), _all_tables(rating, _shown_cases(rating)))


def _of_stage(rating: StageRating) -> dict[str, Any]:
    of_spectrum, cases = isinstance(rating, OfSpectrum), _shown_cases(rating)
    worst = rating.most_damaging(MOST_CASES) if isinstance(rating, OfSpectrum) else cases
    tables = [*_all_tables(rating, cases), *_of_meshes(rating, worst)]
    return _told(rating, tuple(of_all_bins(rating)) if of_spectrum else (), tables)


def _told(rating: OfCases, decisive: tuple[str, ...], tables: Sequence[Table]) -> dict[str, Any]:
    """What templates take of a rating, with sentences on what decides."""
    return {
        "refused": (),
        "about": rating.scope.rpartition("; ")[0],
        "safeties": safeties_table(rating),
        "findings": decisive,
        "tables": tables,
        "notes": [note for note in rating.notes() if note not in decisive],
        "warnings": rating.warnings or (),
        "pictures": pictures_of(rating_figures(rating), captions_of(RATING_PICTURES), rating.title),
    }


def _of_halves(rating: DoubleHelicalRating) -> dict[str, Any]:
    cases = _shown_cases(rating)
    figures = [rating.key_figures()[case] for case in cases]
    torques = [f"{plain(1e-3 * float(rating.torque[case]))} N m" for case in cases]
    rows = rows_of(rating, GEARS, rating.modes, figures)[1:]
    tables = []
    for name, half in rating.of_halves.items():
        of_half = [replace(safeties_table(half), caption="safeties and lives"), *_all_tables(half, cases)]
        tables += [replace(table, caption=f"Half {name}: {table.caption}") for table in of_half]
    return {
        "refused": (),
        "about": rating.scope.removesuffix("; pinion | wheel"),
        "safeties": Table(tuple(rows), ("pinion | wheel", *torques), "Both halves together"),
        "findings": (),
        "tables": tables,
        "notes": rating.notes(),
        "warnings": rating.warnings or (),
        "pictures": (*_pictures_of_halves(rating),),
    }


def _pictures_of_halves(rating: DoubleHelicalRating) -> Iterator[Picture]:
    """Pictures of the pair and of both halves, each without the title of its own scene."""
    captions, figures = captions_of(HALVES_RATING_PICTURES), rating_figures(rating)
    titles = {"safeties": rating.title} | {f"half_{name}_": half.title for name, half in rating.of_halves.items()}
    for start, title in titles.items():
        own = {file: figure for file, figure in figures.items() if file.startswith(start)}
        yield from pictures_of(own, captions, title)


def _all_tables(rating: OfCases, cases: Sequence[int]) -> list[Table]:
    """Tables of all parts of a rating, with so many cases beside each other as have room."""
    return [*chain.from_iterable(_tables(rating, cases[part]) for part in parts_of(cases, MOST_CASES))]


def _of_meshes(rating: StageRating, cases: Sequence[int]) -> Iterator[Table]:
    """Tables of both meshes of a stage in its words."""
    for mesh, gears in MESHES.items():
        for table in _all_tables(getattr(rating, mesh), cases):
            caption = f"{gears['pinion'].capitalize()} and {gears['wheel']}: {table.caption}"
            head = tuple(words_of(gears, cell) for cell in table.head)
            rows = tuple((words_of(gears, label), *cells) for label, *cells in table.rows)
            yield replace(table, rows=rows, head=head, caption=caption)


def safeties_table(rating: OfCases) -> Table:
    """The least safeties of all cases of all gears beside those required, and the shortest lives."""
    rows = []
    safeties, lives = (values.min(axis=0) for values in rating.safeties_and_lives())
    for n, mode in enumerate(rating.modes):
        kind = mode.removeprefix("local_")
        words = ALL_FAILURES[kind] if kind == mode else f"{ALL_FAILURES[kind]}, local"
        cells = (
            shown(float(values[gear, n]), "") for gear in range(len(rating.MEMBERS)) for values in (safeties, lives)
        )
        rows.append((words, plain(rating.required.required_safety(mode)), *cells))
    heads = (f"{gear}, {what}" for gear in rating.MEMBERS for what in ("safety", "life [h]"))
    together = "all bins together" if isinstance(rating, OfSpectrum) else "least of all cases"
    return Table(tuple(rows), (together, "required", *heads))


def _shown_cases(rating: OfCases) -> list[int]:
    """Cases whose factors stand in tables: all torques, of a load spectrum the bins of the largest damage."""
    return rating.most_damaging() if isinstance(rating, OfSpectrum) else [*range(len(rating.torque))]


def _tables(rating: OfCases, cases: Sequence[int]) -> Iterator[Table]:
    """Factors of all gears in some cases, a table for each part of the rating."""
    figures = rating.key_figures()
    bins = [f"bin {case + 1}, " if isinstance(rating, OfSpectrum) else "" for case in cases]
    torques = [plain(1e-3 * float(rating.torque[case])) for case in cases]
    heads = [
        f"{each}{torque} N m, {gear}" for each, torque in zip(bins, torques, strict=True) for gear in rating.MEMBERS
    ]
    blocks = STAGE_BLOCKS if isinstance(rating, StageRating) else BLOCKS
    caption, rows = "", list[tuple[str, ...]]()
    for name, number in rating.NUMBERS.items():
        if name in blocks:
            if rows:
                yield Table(tuple(rows), ("", *heads), caption)
            caption, rows = blocks[name].format(rating.standard), []
        if not rating.has(name) or name == "torque" or number.dims == OF_SPECTRUM:
            continue
        head = number.head(name)
        for label, names in _lines(rating, name, head):
            cells = (shown(figures[case][one], one) if one else "" for case in cases for one in names)
            rows.append((labelled(names[0], label).replace("[um]", "[µm]"), *cells))
    yield Table(tuple(rows), ("", *heads), caption)


def _lines(rating: OfCases, name: str, head: str) -> Iterator[tuple[str, list[str]]]:
    """Label and figures of all gears of the lines that a number has in a table."""
    number = rating.NUMBERS[name]
    if number.dims == OF_MODES:
        for mode in rating.modes:
            yield f"{WORDS[mode]}: {number.text}", [f"{gear}_{mode}_{head}" for gear in rating.MEMBERS]
    elif number.dims == OF_GEARS:
        yield number.label or number.text, [f"{gear}_{head}" for gear in rating.MEMBERS]
    else:
        yield number.label or number.text, [head, *[""] * (len(rating.MEMBERS) - 1)]
