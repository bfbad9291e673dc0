"""What the report of a design tells."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from loaded_tca.plots import plot_before_and_after, plot_peak_to_peak_over_torque
from loaded_tca.plots.labels import label_of
from loaded_tca.reports.page import Table, pictures_of
from loaded_tca.reports.result_page import explained, scene_content
from loaded_tca.results.summary import shown
from loaded_tca.scene import parse_scene
from loaded_tca.studies.design import DesignResult
from loaded_tca.studies.design_figures import FIGURES, FigureOfErrors

PEAK = "MPa", "peak pressure, largest over the positions"
CAPTIONS = {
    "before_and_after": "Transmission error and peak pressure over a pitch, load factor and peak-to-peak over the "
    "torque. Lines: mean of the samples of the scatter, bands: all of them.",
    "peak_to_peak": "Peak-to-peak transmission error over the torque.",
}


def design_content(design: DesignResult) -> dict[str, Any]:
    """Return what the template of a design takes.

    Parameters
    ----------
    design : DesignResult
    """
    found = design.dataset
    scene = parse_scene(found.attrs["scene_toml"], source="scene_toml", folder=None)
    minimised = FIGURES[found.attrs["figure"]]
    figures = {
        "before_and_after": plot_before_and_after(design),
        "peak_to_peak": plot_peak_to_peak_over_torque(design),
    }
    return {
        "title": scene.title or "Design",
        **scene_content(scene),
        "objective": f"{found.attrs['objective']} of the {minimised.text}"
        + (f" [{minimised.unit}]" if minimised.unit != "1" else ""),
        "objectives": Table(
            (
                ("by the full analysis", *(f"{one:.4g}" for one in design.objective)),
                ("on held contacts", *(f"{one:.4g}" for one in design.held_objective)),
            ),
            ("", "start", "optimum"),
        ),
        "values": _values(design),
        "limits": [*map(_told_limit, found.attrs["limits"].splitlines())],
        "scattered": _scattered(design),
        "seeds": found.attrs.get("seeds", ""),
        "evaluations": design.evaluations,
        "samples": found.sizes["sample"],
        "figures": _figures(design),
        "warnings": explained(found.attrs["warnings"].splitlines()),
        "pictures": pictures_of(figures, CAPTIONS, scene.title),
        "optimum_toml": scene.with_changes(design.optimum).to_toml(),
    }


def _told_limit(limit: str) -> str:
    """A limit with what its figure measures."""
    name = limit.partition(" ")[0]
    if name not in FIGURES:
        return limit
    figure = FIGURES[name]
    return f"{limit} ({figure.text}{'' if isinstance(figure, FigureOfErrors) else figure.note})"


def _values(design: DesignResult) -> Table:
    """What was designed, within which range."""
    found = design.dataset
    bounds = found["range"].values.tolist() if "range" in found else [(math.nan, math.nan)] * len(design.start)
    rows = (
        (label_of(key), key, *(shown(one, key) for one in (*ends, before, design.optimum[key])))
        for (key, before), ends in zip(design.start.items(), bounds, strict=True)
    )
    return Table(tuple(rows), ("what was designed", "key", "from", "to", "start", "optimum"), of_words=True)


def _scattered(design: DesignResult) -> Table | None:
    """What scatters, how, and over which values."""
    found = design.dataset
    rows = []
    for line in found.attrs.get("distributions", "").splitlines():
        key, _, words = line.partition(": ")
        values = found["scatter"].sel(scatter_key=key).values
        rows.append((label_of(key), key, words, shown(values.min(), key), shown(values.max(), key)))
    return Table(tuple(rows), ("what scatters", "key", "how", "from", "to"), of_words=True) if rows else None


def _figures(design: DesignResult) -> Table:
    """The worst value over the samples of each figure under each torque, of start and optimum."""
    found = design.dataset
    rows = []
    texts = {name: (figure.unit, figure.text) for name, figure in FIGURES.items()}
    for name, (unit, words) in {"peak_pressure": PEAK, **texts}.items():
        if name not in found:
            continue
        values = found[name].max("position") if name == "peak_pressure" else found[name]
        worst = np.fmax.reduce(values.transpose("design", "sample", "torque").values, axis=1)
        for k, torque in enumerate(found["torque"].values.tolist()):
            label = words + (f" [{unit.replace('um', 'µm')}]" if unit != "1" else "")
            rows.append((label, f"{1e-3 * torque:.4g}", *(shown(value, name) for value in worst[:, k].tolist())))
    return Table(tuple(rows), ("largest of the samples", "pinion torque [N m]", "start", "optimum"))
