"""Files of a comparison of results: its key figures as a table and with the differing keys of the scenes as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from loaded_tca.output.report import cell, csv_table, known
from loaded_tca.results.comparison import Comparison
from loaded_tca.results.files import Buffer, FilePath, replace_together

TABLE, ALL = "comparison.csv", "comparison.json"
"""Names of the two files."""


def write_comparison(comparison: Comparison, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write ``comparison.csv`` and ``comparison.json``, all files or none.

    Parameters
    ----------
    comparison : Comparison
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the same results.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = {TABLE: _table(comparison), ALL: _json(comparison)}
    return replace_together(directory, {**{name: text.encode() for name, text in texts.items()}, **more})


def _table(comparison: Comparison) -> str:
    """One row per torque and key figure, columns for each result."""
    figures = comparison.figures
    rows = [(torque, name) for torque in figures.torque.values for name in figures.figure.values]
    columns: dict[str, list[str]] = {
        "pinion_torque_Nm": [cell(1e-3 * torque, "torque") for torque, _ in rows],
        "figure": [name for _, name in rows],
    }
    for k, result in enumerate(comparison.results):
        for part in figures.data_vars if k else ("value",):
            values = figures[part].values[..., k].ravel()
            columns[f"{result}: {part}"] = [cell(value, name) for value, (_, name) in zip(values, rows, strict=True)]
    return csv_table(columns)


def _json(comparison: Comparison) -> str:
    """Differing keys of the scenes, and the figures of each torque by their names and those of the results."""
    figures, names = comparison.figures, list(comparison.results)
    parts = {name: values.values for name, values in figures.data_vars.items()}

    def told(torque: int, index: int, figure: str) -> dict[str, dict[str, float | None]]:
        rows = {part: zip(names, values[torque, index].tolist(), strict=True) for part, values in parts.items()}
        return {
            str(part): {name: known(value, figure) for name, value in row if part == "value" or name != names[0]}
            for part, row in rows.items()
        }

    content = {
        "compared_with": names[0],
        "titles": {name: result.scene.title for name, result in comparison.results.items()},
        "loaded_tca_versions": {name: result.version for name, result in comparison.results.items()},
        "differing_keys": {
            key: dict(zip(names, values, strict=True)) for key, values in comparison.differing_keys.items()
        },
        "torques": [
            {
                "pinion_torque_Nm": 1e-3 * float(torque),
                "figures": {
                    figure: told(k, index, figure) for index, figure in enumerate(figures.figure.values.tolist())
                },
            }
            for k, torque in enumerate(comparison.torque)
        ],
    }
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
