"""Which keys a scene has, how large their tolerances usually are, and what keys do to key figures."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene
from loaded_tca.results import default_tolerances, key_figure_slopes
from tests.samples.results import SCENES, result

TORQUE = "load.pinion_torque_Nm"
pytestmark = pytest.mark.filterwarnings(
    "ignore:derivatives of the transmission error depend"
)  # coarse grids, all is read


def scene(name, **changes):
    values = {key.replace("__", "."): value for key, value in changes.items()}
    return read_scene(SCENES / f"{name}.toml").with_changes(values)


def test_keys_are_the_modifications_that_the_gears_have_the_mounting_errors_and_the_torque():
    relief = {
        "wheel__modifications__tip_relief_um": 12.0,
        "wheel__modifications__tip_relief_start_mm": 180.0,
        "wheel__modifications__end_relief_um": 5.0,
        "wheel__modifications__end_relief_length_mm": 4.0,
    }
    found = default_tolerances(scene("mesh_cycle_helical", **relief))
    assert found == {
        "pinion.modifications.lead_crowning_um": 1.0,
        "pinion.modifications.profile_crowning_um": 1.0,
        "wheel.modifications.end_relief_um": 1.0,
        "wheel.modifications.end_relief_length_mm": 0.1,
        "wheel.modifications.tip_relief_um": 1.0,
        "wheel.modifications.tip_relief_start_mm": 0.1,
        "mounting.in_plane_deg": 0.01,
        "mounting.out_of_plane_deg": 0.01,
        "mounting.centre_distance_error_mm": 0.01,
        "mounting.axial_offset_mm": 0.01,
        TORQUE: 2.6,
    }


def test_mounting_errors_are_those_of_the_kind_of_gears():
    found = default_tolerances(scene("mesh_cycle_bevel"))
    errors = {key: one for key, one in found.items() if key.startswith("mounting.")}
    assert errors == {
        "mounting.offset_mm": 0.01,
        "mounting.pinion_axial_mm": 0.01,
        "mounting.wheel_axial_mm": 0.01,
        "mounting.shaft_angle_error_deg": 0.01,
    }


def test_keys_of_a_double_helical_pair_are_those_of_half_b_as_well():
    errors = {"out_of_plane_deg": 0.01, "misalignment_um": 2.0}
    keys = default_tolerances(scene("double_helical", mounting__half_b=errors))
    of_half_b = {key: size for key, size in keys.items() if "half_b" in key}
    assert of_half_b == {
        "pinion.half_b.modifications.lead_crowning_um": 1.0,
        "pinion.half_b.modifications.tip_relief_um": 1.0,
        "pinion.half_b.modifications.tip_relief_start_roll_deg": 0.1,
        "pinion.half_b.modifications.helix_slope_um": 1.0,
        **{f"mounting.half_b.{name}": 0.01 for name in ("in_plane_deg", "out_of_plane_deg")},
        **{f"mounting.half_b.{name}": 0.01 for name in ("centre_distance_error_mm", "axial_offset_mm")},
    }
    without = default_tolerances(scene("double_helical"))
    assert {key for key in without if key.startswith("mounting.")} == {
        f"mounting.{name}"
        for name in ("in_plane_deg", "out_of_plane_deg", "centre_distance_error_mm", "axial_offset_mm")
    }


def test_roll_angle_of_a_relief_start_has_a_tolerance_of_its_own():
    key = "pinion.modifications.tip_relief_start_roll_deg"
    assert default_tolerances(scene("mesh_cycle_spur"), [key]) == {key: 0.1}


@pytest.mark.quick_cases("face_milled_19x62_matched")
@pytest.mark.parametrize("name", ["mesh_cycle_helical", "mesh_cycle_bevel", "face_milled_19x62_matched"])
def test_every_default_key_is_one_that_a_result_can_be_derived_by(name):
    cycle = result(name, positions=2, torques=(50.0,))
    found = cycle.sensitivities(list(default_tolerances(cycle.scene)))
    assert np.isfinite(found.transmission_error).any(axis=(0, 1)).all()


@pytest.mark.filterwarnings("ignore:an edge of a flank cuts the slices")
@pytest.mark.filterwarnings("ignore:K_Hbeta follows the strip with")
def test_mean_transmission_error_follows_the_centre_distance_as_involutes_do():
    """The driven flank moves along the line of action by sin(alpha_wt) for each mm that the axes part."""
    cycle = result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))
    slopes = key_figure_slopes(cycle.sensitivities(["mounting.centre_distance_error_mm"]))
    expected = -1e3 * math.sin(cycle.scene.mesh().working_pressure_angle)
    assert_allclose(slopes["transmission_error_mean_um"], expected, rtol=2e-3)
    # and it does nothing else: these are the changes by a hundredth of a millimetre
    assert_allclose(1e-2 * slopes["transmission_error_span_um"], 0.0, atol=0.02)


@pytest.mark.filterwarnings("ignore:an edge of a flank cuts the slices")
def test_both_ends_of_a_pitch_count_half_in_the_mean_slope():
    """They are one place of the mesh: the mean is the integral over the pitch, by the trapezoidal rule."""
    cycle = result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0))
    found = cycle.sensitivities(["pinion.modifications.lead_crowning_um", TORQUE])
    slopes = 1e3 * cycle.wheel_base_radius * np.moveaxis(found.transmission_error, 1, 0)
    ends_beside_mean = np.abs(slopes[0] / slopes.mean(axis=0) - 1.0)
    assert (ends_beside_mean > 0.01).all(), "else the weight of the ends would not count"
    assert_allclose(key_figure_slopes(found)["transmission_error_mean_um"], np.trapezoid(slopes, dx=0.25, axis=0))


def test_peak_pressure_of_a_point_contact_grows_with_the_cube_root_of_the_torque():
    cycle = result(torques=(50.0, 80.0))
    figures = cycle.key_figures()
    found = key_figure_slopes(cycle.sensitivities([TORQUE]))["peak_pressure_MPa"][:, 0]
    expected = [one["peak_pressure_MPa"] / (3.0 * one["pinion_torque_Nm"]) for one in figures]
    assert_allclose(found, expected, rtol=0.03)  # 20 x 24 cells; the curvature changes a little over the ellipse


def test_figures_that_are_not_known_have_no_slopes():
    slopes = key_figure_slopes(result(positions=1).sensitivities([TORQUE]))
    assert {name for name, values in slopes.items() if np.isnan(values).all()} == {
        "transmission_error_span_um",
        "transmission_error_order_1_um",
        "face_load_factor",
    }
