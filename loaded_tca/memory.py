"""Whether a grid fits into the memory of the machine, told before anything is allocated."""

import math
import os

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
