"""The whole line, from a scene to the loaded contact over a pitch."""

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import (
    AccuracyWarning,
    ConvergenceError,
    GeometryError,
    InputError,
    analyse,
    load_result,
    read_scene,
)
from loaded_tca.reference import hertz
from loaded_tca.scene import parse_scene
from loaded_tca.unloaded import relative_curvature
from loaded_tca.unloaded.tooth_cycle import pitches_within_reach
from tests.samples.results import ONE_PAIR, assert_same

EQUILIBRIUM = 1e-10
"""Asked for: the pressures sum up to the load; rounding of a sum of 1e4 cells is 1e-13."""
MAP_ERROR = 5e-3
"""Asked for between the pressure map and Hertz at accuracy 1e-3; flanks are no paraboloids to about 1e-3."""
DIFFERENCE = 2e-3
"""A chord of 2 % in the torque against the tangent: approach ~ F^(2/3) bends by 1e-4, the grids differ by 1e-3."""

BEVEL_MAP_ERROR = 1e-2
"""The same on small bevel gears: over the contact of the 17/17 pair the curvature changes by a percent."""

SCENES = Path(__file__).parents[1] / "examples" / "scenes"

SMALLEST_ORDER = 1.5
"""The largest cell of a smooth contact is off by the square of the cell; where it lies adds scatter."""

SCENE = """
title = "Crowned helical pair"
[pair]
type = "cylindrical"
normal_module_mm = 3.0
pressure_angle_deg = 20.0
helix_angle_deg = 15.0
centre_distance_mm = 141.315
driving = "pinion"
sense = "positive"
[pinion]
teeth = 34
face_width_mm = 25.0
hand = "right"
profile_shift = 0.0
tip_diameter_mm = 111.6
bore_diameter_mm = 40.0
[pinion.modifications]
lead_crowning_um = 10.0
lead_crowning_form = "parabolic"
end_relief_um = 0.0
end_relief_length_mm = 0.0
profile_crowning_um = 0.0
tip_relief_um = 0.0
tip_relief_start_mm = 0.0
tip_relief_form = "parabolic"
root_relief_um = 0.0
root_relief_start_mm = 0.0
helix_slope_um = 0.0
profile_slope_um = 0.0
[wheel]
teeth = 57
face_width_mm = 25.0
[mounting]
in_plane_deg = 0.0
out_of_plane_deg = 0.0
centre_distance_error_mm = 0.0
axial_offset_mm = 0.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
max_pressure_MPa = 4000.0
[load]
pinion_torque_Nm = 130.0
[analysis]
positions = 3
accuracy = 1e-3
cells = [32, 32]
tolerance = 1e-6
load_sharing = false
compliance = "contact"
free_edges = false
torques_Nm = [20.0, 130.0]
"""


@pytest.fixture
def scene():
    return parse_scene(SCENE).with_changes({"analysis.torques_Nm": None, "analysis.cells": None})


def test_numbers_have_the_axes_torque_position_pair():
    result = analyse(parse_scene(SCENE))
    assert_allclose(result.torque, [20e3, 130e3])
    assert result.transmission_error.shape == result.mesh_stiffness.shape == (2, 3)
    assert result.peak_pressure.shape == result.load_share.shape == (2, 3, 1)
    assert [len(row) for row in result.maps] == [3, 3]
    assert result.maps[0][0][0].pressure.shape == (32, 32)


def test_one_torque_has_an_axis_too(scene):
    result = analyse(scene)
    assert result.scene is scene
    assert result.transmission_error.shape == (1, 3)
    assert result.peak_pressure.shape == (1, 3, 1)
    assert result.pinion_angle.shape == (3,)
    assert_allclose(result.load_share, np.ones((1, 3, 1)), rtol=0)


def test_positions_cover_one_pitch_with_both_ends(scene):
    # rad; a pitch of 0.2 less its half
    assert_allclose(analyse(scene).pinion_angle, np.pi / 34 * np.array([-1.0, 0.0, 1.0]), rtol=0, atol=1e-13)


def test_one_position_is_the_pitch_point(scene):
    result = analyse(scene.with_changes({"analysis.positions": 1}))
    assert_allclose(result.pinion_angle, [0.0], atol=0)


def test_pressures_sum_up_to_the_normal_force_of_the_torque(scene):
    result = analyse(scene)
    for force, (mapped,), lever in zip(
        result.normal_force[0, :, 0], result.maps[0], result.path.pinion_lever, strict=True
    ):
        assert_allclose(mapped.pressure.sum() * math.prod(mapped.spacing), force, rtol=EQUILIBRIUM)
        assert_allclose(force * lever, 130e3, rtol=EQUILIBRIUM)


def test_gap_is_closed_where_there_is_pressure(scene):
    result = analyse(scene)
    for (mapped,), approach in zip(result.maps[0], result.contact_deformation[0, :, 0], strict=True):
        pressed = mapped.pressure > 0.0
        assert np.abs(mapped.gap[pressed]).max() <= 10 * scene.analysis.tolerance * approach
        assert mapped.gap.min() >= -10 * scene.analysis.tolerance * approach


def test_peak_pressure_is_that_of_hertz(scene):
    result = analyse(scene)
    assert_allclose(result.peak_pressure, result.hertz_pressure, rtol=MAP_ERROR)


def test_load_adds_the_contact_deformation_to_the_transmission_error(scene):
    result = analyse(scene)
    added = result.contact_deformation[..., 0] / result.path.wheel_lever
    assert_allclose(result.path.transmission_error - result.transmission_error, added, rtol=1e-9)


def test_load_makes_the_transmission_error_grow_where_the_wheel_drives(scene):
    result = analyse(scene.with_changes({"pair.driving": "wheel"}))
    assert (result.transmission_error > result.path.transmission_error).all()


def test_mesh_stiffness_is_the_tangent_of_force_over_transmission_error(scene):
    torques = (129.0, 130.0, 131.0)
    result = analyse(scene.with_changes({"analysis.torques_Nm": torques, "analysis.cells": (64, 64)}))
    pair = scene.pair()
    force = 1e3 * (torques[2] - torques[0]) / pair.base_radii[0] / pair.face_width
    turned = pair.base_radii[1] * (result.transmission_error[0] - result.transmission_error[2])
    assert_allclose(result.mesh_stiffness[1], 1e-3 * force / turned, rtol=DIFFERENCE)


def test_zero_torque_gives_no_pressure_and_the_unloaded_transmission_error(scene):
    result = analyse(scene.with_changes({"load.pinion_torque_Nm": 0.0}))
    assert_allclose(result.peak_pressure, 0.0, atol=0)
    assert np.isnan(result.hertz_pressure).all()
    assert_allclose(result.transmission_error[0], result.path.transmission_error, atol=1e-10)


def test_small_torque_tends_to_the_unloaded_transmission_error(scene):
    result = analyse(scene.with_changes({"analysis.torques_Nm": (1e-6, 1e-3, 1.0)}))
    added = np.abs(result.transmission_error - result.path.transmission_error).max(axis=1)
    assert added[0] < added[1] < added[2]
    assert added[0] < 1e-9


def test_edge_contact_warns_and_has_no_hertz_value(scene):
    misaligned = scene.with_changes({"mounting.out_of_plane_deg": 0.3, "analysis.positions": 1})
    with pytest.warns(
        AccuracyWarning,
        match=r"reaches an edge of a flank.*1 of 1 pressure maps; the first: .* N m, pinion angle .*, tooth pair 0\)",
    ):
        result = analyse(misaligned)
    assert result.on_edge.item() is True
    assert np.isnan(result.hertz_pressure.item())
    assert result.edge_pressure.item() == result.maps[0][0][0].pressure.max()
    assert result.edge_is_rounded.item() is False
    assert result.peak_pressure.item() < result.edge_pressure.item()


def test_unmodified_pair_carries_line_contact_hertz_in_the_middle(scene):
    line = scene.with_changes({"pinion.modifications": {}, "analysis.positions": 1, "analysis.cells": (48, 48)})
    with pytest.warns(AccuracyWarning, match="reaches an edge"):
        result = analyse(line)
    mapped, pair = result.maps[0][0][0], line.pair()
    middle = mapped.pressure[:, 23:25].mean(axis=1)
    assert result.path[0].on_line
    curvature = relative_curvature(pair, result.path[0]).across
    expected = hertz.line_contact(middle.sum() * mapped.spacing[0], curvature, pair.contact_modulus)
    assert_allclose(middle.max(), expected.max_pressure, rtol=1e-2)


def test_pressure_is_capped_by_the_material(scene):
    soft = scene.with_changes({"material.max_pressure_MPa": 600.0, "analysis.positions": 1})
    result = analyse(soft)
    assert_allclose(result.peak_pressure, 600.0, rtol=1e-12)  # of cells that are clipped at the cap


def test_peak_pressure_converges_with_the_order_of_a_smooth_contact(scene):
    peaks = []
    for cells in (16, 32, 64):
        fine = scene.with_changes({"analysis.cells": (cells, cells), "analysis.tolerance": 1e-9})
        peaks.append(analyse(fine.with_changes({"analysis.positions": 1})).maps[0][0][0].pressure.max())
    assert abs(peaks[1] - peaks[0]) > 2.0**SMALLEST_ORDER * abs(peaks[2] - peaks[1])


def test_grid_beyond_memory_is_refused_with_the_size_it_needs(scene):
    with pytest.raises(InputError, match="GiB"):
        analyse(scene.with_changes({"analysis.cells": (200000, 200000)}))


def test_gears_that_never_touch_are_refused(scene):
    apart = scene.with_changes({"mounting.centre_distance_error_mm": 20.0})
    with pytest.raises(GeometryError, match="no common flank"):
        analyse(apart)


def test_progress_is_told_after_every_map(scene):
    told = []
    analyse(scene, progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_result_is_the_same_from_run_to_run(scene):
    first, second = analyse(scene), analyse(scene)
    assert_allclose(first.peak_pressure, second.peak_pressure, rtol=0)


def test_no_warning_for_a_contact_inside_the_flank(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        analyse(scene.with_changes({"analysis.positions": 1}))


# Bevel pairs: the same line, word for word


@pytest.mark.parametrize("name", ["straight_bevel", "spiral_bevel"])
def test_peak_pressure_of_a_bevel_pair_is_that_of_hertz(name):
    result = analyse(read_scene(SCENES / f"{name}.toml").with_changes({**ONE_PAIR, "analysis.positions": 3}))
    assert_allclose(result.peak_pressure, result.hertz_pressure, rtol=BEVEL_MAP_ERROR)
    assert 1000.0 < result.peak_pressure.max() < 1500.0


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["straight_bevel", "spiral_bevel"])
def test_bevel_result_is_reopened_as_it_was(name, tmp_path):
    scene = read_scene(SCENES / f"{name}.toml").with_changes({"analysis.positions": 2, "analysis.cells": (16, 16)})
    result = analyse(scene)
    result.save(tmp_path / "result.nc")
    again = load_result(tmp_path / "result.nc")
    assert again.scene == scene
    assert_same(again, result)


@pytest.mark.parametrize("teeth", [(39, 32), (16, 64), (64, 16)])
def test_line_contact_of_a_straight_bevel_pair_is_as_long_as_the_face(teeth):
    """Its contact lines are generators of cones: their length is b, however flat the pinion is."""
    scene = read_scene(SCENES / "straight_bevel.toml").with_changes(
        {
            **ONE_PAIR,
            "pinion.teeth": teeth[0],
            "wheel.teeth": teeth[1],
            "pinion.modifications": {},
            "analysis.positions": 1,
            "analysis.cells": (16, 24),
        }
    )
    with pytest.warns(AccuracyWarning) as caught:  # of tips below form circles, too
        result = analyse(scene)
    assert any("reaches an edge" in str(one.message) for one in caught)
    assert_allclose(result.contact_length, scene.pinion.face_width_mm, rtol=1e-6)


def test_load_beyond_the_reach_of_tooth_pairs_is_told():
    scene = read_scene(SCENES / "mesh_cycle_spur.toml")
    changes = {"analysis.positions": 1, "analysis.cells": (16, 16), "analysis.torques_Nm": (50e3,)}
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", AccuracyWarning)
        analyse(scene.with_changes(changes))
    assert any("more than 0.05 modules" in str(one.message) for one in told)


def test_what_does_not_converge_is_told_with_its_place(monkeypatch):
    monkeypatch.setattr("loaded_tca.contact.solver.MOST_ITERATIONS", 1)
    scene = read_scene(SCENES / "mesh_cycle_spur.toml")
    changes = {"positions": 1, "cells": (16, 16), "torques_Nm": (40.0,)}
    with pytest.raises(ConvergenceError, match=r"40 N m at pinion angle 0 deg: tooth pair 0: contact not converged"):
        analyse(scene.with_changes({f"analysis.{key}": value for key, value in changes.items()}))


def test_ends_of_a_pitch_agree_where_the_pressure_lies_beside_the_axis_of_its_grid():
    """An overloaded, misaligned pair: the places where its forces bend the teeth are those of the last pressure.

    They are found to 1e-3 modules; those of the pressure under the first guess of the forces were off by 2 nm here.
    """
    changes = {"cells": [24, 32], "positions": 2}
    scene = read_scene(SCENES / "helical.toml").with_changes(
        {f"analysis.{key}": value for key, value in changes.items()}
        | {"load.pinion_torque_Nm": 2827.0, "mounting.misalignment_um": 30.0}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        result = analyse(scene)
    errors = result.transmission_error[0]
    assert abs(errors[1] - errors[0]) * scene.pair().base_radii[1] < 1e-7  # mm: 0.1 nm
    assert result.coupled_pitches == pitches_within_reach(scene.pair()) == 2
