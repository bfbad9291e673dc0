"""Measured flanks: what a measurement of a known flank gives back, and every grid of points that is refused."""

import math
import re
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, InputError, trace_contact
from loaded_tca.flanks import FlankModifications, MeasuredDeviations, MeasuredPoints, measured
from loaded_tca.flanks.base import unmodified
from loaded_tca.flanks.spline import pitch_point
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from tests.samples.gear_pairs import gear_pair

POINT = 1e-6  # mm
SAME = 1e-12  # rad; the parabolas of crowning and twist lie in the spline space
NONE = FlankModifications()
CROWNED = FlankModifications(lead_crowning=0.01, profile_crowning=0.005, twist=0.004)
CENTRED = FlankModifications(lead_crowning=0.01, twist=0.004)  # nothing at the pitch point
KINDS = ("spur", "helical", "straight_bevel", "spiral_bevel")


def pair_of(kind, pinion=CROWNED, wheel=NONE, **choices):
    if kind in ("spur", "helical"):
        return gear_pair(pinion, wheel, helix_deg=15.0 if kind == "helical" else 0.0, **choices)
    mesh = bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=math.radians(35.0) if kind == "spiral_bevel" else 0.0)
    return bevel_pair(mesh, modifications=(pinion, wheel), **choices)


def measure(flank, nominal, points=(9, 11), wobble=0.0):
    """Deviations of a flank from the nominal one at a grid whose points leave its lines by ``wobble`` mm."""
    rho, z = nominal.grid(*points)
    inner = np.sin(np.linspace(0.0, math.pi, points[0]))[:, None] * np.sin(np.linspace(0.0, math.pi, points[1]))
    rho, z = rho + wobble * inner * np.cos(3.0 * z), z + wobble * inner * np.sin(5.0 * rho)
    turn = nominal.side * (flank.theta(rho, z).value - nominal.theta(rho, z).value)
    return MeasuredDeviations(rho, z, turn / nominal.gradient_norm(rho, z).value)


def points_of(flank, azimuth=0.0, points=(9, 11)):
    """Cartesian points of a flank whose tooth stands at an azimuth."""
    rho, z = flank.grid(*points)
    theta = flank.theta(rho, z).value + azimuth
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=-1)


def paths(*pairs):
    angles = np.linspace(-0.5, 0.5, 7) * pairs[0].pitch
    return [trace_contact(pair, angles) for pair in pairs]


# A measured flank does what the flank does that was measured


@pytest.mark.quick_cases(*(f"0.3-{kind}" for kind in KINDS))
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("wobble", [0.0, 0.3])
def test_contact_of_measured_deviations_is_that_of_the_modifications(kind, wobble):
    pair = pair_of(kind)
    nominal = unmodified(pair.pinion.flank)
    flank = measured(nominal, measure(pair.pinion.flank, nominal, wobble=wobble), turned=False)
    exact, found = paths(pair, pair.with_flanks(pinion=flank))
    # bevel: |grad F| falls with 1/R, which no polynomial is
    point, error = (POINT, SAME) if kind in ("spur", "helical") else (1e-4, 1e-10)
    assert_allclose(found.point, exact.point, rtol=0, atol=point)
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=error)
    assert flank.fit_error.largest < 1e-12  # mm; parabolas lie in the spline space: 7e-17 seen


@pytest.mark.parametrize("choices", [{"driving": "wheel"}, {"sense": "negative"}])
def test_measured_deviations_count_along_the_normal_on_both_sides_of_the_tooth(choices):
    pair = pair_of("helical", NONE, CROWNED, **choices)
    nominal = unmodified(pair.wheel.flank)
    flank = measured(nominal, measure(pair.wheel.flank, nominal), turned=False)
    exact, found = paths(pair, pair.with_flanks(wheel=flank))
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=SAME)


def test_excess_material_makes_the_wheel_lead():
    pair = pair_of("spur", FlankModifications(lead_crowning=0.01))
    rho, z = pair.pinion.flank.grid(6, 6)
    thick = measured(pair.pinion.flank, MeasuredDeviations(rho, z, np.full(rho.shape, 0.002)), turned=False)
    exact, found = paths(pair, pair.with_flanks(pinion=thick))
    lead = (found.transmission_error - exact.transmission_error) * pair.base_radii[1]
    assert_allclose(lead, 0.002, rtol=1e-9)


@pytest.mark.quick_cases(every=5)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("azimuth", [0.0, 2.9, -1.3])
def test_contact_of_measured_points_does_not_depend_on_where_the_tooth_stood(kind, azimuth):
    pair = pair_of(kind, CENTRED)
    nominal = unmodified(pair.pinion.flank)
    flank = measured(nominal, MeasuredPoints(points_of(pair.pinion.flank, azimuth)))
    exact, found = paths(pair, pair.with_flanks(pinion=flank))
    point, error = (POINT, SAME) if kind in ("spur", "helical") else (1e-4, 1e-10)
    assert_allclose(found.point, exact.point, rtol=0, atol=point)
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=error)


@pytest.mark.parametrize("kind", KINDS)
def test_measured_flank_is_turned_until_it_holds_the_pitch_point(kind):
    pair = pair_of(kind)
    nominal = unmodified(pair.pinion.flank)
    place = pitch_point(nominal)
    data = measure(pair.pinion.flank, nominal)
    kept, turned = (measured(nominal, data, turned=choice) for choice in (False, True))
    assert abs(float(kept.theta(*place).value)) > 1e-8, "profile crowning removes material at the pitch point"
    # rad; the table is turned until this is none: 7e-21 seen
    assert_allclose(turned.theta(*place).value, 0.0, atol=1e-15)
    rho, z = nominal.grid(4, 4)
    # rad; of angles of 0.1: 3e-17 seen
    assert_allclose(np.ptp(turned.theta(rho, z).value - kept.theta(rho, z).value), 0.0, atol=1e-15)


def test_measured_points_that_are_not_turned_keep_their_zero():
    pair = pair_of("helical")
    nominal = unmodified(pair.pinion.flank)
    flank = measured(nominal, MeasuredPoints(points_of(pair.pinion.flank)), turned=False)
    exact, found = paths(pair, pair.with_flanks(pinion=flank))
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=SAME)


def test_deviations_from_a_modified_flank_add_to_its_modifications():
    pair = pair_of("helical", FlankModifications(lead_crowning=0.01), driving="wheel")
    extra = pair_of("helical", FlankModifications(lead_crowning=0.013), driving="wheel")
    flank = measured(pair.pinion.flank, measure(extra.pinion.flank, pair.pinion.flank))
    exact, found = paths(extra, pair.with_flanks(pinion=flank))
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=SAME)


def test_relief_starts_of_the_nominal_flank_stay():
    relief = FlankModifications(lead_crowning=0.01, tip_relief=0.02, tip_relief_form="linear", tip_relief_start=102.0)
    pair = pair_of("spur", relief)
    rho, z = pair.pinion.flank.grid(7, 7)
    flank = measured(pair.pinion.flank, MeasuredDeviations(rho, z, np.zeros((7, 7))))
    exact, found = paths(pair, pair.with_flanks(pinion=flank))
    assert len(flank.relief_starts(rho, z)) == 1
    assert exact.on_relief_start.any()
    assert (found.on_relief_start == exact.on_relief_start).all()
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=SAME)


@pytest.mark.parametrize("back", [(0,), (1,), (0, 1)])
def test_order_in_which_the_lines_were_measured_does_not_matter(back):
    pair = pair_of("spiral_bevel")
    data = measure(pair.pinion.flank, unmodified(pair.pinion.flank), wobble=0.2)
    other = MeasuredDeviations(*(np.flip(part, back) for part in (data.radius, data.axial, data.excess)))
    rho, z = pair.pinion.flank.grid(13, 13)
    values = [measured(unmodified(pair.pinion.flank), one).theta(rho, z).value for one in (data, other)]
    # rad; of angles of 0.3, the table in another order: none seen
    assert_allclose(values[1], values[0], rtol=0, atol=1e-14)


def test_fewer_coefficients_smooth_the_noise_and_the_fit_error_tells_it(rng):
    pair = pair_of("helical")
    nominal = unmodified(pair.pinion.flank)
    data = measure(pair.pinion.flank, nominal, (25, 35))
    noise = 1e-3 * rng.normal(size=data.radius.shape)
    noisy = MeasuredDeviations(data.radius, data.axial, np.asarray(data.excess) + noise)
    rough, smooth = (measured(nominal, noisy, coefficients=counts, turned=False) for counts in (None, (6, 6)))
    rho, z = nominal.grid(20, 20)
    away = [flank.distance_to(pair.pinion.flank, rho, z).std() for flank in (rough, smooth)]
    assert rough.fit_error.largest < 1e-12  # mm; as many coefficients as points: 1e-14 seen
    # 36 of 875 degrees of freedom fitted: sqrt(36/875) = 0.2 of the noise is left, and its rms is the fit error
    assert away[1] < 0.35 * away[0]
    assert_allclose(smooth.fit_error.rms, 1e-3, rtol=0.1)


def test_degree_follows_the_number_of_points():
    nominal = unmodified(pair_of("spur").pinion.flank)
    rho, z = nominal.grid(5, 9)
    assert measured(nominal, MeasuredDeviations(rho, z, 0.0 * rho)).spline.degrees == (3, 5)
    assert measured(nominal, MeasuredDeviations(rho, z, 0.0 * rho), degree=3).spline.degrees == (3, 3)


# Coverage


def test_points_that_stop_short_of_the_edges_are_continued_and_a_wide_margin_warns():
    pair = pair_of("helical")
    nominal = unmodified(pair.pinion.flank)
    whole = measure(pair.pinion.flank, nominal, (21, 21))

    def inner(first, last):
        return MeasuredDeviations(*(part[first:last, first:last] for part in (whole.radius, whole.axial, whole.excess)))

    near = measured(nominal, inner(2, 19), turned=False)
    rho, z = nominal.grid(9, 9)
    # crowning and twist are parabolas, and so is the continuation
    # rad; 3e-14 seen
    assert_allclose(near.theta(rho, z).value, pair.pinion.flank.theta(rho, z).value, rtol=0, atol=1e-12)
    with pytest.warns(AccuracyWarning, match=r"leave 20 % at the .* and 20 % at the .* of the flank uncovered"):
        measured(nominal, inner(4, 17))
    with pytest.raises(InputError, match="lengthwise: the points cover 40 % of the flank; at least 50 % is needed"):
        measured(nominal, inner(6, 15))


@pytest.mark.parametrize(("coefficients", "degree"), [(None, None), (None, 3), ((6, 6), None), ((4, 4), 3)])
def test_continuation_that_follows_the_noise_warns(coefficients, degree, rng):
    """A parabola and noise of 1 um, which even one quintic goes on with; a cubic goes on as the parabola does."""
    nominal = unmodified(pair_of("helical").pinion.flank)
    rho, z = (part[2:-2, 2:-2] for part in nominal.grid(21, 21))
    parabola = -0.012 * (z / z.max()) ** 2
    noisy = MeasuredDeviations(rho, z, parabola + 1e-3 * rng.normal(size=rho.shape))
    plain = measured(nominal, MeasuredDeviations(rho, z, parabola), turned=False)  # leaves its points by 56 %, rightly
    ends = plain.distance_to(nominal, *nominal.grid(9, 9))
    assert_allclose(ends.min(), -0.012 / 0.8**2, rtol=1e-3)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        measured(nominal, noisy, coefficients=coefficients, degree=degree)
    told = [str(one.message) for one in caught]
    if coefficients != (4, 4):
        (sentence,) = told
        assert re.match(
            r"the points deviate by -1\d.* to .* um, the flank by -\d+.* um: the flank oscillates", sentence
        )
    else:
        assert told == []


def test_flank_without_deviations_does_not_swing():
    nominal = unmodified(pair_of("helical").pinion.flank)
    rho, z = (part[2:-2, 2:-2] for part in nominal.grid(21, 21))
    flank = measured(nominal, MeasuredDeviations(rho, z, np.zeros(rho.shape)))  # warnings are errors
    assert flank.fit_error.largest == 0.0


# Refusals


def grid_of(nominal, points=(7, 9)):
    rho, z = nominal.grid(*points)
    return rho.copy(), z.copy()


def refusal(nominal, rho, z, excess=0.0, **choices):
    with pytest.raises(InputError) as caught:
        measured(nominal, MeasuredDeviations(rho, z, excess + 0.0 * rho), **choices)
    return caught.value.problems


@pytest.mark.parametrize("kind", ["helical", "spiral_bevel"])
def test_grid_that_is_too_coarse_is_refused(kind):
    nominal = unmodified(pair_of(kind).pinion.flank)
    assert refusal(nominal, *grid_of(nominal, (3, 2))) == (
        "profile: 3 points are too coarse; a B-spline of degree 3 needs 4",
        "lengthwise: 2 points are too coarse; a B-spline of degree 3 needs 4",
    )
    assert refusal(nominal, *grid_of(nominal, (5, 9)), degree=5) == (
        "profile: 5 points are too coarse; a B-spline of degree 5 needs 6",
    )
    assert refusal(nominal, *grid_of(nominal), degree=2) == ("degree: 2; allowed 3 or 5",) * 2
    assert refusal(nominal, *grid_of(nominal), coefficients=(5, 10)) == (
        "coefficients: 5 (profile); allowed 6 (degree 5) to 7, the number of points",
        "coefficients: 10 (lengthwise); allowed 6 (degree 5) to 9, the number of points",
    )


@pytest.mark.parametrize("kind", ["helical", "spiral_bevel"])
def test_folded_grid_is_refused_and_told_where(kind):
    nominal = unmodified(pair_of(kind).pinion.flank)
    rho, z = grid_of(nominal)
    for part in (rho, z):
        part[3, 4], part[4, 4] = part[4, 4], part[3, 4]
    (problem,) = refusal(nominal, rho, z)
    assert problem.startswith("points are folded, or lie on each other: 2 of 48 cells, first at radius ")


def test_points_that_lie_on_each_other_are_refused():
    nominal = unmodified(pair_of("spur").pinion.flank)
    rho, z = grid_of(nominal)
    rho[2, 3], z[2, 3] = rho[2, 2], z[2, 2]
    assert "points are folded, or lie on each other: " in refusal(nominal, rho, z)[0]


@pytest.mark.parametrize("kind", ["helical", "spiral_bevel"])
def test_unordered_grid_is_refused_and_told_which_lines(kind):
    nominal = unmodified(pair_of(kind).pinion.flank)
    rho, z = grid_of(nominal)
    order = [0, 1, 3, 2, 4, 5, 6]
    (problem,) = refusal(nominal, rho[order], z[order])
    assert problem.startswith(
        "points are out of order: the profile coordinate does not grow, or fall, all along axis 0"
    )
    assert problem.endswith("(lines 3 and 4); axes are (profile, lengthwise)")


def test_grid_with_its_axes_exchanged_is_refused():
    nominal = unmodified(pair_of("spur").pinion.flank)
    rho, z = grid_of(nominal, (8, 8))
    assert "points are out of order" in refusal(nominal, rho.T, z.T)[0]


def test_points_off_the_flank_are_refused_with_the_edge_they_pass():
    nominal = unmodified(pair_of("spur").pinion.flank)
    rho, z = grid_of(nominal)
    problems = refusal(nominal, rho + 2.0, z + 12.5)
    assert problems[0].startswith("18 of 63 points lie off the flank, up to 2 mm beyond the tip circle: wrong gear")
    assert "up to 12.5 mm beyond the end of the face at z > 0" in problems[1]
    bevel = unmodified(pair_of("spiral_bevel").pinion.flank)
    assert any("beyond the heel" in problem for problem in refusal(bevel, *(1.2 * part for part in grid_of(bevel))))


def test_deviations_larger_than_any_are_refused():
    nominal = unmodified(pair_of("spur").pinion.flank)
    (problem,) = refusal(nominal, *grid_of(nominal), excess=5.0)
    assert problem.startswith("the points lie up to 5 mm off the nominal flank along its normal, more than the 0.")


def test_points_of_the_other_side_of_the_tooth_are_refused():
    nominal = unmodified(pair_of("spiral_bevel").pinion.flank)
    other = unmodified(pair_of("spiral_bevel", driving="wheel").pinion.flank)
    with pytest.raises(InputError, match=r"off the nominal flank along its normal.*side of the tooth"):
        measured(nominal, MeasuredPoints(points_of(other)))


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_values_that_are_not_finite_are_refused_and_told_where(value):
    rho, z = grid_of(unmodified(pair_of("spur").pinion.flank))
    rho[2, 5] = value
    match = "radius: 1 values are not finite, the first at profile line 3, lengthwise line 6"
    with pytest.raises(InputError, match=match):
        MeasuredDeviations(rho, z, np.zeros((7, 9)))
    points = np.ones((4, 4, 3))
    points[0, 1, 2] = value
    with pytest.raises(
        InputError, match="points: 1 values are not finite, the first at profile line 1, lengthwise line 2"
    ):
        MeasuredPoints(points)


def test_arrays_of_other_shapes_are_refused_all_at_once():
    with pytest.raises(InputError) as caught:
        MeasuredDeviations([1.0, 2.0], [["a"]], np.zeros((0, 3)))
    assert caught.value.problems == (
        "radius: shape (2,); allowed (n, m), axes (profile, lengthwise)",
        "axial: an array (n, m) of numbers is asked for, not [['a']]",
        "excess: shape (0, 3); allowed (n, m), axes (profile, lengthwise)",
    )
    with pytest.raises(InputError, match=r"shapes radius \(2, 2\), axial \(2, 3\), excess \(2, 2\) differ"):
        MeasuredDeviations(np.ones((2, 2)), np.ones((2, 3)), np.ones((2, 2)))
    with pytest.raises(InputError, match="radius: -1 mm is not positive"):
        MeasuredDeviations(-np.ones((2, 2)), np.ones((2, 2)), np.ones((2, 2)))
    with pytest.raises(InputError, match=r"points: shape \(4, 4, 2\); allowed \(n, m, 3\)"):
        MeasuredPoints(np.ones((4, 4, 2)))
