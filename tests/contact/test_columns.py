"""Columns of graded width: the spacing rule, their growth, and the pressed part of a rounding."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from loaded_tca.contact.columns import FineZone, column_borders, pressed_width
from loaded_tca.errors import InputError
from loaded_tca.reference.punch import RoundedPunch
from tests.refusals import refusals

E_STAR = 113187.0


@pytest.mark.parametrize(("part", "tolerance"), [(1e-1, 4e-2), (1e-2, 4e-3), (1e-3, 4e-4)])
def test_pressed_width_is_the_limit_of_the_closed_form(part, tolerance):
    """b - a of a flat punch with rounded ends, the better the narrower it is: the error is of the order of d/a."""
    punch = RoundedPunch(0.1, 0.2, 0.1 * (1.0 + part), E_STAR)
    assert_allclose(pressed_width(punch.line_load, 0.2, 0.1, E_STAR), 0.1 * part, rtol=tolerance)


@given(
    places=st.lists(st.floats(-1.2, 1.2), min_size=0, max_size=3),
    width=st.floats(1e-3, 0.1),
    reach=st.floats(0.0, 0.2),
    growth=st.floats(1.1, 2.0),
)
def test_columns_fill_the_box_and_keep_the_rule(places, width, reach, growth):
    zones = [FineZone(place, width, reach) for place in places]
    borders = column_borders(-1.0, 1.0, zones, 0.25, growth)
    widths, middles = np.diff(borders), 0.5 * (borders[1:] + borders[:-1])
    assert (borders[0], borders[-1]) == (-1.0, 1.0)
    assert widths.min() > 0.0
    assert widths.max() <= 0.25 * (1.0 + 1e-9)
    for place in places:
        near = np.abs(middles - place) < reach
        assert (widths[near] <= width * (1.0 + 1e-6)).all()
        beside = any(0.0 < abs(place - other) < 0.5 * width for other in places)
        assert not -1.0 < place < 1.0 or beside or np.abs(borders - place).min() == 0.0
    # Neighbours differ by no more than the growth, but for the columns beside a place, whose number is rounded up, and
    # where two zones of their own numbers meet.
    ratios = widths[1:] / widths[:-1]
    met = np.isin(borders[1:-1], places)
    assert np.maximum(ratios, 1.0 / ratios)[~met].max(initial=1.0) <= growth**1.5


def test_columns_grow_by_the_factor():
    widths = np.diff(column_borders(0.0, 10.0, [FineZone(0.0, 1e-3, 0.0)], 5.0, 1.3))
    assert_allclose(widths[3:-1] / widths[2:-2], 1.3, rtol=0.03)  # the number is rounded up


def test_columns_without_a_zone_are_even():
    assert_allclose(np.diff(column_borders(0.0, 1.0, [], 0.3)), 0.25)


test_columns_that_cannot_be_are_refused = refusals(
    lambda arguments: column_borders(*arguments),
    ((1.0, 0.0, [], 0.1), "^low, high: 1.0 and 0.0 mm are not in order and finite$"),
    ((0.0, math.nan, [], 0.1), "^low, high"),
    ((0.0, 1.0, [], 0.0), "^widest: 0.0 mm is not positive and finite$"),
    ((0.0, 1.0, [], 0.1, 1.0), "^growth: 1.0 is not above 1$"),
    (
        (0.0, 1.0, [FineZone(0.5, 0.0, 0.1)], 0.1),
        "^zones: a place is not finite, a width not positive or a reach negative in",
    ),
    ((0.0, 1.0, [FineZone(math.inf, 0.1, 0.1)], 0.1), "^zones: a place"),
    ((0.0, 1.0, [FineZone(0.5, 0.1, -0.1)], 0.1), "^zones: a place"),
    ((0.0, 1.0, [0.5], 0.1), "^zones: a place"),
    ((0.0, 1.0, [FineZone(0.5, 1e-5, 0.5)], 0.1), "^zones: 50000 columns from 0 to 0.5 mm are above 2000$"),
)


@pytest.mark.parametrize("name", ["line_load", "radius", "half_width", "contact_modulus"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_pressed_width_of_nothing_is_refused(name, value):
    given = {"line_load": 100.0, "radius": 0.2, "half_width": 0.1, "contact_modulus": E_STAR} | {name: value}
    with pytest.raises(InputError, match=f"^{name}: .* is not positive and finite$"):
        pressed_width(**given)


def test_zones_at_nearly_the_same_place_leave_no_sliver():
    """Arcs of both gears begin at one place but for rounding: a column of that width would have a peak of its own."""
    zones = [FineZone(1.0 + off, 0.01, 0.02) for off in (0.0, 1e-6, -2e-6)]
    borders = column_borders(0.0, 2.0, zones, 0.1)
    assert np.diff(borders).min() > 0.005
    assert np.abs(borders - 1.0).min() < 1e-5
