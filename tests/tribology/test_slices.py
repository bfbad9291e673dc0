"""What slices have of the contacts: radii, velocities, forces; what does not depend on the grid."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from loaded_tca.loaded.line_load import AVERAGED_OVER, stretch_parts
from loaded_tca.material import Material
from loaded_tca.pairs.kinematics import surface_motions
from loaded_tca.reference.hertz import line_contact
from loaded_tca.tribology.contact_slices import _averaged
from loaded_tca.tribology.slices import _moving, slices_of
from tests.samples.tribology import FAMILIES, known, shared

ROUNDING = 1e-12  # of a few products and roots


def test_involutes_roll_by_their_roll_lengths():
    """Of spur gears: v_r = omega rho_t, and 1/rho is the sum of both curvatures."""
    result = shared("mesh_cycle_spur", pinion__modifications=None, wheel__modifications=None, torque=1.0)
    slices, path = slices_of(result), result.scene.mesh().path_of_contact
    assert_allclose(slices.rolling[0], slices.roll_length, rtol=1e-9)
    assert_allclose(slices.rolling[1], result.gear_pair.ratio * (path.T2 - slices.roll_length), rtol=1e-6)
    radius = slices.roll_length * (path.T2 - slices.roll_length) / path.T2
    on_path = (slices.roll_length > path.A) & (slices.roll_length < path.E)
    assert_allclose(slices.relative_radius[on_path], radius[on_path], rtol=1e-6)


def test_slices_have_the_pressure_and_half_width_of_a_line_contact():
    slices = slices_of(shared("mesh_cycle_spur"))
    modulus = shared("mesh_cycle_spur").gear_pair.contact_modulus
    for one in range(0, len(slices), 97):
        line = line_contact(slices.line_load[one], 1.0 / slices.relative_radius[one], modulus)
        assert_allclose(
            (slices.pressure[one], slices.half_width[one]), (line.max_pressure, line.half_width), rtol=ROUNDING
        )


@pytest.mark.parametrize("name", FAMILIES)
def test_pressure_of_slices_is_that_of_cells_where_contacts_keep_off_edges(name):
    """Slender contacts: slices have the pressure of line contacts, within the cells and 1/aspect^2."""
    result = shared(name)
    peaks = np.fmax.reduceat(slices_of(result).pressure, slices_of(result).starts)
    rough = (result.on_edge.astype(bool) | result.on_relief_start.astype(bool))[0]
    loaded = result.normal_force[0] > 0.0
    smooth = ~rough[loaded]
    assert_allclose(peaks[smooth], result.peak_pressure[0][loaded][smooth], rtol=0.06)


def test_line_load_is_the_mean_over_a_quarter_module_as_far_as_the_contact_goes():
    """By the part of each slice that lies within the length, of contacts of unlike slices, ends and gaps."""
    forces = np.array([[0.0, 2.0, 7.0, 0.0, 3.0, 1.0], [5.0, 1.0, 0.0, 0.0, 0.0, 0.0]])
    for force, step, line_load in zip(
        forces, (0.3, 0.5), _averaged(forces, np.array([[0.3], [0.5]]), 4.0), strict=True
    ):
        loaded, borders = np.flatnonzero(force), step * np.arange(7)
        ends = borders[loaded[0]], borders[loaded[-1] + 1]
        length = min(AVERAGED_OVER * 4.0, ends[1] - ends[0])
        middles = borders[loaded] + 0.5 * step
        covered = np.minimum(middles + 0.5 * length, ends[1]) - np.maximum(middles - 0.5 * length, ends[0])
        expected = stretch_parts(borders, middles, length) @ force / covered
        assert_allclose(line_load[loaded], expected, rtol=1e-13)  # rounding of sums of six numbers


@pytest.mark.thorough
def test_extremes_at_sharp_edges_do_not_depend_on_the_grid():
    """Single cells at a sharp tip grow without a limit as grids are refined; slices keep their line load."""
    coarse, fine = (
        known(shared("fzg_c14", analysis__accuracy=None, analysis__cells=cells), friction=0.05)
        for cells in ((24, 16), (64, 16))
    )
    assert_allclose(fine.largest_flash_temperature, coarse.largest_flash_temperature, rtol=0.02)
    assert_allclose(fine.least_film_thickness, coarse.least_film_thickness, rtol=0.02)
    assert_allclose(fine.loss_factor, coarse.loss_factor, rtol=2e-3)


@pytest.mark.thorough
@pytest.mark.parametrize(("radius", "torque"), [pytest.param(0.8, 300.0, marks=pytest.mark.thorough), (0.8, 50.0)])
def test_slices_on_a_rounded_tip_have_the_radius_of_the_arc(radius, torque):
    """The arc bends away from the flank by 1/r: 1/r + 1/rho_1 + 1/rho_2, and film and flash follow from that.

    The arc counts lengths by the slope at its edge; as the flank turns by t/rho_1 over the reach t of the arc, its
    curvature is off by at most 2 t/rho_1 in all, 2 % here.
    """
    flanks = {"pinion__modifications": None, "wheel__modifications": None, "pinion__tip_rounding_mm": radius}
    result = shared("mesh_cycle_spur", positions=25, torque=torque, **flanks)
    slices, mesh = slices_of(result), result.scene.mesh()
    first, second = (
        np.sqrt(place**2 - gear.base_radius**2)
        for place, gear in ((slices.radius, mesh.pinion), (slices.wheel_radius, mesh.wheel))
    )
    on_arc = slices.radius > mesh.pinion.tip_radius - 0.55 * radius
    assert 0 < on_arc.sum() < 0.1 * len(slices)
    arc, flank = (1.0 / (bend + 1.0 / first + 1.0 / second) for bend in (1.0 / radius, 0.0))
    assert_allclose(slices.relative_radius[on_arc], arc[on_arc], rtol=0.02)
    assert_allclose(slices.relative_radius[~on_arc], flank[~on_arc], rtol=1e-3)


def test_slices_are_found_once():
    result = shared("mesh_cycle_spur")
    assert slices_of(result) is slices_of(result)


def test_thermal_contact_coefficient_is_the_printed_one():
    """KISSsoft prints 13.780 N/(mm s^0.5 K) for 50 N/(s K) and 3.8 N/(mm2 K)."""
    assert_allclose(
        Material().thermal_contact_coefficient, 13780.0, rtol=5e-4
    )  # half a unit of its last digit, and 3.8


def test_a_material_that_conducts_better_stays_cooler():
    plain = shared("mesh_cycle_spur")
    better = shared("mesh_cycle_spur", material__conductivity_W_mK=200.0)
    ratio = known(better, friction=0.05).flash_temperature / known(plain, friction=0.05).flash_temperature
    assert_allclose(ratio[np.isfinite(ratio)], 0.5, rtol=1e-9)


def test_teeth_on_axes_that_cross_at_a_distance_slide_along_their_contacts_too():
    """As those of hypoids: the velocity between both bodies in the tangent plane, each turning about its own axis."""
    wheel = SimpleNamespace(axes=Rotation.from_euler("x", 90.0, degrees=True).as_matrix(), origin=[5.0, 40.0, -8.0])
    pair = SimpleNamespace(sense=1, ratio=0.3, wheel_axes=wheel.axes, wheel_origin=np.array(wheel.origin))
    origin, axes = np.array([20.0, 6.0, 30.0]), Rotation.from_euler("xyz", [0.4, 1.1, 0.3]).as_matrix()
    first, second = surface_motions(pair, origin[None], axes[None])
    x, y = np.array([-0.1, 0.0, 0.1]), np.array([-2.0, 0.0, 2.0])
    one = SimpleNamespace(x=x, y=y, spacing=(0.1, 2.0), pressure=np.ones((3, 3)))
    slices = _moving(pair, one, (np.arange(3), np.zeros(3)), (first, second, first.less(second, 0.3)), 0)
    points = origin + y[:, None] * axes[1]
    between = np.cross([0.0, 0.0, 1.0], points) - 0.3 * np.cross(-wheel.axes[2], points - wheel.origin)
    along = between @ axes[1]
    assert_allclose(slices["sliding"], np.hypot(between @ axes[0], along), rtol=1e-9)
    assert (np.abs(along) > 0.1 * slices["sliding"]).all()


@pytest.mark.thorough
def test_flanks_of_a_ring_gear_roll_the_same_way():
    """Inside a ring the curvatures count against each other, and the ring's roll lengths begin before the pinion's."""
    result = shared("planet_ring", pinion__modifications__tip_relief_um=0.0, wheel__modifications__tip_relief_um=0.0)
    slices, mesh = slices_of(result), result.scene.mesh()
    line = -mesh.path_of_contact.T2
    ring = result.gear_pair.ratio * (slices.roll_length + line)
    assert_allclose(np.median(slices.rolling[1] / ring), 1.0, rtol=1e-6)
    radius = slices.roll_length * (slices.roll_length + line) / line / np.cos(mesh.pinion.base_helix_angle)
    assert_allclose(np.median(slices.relative_radius / radius), 1.0, rtol=1e-3)  # the crowning of the lead tilts slices
