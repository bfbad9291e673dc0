"""Rolling bearings by their inner geometry: a commercial program, Stribeck's numbers, ISO 281, gears really moved.

- A ball bearing of 7 balls of 11.5 mm on 43.5 mm, grooves of 0.52 and 0.53, by the program MASTA: motions of the inner
  ring under a radial and an axial load of 1 kN, and lives, with and without clearance. Its numbers are printed in the
  tests of the public repository minzhun/ISO16281; it has steel of 210000 MPa. Tolerance 1e-4, of the digits of such a
  program. Under a moment its lever is the pitch radius, ours that of the groove: 1.5 %.
- Stribeck's numbers of a bearing of very many elements without clearance, 4.37 and 4.08, as NSK prints them: the three
  digits, and 0.1 % of single elements.
- Factors f_c of ISO 281, tables 2 and 7: their digits.
- The helical pair of ``examples/scenes/helical_on_rolling_bearings.toml``: rigid analyses whose wheel is set where the
  loads move both shafts by the exact law of their bearings, until nothing moves, at the middle and at an end of the
  pitch. They agree to 3e-5 of the transmission error and 2e-4 of the motions, what both repetitions end at.

``python -m validation.loaded.rolling_bearings`` writes ``docs/studies/rolling_bearings.md``.
"""

from __future__ import annotations

import time
import warnings
from functools import cache, partial

import numpy as np

from loaded_tca import AccuracyWarning, Scene, analyse, read_scene
from loaded_tca.arrays import Array
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.results import MeshCycle
from loaded_tca.supports import BallBearing, RollerBearing, RollingBearing, Support, supports_of
from loaded_tca.supports.bearing import Seat, balanced
from loaded_tca.supports.bearing_life import ball_factor, roller_factor
from validation.loaded.moved_gears import settled
from validation.page import SCENES, Page, formatted, lines, machine, median_ratio, medians, take_times, write_page
from validation.table import Row

CASE, PROGRAM = "rolling bearings", "MASTA, as minzhun/ISO16281 prints it"
SMALL = {"at": 0.0, "elements": 7, "diameter": 11.5, "pitch_diameter": 43.5, "rating": 23400.0}
LOADS = {
    "radial": ((1000.0, 0.0), {0.0: (15.1101, None, 13163.019), 10.0: (21.223, None, 10795.7948)}),
    "axial": ((0.0, 1000.0), {0.0: (None, 133.5381, 2222.7318), 10.0: (None, 149.1717, 3115.8781)}),
    "radial and axial": ((1000.0, 1000.0), {10.0: (19.5923, 146.4603, 1630.5367)}),
}
"""Forces [N] -> by clearance [um] the motions along them [um], and the life [1e6 revolutions]."""
OF_PROGRAM, OF_MOMENT, OF_STRIBECK, OF_TABLES = 1e-4, 0.015, 2e-3, 1e-3
MANY = {"at": 0.0, "elements": 200, "diameter": 1.0, "pitch_diameter": 100.0}
TABLES = {0.05: (46.7, 74.1), 0.1: (55.5, 84.2), 0.16: (59.6, 88.5), 0.2: (59.9, 88.7)}
OF_ERROR, OF_MOTIONS = 3e-5, 2e-4
CELLS, TORQUES = 24, (40.0, 130.0)
RUNS = 5
"""Of analyses whose times are compared."""


def rows() -> list[Row]:
    """Every comparison."""
    return [*_of_program(), *_of_stribeck(), *_of_tables(), *_of_moved_gears()]


def _alone(bearing: RollingBearing, load: Array) -> Array:
    """Motion (6,) of the inner ring of a bearing alone; next to nothing holds what it leaves free."""
    slack = np.diag([0.0, 0.0, 1e-3, 1.0, 1.0, 0.0])
    return balanced(slack, load, np.arange(5), [Seat(bearing, slice(0, 6))])[0]


def _of_program() -> list[Row]:
    rows = []
    for name, ((radial, axial), by_clearance) in LOADS.items():
        for clearance, (across, along, life) in by_clearance.items():
            bearing = BallBearing(clearance=1e-3 * clearance, **SMALL)
            motion = _alone(bearing, np.array([radial, 0.0, axial, 0.0, 0.0, 0.0]))
            about = f"{name} 1 kN, clearance {clearance:g} um"
            numbers = {
                "radial motion [um]": (across, 1e3 * motion[0]),
                "axial motion [um]": (along, 1e3 * motion[2]),
                "life [1e6 revolutions]": (life, bearing.life(motion)),
            }
            rows += [
                Row(CASE, PROGRAM, f"{about}: {what}", expected, float(obtained), OF_PROGRAM)
                for what, (expected, obtained) in numbers.items()
                if expected is not None
            ]
    tilt = _alone(BallBearing(**SMALL), np.array([0.0, 0.0, 0.0, 1000.0, 0.0, 0.0]))[3]
    rows.append(Row(CASE, PROGRAM, "1 N m about x: tilt [mrad]", 3.6957, 1e3 * float(tilt), OF_MOMENT))
    return rows


def _of_stribeck() -> list[Row]:
    bearings = {
        "balls": (BallBearing(**MANY), 4.37, 3e3),
        "rollers": (RollerBearing(length=40.0, **MANY), 4.08, 3e5),
    }
    rows = []
    for name, (bearing, number, load) in bearings.items():
        motion = _alone(bearing, np.array([load, 0.0, 0.0, 0.0, 0.0, 0.0]))
        part = float(bearing.element_forces(motion).max()) * bearing.elements / load
        rows.append(Row(CASE, "Stribeck, as NSK prints it", f"200 {name}: Z Q_max/F_r", number, part, OF_STRIBECK))
    return rows


def _of_tables() -> list[Row]:
    return [
        Row(CASE, "ISO 281", f"f_c of {name}, D cos(alpha)/D_pw = {gamma:g}", expected, obtained, OF_TABLES)
        for gamma, of_table in TABLES.items()
        for name, expected, obtained in (
            ("balls", of_table[0], ball_factor(gamma, 0.52, 0.53)),
            ("rollers", of_table[1], roller_factor(gamma)),
        )
    ]


@cache
def scene() -> Scene:
    """The helical pair on rolling bearings, on coarse grids, whose teeth do not bend."""
    changes = {"analysis.positions": 5, "analysis.cells": (CELLS, CELLS), "analysis.compliance": "contact"}
    return read_scene(SCENES / "helical_on_rolling_bearings.toml").with_changes(
        changes | {"analysis.torques_Nm": list(TORQUES)}
    )


def _analysed(one: Scene) -> MeshCycle:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse(one)


def _moved(support: Support, load: Array) -> Array:
    """Exact motion (6,) of the middle of the face under a load there."""
    return support.at_middle(support.linear_near(load).moved(load))


def _of_moved_gears() -> list[Row]:
    rows, wanted = [], scene().analysis
    grid = GridChoice((CELLS, CELLS), tolerance=wanted.tolerance, free_edges=wanted.free_edges)
    result, source = _analysed(scene()), "rigid analyses, gears moved"
    for t, position in ((0, wanted.positions // 2), (1, 0), (1, wanted.positions // 2)):
        torque, angle = TORQUES[t], float(result.pinion_angle[position])
        alone = scene().with_changes({"analysis.torques_Nm": [torque]})
        pinion, wheel = (partial(_moved, support) for support in supports_of(alone))
        expected = settled(alone, (pinion, wheel), grid, change=1e-7, angle=angle)
        error, about = float(result.transmission_error[t, position]), f"{torque:g} N m, {np.degrees(angle):.1f} deg"
        rows.append(Row(CASE, source, f"{about}: TE [urad]", 1e6 * expected.transmission_error, 1e6 * error, OF_ERROR))
        for n, gear in enumerate(("pinion", "wheel")):
            motion, exact = getattr(result, f"{gear}_motion")[t, position], expected.motions[n]
            for what, part in (("way", slice(0, 3)), ("rotation", slice(3, 6))):
                off = float(np.abs(motion[part] - exact[part]).max() / np.abs(exact[part]).max())
                rows.append(Row(CASE, source, f"{about}: {what} of the {gear}, off by", 0.0, off, OF_MOTIONS))
    return rows


def page() -> Page:
    """Tables of the rows; rolling bearings beside linear ones over the torque; the time of both."""
    compared = lines(
        [row.quantity, row.source, f"{row.expected:.6g}", f"{row.obtained:.6g}", f"{row.error:.1e}"] for row in rows()
    )
    return Page("rolling_bearings", _text(compared, lines(_over_the_torque()), lines(_times())))


def _linear(one: Scene) -> Scene:
    """The scene with the stiffnesses that its bearings have under its torque."""
    changes: dict[str, object] = {}
    for gear, support in zip(("pinion", "wheel"), supports_of(one), strict=True):
        motions = getattr(_analysed(one), f"{gear}_bearing_motion")[0].mean(axis=0)
        changes[f"{gear}.shaft.bearings"] = [
            {"at_mm": bearing.at, "stiffness": bearing.reaction(motion).tangent[:5, :5].tolist()}
            for bearing, motion in zip(support.bearings, motions, strict=True)
        ]
    return one.with_changes(changes)


def _over_the_torque() -> list[list[str]]:
    """Misalignment and K_Hbeta with rolling bearings, with their stiffness under 130 N m, and on rigid supports."""
    torques = [20.0, 40.0, 80.0, 130.0, 200.0, 260.0]
    one = scene().with_changes({"analysis.torques_Nm": torques})
    at_130 = scene().with_changes({"analysis.torques_Nm": [130.0], "analysis.positions": 3})
    linear = _analysed(_linear(at_130).with_changes({"analysis.torques_Nm": torques, "analysis.positions": 5}))
    rolling, rigid = _analysed(one), _analysed(one.with_changes({"pinion.shaft": None, "wheel.shaft": None}))
    figures = rolling.key_figures()
    return [
        [
            f"{torque:g}",
            *formatted(".2f", *(float(each.misalignment[t].mean()) for each in (rolling, linear))),
            *formatted(".3f", *(float(each.face_load_factor[t]) for each in (rolling, linear, rigid))),
            *formatted(".0f", *(figures[t][name] for name in ("pinion_element_force_N", "pinion_bearing_life_Mrev"))),
        ]
        for t, torque in enumerate(torques)
    ]


def _times() -> list[list[str]]:
    """Processor time of analyses with bending teeth at one torque, over that of rigid supports."""
    plain = read_scene(SCENES / "helical_on_rolling_bearings.toml").with_changes({"analysis.torques_Nm": [130.0]})
    linear = plain.with_changes(
        {
            f"{gear}.shaft.bearings": getattr(read_scene(SCENES / "helical_on_shafts.toml"), gear).shaft.bearings
            for gear in ("pinion", "wheel")
        }
    )
    scenes = {"rigid": plain.with_changes({"pinion.shaft": None, "wheel.shaft": None})}
    scenes |= {"shafts on linear bearings": linear, "shafts on rolling bearings": plain}
    calls = {name: partial(_analysed, one) for name, one in scenes.items()}
    take_times(calls, 1)  # makes the models of teeth
    taken = take_times(calls, RUNS, time.process_time)
    return [
        [name, f"{seconds:.2f}", f"{median_ratio(taken[name], taken['rigid']):.1f}"]
        for name, seconds in medians(taken).items()
    ]


def _text(compared: str, over_the_torque: str, times: str) -> str:
    return f"""# Rolling bearings by their inner geometry

Written by `python -m validation.loaded.rolling_bearings`; {machine()}.

The method is in [shafts and bearings](../how_it_works/supports.md).

## Beside numbers of others, and gears really moved

A ball bearing of 7 balls of 11.5 mm on 43.5 mm by a commercial program; Stribeck's numbers; factors of ISO 281; the
helical pair of `examples/scenes/helical_on_rolling_bearings.toml`, {CELLS} x {CELLS} cells, beside rigid analyses
repeated with the wheel where the loads move both shafts. Where the expected number is 0, the error is absolute.

| quantity | source | expected | here | error |
| --- | --- | --- | --- | --- |
{compared}

## Misalignment over the torque

The same pair with flanks alone: with its rolling bearings, with linear bearings that have the stiffness of the rolling
bearings under 130 N m, and on rigid supports. The last two columns have the largest element force [N] and the shortest
life [1e6 revolutions] of the pinion's bearings. With linear bearings the misalignment is proportional to the torque, as
far as the load stays in its place. In rolling bearings small torques already close the clearances; under larger torques
the bearings become stiffer.

| torque [N m] | F_beta rolling [um] | linear [um] | K_Hbeta rolling | linear | rigid | element force | life |
| --- | --- | --- | --- | --- | --- | --- | --- |
{over_the_torque}

## Time

Nine positions, one torque, teeth that bend, models of teeth kept; processor time of one thread, medians of {RUNS} runs
that take turns.

| supports | seconds | over rigid ones |
| --- | --- | --- |
{times}

Before the cycle itself the pair is moved and solved at a few positions. A balance of a shaft on its bearings takes some
milliseconds, about a hundredth of this additional time.
"""


if __name__ == "__main__":
    write_page(__doc__, page)
