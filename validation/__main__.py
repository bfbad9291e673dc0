"""Run every comparison and print one table: ``python -m validation``; exit code 1 if a row fails.

The cases run in two processes, the longest first; how far they are goes to the error output. The table has a fixed
order, whichever case ends first; below it stand the seconds of each. A case that raises becomes one row that fails and
has the error; its traceback goes to the error output, and the other cases are run.

``--save rows.json`` keeps the numbers, ``--compare rows.json`` tells which have moved since: what a change of the code
did to them. Cases that are named run alone.

Cases that compare the package with itself (finer grids, invariances, differences of analyses) have one scene of each
kind in the table; ``--whole`` runs them on all their scenes, grids and seeds, which takes three times as long.
"""

import argparse
import json
import sys
import time
from dataclasses import asdict
from pathlib import Path

from validation.cases import run_cases, times
from validation.table import Row, moved, render

CASES = (
    "loaded.error_estimates",
    "contact.sphere",
    "cylindrical.sam_paper",
    "unloaded.reduced_tca_misalignment",
    "unloaded.reduced_tca_tables",
    "unloaded.convergence_from_random_starts",
    "bevel.convergence",
    "unloaded.mounting_errors",
    "bevel.mounting_errors",
    "bevel.miter_gear_paper",
    "bevel.pressure",
    "unloaded.involute_pairs",
    "unloaded.internal_pairs",
    "cylindrical.line_contact",
    "cylindrical.nrel_planet_ring",
    "cylindrical.internal_hertz",
    "cylindrical.rack",
    "stages.planetary",
    "cylindrical.double_helical",
    "cylindrical.fzg_c14_geometry",
    "cylindrical.fzg_c14_root_stress",
    "tribology.published",
    "rating.strength",
    "rating.rings",
    "rating.stages",
    "rating.solved",
    "rating.iso_tr_10300_30",
    "rating.bevel_solved",
    "rating.spectra",
    "rating.stage_spectra",
    "bevel.iso_23509_sample",
    "face_milled.settings",
    "face_milled.swept_cutter",
    "face_milled.duplex_paper",
    "face_milled.hypoid_pair",
    "face_milled.synthesis",
    "face_milled.measured_settings",
    "cylindrical.iso_tr_6336_30",
    "cylindrical.nrel_5mw_stage_3",
    "cylindrical.metric_gear_technology",
    "cylindrical.undercut",
    "cylindrical.inches",
    "loaded.limits",
    "loaded.revolution",
    "loaded.rolling_bearings",
    "loaded.cut_contacts",
    "loaded.mesh_stiffness",
    "loaded.local_term",
    "loaded.ring_teeth",
    "loaded.internal_cycle",
    "loaded.root_stress",
    "loaded.root_stress_cycle",
    "loaded.root_stress_space",
    "loaded.root_stress_precision",
    "loaded.root_face_load",
    "loaded.face_ends_space",
    "loaded.numbers_to_copy",
    "loaded.rounded_ends",
    "calculix.mesh_cycle",
    "calculix.helical_relief",
    "contact.subsurface",
    "contact.free_edge",
    "contact.free_block",
    "contact.wedge",
    "contact.rounded_edge",
    "contact.rounded_ends",
    "calculix.rounded_tip",
)

LONG = (
    "loaded.sensitivities",
    "loaded.jumps",
    "loaded.rounded_edges",
    "studies.robust_design",
    "loaded.random_sensitivities",
    "rating.speed",
    "loaded.moving_edges",
    "loaded.random_scenes",
    "loaded.root_stress_families",
    "unloaded.rounded_edges",
    "loaded.bending_line",
    "loaded.face_ends",
)
"""Dear cases, which the tests leave out; the longest first.

Of other cases the tests have the ``short_rows``, where a module has them.
"""


def main() -> int:
    """Print the table; 0 if every row holds."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__.partition("\n\n")[0])
    parser.add_argument("cases", nargs="*", metavar="CASE", help="cases such as contact.sphere; default: all")
    parser.add_argument("--save", metavar="FILE", type=Path, help="keep the rows as JSON")
    parser.add_argument("--compare", metavar="FILE", type=Path, help="list the rows that differ from kept ones")
    parser.add_argument("--processes", metavar="N", type=int, default=2, help="cases that run at a time (default: 2)")
    parser.add_argument(
        "--whole",
        action="store_const",
        const="whole_rows",
        default="rows",
        help="every scene, grid and seed of cases that compare the package with itself: three times as long",
    )
    options = parser.parse_args()
    if options.processes < 1:
        parser.error(f"--processes: {options.processes} is not positive")
    if unknown := [case for case in options.cases if case not in (*CASES, *LONG)]:
        parser.error(f"no case {', '.join(unknown)}; there are {', '.join((*CASES, *LONG))}")
    wanted = options.cases or (*CASES, *LONG)
    start = time.perf_counter()
    outcomes = run_cases(sorted(wanted, key=lambda case: case not in LONG), options.processes, options.whole)
    rows = [row for case in wanted for row in outcomes[case].rows]
    print(render(rows))
    print(f"\n{times(outcomes)}")
    failed = sum(not row.holds for row in rows)
    shown = sum(row.tolerance is None for row in rows)
    seconds = f"{time.perf_counter() - start:.0f} s"
    print(f"\n{len(rows)} rows, {failed} beyond the tolerance; {shown} shown without a verdict; {seconds}")
    if options.save:
        options.save.write_text(json.dumps([asdict(row) for row in rows], indent=1, ensure_ascii=False) + "\n")
    if options.compare:
        print("\n".join(moved(rows, [Row(**row) for row in json.loads(options.compare.read_text())])))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
