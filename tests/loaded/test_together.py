"""Contacts worked on together: each is answered, fails and ends by itself, whatever stands beside it."""

import numpy as np
import pytest

from loaded_tca.contact import ContactProblem
from loaded_tca.errors import ConvergenceError, GeometryError
from loaded_tca.loaded import together
from loaded_tca.loaded.together import Gap, Task, run_alone, run_stacked
from loaded_tca.unloaded import trace_contact
from tests.samples.gear_pairs import sam_paper

PAIR = sam_paper()
CONTACT = trace_contact(PAIR, [0.0])[0]


def sphere(load, cells=16):
    x = np.linspace(-0.3, 0.3, cells)
    return ContactProblem((x[:, None] ** 2 + x**2) / 20.0, (x[1] - x[0],) * 2, 115e3, load=load)


def loads_doubled(load, times):
    """Solve a sphere under ever larger loads, each from the last; the pressures."""
    found, start = [], None
    for step in range(times):
        solution = yield Task(sphere(2.0**step * load), 1e-6, start)
        found.append(solution.pressure)
        start = solution.pressure
    return found


def test_results_stand_in_order_and_are_those_found_alone():
    asked = [(float(load), times) for load, times in zip(range(10, 110), [1, 3, 0, 2] * 25, strict=True)]
    found = run_stacked(PAIR, [loads_doubled(*one) for one in asked])
    assert [len(one) for one in found] == [times for _, times in asked]
    for one, own in zip(asked[:8], found, strict=False):
        for alone, beside in zip(run_alone(PAIR, loads_doubled(*one)), own, strict=True):
            assert (alone == beside).all()


def test_grids_of_several_sizes_are_all_solved():
    def on(cells):
        separation = yield Gap(CONTACT, (cells, cells), load=100.0)
        solution = yield Task(sphere(50.0, cells), 1e-6)
        return separation.gap.shape, solution.pressure.shape

    sizes = [8, 16, 24, 16, 8, 16]
    assert run_stacked(PAIR, [on(cells) for cells in sizes]) == [((n, n), (n, n)) for n in sizes]


def test_every_end_is_told_and_no_more_are_under_way_than_allowed(monkeypatch):
    monkeypatch.setattr(together, "UNDER_WAY", 3)
    running, most, told = set(), [], []

    def counted(name, times):
        running.add(name)
        most.append(len(running))
        yield from loads_doubled(10.0, times)
        running.discard(name)

    run_stacked(PAIR, [counted(name, 1 + name % 3) for name in range(11)], told.append)
    assert told == list(range(1, 12))
    assert max(most) == 3


def test_nothing_to_do_is_done():
    assert run_stacked(PAIR, []) == []


@pytest.mark.parametrize("deals_with_it", [True, False])
def test_error_reaches_the_one_that_asked(monkeypatch, deals_with_it):
    def hopeless():
        try:
            yield Task(sphere(1e3), 1e-13)
        except ConvergenceError as error:
            if not deals_with_it:
                raise
            return f"{error}"

    monkeypatch.setattr("loaded_tca.contact.solver.MOST_ITERATIONS", 3)
    steps = [loads_doubled(0.0, 2), hopeless(), loads_doubled(0.0, 1)]
    if deals_with_it:
        first, told, last = run_stacked(PAIR, steps)
        assert (len(first), len(last)) == (2, 1)
        assert "contact not converged" in told
    else:
        with pytest.raises(ConvergenceError, match="contact not converged") as caught:
            run_stacked(PAIR, steps)
        assert caught.value.last.iterations == 3


def test_gap_that_cannot_be_sampled_is_an_error_of_the_one_that_asked():
    apart = trace_contact(PAIR, [0.0, 1.0], warn=False)[1]

    def nowhere():
        with pytest.raises(GeometryError, match="not in contact"):
            yield Gap(apart, (8, 8), load=1.0)
        return "told"

    def somewhere():
        return (yield Gap(CONTACT, (8, 8), load=1.0)).gap.shape

    assert run_stacked(PAIR, [nowhere(), somewhere()]) == ["told", (8, 8)]
