"""Random bevel pairs, straight and spiral: every position is a certified contact or an error that says why.

40 pairs here; 2000 with HYPOTHESIS_PROFILE=nightly.
"""

import math
import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import bevel_mesh
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.ease_off import EaseOff
from loaded_tca.unloaded.reduced import climb
from tests.samples.gear_pairs import ROUNDING, TURNS, assert_certified_or_refused, highest_on_grid, reliefs

PAIRS = 2000 if os.environ.get("HYPOTHESIS_PROFILE") == "nightly" else 40
MOST_TEETH, MOST_RATIO = 80, 6.0
STARTS = 1000


@st.composite
def bevel_meshes(draw):
    """Shaft angle 30 to 150 deg, teeth 8 to 80, ratio to 6, spiral to 45 deg, face width to 0.3 R_e, shifts."""
    first = draw(st.integers(8, MOST_TEETH))
    second = draw(st.integers(first, min(MOST_TEETH, int(MOST_RATIO * first))))
    teeth = (second, first) if draw(st.booleans()) else (first, second)
    shaft_angle = math.radians(draw(st.one_of(st.just(90.0), st.floats(30.0, 150.0))))
    module = draw(st.floats(0.5, 20.0))
    outer_cone_distance = 0.5 * teeth[0] * module / math.sin(pitch_angles(teeth, shaft_angle)[0])
    shift = st.floats(-0.5, 0.6)
    return bevel_mesh(
        teeth,
        module,
        draw(st.floats(0.1, 0.3)) * outer_cone_distance,
        shaft_angle=shaft_angle,
        pressure_angle=math.radians(draw(st.sampled_from([14.5, 20.0, 25.0]))),
        spiral_angle=math.radians(draw(st.one_of(st.just(0.0), st.floats(-45.0, 45.0)))),
        profile_shifts=(draw(shift), draw(shift)),
    )


@st.composite
def bevel_pairs(draw):
    """All modifications of both gears; errors E, P, G up to 0.5 mm (modules below 3 mm less), shaft angle to 1 deg."""
    mesh = draw(bevel_meshes())
    module = mesh.pinion.outer_module
    far = 0.5 * min(1.0, module / 3.0)
    length, angle = st.floats(-far, far), st.floats(-math.radians(1.0), math.radians(1.0))
    diameters = [
        tuple(gear.diameter_at(cone) for cone in cones)
        for gear, cones in zip((mesh.pinion, mesh.wheel), mesh.active_cones, strict=True)
    ]
    return bevel_pair(
        mesh,
        modifications=(draw(reliefs(module, diameters[0])), draw(reliefs(module, diameters[1]))),
        mounting=BevelMounting(draw(length), draw(length), draw(length), draw(angle)),
        driving=draw(st.sampled_from(["pinion", "wheel"])),
        sense=draw(st.sampled_from(["positive", "negative"])),
    )


@pytest.mark.thorough
@given(st.data(), TURNS)
@settings(max_examples=PAIRS)
def test_every_position_of_a_random_bevel_pair_is_certified_or_refused_with_a_reason(data, turns):
    assert_certified_or_refused(lambda: data.draw(bevel_pairs()), turns)


CROWNED = FlankModifications(lead_crowning=0.02, profile_crowning=0.01)
FEW_STEPS = 10.0
"""Mean Newton steps of an ascent; long edges and bent ridges take a few more than the usual 7."""


def from_everywhere(teeth, module, face_width, spiral_deg, shaft_deg, mounting):
    """A crowned pair, and 1000 ascents from a grid over its pinion's flank at the pitch point."""
    mesh = bevel_mesh(
        teeth, module, face_width, shaft_angle=math.radians(shaft_deg), spiral_angle=math.radians(spiral_deg)
    )
    pair = bevel_pair(mesh, modifications=(CROWNED, FlankModifications()), mounting=mounting)
    rho, z = (part.ravel() for part in np.broadcast_arrays(*pair.pinion.flank.grid(25, STARTS // 25)))
    return pair, climb(EaseOff(pair), np.zeros(STARTS), rho, z)


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("mounting", [BevelMounting(), BevelMounting(-0.1, -0.2, 0.25)])
@pytest.mark.parametrize(
    ("teeth", "module", "face_width", "spiral_deg", "shaft_deg"),
    [
        ((39, 32), 2.5, 14.0, 0.0, 90.0),
        ((20, 40), 3.0, 20.0, 0.0, 90.0),
        ((17, 23), 3.0, 12.0, 35.0, 90.0),
        ((30, 15), 5.0, 20.0, 7.0, 93.0),
        ((30, 8), 5.0, 20.0, 0.0, 120.0),
    ],
)
def test_every_start_on_the_pinion_climbs_to_the_contact(teeth, module, face_width, spiral_deg, shaft_deg, mounting):
    pair, found = from_everywhere(teeth, module, face_width, spiral_deg, shaft_deg, mounting)
    height = trace_contact(pair, [0.0]).transmission_error[0] * pair.base_radii[1]
    assert found.converged.all()
    np.testing.assert_allclose(found.value, height, atol=1e-9 * pair.base_radii[1])
    assert found.iterations.mean() < FEW_STEPS
    assert found.iterations.max() < 100


def test_start_below_the_base_cone_of_the_wheel_goes_back_to_the_flank():
    """The field means nothing there: an ascent that trusted it would creep on for hundreds of steps."""
    pair, found = from_everywhere((30, 8), 5.0, 20.0, 0.0, 120.0, BevelMounting())
    rho, z = (part.ravel() for part in np.broadcast_arrays(*pair.pinion.flank.grid(25, STARTS // 25)))
    _, edges = EaseOff(pair).heights(np.zeros(STARTS), rho, z)
    below = edges[:, 5] < -0.1 * pair.wheel.flank.extent[0]
    assert below.sum() > 100
    assert found.converged[below].all()
    assert found.iterations[below].max() < 20


def test_corner_where_the_tip_of_the_wheel_leaves_the_root_of_the_pinion_is_found():
    """The first touch lies in that corner, between the points of every grid on either flank."""
    mesh = bevel_mesh(
        (40, 212), 1.4, 41.0, shaft_angle=math.radians(123), pressure_angle=math.radians(16),
        spiral_angle=math.radians(43),
    )  # fmt: skip
    slopes = [FlankModifications(lead_crowning=c, profile_slope=s) for c, s in ((0.009, 0.005), (0.0045, 0.0055))]
    mounting = BevelMounting(pinion_axial=-0.026, shaft_angle_error=-0.0152)
    pair = bevel_pair(mesh, modifications=(slopes[0], slopes[1]), mounting=mounting)
    path = trace_contact(pair, np.array([0.05, 0.1, 0.7, 0.8]) * pair.pitch, warn=False)
    assert path.edges[:, [1, 4]].all(axis=1).any()
    for row, angle in enumerate(path.pinion_angle):
        assert highest_on_grid(pair, angle, (20, 400)) <= path.transmission_error[row] + ROUNDING
