"""Frames of pictures: root at the bottom, tip on top, toe left, heel right, and lengths that are true."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.flanks import ConeFrame, CylinderFrame, FlankModifications
from loaded_tca.flanks.base import EDGE_NAMES, lengthwise_direction
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from tests.samples.gear_pairs import gear_pair

CROWNED = FlankModifications(lead_crowning=0.01, profile_crowning=0.005)


def bevel(modifications=FlankModifications(), **mesh):
    built = bevel_mesh((20, 40), 4.0, 20.0, **mesh)
    return bevel_pair(built, modifications=(modifications, modifications))


PAIRS = {
    "spur": gear_pair,
    "helical, crowned": lambda: gear_pair(CROWNED, CROWNED, helix_deg=15.0),
    "straight bevel": bevel,
    "spiral bevel, crowned": lambda: bevel(CROWNED, spiral_angle=math.radians(35.0)),
    "obtuse bevel": lambda: bevel(shaft_angle=math.radians(120.0)),
}
flanks = pytest.mark.parametrize(
    ("kind", "member"), [(kind, member) for kind in PAIRS for member in ("pinion", "wheel")]
)


@flanks
def test_picture_has_the_tip_on_top_and_the_heel_on_the_right(kind, member):
    flank = getattr(PAIRS[kind](), member).flank
    across, up = flank.frame.to_picture(*flank.grid(9, 7))
    assert (np.diff(up, axis=0) > 0.0).all()
    assert (np.diff(across, axis=1) > 0.0).all()
    assert_allclose(across[:, 0], -across[:, -1], rtol=1e-9)  # mid-face in the middle


@flanks
def test_lengthwise_place_is_the_coordinate_of_lengthwise_modifications(kind, member):
    flank = getattr(PAIRS[kind](), member).flank
    rho, z = flank.grid(5, 4)
    expected = np.broadcast_to(flank.lengthwise_coordinate(rho, z).value, rho.shape)
    assert_allclose(flank.frame.to_picture(rho, z)[0], expected, atol=1e-12)  # mm; of some 50 mm, beside rtol


@flanks
def test_lengthwise_direction_is_the_one_in_which_the_place_moves_to_the_right(kind, member):
    flank, step = getattr(PAIRS[kind](), member).flank, 1e-6
    rho, z = flank.grid(5, 4)
    radial, around, axial = np.moveaxis(lengthwise_direction(flank, rho, z), -1, 0)
    assert_allclose(around, 0.0, atol=0)
    assert_allclose(np.hypot(radial, axial), 1.0)
    moved = flank.frame.to_picture(rho + step * radial, z + step * axial)[0] - flank.frame.to_picture(rho, z)[0]
    assert_allclose(moved, step, rtol=1e-6)  # differences of 1e-6 in numbers of 10 to 100


def test_height_on_a_cone_is_zero_on_the_pitch_cone_and_grows_with_the_cone_distance():
    mesh = bevel_mesh((20, 40), 4.0, 20.0)
    frame = ConeFrame(mesh.pinion.pitch_angle, mesh.pinion.mean_cone_distance)
    distance = np.array([70.0, 90.0])
    for angle, height in ((mesh.pinion.pitch_angle, 0.0), (mesh.pinion.tip_angle, 1.0)):
        rho, z = distance * np.sin(angle), distance * np.cos(angle)
        rise = distance * (mesh.pinion.tip_angle - mesh.pinion.pitch_angle)
        # mm; of heights of some mm, beside rtol
        assert_allclose(frame.to_picture(rho, z)[1], height * rise, atol=1e-12)


def test_edges_have_a_name_each_in_the_order_of_the_flank():
    for frame, words in (
        (CylinderFrame(), ("tip", "root", "z < 0", "z > 0")),
        (ConeFrame(0.5, 100.0), ("face", "root", "toe", "heel")),
    ):
        assert len(frame.edges) == len(EDGE_NAMES)
        assert all(word in name for word, name in zip(words, frame.edges, strict=True))
        assert frame.heelwards in ("z > 0", "the heel")


@pytest.mark.parametrize(
    ("distance", "angle", "words"),
    [
        (100.0, 0.5, "at the mean cone distance, 0 mm above the pitch cone"),
        (97.5, 0.49, "2.5 mm from R_m to the toe, 0.975 mm below the pitch cone"),
        (101.25, 0.51, "1.25 mm from R_m to the heel, 1.01 mm above the pitch cone"),
    ],
)
def test_place_on_a_cone_is_told_from_mid_face_and_pitch_cone(distance, angle, words):
    frame = ConeFrame(0.5, 100.0)
    assert frame.place(distance * math.sin(angle), distance * math.cos(angle)) == words


def test_span_of_a_profile_does_not_depend_on_the_place_lengthwise():
    for z in (3.0, -4.0):
        assert CylinderFrame().profile_span((51.0, z), (55.8, z)) == "diameter 102.00 to 111.60 mm"
    for distance in (80.0, 100.0):
        ends = [(distance * math.sin(angle), distance * math.cos(angle)) for angle in (0.48, 0.52)]
        assert ConeFrame(0.5, 100.0).profile_span(*ends) == "cone angle 27.50 to 29.79 deg"


def test_modified_flank_keeps_the_frame_of_the_nominal_one():
    assert bevel(CROWNED).wheel.flank.frame == bevel().wheel.flank.frame
