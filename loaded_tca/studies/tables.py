"""Tables of a study as a frame of pandas, in CSV files and in a workbook of Excel."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from loaded_tca.arguments import checked
from loaded_tca.errors import require
from loaded_tca.results.files import STUDY, FilePath, replace_file
from loaded_tca.results.tables import frame_of, require_openpyxl, sentences_table, workbook_of
from loaded_tca.results.warnings import without_place
from loaded_tca.studies.ranking import ranking, varied_keys
from loaded_tca.studies.stage import subject_of

if TYPE_CHECKING:
    import pandas
    import xarray


def to_pandas(study: xarray.Dataset) -> pandas.DataFrame:
    """Return a study as a frame, a row for each variant and torque, with the columns of ``study.csv``.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.

    Returns
    -------
    pandas.DataFrame
        The varied keys first, then the key figures, whose names end in their units, ``status``, ``reason``,
        ``warnings``. Its index: ``sample``, variants numbered from 0, and ``torque_Nm``, or where variants have
        different torques ``torque_number``, counted from 0; variants alone where none is ok. NaN: not known.
        Columns of whole numbers, as counts are, are of type Int64.

    Raises
    ------
    InputError
        If it is no study.
    """
    _require_study(study)
    order = [name for name in ("sample", "torque") if name in study.sizes]  # no torque where no variant is ok
    frame = study.to_dataframe(order)
    if "torque" in study.coords:
        frame = frame.rename(index=lambda torque: torque / 1e3, level="torque")
    frame = frame.rename_axis(index={"torque": "torque_Nm" if "torque" in study.coords else "torque_number"})
    for name in study.data_vars:
        known = frame[name].dropna()
        if known.dtype.kind == "f" and (known.abs() < 2**53).all() and (known % 1 == 0).all():
            frame[name] = frame[name].astype("Int64")
    keys = varied_keys(study)
    return frame[[*keys, *(name for name in frame if name not in keys)]]


@checked
def to_excel(study: xarray.Dataset, path: FilePath) -> Path:
    """Write a study into a workbook of Excel, whole or not at all, with the units in the heads.

    Its sheets: ``variants``, as :func:`to_pandas` has them, ``ranking``, the variants in the order of the default
    figure, with distributions the designs (:func:`loaded_tca.studies.rank_combinations`), and ``warnings`` with the
    number of variants that each concerns.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    path : str or path
        Of the workbook; ends in .xlsx.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If it is no study, the package openpyxl is not installed (extra ``excel``), the path has another ending, there
        are more rows than a sheet takes, or the file cannot be written.
    """
    require_openpyxl(path)
    variants, places = to_pandas(study), ranking(study)
    counted = Counter(
        line for lines in study["warnings"].values.tolist() for line in {*map(without_place, lines.splitlines())}
    )
    of_variants = f" of {study.sizes['sample']} variants)"
    warned = [f"{sentence} ({count}{of_variants}" for sentence, count in counted.most_common()]
    sheets = {"variants": variants, "ranking": places, "warnings": frame_of(sentences_table({"warning": warned}))}
    title = subject_of(study).title or "Study"
    about = f"a study of {study.sizes['sample']} variants; loaded_tca {study.attrs.get('version', '')}".rstrip()
    replace_file(path, workbook_of(sheets, title, about))
    return Path(path)


def _require_study(study: xarray.Dataset) -> None:
    is_study = getattr(study, "attrs", {}).get("kind") == STUDY
    require((is_study, f"study: found a {type(study).__name__}; allowed what run_study or load_study returns"))
