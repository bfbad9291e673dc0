"""A study that does not come to its end: ``python endless.py FOLDER``."""

import sys
from pathlib import Path

from loaded_tca.studies import process_pool, run_study
from tests.samples.figures import endless
from tests.samples.studies import in_folder

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    with process_pool(2) as pool:
        run_study(in_folder(folder, *range(1, 100)), pool, folder / "study.nc", figures=endless)
