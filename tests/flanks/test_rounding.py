"""Rounded edges: exact arcs from the flank towards the edge, tangent to it, with the derivatives they claim."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import outward_normal, unmodified
from loaded_tca.flanks.rounding import LOWER, TIP, UPPER, EdgeRounding, RoundedFlank, edge_places, sharp
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.tooth import FaceMilledTooth
from tests.refusals import refusals
from tests.samples.face_milled import published_wheel
from tests.samples.gear_pairs import gear_pair

RADIUS = 0.3
RELIEVED = FlankModifications(lead_crowning=0.01, tip_relief=0.02, tip_relief_start=114.0)


def spur():
    return gear_pair(RELIEVED, shifts=(0.2, 0.0), teeth=(36, 57)).pinion.flank


def helical():
    return gear_pair(RELIEVED, helix_deg=20.0, teeth=(34, 57), shifts=(0.2, 0.0)).pinion.flank


def bevel():
    return bevel_pair(bevel_mesh((30, 40), outer_module=4.0, face_width=20.0, spiral_angle=0.6)).wheel.flank


def face_milled():
    return FaceMilledTooth(published_wheel()).nominal(1)


def closed_cosine(flank, edge):
    """Cosine of the material angle of a helical or spiral involute flank by the formulas of ISO 21771 and 23509."""
    nominal = unmodified(flank)
    if hasattr(nominal, "base_helix_angle"):
        across = -math.sqrt(1.0 - (nominal.base_radius / nominal.radii[1]) ** 2) * math.cos(nominal.base_helix_angle)
        along = nominal.side * math.sin(nominal.base_helix_angle)
    else:
        base, tip = nominal.base_angle, nominal.cone_angles[1]
        spiral = (
            nominal.theta(np.array(30.0), np.array(40.0)).rho * 30.0
            + nominal.theta(np.array(30.0), np.array(40.0)).z * 40.0
        )  # R dTheta/dR, the same everywhere on a logarithmic spiral
        size = math.hypot(1.0 / math.sin(base), spiral)
        across = -math.sqrt(1.0 - (math.sin(base) / math.sin(tip)) ** 2) / math.sin(base) / size
        along = nominal.side * spiral / size
    return {TIP: across, LOWER: -along, UPPER: along}[edge]


def places_near(flank, edge, depth, count=4000, seed=1):
    """Random places (n,) up to a distance [mm] from an edge of the flank, and farther from the others."""
    rng = np.random.default_rng(seed)
    corners = np.stack(flank.grid(2, 2)).reshape(2, -1)
    rho, z = (rng.uniform(part.min(), part.max(), count * 40) for part in corners)
    distances = np.stack([np.broadcast_to(jet.value, rho.shape) for jet in flank.edges(rho, z)])
    near = (distances[edge] < depth) & (np.delete(distances, edge, axis=0).min(axis=0) > 1.0) & (distances[edge] > 0.0)
    return rho[near][:count], z[near][:count]


def depths(flank, rho, z):
    """Depth of the rounded flank below the sharp one, from where both stand and how steep the sharp one is [mm]."""
    nominal, bare = unmodified(flank).theta(rho, z), sharp(flank).theta(rho, z)
    steep = np.sqrt(1.0 / rho**2 + nominal.rho**2 + nominal.z**2)
    return flank.side * (bare.value - flank.theta(rho, z).value) / steep


def section(depth, distance, cosine):
    """Place along the flank [mm], from the edge, of points at a depth and a distance from the edge's surface."""
    return -(distance + depth * cosine) / np.sqrt(1.0 - cosine**2)


@pytest.mark.parametrize("make", [spur, helical, bevel])
@pytest.mark.parametrize("edge", [TIP, LOWER, UPPER])
def test_points_lie_on_an_arc_about_one_centre_across_the_edge(make, edge):
    flank = RoundedFlank(make(), EdgeRounding(RADIUS, RADIUS))
    rho, z = places_near(flank, edge, 2.0 * RADIUS)
    cosine = closed_cosine(flank, edge)
    angle = math.acos(cosine)
    depth, distance = depths(flank, rho, z), flank.edges(rho, z)[edge].value
    x = section(depth, distance, cosine)
    centre = -RADIUS / math.tan(0.5 * angle)
    turn = np.arctan2(x - centre, RADIUS - depth)
    on = (x > centre) & (turn < min(math.radians(40.0), 0.7 * (math.pi - angle)))
    assert on.sum() > 100
    assert_allclose(np.hypot(x - centre, RADIUS - depth)[on], RADIUS, rtol=0.0, atol=1e-12)  # mm; 4e-16 seen
    assert_allclose(depth[x < centre], 0.0, atol=1e-15)  # nothing is taken there


@pytest.mark.parametrize("edge", [TIP, LOWER, UPPER])
def test_arc_of_a_flank_whose_angle_changes_along_the_edge(edge):
    """The wheel of a face-milled pair: the angle is that of its exact normal at the edge beside each point."""
    flank = RoundedFlank(face_milled(), EdgeRounding(RADIUS, RADIUS))
    rho, z = edge_places(flank, edge, 12)
    jet = flank.edges(rho, z)[edge]
    normal = outward_normal(unmodified(flank), rho, z)
    cosine = normal[..., 0] * jet.rho + normal[..., 2] * jet.z
    assert np.ptp(cosine) > 1e-3, "else the test says nothing"
    depth, x = depths(flank, rho, z), 0.0
    inwards = 0.6 * RADIUS * (1.0 + cosine)  # of an arc that begins at RADIUS (1 + cosine) from the edge
    coordinate = flank.lengthwise_coordinate if edge == TIP else flank.profile_coordinate
    along = coordinate(rho, z)
    # beside the place, where the coordinate along the edge is the same
    other = np.stack([-along.z, along.rho] / np.hypot(along.rho, along.z))
    other *= np.sign(other[0] * jet.rho + other[1] * jet.z)
    step = inwards / (other[0] * jet.rho + other[1] * jet.z)
    rho, z = rho + step * other[0], z + step * other[1]
    depth, distance = depths(flank, rho, z)[1:-1], np.asarray(flank.edges(rho, z)[edge].value)[1:-1]
    x = section(depth, distance, cosine[1:-1])
    centre = -RADIUS / np.tan(0.5 * np.arccos(cosine[1:-1]))
    # the step is straight, the coordinate is not: angles differ by its bend, 1e-5 of them
    assert_allclose(np.hypot(x - centre, RADIUS - depth), RADIUS, rtol=0.0, atol=1e-5 * RADIUS)


@pytest.mark.parametrize("make", [spur, helical, bevel, face_milled])
def test_arc_begins_tangent_to_the_flank_and_leaves_the_rest_as_it_is(make):
    flank, bare = RoundedFlank(make(), EdgeRounding(RADIUS, RADIUS)), make()
    rho, z = flank.off_arcs(*(part[:, 1:-1].ravel() for part in bare.grid(2, 41)))
    rounded, plain = flank.theta(rho, z), bare.theta(rho, z)
    steep = np.sqrt(1.0 / rho**2 + plain.rho**2 + plain.z**2)
    assert_allclose((rounded.value - plain.value) / steep, 0.0, atol=1e-12)  # mm; nothing is taken there
    for one, other in ((rounded.rho, plain.rho), (rounded.z, plain.z)):
        assert_allclose((one - other) / steep, 0.0, atol=1e-8)
    inner = [part[3:-3, 3:-3] for part in bare.grid(33, 65)]
    clear = np.stack(flank.past_tangents(*inner)).max(axis=0) < 0.0
    assert clear.any()
    # exact: the rounding adds zeros there
    assert_array_equal(flank.theta(*inner).value[clear], bare.theta(*inner).value[clear])


@pytest.mark.parametrize("make", [spur, helical, bevel, face_milled])
@pytest.mark.parametrize("edge", [TIP, LOWER, UPPER])
def test_derivatives_are_those_of_differences(make, edge):
    flank = RoundedFlank(make(), EdgeRounding(RADIUS, RADIUS))
    rho, z = places_near(flank, edge, 1.5 * RADIUS, count=400)
    step = 1e-6
    jet = flank.theta(rho, z)
    assert np.abs(flank.removal(rho, z).rho_rho + 0.0 * rho).max() + np.abs(flank.removal(rho, z).z_z).max() > 0.5

    def slopes(part):
        on_rho = (part(flank.theta(rho + step, z)) - part(flank.theta(rho - step, z))) / (2.0 * step)
        return on_rho, (part(flank.theta(rho, z + step)) - part(flank.theta(rho, z - step))) / (2.0 * step)

    assert_allclose(slopes(lambda one: one.value), (jet.rho, jet.z + 0.0 * rho), atol=2e-8)
    bends = [part + 0.0 * rho for part in jet.bends]
    # of the few points within a step of where the arc begins, or ends, differences say nothing
    for found, wanted in zip(
        (*slopes(lambda one: one.rho), slopes(lambda one: one.z + 0.0 * rho)[1]), bends, strict=True
    ):
        assert_allclose(np.sort(np.abs(found - wanted))[:-4], 0.0, atol=1e-6)


def test_arc_goes_on_as_its_parabola_without_a_jump_of_curvature():
    flank = RoundedFlank(spur(), EdgeRounding(tip=RADIUS))
    rho = np.linspace(flank.nominal.edges(np.array(0.0), np.array(0.0))[TIP].value - RADIUS, 60.0, 4001)
    removal = flank.removal(rho, np.zeros_like(rho))
    begun = removal.value > 0.0
    jumps = np.abs(np.diff((removal.rho_rho + 0.0 * rho)[begun]))
    assert jumps.max() < 0.05 * removal.rho_rho.max(), "the second derivative is continuous"
    last = (removal.rho_rho + 0.0 * rho)[-100:]
    # the same coefficient at each place
    assert_allclose(last, last[0], rtol=1e-12, err_msg="a parabola has one second derivative")


test_radius_that_is_none_is_refused = refusals(
    EdgeRounding,
    *(
        (0.2, side, r"side: found .*; allowed 0 \(sharp\), or from 0.01 mm on")
        for side in (0.005, -0.1, math.nan, math.inf)
    ),
    (-1.0, 0.001, ("^tip:", "^side:")),
)


def test_drawn_grid_is_fine_on_the_arcs():
    flank = RoundedFlank(helical(), EdgeRounding(RADIUS, RADIUS))
    rho, z = flank.drawn_grid(31, 31)
    distances = [np.asarray(jet.value + 0.0 * rho) for jet in flank.edges(rho, z)]
    assert (distances[TIP][:, 0] <= 1.2 * RADIUS + 1e-2).sum() >= 9
    for end in (LOWER, UPPER):
        assert (distances[end][0] <= 1.2 * RADIUS + 1e-2).sum() >= 9
    for got, wanted in zip((rho, z), flank.grid(2, 2), strict=True):
        assert_allclose(got[np.ix_((0, -1), (0, -1))], wanted, rtol=1e-14)  # the same jets at the corners of a grid
