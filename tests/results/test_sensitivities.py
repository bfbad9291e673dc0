"""Sensitivities of results: against slopes through whole analyses, closed forms, files, keys that cannot be varied."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, load_result, read_scene
from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.loaded.together import Trace
from loaded_tca.results.sensitivities import Sensitivities
from loaded_tca.scene import parse_scene
from tests.refusals import refusals
from tests.samples.results import FLANKS_ALONE, ONE_PAIR, SCENES, result
from tests.samples.shared import made_once

REAL_PAIRS = 0.03
"""Agreement asked for with analyses, of the largest slope, on 64 cells: they make boxes and grids anew."""
SOLVED = 1e-5
"""Of numbers that cancel, over their parts: linear systems are solved to 1e-7."""
LINES_HELD = 3e-4
"""Part of the mesh stiffness that is due to the motion of the forces on the teeth."""
FROM_FILE = 1e-9
"""A result of a file begins anew: contact points found again to 1e-12 mm, then a solve of the slopes that stops at
1e-6, which carries rounding on: 2e-12 was seen."""
POSITIONS = {"mesh_cycle_helical": 4, "mesh_cycle_bevel": 4, "mesh_cycle_spur": 6}
"""Of the spur pair more: a third of a pitch on, its figures do not follow a cubic over the steps."""
CROWNING, SLOPE = "pinion.modifications.lead_crowning_um", "pinion.modifications.helix_slope_um"
TORQUE = "load.pinion_torque_Nm"


@made_once
def analysed(name, bends, changes=(), cells=64, positions=None):
    wanted = {"analysis.accuracy": None, "analysis.cells": (cells, cells), "analysis.torques_Nm": None}
    wanted["analysis.positions"] = positions or POSITIONS[name]
    scene = read_scene(SCENES / f"{name}.toml").with_changes(
        {**wanted, **({} if bends else FLANKS_ALONE), **dict(changes)}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        return analyse(scene)


def value_of(scene, key):
    for part in key.split("."):
        scene = getattr(scene, part)
    return scene


def slope_through_analyses(name, bends, key, step, quantity="transmission_error", cells=64):
    """Slope of the cubic through five analyses: that in the middle counts nothing."""
    middle = value_of(analysed(name, bends, cells=cells).scene, key)
    steps = step * np.array([-1.0, -0.5, 0.5, 1.0])
    values = [getattr(analysed(name, bends, ((key, middle + by),), cells), quantity)[0] for by in steps]
    return np.einsum("i,i...->...", np.array([1.0, -8.0, 8.0, -1.0]) / (6.0 * step), values)


REAL = [
    ("mesh_cycle_helical", CROWNING, 2.0),
    ("mesh_cycle_helical", "mounting.misalignment_um", 2.0),
    ("mesh_cycle_spur", CROWNING, 2.0),
    ("mesh_cycle_spur", "pinion.modifications.tip_relief_um", 2.0),
    ("mesh_cycle_bevel", SLOPE, 1.0),
    ("mesh_cycle_bevel", "mounting.offset_mm", 3e-3),
]


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("name", "key", "step", "bends"),
    [
        *((*one, False) for one in REAL),
        *(pytest.param(*REAL[n], True, marks=pytest.mark.thorough) for n in (1, 2, 4)),
    ],  # bending: each pair, both kinds of keys
)
def test_transmission_error_of_real_pairs_changes_as_whole_analyses_do(name, key, step, bends):
    expected = slope_through_analyses(name, bends, key, step)
    found = analysed(name, bends).sensitivities([key]).transmission_error[0, :, 0]
    assert_allclose(found, expected, rtol=0, atol=REAL_PAIRS * np.abs(expected).max())


@pytest.mark.quick_cases("transmission_error-32-0.005")
@pytest.mark.parametrize(
    ("name", "cells", "agreement"),
    [("transmission_error", 32, 5e-3), ("line_load", 64, 5e-3), ("face_load_factor", 64, REAL_PAIRS)],
)
def test_bending_follows_a_contact_that_a_relief_moves_up_the_tooth(name, cells, agreement):
    key = "wheel.modifications.tip_relief_um"  # where bending stays behind they are 1.6, 2.5 and 14 % off
    expected = slope_through_analyses("mesh_cycle_spur", True, key, 1.0, name, cells)
    found = getattr(analysed("mesh_cycle_spur", True, cells=cells).sensitivities([key]), name)[0, ..., 0]
    assert_allclose(np.nan_to_num(found), np.nan_to_num(expected), rtol=0, atol=agreement * np.nanmax(np.abs(expected)))


WAYS = 0.05
"""Agreement of what ways do to derivatives, of the largest: middles lie after a first balance, by laws after Hertz."""


def test_contacts_go_along_their_paths_by_half_of_what_a_key_adds_to_their_ways(monkeypatch):
    key, step, middles = "mounting.pinion_axial_mm", 1e-3, {}
    grid = {"analysis.cells": (16, 16), "analysis.positions": 3}
    scene = read_scene(SCENES / "straight_bevel.toml").with_changes(grid)

    def traced(contacts, angles, gears):
        """At the middles that the contacts of the scene have."""
        angles = [middles.setdefault(round(one.pinion_angle, 9), at) for one, at in zip(contacts, angles, strict=True)]
        return Trace(contacts, angles, gears)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        moved = analyse(scene.with_changes({key: step}))
        monkeypatch.setattr("loaded_tca.loaded.load_sharing.Trace", traced)
        base, held = analyse(scene), analyse(scene.with_changes({key: step}))
    found = base.sensitivities([key]).transmission_error
    monkeypatch.setattr("loaded_tca.results.gap_growth.NO_WAY", np.inf)
    by_ways = (found - base.sensitivities([key]).transmission_error)[0, :, 0]
    expected = (moved.transmission_error - held.transmission_error)[0] / step
    assert_allclose(by_ways, expected, rtol=0, atol=WAYS * np.abs(expected).max())


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["load_share", "line_load", "peak_pressure"])
def test_figures_of_tooth_pairs_of_a_helical_pair_change_as_whole_analyses_do(name):
    same, first = analysed("mesh_cycle_helical", False), (0, 0)  # in the middle a corner carries 2 % on a few cells
    expected = slope_through_analyses("mesh_cycle_helical", False, CROWNING, 0.5, name)[0]
    found = getattr(same.sensitivities([CROWNING]), name)[*first, :, 0]
    carries = same.load_share[first] > 0.0
    assert carries.sum() == 2
    assert_allclose(found[carries], expected[carries], rtol=REAL_PAIRS)


def test_peak_pressures_follow_contacts_that_a_profile_crowning_moves_over_their_grids():
    key, step, fewer = "pinion.modifications.profile_crowning_um", 0.2, {"cells": 32, "positions": 2}
    middle = analysed("mesh_cycle_bevel", False, **fewer)
    value = value_of(middle.scene, key)
    low, high = (
        analysed("mesh_cycle_bevel", False, ((key, value + by),), **fewer).peak_pressure for by in (-step, step)
    )
    slope = (high - low) / (2.0 * step)
    assert not middle.on_edge.any()
    # grids that stay are 8 % off
    assert_allclose(
        middle.sensitivities([key]).peak_pressure[..., 0], slope, rtol=0.0, atol=REAL_PAIRS * np.nanmax(np.abs(slope))
    )
    # on supports that hardly give way they are those of rigid ones
    supported = analyse(middle.scene.with_changes({"pinion.support.compliance": (1e-12 * np.eye(6)).tolist()}))
    peaks = [one.sensitivities([key]).peak_pressure[..., 0] for one in (supported, middle)]
    # two analyses, each solved to 1e-6: of the largest slope, beside which that of the other contact is a hundredth
    assert_allclose(*peaks, rtol=0.0, atol=1e-3 * np.nanmax(np.abs(peaks)))


def test_load_shares_of_all_pairs_change_by_nothing_together():
    found = result("mesh_cycle_helical").sensitivities([CROWNING, SLOPE, TORQUE]).load_share
    found = found / np.nanmax(np.abs(found), axis=(0, 1, 2))
    assert_allclose(np.nansum(found, axis=2), 0.0, atol=SOLVED)


@pytest.mark.thorough
def test_transmission_error_changes_with_the_torque_as_between_two_analyses():
    one = analysed("mesh_cycle_helical", False)
    step = 2.0
    around = [analysed("mesh_cycle_helical", False, ((TORQUE, 130.0 + by),)) for by in (-step, step)]
    expected = (around[1].transmission_error - around[0].transmission_error)[0] / (2.0 * step)
    found = one.sensitivities([TORQUE]).transmission_error[0, :, 0]
    assert_allclose(found, expected, rtol=REAL_PAIRS)
    assert (found < 0.0).all(), "the wheel stays behind the pinion that drives it"


def test_lead_crowning_of_either_gear_counts_alike():
    one = analysed("mesh_cycle_helical", False)
    found = one.sensitivities([CROWNING, "wheel.modifications.lead_crowning_um"]).transmission_error[0]
    assert_allclose(found[:, 0], found[:, 1], rtol=1e-3)


@pytest.mark.filterwarnings("ignore:edges of both gears lie")  # faces are of one width
def test_tooth_pair_that_carries_all_has_sensitivities_too():
    one = analysed("mesh_cycle_helical", False, tuple(ONE_PAIR.items()), 32)
    found = one.sensitivities(["mounting.axial_offset_mm", CROWNING])
    gear = one.scene.mesh().pinion
    assert_allclose(
        found.transmission_error[0, 1, 0] * one.wheel_base_radius, np.tan(abs(gear.base_helix_angle)), rtol=1e-3
    )
    assert_allclose(found.load_share, 0.0, atol=SOLVED)


@pytest.mark.filterwarnings("ignore:an edge of a flank cuts the slices")
@pytest.mark.filterwarnings("ignore:K_Hbeta follows the strip with")
@pytest.mark.filterwarnings("ignore:a tooth pair with")
def test_sensitivities_of_a_result_from_a_file_are_those_of_the_analysis(tmp_path):
    one = result("mesh_cycle_helical")
    one.save(tmp_path / "result.nc")
    keys = [CROWNING, "mounting.out_of_plane_deg"]
    found = load_result(tmp_path / "result.nc").sensitivities(keys)
    kept = one.sensitivities(keys)
    assert_allclose(found.transmission_error, kept.transmission_error, rtol=FROM_FILE)
    assert found.keys == tuple(keys)
    assert_allclose(found.line_load, kept.line_load, rtol=FROM_FILE, atol=FROM_FILE * np.nanmax(np.abs(kept.line_load)))
    assert found.dataset["load_share"].dims == ("torque", "position", "pair", "key")
    assert found.dataset["key"].values.tolist() == keys


def test_peak_to_peak_and_harmonics_follow_from_the_positions():
    one = result("mesh_cycle_helical", positions=9)
    found, step = one.sensitivities([CROWNING]), 1e-3
    moved = one.transmission_error + step * found.transmission_error[..., 0]
    span = (np.ptp(moved, axis=1) - np.ptp(one.transmission_error, axis=1)) / step
    assert_allclose(found.peak_to_peak[:, 0], span, rtol=1e-6)
    waves = [np.abs(np.fft.rfft(error[:, :-1])[:, 1:4]) / 4.0 for error in (one.transmission_error, moved)]
    assert_allclose(found.harmonics(3)[..., 0], (waves[1] - waves[0]) / step, rtol=1e-3)


@pytest.mark.thorough
def test_load_factor_changes_as_whole_analyses_do():
    key = "pinion.modifications.tip_relief_um"  # of one that moves no load along the face the strips stay
    expected = slope_through_analyses("mesh_cycle_spur", False, key, 1.0, "face_load_factor")
    found = analysed("mesh_cycle_spur", False).sensitivities([key]).face_load_factor[0]
    assert_allclose(found, expected, rtol=REAL_PAIRS)


@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")
def test_pressure_at_edges_grows_with_the_root_of_the_relative_curvature(monkeypatch):
    """That of line contacts: 1 % more of line load times curvature is 1/2 % of pressure, beside what forces change."""
    one, slopes = result("mesh_cycle_helical"), []
    for growth in (0.0, 0.01):
        fixed = np.array([[growth]])
        monkeypatch.setattr("loaded_tca.results.sensitivities.curvature_growth", lambda *_, fixed=fixed: fixed)
        slopes.append(one.sensitivities([CROWNING]).peak_pressure[..., 0])
    grown = (slopes[1] - slopes[0]) / one.peak_pressure
    rough = (one.on_edge > 0) & (np.abs(grown) > 0.0)
    assert rough.any()
    assert_allclose(grown[rough], 0.005, rtol=1e-6)


def test_pressures_of_pairs_that_only_just_carry_at_an_edge_are_marked():
    share, on_edge = np.array([[[0.02, 0.02, 0.4]]]), np.array([[[1, 0, 1]]])
    one = SimpleNamespace(
        result=SimpleNamespace(load_share=share, on_edge=on_edge),
        tangents=SimpleNamespace(grids=[]),
        _rough_peaks=[],
        _where=lambda _: np.zeros(share.shape, dtype=bool),
    )
    assert Sensitivities.at_corners.func(one).tolist() == [[[True, False, False]]]


def test_pressure_norm_of_a_position_is_near_its_peak_and_changes_with_it():
    one = analysed("mesh_cycle_spur", False)
    found = one.sensitivities([TORQUE])
    place = 0, 0  # two contacts alike
    norm, peak = found.pressure_norm(200.0)[*place, 0], np.nanmax(found.peak_pressure[*place, :, 0])
    assert_allclose(norm, peak, rtol=0.05)  # as the 200th root of their areas over 1 mm^2, and of two


def test_pressure_norm_grows_with_the_torque_as_between_two_analyses():
    """Half a pitch before the pitch point, where two contacts are alike."""
    step = 1.0
    norms = []
    for by in (-step, step):
        one = analysed("mesh_cycle_spur", False, ((TORQUE, 130.0 + by),), positions=2)
        (parts,) = [[m for m in row if m is not None] for row in one.maps[0][:1]]
        norms.append(sum((m.pressure**8).sum() * m.spacing[0] * m.spacing[1] for m in parts) ** 0.125)
    one = analysed("mesh_cycle_spur", False, ((TORQUE, 130.0),), positions=2)
    found = one.sensitivities([TORQUE]).pressure_norm(8.0)[0, 0, 0]
    assert_allclose(found, (norms[1] - norms[0]) / (2.0 * step), rtol=REAL_PAIRS)


@pytest.mark.quick_cases(
    "mesh_cycle_helical-changes0-flanks alone",
    "mesh_cycle_bevel-changes1-flanks alone",
    "spur-changes2-flanks alone",
    "spur-changes2-bending",
)
@pytest.mark.parametrize("bends", [False, True], ids=["flanks alone", "bending"])
@pytest.mark.parametrize(
    ("name", "changes"), [("mesh_cycle_helical", {}), ("mesh_cycle_bevel", {}), ("spur", ONE_PAIR)]
)
def test_transmission_error_changes_with_the_torque_by_the_inverse_of_the_mesh_stiffness(name, changes, bends):
    one = analysed(name, bends, tuple(changes.items()), 48, 3)
    found = one.sensitivities([TORQUE]).transmission_error[..., 0]  # rad per N m
    lengths = 1e3 * np.prod(one.gear_pair.base_radii) * one.face_width
    # the stiffness holds the places of the forces on the teeth, which the transmission error lets follow: 1e-4 was seen
    agreement = LINES_HELD if bends else SOLVED
    assert_allclose(1e3 / found, -one.gear_pair.driving * lengths * one.mesh_stiffness, rtol=agreement)


def test_maps_of_weights_take_the_same_off_the_transmission_error_as_even_removal():
    one = result("mesh_cycle_helical")
    found = one.sensitivities([CROWNING])
    for t, n in np.ndindex(one.transmission_error.shape):
        parts = [part for part in found.weight_maps[t][n] if part is not None]
        assert_allclose(sum(part.sum() for part in parts) * one.path.wheel_lever[n], 1.0, rtol=1e-3)
        assert all(
            (part[pressed.pressure == 0.0] == 0.0).all()
            for part, pressed in zip(parts, (m for m in one.maps[t][n] if m is not None), strict=True)
        )


@pytest.mark.filterwarnings("ignore:an edge of a flank cuts the slices")
@pytest.mark.filterwarnings("ignore:K_Hbeta follows the strip with")
def test_spread_adds_up_the_squares_of_independent_deviations():
    one = result("mesh_cycle_helical")
    found = one.sensitivities([CROWNING, SLOPE])
    both = found.spread({CROWNING: 2.0, SLOPE: 3.0})
    for name in ("transmission_error", "peak_pressure", "face_load_factor"):
        slopes = getattr(found, name)
        # also below: a root of two squares, 1e-16 seen
        assert_allclose(both[name], np.hypot(2.0 * slopes[..., 0], 3.0 * slopes[..., 1]), rtol=1e-12)
    assert_allclose(found.spread({SLOPE: 3.0})["peak_to_peak"], 3.0 * np.abs(found.peak_to_peak[:, 1]), rtol=1e-12)


test_spread_under_deviations_that_are_none_is_one_clear_error = refusals(
    lambda deviations: result("mesh_cycle_helical").sensitivities([CROWNING]).spread(deviations),
    ({"nothing": 1.0}, "nothing: is none of the keys"),
    ({CROWNING: -1.0}, "found -1.0"),
    ({CROWNING: "1"}, "found '1'"),
    ({}, "none given"),
    ([CROWNING], "allowed a mapping"),
)


def test_result_without_any_load_has_no_sensitivities():
    with pytest.raises(InputError, match="no tooth pair of the result carries load"):
        result("mesh_cycle_helical", torques=(0.0,)).sensitivities([CROWNING])


def test_state_without_load_has_no_sensitivities():
    one = result("mesh_cycle_helical", torques=(0.0, 130.0))
    found = one.sensitivities([CROWNING])
    assert np.isnan(found.transmission_error[0]).all()
    assert np.isfinite(found.transmission_error[1]).all()
    assert np.isnan(found.peak_to_peak[0]).all()
    assert np.isfinite(found.peak_to_peak[1]).all()


test_keys_that_are_no_parameters_are_one_clear_error = refusals(
    lambda keys: result("mesh_cycle_helical").sensitivities(keys),
    (["pinion.modifications.lead_crownin_um"], "unknown key"),
    (["pinion.teeth"], "does not change the gap alone"),
    ([CROWNING, CROWNING], "given twice"),
    (CROWNING, "allowed is a list of keys"),
    (None, "allowed is a list of keys"),
    ([], "none given"),
    ([CROWNING, 3], "3 is no text"),
)


END_RELIEF = """
[pair]
type = "cylindrical"
normal_module_mm = 2.5
[pinion]
teeth = 35
face_width_mm = 26.0
[pinion.modifications]
lead_crowning_um = 3.0
profile_crowning_um = 4.0
end_relief_um = 15.0
end_relief_length_mm = 5.0
[wheel]
teeth = 71
face_width_mm = 26.0
[mounting]
misalignment_um = 5.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 135.0
[analysis]
positions = 1
compliance = "contact"
free_edges = false
cells = [16, 48]
"""


def test_transmission_error_follows_a_misalignment_into_an_end_relief():
    """Contact points go along the crown, which the end relief does not do: a grid with them had 1.5 times the slope.

    The tolerance is what slopes of analyses on 48 to 96 cells along the contact differ by, 3 % of it, and the 10 % by
    which derivatives on these grids do; what is wrong is 54 % off.
    """
    scene, key = parse_scene(END_RELIEF), "mounting.misalignment_um"

    def errors(by):
        return analyse(scene.with_changes({key: 5.0 + by})).transmission_error[0, 0]

    slope = analyse(scene).sensitivities([key]).transmission_error[0, 0, 0]
    assert_allclose(slope, (errors(1.0) - errors(-1.0)) / 2.0, rtol=0.15)
