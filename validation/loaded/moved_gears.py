"""Gears on supports by rigid analyses alone: the wheel is set where the loads move it, until nothing moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from loaded_tca.arrays import Array
from loaded_tca.compliance import model_of
from loaded_tca.loaded.cycle import AllPairsCycle, solve_cycles
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.scene import Scene
from loaded_tca.unloaded import trace_teeth

STEPS, SETTLED = 60, 1e-8
"""Rigid analyses at the most; change of the motions [mm, rad over 1/mm] that is none."""


@dataclass(frozen=True)
class Settled:
    """Transmission error [rad], and motions (2, 6) of pinion and wheel in the fixed frame [mm, rad]."""

    transmission_error: float
    motions: Array


Law = Array | Callable[[Array], Array]


def settled(
    scene: Scene,
    compliances: tuple[Law, Law],
    grid: GridChoice,
    relaxation: float = 1.0,
    change: float = SETTLED,
    angle: float = 0.0,
) -> Settled:
    """Rigid analyses at a pinion angle with a wheel that is moved by what the loads move both gears.

    ``compliances``: (6, 6) of the middles of the faces, in the axes of each gear's own frame, or motions (6,) by loads
    (6,). ``change``: of the motions that is none.
    """
    pair = scene.pair()
    none = [f"{gear}.{section}" for gear in ("pinion", "wheel") for section in ("support", "shaft")]
    bending = model_of(scene.with_changes(dict.fromkeys(none)), pair, 3)
    torque = np.array(scene.torques[:1])
    axes = np.eye(3), pair.wheel_axes
    middles = [np.zeros(3), pair.wheel_origin] + np.array(scene.face_middles)[:, None] * [own[2] for own in axes]
    motions = np.zeros((2, 6))
    for _ in range(STEPS):
        pinion, wheel = (Rotation.from_rotvec(motion[3:]).as_matrix() for motion in motions)
        origin = middles[1] + motions[1, :3] + wheel @ (pair.wheel_origin - middles[1])
        origin = pinion.T @ (origin - middles[0] - motions[0, :3]) + middles[0]
        moved = replace(pair, wheel_origin=origin, wheel_axes=pair.wheel_axes @ wheel.T @ pinion)
        teeth = None if bending is None else bending.mounted(moved)
        carried = solve_cycles([AllPairsCycle(moved, trace_teeth(moved, np.array([angle])), torque, grid, teeth)])[0]
        loads = np.zeros((2, 6))
        at = [middles[0], moved.wheel_origin + scene.face_middles[1] * moved.wheel_axes[2]]
        for one in carried.contacts[0][0]:
            if one is not None:
                area, place = one.separation.spacing[0] * one.separation.spacing[1], one.separation
                forces = one.solution.pressure.sum(axis=0) * area
                points = place.origin + np.outer(place.force_line, place.axes[0]) + np.outer(place.y, place.axes[1])
                for gear, sign in enumerate((-1.0, 1.0)):
                    force = sign * np.outer(forces, place.axes[2])
                    moment = np.cross(points - at[gear], force)
                    loads[gear] += np.concatenate([force.sum(axis=0), moment.sum(axis=0)])
        new = np.empty((2, 6))
        for gear, (own, compliance) in enumerate(zip(axes, compliances, strict=True)):
            turned = np.kron(np.eye(2), own)
            own_loads = np.kron(np.eye(2), own @ pinion) @ loads[gear]  # the moved pair's frame turns with the pinion
            moved_by = compliance(own_loads) if callable(compliance) else compliance @ own_loads
            new[gear] = turned.T @ moved_by
        changed = float(np.abs(new - motions).max())
        motions = motions + relaxation * (new - motions)
        if changed < change:
            error = float(carried.path.transmission_error[0] - pair.driving * carried.rotation[0, 0])
            return Settled(error, new)
    raise AssertionError(f"oracle not settled: {changed:.1e}")
