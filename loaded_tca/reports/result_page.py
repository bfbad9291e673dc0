"""What the report of a result tells."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from loaded_tca.output.overview import scene_sections
from loaded_tca.plots import result_figures
from loaded_tca.plots.labels import label_of
from loaded_tca.reports.page import Table, parts_of, pictures_of, tables_of
from loaded_tca.results.explanations import Explanation, explanation_of
from loaded_tca.results.iso_figures import REASONS
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.summary import IN_PERCENT, Figures, known_rows, limits_of, shown
from loaded_tca.scene import Scene

MOST_TORQUES = 5
"""Torques with a column each in one table of a page."""
TORQUE = "pinion torque [N m]"
IN_THE_TABLE = {
    "pinion_torque_Nm": TORQUE,
    "peak_pressure_MPa": "peak pressure [MPa]",
    "edge_pressure_MPa": "pressure at an edge [MPa]",
    "transmission_error_span_um": "transmission error, peak to peak [µm]",
    "mesh_stiffness_mean_N_per_mm_um": "mesh stiffness, mean [N/(mm µm)]",
    "face_load_factor": "K_Hβ",
    "transverse_load_factor": "K_Hα",
    "pinion_root_tension_MPa": "root tension, pinion [MPa]",
    "wheel_root_tension_MPa": "root tension, wheel [MPa]",
}
"""Key figures of the table of the load cases."""
WIDE = 33.0
"""Face width over the module from which the ends of a face matter little."""
COMPARED: dict[str, dict[str, float]] = {
    f"spur teeth on a face of {WIDE:g} modules or more": {
        "transmission_error_mean_": 1.0,
        "transmission_error_span_": 0.5,
        "mesh_stiffness_mean_": 3.0,
    },
    f"spur teeth on a face below {WIDE:g} modules": {
        "transmission_error_mean_": 2.7,
        "transmission_error_span_": 2.5,
        "mesh_stiffness_mean_": 4.7,
    },
    "spur teeth": {"root_tension_MPa": 0.5, "root_compression_MPa": 0.6},
    "helical teeth": {"root_tension_MPa": 0.9, "root_compression_MPa": 1.5},
}
"""Kind of gears -> by how many percent key figures with such words in their names differ from finite elements in the
studies of the documentation: the mesh cycle, and root stress. Gears of other kinds were not compared."""
NO_ESTIMATE = "no estimate"
CAPTIONS = {
    "contact_path": "Where the flanks carry pressure at some positions, and the unloaded contact points of all.",
    "transmission_error": "Absolute, and below less its mean over a pitch. The unloaded one is that of the flanks.",
    "peak_pressure": "Broad dashed lines: after Hertz, where Hertz holds. Crosses and arrows: pressure at an edge, "
    "mesh-dependent where the edge is sharp.",
    "pressure_map": "At the position of the peak pressure, in the tangent plane. White: no pressure, grey: no "
    "material. The direction across is drawn larger.",
    "pressure_map_edge": "At the position of the highest pressure at an edge. At a sharp edge the pressure of single "
    "cells depends on the mesh.",
    "pressure_map_hertz": "At the highest peak pressure where Hertz holds, with the area after Hertz.",
    "load_share": "Share of each tooth pair in the torque, and how many pairs carry load.",
    "harmonics": "Amplitudes and phases of the orders of the tooth mesh in the loaded transmission error.",
    "mesh_stiffness": "Solid: tangent of the force over the face width to the transmission error. Dotted: secant from "
    "no load.",
    "line_load": "Largest force per length along the contact of the most loaded pair; at a sharp face end "
    "mesh-dependent.",
    "line_load_distribution": "Force per length along the contacts of all positions, where they lie on the flanks.",
    "face_load": "Normal force of all tooth pairs per face width, the mean over a pitch. Its largest value over its "
    "mean is K_Hβ.",
    "pressure_envelope": "The highest pressure that each place of the flanks sees over the mesh cycle.",
    "path_pressure": "Peak pressure of a tooth pair from the begin to the end of its contact.",
    "root_stress": "Tangential stress over fillet and face: at the largest tension, and as envelopes over the mesh.",
    "root_stress_cycle": "Largest tension and compression at the roots over the positions.",
    "root_stress_over_torque": "Largest tension and compression at the roots over the torque.",
    "contact_patterns": "The pressure envelope under each torque, all on one scale of colours.",
    "full_mesh": "All tooth pairs in contact at one position, with their shares of the torque.",
}
"""How each picture is read."""


def result_content(result: MeshCycle) -> dict[str, Any]:
    """Return what the template of a result takes.

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
        "key_figures": [_key_figures(result, part, figures[part]) for part in parts_of(figures, MOST_TORQUES)],
        "limits": [*limits_of(figures)],
        "accuracy": [_accuracy(result, part, figures) for part in parts_of(figures, MOST_TORQUES)],
        "warnings": None if result.warnings is None else explained(result.warnings),
        "pictures": pictures_of(result_figures(result, more=True), CAPTIONS, result.scene.title),
    }


def scene_content(scene: Scene) -> dict[str, Any]:
    """Return what the templates take of a scene: what was asked, the geometry, the text of the file."""
    sections = scene_sections(scene)
    asked = [*sections["load and analysis"], *sections["mounting errors, edges and modifications"]]
    standard = "ISO 21771" if scene.path_points else "ISO 23509"
    path = sections["path of contact"]
    geometry = [
        *tables_of(sections["geometry"], f"Geometry ({standard})"),
        *([Table(tuple(path[1:]), tuple(path[0]), "Path of contact")] if path else []),
        *tables_of(sections["ISO 6336"], "ISO 6336"),
        *tables_of(sections["flanks described by points"], "Flanks described by points"),
    ]
    return {
        "asked": tables_of([("material", *_materials(scene)), *asked]),
        "geometry": geometry,
        "scene_toml": scene.to_toml(),
    }


def explained(sentences: Sequence[str]) -> list[tuple[list[str], Explanation | None]]:
    """Return accuracy warnings, those for one reason together, with what is to be known of them."""
    found: dict[Explanation | None, list[str]] = {}
    for sentence in sentences:
        found.setdefault(explanation_of(sentence), []).append(sentence)
    return [(told, known) for known, told in found.items()]


def _materials(scene: Scene) -> tuple[str, ...]:
    """Modulus and ratio of both gears, once if they are the same."""
    told = (f"E = {1e-3 * one.youngs_modulus_MPa:g} GPa, ν = {one.poisson_ratio:g}" for one in scene.materials)
    return tuple(dict.fromkeys(told))


def _load_cases(result: MeshCycle, figures: Sequence[Figures]) -> Table:
    """A line for each torque: forces, and the figures that matter most."""
    torques = result.torque.tolist()
    forces = result.scene.force_rows(torques)[:2]  # tangential and normal; all of them are in what was asked
    names = [name for name in IN_THE_TABLE if any(math.isfinite(one.get(name, math.nan)) for one in figures)]
    first, *others = names
    heads = [IN_THE_TABLE[first], *(label for label, *_ in forces), *(IN_THE_TABLE[name] for name in others)]
    rows = [
        (shown(one[first], first), *(row[k + 1] for row in forces), *(shown(one[name], name) for name in others))
        for k, one in enumerate(figures)
    ]
    return Table(tuple(rows), tuple(heads))


def _key_figures(result: MeshCycle, part: slice, figures: Sequence[Figures]) -> Table:
    """Every figure of the summary under some torques, its unit, and what is to be known of its accuracy."""
    rows = []
    for label, names in known_rows(figures):
        for name in names if label != TORQUE else ():
            indent = "  " if label.startswith(" ") else ""
            values = (_value(one, name) for one in figures)
            unit = " [%]" if name in IN_PERCENT else ""  # as summaries show it
            rows.append((indent + label_of(name) + unit, *values, _note(name, result, part, figures)))
    return Table(tuple(rows), ("key figure", *_under(figures), "accuracy"))


def _under(figures: Sequence[Figures]) -> Iterator[str]:
    """Names of the columns of some torques."""
    return (f"{one['pinion_torque_Nm']:.4g}\N{NO-BREAK SPACE}N\N{NO-BREAK SPACE}m" for one in figures)


def _value(figures: Figures, name: str) -> str:
    """A figure as summaries show it; an edge pressure without an estimate of its error has none."""
    value = figures.get(name, math.nan)
    lacks = name == "edge_pressure_error" and math.isnan(value) and math.isfinite(figures["edge_pressure_MPa"])
    return NO_ESTIMATE if lacks else shown(value, name)


def _note(name: str, result: MeshCycle, part: slice, figures: Sequence[Figures]) -> str:
    """What is to be known of the accuracy of a key figure; nothing of most."""
    if name in PRESSURES:
        return PRESSURES[name](result, part, figures)
    if name in REASONS:
        return REASONS[name]
    if name == "line_load_at_largest_force_N_per_mm" and any(one["edge_positions"] for one in figures):
        return "mesh-dependent where it lies at a sharp face end"
    if name == "face_load_factor":
        return "from 30 strips of the face"
    positions = f"{len(result.path)} positions"
    if name == "transverse_load_factor":
        return f"the largest of {positions}: more may find a larger one"
    if name.startswith("transmission_error_order_"):
        return f"of {positions}: higher orders are aliased into it"
    bends = result.scene.analysis.compliance != "contact"
    if not bends and name.startswith(("transmission_error_", "mesh_stiffness_", "secant_stiffness_")):
        return "of the flanks alone: the teeth do not bend"
    return _compared(name, result)


def _note_on_edge(_: MeshCycle, __: slice, figures: Sequence[Figures]) -> str:
    """What is to be known of the pressure at an edge."""
    rounded = {bool(one["edge_is_rounded"]) for one in figures if math.isfinite(one["edge_pressure_MPa"])}
    if rounded == {True}:
        return "rounded edge: with the error below"
    return "mesh-dependent at sharp edges: not for rating"


def _note_on_peak(result: MeshCycle, part: slice, figures: Sequence[Figures]) -> str:
    """How accurate the peak pressure is."""
    of_slices = any(one["edge_positions"] or one["relief_start_positions"] for one in figures)
    beside = "; where an edge or a relief start is reached, that of slices" if of_slices else ""
    return f"mesh-independent; error of the grid: {_errors_at_peak(result, part)}{beside}"


def _note_on_hertz(*_: Any) -> str:
    """What the pressure after Hertz is for."""
    return "closed form, to compare with"


PRESSURES: dict[str, Callable[[MeshCycle, slice, Sequence[Figures]], str]] = {
    "peak_pressure_MPa": _note_on_peak,
    "edge_pressure_MPa": _note_on_edge,
    "hertz_pressure_there_MPa": _note_on_hertz,
}
"""Key figures whose accuracy depends on the contacts."""


def _errors_at_peak(result: MeshCycle, part: slice) -> str:
    """Estimated error of the peak pressure itself under some torques."""
    places = [result.peak_contact(torque) for torque in range(len(result.torque))[part]]
    errors = [
        math.nan if place is None else float(result.discretisation_error[torque][place])
        for torque, place in zip(range(len(result.torque))[part], places, strict=True)
    ]
    return NO_ESTIMATE if np.isnan(errors).all() else ", ".join(map(_percent, errors))


def _compared(name: str, result: MeshCycle) -> str:
    """By how much a key figure of gears of this kind differs from finite elements; nothing of most figures."""
    if not any(words in name for compared in COMPARED.values() for words in compared) or "unloaded" in name:
        return ""
    for kind in _kinds(result):
        for words, percent in COMPARED[kind].items():
            if words in name:
                return f"{kind}: within {percent:g} % of finite elements"
    return f"{NO_ESTIMATE}: such gears were not compared with finite elements"


def _kinds(result: MeshCycle) -> Iterator[str]:
    """Kinds of gears of ``COMPARED`` that a result is of."""
    spur_wide, spur_narrow, spur, helical = COMPARED
    _, helix = result.scene.transverse_angles
    if helix == 0.0:
        yield spur_wide if result.face_width >= WIDE * result.gear_pair.module else spur_narrow
        yield spur
    elif math.isfinite(helix):
        yield helical


def _accuracy(result: MeshCycle, part: slice, figures: Sequence[Figures]) -> Table:
    """What limits the numbers under some torques: errors of grids, cells, residuals."""
    wanted = result.scene.analysis
    errors = [float(np.nanmax(one, initial=-math.inf)) for one in result.edge_pressure_error[part]]
    asked = f"{wanted.accuracy:.2%}" if wanted.cells is None else "cells given, none"
    rows = [
        ("accuracy of the peak pressure that the scene asks for", *(asked for _ in errors)),
        (
            "estimated discretisation error of the peak pressure, largest",
            *(_percent(one["largest_discretisation_error"]) for one in figures[part]),
        ),
        (
            "estimated error of the pressure at rounded edges, largest",
            *("-" if error == -math.inf else _percent(error) for error in errors),
        ),
        *(
            (
                f"cells {where} the contact, fewest and most",
                *(f"{one[f'fewest_cells_{where}']:g}, {one[f'most_cells_{where}']:g}" for one in figures[part]),
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
            "positions at which a relief start lies in the contact",
            *(f"{one['relief_start_positions']} of {one['positions']}" for one in figures[part]),
        ),
    ]
    return Table(tuple(rows), ("", *_under(figures[part])))


def _percent(error: float) -> str:
    """A relative error as a percentage."""
    if error == math.inf:
        return "no limit"
    return f"{error:.2%}" if math.isfinite(error) else NO_ESTIMATE
