"""Sections of whole revolutions: pitch deviations and runout of each gear, and which positions are analysed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, named, require
from loaded_tca.input_files import Table, number_in, read_table, require_decimal_points, table_in
from loaded_tca.pairs.tooth_deviations import random_index
from loaded_tca.plain import plain
from loaded_tca.scene.keys import Choice, Either, Line, List, Number, Whole, key, shown
from loaded_tca.scene.section import Rule, Section

LARGEST_FILE = 2**20
"""Bytes of a file of pitch deviations: ten thousand teeth have a fifth of that."""
CLOSED_um = 1e-3
"""Sum of single pitch deviations that counts as zero: rounding of the values as they are written."""
LARGEST_INDEX = 0.05
"""Index deviation over the module, beyond which no load brings the teeth into contact."""
DEVIATION_um = Number(-10000.0, 10000.0)
DEVIATIONS_um = List(DEVIATION_um, 3, 10000)
COLUMNS, TOOTH = ("index_um", "single_um"), "tooth"
SOURCES = "index_um", "single_um", "file", "tolerance_class"


def _one_source(*given: object) -> str | None:
    names = [name for name, value in zip(SOURCES, given, strict=True) if value is not None]
    return f"found {' beside '.join(names)}; give one of them" if len(names) > 1 else None


def _of_class(seed: int, tolerance_class: int | None) -> str | None:
    if not seed or tolerance_class is not None:
        return None
    return f"found {seed} without tolerance_class; allowed beside tolerance_class, for its random deviations"


def _closed(single: tuple[float, ...] | None) -> str | None:
    if single is None or abs(sum(single)) <= CLOSED_um:
        return None
    return (
        f"the single pitch deviations add up to {plain(sum(single))} um; allowed 0, since the last tooth "
        "meets the first"
    )


@dataclass(frozen=True, kw_only=True)
class Pitch(Section):
    """[pinion.pitch], [wheel.pitch]: where the teeth stand beside their nominal places.

    A file of deviations is read when the section is made, and its numbers take its place.
    """

    index_um: tuple[float, ...] | None = key(
        DEVIATIONS_um,
        "index deviation of every tooth, in the order in which the teeth come into mesh, along the transverse line of "
        "action; positive: the flank is set back from its mating flank",
        None,
        "no index deviations, or those of another key",
    )
    single_um: tuple[float, ...] | None = key(
        DEVIATIONS_um,
        "or single pitch deviations, each the index deviation of a tooth less that of the tooth before it; they add up "
        "to 0",
        None,
        "as `index_um`",
    )
    file: str | None = key(
        Line(1000),
        "or a CSV file, relative to the folder of the scene, with a column `index_um` or `single_um`, a line for each "
        "tooth in the order of the numbers of teeth; the only other column is `tooth`, with these numbers from 0 or 1",
        None,
        "as `index_um`",
    )
    tolerance_class: int | None = key(
        Whole(1, 11),
        "or the flank tolerance class of ISO 1328-1:2013, whose single and cumulative pitch tolerances "
        "random deviations fill; for cylindrical gears only",
        None,
        "as `index_um`",
    )
    seed: int = key(Whole(0, 2**31 - 1), "seed of these random deviations: equal seeds give equal deviations", 0)
    runout_um: float = key(Number(0.0, 10000.0), "runout, twice the eccentricity of the teeth", 0.0)
    runout_phase_deg: float = key(
        Number(-360.0, 360.0),
        "azimuth of the eccentricity in the gear's own frame, from its x axis about its z axis",
        0.0,
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(SOURCES, _one_source),
        Rule(("single_um",), _closed),
        Rule(("seed", "tolerance_class"), _of_class),
    )
    alternatives: ClassVar[tuple[str, ...]] = SOURCES
    companions: ClassVar[dict[str, tuple[str, ...]]] = {"tolerance_class": ("seed",)}

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.file is not None:
            with named("file"):
                name, values = read_deviations(self.file)
                complaint = _closed(values) if name == "single_um" else None
                require((complaint is None, f"{self.file}: {complaint}"))
            object.__setattr__(self, name, values)
            object.__setattr__(self, "file", None)

    @property
    def is_given(self) -> bool:
        """Whether a tooth stands elsewhere than at its nominal place."""
        return self.runout_um > 0.0 or self.tolerance_class is not None or any(self.index_um or self.single_um or ())

    @property
    def given_index(self) -> tuple[str, ...]:
        """The key that has a deviation of every tooth, if there is one."""
        return tuple(name for name in COLUMNS if getattr(self, name) is not None)

    @property
    def count(self) -> int | None:
        """How many teeth the deviations are of; None without any."""
        values = self.index_um or self.single_um
        return None if values is None else len(values)

    def index(self, teeth: int, tolerances: Callable[[int], tuple[float, float]]) -> Array:
        """Index deviations (teeth,) [um]; zeros without any.

        Parameters
        ----------
        teeth : int
        tolerances : callable
            Single and cumulative pitch tolerance [um] of a class, along the transverse line of action.
        """
        if self.tolerance_class is not None:
            return random_index(teeth, *tolerances(self.tolerance_class), self.seed)
        if self.index_um is not None:
            return np.array(self.index_um)
        return np.zeros(teeth) if self.single_um is None else np.cumsum(self.single_um)


def read_deviations(file: str) -> tuple[str, tuple[float, ...]]:
    """Return the column of a CSV file of pitch deviations, ``index_um`` or ``single_um``, and its values.

    Raises
    ------
    InputError
        If the file cannot be read, has not one of the columns, or an entry that is no number within the limits.
    """
    text = read_table(file, LARGEST_FILE, "file of pitch deviations")
    with named(file):
        table = table_in(text)
        names = [name for name in COLUMNS if name in table.names]
        columns = ", ".join(table.names) or "none"
        others = {*table.names} - {*COLUMNS, TOOTH}
        require(
            (
                len(names) == 1 and not others,
                f"found the columns {columns}; allowed one of index_um, single_um, and {TOOTH} beside it",
            )
        )
        require_decimal_points(table)
    if TOOTH in table.names:
        _require_order(file, table)
    column, values = table.names.index(names[0]), []
    for number, (_, cells) in enumerate(table.rows, 1):
        if len(cells) > len(table.names):
            raise InputError(f"{file}: line {number} of the table: more values than the header has columns")
        cell = cells[column] if column < len(cells) else ""
        try:
            values.append(DEVIATION_um.read(number_in(cell)))
        except ValueError:
            raise InputError(
                f"{file}: line {number} of the table: found {shown(cell)}; allowed {DEVIATION_um.allowed}"
            ) from None
    try:
        return names[0], DEVIATIONS_um.read(values)
    except ValueError as refused:
        raise InputError(f"{file}: {refused}") from None


def _require_order(file: str, table: Table) -> None:
    """Deviations are taken in the order of their lines: numbers of teeth beside them count up, from 0 or 1 on."""
    column = table.names.index(TOOTH)
    cells = [row[column].strip() if column < len(row) else "" for _, row in table.rows]
    first = int(cells[:1] != ["0"])
    for line, cell in enumerate(cells):
        if cell != str(first + line):
            raise InputError(
                f"{file}: line {line + 1} of the table: found {TOOTH} {shown(cell)}; allowed {first + line}: teeth are "
                "numbered in the order of the lines, from 0 or 1 on"
            )


@dataclass(frozen=True, kw_only=True)
class Revolution(Section):
    """[revolution]: how many pitches a whole revolution has, and where it is looked at."""

    pitches: int | str = key(
        Either((Choice(("pinion", "wheel", "hunting")), Whole(1, 10**8))),
        "pitches in succession: a turn of the pinion or of the wheel, all pitches until the same teeth meet again "
        '("hunting"), or any smaller number of pitches',
        "wheel",
    )
    positions_per_pitch: int = key(Whole(1, 10000), "positions that divide each pitch evenly", 8)
    first_pair: int | tuple[int, int] = key(
        Either((Whole(0, 10**8), List(Whole(0, 10000), 2, 2))),
        "tooth pair at the pitch point at the first position: its number, which modulo the numbers of teeth gives "
        "the teeth; or the teeth of pinion and wheel, from 0",
        0,
    )

    def count(self, teeth: tuple[int, int]) -> int:
        """Pitches of the revolution of a pair with numbers of teeth."""
        words = {"pinion": teeth[0], "wheel": teeth[1], "hunting": math.lcm(*teeth)}
        return words.get(str(self.pitches), 0) or int(self.pitches)

    def first_teeth(self, teeth: tuple[int, int]) -> tuple[int, int]:
        """Teeth of pinion and wheel that touch at the pitch point at the first position."""
        pair = self.first_pair
        return (pair % teeth[0], pair % teeth[1]) if isinstance(pair, int) else pair


def entry_for_each_tooth(gear: str) -> Rule:
    """Rule: the pitch deviations of a gear are as many as its teeth."""

    def complain(pitch: Pitch | None, teeth: int) -> str | None:
        if pitch is None or pitch.count in (None, abs(teeth)):
            return None
        name = "index_um" if pitch.index_um is not None else "single_um"
        return f"{name}: found {pitch.count} values; allowed {abs(teeth)}, one for each tooth"

    return Rule((f"{gear}.pitch", f"{gear}.teeth"), complain)


def _within_hunting(pitches: int | str, pinion: int, wheel: int) -> str | None:
    most = math.lcm(pinion, wheel)
    if isinstance(pitches, str) or pitches <= most:
        return None
    return f"found {pitches}; allowed up to {most}, after which the same teeth meet again"


def _known_teeth(first: int | tuple[int, int], pinion: int, wheel: int) -> str | None:
    if isinstance(first, int) or (first[0] < pinion and first[1] < abs(wheel)):
        return None
    last = pinion - 1, abs(wheel) - 1
    return f"found {shown(first)}; allowed teeth up to {last[0]} of the pinion and up to {last[1]} of the wheel"


def teeth_of_their_own(gear: str) -> Rule:
    """Rule: the teeth of a gear that have flanks of their own exist, each given once."""

    def complain(given: tuple[Any, ...] | None, teeth: int) -> str | None:
        numbers = [tooth.number for tooth in given or ()]
        if numbers and max(numbers) >= abs(teeth):
            return f"number: found {max(numbers)}; allowed 0 to {abs(teeth) - 1}"
        twice = sorted({number for number in numbers if numbers.count(number) > 1})
        return f"number: found {twice[0]} twice; allowed once" if twice else None

    return Rule((f"{gear}.tooth", f"{gear}.teeth"), complain)


TEETH = "pinion.teeth", "wheel.teeth"
REVOLUTION_RULES: tuple[Rule, ...] = (
    entry_for_each_tooth("pinion"),
    entry_for_each_tooth("wheel"),
    teeth_of_their_own("pinion"),
    teeth_of_their_own("wheel"),
    Rule(("revolution.pitches", *TEETH), _within_hunting),
    Rule(("revolution.first_pair", *TEETH), _known_teeth),
)
"""Of whole scenes."""
