"""The duplex paper: the bidirectional start of a duplex spread blade pair, what its settings give, who needs a start.

The start values depend neither on the calculation point nor on what the paper leaves out (face width, cradle angle), so
that they are compared from an azimuth of the gear each calculation begins with: reverse from the printed theta_p,
forward from the theta_g to which the printed theta_p belongs. Two numbers are misprinted: the forward theta_g, 5.349393
for 5.346931, and the mean, 5.310104 for 5.309104; from the printed theta_g nothing else in its column follows.

The page about it is written by :mod:`validation.face_milled.duplex_document`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import degrees

import numpy as np
from scipy.optimize import brentq

from loaded_tca.baselines.bidirectional import BidirectionalStart, Guess, StartValues
from loaded_tca.baselines.conventional import solve_conventional
from loaded_tca.flanks.face_milled import GeneratedFlank
from loaded_tca.gears.face_milled import FlankName
from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import climb
from validation.face_milled.pairs import (
    DUPLEX_ASSUMED,
    MENDED_RADIAL,
    Gears,
    duplex_gears,
    duplex_paper_gears,
    error_from_top,
    matched_spygo_gears,
    spygo_gears,
)
from validation.table import Row

CASE, SOURCE, COMPUTED = "duplex paper, 20 x 30", "duplex paper", "computed independently"
MENDED = "duplex paper, mended pair D"
FORWARD_PINION_AZIMUTH, REVERSE_AZIMUTH = 0.896671, 0.979223
MISPRINTS = {"forward theta_g": (5.349393, 5.346931), "mean theta_g": (5.310104, 5.309104)}
"""Printed and mended."""
PRINTED = {
    "forward theta_g": 5.346931,
    "forward theta_p": 0.896671,
    "forward phi2'": 7.943e-3,
    "forward phi1'": -6.3e-4,
    "reverse theta_g": 5.271278,
    "reverse theta_p": 0.979223,
    "reverse phi2'": -2.72e-3,
    "reverse phi1'": 2.81e-3,
    "mean theta_g": 5.309104,
    "mean theta_p": 0.937947,
    "mean phi2'": 2.611e-3,
    "mean phi1'": 1.090e-3,
}
GIVEN = ("forward theta_p", "reverse theta_p", "mean theta_p")
"""What the calculations begin with, and its mean: shown on the page, no rows."""
AZIMUTH_DIGIT = 1e-6
TURN_DIGITS = {"forward phi2'": 1e-6, "reverse phi1'": 1e-5, "reverse phi2'": 1e-5, "mean phi1'": 1e-5}
"""Unit of the last printed digit of the turns, where it is not 1e-6; the paper cuts digits off instead of rounding."""
COMPONENTS = {"y, z": (1, 2), "x, z": (0, 2)}
"""Pairs of components of the normals in the five equations."""
SAME_CONTACT = 1e-9
"""Difference of wheel angles that is rounding [rad]."""


@dataclass(frozen=True)
class Study:
    """A pair, and where its start leads.

    Attributes
    ----------
    name : str
    gears : (FaceMilledGear, FaceMilledGear)
    flank : {"concave", "convex"}
        Of the pinion.
    """

    name: str
    gears: Gears
    flank: FlankName = "concave"

    def pair(self) -> GearPair:
        """The pair of flanks."""
        return _pair(self.gears, self.flank)


@cache
def _pair(gears: Gears, flank: FlankName) -> GearPair:
    return face_milled_pair(*gears, pinion_flank=flank)


@dataclass(frozen=True)
class Outcome:
    """Where one start leads.

    Attributes
    ----------
    distance : float [mm]
        Between the two points of the start.
    wheel_angle_off : float [deg]
        Wheel angle of the start beside that of the first touch.
    conventional : dict of str to str
        By the pair of components: steps to the contact, or what came instead.
    reduced : int or None
        Steps of the reduced solver to the first touch; None if it ended elsewhere.
    on_edge : bool
        Whether the first touch lies on an edge.
    """

    distance: float
    wheel_angle_off: float
    conventional: dict[str, str]
    reduced: int | None
    on_edge: bool


@cache
def studies() -> tuple[Study, ...]:
    """Pairs from which starts are tried."""
    return (
        Study("printed settings, drive", duplex_paper_gears()),
        Study("printed settings, coast", duplex_paper_gears(), "convex"),
        Study("mended pair D, drive", duplex_paper_gears(MENDED_RADIAL)),
        Study("duplex blank, drive", duplex_gears()),
        Study("duplex blank, coast", duplex_gears(), "convex"),
        Study("19 x 62 matched B, drive", matched_spygo_gears()),
        Study("19 x 62 published, drive", spygo_gears()),
        Study("19 x 62 published, coast", spygo_gears(), "convex"),
    )


def starts(study: Study, pair: GearPair) -> dict[str, Guess]:
    """Forward, reverse and mean start."""
    start = BidirectionalStart(study.gears, pair)
    values = {"forward": start.forward(), "reverse": start.reverse(), "mean": start.mean()}
    return {name: start.guess(one) for name, one in values.items()}


@cache
def outcomes(study: Study) -> dict[str, Outcome]:
    """Where forward, reverse and mean start lead."""
    pair = study.pair()
    return {name: _try(pair, guess) for name, guess in starts(study, pair).items()}


def _try(pair: GearPair, guess: Guess) -> Outcome:
    """Both solvers from one start, and the first touch that the scan of the ease-off finds without any."""
    phi1 = np.array([guess.pinion_angle])
    touch = trace_contact(pair, phi1, warn=False)
    results = {}
    for name, components in COMPONENTS.items():
        found = solve_conventional(pair, phi1, guess.unknowns[None], components)
        same = abs(found.wheel_angle[0] - touch.wheel_angle[0]) < SAME_CONTACT
        results[name] = _told(bool(found.converged[0]), bool(found.is_contact[0] and same), int(found.iterations[0]))
    peak = climb(EaseOff(pair), phi1, *guess.unknowns[:2, None])
    error = abs(peak.value[0] / pair.base_radii[1] - pair.driving * touch.transmission_error[0])
    reached = bool(peak.converged[0]) and error < SAME_CONTACT
    return Outcome(
        guess.distance,
        degrees(guess.unknowns[4] - touch.wheel_angle[0]),
        results,
        int(peak.iterations[0]) if reached else None,
        bool(touch.on_edge[0]),
    )


def _told(converged: bool, contact: bool, steps: int) -> str:
    if contact:
        return f"{steps} steps"
    return "off the flanks" if converged else "diverges"


def rows() -> list[Row]:
    """Start values digit by digit, then what the settings give."""
    return [*_start_rows(), *_pair_rows(), *_solver_rows()]


def _start_rows() -> list[Row]:
    values = start_values()
    lines = []
    for quantity, printed in PRINTED.items():
        if quantity in GIVEN:
            continue
        digit = AZIMUTH_DIGIT if "theta" in quantity else TURN_DIGITS.get(quantity, 1e-6)
        remark = f"printed {MISPRINTS[quantity][0]}, a misprint" if quantity in MISPRINTS else ""
        lines.append(Row(CASE, SOURCE, f"{quantity} [rad]", printed, values[quantity], digit / abs(printed), remark))
    return lines


def start_values() -> dict[str, float]:
    """The paper's three columns."""
    gears = duplex_paper_gears()
    start = BidirectionalStart(gears, Study(CASE, gears).pair())
    wheel_azimuth = brentq(lambda angle: start.forward(angle).pinion_azimuth - FORWARD_PINION_AZIMUTH, 5.3, 5.4)
    forward, reverse = start.forward(wheel_azimuth), start.reverse(REVERSE_AZIMUTH)
    columns = {"forward": forward, "reverse": reverse, "mean": forward.mean(reverse)}
    return {f"{name} {key}": value for name, one in columns.items() for key, value in _named(one).items()}


def _named(values: StartValues) -> dict[str, float]:
    return {
        "theta_g": values.wheel_azimuth,
        "theta_p": values.pinion_azimuth,
        "phi2'": values.wheel_turn,
        "phi1'": values.pinion_turn,
    }


def _pair_rows() -> list[Row]:
    lines = []
    gears = duplex_paper_gears()
    for name, flank, mating, printed in (("drive", "concave", "convex", -1.59), ("coast", "convex", "concave", 1.68)):
        miss = abs(GeneratedFlank(gears[0], flank).angles.spiral) - abs(GeneratedFlank(gears[1], mating).angles.spiral)
        lines.append(
            Row(CASE, COMPUTED, f"{name}: spiral angles miss [deg]", printed, degrees(miss), 5e-3, DUPLEX_ASSUMED)
        )
    pair = Study(CASE, gears).pair()
    top = error_from_top(pair, ())[2]
    lengthwise, _ = pair.pinion.flank.frame.to_picture(top.pinion_radius, top.pinion_axial)
    lines.append(Row(CASE, COMPUTED, "drive: R - R_m at the top [mm], toe -10", -10.0, float(lengthwise[0]), 1e-9))
    mended = Study(MENDED, duplex_paper_gears(MENDED_RADIAL)).pair()
    _, fall, _ = error_from_top(mended, (-0.5, 0.5))
    for part, printed, value in zip(("before", "after"), (-12.29, -12.50), fall, strict=True):
        quantity = f"TE half a pitch {part} the top [arcsec]"
        lines.append(Row(MENDED, COMPUTED, quantity, printed, float(value), 5e-4, DUPLEX_ASSUMED))
    return lines


def _solver_rows() -> list[Row]:
    """The reduced solver ends in the first touch from every start of every pair."""
    lines = []
    for study in studies():
        reached = sum(outcome.reduced is not None for outcome in outcomes(study).values())
        lines.append(Row(study.name, "all", "starts from which the reduced solver touches", 3.0, float(reached), 0.0))
    return lines
