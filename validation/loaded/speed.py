"""Time against error of the whole line, from a scene to the loaded mesh cycle.

Nine positions of a pitch of each mesh cycle in ``examples/scenes``, one torque, teeth that do not bend. Errors are
those against the finest cells: the largest of any position relative in the peak pressure and absolute in the load
shares, and relative in the peak to peak of the loaded transmission error. Times are medians of whole runs, unloaded
contact included. What whole cycles take is in ``validation.loaded.cycles``.

Run from the root of the repository: ``python -m validation.loaded.speed``; prints the table that
``validation.contact.speed_against_error`` writes.
"""

import statistics
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from validation.page import SCENES, table, timed

NAMES = ("mesh_cycle_spur", "mesh_cycle_helical", "mesh_cycle_bevel")
POSITIONS, RUNS = 9, 3
ACCURACIES, CELLS, FINEST = (1e-1, 1e-2, 1e-3, 1e-4), (16, 32, 64, 128), 256
FLANKS_ALONE: dict[str, Any] = {"analysis.compliance": "contact", "analysis.free_edges": False}


@dataclass(frozen=True)
class WholeLine:
    """One setting of one scene; the time in seconds."""

    scene: str
    setting: str
    seconds: float
    pressure: float
    share: float
    peak_to_peak: float


def measure(names: tuple[str, ...] = NAMES, runs: int = RUNS) -> list[WholeLine]:
    """Run every setting of the scenes."""
    return [line for name in names for line in _measured(name, runs)]


def table_of(found: list[WholeLine]) -> str:
    """One line a setting."""
    return table(
        "scene | setting | time s | pressure | load share | TE peak to peak",
        (
            f"{m.scene} | {m.setting} | {m.seconds:.2g} | {m.pressure:.1e} | {m.share:.1e} | {m.peak_to_peak:.1e}"
            for m in found
        ),
    )


def heading() -> str:
    """What the table shows."""
    return (
        f"Whole line, scene to loaded mesh cycle: {POSITIONS} positions, one torque, load shared over the tooth pairs. "
        f"Errors against {FINEST} x {FINEST} cells for each contact; times: medians of {RUNS} runs."
    )


def _measured(name: str, runs: int) -> list[WholeLine]:
    scene = read_scene(SCENES / f"{name}.toml")
    middle = 1e-3 * float(np.median(scene.torques))
    changes = {"analysis.positions": POSITIONS, "analysis.torques_Nm": [middle]}
    scene = scene.with_changes({**FLANKS_ALONE, **changes})
    finest, _ = _analysed(scene, "cells", (FINEST, FINEST), 1)
    settings: list[tuple[str, str, Any]] = [(f"accuracy {value:.0e}", "accuracy", value) for value in ACCURACIES]
    settings += [(f"{n} x {n} cells", "cells", (n, n)) for n in CELLS]
    found = []
    for words, key, value in settings:
        cycle, seconds = _analysed(scene, key, value, runs)
        found.append(WholeLine(name, words, seconds, *_errors(cycle, finest)))
    return found


def _analysed(scene: Scene, key: str, value: Any, runs: int) -> tuple[MeshCycle, float]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        cycle, times = timed(lambda: analyse(scene.with_changes({f"analysis.{key}": value})), runs)
    return cycle, statistics.median(times)


def _errors(cycle: MeshCycle, finest: MeshCycle) -> tuple[float, float, float]:
    """Of pressure, load share and peak to peak of the transmission error."""
    own, exact = (one.at_position("peak_pressure") for one in (cycle, finest))
    shares = [{int(k): one.load_share[..., n] for n, k in enumerate(one.pair)} for one in (cycle, finest)]
    share = max(
        np.abs(shares[0].get(k, 0.0) - shares[1].get(k, 0.0)).max() for k in shares[0].keys() | shares[1].keys()
    )
    heights = [np.ptp(one.transmission_error) for one in (cycle, finest)]
    return float(np.nanmax(np.abs(own / exact - 1.0))), float(share), abs(float(heights[0] / heights[1]) - 1.0)


if __name__ == "__main__":
    print(heading())
    print(table_of(measure()))
