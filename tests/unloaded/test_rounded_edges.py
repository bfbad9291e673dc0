"""First touch of flanks with rounded edges: certified wherever they stand, and that of sharp edges in the limit.

Random pairs here; a thousand positions in validation/unloaded/rounded_edges.py.
"""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import parse_scene, read_scene
from loaded_tca.flanks import FlankModifications
from loaded_tca.flanks.base import EDGE_NAMES
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import relative_curvature, trace_contact, trace_teeth
from loaded_tca.unloaded.path import contact_span
from tests.samples.gear_pairs import gear_pair, transmission_error_at

ROUNDED = EdgeRounding(0.2, 0.2)
ROUNDING = 1e-12  # rad or mm; angles of order 0.1, lengths of 100 mm: 5e-17 rad seen
"""Height above the contact, over r_b2, that is rounding."""


def dense_points(flank):
    """Points (k,) of a flank: a grid, and rows beside every edge, as dense as an arc of 0.01 mm needs."""
    rho, z = flank.grid(48, 48)
    found = [(rho.ravel(), z.ravel())]
    edges = [np.concatenate([grid[k].ravel() for grid in (flank.grid(2, 301), flank.grid(301, 2))]) for k in (0, 1)]
    begin = flank.off_arcs(*edges)
    found += [
        tuple(e + share * (b - e) for e, b in zip(edges, begin, strict=True)) for share in np.linspace(0.0, 1.0, 11)
    ]
    return (np.concatenate(part) for part in zip(*found, strict=True))


def assert_certified(pair, angles):
    path = trace_contact(pair, angles, warn=False)
    rho, z = dense_points(pair.pinion.flank)
    for angle, found, there in zip(angles, path.transmission_error, path.in_contact, strict=True):
        error, covered = transmission_error_at(pair, angle, rho, z)
        highest = np.where(covered & pair.pinion.flank.inside(rho, z, 1e-12), pair.driving * error, -np.inf).max()
        assert there or not np.isfinite(highest)
        if there:
            assert highest - pair.driving * found <= ROUNDING, "no point of the flanks penetrates"
    return path


def random_pair(rng):
    helix, driving, sense = (
        rng.choice([0.0, 12.0, 25.0]),
        rng.choice(["pinion", "wheel"]),
        rng.choice(["positive", "negative"]),
    )
    errors = Mounting(*np.radians(rng.uniform(-0.5, 0.5, 2)), rng.uniform(-0.1, 0.1), rng.uniform(-2.0, 2.0))
    crowned = (
        FlankModifications(lead_crowning=rng.uniform(0.0, 0.02), profile_crowning=rng.uniform(0.0, 0.02)) for _ in "12"
    )
    pair = gear_pair(*crowned, mounting=errors, helix_deg=helix, driving=driving, sense=sense)
    radii = np.exp(rng.uniform(math.log(0.01), math.log(0.9), (2, 2))).tolist()
    return pair.rounded(*(EdgeRounding(*both) for both in radii))


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("seed", range(12))
def test_positions_of_random_misaligned_pairs_are_certified(seed):
    rng = np.random.default_rng(seed)
    pair = random_pair(rng)
    assert_certified(pair, rng.uniform(-1.0, 1.0, 4) * pair.pitch)


def test_bevel_pair_is_certified_on_its_arcs():
    mesh = bevel_mesh((20, 40), outer_module=4.0, face_width=20.0, spiral_angle=math.radians(30.0))
    pair = bevel_pair(mesh, mounting=BevelMounting(offset=0.1, shaft_angle_error=0.002)).rounded(ROUNDED, ROUNDED)
    path = assert_certified(pair, np.linspace(-0.7, 0.7, 7) * pair.pitch)
    assert path.on_edge.any()


def misaligned(rounding, **changes):
    crowned = FlankModifications(profile_crowning=0.005)
    pair = gear_pair(crowned, mounting=Mounting(out_of_plane=0.003), **changes)
    return pair.rounded(rounding, rounding)


RING = """
[pair]
type = "cylindrical"
normal_module_mm = 3.0
helix_angle_deg = 21.0
sense = "negative"
[pinion]
teeth = 22
face_width_mm = 23.0
profile_shift = 0.3
side_rounding_mm = 0.21
modifications.lead_crowning_um = 6.0
[wheel]
teeth = -72
face_width_mm = 21.0
profile_shift = -0.3
side_rounding_mm = 0.21
modifications.lead_crowning_um = 10.0
modifications.lead_crowning_form = "logarithmic"
[mounting]
out_of_plane_deg = 0.0005
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 20.0
"""


def test_ascents_pass_the_start_of_an_arc_where_the_curvature_jumps():
    """Along an edge the ease-off bends by 0.02 per mm up to the start of the arc, by 6 beyond: Newton's steps lead to
    and fro over it, and corrections of such steps back to where they began."""
    path = assert_certified(parse_scene(RING).pair(), [0.4284])
    assert path.iterations[0] < 50  # three; an ascent that comes to no end takes 300


def test_contact_off_the_arcs_is_that_of_sharp_edges_to_the_bit():
    pair = gear_pair(FlankModifications(lead_crowning=0.01, profile_crowning=0.01), helix_deg=15.0)
    angles = np.linspace(-0.3, 0.3, 9) * pair.pitch
    sharp, rounded = (trace_contact(one, angles) for one in (pair, pair.rounded(ROUNDED, ROUNDED)))
    assert not sharp.on_edge.any()
    for name in ("transmission_error", "point", "normal", "pinion_lever", "wheel_lever", "edges"):
        # exact: away from the arcs the rounding adds zeros
        assert_array_equal(getattr(rounded, name), getattr(sharp, name))


def test_line_of_aligned_teeth_is_as_long_as_with_sharp_edges():
    pair = gear_pair()
    sharp, rounded = (trace_contact(one, [0.0]) for one in (pair, pair.rounded(ROUNDED, ROUNDED)))
    assert rounded.on_line.all()
    assert not rounded.on_edge.any()
    assert_allclose(rounded.line_ends, sharp.line_ends, atol=1e-9)


def test_contact_on_an_arc_lies_where_it_has_turned_by_the_misalignment():
    """A side of spur teeth, w = 90 deg: the arc begins r before the end and turns by the angle between the flanks."""
    out_of_plane, radius = 0.003, 0.4
    pair = misaligned(EdgeRounding(side=radius))
    path = trace_contact(pair, [0.0])
    sides = [EDGE_NAMES.index("lower side"), EDGE_NAMES.index("upper side")]
    assert path.edges.reshape(2, 4)[:, sides].any()
    assert path.on_edge.all()
    # the flanks lie askew by gamma cos(alpha); both arcs, of one end of equal faces, share the turn
    turn = out_of_plane * math.cos(math.radians(20.0))
    inwards = 12.5 - abs(float(path.pinion_axial[0]))
    assert inwards == pytest.approx(radius * (1.0 - 0.5 * math.sin(turn)), abs=0.1 * radius * turn)
    assert path.residual[0] < 1e-9, "the two normals are one"
    assert_allclose(np.linalg.norm(path.normal[0]), 1.0, rtol=1e-14)  # a unit vector


@pytest.mark.parametrize("edge", ["tip", "side"])
def test_transmission_error_tends_to_that_of_sharp_edges(edge):
    """The arc stays behind the sharp edge by no more than r turn (1 + cos w)."""
    angles = np.linspace(-0.9, 0.9, 13) * misaligned(EdgeRounding()).pitch
    sharp = trace_contact(misaligned(EdgeRounding()), angles, warn=False).transmission_error
    errors = []
    for radius in (0.2, 0.1, 0.05, 0.02):
        pair = misaligned(EdgeRounding(**{edge: radius}))
        off = pair.driving * (sharp - trace_contact(pair, angles, warn=False).transmission_error)
        assert off.min() >= -1e-15, "rounding takes material off"  # mm; an amount of 0.01 less itself
        errors.append(off.max())
    ratio = np.array(errors[:-1]) / errors[1:]
    assert_allclose(ratio, [2.0, 2.0, 2.5], rtol=0.1, err_msg="the difference is proportional to the radius")


def test_curvature_on_an_arc_is_that_of_the_sharp_flanks():
    sharp, rounded = misaligned(EdgeRounding()), misaligned(EdgeRounding(side=0.2))
    of_sharp, of_rounded = (relative_curvature(one, trace_contact(one, [0.0])[0]) for one in (sharp, rounded))
    assert of_rounded.across == pytest.approx(of_sharp.across, rel=0.02)
    assert abs(of_rounded.axes[1] @ of_sharp.axes[1]) > 0.9999, "across and along do not change places"


@pytest.mark.thorough
def test_mesh_and_its_span_are_traced_over_rounded_edges():
    """Of a pair that transfers over its tips, whose arcs shorten the flank and smooth the envelope."""
    pair = gear_pair(helix_deg=15.0)
    rounded = pair.rounded(ROUNDED, ROUNDED)
    mesh = trace_teeth(rounded, np.linspace(-0.5, 0.5, 11) * pair.pitch)
    assert_allclose(mesh.transmission_error, 0.0, atol=ROUNDING)
    ends = [contact_span(one) for one in (misaligned(EdgeRounding()), misaligned(EdgeRounding(tip=0.2)))]
    assert (ends[0][0] is None) == (ends[1][0] is None)


def test_points_off_the_arc_of_a_face_end_are_not_looked_at_beyond_the_tip():
    """The tip of a face-milled wheel is not square to its face ends, so that they leave the flank by 0.7 um."""
    scene = read_scene("examples/scenes/face_milled_19x62_matched.toml")
    pairs = [scene.with_changes({"wheel.side_rounding_mm": radius}).pair() for radius in (0.0, 0.37)]
    sharp, rounded = (pair.driving * trace_contact(pair, [-0.65], warn=False).transmission_error for pair in pairs)
    assert -1e-4 < rounded - sharp < 0.0, "the sharp end is in contact, so that the wheel without it stands further on"
