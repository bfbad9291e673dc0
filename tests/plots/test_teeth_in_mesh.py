"""Teeth of both gears in mesh at the pitch point: they touch there, overlap nowhere, and have their numbers."""

import itertools
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.testing import assert_allclose

from loaded_tca.plots import plot_teeth_in_mesh
from loaded_tca.plots.style import note_of
from loaded_tca.scene import read_scene

ROUNDING = 1e-12  # relative, or mm: points of lengths of 100 mm by a few operations
SCENES = Path(__file__).parents[2] / "examples" / "scenes"
SPUR, RING = SCENES / "spur.toml", SCENES / "ground_planet_ring.toml"
UNDERCUT = {"pinion.teeth": 10, "wheel.teeth": 40}
FREE = {"pair.sense": "negative", "mounting.centre_distance_error_mm": 0.02}
CHORD = 1e-3
"""Of a module: outlines are straight between points, 0.06 modules apart: 0.06^2/8 over half a module."""

ON_CIRCLE = 1e-9
"""Radii of lands, which go through sine and cosine [mm]."""


def drawn(path, changes):
    return _drawn(path, tuple(changes.items()))


@cache
def _drawn(path, changes):
    scene = read_scene(path).with_changes(dict(changes))
    return scene.mounted_mesh(), plot_teeth_in_mesh(scene)


def line(figure, label):
    """Points (n, 2) of the line with this label."""
    return next(one.get_xydata() for one in figure.axes[0].lines if one.get_label() == label)


def outlines(figure, width):
    """Points (n, 2) of both gears beside the pitch point."""
    both = [patch.get_xy() for patch in figure.axes[0].patches]
    return [points[np.abs(points[:, 0]) < width] for points in both]


def above_wheel(mesh, points):
    """How far points lie outside the teeth of the wheel whose axis is on the line of centres, along its circles [mm].

    Only of those between its tip and its root; teeth stand where their flanks touch at the pitch point.
    """
    wheel, ring, radius_w = mesh.wheel, mesh.wheel.teeth < 0, mesh.wheel_working_radius
    x, y = points[:, 0], radius_w + points[:, 1] if ring else radius_w - points[:, 1]
    radius, angle = np.hypot(x, y), np.arctan2(x, y)
    low, high = sorted((wheel.tip_radius, wheel.root_radius))
    inside = (radius > low + ON_CIRCLE) & (radius < high - ON_CIRCLE)
    radius, angle = radius[inside], angle[inside]
    flank = np.linspace(wheel.form_radius, wheel.tip_radius, 400)
    half = [0.5 * wheel.tooth_thickness_at(one) / one for one in flank]
    fillet = wheel.root_fillet(400)
    radii, halves = np.append(fillet[0][::-1], flank), np.append(fillet[1][::-1], half)
    order = np.argsort(radii)
    pitch, middle = 2.0 * math.pi / wheel.tooth_count, 0.5 * wheel.tooth_thickness_at(radius_w) / radius_w
    right = np.remainder(angle + middle + 0.5 * pitch, pitch) - 0.5 * pitch
    left = np.remainder(angle - middle + 0.5 * pitch, pitch) - 0.5 * pitch
    thick = np.interp(radius, radii[order], halves[order])
    return radius * (np.abs(right) - thick), radius * (np.abs(left) - thick)


@pytest.mark.parametrize(
    ("path", "changes", "mirrored"),
    [
        (SPUR, UNDERCUT, False),
        (SPUR, {**UNDERCUT, "pair.driving": "wheel", "wheel.tip_chamfer_mm": 0.3}, True),
        (RING, FREE, True),
    ],
)
def test_teeth_touch_at_the_pitch_point_and_overlap_nowhere(path, changes, mirrored):
    mesh, figure = drawn(path, changes)
    module = mesh.pinion.normal_module
    pinion, wheel = outlines(figure, 6.0 * module)
    outside = above_wheel(mesh, pinion)[mirrored]
    assert outside.min() > -CHORD * module
    assert above_wheel(mesh, wheel)[mirrored].max() < CHORD * module  # where the wheel is drawn
    assert np.hypot(*pinion.T).min() < 0.1 * module  # of its points; the flank between them goes through the origin
    assert outside.min() < 0.02 * module
    if mesh.backlash > 0.1:
        assert above_wheel(mesh, pinion)[not mirrored].min() < -0.05  # teeth on the other side would overlap


def test_path_of_contact_lies_between_the_circles_that_end_it():
    mesh, figure = drawn(SPUR, UNDERCUT)
    ends = line(figure, "path of contact A to E")
    first, second = (np.hypot(ends[:, 0], ends[:, 1] - height) for height in (-mesh.pinion_working_radius, 60.0))
    assert_allclose(first, [mesh.pinion.form_radius, mesh.pinion.tip_radius], rtol=ROUNDING)
    whole = line(figure, "line of action T1 T2")
    assert_allclose(
        np.hypot(whole[0, 0], whole[0, 1] + mesh.pinion_working_radius), mesh.pinion.base_radius, rtol=ROUNDING
    )
    assert_allclose(np.hypot(whole[1, 0], whole[1, 1] - 60.0), mesh.wheel.base_radius, rtol=ROUNDING)
    assert (second < mesh.wheel.tip_radius).all()  # the undercut ends the path before the tip of the wheel
    assert figure.axes[0].get_aspect() == 1.0


def test_points_that_touch_are_base_pitches_apart_on_the_path():
    mesh, figure = drawn(RING, FREE)
    points = line(figure, "flanks touch")
    assert len(points) == 1 + int(mesh.path_of_contact.AC // mesh.pinion.base_pitch) + int(
        (mesh.path_of_contact.AE - mesh.path_of_contact.AC) // mesh.pinion.base_pitch
    )
    assert_allclose(np.hypot(*points.T).min(), 0.0, atol=ROUNDING)


def test_picture_has_its_numbers_with_units():
    mesh, figure = drawn(RING, FREE)
    note = note_of(figure)
    for part in (
        "mounted with an error of the centre distance of -0.0200 mm",
        f"contact ratio {mesh.transverse_contact_ratio:.4f}",
        f"backlash j_wt {mesh.backlash:.4f} mm",
        "tip clearance at the root of the pinion {:.4f} mm, of the wheel {:.4f} mm".format(*mesh.tip_clearances),
        "pinion drives, pinion turns clockwise",
    ):
        assert part in note
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert {f"backlash j_wt = {mesh.backlash:.4f} mm", *(f"c = {one:.3f} mm" for one in mesh.tip_clearances)} <= {
        *texts
    }
    assert [text for text in texts if len(text) <= 2] == ["T1", "A", "B", "C", "D", "E"] or "T2" in texts
    assert "undercut of the pinion: 1.5172 mm of the path are lost, 13.6%" in note_of(drawn(SPUR, UNDERCUT)[1])


@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("path", [SPUR, RING])
def test_clearances_are_written_where_the_path_of_contact_is_not(path, sense):
    """On the other side of the line of centres, so that no letter of the path lies below them."""
    _, figure = drawn(path, {"pair.sense": sense})
    FigureCanvasAgg(figure).draw()
    ends, axes = line(figure, "path of contact A to E"), figure.axes[0]
    clearances = [text for text in axes.texts if text.get_text().startswith("c = ")]
    assert len(clearances) == 2
    for text in clearances:
        extent = text.get_window_extent().transformed(axes.transData.inverted())
        (end,) = ends[np.sign(ends[:, 1]) == np.sign(extent.y0 + extent.y1)]
        assert end[0] * (extent.x0 + extent.x1) < 0.0


def test_rack_is_called_rack_and_letters_do_not_overlap():
    """The tip line of a rack cuts the line of action near T1 where 18 teeth are just not undercut."""
    changes = {"pair.helix_angle_deg": 0.0, "pinion.teeth": 18, "pinion.modifications": {}}
    scene = read_scene(SCENES / "rack_and_pinion.toml").with_changes(changes)
    figure = plot_teeth_in_mesh(scene)
    figure.canvas.draw()
    (axes,) = figure.axes
    letters = [text for text in axes.texts if set(text.get_text()) <= set("ABCDET1 ")]  # T2 is far away
    assert "".join(text.get_text().replace(" ", "") for text in letters) == "T1ABCDE"
    boxes = sorted((text.get_window_extent() for text in letters), key=lambda box: box.x0)
    assert all(left.x1 <= right.x0 for left, right in itertools.pairwise(boxes))
    words = [*axes.get_legend_handles_labels()[1], axes.get_ylabel(), note_of(figure)]
    assert "rack" in words
    assert not [text for text in words if "wheel" in text]
