"""Run the whole set and keep its numbers: ``python -m validation.calculix [--work DIRECTORY] [--every 2]``."""

import argparse
import sys
from pathlib import Path

from validation.calculix.campaign import run_all
from validation.calculix.keep import keep_cycles, keep_in_space, keep_rings, keep_roots, keep_study
from validation.calculix.rounded_tip import keep as keep_rounded_tip
from validation.calculix.run import program_version


def main() -> int:
    """Run what is not there yet and write the tables."""
    parser = argparse.ArgumentParser(prog="python -m validation.calculix", description=__doc__)
    parser.add_argument("--work", type=Path, default=Path("reference-fem-runs"), help="directory of the runs")
    parser.add_argument("--every", type=int, choices=(1, 2), default=1, help="2: every second position alone")
    asked = parser.parse_args()
    work = asked.work
    program = program_version()
    keep_study(program, work)
    keep_in_space(program, work)
    keep_rounded_tip(work)
    keep_cycles(program, run_all(work, asked.every))
    keep_roots(program, work)
    keep_rings(program, work)
    return 0


if __name__ == "__main__":
    sys.exit(main())
