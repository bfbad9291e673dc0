"""What every test and example shares: models of gear bodies are made once in a session, and none is taken from before.

Their folder is removed at the end of the session; its workers share it. Of several workers, each has one thread of
BLAS: more would wait for each other on cores that all of them fill. Compiled modules are kept, whatever the environment
says: dozens of tests start processes, which would each compile the package.
"""

import atexit
import os
import shutil
import sys
import tempfile

if "PYTEST_XDIST_WORKER" not in os.environ:  # workers inherit the folder of the session
    os.environ["LOADED_TCA_CACHE"] = tempfile.mkdtemp(prefix="loaded_tca-models-")
    atexit.register(shutil.rmtree, os.environ["LOADED_TCA_CACHE"], ignore_errors=True)
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
os.environ["LOADED_TCA_JOBS"] = "1"
if int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")) > 1:  # read when BLAS is loaded, by numpy
    os.environ.setdefault("OMP_NUM_THREADS", "1")
