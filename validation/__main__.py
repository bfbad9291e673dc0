"""Run every comparison and print one table: ``python -m validation``; exit code 1 if a row fails.

``--save rows.json`` keeps the numbers, ``--compare rows.json`` tells which have moved since: what a change of the code
did to them.
"""

import argparse
import json
import sys
from dataclasses import asdict
from importlib import import_module
from pathlib import Path

from validation.table import Row, moved, render

CASES = (
    "contact.sphere",
    "cylindrical.sam_paper",
    "unloaded.reduced_tca_misalignment",
    "unloaded.reduced_tca_tables",
    "unloaded.convergence_from_random_starts",
    "bevel.convergence",
    "unloaded.mounting_errors",
    "unloaded.mounting_error_map",
    "bevel.mounting_errors",
    "bevel.miter_gear_paper",
    "bevel.pressure",
    "unloaded.involute_pairs",
    "cylindrical.line_contact",
    "cylindrical.fzg_c14_geometry",
    "bevel.iso_23509_sample",
    "face_milled.settings",
    "face_milled.duplex_paper",
    "cylindrical.iso_tr_6336_30",
    "loaded.limits",
    "calculix.mesh_cycle",
    "contact.subsurface",
    "contact.free_edge",
    "contact.wedge",
)


def collect() -> list[Row]:
    """Rows of all cases, in the order of ``CASES``."""
    return [row for case in CASES for row in import_module(f"validation.{case}").rows()]


def main() -> int:
    """Print the table; 0 if every row holds."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__.partition("\n\n")[0])
    parser.add_argument("--save", metavar="FILE", type=Path, help="keep the rows as JSON")
    parser.add_argument("--compare", metavar="FILE", type=Path, help="list the rows that differ from kept ones")
    options = parser.parse_args()
    rows = collect()
    print(render(rows))
    failed = sum(not row.holds for row in rows)
    shown = sum(row.tolerance is None for row in rows)
    print(f"\n{len(rows)} rows, {failed} beyond the tolerance; {shown} shown without a verdict")
    if options.save:
        options.save.write_text(json.dumps([asdict(row) for row in rows], indent=1, ensure_ascii=False) + "\n")
    if options.compare:
        print("\n".join(moved(rows, [Row(**row) for row in json.loads(options.compare.read_text())])))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
