"""Work on many contacts at once: each asks for gaps and pressures, and what all ask for is found together.

A contact, or the tooth pairs of a position that share a torque, is a generator. It yields what it needs next, a
:class:`Trace`, :class:`Gap`, :class:`Line`, :class:`Ends`, :class:`Bend` or a :class:`Task`, is sent the answer, and
returns its result. So it reads as if it were alone, and its numbers do not depend on what stands beside it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Generator, Sequence
from functools import partial
from itertools import islice
from typing import Any, NamedTuple, TypeVar

from loaded_tca.arrays import Array
from loaded_tca.compliance.model import BendingModel
from loaded_tca.contact import ContactProblem
from loaded_tca.contact.solution import ContactSolution, ContactStatus
from loaded_tca.contact.solver import solve_problems
from loaded_tca.edges.free import edge_compliances
from loaded_tca.errors import LoadedTCAError
from loaded_tca.loaded.first_guess import ExpectedLine, expected_lines
from loaded_tca.pairs.gear_pair import ContactGrid, GearPair
from loaded_tca.separation import Separation
from loaded_tca.separation.box import Box
from loaded_tca.separation.polynomials import GapPolynomials
from loaded_tca.separation.sample import sample_separations
from loaded_tca.threads import leave_if_not_wanted
from loaded_tca.unloaded import ContactPoint
from loaded_tca.unloaded.path import trace_near

UNDER_WAY = 128
"""Generators under way at the same time: a cycle of 33 positions under three torques, whose stacks are full then."""
Result = TypeVar("Result")


class Gap(NamedTuple):
    """A separation to sample, in the box that a load needs or in a given one; see :func:`sample_separation`.

    ``gears`` are those of a tooth pair that has flanks of its own; None: the common ones. ``polynomials`` are those of
    another grid of the contact; ``cells_at_ends`` are used instead of ``cells`` in estimated boxes in which flanks end.
    """

    contact: ContactPoint
    cells: tuple[int, int]
    load: float | None = None
    box: Box | None = None
    gears: GearPair | None = None
    polynomials: GapPolynomials | None = None
    cells_at_ends: tuple[int, int] | None = None


class Trace(NamedTuple):
    """Contacts at other pinion angles [rad] nearby; see :func:`loaded_tca.unloaded.path.trace_near`.

    ``gears`` as of :class:`Gap`.
    """

    contacts: Sequence[ContactPoint]
    pinion_angles: Sequence[float]
    gears: GearPair | None = None


class Line(NamedTuple):
    """The slices that a contact is expected to load; see :func:`loaded_tca.loaded.first_guess.expected_lines`."""

    contact: ContactPoint
    half_length: float
    gears: GearPair | None = None


class Task(NamedTuple):
    """A contact problem to solve to a tolerance, from a pressure to start from or none."""

    problem: ContactProblem
    tolerance: float
    start: Array | None = None


class Ends(NamedTuple):
    """Compliance that free edges add to the slices of a grid; see :mod:`loaded_tca.edges.free`."""

    separation: Separation
    gears: GearPair | None = None


class Bend(NamedTuple):
    """Deflection of the slices of a grid by a bending model; see :meth:`BendingModel.within`."""

    bending: BendingModel
    number: int
    grid: ContactGrid


Request = Trace | Gap | Line | Ends | Bend | Task
Steps = Generator[Request, Any, Result]


def run_stacked(
    pair: GearPair, all_steps: Sequence[Steps[Result]], progress: Callable[[int], None] | None = None
) -> list[Result]:
    """Answer what generators ask for, in rounds, until all have returned.

    In a round what most ask for is found: all contacts elsewhere, or all gaps, or all lines, or all free edges, or the
    bending of all slices, or all problems on one grid.
    Whenever one returns, another one begins: so many are under way that stacks are full, and no more, so that memory
    stays bounded and progress steady.

    Parameters
    ----------
    pair : GearPair
    all_steps : sequence of generators
    progress : callable, optional
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
    asked: defaultdict[object, dict[int, Any]] = defaultdict(dict)  # for each kind of request

    def advance(index: int, step: Callable[[], Request]) -> None:
        try:
            request = step()
        except StopIteration as end:
            results[index] = end.value
            if progress is not None:
                progress(len(results))
        else:
            asked[request.problem.cells if isinstance(request, Task) else type(request)][index] = request

    waiting = iter(enumerate(all_steps))
    while len(results) < len(all_steps):
        leave_if_not_wanted()
        for index, steps in islice(waiting, UNDER_WAY - sum(map(len, asked.values()))):
            advance(index, partial(next, steps))
        most = max(asked, key=lambda kind: len(asked[kind]), default=None)
        for index, answer in _answers(pair, asked.pop(most)).items() if asked else ():
            steps = all_steps[index]
            failed = isinstance(answer, LoadedTCAError)
            advance(index, partial(steps.throw, answer) if failed else partial(steps.send, answer))
    return [results[index] for index in range(len(all_steps))]


def run_alone(pair: GearPair, steps: Steps[Result]) -> Result:
    """Answer what one generator asks for, until it returns."""
    return run_stacked(pair, [steps])[0]


def _answers(
    pair: GearPair, asked: dict[int, Any]
) -> dict[int, list[ContactPoint] | Separation | ExpectedLine | Array | ContactSolution | LoadedTCAError | None]:
    """Answer requests of one kind: contacts, gaps, lines, free edges, bending, problems on one grid; or with errors."""
    kind = type(next(iter(asked.values())))
    if kind is not Task:
        alike: dict[int, dict[int, Any]] = {}
        for index, request in asked.items():
            alike.setdefault(id(request.bending if kind is Bend else request.gears), {})[index] = request
        return {index: answer for some in alike.values() for index, answer in _of_flanks(pair, some).items()}
    solutions = solve_problems(*zip(*asked.values(), strict=True), on_failure="return")
    return {
        index: solution.not_converged(task.tolerance) if solution.status is ContactStatus.NOT_CONVERGED else solution
        for (index, task), solution in zip(asked.items(), solutions, strict=True)
    }


def _of_flanks(
    pair: GearPair, asked: dict[int, Any]
) -> dict[int, list[ContactPoint] | Separation | ExpectedLine | Array | LoadedTCAError | None]:
    """Answer requests for contacts, for gaps, for lines, or for free edges, of the same gears, or for one bending."""
    requests = list(asked.values())
    if isinstance(requests[0], Bend):
        bent = requests[0].bending.within_each([(request.number, request.grid) for request in requests])
        return dict(zip(asked, bent, strict=True))
    gears = requests[0].gears or pair
    if isinstance(requests[0], Trace):
        near = [contact for request in requests for contact in request.contacts]
        path = trace_near(gears, near, [angle for request in requests for angle in request.pinion_angles])
        points = iter(path)
        return {index: [*islice(points, len(request.contacts))] for index, request in asked.items()}
    if isinstance(requests[0], Ends):
        return dict(zip(asked, edge_compliances(gears, [request.separation for request in requests]), strict=True))
    if isinstance(requests[0], Line):
        contacts, half_lengths, _ = zip(*requests, strict=True)
        return dict(zip(asked, expected_lines(gears, contacts, half_lengths), strict=True))
    contacts, cells, loads, boxes, _, polynomials, at_ends = zip(*requests, strict=True)
    gaps = sample_separations(
        gears, contacts, cells=cells, loads=loads, boxes=boxes, polynomials=polynomials, cells_at_ends=at_ends
    )
    return dict(zip(asked, gaps, strict=True))


def with_gears(gears: GearPair | None, steps: Steps[Result]) -> Steps[Result]:
    """Steps whose gaps and free edges are those of the gears of one tooth pair; None: of the common ones."""
    if gears is None:
        return (yield from steps)
    answer: Any = None
    failure: BaseException | None = None
    while True:
        try:
            request = steps.send(answer) if failure is None else steps.throw(failure)
        except StopIteration as end:
            return end.value
        failure = None
        try:
            answer = yield (request if isinstance(request, Task | Bend) else request._replace(gears=gears))
        except LoadedTCAError as error:
            failure = error
