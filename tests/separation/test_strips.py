"""Contacts cut into strips: what they share is Hertz's where strips are exact, and near it elsewhere."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.contact import solve_contact
from loaded_tca.reference.hertz import point_contact
from loaded_tca.separation.strips import _ends_of_parabolas, strip_pressure

MODULUS, LOAD = 115e3, 1000.0


def paraboloid(curvatures, cells=(32, 32)):
    """Hertz's contact of a paraboloid, its gap on a grid of 1.25 times the contact, and the places of the cells."""
    hertz = point_contact(LOAD, curvatures, MODULUS)
    spacing = tuple(2.5 * half / n for half, n in zip((hertz.semi_minor, hertz.semi_major), cells, strict=True))
    x, y = ((np.arange(n) - 0.5 * (n - 1)) * step for n, step in zip(cells, spacing, strict=True))
    gap = 0.5 * curvatures[0] * x[:, None] ** 2 + 0.5 * curvatures[1] * y**2
    return hertz, gap, spacing, (x, y)


@pytest.mark.parametrize(("aspect", "bound"), [(1.0, 0.2), (1e-2, 0.1), (1e-4, 0.05)])
def test_pressure_of_strips_is_near_that_of_hertz(aspect, bound):
    """Circular contacts have the right line loads, on strips wider by the root of 4/pi; slender ones come nearer."""
    hertz, gap, spacing, (x, y) = paraboloid((0.1, 0.1 * aspect))
    pressure = strip_pressure(gap, spacing, LOAD, MODULUS)
    pressure *= LOAD / (pressure.sum() * spacing[0] * spacing[1])
    exact = hertz.pressure(x[:, None], y)
    assert np.linalg.norm(pressure - exact) < bound * np.linalg.norm(exact)


def test_places_without_material_carry_nothing():
    """Half a contact: the strips that are left share the load."""
    _, gap, spacing, _ = paraboloid((0.1, 1e-4))
    gap[:, :16] = np.inf
    pressure = strip_pressure(gap, spacing, LOAD, MODULUS)
    assert (pressure[:, :16] == 0.0).all()
    assert (pressure[:, 16:].max(axis=0) > 0.0).sum() > 8


def test_solver_needs_fewer_convolutions_from_strips_than_from_nothing():
    """Of a contact that its edge cuts off, as of a spur pair: both starts lead to the same pressure."""
    _, gap, spacing, _ = paraboloid((0.1, 1e-6), (16, 32))
    gap[:, 28:] = np.inf
    start = strip_pressure(gap, spacing, LOAD, MODULUS)
    keys = {"load": LOAD, "tolerance": 1e-5, "warn": False}
    by_strips = solve_contact(gap, spacing, MODULUS, initial_pressure=start, **keys)
    flat = solve_contact(gap, spacing, MODULUS, initial_pressure=np.isfinite(gap) * 1.0, **keys)
    assert by_strips.convolutions < flat.convolutions
    assert_allclose(by_strips.pressure, flat.pressure, rtol=0, atol=1e-3 * flat.pressure.max())


def test_end_of_a_penetration_that_falls_as_a_parabola_is_where_that_is_zero():
    """Between the strips; of its two ends the farther one."""
    places = np.linspace(-2.0, 2.0, 21)
    penetration = np.stack([3e-3 * (1.0 - (places / end) ** 2) for end in (1.27, 0.73)])
    ends = _ends_of_parabolas(np.abs(np.stack([places, places])), penetration, penetration > 0.0)
    assert_allclose(ends, [1.27, 0.73], rtol=1e-9)


def test_ends_of_penetrations_are_those_of_their_mirror_images():
    """Both last strips are as far from the contact point, to the bit; one of them is deeper."""
    places = np.arange(-16, 17) / 8.0
    penetration = np.stack([3e-3 * (1.0 - (places / 1.27) ** 2) * (1.0 + skew * places) for skew in (0.3, -0.3)])
    first, second = _ends_of_parabolas(np.abs(np.stack([places, places])), penetration, penetration > 0.0)
    assert first == pytest.approx(second, rel=1e-9)
