"""A loaded pinion in a ring by finite elements of several teeth in plane strain.

Both sections are triangulated in their true form (``plane_teeth``). Unit forces on the nodes of a flank give the
compliance of all teeth that share the load: a gear is the same from each of its teeth, so that one fine tooth does.
At each position the flanks stand where exact involutes have them; forces on cells along the flanks balance the torque
where no cell penetrates. There are no half-spaces, no local terms, no friction; elements half as large move the
transmission error by less than 0.5 %, but where a tip corner has just come into contact.

The numbers are kept in ``data/internal_cycle.csv``, written by ``python -m validation.loaded.plane_pair`` (half a
minute).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from loaded_tca import parse_scene
from loaded_tca.gears import CylindricalGear, RingGear
from loaded_tca.scene import Scene
from validation.calculix.tables import provenance, read_table, write_table
from validation.loaded.plane_teeth import STEEL, PlaneTeeth, flank_angle

Array = NDArray[np.float64]

FILE = Path(__file__).parent / "data" / "internal_cycle.csv"
TEETH = 25, 60
LINE_LOADS = 50.0, 150.0  # N per mm of face, along the line of action
POSITIONS = 9
WIDE = 100.0  # mm
BESIDE = 2
"""Teeth beside the loaded one that may carry load, too."""
SHARES = tuple(f"share_{-k}" for k in range(-BESIDE, BESIDE + 1))
MOST_STEPS, PENETRATION = 200, 1e-9  # of the balance; in mm
STEPS = 0.04, 0.02
"""Nodes of the fine flank are half as far apart [mm]; the last ones are the reference."""
REACH = 0.7  # how far from the unloaded contact pressures may be [mm]
SCENE = """
title = "pinion in a ring"
[pair]
type = "cylindrical"
normal_module_mm = 3.0
[pinion]
teeth = 25
face_width_mm = 100.0
profile_shift = 0.3
[wheel]
teeth = -60
face_width_mm = 100.0
tip_diameter_mm = 175.2
outer_diameter_mm = 229.5
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 100.0
[analysis]
positions = 9
"""
RELIEF = {
    "pinion.modifications.tip_relief_um": 15.0,
    "pinion.modifications.tip_relief_start_mm": 79.5,
    "wheel.modifications.tip_relief_um": 15.0,
    "wheel.modifications.tip_relief_start_mm": 177.5,
}
VARIANTS: dict[str, dict[str, float]] = {"unmodified": {}, "tip relief": RELIEF}


def scene_of(variant: str, loads: tuple[float, ...] = LINE_LOADS) -> Scene:
    """Scene of a wide face under line loads [N/mm]."""
    scene = parse_scene(SCENE).with_changes(VARIANTS[variant])
    torques = [1e-3 * load * WIDE * scene.mesh().pinion.base_radius for load in loads]
    return scene.with_changes({"analysis.torques_Nm": torques})


@dataclass(frozen=True, eq=False)
class Flank:
    """A loaded flank of the fine tooth, and how all teeth give way to unit forces on it.

    Attributes
    ----------
    gear : CylindricalGear or RingGear
    roll : (n,) array [mm]
        Roll lengths of the nodes, rising.
    compliance : (teeth, n, n) array [mm per N/mm]
        Displacement along the normal of node j of the teeth -2 to 2, on the nodes of the fine one, under a force on
        node i of the fine tooth.
    """

    gear: CylindricalGear | RingGear
    roll: Array
    compliance: Array

    def between(self, loaded: int, other: int) -> Array:
        """Compliance (n, n) of a tooth under forces on another."""
        if other >= loaded:
            return np.asarray(self.compliance[BESIDE + other - loaded])
        return np.asarray(self.compliance[BESIDE + loaded - other].T)

    def at(self, roll: Array) -> Array:
        """Quadratic shape functions of all nodes (m, n) at roll lengths (m,); corners are the even nodes."""
        corners = self.roll[::2]
        element = np.clip(np.searchsorted(corners, roll) - 1, 0, len(corners) - 2)
        part = (roll - corners[element]) / (corners[element + 1] - corners[element])
        shapes = np.zeros((len(roll), len(self.roll)))
        values = (1.0 - part) * (1.0 - 2.0 * part), 4.0 * part * (1.0 - part), part * (2.0 * part - 1.0)
        for k, value in enumerate(values):
            shapes[np.arange(len(roll)), 2 * element + k] = value
        return shapes


def solved_flank(gear: CylindricalGear | RingGear, held_radius: float, fine_step: float) -> Flank:
    """Solve a section under unit forces on each node of the flank at the larger angle."""
    teeth = PlaneTeeth.of(gear, held_radius, fine_step)
    freedoms, places, normals = [], [], []
    for tooth in range(-BESIDE, BESIDE + 1):
        own, place, normal = _flank_nodes(teeth, tooth)
        freedoms.append(own)
        places.append(place)
        normals.append(normal)
    fine = BESIDE
    load = np.zeros((teeth.basis.N, len(places[fine])))
    for axis in range(2):
        load[freedoms[fine][axis], np.arange(len(places[fine]))] = normals[fine][axis]
    moved = teeth.displacement(load)
    compliance = []
    for own, place, normal in zip(freedoms, places, normals, strict=True):
        along = sum(normal[axis][:, None] * moved[own[axis]] for axis in range(2))
        compliance.append(np.stack([np.interp(places[fine], place, column) for column in along.T]))
    return Flank(gear, places[fine], np.stack(compliance))


def _flank_nodes(teeth: PlaneTeeth, tooth: int) -> tuple[NDArray[np.int64], Array, Array]:
    """Degrees of freedom (2, n), roll lengths (n,), normals into the tooth (2, n) of the nodes of its flank."""
    gear, turn = teeth.gear, 2.0 * math.pi * tooth / teeth.gear.tooth_count
    radii = np.sort([gear.tip_radius, gear.form_radius])

    def off(x: Array) -> Array:
        radius = np.hypot(*x)
        inside = (radius > radii[0] - 2e-3) & (radius < radii[1] + 2e-3)
        angle = np.arctan2(x[1], x[0]) - turn
        return np.where(inside, np.abs(angle - flank_angle(gear, radius)) * radius, np.inf)

    facets = teeth.mesh.facets_satisfying(lambda x: off(x) < 2e-3, boundaries_only=True)
    dofs = teeth.basis.get_dofs(facets)
    numbers = np.stack([np.concatenate([dofs.nodal[f"u^{k}"], dofs.facet[f"u^{k}"]]) for k in (1, 2)])
    x, y = teeth.basis.doflocs[:, numbers[0]]
    radius = np.hypot(x, y)
    roll = np.sqrt(radius**2 - gear.base_radius**2)
    order = np.argsort(roll)
    # the normal is tangent to the base circle: its foot lies behind the tooth's flank, or before that of a ring
    lean = np.arctan(roll / gear.base_radius)
    foot = np.arctan2(y, x) + (lean if isinstance(gear, RingGear) else -lean)
    return numbers[:, order], roll[order], np.stack([np.sin(foot), -np.cos(foot)])[:, order]


def flank_curve(gear: CylindricalGear | RingGear, roll: float, rolls: Array) -> tuple[Array, Array]:
    """Coordinates of a flank along the profile and along its normal at a roll length, away from the base circle."""
    start, angle = roll / gear.base_radius, rolls / gear.base_radius
    point = gear.base_radius * np.stack([np.cos(angle) + angle * np.sin(angle), np.sin(angle) - angle * np.cos(angle)])
    along, normal = np.array([math.cos(start), math.sin(start)]), np.array([math.sin(start), -math.cos(start)])
    origin = gear.base_radius * along + roll * normal
    return along @ (point - origin[:, None]), normal @ (point - origin[:, None])


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of a tooth pair: roll lengths on both flanks, gap [mm], shape functions of both."""

    tooth: int
    gap: Array
    shapes: tuple[Array, Array]


@dataclass(frozen=True)
class PlanePosition:
    """Angle [rad], transmission error at the ring's base circle [um], shares of five pairs, peak pressure [MPa]."""

    pinion_angle: float
    transmission_error: float
    shares: tuple[float, ...]
    pressure: float


class PlanePair:
    """Both gears with the flanks that carry."""

    def __init__(self, scene: Scene, fine_step: float) -> None:
        self.mesh = scene.mesh()
        pinion, ring = self.mesh.pinion, self.mesh.ring
        bore = 0.55 * pinion.root_radius
        self.flanks = solved_flank(pinion, bore, fine_step), solved_flank(ring, 0.5 * ring.outer_diameter, fine_step)
        self.cell = 0.5 * fine_step  # of the pressures along the flank [mm]: as far as nodes are apart
        self.between = float(self.mesh.path_of_contact.T2)  # of the feet of both normals

    def cells(self, angle: float, tooth: int, relief: tuple[tuple[float, float], ...]) -> Cells | None:
        """Cells about the unloaded contact of a tooth pair; None where it is out of reach."""
        turned = angle + 2.0 * math.pi * tooth / TEETH[0]
        roll = float(self.mesh.path_of_contact.C) + self.mesh.pinion.base_radius * turned
        rolls = roll, roll + abs(self.between)
        if roll < 4.0 * REACH:  # far below the flanks, at the base circle of the pinion
            return None
        places, gaps, sampled = np.arange(-REACH + 0.5 * self.cell, REACH, self.cell), [], []
        for flank, own in zip(self.flanks, rolls, strict=True):
            fine = np.arange(own - 4.0 * REACH, own + 4.0 * REACH, 2e-3)
            along, off = flank_curve(flank.gear, own, fine)
            sampled.append(np.interp(places, along, fine))
            gaps.append(np.interp(places, along, off))
        on = np.ones(len(places), dtype=bool)
        gap = gaps[1] - gaps[0]
        for k, (flank, own) in enumerate(zip(self.flanks, sampled, strict=True)):
            on &= (own > flank.roll[0]) & (own < flank.roll[-1])
            amount, start = relief[k]
            if amount:
                tip = flank.gear.roll_length(flank.gear.tip_radius)
                gap += amount * np.clip((own - start) / (tip - start), 0.0, 1.0) ** 2
        if not on.any():
            return None
        shapes = tuple(flank.at(own[on]) for flank, own in zip(self.flanks, sampled, strict=True))
        return Cells(tooth, gap[on], (shapes[0], shapes[1]))

    def position(self, angle: float, line_load: float, relief: tuple[tuple[float, float], ...]) -> PlanePosition:
        """Balance of all pairs at a pinion angle [rad], under a normal force per face width [N/mm]."""
        pairs = [one for k in range(-BESIDE, BESIDE + 1) if (one := self.cells(angle, k, relief)) is not None]
        compliance = np.block([[self._compliance(one, other) for other in pairs] for one in pairs])
        gap = np.concatenate([one.gap for one in pairs])
        force, approach = balanced(compliance, gap, line_load)
        owner = np.concatenate([np.full(len(one.gap), one.tooth) for one in pairs])
        shares = tuple(float(force[owner == k].sum() / line_load) for k in range(-BESIDE, BESIDE + 1))
        return PlanePosition(angle, -1e3 * approach, shares, float(force.max() / self.cell))

    def _compliance(self, one: Cells, other: Cells) -> Array:
        """Of cells of a pair under forces on those of another [mm per N/mm]; teeth of the mirrored ring count back."""
        matrix = np.zeros((len(one.gap), len(other.gap)))
        for k, (flank, sense) in enumerate(zip(self.flanks, (1, -1), strict=True)):
            nodes = flank.between(sense * other.tooth, sense * one.tooth)  # (loaded, observed)
            matrix += one.shapes[k] @ nodes.T @ other.shapes[k].T
        return matrix


def balanced(compliance: Array, gap: Array, total: float) -> tuple[Array, float]:
    """Forces (n,) that add up to a total and the approach [mm] where no cell penetrates, by active sets."""
    force = np.zeros(len(gap))
    active = gap < gap.min() + 0.02
    for _ in range(MOST_STEPS):
        count = int(active.sum())
        system = np.ones((count + 1, count + 1))
        system[:count, :count], system[count, count] = compliance[np.ix_(active, active)], 0.0
        system[:count, count] = -1.0
        solved = np.linalg.solve(system, np.append(-gap[active], total))
        if (solved[:count] < 0.0).any():
            active[np.flatnonzero(active)[solved[:count] < 0.0]] = False
            continue
        force[:] = 0.0
        force[active], approach = solved[:count], float(solved[count])
        penetrating = (gap + compliance @ force - approach < -PENETRATION) & ~active
        if not penetrating.any():
            return force, approach
        active |= penetrating
    raise ArithmeticError("the forces of the cells do not come into balance")


@cache
def solved(fine_step: float) -> PlanePair:
    """Both sections with nodes of half a step on the fine flanks."""
    return PlanePair(scene_of("unmodified"), fine_step)


def reliefs(variant: str) -> tuple[tuple[float, float], ...]:
    """Amount [mm] of the tip relief of both gears, and the roll length at which it starts [mm]."""
    mesh, changes = scene_of(variant).mesh(), VARIANTS[variant]
    found = []
    for name, gear in (("pinion", mesh.pinion), ("wheel", mesh.ring)):
        amount = 1e-3 * changes.get(f"{name}.modifications.tip_relief_um", 0.0)
        start = changes.get(f"{name}.modifications.tip_relief_start_mm")
        found.append((amount, gear.roll_length(0.5 * start) if start else 0.0))
    return tuple(found)


def angles() -> list[float]:
    """Pinion angles of a pitch, the pitch point in its middle [rad]."""
    return [float(one) for one in 2.0 * math.pi / TEETH[0] * np.linspace(-0.5, 0.5, POSITIONS)]


def measured(fine_step: float) -> Iterator[dict[str, float | str]]:
    """Rows of the kept table by elements of one size."""
    pair = solved(fine_step)
    for variant in VARIANTS:
        for load in LINE_LOADS:
            for index, angle in enumerate(angles()):
                place = pair.position(angle, load, reliefs(variant))
                yield {
                    "step_mm": fine_step,
                    "variant": variant,
                    "line_load_N_per_mm": load,
                    "position": index,
                    "pinion_angle_rad": angle,
                    "transmission_error_um": place.transmission_error,
                    "peak_pressure_MPa": place.pressure,
                    **{
                        f"share_{k}": share
                        for k, share in zip(range(BESIDE, -BESIDE - 1, -1), place.shares, strict=True)
                    },
                }


def keep(path: Path = FILE) -> None:
    """Solve with both sizes of elements, write the table."""
    notes = (
        "Spur pinion of 25 teeth (x 0.3) in a ring of 60 (tip diameter 175.2 mm), m 3 mm, alpha 20 deg, no backlash;",
        "pinion's root cut by a rack with h_fP 1.25 m and a tip rounding of 0.38 m, bore 0.55 x root diameter, held;",
        "arcs of 0.38 m at the root of the ring, outside 229.5 mm, held; eleven teeth of each;",
        f"E {STEEL.youngs_modulus:g} MPa, nu {STEEL.poisson_ratio:g}; plane strain, no friction.",
        "Tip relief: parabolic over the roll length, 15 um from 79.5 mm (pinion) and 177.5 mm (ring) on.",
        "Transmission error at the ring's base circle, negative: the ring lags; share_k: part of the load of tooth",
        "pair k, pair 0 at the pitch point at angle 0, pair k a pitch times k behind it.",
    )
    head = provenance("validation.loaded.plane_pair", notes, ())
    head[0] = head[0].replace("make reference-fem", "python -m validation.loaded.plane_pair")
    write_table(path, head, [row for step in STEPS for row in measured(step)])


def read(path: Path = FILE) -> dict[tuple[str, float], list[dict[str, float | str]]]:
    """Kept positions of the finest elements by variant and line load."""
    kept: dict[tuple[str, float], list[dict[str, float | str]]] = {}
    for row in read_table(path):
        if row["step_mm"] == STEPS[-1]:
            kept.setdefault((str(row["variant"]), float(row["line_load_N_per_mm"])), []).append(row)
    return kept


if __name__ == "__main__":
    keep()
