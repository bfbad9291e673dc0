"""A study by processes of MPI: ``mpiexec -n 3 python -m mpi4py.futures on_mpi.py OUT``."""

import sys

from mpi4py.futures import MPIPoolExecutor

from loaded_tca.studies import run_study
from tests.samples.studies import unlike_variants

if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        run_study(unlike_variants(), executor, sys.argv[1])
