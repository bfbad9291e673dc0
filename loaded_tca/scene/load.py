"""What a pair or a stage carries: one torque on its input, or a load spectrum whose bins may stand in a file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, named, require
from loaded_tca.input_files import Table, number_in, read_table, require_decimal_points, table_in
from loaded_tca.plain import apart, plain
from loaded_tca.scene.keys import Choice, Line, Number, above_zero, did_you_mean, key, nearest, shown
from loaded_tca.scene.section import Rule, Section, Tables, check, keys_of, made
from loaded_tca.scene.written import writing_of

# ruff: noqa: N802, N815  -- names are the keys of the file, units included; the calls make dataclass fields

TORQUE_Nm = Number(0.0, 1e9)
LARGEST_FILE = 2**21
"""Bytes of a file of a load spectrum; five thousand bins have a tenth of that."""
MOST_BINS = 5000
MOST_PROBLEMS = 20
"""Lines of a file whose problems are told one by one."""
SUM_OF_SHARES = 1e-3
"""By how much shares may miss 1: they are written with a few digits, and count as parts of their sum."""
SOLVED = 12
"""Torques of a spectrum that are solved; between them a rating interpolates."""
LEAST_EXPONENT, NEGLIGIBLE = 4.0, 1e-4
"""Damage of the flattest S-N curves grows with this power of the torque and more; bins that together do less than this
part of it do not matter unless load factors raise them: of torques below them the smallest alone is solved."""
SMALLEST_SOLVED = 0.01
"""Of the largest torque: a bin below is no reason to solve its torque."""
ROUNDED = 1e-4
"""By how much, relatively, a bin may be above the largest torque solved: torques of drawings in N m and in lbf in are
rounded to four digits and more."""
DIGITS = 5
"""Of torques that are solved between those of bins."""


def _one_duration(hours: float | None, share: float | None) -> str | None:
    if (hours is None) != (share is None):
        return None
    if hours is None or share is None:
        return "missing; give hours, or share"
    return f"found {plain(hours, 6)} beside share = {plain(share, 6)}; give one"


class Bin(Section):
    """What the bins of load spectra of pairs and of stages have in common; ``MEMBER`` carries torque and speed.

    ``OTHER_WAY`` has the keys that turn a whole spectrum round.
    """

    MEMBER: ClassVar[str]
    OTHER_WAY: ClassVar[str]
    hours: float | None
    share: float | None
    reversed: bool

    alternatives: ClassVar[tuple[str, ...]] = ("hours", "share")
    rules: ClassVar[tuple[Rule, ...]] = (Rule(("hours", "share"), _one_duration),)

    @property
    def torque_Nm(self) -> float:
        """Magnitude of the torque [N m]."""
        return float(getattr(self, self.torque_key()))

    @property
    def speed_rpm(self) -> float | None:
        """Speed [rpm], or None: that of [operation]."""
        speed: float | None = getattr(self, f"{self.MEMBER}_speed_rpm")
        return speed

    @classmethod
    def torque_key(cls) -> str:
        """Name of the key of the torque."""
        return f"{cls.MEMBER}_torque_Nm"


torque_of_bin = partial(key, Number(0.0, 1e9, advice="reversed = true is the other direction"))
speed_of_bin = partial(key, above_zero(1e6))
hours_of_bin = partial(key, Number(0.0, 1e8), "how long the bin lasts", None, "`share` is given")
share_of_bin = partial(
    key, Number(0.0, 1.0), "or the part of the time of the bin; all shares add up to 1", None, "`hours` are given"
)
reversed_of_bin = partial(
    key, Choice((False, True)), "whether the torque acts the other way, so that the other flanks carry it", False
)


@dataclass(frozen=True, kw_only=True)
class LoadCase(Bin):
    """[[load.case]]: a bin of a load spectrum; the analysis takes its torque, a rating the rest."""

    MEMBER: ClassVar[str] = "pinion"
    OTHER_WAY: ClassVar[str] = "pair.driving or pair.sense"
    pinion_torque_Nm: float = torque_of_bin("magnitude of the torque on the pinion")
    pinion_speed_rpm: float | None = speed_of_bin("speed of the pinion", None, "`operation.pinion_speed_rpm`")
    hours: float | None = hours_of_bin()
    share: float | None = share_of_bin()
    reversed: bool = reversed_of_bin()


def alternatives_of(case: type[Bin]) -> tuple[str, ...]:
    """Keys that say in several ways what is carried."""
    return case.torque_key(), "case", "spectrum"


def load_rules(case: type[Bin]) -> tuple[Rule, ...]:
    """What the keys of a load must fulfil together."""
    names = alternatives_of(case)
    return Rule(names, partial(_one_load, names)), Rule(("case",), _spectrum_problem)


def _one_load(names: tuple[str, ...], torque: float | None, cases: object, spectrum: str | None) -> str | None:
    given = [name for name, one in zip(names, (torque, cases, spectrum), strict=True) if one is not None]
    if not given:
        return "missing; give a torque, or the bins of a spectrum: [[load.case]], or load.spectrum"
    return f"found {' beside '.join(given)}; give one of them" if len(given) > 1 else None


def _spectrum_problem(cases: Sequence[Bin] | None) -> str | None:
    """What is wrong with bins that are sound one by one."""
    if cases is None:
        return None
    hours, shares = ([getattr(case, name) for case in cases] for name in ("hours", "share"))
    of_hours = sum(each is not None for each in hours)
    if 0 < of_hours < len(cases):
        return f"hours of {of_hours} bins and shares of {len(cases) - of_hours}; give one of them for all"
    if of_hours and not sum(hours) > 0.0:
        return "the hours sum to 0; allowed above 0"
    if not of_hours and abs(sum(shares) - 1.0) > SUM_OF_SHARES:
        return f"the shares sum to {plain(sum(shares), 6)}; allowed 1"
    if not any(case.torque_Nm > 0.0 for case in cases):
        return f"no bin has a {cases[0].torque_key()} above 0"
    if all(case.reversed for case in cases):
        return f"all bins are reversed; change {cases[0].OTHER_WAY}, and leave reversed out"
    return None


class AnyLoad(Section):
    """[load] of pairs and of stages: a torque, or the bins of a load spectrum, which are of the class ``CASE``.

    A file of a spectrum is read when the section is made, and its bins take its place.
    """

    CASE: ClassVar[type[Bin]]
    case: tuple[Bin, ...] | None
    spectrum: str | None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.spectrum is not None:
            with named("spectrum"):
                cases = read_spectrum(self.spectrum, self.CASE)
                complaint = _spectrum_problem(cases)
                require((complaint is None, f"{self.spectrum}: {complaint}"))
            object.__setattr__(self, "case", cases)
            object.__setattr__(self, "spectrum", None)

    @property
    def hours(self) -> float | None:
        """Hours of all bins together; None of shares, and without a spectrum."""
        hours = [case.hours for case in self.case or () if case.hours is not None]
        return sum(hours) if hours else None

    @property
    def largest_Nm(self) -> float:
        """Largest torque of all bins [N m]; 0 without a spectrum."""
        return max((case.torque_Nm for case in self.case or ()), default=0.0)

    @property
    def torques(self) -> tuple[float, ...]:
        """Torques to solve [N mm]: that of the pair or stage, all of a spectrum, or of many bins a dozen."""
        if self.case is None:
            return (1e3 * float(getattr(self, self.CASE.torque_key())),)  # given, by the rules of the section
        return tuple(1e3 * torque for torque in _solved_torques(self.case))


@dataclass(frozen=True, kw_only=True)
class Load(AnyLoad):
    """[load]: torque on the pinion, or the bins of a load spectrum."""

    CASE: ClassVar[type[Bin]] = LoadCase
    pinion_torque_Nm: float | None = key(
        TORQUE_Nm, "magnitude of the torque on the pinion", None, "those of `case` or `spectrum`"
    )
    case: tuple[LoadCase, ...] | None = key(
        Tables(LoadCase, 1, MOST_BINS),
        "or the bins of a load spectrum, each a table `[[load.case]]` of `pinion_torque_Nm`, `hours` or `share` (of "
        "the time; all shares add up to 1), `pinion_speed_rpm`, by default that of [operation], and `reversed = false` "
        "(true: the torque acts the other way, and the other flanks carry it); of more than twelve torques, twelve in "
        "equal steps are analysed",
        None,
        "no spectrum",
    )
    spectrum: str | None = key(
        Line(1000),
        "or a CSV file, relative to the folder of the scene, a line for each bin, its keys as columns: "
        "`pinion_torque_Nm`, `hours` or `share`, and where wanted `pinion_speed_rpm` and `reversed` (true, false)",
        None,
        "as `case`",
    )

    alternatives: ClassVar[tuple[str, ...]] = alternatives_of(LoadCase)
    rules: ClassVar[tuple[Rule, ...]] = load_rules(LoadCase)


def _solved_torques(cases: Sequence[Bin]) -> list[float]:
    """Torques [N m] of bins; of more than a dozen a dozen: in equal steps, or the smallest beside these.

    Steps are equal since damage is done by the largest: in equal ratios the damage of flanks of an electric drive under
    500 bins was wrong by up to 7 %, in equal steps by 0.2 %. The smallest stands beside them since K_v by method B
    multiplies small loads: near resonance bins of 2 % of the largest torque did 9 % of the damage of these flanks
    (``validation/rating/spectra.py``).
    """
    loaded = [case for case in cases if case.torque_Nm > 0.0]
    torques = np.array([case.torque_Nm for case in loaded])
    distinct = np.unique(torques)
    if len(distinct) <= SOLVED:
        return [float(torque) for torque in distinct]
    largest, matters = float(distinct[-1]), _smallest_that_matters(loaded, torques)
    smallest = float(distinct[distinct >= SMALLEST_SOLVED * largest][0])
    alone = matters - smallest > (largest - matters) / (SOLVED - 1)
    first, count = (matters, SOLVED - 1) if alone else (smallest, SOLVED)
    between = [float(f"{torque:.{DIGITS}g}") for torque in np.linspace(first, largest, count)[1:-1]]
    return [*([smallest] if alone else []), first, *between, largest]


def _smallest_that_matters(cases: Sequence[Bin], torques: Array) -> float:
    """Torque [N m] below which bins do next to no damage on the flattest S-N curve."""
    weights = np.array([case.hours if case.share is None else case.share for case in cases], dtype=float)
    if all(case.speed_rpm is not None for case in cases):
        weights *= [case.speed_rpm for case in cases]
    order = np.argsort(torques, kind="stable")
    damage = np.cumsum(weights[order] * (torques[order] / torques.max()) ** LEAST_EXPONENT)
    return float(torques[order][np.searchsorted(damage, NEGLIGIBLE * damage[-1])])


def life_is_given(life_hours: float | None, load: AnyLoad) -> str | None:
    """What is wrong where neither a rating nor its load cases say how long the gears are to last."""
    if life_hours is not None or load.hours is not None:
        return None
    return "missing; needed unless load cases have hours, whose sum then is the required life"


def within_solved(load: AnyLoad | None, torques: Sequence[float] | None) -> str | None:
    """What is wrong with torques [N m] that are solved in the place of those of a spectrum."""
    if load is None or load.case is None or torques is None:
        return None
    if load.largest_Nm <= max(torques) * (1.0 + ROUNDED):
        return None
    found, most = apart([load.largest_Nm, max(torques)])
    return f"a bin has {found} N m; allowed up to {most}, the largest of analysis.torques_Nm"


def read_spectrum(file: str, case: type[Bin] = LoadCase) -> tuple[Bin, ...]:
    """Return the bins of a CSV file of a load spectrum: its columns are the keys of ``case``, as drawings have them.

    Raises
    ------
    InputError
        If the file cannot be read, or with the problems of its columns and lines.
    """
    table = _table_of(file)
    with named(file):
        require(*((False, problem) for problem in _column_problems(table.names, case)))
        require_decimal_points(table)
        count = len(table.rows)
        require((0 < count <= MOST_BINS, f"{count} lines of bins; allowed 1 to {MOST_BINS}"))
        return _bins(table, case)


def _table_of(file: str) -> Table:
    """The table of a CSV file of a load spectrum."""
    text = read_table(file, LARGEST_FILE, "file of a load spectrum")
    with named(file):
        return table_in(text)


def spectrum_columns(file: str) -> tuple[str, ...]:
    """Names of the columns of a CSV file of a load spectrum, as it writes them."""
    return tuple(_table_of(file).names)


def _column_problems(names: Sequence[str], case: type[Bin]) -> list[str]:
    """What is wrong with the names of columns."""
    columns, torque = keys_of(case), case.torque_key()
    names = [writing.key if (writing := writing_of(name, columns, {})) else name for name in names]
    allowed = ", ".join(columns)
    problems = [
        f"unknown column {shown(name)}{did_you_mean(nearest(name, columns)) or f'; allowed {allowed}'}"
        for name in names
        if name not in columns
    ]
    problems += [f"column {name} found twice" for name in dict.fromkeys(names) if names.count(name) > 1]
    if torque not in names:
        problems.append(f"no column {torque}; found {', '.join(names) or 'no columns'}")
    if ("hours" in names) == ("share" in names):
        problems.append(f"found {'both' if 'hours' in names else 'none'} of the columns hours and share; give one")
    return problems


def _bins(table: Table, case: type[Bin]) -> tuple[Bin, ...]:
    """The bins of a table whose columns are sound; InputError with every line that is not."""
    cases: list[Bin] = []
    problems: list[str] = []
    for number, cells in table.rows:
        line = f"line {number}"
        if len(cells) > len(table.names):
            problems.append(f"{line}: more values than the header has columns")
            continue
        row = {name: _value(name, cell) for name, cell in zip(table.names, cells, strict=False) if cell}
        values, wrong, _ = check(case, row)
        problems += [f"{line}: {problem}" for problem in wrong]
        if not wrong:
            cases.append(made(case, values))
    if len(problems) > MOST_PROBLEMS:
        problems[MOST_PROBLEMS:] = [f"{len(problems) - MOST_PROBLEMS} more problems"]
    if problems:
        raise InputError(problems)
    return tuple(cases)


def _value(name: str, cell: str) -> Any:
    """Value of a cell as a scene file would have it; text that is none stays, to be refused by its key."""
    if name == "reversed":
        return {"true": True, "1": True, "false": False, "0": False}.get(cell.lower(), cell)
    try:
        return number_in(cell)
    except ValueError:
        return cell
