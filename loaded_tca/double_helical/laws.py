"""What both halves give way by, read off their mesh cycles or revolutions, and their balance under any torques."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy

from loaded_tca.arrays import Array
from loaded_tca.double_helical.balance import HalfLaw, Halves, Shares, shared
from loaded_tca.errors import GeometryError, named
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results import MeshCycle, Revolution
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.double_helical import HALVES, DoubleHelicalScene


def gears_of(cycle: MeshCycle | Revolution) -> GearPair:
    """The gears of a half in space."""
    return cycle.gear_pair if isinstance(cycle, MeshCycle) else cycle.scene.pair()


def half_law(cycle: MeshCycle | Revolution, axial_rate: float) -> HalfLaw:
    """How far the flanks of a half give way at the base circle, without what its axial offset brings together."""
    scene, pair = cycle.scene, gears_of(cycle)
    of_cycle = isinstance(cycle, MeshCycle)
    unloaded = cycle.unloaded_transmission_error if of_cycle else cycle.rigid_transmission_error
    assert isinstance(scene, CylindricalScene)
    offset = scene.mounting.axial_offset_mm
    length = -pair.driving * pair.base_radii[1]
    deflection = length * cycle.transmission_error
    stiffness = cycle.drive_stiffness if scene.is_supported else cycle.mesh_stiffness
    if not np.isfinite(deflection).all():
        raise GeometryError("its flanks are out of contact at some positions; there it cannot share a torque")
    return HalfLaw(
        force=cycle.torque / pair.base_radii[0],
        deflection=deflection - axial_rate * offset,
        compliance=1.0 / (1e3 * cycle.face_width * stiffness),
        unloaded=length * unloaded - axial_rate * offset,
    )


def axial_stiffness(scene: DoubleHelicalScene) -> float:
    """Stiffness of the axial support of the floating gear [N/mm]; 0: nothing holds it, inf: none floats."""
    geometry = scene.geometry
    return math.inf if geometry.floating == "none" else 1e3 * geometry.axial_stiffness_N_per_um


def balance_of(
    scene: DoubleHelicalScene,
    cycles: Sequence[MeshCycle | Revolution],
    torques: Array,
    moved: tuple[Array, Array] | None = None,
    coupling: float | Array = 0.0,
) -> Shares:
    """Balance of both halves under pinion torques (t,) [N mm] of both, above 0.

    Parameters
    ----------
    scene : DoubleHelicalScene
    cycles : two of MeshCycle, or of Revolution
        Of the halves.
    torques : (t,) array [N mm]
    moved : two arrays (n,) [mm], optional
        By how much the flanks of both halves part by shafts beside what their mesh cycles have.
    coupling : float, or (n,) array [mm/N]
        How far the flanks of each half give way under a unit force on the other.
    """
    laws = []
    for name, cycle in zip(HALVES, cycles, strict=True):
        with named(f"half {name}"):
            laws.append(half_law(cycle, scene.axial_rate))
    total = np.asarray(torques) / scene.mesh().pinion.base_radius
    parted: tuple[float | Array, float | Array] = scene.parted
    if moved is not None:
        parted = parted[0] + moved[0], parted[1] + moved[1]
    return shared(Halves((laws[0], laws[1]), parted, scene.axial_rate, axial_stiffness(scene), coupling), total)


def between_torques(nodes: Array, values: Array, torques: Array, known_at_zero: bool) -> Array:
    """Numbers (t, n) under torques (t, n), between those (k, n) under the torques of a mesh cycle."""
    if known_at_zero:
        nodes, values = np.append(0.0, nodes), np.concatenate([np.zeros_like(values[:1]), values])
    elif len(nodes) == 1:
        return np.broadcast_to(values, torques.shape)
    inside = np.clip(torques, nodes[0], nodes[-1])
    numbers = np.full_like(inside, math.nan)
    for n in np.flatnonzero(np.isfinite(values).all(axis=0)):  # a pitch of one position has no load factors
        numbers[:, n] = scipy.interpolate.PchipInterpolator(nodes, values[:, n])(inside[:, n])
    return numbers
