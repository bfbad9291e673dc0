import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import GeometryError
from loaded_tca.flank_maps.conjugate import BLOCK, conjugate_contact, exchanged
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_contact
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair, transmission_error_at

ROUNDING = 1e-12  # rad or mm; lengths of 100 mm along a path: 3e-14 seen
"""mm: the lead is a difference of angles of order one, times a base radius below 100 mm."""
BOTH = ["pinion", "wheel"]


def crowned(**changes):
    return gear_pair(
        FlankModifications(lead_crowning=0.02, profile_crowning=0.01, twist=0.01),
        FlankModifications(lead_crowning=0.01, tip_relief=0.02, tip_relief_start=174.0, tip_relief_form="linear"),
        helix_deg=15.0,
        mounting=Mounting(in_plane=2e-4, out_of_plane=3e-4, centre_distance_error=0.05, axial_offset=0.3),
        **changes,
    )


def bevel(spiral_deg, **changes):
    mesh = bevel_mesh((20, 31), outer_module=4.0, face_width=22.0, spiral_angle=math.radians(spiral_deg))
    return bevel_pair(mesh, **changes)


@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("driving", BOTH)
@pytest.mark.parametrize("make", [gear_pair, lambda **k: gear_pair(helix_deg=20.0, **k), lambda **k: bevel(35.0, **k)])
def test_lead_of_an_unmodified_pair_is_zero_everywhere(make, driving, sense):
    pair = make(driving=driving, sense=sense)
    for seen in (pair, exchanged(pair)):
        contact = conjugate_contact(seen, *seen.pinion.flank.grid(15, 9))
        on = contact.exists & (contact.profile_room >= 0.0)
        assert on[-1].all()  # the own tip always finds the mating gear's flank
        assert_allclose(contact.lead[on], 0.0, atol=ROUNDING)


def test_contact_of_involutes_lies_on_the_line_of_action():
    mesh = cylindrical_mesh()
    pair = gear_pair()
    contact = conjugate_contact(pair, *pair.pinion.flank.grid(15, 3))
    rho, _ = pair.pinion.flank.grid(15, 3)
    roll = np.sqrt(rho**2 - pair.base_radii[0] ** 2) + np.sqrt(contact.mating_radius**2 - pair.base_radii[1] ** 2)
    length = math.sqrt(mesh.working_centre_distance**2 - sum(pair.base_radii) ** 2)
    assert_allclose(roll, length, rtol=1e-9)


@pytest.mark.parametrize("driving", BOTH)
def test_lead_is_the_highest_of_the_whole_passage(driving):
    """Dense angles, written from the definitions of the frames: never above, and below by a parabola's step at most."""
    pair = crowned(driving=driving)
    rho, z = (part.ravel() for part in pair.pinion.flank.grid(9, 7))
    contact = conjugate_contact(pair, rho, z)
    on = contact.exists & (contact.profile_room > 0.0)
    steps = np.linspace(-1e-3, 1e-3, 201)
    lags = [transmission_error_at(pair, contact.angle[on] + step, rho[on], z[on])[0] for step in steps]
    highest = pair.base_radii[1] * np.max(pair.driving * np.array(lags), axis=0)
    assert on.sum() > 40
    assert (highest <= contact.lead[on] + ROUNDING).all()
    assert_allclose(highest, contact.lead[on], atol=1e-7)  # half a step of 1e-5 rad on a relief start of 1e-2 mm/rad


def test_whole_passage_has_no_higher_lead_elsewhere():
    pair = crowned()
    rho, z = (part.ravel() for part in pair.pinion.flank.grid(9, 7))
    contact = conjugate_contact(pair, rho, z)
    for angle in np.linspace(-2.0, 2.0, 400) * pair.pitch:
        lag, inside = transmission_error_at(pair, angle, rho, z)
        on = inside & contact.exists
        assert (pair.base_radii[1] * lag[on] <= contact.lead[on] + ROUNDING).all()


@pytest.mark.parametrize("driving", BOTH)
def test_highest_lead_is_that_of_the_highest_transmission_error(driving):
    """The point that touches first of all over the passage is where the ease-off is zero."""
    pair = crowned(driving=driving)
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 201) * pair.pitch)
    error = pair.driving * path.transmission_error * pair.base_radii[1]
    first = int(error.argmax())
    assert not path.on_edge[first]
    leads = conjugate_contact(pair, path.pinion_radius, path.pinion_axial).lead
    assert_allclose(leads.max(), error[first], atol=2e-7)  # the summit lies between two positions
    dense = conjugate_contact(pair, *pair.pinion.flank.grid(81, 81))
    assert np.nanmax(np.where(dense.profile_room > 0.0, dense.lead, -np.inf)) <= leads.max() + 2e-7


def test_several_blocks_of_points_are_one_after_the_other():
    pair = crowned()
    rho, z = pair.pinion.flank.grid(3, BLOCK // 2)
    whole, part = conjugate_contact(pair, rho, z), conjugate_contact(pair, rho[2, -5:], z[2, -5:])
    assert whole.lead.shape == rho.shape
    assert_allclose(whole.lead[2, -5:], part.lead, rtol=0, atol=ROUNDING)


def test_points_that_never_meet_the_mate_have_no_contact():
    pair = gear_pair(mounting=Mounting(centre_distance_error=4.0))
    contact = conjugate_contact(pair, *pair.pinion.flank.grid(9, 2))
    assert contact.exists[-1].all()
    assert not contact.exists[0].any()
    assert np.isnan(contact.angle[0]).all()


def test_gears_that_are_far_apart_are_refused():
    with pytest.raises(GeometryError, match="nowhere near"):
        conjugate_contact(gear_pair(mounting=Mounting(centre_distance_error=30.0)), np.array([50.0]), np.array([0.0]))


@pytest.mark.parametrize("make", [crowned, lambda: bevel(35.0)])
def test_exchanged_twice_is_the_pair(make):
    pair = make()
    twice = exchanged(exchanged(pair))
    assert_allclose(twice.wheel_origin, pair.wheel_origin, atol=ROUNDING)
    assert_array_equal(twice.wheel_axes, pair.wheel_axes)  # exact: the same axes, copied
    arrays = {"wheel_origin", "wheel_axes"}
    assert {name: twice.__dict__[name] for name in vars(pair).keys() - arrays} == {
        name: value for name, value in vars(pair).items() if name not in arrays
    }


@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("driving", BOTH)
def test_exchanged_pair_touches_at_the_same_places(driving, sense):
    pair = crowned(driving=driving, sense=sense)
    path = trace_contact(pair, np.linspace(-0.3, 0.3, 7) * pair.pitch)
    back = trace_contact(exchanged(pair), path.wheel_angle)
    assert_allclose(back.wheel_angle, path.pinion_angle, atol=ROUNDING)
    places = (path.wheel_radius, path.wheel_axial, path.pinion_radius, path.pinion_axial)
    found = (back.pinion_radius, back.pinion_axial, back.wheel_radius, back.wheel_axial)
    assert_allclose(found, places, atol=1e-6)
