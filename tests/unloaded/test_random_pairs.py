"""Random external pairs, far beyond the usual: every position is a certified contact or an error that says why.

60 pairs here; 2000 with HYPOTHESIS_PROFILE=nightly.
"""

import math
import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.unloaded import trace_contact
from tests.samples.gear_pairs import TURNS, assert_certified_or_refused, reliefs

PAIRS = 2000 if os.environ.get("HYPOTHESIS_PROFILE") == "nightly" else 60


@st.composite
def wide_pairs(draw):
    """Teeth 10 to 150, module 0.5 to 20 mm, helix 0 to 35 deg, shifts as ISO 21771 allows, errors to 1 deg, 0.5 mm."""
    module, helix = draw(st.floats(0.5, 20.0)), math.radians(draw(st.floats(0.0, 35.0)))
    width = module * draw(st.floats(2.0, 20.0))
    gears = [
        CylindricalGear(
            draw(st.integers(10, 150)), module, width * draw(st.sampled_from([1.0, 1.1])), helix_angle=sign * helix,
            profile_shift=draw(st.floats(-0.5, 0.8)), name=name,
        )
        for sign, name in ((1.0, "pinion"), (-1.0, "wheel"))
    ]  # fmt: skip
    mesh = CylindricalMesh(*gears)
    modifications = tuple(
        draw(reliefs(module, (2.0 * active.start_radius, 2.0 * active.end_radius)))
        for active in (mesh.pinion_active_profile, mesh.wheel_active_profile)
    )
    angle, length = st.floats(-math.radians(1.0), math.radians(1.0)), st.floats(-0.5, 0.5)
    return cylindrical_pair(
        mesh,
        modifications=modifications,
        mounting=Mounting(draw(angle), draw(angle), draw(length), draw(length)),
        driving=draw(st.sampled_from(["pinion", "wheel"])),
        sense=draw(st.sampled_from(["positive", "negative"])),
    )


@pytest.mark.thorough
@given(st.data(), TURNS)
@settings(max_examples=PAIRS)
def test_every_position_of_a_random_pair_is_certified_or_refused_with_a_reason(data, turns):
    assert_certified_or_refused(lambda: data.draw(wide_pairs()), turns)


def test_shared_region_of_a_hair_is_found():
    """Faces that overlap by a hundredth of the spacing of the scan."""
    gears = [CylindricalGear(z, 3.0, 25.0, name=name) for z, name in ((34, "pinion"), (57, "wheel"))]
    pair = cylindrical_pair(CylindricalMesh(*gears), mounting=Mounting(axial_offset=24.99))
    path = trace_contact(pair, [0.0])
    assert path.in_contact.all()
    assert path.pinion_axial[0] == pytest.approx(12.5, abs=0.011)


def test_narrow_wheel_between_the_points_of_the_scan_is_found():
    pinion, wheel = (CylindricalGear(z, 3.0, b, name="gear") for z, b in ((34, 50.0), (57, 0.3)))
    for offset in np.linspace(0.0, 3.0, 7):
        pair = cylindrical_pair(CylindricalMesh(pinion, wheel), mounting=Mounting(axial_offset=float(offset)))
        path = trace_contact(pair, [0.0])
        assert path.in_contact.all()
        assert path.pinion_axial[0] == pytest.approx(offset, abs=0.15)
