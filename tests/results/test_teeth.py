import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.pairs import mating_teeth
from loaded_tca.results.teeth import teeth_in_space
from loaded_tca.tooth import Resolution
from tests.samples.results import result, with_a_gap

COARSE = Resolution(9, 5, 3, 5)


def placed(cycle, **where):
    return teeth_in_space(cycle, mating_teeth(cycle.gear_pair, COARSE), **where)


@pytest.mark.parametrize("name", ["helical", "straight_bevel", "spiral_bevel"])
def test_pressure_carries_the_normal_force(name):
    """Laid on the flank the cells keep their size: their pressures add up to the force on the tooth pair."""
    cycle = result(name, positions=3)
    shown = placed(cycle, position=1)
    sizes = np.linalg.norm(shown.pressure.normals, axis=1)
    carried = float((sizes * shown.pressure.cell_data["pressure_MPa"]).sum())
    assert_allclose(carried, cycle.normal_force[0, 1, 0], rtol=5e-3)  # a curved flank for a tangent plane


@pytest.mark.parametrize("name", ["helical", "spiral_bevel"])
def test_path_runs_through_the_contact_point_of_the_position(name):
    cycle = result(name, positions=5)
    shown = placed(cycle, position=3)
    assert_allclose(shown.path[3], shown.point, atol=1e-9)
    assert_allclose(shown.point, cycle.path.point[3])
    steps = np.linalg.norm(np.diff(shown.path, axis=0), axis=1)
    assert (steps > 0.0).all()


@pytest.mark.parametrize("changes", [{"pair.sense": "negative"}, {"pair.driving": "wheel"}])
def test_any_sense_and_drive_brings_the_right_flanks_together(changes):
    scene = result("straight_bevel", positions=3).scene.with_changes(changes)
    teeth = mating_teeth(scene.pair(), COARSE)
    assert teeth.pair.pinion.flank.side == teeth.pair.sense * teeth.pair.driving
    turned = mating_teeth(scene.with_changes({"pair.sense": None}).pair(), COARSE)
    assert_allclose(turned.pinion.outline, teeth.pinion.outline)  # the teeth themselves are the same


def test_eye_sees_the_flank():
    for name in ("helical", "spiral_bevel"):
        shown = placed(result(name, positions=3))
        assert shown.eye @ shown.normal > 0.5
        assert_allclose(np.linalg.norm(shown.eye), 1.0)


def test_default_is_the_peak_under_the_largest_torque():
    cycle = result(torques=(20.0, 50.0, 80.0))
    shown = placed(cycle)
    assert (shown.torque, shown.position, shown.column) == (2, *cycle.peak_contact(2))
    assert_allclose(shown.highest_pressure, cycle.maps[2][shown.position][0].pressure.max())


def test_position_without_contact_is_refused():
    with pytest.raises(GeometryError, match="is not in contact at this position"):
        placed(with_a_gap(), position=1)


def test_positions_without_contact_have_no_place_on_the_path():
    cycle = with_a_gap()
    assert len(placed(cycle, position=0).path) == cycle.path.in_contact.sum()


def test_fillet_that_does_not_fit_is_refused():
    scene = result("straight_bevel", positions=3).scene
    with pytest.raises(InputError, match="pinion: fillet_radius: 9 mm does not fit"):
        mating_teeth(scene.pair(), COARSE, fillet_radius=9.0)
