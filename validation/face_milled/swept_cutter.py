"""Flanks cut with machine settings that are not basic ones, against what a cutter leaves that is moved step by step.

The reference solves no equation of meshing and takes no derivative. Homogeneous matrices place blank and cutter on the
machine, one for each of its axes (Litvin & Fuentes 2004, section 21.2; senses as in
``docs/how_it_works/face_milling.md``). At a turn of the cradle the cutting edge meets the circle of the blank through
(rho, z) at an azimuth, found by bisection; the flank is the extreme of these azimuths over all turns: what no turn has
cut away. Rows tell by how much a setting moves the flank, counted from the pitch point, on that of four circles towards
the corners where it moves most.

The last row of each gear takes the same from the kinematic chain that SpyGO publishes for its machine (a product of
exponentials of nine joints) in place of these matrices, computed apart from this package. For its systemHand "left",
the hand of this pair, the signs differ: of the pinion, tilt, swivel, H and 2C, of the wheel, swivel.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import cos, hypot, inf, pi, radians, sin

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar
from scipy.spatial.transform import Rotation

from loaded_tca.flanks import GeneratedFlank
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from validation.face_milled.pairs import matched_spygo_gears
from validation.table import Row

SOURCE, SPYGO = "swept cutter, numerically", "SpyGO's kinematics"
SETTINGS: dict[str, dict[str, float]] = {
    "tilt 0.3 deg": {"tilt": radians(0.3)},
    "tilt 0.3 deg, swivel 40 deg": {"tilt": radians(0.3), "swivel": radians(40.0)},
    "blank offset 0.8 mm": {"blank_offset": 0.8},
    "helical motion 0.6 mm/rad": {"helical_motion": 0.6},
    "modified roll 2C 0.02": {"modified_roll_2c": 0.02},
    "modified roll 6D -0.1": {"modified_roll_6d": -0.1},
}
"""What is changed of the settings of the matched pair, one thing after the other and then everything."""
FLANKS: tuple[FlankName, FlankName] = ("concave", "convex")
"""Of pinion and wheel: the drive side."""
REACH, TURNS = 1.0, np.linspace(-0.3, 0.3, 13)
"""Azimuth from the root line within which a circle is cut, and turns of the cradle to begin with [rad]."""
AGREEMENT = 3e-10
"""Relative; reference and flank are 8e-11 apart where a setting moves the flank by a micrometre."""
TOGETHER = "all of these"
SPYGO_MOVES = {"pinion": -0.0535028035, "wheel": 0.1197808948}
SPYGO_DIGITS = 2e-9
"""Movement under all changes together by SpyGO's chain [mm], and its last digit, relative."""


def rows() -> list[Row]:
    """Movements of the drive flanks of pinion and wheel."""
    every = {name: value for change in SETTINGS.values() for name, value in change.items()}
    changes = {**SETTINGS, TOGETHER: every}
    flanks = list(zip(matched_spygo_gears(), FLANKS, strict=True))
    return [
        row for gear, flank in flanks for name, change in changes.items() for row in _rows(gear, flank, name, change)
    ]


def _rows(gear: FaceMilledGear, flank: FlankName, name: str, change: dict[str, float]) -> Iterator[Row]:
    """The movement [mm] of the corner that moves most, by the reference and by the flank."""
    other = replace(gear, machine=replace(gear.machine, **change))
    rho, z = places(gear, flank)
    swept = rho[1:] * (turns_swept(other, flank, rho, z) - turns_swept(gear, flank, rho, z))
    exact = rho[1:] * (_turns(other, flank, rho, z) - _turns(gear, flank, rho, z))
    most = int(np.abs(swept).argmax())
    case = f"19 x 62, {gear.name}, {flank} flank"
    quantity, found = f"{name}: moves a corner [mm]", float(exact[most])
    yield Row(case, SOURCE, quantity, float(swept[most]), found, AGREEMENT)
    if name == TOGETHER:
        yield Row(case, SPYGO, quantity, SPYGO_MOVES[gear.name], found, SPYGO_DIGITS)


def places(gear: FaceMilledGear, flank: FlankName) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Circles (rho, z) of the blank, (5,) each [mm]: the pitch point's, then four towards the corners of the flank."""
    inner = [part[1:4:2, 1:4:2].ravel() for part in GeneratedFlank(gear, flank).grid(5, 5)]
    distance, delta = gear.blank.mean_cone_distance, gear.blank.pitch_angle
    pitch_point = distance * sin(delta), distance * cos(delta)
    rho, z = (np.array([first, *others]) for first, others in zip(pitch_point, inner, strict=True))
    return rho, z


def _turns(gear: FaceMilledGear, flank: FlankName, rho: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray:
    """Azimuths of the flank from the pitch point [rad], of all circles but the first."""
    theta = GeneratedFlank(gear, flank).theta(rho, z).value
    return theta[1:] - theta[0]


def turns_swept(gear: FaceMilledGear, flank: FlankName, rho: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray:
    """The same left by a cutter that is swept over the blank."""
    theta = np.array([_left_by_cutter(gear, flank, *circle) for circle in zip(rho, z, strict=True)])
    return gear.mirror * (theta[1:] - theta[0])


def _left_by_cutter(gear: FaceMilledGear, flank: FlankName, rho: float, z: float) -> float:
    """Azimuth on a right-hand member up to which a circle is not cut at any turn of the cradle [rad].

    The material lies at smaller azimuths than a concave flank, and at larger ones than a convex one.
    """
    sign = 1.0 if flank == "concave" else -1.0
    blade = gear.cutter.blade(flank)

    def cut(phi: float) -> float:
        """Azimuth where the cutting edge meets the circle, times the sign; infinite if its tip does not reach it."""
        to_cutter, turned = cutter_from_blank(gear, phi), _roll(gear, phi)

        def seen(theta: float) -> tuple[float, float]:
            x, y, depth, _ = to_cutter @ (rho * cos(theta), rho * sin(theta), z, 1.0)
            return sign * (hypot(x, y) - blade.point_radius) - float(blade.widening(-depth)[0]), -depth

        ends = -REACH - turned, REACH - turned
        if seen(ends[0])[0] * seen(ends[1])[0] > 0.0:
            return inf
        theta = brentq(lambda theta: seen(theta)[0], *ends, xtol=1e-14)
        return sign * theta if seen(theta)[1] > 0.0 else inf

    coarse = int(np.argmin([cut(phi) for phi in TURNS]))
    found = minimize_scalar(cut, bounds=(TURNS[coarse - 1], TURNS[coarse + 1]), options={"xatol": 1e-8})
    return sign * float(found.fun)


def cutter_from_blank(gear: FaceMilledGear, phi: float) -> NDArray[np.float64]:
    """Matrix (4, 4) that takes points of the blank to the cutter, at a turn of the cradle [rad].

    Seen from the cutter its blades stand along -z, their tips in the plane z = 0.
    """
    machine = gear.machine
    base = machine.sliding_base + machine.helical_motion * phi
    blank = (
        _shifted(0.0, machine.blank_offset, base)
        @ _turned("y", 0.5 * pi - machine.root_angle)
        @ _shifted(0.0, 0.0, machine.machine_centre_to_back)
        @ _turned("z", _roll(gear, phi))
    )
    cutter = (
        _turned("z", machine.cradle_angle + phi)
        @ _shifted(machine.radial, 0.0, 0.0)
        @ _turned("z", machine.swivel)
        @ _turned("x", -machine.tilt)
    )
    return np.linalg.solve(cutter, blank)


def _roll(gear: FaceMilledGear, phi: float) -> float:
    """Turn of the blank by the series of the modified roll [rad]."""
    machine = gear.machine
    lag = machine.modified_roll_2c * phi**2 / 2.0 + machine.modified_roll_6d * phi**3 / 6.0
    return machine.ratio_of_roll * (phi - lag)


def _turned(axis: str, angle: float) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler(axis, angle).as_matrix()
    return matrix


def _shifted(x: float, y: float, z: float) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix
