"""What the reports of a result and of a planetary stage tell."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from loaded_tca.output.overview import scene_sections
from loaded_tca.output.stage_overview import HELD, geometry_of_meshes, stage_sections
from loaded_tca.plain import plain
from loaded_tca.plots import (
    CAPTIONS,
    STAGE_CAPTIONS,
    TRIBOLOGY_PICTURES,
    result_figures,
    stage_figures,
    tribology_figures,
)
from loaded_tca.plots.picture import captions_of
from loaded_tca.plots.style import label_of
from loaded_tca.reports.page import Table, parts_of, pictures_of, tables_of
from loaded_tca.reports.rating_page import rating_content, stage_rating_content
from loaded_tca.results.figure import NO_ESTIMATE, Figures, in_percent, labelled
from loaded_tca.results.figures import FIGURES, declared
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.summary import known_rows, shown
from loaded_tca.scene import Scene
from loaded_tca.stages import Stage, StageResult
from loaded_tca.tribology import tribology_of
from loaded_tca.tribology.summary import unknown_in_words
from loaded_tca.warning_kinds import Kind, kind_of

MOST_TORQUES = 5
"""Torques with a column each in one table of a page."""
TORQUE = "pinion_torque_Nm"


def result_content(result: MeshCycle, coast: MeshCycle | None = None) -> dict[str, Any]:
    """Return what the template of a result takes.

    Parameters
    ----------
    result : MeshCycle
    coast : MeshCycle, optional
        Result of its coast side, for the rating.
    """
    pictures = result_figures(result, more=True)
    glance = {name: pictures.pop(name) for name in ("at_a_glance",) if name in pictures}
    return {
        **result_tables(result),
        "glance": pictures_of(glance, CAPTIONS, result.scene.title),
        "pictures": pictures_of(pictures, CAPTIONS, result.scene.title),
        "lubrication": _lubrication(result),
        "rating": rating_content(result, coast),
    }


def result_tables(result: MeshCycle) -> dict[str, Any]:
    """Return what a page says of a result in words and tables.

    Parameters
    ----------
    result : MeshCycle
    """
    figures = result.key_figures()
    return {
        "title": result.scene.title or "Loaded tooth contact",
        "analysed_by": result.version,
        "scope": result.scope,
        **scene_content(result.scene),
        "load_cases": _load_cases(result, figures),
        "key_figures": [key_figures_table(result, part, figures[part]) for part in parts_of(figures, MOST_TORQUES)],
        "limits": [*result.notes(), *result.findings()],
        "accuracy": [_accuracy(result, part, figures) for part in parts_of(figures, MOST_TORQUES)],
        "warnings": None if result.warnings is None else explained(result.warnings),
    }


def _lubrication(result: MeshCycle) -> dict[str, Any] | None:
    """What the oil sees, of scenes that say how the pair runs: a line for each number, notes, pictures."""
    if result.scene.operation is None and result.scene.lubricant is None:
        return None
    tribology = tribology_of(result, warn=False)
    rows = tribology.rows(tribology.key_figures())
    lacking = (f"not known: {sentence}" for sentence in unknown_in_words(tribology))
    return {
        "about": tribology.scope,
        "table": Table(tuple(rows[1:]), rows[0]),
        "notes": [*lacking, *tribology.warnings],
        "pictures": pictures_of(tribology_figures(tribology), captions_of(TRIBOLOGY_PICTURES), result.scene.title),
    }


def scene_content(scene: Scene, positions: int | None = None) -> dict[str, Any]:
    """Return what the templates take of a scene: what was asked, the geometry, the text of the file.

    ``positions`` as of :func:`loaded_tca.output.overview.scene_sections`.
    """
    sections = scene_sections(scene, positions)
    asked = [*sections["load and analysis"], *sections["mounting errors, edges and modifications"]]
    path = sections["path of contact"]
    geometry = [
        *tables_of(sections["geometry"], f"Geometry ({scene.geometry_standard})"),
        *([Table(tuple(path[1:]), tuple(path[0]), "Path of contact")] if path else []),
        *tables_of(sections["ISO 6336"], "ISO 6336"),
        *tables_of(sections["flanks described by points"], "Flanks described by points"),
    ]
    return {
        "asked": tables_of([("material", *_materials(scene)), *asked]),
        "geometry": geometry,
        "scene_toml": scene.to_toml(),
    }


def explained(sentences: Sequence[str]) -> list[tuple[list[str], Kind | None]]:
    """Return accuracy warnings, those for one reason together, with what is to be known of them."""
    sentences_of: dict[Kind | None, list[str]] = {}
    for sentence in sentences:
        sentences_of.setdefault(kind_of(sentence), []).append(sentence)
    return [(alike, known) for known, alike in sentences_of.items()]


def _materials(scene: Scene) -> tuple[str, ...]:
    """Modulus and ratio of both gears, once if they are the same."""
    materials = (
        f"E = {plain(1e-3 * one.youngs_modulus_MPa, 6)} GPa, ν = {plain(one.poisson_ratio, 6)}"
        for one in scene.materials
    )
    return tuple(dict.fromkeys(materials))


def _load_cases(result: MeshCycle, figures: Sequence[Figures]) -> Table:
    """A line for each torque: forces, and the figures that matter most."""
    torques = result.torque.tolist()
    forces = result.scene.force_rows(torques)[:2]  # tangential and normal; all of them are in what was asked
    cases = declared(lambda figure: figure.is_load_case)
    names = [name for name in cases if any(math.isfinite(one.get(name, math.nan)) for one in figures)]
    first, *others = names
    heads = [_head(first), *(label for label, *_ in forces), *map(_head, others)]
    rows = [
        (shown(one[first], first), *(row[k + 1] for row in forces), *(shown(one[name], name) for name in others))
        for k, one in enumerate(figures)
    ]
    return Table(tuple(rows), tuple(heads))


def _head(name: str) -> str:
    """Label of a figure in the table of the load cases."""
    words, bracket, unit = labelled(name, FIGURES[name].column or FIGURES[name].label).rpartition(" [")
    return words + bracket + unit.replace("um", "µm") if bracket else unit


def key_figures_table(result: MeshCycle, part: slice, figures: Sequence[Figures], *, main: bool = False) -> Table:
    """Every figure of the summary under some torques, its unit, and what is to be known of its accuracy.

    With ``main`` those alone by which results are compared.
    """
    rows = []
    for label, names in known_rows(figures):
        for name in names if names != (TORQUE,) else ():
            if main and not FIGURES[name].is_compared:
                continue
            accuracy = FIGURES[name].accuracy
            indent = "  " if label.startswith(" ") else ""
            values = (_value(one, name) for one in figures)
            unit = " [%]" if FIGURES[name].is_part else ""  # as summaries show it
            rows.append(
                (indent + label_of(name) + unit, *values, accuracy(name, result, part, figures) if accuracy else "")
            )
    return Table(tuple(rows), ("key figure", *_under(figures), "accuracy"))


def _under(figures: Sequence[Figures]) -> Iterator[str]:
    """Names of the columns of some torques."""
    return (f"{plain(one['pinion_torque_Nm'])}\N{NO-BREAK SPACE}N\N{NO-BREAK SPACE}m" for one in figures)


def _value(figures: Figures, name: str) -> str:
    """A figure as summaries show it; an edge pressure without an estimate of its error has none."""
    value = figures.get(name, math.nan)
    lacks = name == "edge_pressure_error" and math.isnan(value) and math.isfinite(figures["edge_pressure_MPa"])
    return NO_ESTIMATE if lacks else shown(value, name)


def _accuracy(result: MeshCycle, part: slice, figures: Sequence[Figures]) -> Table:
    """What limits the numbers under some torques: errors of grids, cells, residuals."""
    wanted = result.scene.analysis
    errors = [float(np.nanmax(one, initial=-math.inf)) for one in result.edge_pressure_error[part]]
    asked = f"{wanted.accuracy:.2%}" if wanted.cells is None else "cells given, none"
    rows = [
        ("accuracy of the peak pressure that the scene asks for", *(asked for _ in errors)),
        (
            "estimated discretisation error of the peak pressure, largest",
            *(in_percent(one["largest_discretisation_error"]) for one in figures[part]),
        ),
        (
            "estimated error of the pressure at rounded edges, largest",
            *("-" if error == -math.inf else in_percent(error) for error in errors),
        ),
        *(
            (
                f"cells {where} the contact, fewest and most",
                *(
                    f"{plain(one[f'fewest_cells_{where}'], 6)}, {plain(one[f'most_cells_{where}'], 6)}"
                    for one in figures[part]
                ),
            )
            for where in ("across", "along")
        ),
        (
            "residual of the contact solver, worst",
            *(shown(one["worst_solver_residual"], "worst_solver_residual") for one in figures[part]),
        ),
        (
            "positions at which the contact reaches an edge",
            *(f"{one['edge_positions']} of {one['positions']}" for one in figures[part]),
        ),
        (
            "positions at which the start of a linear relief lies in the contact",
            *(f"{one['relief_start_positions']} of {one['positions']}" for one in figures[part]),
        ),
    ]
    return Table(tuple(rows), ("", *_under(figures[part])))


def stage_content(result: StageResult) -> dict[str, Any]:
    """Return what the template of a stage takes.

    Parameters
    ----------
    result : StageResult
    """
    head, *phases = stage_sections(result.stage)["phases"]
    return {
        "title": result.stage.title or "Planetary stage",
        "analysed_by": result.version,
        "held": HELD,
        **stage_geometry(result.stage),
        "phases": Table(tuple(phases[:-1]), ("", f"{head[1]} mesh", f"{head[2]} mesh")),
        "cancelled": phases[-1],
        "key_figures": [_stage_figures(result, part) for part in parts_of(result.torque.tolist(), MOST_TORQUES)],
        "shares": _shares(result),
        "findings": result.findings(),
        "orders": _orders(result),
        "files": [*result.parts()],
        "warnings": explained(result.warnings or ()),
        "pictures": pictures_of(stage_figures(result), STAGE_CAPTIONS, result.stage.title),
        "rating": stage_rating_content(result),
    }


def stage_geometry(stage: Stage) -> dict[str, Any]:
    """Return what templates take of a stage: what was asked, the geometry of both meshes, the text of the file."""
    sections = stage_sections(stage)
    return {
        "asked": [*tables_of(sections["stage"]), *tables_of(sections["torques"])],
        "geometry": [
            table
            for name, rows, _ in geometry_of_meshes(stage)
            for table in tables_of(rows, f"Mesh of {name} (ISO 21771)")
        ],
        "scene_toml": stage.to_toml(),
    }


def figures_table(labels: Mapping[str, str], figures: Sequence[Figures]) -> Table:
    """Figures by their names under some torques, the first of them, the torque, at the head of its columns."""
    head, *rows = ((label, *(shown(row[name], name) for row in figures)) for name, label in labels.items())
    return Table(tuple(rows), head)


def _stage_figures(result: StageResult, part: slice) -> Table:
    """Every figure under some torques."""
    labels = {name: label_of(name) for name in result.known_figures()}
    labels |= {
        name: f"{label}, {edge}"
        for name, label in labels.items()
        if "_edge_" in name and (edge := result.kind_of_edge(name))
    }
    return figures_table(labels, result.key_figures()[part])


def _shares(result: StageResult) -> Table:
    """Least, mean and largest share of each planet, under the largest torque."""
    shares = 100.0 * result.planet_share[index_or_largest(result.torque)]
    rows = (
        (f"planet {planet}", *(f"{value:z.2f}" for value in (own.min(), own.mean(), own.max())))
        for planet, own in enumerate(shares.T)
    )
    return Table(tuple(rows), ("share of the torque [%], largest torque", "least", "mean", "largest"))


def _orders(result: StageResult) -> Table:
    """Orders of the mesh under the largest torque, and what equal planets cancel of them."""
    rows = (
        (
            f"order {one.order}",
            f"{one.stage:z.4f}",
            f"{one.one_path:z.4f}",
            "cancelled" if one.torsion_cancels else "kept",
            "cancelled" if one.translation_cancels else "kept",
        )
        for one in result.orders(index_or_largest(result.torque))
    )
    head = (
        "transmission error at the sun's base circle [µm]",
        "stage",
        "one planet alone",
        "equal planets: rotation",
        "forces on the sun",
    )
    return Table(tuple(rows), head)
