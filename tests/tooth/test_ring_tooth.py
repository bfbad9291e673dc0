"""Complete teeth of rings: closed, outwards, tangent fillets, and what they are held by."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import PinionCutter
from loaded_tca.pairs import mating_teeth
from loaded_tca.tooth import Resolution, build_tooth
from loaded_tca.tooth.fillet import ArcFillet
from tests.samples.internal_pairs import ring_pair

ROUNDING = 1e-12  # of the root of two squares
FINE = Resolution(flank=33, fillet=33, land=5, lengthwise=5)
CUTTER = PinionCutter(25, 0.1, 0.25)


def tooth_of(gear):
    return build_tooth(gear.flanks, gear.form, FINE)


@pytest.mark.parametrize("cutter", [None, CUTTER])
@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_closed_ring_tooth_has_no_open_edge_and_its_normals_point_outwards(cutter, helix):
    surface = tooth_of(ring_pair(helix_deg=helix, cutter=cutter).wheel).triangles(closed=True)
    assert surface.is_closed
    assert surface.volume > 0.0


def test_normals_of_the_lands_point_towards_the_axis():
    surface = tooth_of(ring_pair().wheel).triangles()
    for patch in (0, 3, 6):  # root lands and tip land
        of_patch = surface.cell_data["patch"] == patch
        middle, normal = surface.corners[of_patch].mean(axis=1), surface.normals[of_patch]
        assert ((middle * normal)[:, :2].sum(axis=1) < 0.0).all()


def test_lands_lie_on_their_circles():
    pair = ring_pair()
    tooth = tooth_of(pair.wheel)
    gear = pair.wheel.geometry.gear
    for name, radius in (("tip land", gear.tip_radius), ("root land +", gear.root_radius)):
        patch = tooth.patch(name)
        assert_allclose(np.hypot(patch[..., 0], patch[..., 1]), radius, rtol=ROUNDING)


@pytest.mark.parametrize("cutter", [None, CUTTER])
def test_outline_bends_smoothly_from_the_flank_over_the_fillet_to_the_root(cutter):
    tooth = tooth_of(ring_pair(cutter=cutter).wheel)
    line = tooth.outline[:, 2, :2]
    step = np.diff(line[tooth.joints[4] : tooth.joints[7]], axis=0)
    turn = np.abs(np.diff(np.unwrap(np.arctan2(step[:, 1], step[:, 0]))))
    assert turn.max() < 0.12  # rad, of an arc of 32 pieces over a right angle; a corner would have 0.3 or more


def test_fillet_of_a_modified_flank_turns_with_its_root_edge():
    plain = tooth_of(ring_pair().wheel)
    changed = tooth_of(ring_pair(wheel=FlankModifications(profile_slope=0.02)).wheel)
    assert_allclose(changed.patch("tip land").shape, plain.patch("tip land").shape)
    assert np.abs(changed.outline - plain.outline).max() < 0.03


def test_arc_that_is_asked_for_has_its_radius_in_the_gear():
    pair = ring_pair()
    form = pair.wheel.form.with_arc(0.8)
    assert isinstance(form.fillet, ArcFillet)
    curve = build_tooth(pair.wheel.flanks, form, FINE).patch("fillet +")[-8:, 2, :2]
    place = curve @ [1.0, 1j]  # below the straight piece that leads on from the flank
    a, b, c = place[0], place[4], place[-1]
    area = 0.5 * abs(((b - a) * np.conj(c - a)).imag)
    assert_allclose(abs(a - b) * abs(b - c) * abs(c - a) / (4.0 * area), 0.8, rtol=1e-9)
    with pytest.raises(InputError, match=r"fillet_radius: 90 mm does not fit .* the largest that does is 1.303 mm"):
        build_tooth(pair.wheel.flanks, pair.wheel.form.with_arc(90.0), FINE)


def test_ring_is_held_at_its_outside():
    default = ring_pair().wheel
    root = default.geometry.gear.root_radius
    assert_allclose(default.smallest_bore, 2.0 * root + 14.0 * 3.0)
    assert default.rim_over_height > 1.0
    assert_allclose(ring_pair(outer_diameter=240.0).wheel.smallest_bore, 240.0)
    with pytest.raises(InputError, match=r"outer_diameter: 188 mm is not between 1.02 and 20 times"):
        _ = ring_pair(outer_diameter=188.0).wheel.smallest_bore


def test_teeth_in_mesh_touch_and_do_not_overlap():
    """In mesh at the pitch point, the nearest points of both flanks are apart by their chords alone."""
    pair = ring_pair()
    pinion, ring = mating_teeth(pair, Resolution(flank=201, lengthwise=3)).in_mesh(0.0, 0.0)
    points = [
        surface.vertices[np.unique(surface.triangles[surface.cell_data["patch"] == 4])] for surface in (pinion, ring)
    ]
    middle = [p[np.abs(p[:, 2]) < 1e-9] for p in points]
    assert np.linalg.norm(middle[0][:, None] - middle[1][None], axis=-1).min() < 0.03  # mm, steps along the profile
