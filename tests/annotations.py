"""Check the annotations of the package by mypy, whose memory is given back at its end alone.

Run from the root of the repository: ``python -m tests.annotations [ARGUMENT OF mypy ...]``. The collector of garbage
would walk all syntax trees again and again, for a quarter of the processor time of a check without a cache; without it
mypy takes 1.6 GB.
"""

import gc

from mypy.__main__ import console_entry

if __name__ == "__main__":
    gc.disable()
    gc.enable = gc.disable  # which mypy calls when it has read its cache
    console_entry()
