"""Files of a planetary stage: the result with both mesh cycles, its figures, a table of positions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from loaded_tca.output.result_files import csv_table, json_text, known
from loaded_tca.results.files import Buffer, FilePath, replace_together
from loaded_tca.stages import StageResult


def write_stage(result: StageResult, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write a stage, its figures and its table, all files or none.

    Parameters
    ----------
    result : StageResult
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.

    Returns
    -------
    tuple of Path
        ``stage.nc``, ``sun_mesh.nc``, ``ring_mesh.nc``, ``stage.json``, ``stage.csv``, and those of ``more``.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    tables = {"stage.json": stage_json(result).encode(), "stage.csv": csv_table(result.to_table()).encode()}
    return replace_together(directory, {**result.contents(), **tables, **more})


def stage_json(result: StageResult) -> str:
    """Return the figures of each torque, phases and orders as JSON, null where a figure is not known."""
    rows = [{name: known(value, name) for name, value in figures.items()} for figures in result.key_figures()]
    orders = [
        {
            "order": one.order,
            "stage_um": one.stage,
            "one_path_um": one.one_path,
            "cancelled_in_torsion": one.torsion_cancels,
            "cancelled_in_translation": one.translation_cancels,
        }
        for one in result.orders()
    ]
    content = {
        "title": result.stage.title,
        "sun_mesh_phase": result.sun_mesh_phase.tolist(),
        "ring_mesh_phase": result.ring_mesh_phase.tolist(),
        "torques": rows,
        "orders_under_the_last_torque": orders,
        "findings": list(result.findings()),
        "warnings": list(result.warnings),
    }
    return json_text(content)
