"""Positions of a loaded spur pair, kept from finite elements and computed here, in the same few numbers.

The finite elements are in plane strain. A face of the package has free ends, where the teeth deflect more. So it is
made wide, under the same line load, and pressures are read at mid-face.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from loaded_tca.compliance import MeshDensity, tooth_compliance
from loaded_tca.compliance.model import BendingModel
from loaded_tca.loaded.cycle import AllPairsCycle, CycleSolution, solve_cycles
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene import parse_scene
from loaded_tca.unloaded import trace_teeth
from validation.calculix.case import FACE_WIDTH, POSITIONS, pinion_angle
from validation.calculix.deck import LOAD_STEPS
from validation.calculix.tables import CONTACTS_FILE, POSITIONS_FILE, read_table

SCENE = """
title = "Spur pair 25/37"
[pair]
type = "cylindrical"
normal_module_mm = 3.0
pressure_angle_deg = 20.0
centre_distance_mm = 93.0
[pinion]
teeth = 25
face_width_mm = {face_width}
[wheel]
teeth = 37
face_width_mm = {face_width}
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 100.0
"""
"""The bore is left to its default, 0.55 of the root diameter, as in the reference."""
RELIEF = {
    f"{gear}.modifications.{key}": value
    for gear, start in (("pinion", 76.2), ("wheel", 112.45))
    for key, value in (("tip_relief_um", 15.0), ("tip_relief_start_mm", start))
}
CHANGES: dict[str, dict[str, float]] = {"unmodified": {}, "tip_relief": RELIEF}
GRID = GridChoice(cells=(32, 64))
"""Across and along; along a wide face cells should be no longer than the tooth is thick."""
GOOD_FIT = 1e-2
"""Difference of a fitted half ellipse from the largest node, relative, beyond which it is no fit."""
NEIGHBOURS = 1
"""Pitches between the loaded pairs of a position: never more than two pairs carry load here."""

Key = tuple[str, float]
"""Variant and pinion torque [N m] of a face 20 mm wide."""


@dataclass(frozen=True)
class PairLoad:
    """What one tooth pair carries.

    Attributes
    ----------
    share : float
        Of the torque.
    pressure : float [MPa]
        Peak at mid-face under the mean line load.
    pressed : float [MPa]
        The same under the line load of mid-face itself.
    at_corner : bool
        Whether a tip corner is in contact.
    """

    share: float
    pressure: float
    pressed: float
    at_corner: bool


@dataclass(frozen=True)
class Position:
    """A position under load.

    Attributes
    ----------
    pinion_angle : float [rad]
    transmission_error : float [um]
        Loaded, absolute, on the wheel's base circle.
    mesh_stiffness : float [N/(mm um)]
        Between 96 and 100 % of the torque: a pair may come apart in between.
    pairs : dict of int to PairLoad
        By the number of the tooth pair.
    seconds : float
        Processor time of a position and torque, without what is made once for all.
    """

    pinion_angle: float
    transmission_error: float
    mesh_stiffness: float
    pairs: dict[int, PairLoad]
    seconds: float

    @property
    def place(self) -> float:
        """Number of the position: 0 half a pitch before the pitch point, 12 at it."""
        return 0.5 * POSITIONS * (self.pinion_angle / abs(pinion_angle(0)) + 1.0)

    @property
    def at_corner(self) -> bool:
        """Whether a tip corner is in contact."""
        return any(pair.at_corner for pair in self.pairs.values())

    def share(self, pair: int) -> float:
        """Share of a tooth pair, zero where it is apart."""
        return self.pairs[pair].share if pair in self.pairs else 0.0


def read_cycles(positions: Path = POSITIONS_FILE, contacts: Path = CONTACTS_FILE) -> dict[Key, list[Position]]:
    """Kept positions of finite elements by variant and torque; none where a table is missing.

    Parameters
    ----------
    positions, contacts : Path
        Tables of the positions and of the contacts of their tooth pairs.
    """
    if not (positions.exists() and contacts.exists()):
        return {}
    pairs: dict[tuple[str, float, int], dict[int, PairLoad]] = {}
    for row in read_table(contacts):
        pairs.setdefault(_place(row), {})[int(row["pair"])] = _kept_pair(row)
    cycles: dict[Key, list[Position]] = {}
    for row in read_table(positions):
        variant, torque, index = _place(row)
        position = Position(
            pinion_angle=float(row["pinion_angle_rad"]),
            transmission_error=float(row["transmission_error_um"]),
            mesh_stiffness=float(row["mesh_stiffness_N_per_mm_um"]),
            pairs=pairs[variant, torque, index],
            seconds=float(row["seconds"]),
        )
        cycles.setdefault((variant, torque), []).append(position)
    return {key: sorted(cycle, key=lambda position: position.pinion_angle) for key, cycle in cycles.items()}


def _place(row: dict[str, float | str]) -> tuple[str, float, int]:
    """Variant, torque and position of a row."""
    return str(row["variant"]), float(row["torque_Nm"]), int(row["position"])


def _kept_pair(row: dict[str, float | str]) -> PairLoad:
    """Tooth pair of a row; the largest node where no half ellipse fits."""
    fitted, node = float(row["fitted_pressure_MPa"]), float(row["peak_pressure_MPa"])
    pressure = fitted if abs(fitted / node - 1.0) <= GOOD_FIT else node
    return PairLoad(float(row["load_share"]), pressure, pressure, row["corner"] != "no")


@dataclass(frozen=True)
class Model:
    """The pair of the package: flanks of every variant on the same bodies.

    Attributes
    ----------
    pairs : dict of str to GearPair
        By variant.
    bending : BendingModel
        Of the unmodified teeth: 15 um of relief are no part of a body.
    face_width : float [mm]
    seconds : float
        Processor time of the bending model.
    """

    pairs: dict[str, GearPair]
    bending: BendingModel
    face_width: float
    seconds: float

    def cycle(self, variant: str, torque: float, angles: Sequence[float]) -> list[Position]:
        """Return positions under load.

        Parameters
        ----------
        variant : str
        torque : float [N m]
            Of a face of 20 mm; the model carries as much per length.
        angles : (n,) sequence [rad]
            Of the pinion.
        """
        pair = self.pairs[variant]
        whole = 1e3 * torque * self.face_width / FACE_WIDTH
        torques = whole * np.array(LOAD_STEPS)
        start = time.process_time()
        carried = solve_cycles(
            [AllPairsCycle(pair, trace_teeth(pair, np.asarray(angles)), torques, GRID, self.bending)]
        )[0]
        seconds = (time.process_time() - start) / (len(torques) * len(angles))
        return [self._position(pair, carried, n, seconds) for n in range(len(angles))]

    def _position(self, pair: GearPair, carried: CycleSolution, n: int, seconds: float) -> Position:
        """Position of the last torque; stiffness from the last two, as in the reference."""
        first, second = pair.base_radii
        setback = carried.path.transmission_error[n] - pair.driving * carried.rotation[-1, n]
        rate = np.diff(carried.torque) / np.diff(carried.rotation[:, n])
        shares = zip(carried.pairs.tolist(), carried.contacts[-1][n], carried.share[-1, n], strict=True)
        return Position(
            pinion_angle=float(carried.path.pinion_angle[n]),
            transmission_error=1e3 * second * float(setback),
            mesh_stiffness=float(rate[-1]) / (1e3 * first * second * self.face_width),
            pairs={number: self._pair(loaded, float(share)) for number, loaded, share in shares if loaded},
            seconds=seconds,
        )

    def _pair(self, loaded: LoadedContact, share: float) -> PairLoad:
        """Pressure of the middle slice; by Hertz it goes with the root of the line load.

        A pair that is hardly in contact may leave the middle free of load: no pressure.
        """
        pressure = loaded.solution.pressure
        middle = pressure[:, pressure.shape[1] // 2]
        line_load = float(middle.sum()) * loaded.separation.spacing[0]
        mean = loaded.solution.load / self.face_width
        highest = float(middle.max())
        even = highest * float(np.sqrt(mean / line_load)) if line_load else 0.0
        return PairLoad(share, even, highest, bool(loaded.contact.on_edge))


def model(face_width: float, layers: int | None = None) -> Model:
    """Make the pair of the package.

    Parameters
    ----------
    face_width : float [mm]
    layers : int, optional
        Of elements across the face; by default as many as the package takes.
    """
    scenes = {
        variant: parse_scene(SCENE.format(face_width=face_width)).with_changes(changes)
        for variant, changes in CHANGES.items()
    }
    plain = scenes["unmodified"]
    density = None if layers is None else MeshDensity(lengthwise=layers)
    start = time.process_time()
    compliance = tooth_compliance(plain.pair(), neighbours=NEIGHBOURS, density=density)
    seconds = time.process_time() - start
    return Model({variant: scene.pair() for variant, scene in scenes.items()}, compliance, face_width, seconds)
