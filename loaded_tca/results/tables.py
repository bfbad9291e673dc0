"""Tables of results as columns with their units in the heads: CSV files, pandas and Excel read the same ones."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError, require
from loaded_tca.results.declared import PAIRS
from loaded_tca.results.warnings import EDGES, reached_edges
from loaded_tca.warning_kinds import kind_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from os import PathLike

    import pandas

    from loaded_tca.results.files import Buffer
    from loaded_tca.results.mesh_cycle import MeshCycle

FORCES = "force_x_N", "force_y_N", "force_z_N", "moment_x_Nm", "moment_y_Nm", "moment_z_Nm"
"""Columns of forces and moments on bearings, axes of the gear's own frame."""
MOST_ROWS = 1_048_576
"""Of a sheet of Excel, its head included."""
WIDEST, NARROWEST = 60, 12
"""Characters of a column of a sheet."""
ENDING = ".xlsx"
MISSING = (
    "to_excel: needs the package openpyxl; 'pip install openpyxl' gets it, as does installing loaded_tca with its "
    "extra 'excel'"
)


class Columns(NamedTuple):
    """Columns of a table by their heads, all equally long, and the heads of those that name its rows."""

    values: Mapping[str, Any]
    keys: tuple[str, ...] = ()


def positions_table(result: MeshCycle) -> Columns:
    """A row for each torque and position of a mesh cycle; NaN: not known."""
    table, shape = result.to_table(), result.transmission_error.shape
    of_path = {"position": np.arange(1, len(result.path) + 1)}
    of_path |= {name: factor * getattr(result.path, part) for name, part, factor in _places()}
    position, *points = ((name, np.broadcast_to(values, shape).ravel()) for name, values in of_path.items())
    torque, angle, *others = table.items()
    return Columns(dict([torque, position, angle, *points, *others]), (torque[0], position[0]))


def _places() -> Iterator[tuple[str, str, float]]:
    """Columns of contact points: name, part of a path, how many times that."""
    for gear in GEARS:
        for name, part, factor in (("diameter_mm", "radius", 2.0), ("axial_mm", "axial", 1.0)):
            yield f"contact_point_{gear}_{name}", f"{gear}_{part}", factor


def contacts_table(result: MeshCycle) -> Columns:
    """A row for each torque, position and tooth pair under load of a mesh cycle; NaN: not known.

    The pairs of a position stand in the order of the mesh. The last column names the edges that the contact reaches,
    the tip of a gear or a face end.
    """
    columns = {
        "pinion_torque_Nm": 1e-3 * result.torque[:, None, None],
        "position": np.arange(1, len(result.path) + 1)[:, None],
        "pinion_angle_deg": np.degrees(result.pinion_angle)[:, None],
        "tooth_pair": result.pair,
    }
    for name, part, factor in _places():
        columns[name] = np.stack([factor * getattr(path, part) for path in result.paths], axis=-1)
    for name, number in result.NUMBERS.items():
        if number.dims == PAIRS and result.has(name):
            head = number.head(name)
            columns[head] = result.values(name) * number.factor(head)
    rows = result.normal_force > 0.0
    reached = reached_edges(result)[rows]
    words = [" + ".join(name for name, one in zip(EDGES, row, strict=True) if one) for row in reached]
    under_load = {name: np.broadcast_to(values, rows.shape)[rows] for name, values in columns.items()}
    keys = "pinion_torque_Nm", "position", "tooth_pair"
    return Columns({**under_load, "edges": np.array(words, dtype=object)}, keys)


def sentences_table(sentences: Mapping[str, Iterable[str]]) -> Columns:
    """A row for each sentence of some kinds, as notes and warnings, with the meaning of accuracy warnings.

    Parameters
    ----------
    sentences : mapping of str to iterable of str
        Kind -> sentences.
    """
    rows = [(kind, sentence, kind_of(sentence)) for kind, some in sentences.items() for sentence in some]
    columns = {
        "kind": [kind for kind, _, _ in rows],
        "sentence": [sentence for _, sentence, _ in rows],
        "meaning": [known.meaning if known else "" for _, _, known in rows],
        "what_to_do": [known.advice if known else "" for _, _, known in rows],
    }
    return Columns({name: np.array(values, dtype=object) for name, values in columns.items()})


def frame_of(columns: Columns) -> pandas.DataFrame:
    """A table as a frame of pandas."""
    import pandas

    frame = pandas.DataFrame({head: np.asarray(values) for head, values in columns.values.items()})
    return frame.set_index([*columns.keys]) if columns.keys else frame


def require_openpyxl(path: str | PathLike[str]) -> None:
    """Refuse to write a workbook without the package that does, or under a name that spreadsheets take for other files.

    Raises
    ------
    InputError
    """
    ending = Path(path).suffix
    require((ending.lower() == ENDING, f"path: {str(path)!r:.200} ends in {ending!r}; a workbook ends in {ENDING}"))
    try:
        import openpyxl  # noqa: F401
    except ModuleNotFoundError:
        raise InputError(MISSING) from None


def workbook_of(sheets: Mapping[str, pandas.DataFrame], title: str, about: str) -> Buffer:
    """Bytes of a workbook of Excel with a sheet for each frame: heads stay in view, text is text and no formula.

    Parameters
    ----------
    sheets : mapping of str to pandas.DataFrame
    title, about : str
        Properties of the workbook: its title and its description.

    Raises
    ------
    InputError
        If a frame has more rows than a sheet takes.
    """
    import pandas
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    def legal(value: Any) -> Any:
        return ILLEGAL_CHARACTERS_RE.sub("\N{REPLACEMENT CHARACTER}", value) if isinstance(value, str) else value

    require(
        *(
            (len(frame) < MOST_ROWS, f"to_excel: the sheet {name} has {len(frame)} rows; a sheet takes {MOST_ROWS - 1}")
            for name, frame in sheets.items()
        )
    )
    content = io.BytesIO()
    with pandas.ExcelWriter(content, engine="openpyxl") as writer:
        for name, frame in sheets.items():
            of_words = frame.select_dtypes(exclude="number")
            whole = frame.assign(**{str(head): of_words[head].map(legal) for head in of_words})
            named = [head for head in frame.index.names if head is not None]
            layout: Any = {"index": bool(named), "freeze_panes": (1, len(named)), "merge_cells": False}
            whole.to_excel(writer, sheet_name=name, inf_rep="inf", **layout)
            _laid_out(writer.sheets[name])
        writer.book.properties.title, writer.book.properties.description = legal(title), legal(about)
        writer.book.properties.creator = "loaded_tca"
    return content.getvalue()


def _laid_out(sheet: Any) -> None:
    """Columns as wide as their heads and words, whose lines are broken; what begins with = is no formula."""
    from openpyxl.styles import Alignment

    for column in sheet.iter_cols():
        words = [cell for cell in column[1:] if isinstance(cell.value, str)]
        for cell in words:
            cell.data_type, cell.alignment = "s", Alignment(wrap_text=True, vertical="top")
        longest = max(len(str(cell.value)) for cell in (column[0], *words))
        sheet.column_dimensions[column[0].column_letter].width = min(max(longest + 2, NARROWEST), WIDEST)
