"""What the report of a result tells of its rating: tables as rating programs print them, what decides, pictures."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Any

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.plots import SAFETY_PICTURES, safety_figures
from loaded_tca.rating import Rating, rating_of
from loaded_tca.rating.findings import findings
from loaded_tca.rating.quantities import NUMBERS, OF_GEARS
from loaded_tca.reports.page import Table, parts_of, pictures_of
from loaded_tca.results.figure import labelled
from loaded_tca.results.summary import shown
from loaded_tca.scene.rating import is_rated

if TYPE_CHECKING:
    from loaded_tca.results.mesh_cycle import MeshCycle

MOST_CASES = 2
"""With a column for each gear in one table of a page."""
BLOCKS = {
    "torque": "Loads and load factors",
    "Z_H": "Flanks, ISO 6336-2",
    "Y_F": "Roots, ISO 6336-3",
    "local_flank_stress": "Local",
}
"""First number of each table, and its caption."""


def rating_content(result: MeshCycle) -> dict[str, Any] | None:
    """Return what the template takes of the rating of a result; None if its scene has no strengths or no [rating].

    Parameters
    ----------
    result : MeshCycle
    """
    if not is_rated(result.scene):
        return None
    try:
        rating = rating_of(result, warn=False)
    except InputError as error:  # the report has what there is
        return {"refused": error.problems, "pictures": ()}
    decisive, said = findings(rating), {*findings(rating)}
    captions = {name: picture.caption for name, picture in SAFETY_PICTURES.items()}
    return {
        "refused": (),
        "about": rating.scope.removesuffix("; pinion | wheel"),
        "safeties": _safeties(rating),
        "findings": decisive,
        "tables": [*chain.from_iterable(_tables(rating, part) for part in parts_of(rating.torque, MOST_CASES))],
        "notes": [note for note in rating.notes() if note not in said],
        "warnings": rating.warnings or (),
        "pictures": pictures_of(safety_figures(rating), captions, result.scene.title),
    }


def _safeties(rating: Rating) -> Table:
    """The least safeties of all cases of both gears beside those required, and the shortest lives."""
    wanted, rows = rating.scene.rating, []
    assert wanted is not None  # rated
    lines = (("pitting", "flank", ""), ("tooth breakage", "root", ""))
    for words, kind, prefix in (*lines, *((f"{words}, local", kind, "local_") for words, kind, _ in lines)):
        if rating.has(f"{prefix}{kind}_safety"):
            safeties, lives = rating.values(f"{prefix}{kind}_safety"), rating.values(f"{prefix}{kind}_life")
            required = getattr(wanted, f"required_{kind}_safety")
            cells = (
                shown(float(values[:, gear].min()), "") for gear in range(len(GEARS)) for values in (safeties, lives)
            )
            rows.append((words, plain(required), *cells))
    heads = (f"{gear}, {what}" for gear in GEARS for what in ("safety", "life [h]"))
    return Table(tuple(rows), ("least of all cases", "required", *heads))


def _tables(rating: Rating, part: slice) -> Iterator[Table]:
    """Factors of both gears in some cases, a table for each part of the rating."""
    cases = rating.torque[part]
    figures = rating.key_figures()[part]
    heads = [f"{plain(1e-3 * float(torque))} N m, {gear}" for torque in cases for gear in GEARS]
    caption, rows = "", list[tuple[str, ...]]()
    for name, number in NUMBERS.items():
        if name in BLOCKS:
            if rows:
                yield Table(tuple(rows), ("", *heads), caption)
            caption, rows = BLOCKS[name], []
        if not rating.has(name) or name == "torque":
            continue
        head = number.head(name)
        names = [f"{gear}_{head}" for gear in GEARS] if number.dims == OF_GEARS else [head, ""]
        cells = (shown(row[one], one) if one else "" for row in figures for one in names)
        rows.append((labelled(names[0], number.label or number.text).replace("[um]", "[µm]"), *cells))
    yield Table(tuple(rows), ("", *heads), caption)
