"""What the report of a design tells."""

from __future__ import annotations

from typing import Any

import numpy as np

from loaded_tca.plots import plot_before_and_after, plot_peak_to_peak_over_torque
from loaded_tca.plots.labels import label_of
from loaded_tca.reports.page import Table, pictures_of
from loaded_tca.reports.result_page import explained, scene_content
from loaded_tca.results.summary import shown
from loaded_tca.scene import parse_scene
from loaded_tca.studies.design import FIGURE_TEXTS, DesignResult

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
    unit, words = FIGURE_TEXTS[found.attrs["figure"]]
    figures = {
        "before_and_after": plot_before_and_after(design),
        "peak_to_peak": plot_peak_to_peak_over_torque(design),
    }
    return {
        "title": scene.title or "Design",
        **scene_content(scene),
        "objective": f"{found.attrs['objective']} of the {words}" + (f" [{unit}]" if unit != "1" else ""),
        "objectives": Table(
            (
                ("by the full analysis", *(f"{one:.4g}" for one in design.objective)),
                ("on held contacts", *(f"{one:.4g}" for one in design.held_objective)),
            ),
            ("", "start", "optimum"),
        ),
        "values": Table(
            tuple(
                (label_of(key), key, shown(before, key), shown(design.optimum[key], key))
                for key, before in design.start.items()
            ),
            ("what was designed", "key", "start", "optimum"),
            of_words=True,
        ),
        "limits": found.attrs["limits"].splitlines(),
        "evaluations": design.evaluations,
        "samples": found.sizes["sample"],
        "figures": _figures(design),
        "warnings": explained(found.attrs["warnings"].splitlines()),
        "pictures": pictures_of(figures, CAPTIONS, scene.title),
        "optimum_toml": scene.with_changes(design.optimum).to_toml(),
    }


def _figures(design: DesignResult) -> Table:
    """The worst value over the samples of each figure under each torque, of start and optimum."""
    found = design.dataset
    rows = []
    for name, (unit, words) in FIGURE_TEXTS.items():
        if name not in found:
            continue
        worst = np.fmax.reduce(found[name].transpose("design", "sample", "torque").values, axis=1)
        for k, torque in enumerate(found["torque"].values.tolist()):
            label = words + (f" [{unit.replace('um', 'µm')}]" if unit != "1" else "")
            rows.append((label, f"{1e-3 * torque:.4g}", *(shown(value, name) for value in worst[:, k].tolist())))
    return Table(tuple(rows), ("largest of the samples", "pinion torque [N m]", "start", "optimum"))
