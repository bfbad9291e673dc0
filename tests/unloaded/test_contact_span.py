"""Begin and end of the unloaded contact of a tooth pair: those of involutes, and of flanks that end them sooner."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import path
from loaded_tca.unloaded.path import contact_span, path_letters, roll_lengths_of_flanks
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, sam_paper

FOUND = 2e-3
"""Of a base pitch, 8.9 mm, the last round is an 8th part of 1e-3."""


@pytest.mark.quick_cases("pinion-0.0")
@pytest.mark.parametrize("helix_deg", [0.0, 15.0])
@pytest.mark.parametrize("driving", ["pinion", "wheel"])
def test_crowned_involutes_are_in_contact_as_long_as_iso_21771_says(helix_deg, driving):
    pair = sam_paper(helix_deg, driving=driving)
    wanted_path = cylindrical_mesh(helix_deg=helix_deg).path_of_contact
    found = roll_lengths_of_flanks(pair, *contact_span(pair))
    wanted = {letter: getattr(wanted_path, letter) for letter in "ABDE"}
    assert found.keys() == wanted.keys()
    assert_allclose([found[letter] for letter in wanted], list(wanted.values()), atol=FOUND)


@pytest.mark.thorough
def test_tip_relief_of_the_wheel_begins_contact_higher_on_the_pinion():
    crowned = FlankModifications(lead_crowning=0.005)
    relieved = FlankModifications(tip_relief=0.012, tip_relief_start=174.6)
    plain, shorter = (contact_span(gear_pair(crowned, wheel))[0] for wheel in (FlankModifications(), relieved))
    assert shorter.pinion_radius > plain.pinion_radius + 0.05  # mm, of 10 mm of flank


def test_contact_that_lies_on_an_edge_throughout_has_no_ends():
    assert contact_span(sam_paper(mounting=Mounting(out_of_plane=0.004))) == (None, None)


def test_letters_of_a_path_are_those_that_are_known():
    assert path_letters(-1.0, 0.5, 1.0) == {"A": -1.0, "B": -0.5, "D": 0.0, "E": 0.5}
    assert path_letters(1.0, -0.5, -1.0) == {"A": 1.0, "B": 0.5, "D": 0.0, "E": -0.5}
    assert path_letters(-1.0, 1.5, 1.0) == {"A": -1.0, "E": 1.5}  # two pairs at least everywhere
    assert path_letters(np.nan, 0.5, 1.0) == {"E": 0.5}


def test_ends_farther_away_than_the_angles_looked_at_first_are_found(monkeypatch):
    """Of five angles that a round looks at, both ends lie between the third and the fourth, and the second is near."""
    pair = sam_paper()
    monkeypatch.setattr(path, "FARTHEST", 1.2)
    monkeypatch.setattr(path, "FINENESS", 5)
    monkeypatch.setattr(path, "ROUNDS", 2)
    ends = []
    for near in (2, 5):
        monkeypatch.setattr(path, "NEAR", near)
        ends.append([float(end.pinion_angle) / pair.pitch for end in contact_span(pair)])
    assert ends[0] == ends[1]
    assert -0.9 < ends[0][0] < -0.6
    assert 0.6 < ends[0][1] < 0.9
