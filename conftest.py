"""What every test and example shares: no model of a gear body is kept on disk, or taken from there.

Of several workers, each has one thread of BLAS: more would wait for each other on cores that all of them fill. Compiled
modules are kept, whatever the environment says: dozens of tests start processes, which would each compile the package.
"""

import os

os.environ["LOADED_TCA_CACHE"] = "off"
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
if int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")) > 1:  # read when BLAS is loaded, by numpy
    os.environ.setdefault("OMP_NUM_THREADS", "1")
