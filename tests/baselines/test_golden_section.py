"""Golden sections on the signed smallest gap: the contacts of the reduced solver, edges included, by another road."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import ConvergenceError, GeometryError, trace_contact
from loaded_tca.baselines import golden_section
from loaded_tca.baselines.conventional import solve_conventional
from loaded_tca.baselines.golden_section import search_golden_section
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from tests.refusals import refusals
from tests.samples.gear_pairs import gear_pair, highest_on_grid, sam_paper, transmission_error_at

SAME_ANGLE = 1e-12  # rad; asked for: 1e-10
INTERIOR = 30  # sections: 5e-7 of the flank, the square of which is the error of a level gap
CLOSED = 1e-11  # of r_b2: the gap at which the search stops

PAIRS = {
    "crowned spur": sam_paper(),
    "crowned helical": sam_paper(15.0),
    "misaligned": sam_paper(15.0, mounting=Mounting(1e-4, 2e-4, 0.05, 0.1)),
    "profile crowned, wheel driving, turning back": gear_pair(
        FlankModifications(lead_crowning=0.01, profile_crowning=0.008),
        FlankModifications(profile_crowning=0.005),
        helix_deg=12.0,
        driving="wheel",
        sense="negative",
    ),
}


def unknowns(path):
    """Those of the conventional equations, from the reduced solver."""
    parts = (path.pinion_radius, path.pinion_axial, path.wheel_radius, path.wheel_axial, path.wheel_angle)
    return np.stack(parts, axis=-1)


@pytest.mark.quick_cases("crowned spur")
@pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
def test_interior_contacts_of_three_methods_agree(pair):
    """Reduced, golden section, and the conventional equations from a start 0.1 mm and 0.01 rad off."""
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 3) * pair.pitch)
    assert not path.on_edge.any()
    found = search_golden_section(pair, path.pinion_angle, sections=INTERIOR)
    off = np.array([0.1, 0.1, -0.1, -0.1, 0.01])
    conventional = solve_conventional(pair, path.pinion_angle, unknowns(path) + off)
    assert conventional.is_contact.all()
    assert_allclose(found.wheel_angle, path.wheel_angle, rtol=0, atol=SAME_ANGLE)
    assert_allclose(found.wheel_angle, conventional.wheel_angle, rtol=0, atol=SAME_ANGLE)
    assert_allclose(found.point, path.point, rtol=0, atol=1e-4)  # mm; the root of the rounding of a level gap


EDGES = {
    "end of the face": (sam_paper(mounting=Mounting(out_of_plane=0.01)), [0.0, 0.03]),
    "corner region of a helical pair": (sam_paper(15.0, mounting=Mounting(0.02, 0.01)), [-0.05, 0.02]),
    "tip beyond the nominal path": (gear_pair(FlankModifications(lead_crowning=0.002)), [-0.166, 0.166]),
}


@pytest.mark.thorough
@pytest.mark.parametrize(("pair", "angles"), EDGES.values(), ids=EDGES)
def test_edge_contacts_are_found_where_the_conventional_equations_have_none(pair, angles):
    path = trace_contact(pair, angles)
    assert path.on_edge.all()
    found = search_golden_section(pair, angles)
    assert_allclose(found.wheel_angle, path.wheel_angle, rtol=0, atol=2.0 * CLOSED)
    assert not solve_conventional(pair, angles, unknowns(path)).is_contact.any()


@pytest.mark.thorough
def test_no_point_of_the_flanks_touches_before_the_angle_found():
    """Against a dense grid that knows neither gaps nor sections."""
    pair = sam_paper(15.0, mounting=Mounting(2e-4, 1e-4))
    found = search_golden_section(pair, [-0.03, 0.04], sections=INTERIOR)
    for angle, wheel_angle in zip(found.pinion_angle, found.wheel_angle, strict=True):
        lag = wheel_angle - pair.ratio * angle
        assert 0.0 <= lag - highest_on_grid(pair, np.array(angle)) < 1e-5


@pytest.mark.thorough
def test_wheel_flank_passes_through_the_point_found():
    pair = PAIRS["misaligned"]
    found = search_golden_section(pair, [-0.02, 0.02], sections=INTERIOR)
    lag, there = transmission_error_at(pair, found.pinion_angle, found.pinion_radius, found.pinion_axial)
    assert there.all()
    assert_allclose(lag, found.wheel_angle - pair.ratio * found.pinion_angle, rtol=0, atol=2.0 * CLOSED)
    assert (np.abs(found.gap) <= CLOSED * pair.base_radii[1]).all()


def test_smallest_gap_grows_with_the_wheel_angle_where_the_distance_without_sign_is_zero_all_along():
    """Why the gap needs its sign: interpenetrating flanks cross, at every angle, at a distance of nothing."""
    pair = sam_paper()
    search = golden_section._Search(pair, np.zeros(5), 20)
    angles = np.array([-2e-3, -1e-3, -5e-4, 0.0, 1e-3])
    rows = np.arange(5)
    smallest = search.narrowest(rows, angles)[0]
    assert (np.diff(smallest) > 0.0).all()
    rho, z = (part.ravel() for part in pair.pinion.flank.grid(40, 40))
    for row in rows[:3]:
        gaps = search.gap(np.full(rho.size, row), np.full(rho.size, angles[row]), rho, z)
        assert gaps.min() < 0.0 < gaps.max()


@pytest.mark.thorough
@pytest.mark.parametrize("turns", [1, -2, 57])
def test_contact_whole_turns_away_is_that_of_the_same_tooth(turns):
    angle = [0.01 + 2.0 * np.pi * turns]
    found = search_golden_section(sam_paper(), angle, sections=INTERIOR)
    expected = trace_contact(sam_paper(), angle).wheel_angle
    rounding = 1e-12  # of angles of hundreds of radians
    assert_allclose(found.wheel_angle, expected, rtol=0, atol=rounding)


@pytest.mark.thorough
def test_line_contact_of_an_unmodified_pair_is_found():
    found = search_golden_section(gear_pair(), [0.01], sections=INTERIOR)
    assert_allclose(found.wheel_angle, 0.01 * 34 / 57, rtol=0, atol=2.0 * CLOSED)


@pytest.mark.thorough
def test_positions_without_a_common_region_are_not_a_number():
    found = search_golden_section(sam_paper(), [1.5, 0.0], sections=INTERIOR)
    assert found.in_contact.tolist() == [False, True]
    for name in ("wheel_angle", "point", "pinion_radius", "pinion_axial", "gap"):
        assert np.isnan(getattr(found, name)[0]).all()
        assert np.isfinite(getattr(found, name)[1]).all()
    assert repr(found) == f"GoldenSectionResult(2 positions, 1 touch, {found.evaluations} gaps each)"


@pytest.mark.thorough
def test_every_gap_is_counted():
    """A search of m sections along both directions takes (m + 2)^2 gaps, and m + 2 for the place of the last."""
    found = search_golden_section(sam_paper(), [0.0], sections=20)
    assert found.evaluations % (22 * 23) == 0
    assert 4 <= found.evaluations / (22 * 23) <= 8


test_inputs_that_cannot_be_used_are_refused = refusals(
    lambda angles, sections: search_golden_section(sam_paper(), angles, sections=sections),
    ([], 30, r"pinion_angles: found shape \(0,\); allowed finite numbers"),
    (0.0, 30, r"pinion_angles: found shape \(\)"),
    ([math.nan], 30, "pinion_angles"),
    ("x", 30, "pinion_angles: an array of finite numbers is asked for, not 'x'"),
    ([0.0], 0, "sections: 0 is not a whole number >= 1"),
    ([0.0], 2.5, "sections: 2.5 is not a whole number >= 1"),
    ([0.0], None, "sections: None is not a whole number >= 1"),
)


def test_pair_that_never_touches_is_refused():
    with pytest.raises(GeometryError, match="no common flank: at none of the 1 pinion angles"):
        search_golden_section(gear_pair(mounting=Mounting(axial_offset=30.0)), [0.0], sections=INTERIOR)


def test_flanks_that_stay_apart_within_half_a_pitch_are_refused():
    """A steep helix far along the axis: the wheel would have to turn by more than half a pitch."""
    pair = gear_pair(mounting=Mounting(axial_offset=20.0), helix_deg=30.0)
    with pytest.raises(GeometryError, match="do not come to touch within half a pitch of the wheel at pinion angle 0"):
        search_golden_section(pair, [0.0], sections=INTERIOR)


def test_gap_that_is_not_closed_is_reported_with_what_is_left(monkeypatch):
    monkeypatch.setattr(golden_section, "MOST_TURNS", 1)
    with pytest.raises(ConvergenceError, match=r"a gap of .* mm is left after 1 turns of the wheel") as caught:
        search_golden_section(PAIRS["profile crowned, wheel driving, turning back"], [0.05], sections=10)
    angle, gap = caught.value.last
    assert np.isfinite(angle).all()
    assert abs(gap[0]) > CLOSED
