"""Two or more results side by side: what their scenes differ in, and what that does to the key figures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.errors import InputError, require
from loaded_tca.notebooks import InNotebooks
from loaded_tca.results.figure import labelled
from loaded_tca.results.figures import FIGURES, declared
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.summary import kind_of_edge, shown, without_rounding
from loaded_tca.results.tables import Columns, frame_of
from loaded_tca.results.warnings import peak_finding
from loaded_tca.scene.keys import shown as shown_value
from loaded_tca.scene.section import as_table

if TYPE_CHECKING:
    import pandas
    import xarray

    from loaded_tca.arrays import Array

PLACES = "pinion_angle_at", "_axial_"
"""Parts of the names of figures that count from a zero of no meaning: they have no relative difference."""
NOT_COMPARED = "title", "load.pinion_torque_Nm", "analysis.torques_Nm"
"""Keys of the scenes that a comparison does not name."""
DIGITS = ".6g"
"""Of torques [N m] that are the same."""
SIZES = "% of absolute values, none where the signs differ"
"""What differences in % are of."""
MARK = "*"
"""Beside a difference that exceeds the errors of both results."""
MOST_KEYS = 12
"""Keys of the scenes that the summary names."""


@dataclass(frozen=True, eq=False)
class Comparison(InNotebooks):
    """Two or more results under the torques that all of them have, each beside the first.

    Attributes
    ----------
    results : mapping of str to MeshCycle
        By their names; the first is the one that the others are compared with.
    torque : (m,) array [N mm]
        Torques that all results have, ascending.
    """

    results: Mapping[str, MeshCycle]
    torque: Array

    @cached_property
    def figures(self) -> xarray.Dataset:
        """Key figures as ``value``, ``difference`` and ``relative_difference`` to the first (torque, figure, result).

        NaN: not known. A relative difference is that of the magnitudes over that of the first, since the sign of a
        figure is a direction; NaN where the first is zero, where the signs differ, and for angles and axial positions,
        whose zero has no meaning. ``difference_error`` is the sum of the errors that both results state of the figure,
        by the grid, by the positions or against finite elements.
        """
        import xarray

        owned = self._owned
        names = [name for name in dict.fromkeys(name for own in owned for name in own[0]) if name != "pinion_torque_Nm"]
        value = np.array(
            [
                [
                    [without_rounding(own[k].get(name, math.nan), name) for own, k in zip(owned, row, strict=True)]
                    for name in names
                ]
                for row in self.indices
            ]
        )
        first = value[..., :1]
        with np.errstate(invalid="ignore"):  # errors without a limit in both
            difference = value - first
        is_place = np.array([any(part in name for part in PLACES) for name in names])
        is_apart = (first == 0.0) | (value * np.sign(first) < 0.0) | is_place[:, None]
        growth = np.where(is_apart, math.nan, difference * np.sign(first))
        with np.errstate(invalid="ignore"):
            base = np.where(first == 0.0, math.nan, np.abs(first))
            parts = {"value": value, "difference": difference, "relative_difference": growth / base}
            error = np.abs(value) * self._stated_errors(names)
            parts["difference_error"] = error + error[..., :1]
        dimensions = ("torque", "figure", "result")
        return xarray.Dataset(
            {name: (dimensions, values) for name, values in parts.items()},
            {"torque": self.torque, "figure": names, "result": list(self.results)},
        )

    @cached_property
    def _owned(self) -> list[tuple[dict[str, float], ...]]:
        """Key figures of each result under all torques that it has."""
        return [result.key_figures() for result in self.results.values()]

    @cached_property
    def relative_errors(self) -> xarray.DataArray:
        """Relative errors (torque, figure, result) that the results state of their key figures; NaN: none."""
        value = self.figures["value"]
        return value.copy(data=self._stated_errors(value["figure"].values.tolist()))

    def _stated_errors(self, names: Sequence[str]) -> Array:
        """Relative errors (torque, figure, result) of key figures by their names."""
        cases = zip(self.results.values(), self._owned, self.indices.T.tolist(), strict=True)
        errors = [
            [
                [FIGURES[name].relative_error(name, result, k, own[k]) if name in FIGURES else math.nan for k in row]
                for name in names
            ]
            for result, own, row in cases
        ]
        return np.transpose(errors, (2, 1, 0))

    @property
    def beyond_errors(self) -> xarray.DataArray:
        """Whether differences (torque, figure, result) exceed the errors that both results state.

        1: they do; 0: they do not; NaN: the difference or an error is not known, or there is none, as of the first.
        Errors that both results share cancel in a difference: one within them may be there all the same.
        """
        difference, error = self.figures["difference"], self.figures["difference_error"]
        known = difference.notnull() & error.notnull() & (self.figures["result"] != next(iter(self.results)))
        return ((difference > error) | (-difference > error)).where(known)

    def table(self) -> Columns:
        """A row for each torque and figure, columns for each result: its value, and what it differs by."""
        figures = self.figures
        count = figures.sizes["figure"]
        columns: dict[str, Any] = {
            "pinion_torque_Nm": np.repeat(1e-3 * self.torque, count),
            "figure": np.tile(figures["figure"].values.astype(object), len(self.torque)),
        }
        for k, result in enumerate(self.results):
            for part in figures.data_vars if k else ("value",):
                columns[f"{result}: {part}"] = figures[part].values[..., k].ravel()
        return Columns(columns, ("pinion_torque_Nm", "figure"))

    def to_pandas(self) -> pandas.DataFrame:
        """Return the key figures as a frame, with the columns of ``comparison.csv``; NaN: not known.

        Its index: torques [N m], and figures, whose names end in the units of their rows.
        """
        return frame_of(self.table())

    @cached_property
    def indices(self) -> np.ndarray[tuple[int, int], np.dtype[np.int_]]:
        """Index (torque, result) of each torque in each result."""
        named = [_torques(result) for result in self.results.values()]
        return np.array([[known.index(torque) for known in named] for torque in map(_told, self.torque)])

    @cached_property
    def differing_keys(self) -> dict[str, tuple[Any, ...]]:
        """Keys of the scenes that are not the same in all, with the value of each result; None: not given.

        Titles and torques are left out.
        """
        scenes = [dict(_flat(as_table(result.scene))) for result in self.results.values()]
        keys = dict.fromkeys(key for scene in scenes for key in scene if key not in NOT_COMPARED)
        values = {key: tuple(scene.get(key) for scene in scenes) for key in keys}
        return {key: row for key, row in values.items() if any(value != row[0] for value in row)}

    @property
    def left_out(self) -> dict[str, list[str]]:
        """Torques [N m] of the results that not all have, by the names of those that have such ones."""
        shared = [_told(torque) for torque in self.torque]
        others = {name: [one for one in _torques(result) if one not in shared] for name, result in self.results.items()}
        return {name: torques for name, torques in others.items() if torques}

    def findings(self, torque: float | None = None) -> tuple[str, ...]:
        """Return sentences on peak pressures that lie at an edge, on a pair that carries less than a tenth of a torque.

        Such a peak pressure is compared with that of other results all the same, and its difference is none of the
        pairs that carry the load: each sentence names the result, and has the peak pressure of these pairs.

        Parameters
        ----------
        torque : float [N mm], optional
            Default: the largest that all results have.
        """
        row = self.indices[self.index_of(torque)].tolist()
        told = {name: peak_finding(one, k) for (name, one), k in zip(self.results.items(), row, strict=True)}
        return tuple(f"{name}: {sentence}" for name, sentence in told.items() if sentence)

    def index_of(self, torque: float | None = None) -> int:
        """Return the index of a torque [N mm] among the shared ones; default: that of the largest.

        Raises
        ------
        InputError
            If the results do not share it.
        """
        if torque is None:
            return len(self.torque) - 1
        known = [_told(one) for one in self.torque]
        require((_told(torque) in known, f"torque: {_told(torque)} N m; the results share {', '.join(known)} N m"))
        return known.index(_told(torque))

    def summary(self, torque: float | None = None) -> str:
        """Return what differs in the scenes and in the main figures under one torque [N mm]; default: the largest."""
        at = self.index_of(torque)
        names = list(self.results)
        table: list[tuple[str, ...]] = [("", names[0], *(cell for name in names[1:] for cell in (name, "", "", "")))]
        keys = list(self.differing_keys.items())
        for key, (first, *others) in keys[:MOST_KEYS]:
            table.append(
                (key, written_value(first), *(cell for other in others for cell in (written_value(other), "", "", "")))
            )
        under = self.figures.isel(torque=at).assign(beyond=self.beyond_errors.isel(torque=at))
        pressure, rounded = (under.value.sel(figure=name).values for name in ("edge_pressure_MPa", "edge_is_rounded"))
        edge = kind_of_edge([{"edge_is_rounded": one} for one in rounded[np.isfinite(pressure)]])
        for name in declared(lambda figure: figure.is_compared):
            if name not in under.figure:
                continue
            label = labelled(name, FIGURES[name].below or FIGURES[name].label)
            row = under.sel(figure=name)
            if not row.value.isnull().all():
                parts = (row[part].values for part in ("value", "difference", "relative_difference", "beyond"))
                table.append((label.format(edge=edge), *_cells(name, *parts)))
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        lines = [f"{row[0]:<{widths[0]}}" + _right(row[1:], widths[1:]) for row in table]
        more = len(keys) - MOST_KEYS
        notes = [f"{more} more keys of the scenes differ"] if more > 0 else []
        if any(MARK in row for row in table):
            notes.append(f"{MARK} differs by more than the errors that both results state")
        if left := [f"{name} {', '.join(torques)}" for name, torques in self.left_out.items()]:
            shared = ", ".join(map(_told, self.torque))
            notes.append(f"all have the torques {shared} N m; left out: {'; '.join(left)} N m")
        told = [f"finding: {sentence}" for sentence in self.findings(torque)]
        head = f"Compared with {names[0]}, pinion torque {_told(self.torque[at])} N m; {SIZES}"
        return "\n".join([head, *(line.rstrip() for line in lines), *(f"note: {note}" for note in notes), *told])


def compare_results(results: Mapping[str, MeshCycle] | Sequence[MeshCycle]) -> Comparison:
    """Compare two or more results under the torques that all of them have.

    Parameters
    ----------
    results : mapping of str to MeshCycle, or sequence of MeshCycle
        By their names; those of a sequence are called ``result 1``, ``result 2``, ... The first one is what the others
        are compared with. They may be of different gears, and of other positions and models.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        If there are fewer than two, or they share no torque.

    Examples
    --------
    Of a pair with more crowning than the other::

        comparison = compare_results({"5 um": first, "8 um": second})
        comparison.differing_keys  # {"pinion.modifications.lead_crowning_um": (5.0, 8.0)}
        comparison.figures.relative_difference.sel(figure="peak_pressure_MPa", result="8 um")
    """
    named = dict(
        results if isinstance(results, Mapping) else {f"result {k}": one for k, one in enumerate(results, start=1)}
    )
    require(
        (len(named) > 1, f"results: {len(named)} given; a comparison takes two or more"),
        *(
            (isinstance(one, MeshCycle), f"results: {name} is no MeshCycle but {one!r:.60}")
            for name, one in named.items()
        ),
    )
    torques = [set(_torques(result)) for result in named.values()]
    shared = set.intersection(*torques)
    if not shared:
        owned = "; ".join(f"{name}: {', '.join(_torques(result))} N m" for name, result in named.items())
        raise InputError(f"results: have no torque in common ({owned})")
    first = next(iter(named.values()))
    return Comparison(named, np.sort([torque for torque in first.torque if _told(torque) in shared]))


def _told(torque: float) -> str:
    """A torque [N mm] in N m, as scenes write it."""
    return f"{1e-3 * torque:{DIGITS}}"


def _torques(result: MeshCycle) -> list[str]:
    return [_told(torque) for torque in result.torque]


def _flat(table: Mapping[str, Any], place: str = "") -> Iterator[tuple[str, Any]]:
    """Keys with dots, and their values."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{place}{name}.")
        elif isinstance(value, Sequence) and value and all(isinstance(one, Mapping) for one in value):
            yield from _flat({str(n): one for n, one in enumerate(value)}, f"{place}{name}.")
        else:
            yield place + name, value


def written_value(value: Any) -> str:
    """A value of a scene as files have it; how many numbers lists of lists have; a dash where it is not given."""
    if isinstance(value, list | tuple) and value and all(isinstance(row, list | tuple) for row in value):
        return f"{len(value)} lists, {sum(map(len, value))} values"
    return "-" if value is None else shown_value(value)


def _cells(name: str, value: Array, difference: Array, relative: Array, beyond: Array) -> Iterator[str]:
    """The first value, then of every other result its value, difference, relative difference and mark."""
    yield shown(value[0], name)
    for one, change, part, marked in zip(value[1:], difference[1:], relative[1:], beyond[1:], strict=True):
        yield shown(one, name)
        yield signed_change(change, name)
        yield f"({100.0 * part:+.1f} %)" if math.isfinite(part) else ""
        yield MARK if marked == 1.0 else ""


def signed_change(change: float, name: str) -> str:
    """A difference of a figure as summaries show it, with its sign."""
    text = shown(change, name)
    return f"+{text}" if change > 0.0 else text


def _right(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "".join(f"  {cell:>{width}}" for cell, width in zip(cells, widths, strict=True))
