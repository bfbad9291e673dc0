"""What a study varies: keys of a scene or of a planetary stage, each over given values or after a distribution."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from numbers import Integral, Real
from typing import Any, Protocol

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, require
from loaded_tca.notebooks import InNotebooks
from loaded_tca.plain import plain
from loaded_tca.scene import Scene
from loaded_tca.scene.keys import Key, Number, Whole, shown
from loaded_tca.scene.section import as_given, as_table
from loaded_tca.separation.pair_change import value_at
from loaded_tca.stages import Stage
from loaded_tca.studies.stage import key_of, problem_of_places

NEVER = 1e-12
"""Probabilities nearer than this to 0 or 1 are moved there: a distribution without bounds has no value at its ends."""
MOST_VARIANTS = 1_000_000
"""Of a study: a row of key figures takes 3 kB on disk."""


class Distribution(Protocol):
    """A frozen distribution of ``scipy.stats``."""

    def ppf(self, q: Any) -> Any:
        """Value that is not exceeded with the probability ``q``."""


@dataclass(frozen=True, eq=False)
class Study(InNotebooks):
    """Variants of a scene or of a stage, numbered from 0: rows of the table outermost, then factors, samples innermost.

    Parameters
    ----------
    scene : Scene or Stage
        What all variants have in common.
    factors : mapping of str to sequence, optional
        Keys as in a scene file, with dots -> values; every combination is a variant, the last factor changes fastest.
    distributions : mapping of str to frozen distribution of ``scipy.stats``, optional
        Keys -> distributions, independent of each other. The same ``samples`` points stand for every combination.
    samples : int, optional
        Points of a scrambled Sobol sequence; powers of two fill the space best. Needed with distributions.
    seed : int
        Of the scrambling: the same seed gives the same points.
    table : mapping of str to sequence, optional
        Keys -> given values, all equally many, as a ``pandas.DataFrame`` has them; each row is a variant.

    Raises
    ------
    InputError
        Every problem at once: unknown keys, values that a key never takes, none at all. A number out of the range of
        its key is no problem of the study: that variant is refused when its turn comes.

    Examples
    --------
    >>> from scipy.stats import norm
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> scene = parse_scene(DEMO_SCENE.read_text())
    >>> crownings = {"pinion.modifications.lead_crowning_um": [3.0, 5.0]}
    >>> study = Study(scene, crownings, {"mounting.misalignment_um": norm(0.0, 5.0)}, samples=64)
    >>> len(study), study.changes(64)["pinion.modifications.lead_crowning_um"]
    (128, 5.0)
    """

    scene: Scene | Stage
    factors: Mapping[str, Sequence[Any]] = field(default_factory=dict)
    distributions: Mapping[str, Distribution] = field(default_factory=dict)
    samples: int | None = None
    seed: int = 0
    table: Mapping[str, Sequence[Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        problems = [*self._problems_of_numbers(), *self._problems_of_keys()]
        kinds = self._kinds
        for key, values in (*self.table.items(), *self.factors.items()):
            problems += _problems_of_values(key, kinds.get(key), values)
        for key, distribution in self.distributions.items():
            problems += _problems_of_distribution(key, kinds.get(key), distribution)
        lengths = {key: len(values) for key, values in self.table.items() if hasattr(values, "__len__")}
        if len(set(lengths.values())) > 1:
            problems.append("table: columns of different lengths: " + ", ".join(f"{k} {n}" for k, n in lengths.items()))
        if problems:
            raise InputError(problems)
        for name in ("factors", "table"):  # copies, which nobody else changes
            lists = {key: [_plain(value) for value in values] for key, values in getattr(self, name).items()}
            object.__setattr__(self, name, lists)
        if (count := math.prod(self._counts)) > MOST_VARIANTS:
            raise InputError(f"factors: all together {plain(count)} variants; allowed up to {MOST_VARIANTS}")

    def _problems_of_numbers(self) -> Iterator[str]:
        if not is_whole(self.seed, 0, math.inf):
            yield f"seed: found {shown(self.seed)}; allowed a whole number from 0 on"
        if not self.distributions and self.samples is not None:
            yield "samples: given without distributions; give distributions, too, or leave samples out"
        elif self.distributions and not is_whole(self.samples, 1, MOST_VARIANTS):
            given = "missing" if self.samples is None else f"found {shown(self.samples)}"
            yield f"samples: {given}; allowed a whole number from 1 to {MOST_VARIANTS}, with distributions"

    def _problems_of_keys(self) -> Iterator[str]:
        if not self.keys:
            yield "factors: none given, no distributions and no table; a study varies one key at least"
        for key in dict.fromkeys(self.keys):
            if self.keys.count(key) > 1:
                yield f"{key}: varied more than once"
            try:
                key_of(self.scene, key)
            except InputError as error:
                yield from error.problems
            else:
                if problem := problem_of_places(self.scene, key, self.keys):
                    yield problem
        several = self.scene.analysis.torques_Nm is not None or "analysis.torques_Nm" in self.keys
        torque = "load.sun_torque_Nm" if isinstance(self.scene, Stage) else "load.pinion_torque_Nm"
        if torque in self.keys and several:
            yield (f"{torque}: changes nothing beside analysis.torques_Nm; vary these, or leave them out")

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that vary: those of the table, of the factors, of the distributions."""
        return (*self.table, *self.factors, *self.distributions)

    def __len__(self) -> int:
        return math.prod(self._counts)

    def changes(self, variant: int) -> dict[str, Any]:
        """What a variant changes in the scene: key -> value."""
        if not 0 <= variant < len(self):
            raise InputError(f"variant: {variant}; allowed 0 to {len(self) - 1}")
        row, *places, sample = (int(place) for place in np.unravel_index(variant, self._counts))
        changed = {key: column[row] for key, column in self.table.items()}
        changed |= {key: values[place] for (key, values), place in zip(self.factors.items(), places, strict=True)}
        changed |= dict(zip(self.distributions, self._points[sample].tolist(), strict=True))
        return {key: _as_key_takes(self._kinds[key], value) for key, value in changed.items()}

    def digests(self, figures: Callable[..., Any]) -> Callable[[int], str]:
        """Return a digest for each variant: of scene and changes, asked figures and version of the package.

        A variant of another study that changes the same keys to the same values has the same digest.
        """
        table = as_table(self.scene)
        for key in self.keys:  # what the scene itself has there is of no account
            *sections, name = key.split(".")
            place: Any = table
            for section in sections:
                in_list = {str(n): one for n, one in enumerate(place)} if isinstance(place, tuple) else place
                place = in_list.get(section, {})
            if isinstance(place, dict):
                place.pop(name, None)
            elif int(name) < len(place):  # a place in a list
                _put(table, sections, (*place[: int(name)], None, *place[int(name) + 1 :]))
        common = [version("loaded_tca"), f"{figures.__module__}.{figures.__qualname__}", table]
        begun = hashlib.sha256(json.dumps(common, sort_keys=True).encode())

        def digest(variant: int) -> str:
            own = begun.copy()
            own.update(json.dumps(self.changes(variant), sort_keys=True).encode())
            return own.hexdigest()

        return digest

    @cached_property
    def _counts(self) -> tuple[int, ...]:
        rows = max((len(column) for column in self.table.values()), default=1)
        return (rows, *(len(values) for values in self.factors.values()), self.samples or 1)

    @cached_property
    def _kinds(self) -> dict[str, Key]:
        """What the scene says of the keys, of those that it knows."""
        kinds = {}
        for key in self.keys:
            with suppress(InputError):
                kinds[key] = key_of(self.scene, key)
        return kinds

    @cached_property
    def _points(self) -> Array:
        """Values of the keys with distributions, (samples, keys)."""
        if self.samples is None:
            return np.empty((1, 0))
        from scipy.stats import qmc  # half a second, which studies without distributions do not need

        sobol = qmc.Sobol(len(self.distributions), scramble=True, rng=self.seed)
        unit = sobol.random_base2(int(self.samples - 1).bit_length())[: self.samples]
        columns = zip(self.distributions.values(), np.clip(unit, NEVER, 1.0 - NEVER).T, strict=True)
        return np.stack([np.asarray(one.ppf(column), dtype=float) for one, column in columns], axis=1)


def _put(table: dict[str, Any], path: Sequence[str], value: Any) -> None:
    """Set a value at a path of a nested table."""
    *sections, name = path
    for section in sections:
        table = table[section]
    table[name] = value


def told_distribution(distribution: Any) -> str:
    """Name and parameters of a distribution; of what is none of ``scipy.stats`` its class.

    Examples
    --------
    >>> from scipy.stats import norm
    >>> told_distribution(norm(0.0, scale=5.0))
    'norm(0.0, scale=5.0)'
    """
    if not all(hasattr(distribution, name) for name in ("dist", "args", "kwds")):
        return type(distribution).__name__
    named = (f"{name}={shown(value)}" for name, value in distribution.kwds.items())
    return f"{distribution.dist.name}({', '.join([*map(shown, distribution.args), *named])})"


def is_whole(value: Any, low: float, high: float) -> bool:
    """Whether a value is a whole number, but no boolean, within a range."""
    return isinstance(value, Integral) and not isinstance(value, bool) and low <= int(value) <= high


def is_finite(value: Any) -> bool:
    """Whether a value is a number, but no boolean, that a float can hold."""
    try:
        return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)
    except OverflowError:
        return False


def _plain(value: Any) -> Any:
    """A value without the types of NumPy."""
    return value.tolist() if isinstance(value, np.generic | np.ndarray) else value


def _as_key_takes(key: Key, value: Any) -> Any:
    """The value in the key's own type; a number that it refuses stays what it is."""
    try:
        return as_given(key.read(_whole_if_asked(key, value)))
    except ValueError:
        return value


def _whole_if_asked(key: Key, value: Any) -> Any:
    """A whole number where one is asked for and the value is one that is written otherwise, as 33.0."""
    return int(value) if isinstance(key.kind, Whole) and is_finite(value) and float(value).is_integer() else value


def _problems_of_values(key: str, known: Key | None, values: Any) -> Iterator[str]:
    if isinstance(values, str | bytes | Mapping) or not (hasattr(values, "__len__") and hasattr(values, "__iter__")):
        yield f"{key}: found {shown(values)}; allowed a list of values"
        return
    if len(values) == 0:
        yield f"{key}: no values"
    elif known is not None:
        refusals = (_refusal(known, _plain(value)) for value in values)
        yield from dict.fromkeys(f"{key}: {refusal}" for refusal in refusals if refusal)


def _refusal(known: Key, value: Any) -> str:
    """Why a key never takes a value; nothing for a number, be it in the range of the key or not."""
    if isinstance(known.kind, Number) and is_finite(value):
        return ""
    try:
        known.read(_whole_if_asked(known, value))
    except ValueError as refused:
        return str(refused)
    return ""


def _problems_of_distribution(key: str, known: Key | None, distribution: Any) -> Iterator[str]:
    if known is not None and not isinstance(known.kind, Number | Whole):
        yield f"{key}: no number, so that it has no distribution; allowed {known.kind.allowed}, as a factor"
    try:
        middle = float(distribution.ppf(0.5))
    except Exception:  # of whatever it is, or of parameters that scipy.stats stumbles over
        yield f"{key}: found {shown(distribution)}; allowed a frozen distribution of scipy.stats, as norm(0.0, 5.0)"
        return
    if callable(distribution):  # what makes frozen ones, with parameters that nobody gave
        name = getattr(distribution, "name", None) or getattr(distribution, "__name__", type(distribution).__name__)
        yield f"{key}: found the distribution {name} without parameters; allowed a frozen one, as norm(0.0, 5.0)"
    elif not math.isfinite(middle):
        yield f"{key}: the distribution has no median: a parameter is out of its range, as a scale below 0"
    elif known is not None and isinstance(known.kind, Whole) and not middle.is_integer():
        yield f"{key}: the distribution gives {plain(middle, 6)}; allowed are whole numbers"


def problems_of_key(scene: Scene, key: Any) -> Iterator[str]:
    """Problems of a key that varies or scatters."""
    if not isinstance(key, str):
        yield f"{key!r:.60}: no text; allowed a key as of scene.with_changes"
        return
    try:
        value_at(scene, key)
    except InputError as error:
        yield from (f"{key}: {problem}" for problem in error.problems)


def problems_of_range(scene: Scene, key: str, bounds: Any) -> Iterator[str]:
    """Problems of the range of a key that varies."""
    if key.startswith("mounting."):
        yield f"{key}: a mounting error, which no design shapes; allowed in scatter"
    elif not (np.shape(bounds) == (2,) and all(map(is_finite, bounds)) and bounds[0] < bounds[1]):
        yield f"{key}: range {bounds!r:.60}; allowed two numbers, the lower one first"
    elif not bounds[0] <= (value := value_at(scene, key)) <= bounds[1]:
        yield (
            f"{key}: the scene, where a design starts, has {plain(value, 6)}; allowed {plain(bounds[0], 6)} "
            f"to {plain(bounds[1], 6)}"
        )


def deviations_of(
    scene: Scene,
    scatter: Mapping[str, Distribution | Sequence[float]],
    samples: int,
    seed: int,
    multiple: float,
) -> list[dict[str, float]]:
    """What keys that scatter have, or deviate by, in each sample; ``multiple`` times as far from their medians."""
    if not scatter:
        return [{}]
    given = {key: one for key, one in scatter.items() if not hasattr(one, "ppf")}
    drawn: dict[str, Any] = {key: one for key, one in scatter.items() if key not in given}
    require((not given or not drawn, "scatter: distributions and given values; allowed one or the other"))
    if given:
        study = Study(scene, table=given)
        medians = {key: float(np.median(column)) for key, column in study.table.items()}
    else:
        study = Study(scene, distributions=drawn, samples=samples, seed=seed)
        medians = {key: float(one.ppf(0.5)) for key, one in drawn.items()}
    changes = (study.changes(sample) for sample in range(len(study)))
    return [{key: medians[key] + multiple * (by - medians[key]) for key, by in one.items()} for one in changes]
