"""Face-milled 19 x 62 of SpyGO: its settings from the blank, and what the pair does as published and as matched.

The closed forms of :mod:`loaded_tca.gears.basic_settings` are compared to a unit of the last printed digit. Point
widths are those of the slots at mid-face; SpyGO's differ and are shown only. The angles by which the published pair
misses and the numbers of the matched pair B were computed independently of this package. How pressure angles miss is
told to 0.01 deg: the hollow blade of the wheel turns by that much in 0.09 mm of height.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees

import numpy as np

from loaded_tca.flanks import GeneratedFlank
from loaded_tca.gears.basic_settings import cutter_number, point_width, spread_blade
from loaded_tca.gears.face_milled import FlankName
from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.reference.hertz import point_contact
from loaded_tca.unloaded import relative_curvature
from validation.bevel.iso_23509_sample import SPYGO, spygo
from validation.face_milled.pairs import (
    duplex_blank,
    duplex_gears,
    duplex_paper_blank,
    error_from_top,
    matched_spygo_gears,
    spygo_gears,
)
from validation.table import Row

PUBLISHED, COMPUTED = "SpyGO", "computed independently"
PRINTED = {
    "pinion": (97.959402908, 52.796746783, 15.640967271, 3.339685915),
    "wheel": (97.953678147, 52.801158062, 75.663828096, 1.023367029),
}
DIGIT = 1e-9
NUMBER = 1e-6
"""Of the cutter number, whole by the rounded numbers of the blank."""
ALONG, ACROSS = 4e-6, 2e-7
"""Of curvatures with seven digits: what B-splines leave, the more the smaller they are."""
POINT_WIDTHS = 95.951739019 - 94.548260981, 2.0 * (96.439269791 - 95.25)
MATCHED = f"{SPYGO}, matched pair B"
EIGHTHS = (-0.5, -0.375, -0.25, -0.125, 0.125, 0.25, 0.375, 0.5)
MATCHED_ERROR = (-6.018, -3.361, -1.484, -0.368, -0.364, -1.445, -3.232, -5.711)
MEAN_POINT = {"pinion rho": 34.094573, "pinion z": 108.697640, "wheel rho": 111.255550, "wheel z": 24.491209}
INFERRED = "point radius of the wheel's inside blade 94.060730209"


def rows() -> list[Row]:
    """Settings, blade group, then the three pairs."""
    return [*_settings(), *_blade_groups(), *_published_pair(), *_matched_pair(), *_duplex_pair()]


def _settings() -> Iterable[Row]:
    blank = spygo()
    for gear, printed in zip(spread_blade(blank), PRINTED.values(), strict=True):
        machine = gear.machine
        obtained = (machine.radial, degrees(machine.cradle_angle), degrees(machine.root_angle), machine.ratio_of_roll)
        names = ("radial [mm]", "cradle angle [deg]", "machine root angle [deg]", "ratio of roll")
        for name, expected, value in zip(names, printed, obtained, strict=True):
            yield Row(SPYGO, PUBLISHED, f"{gear.name} {name}", expected, value, DIGIT / expected)
    for one, printed_width in zip((blank.pinion, blank.wheel), POINT_WIDTHS, strict=True):
        yield Row(SPYGO, PUBLISHED, f"{one.name} point width [mm]", printed_width, point_width(one), None)


def _blade_groups() -> Iterable[Row]:
    assumed = "spiral angle 35 deg, to which its root angles belong"
    yield Row(
        "duplex paper, 20 x 30",
        "duplex paper",
        "cutter number",
        11.0,
        cutter_number(duplex_paper_blank()),
        NUMBER,
        assumed,
    )


def _published_pair() -> Iterable[Row]:
    gears = spygo_gears()
    flanks: tuple[tuple[str, FlankName, float, float], ...] = (
        ("drive", "concave", 1.66, 1e-2),
        ("coast", "convex", 2.58, 1e-2),
    )
    for name, flank, missed, digit in flanks:
        side = gears[0].side(flank)
        angles = [GeneratedFlank(gear, gear.flank_name(side)).angles.pressure for gear in gears]
        miss = degrees(abs(angles[0] - angles[1]))
        yield Row(SPYGO, COMPUTED, f"{name}: pressure angles miss [deg]", missed, miss, digit / missed, INFERRED)
    _, fall, top = error_from_top(face_milled_pair(*gears), (-0.5, 0.5))
    for part, expected, value in zip(("before", "after"), (-44.2, -45.1), fall, strict=True):
        quantity = f"drive: TE half a pitch {part} the top [arcsec]"
        yield Row(SPYGO, COMPUTED, quantity, expected, float(value), 0.05 / abs(expected), INFERRED)
    on_tip = float(top.edges[0, 4])
    yield Row(SPYGO, COMPUTED, "drive: top on the wheel's tip edge (1: yes)", 1.0, on_tip, 0.0, INFERRED)


def _matched_pair() -> Iterable[Row]:
    pair = face_milled_pair(*matched_spygo_gears())
    _, fall, top = error_from_top(pair, EIGHTHS)
    for part, expected, value in zip(EIGHTHS, MATCHED_ERROR, fall, strict=True):
        label = f"TE at {part:+.3f} pitches from its top [arcsec]"
        yield Row(MATCHED, COMPUTED, label, expected, float(value), 6e-4 / abs(expected))
    place = (top.pinion_radius, top.pinion_axial, top.wheel_radius, top.wheel_axial)
    for (name, expected), value in zip(MEAN_POINT.items(), place, strict=True):
        yield Row(MATCHED, COMPUTED, f"top at {name} [mm]", expected, float(value[0]), 2e-6 / expected)
    bend = relative_curvature(pair, top[0])
    yield Row(MATCHED, COMPUTED, "curvature along, B-splines [1/mm]", 3.954798e-4, bend.along, ALONG)
    yield Row(MATCHED, COMPUTED, "curvature across, B-splines [1/mm]", 6.658058e-2, bend.across, ACROSS)
    load = 300e3 / float(top.pinion_lever[0])
    hertz = point_contact(load, (bend.across, bend.along), pair.contact_modulus)
    yield Row(MATCHED, COMPUTED, "p0 at 300 N m [MPa]", 1466.36, hertz.max_pressure, 0.005 / 1466.36)


def _duplex_pair() -> Iterable[Row]:
    """Closed forms alone: the method's own blank gives a pair that touches inside its flanks, on both sides."""
    gears, blank = duplex_gears(), duplex_blank()
    case, source = "duplex spread blade 20 x 30", "closed forms"
    for name, flank in (("drive", "concave"), ("coast", "convex")):
        side = gears[0].side(flank)  # type: ignore[arg-type]
        pinion, wheel = (GeneratedFlank(gear, gear.flank_name(side)).angles for gear in gears)
        miss = degrees(abs(pinion.spiral) - abs(wheel.spiral))
        yield Row(case, source, f"{name}: spiral angles miss [deg]", 0.0, miss, 0.01)
        _, _, top = error_from_top(face_milled_pair(*gears, pinion_flank=flank), ())  # type: ignore[arg-type]
        off = float(np.hypot(top.pinion_radius, top.pinion_axial)[0]) - blank.mean_cone_distance
        yield Row(case, source, f"{name}: R - R_m at the top [mm]", 0.0, off, 0.5)
