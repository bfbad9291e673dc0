"""Everything that can be wrong with a contact problem, told before work starts."""

import math
import os

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError


def check_grid(gap: Array, spacing: tuple[float, float], contact_modulus: float) -> list[str]:
    """Problems of the gap array, the spacing and the modulus."""
    if gap.ndim != 2 or 0 in gap.shape:
        return [f"gap: an array of shape {gap.shape} is not a grid of cells (nx, ny)"]
    if (memory := memory_problem(gap.shape)) is not None:
        return [f"gap: {memory}"]
    problems = check_spacing(spacing)
    if not 0.0 < contact_modulus < math.inf:
        problems.append(f"contact_modulus: {contact_modulus} is not positive and finite")
    if np.isnan(gap).any():
        problems.append(f"gap: {int(np.isnan(gap).sum())} cells are NaN (use inf for no material)")
    elif np.isneginf(gap).any():
        problems.append("gap: minus infinity is no gap")
    elif not np.isfinite(gap).any():
        problems.append("gap: no cell holds material, every one is inf")
    return problems


def check_cover(cover: Array | None, gap: Array) -> list[str]:
    """Problems of the parts of the cells that have material."""
    if cover is None:
        return []
    if cover.shape != gap.shape:
        return [f"cover: its shape {cover.shape} is not that of the gap, {gap.shape}"]
    wrong = int(np.count_nonzero(~((cover > 0.0) & (cover <= 1.0))[np.isfinite(gap)]))
    return [f"cover: {wrong} cells with a finite gap are not above 0 and at most 1"] if wrong else []


def check_spacing(spacing: tuple[float, float]) -> list[str]:
    """Problems of the widths of a cell."""
    if np.shape(spacing) != (2,):
        return [f"spacing: {spacing} is not a pair of cell widths (dx, dy)"]
    return [
        f"spacing[{axis}]: {width} is not positive and finite"
        for axis, width in enumerate(spacing)
        if not 0.0 < width < math.inf
    ]


def check_demand(load: float | None, approach: float | None, max_pressure: float | None, area: float) -> list[str]:
    """Problems of what is asked for: exactly one of load and approach, within what the cap can carry."""
    problems = []
    if (load is None) == (approach is None):
        problems.append("load, approach: give exactly one of the two")
    if load is not None and not 0.0 <= load < math.inf:
        problems.append(f"load: {load} N is negative or not finite")
    if approach is not None and not math.isfinite(approach):
        problems.append(f"approach: {approach} mm is not finite")
    if max_pressure is not None and not max_pressure > 0.0:
        problems.append(f"max_pressure: {max_pressure} MPa is not positive")
    elif max_pressure is not None and load is not None and load > max_pressure * area:
        most = max_pressure * area
        problems.append(f"load: {load} N is more than max_pressure on all material can carry, {most:.6g} N")
    return problems


def check_run(tolerance: float, on_failure: str, initial: ArrayLike | None, shape: tuple[int, ...]) -> list[str]:
    """Problems of the options of the iteration."""
    problems, start = [], None if initial is None else np.asarray(initial, dtype=np.float64)
    if not 0.0 < tolerance < 1.0:
        problems.append(f"tolerance: {tolerance} is not between 0 and 1")
    if on_failure not in ("raise", "return"):
        problems.append(f'on_failure: {on_failure!r} is neither "raise" nor "return"')
    if start is not None and start.shape != shape:
        problems.append(f"initial_pressure: its shape {start.shape} is not that of the gap, {shape}")
    elif start is not None and not (np.isfinite(start).all() and (start >= 0.0).all()):
        problems.append("initial_pressure: holds negative or infinite values or NaN")
    return problems


def raise_if(problems: list[str]) -> None:
    """Raise one InputError with every problem, if there is any."""
    if problems:
        raise InputError(problems)


# Bytes at the peak of a solve for every cell of the grid: transforms of the doubled box in double precision, its
# kernel, and the fields. Measured: 200 to 260 on 512 x 512 and 1024 x 1024 cells; the rest is reserve.
BYTES_PER_CELL = 400


def memory_problem(shape: tuple[int, ...], available: float | None = None) -> str | None:
    """Return what to say if a grid needs more memory than the machine has."""
    needed = math.prod(shape) * float(BYTES_PER_CELL)
    limit = machine_memory() if available is None else available
    if needed <= limit:
        return None
    return f"{shape} cells need {needed / 2**30:.3g} GiB, the machine has {limit / 2**30:.3g} GiB"


def machine_memory() -> float:
    """Return the physical memory [bytes], infinity where the system does not tell."""
    try:
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):
        return math.inf
