"""Everything that can be wrong with a contact problem, told before work starts."""

import functools
import math
import os
import sys
from typing import Any

import numpy as np

from loaded_tca.arrays import Array, count_problems, numbers, real
from loaded_tca.errors import InputError
from loaded_tca.plain import plain

LEAST, MOST = 1e-20, 1e20
"""Widths of a cell [mm] between which nothing leaves the range of floating point numbers, whatever the unit."""
SOFTEST, STIFFEST = 1e-30, 1e30
"""The same of the contact modulus [MPa]."""
MOST_SLENDER = 1e12
"""Length of a cell over its width, either way."""
SHORTEST, LONGEST = 1e-25, 1e25
"""Displacements [mm] that stay far from the limits of single precision, in which the iteration runs."""
SYMMETRY = 1e-9
"""Of a slice compliance, over its largest value: it is symmetric, the rounding of how it was computed is not."""


def check_grid(gap: Array, spacing: tuple[float, float], contact_modulus: float) -> list[str]:
    """Problems of the gap array, the spacing and the modulus."""
    if gap.ndim != 2 or 0 in gap.shape:
        return [f"gap: an array of shape {gap.shape} is not a grid of cells (nx, ny)"]
    if (memory := memory_problem(gap.shape)) is not None:
        return [f"gap: {memory}"]
    problems = check_spacing(spacing)
    if not SOFTEST <= real(contact_modulus) <= STIFFEST:
        problems.append(
            f"contact_modulus: {contact_modulus} is not a number from {plain(SOFTEST, 6)} to {plain(STIFFEST, 6)} MPa"
        )
    least = gap.min()
    if np.isnan(least):
        problems.append(f"gap: {int(np.isnan(gap).sum())} cells are NaN (use inf for no material)")
    elif least == -math.inf:
        problems.append("gap: minus infinity is no gap")
    elif least == math.inf:
        problems.append("gap: no cell holds material, every one is inf")
    return problems


def check_cover(cover: Array | None, gap: Array) -> list[str]:
    """Problems of the parts of the cells that have material."""
    if cover is None:
        return []
    if cover.shape != gap.shape:
        return [f"cover: its shape {cover.shape} is not that of the gap, {gap.shape}"]
    wrong = np.count_nonzero(np.isfinite(gap) & ~((cover > 0.0) & (cover <= 1.0)))
    return [f"cover: {wrong} cells with a finite gap are not above 0 and at most 1"] if wrong else []


def check_slices(compliance: Array | None, shape: tuple[int, ...]) -> list[str]:
    """Problems of a slice compliance for a grid of a shape."""
    if compliance is None:
        return []
    if compliance.shape != (shape[-1], shape[-1]):
        return [f"slice_compliance: shape {(shape[-1], shape[-1])} is needed, not {compliance.shape}"]
    if not np.isfinite(compliance).all():
        return [f"slice_compliance: {int((~np.isfinite(compliance)).sum())} values are not finite"]
    if np.abs(compliance - compliance.T).max() > SYMMETRY * np.abs(compliance).max():
        return ["slice_compliance: is not symmetric"]
    return []


def check_spacing(spacing: tuple[float, float]) -> list[str]:
    """Problems of the widths of a cell."""
    try:
        widths = numbers("spacing", spacing)
    except InputError as error:
        return list(error.problems)
    if widths.shape != (2,):
        return [f"spacing: {widths.tolist()} is not a pair of cell widths (dx, dy)"]
    both = widths.tolist()
    problems = [
        f"spacing[{axis}]: {width} is not between {plain(LEAST, 6)} and {plain(MOST, 6)} mm"
        for axis, width in enumerate(both)
        if not LEAST <= width <= MOST
    ]
    if not problems and max(both) > MOST_SLENDER * min(both):
        problems.append(f"spacing: {both} are widths of a ratio above {plain(MOST_SLENDER, 6)}")
    return problems


def check_demand(
    load: Any,
    approach: Any,
    max_pressure: Any,
    gap: Array,
    area: float,
    spacing: tuple[float, float],
    contact_modulus: float,
) -> list[str]:
    """Problems of what is asked for: exactly one of load and approach, within what the cap on the area can carry."""
    problems = []
    if (load is None) == (approach is None):
        problems.append("load, approach: give exactly one of the two")
    least, most = (limit * spacing[1] * contact_modulus for limit in (SHORTEST, LONGEST))
    if load is not None and not (least <= real(load) <= most or real(load) == 0.0):
        problems.append(
            f"load: {load} N is neither 0 nor, on this grid, a number from {plain(least, 3)} to {plain(most, 3)} N"
        )
    depth = 0.0 if approach is None else real(approach) - float(gap.min())
    if not (-LONGEST <= depth <= 0.0 or SHORTEST <= depth <= LONGEST):
        allowed = f"up to {plain(LONGEST, 6)} mm to either side of it, and beyond it at least {plain(SHORTEST, 6)} mm"
        problems.append(f"approach: {approach} mm lies {depth} mm beyond first contact; allowed {allowed}")
    if max_pressure is not None and not real(max_pressure) > 0.0:
        problems.append(f"max_pressure: {max_pressure} MPa is not positive")
    elif max_pressure is not None and load is not None:
        carried = max_pressure * area
        if real(load) > carried:
            problems.append(
                f"load: {load} N is more than max_pressure on all material can carry, {plain(carried, 6)} N"
            )
    return problems


def check_run(
    tolerance: float, on_failure: str, start: Array | None, shape: tuple[int, ...], threads: int
) -> list[str]:
    """Problems of the options of the iteration."""
    problems = count_problems({"threads": threads}, 1)
    if not 0.0 < real(tolerance) < 1.0:
        problems.append(f"tolerance: {tolerance} is not between 0 and 1")
    if on_failure not in ("raise", "return"):
        problems.append(f'on_failure: {on_failure!r} is neither "raise" nor "return"')
    if start is not None and start.shape != shape:
        problems.append(f"initial_pressure: its shape {start.shape} is not that of the gap, {shape}")
    elif start is not None and not (start.min() >= 0.0 and start.max() < math.inf):
        problems.append("initial_pressure: holds negative or infinite values or NaN")
    return problems


def raise_if(problems: list[str]) -> None:
    """Raise one InputError with every problem, if there is any."""
    if problems:
        raise InputError(problems)


# Bytes at the peak of a solve for every cell of the grid: transforms of the doubled box in double precision, its
# kernel, and the fields. Measured: 200 to 260 on 512 x 512 and 1024 x 1024 cells; the rest is reserve.
MOST_CELLS = 1024
"""Along a side of a grid, beyond which an accuracy refines no further."""
BYTES_PER_CELL = 400


def memory_problem(shape: tuple[int, ...], available: float | None = None) -> str | None:
    """Return what to say if a grid needs more memory than the machine has."""
    needed = math.prod(shape) * float(BYTES_PER_CELL)
    limit = machine_memory() if available is None else available
    if needed <= limit:
        return None
    return f"{shape} cells need {plain(needed / 2**30, 3)} GiB, the machine has {plain(limit / 2**30, 3)} GiB"


BYTES_PER_PAIR = 48
"""Bytes at the peak of a solve for every pair of columns and cell along them: coefficients, their transform in both
precisions and its inverses, and the same of the coarser grids. Measured: 32 to 39."""


def columns_memory_problem(rows: int, columns: int, available: float | None = None) -> str | None:
    """Return what to say if columns need more memory than the machine has."""
    needed = float(BYTES_PER_PAIR) * (rows + 1.0) * float(columns) ** 2
    limit = machine_memory() if available is None else available
    if needed <= limit:
        return None
    return (
        f"{columns} columns of {rows} cells need {plain(needed / 2**30, 3)} GiB, the machine has "
        f"{plain(limit / 2**30, 3)} GiB"
    )


@functools.cache
def machine_memory() -> float:
    """Return the physical memory [bytes], infinity where the system does not tell."""
    if sys.platform == "win32":
        return math.inf
    try:
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (ValueError, OSError):
        return math.inf
