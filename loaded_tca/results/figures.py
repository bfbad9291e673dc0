"""The key figures of a mesh cycle, each declared once: its number, and what texts, tables and pictures say of it.

Summary, comparison, summary and ranking of studies, sensitivities, axes of pictures and reports all read ``FIGURES``,
and the order of ``SUMMARY``. A name ends in its unit.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.results.figure import (
    ROOT,
    Figure,
    Line,
    Slope,
    compared,
    length,
    of_bending,
    of_edge,
    of_error_at_edge,
    of_face_load,
    of_largest,
    of_line_load,
    of_orders,
    of_peak,
    saying,
    slope_of_mean_error,
    slope_of_peak,
    slope_of_root_tension,
)
from loaded_tca.results.key_figures import (
    AXES,
    LOAD_ROW,
    ORDERS,
    REASONS,
    STIFFNESS_ROW,
    STRESS_ROWS,
    UnderTorque,
    mean_over_a_pitch,
    positions_with,
    reduced,
    span_of,
)
from loaded_tca.results.root_stress import FACTORS, RIM_LABEL
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from collections.abc import Callable

    from loaded_tca.results.numbers import CycleNumbers


def key_figures(result: CycleNumbers, torque: int) -> dict[str, float]:
    """Return the figures under one torque by names that end in their unit; NaN: not known.

    Parameters
    ----------
    result : MeshCycle
    torque : int
        Index of the torque.
    """
    under = UnderTorque(result, torque)
    return {name: figure.of(under) for name, figure in FIGURES.items() if not figure.needs or result.has(figure.needs)}


def _of_order(order: int) -> Figure:
    """Amplitude of an order of the tooth mesh."""
    slope = Slope(3, "order 1", lambda slopes: length(slopes) * slopes.harmonics(1)[:, 0])
    return Figure(
        of=lambda under: under.length * float(under.harmonics[order - 1]),
        label=f"  order {order} of the tooth mesh",
        axis=f"order {order} of the transmission error",
        is_compared=True,
        is_scattered=order == 1,
        slope=slope if order == 1 else None,
        accuracy=of_orders,
    )


def _of_standard(name: str, axis: str) -> Figure:
    """Figure of ISO 6336-1 or -2."""
    return Figure(of=lambda under: under.iso[name], axis=axis, accuracy=saying(REASONS.get(name, "")))


def _of_roots(name: str, **texts: Any) -> Figure:
    """Figure of root stress."""
    return Figure(of=lambda under: under.root[name], needs=ROOT, **texts)


def _of_gear(gear: int) -> dict[str, Figure]:
    """Figures of the root stress of pinion or wheel."""
    name = GEARS[gear]
    main: dict[str, dict[str, Any]] = {
        "tension": {
            "column": f"root tension, {name}",
            "is_load_case": True,
            "rank": 4 + gear,
            "slope": Slope(6 + gear, f"{name} tension", slope_of_root_tension(gear)),
        },
        "compression": {"largest_is_best": True},
    }
    figures: dict[str, dict[str, Any]] = {
        f"{name}_rim_thickness_factor_iso_6336": {"axis": f"{name} rim thickness factor Y_B, ISO 6336"}
    }
    for extreme, texts in main.items():
        figure = f"{name}_root_{extreme}"
        texts |= {"label": f"root {extreme} of the {name}", "is_compared": True, "accuracy": compared}
        places = f"pinion_angle_at_{figure}_deg", f"{figure}_angle_deg", f"{figure}_axial_mm", f"{figure}_on_back"
        figures |= {f"{figure}_MPa": texts, **{place: {} for place in places}}
    others = "nominal_root_stress_iso_6336_MPa", *(f"{what}_factor_iso_6336" for what in FACTORS)
    figures[f"{name}_root_stress_ratio"] = {"largest_is_best": True}
    figures |= {f"{name}_{other}": {} for other in (*others, "root_stress_iso_6336_MPa")}
    return {entry: _of_roots(entry, **texts) for entry, texts in figures.items()}


def _of_bearings(gear: str) -> dict[str, Figure]:
    """Figures of the rolling bearings of the shaft of a gear."""
    force, pressure, life = f"{gear}_element_force", f"{gear}_element_pressure", f"{gear}_bearing_life"
    return {
        f"{force}_N": Figure(
            of=lambda under: reduced(np.max, getattr(under, force)),
            label=f"element force in bearings, {gear}",
            is_compared=True,
            needs=force,
        ),
        f"{pressure}_MPa": Figure(
            of=lambda under: reduced(np.max, getattr(under, pressure)),
            label=f"pressure in bearings, {gear}",
            is_compared=True,
            needs=pressure,
        ),
        f"{life}_Mrev": Figure(
            of=lambda under: reduced(np.min, getattr(under, life)),
            label=f"bearing life, {gear}",
            is_compared=True,
            largest_is_best=True,
            needs=life,
            accuracy=saying("basic reference rating life, ISO/TS 16281: 90 % reliability, no lubrication"),
        ),
    }


FIGURES: dict[str, Figure] = {
    "pinion_torque_Nm": Figure(of=lambda under: 1e-3 * float(under.torque), label="pinion torque", is_load_case=True),
    "peak_pressure_MPa": Figure(
        of=lambda under: under.peak.number("peak_pressure"),
        label="peak pressure",
        is_compared=True,
        is_load_case=True,
        is_scattered=True,
        rank=2,
        slope=Slope(5, "peak pressure", slope_of_peak),
        accuracy=of_peak,
    ),
    "pinion_angle_at_peak_deg": Figure(of=lambda under: math.degrees(under.peak.unloaded("pinion_angle"))),
    "pinion_diameter_at_peak_mm": Figure(of=lambda under: 2.0 * under.peak.number("peak_radius")),
    "pinion_axial_at_peak_mm": Figure(of=lambda under: under.peak.number("peak_axial")),
    "contact_point_diameter_at_peak_mm": Figure(of=lambda under: 2.0 * under.peak.unloaded("pinion_radius")),
    "contact_point_axial_at_peak_mm": Figure(of=lambda under: under.peak.unloaded("pinion_axial")),
    "central_pressure_at_peak_MPa": Figure(of=lambda under: under.peak.number("central_pressure")),
    "normal_force_at_peak_N": Figure(of=lambda under: under.peak.number("normal_force")),
    "contact_length_at_peak_mm": Figure(
        of=lambda under: under.peak.number("contact_length"),
        label="contact length",
        below="  contact length there",
        is_compared=True,
    ),
    "contact_width_at_peak_mm": Figure(of=lambda under: under.peak.number("contact_width")),
    "contact_deformation_at_peak_um": Figure(of=lambda under: 1e3 * under.peak.number("contact_deformation")),
    "edge_pressure_MPa": Figure(
        of=lambda under: under.edge.number("edge_pressure"),
        label="{edge}",
        column="pressure at an edge (sharp: mesh-dependent)",
        is_compared=True,
        is_load_case=True,
        accuracy=of_edge,
    ),
    "edge_is_rounded": Figure(of=lambda under: under.edge.has("edge_is_rounded")),
    "edge_pressure_error": Figure(
        of=lambda under: under.edge.number("edge_pressure_error"), is_part=True, accuracy=of_error_at_edge
    ),
    "normal_force_at_edge_N": Figure(of=lambda under: under.edge.number("normal_force")),
    "pinion_angle_at_edge_deg": Figure(of=lambda under: math.degrees(under.edge.unloaded("pinion_angle"))),
    "pinion_diameter_at_edge_mm": Figure(of=lambda under: 2.0 * under.edge.number("edge_radius")),
    "pinion_axial_at_edge_mm": Figure(of=lambda under: under.edge.number("edge_axial")),
    "peak_pressure_where_hertz_holds_MPa": Figure(of=lambda under: under.smooth.number("peak_pressure")),
    "hertz_pressure_there_MPa": Figure(
        of=lambda under: under.smooth.number("hertz_pressure"), accuracy=saying("closed form, to compare with")
    ),
    "hertz_length_there_mm": Figure(of=lambda under: 2.0 * under.smooth.number("hertz_semi_major")),
    "hertz_width_there_mm": Figure(of=lambda under: 2.0 * under.smooth.number("hertz_semi_minor")),
    "transmission_error_mean_arcsec": Figure(
        of=lambda under: mean_over_a_pitch(under.transmission_error) * under.arcsec,
        axis="mean transmission error",
        accuracy=of_bending,
    ),
    "transmission_error_mean_um": Figure(
        of=lambda under: mean_over_a_pitch(under.transmission_error) * under.length,
        axis="mean transmission error",
        accuracy=of_bending,
        is_compared=True,
        label="transmission error, mean",
        slope=Slope(1, "TE, mean", slope_of_mean_error),
    ),
    "transmission_error_span_arcsec": Figure(
        of=lambda under: span_of(under.transmission_error, under.result.places_of_mesh) * under.arcsec,
        axis="peak-to-peak transmission error",
        accuracy=of_bending,
    ),
    "transmission_error_span_um": Figure(
        of=lambda under: span_of(under.transmission_error, under.result.places_of_mesh) * under.length,
        axis="peak-to-peak transmission error",
        accuracy=of_bending,
        is_compared=True,
        label="transmission error, peak to peak",
        below="  peak to peak",
        is_load_case=True,
        is_scattered=True,
        rank=1,
        slope=Slope(2, "peak to peak", lambda slopes: length(slopes) * slopes.peak_to_peak),
    ),
    **{f"transmission_error_order_{order}_um": _of_order(order) for order in range(1, ORDERS + 1)},
    "unloaded_transmission_error_mean_arcsec": Figure(
        of=lambda under: mean_over_a_pitch(under.result.unloaded_transmission_error) * under.arcsec
    ),
    "unloaded_transmission_error_mean_um": Figure(
        of=lambda under: mean_over_a_pitch(under.result.unloaded_transmission_error) * under.length
    ),
    "unloaded_transmission_error_span_arcsec": Figure(
        of=lambda under: span_of(under.result.unloaded_transmission_error, under.result.places_of_mesh) * under.arcsec,
        axis="peak-to-peak unloaded transmission error",
    ),
    "unloaded_transmission_error_span_um": Figure(
        of=lambda under: span_of(under.result.unloaded_transmission_error, under.result.places_of_mesh) * under.length,
        axis="peak-to-peak unloaded transmission error",
        label="unloaded transmission error, peak to peak",
        below="  unloaded, peak to peak",
        is_compared=True,
    ),
    "mesh_stiffness_mean_N_per_mm_um": Figure(
        of=lambda under: mean_over_a_pitch(under.mesh_stiffness),
        label="mesh stiffness, mean",
        is_compared=True,
        is_load_case=True,
        is_scattered=True,
        accuracy=of_bending,
    ),
    "mesh_stiffness_without_body_torsion_mean_N_per_mm_um": Figure(
        of=lambda under: under.result.without_body_torsion(mean_over_a_pitch(under.mesh_stiffness)), accuracy=of_bending
    ),
    "secant_stiffness_mean_N_per_mm_um": Figure(
        of=lambda under: mean_over_a_pitch(under.secant_stiffness), accuracy=of_bending
    ),
    "rack_transmission_error_mean_um": Figure(
        of=lambda under: MICROMETRES * mean_over_a_pitch(under.rack_transmission_error),
        axis="mean transmission error along the rack",
        accuracy=of_bending,
        is_compared=True,
        label="transmission error along the rack, mean",
        needs="rack_transmission_error",
    ),
    "rack_transmission_error_span_um": Figure(
        of=lambda under: MICROMETRES * span_of(under.rack_transmission_error, under.result.places_of_mesh),
        axis="peak-to-peak transmission error along the rack",
        accuracy=of_bending,
        is_compared=True,
        label="transmission error along the rack, peak to peak",
        needs="rack_transmission_error",
    ),
    "misalignment_mean_um": Figure(
        of=lambda under: mean_over_a_pitch(under.misalignment),
        axis="mean misalignment",
        label="misalignment, mean",
        is_compared=True,
        needs="misalignment",
    ),
    "wind_up_mean_um": Figure(
        of=lambda under: mean_over_a_pitch(under.wind_up) * under.length,
        axis="mean wind-up",
        label="wind-up in the transmission error, mean",
        is_compared=True,
        needs="wind_up",
    ),
    "drive_stiffness_mean_N_per_mm_um": Figure(
        of=lambda under: mean_over_a_pitch(under.drive_stiffness), axis="mean drive stiffness", needs="drive_stiffness"
    ),
    "face_load_factor": Figure(
        of=lambda under: float(under.face_load_factor),
        label="load factor K_Hbeta",
        column="K_Hβ",
        axis="face load factor K_Hβ",
        is_compared=True,
        is_load_case=True,
        is_scattered=True,
        rank=3,
        slope=Slope(4, "K_Hbeta", lambda slopes: slopes.face_load_factor),
        accuracy=of_face_load,
    ),
    "face_load_factor_error": Figure(of=lambda under: under.face_load_factor_error, is_part=True),
    "face_load_factor_by_positions": Figure(of=lambda under: under.face_load_factor_by_positions, is_part=True),
    "transverse_load_factor": Figure(
        of=lambda under: float(under.transverse_load_factor),
        label="load factor K_Halpha",
        column="K_Hα",
        axis="transverse load factor K_Hα",
        is_compared=True,
        is_load_case=True,
        accuracy=of_largest,
    ),
    **{name: _of_standard(name, axis) for name, axis in AXES.items()},
    "loaded_contact_ratio": Figure(
        of=lambda under: mean_over_a_pitch(under.pairs), label="tooth pairs under load, mean", is_compared=True
    ),
    "fewest_loaded_pairs": Figure(of=lambda under: reduced(np.min, under.pairs)),
    "most_loaded_pairs": Figure(of=lambda under: reduced(np.max, under.pairs)),
    "line_load_max_N_per_mm": Figure(of=lambda under: reduced(np.max, under.line_load)),
    "line_load_at_largest_force_N_per_mm": Figure(
        of=lambda under: under.heaviest.number("line_load"),
        label="line load under the largest force",
        is_compared=True,
        accuracy=of_line_load,
    ),
    "line_load_ratio_at_largest_force": Figure(of=lambda under: under.heaviest.number("line_load_ratio")),
    **{name: figure for gear in GEARS for name, figure in _of_bearings(gear).items()},
    "max_pressure_MPa": Figure(of=lambda under: under.result.max_pressure),
    "fewest_cells_across": Figure(of=lambda under: reduced(np.min, under.cells_across[under.cells_across > 0])),
    "fewest_cells_along": Figure(of=lambda under: reduced(np.min, under.cells_along[under.cells_along > 0])),
    "most_cells_across": Figure(of=lambda under: reduced(np.max, under.cells_across[under.cells_across > 0])),
    "most_cells_along": Figure(of=lambda under: reduced(np.max, under.cells_along[under.cells_along > 0])),
    "largest_discretisation_error": Figure(of=lambda under: reduced(np.max, under.discretisation_error)),
    "most_solver_iterations": Figure(of=lambda under: reduced(np.max, under.iterations)),
    "worst_solver_residual": Figure(of=lambda under: reduced(np.max, under.residual)),
    "positions": Figure(of=lambda under: len(under.result.path)),
    "positions_in_contact": Figure(of=lambda under: int(under.result.path.in_contact.sum())),
    "line_positions": Figure(of=lambda under: positions_with(under.on_line)),
    "edge_positions": Figure(of=lambda under: positions_with(under.on_edge)),
    "relief_start_positions": Figure(of=lambda under: positions_with(under.on_relief_start)),
    "capped_positions": Figure(of=lambda under: positions_with(under.capped)),
    **{name: figure for gear in range(len(GEARS)) for name, figure in _of_gear(gear).items()},
    "root_face_load_factor_iso_6336": _of_roots("root_face_load_factor_iso_6336"),
}
"""Name -> figure, in the order of tables and files; those of root stress where a scene asks for it."""

SUMMARY: tuple[Line, ...] = (
    Line("pinion torque [N m]", ("pinion_torque_Nm",), True),
    Line("peak pressure [MPa] | pinion angle [deg]", ("peak_pressure_MPa", "pinion_angle_at_peak_deg"), True),
    Line("  normal force of that tooth pair [N]", ("normal_force_at_peak_N",), True),
    Line("  pinion diameter | axial position [mm]", ("pinion_diameter_at_peak_mm", "pinion_axial_at_peak_mm"), True),
    Line("  contact length | width [mm]", ("contact_length_at_peak_mm", "contact_width_at_peak_mm"), True),
    Line("{edge} [MPa] | its force [N]", ("edge_pressure_MPa", "normal_force_at_edge_N")),
    Line("  estimated error [%]", ("edge_pressure_error",)),
    Line("  pinion diameter | axial position [mm]", ("pinion_diameter_at_edge_mm", "pinion_axial_at_edge_mm")),
    *(Line(*row) for row in STRESS_ROWS),
    Line(
        "highest where Hertz holds (-: nowhere) | Hertz [MPa]",
        ("peak_pressure_where_hertz_holds_MPa", "hertz_pressure_there_MPa"),
    ),
    Line("  length | width after Hertz [mm]", ("hertz_length_there_mm", "hertz_width_there_mm")),
    Line(
        "transmission error, mean [arcsec | um]",
        ("transmission_error_mean_arcsec", "transmission_error_mean_um"),
        True,
    ),
    Line("  peak to peak [arcsec | um]", ("transmission_error_span_arcsec", "transmission_error_span_um"), True),
    Line(
        "  unloaded, peak to peak [arcsec | um]",
        ("unloaded_transmission_error_span_arcsec", "unloaded_transmission_error_span_um"),
        True,
    ),
    Line(
        "  orders 1 | 2 | 3 of the tooth mesh [um]",
        tuple(f"transmission_error_order_{order}_um" for order in (1, 2, 3)),
    ),
    Line(
        "transmission error along the rack, mean | peak to peak [um]",
        ("rack_transmission_error_mean_um", "rack_transmission_error_span_um"),
    ),
    Line(
        "mesh stiffness, mean, tangent | secant [N/(mm um)]",
        ("mesh_stiffness_mean_N_per_mm_um", "secant_stiffness_mean_N_per_mm_um"),
        True,
    ),
    Line(
        "  tangent, without body torsion [N/(mm um)]",
        ("mesh_stiffness_without_body_torsion_mean_N_per_mm_um",),
    ),
    Line(*STIFFNESS_ROW),
    Line("  drive stiffness, mean, tangent with the supports [N/(mm um)]", ("drive_stiffness_mean_N_per_mm_um",)),
    Line("misalignment of the supports, mean [um]", ("misalignment_mean_um",)),
    Line("wind-up of the shafts in the transmission error, mean [um]", ("wind_up_mean_um",)),
    Line("largest element force in bearings of pinion | wheel [N]", tuple(f"{gear}_element_force_N" for gear in GEARS)),
    Line("  largest pressure there [MPa]", tuple(f"{gear}_element_pressure_MPa" for gear in GEARS)),
    Line("  shortest life [million revolutions]", tuple(f"{gear}_bearing_life_Mrev" for gear in GEARS)),
    Line("load factors K_Hbeta | K_Halpha", ("face_load_factor", "transverse_load_factor")),
    Line("  K_Hbeta off by its cells, at the most [%]", ("face_load_factor_error",)),
    Line("  change of its strips if only every second position counts [%]", ("face_load_factor_by_positions",)),
    Line(*LOAD_ROW),
    Line(
        "line load under the largest force; mesh-dependent at sharp ends [N/mm]",
        ("line_load_at_largest_force_N_per_mm",),
        True,
    ),
    Line(
        "tooth pairs under load, mean | fewest | most",
        ("loaded_contact_ratio", "fewest_loaded_pairs", "most_loaded_pairs"),
    ),
    Line("root tension of pinion | wheel [MPa]", ("pinion_root_tension_MPa", "wheel_root_tension_MPa")),
    Line("  tangent angle [deg]", ("pinion_root_tension_angle_deg", "wheel_root_tension_angle_deg")),
    Line("  axial position on the gear [mm]", ("pinion_root_tension_axial_mm", "wheel_root_tension_axial_mm")),
    Line("  stress ratio R there", ("pinion_root_stress_ratio", "wheel_root_stress_ratio")),
    Line(
        "  ISO 6336-3:2006, sigma_F0 K_Fbeta [MPa]",
        ("pinion_root_stress_iso_6336_MPa", "wheel_root_stress_iso_6336_MPa"),
    ),
    Line(
        "    its sigma_F0 of pinion | wheel [MPa], K_Fbeta",
        (
            "pinion_nominal_root_stress_iso_6336_MPa",
            "wheel_nominal_root_stress_iso_6336_MPa",
            "root_face_load_factor_iso_6336",
        ),
    ),
    *(
        Line(f"    its Y_F | Y_S | Y_beta of the {gear}", tuple(f"{gear}_{name}_factor_iso_6336" for name in FACTORS))
        for gear in GEARS
    ),
    Line(RIM_LABEL, tuple(f"{gear}_rim_thickness_factor_iso_6336" for gear in GEARS)),
    Line("root compression of pinion | wheel [MPa]", ("pinion_root_compression_MPa", "wheel_root_compression_MPa")),
    Line(
        "most cells across | along, worst residual",
        ("most_cells_across", "most_cells_along", "worst_solver_residual"),
        True,
    ),
)
"""Lines of the summary in their order, which is that of figures in other texts; {edge} stands for the kind of edge."""


def declared(holds: Callable[[Figure], object]) -> list[str]:
    """Names of the figures for which something holds, in the order of the summary."""
    return [name for line in SUMMARY for name in line.names if holds(FIGURES[name])]
