"""Run every comparison and print one table: ``python -m validation``; exit code 1 if a row fails.

A case that raises becomes one row that fails and tells the error; its traceback goes to the error output, and the other
cases are run.

``--save rows.json`` keeps the numbers, ``--compare rows.json`` tells which have moved since: what a change of the code
did to them.
"""

import argparse
import json
import sys
import traceback
from collections.abc import Sequence
from dataclasses import asdict
from importlib import import_module
from math import nan
from pathlib import Path
from textwrap import shorten

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
    "cylindrical.fzg_c14_root_stress",
    "bevel.iso_23509_sample",
    "face_milled.settings",
    "face_milled.swept_cutter",
    "face_milled.duplex_paper",
    "cylindrical.iso_tr_6336_30",
    "loaded.limits",
    "loaded.cut_contacts",
    "loaded.mesh_stiffness",
    "loaded.bending_line",
    "loaded.local_term",
    "loaded.root_stress",
    "loaded.root_stress_cycle",
    "loaded.root_stress_space",
    "loaded.root_face_load",
    "loaded.numbers_to_copy",
    "calculix.mesh_cycle",
    "contact.subsurface",
    "contact.free_edge",
    "contact.free_block",
    "contact.wedge",
    "contact.rounded_edge",
    "calculix.rounded_tip",
)


LONG = (
    "loaded.root_stress_families",
    "loaded.sensitivities",
    "loaded.rounded_edges",
    "studies.robust_design",
    "unloaded.rounded_edges",
)
"""Cases of minutes, which the tests leave out."""


def collect(cases: Sequence[str] | None = None) -> list[Row]:
    """Rows of cases in their order, of ``CASES`` by default; one that fails for a case that raises."""
    rows: list[Row] = []
    for case in CASES if cases is None else cases:
        try:
            rows += import_module(f"validation.{case}").rows()
        except Exception as error:  # whatever a case raises is a result of that case
            traceback.print_exc()
            told = shorten(f"raised {type(error).__name__}: {error}", 120)
            rows.append(Row(case, f"validation.{case}", told, 0.0, nan, 0.0))
    return rows


def main() -> int:
    """Print the table; 0 if every row holds."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__.partition("\n\n")[0])
    parser.add_argument("--save", metavar="FILE", type=Path, help="keep the rows as JSON")
    parser.add_argument("--compare", metavar="FILE", type=Path, help="list the rows that differ from kept ones")
    options = parser.parse_args()
    rows = collect((*CASES, *LONG))
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
