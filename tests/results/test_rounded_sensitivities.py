"""Derivatives of contacts on rounded edges: grids stay with the arcs that end the contact."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.scene import parse_scene

KEY = "mounting.out_of_plane_deg"
SCENE = """
[pair]
type = "cylindrical"
normal_module_mm = 2.2
helix_angle_deg = 28.0
centre_distance_mm = 107.5
dedendum_coefficient = 1.4
root_radius_coefficient = 0.3
[pinion]
teeth = 19
face_width_mm = 32.0
profile_shift = 0.3
hand = "left"
tip_rounding_mm = 0.2
[pinion.modifications]
lead_crowning_um = 5.0
helix_slope_um = 8.0
end_relief_um = 10.0
end_relief_length_mm = 3.0
tip_relief_um = 15.0
tip_relief_start_mm = 51.2
[wheel]
teeth = 67
face_width_mm = 30.0
side_rounding_mm = 0.3
tip_rounding_mm = 0.2
[wheel.modifications]
tip_relief_um = 15.0
tip_relief_start_mm = 169.3
[mounting]
misalignment_um = 12.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 320.0
[analysis]
positions = 5
compliance = "contact"
cells = [32, 64]
"""


def analysed(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts that reach edges are wanted here
        return analyse(scene)


@pytest.mark.thorough
def test_transmission_error_follows_a_tilt_where_one_row_of_cells_lies_on_the_arc_of_a_face_end():
    """Grids that went with their contact point had -300 um/deg at the second position, 20 times as much as analyses.

    The tolerance is the scatter of analyses on 64 cells along a contact that ends on arcs, 0.25 um per 0.01 deg.
    """
    scene = parse_scene(SCENE)
    result = analysed(scene)
    length = 1e3 * result.wheel_base_radius
    told = length * result.sensitivities([KEY]).transmission_error[0, :, 0]
    up, down = (analysed(scene.with_changes({KEY: step})).transmission_error[0] for step in (4e-3, -4e-3))
    by_analyses = length * (up - down) / 8e-3
    assert np.abs(told[1]) < 50.0
    assert_allclose(told, by_analyses, rtol=0.0, atol=25.0)


ENDS = """
[pair]
type = "cylindrical"
normal_module_mm = 2.34
helix_angle_deg = 7.22
[pinion]
teeth = 36
face_width_mm = 7.77
profile_shift = 0.454
hand = "right"
[pinion.modifications]
helix_slope_um = -5.87
[wheel]
teeth = 165
face_width_mm = 6.6
profile_shift = -0.305
side_rounding_mm = 0.249
[wheel.modifications]
twist_um = 8.38
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 20.9
[analysis]
positions = 4
compliance = "contact"
free_edges = false
cells = [16, 24]
"""
MISALIGNMENT = "mounting.misalignment_um"


def test_transmission_error_follows_a_misalignment_where_contacts_end_beside_the_arc_of_a_face_end():
    """No cell under pressure lies on the arc: grids that went with their contact had 1.58 urad/um for 1.22.

    The tolerance is what analyses over 0.6 and 1.2 um, on grids of their own, differ by.
    """
    scene = parse_scene(ENDS)
    told = analysed(scene).sensitivities([MISALIGNMENT]).transmission_error[0, :, 0]
    up, down = (analysed(scene.with_changes({MISALIGNMENT: step})).transmission_error[0] for step in (0.6, -0.6))
    by_analyses = (up - down) / 1.2
    assert_allclose(told, by_analyses, rtol=0.0, atol=0.04 * np.abs(by_analyses).max())
