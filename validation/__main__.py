"""Run every comparison and print one table: ``python -m validation``; exit code 1 if a row fails."""

import sys
from importlib import import_module

from validation.table import Row, render

CASES = (
    "sphere",
    "seed_002_crowned_pairs",
    "seed_000_misalignment",
    "seed_000_tables",
    "convergence_from_random_starts",
    "bevel_convergence",
    "mounting_errors",
    "mounting_error_map",
    "bevel_mounting_errors",
    "seed_001_pair",
    "bevel_pressure",
    "involute_pairs",
    "line_contact",
    "fzg_c14_geometry",
    "iso_23509_sample",
    "face_milled_settings",
    "seed_004_start",
    "iso_tr_6336_30",
    "mesh_cycle_limits",
    "mesh_cycle_fem",
    "subsurface",
    "free_edge",
    "wedge",
)


def collect() -> list[Row]:
    """Rows of all cases, in the order of ``CASES``."""
    return [row for case in CASES for row in import_module(f"validation.{case}").rows()]


def main() -> int:
    """Print the table; 0 if every row holds."""
    rows = collect()
    print(render(rows))
    failed = sum(not row.holds for row in rows)
    print(f"\n{len(rows)} rows, {failed} beyond the tolerance")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
