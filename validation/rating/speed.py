"""Processor time of a rating under 500 bins, beside that of the analysis of its dozen torques.

The stage of an electric drive of ``rating.spectra`` as its file has it, on grids of 64 x 64 cells, with root stress and
nine positions, or 33 of the whole table. Rows have no verdict, times differ from machine to machine: analysis and first
rating over the analysis, which is to be below 2, and a further rating, which is to be below 50 ms, as the median of
nine.
"""

from statistics import median
from time import process_time

from loaded_tca import analyse
from loaded_tca.errors import noted_accuracy_warnings
from validation.rating.spectra import scene
from validation.table import Row

POSITIONS, WHOLE_POSITIONS = 9, 33
CHANGES = {"analysis.cells": (64, 64), "analysis.root_stress": True}
RATINGS = 9


def rows() -> list[Row]:
    """Both of few positions."""
    return _rows(POSITIONS)


def whole_rows() -> list[Row]:
    """Both of the positions that the guide tells of."""
    return _rows(WHOLE_POSITIONS)


def _rows(positions: int) -> list[Row]:
    with noted_accuracy_warnings(given=False):  # contacts reach edges
        begin = process_time()
        result = analyse(scene().with_changes({**CHANGES, "analysis.positions": positions}))
        solved = process_time()
        result.rating()
        rated, further = process_time(), []
        for _ in range(RATINGS):
            start = process_time()
            result.rating()
            further.append(process_time() - start)
    case = f"EV stage, 500 bins, {positions} positions"
    ratio = "processor time of analysis and rating over the analysis"
    note = f"analysis {solved - begin:.0f} s, first rating {rated - solved:.2f} s"
    return [
        Row(case, "below 2", ratio, 2.0, (rated - begin) / (solved - begin), None, note=note),
        Row(case, "below 50 ms", "processor time of a further rating [s]", 0.05, median(further), None),
    ]
