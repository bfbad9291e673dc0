"""The ease-off field: its value from the frames, its derivatives, and the geometry behind its gradient."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import outward_normal
from loaded_tca.flanks.removal import Term, logarithmic
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.pairs.gear_pair import cylindrical_basis
from loaded_tca.unloaded.ease_off import EaseOff
from tests.samples.gear_pairs import gear_pair, pairs, transmission_error_at

STEP = 1e-4  # mm
FIRST = 2e-8  # rounding 1e-14 * 100 mm over the step, and step^2 times the third derivative
SECOND = 5e-6  # differences of exact slopes; third derivatives reach 10 1/mm^2 near the base circle, times the step^2

shares = st.tuples(st.floats(0.1, 0.9), st.floats(0.05, 0.95))
turns = st.floats(-0.5, 0.5)


def place(pair, share):
    rho, z = pair.pinion.flank.grid(2, 2)
    return np.array(
        [
            [low + part * (high - low)]
            for low, high, part in zip((rho.min(), z.min()), (rho.max(), z.max()), share, strict=True)
        ]
    )


def stencil(rho, z):
    """The point and its neighbours in rho and z: (5,) each."""
    return rho + STEP * np.array([0, 1, -1, 0, 0]), z + STEP * np.array([0, 0, 0, 1, -1])


def smooth_there(pair, field, phi1, rho, z):
    """Whether no joint of a relief lies within the stencil, nor the steep end of a logarithmic crowning.

    Second derivatives jump at the first; the third of the other is so large that differences are off by 1e-6.
    """
    station = field.station(phi1, rho, z)
    for flank, r, x in ((pair.pinion.flank, rho, z), (pair.wheel.flank, station.wheel_rho, station.wheel_z)):
        for term in (term for term in getattr(flank, "terms", ()) if isinstance(term, Term)):
            t = term.coordinate(flank.nominal, r, x).value * abs(term.length)
            steep = term.shape is logarithmic and (np.abs(t) > 0.8 * abs(term.length)).any()
            if steep or (np.abs(t) < 10.0 * STEP).any():
                return False
    return True


@pytest.mark.thorough
@given(pairs(), shares, turns)
@settings(max_examples=60)
def test_gradient_and_hessian_agree_with_differences(pair, share, turn):
    rho, z = stencil(*place(pair, share))
    phi1, field = np.full(5, turn * pair.pitch), EaseOff(pair)
    station = field.station(phi1, rho, z)
    assume((station.wheel_rho > pair.base_radii[1] + 1.0).all())  # below it the wheel has no involute
    assume(smooth_there(pair, field, phi1, rho, z))
    value, gradient = field.value(station, phi1), field.gradient(station)
    assert_allclose(gradient[0], (value[[1, 3]] - value[[2, 4]]) / (2.0 * STEP), rtol=1e-7, atol=FIRST)
    bend = (gradient[[1, 3]] - gradient[[2, 4]]) / (2.0 * STEP)
    assert_allclose(field.hessian(station)[0], bend, rtol=1e-5, atol=SECOND)


@given(pairs(), shares, turns)
@settings(max_examples=25)
def test_value_is_the_scaled_transmission_error_of_the_definition(pair, share, turn):
    rho, z = place(pair, share)
    phi1 = np.array([turn * pair.pitch])
    lag, _ = transmission_error_at(pair, phi1, rho, z)
    value = pair.driving * lag * pair.base_radii[1]
    field = EaseOff(pair)
    station = field.station(phi1, rho, z)
    assert_allclose(field.value(station, phi1), value, atol=1e-12)  # mm, also below: coordinates of 100 mm, beside rtol
    assert_allclose(field.heights(phi1, rho, z)[0], value, atol=1e-12)


@given(pairs(), shares, turns)
@settings(max_examples=25)
def test_slope_of_the_field_is_the_tilt_of_the_normals_over_the_lever(pair, share, turn):
    """d phi2 = (n2 . t)/(n2 . (w2 x r2)) with w2 = -e_z2: the gradient vanishes exactly where the normals agree."""
    rho, z = place(pair, share)
    phi1, field = np.array([turn * pair.pitch]), EaseOff(pair)
    station = field.station(phi1, rho, z)
    assume((station.wheel_rho > pair.base_radii[1] + 1.0).all())
    normal = outward_normal(pair.wheel.flank, station.wheel_rho, station.wheel_z)[0] @ station.wheel_basis[0]
    turning = np.cross(-pair.wheel_axes[2], station.point[0] - pair.wheel_origin)
    expected = (station.tangents[0] @ normal) / (normal @ turning) * pair.sense
    found = field.gradient(station)[0] / (pair.driving * pair.base_radii[1])
    assert_allclose(found, expected, rtol=1e-9, atol=1e-14)  # atol: rad, an angle that is none


@pytest.mark.thorough
@given(pairs(), shares, turns)
@settings(max_examples=25)
def test_tangents_and_second_derivatives_of_the_point_agree_with_differences(pair, share, turn):
    rho, z = stencil(*place(pair, share))
    phi1, field = np.full(5, turn * pair.pitch), EaseOff(pair)
    assume(smooth_there(pair, field, phi1, rho, z))
    station = field.station(phi1, rho, z)
    along = [(station.point[k] - station.point[k + 1]) / (2.0 * STEP) for k in (1, 3)]
    assert_allclose(station.tangents[0], along, atol=1e-8)
    bends = [(station.tangents[k, j] - station.tangents[k + 1, j]) / (2.0 * STEP) for k, j in ((1, 0), (1, 1), (3, 1))]
    second = np.einsum("ik,ij->kj", station.bends[..., 0], station.wheel_basis[0])
    assert_allclose(second, bends, rtol=1e-5, atol=SECOND)


@pytest.mark.thorough
@given(pairs(), shares, turns)
@settings(max_examples=25)
def test_edge_gradients_agree_with_differences(pair, share, turn):
    rho, z = stencil(*place(pair, share))
    phi1, field = np.full(5, turn * pair.pitch), EaseOff(pair)
    values, slopes = field.edges(field.station(phi1, rho, z))
    differences = (values[[1, 3]] - values[[2, 4]]) / (2.0 * STEP)
    assert_allclose(slopes[0], differences.T, atol=1e-7)
    assert_allclose(values, field.heights(phi1, rho, z)[1], atol=1e-12)  # mm; coordinates of 100 mm


@pytest.mark.thorough
@given(pairs(), shares, turns, st.integers(0, 7))
@settings(max_examples=25)
def test_edge_normal_is_the_gradient_of_the_edge_in_space(pair, share, turn, edge):
    rho, z = place(pair, share)
    field = EaseOff(pair)
    station = field.station(np.array([turn * pair.pitch]), rho, z)
    normal = field.edge_normal(station, edge)[0]
    # of unit vectors: 5e-17 seen
    assert_allclose(station.tangents[0] @ normal, field.edges(station)[1][0, edge], atol=1e-12)


def test_edge_hessian_agrees_with_differences_of_the_edge_gradients():
    pair = gear_pair(helix_deg=15.0, mounting=Mounting(0.01, -0.02))
    rho, z = stencil(*place(pair, (0.6, 0.3)))
    phi1, field = np.full(5, 0.02), EaseOff(pair)
    station = field.station(phi1, rho, z)
    _, slopes = field.edges(station)
    weights = np.tile(np.linspace(-1.0, 2.0, 8), (5, 1))
    total = np.einsum("nk,nkj->nj", weights, slopes)
    bend = np.stack([(total[k] - total[k + 1]) / (2.0 * STEP) for k in (1, 3)])
    assert_allclose(field.edge_hessian(station, weights)[0], bend, atol=SECOND)


def test_relief_starts_come_after_the_edges_of_their_gear_and_point_to_the_side_asked_for():
    relief = FlankModifications(tip_relief=0.02, tip_relief_start=105.0, tip_relief_form="linear")
    pair = gear_pair(
        pinion=relief, wheel=FlankModifications(tip_relief=0.02, tip_relief_start=174.0, tip_relief_form="linear")
    )
    rho, z, phi1 = np.array([53.0]), np.array([0.0]), np.array([0.0])
    sides = EaseOff(pair).sides(phi1, rho, z)
    assert sides.shape == (1, 2)
    assert sides[0, 0]
    for beyond in ([[True, True]], [[False, False]]):
        field = EaseOff(pair, np.array(beyond))
        assert field.edge_owner().tolist() == [0] * 5 + [1] * 5
        assert np.flatnonzero(field.edge_is_relief_start()).tolist() == [4, 9]
        distances, _ = field.edges(field.station(phi1, rho, z))
        assert (distances[0, [4, 9]] > 0.0).tolist() == [
            side == own for side, own in zip(beyond[0], sides[0], strict=True)
        ]


@pytest.mark.parametrize("sense", ["positive", "negative"])
def test_points_turn_with_the_pinion_in_the_sense_of_motion(sense):
    pair = gear_pair(sense=sense)
    field, rho, z = EaseOff(pair), np.array([51.0]), np.array([2.0])
    rest, turned = (field.station(np.array([angle]), rho, z).point[0] for angle in (0.0, 0.1))
    basis = cylindrical_basis(np.array(0.1 * pair.sense))
    assert_allclose(turned, rest @ basis, atol=1e-12)  # of unit vectors, beside rtol
