"""Change of the gap with keys of the scene: against differences of gaps on a held grid, and closed forms."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene, sample_separation, trace_contact
from loaded_tca.separation.gap_change import contact_changes
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.pair_change import PairChange, Places, pair_changes
from tests.refusals import refusals
from tests.samples.results import SCENES

AGREEMENT = 1e-6
"""Asked for, of the largest change on the grid."""
LENGTHS = {"um": 0.5, "deg": 2e-4, "mm": 2e-4}
"""Steps of the differences of gaps: not those of the code under test."""
MODIFIED = {
    "lead_crowning_um": 4.0,
    "end_relief_um": 3.0,
    "end_relief_length_mm": 6.0,
    "profile_crowning_um": 3.0,
    "tip_relief_um": 12.0,
    "root_relief_um": 9.0,
    "helix_slope_um": -3.0,
    "profile_slope_um": 2.0,
    "twist_um": 4.0,
}
MOUNTING = {
    "cylindrical": (
        "in_plane_deg",
        "out_of_plane_deg",
        "misalignment_um",
        "centre_distance_error_mm",
        "axial_offset_mm",
    ),
    "bevel": ("offset_mm", "pinion_axial_mm", "wheel_axial_mm", "shaft_angle_error_deg"),
}


def scene_of(name, **changes):
    scene = read_scene(SCENES / f"{name}.toml")
    return scene.with_changes(changes)


def modified(gear, starts, **more):
    values = {**MODIFIED, **starts, **more}
    return {f"{gear}.modifications.{name}": value for name, value in values.items()}


def grid_of(scene, turn=0.2, cells=(12, 14)):
    """Pair, contact and separation of a position, in a box that the flanks fill."""
    pair = scene.pair()
    contact = trace_contact(pair, [turn * pair.pitch])[0]
    return (
        pair,
        contact,
        sample_separation(pair, contact, cells=cells, box=(0.25 * pair.module, 0.35 * pair.face_width)),
    )


def difference(scene, key, contact, separation, steps):
    """Central difference of the gap on the held grid, contact and axes."""
    *sections, name = key.split(".")
    value, step = scene, steps[key.rpartition("_")[2]]
    for section in (*sections, name):
        value = getattr(value, section)
    gaps = []
    for trial in (value - step, value + step):
        gap = NormalGap(scene.with_changes({key: trial}).pair(), contact, separation.axes)
        gaps.append(gap.at(separation.x[None, :, None], separation.y[None, None])[0][0])
    there = np.isfinite(separation.cut_gap)
    return np.where(there, (gaps[1] - gaps[0]) / (2.0 * step), 0.0)


def grown(pair, contact, separation, scene, keys):
    """Growth of the gap with the gears held, (keys, nx, ny); zero where there is no material."""
    there = np.isfinite(separation.cut_gap)
    found = np.zeros((len(keys), *there.shape))
    found[:, there] = contact_changes(pair, [contact], [separation], [there], pair_changes(scene, keys)).held_gaps
    return found


def check(scene, keys, steps=LENGTHS):
    pair, contact, separation = grid_of(scene)
    found = grown(pair, contact, separation, scene, keys)
    for key, change in zip(keys, found, strict=True):
        expected = difference(scene, key, contact, separation, steps)
        assert np.abs(expected).max() > 0.0, key
        assert_allclose(change, expected, rtol=0, atol=AGREEMENT * np.abs(expected).max(), err_msg=key)


CYLINDRICAL = {
    **modified("pinion", {"tip_relief_start_mm": 105.5, "root_relief_start_mm": 105.0}),
    **modified("wheel", {"tip_relief_start_mm": 176.5, "root_relief_start_mm": 176.0}, lead_crowning_form="circular"),
    "mounting.out_of_plane_deg": 0.01,
}
BEVEL = {f"pinion.modifications.{name}_um": value for name, value in (("helix_slope", 3.0), ("twist", 3.0))}
MEASURED = {"pinion.modifications.lead_crowning_um": 3.0, "wheel.modifications.profile_slope_um": 2.0}
CASES = {
    "helical": ("mesh_cycle_helical", CYLINDRICAL, MOUNTING["cylindrical"]),
    "spiral bevel": ("spiral_bevel", BEVEL, MOUNTING["bevel"]),
    "fitted": ("bspline_bevel", BEVEL, ()),
    "measured": ("measured_flank", MEASURED, ()),
}


@pytest.mark.quick_cases("spiral bevel")
@pytest.mark.parametrize("name", CASES)
def test_gap_change_of_every_key_is_the_difference_of_gaps_on_the_held_grid(name):
    file, changes, errors = CASES[name]
    scene = scene_of(file, **changes)
    keys = [f"mounting.{error}" for error in errors]
    for gear in ("pinion", "wheel"):
        values = vars(getattr(scene, gear).modifications)
        keys += [f"{gear}.modifications.{k}" for k, v in values.items() if isinstance(v, float) and v != 0.0]
    check(scene, keys)


OTHER_STARTS = {
    "by roll angle and length": (
        "mesh_cycle_helical",
        {
            **modified("pinion", {"tip_relief_start_roll_deg": 26.0, "root_relief_start_length_mm": 19.0}),
            "pinion.modifications.lead_crowning_form": "logarithmic",
            "pinion.modifications.end_relief_lower_um": 5.0,
            "pinion.modifications.end_relief_lower_length_mm": 7.0,
        },
        (
            "tip_relief_start_roll_deg",
            "root_relief_start_length_mm",
            "end_relief_lower_um",
            "end_relief_lower_length_mm",
        ),
    ),
    "of a bevel gear": (
        "straight_bevel",
        {"pinion.modifications.tip_relief_um": 8.0, "pinion.modifications.tip_relief_start_roll_deg": 24.0},
        ("tip_relief_um", "tip_relief_start_roll_deg", "lead_crowning_um"),
    ),
}


@pytest.mark.parametrize("name", OTHER_STARTS)
def test_gap_change_with_relief_starts_of_every_kind_is_the_difference_of_gaps(name):
    file, changes, names = OTHER_STARTS[name]
    scene = scene_of(file, **changes)
    check(scene, [f"pinion.modifications.{one}" for one in names])


@pytest.mark.thorough
def test_gap_change_with_machine_settings_is_the_difference_of_gaps():
    scene = scene_of("face_milled_19x62")
    keys = ["pinion.machine.radial_mm", "wheel.machine.sliding_base_mm", "wheel.cutter.convex.blade_angle_deg"]
    check(scene, keys, {"mm": 5e-3, "deg": 5e-3})  # generated flanks are known to 1e-11 mm


LEVERS = {
    "helical": ("mesh_cycle_helical", {}, ("pinion.modifications.profile_crowning_um", "mounting.misalignment_um")),
    "spiral bevel": (
        "spiral_bevel",
        BEVEL,
        (
            "pinion.modifications.helix_slope_um",
            "wheel.modifications.profile_slope_um",
            "mounting.offset_mm",
            "mounting.pinion_axial_mm",
            "mounting.shaft_angle_error_deg",
        ),
    ),
}


@pytest.mark.parametrize("name", LEVERS)
def test_levers_and_places_change_as_those_of_contact_points_traced_anew(name):
    file, changes, keys = LEVERS[name]
    scene = scene_of(file, **changes)
    pair, contact, separation = grid_of(scene, cells=(3, 3))
    changes = contact_changes(pair, [contact], [separation], [np.ones((3, 3), bool)], pair_changes(scene, keys))
    for key, found, shift in zip(
        keys, changes.at_points.levers[..., 0].T, changes.at_points.shifts[:, 0, 0], strict=True
    ):
        step, trials = LENGTHS[key.rpartition("_")[2]], []
        *sections, last = key.split(".")
        value = scene
        for section in (*sections, last):
            value = getattr(value, section)
        for trial in (value - step, value + step):
            trials.append(trace_contact(scene.with_changes({key: trial}).pair(), [contact.pinion_angle])[0])
        expected = [
            (getattr(trials[1], f"{g}_lever") - getattr(trials[0], f"{g}_lever")) / (2 * step)
            for g in ("pinion", "wheel")
        ]
        assert_allclose(found, expected, rtol=0, atol=1e-3 * np.abs(expected).max(), err_msg=key)
        moved = (trials[1].point - trials[0].point) / (2 * step)
        expected_shift, atol = moved @ separation.axes[0], 1e-3 * np.linalg.norm(moved)
        assert_allclose(shift, expected_shift, rtol=0, atol=atol, err_msg=key)


def test_gap_of_an_amount_that_may_not_fall_below_zero_grows_as_above_it():
    scene, key = scene_of("mesh_cycle_helical"), "wheel.modifications.lead_crowning_um"
    pair, contact, separation = grid_of(scene)
    at_zero = grown(pair, contact, separation, scene, [key])
    above = scene.with_changes({key: 5.0})
    five = grown(above.pair(), contact, separation, above, [key])
    # the flank is met up to 5 um away along the normal, and the normals differ by 1e-3
    assert_allclose(at_zero, five, rtol=0, atol=1e-3 * five.max())


def test_gap_of_helical_gears_grows_by_the_sine_of_the_pressure_angle_with_the_centre_distance():
    scene = scene_of("mesh_cycle_helical", **{"pinion.modifications.profile_crowning_um": 0.0})
    pair, contact, separation = grid_of(scene, cells=(3, 3))
    keys = ["mounting.centre_distance_error_mm", "mounting.axial_offset_mm"]
    apart, along = grown(pair, contact, separation, scene, keys)[:, 1, 1]
    gear, working = scene.mesh().pinion, scene.mesh().working_pressure_angle
    # at the contact point the normal is that of the plane of action, within the slope of the crowning, 1e-4
    assert_allclose(abs(apart), math.sin(working) * math.cos(gear.base_helix_angle), rtol=1e-3)
    assert_allclose(abs(along), math.sin(abs(gear.base_helix_angle)), rtol=1e-3)


test_keys_that_cannot_be_varied_are_refused_by_name = refusals(
    lambda keys: pair_changes(scene_of("mesh_cycle_helical"), keys),
    (["pinion.modifications.lead_crownin_um"], "pinion.modifications.lead_crownin_um: unknown key"),
    (["nothing"], "nothing: unknown key"),
    (["pinion.face_width_mm"], "pinion.face_width_mm: does not change the gap alone"),
    (["material.youngs_modulus_MPa"], "material.youngs_modulus_MPa: does not change the gap alone"),
    (
        ["pinion.modifications.lead_crowning_form"],
        "pinion.modifications.lead_crowning_form: does not change the gap alone",
    ),
    (["pinion.modifications.polynomial_mm"], "pinion.modifications.polynomial_mm: .* one number"),
    (["pinion.modifications.end_relief_lower_um"], "pinion.modifications.end_relief_lower_um: found None"),
    (["wheel.modifications.tip_relief_um"], "wheel.modifications.tip_relief_um: .*tip_relief_start_mm"),
    (["one", "mounting.two_mm"], ("^one: unknown key", "^mounting.two_mm: unknown key")),
)


@pytest.mark.parametrize(
    ("key", "edges", "lines"),
    [
        ("pinion.modifications.lead_crowning_um", True, True),
        ("wheel.modifications.tip_relief_start_mm", False, False),
        ("mounting.offset_mm", True, False),
        ("pinion.machine.sliding_base_mm", False, False),
    ],
)
def test_keys_move_edges_and_lines_of_force_or_hold_them(key, edges, lines):
    """Amounts of modifications move neither; mounting errors leave the flanks as they are, but move the contacts."""
    change = PairChange(key, None, None, 1.0)
    assert (change.holds_edges, change.holds_lines) == (edges, lines)


def test_grid_that_tilts_on_flanks_alike_opens_no_gap():
    """Heights and slopes of both flanks at two places: a grid that turns sees the difference of what both rise."""
    heights, slopes = np.array([0.3, -0.2]), np.array([[0.1, 0.4], [-0.3, 0.2]])
    none = np.zeros((2, 2, 2))
    alike, flat = (
        Places(None, none, none, np.stack([low, heights]), none, np.stack([low_slopes, slopes]), none)
        for low, low_slopes in ((heights, slopes), (heights, 0.0 * slopes))
    )
    assert not alike.tilt_slopes.any()
    assert_allclose(flat.tilt_slopes, heights[:, None] * slopes)
