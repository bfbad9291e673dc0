"""Contact patterns: against the curvature ellipse, on both flanks, at edges, and what is refused."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import GeometryError, InputError, sample_separation, trace_contact
from loaded_tca.flank_maps.pattern import COMPOUND, contact_area, contact_pattern, flank_gap
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded.teeth import trace_teeth
from tests.samples.gear_pairs import gear_pair, transmission_error_at

CROWNED = FlankModifications(lead_crowning=0.05, profile_crowning=0.01)
TILTED = Mounting(out_of_plane=1e-3)

drives = pytest.mark.parametrize("driving", ["pinion", "wheel"])
helices = pytest.mark.parametrize("helix_deg", [0.0, 15.0])


def crowned(**kwargs):
    return gear_pair(CROWNED, **({"mounting": TILTED} | kwargs))


def contact(pair, angle=0.01):
    return trace_contact(pair, [angle])[0]


# The gap


@drives
@helices
def test_gap_is_zero_at_the_contact_and_nowhere_negative(helix_deg, driving):
    pair = crowned(helix_deg=helix_deg, driving=driving)
    here = contact(pair)
    for gear, flank in (("pinion", pair.pinion.flank), ("wheel", pair.wheel.flank)):
        place = np.array([getattr(here, f"{gear}_radius")]), np.array([getattr(here, f"{gear}_axial")])
        gap, radius, axial = flank_gap(pair, gear, (here.pinion_angle, here.wheel_angle), place)
        mating = "wheel" if gear == "pinion" else "pinion"
        assert_allclose(
            [gap[0], radius[0], axial[0]],
            [0.0, *(getattr(here, f"{mating}_{x}") for x in ("radius", "axial"))],
            atol=1e-12,  # mm; of coordinates of 50 mm: 1e-16 seen
        )
        gap, _, _ = flank_gap(pair, gear, (here.pinion_angle, here.wheel_angle), flank.grid(40, 40))
        assert gap.min() >= 0.0


@drives
def test_gap_is_the_lag_times_the_lever(driving):
    """Independently of the package's field: the wheel's lag from the definitions of the frames."""
    pair = crowned(helix_deg=15.0, driving=driving)
    here = contact(pair)
    rho, z = pair.pinion.flank.grid(20, 20)
    lag, there = transmission_error_at(pair, here.pinion_angle, rho, z)
    gap, _, _ = flank_gap(pair, "pinion", (here.pinion_angle, here.wheel_angle), (rho, z))
    lever = pair.base_radii[1] * math.cos(
        math.atan(pair.base_radii[0] * math.tan(math.radians(14.0761)) / pair.base_radii[0])
    )
    expected = pair.driving * (here.transmission_error - lag) * lever
    assert (np.isfinite(gap) == there).all()
    assert_allclose(gap[there], expected[there], rtol=2e-3)  # the modifications tilt the normal a little


@helices
def test_gap_agrees_with_the_distance_along_the_common_normal(helix_deg):
    """To first order; both fall by less than a hundredth over a compound."""
    pair = crowned(helix_deg=helix_deg)
    here = contact(pair)
    area = contact_area(pair, here, rays=16)
    box = tuple(1.02 * length for length in area.semi_axes)
    separation = sample_separation(pair, here, cells=(65, 65), box=box)
    inside = (separation.gap <= COMPOUND).sum() * separation.spacing[0] * separation.spacing[1]
    assert_allclose(inside, area.area, rtol=0.02)  # 65 cells across an ellipse


# The instantaneous area


@drives
@helices
def test_area_tends_to_that_of_the_curvature_ellipse_with_the_first_power_of_the_compound(helix_deg, driving):
    pair = crowned(helix_deg=helix_deg, driving=driving)
    here = contact(pair)
    errors = []
    for compound in (1e-3, 1e-4, 1e-5):
        area = contact_area(pair, here, compound)
        assert not area.is_cut
        errors.append(abs(area.area / area.ellipse_area - 1.0))
        assert_allclose(area.semi_axes, area.ellipse_semi_axes, rtol=1e-3)
    assert errors[0] < 1e-3
    assert_allclose(np.log10(np.divide(errors[:-1], errors[1:])), 1.0, atol=0.05)


def test_area_is_two_pi_compound_over_the_root_of_the_curvatures():
    area = contact_area(crowned(), contact(crowned()))
    first, second = (2.0 * COMPOUND / axis**2 for axis in area.ellipse_semi_axes)
    assert_allclose(area.ellipse_area, 2.0 * math.pi * COMPOUND / math.sqrt(first * second))
    assert_allclose(
        np.linalg.norm(area.ellipse_points - contact(crowned()).point, axis=1).max(), area.semi_axes[1], rtol=0.01
    )


@drives
def test_contour_has_the_gap_of_the_compound_on_both_flanks(driving):
    pair = crowned(helix_deg=15.0, driving=driving)
    here = contact(pair)
    area = contact_area(pair, here, rays=32)
    angles = here.pinion_angle, here.wheel_angle
    own, radius, axial = flank_gap(pair, "pinion", angles, (area.pinion_radius, area.pinion_axial))
    assert_allclose(own, COMPOUND, rtol=1e-9)
    assert_allclose(np.stack([radius, axial]), np.stack([area.wheel_radius, area.wheel_axial]))
    assert_allclose(np.hypot(*area.point[:, :2].T), area.pinion_radius)
    other, _, _ = flank_gap(pair, "wheel", angles, (area.wheel_radius, area.wheel_axial))
    assert_allclose(other, COMPOUND, rtol=0.02)  # beside the point by the gap itself


def test_more_rays_do_not_change_the_area():
    pair = crowned()
    few, many = (contact_area(pair, contact(pair), rays=rays).area for rays in (24, 720))
    assert_allclose(few, many, rtol=1e-5)  # 1e-6 may hide in each of a few sectors


def test_line_contact_is_cut_by_the_ends_of_the_flank():
    pair = gear_pair()
    area = contact_area(pair, contact(pair))
    assert area.is_cut
    assert area.ellipse_semi_axes[1] == math.inf
    assert np.isnan(area.ellipse_points).all()
    assert_allclose(area.semi_axes[1], 0.5 * pair.face_width, rtol=1e-9)
    width = 2.0 * area.ellipse_semi_axes[0]
    assert_allclose(area.area, width * pair.face_width, rtol=5e-3)
    assert area.ellipse_area == math.inf


def test_area_at_an_edge_ends_there():
    pair = gear_pair(mounting=Mounting(out_of_plane=2e-3), helix_deg=15.0)
    here = contact(pair)
    assert here.on_edge
    area = contact_area(pair, here)
    assert area.is_cut
    assert 0.0 < area.area < 0.5 * pair.face_width
    assert area.pinion_axial.max() <= 0.5 * pair.face_width + 1e-9


def integrated_area(pair, here, compound=COMPOUND, count=700):
    """Area of the projection into the tangent plane, from a dense grid over the part of the flank that it takes."""
    area = contact_area(pair, here, compound)
    ends = zip(pair.pinion.flank.grid(2, 2), (area.pinion_radius, area.pinion_axial), strict=True)
    spans = [(max(part.min(), own.min() - 1e-3), min(part.max(), own.max() + 1e-3)) for part, own in ends]
    rho, z = np.meshgrid(*(low + (high - low) * (np.arange(count) + 0.5) / count for low, high in spans), indexing="ij")
    gap, _, _ = flank_gap(pair, "pinion", (here.pinion_angle, here.wheel_angle), (rho, z))
    jet = pair.pinion.flank.theta(rho, z)
    theta = jet.value + pair.sense * here.pinion_angle
    radial, zero = np.stack([np.cos(theta), np.sin(theta), 0.0 * theta], axis=-1), 0.0 * theta
    around = np.stack([-rho * np.sin(theta), rho * np.cos(theta), zero], axis=-1)
    along = np.stack([zero, zero, 1.0 + zero], axis=-1)
    slopes = [np.broadcast_to(slope, rho.shape)[..., None] for slope in (jet.rho, jet.z)]
    patch = np.cross(radial + slopes[0] * around, along + slopes[1] * around) @ here.normal
    cell = math.prod(high - low for low, high in spans) / count**2
    return np.abs(patch[gap <= compound]).sum() * cell


LIGHT = FlankModifications(lead_crowning=0.005)
CUT_AREAS = {
    "side of the pinion, helical": (
        {"pinion": LIGHT, "helix_deg": 15.0, "mounting": Mounting(out_of_plane=2e-3)},
        0.01,
    ),
    "side, spur, steep": ({"pinion": LIGHT, "mounting": Mounting(out_of_plane=1e-2)}, 0.01),
    "side of the wheel": ({"pinion": LIGHT, "mounting": Mounting(out_of_plane=-5e-3, axial_offset=3.0)}, 0.0),
    "tip of the pinion, spur": ({"pinion": FlankModifications(lead_crowning=0.002)}, 0.9 * math.tau / 34),
    "tip of the wheel, helical": (
        {"pinion": FlankModifications(lead_crowning=0.002), "helix_deg": 10.0},
        -math.tau / 34,
    ),
    "tip and side": ({"pinion": LIGHT, "helix_deg": 15.0, "mounting": Mounting(out_of_plane=4e-3)}, 0.17),
    "cut by a tip away from the contact": ({"pinion": CROWNED, "helix_deg": 15.0}, 0.14),
    "both sides": ({"pinion": LIGHT}, 0.0),
}


@pytest.mark.thorough
@pytest.mark.parametrize("case", CUT_AREAS)
def test_area_cut_by_edges_is_that_of_a_dense_grid(case):
    arguments, angle = CUT_AREAS[case]
    pair = gear_pair(**arguments)
    here = contact(pair, angle)
    area = contact_area(pair, here)
    assert area.is_cut
    assert_allclose(
        area.area, integrated_area(pair, here), rtol=5e-4
    )  # 700 cells across; curved tip of the mating gear


@pytest.mark.thorough
def test_area_cut_by_edges_does_not_depend_on_the_rays():
    pair = gear_pair(LIGHT, helix_deg=15.0, mounting=Mounting(out_of_plane=4e-3))
    few, many = (contact_area(pair, contact(pair, 0.17), rays=rays) for rays in (16, 720))
    assert_allclose(few.area, many.area, rtol=1e-4)
    assert_allclose(few.semi_axes, many.semi_axes, rtol=2e-3)


def test_contour_of_a_cut_area_has_its_corners():
    """A line contact ends with the face: the width of the contour is that of the line up to the very end."""
    pair = gear_pair()
    area = contact_area(pair, contact(pair), rays=36)
    side = area.on_edge & (area.pinion_axial > 0.0)
    assert len(area.point) > 36
    span = np.ptp(area.point[side] @ np.cross(contact(pair).normal, [0.0, 0.0, 1.0]))
    assert_allclose(span, 2.0 * area.semi_axes[0], rtol=1e-4)


# The accumulated pattern


@pytest.fixture(scope="module")
def pattern():
    return contact_pattern(crowned(helix_deg=15.0), grid=(31, 41))


def test_pattern_holds_every_instantaneous_area(pattern):
    pair = crowned(helix_deg=15.0)
    touched = pattern.gap <= 1.05 * COMPOUND
    for angle in np.linspace(-0.3, 0.3, 4) * pair.pitch:
        here = contact(pair, angle)
        gap, _, _ = flank_gap(pair, "pinion", (here.pinion_angle, here.wheel_angle), (pattern.radius, pattern.axial))
        assert (touched | (gap > COMPOUND)).all()


def test_pattern_touches_along_the_contact_path(pattern):
    pair = crowned(helix_deg=15.0)
    lead = trace_teeth(pair).leading_contact
    i = np.abs(pattern.radius[:, :1] - lead.pinion_radius).argmin(axis=0)
    j = np.abs(pattern.axial[:1].T - lead.pinion_axial).argmin(axis=0)
    assert pattern.touched[i, j].all()
    assert 0.1 < pattern.touched.mean() < 0.5
    assert pattern.gap.min() >= -1e-12  # mm; the smallest gap is taken off: rounding
    assert_allclose(pattern.diameter, 2.0 * pattern.radius)
    assert "touched" in repr(pattern)


def test_pattern_grid_ends_with_the_flank(pattern):
    pair = crowned(helix_deg=15.0)
    assert_allclose(pattern.axial[:, [0, -1]], np.tile([-12.5, 12.5], (31, 1)))
    roll = np.sqrt(pattern.radius**2 - pair.base_radii[0] ** 2)
    assert_allclose(pattern.roll_length, roll)


def test_pattern_of_a_larger_compound_holds_that_of_a_smaller():
    mesh = trace_teeth(crowned())
    small, large = (contact_pattern(mesh.pair, mesh, compound=c, grid=(21, 31)).touched for c in (3e-3, 6e-3))
    assert (large >= small).all()
    assert large.sum() > small.sum()


@drives
def test_patterns_of_both_flanks_have_the_same_length(driving):
    """A misalignment moves both by the same way along the face."""
    pair = crowned(driving=driving)
    mesh = trace_teeth(pair)
    spans = []
    for gear in ("pinion", "wheel"):
        found = contact_pattern(pair, mesh, gear=gear, grid=(41, 101))
        axial = found.axial[found.touched]
        spans.append((axial.min(), axial.max()))
        assert found.gear == gear
    assert_allclose(spans[0], spans[1], atol=0.26)  # a column of the grid


def test_pattern_of_an_aligned_spur_pair_is_symmetric_over_the_face():
    pair = gear_pair(CROWNED)
    found = contact_pattern(pair, trace_teeth(pair), grid=(21, 31))
    assert_allclose(found.gap, found.gap[:, ::-1], atol=1e-9)


def test_unmodified_pair_touches_on_the_whole_active_flank():
    pair = gear_pair(teeth=(30, 30))
    found = contact_pattern(pair, grid=(41, 5))
    middle = found.radius[:, 2]
    active = middle >= trace_contact(pair, np.linspace(-0.8, -0.5, 7) * pair.pitch).pinion_radius.min()
    assert found.touched[active].all()


# What is refused


@pytest.mark.parametrize("compound", [0.0, -1e-3, math.inf, math.nan, None, "x", [6e-3], 1j])
def test_compound_that_is_no_thickness_is_refused(compound):
    pair = crowned()
    with pytest.raises(InputError, match=r"compound: .* is not a positive, finite thickness"):
        contact_area(pair, contact(pair), compound)
    with pytest.raises(InputError, match="is not a positive, finite thickness"):
        contact_pattern(pair, compound=compound)


def test_every_wrong_argument_is_told_at_once():
    pair = crowned()
    with pytest.raises(InputError) as caught:
        contact_pattern(pair, gear="rack", compound=-1.0, grid=(1, 5))
    assert len(caught.value.problems) == 3
    for rays in (7, 8.5, None, "many"):
        with pytest.raises(InputError, match=f"rays: {rays!r} is not a whole number >= 8"):
            contact_area(pair, contact(pair), rays=rays)


@pytest.mark.parametrize("grid", [None, "ab", 5, (5,), (5, 5, 5), (5, 5.5), ((5, 6), 7), (5, 1)])
def test_grid_that_is_not_two_whole_numbers_is_refused(grid):
    with pytest.raises(InputError, match=r"grid: .* are not two whole numbers >= 2"):
        contact_pattern(crowned(), grid=grid)


def test_area_of_a_whole_path_is_refused():
    pair = crowned()
    for wrong in (trace_contact(pair), trace_contact(pair)[:1], None):
        with pytest.raises(InputError, match=r"contact: .* is not one position of a path; take path\[i\]"):
            contact_area(pair, wrong)


def test_pattern_of_the_mesh_of_another_pair_is_refused():
    mesh = trace_teeth(crowned())
    with pytest.raises(
        InputError, match=r"mesh: it was traced for another object, GearPair\(34/57.*hand over mesh.pair"
    ):
        contact_pattern(crowned(), mesh)
    with pytest.raises(InputError, match="mesh: ContactPath is not a MeshPath, which trace_teeth gives"):
        contact_pattern(mesh.pair, mesh.leading_contact)


def test_area_without_contact_is_refused():
    pair = crowned()
    path = trace_contact(pair, [0.0, 3.0 * pair.pitch])
    assert not path.in_contact[1]
    with pytest.raises(GeometryError, match="no common flank: the tooth pair is not in contact"):
        contact_area(pair, path[1])
