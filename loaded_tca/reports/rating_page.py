"""What the report of a result tells of its rating: tables as rating programs print them, what decides, pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.plots import RATING_PICTURES, rating_figures
from loaded_tca.rating import Rating, SpectrumRating, rating_of
from loaded_tca.rating.findings import FAILURES, findings
from loaded_tca.rating.quantities import OF_GEARS, OF_MODES, OF_SPECTRUM
from loaded_tca.rating.rating import WORDS
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
    "Z_H": "Flanks, {}-2",
    "Y_F": "Roots, {}-3",
    "local_flank_stress": "Local",
    "damage": "Damage and lives",
}
"""First number of each table, and its caption with the standard."""


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
    decisive, said, cases = findings(rating), {*findings(rating)}, _shown_cases(rating)
    captions = {name: picture.caption for name, picture in RATING_PICTURES.items()}
    return {
        "refused": (),
        "about": rating.scope.removesuffix("; pinion | wheel"),
        "safeties": safeties_table(rating),
        "findings": decisive,
        "tables": [*chain.from_iterable(_tables(rating, cases[part]) for part in parts_of(cases, MOST_CASES))],
        "notes": [note for note in rating.notes() if note not in said],
        "warnings": rating.warnings or (),
        "pictures": pictures_of(rating_figures(rating), captions, result.scene.title),
    }


def safeties_table(rating: Rating) -> Table:
    """The least safeties of all cases of both gears beside those required, and the shortest lives."""
    rows = []
    safeties, lives = (values.min(axis=0) for values in rating.safeties_and_lives())
    for n, mode in enumerate(rating.modes):
        kind = mode.removeprefix("local_")
        words = FAILURES[kind] if kind == mode else f"{FAILURES[kind]}, local"
        cells = (shown(float(values[gear, n]), "") for gear in range(len(GEARS)) for values in (safeties, lives))
        rows.append((words, plain(rating.required.required_safety(mode)), *cells))
    heads = (f"{gear}, {what}" for gear in GEARS for what in ("safety", "life [h]"))
    together = "all bins together" if isinstance(rating, SpectrumRating) else "least of all cases"
    return Table(tuple(rows), (together, "required", *heads))


def _shown_cases(rating: Rating) -> list[int]:
    """Cases whose factors stand in tables: all torques, of a load spectrum the bins of the largest damage."""
    return rating.most_damaging() if isinstance(rating, SpectrumRating) else [*range(len(rating.torque))]


def _tables(rating: Rating, cases: Sequence[int]) -> Iterator[Table]:
    """Factors of both gears in some cases, a table for each part of the rating."""
    figures = rating.key_figures()
    bins = [f"bin {case + 1}, " if isinstance(rating, SpectrumRating) else "" for case in cases]
    torques = [plain(1e-3 * float(rating.torque[case])) for case in cases]
    heads = [f"{each}{torque} N m, {gear}" for each, torque in zip(bins, torques, strict=True) for gear in GEARS]
    caption, rows = "", list[tuple[str, ...]]()
    for name, number in rating.NUMBERS.items():
        if name in BLOCKS:
            if rows:
                yield Table(tuple(rows), ("", *heads), caption)
            caption, rows = BLOCKS[name].format(rating.standard), []
        if not rating.has(name) or name == "torque" or number.dims == OF_SPECTRUM:
            continue
        head = number.head(name)
        for label, names in _lines(rating, name, head):
            cells = (shown(figures[case][one], one) if one else "" for case in cases for one in names)
            rows.append((labelled(names[0], label).replace("[um]", "[µm]"), *cells))
    yield Table(tuple(rows), ("", *heads), caption)


def _lines(rating: Rating, name: str, head: str) -> Iterator[tuple[str, list[str]]]:
    """Label and figures of both gears of the lines that a number has in a table."""
    number = rating.NUMBERS[name]
    if number.dims == OF_MODES:
        for mode in rating.modes:
            yield f"{WORDS[mode]}: {number.text}", [f"{gear}_{mode}_{head}" for gear in GEARS]
    elif number.dims == OF_GEARS:
        yield number.label or number.text, [f"{gear}_{head}" for gear in GEARS]
    else:
        yield number.label or number.text, [head, ""]
