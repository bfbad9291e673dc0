import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError
from loaded_tca.flank_maps.conjugate import exchanged, mated_grid
from loaded_tca.gears import CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from tests.samples.gear_pairs import cylindrical_mesh, gear_pair

ROUNDING = 1e-12
"""Of lengths and angles of closed forms, or mm of the face: 2e-16 was seen."""
FOUND = 1e-6
"""mm: edges are found to 1e-9 of the flank, where they are not its own."""


def roll_lengths(pair, rho):
    return np.sqrt(rho**2 - pair.base_radii[0] ** 2)


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_profile_is_the_active_one(helix_deg):
    mesh, pair = cylindrical_mesh(helix_deg=helix_deg), gear_pair(helix_deg=helix_deg)
    for seen, active in ((pair, mesh.pinion_active_profile), (exchanged(pair), mesh.wheel_active_profile)):
        rho, z = mated_grid(seen, 7, 5)
        roll = roll_lengths(seen, rho)
        assert_allclose(roll[0], active.start_roll_length, atol=FOUND)
        assert_allclose(rho[-1], active.end_radius, rtol=ROUNDING)
        assert_allclose(z, np.broadcast_to(np.linspace(-12.5, 12.5, 5), z.shape), atol=ROUNDING)


def test_grid_is_even():
    rho, _ = mated_grid(gear_pair(), 9, 3)
    steps = np.diff(roll_lengths(gear_pair(), rho), axis=0)
    assert_allclose(steps, steps.mean(), rtol=1e-3)  # places are interpolated in between


def test_profile_of_a_bevel_pair_is_the_active_one():
    mesh = bevel_mesh((20, 31), outer_module=4.0, face_width=22.0, spiral_angle=math.radians(30.0))
    pair = bevel_pair(mesh)
    for seen, (start, end) in zip((pair, exchanged(pair)), mesh.active_cones, strict=True):
        angle = np.arctan2(*mated_grid(seen, 5, 5))
        assert_allclose(angle[0], start, atol=1e-7)
        assert_allclose(angle[-1], end, rtol=ROUNDING)


def test_face_ends_with_the_narrower_gear():
    gears = [CylindricalGear(z, 3.0, width) for z, width in ((34, 30.0), (57, 20.0))]
    pair = cylindrical_pair(CylindricalMesh(*gears))
    for seen in (pair, exchanged(pair)):
        _, z = mated_grid(seen, 4, 3)
        assert_allclose(z, np.broadcast_to([-10.0, 0.0, 10.0], z.shape), atol=FOUND)


def test_axial_offset_moves_the_common_face():
    _, z = mated_grid(gear_pair(mounting=Mounting(axial_offset=4.0)), 4, 3)
    assert_allclose(z[:, [0, -1]], np.broadcast_to([-8.5, 12.5], (4, 2)), atol=FOUND)


def test_larger_centre_distance_shortens_the_profile_from_below():
    rolls = [
        roll_lengths(pair, mated_grid(pair, 3, 3)[0])
        for pair in (gear_pair(mounting=Mounting(centre_distance_error=error)) for error in (0.0, 0.5))
    ]
    assert (rolls[1][0] > rolls[0][0] + 0.5).all()
    assert_allclose(rolls[1][-1], rolls[0][-1], rtol=ROUNDING)


@pytest.mark.parametrize("error", [{"axial_offset": 26.0}, {"centre_distance_error": 6.5}])
def test_flank_out_of_reach_is_refused(error):
    with pytest.raises(GeometryError, match="does not reach"):
        mated_grid(gear_pair(mounting=Mounting(**error)), 3, 3)
