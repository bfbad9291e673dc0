"""Wedge under a line load: half-plane, Michell's far field, reciprocity, scale, quarter-plane by Hetenyi's series."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.reference.wedge import FARTHEST, extra_displacement
from tests.refusals import refusals

PLACES = np.geomspace(0.01, 100.0, 9)


def michell(angle):
    """Displacement of a wedge under a load at its apex, seen from afar, over that of a half-plane, less 1.

    Radial stresses (a cos t + b sin t)/r balance the load, and the edge moves with it by the same a and b.
    """
    nodes, weights = np.polynomial.legendre.leggauss(40)
    turn = 0.5 * angle * (1.0 + nodes)
    rays = np.array([np.cos(turn), np.sin(turn)])
    return 0.5 * math.pi * np.linalg.inv((0.5 * angle * weights * rays) @ rays.T)[1, 1] - 1.0


def hetenyi(places, load_place):
    """Slopes E* u'/P of a quarter-plane beyond those of a half-plane: two half-planes that free each other's faces.

    A pair of forces p at y and -y on one face leaves the plane between them the pressure 4 p y^2 z/(pi (y^2 + z^2)^2)
    (Flamant) and no shear. Pairs r on top and q on the side that add up to the load alone: q + T (P + r) = 0,
    r + T q = 0; those on the side do not move the top, the plane between them.
    """
    step = 0.02
    y = load_place * np.exp(np.arange(-14.0, 14.0, step) + 0.5 * step)  # no place is on it
    onto = 4.0 / np.pi * y**2 * y[:, None] / (y**2 + y[:, None] ** 2) ** 2 * y * step
    side = 4.0 / np.pi * load_place**2 * y / (load_place**2 + y**2) ** 2
    pairs = np.linalg.solve(np.eye(y.size) - onto @ onto, onto @ side)
    x = places[:, None]
    # The principal value of 1/(x - y) + 1/(x + y) is zero.
    apart = pairs - np.interp(np.log(x), np.log(y), pairs)
    return -2.0 / np.pi * (1.0 / (places + load_place) + (apart * 2.0 * x / (x**2 - y**2) * y * step).sum(axis=1))


def test_quarter_plane_is_that_of_hetenyi():
    places, step = np.array([0.2, 0.5, 1.0, 2.0, 5.0]), 1e-4
    ends = extra_displacement(places[:, None] * (1.0 + step * np.array([-1.0, 1.0])), 1.0, 0.5 * math.pi)
    assert_allclose(np.diff(ends, axis=1)[:, 0] / (2.0 * step * places), hetenyi(places, 1.0), rtol=1e-3)


def test_half_plane_has_no_more():
    assert_allclose(extra_displacement(PLACES, 1.0, math.pi), 0.0, atol=1e-12)  # the sine of pi


@pytest.mark.parametrize("degrees", [40.0, 90.0, 115.0, 150.0])
def test_far_away_it_is_michells_wedge(degrees):
    angle = math.radians(degrees)
    more = michell(angle)
    far = np.diff(extra_displacement([1e4, 1e5], 1.0, angle))[0] / math.log(10.0)
    assert_allclose(far, -2.0 * more / math.pi, rtol=1e-3)
    step = 1e-4  # where the load is, the tilt is half of that, x/s = 1
    here = np.diff(extra_displacement([1.0 - step, 1.0 + step], 1.0, angle))[0] / (2.0 * step)
    assert_allclose(here, -more / math.pi, rtol=1e-6)
    assert_allclose(extra_displacement(1e-6, 1.0, angle), extra_displacement(1e-5, 1.0, angle), atol=1e-3 * more)


def test_displacement_is_reciprocal_and_scales():
    found = extra_displacement(PLACES[:, None], PLACES, 2.0)
    assert_allclose(found, found.T, rtol=1e-12)  # the logarithm of a ratio and of its inverse: 5e-16 seen
    larger = extra_displacement(3.0 * PLACES[:, None], 3.0 * PLACES, 2.0)
    # displacements of order one
    assert np.ptp(larger - found) < 1e-12  # but for a displacement of the whole, 2 m/pi ln 3


def test_a_wedge_is_softer_than_a_half_plane():
    """Material taken off: every load has more energy; loads that sum up to zero, so that no level counts."""
    energy = np.linalg.eigvalsh(np.diff(np.diff(extra_displacement(PLACES[:, None], PLACES, 2.0), axis=0), axis=1))
    assert energy.min() > 0.0


test_arguments_out_of_range_are_refused = refusals(
    lambda place, angle: extra_displacement(place, 1.0, angle),
    (0.0, 1.0, "^place: 0.0 "),
    (1.0, 0.0, "^angle: 0.0 rad is not between 0 and pi$"),
    (1.0, 4.0, "^angle: 4.0 rad"),
    (2.0 * FARTHEST, 1.0, "^place, load_place: one is .* times the other"),
)
