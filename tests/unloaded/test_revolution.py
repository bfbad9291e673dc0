"""Rigid transmission error over a revolution: flanks that are really turned, closed forms, invariances."""

import copy
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.tooth_deviations import ToothDeviations, random_index
from loaded_tca.scene import read_scene
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.revolution import trace_revolution
from tests.samples.gear_pairs import gear_pair
from validation.loaded.revolution import error_of_turned_flanks

ROUNDING = 1e-12
"""Asked for [mm]: the rigid transmission error is that of flanks that are really turned."""
RELIEF = FlankModifications(lead_crowning=0.006, profile_crowning=0.004)
SCENES = {
    "bevel": "mesh_cycle_bevel",
    "face-milled": "face_milled_19x62",
}


def pair_of(kind, driving="pinion", sense="positive"):
    if kind in SCENES:
        return read_scene(f"examples/scenes/{SCENES[kind]}.toml").pair()
    helix = {"spur": 0.0, "helical": 15.0}[kind]
    return gear_pair(RELIEF, RELIEF, teeth=(17, 24), helix_deg=helix, driving=driving, sense=sense)


def none(teeth):
    return ToothDeviations(np.zeros(teeth))


def deviations_of(pair, seed, eccentricity=(0.0, 0.0)):
    generator = np.random.default_rng(seed)
    return tuple(
        ToothDeviations(generator.normal(0.0, 0.004, teeth), offset, 0.7)
        for teeth, offset in zip(pair.teeth, eccentricity, strict=True)
    )


@pytest.mark.parametrize(
    ("kind", "driving", "sense"),
    [
        ("spur", "pinion", "positive"),
        pytest.param("helical", "pinion", "positive", marks=pytest.mark.thorough),
        ("helical", "wheel", "positive"),
        pytest.param("helical", "pinion", "negative", marks=pytest.mark.thorough),
        pytest.param("bevel", "pinion", "positive", marks=pytest.mark.thorough),
        pytest.param("face-milled", "pinion", "positive", marks=pytest.mark.thorough),
    ],
)
def test_rigid_transmission_error_is_that_of_flanks_really_turned(kind, driving, sense):
    pair = pair_of(kind, driving, sense)
    deviations = deviations_of(pair, 3)
    path = trace_revolution(pair, deviations, pitches=3, per_pitch=4, first_teeth=(5, 2))
    expected = [error_of_turned_flanks(pair, deviations, path, n, n // 4) for n in range(len(path))]
    assert_allclose(path.transmission_error * pair.base_radii[1], expected, atol=ROUNDING)


@pytest.mark.parametrize("kind", ["spur", "helical", "bevel"])
def test_alike_teeth_repeat_with_every_pitch(kind):
    pair = pair_of(kind)
    path = trace_revolution(pair, (none(pair.teeth[0]), none(pair.teeth[1])), pitches=3, per_pitch=5)
    error = path.transmission_error.reshape(3, 5)
    assert np.array_equal(error[0], error[2])
    assert np.array_equal(path.pinion_tooth[5:], (path.pinion_tooth[:-5] + 1) % pair.teeth[0])


def test_unloaded_contacts_of_one_pitch_serve_all_pitches():
    pair = pair_of("helical")
    deviations = none(17), deviations_of(pair, 1)[1]
    path = trace_revolution(pair, deviations, pitches=24, per_pitch=4)
    assert len(path.contacts) <= 4 * len(path.pairs) + 4
    points = [point for n in (1, 5) for number, point, *_ in path.pairs_at(n) if number == 0]
    assert points[0] is points[1]


@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("gear", [0, 1])
def test_eccentric_axis_shifts_all_pairs_together_as_the_displaced_gear_does(gear, sense):
    """The whole gear is displaced: at each position another mounting of the pair, right to e^2."""
    eccentricity, teeth = 0.01, (17, 24)
    pair = gear_pair(RELIEF, RELIEF, teeth=teeth, helix_deg=15.0, sense=sense)
    offsets = [0.0, 0.0]
    offsets[gear] = eccentricity
    deviations = tuple(ToothDeviations(np.zeros(z), e, 0.7) for z, e in zip(teeth, offsets, strict=True))
    path = trace_revolution(pair, deviations, pitches=teeth[gear], per_pitch=1)
    nominal = trace_revolution(pair, (none(17), none(24)), pitches=teeth[gear], per_pitch=1)
    assert_allclose(path.initial_separation, nominal.initial_separation, rtol=0, atol=ROUNDING, equal_nan=True)
    second_order = 2.0 * eccentricity**2 / min(pair.base_radii)
    for n in range(0, len(path), 4):
        phi1 = path.pinion_angle[n]
        azimuth = 0.7 + pair.sense * phi1 if gear == 0 else 0.7 - pair.sense * pair.ratio * phi1 + math.pi
        towards = eccentricity * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
        shift = towards if gear else -towards  # of the wheel against the pinion
        moved = copy.copy(pair)
        object.__setattr__(moved, "wheel_origin", pair.wheel_origin + shift)
        tooth = path.pairs[np.argmin(np.nan_to_num(path.initial_separation[n], nan=1.0))]
        own = -tooth * pair.pitch
        expected = trace_contact(moved, [own], warn=False).transmission_error[0] * pair.base_radii[1]
        assert path.transmission_error[n] * pair.base_radii[1] == pytest.approx(expected, abs=second_order)


def test_eccentric_wheel_has_the_closed_form():
    """TE r_b2 = -(e_x sin alpha_wt + e_y cos alpha_wt) of involutes, the eccentricity turning with the wheel."""
    pair = gear_pair(teeth=(17, 24))
    eccentric = ToothDeviations(np.zeros(24), 0.006, 0.3)
    path = trace_revolution(pair, (none(17), eccentric), pitches=24, per_pitch=2)
    azimuth = 0.3 - pair.ratio * path.pinion_angle + math.pi  # the wheel's x axis points to the pinion
    alpha = math.acos(sum(pair.base_radii) / pair.wheel_origin[0])
    expected = -0.006 * (np.cos(azimuth) * math.sin(alpha) + np.sin(azimuth) * math.cos(alpha))
    assert_allclose(path.transmission_error * pair.base_radii[1], expected, atol=ROUNDING)


@pytest.mark.parametrize("gear", [0, 1])
def test_revolution_that_begins_with_later_teeth_finds_the_gears_turned_as_far(gear):
    """As the fourth pitch of a revolution from the first teeth on: eccentricity turns with its gear."""
    pair = gear_pair(teeth=(17, 24))
    deviations = [none(17), none(24)]
    deviations[gear] = ToothDeviations(np.zeros(pair.teeth[gear]), 0.006, 0.3)
    whole = trace_revolution(pair, tuple(deviations), pitches=5, per_pitch=2)
    later = trace_revolution(pair, tuple(deviations), pitches=2, per_pitch=2, first_teeth=(3, 3))
    scale = pair.base_radii[1]
    assert_allclose(later.transmission_error * scale, whole.transmission_error[6:] * scale, atol=ROUNDING)
    assert np.ptp(whole.transmission_error[::2]) * scale > 1e-3


@pytest.mark.thorough
def test_deviations_that_bring_a_farther_pair_into_reach_are_seen():
    """All but one tooth of the wheel are set back by nearly as much as allowed: its edges go on touching long after."""
    pair = gear_pair(teeth=(17, 24))
    index = np.full(24, 0.14)
    index[6] = -0.14
    path = trace_revolution(pair, (none(17), ToothDeviations(index)), pitches=12, per_pitch=16)
    numbers = np.arange(-3, 16)
    own = path.pinion_angle[:, None] - numbers * pair.pitch
    every = trace_contact(pair, own.ravel(), warn=False).transmission_error.reshape(own.shape) * pair.base_radii[1]
    expected = np.nanmax(every - index[numbers % 24], axis=1)
    assert_allclose(path.transmission_error * pair.base_radii[1], expected, atol=ROUNDING)
    assert (np.nanargmax(every - index[numbers % 24], axis=1) == 9).sum() > 1.7 * 16  # the contact ratio is 1.6


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(("teeth", "single", "cumulative"), [(34, 8.5, 28.0), (57, 9.0, 32.0), (200, 7.5, 38.0)])
def test_random_deviations_fill_both_tolerances(teeth, single, cumulative, seed):
    index = random_index(teeth, single, cumulative, seed)
    assert np.abs(index - np.roll(index, 1)).max() == pytest.approx(single, rel=1e-9)
    assert np.ptp(index) == pytest.approx(cumulative, rel=1e-6)
    assert index.mean() == pytest.approx(0.0, abs=1e-12)  # um; a mean of amounts of 10


@pytest.mark.parametrize("teeth", [5, 7, 11, 17])
def test_random_deviations_of_few_teeth_stay_within_both_tolerances(teeth):
    for seed in range(20):
        index = random_index(teeth, 5.0, 14.0, seed)
        assert np.abs(index - np.roll(index, 1)).max() <= 5.0 * (1.0 + 1e-9)
        assert np.ptp(index) <= 14.0 * (1.0 + 1e-6)
