"""Growth of the deflection by free edges: against differences of whole deflections, and where these have a kink."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca import read_scene, sample_separation, trace_contact
from loaded_tca.edges.free import edge_compliance, edge_deflection_growth
from loaded_tca.pairs.gear_pair import MovedSlices
from loaded_tca.separation.pair_change import pair_changes
from tests.samples.results import SCENES

STEP = 1e-6
"""Of motions [mm]: rounding and curvature leave 1e-8 of a difference."""
KEYS = ("mounting.centre_distance_error_mm", "mounting.axial_offset_mm", "mounting.out_of_plane_deg")


@cache
def contacts():
    """Grids of a helical pair whose lines end in the reach of tips and of face ends, and forces on their slices."""
    scene = read_scene(SCENES / "helical.toml")
    pair, rng = scene.pair(), np.random.default_rng(7)
    path = trace_contact(pair, pair.pitch * np.array([-0.6, 0.1, 0.7]))
    grids = [sample_separation(pair, path[n], cells=(8, 20 + n), load=3000.0) for n in range(len(path))]
    return scene, pair, grids, rng.random(sum(grid.y.size for grid in grids))


def deflection(pair, grids, forces):
    parts = np.split(forces, np.cumsum([grid.y.size for grid in grids])[:-1])
    matrices = [edge_compliance(pair, grid) for grid in grids]
    return np.concatenate(
        [0.0 * part if matrix is None else matrix @ part for matrix, part in zip(matrices, parts, strict=True)]
    )


def differences(steps, forces):
    return np.array([(deflection(*one.high, forces) - deflection(*one.low, forces)) / one.difference for one in steps])


def test_deflection_grows_as_differences_of_the_whole_say_where_the_wheel_or_the_slices_move():
    scene, pair, grids, forces = contacts()
    steps = [MovedSlices((key.below, grids), (key.above, grids), key.difference) for key in pair_changes(scene, KEYS)]
    for axis in (0, 1):
        low, high = (
            [replace(grid, origin=grid.origin + part * STEP * grid.axes[axis]) for grid in grids]
            for part in (-0.5, 0.5)
        )
        steps.append(MovedSlices((pair, low), (pair, high), STEP))
    grown, expected = edge_deflection_growth(pair, grids, forces, steps), differences(steps, forces)
    largest = np.abs(expected).max(axis=1)
    assert (largest > 1e-9).all()
    # the differences are rounded to 1e-10 of the deflection over the step, and to 1e-6
    assert_allclose(grown / largest[:, None], expected / largest[:, None], rtol=0, atol=1e-6)


def test_slices_on_an_edge_grow_by_the_mean_of_both_sides():
    """Beyond an edge distances count no more: the growth of the deflection has a jump there."""
    _, pair, grids, _ = contacts()
    grid, out = grids[1], np.array([0.0, 0.0, 1.0])
    on_end = grid.origin + (0.5 * 25.0 - grid.origin[2]) * out  # of a face of 25 mm
    inwards, material = -np.sign(grid.axes[1, 2]), np.ones(2, dtype=bool)

    def moved(by):
        y = np.array([0.0, inwards])
        origin = on_end - by * out
        return SimpleNamespace(origin=origin, axes=grid.axes, y=y, widths=np.full(2, 0.2), with_material=material)

    low, there, high = (edge_compliance(pair, moved(by)).sum(axis=1) for by in (-STEP, 0.0, STEP))
    beyond, inside = (there - low) / STEP, (high - there) / STEP
    steps = [MovedSlices((pair, [moved(-STEP)]), (pair, [moved(STEP)]), 2.0 * STEP)]
    found = edge_deflection_growth(pair, [moved(0.0)], np.ones(2), steps)[0]
    assert_allclose(found, 0.5 * (beyond + inside), rtol=1e-4)
    assert (np.abs(inside - beyond) > 0.1 * np.abs(found)).all()
