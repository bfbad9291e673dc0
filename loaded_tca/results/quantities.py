"""What a result holds: name, dimensions, unit and long name of every array in the dataset and in its file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from loaded_tca.arrays import GEARS as GEARS
from loaded_tca.results.declared import CYCLE, OVER_CYCLE, PAIRS, Asked, Number, numbers

if TYPE_CHECKING:
    from loaded_tca.results.files import Part

QUANTITIES: dict[str, Part] = {
    "torque": Number(("torque",), "N mm", "pinion torque", column="pinion_torque_Nm"),
    "pair": Number(
        ("pair",), "1", "tooth pair: 0 is in contact at the pitch point at phi1 = 0, +1 follows it", column="tooth_pair"
    ),
    "pinion_angle": (("position",), "rad", "angle of the pinion phi1"),
    "wheel_base_radius": ((), "mm", "base radius of the wheel"),
    "face_width": ((), "mm", "common face width"),
    "coupled_pitches": (
        (),
        "1",
        "largest number of pitches between two tooth pairs that tooth bending couples; 0 where no teeth bend",
    ),
    "max_pressure": ((), "MPa", "cap on the pressure; NaN: elastic"),
    "unloaded_transmission_error": Number(
        ("position",), "rad", "unloaded transmission error, absolute", at_base_circle=True
    ),
    "face_load_factor": (("torque",), "1", "face load factor K_Hbeta, from 30 strips of the face"),
    "transverse_load_factor": (("torque",), "1", "transverse load factor K_Halpha; NaN for bevel gears"),
    "transmission_error": Number(CYCLE, "rad", "loaded transmission error, absolute", at_base_circle=True),
    "transmission_error_by_grids": Number(
        CYCLE,
        "rad",
        "estimated error of the transmission error by the grids, from the two finest of each contact; no bound with "
        "rounded side edges; NaN on given cells of which fewer than 32 lie along both axes",
        at_base_circle=True,
    ),
    "mesh_stiffness": (
        CYCLE,
        "N/(mm um)",
        "derivative of the force over the face width with respect to the transmission error, without supports",
    ),
    "secant_stiffness": (
        CYCLE,
        "N/(mm um)",
        "force over the face width, divided by the transmission error that the load adds on rigid supports",
    ),
    "loaded_pairs": (CYCLE, "1", "number of tooth pairs under load"),
    "load_share": Number(PAIRS, "1", "share of the tooth pair in the torque", columns=("load_share_pair_{}",)),
    "normal_force": (PAIRS, "N", "normal force on the tooth pair"),
    "peak_pressure": (
        PAIRS,
        "MPa",
        "peak contact pressure; where the contact reaches an edge or a relief start, the larger of two: the largest "
        "pressure of its slices, and the largest pressure of cells in slices away from there",
    ),
    "edge_pressure": (
        PAIRS,
        "MPa",
        "largest pressure at an edge; NaN where the contact reaches no edge, and at rounded edges that cannot have the "
        "largest pressure under their torque unless all edges are asked for",
    ),
    "edge_is_rounded": (
        PAIRS,
        "1",
        "whether the edge of edge_pressure is rounded; the pressure at a sharp edge is mesh-dependent",
    ),
    "edge_pressure_error": (PAIRS, "1", "estimated relative error of the pressure at a rounded edge by its columns"),
    "edge_radius": Number(
        PAIRS, "mm", "radius on the pinion of the edge pressure", column="edge_pinion_diameter_mm", times=2.0
    ),
    "edge_axial": Number(
        PAIRS, "mm", "axial coordinate on the pinion of the edge pressure", column="edge_pinion_axial_mm"
    ),
    "central_pressure": (
        PAIRS,
        "MPa",
        "contact pressure beside the point where the grid starts, mesh-dependent if this point is on a sharp edge",
    ),
    "peak_radius": Number(
        PAIRS, "mm", "radius on the pinion of the peak pressure", column="peak_pinion_diameter_mm", times=2.0
    ),
    "peak_axial": Number(
        PAIRS, "mm", "axial coordinate on the pinion of the peak pressure", column="peak_pinion_axial_mm"
    ),
    "hertz_pressure": (
        PAIRS,
        "MPa",
        "peak pressure after Hertz at the contact point or of the contact line; NaN where Hertz does not hold",
    ),
    "hertz_semi_minor": Number(
        PAIRS, "mm", "half width across the contact after Hertz", column="hertz_width_mm", times=2.0
    ),
    "hertz_semi_major": Number(
        PAIRS,
        "mm",
        "half length of the Hertz ellipse, or of the loaded contact line",
        column="hertz_length_mm",
        times=2.0,
    ),
    "contact_width": (PAIRS, "mm", "full width of the contact across, from the pressure map"),
    "contact_length": (
        PAIRS,
        "mm",
        "full length of the contact, from the pressure map, without any part beyond the face",
    ),
    "line_load": (PAIRS, "N/mm", "largest force per length along the contact; at a face end mesh-dependent"),
    "line_load_ratio": (PAIRS, "1", "largest line load over the force spread evenly along the whole face"),
    "contact_deformation": Number(
        PAIRS, "mm", "approach of the two flanks as half-spaces, along the normal", column="contact_deformation_um"
    ),
    "tooth_deflection": Number(
        PAIRS, "mm", "deflection of the teeth and bodies along the normal", column="tooth_deflection_um"
    ),
    "on_edge": (PAIRS, "1", "whether the contact reaches an edge of a flank"),
    "on_relief_start": (PAIRS, "1", "whether the start of a linear relief lies in the contact"),
    "cells_across": (PAIRS, "1", "cells of the grid across the contact"),
    "cells_along": (PAIRS, "1", "cells of the grid along the contact"),
    "discretisation_error": (
        PAIRS,
        "1",
        "estimated relative error of the peak pressure by the grid, from the two finest grids; NaN without load, and "
        "on given cells at edges and relief starts, or if fewer than 32 lie along both axes",
    ),
    "iterations": (PAIRS, "1", "iterations of the contact solver"),
    "residual": (PAIRS, "1", "residual of the contact solver"),
}
"""Name in ``MeshCycle.dataset`` -> dimensions, unit, long name."""
COORDINATES = ("torque", "pinion_angle", "pair")

OF_THE_PEAK = frozenset(
    {"peak_pressure", "peak_radius", "peak_axial", "on_edge", "on_relief_start"}
    | {"cells_across", "cells_along", "discretisation_error", "iterations", "residual"}
)
"""Numbers whose value at a position is that of the pair with the highest peak pressure."""
OF_THE_EDGE = frozenset({"edge_pressure", "edge_is_rounded", "edge_pressure_error", "edge_radius", "edge_axial"})

ROOT_QUANTITIES: dict[str, Part] = {
    "root_tension": (OVER_CYCLE, "MPa", "largest stress at the roots of all teeth of pinion and wheel, on both sides"),
    "root_compression": (OVER_CYCLE, "MPa", "smallest stress at the roots of all teeth, negative in compression"),
    "root_tension_angle": (
        OVER_CYCLE,
        "rad",
        "angle of the fillet tangent to the middle line of the tooth, at the largest tension",
    ),
    "root_compression_angle": (OVER_CYCLE, "rad", "angle of the fillet tangent, at the largest compression"),
    "root_tension_axial": (OVER_CYCLE, "mm", "axial coordinate on the gear itself, at the largest tension"),
    "root_compression_axial": (OVER_CYCLE, "mm", "axial coordinate on the gear, at the largest compression"),
    "root_tension_place": (
        (*OVER_CYCLE, "index"),
        "1",
        "tooth, counted in the sense of +theta; side, 0 the one in contact; station along the fillet; place along the "
        "face; -1 where nothing is known",
    ),
    "root_compression_place": (
        (*OVER_CYCLE, "index"),
        "1",
        "indices of the largest compression, as of root_tension_place",
    ),
    "root_stress_ratio": (
        ("torque", "gear"),
        "1",
        "smallest over largest stress in a whole turn, at the place of the largest tension of a tooth",
    ),
}
"""Numbers of both gears that a result has where its scene asks for root stress."""
PLACE = "tooth", "side", "station", "along"
"""What the axis ``index`` counts."""

ON_FILLETS: dict[str, Part] = {
    "root_angle": (("side", "station"), "rad", "angle of the fillet tangent to the middle line of the tooth"),
    "root_point": (("side", "station"), "mm", "places in the frame of the tooth"),
    "root_stress_at_tension": (("torque", "side", "station"), "MPa", "stress of the tooth with the largest tension"),
    "root_stress_largest": (("torque", "side", "station"), "MPa", "largest stress of a tooth in a whole turn"),
    "root_stress_smallest": (("torque", "side", "station"), "MPa", "smallest stress of a tooth in a whole turn"),
}
"""Arrays of each gear over both sides of a tooth, stations along the fillet and places along the face."""
ROOT_MAPS: dict[str, Part] = {
    f"{gear}_{name}": ((*axes, f"{gear}_along", *(("vector",) if name == "root_point" else ())), unit, text)
    for gear in GEARS
    for name, (axes, unit, text) in ON_FILLETS.items()
}
"""The same by their names in a file; places along the face are as many as the width of each gear asks for."""
ROOT_PARTS = ROOT_QUANTITIES | ROOT_MAPS

HALF_QUANTITIES: dict[str, Part] = {
    "mid_face": (
        ("gear",),
        "mm",
        "axial place of the middle of the face of a half in the double helical gear, from the middle of its groove; "
        "half a lies at positive places, half b, whose result is that of its mirror image, at negative ones",
    ),
}
"""Numbers of both gears that the result of a half of a double helical pair has."""

MOTION = (*CYCLE, "motion")
SUPPORT_QUANTITIES: dict[str, Part] = {
    "pinion_motion": (
        MOTION,
        "mm, rad",
        "motion of the middle of the pinion's face on its axis: along x, y, z and about them, axes of the fixed frame",
    ),
    "wheel_motion": (MOTION, "mm, rad", "motion of the middle of the wheel's face on its axis, as of pinion_motion"),
    "misalignment": (
        CYCLE,
        "um",
        "misalignment F_beta of the motions over the common face, signs as of mounting.misalignment_um; NaN for bevel "
        "gears",
    ),
    "wind_up": (
        CYCLE,
        "rad",
        "part of the transmission error that comes from the rotation of both gears against the ends of their shafts",
    ),
    "drive_stiffness": (
        CYCLE,
        "N/(mm um)",
        "drive stiffness: mesh stiffness that includes the compliance of the supports",
    ),
    **{
        f"{gear}_support_load": (
            ("torque", f"{gear}_support"),
            "N, N mm",
            f"forces along x, y, z and moments about them at each station; the {gear} is moved by the motions that "
            f"they cause before the contact is traced; axes of the {gear}'s own frame",
        )
        for gear in GEARS
    },
}
"""Numbers that a result has where its scene has supports."""
BEARING_QUANTITIES: dict[str, Part] = {
    f"{gear}_bearing_force": (
        (*CYCLE, f"{gear}_bearing", "motion"),
        "N, N mm",
        f"forces along x, y, z and moments about them on the bearings of the {gear}, axes of the {gear}'s own frame",
    )
    for gear in GEARS
}
"""Numbers that a result has of each gear with a shaft."""
ROLLING_QUANTITIES: dict[str, Part] = {
    name.format(gear): ((*axes, f"{gear}_bearing", *last), unit, text.format(gear))
    for gear in GEARS
    for name, axes, last, unit, text in (
        (
            "{}_bearing_motion",
            CYCLE,
            ("motion",),
            "mm, rad",
            "motion of the shaft of the {0} in its bearings: along x, y, z and about them, axes of the {0}'s own frame",
        ),
        (
            "{}_element_force",
            CYCLE,
            (),
            "N",
            "largest force of a rolling element of the {}'s bearings; NaN for linear bearings",
        ),
        (
            "{}_element_pressure",
            CYCLE,
            (),
            "MPa",
            "largest contact pressure of a rolling element at the inner ring of the {}'s bearings",
        ),
        (
            "{}_bearing_life",
            ("torque",),
            (),
            "1e6 revolutions",
            "basic reference rating life after ISO/TS 16281 at the mean motion of the {}'s bearings; inf without load",
        ),
    )
}
"""Numbers that a result has of each gear whose shaft has rolling bearings."""
MOTIONS = 6
"""Length of the axis ``motion``."""

PATH_PARTS: dict[str, Part] = {
    "pinion_angle": ((), "rad", "angle of the pinion phi1"),
    "wheel_angle": ((), "rad", "unloaded angle of the wheel phi2"),
    "transmission_error": ((), "rad", "unloaded transmission error, absolute"),
    "point": (("vector",), "mm", "unloaded contact point in the fixed frame"),
    "normal": (("vector",), "1", "unit normal out of the pinion"),
    "pinion_radius": ((), "mm", "radius of the contact point on the pinion"),
    "pinion_axial": ((), "mm", "axial coordinate of the contact point on the pinion"),
    "wheel_radius": ((), "mm", "radius of the contact point on the wheel"),
    "wheel_axial": ((), "mm", "axial coordinate of the contact point on the wheel"),
    "pinion_lever": ((), "mm", "torque of a unit normal force about the axis of the pinion"),
    "wheel_lever": ((), "mm", "torque of a unit normal force about the axis of the wheel"),
    "in_contact": ((), "1", "whether the tooth pair is in contact"),
    "on_edge": ((), "1", "whether the unloaded contact lies on an edge of a flank"),
    "on_relief_start": ((), "1", "whether the unloaded contact lies on the start of a linear relief"),
    "on_line": ((), "1", "whether the unloaded contact is a line"),
    "line_ends": (("end", "vector"), "mm", "ends of the line in the fixed frame"),
    "edges": (("edge",), "1", "edges that hold the point, pinion then wheel: tip, root, lower (toe), upper (heel)"),
    "iterations": ((), "1", "Newton steps of the unloaded contact"),
    "residual": ((), "1", "sine of the angle between the two normals"),
}
"""Parts of a contact path; each has the dimension position before its own."""

MAP_PARTS: dict[str, Part] = {
    "x": (("across",), "mm", "cell centres across the contact, from the contact point"),
    "y": (("along",), "mm", "cell centres along the contact, from the contact point"),
    "spacing": (("axis",), "mm", "cell sizes across and along"),
    "pressure": (
        ("across", "along"),
        "MPa",
        "contact pressure; in cells that an edge cuts the mean over the whole cell",
    ),
    "gap": (
        ("across", "along"),
        "mm",
        "deformed gap, infinite where a flank ends before the middle of the cell",
    ),
    "cover": (("across", "along"), "1", "part of the cell that has material"),
    "origin": (("vector",), "mm", "contact point in the fixed frame"),
    "force_line": (("along",), "mm", "place of the force of each slice across the contact, from the contact point"),
    "axes": (("row", "vector"), "1", "directions across, along and normal out of the pinion, in rows"),
}
"""Parts of a pressure map."""
MAP_LOADS: dict[str, Part] = {
    "strip_force": (
        ("columns", "strip"),
        "N",
        "force in each strip of the common face, on columns graded towards rounded ends and on coarser ones; NaN: that "
        "of the cells",
    ),
}
"""Parts of those pressure maps alone whose contacts end on the arc of a rounded edge."""
SIZES = {"axis": 2, "row": 3, "vector": 3, "columns": 2, "strip": 30}
"""Lengths of dimensions that are the same in every map."""

MAP_CELLS: dict[str, Part] = {
    f"map_cells_{axis}": (PAIRS, "1", f"cells of the pressure map {axis} the contact; 0: no map")
    for axis in ("across", "along")
}
"""How many values each map has in the arrays of all maps."""
LAID_END_TO_END = {("across",): ("across",), ("along",): ("along",), ("across", "along"): ("cell",)}
"""Dimensions of parts of unlike sizes -> the one dimension over which a file has those of all maps, one after another:
torque by torque, position by position, pair by pair, each map row by row."""
IN_FILES: dict[str, Part] = {
    **{f"path_{name}": (("path", "position", *own), unit, text) for name, (own, unit, text) in PATH_PARTS.items()},
    **MAP_CELLS,
    **{
        f"map_{name}": (LAID_END_TO_END.get(own, (*PAIRS, *own)), unit, text)
        for name, (own, unit, text) in MAP_PARTS.items()
    },
}
"""What a file has beside ``QUANTITIES``: the paths, that of the leading contact before those of the pairs; the maps."""
IN_SOME_FILES: dict[str, Part] = {
    f"map_{name}": ((*PAIRS, *own), unit, text) for name, (own, unit, text) in MAP_LOADS.items()
}
"""What a file has beside these, if a map has it."""

RACK_QUANTITIES: dict[str, Part] = {
    "rack_travel": (
        ("position",),
        "mm",
        "travel of the rack without errors, r_1 phi1, from where tooth pair 0 touches at the pitch point",
    ),
    "rack_transmission_error": Number(
        CYCLE, "mm", "loaded transmission error along the rack, absolute", column="rack_transmission_error_um"
    ),
    "rack_force": Number(("torque",), "N", "mean force along the rack, without friction", label="force along the rack"),
}
"""Numbers that a result has where the wheel is a rack; its rotations are those of the gear that stands for the rack."""

ROOTS_ASKED = Asked(
    lambda scene, _: scene.analysis.root_stress, "the result has no root stress; set analysis.root_stress = true"
)
SUPPORTS_ASKED = Asked(
    lambda scene, _: scene.is_supported, "the scene has no supports; [pinion.support] or [wheel.support] gives them"
)
SHAFT_ASKED = Asked(
    lambda scene, gear: getattr(scene, gear).shaft is not None, "the gear has no shaft; [{gear}.shaft] gives it"
)
ROLLING_ASKED = Asked(  # which a file has where the scene does
    lambda *_: False, "the gear has no rolling bearings; type of [[{gear}.shaft.bearings]] gives them"
)
RACK_ASKED = Asked(
    lambda scene, _: scene.rack_radius is not None, 'the wheel is no rack; wheel.teeth = "rack" makes it one'
)
HALF_ASKED = Asked(lambda *_: False, "the result is not one of a half of a double helical pair")
"""When a result has numbers of root stress, of supports, of shafts, of rolling bearings, of racks and of halves."""
OF_SUPPORTS = {
    **numbers(SUPPORT_QUANTITIES, SUPPORTS_ASKED),
    **numbers(BEARING_QUANTITIES, SHAFT_ASKED),
    **numbers(ROLLING_QUANTITIES, ROLLING_ASKED),
}
ROOT_STRESS = numbers(ROOT_PARTS, ROOTS_ASKED)
OF_RACKS = numbers(RACK_QUANTITIES, RACK_ASKED)
OF_A_HALF = numbers(HALF_QUANTITIES, HALF_ASKED)
CYCLE_NUMBERS = numbers(QUANTITIES) | OF_SUPPORTS | ROOT_STRESS | OF_RACKS | OF_A_HALF
"""All numbers of mesh cycles by their names: those that all have, of supports, of root stress, of racks, of halves."""
