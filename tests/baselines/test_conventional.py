"""The five contact equations: their Jacobian, agreement with the reduced solver, and where they fail."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from numpy.testing import assert_allclose

from loaded_tca import InputError, trace_contact
from loaded_tca.baselines.conventional import UNKNOWNS, contact_equations, solve_conventional, solve_with_scipy_root
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from tests.samples.gear_pairs import gear_pair, pairs, sam_paper

SAME_ANGLE = 1e-12  # rad; asked for: 1e-10
SAME_POINT = 1e-6  # mm; along a ridge of radius 15 m, a residual of 1e-12 leaves 2e-8 mm
NEAR = np.array([0.1, 0.5, -0.1, -0.5, 0.01])  # mm, mm, mm, mm, rad: off the answer

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
every_pair = pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS)
solvers = pytest.mark.parametrize("solve", [solve_conventional, solve_with_scipy_root])
components = pytest.mark.parametrize("normal_components", [(1, 2), (0, 2)])


def answer(path):
    """The unknowns of the conventional equations, from the reduced solver."""
    parts = (path.pinion_radius, path.pinion_axial, path.wheel_radius, path.wheel_axial, path.wheel_angle)
    return np.stack(parts, axis=-1)


@pytest.mark.quick_cases(every=5)
@every_pair
@solvers
@components
def test_equations_have_the_contact_of_the_reduced_solver_as_their_solution(pair, solve, normal_components):
    path = trace_contact(pair, np.linspace(-0.6, 0.6, 7) * pair.pitch)
    expected, inner = answer(path), ~path.on_edge
    found = solve(pair, path.pinion_angle, expected + NEAR, normal_components)
    assert inner.sum() >= 4
    assert found.is_contact[inner].all()
    assert_allclose(found.wheel_angle[inner], path.wheel_angle[inner], rtol=0, atol=SAME_ANGLE)
    assert_allclose(found.unknowns[inner], expected[inner], rtol=0, atol=SAME_POINT)


@pytest.mark.thorough
@given(pairs())
@settings(max_examples=30)
def test_equations_hold_at_every_smooth_interior_contact(pair):
    """Values of the equations at the contacts of the reduced solver, whatever the pair."""
    path = trace_contact(pair, np.linspace(-0.4, 0.4, 3) * pair.pitch)
    smooth = path.in_contact & ~path.on_edge & ~path.on_relief_start & ~path.on_line
    values, _ = contact_equations(pair, path.pinion_angle[smooth], answer(path)[smooth])
    assert_allclose(values, 0.0, atol=1e-9)  # the residual that the reduced solver leaves in the normals


@every_pair
@components
def test_jacobian_is_the_slope_of_the_equations(pair, normal_components, rng):
    angle = rng.uniform(-0.05, 0.05, 4)
    unknowns = answer(trace_contact(pair, angle)) + rng.uniform(-0.2, 0.2, (4, 5))
    _, jacobian = contact_equations(pair, angle, unknowns, normal_components)
    step = 1e-5
    for k, _name in enumerate(UNKNOWNS):
        shift = step * np.eye(5)[k]
        sides = [contact_equations(pair, angle, unknowns + s * shift, normal_components)[0] for s in (1.0, -1.0)]
        slope = (sides[0] - sides[1]) / (2.0 * step)
        assert_allclose(jacobian[..., k], slope, rtol=0, atol=1e-9)  # h^2 and rounding/h, both about 1e-10


def test_newton_converges_quadratically_near_the_contact():
    pair = sam_paper(15.0)
    path = trace_contact(pair, [0.01])
    residuals = []
    unknowns = answer(path) + 0.3 * NEAR
    for _ in range(3):
        values, jacobian = contact_equations(pair, path.pinion_angle, unknowns)
        residuals.append(np.abs(values).max())
        unknowns = unknowns + np.linalg.solve(jacobian, -values[..., None])[..., 0]
    assert residuals[1] < residuals[0] ** 1.7
    assert residuals[2] < residuals[1] ** 1.7


@solvers
def test_contact_on_an_edge_is_beyond_the_equations(solve):
    """The normals differ there: what the equations have for a solution lies off the flanks, 50 mm beyond the face."""
    pair = sam_paper(mounting=Mounting(out_of_plane=0.01))
    path = trace_contact(pair, [-0.02, 0.0, 0.02])
    found = solve(pair, path.pinion_angle, answer(path))
    assert path.on_edge.all()
    assert found.converged.all()
    assert not found.inside.any()
    assert not found.is_contact.any()
    assert (found.unknowns[:, 1] > 50.0).all()
    assert (np.abs(found.wheel_angle - path.wheel_angle) > 1e-4).all()


def test_share_of_random_starts_that_converge_falls_with_the_spread_of_the_wheel_angle(rng):
    """The reduced-TCA dissertation prints 27.32 % of 5000 for its spur pair, without saying how far phi2 was spread."""
    pair = gear_pair(FlankModifications(lead_crowning=0.0931), teeth=(52, 72), module=1.0, width=11.42)
    starts = np.stack([rng.uniform(*ends, 600) for ends in random_ranges(pair)], axis=-1)
    near, wide = (starts * [1.0, 1.0, 1.0, 1.0, spread] for spread in (0.2, 0.5 * math.pi))
    shares = [solve_conventional(pair, 0.0, start).is_contact.mean() for start in (near, wide)]
    assert shares[0] == 1.0
    assert 0.2 < shares[1] < 0.36  # 28 %, four times the sampling error of 600 starts
    better = solve_conventional(pair, 0.0, wide, (0, 2)).is_contact.mean()
    assert better > shares[1] + 0.1


def random_ranges(pair):
    """Ends of both flanks, and -1 to 1 for the wheel angle."""
    corners = [part for flank in (pair.pinion.flank, pair.wheel.flank) for part in flank.grid(2, 2)]
    return [(part.min(), part.max()) for part in corners] + [(-1.0, 1.0)]


def test_starts_that_diverge_are_marked_and_stay_finite(rng):
    pair = sam_paper(15.0)
    start = np.stack([rng.uniform(*ends, 200) for ends in random_ranges(pair)], axis=-1)
    start[:, 4] *= 50.0
    found = solve_conventional(pair, 0.0, start)
    assert not found.converged.all()
    assert np.isfinite(found.unknowns).all()
    assert np.isfinite(found.wheel_angle).all()
    assert not np.isnan(found.residual).any()
    assert (found.residual[~found.converged] > 1e-12).all()  # where iterations stop
    assert (np.abs(found.wheel_angle) <= math.pi).all()


def test_two_components_of_the_normals_leave_a_false_solution_that_is_told_apart(rng):
    """The normals agree in y and z and are mirrored in x: converged, yet no contact."""
    pair = gear_pair(FlankModifications(lead_crowning=0.0156), teeth=(25, 25), module=2.5)
    start = np.stack([rng.uniform(*ends, 800) for ends in random_ranges(pair)], axis=-1)
    start[:, 4] *= 0.5 * math.pi
    found = solve_conventional(pair, 0.0, start)
    false = found.converged & ~found.tangent
    assert false.any()
    assert not found.is_contact[false].any()


def test_unmodified_spur_pair_has_a_singular_jacobian_and_no_start_converges():
    """A line contact: every point of it solves the equations, so none is singled out."""
    pair = gear_pair()
    found = solve_conventional(pair, 0.0, [[51.2, 1.0, 85.2, -1.0, 0.01]])
    assert not found.converged.any()
    assert found.iterations.tolist() == [0]
    assert trace_contact(pair, [0.0]).on_line.all()


def test_wheel_angle_does_not_count_whole_turns():
    pair = sam_paper()
    path = trace_contact(pair, [0.02])
    start = answer(path)
    start[:, 4] += 4.0 * math.pi
    found = solve_conventional(pair, 0.02, start)
    assert found.is_contact.all()
    # rad, also below: an angle of 13 is rounded to 2e-15
    assert_allclose(found.unknowns[:, 4], path.wheel_angle + 4.0 * math.pi, rtol=0, atol=1e-11)
    assert_allclose(found.wheel_angle, path.wheel_angle, rtol=0, atol=1e-11)


GOOD = [51.0, 0.0, 85.5, 0.0, 0.0]


@solvers
@pytest.mark.parametrize(
    ("phi1", "start", "components", "message"),
    [
        (0.0, GOOD, (1, 2), r"start: shape \(5,\); one row of five finite numbers a start is asked for: pinion_radius"),
        (0.0, [GOOD[:4]], (1, 2), r"start: shape \(1, 4\)"),
        (0.0, [[51.0, 0.0, 85.5, 0.0, math.nan]], (1, 2), r"start: shape \(1, 5\); one row of five finite"),
        (0.0, [[-51.0, 0.0, 85.5, 0.0, 0.0]], (1, 2), "radii pinion_radius and wheel_radius must be positive"),
        (math.inf, [GOOD], (1, 2), "phi1: shape .*; one finite angle, or one for each of 1 starts"),
        ([0.0, 0.1], [GOOD], (1, 2), r"phi1: shape \(2,\)"),
        (0.0, [GOOD], (1, 1), "normal_components: .* are not two different ones of 0, 1, 2"),
        (0.0, [GOOD], (1, 3), "normal_components"),
        (0.0, [GOOD], None, "normal_components"),
        (0.0, "x", (1, 2), "start: an array of finite numbers is asked for, not 'x'"),
        ([None, "a"], [GOOD], (1, 2), "phi1: an array of finite numbers is asked for"),
    ],
)
def test_inputs_that_cannot_be_used_are_refused(solve, phi1, start, components, message):
    with pytest.raises(InputError, match=message):
        solve(sam_paper(), phi1, start, components)


def test_result_tells_how_many_starts_reached_a_contact():
    found = solve_conventional(sam_paper(), 0.0, [GOOD, [51.2, 1.0, 85.2, -1.0, 1.5]])
    assert repr(found) == "ConventionalResult(2 starts, 1 converged, 1 of them to a contact)"
