"""Tables of a study: every figure of every variant, and the variants in the order of a figure."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from loaded_tca.results.files import Buffer, FilePath, replace_together
from loaded_tca.studies.ranking import main_figures, rank_variants, varied_keys

if TYPE_CHECKING:
    import xarray

TABLE, RANKING, PICTURES = "study.csv", "ranking.csv", "study_*.png"
"""Names of the two files and of the pictures."""


def write_study(
    study: xarray.Dataset,
    directory: FilePath,
    more: Mapping[str, Buffer] = {},
    rank_by: str | None = None,
    largest_is_best: bool = False,
) -> tuple[Path, ...]:
    """Write ``study.csv`` and ``ranking.csv``, all files or none.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    directory : str or path
        Made if it does not exist. Pictures ``study_*.png`` of an earlier study that are not written again are removed.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the study.
    rank_by, largest_is_best
        As for :func:`loaded_tca.studies.rank_variants`.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written, or the study has figures, but not ``rank_by``.
    """
    by = rank_by if main_figures(study) else None  # where all variants were refused there is nothing to rank by
    ranking = rank_variants(study, by, largest_is_best=largest_is_best).to_csv(index=False)
    contents = {TABLE: study_csv(study).encode(), RANKING: ranking.encode(), **more}
    old = {path.name for path in Path(directory).glob(PICTURES)} - {*contents}
    return replace_together(directory, contents, old)


def study_csv(study: xarray.Dataset) -> str:
    """Return every figure as CSV, one row per variant and torque, the varied keys first.

    Variants and torques are numbered from 0. Columns of whole numbers, as counts are, have no decimals.
    """
    order = [name for name in ("sample", "torque") if name in study.sizes]  # no torque where no variant is ok
    frame = study.drop_vars("torque", errors="ignore").to_dataframe(order).reset_index()
    for name in study.data_vars:
        known = frame[name].dropna()
        if known.dtype.kind == "f" and (known.abs() < 2**53).all() and (known % 1 == 0).all():
            frame[name] = frame[name].astype("Int64")
    table: str = frame[list(dict.fromkeys([*order, *varied_keys(study), *frame]))].to_csv(index=False)
    return table
