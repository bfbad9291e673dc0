"""The helical pair with short reliefs in space: gaps, meshes, condensed stiffness and contact, without the runs."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from validation.calculix import helical_contact, helical_mesh, helical_relief
from validation.calculix.helical_mesh import HelicalMeshing, HelicalPosition, course
from validation.calculix.ring_solved import CORNERS, slopes
from validation.calculix.tables import read_table

TINY = HelicalMeshing(across=0.4, along=2.0)
ROUNDING = 1e-9  # of coordinates of 100 mm and their differences within an element
BASE_RADIUS = (
    37.5
    / math.cos(math.radians(27.0))
    * math.cos(math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(27.0))))
)
COSINE_AT_BASE = math.sqrt(1.0 - (math.sin(math.radians(27.0)) * math.cos(math.radians(20.0))) ** 2)


def line(height: float) -> float:
    return course(HelicalPosition(helical_contact.pinion_angle(123), helical_contact.TOUCHING), height).touched[0]


@pytest.fixture(scope="module")
def ring():
    return helical_mesh.line_ring(line, -1, TINY)


@pytest.fixture(scope="module")
def points(ring):
    return ring.coordinates()[:, 1:]


def test_unloaded_transmission_error_is_the_lead_at_its_lowest_place():
    """Before the relief: 20 um (2 z/b)^2 + 20 um (z/b + 1/2) is smallest at z = -b/8: 8.75 um along the normal."""
    position = HelicalPosition(helical_contact.pinion_angle(110), 0.0)
    least = min(float(course(position, height).gap.min()) for height in (-1.6, -1.5, -1.4))
    assert least == pytest.approx(8.75e-3 / COSINE_AT_BASE, rel=1e-6)  # points of the flank are 0.3 um apart
    assert float(course(position, -1.5).gap.min()) == pytest.approx(least)


def test_setback_closes_the_gap():
    angle = helical_contact.pinion_angle(110)
    ahead, behind = (course(HelicalPosition(angle, setback), -1.5).gap.min() for setback in (0.0, 0.005))
    assert ahead - behind == pytest.approx(0.005, rel=1e-3)


@pytest.mark.thorough
def test_sections_have_one_topology_and_no_element_is_turned(ring, points):
    sections = [ring.at_height(height) for height in (-6.0, 6.0)]
    np.testing.assert_array_equal(sections[0].elements, sections[1].elements)
    elements = ring.hexahedra()[:, 1:] - ring.first_node
    for corner in np.array(CORNERS) / math.sqrt(3.0):
        jacobian = np.einsum("ka,mkb->mab", slopes(corner), points[elements])
        assert np.linalg.det(jacobian).min() > 0.0


@pytest.mark.thorough
def test_points_of_the_flank_lie_in_their_faces(ring, points):
    flank = helical_contact.unloaded_flank(ring, points)
    layer, height = 3, 0.3 * ring.levels[3] + 0.7 * ring.levels[4]
    radius = np.array([42.0, 43.05, 44.2])
    nodes, shapes = flank.shares(layer, height, radius)
    assert_allclose(shapes.sum(axis=1), 1.0, rtol=ROUNDING)
    places = np.einsum("kn,knx->kx", shapes, points[nodes])
    assert_allclose(places[:, 2], height, rtol=ROUNDING)
    assert_allclose(np.hypot(places[:, 0], places[:, 1]), radius, rtol=1e-4)  # chords of sections turned by 0.02 rad


@pytest.mark.thorough
def test_normals_are_those_of_an_involute_helicoid(ring, points):
    nodes = np.unique(helical_contact.unloaded_flank(ring, points).faces[:, 2:4])
    normals = helical_contact.inward_normals(points[nodes], ring.twist)
    x, y, _ = points[nodes].T
    lengthwise = np.stack([-ring.twist * y, ring.twist * x, np.ones(len(x))])
    assert_allclose(np.einsum("nk,kn->n", normals, lengthwise), 0.0, atol=ROUNDING)
    assert_allclose(np.cross(points[nodes], normals)[:, 2], -BASE_RADIUS * COSINE_AT_BASE, rtol=ROUNDING)


def test_compliance_is_that_of_the_whole_stiffness(monkeypatch):
    """Against the inverse of a full matrix; the program that condenses it is replaced by that of blocks."""

    def by_blocks(upper, kept):
        full = upper.toarray()
        full += np.triu(full, 1).T
        rest = np.setdiff1d(np.arange(len(full)), kept)
        inner = np.linalg.solve(full[np.ix_(rest, rest)], full[np.ix_(rest, kept)])
        return full[np.ix_(kept, kept)] - full[np.ix_(kept, rest)] @ inner

    monkeypatch.setattr(helical_contact, "condensed", by_blocks)
    rng = np.random.default_rng(7)
    half = rng.normal(size=(30, 30))
    stiffness = half @ half.T + 30.0 * np.eye(30)
    held, freedoms = np.array([0, 4, 17]), np.array([[6, 7, 8], [21, 22, 23]])
    normals = np.array([[0.6, 0.0, 0.8], [0.0, -0.6, 0.8]])
    compliance = helical_contact.normal_compliance(helical_contact.csr_array(stiffness), held, freedoms, normals)
    free = np.setdiff1d(np.arange(30), held)
    inverse = np.zeros((30, 30))
    inverse[np.ix_(free, free)] = np.linalg.inv(stiffness[np.ix_(free, free)])
    blocks = inverse[freedoms[:, None, :, None], freedoms[None, :, None, :]]
    assert_allclose(compliance, np.einsum("ia,ijab,jb->ij", normals, blocks, normals), rtol=ROUNDING)


def test_pressures_are_those_of_hertz_in_the_plane():
    """A cylinder on a plane: the compliance is that of line forces and a constant, which moves the approach alone."""
    modulus, radius, force, count = 113187.0, 8.0, 300.0, 121
    half_width = math.sqrt(4.0 * force * radius / (math.pi * modulus))
    width = 3.0 * half_width / count
    x = width * (np.arange(count) - count // 2)
    ends = x[:, None] - x + 0.5 * width * np.array([[[1.0]], [[-1.0]]])
    integral = ends * np.log(np.abs(ends)) - ends
    constant = 1.0
    compliance = width * (constant - 2.0 / (math.pi * modulus) * (integral[0] - integral[1]))
    area = np.full(count, width)
    pressure, _ = helical_contact.pressures(compliance, x**2 / (2.0 * radius), area, force)
    assert pressure @ area == pytest.approx(force)
    # the cell at the middle, 80 of them in the contact
    assert pressure.max() == pytest.approx(2.0 * force / (math.pi * half_width), rel=2e-3)
    assert np.count_nonzero(pressure) * width == pytest.approx(2.0 * half_width, abs=2.0 * width)


def test_kept_runs_converge_and_have_no_step():
    reference = helical_relief.kept()
    for other in (helical_relief.kept("medium"), helical_relief.kept(setback=helical_contact.UNDER_LOAD)):
        of_error, of_step = helical_relief.change(other)
        assert of_error < helical_relief.ERROR * abs(reference.transmission_error).max()
        assert 2.0 * of_step < helical_relief.STEP
    steps = np.diff(reference.transmission_error) / np.diff(helical_contact.POSITIONS)
    assert steps.max() - steps.min() < 0.1  # um a position; the former step was 0.4 um beside its neighbours
    force = 1e3 * helical_mesh.TORQUE / (BASE_RADIUS * COSINE_AT_BASE)
    for position in helical_contact.POSITIONS:
        carried = [row["force_N"] for row in read_table(helical_contact.LINES_FILE) if row["position"] == position]
        assert sum(carried) == pytest.approx(force, rel=1e-5)
