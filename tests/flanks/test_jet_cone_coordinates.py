"""Cone angle and cone distance against their definitions, and their derivatives against identities of plane polars."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.flanks.base import SMALLEST_DISTANCE, cone_angle, cone_distance

ROUNDING = 1e-14  # a handful of products of numbers of order one
STEP = 1e-5
DIFFERENCE = 1e-9  # step^2 times a third derivative, and rounding over the step

lengths = st.floats(0.5, 2.0)


def gradient_and_hessian(jet):
    return np.array([jet.rho, jet.z]), np.array([[jet.rho_rho, jet.rho_z], [jet.rho_z, jet.z_z]])


def functions(rho, z):
    return cone_distance(rho, z, 1.0), cone_angle(rho, z)


@given(lengths, lengths)
def test_values_and_gradients_are_those_of_plane_polars(rho, z):
    distance, angle = functions(rho, z)
    assert_allclose(
        [distance.value * np.sin(angle.value), distance.value * np.cos(angle.value)], [rho, z], rtol=ROUNDING
    )
    along, around = gradient_and_hessian(distance)[0], gradient_and_hessian(angle)[0]
    assert_allclose(along, np.array([rho, z]) / distance.value, rtol=ROUNDING)
    assert_allclose(around * distance.value, [along[1], -along[0]], rtol=ROUNDING)


@given(lengths, lengths)
def test_second_derivatives_are_differences_of_the_first(rho, z):
    beside = [
        (functions(rho + STEP, z), functions(rho - STEP, z)),
        (functions(rho, z + STEP), functions(rho, z - STEP)),
    ]
    for k, jet in enumerate(functions(rho, z)):
        slopes = [[gradient_and_hessian(jets[k])[0] for jets in both] for both in beside]
        differences = np.array([(ahead - behind) / (2.0 * STEP) for ahead, behind in slopes])
        assert_allclose(gradient_and_hessian(jet)[1], differences, rtol=0, atol=10.0 * DIFFERENCE)


@given(lengths, lengths)
def test_cone_distance_is_linear_along_a_generator_and_the_cone_angle_harmonic(rho, z):
    distance, angle = functions(rho, z)
    assert_allclose(gradient_and_hessian(distance)[1] @ [rho, z], 0.0, atol=ROUNDING)
    assert angle.rho_rho + angle.z_z == 0.0


def test_cone_distance_ends_beside_the_apex():
    assert cone_distance(np.array([0.0, 3.0]), np.array([1e-9, 4.0]), 5.0).value.tolist() == [
        5.0 * SMALLEST_DISTANCE,
        5.0,
    ]
