"""What the report of a planetary stage tells."""

from __future__ import annotations

from typing import Any

from loaded_tca.output.stage_overview import HELD, geometry_of_meshes, stage_sections
from loaded_tca.plots import STAGE_CAPTIONS, STAGE_PICTURES
from loaded_tca.plots.style import label_of
from loaded_tca.reports.page import Table, parts_of, pictures_of, tables_of
from loaded_tca.reports.result_page import MOST_TORQUES, explained
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.summary import shown
from loaded_tca.stages import Stage, StageResult
from loaded_tca.stages.result import FILES


def stage_content(result: StageResult) -> dict[str, Any]:
    """Return what the template of a stage takes.

    Parameters
    ----------
    result : StageResult
    """
    head, *phases = stage_sections(result.stage)["phases"]
    figures = {name: draw(result) for name, draw in STAGE_PICTURES.items()}
    return {
        "title": result.stage.title or "Planetary stage",
        "analysed_by": str(result.dataset.attrs.get("version", "")),
        "held": HELD,
        **stage_geometry(result.stage),
        "phases": Table(tuple(phases[:-1]), ("", f"{head[1]} mesh", f"{head[2]} mesh")),
        "cancelled": phases[-1],
        "key_figures": [_key_figures(result, part) for part in parts_of(result.torque.tolist(), MOST_TORQUES)],
        "shares": _shares(result),
        "findings": result.findings(),
        "orders": _orders(result),
        "files": FILES[1:],
        "warnings": explained(result.warnings),
        "pictures": pictures_of(figures, STAGE_CAPTIONS, result.stage.title),
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


def _key_figures(result: StageResult, part: slice) -> Table:
    """Every figure under some torques."""
    figures = result.key_figures()[part]
    first, *names = result.known_figures()
    heads = {name: label_of(name) for name in names}
    heads |= {
        name: f"{heads[name]}, {edge}" for name in names if "_edge_" in name and (edge := result.kind_of_edge(name))
    }
    rows = ((heads[name], *(shown(row[name], name) for row in figures)) for name in names)
    return Table(tuple(rows), (label_of(first), *(shown(row[first], first) for row in figures)))


def _shares(result: StageResult) -> Table:
    """Least, mean and largest share of each planet, under the largest torque."""
    shares = 100.0 * result.planet_share[index_or_largest(result.torque)]
    rows = (
        (f"planet {planet}", *(f"{value:.2f}" for value in (own.min(), own.mean(), own.max())))
        for planet, own in enumerate(shares.T)
    )
    return Table(tuple(rows), ("share of the torque [%], largest torque", "least", "mean", "largest"))


def _orders(result: StageResult) -> Table:
    """Orders of the mesh under the largest torque, and what equal planets cancel of them."""
    rows = (
        (
            f"order {one.order}",
            f"{one.stage:.4f}",
            f"{one.one_path:.4f}",
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
