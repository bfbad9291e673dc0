"""How quick this machine is beside the one that the constants of ``loaded_tca.effort`` were measured on.

Two works that stand for an analysis are done once on a machine, in half a second of processor time: a stack of small
contact problems, as states of a cycle are, and dense eliminations, as models of gear bodies are. What they take is kept
beside the models of teeth, see :mod:`loaded_tca.compliance.kept`: for the contact solver as it is, for this version of
NumPy and of SciPy, and for this machine. A file that is missing, damaged or of another machine is made anew; where none
can be written, each process measures for itself.
"""

from __future__ import annotations

import hashlib
import os
import platform
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance.kept import kept
from loaded_tca.threads import one_thread

STATES_REFERENCE, MODELS_REFERENCE = 7.7e-3, 6.0e-3
"""Processor time [s] of the two works on the machine of the constants. On virtual machines of two cores
they take 2.1 and 2.3 times as long (AMD EPYC), as do states, pictures and models of the electric drive of
``validation.loaded.user_scenes``, and 1.3 and 1.4 times (Intel Xeon)."""
REPEATED = 5
"""Times that each is done, of which the quickest counts: others make a machine slower for a while, nothing quicker."""
CONTACTS, CELLS = 8, 48
EQUATIONS, ELIMINATIONS = 500, 4


@dataclass(frozen=True, eq=False)
class MachineSpeed:
    """Time that works take on this machine over that on the machine of reference.

    Attributes
    ----------
    states, models : () array
        Of states of a cycle, and of finite element models.
    """

    states: Array
    models: Array


@cache
def machine_speed() -> MachineSpeed:
    """Return how long works take on this machine, measured or as kept on disk."""
    return kept(_key(), MachineSpeed, measured_speed)


def measured_speed() -> MachineSpeed:
    """Measure how long works take on this machine, in processor time on one thread."""
    with one_thread():
        states, models = _quickest(_contacts()), _quickest(_eliminations())
    return MachineSpeed(np.array(states / STATES_REFERENCE), np.array(models / MODELS_REFERENCE))


def _quickest(work: Callable[[], object]) -> float:
    """Least processor time [s] of some work, done first to load what it needs."""
    work()
    taken = []
    for _ in range(REPEATED):
        start = time.thread_time()
        work()
        taken.append(time.thread_time() - start)
    return max(min(taken), 1e-6)


def _contacts() -> Callable[[], object]:
    """Problems of paraboloids of several curvatures, each under its load."""
    from loaded_tca.contact import ContactProblem, solve_problems  # once on a machine

    place = (np.arange(CELLS) + 0.5) / CELLS - 0.5
    problems = [
        ContactProblem(
            gap=(place[:, None] ** 2 + slender * place**2) / 20.0,
            spacing=(1.0 / CELLS, 1.0 / CELLS),
            contact_modulus=115e3,
            load=100.0 * slender,
        )
        for slender in np.linspace(0.3, 0.9, CONTACTS)
    ]
    return lambda: solve_problems(problems, [1e-6] * CONTACTS, [None] * CONTACTS)


def _eliminations() -> Callable[[], object]:
    """Halves of the unknowns of symmetric matrices are eliminated, as in fronts of a gear body."""
    from scipy.linalg import cholesky, solve_triangular

    matrix = np.eye(EQUATIONS) + 1.0 / (1.0 + np.abs(np.subtract.outer(np.arange(EQUATIONS), np.arange(EQUATIONS))))
    half = EQUATIONS // 2

    def work() -> None:
        order = np.arange(EQUATIONS)[::-1]
        for _ in range(ELIMINATIONS):
            whole = matrix.take(order, axis=1).take(order, axis=0)
            factor = cholesky(whole[:half, :half], lower=True, check_finite=False)
            coupling = solve_triangular(factor, whole[:half, half:], lower=True, check_finite=False).T
            _ = whole[half:, half:] - coupling @ coupling.T

    return work


def _key() -> str:
    """Digest of the machine and of all programmes that its speed depends on."""
    here = Path(__file__)
    sources = [here, *sorted(here.with_name("contact").glob("*.py"))]
    scipy = find_spec("scipy")  # its version without importing it
    if scipy is not None and scipy.origin is not None:
        sources.append(Path(scipy.origin).with_name("version.py"))
    machine = platform.node(), platform.machine(), platform.python_version(), os.cpu_count(), _processor()
    digest = hashlib.sha256(f"speed {np.__version__} {machine}".encode())
    for source in sources:
        digest.update(source.read_bytes())
    return digest.hexdigest()


def _processor() -> str:
    """Name of the processor, as far as the system tells it."""
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8", errors="replace") as lines:
            return next((line for line in lines if line.startswith("model name")), "")
    except OSError:
        return platform.processor()
