"""What must hold of racks and of double helical pairs beside what holds of all scenes.

A rack is the limit of a wheel with more and more teeth. Two equal halves are one under half the torque; halves change
places in a mirror across the axes; forces along the axes balance; the flanks of both halves close by one rotation.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from loaded_tca import MeshCycle
from loaded_tca.arrays import Array
from loaded_tca.gears.rack import RACK_TEETH
from loaded_tca.scene.double_helical import DoubleHelicalScene
from validation.halves import HalvesAsPairs, Renamed
from validation.invariances import (
    ENERGY,
    SAME_STEPS,
    SAME_TORQUE,
    SOLVED_ANEW,
    Off,
    Subject,
    analysed,
    difference,
    of_pairs,
    span,
    stored_in,
    told,
)
from validation.scene_transforms import as_wheel, half_alone, halves_exchanged

WHEEL_TEETH = 5_000, 10_000
"""Of two wheels in a scene, the second with twice the teeth of the first and the most that a scene allows."""
EXACT = 1e-9
"""Of forces that follow from each other in closed form."""


def rack_as_wheel(subject: Subject) -> Off:
    """The rack as the limit of wheels of very many teeth, by contact alone: bodies below the teeth are unlike ones.

    What a wheel has differs from the limit by a part of one over its teeth, which two wheels tell.
    """
    changes = {"analysis.compliance": "contact", "mounting.in_plane_deg": 0.0}
    scene = subject.scene.with_changes(changes)
    wheels = [analysed(as_wheel(scene, teeth)) for teeth in WHEEL_TEETH]
    limit: Any = Renamed(wheels[-1])
    limit.pair = np.union1d(*(wheel.pair for wheel in wheels))
    for name in ("load_share", "peak_pressure"):
        near, nearest = (of_pairs(wheel, name, limit.pair) for wheel in wheels)
        setattr(limit, name, 2.0 * nearest - near)
    near, nearest = (
        wheel.transmission_error * teeth / RACK_TEETH  # the same travel
        for wheel, teeth in zip(wheels, WHEEL_TEETH, strict=True)
    )
    limit.transmission_error = 2.0 * nearest - near
    return difference(analysed(scene), limit, SOLVED_ANEW)


def _double_helical(subject: Subject) -> DoubleHelicalScene:
    assert isinstance(subject.scene, DoubleHelicalScene)
    return subject.scene


EQUAL = {"pinion.half_b": None, "wheel.half_b": None, "mounting.half_b": None, "pair.apex_offset_mm": 0.0}
"""Changes that leave both halves alike, with those of the errors that move the whole wheel against both."""
ALIKE = EQUAL | {f"mounting.{name}": 0.0 for name in ("in_plane_deg", "out_of_plane_deg", "misalignment_um",
                                                     "axial_offset_mm")}  # fmt: skip


def equal_halves(subject: Subject) -> Off:
    """Two halves that are alike are one of them, a helical pair, under half the torque.

    Where faces are unlike, the wheel of the half stands beside its pinion, which turns its helix: there transmission
    errors count from the first one.
    """
    scene: Any = subject.scene.with_changes(ALIKE)
    alone, both = analysed(half_alone(scene)), analysed(scene)
    peaks, behind = np.nan_to_num(alone.peak_pressure).max(axis=-1), both.transmission_error - alone.transmission_error
    if scene.pinion.face_width_mm != scene.wheel.face_width_mm:
        behind = behind - behind[0, 0]
    return {
        "transmission error": float((np.abs(behind) / span(alone)).max()) / SAME_TORQUE[0],
        "load share": float(np.abs(both.load_share - 0.5).max()) / SAME_TORQUE[1],
        "peak pressure": float((np.abs(both.peak_pressure - peaks[..., None]) / peaks.max()).max()) / SAME_TORQUE[2],
        "mesh stiffness": float(np.abs(both.mesh_stiffness / alone.mesh_stiffness - 1.0).max()) / SAME_TORQUE[2],
    }


def halves_in_each_others_place(subject: Subject) -> Off:
    """In a mirror across the axes: half a is what half b was, and all that points along the axis turns round."""
    other: Any = analysed(halves_exchanged(subject.scene))
    turned: Any = HalvesAsPairs(other.of_pair, turned=True)
    return difference(subject.result, turned, SOLVED_ANEW)


def pitch_later_in_both_halves(subject: Subject) -> Off:
    """The last position of a pitch is its first one."""
    result: Any = subject.result
    ends = {name: np.ptp(getattr(result, name)[:, [0, -1]], axis=1) for name in ("load_share", "peak_pressure")}
    moved = np.ptp(result.transmission_error[:, [0, -1]], axis=1) / span(result)[:, 0]
    return {
        "transmission error": float(moved.max()) / SAME_STEPS,
        "load share": float(ends["load_share"].max()) / SAME_STEPS,
        "peak pressure": float(ends["peak_pressure"].max() / result.peak_pressure.max()) / SAME_STEPS,
    }


def axial_forces_balanced(subject: Subject) -> Off:
    """Forces along the axis: of each half as its torque and helix angle have it; both hold what the support gives."""
    scene, result = _double_helical(subject), subject.result
    pinion, shares, data = scene.mesh().pinion, np.asarray(result.load_share), _data(result)
    torque = np.asarray(result.torque)[:, None, None]
    forces = shares * torque * np.tan(abs(pinion.helix_angle)) / pinion.reference_radius
    largest = float(forces.max())
    motion, left = np.asarray(data["axial_motion"]), np.asarray(data["axial_force_left"])
    stiffness = 1e3 * scene.geometry.axial_stiffness_N_per_um
    off = {
        "shares": float(np.abs(shares.sum(axis=-1) - 1.0).max()) / EXACT,
        "force of a half": float(np.abs(np.abs(np.asarray(data["axial_force"])) - forces).max()) / largest / EXACT,
        "force that is left": float(np.abs(np.abs(left) - stiffness * np.abs(motion)).max()) / largest / EXACT,
    }
    if scene.geometry.floating == "none":
        off.pop("force that is left")
        off["motion"] = float(np.abs(motion).max()) / EXACT
    return off


def _data(result: MeshCycle) -> Any:
    """Dataset of both halves together."""
    return result.dataset


def halves_close_together(subject: Subject) -> Off:
    """Each half by itself, under what it carries and where the gears stand, is behind by as much as the other.

    The wheel of a half stands beside its pinion by the motion and by the offset of the apex: teeth that are moved
    along the axis, and faces with them by as little. What an axis error moves the middles of both halves by is left
    out, so that scenes have none across the plane.
    """
    scene, result = _double_helical(subject), subject.result
    shares = np.asarray(result.load_share)[-1]
    if scene.out_of_plane_deg != 0.0 or (shares <= 0.0).any():
        return {}
    n = int(np.abs(shares[:, 0] - 0.5).argmax())  # the position where they differ most
    toward = {"pinion": -1.0}.get(scene.geometry.floating, 1.0)
    way = toward * float(_data(result)["axial_motion"][-1, n])
    along = scene.mounting.axial_offset_mm + scene.geometry.apex_offset_mm + way
    halves: Sequence[Any] = scene.half_scenes(along, [[1e-3 * result.torque[-1] * share] for share in shares[n]])
    behind = np.array([analysed(half).transmission_error[0, n] for half in halves])
    allowed = SOLVED_ANEW[0] + float(told(result)[-1, n])
    return {"transmission error": float(np.ptp(behind)) / float(span(result)[-1, 0]) / allowed}


def energy_kept_in_both_halves(subject: Subject) -> Off:
    """The work of the wheel's moment from three quarters of a torque to five quarters is what both halves store."""
    torques = 1e-3 * max(subject.scene.torques) * np.array([0.75, 1.0, 1.25])
    result: Any = analysed(subject.scene.with_changes({"analysis.torques_Nm": torques.tolist()}))
    if result.notes_of_places():
        return {}
    halves = result.of_pair.halves
    moment = np.sum([_wheel_moment(half) for half in halves], axis=0)
    rotation = -result.gear_pair.driving * np.asarray(result.transmission_error)
    between = (moment[2] - moment[0]) * (rotation[0] + 4.0 * rotation[1] + rotation[2]) / 6.0
    work = moment[2] * rotation[2] - moment[0] * rotation[0] - between
    solved = [half for half in halves if half.states is not None]  # two that are alike are solved once
    stored = sum(stored_in(half) for half in solved) * 2.0 / len(solved)
    allowed = ENERGY + np.max([told(half).max(axis=0) for half in halves], axis=0)
    return {"work": float((np.abs((stored[2] - stored[0]) / work - 1.0) / allowed).max())}


def _wheel_moment(result: MeshCycle) -> Array:
    """Moment of the normal forces about the axis of the wheel (torque, position) [N mm]."""
    levers = np.stack([path.wheel_lever for path in result.paths], axis=-1)
    return np.asarray(np.nansum(result.normal_force * levers, axis=-1))
