"""B-spline flanks against the analytic ones that they stand for: contact points, curvatures, transmission error."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, GeometryError, InputError, trace_contact
from loaded_tca.flanks import FlankModifications, InvoluteFlank, SplineFlank, fitted
from loaded_tca.flanks.base import Jet, Region, unmodified
from loaded_tca.flanks.spline import pitch_point
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.unloaded.curvature import relative_curvature
from tests.samples.gear_pairs import gear_pair

ROUNDING = 1e-14  # rad; angles below 0.1 through a fit: 2e-16 seen
POINT = 1e-6  # mm; asked for, and reached with 33 x 33 points
CURVATURE = 1e-4  # relative; asked for
TRANSMISSION_ERROR = 1e-11  # rad; second order in the distance between the contact points
CROWNED = FlankModifications(lead_crowning=0.01, profile_crowning=0.005, twist=0.004)
KINDS = ("spur", "helical", "straight_bevel", "spiral_bevel")


def pair_of(kind, pinion=CROWNED, wheel=FlankModifications(), **choices):
    """Gear pair of a kind, with modifications."""
    if kind in ("spur", "helical"):
        return gear_pair(pinion, wheel, helix_deg=15.0 if kind == "helical" else 0.0, **choices)
    mesh = bevel_mesh((20, 40), 4.0, 20.0, spiral_angle=math.radians(35.0) if kind == "spiral_bevel" else 0.0)
    return bevel_pair(mesh, modifications=(pinion, wheel), **choices)


def with_splines(pair, points=(33, 33)):
    return pair.with_flanks(pinion=fitted(pair.pinion.flank, points), wheel=fitted(pair.wheel.flank, points))


def angles(pair):
    return np.linspace(-0.5, 0.5, 9) * pair.pitch


# A fitted flank does what the flank does


@pytest.mark.parametrize("kind", KINDS)
def test_contact_of_fitted_flanks_is_that_of_the_analytic_ones(kind):
    pair = pair_of(kind)
    spline = with_splines(pair)
    exact, found = (trace_contact(one, angles(pair)) for one in (pair, spline))
    assert_allclose(found.point, exact.point, rtol=0, atol=POINT)
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=TRANSMISSION_ERROR)
    assert_allclose(found.normal, exact.normal, rtol=0, atol=1e-7)
    for row in (0, 4, 8):
        curvatures = [relative_curvature(one, path[row]) for one, path in ((pair, exact), (spline, found))]
        assert_allclose(curvatures[1].across, curvatures[0].across, rtol=CURVATURE)
        assert_allclose(curvatures[1].along, curvatures[0].along, rtol=CURVATURE)


@pytest.mark.parametrize("choices", [{"driving": "wheel"}, {"sense": "negative"}])
def test_contact_of_fitted_flanks_is_that_of_the_analytic_ones_on_the_other_side_of_the_tooth(choices):
    pair = pair_of("helical", **choices)
    exact, found = (trace_contact(one, angles(pair)) for one in (pair, with_splines(pair, (25, 25))))
    assert_allclose(found.point, exact.point, rtol=0, atol=POINT)
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=TRANSMISSION_ERROR)


def test_fitted_flank_keeps_the_place_of_a_flank_whose_modification_reaches_the_pitch_point():
    """Constant removal turns the pair; a fit must not turn it back."""
    pair = pair_of("spur", FlankModifications(polynomial=(0.01, 0, 0, 0, 1e-4, 1e-4)))
    exact, found = (trace_contact(one, angles(pair)) for one in (pair, with_splines(pair, (17, 17))))
    assert exact.transmission_error.max() < -1e-4
    assert_allclose(found.transmission_error, exact.transmission_error, rtol=0, atol=TRANSMISSION_ERROR)


@pytest.mark.parametrize("kind", KINDS)
@given(height=st.floats(0.05, 0.95), place=st.floats(0.02, 0.98))
@settings(max_examples=25)
def test_derivatives_of_fitted_flanks_agree_with_differences(kind, height, place):
    flank = pair_of(kind).pinion.flank
    corners = np.stack(flank.grid(2, 2))
    weights = np.outer([1.0 - height, height], [1.0 - place, place])
    rho, z = (corners * weights).sum(axis=(1, 2))
    step, spline = 1e-4, FITTED[kind]
    points = np.array([(rho + i * step, z + j * step) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    jet = spline.theta(points[:, 0], points[:, 1])
    value, slope_rho, slope_z = (np.broadcast_to(part, 9).reshape(3, 3) for part in (jet.value, jet.rho, jet.z))
    first = (value[2, 1] - value[0, 1]) / (2 * step), (value[1, 2] - value[1, 0]) / (2 * step)
    assert_allclose([slope_rho[1, 1], slope_z[1, 1]], first, rtol=0, atol=1e-8)
    second = (
        (slope_rho[2, 1] - slope_rho[0, 1]) / (2 * step),
        (slope_rho[1, 2] - slope_rho[1, 0]) / (2 * step),
        (slope_z[1, 2] - slope_z[1, 0]) / (2 * step),
    )
    here = [np.broadcast_to(part, 9)[4] for part in (jet.rho_rho, jet.rho_z, jet.z_z)]
    assert_allclose(here, second, rtol=1e-5, atol=1e-7)


FITTED = {kind: fitted(pair_of(kind).pinion.flank, (17, 17)) for kind in KINDS}


def test_fitted_flank_goes_on_smoothly_beyond_its_edges():
    flank = pair_of("helical").wheel.flank
    spline = fitted(flank)
    away = 0.02 * np.array(flank.extent)
    rho, z = flank.grid(3, 3)
    for sign in (-1.0, 1.0):
        outside = rho + sign * away[0], z + sign * away[1]
        # third derivatives of Theta are about 1e-4 1/mm^3
        assert_allclose(spline.theta(*outside).value, flank.theta(*outside).value, rtol=0, atol=1e-7)


# How well it fits


@pytest.mark.parametrize("kind", ["helical", "spiral_bevel"])
def test_fit_error_falls_with_the_sixth_power_of_the_spacing(kind):
    errors = [fitted(pair_of(kind).pinion.flank, (count, count)).check_error.largest for count in (9, 17, 33)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (orders > 5.5).all()


def test_fit_error_is_the_distance_along_the_normal_at_and_between_the_points():
    flank = pair_of("straight_bevel").pinion.flank
    spline = fitted(flank, (9, 9))
    assert spline.fit_error.largest < 1e-12  # mm; of a flank of 50 mm: 4e-15 seen
    rho, z = flank.grid(17, 17)
    apart = np.abs(spline.distance_to(flank, rho, z)[1::2, 1::2])
    assert_allclose(spline.check_error.largest, apart.max(), rtol=1e-9)
    assert_allclose(spline.check_error.rms, math.sqrt((apart**2).mean()), rtol=1e-9)
    assert 0.0 < spline.check_error.rms < spline.check_error.largest < 1e-4


def test_fit_error_of_a_relief_start_warns():
    low, high = (2.0 * radius for radius in pair_of("spur").pinion.flank.nominal.radii)
    relief = FlankModifications(tip_relief=0.05, tip_relief_form="linear", tip_relief_start=0.4 * low + 0.6 * high)
    flank = pair_of("spur", relief).pinion.flank
    with pytest.warns(
        AccuracyWarning, match=r"misses the flank by .* um at most.*between the points.*start of a linear relief"
    ):
        spline = fitted(flank)
    assert spline.relief_starts(*flank.grid(2, 2)) == ()
    assert 1e-4 < spline.check_error.largest < 0.005


def test_fitted_flank_of_a_fitted_flank_is_the_same():
    once = fitted(pair_of("helical").pinion.flank, (17, 17))
    rho, z = once.grid(17, 17)
    assert_allclose(fitted(once, (17, 17)).theta(rho, z).value, once.theta(rho, z).value, rtol=0, atol=ROUNDING)


# What it takes over, what it is made of


def test_fitted_flank_has_the_region_of_the_flank():
    flank = pair_of("spiral_bevel").wheel.flank
    spline = fitted(flank, (9, 9))
    rho, z = flank.grid(4, 5)
    assert (spline.side, spline.extent, spline.frame) == (flank.side, flank.extent, flank.frame)
    assert_allclose(spline.grid(4, 5), (rho, z), rtol=0)
    assert spline.inside(rho, z, 1e-9).all()
    assert_allclose(spline.gradient_norm(rho, z).value, flank.gradient_norm(rho, z).value, rtol=0)


def test_region_has_no_surface():
    flank = pair_of("helical").pinion.flank
    rho, z = flank.grid(3, 3)
    assert_allclose(Region(flank).theta(rho, z).value, np.zeros((3, 3)), rtol=0)


def test_unmodified_flank_is_the_bottom_of_all_derived_ones():
    flank = pair_of("helical").pinion.flank
    assert isinstance(unmodified(fitted(flank, (9, 9))), InvoluteFlank)


def test_spline_flank_survives_pickling_and_says_how_well_it_fits():
    flank = fitted(pair_of("spur").pinion.flank, (9, 9))
    again = pickle.loads(pickle.dumps(flank))
    rho, z = flank.grid(5, 5)
    assert_allclose(again.theta(rho, z).value, flank.theta(rho, z).value, rtol=0)
    assert repr(flank).startswith("SplineFlank(9 x 9 coefficients, fit error ")


# Pitch point


@pytest.mark.parametrize("kind", KINDS)
def test_pitch_point_is_where_the_unmodified_pair_touches_at_the_zero_of_the_angles(kind):
    pair = pair_of(kind, sense="negative")
    # lead crowning leaves the middle of the face where it is
    path = trace_contact(pair_of(kind, FlankModifications(lead_crowning=0.01), sense="negative"), [0.0])
    rho, z = pitch_point(pair.pinion.flank)
    assert_allclose([rho, z], [path.pinion_radius[0], path.pinion_axial[0]], rtol=0, atol=1e-8)
    assert_allclose(unmodified(pair.pinion.flank).theta(rho, z).value, 0.0, atol=ROUNDING)
    assert_allclose(pair.pinion.flank.lengthwise_coordinate(rho, z).value, 0.0, atol=1e-10)  # mm: none seen


def test_flank_without_a_pitch_point_is_told():
    class Raised(InvoluteFlank):
        """A flank turned so far that its theta is nowhere zero."""

        def theta(self, rho, z, beyond=None):
            jet = super().theta(rho, z, beyond)
            return Jet(np.maximum(jet.value, -1.0) + 3.0, jet.rho, jet.z, jet.bends)

    flank = Raised(50.0, 0.0, -1, 53.0, (51.0, 57.0), 20.0)
    with pytest.raises(GeometryError, match=r"the flank around diameter .* mm, 0 mm from mid-face has no pitch point"):
        pitch_point(flank)


# Refusals


def test_too_few_points_or_another_degree_are_refused():
    flank = pair_of("spur").pinion.flank
    with pytest.raises(InputError, match="points: 5 x 9 are too coarse for degree 5; at least 6 each"):
        fitted(flank, (5, 9))
    with pytest.raises(InputError, match="degree: 4; allowed 3 or 5"):
        fitted(flank, (9, 9), degree=4)
    assert isinstance(fitted(flank, (6, 6)), SplineFlank)
    with pytest.warns(AccuracyWarning, match="4 x 4 points misses the flank by"):
        fitted(flank, (4, 4), degree=3)
