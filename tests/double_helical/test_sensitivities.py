"""Derivatives of double helical pairs: the balance differentiated, changes of halves, whole analyses, refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError
from loaded_tca.double_helical import analyse_double_helical
from loaded_tca.double_helical.balance import HalfLaw, Halves, shared
from loaded_tca.double_helical.sensitivities import _changes_of_half, _grown
from loaded_tca.separation.pair_change import number_at
from tests.samples.double_helical import analysed, equal_halves, unlike_halves

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
SLOPE, CROWNING = "pinion.half_b.modifications.helix_slope_um", "pinion.modifications.lead_crowning_um"
APEX, TORQUE = "pair.apex_offset_mm", "load.pinion_torque_Nm"
ROUNDING = 1e-12  # of products of a few slopes


def test_balance_grows_as_differences_of_it():
    """Two bent laws that rise by 3 and -2 mm for a unit of one key, the whole force by 50 N for one of another."""
    forces, rate, moved = np.array([200.0, 1000.0, 2000.0]), 0.5, np.array([3.0, -2.0])
    whole = 1500.0

    def balance(parted, total, stiffness):
        laws = [
            HalfLaw(
                forces,
                (size * forces**0.9 + parted * u)[:, None],
                (0.9 * size * forces**-0.1)[:, None],
                np.array([parted * u]),
            )
            for size, u in zip((2e-5, 3e-5), moved, strict=True)
        ]
        return laws, shared(Halves((laws[0], laws[1]), (0.001, 0.0), rate, stiffness), np.array([total]))

    for stiffness in (0.0, 2e4, np.inf):
        laws, state = balance(0.0, whole, stiffness)
        soft = [
            law.at(state.force[..., half].ravel(), np.zeros(1, int))[1].reshape(1, 1, 1)
            for half, law in enumerate(laws)
        ]
        given = [np.array([[[u, 0.0]]]) for u in moved]
        grown = _grown(given, soft, np.array([0.0, 50.0]), state.force, rate, stiffness)
        moves = [balance(x, whole, stiffness)[1] for x in (-1e-7, 1e-7)]
        rises = [balance(0.0, whole + 50.0 * x, stiffness)[1] for x in (-1e-3, 1e-3)]
        for key, (step, ends) in enumerate(((1e-7, moves), (1e-3, rises))):
            for name, numbers in (("force", grown.forces), ("motion", grown.motion), ("approach", grown.approach)):
                difference = (getattr(ends[1], name) - getattr(ends[0], name)) / (2.0 * step)
                # differences of forces to 1e-14 of the whole over the step; their bends are of the order of 1e-7
                size = max(np.abs(difference).max(), 1e-9)
                assert_allclose(numbers[..., key], difference, rtol=1e-5, atol=1e-5 * size)


def test_halves_change_with_mounting_errors_of_the_whole_wheel():
    scene, lever = unlike_halves(), 30.0  # from the middle of the groove to that of a half
    for half, sign in enumerate((1.0, -1.0)):
        changes, parted = _changes_of_half(scene, half, "mounting.in_plane_deg")
        assert_allclose(changes["mounting.in_plane_deg"], sign, rtol=1e-9)
        assert_allclose(changes["mounting.centre_distance_error_mm"], sign * lever * np.pi / 180.0, rtol=1e-9)
        assert parted == 0.0
        across = _changes_of_half(scene, half, "mounting.out_of_plane_deg")[1]
        angle = scene.mesh().working_pressure_angle
        assert_allclose(abs(across), lever * np.cos(angle) * np.pi / 180.0, rtol=1e-9)
    assert _changes_of_half(scene, 0, SLOPE) == ({}, 0.0)
    assert _changes_of_half(scene, 1, SLOPE) == ({SLOPE.replace("half_b.", ""): 1.0}, 0.0)
    assert _changes_of_half(scene, 1, CROWNING) == ({}, 0.0)  # half b has its own
    assert _changes_of_half(equal_halves(), 1, CROWNING) == ({CROWNING: 1.0}, 0.0)


def test_floating_gear_follows_the_apex_alone_and_slopes_by_half():
    slopes = analysed()[0].sensitivities([APEX, SLOPE, TORQUE])
    assert_allclose(slopes.axial_motion[..., 0], 1.0, rtol=ROUNDING)  # the pinion, after the wheel
    assert_allclose(slopes.transmission_error[..., 0], 0.0, atol=ROUNDING)  # rad/mm; both halves cancel
    assert_allclose(slopes.torque_share, 0.0, atol=ROUNDING)
    result, rate = analysed()[0], abs(analysed()[0].scene.axial_rate)
    radius = result.half_b.gear_pair.base_radii[1]
    of_half = result.half_b.sensitivities([SLOPE.replace("half_b.", "")]).transmission_error[..., 0]
    # the other half turns on as well: half of the way of half b, which the motion takes
    assert_allclose(slopes.transmission_error[..., 1], 0.5 * of_half, rtol=ROUNDING)
    assert_allclose(np.abs(slopes.axial_motion[..., 1]), np.abs(0.5 * radius * of_half / rate), rtol=ROUNDING)
    stiffness = 1e3 * result.face_width * result.mesh_stiffness  # N/mm of both halves
    force = 1e3 / result.scene.mesh().pinion.base_radius
    assert_allclose(np.abs(slopes.transmission_error[..., 2]), force / stiffness / radius, rtol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("support", [{}, {"pair.floating": "none"}, {"pair.axial_stiffness_N_per_um": 20.0}])
def test_derivatives_are_differences_of_whole_analyses(support):
    crowned = {"lead_crowning_um": 30.0, "profile_crowning_um": 15.0}
    smooth = {"analysis.positions": 1, "analysis.cells": [24, 32], "load.pinion_torque_Nm": 80.0}
    halves = {"pinion.modifications": crowned, "pinion.half_b": {"modifications": {**crowned, "helix_slope_um": 4.0}}}
    scene = equal_halves().with_changes({**smooth, **halves, APEX: 0.002, **support})
    steps = {SLOPE: 0.2, "mounting.in_plane_deg": 1e-4, TORQUE: 1.0}
    result = analyse_double_helical(scene)
    slopes = result.sensitivities([*steps])
    for column, (key, step) in enumerate(steps.items()):
        value = number_at(scene, key)
        low, high = (analyse_double_helical(scene.with_changes({key: value + way})) for way in (-step, step))
        # derivatives hold the grids, whose boxes follow the contacts in whole analyses: 4e-4 of those of one half here
        for name in ("transmission_error", "torque_share"):
            difference = (getattr(high, name) - getattr(low, name)) / (2.0 * step)
            assert_allclose(getattr(slopes, name)[..., column], difference, rtol=2e-3, atol=1e-12)
        difference = (high.peak_pressure - low.peak_pressure) / (2.0 * step)
        # peaks between cells: 7 % of the smaller half
        assert_allclose(slopes.peak_pressure[..., column], difference, rtol=0.1, atol=0.02 * np.abs(difference).max())


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        (["pinion.modifications.lead_crown_um"], "pinion.modifications.lead_crown_um: unknown key"),
        ([APEX, APEX], "pair.apex_offset_mm: given twice"),
        (["pair.gap_mm"], "pair.gap_mm: there are no derivatives of both halves together; allowed are load.pinion"),
    ],
)
def test_refused(keys, words):
    with pytest.raises(InputError, match=words):
        analysed()[0].sensitivities(keys)
