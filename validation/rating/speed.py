"""Processor time of a rating under 500 bins, beside that of the analysis of its dozen torques.

The stage of an electric drive of ``rating.spectra`` as its file has it, on grids of 64 x 64 cells, with root stress and
33 positions. Rows have no verdict, times differ from machine to machine: the whole of analysis and first rating over
the analysis, which is to be below 2, and a further rating, which is to be below 50 ms, as the median of nine.
"""

from statistics import median
from time import process_time

from loaded_tca import analyse
from loaded_tca.errors import noted_accuracy_warnings
from validation.rating.spectra import scene
from validation.table import Row

CASE = "EV stage, 500 bins, 33 positions"
WHOLE = {"analysis.positions": 33, "analysis.cells": (64, 64), "analysis.root_stress": True}
RATINGS = 9


def rows() -> list[Row]:
    """Measure both."""
    with noted_accuracy_warnings(given=False):  # contacts reach edges
        begin = process_time()
        result = analyse(scene().with_changes(WHOLE))
        solved = process_time()
        result.rating()
        rated, further = process_time(), []
        for _ in range(RATINGS):
            start = process_time()
            result.rating()
            further.append(process_time() - start)
    ratio = "processor time of analysis and rating over the analysis"
    note = f"analysis {solved - begin:.0f} s, first rating {rated - solved:.2f} s"
    return [
        Row(CASE, "below 2", ratio, 2.0, (rated - begin) / (solved - begin), None, note=note),
        Row(CASE, "below 50 ms", "processor time of a further rating [s]", 0.05, median(further), None),
    ]
