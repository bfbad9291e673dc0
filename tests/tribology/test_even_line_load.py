"""Loss of involute pairs under an even line load: lines on the plane of action, known without any contact analysis."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.reference.iso6336_22 import load_loss_factor
from tests.samples.tribology import shared

EVEN = 1e-3  # of the mean: ends of lines fall between the slices of the grid
ON_POINTS = 2001


def lines(mesh, angle):
    """Distances (pair, point) from T1 of points spread evenly along the contact lines; NaN beyond A and E."""
    path, pitch = mesh.path_of_contact, mesh.pinion.base_pitch
    width = mesh.common_face_width
    along = (np.arange(ON_POINTS) + 0.5) / ON_POINTS * width - 0.5 * width
    slope = math.tan(abs(mesh.pinion.base_helix_angle))
    places = path.C + mesh.pinion.base_radius * angle + np.arange(-6, 7)[:, None] * pitch + along * slope
    return np.where((places >= path.A) & (places <= path.E), places, np.nan)


def loss_of_even_lines(mesh, angle):
    """Loss over torque: the mean sliding distance of the normal force, larger by 1/cos beta_b than the tangential."""
    sliding = np.nanmean(np.abs(lines(mesh, angle) - mesh.path_of_contact.C)) * (1.0 + 1.0 / mesh.gear_ratio)
    return sliding / (mesh.pinion.base_radius * math.cos(mesh.pinion.base_helix_angle))


def evened(result):
    """The result with the same force on each length of the lines between A and E, slice by slice."""
    mesh = result.scene.mesh()
    path, force = mesh.path_of_contact, mesh.normal_force(float(result.torque[0]))
    rows = []
    for row in result.maps[0]:
        weights = [None if one is None else one.pressure * _between(one, path.A, path.E) for one in row]
        length = sum(
            one.spacing[1] * weight.any(axis=0).sum()
            for one, weight in zip(row, weights, strict=True)
            if one is not None
        )
        rows.append(
            tuple(
                None if one is None or not weight.any() else replace(one, pressure=weight * force / length)
                for one, weight in zip(row, weights, strict=True)
            )
        )
    return replace(result, maps=(tuple(rows),))


def _between(one, start, end):
    """Factors (ny,) that turn the pressure of a map into a line load of 1 between two places of the path, else 0."""
    force = one.pressure.sum(axis=0)
    carrying = force > 0.0
    across = np.divide(one.x @ one.pressure, force, out=np.zeros_like(force), where=carrying)
    points = one.origin + across[:, None] * one.axes[0] + one.y[:, None] * one.axes[1]
    normal = one.axes[2, :2]
    places = np.abs(points[:, :2] @ normal) / np.hypot(*normal)
    reached = carrying & (places >= start) & (places <= end)
    return np.divide(reached / one.spacing[0], force, out=np.zeros_like(force), where=carrying)


@pytest.mark.parametrize(
    ("name", "rtol"), [("mesh_cycle_spur", 1e-4), pytest.param("mesh_cycle_helical", 1e-2, marks=pytest.mark.thorough)]
)
def test_loss_of_an_even_line_load_is_that_of_lines_on_the_plane_of_action(name, rtol):
    """Position by position, and in the mean over a pitch; under little torque contacts keep to the path."""
    plain = {"pinion__modifications": None, "wheel__modifications": None}
    result = shared(name, 17, 1.0, **plain, analysis__accuracy=None, analysis__cells=(16, 128))
    even = evened(result).tribology(1500.0, friction=1.0)
    mesh = result.scene.mesh()
    expected = np.array([loss_of_even_lines(mesh, angle) for angle in result.pinion_angle])
    power = even.friction_power[0] / (1e-3 * 2.0 * math.pi * 25.0 * result.torque[0])
    half_way = 1e-6  # at the pitch point: contacts lie further on by half of what the load turns them, 0.1 um here
    assert_allclose(power, expected, rtol=rtol, atol=half_way)
    assert_allclose(even.loss_factor, np.trapezoid(expected) / 16.0, rtol=EVEN)


def test_standard_is_low_for_lines_that_overlap():
    """It weights the path as spur pairs do, while lines of an overlap above 1 lie over all of it at once."""
    result = shared("mesh_cycle_helical")
    mesh = result.scene.mesh()
    path, pitch = mesh.path_of_contact, mesh.pinion.base_pitch
    parts = (path.E - path.C) / pitch, (path.C - path.A) / pitch
    standard = load_loss_factor(*parts, mesh.pinion.teeth, mesh.wheel.teeth, mesh.pinion.base_helix_angle)
    angles = np.linspace(0.0, result.gear_pair.pitch, 65)
    even = np.mean([loss_of_even_lines(mesh, angle) for angle in angles[:-1]])
    assert 0.8 < standard / even < 0.95


@pytest.mark.thorough
def test_standard_is_that_of_spur_pairs_that_share_evenly():
    mesh = shared("mesh_cycle_spur").scene.mesh()
    path, pitch = mesh.path_of_contact, mesh.pinion.base_pitch
    parts = (path.E - path.C) / pitch, (path.C - path.A) / pitch
    angles = (np.arange(4000) + 0.5) / 4000 * 2.0 * math.pi / mesh.pinion.teeth
    even = np.mean([loss_of_even_lines(mesh, angle) for angle in angles])
    assert_allclose(load_loss_factor(*parts, mesh.pinion.teeth, mesh.wheel.teeth), even, rtol=1e-3)  # of 4000 angles
