"""Sensitivities of loaded results against slopes through whole analyses, closed forms, and Monte Carlo studies.

The slope of the cubic through nine analyses, a step apart in one key, beside the derivative of the analysis in their
middle: every analysis places its boxes and grids anew, and their scatter enters the slope. Spread to first order beside
that of Monte Carlo studies of the same scene, over the size of the scatter. What twenty derivatives cost beside the
analysis: every scene and setting is a process of its own, in which analysis and derivatives take turns.

Run from the root of the repository, on a machine that does nothing else: ``python -m validation.loaded.sensitivities``;
writes docs/studies/sensitivities.md and its pictures.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.arrays import Array
from loaded_tca.plots.style import DISTINCT_COLOURS
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import Scene
from loaded_tca.studies import Study, process_pool, run_study
from loaded_tca.studies.ranking import figure_values
from validation.page import (
    SCENES,
    SPACED,
    Page,
    formatted,
    in_a_process,
    machine,
    median_ratio,
    medians,
    table,
    timed,
    write_page,
)
from validation.table import Row

SETTINGS: dict[str, dict[str, Any]] = {
    "flanks alone": {"analysis.compliance": "contact", "analysis.free_edges": False},
    "with bending": {},
}
CASE, ANALYSES = "sensitivities", "nine analyses"
GRIDS, POSITIONS, ASKED = (64, 128), 6, {64: 0.03, 128: 0.01, 256: 0.01}
PINION, WHEEL = "pinion.modifications.", "wheel.modifications."
MISALIGNMENT, CROWNING, SLOPE = "mounting.misalignment_um", f"{PINION}lead_crowning_um", f"{PINION}helix_slope_um"
TWIST, FINER = f"{PINION}twist_um", (*GRIDS, 192, 256)
CENTRE_DISTANCE, AXIAL_OFFSET = "mounting.centre_distance_error_mm", "mounting.axial_offset_mm"
STEPS = {
    "mesh_cycle_helical": {
        CROWNING: 2.0,
        SLOPE: 2.0,
        f"{PINION}profile_crowning_um": 2.0,
        f"{PINION}twist_um": 0.5,
        MISALIGNMENT: 2.0,
    },
    "mesh_cycle_spur": {
        CROWNING: 0.5,
        f"{PINION}tip_relief_um": 2.0,
        f"{WHEEL}tip_relief_um": 2.0,
        f"{PINION}tip_relief_start_mm": 0.05,
    },
    "mesh_cycle_bevel": {
        CROWNING: 2.0,
        SLOPE: 1.0,
        f"{PINION}profile_crowning_um": 1.0,
        "mounting.offset_mm": 3e-3,
        "mounting.pinion_axial_mm": 3e-3,
    },
}
"""Keys of each scene, and by how much the outer of the nine analyses differ from that in their middle."""
IN_ROWS = {
    "mesh_cycle_helical": (CROWNING, MISALIGNMENT),
    "mesh_cycle_spur": (CROWNING, f"{PINION}tip_relief_um"),
    "mesh_cycle_bevel": ("mounting.offset_mm", SLOPE),
}
"""Keys of ``whole_rows``; the last of each pair on the finer grid too."""
OF_TWIST = (GRIDS[0], FINER[-1])
"""Grids of the twist in ``whole_rows``: it moves the transmission error by 7 to 19 nm/um, so that what the cells leave,
0.1 to 0.2 nm/um on 128, is 1.2 % of it, and below 1 % from 256 on."""
IN_TABLE = (
    *((name, setting, GRIDS[0], keys[0]) for name, keys in IN_ROWS.items() for setting in SETTINGS),
    *((name, "flanks alone", GRIDS[0], keys[1]) for name, keys in IN_ROWS.items()),
    *((name, "with bending", GRIDS[1], keys[1]) for name, keys in IN_ROWS.items()),
    *(("mesh_cycle_helical", setting, GRIDS[0], TWIST) for setting in SETTINGS),
)
"""Scenes, settings, cells and keys of ``rows``: every key in both settings, one of each pair on the finer grid."""
PROMISED = {"load_share": 0.08, "line_load": 0.05, "peak_pressure": 0.05, "root_tension": ASKED[GRIDS[0]]}
"""Errors over the largest slope that the page states: where pairs stay, of pressures and line loads away from edges."""
OVER_VALUE = {"line_load": 0.01, "peak_pressure": 0.015, "face_load_factor": 0.025}
"""Errors times the step of the key, over the largest value of the figure, that the page states: at edges, and of
K_Hbeta, whose slope is that to one side of a kink."""
WITHOUT_KINK, OF_FACTOR = (CROWNING, f"{PINION}tip_relief_um"), 0.03
"""Keys that move K_Hbeta without a kink, and its error over the slope."""
PAIRS = {
    "mesh_cycle_helical": "helical 34/57",
    "mesh_cycle_spur": "spur 34/57",
    "mesh_cycle_bevel": "spiral bevel 17/17",
}
# Levers are those of flanks with modifications, whose normals are off by some 1e-4.
OF_CLOSED_FORMS = 1e-3
APART, OF_TWO = 2e-3, 1e-4
"""Centre distance [mm] by which two analyses are off the nominal one, and by what their slope may differ: its change
from 2 to 8 um is 4e-5."""
FIGURES = {
    "transmission_error": "transmission error",
    "load_share": "load share",
    "line_load": "line load",
    "peak_pressure": "peak pressure",
    "face_load_factor": "K_Hbeta",
    "root_tension": "root tension",
}

DEVIATIONS = {CROWNING: 0.75, SLOPE: 3.0, MISALIGNMENT: 4.0, CENTRE_DISTANCE: 0.02}
SCALES, SAMPLES, STUDY_POSITIONS = (0.25, 0.5, 1.0, 2.0), 256, 9
OF_STUDIES = {
    "transmission_error_mean_um": "mean TE [um]",
    "transmission_error_span_um": "peak-to-peak TE [um]",
    "face_load_factor": "K_Hbeta",
    "peak_pressure_MPa": "largest peak pressure [MPa]",
}
OUT_OF_LINE = {0.0: "aligned", 10.0: "10 um out of line"}

RUNS, ACCURACIES = 5, (1e-2, 1e-3)
BOTH_GEARS = [
    f"{gear}.modifications.{name}_um"
    for gear in ("pinion", "wheel")
    for name in ("lead_crowning", "profile_crowning", "helix_slope", "profile_slope", "twist", "tip_relief")
]
TORQUE = "load.pinion_torque_Nm"
KINDS = {
    "the torque alone": [TORQUE],
    "one modification": [CROWNING],
    "four modifications": [CROWNING, SLOPE, f"{PINION}profile_crowning_um", f"{WHEEL}lead_crowning_um"],
    "one mounting error": [CENTRE_DISTANCE],
    "four mounting errors": [CENTRE_DISTANCE, AXIAL_OFFSET, MISALIGNMENT, "mounting.in_plane_deg"],
}
"""Keys of ``helical.toml`` whose cost is told by kind."""
MOUNTING = {
    "cylindrical": (
        "in_plane_deg",
        "out_of_plane_deg",
        "misalignment_um",
        "centre_distance_error_mm",
        "axial_offset_mm",
    ),
    "bevel": ("offset_mm", "pinion_axial_mm", "wheel_axial_mm", "shaft_angle_error_deg"),
}


def reliefs(start: str, pinion: float, wheel: float) -> dict[str, Any]:
    """Tip reliefs on both gears, from where they start."""
    starts = {f"{PINION}{start}": pinion, f"{WHEEL}{start}": wheel}
    return {**starts, f"{PINION}tip_relief_um": 5.0, f"{WHEEL}tip_relief_um": 5.0}


def twenty(kind: str, changes: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Changes of a scene and twenty keys: modifications, mounting errors, the torque, and of the changes."""
    keys = [*BOTH_GEARS, *(f"mounting.{name}" for name in MOUNTING[kind]), TORQUE]
    return changes, [*keys, *(key for key in changes if key not in keys)][:20]


TWENTY = {
    "mesh_cycle_helical": twenty("cylindrical", reliefs("tip_relief_start_mm", 105.5, 176.5)),
    "mesh_cycle_spur": twenty("cylindrical", reliefs("tip_relief_start_mm", 105.6, 174.6)),
    "mesh_cycle_bevel": twenty(
        "bevel",
        {
            **reliefs("tip_relief_start_roll_deg", 24.0, 24.0),
            f"{PINION}end_relief_um": 3.0,
            f"{PINION}end_relief_length_mm": 0.8,
        },
    ),
}
"""Changes of each scene, by which it has all keys, and its keys."""


@cache
def analysed(name: str, setting: str, cells: int, changes: tuple[tuple[str, Any], ...] = ()) -> MeshCycle:
    """Analysis of a scene under its one torque, on given cells."""
    wanted = {"analysis.accuracy": None, "analysis.cells": (cells, cells), "analysis.torques_Nm": None}
    scene = read_scene(SCENES / f"{name}.toml").with_changes(
        {**wanted, "analysis.positions": POSITIONS, "analysis.root_stress": True, **SETTINGS[setting], **dict(changes)}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        return analyse(scene)


def value_of(scene: Scene, key: str) -> float:
    """Value of a key."""
    value: Any = scene
    for part in key.split("."):
        value = getattr(value, part)
    return float(value)


@dataclass(frozen=True)
class Agreement:
    """Derivatives of a figure to a key beside the slopes of cubics through nine analyses.

    Attributes
    ----------
    found, slopes, scatter : (positions,) or (positions, pairs) arrays, or numbers
        Derivative, slope, and the standard error of the slope by what the cubic leaves of the nine analyses.
    steady : array of bool
        Where the same tooth pairs carry load in all nine, and the largest root tension is that of the same tooth.
    edge : array of bool
        Where one of the nine contacts reaches an edge or a relief start.
    """

    found: Array
    slopes: Array
    scatter: Array
    steady: Array
    edge: Array
    scale: float
    """Step of the key over the largest value of the figure."""

    @property
    def smooth(self) -> Array:
        """Where pairs stay, away from edges."""
        return np.asarray(self.steady & ~self.edge)

    def over_largest(self, where: Array) -> tuple[float, float]:
        """Largest difference and largest standard error at chosen places, over the largest slope where pairs stay."""
        if not where.any():
            return float("nan"), float("nan")
        largest = np.abs(self.slopes[self.steady]).max()
        errors = np.abs(self.found - self.slopes)[where].max(), self.scatter[where].max()
        return float(errors[0] / largest), float(errors[1] / largest)

    def over_value(self, where: Array) -> tuple[float, float]:
        """Largest difference and largest standard error at chosen places times the step, over the largest value."""
        if not where.any():
            return float("nan"), float("nan")
        errors = np.abs(self.found - self.slopes)[where].max(), self.scatter[where].max()
        return float(errors[0] * self.scale), float(errors[1] * self.scale)


def nine(name: str, setting: str, cells: int, key: str) -> tuple[Array, list[MeshCycle]]:
    """Values of a key and the analyses with them."""
    middle, step = value_of(analysed(name, setting, cells).scene, key), STEPS[name][key]
    values = np.linspace(middle - step, middle + step, 9)
    changes = [((key, value),) if value != middle else () for value in values.tolist()]
    return values, [analysed(name, setting, cells, change) for change in changes]


@cache
def agreements(name: str, setting: str, cells: int, key: str) -> dict[str, Agreement]:
    """Derivatives of all figures to a key beside slopes through analyses."""
    values, cycles = nine(name, setting, cells, key)
    loaded = np.array([one.load_share[0] > 0.0 for one in cycles])
    steady = (loaded == loaded[4]).all(axis=(0, 2))
    rough = np.array([(one.on_edge[0] > 0) | (one.on_relief_start[0] > 0) for one in cycles]).any(axis=0)
    roots = np.array([one.root_tension_place[0, :, :, :2] for one in cycles])
    same_root = (roots == roots[4]).all(axis=(0, 3))  # tooth and side
    nowhere = np.zeros(same_root.shape, bool)
    where = {
        "transmission_error": (steady, nowhere[:, 0]),
        "face_load_factor": (np.array(True), np.array(False)),
        "root_tension": (steady[:, None] & same_root, nowhere),
    }
    derivatives, found = cycles[4].sensitivities([key]), {}
    for figure in FIGURES:
        numbers = np.array([getattr(one, figure)[0] for one in cycles])
        slopes, scatter = cubic(values - values[4], numbers)
        own = getattr(derivatives, figure)[0, ..., 0]
        scale = STEPS[name][key] / float(np.nanmax(np.abs(numbers[4])))
        found[figure] = Agreement(own, slopes, scatter, *where.get(figure, (steady[:, None] & loaded[4], rough)), scale)
    return found


def cubic(steps: Array, values: Array) -> tuple[Array, Array]:
    """Slope in the middle of the cubics through values (steps, ...), and its standard error by what they leave."""
    powers = np.vander(steps, 4)
    inverse = np.linalg.pinv(powers)
    parts = inverse @ values.reshape(len(steps), -1)
    left = values.reshape(len(steps), -1) - powers @ parts
    deviation = np.sqrt((left**2).sum(axis=0) / (len(steps) - 4))
    error = deviation * np.linalg.norm(inverse[-2])
    return parts[-2].reshape(values.shape[1:]), error.reshape(values.shape[1:])


def closed_forms(setting: str, cells: int) -> dict[str, tuple[float, Array]]:
    """Of the helical pair: what is expected, and what each position has.

    Where the teeth bend the centre distance changes that, too: the same forces then act higher on the wheel's teeth.
    """
    one = analysed("mesh_cycle_helical", setting, cells)
    found, mesh = one.sensitivities([CENTRE_DISTANCE, AXIAL_OFFSET]), one.scene.mesh()
    moved = found.transmission_error[0] * one.wheel_base_radius
    removed = [sum(part.sum() for part in row if part is not None) for row in found.weight_maps[0]]
    forms = {
        "sum of the weights of removal times the lever": (1.0, np.array(removed) * one.path.wheel_lever),
        "r_b2 dTE per mm of axial offset: tan(beta_b)": (np.tan(abs(mesh.pinion.base_helix_angle)), moved[:, 1]),
    }
    if one.scene.analysis.compliance == "contact":
        by_distance = "r_b2 dTE per mm of centre distance: -sin(alpha_wt)"
        forms[by_distance] = -np.sin(mesh.working_pressure_angle), moved[:, 0]
    return forms


def row_of_bending_by_distance() -> Row:
    """Of the helical pair with bending: derivative to the centre distance against two analyses, the worst position."""
    one = analysed("mesh_cycle_helical", "with bending", GRIDS[0])
    found = one.sensitivities([CENTRE_DISTANCE]).transmission_error[0, :, 0]
    low, high = (
        analysed("mesh_cycle_helical", "with bending", GRIDS[0], ((CENTRE_DISTANCE, by),)) for by in (-APART, APART)
    )
    slopes = (high.transmission_error - low.transmission_error)[0] / (2.0 * APART)
    worst = int(np.abs(found / slopes - 1.0).argmax())
    quantity = "r_b2 dTE per mm of centre distance, worst position, with bending"
    radius = one.wheel_base_radius
    return Row(CASE, "two analyses", quantity, float(radius * slopes[worst]), float(radius * found[worst]), OF_TWO)


def rows() -> list[Row]:
    """Closed forms, and derivatives of all figures against analyses."""
    return [*rows_of_closed_forms(), *(row for where in IN_TABLE for row in rows_of(*where))]


def whole_rows() -> list[Row]:
    """The same of all keys on both grids, and what they cost."""
    every = [
        *((name, GRIDS[0], key) for name, keys in IN_ROWS.items() for key in keys),
        *((name, GRIDS[1], keys[-1]) for name, keys in IN_ROWS.items()),
        *(("mesh_cycle_helical", cells, TWIST) for cells in OF_TWIST),
    ]
    found = [row for name, cells, key in every for setting in SETTINGS for row in rows_of(name, setting, cells, key)]
    return [*rows_of_closed_forms(), *found, *rows_of_cost()]


def rows_of_closed_forms() -> list[Row]:
    """Closed forms, and two analyses where teeth bend."""
    found = []
    for setting in SETTINGS:
        for what, (expected, values) in closed_forms(setting, GRIDS[0]).items():
            worst = float(values[np.abs(values - expected).argmax()])
            quantity = f"{what}, worst position, {setting}"
            found.append(Row(CASE, "closed form", quantity, float(expected), worst, OF_CLOSED_FORMS))
    return [*found, row_of_bending_by_distance()]


def rows_of(name: str, setting: str, cells: int, key: str) -> Iterator[Row]:
    """Every figure by one key: over the largest slope; at edges and kinks over the value of the figure."""
    for figure, one in agreements(name, setting, cells, key).items():
        words = f"d {FIGURES[figure]}/d {short(key)} of {PAIRS[name]}, {setting}, {cells} cells"
        largest, value = "error/largest", "error times step/value"
        promised = PROMISED.get(figure)
        if figure == "transmission_error":
            judged = [(largest, one.over_largest(one.steady), ASKED[cells])]
        elif figure == "face_load_factor" and key in WITHOUT_KINK:
            judged = [(largest, one.over_largest(one.steady), OF_FACTOR)]
        elif figure == "face_load_factor":
            judged = [(value, one.over_value(one.steady), OVER_VALUE[figure])]
        elif figure in OVER_VALUE:
            judged = [
                (largest, one.over_largest(one.smooth), promised),
                (f"{value}, at edges", one.over_value(one.steady & one.edge), OVER_VALUE[figure]),
            ]
        else:
            judged = [(largest, one.over_largest(one.steady), promised)]
        for quantity, (worst, scatter), allowed in judged:
            if not np.isnan(worst):  # there are such places
                note = f"standard error of the slope {scatter:.1e}"
                yield Row(CASE, ANALYSES, f"{words}: {quantity}", 0.0, worst, allowed, note=note)


def short(key: str) -> str:
    """Key without its section, unless that is the wheel's."""
    section, _, name = key.rpartition(".")
    return f"wheel's {name}" if section.startswith("wheel") else name


@dataclass(frozen=True)
class Scattered:
    """Figures of a scene whose keys scatter.

    Attributes
    ----------
    nominal : dict of str to float
        Figures without scatter.
    first_order : dict of str to float
        Their standard deviations to first order, at scale one.
    studies : dict of float to (str to (samples,) array)
        Figures of the samples of a study, by the scale of all deviations; NaN where one is refused.
    """

    nominal: dict[str, float]
    first_order: dict[str, float]
    studies: dict[float, dict[str, Array]]

    def ratio(self, scale: float, figure: str) -> float:
        """Standard deviation of a study over that to first order."""
        return float(np.nanstd(self.studies[scale][figure], ddof=1)) / (scale * self.first_order[figure])

    def shift(self, scale: float, figure: str) -> float:
        """Mean of a study less the nominal value, over the standard deviation of the study."""
        values = self.studies[scale][figure]
        return float((np.nanmean(values) - self.nominal[figure]) / np.nanstd(values, ddof=1))


def scattered(out_of_line: float) -> Scattered:
    """Figures of the helical pair out of line by a mean misalignment [um], to first order and in studies."""
    from scipy.stats import norm

    means = {CROWNING: 5.0, SLOPE: 0.0, MISALIGNMENT: out_of_line, CENTRE_DISTANCE: 0.0}
    scene = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(
        {**SETTINGS["flanks alone"], **means, "analysis.torques_Nm": None, "analysis.positions": STUDY_POSITIONS}
    )
    studies = {}
    with warnings.catch_warnings(), process_pool(2) as executor:
        warnings.simplefilter("ignore", AccuracyWarning)
        result = analyse(scene)
        for scale in SCALES:
            distributions = {key: norm(means[key], scale * sigma) for key, sigma in DEVIATIONS.items()}
            found = run_study(Study(scene, distributions=distributions, samples=SAMPLES, seed=1), executor)
            studies[scale] = {figure: figure_values(found, figure)[:, 0] for figure in OF_STUDIES}
    nominal = {figure: float(result.key_figures()[0][figure]) for figure in OF_STUDIES}
    return Scattered(nominal, first_order(result), studies)


def first_order(result: MeshCycle) -> dict[str, float]:
    """Standard deviations of the figures of studies to first order."""
    slopes = result.sensitivities(list(DEVIATIONS))
    spread, deviations = slopes.spread(DEVIATIONS), np.array(list(DEVIATIONS.values()))
    length = 1e3 * result.wheel_base_radius
    mean = np.trapezoid(slopes.transmission_error[0], axis=0) / (len(result.pinion_angle) - 1)
    highest = np.unravel_index(np.nanargmax(result.peak_pressure), result.peak_pressure.shape)
    values = (
        length * np.linalg.norm(mean * deviations),
        length * spread["peak_to_peak"].values[0],
        spread["face_load_factor"].values[0],
        spread["peak_pressure"].values[highest],
    )
    return dict(zip(OF_STUDIES, map(float, values), strict=True))


def cost(name: str, setting: str, accuracy: float) -> dict[str, float]:
    """Processor time of an analysis and of its sensitivities [s], medians of runs that take turns."""
    scene = read_scene(SCENES / f"{name}.toml").with_changes(
        {**SETTINGS[setting], **TWENTY[name][0], "analysis.accuracy": accuracy}
    )
    times: dict[str, list[float]] = {"analysis": [], "sensitivities": []}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        analyse(scene)
        for _ in range(RUNS):
            result, analysis = timed(lambda: analyse(scene), clock=time.process_time)
            finite, own = timed(lambda of=result: all_finite(of, TWENTY[name][1]), clock=time.process_time)
            if not finite:
                raise AssertionError("a state without sensitivities")
            times["analysis"] += analysis
            times["sensitivities"] += own
    return {**medians(times), "ratio": median_ratio(times["sensitivities"], times["analysis"])}


def cost_of_kinds() -> dict[str, float]:
    """Processor time of derivatives of the transmission error by keys of each kind over that of the analysis."""
    scene = read_scene(SCENES / "helical.toml")
    analyses: list[float] = []
    times: dict[str, list[float]] = {kind: [] for kind in KINDS}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        analyse(scene)
        for _ in range(RUNS):
            result, analysis = timed(lambda: analyse(scene), clock=time.process_time)
            analyses += analysis
            for kind, keys in KINDS.items():
                times[kind] += timed(
                    lambda of=result, by=keys: of.sensitivities(by).transmission_error, clock=time.process_time
                )[1]
    return {kind: median_ratio(own, analyses) for kind, own in times.items()}


def rows_of_cost() -> Iterator[Row]:
    """What keys of each kind cost; shown alone, as it is another on every machine."""
    for kind, ratio in in_a_process(cost_of_kinds).items():
        words = f"processor time of d transmission error by {kind}, over the analysis, helical.toml"
        yield Row(CASE, "its analysis", words, 0.0, ratio, None)


def all_finite(result: MeshCycle, keys: list[str]) -> bool:
    """Whether every state has sensitivities of the transmission error and of the pressure norm."""
    found = result.sensitivities(keys)
    return bool(np.isfinite(found.transmission_error).all() and np.isfinite(found.pressure_norm()).all())


def percent(numbers: tuple[float, float]) -> str:
    """Error and, in brackets, the standard error of what it is related to."""
    return "none" if np.isnan(numbers[0]) else f"{100.0 * numbers[0]:.2f} % ({100.0 * numbers[1]:.2f})"


def of_transmission_error() -> str:
    """Errors of the derivatives of the transmission error on both grids."""
    found = []
    for name, steps in STEPS.items():
        for key, step in steps.items():
            for setting in SETTINGS:
                both = [agreements(name, setting, cells, key)["transmission_error"] for cells in GRIDS]
                largest = (
                    f"{np.abs(both[-1].slopes).max() * 1e6 * analysed(name, setting, GRIDS[0]).wheel_base_radius:.3g}"
                )
                left_out = POSITIONS - int(both[-1].steady.sum())
                errors = [percent(one.over_largest(one.steady)) for one in both]
                found.append([PAIRS[name], f"`{short(key)}`", f"{step:g}", setting, largest, *errors, f"{left_out}"])
    asked = " | ".join(f"{cells} cells, asked {100.0 * ASKED[cells]:.0f} %" for cells in GRIDS)
    head = f"pair | key | step | setting | largest slope [nm per unit] | {asked} | positions left out"
    return table(head, found, SPACED)


def of_twist() -> str:
    """Errors of the derivative of the transmission error to the twist of the helical pair on finer grids, too."""
    found = []
    for setting in SETTINGS:
        every = [agreements("mesh_cycle_helical", setting, cells, TWIST)["transmission_error"] for cells in FINER]
        found.append([setting, *(percent(one.over_largest(one.steady)) for one in every)])
    return table(f"setting | {' | '.join(f'{cells} cells' for cells in FINER)}", found, SPACED)


def of_other_figures() -> str:
    """Errors of the derivatives of other figures on the finer grid."""
    found = []
    for name, steps in STEPS.items():
        for key in steps:
            for setting in SETTINGS:
                of = agreements(name, setting, GRIDS[1], key)
                cells = [percent(of["load_share"].over_largest(of["load_share"].steady))]
                for figure in ("line_load", "peak_pressure"):
                    one = of[figure]
                    cells += [percent(one.over_largest(where)) for where in (one.smooth, one.steady & one.edge)]
                one = of["face_load_factor"]
                found.append([PAIRS[name], f"`{short(key)}`", setting, *cells, percent(one.over_largest(one.steady))])
    figures = "load share | line load | line load, at edges | peak pressure | peak pressure, at edges | K_Hbeta"
    return table(f"pair | key | setting | {figures}", found, SPACED)


def of_root_tension() -> str:
    """Errors of the derivatives of root tension on the coarser grid."""
    found = []
    for name, keys in IN_ROWS.items():
        for key in keys:
            every = [agreements(name, setting, GRIDS[0], key)["root_tension"] for setting in SETTINGS]
            found.append([PAIRS[name], f"`{short(key)}`", *(percent(one.over_largest(one.steady)) for one in every)])
    return table(f"pair | key | {' | '.join(SETTINGS)}", found, SPACED)


def of_closed_forms() -> str:
    """Closed forms and what the positions have."""
    found = []
    for setting in SETTINGS:
        for cells in GRIDS:
            for what, (expected, values) in closed_forms(setting, cells).items():
                ends = f"{values.min():.6f} to {values.max():.6f}"
                found.append([what, setting, f"{cells}", f"{expected:.6f}", ends])
    return table("quantity | setting | cells | closed form | least and largest of the positions", found, SPACED)


def of_cost() -> str:
    """Time of twenty derivatives over that of the analysis."""
    found = []
    for name in PAIRS:
        for setting in SETTINGS:
            for accuracy in ACCURACIES:
                one = in_a_process(cost, name, setting, accuracy)
                times = [*formatted(".2f", one["analysis"], one["sensitivities"]), f"{100.0 * one['ratio']:.0f} %"]
                found.append([PAIRS[name], setting, f"{accuracy:g}", *times])
                print(*found[-1], flush=True)
    return table("pair | setting | accuracy | analysis [s] | sensitivities [s] | ratio", found, SPACED)


def of_kinds() -> str:
    """The same by the kind of the keys."""
    ratios = in_a_process(cost_of_kinds)
    return table("keys | ratio", [[kind, f"{100.0 * ratio:.0f} %"] for kind, ratio in ratios.items()], SPACED)


def of_studies(scenes: Mapping[float, Scattered]) -> str:
    """Standard deviations of studies beside those to first order."""
    found = []
    for out_of_line, one in scenes.items():
        for figure, words in OF_STUDIES.items():
            for scale in SCALES:
                deviation = float(np.nanstd(one.studies[scale][figure], ddof=1))
                sizes = formatted(".3g", one.nominal[figure], scale * one.first_order[figure], deviation)
                ratio, shift = f"{one.ratio(scale, figure):.2f}", f"{one.shift(scale, figure):+.2f}"
                found.append([OUT_OF_LINE[out_of_line], words, f"{scale:g}", *sizes, ratio, shift])
    return table("scene | figure | scale | nominal | first order | study | ratio | shift of the mean", found, SPACED)


def picture_of_studies(scenes: Mapping[float, Scattered]) -> Figure:
    """Ratio of the standard deviations over the scale, a panel for each scene."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    panels = figure.subplots(1, len(scenes), sharey=True)
    for axes, (out_of_line, one) in zip(panels, scenes.items(), strict=True):
        axes.set_prop_cycle(color=DISTINCT_COLOURS)
        for name, marker in zip(OF_STUDIES, "osD^", strict=True):
            ratios = [one.ratio(scale, name) for scale in SCALES]
            axes.plot(SCALES, ratios, marker=marker, label=OF_STUDIES[name].partition(" [")[0])
        axes.axhline(1.0, color="0.6", linewidth=0.8)
        axes.set(xscale="log", title=f"helical 34/57, {OUT_OF_LINE[out_of_line]}", xlabel="scale of all deviations")
        axes.set_xticks(SCALES, [f"{scale:g}" for scale in SCALES], minor=False)
        axes.minorticks_off()
    panels[0].set(ylabel="deviation of the study / first order", ylim=(0.0, None))
    panels[0].legend()
    return figure


SHOWN = ("mesh_cycle_helical", "flanks alone", 128, MISALIGNMENT)
"""Scene, setting, cells and key of the picture of analyses."""


def picture_of_analyses() -> Figure:
    """Figures of nine analyses over the key, with the derivative of that in the middle as a line."""
    name, setting, cells, key = SHOWN
    values, cycles = nine(*SHOWN)
    derivatives, middle = cycles[4].sensitivities([key]), cycles[4]
    length = 1e3 * middle.wheel_base_radius
    corner = np.unravel_index(
        np.nanargmax(np.where(middle.on_edge[0] > 0, middle.edge_pressure[0], np.nan)), middle.on_edge[0].shape
    )
    panels = [
        ("transmission error, third position [µm]", "transmission_error", (0, 2), length),
        ("peak-to-peak transmission error [µm]", "peak_to_peak", (0,), length),
        ("line load of a corner contact [N/mm]", "line_load", (0, *corner), 1.0),
        ("face load factor K_Hβ", "face_load_factor", (0,), 1.0),
    ]
    figure = Figure(figsize=(9.0, 6.0), layout="constrained")
    for axes, (words, quantity, place, unit) in zip(figure.subplots(2, 2).flat, panels, strict=True):
        if quantity == "peak_to_peak":
            found = np.array([np.ptp(one.transmission_error[0]) for one in cycles])
        else:
            found = np.array([getattr(one, quantity)[place] for one in cycles])
        slope = float(getattr(derivatives, quantity)[(*place, 0)])
        axes.set_prop_cycle(color=DISTINCT_COLOURS)
        axes.plot(values, unit * found, "o", label="analyses")
        axes.plot(values, unit * (found[4] + slope * (values - values[4])), label="derivative in the middle")
        axes.set(xlabel="misalignment [µm]", ylabel=words)
        axes.ticklabel_format(useOffset=False)
    figure.axes[0].legend()
    figure.suptitle(f"{PAIRS[name]}, {setting}, {cells} x {cells} cells")
    return figure


def page() -> Page:
    """Measure everything; text and pictures."""
    scenes = {out_of_line: scattered(out_of_line) for out_of_line in OUT_OF_LINE}
    pictures = {"sensitivities_scatter": picture_of_studies(scenes), "sensitivities_analyses": picture_of_analyses()}
    return Page("sensitivities", text_of(scenes), pictures, dots_per_inch=110)


def text_of(scenes: Mapping[float, Scattered]) -> str:
    """Markdown with all tables."""
    deviations = ", ".join(f"`{short(key)}` {sigma:g}" for key, sigma in DEVIATIONS.items())
    return f"""# Sensitivities against whole analyses and Monte Carlo studies

Written by `python -m validation.loaded.sensitivities`. How the derivatives are found is in
[sensitivities](../how_it_works/sensitivities.md).

## Against slopes through nine analyses

The mesh cycles of `examples/scenes`, {POSITIONS} positions, the middle torque, one grid size for all contacts; flanks
alone (`compliance = "contact"`, no free edges), and with bending (the defaults). A slope is that of the cubic through
nine analyses, equally spaced from -step to +step around the value of the scene. An error is the largest difference of
any position (and tooth pair) over the largest slope of any; in brackets the largest standard error of a slope, from
the residuals of the cubic, over the same slope. It is the scatter of the analyses, each of which places its boxes and
grids anew.

{of_transmission_error()}

The twist of the helical pair, which moves the transmission error least, is off by 0.1 to 0.2 nm/um on {GRIDS[1]} cells.
That is the grid:

{of_twist()}

Left out are positions at which a tooth pair comes into contact or leaves it among the nine analyses: its force starts
at zero, but the curvature has a jump there, which a cubic cannot follow. The cubic is wrong then: for the profile
crowning of the spiral bevel pair with bending, where a pair with 1.6 % of the load leaves, the difference on 64 cells
was 16.9, 5.9 and 1.9 % with steps of 2, 1 and 0.5 um. Contacts that begin to reach an edge within the step do the
same to a lesser degree; the twist of the helical pair, whose slopes are the smallest, has a step of 0.5 for that
reason.

A misalignment or helix slope of the spur pair is not in the table: by symmetry the slopes are zero.

## Other figures

As above, on {GRIDS[1]} cells along each axis. Contacts "at edges" are those that reach an edge of a flank or the start
of a linear relief in one of the nine analyses; errors of both kinds are over the largest slope of all contacts.

{of_other_figures()}

Where tooth pairs stay and contacts reach no edge, the derivatives of line loads and peak pressures are within 5 % of
the largest slope, those of load shares within 5 % everywhere. At edges, and for
K_Hbeta, slopes themselves are small or jump: there the error times the step of the key is at most 1 % of the largest
line load, 1.5 % of the largest peak pressure and 2.5 % of K_Hbeta. K_Hbeta over the lead crowning and the pinion's tip
relief, which move it without a kink, is within 3 % of the slope, over the wheel's tip relief within 10 %.

Three figures have larger errors than the transmission error, and finer grids do not reduce them:

- **Corners.** A tip corner carries a few percent of the load on a few cells at a sharp edge. Its line load and pressure
  depend on the grid, and their derivatives with them; so do those of the largest pressure where such a corner has it.
- **K_Hbeta** is a maximum over 30 strips. Where two strips have the same force, as in an aligned pair under a
  misalignment, it has a kink: there the derivative is that to one side, and the cubic has the mean of both. Away from
  kinks its slopes through analyses scatter (the numbers in brackets), since cells come and go in a strip.

![Figures of the helical pair over its misalignment: nine analyses and the derivative](sensitivities_analyses.png)

## Root tension

On {GRIDS[0]} cells along each axis, asked {100.0 * ASKED[GRIDS[0]]:.0f} %: both gears, all positions at which the
largest tension stays with one side of one tooth.

{of_root_tension()}

## Closed forms

Helical pair 34/57. Removal all over the flanks turns the wheel by itself over the lever. Involutes stay conjugate
when the gears are moved: the line of action shifts by sin(alpha_wt) per mm of centre distance and by tan(beta_b) per
mm of axial offset, whatever the load. Single positions differ from the first formula, since the crowning turns the
normals. Where teeth bend it does not hold: farther apart, the forces act higher on the wheel's teeth, which bend more.

{of_closed_forms()}

## First order against Monte Carlo

Helical pair 34/57, flanks alone, accuracy 1e-2, {STUDY_POSITIONS} positions, 130 N m. Normal distributions with the
deviations {deviations}, times the scale; {SAMPLES} Sobol samples for each study, whole analyses. "First order" is
`s.spread(...)`, for the mean TE the same of the mean of the slopes; "ratio" is that of the two standard deviations,
"shift of the mean" that of the study less the nominal value, over the standard deviation.

{of_studies(scenes)}

![Standard deviation of studies over that to first order, over the scale](sensitivities_scatter.png)

The mean transmission error is linear throughout: the centre distance moves it, by a closed form. The others are not.
Aligned, first order holds within a fifth at a quarter of the deviations. At their full size it gives twice the
scatter of the peak-to-peak, since other positions become the highest and the lowest and the slope changes its sign,
and too little scatter of K_Hbeta and the pressure, which rise with a misalignment to either side. Ten micrometres out
of line contacts reach the ends of the face: pressure and K_Hbeta scatter three to four times as much as their slopes
say. The shift of the mean is a second-order effect and a measure of the error: where it is beyond a tenth of the
deviation, first order is not accurate. Flanks that do not bend are the harder case, as teeth that bend even out the
load.

## Cost

Transmission error and pressure norm of all positions (33 positions, three torques) for twenty keys, beside the analysis
whose result they are derivatives of: processor time in one process with one thread, medians of {RUNS} runs that take
turns, and of their ratios. Scenes with tip reliefs on both gears. {machine()}.
Five of the twenty keys are mounting errors, below which teeth bend anew, two are starts of reliefs; with bending both
solutions are of force lines that follow the forces. Differences of analyses would need twenty to forty analyses. The
aim, half of one analysis, is not reached.

{of_cost()}

The transmission error of `helical.toml` (21 positions, one torque), by the kind of the keys: that of the torque is
what all keys share, the solution with force lines that follow the forces and how these bend the teeth.

{of_kinds()}
"""


if __name__ == "__main__":
    write_page(__doc__, page)
