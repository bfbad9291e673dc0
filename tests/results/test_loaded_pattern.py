"""Where loaded contacts leave their marks on a flank."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene
from loaded_tca.results.loaded_pattern import loaded_pattern
from tests.samples.results import SCENES


class Map(SimpleNamespace):
    """Cells of 1 x 0.5 mm of a tangent plane along y and z, from y = 50 mm."""

    @property
    def points(self):
        x, y = np.meshgrid(50.0 + np.arange(4.0), 0.5 * np.arange(3) + self.at, indexing="ij")
        return np.stack([x, 0.0 * x, y], axis=-1)


def result(*pressures):
    """Maps (4, 3) whose first axis is the radius of a flank that its frame shows as it is, and the last the axis."""
    frame = SimpleNamespace(to_picture=lambda rho, z: (z, rho))
    gear = SimpleNamespace(flank=SimpleNamespace(frame=frame))
    on_flank = lambda points: (points[..., 0], points[..., 2])  # noqa: E731
    pair = SimpleNamespace(pinion=gear, wheel=gear, on_pinion=on_flank, on_wheel=on_flank)
    maps = [
        [None if p is None else Map(pressure=p, spacing=(1.0, 0.5 + k), at=2.0 * k) for k, p in enumerate(pressures)]
    ]
    peaks = np.array([[[np.nan if p is None else p.max() for p in pressures]]])
    return SimpleNamespace(maps=[maps], gear_pair=pair, peak_pressure=peaks, scene=SimpleNamespace(is_supported=False))


def test_pattern_has_the_centre_of_all_forces_and_their_reach():
    one, other = np.zeros((4, 3)), np.zeros((4, 3))
    one[1, 0], other[3, 2] = 300.0, 100.0  # of cells of 0.5 and 1.5 mm2: forces of 150 N at (0, 51) and (3, 53) mm
    pattern = loaded_pattern(result(one, None, np.zeros((4, 3))), 0, "pinion")
    assert_allclose([*pattern.centre, *pattern.size, pattern.peak_pressure], [0.0, 51.0, 0.0, 0.0, 300.0])
    pattern = loaded_pattern(result(one, other), 0, "wheel")
    assert_allclose([*pattern.centre, *pattern.size, pattern.peak_pressure], [1.5, 52.0, 3.0, 2.0, 300.0])


def test_nothing_in_contact_has_no_pattern():
    pattern = loaded_pattern(result(None, np.zeros((4, 3))), 0, "pinion")
    assert np.isnan([*pattern.centre, *pattern.size, pattern.peak_pressure]).all()


@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
def test_pattern_on_a_gear_that_gives_way_is_where_the_gear_stands():
    """A wheel that moves along its axis alone has the pattern so much further back, both gears one place in space."""
    compliance = [[4e-5 if i == j == 2 else 0.0 for j in range(6)] for i in range(6)]  # mm/N along the axis
    few = {"analysis.cells": [8, 16], "analysis.positions": 2, "analysis.compliance": "contact"}
    scene = read_scene(SCENES / "helical.toml").with_changes({**few, "wheel.support.compliance": compliance})
    found = analyse(scene)
    moved = found.wheel_motion[0, :, 2]
    assert np.abs(moved).min() > 0.01
    middles = [
        (one.pressure[..., None] * one.points).sum(axis=(0, 1)) * np.prod(one.spacing)
        for row in found.maps[0]
        for one in row
        if one is not None
    ]
    forces = [one.pressure.sum() * np.prod(one.spacing) for row in found.maps[0] for one in row if one is not None]
    in_space = np.sum(middles, axis=0)[2] / sum(forces)
    expected = in_space - found.gear_pair.wheel_origin[2] - moved.mean()
    assert_allclose(loaded_pattern(found, 0, "wheel").centre[0], expected, atol=1e-3 * abs(moved.mean()))
