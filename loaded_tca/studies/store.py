"""The result of a study: the rows of its variants as a dataset, and the file that holds it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.results.files import FilePath, read_dataset
from loaded_tca.scene.text import literal
from loaded_tca.studies.rows import Row
from loaded_tca.studies.study import Study, told_distribution

if TYPE_CHECKING:
    import xarray

KIND = "study"


def dataset_of(study: Study, rows: Iterable[Row], attributes: dict[str, Any]) -> xarray.Dataset:
    """Gather the rows of all variants, in their order.

    Parameters
    ----------
    study : Study
    rows : iterable of Row
        Of all variants; read one by one.
    attributes : dict

    Returns
    -------
    xarray.Dataset
        Dimensions sample (the number of the variant) and torque [N mm], which has a coordinate where all variants have
        the same. Over both the key figures, NaN where there are none; over the samples the varied
        keys (coordinates, with the attribute ``sampling``: "table", "factor" or "distribution", and of the last one
        ``distribution``: its name and parameters), ``status``, ``reason``, ``warnings`` (lines) and ``seconds``.
    """
    import xarray

    count = len(study)
    texts: dict[str, list[str]] = {"status": [], "reason": [], "warnings": []}
    same: dict[str, str] = {}  # many variants say the same: one text in memory for all
    seconds = np.empty(count)
    found: dict[str, Array] = {}
    torques = 1
    for sample, row in enumerate(rows):
        told = row["status"], row["reason"], "\n".join(row["warnings"])
        for column, text in zip(texts.values(), told, strict=True):
            column.append(same.setdefault(text, text))
        seconds[sample] = row["seconds"]
        for name, values in row["figures"].items():
            if len(values) > torques:
                torques = len(values)
                found = {known: _widened(array, torques) for known, array in found.items()}
            array = found.setdefault(name, np.full((count, torques), np.nan))
            array[sample, : len(values)] = values
    variables = {name: (("sample", "torque"), array) for name, array in found.items()}
    own = {name: ("sample", np.array(column, dtype=object)) for name, column in texts.items()}
    spent = ("sample", seconds, {"units": "s", "long_name": "time of the analysis"})
    places = {"sample": ("sample", np.arange(count, dtype=np.int32))}
    torque = 1e3 * found.get("pinion_torque_Nm", np.full((1, torques), np.nan))
    known = torque[np.isfinite(torque).all(axis=1)]
    if len(known) and (known == known[0]).all():  # the same in all variants
        places["torque"] = ("torque", known[0])
    return xarray.Dataset(
        {**variables, **own, "seconds": spent}, coords={**places, **_varied(study)}, attrs={"kind": KIND, **attributes}
    )


def _widened(array: Array, torques: int) -> Array:
    """The array with room for more torques."""
    return np.pad(array, ((0, 0), (0, torques - array.shape[1])), constant_values=np.nan)


def _varied(study: Study) -> dict[str, tuple[str, Array, dict[str, str]]]:
    """Values of the varied keys over the samples; lists and booleans as a scene file writes them."""
    columns: dict[str, list[Any]] = {key: [] for key in study.keys}
    for variant in range(len(study)):
        for key, value in study.changes(variant).items():
            plain = isinstance(value, int | float | str) and not isinstance(value, bool)
            columns[key].append(value if plain else literal(value))
    ways = [("table", study.table), ("factor", study.factors), ("distribution", study.distributions)]
    sampling = {key: {"sampling": way} for way, keys in ways for key in keys}
    for key, distribution in study.distributions.items():
        sampling[key]["distribution"] = told_distribution(distribution)
    return {key: ("sample", np.array(column), sampling[key]) for key, column in columns.items()}


def load_study(path: FilePath) -> xarray.Dataset:
    """Read the result of a study.

    Parameters
    ----------
    path : str or path
        File that ``run_study`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, or is no study.
    """
    dataset = read_dataset(path)
    if dataset.attrs.get("kind") != KIND:
        raise InputError(f"{path}: a result of loaded_tca, but no study; read it with load_result")
    return dataset
