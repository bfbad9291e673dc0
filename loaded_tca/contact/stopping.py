"""When the iterations on even and graded grids stop, and what is said of those that do not converge."""

from __future__ import annotations

from typing import Literal, Protocol

from loaded_tca.errors import ConvergenceError

MOST_ITERATIONS = 500
"""On one grid. Rough surfaces need about a hundred, smooth ones less than ten."""
MOST_CHECKS = 20
"""On the whole grid; every one that fails widens the window or starts from an exact displacement."""
COARSE_FACTOR, COARSE_TOLERANCE = 2.0, 1e-3
"""A coarse grid is solved so much less closely than the next finer one, and no less closely than that: as closely costs
as much as it brings, four times less closely (as its own error is larger) brings an iteration more on the finest grid
of a smooth contact."""
RESERVE = 0.8
"""Of the tolerance, at which the iteration stops, so that the check in double precision finds it kept."""

OnFailure = Literal["raise", "return"]


class Iterated(Protocol):
    """A solution that iterations came to."""

    @property
    def residual(self) -> float:
        """Largest violation of the contact conditions over the approach from first contact."""

    @property
    def iterations(self) -> int:
        """Iterations that it took."""


def not_converged(solution: Iterated, tolerance: float, name: str = "contact") -> ConvergenceError:
    """Error that tells of a contact that is not solved to its tolerance."""
    return ConvergenceError(
        f"{name} not converged: residual {solution.residual:.1e} > tolerance {tolerance:.1e} after "
        f"{solution.iterations} iterations; try a larger tolerance (in scenes: analysis.tolerance), or "
        "on_failure='return' to look at it",
        last=solution,
    )
