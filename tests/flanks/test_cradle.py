"""The generating equations against the classical way: matrices, surface parameters of the cutter, n . v = 0."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import fsolve

from loaded_tca.flanks.cradle import CradleGeneration
from loaded_tca.gears import Blade, MachineSettings
from tests.samples.face_milled import published_pinion, published_wheel

EVERY_SETTING = MachineSettings(
    radial=97.0,
    cradle_angle=0.9,
    root_angle=0.3,
    ratio_of_roll=3.3,
    machine_centre_to_back=0.4,
    sliding_base=-0.3,
    blank_offset=0.8,
    tilt=0.01,
    swivel=0.7,
    modified_roll_2c=0.03,
    modified_roll_6d=-0.1,
    helical_motion=0.5,
)
HOLLOW = Blade(95.0, math.radians(20.0), blade_radius=400.0)
FLANKS = ("concave", "convex")
DISTANCES, ANGLES = np.linspace(98.0, 130.0, 5), np.linspace(0.29, 0.33, 4)
PLACES = [part.ravel() for part in (np.outer(np.sin(ANGLES), DISTANCES), np.outer(np.cos(ANGLES), DISTANCES))]
AGREEMENT = 1e-9  # rad; fsolve stops at about 1e-10 of its unknowns
STEP = 1e-4  # mm


def about_z(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def about_y(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def about_x(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def cutter_point(generation, azimuth, height, phi):
    """A point of the cutter's surface in the frame of the blank, whose axis is z and whose root line is x."""
    machine = generation.machine
    radius = generation.blade.point_radius + generation.sign * float(generation.blade.widening(height)[0])
    point = np.array([radius * math.cos(azimuth), radius * math.sin(azimuth), -height])
    point = about_z(machine.swivel) @ about_x(-machine.tilt) @ point  # the tilt leans the axis towards +y
    point = about_z(machine.cradle_angle + phi) @ (point + np.array([machine.radial, 0.0, 0.0]))
    withdrawn = [0.0, -machine.blank_offset, -machine.sliding_base - machine.helical_motion * phi]
    point = about_y(machine.root_angle - 0.5 * math.pi) @ (point + withdrawn)  # z along the axis of the blank
    point[2] -= machine.machine_centre_to_back
    turned = machine.ratio_of_roll * (
        phi - machine.modified_roll_2c * phi**2 / 2.0 - machine.modified_roll_6d * phi**3 / 6.0
    )
    return about_z(-turned) @ point


def classical(generation, rho, z, height, phi):
    """Azimuth of the generated surface at (rho, z): cutter azimuth, height and turn of the cradle by fsolve.

    Other roots are near: the start is the azimuth that comes nearest at the height and turn given.
    """

    def distance(azimuth):
        point = cutter_point(generation, azimuth, height, phi)
        return math.hypot(math.hypot(point[0], point[1]) - rho, point[2] - z)

    start = [min(np.linspace(-math.pi, math.pi, 4001), key=distance), height, phi]

    def equations(unknowns):
        point = cutter_point(generation, *unknowns)
        steps = np.diag([1e-5, 1e-3, 1e-5])
        tangents = [
            cutter_point(generation, *(unknowns + step)) - cutter_point(generation, *(unknowns - step))
            for step in steps
        ]
        volume = np.linalg.det([tangent / np.linalg.norm(tangent) for tangent in tangents])
        return [math.hypot(point[0], point[1]) - rho, point[2] - z, 10.0 * volume]

    found = fsolve(equations, start, xtol=1e-11)
    point = cutter_point(generation, *found)
    return math.atan2(point[1], point[0])


@pytest.mark.quick_cases("convex")
@pytest.mark.parametrize("flank", FLANKS)
def test_azimuth_is_that_of_the_classical_equations_with_every_setting(flank):
    generation = CradleGeneration(HOLLOW, flank, EVERY_SETTING)
    points = generation.solve(*PLACES)
    assert points.found.all()
    for k in (6, 9, 19):
        around = float(points.height[k]) + 0.01, float(points.cradle[k]) + 0.001
        expected = classical(generation, PLACES[0][k], PLACES[1][k], *around)
        assert_allclose(points.theta.value[k], expected, atol=AGREEMENT)


@pytest.mark.parametrize("generation", ["generated", "formate"])
@pytest.mark.parametrize("flank", FLANKS)
def test_derivatives_are_those_of_the_azimuth(flank, generation):
    solver = CradleGeneration(HOLLOW, flank, replace(EVERY_SETTING, generation=generation))
    rho, z = PLACES
    jet = solver.solve(rho, z).theta
    beside = [solver.solve(rho + step, z).theta for step in (-STEP, STEP)]
    along = [solver.solve(rho, z + step).theta for step in (-STEP, STEP)]
    tolerance = {"rtol": 1e-6, "atol": 1e-9}  # third derivatives times STEP^2, and rounding over STEP
    assert_allclose((beside[1].value - beside[0].value) / (2.0 * STEP), jet.rho, **tolerance)
    assert_allclose((along[1].value - along[0].value) / (2.0 * STEP), jet.z, **tolerance)
    assert_allclose((beside[1].rho - beside[0].rho) / (2.0 * STEP), jet.rho_rho, **tolerance)
    assert_allclose((beside[1].z - beside[0].z) / (2.0 * STEP), jet.rho_z, **tolerance)
    assert_allclose((along[1].z - along[0].z) / (2.0 * STEP), jet.z_z, **tolerance)


@pytest.mark.parametrize("flank", FLANKS)
def test_no_other_turn_of_the_cradle_cuts_into_the_flank(flank):
    pinion = published_pinion()
    generation = CradleGeneration(pinion.cutter.blade(flank), flank, pinion.machine)
    rho, z = PLACES
    points = generation.solve(rho, z)
    for turn in (-0.1, -0.01, 0.01, 0.1):
        phi = points.cradle + turn
        assert (generation.cut(rho, points.theta.value + generation.roll(phi)[0], z, phi).value > 0.0).all()


def test_formate_flank_is_the_surface_of_the_cutter():
    wheel = published_wheel()
    machine = replace(wheel.machine, generation="formate")
    generation = CradleGeneration(wheel.cutter.blade("concave"), "concave", machine)
    angle = np.linspace(1.33, 1.38, 6)
    rho, z = 110.0 * np.sin(angle), 110.0 * np.cos(angle)
    points = generation.solve(rho, z)
    assert points.found.all()
    assert_allclose(points.cradle, 0.0, atol=1e-15)  # the angle of the section itself, where nothing turns
    blade = generation.blade
    for k in range(rho.size):
        gamma, theta = machine.root_angle, points.theta.value[k]
        place = about_y(0.5 * math.pi - gamma) @ [rho[k] * math.cos(theta), rho[k] * math.sin(theta), z[k]]
        centre = machine.radial * np.array([math.cos(machine.cradle_angle), math.sin(machine.cradle_angle)])
        radius = blade.point_radius + float(blade.widening(-place[2])[0])
        assert_allclose(np.linalg.norm(place[:2] - centre), radius, rtol=0, atol=1e-10)  # mm: 1e-14 seen


def test_cradle_angle_of_a_constant_roll_turns_the_gear_only():
    pinion = published_pinion()
    blade = pinion.cutter.blade("concave")
    azimuths = [
        CradleGeneration(blade, "concave", replace(pinion.machine, cradle_angle=angle)).solve(*PLACES).theta.value
        for angle in (pinion.machine.cradle_angle, 0.7)
    ]
    turn = pinion.machine.ratio_of_roll * (0.7 - pinion.machine.cradle_angle)
    assert_allclose(azimuths[1] - azimuths[0], turn, rtol=0, atol=1e-11)  # rad; of an angle of 0.7: 1e-15 seen


def test_machine_centre_to_back_moves_the_surface_along_the_axis():
    pinion = published_pinion()
    withdrawn = replace(pinion.machine, machine_centre_to_back=pinion.machine.machine_centre_to_back + 0.5)
    blade, (rho, z) = pinion.cutter.blade("convex"), PLACES
    first = CradleGeneration(blade, "convex", pinion.machine).solve(rho, z).theta.value
    moved = CradleGeneration(blade, "convex", withdrawn).solve(rho, z - 0.5).theta.value
    assert_allclose(moved, first, atol=1e-12)  # rad; rounding of angles of order one, beside rtol


def test_sliding_base_away_from_the_tips_leaves_more_material():
    """On the convex flank the material lies at larger azimuths, so that more of it lowers theta."""
    pinion = published_pinion()
    azimuths = [
        CradleGeneration(pinion.cutter.blade("convex"), "convex", replace(pinion.machine, sliding_base=base))
        .solve(*PLACES)
        .theta.value
        for base in (0.0, 0.1)
    ]
    assert (azimuths[1] < azimuths[0]).all()


def test_tilt_about_the_radial_line_leans_the_axis_of_the_cutter_tangentially():
    machine = replace(EVERY_SETTING, tilt=0.2, swivel=0.0)
    assert_allclose(CradleGeneration(HOLLOW, "concave", machine).axis, [0.0, math.sin(0.2), math.cos(0.2)])


@pytest.mark.parametrize("flank", FLANKS)
def test_form_line_holds_the_height_of_the_blade(flank):
    pinion = published_pinion()
    generation = CradleGeneration(pinion.cutter.blade(flank), flank, pinion.machine)
    angle, points = generation.at_height(2.0, DISTANCES)
    assert points.found.all()
    assert_allclose(points.height, 2.0, rtol=0, atol=1e-10)  # mm; of places of 100 mm: 7e-15 seen
    solved = generation.solve(DISTANCES * np.sin(angle), DISTANCES * np.cos(angle))
    assert_allclose(solved.theta.value, points.theta.value, rtol=0, atol=1e-11)  # rad: 1e-15 seen


def test_points_that_the_cutter_does_not_reach_are_not_found():
    pinion = published_pinion()
    machine = replace(pinion.machine, radial=5.0)
    points = CradleGeneration(pinion.cutter.blade("concave"), "concave", machine).solve(*PLACES)
    assert not points.found.all()
