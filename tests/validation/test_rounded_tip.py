"""The rounded tip in the plane: its outline, meshes and deck, without running the program."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from validation.calculix import rounded_tip as tip


@pytest.mark.parametrize("degrees", [90.0, 115.0, 150.0])
def test_outline_is_a_line_an_arc_and_a_line(degrees):
    turn = math.pi - math.radians(degrees)
    s = np.linspace(-1.0, 1.0, 4001)
    curve = tip.tip_curve(s, math.radians(degrees))
    assert_allclose(np.hypot(*np.diff(curve, axis=0).T), s[1] - s[0], rtol=1e-4)  # s is the length
    arc = (s > 0.0) & (s < tip.RADIUS * turn)
    # the root of two squares
    assert_allclose(np.hypot(curve[arc, 0], curve[arc, 1] - tip.RADIUS), tip.RADIUS, rtol=1e-12)
    land = curve[-1] - curve[-2]
    assert_allclose(math.atan2(land[1], land[0]), turn, rtol=1e-9)


def test_ring_is_a_valid_mesh():
    turn = math.radians(65.0)
    surface = tip.tip_curve(tip.along(-tip.LENGTH, tip.LENGTH + tip.RADIUS * turn, (-0.01, 0.03)), math.radians(115.0))
    inward = math.radians(180.0 - 57.5)
    pole = np.array([0.0, tip.RADIUS]) + tip.BODY * np.array([math.cos(inward), math.sin(inward)])
    nodes, elements, loaded, core = tip.ring(surface, pole)
    x, y = nodes[elements[:, :4]].transpose(2, 0, 1)
    areas = 0.5 * sum(x[:, k - 1] * y[:, k] - x[:, k] * y[:, k - 1] for k in range(4))
    assert areas.min() > 0.0
    assert len(loaded) == (len(surface) - 1) // 2
    assert_allclose(nodes[elements[loaded[0], 0]], surface[0])
    assert_allclose(nodes[elements[loaded, 4]], surface[1::2])
    assert_allclose(np.hypot(*(nodes[core] - pole).T), tip.BODY / 3.0)
    assert set(np.unique(elements)) == set(range(len(nodes)))


def test_deck_holds_one_body_and_loads_the_other():
    text = tip.deck(math.radians(115.0), 200.0)
    for part in ("*SURFACE,NAME=P0", "*SURFACE,NAME=W0", "HELD,1,2\nMOVED,1,1", "1e+09", ",2,20\n"):
        assert part in text


def test_kept_pressures_carry_the_load():
    kept = tip.read_table(tip.FILE)
    for degrees, load in tip.RUNS:
        mine = [row for row in kept if (row["tip_angle_deg"], row["line_load_N_per_mm"]) == (degrees, load)]
        x, p = np.array([[row["x_mm"], row["pressure_MPa"]] for row in mine]).T
        assert_allclose(np.trapezoid(p, x), load, rtol=0.1)  # elements of 0.03 mm at the far end of the contact
        assert -0.01 < x[p.argmax()] < 0.01
