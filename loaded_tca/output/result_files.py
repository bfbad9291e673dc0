"""What an analysis leaves behind: the whole result, its key figures, tables of the positions and of all contacts."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loaded_tca.arguments import checked
from loaded_tca.results.files import Buffer, FilePath, replace_together
from loaded_tca.results.summary import known, without_rounding
from loaded_tca.results.tables import contacts_table, positions_table

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from loaded_tca.results.mesh_cycle import MeshCycle
    from loaded_tca.results.result import Result

RESULT, SUMMARY, POSITIONS, CONTACTS = "result.nc", "summary.json", "positions.csv", "contacts.csv"
"""Names of the files; the last one is there only where tooth pairs share the load."""


@checked
def write_result(
    result: Result, directory: FilePath, more: Mapping[str, Buffer] = {}, outdated: Iterable[str] = ()
) -> tuple[Path, ...]:
    """Write the files of a result that is no mesh cycle, its key figures and its tables, all files or none.

    Parameters
    ----------
    result : Revolution, StageResult, Tribology, Rating or another kind
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.
    outdated : iterable of str
        Names of files of an older result to remove where this one has none of that name, as those of its rating.

    Returns
    -------
    tuple of Path
        ``revolution.nc``, ``stage.nc`` ... with the files of its parts, ``.json`` with the key figures of each torque,
        ``.csv`` of each table that it has, and those of ``more``. What is not known is null in JSON, as is a life that
        does not end, which is inf in CSV.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = {result.JSON: figures_json(result)} if result.JSON else {}
    tables = result.tables()
    texts |= {file: csv_table(tables[name]().values) for file, name in result.TABLES.items() if name in tables}
    files = {**result.contents(), **{name: text.encode() for name, text in texts.items()}, **more}
    older = {*outdated, *result.TABLES, *result.outdated(Path(directory))}
    return replace_together(directory, files, older - {*files})


write_rating = write_revolution = write_stage = write_tribology = write_result


def figures_json(result: Result) -> str:
    """Return the title, the figures of each torque, null where one is not known, and more of a result as JSON."""
    rows = [{name: known(value, name) for name, value in figures.items()} for figures in result.key_figures()]
    return json_text({"title": result.title, "torques": rows, **result.beside_figures()})


@checked
def write_report(result: MeshCycle, directory: FilePath, outdated: Iterable[str] = ()) -> tuple[Path, ...]:
    """Write ``result.nc``, ``summary.json`` and ``positions.csv``, all of them or none.

    Where tooth pairs share the load ``contacts.csv`` too; elsewhere one that an earlier result left is removed.

    Parameters
    ----------
    result : MeshCycle
    directory : str or path
        Made if it does not exist.
    outdated : iterable of str
        Names of files that an earlier result may have left there: removed before the new ones take their places.

    Returns
    -------
    tuple of Path
        The three or four files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = {SUMMARY: summary_json(result), POSITIONS: positions_csv(result)}
    if result.scene.analysis.load_sharing:
        texts[CONTACTS] = contacts_csv(result)
    contents: dict[str, Buffer] = {RESULT: result.to_netcdf(), **{name: text.encode() for name, text in texts.items()}}
    return replace_together(directory, contents, {*outdated, CONTACTS} - {*contents})


def summary_json(result: MeshCycle) -> str:
    """Return the key figures as JSON, their units in the names; null: not known, or infinite as an error may be."""
    content = {
        "title": result.scene.title,
        "loaded_tca_version": result.version,
        "tooth_pairs_sharing_load": len(result.pair),
        "face_width_mm": result.face_width,
        "wheel_base_radius_mm": result.wheel_base_radius,
        "mesh_stiffness_is": f"d(F_bt/b)/d(r_b2 TE); {result.bending}",
        "rigid_bore_diameters_mm": result.scene.rigid_bores,
        "accuracy_warnings": result.warnings,
        "findings": result.findings(),
        "torques": [
            {
                **{name: known(value, name) for name, value in figures.items()},
                "tooth_pair_at_peak": None if place is None else int(result.pair[place[1]]),
            }
            for torque, figures in enumerate(result.key_figures())
            for place in (result.peak_contact(torque),)
        ],
    }
    return json_text(content)


def positions_csv(result: MeshCycle) -> str:
    """Return one row per torque and position, units in the header; an empty cell: not known."""
    return csv_table(positions_table(result).values)


def contacts_csv(result: MeshCycle) -> str:
    """Return one row per torque, position and tooth pair under load, units in the header; an empty cell: not known.

    The pairs of a position stand in the order of the mesh. The last column names the edges that the contact reaches,
    the tip of a gear or a face end.
    """
    return csv_table(contacts_table(result).values)


def json_text(content: Mapping[str, Any]) -> str:
    """Return content as JSON, as :func:`write_report` writes it."""
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def csv_table(columns: Mapping[str, Iterable[Any]]) -> str:
    """Return columns of one length as CSV, numbers as :func:`write_report` writes them, words as they are."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    cells = ([cell(value, name) for value in values] for name, values in columns.items())
    writer.writerows(zip(*cells, strict=True))
    return text.getvalue()


def cell(value: Any, name: str) -> str:
    """Return a number as tables have it: nine digits, zero for rounding, nothing where unknown; words as they are."""
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else f"{without_rounding(value, name):.9g}"
