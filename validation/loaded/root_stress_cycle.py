"""Root stress of both gears over the loaded mesh beside finite elements in plane strain.

Source: the kept runs of ``validation.calculix`` with fine fillets, spur 25/37 under 100 N m on 20 mm, unmodified and
with tip relief. The loads are those of the package's own mesh cycle of a face of 100 mm, as those of
``validation.calculix.mesh_cycle``; the stress under each is that of one section of the package's root stress model in
plane strain.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance.root_stress import DENSITY
from loaded_tca.errors import AccuracyWarning
from loaded_tca.loaded.cycle import AllPairsCycle, solve_cycles
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import trace_teeth
from validation.calculix.case import FACE_WIDTH, line_load
from validation.calculix.comparison import GRID, Model, model
from validation.calculix.root_campaign import TORQUE
from validation.calculix.tables import ROOTS_FILE, read_table
from validation.loaded.root_stress import plane_curves
from validation.table import Row

SOURCE = "finite elements, plane strain (CalculiX)"
WIDE = 100.0
"""Face [mm] whose free ends matter little."""
OF_THE_MAXIMUM = 0.02
"""Asked: difference over the largest of the cycle."""
GEARS = ("pinion", "wheel")
SIGNS = {"tension": 1.0, "compression": -1.0}


@dataclass(frozen=True)
class Load:
    """Load of a section on one tooth of a gear.

    Attributes
    ----------
    tooth : int
        Counted in the sense of +theta.
    radius : float [mm]
    line_load : float [N/mm]
    """

    tooth: int
    radius: float
    line_load: float


Cycle = dict[tuple[str, str], Array]
"""Stress (positions,) [MPa] and its tangent angle [deg] by gear and sign."""


@dataclass(frozen=True)
class RootCycle:
    """Largest tension and compression of both gears over the mesh.

    Attributes
    ----------
    pinion_angle : (n,) array [rad]
    stress, angle : dict of (n,) arrays [MPa], [deg]
        By gear and "tension" or "compression".
    """

    pinion_angle: Array
    stress: Cycle
    angle: Cycle

    def every(self, step: int) -> RootCycle:
        """The cycle at every so many positions."""
        stress, angle = ({key: values[::step] for key, values in one.items()} for one in (self.stress, self.angle))
        return RootCycle(self.pinion_angle[::step], stress, angle)


def read_roots(path: Path = ROOTS_FILE) -> dict[str, RootCycle]:
    """Kept cycles by variant; none where the table is missing."""
    table = read_table(path) if path.exists() else []
    cycles = {}
    for variant in dict.fromkeys(str(row["variant"]) for row in table):
        own = {
            gear: sorted(
                (r for r in table if (r["variant"], r["gear"]) == (variant, gear)), key=lambda r: r["position"]
            )
            for gear in GEARS
        }
        stress, angle = (
            {(g, s): np.array([float(row[f"{s}_{unit}"]) for row in own[g]]) for g in GEARS for s in SIGNS}
            for unit in ("MPa", "angle_deg")
        )
        cycles[variant] = RootCycle(np.array([float(r["pinion_angle_rad"]) for r in own[GEARS[0]]]), stress, angle)
    return cycles


def root_cycle(ours: Model, variant: str, angles: Array) -> RootCycle:
    """Stress of the package at pinion angles (n,) [rad]."""
    loads = section_loads(ours, variant, angles)
    pair = ours.pairs["unmodified"]
    stress, angle = {}, {}
    for gear, name, of_gear in zip((pair.pinion, pair.wheel), GEARS, zip(*loads, strict=True), strict=True):
        for sign, found in _extremes(gear, of_gear).items():
            stress[name, sign], angle[name, sign] = found
    return RootCycle(angles, stress, angle)


def section_loads(ours: Model, variant: str, angles: Array) -> list[tuple[list[Load], list[Load]]]:
    """Loads on the teeth of pinion and wheel at every position, per length of face."""
    pair = ours.pairs[variant]
    torque = 1e3 * TORQUE * ours.face_width / FACE_WIDTH
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # tip corners in contact
        carried = solve_cycles(
            [AllPairsCycle(pair, trace_teeth(pair, angles), np.array([torque]), GRID, ours.bending)]
        )[0]
    whole = line_load(TORQUE)
    loads = []
    for contacts, shares in zip(carried.contacts[0], carried.share[0], strict=True):
        pinion, wheel = [], []
        for number, contact, share in zip(carried.pairs.tolist(), contacts, shares, strict=True):
            if contact is None or share <= 0.0:
                continue
            radii = _radii(pair, contact)
            for found, tooth, radius in zip((pinion, wheel), (-number, number), radii, strict=True):
                found.append(Load(pair.sense * tooth, radius, float(share) * whole))
        loads.append((pinion, wheel))
    return loads


def _radii(pair: GearPair, contact: LoadedContact) -> tuple[float, float]:
    """Where the force of the whole contact acts on the flanks of pinion and wheel."""
    separation, pressure = contact.separation, contact.solution.pressure
    x = float(separation.x @ pressure.sum(axis=1)) / float(pressure.sum())
    point = separation.origin + x * separation.axes[0]
    radius, _, _ = pair.to_wheel(point)
    return float(np.hypot(point[0], point[1])), float(radius)


def _extremes(gear: Gear, loads: Sequence[list[Load]]) -> dict[str, tuple[Array, Array]]:
    """Largest stress [MPa] of every position and its tangent angle [deg], of loaded teeth and their neighbours."""
    section = replace(DENSITY, lengthwise=1)
    radii = np.array([load.radius for position in loads for load in position])
    near = range(-section.neighbours, section.neighbours + 1)
    curves = {away: plane_curves(gear, section, radii, away) for away in near}
    angle = [np.degrees(side.angle) for side in curves[0]]
    found: dict[str, list[tuple[float, float]]] = {sign: [] for sign in SIGNS}
    first = 0
    for position in loads:
        teeth = {load.tooth + beside for load in position for beside in (-1, 0, 1)}
        stress = [
            sum(
                load.line_load * curves[load.tooth - tooth][side].stress[:, first + n]
                for n, load in enumerate(position)
                if load.tooth - tooth in near
            )
            for tooth in teeth
            for side in (0, 1)
        ]
        first += len(position)
        for sign, factor in SIGNS.items():
            best = max(range(len(stress)), key=lambda k: (factor * stress[k]).max())
            place = int((factor * stress[best]).argmax())
            found[sign].append((float(stress[best][place]), float(angle[best % 2][place])))
    return {sign: tuple(np.array(values).T) for sign, values in found.items()}


def rows() -> list[Row]:
    """Rows of every kept cycle."""
    return _rows_of_kept(read_roots())


def short_rows() -> list[Row]:
    """Rows of the one with tip relief, at every third position."""
    kept = read_roots()
    return _rows_of_kept({"tip_relief": kept["tip_relief"].every(3)} if kept else {})


def _rows_of_kept(kept: dict[str, RootCycle]) -> list[Row]:
    if not kept:
        return []
    ours = model(WIDE)
    return [
        row
        for variant, cycle in kept.items()
        for row in rows_of(variant, cycle, root_cycle(ours, variant, cycle.pinion_angle))
    ]


def rows_of(variant: str, kept: RootCycle, ours: RootCycle) -> Iterator[Row]:
    """Largest stress of the cycle, and the largest difference at any position over it."""
    case = f"root stress over the mesh, {variant.replace('_', ' ')}, {TORQUE:g} N m"
    for (gear, sign), values in kept.stress.items():
        factor, found = SIGNS[sign], ours.stress[gear, sign]
        highest = factor * (factor * values).max()
        yield Row(
            case, SOURCE, f"{gear}, {sign}, largest [MPa]", highest, factor * (factor * found).max(), OF_THE_MAXIMUM
        )
        apart = np.abs(found - values) / abs(highest)
        note = f"position {int(apart.argmax())}"
        words = f"{gear}, {sign}, largest difference of {len(values)} positions, of the largest"
        yield Row(case, SOURCE, words, 0.0, float(apart.max()), OF_THE_MAXIMUM, note=note)
