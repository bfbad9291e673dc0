"""Reduced mass of real bodies, resonance ratio, and excitation of a rated mesh."""

from math import pi

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.gears import CylindricalGear
from loaded_tca.gears.cylindrical import transverse_profile
from loaded_tca.rating.inputs import inputs_of
from loaded_tca.rating.vibration import full_second_moment, reduced_mass, resonance_ratio
from tests.samples.rating import solved

ROUNDING = 1e-12  # of a few products and roots, with room for any order of them
PER_VOLUME = 7.85e-6  # kg/mm3, steel
SHAFT = {
    "start_mm": -40.0,
    "torque_at_mm": -40.0,
    "sections": [
        {"length_mm": 40.0, "outer_diameter_mm": 25.0, "inner_diameter_mm": 10.0},
        {"length_mm": 40.0, "outer_diameter_mm": 25.0, "inner_diameter_mm": 16.0},
    ],
    "bearings": [{"at_mm": -30.0, "radial_stiffness_N_per_um": 500.0, "axial_stiffness_N_per_um": 100.0},
                 {"at_mm": 30.0, "radial_stiffness_N_per_um": 500.0}],
}  # fmt: skip


def test_second_moment_of_a_gear_is_that_of_its_disc_with_its_teeth():
    gear = CylindricalGear(teeth=31, normal_module=2.0, face_width=20.0)
    outline = transverse_profile(gear, 400, inner_radius=0.5 * gear.root_radius)
    # the same area by triangles to the origin, each with the polar moment of a triangle with a corner there
    x, y = outline.T
    cross = x[:-1] * y[1:] - x[1:] * y[:-1]
    squares = sum(one[:-1] ** 2 + one[:-1] * one[1:] + one[1:] ** 2 for one in (x, y))
    hollow = 2.0 * gear.teeth * float(cross @ squares) / 12.0
    expected = hollow + pi / 2.0 * (0.5 * gear.root_radius) ** 4
    assert_allclose(full_second_moment(gear), expected, rtol=1e-4)  # chords: 400 and 40 points along each part


def test_reduced_mass_is_near_that_of_two_discs():
    whole = solved(**{"pinion.bore_diameter_mm": 20.0})
    inputs, masses = inputs_of(whole), []
    for gear, bore in ((inputs.mesh.pinion, 20.0), (inputs.mesh.wheel, 0.0)):
        mean = gear.tip_radius + gear.root_radius
        disc = pi / 32.0 * PER_VOLUME * (mean**4 - bore**4)
        masses.append(disc * gear.face_width / inputs.mesh.common_face_width / gear.base_radius**2)
    # the disc of the standard, of the mean of tip and root diameter, leaves out where the teeth have their material
    assert_allclose(reduced_mass(inputs), masses[0] * masses[1] / sum(masses), rtol=0.03)


def test_hollow_shaft_takes_its_hole_from_the_body():
    solid, hollow = inputs_of(solved()), inputs_of(solved(**{"pinion.shaft": SHAFT}))
    radii = solid.mesh.pinion.base_radius, solid.mesh.wheel.base_radius
    width = solid.mesh.pinion.face_width / solid.mesh.common_face_width
    hole = PER_VOLUME * pi / 32.0 * 0.5 * (10.0**4 + 16.0**4) * width
    moments = [full_second_moment(gear) * PER_VOLUME for gear in (solid.mesh.pinion, solid.mesh.wheel)]
    wheel = moments[1] * solid.mesh.wheel.face_width / solid.mesh.common_face_width / radii[1] ** 2
    for inputs, taken in ((solid, 0.0), (hollow, hole)):
        pinion = (moments[0] * width - taken) / radii[0] ** 2
        assert_allclose(reduced_mass(inputs), 1.0 / (1.0 / pinion + 1.0 / wheel), rtol=ROUNDING)


def test_resonance_ratio_is_speed_over_that_of_mass_and_stiffness():
    rated, whole = solved().rating(), solved()
    for stiffness, ratios in (
        (whole.scene.contact_standard.mesh_stiffness, rated.resonance_ratio),
        (
            np.array([(row[:-1] + row[1:]).mean() / 2.0 for row in whole.mesh_stiffness]),
            rated.resonance_ratio_of_analysis,
        ),
    ):
        # kg/mm and N/(mm um), 1e9 N/m2: an angular frequency of sqrt(c/m) 1e3 [1/s] for kg/mm over kg/m
        natural = np.sqrt(np.asarray(stiffness) * 1e9 / (rated.reduced_mass * 1e3)) / (2.0 * pi)
        assert_allclose(ratios, 1500.0 / 60.0 * whole.scene.pinion.teeth / natural, rtol=ROUNDING)


def test_excitation_is_that_of_the_key_figures():
    rated, figures = solved().rating(), solved().key_figures()
    for name in ("transmission_error_span", "transmission_error_order_1"):
        assert_allclose(rated.values(name), [row[f"{name}_um"] for row in figures], rtol=ROUNDING)


def test_ratio_is_unknown_where_the_standard_has_no_stiffness():
    unknown, known = resonance_ratio(inputs_of(solved()), np.array([np.nan, 20.0]))
    assert np.isnan(unknown)
    assert known > 0.0


def test_smaller_gear_is_the_pinion_of_the_stiffness():
    scene = solved().scene
    exchanged = scene.with_changes({"pinion.teeth": scene.wheel.teeth, "wheel.teeth": scene.pinion.teeth})
    assert scene.wheel.teeth != scene.pinion.teeth
    single, of_exchanged = (each.contact_standard.single_stiffness for each in (scene, exchanged))
    assert_allclose(of_exchanged, single, rtol=ROUNDING)
