import math

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.compliance.flexibility import (
    depth_displacement,
    depth_displacement_by_depth,
    depth_displacement_slope,
    line_force,
)
from loaded_tca.material import Material

STEEL = Material()
STEP = 1e-5
DIFFERENCES = 1e-6
"""Central differences over 1e-5 mm."""


def test_stress_of_a_line_force_follows_from_its_displacement(rng):
    points = rng.uniform(0.2, 2.0, (30, 2)) * [1.0, -1.0]
    slopes = [
        (line_force(points + step, STEEL)[0] - line_force(points - step, STEEL)[0]) / (2.0 * STEP)
        for step in STEP * np.eye(2)
    ]
    gradient = np.stack(slopes, axis=-1)
    strain = 0.5 * (gradient + gradient.swapaxes(1, 2))
    shear = STEEL.youngs_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    lame = 2.0 * shear * STEEL.poisson_ratio / (1.0 - 2.0 * STEEL.poisson_ratio)
    stress = 2.0 * shear * strain + lame * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2)
    assert_allclose(stress, line_force(points, STEEL)[1], atol=DIFFERENCES)


def test_stress_of_a_line_force_balances_it():
    angle, weight = np.polynomial.legendre.leggauss(20)
    angle, weight = 0.5 * math.pi * angle, 0.5 * math.pi * weight
    arc = 3.0 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    traction = np.einsum("nab,nb->na", line_force(arc, STEEL)[1], arc)
    assert_allclose(weight @ traction, [-1.0, 0.0], atol=1e-12)  # a force of one, summed over the nodes: 9e-18 seen


def test_displacement_at_a_depth_falls_with_the_square_of_the_distance_as_its_differences_say():
    square, depth = np.array([0.01, 0.5, 1.0, 9.0]), 2.3
    low, high = (depth_displacement(np.asarray(depth), np.sqrt(square + by), STEEL) for by in (-STEP, STEP))
    assert_allclose(depth_displacement_slope(depth, square, STEEL), (high - low) / (2.0 * STEP), rtol=DIFFERENCES)


def test_displacement_changes_with_the_depth_as_its_differences_say():
    distance, depth = np.array([[0.1], [0.7], [1.0], [3.0]]), np.array([0.4, 2.3])
    low, high = (depth_displacement(depth + by, distance, STEEL) for by in (-STEP, STEP))
    found = depth_displacement_by_depth(depth, distance, STEEL)
    assert_allclose(found, (high - low) / (2.0 * STEP), rtol=0, atol=DIFFERENCES * np.abs(found).max())


def test_line_force_is_a_line_of_point_forces():
    depths = np.array([1.0, 3.0])
    places = np.arange(-100.0, 100.0, 0.25)
    fields = [0.25 * depth_displacement(depth, places, STEEL).sum() for depth in depths]
    plane = line_force(np.stack([depths, 0.0 * depths], axis=-1), STEEL)[0][:, 0]
    assert_allclose(fields[0] - fields[1], plane[0] - plane[1], rtol=1e-3)  # a line of 200 mm is not endless
