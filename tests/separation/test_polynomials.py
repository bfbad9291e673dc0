"""Polynomials of the gap about a contact: the gap itself, on flanks of one piece, and none elsewhere."""

from functools import cache

import numpy as np
import pytest

from loaded_tca import read_scene, sample_separation, trace_contact
from loaded_tca.separation.box import PROBE
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.separation.polynomials import MISFIT, OUTSIDE, ROUNDING, GapPolynomials
from tests.samples.results import SCENES

SMOOTH = ("spur", "helical", "straight_bevel", "spiral_bevel", "planet_ring")


@cache
def scene_of(name):
    return read_scene(SCENES / f"{name}.toml")


def sampled(pair, load, angle=0.0, **keys):
    """Contact at a pinion angle, and its grid under a normal force [N]."""
    contact = trace_contact(pair, [angle])[0]
    return contact, sample_separation(pair, contact, cells=(16, 32), load=load, **keys)


def force(scene, pair):
    contact = trace_contact(pair, [0.0])[0]
    return float(np.median(scene.torques)) / contact.pinion_lever


@pytest.mark.parametrize("name", SMOOTH)
def test_polynomials_are_the_gap_and_the_distances_to_the_edges(rng, name):
    """At places between those they were fitted to: of the same accuracy, and for edges a little beyond."""
    scene, pair = scene_of(name), scene_of(name).pair()
    contact, separation = sampled(pair, force(scene, pair))
    polynomials, gap = separation.polynomials, NormalGap(pair, contact, separation.axes)
    reach = polynomials.reach[0]
    x, y = (np.sort(rng.uniform(-half, half, (1, count)), axis=1) for half, count in zip(reach, (23, 41), strict=True))
    exact, by_polynomials = gap.surfaces(x[:, :, None], y[:, None]), polynomials.surfaces(x, y)
    np.testing.assert_allclose(by_polynomials[0], exact[0], rtol=0, atol=2.0 * MISFIT)
    largest = np.abs(exact[1:]).max(axis=(1, 2, 3))
    errors = np.abs(by_polynomials - exact)[1:].max(axis=(1, 2, 3))
    assert (errors <= 2.0 * (MISFIT + ROUNDING * largest)).all()
    x, y = OUTSIDE * x, OUTSIDE * y
    exact = gap.surfaces(x[:, :, None], y[:, None])[1:]
    np.testing.assert_allclose(polynomials.surfaces(x, y)[1:], exact, rtol=0, atol=1e-3 * min(separation.spacing))


@pytest.mark.parametrize("name", SMOOTH)
def test_grid_by_polynomials_is_the_grid_without(name):
    """In the box that was estimated; the same box given alone is sampled point by point."""
    scene, pair = scene_of(name), scene_of(name).pair()
    _, separation = sampled(pair, force(scene, pair))
    _, other = sampled(pair, None, box=separation.box)
    assert other.polynomials is None
    np.testing.assert_array_equal(np.isinf(separation.gap), np.isinf(other.gap))
    there = np.isfinite(other.cut_gap)
    np.testing.assert_allclose(separation.cut_gap[there], other.cut_gap[there], rtol=0, atol=2.0 * MISFIT)
    np.testing.assert_allclose(separation.cover, other.cover, rtol=0, atol=1e-6)


def with_key(key, value):
    return scene_of("spur").with_changes({key: value}).pair()


@pytest.mark.parametrize(
    "pair",
    [
        lambda: scene_of("mesh_cycle_spur").pair(),
        lambda: with_key("pinion.side_rounding_mm", 0.3),
        lambda: scene_of("measured_flank").pair(),
    ],
    ids=["relief", "rounded edge", "spline"],
)
def test_flanks_that_bend_within_the_contact_have_none(pair):
    """Where the tip relief begins the second derivative of the gap jumps; on an arc and on a spline it does, too."""
    pair = pair()
    assert sampled(pair, 2e3, 0.5 * pair.pitch)[1].polynomials is None


def test_normals_that_miss_a_flank_leave_none():
    surfaces = np.zeros((2, 1, *PROBE))
    surfaces[1, 0, 3, 4] = -np.inf
    assert not GapPolynomials.fitted(surfaces, np.ones((1, 2)))[1][0]


def test_a_jump_of_the_curvature_is_seen_wherever_it_lies():
    """A gap that bends by 1e-3/mm more beyond a line, as where a relief of micrometres begins, at any place of it."""
    x, y = (np.linspace(-1.0, 1.0, count) for count in PROBE)
    for start in np.linspace(-0.95, 0.95, 39):
        for places in (x[:, None] + 0.0 * y, 0.0 * x[:, None] + y):
            gap = 5e-4 * np.maximum(places - start, 0.0) ** 2
            assert not GapPolynomials.fitted(gap[None, None], np.array([[1.0, 1.0]]))[1][0], start
