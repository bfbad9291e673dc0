import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse import coo_array, csr_array
from scipy.sparse.linalg import spsolve

from loaded_tca.compliance import dissection
from loaded_tca.compliance.body import error_of_displacements
from loaded_tca.compliance.dissection import factorise
from loaded_tca.compliance.finite_elements import discretise
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.material import Material

ROUNDING = 1e-9  # solutions with stiffness matrices of finite elements, in another order


def ring(columns=12, rows=4, turns=None):
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * columns, endpoint=False)[:, None]
    radius = np.linspace(1.0, 2.0, 2 * rows + 1)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    lowest = 2 * np.stack(np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"), axis=-1).reshape(-1, 2)
    return discretise(points, lowest, turns)


def turn(angle):
    """Turns (n, 2, 2): from components in turned frames to those before."""
    return np.moveaxis(np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]), -1, 0)


def free_unknowns(mesh):
    free = np.ones((len(mesh.points), 2), dtype=bool)
    free[mesh.number[:, 0][mesh.number[:, 0] >= 0]] = False
    return free.ravel()


@pytest.fixture(params=[False, True], ids=["few steps", "many steps"])
def steps(request, monkeypatch):
    """Few large fronts, or many small ones of several blocks of columns and rows each."""
    if request.param:
        for name, size in (("LEAF", 2), ("COLUMNS", 5), ("ROWS", 7)):
            monkeypatch.setattr(dissection, name, size)


@pytest.mark.usefixtures("steps")
def test_solution_is_that_of_a_sparse_solver(rng):
    mesh = ring()
    matrices, free = mesh.stiffness(Material()), free_unknowns(mesh)
    loads = rng.standard_normal((len(free), 3))
    found = factorise(matrices, mesh.dofs, mesh.lowest // 2, free).solve(loads)
    width = mesh.dofs.shape[1]
    rows, columns = np.repeat(mesh.dofs, width, axis=1).ravel(), np.tile(mesh.dofs, (1, width)).ravel()
    whole = coo_array((matrices.ravel(), (rows, columns))).tocsr()
    expected = spsolve(whole[free][:, free].tocsc(), loads[free])
    assert_allclose(found[free], expected, atol=ROUNDING * np.abs(expected).max())
    assert not found[~free].any()


def test_parts_that_are_alike_are_eliminated_once(rng, monkeypatch):
    """A ring of 12 equal pitches: the same answer from the matrices of one, in one elimination for each halving."""
    turns = np.repeat(np.arange(12), 2) * np.pi / 6.0
    plain, turned = ring(rows=1), ring(rows=1, turns=turns)
    free = free_unknowns(plain)
    matrices = turned.stiffness(Material())
    assert len(matrices) == len(plain.stiffness(Material())) / 12
    loads = rng.standard_normal((len(free), 3))
    expected = factorise(plain.stiffness(Material()), plain.dofs, plain.lowest // 2, free).solve(loads)
    counts = []
    eliminate = dissection._eliminate
    monkeypatch.setattr(dissection, "_eliminate", lambda *matrix: counts.append(1) or eliminate(*matrix))
    monkeypatch.setattr(dissection, "LEAF", 1)
    factor = factorise(matrices, turned.dofs, turned.lowest // 2, free, kinds=turned.kinds)
    columns = np.empty(len(plain.points), dtype=int)
    columns[plain.number[plain.number >= 0]] = np.nonzero(plain.number >= 0)[0]
    frames = turn(turns[columns])
    found = factor.solve(np.einsum("nba,nbm->nam", frames, loads.reshape(-1, 2, 3)).reshape(-1, 3))
    found = np.einsum("nab,nbm->nam", frames, found.reshape(-1, 2, 3)).reshape(-1, 3)
    assert_allclose(found, expected, atol=ROUNDING * np.abs(expected).max())
    assert len(counts) == 5  # 12 pitches, 6, 3, 2 and 1


def test_blocks_are_put_together_in_any_number(rng):
    mesh = ring()
    matrices, free = mesh.stiffness(Material()), free_unknowns(mesh)
    loads = rng.standard_normal((len(free), 2))
    expected = factorise(matrices, mesh.dofs, mesh.lowest // 2, free).solve(loads)
    for blocks in (mesh.lowest[:, 0] // 8, np.where(mesh.lowest[:, 0] < 4, 0, 1)):
        found = factorise(matrices, mesh.dofs, mesh.lowest // 2, free, blocks=blocks).solve(loads)
        assert_allclose(found, expected, atol=ROUNDING * np.abs(expected).max())


@pytest.mark.usefixtures("steps")
def test_flexibility_is_read_from_the_solution(rng):
    mesh = ring()
    matrices, free = mesh.stiffness(Material()), free_unknowns(mesh)
    factor = factorise(matrices, mesh.dofs, mesh.lowest // 2, free)
    loads, readings = np.zeros((2, len(free))), np.zeros((3, len(free)))
    loaded, read = np.flatnonzero(free)[40:49], np.flatnonzero(free)[[42, 60, -2, -1]]  # in a front alike and far apart
    loads[:, loaded], readings[:, read] = rng.standard_normal((2, 9)), rng.standard_normal((3, 4))
    expected = readings @ factor.solve(loads.T)
    found = factor.flexibility(csr_array(loads), csr_array(readings))
    assert_allclose(found, expected, atol=ROUNDING * np.abs(expected).max())
    assert_allclose(factor.flexibility(csr_array(readings), csr_array(loads)), found.T, rtol=1e-6)


@pytest.mark.parametrize("columns", [12, 48])
def test_error_of_single_precision_is_told_by_a_step_of_refinement(columns):
    """Within a factor of three, as it changes from load to load; double precision has none."""
    mesh = ring(columns)
    matrices, free = mesh.stiffness(Material()), free_unknowns(mesh)
    single, double = (
        factorise(used, mesh.dofs, mesh.lowest // 2, free) for used in (matrices.astype(np.float32), matrices)
    )
    loads = np.zeros((len(free), 2))
    node = int(np.hypot(*mesh.points.T).argmax())
    loads[2 * node + np.arange(2), np.arange(2)] = 1.0
    exact = double.solve(loads)
    error = (np.abs(single.solve(loads) - exact).max(axis=0) / np.abs(exact).max(axis=0)).max()
    assert single.dtype == np.float32
    assert 1e-8 < error < 1e-3
    assert error / 3.0 < error_of_displacements(mesh, single, matrices) < 3.0 * error
    assert error_of_displacements(mesh, double, matrices) < 1e-6 * error


def test_a_body_that_is_not_held_is_refused():
    mesh = ring()
    free = np.ones(2 * len(mesh.points), dtype=bool)
    with pytest.raises(GeometryError, match="not held"):
        factorise(mesh.stiffness(Material()), mesh.dofs, mesh.lowest // 2, free)


def two_springs(ground):
    """Stiffness of a spring between two points, and of one from the second to the ground, of a power of two.

    Every number on the way through Cholesky's factor is a float: it is exact with any BLAS.
    """
    return np.array([[[1.0, -1.0], [-1.0, 1.0 + ground]]]), np.array([[0, 1]]), np.array([[0]]), np.ones(2, dtype=bool)


@pytest.mark.parametrize("ground", [2.0**-50, 2.0**-40])
def test_a_body_that_is_held_by_rounding_alone_is_refused(ground):
    matrices, *rest = two_springs(ground)
    assert np.linalg.cholesky(matrices[0])[1, 1] ** 2 == ground  # positive: Cholesky itself does not refuse it
    with pytest.raises(GeometryError, match="not held"):
        factorise(matrices, *rest)


def test_a_body_that_is_held_by_little_is_solved():
    """Under a unit force on the first point both move by 1 / ground, and the first by 1 more."""
    ground = 2.0**-24
    displacement = factorise(*two_springs(ground)).solve(np.array([[1.0], [0.0]]))
    assert_array_equal(displacement, [[1.0 / ground + 1.0], [1.0 / ground]])


def test_flexibility_is_the_same_for_loads_one_by_one(rng):
    mesh = ring()
    free = free_unknowns(mesh)
    factor = factorise(mesh.stiffness(Material()), mesh.dofs, mesh.lowest // 2, free)
    loads, readings = np.zeros((2, len(free))), np.zeros((3, len(free)))
    loads[:, np.flatnonzero(free)[::7]] = rng.standard_normal((2, len(np.flatnonzero(free)[::7])))
    readings[:, np.flatnonzero(free)[-3:]] = rng.standard_normal((3, 3))
    together = factor.flexibility(csr_array(loads), csr_array(readings))
    found = np.hstack([factor.flexibility(csr_array(load[None]), csr_array(readings)) for load in loads])
    assert_allclose(found, together, atol=ROUNDING * np.abs(together).max())


def test_memory_is_told_before_it_is_taken(monkeypatch):
    mesh = ring()
    monkeypatch.setattr(dissection, "machine_memory", lambda: 1e4)
    monkeypatch.setattr(dissection._Plan, "factors", lambda *_: pytest.fail("memory was taken"))
    with pytest.raises(
        InputError, match=r"mesh of the gear body: \d+ unknowns need .* GiB, the machine has 0.00000931 GiB"
    ):
        factorise(mesh.stiffness(Material()), mesh.dofs, mesh.lowest // 2, free_unknowns(mesh))


def test_planned_memory_is_that_of_the_factor_at_least_and_not_of_all_that_parts_leave(monkeypatch):
    mesh, plans = ring(48, 16), []
    bytes_of = dissection._Plan.bytes.fget
    monkeypatch.setattr(dissection._Plan, "bytes", property(lambda plan: plans.append(plan) or bytes_of(plan)))
    factor = factorise(mesh.stiffness(Material()), mesh.dofs, mesh.lowest // 2, free_unknowns(mesh))
    kept = sum(front.factor.nbytes for front in factor.fronts)
    (plan,) = plans
    left = sum(8.0 * (len(step.order) - step.count) ** 2 for step in plan.steps)
    assert kept < bytes_of(plan) < dissection.RESERVE * (kept + left)
