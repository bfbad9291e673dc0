"""Result of a design: what its dataset holds, and its file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from loaded_tca.errors import InputError, require
from loaded_tca.results.files import FilePath, Part, read_dataset, write_dataset
from loaded_tca.results.quantities import GEARS
from loaded_tca.studies.design_figures import FIGURES

if TYPE_CHECKING:
    import xarray

KIND = "design"
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
class DesignResult:
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
        told = self.dataset.attrs["warnings"].count("\n") + 1 if self.dataset.attrs["warnings"] else 0
        values = ", ".join(f"{key} = {value:.4g}" for key, value in self.optimum.items())
        figure = f"{self.dataset.attrs['objective']} of {self.dataset.attrs['figure']}"
        warned = f", {told} accuracy warnings in dataset.attrs" if told else ""
        return f"DesignResult({figure}: {before:.4g} -> {after:.4g}, {values}{warned})"

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
    def evaluations(self) -> int:
        """How many designs were evaluated."""
        return int(self.dataset.sizes["evaluation"])

    def save(self, path: FilePath) -> None:
        """Write the result to a NetCDF-3 file, to be read by :func:`load_design`."""
        write_dataset(path, self.dataset)


def load_design(path: FilePath) -> DesignResult:
    """Read the result of a design.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, is no design, or lacks what all designs have.
    """
    dataset = read_dataset(path)
    if dataset.attrs.get("kind") != KIND:
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
