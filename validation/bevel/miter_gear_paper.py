"""The straight bevel pair 20/40 of the miter-gear paper: three methods, contact pattern, edge contact, B-splines.

m_et 3 mm, shaft angle 90 deg, alpha 20 deg, profile shifts +0.416/-0.416, spherical involutes, crowned pinion. The
source compares the conventional equations ("Litvin") with its golden-section search and prints a largest transmission
error of about -12.5 and -12.7 arcsec (Table 2), but neither face width nor crownings nor marking compound: assumed here
are 20 mm, 10 um lengthwise and 5 um along the profile, 6.35 um. The transmission error does not depend on the
lengthwise crowning, so the profile crowning that gives the printed one follows.

``validation/bevel/miter_gear_document.py`` writes the page and the picture.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cache
from math import degrees, nan, pi, sin

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from loaded_tca.baselines.conventional import solve_conventional
from loaded_tca.baselines.golden_section import search_golden_section
from loaded_tca.flank_maps import ContactArea, contact_area
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.spline import fitted
from loaded_tca.gears import bevel_mesh
from loaded_tca.material import Material
from loaded_tca.pairs.bevel import BevelMounting
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPath, relative_curvature, trace_contact, trace_teeth
from validation.bevel.pairs import BevelGears
from validation.page import timed
from validation.table import Row

Array = NDArray[np.float64]
CASE = "miter-gear paper, straight bevel 20/40"
ASSUMED = "b 20 mm, crowning of the pinion 10 um lengthwise, 5 um profile, compound 6.35 um"
ARCSEC = degrees(3600.0)
GEARS = BevelGears(
    "straight bevel 20/40", bevel_mesh((20, 40), 3.0, 20.0, profile_shifts=(0.416, -0.416)), Material(), 1500.0
)
LENGTHWISE, PROFILE = 0.010, 0.005
"""Crownings [mm]."""
SLIGHT = 1e-4
"""Profile crowning [mm] so small that the transmission error is proportional to it (to 3e-4; at 10 um, to 3 %)."""
POSITIONS = 21
FEW, SECTIONS = 5, 24
"""Positions and sections of the golden-section search in the table of rows: it is slow."""
NORMALS = (0, 2)
"""Components of the normals that the five equations set equal: those from which most starts converge."""
EDGE = BevelMounting(offset=0.2)
"""E at which the contact runs on the heel all along."""
BESIDE = BevelMounting(offset=0.1)
"""E at which the contact area reaches the heel."""
PRINTED = {"Litvin's method": -12.5, "the source's method": -12.7}
"""Largest transmission error [arcsec]."""
SAME_POINT, SAME_ANGLE, SAME_CURVATURE = 1e-7, 1e-7, 4e-7
"""Of contact points [mm], where a residual of 1e-12 mm leaves 1e-8 on a ridge of radius 5 m, and of the wheel's angle
[arcsec], 5e-13 rad; of the relative curvatures of B-spline flanks, three times what is seen."""
SEARCHED = 1e-6, 1e-4
"""Transmission error [arcsec] of so few sections, within the flank and on an edge, where its maximum is no summit."""
RUNS = 5


def pair(profile_crowning: float = PROFILE, mounting: BevelMounting | None = None) -> GearPair:
    """The pair with its crowned pinion."""
    crowned = FlankModifications(lead_crowning=LENGTHWISE, profile_crowning=profile_crowning)
    return GEARS.pair(mounting, crowned)


def path_of(gears: GearPair, count: int = POSITIONS) -> ContactPath:
    """Contact path over one pitch."""
    return trace_contact(gears, angles(count), warn=False)


def angles(count: int = POSITIONS) -> Array:
    """Pinion angles over one pitch [rad]."""
    return np.linspace(-0.5, 0.5, count) * pair().pitch


@dataclass(frozen=True)
class Comparison:
    """A method beside the ease-off at the same positions; NaN where it finds no contact.

    Attributes
    ----------
    angle : (n,) array [arcsec]
        Difference of the wheel angles.
    distance : (n,) array [mm]
        Between the contact points.
    """

    angle: Array
    distance: Array

    @property
    def found(self) -> int:
        """Positions at which the method finds the contact."""
        return int(np.isfinite(self.angle).sum())

    @property
    def largest(self) -> tuple[float, float]:
        """Largest difference of the wheel angles [arcsec] and of the places [mm]; NaN if there is none."""
        return (float(np.nanmax(self.angle)), float(np.nanmax(self.distance))) if self.found else (nan, nan)


def golden(gears: GearPair, path: ContactPath, sections: int = SECTIONS) -> Comparison:
    """Golden-section search at the positions of a path."""
    found = search_golden_section(gears, path.pinion_angle, sections=sections)
    away = np.linalg.norm(found.point - path.point, axis=1)
    return Comparison(np.abs(found.wheel_angle - path.wheel_angle) * ARCSEC, away)


def five_equations(gears: GearPair, path: ContactPath, *, from_answer: bool = False) -> Comparison:
    """Newton iteration from the contact in the middle of a path, or from the ease-off's answer: no start is better."""
    places = np.stack([path.pinion_radius, path.pinion_axial, path.wheel_radius, path.wheel_axial], axis=-1)
    middle = len(path) // 2
    start = np.column_stack([np.tile(places[middle], (len(path), 1)), gears.ratio * path.pinion_angle])
    if from_answer:
        start = np.column_stack([places, path.wheel_angle])
    found = solve_conventional(gears, path.pinion_angle, start, NORMALS)
    turned = np.abs(found.wheel_angle - path.wheel_angle) * ARCSEC
    away = np.hypot(*(found.unknowns[:, :2] - places[:, :2]).T)
    return Comparison(np.where(found.is_contact, turned, nan), np.where(found.is_contact, away, nan))


def largest_error(profile_crowning: float, *, one_pair: bool = False) -> float:
    """Largest transmission error [arcsec]: of the motion, or of one tooth pair from -1/2 to +1/2 pitch."""
    gears = pair(profile_crowning)
    if one_pair:
        return float(path_of(gears).transmission_error.min()) * ARCSEC
    return -trace_teeth(gears, angles()).peak_to_peak * ARCSEC


@cache
def crowning_for(error: float, *, one_pair: bool = False) -> float:
    """Profile crowning [mm] that gives a largest transmission error [arcsec]."""
    return float(brentq(lambda amount: largest_error(amount, one_pair=one_pair) - error, 1e-3, 2e-2, xtol=1e-9))


def crowning_in_closed_form(error: float) -> float:
    """The same [mm] of an aligned pair, slightly crowned.

    The contact runs through the unwound arc w at the rate sin(delta_b) in phi1. Half a pitch to either side of the
    top, with w_a - w_m half the active arc, the wheel stays behind by
    z1/z2 C/(R_m sin delta_b) (pi sin(delta_b)/(z1 (w_a - w_m)))^2.
    """
    gear, mating = GEARS.mesh.pinion, GEARS.mesh.wheel
    start, tip = (gear.unwound_arc(cone) for cone in GEARS.mesh.active_cones[0])
    share = pi * sin(gear.base_angle) / (gear.teeth * 0.5 * (tip - start))
    return -error / ARCSEC * mating.teeth / gear.teeth * gear.mean_base_radius / share**2


def fitted_pair() -> GearPair:
    """The pair with both flanks replaced by quintic B-splines through 33 x 33 of their points."""
    exact = pair()
    return exact.with_flanks(fitted(exact.pinion.flank), fitted(exact.wheel.flank))


def rows() -> list[Row]:
    """The three methods agree, the pattern is an ellipse away from the edges, B-splines change nothing."""
    return [*_method_rows(), *_edge_rows(), *_error_rows(), *_pattern_rows(), *_spline_rows()]


def short_rows() -> list[Row]:
    """Rows with a verdict; what the printed errors say of the crowning has none."""
    return [*_method_rows(), *_edge_rows(), _slight_row(), *_pattern_rows(), *_spline_rows()]


def _method_rows() -> list[Row]:
    gears = pair()
    searched, solved = golden(gears, path_of(gears, FEW)), five_equations(gears, path_of(gears))
    return [
        _row("ease-off", "golden section: TE, largest difference [arcsec]", 0.0, searched.largest[0], SEARCHED[0]),
        _row("ease-off", "golden section: path, largest distance [mm]", 0.0, searched.largest[1], 1e-3),
        _row("ease-off", "five equations: TE, largest difference [arcsec]", 0.0, solved.largest[0], SAME_ANGLE),
        _row("ease-off", "five equations: path, largest distance [mm]", 0.0, solved.largest[1], SAME_POINT),
        _row("ease-off", "five equations, from the pitch point: positions found", POSITIONS, solved.found, None),
    ]


def _edge_rows() -> list[Row]:
    gears, place = pair(mounting=EDGE), f"E {EDGE.offset:g} mm"
    path = path_of(gears)
    off = golden(gears, path_of(gears, FEW)).largest
    tangent = five_equations(gears, path, from_answer=True).found
    return [
        _row("all on the heel", f"{place}: positions on an edge", POSITIONS, path.on_edge.sum(), 1e-9),
        _row("ease-off", f"{place}, golden section: TE, largest difference [arcsec]", 0.0, off[0], SEARCHED[1]),
        _row("ease-off", f"{place}, golden section: path, largest distance [mm]", 0.0, off[1], 1e-3),
        _row("no tangency on an edge", f"{place}, five equations: positions found", 0, tangent, 1e-9),
    ]


def _slight_row() -> Row:
    again = crowning_in_closed_form(largest_error(SLIGHT))
    return _row("closed form", "profile crowning from the TE of a slight one [um]", 1e3 * SLIGHT, 1e3 * again, 1e-3)


def _error_rows() -> list[Row]:
    found = [_slight_row()]
    for method, error in PRINTED.items():
        source, amount = f"as printed, Table 2, {method}", 1e3 * crowning_for(error)
        one = 1e3 * crowning_for(error, one_pair=True)
        text = f"profile crowning [um] for a largest TE of {error:g} arcsec"
        found += [
            _row(source, "largest TE of the motion [arcsec]", error, largest_error(PROFILE), None),
            _row("5 um assumed", f"{text} of the motion", 1e3 * PROFILE, amount, None),
            _row("5 um assumed", f"{text} of one pair, +-1/2 pitch", 1e3 * PROFILE, one, None),
        ]
    return found


def _pattern_rows() -> list[Row]:
    area = area_at(None)
    ellipse = "ellipse of the curvatures"
    names = ("across", "along")
    sizes = zip(names, area.ellipse_semi_axes, area.semi_axes, strict=True)
    beside = area_at(BESIDE)
    return [
        _row(ellipse, "contact area, aligned [mm^2]", area.ellipse_area, area.area, 5e-3),
        *(_row(ellipse, f"contact area, aligned, semi-axis {name} [mm]", k, s, 5e-3) for name, k, s in sizes),
        _row(ellipse, f"contact area, E {BESIDE.offset:g} mm: cut [mm^2]", beside.ellipse_area, beside.area, None),
    ]


def _spline_rows() -> list[Row]:
    exact, spline = path_of(pair()), path_of(fitted_pair())
    away = np.linalg.norm(spline.point - exact.point, axis=1).max()
    change = np.abs(curvatures(fitted_pair(), spline) / curvatures(pair(), exact) - 1.0).max()
    return [
        _row("exact flanks", "B-spline flanks: contact point, largest distance [mm]", 0.0, away, SAME_POINT),
        _row("exact flanks", "B-spline flanks: relative curvatures, change", 0.0, change, SAME_CURVATURE),
    ]


def curvatures(gears: GearPair, path: ContactPath) -> Array:
    """Principal relative curvatures (n, 2) along a path [1/mm]."""
    found = [relative_curvature(gears, path[row]) for row in range(len(path))]
    return np.array([(one.across, one.along) for one in found])


def slowness() -> float:
    """Processor time of a path on B-spline flanks over that on exact ones; each the shortest of some runs."""
    fitted, exact = (
        min(timed(lambda gears=gears: path_of(gears), RUNS, clock=time.process_time)[1])
        for gears in (fitted_pair(), pair())
    )
    return fitted / exact


def area_at(mounting: BevelMounting | None, turn: float = 0.0) -> ContactArea:
    """Contact area under the marking compound, ``turn`` pitches from the pitch point."""
    gears = pair(mounting=mounting)
    return contact_area(gears, trace_contact(gears, [turn * gears.pitch], warn=False)[0])


def _row(source: str, quantity: str, expected: float, obtained: float, tolerance: float | None) -> Row:
    return Row(CASE, source, quantity, float(expected), float(obtained), tolerance, ASSUMED)
