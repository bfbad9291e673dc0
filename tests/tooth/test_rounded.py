"""Complete teeth with rounded edges: the arc is part of the surface, and the land narrower by it."""

import numpy as np
import pytest

from loaded_tca.compliance import require_teeth
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.scene import read_scene
from loaded_tca.tooth import build_tooth
from tests.samples.gear_pairs import gear_pair
from tests.samples.results import SCENES


def test_tip_land_and_face_ends_are_narrower_by_the_arcs():
    pair = gear_pair()
    blunt = pair.rounded(pinion=EdgeRounding(tip=0.3, side=0.3)).pinion
    sharp_tooth, tooth = (build_tooth(gear.flanks, gear.form) for gear in (pair.pinion, blunt))
    lands = [np.linalg.norm(np.diff(one.patch("tip land")[[0, -1], 16], axis=0)) for one in (sharp_tooth, tooth)]
    removed = float(blunt.flank.removal(*(np.array(part) for part in (blunt.flank.nominal.radii[1], 0.0))).value)
    narrower = 2.0 * removed * blunt.flank.nominal.radii[1] / blunt.flank.nominal.base_radius
    assert lands[0] - lands[1] == pytest.approx(narrower, rel=1e-3)
    flank, sharp_flank = (one.patch("flank +") for one in (tooth, sharp_tooth))
    azimuth, sharp_azimuth = (np.arctan2(one[..., 1], one[..., 0]) for one in (flank, sharp_flank))
    assert azimuth[-1, 0] < azimuth[-1, 16], "the end of the face is turned in"
    # rad; away from the arcs the rounding adds zeros
    assert azimuth[-1, 16] == pytest.approx(sharp_azimuth[-1, 16], abs=1e-12)


def test_surface_is_fine_where_the_arc_bends():
    gear = gear_pair().rounded(pinion=EdgeRounding(tip=0.3)).pinion
    flank = build_tooth(gear.flanks, gear.form).patch("flank +")[:, 16]
    on = np.hypot(flank[:, 0], flank[:, 1]) > gear.flank.nominal.radii[1] - gear.flank.arcs[0].reach
    assert on.sum() >= 7, "an even grid has one"


@pytest.mark.thorough
def test_teeth_whose_corners_have_no_room_for_all_arcs_are_built():
    """The toe of a spiral bevel tooth: arcs of tip and side of both flanks meet on a land of 0.4 mm."""
    scene = read_scene(SCENES / "spiral_bevel.toml")
    radii = {f"{gear}.{edge}_rounding_mm": 0.19 for gear in ("pinion", "wheel") for edge in ("tip", "side")}
    gear = scene.with_changes(radii).pair().pinion
    tooth = build_tooth(gear.flanks, gear.form)
    azimuth = np.arctan2(tooth.outline[..., 1], tooth.outline[..., 0])
    thickness = azimuth[tooth.joints[4]] - azimuth[tooth.joints[3]]
    assert (thickness >= -1e-15).all()  # mm; a depth less itself
    assert thickness[len(thickness) // 2] > 0.0


def test_bending_of_rounded_teeth_is_checked_with_sharp_edges():
    """No warning that the tooth is pointed: bending does not see its arcs."""
    scene = read_scene(SCENES / "spiral_bevel.toml")
    require_teeth(scene.with_changes({"pinion.side_rounding_mm": 0.19, "pinion.tip_rounding_mm": 0.19}).pair(), "")
