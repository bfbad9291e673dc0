"""Contacts on which solvers go wrong, each beside its answer: iterations, convolutions, residual, error.

Run from the root of the repository: ``python -m validation.contact.hard_cases``; prints the table of
``docs/studies/contact_solver.md``. The same cases are tests in ``tests/contact/test_hard_cases.py``.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.contact import ContactSolution, solve_contact
from loaded_tca.reference import hertz, punch
from validation.page import table

Array = NDArray[np.float64]
E_STAR = 115e3
LOAD = 100.0
TOLERANCE = 1e-8
Case = tuple[str, Array, tuple[float, float], dict[str, Any], str, Callable[[ContactSolution], float]]


def centred(n: int, width: float) -> Array:
    """Centres of n cells around zero."""
    return (np.arange(n) - (n - 1) / 2.0) * width


def ellipse(cells: tuple[int, int], small: float, box: float = 3.0) -> tuple[Array, tuple[float, float], Any]:
    """Gap, spacing and Hertz contact of a paraboloid of the curvatures 0.1 and ``small``."""
    contact = hertz.point_contact(LOAD, (0.1, small), E_STAR)
    spacing = (box * contact.semi_minor / cells[0], box * contact.semi_major / cells[1])
    x, y = (centred(n, width) for n, width in zip(cells, spacing, strict=True))
    return 0.05 * x[:, None] ** 2 + 0.5 * small * y**2, spacing, contact


def point_contacts() -> Iterator[Case]:
    """Contacts that Hertz answers: slender cells, offsets, bad starts, light loads."""
    for ratio, small in ((1, 0.1), (100, 4.9893e-5), (1000, 7.29452e-7)):
        gap, spacing, contact = ellipse((48, 96), small)
        approach = contact.approach
        yield (
            f"ellipse {ratio}:1, 48 x 96 cells",
            gap,
            spacing,
            {"load": LOAD},
            "approach",
            lambda s, a=approach: s.approach / a - 1.0,
        )
    gap, spacing, contact = ellipse((51 * 24, 24), 0.1)
    yield "circle, dy/dx = 51", gap, spacing, {"load": LOAD}, "approach", lambda s: s.approach / contact.approach - 1.0
    gap, spacing, circle = ellipse((64, 64), 0.1)
    four = 1e-9 * LOAD / (4.0 * spacing[0] * spacing[1])
    peak = lambda s: s.peak_pressure / circle.max_pressure - 1.0  # noqa: E731
    yield (
        "load x 1e-9: four cells",
        gap,
        spacing,
        {"load": 1e-9 * LOAD},
        "pressure",
        lambda s: s.pressure.max() / four - 1,
    )
    yield "load x 1e3: whole box", gap, spacing, {"load": 1e3 * LOAD}, "conditions", lambda s: s.residual
    yield "gap + 1e6 mm", gap + 1e6, spacing, {"load": LOAD}, "peak", peak
    for name, place in (("one cell", (30, 30)), ("a far corner", (0, 0))):
        start = np.zeros_like(gap)
        start[place] = 1.0
        yield f"start from {name}", gap, spacing, {"load": LOAD, "initial_pressure": start}, "peak", peak
    asperity, spacing, _ = ellipse((256, 256), 0.1, box=6.0)
    asperity[5, 5] = -2e-4
    yield "far asperity of one cell", asperity, spacing, {"load": LOAD}, "conditions", lambda s: s.residual


def capped_contacts() -> Iterator[Case]:
    """A cap on the pressure, up to a surface that is nearly full."""
    gap, spacing, contact = ellipse((64, 64), 0.1)
    for share in (0.9, 0.5, 0.3):
        cap = share * contact.max_pressure
        options = {"load": LOAD, "max_pressure": cap}
        yield f"cap {share} p0", gap, spacing, options, "cap", lambda s, c=cap: s.pressure.max() / c - 1.0
    area = gap.size * spacing[0] * spacing[1]
    for filled in (0.9, 0.99, 0.9999):
        options = {"load": filled * area * 100.0, "max_pressure": 100.0}
        name = f"cap, F = {filled} p_Y A"
        yield name, gap, spacing, options, "load", lambda s, f=filled: s.pressure.mean() / (100.0 * f) - 1.0


def other_contacts() -> Iterator[Case]:
    """Cylinder through the box, two patches, profiles r^n, punches, roughness."""
    n = 128
    gap = np.repeat(0.01 * centred(n, 10.0 / n)[:, None] ** 2, n, axis=1)
    yield (
        "cylinder through the box",
        gap,
        (10.0 / n, 40.0 / n),
        {"load": 40.0 * math.pi * E_STAR * 0.01},
        "middle, 1515 MPa",
        lambda s: s.pressure[:, 64].max() / 1515.0 - 1.0,
    )
    x, y = centred(512, 6.0 / 512)[:, None], centred(256, 6.0 / 512)
    gap = np.minimum((x - 1.5) ** 2 + y**2, (x + 1.5) ** 2 + y**2 + 0.015) / 50.0
    yield (
        "two patches",
        gap,
        (6.0 / 512,) * 2,
        {"load": 60.0},
        "share of the first, 0.60094",
        lambda s: s.pressure[256:].sum() / s.pressure.sum() / 0.60094 - 1.0,
    )
    radius = np.hypot(centred(n, 3.0 / n)[:, None], centred(n, 3.0 / n))
    for name, coefficient, exponent in (("profile r^8", 1e-3, 8.0), ("cone", 0.01, 1.0)):
        found = punch.power_law(1.0, coefficient, exponent, E_STAR)
        compare = lambda s, a=found.approach: s.approach / a - 1.0  # noqa: E731
        yield name, coefficient * radius**exponent, (3.0 / n,) * 2, {"load": found.load}, "approach", compare
    flat = punch.flat_circular(LOAD, 1.0, E_STAR).approach
    for outside in (math.inf, 1e30):
        gap = np.where(radius < 1.0, 0.0, outside)
        name = f"flat circular punch, {outside:g} outside"
        yield name, gap, (3.0 / n,) * 2, {"load": LOAD}, "approach", lambda s: s.approach / flat - 1.0
    square = LOAD / (punch.SQUARE_PUNCH * E_STAR)
    gap = np.zeros((n, n))
    yield (
        "flat square punch, whole box",
        gap,
        (1.0 / n,) * 2,
        {"load": LOAD},
        "approach",
        lambda s: s.approach / square - 1,
    )
    noise = np.random.default_rng(1).random((256, 256)) * 1e-3
    yield "white noise", noise, (4.0 / 256,) * 2, {"load": LOAD}, "conditions", lambda s: s.residual
    yield (
        "one row of cells",
        0.05 * y[None, :] ** 2,
        (0.01, 6.0 / 512),
        {"load": 1.0},
        "conditions",
        lambda s: s.residual,
    )


def main() -> None:
    """Print the table."""
    rows = []
    for name, gap, spacing, options, compared, error in (*point_contacts(), *capped_contacts(), *other_contacts()):
        found = solve_contact(gap, spacing, E_STAR, tolerance=TOLERANCE, warn=False, **options)
        counts = f"{found.iterations} | {found.convolutions}"
        rows.append(f"{name} | {compared} | {counts} | {found.residual:.0e} | {error(found):+.0e}")
    print(table("case | compared | iterations | convolutions | residual | error", rows))


if __name__ == "__main__":
    main()
