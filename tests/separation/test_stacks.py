"""Gaps of many contacts sampled together: each is what it is alone."""

import math
import warnings
from dataclasses import fields, replace
from functools import cache

import numpy as np
import pytest

from loaded_tca import AccuracyWarning, GeometryError, InputError, read_scene, sample_separation, trace_contact
from loaded_tca.separation.box import PROBE, Box
from loaded_tca.separation.normal_gap import TOGETHER, NormalGap
from loaded_tca.separation.sample import sample_separations
from loaded_tca.unloaded import relative_curvature
from loaded_tca.unloaded.curvature import relative_curvatures
from tests.samples.gear_pairs import gear_pair, sam_paper
from tests.samples.results import SCENES

TURNS = (-0.9, -0.4, 0.0, 0.1, 0.3, 0.8)  # of the pitch: the outer ones at edges
LOADS = (0.0, 1.0, 300.0, 3e3, 1e5)
PAIRS = {
    "base circle": lambda: gear_pair(teeth=(20, 57)),
    **{
        name: lambda name=name: read_scene(SCENES / f"{name}.toml").pair()
        for name in (
            "spur",
            "helical",
            "misaligned",
            "straight_bevel",
            "spiral_bevel",
            "face_milled_19x62_matched",
            "measured_flank",
        )
    },
}


@cache
def traced(pair):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # edge contacts are wanted here
        return trace_contact(pair, [turn * pair.pitch for turn in TURNS])


def contacts_of(pair):
    """New contact points at every call, so that nothing is kept of earlier ones."""
    return [traced(pair)[row] for row in range(len(TURNS))]


def requests(pair):
    """Every contact under every load, and in a box that goes beyond the flanks, on grids of two shapes."""
    asked = [(c, (16, 16), load, None) for load in LOADS for c in contacts_of(pair) if c.in_contact]
    far = (2.0 * pair.module, 0.6 * pair.face_width)
    return asked + [(c, (12, 10), None, far) for c in contacts_of(pair) if c.in_contact]


def sampled(pair, asked):
    contacts, cells, loads, boxes = zip(*asked, strict=True)
    return sample_separations(pair, contacts, cells=cells, loads=loads, boxes=boxes)


def assert_same(one, other):
    assert (one.polynomials is None) == (other.polynomials is None)
    parts = [(one, other)] if one.polynomials is None else [(one, other), (one.polynomials, other.polynomials)]
    for first, second in parts:
        for name in (field.name for field in fields(first) if field.name != "polynomials"):
            np.testing.assert_array_equal(getattr(first, name), getattr(second, name), name)


@pytest.mark.quick_cases("helical")
@pytest.mark.parametrize("name", PAIRS)
def test_gap_does_not_depend_on_what_is_sampled_with_it(name):
    """Not by rounding either: alone, in another order, in other company."""
    pair = PAIRS[name]()
    asked = requests(pair)
    found = sampled(pair, asked)
    assert len(asked) * math.prod(PROBE) > TOGETHER, "more than are sampled at once"
    backwards = sampled(pair, requests(pair)[::-1])[::-1]
    thirds = [sampled(pair, requests(pair)[first::3]) for first in range(3)]
    for index, separation in enumerate(found):
        assert_same(separation, backwards[index])
        assert_same(separation, thirds[index % 3][index // 3])
    for index, (contact, cells, load, box) in enumerate(requests(pair)):
        assert_same(found[index], sample_separation(pair, contact, cells=cells, load=load, box=box))


@pytest.mark.parametrize("name", PAIRS)
def test_curvatures_found_together_are_those_found_alone(name):
    pair = PAIRS[name]()
    together = relative_curvatures(pair, [c for c in contacts_of(pair) if c.in_contact])
    alone = [relative_curvature(pair, contact) for contact in contacts_of(pair) if contact.in_contact]
    for one, other in zip(together, alone, strict=True):
        assert (one.across, one.along) == (other.across, other.along)  # exact, also below: each contact by itself
        np.testing.assert_array_equal(one.axes, other.axes)


def test_curvature_across_of_several_contacts_is_that_of_each():
    pair = sam_paper(15.0)
    contacts = contacts_of(pair)
    axes = np.array([curvature.axes for curvature in relative_curvatures(pair, contacts)])
    x, y = np.linspace(-0.1, 0.1, 5), np.linspace(-3.0, 3.0, 5)
    stack = (np.tile(part, (len(contacts), 1)) for part in (x, y))
    found = NormalGap(pair, contacts, axes).curvature_across(*stack)
    for contact, own, curvature in zip(contacts, axes, found, strict=True):
        np.testing.assert_array_equal(curvature, NormalGap(pair, contact, own).curvature_across(x, y))


def test_contact_that_fails_is_told_at_its_place_and_stops_no_other():
    pair = sam_paper()
    path = trace_contact(pair, [0.0, 1.5, 0.05])
    away = replace(path[0], point=path[0].point + np.array([0.0, 0.0, 100.0]))
    cells, box = (16, 16), (0.2, 4.0)
    found = sampled(
        pair,
        [
            (path[0], cells, 100.0, None),
            (path[1], cells, 100.0, None),
            (away, cells, 100.0, None),
            (path[2], cells, -1.0, None),
            (path[2], cells, None, None),
            (path[2], (0, 4), None, box),
            (path[2], cells, None, box),
        ],
    )
    assert_same(found[0], sample_separation(pair, path[0], cells=cells, load=100.0))
    assert_same(found[-1], sample_separation(pair, path[2], cells=cells, box=box))
    failures = [(type(error), str(error)) for error in found[1:-1]]
    assert [kind for kind, _ in failures] == [GeometryError, GeometryError, InputError, InputError, InputError]
    messages = (
        "is not in contact at pinion angle 1.5 rad",
        "no flank around the contact point at pinion angle 0 rad",
        "load: -1.0 N",
        "load: none given",
        "cells: (0, 4)",
    )
    for (_, told), expected in zip(failures, messages, strict=True):
        assert expected in told


def test_nothing_asked_for_is_nothing_found():
    assert sample_separations(sam_paper(), [], cells=[], loads=[], boxes=[]) == []


def test_box_beside_the_contact_point_is_a_part_of_a_larger_one():
    pair = sam_paper()
    contact = trace_contact(pair, [0.0])[0]
    box = Box((0.2, 3.0), relative_curvature(pair, contact).axes, (0.1, -2.0))
    given = {"cells": [(8, 12)], "loads": [None], "boxes": [box]}
    (beside,) = sample_separations(pair, [contact], **given)
    whole = sample_separation(pair, contact, cells=(12, 20), box=(0.3, 5.0))
    for part, axis in (("x", slice(4, 12)), ("y", slice(0, 12))):
        # mm, also below: the same cells from other ends of the box, beside rtol
        np.testing.assert_allclose(getattr(beside, part), getattr(whole, part)[axis], atol=1e-12)
    np.testing.assert_allclose(beside.gap, whole.gap[4:, :12], atol=1e-12)
    np.testing.assert_allclose(beside.cover, whole.cover[4:, :12])
