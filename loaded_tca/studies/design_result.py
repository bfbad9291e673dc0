"""Result of a design: what its dataset holds, what the analysis does not confirm of it, and its file."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError, require
from loaded_tca.input_files import number_in
from loaded_tca.notebooks import InNotebooks
from loaded_tca.plain import plain
from loaded_tca.results.files import DESIGN, FilePath, Part, read_dataset, write_dataset
from loaded_tca.studies.design_figures import FIGURES, Limit

if TYPE_CHECKING:
    import xarray

CONFIRMED = 0.5
"""Part of the gain on held contacts that the full analysis must confirm. Analyses scatter by 2 to 4 nm, held contacts
are coarser: a gain that is much larger than both is confirmed nearly whole, one of their size is none."""
LIMITS_CONFIRMED = 0.05
"""Part of a limit by which the full analysis may exceed it: K_Hbeta and pressures on two grids differ by percents."""
MORE_CELLS = "take more cells of the model (cells)"
AT_ENDS = (
    "where contacts press on the ends of the flanks, limit edge_pressure_norm_MPa, by less, or keep more relief and "
    "crowning by the ranges of their keys"
)

TEXTS, NUMBERS = ("scene_toml", "warnings", "objective", "limits"), ("value", "objective", "held_objective")
"""Attributes and variables that every result has, besides its figure."""

ANALYSED = "design", "sample", "torque", "position"
PARTS: dict[str, Part] = {
    "value": (("design", "key"), "1", "value of the key, in the unit at the end of its name"),
    "range": (("key", "bound"), "1", "lowest and highest value of the key"),
    "scatter": (("sample", "scatter_key"), "1", "value of the key, or its deviation from that of the design"),
    "transmission_error": (ANALYSED, "rad", "loaded transmission error"),
    "peak_pressure": (ANALYSED, "MPa", "largest peak pressure of the tooth pairs"),
    "transverse_load_factor": (ANALYSED[:3], "1", "K_Halpha"),
    **{name: (ANALYSED[:3], figure.unit, figure.text) for name, figure in FIGURES.items()},
    "objective": (ANALYSED[:1], "", "what was minimised, by the full analysis"),
    "held_transmission_error": (
        (*ANALYSED[:3], "held_position"),
        "rad",
        "loaded transmission error on held contacts, without the last position, the first one of the next pitch",
    ),
    **{
        f"held_{name}": (ANALYSED[:3], figure.unit, f"{figure.text}, on held contacts")
        for name, figure in FIGURES.items()
    },
    "held_difference_um": (ANALYSED[:3], "um", "largest difference of the transmission errors on held contacts"),
    "held_objective": (ANALYSED[:1], "", "what was minimised, on held contacts"),
    "history_x": (("evaluation", "key"), "1", "value of the key"),
    "history_objective": (("evaluation",), "", "objective on held contacts"),
    "history_excess": (("evaluation",), "1", "part by which a figure exceeds its limit; negative within all limits"),
}
"""What the dataset of a result holds."""


EARLIER = {
    "edge_pressure_MPa": "edge_pressure_norm_MPa",
    **{f"{name}_root_tension_MPa": f"{name}_root_tension_norm_MPa" for name in GEARS},
}
"""Names of figures in files before version 0.3 -> their names now."""


@dataclass(frozen=True, eq=False)
class DesignResult(InNotebooks):
    """Result of a design: start and optimum, with the figures of both by the whole analysis.

    Attributes
    ----------
    dataset : xarray.Dataset
        Over ``design`` ("start", "optimum"), sample, torque, position and key: ``value`` of the keys, analysed
        ``transmission_error`` [rad], ``peak_pressure`` [MPa], load factors and ``FIGURES``; those on held contacts as
        ``held_...``; ``history_x``, ``history_objective`` and ``history_excess`` over the evaluations; ``range`` of the
        keys and ``scatter``; ``attrs`` has in words ``limits``, ``distributions`` of the scatter, ``seeds`` and
        ``warnings``, each with the number of analyses that it concerns.
    """

    dataset: xarray.Dataset

    def __repr__(self) -> str:
        before, after = self.objective
        warnings = self.dataset.attrs["warnings"].count("\n") + 1 if self.dataset.attrs["warnings"] else 0
        values = ", ".join(f"{key} = {plain(value)}" for key, value in self.optimum.items())
        figure = f"{self.dataset.attrs['objective']} of {self.dataset.attrs['figure']}"
        warned = f", {warnings} accuracy warnings in dataset.attrs" if warnings else ""
        refused = ", not confirmed" if self.unconfirmed else ""
        return f"DesignResult({figure}: {plain(before)} -> {plain(after)}, {values}{refused}{warned})"

    @property
    def start(self) -> dict[str, float]:
        """Values of the keys where the design started."""
        return self._values("start")

    @property
    def optimum(self) -> dict[str, float]:
        """Values of the keys that were found."""
        return self._values("optimum")

    def _values(self, design: str) -> dict[str, float]:
        values = self.dataset["value"].sel(design=design).values.tolist()
        return dict(zip(self.dataset["key"].values.tolist(), values, strict=True))

    @property
    def objective(self) -> tuple[float, float]:
        """Objective of start and optimum by the full analysis."""
        before, after = self.dataset["objective"].values.tolist()
        return before, after

    @property
    def held_objective(self) -> tuple[float, float]:
        """Objective of start and optimum on held contacts."""
        before, after = self.dataset["held_objective"].values.tolist()
        return before, after

    @property
    def held_difference(self) -> tuple[float, float]:
        """Largest difference of the transmission error of start and optimum between held contacts and analysis [um].

        NaN of files before version 0.3.
        """
        if "held_difference_um" not in self.dataset:
            return math.nan, math.nan
        before, after = self.dataset["held_difference_um"].max(("sample", "torque")).values.tolist()
        return before, after

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Limits of the search, in the order in which they were given."""
        torques = [_shown_torque(one) for one in self.dataset["torque"].values.tolist()]
        limits = []
        for line in self.dataset.attrs["limits"].splitlines():
            if (words := re.fullmatch(r"(\S+) <= (\S+) at (.+) N m", line)) is None or words[1] not in FIGURES:
                continue
            under = tuple(k for k, one in enumerate(torques) if one in words[3].split(", "))
            limits.append(Limit(words[1], under, number_in(words[2])))
        return tuple(limits)

    @property
    def unconfirmed(self) -> tuple[str, ...]:
        """What the whole analysis of start and optimum does not confirm, in words; nothing if it confirms the design.

        At least half of the gain on held contacts, and every limit to 5 %.
        """
        return (*self._unconfirmed_gain(), *self._unconfirmed_limits())

    @property
    def advice(self) -> str:
        """What to do about what is unconfirmed; nothing if the analysis confirms the design."""
        if not self.unconfirmed:
            return ""
        figures = {limit.figure for limit in self._exceeded()}
        return f"{MORE_CELLS}; {AT_ENDS}" if figures & {"pressure_MPa", "edge_pressure_norm_MPa"} else MORE_CELLS

    def _unconfirmed_gain(self) -> Iterator[str]:
        (start, optimum), (held_start, held_optimum) = self.objective, self.held_objective
        gain, held_gain = start - optimum, held_start - held_optimum
        if not gain >= held_gain * (CONFIRMED if held_gain > 0.0 else 1.0 / CONFIRMED):  # nor is NaN
            yield (
                f"the objective goes from {plain(held_start)} to {plain(held_optimum)} on held contacts, but from "
                f"{plain(start)} to {plain(optimum)} by the analysis"
            )

    def _exceeded(self) -> Iterator[Limit]:
        """Limits that the optimum exceeds by the analysis."""
        for limit in self.limits:
            if not self._at_optimum(limit.figure)[:, limit.torques].max() <= (1.0 + LIMITS_CONFIRMED) * limit.highest:
                yield limit

    def _unconfirmed_limits(self) -> Iterator[str]:
        for limit in self._exceeded():
            values, held = (self._at_optimum(name) for name in (limit.figure, f"held_{limit.figure}"))
            under = np.nan_to_num(values[:, limit.torques], nan=math.inf)
            sample, at = np.unravel_index(int(under.argmax()), under.shape)
            place = int(sample), limit.torques[int(at)]
            if math.isnan(values[place]):
                yield f"{limit.figure} is not known by the analysis, its limit {plain(limit.highest, 6)}"
                continue
            torque = _shown_torque(float(self.dataset["torque"].values[place[1]]))
            yield (
                f"{limit.figure} is {plain(values[place])} by the analysis at {torque} N m{self._told_sample(place[0])}"
                f", its limit {plain(limit.highest, 6)} ({plain(held[place])} on held contacts)"
            )

    def _at_optimum(self, name: str) -> Array:
        """A figure of the optimum (sample, torque); NaN where the file does not have it."""
        if name not in self.dataset:
            return np.full((self.dataset.sizes["sample"], self.dataset.sizes["torque"]), math.nan)
        return np.asarray(self.dataset[name].sel(design="optimum").transpose("sample", "torque").values)

    def _told_sample(self, sample: int) -> str:
        if "scatter" not in self.dataset or "scatter_key" not in self.dataset.coords:
            return ""
        values = self.dataset["scatter"].values[sample].tolist()
        words = (f"{key} = {plain(one)}" for key, one in zip(self.dataset["scatter_key"].values, values, strict=True))
        return f" with sample {sample} of the scatter ({', '.join(words)})"

    @property
    def evaluations(self) -> int:
        """How many designs were evaluated."""
        return int(self.dataset.sizes["evaluation"])

    @checked
    def save(self, path: FilePath) -> None:
        """Write the result to a NetCDF-3 file, to be read by :func:`load_design`."""
        write_dataset(path, self.dataset)


def _shown_torque(torque: float) -> str:
    """A torque [N mm] in N m, as limits are kept."""
    return f"{plain(1e-3 * torque, 6)}"


def told_limit(limit: Limit, torques: Array) -> str:
    """A limit in words, as results keep it; of the torques [N mm] of the model."""
    under = ", ".join(_shown_torque(float(torques[t])) for t in limit.torques)
    return f"{limit.figure} <= {plain(limit.highest, 6)} at {under} N m"


@checked
def load_design(path: FilePath) -> DesignResult:
    """Read the result of a design.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, is no design, or lacks what all designs have.
    """
    dataset = read_dataset(path)
    if dataset.attrs.get("kind") != DESIGN:
        raise InputError(f"{path}: a result of loaded_tca, but no design; read it with load_result or load_study")
    renamed = {held + before: held + now for held in ("", "held_") for before, now in EARLIER.items()}
    dataset = dataset.rename({before: now for before, now in renamed.items() if before in dataset})
    for name in ("figure", "limits"):
        if isinstance(text := dataset.attrs.get(name), str):
            lines = (line.split(" ", 1) for line in text.splitlines())
            dataset.attrs[name] = "\n".join(" ".join([EARLIER.get(word, word), *rest]) for word, *rest in lines)
    figure = dataset.attrs.get("figure")
    require(
        *((isinstance(dataset.attrs.get(name), str), f"{name}: missing, or no text") for name in TEXTS),
        *((name in dataset, f"{name}: missing") for name in NUMBERS),
        (str(figure) in FIGURES, f"figure: {figure!r:.60}; allowed {', '.join(FIGURES)}"),
        owner=f"{path}: not the result of a design",
    )
    return DesignResult(dataset)
