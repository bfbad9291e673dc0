"""Work on many contacts at once: each asks for gaps and pressures, and what all ask for is found together.

A contact, or the tooth pairs of a position that share a torque, is a generator. It yields what it needs next, a
:class:`Gap`, :class:`Ends` or a :class:`Task`, is sent the answer, and returns its result. So it reads as if it
were alone, and its numbers do not depend on what stands beside it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Sequence
from functools import partial
from itertools import islice
from typing import Any, NamedTuple, TypeVar

from loaded_tca.arrays import Array
from loaded_tca.contact import ContactProblem
from loaded_tca.contact.solution import ContactSolution, ContactStatus
from loaded_tca.contact.solver import solve_problems
from loaded_tca.contact.stopping import not_converged
from loaded_tca.errors import LoadedTCAError
from loaded_tca.loaded.free_edges import edge_compliances
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation import Separation
from loaded_tca.separation.box import Box
from loaded_tca.separation.sample import sample_separations
from loaded_tca.unloaded import ContactPoint

UNDER_WAY = 64
"""Generators under way at the same time; stacks of contacts gain little beyond 32."""
Result = TypeVar("Result")


class Gap(NamedTuple):
    """A separation to sample, in the box that a load needs or in a given one; see :func:`sample_separation`."""

    contact: ContactPoint
    cells: tuple[int, int]
    load: float | None = None
    box: Box | None = None


class Task(NamedTuple):
    """A contact problem to solve to a tolerance, from a pressure to start from or none."""

    problem: ContactProblem
    tolerance: float
    start: Array | None = None


class Ends(NamedTuple):
    """Compliance that free edges add to the slices of a grid; see :func:`loaded_tca.loaded.free_edges`."""

    separation: Separation


Steps = Generator[Gap | Ends | Task, Any, Result]


def found_together(
    pair: GearPair, all_steps: Sequence[Steps[Result]], told: Callable[[int], None] | None = None
) -> list[Result]:
    """Answer what generators ask for, in rounds, until all have returned.

    In a round what most ask for is found: all gaps, or all free edges, or all problems on one grid.
    Whenever one returns, another one begins: so many are under way that stacks are full, and no more, so that memory
    stays bounded and progress steady.

    Parameters
    ----------
    pair : GearPair
    all_steps : sequence of generators
    told : callable, optional
        Called with how many have returned, whenever one does.

    Returns
    -------
    list
        What they return, in their order.

    Raises
    ------
    InputError, GeometryError, ConvergenceError
        The first one that a generator does not deal with.
    """
    results: dict[int, Result] = {}
    asked: dict[int, Gap | Ends | Task] = {}

    def advance(index: int, step: Callable[[], Gap | Ends | Task]) -> None:
        try:
            asked[index] = step()
        except StopIteration as end:
            results[index] = end.value
            if told is not None:
                told(len(results))

    waiting = iter(enumerate(all_steps))
    while len(results) < len(all_steps):
        for index, steps in islice(waiting, UNDER_WAY - len(asked)):
            advance(index, partial(next, steps))
        for index, answer in _answers(pair, asked).items() if asked else ():
            del asked[index]
            steps = all_steps[index]
            failed = isinstance(answer, LoadedTCAError)
            advance(index, partial(steps.throw, answer) if failed else partial(steps.send, answer))
    return [results[index] for index in range(len(all_steps))]


def found_alone(pair: GearPair, steps: Steps[Result]) -> Result:
    """Answer what one generator asks for, until it returns."""
    return found_together(pair, [steps])[0]


def _answers(
    pair: GearPair, asked: dict[int, Gap | Ends | Task]
) -> dict[int, Separation | Array | ContactSolution | LoadedTCAError | None]:
    """Answer what most ask for, gaps, free edges or problems on one grid; errors are answers."""
    kinds = {index: one.problem.cells if isinstance(one, Task) else type(one) for index, one in asked.items()}
    (most, _), *_ = Counter(kinds.values()).most_common(1)
    chosen: Any = {index: asked[index] for index, kind in kinds.items() if kind == most}
    if most is Gap:
        contacts, cells, loads, boxes = zip(*chosen.values(), strict=True)
        found = sample_separations(pair, contacts, cells=cells, loads=loads, boxes=boxes)
        return dict(zip(chosen, found, strict=True))
    if most is Ends:
        separations = [request.separation for request in chosen.values()]
        return dict(zip(chosen, edge_compliances(pair, separations), strict=True))
    solutions = solve_problems(*zip(*chosen.values(), strict=True), on_failure="return")
    return {
        index: not_converged(solution, task.tolerance) if solution.status is ContactStatus.NOT_CONVERGED else solution
        for (index, task), solution in zip(chosen.items(), solutions, strict=True)
    }
