r"""Micro-geometry designed with exact gradients: quiet on average, or still quiet where the mounting scatters.

With J_s the mean over the torques of a figure of sample s, the objective is its mean over the samples, mean + k sigma,
or a percentile. It is minimised by sequential quadratic programming (``scipy.optimize``, SLSQP) over the keys scaled to
their ranges, under limits on other figures. All of it works on held contacts (:class:`DesignModel`); at the end the
package's own analysis of start and optimum, at the accuracy of the scene, has to confirm what was found.

References
----------
Kraft 1994, ACM Trans. Math. Softw. 20, 262-281 (SLSQP); Bertsimas, Nohadani & Teo 2010, Oper. Res. 58, 161-178 (robust
optimisation by gradients).
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.arrays import Array, real
from loaded_tca.errors import ConvergenceError, InputError, noted_accuracy_warnings, require
from loaded_tca.plain import plain
from loaded_tca.rating.inputs import FEWEST as FEWEST_RATED
from loaded_tca.rating.utilisation import utilisation_of
from loaded_tca.results.files import DESIGN, variables_of
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.warnings import without_place
from loaded_tca.scene import Scene
from loaded_tca.studies.design_figures import (
    FIGURES,
    SMOOTHING,
    FigureOfErrors,
    FigureOfStrength,
    Limit,
    Objective,
    figures_of_strength,
    mean_pressure_norm,
    root_tension_norm,
)
from loaded_tca.studies.design_model import DesignModel, Evaluation
from loaded_tca.studies.design_result import PARTS, DesignResult, load_design, told_limit
from loaded_tca.studies.study import MOST_VARIANTS, is_finite, is_whole
from loaded_tca.threads import one_thread
from loaded_tca.tribology import tribology_of

if TYPE_CHECKING:
    import xarray

__all__ = ["DesignModel", "DesignResult", "Evaluation", "load_design", "optimise", "robustness"]

MOST_ITERATIONS = 50
ACCURACY = 1e-5
"""Of the objective, relative, at which SLSQP stops. At 1e-3 it gives up where a short step gains little, half way."""
ROUNDING = 1e-12
"""Part of the range of a key from its bounds within which SLSQP, which means the bound, leaves its rounding."""
MOST_BASES, SCATTER = 2, 0.02
"""How often a search on supports goes on from its optimum in a model based there, which differs in its transmission
error by more than so much [um]: two grids alone differ by as much on soft shafts."""
KEPT = 2e-3
"""Part of a limit by which a design may exceed it and still meet it: SLSQP meets limits to rounding of its steps."""
Limits = Mapping[str, float | Mapping[float, float]]
Progress = Callable[[int, float, float], None]
"""Called with the number of designs evaluated, the objective of the last one, the part by which it exceeds a limit."""


def optimise(
    model: DesignModel,
    objective: str = "mean + k sigma",
    limits: Limits | None = None,
    *,
    k: float = 1.0,
    percentile: float = 90.0,
    figure: str = "smooth_span_um",
    starts: int = 1,
    seed: int = 0,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> DesignResult:
    """Design the micro-geometry of a model.

    Parameters
    ----------
    model : DesignModel
    objective : {"mean", "mean + k sigma", "percentile"}
        Of the figure, its mean over the torques, over the samples of the scatter.
    limits : mapping, optional
        Figure -> its highest value under every torque with every sample, or a mapping of torques [N mm] to values.
        ``pressure_MPa`` is a norm, above or below the peak pressure by up to a third; ``edge_pressure_norm_MPa`` keeps
        contacts away from the ends of the flanks. Both leave out what a sharp edge owes to the cells.
    k : float
        Standard deviations on top of the mean.
    percentile : float
        From 0 to 100.
    figure : str
        "span_um", "smooth_span_um" (which has derivatives everywhere), "mean_transmission_error_um", "pressure_MPa",
        "edge_pressure_norm_MPa", "face_load_factor", "loss_factor"; with ``analysis.root_stress`` also
        "pinion_root_tension_norm_MPa" and "wheel_root_tension_norm_MPa". Scenes with strengths and [rating] have
        "flank_utilisation", "pinion_root_utilisation" and "wheel_root_utilisation": limits of 1 keep required safeties.
    starts : int
        Designs to start from: that of the scene, then points of a scrambled Sobol sequence within the ranges.
    seed : int
        Of these.
    executor : concurrent.futures.Executor, optional
        For the starts and for the final analyses; it stays the caller's. Default: this process.
    progress : callable, optional
        Called after every evaluation in this process.

    Returns
    -------
    DesignResult

    Raises
    ------
    InputError
        Before work starts, with every problem of the arguments; after it, if no design met a limit, which is named.
    ConvergenceError
        If the analysis at the accuracy of the scene does not confirm half of the gain, or exceeds a limit by more than
        5 %, with the torque and the sample; ``last`` is the DesignResult, whose ``unconfirmed`` has the same sentences.
    """
    wanted = Objective(objective, k, percentile, figure)
    model.require_figure("figure", figure)
    given = _limits(model, limits or {})
    require(
        (is_whole(starts, 1, MOST_VARIANTS), f"starts: {starts!r:.60}; allowed a whole number from 1 on"),
        (is_whole(seed, 0, math.inf), f"seed: {seed!r:.60}; allowed a whole number from 0 on"),
    )
    low, range_ = model.bounds[:, 0], np.ptp(model.bounds, axis=1)
    points = [(model.start - low) / range_]
    if starts > 1:
        from scipy.stats import qmc  # half a second

        points += [*qmc.Sobol(low.size, scramble=True, rng=seed).random_base2((starts - 2).bit_length())[: starts - 1]]
    if executor is None:
        searches = [_Search(model, wanted, given, progress).from_point(point) for point in points]
    else:
        tasks = [executor.submit(_searched, model.__reduce__(), wanted, given, point) for point in points]
        searches = [task.result() for task in tasks]
    history = [trial for search in searches for trial in search]
    best, base = _best(history), model
    for _ in range(MOST_BASES if model.scene.is_supported else 0):
        there = base.based_at(best.x)
        if _apart(base, there, best.x) <= SCATTER:
            break
        base = there
        again = _Search(base, wanted, given, progress).from_point((best.x - low) / range_)
        history, best = history + again, _best(again)
    if best.excess > KEPT:
        raise InputError(_told_unmet(base, given, best.x))
    told_starts = [f"{seed} of the {starts} starts"] if starts > 1 else []
    result = _analysed_result(model, wanted, given, history, (best.x, base), executor, told_starts)
    if result.unconfirmed:
        told = "; ".join(result.unconfirmed)
        raise ConvergenceError(f"design: not confirmed: {told}; {result.advice}", last=result)
    return result


class Trial(NamedTuple):
    """A design that was evaluated: values (keys,), objective, largest part by which a figure exceeds its limit."""

    x: Array
    objective: float
    excess: float


def _best(trials: Sequence[Trial]) -> Trial:
    """The lowest objective within the limits; if no design meets these, that which exceeds them least."""
    return min(trials, key=lambda one: (one.excess > KEPT, one.excess if one.excess > KEPT else one.objective))


def _apart(one: DesignModel, other: DesignModel, x: Array) -> float:
    """Largest difference of the transmission errors of a design between two models [um]."""
    errors = [model.evaluate(x).transmission_error for model in (one, other)]
    return float(one.micrometres * np.abs(errors[1] - errors[0]).max())


class _Search:
    """SLSQP from one start, over the keys scaled to their ranges; the objective is scaled by its first value."""

    def __init__(
        self, model: DesignModel, objective: Objective, limits: Sequence[Limit], progress: Progress | None = None
    ) -> None:
        self._model, self._objective, self._limits, self._progress = model, objective, limits, progress
        self._low, self._range = model.bounds[:, 0], np.ptp(model.bounds, axis=1)
        self._last: Evaluation | None = None
        self.history: list[Trial] = []

    def from_point(self, point: Array) -> list[Trial]:
        """Designs that were evaluated on the way from a point, (keys,) from 0 to 1."""
        self._minimise(self._value, self._slope, point, limited=bool(self._limits))
        if self._nearest().excess > KEPT:  # first any design that meets the limits, then the best one
            self._minimise(self._violation, self._violation_slope, self._point(self._nearest().x), limited=False)
            if self._nearest().excess <= KEPT:
                self._minimise(self._value, self._slope, self._point(self._nearest().x), limited=True)
        return self.history

    def _nearest(self) -> Trial:
        return min(self.history, key=lambda trial: trial.excess)

    def _point(self, x: Array) -> Array:
        return (x - self._low) / self._range

    def _minimise(
        self, value: Callable[[Array], float], slope: Callable[[Array], Array], point: Array, *, limited: bool
    ) -> None:
        from scipy.optimize import minimize

        first = abs(value(point)) or 1.0
        limit: Any = {"type": "ineq", "fun": self._room, "jac": self._room_slopes}
        minimize(  # type: ignore[call-overload]
            lambda z: value(z) / first,
            point,
            jac=lambda z: slope(z) / first,
            method="SLSQP",
            bounds=[(0.0, 1.0)] * point.size,
            constraints=[limit] if limited else [],
            options={"maxiter": MOST_ITERATIONS, "ftol": ACCURACY},
        )

    def _evaluated(self, point: Array) -> Evaluation:
        low, high = self._model.bounds.T
        x = np.where(point >= 1.0 - ROUNDING, high, low + point * self._range)
        x = np.where(point <= ROUNDING, low, np.clip(x, low, high))
        if self._last is None or not np.array_equal(self._last.x, x):
            self._last = self._model.evaluate(x)
            value, _ = self._objective.of(self._last.figure(self._objective.figure))
            excess = -float(self._room(point).min(initial=math.inf))
            self.history.append(Trial(x, value, excess))
            if self._progress is not None:
                self._progress(len(self.history), value, excess)
        return self._last

    def _value(self, point: Array) -> float:
        return self._objective.of(self._evaluated(point).figure(self._objective.figure))[0]

    def _slope(self, point: Array) -> Array:
        evaluation, figure = self._evaluated(point), self._objective.figure
        _, weights = self._objective.of(evaluation.figure(figure))
        return np.asarray(self._range * np.tensordot(weights, evaluation.gradient(figure), 2))

    def _room(self, point: Array) -> Array:
        """What is left up to each limit, as a part of it: (limits times samples times torques,)."""
        evaluation = self._evaluated(point)
        rooms = [1.0 - evaluation.figure(one.figure, one.torques).ravel() / one.highest for one in self._limits]
        return np.concatenate([np.zeros(0), *rooms])

    def _room_slopes(self, point: Array) -> Array:
        evaluation = self._evaluated(point)
        rows = [
            -evaluation.gradient(one.figure, one.torques).reshape(-1, point.size) / one.highest for one in self._limits
        ]
        return np.asarray(self._range * np.concatenate(rows))

    def _violation(self, point: Array) -> float:
        """Sum of the squares by which limits are exceeded."""
        return float((np.minimum(self._room(point), 0.0) ** 2).sum())

    def _violation_slope(self, point: Array) -> Array:
        return np.asarray(2.0 * np.minimum(self._room(point), 0.0) @ self._room_slopes(point))


def _searched(
    made: tuple[Callable[..., DesignModel], tuple[Any, ...]],
    objective: Objective,
    limits: Sequence[Limit],
    point: Array,
) -> list[Trial]:
    """A search on a model of its own, in whatever process and thread this is called."""
    make, given = made
    with one_thread():
        return _Search(make(*given), objective, limits).from_point(point)


def _limits(model: DesignModel, limits: Limits) -> list[Limit]:
    """Checked limits; every problem at once."""
    problems: list[str] = []
    checked = []
    require((isinstance(limits, Mapping), f"limits: {limits!r:.60}; allowed a mapping of figures to highest values"))
    for figure, given in limits.items():
        try:
            model.require_figure("limits", figure)
        except InputError as error:
            problems += error.problems
            continue
        by_torque = given if isinstance(given, Mapping) else {None: given}
        if not by_torque:
            problems.append(f"limits: {figure}: none given; allowed a highest value, or one for each of some torques")
        for torque, highest in by_torque.items():
            near = [True if torque is None else math.isclose(one, real(torque), rel_tol=1e-6) for one in model.torques]
            chosen = tuple(np.flatnonzero(near).tolist())
            if not chosen:
                torques = ", ".join(f"{plain(one, 6)}" for one in model.torques)
                problems.append(f"limits: {figure}: {torque!r:.40} N mm is no torque of the model; allowed {torques}")
            elif not (is_finite(highest) and highest > 0.0):
                problems.append(f"limits: {figure}: {highest!r:.60}; allowed a finite number above 0")
            else:
                checked.append(Limit(figure, chosen, float(highest)))
    if problems:
        raise InputError(problems)
    return checked


def _told_unmet(model: DesignModel, limits: Sequence[Limit], x: Array) -> list[str]:
    """The limits that the best design found exceeds, and by how much."""
    evaluation, sentences = model.evaluate(x), []
    place = ", ".join(f"{key} = {plain(value)}" for key, value in zip(model.keys, x.tolist(), strict=True))
    for one in limits:
        largest = float(evaluation.figure(one.figure, one.torques).max())
        if largest > (1.0 + KEPT) * one.highest:
            part = 100.0 * (largest / one.highest - 1.0)
            sentences.append(
                f"limits: {one.figure}: no design found meets {plain(one.highest, 6)}; at the best one it is "
                f"{plain(largest)}, {plain(part, 2)} % more ({place})"
            )
    return sentences


def robustness(
    model: DesignModel,
    designs: Mapping[str, Mapping[str, float]],
    multiples: Sequence[float],
    objective: str = "mean + k sigma",
    *,
    k: float = 1.0,
    percentile: float = 90.0,
    figure: str = "smooth_span_um",
) -> xarray.Dataset:
    """Objective of designs over a multiple of the scatter, on held contacts.

    Parameters
    ----------
    model : DesignModel
        With a scatter.
    designs : mapping of str to mapping
        Name -> values of the keys.
    multiples : sequence of float
        By which the samples deviate farther than in the model; 0: no scatter.
    objective, k, percentile, figure
        As of :func:`optimise`.

    Returns
    -------
    xarray.Dataset
        ``objective`` over design and multiple.
    """
    import xarray

    wanted = Objective(objective, k, percentile, figure)
    require((bool(model.scatter), "model: has no scatter to multiply; allowed a model with scatter"))
    values = [model.values(one) for one in designs.values()]
    objectives = np.empty((len(designs), len(multiples)))
    for column, multiple in enumerate(multiples):
        scaled = model.with_scatter(multiple)
        objectives[:, column] = [wanted.of(scaled.evaluate(x).figure(figure))[0] for x in values]
    coordinates = {"design": [*designs], "multiple": np.asarray(multiples, dtype=float)}
    measured = FIGURES[figure]
    attributes = {"long_name": f"{wanted.told} of the {measured.text}", "units": measured.unit}
    return xarray.Dataset({"objective": (("design", "multiple"), objectives, attributes)}, coordinates)


def _analysed(scene: Scene) -> dict[str, Any]:
    """What is kept of the analysis of a scene, over its torques; in whatever process this is called."""
    with one_thread(), noted_accuracy_warnings(given=False) as warned:
        result = analyse(scene)
    errors = result.um_per_rad * result.transmission_error[:, :-1]
    figures = {
        "transmission_error": result.transmission_error,
        "peak_pressure": np.fmax.reduce(result.peak_pressure, axis=2),
        "face_load_factor": result.face_load_factor,
        "transverse_load_factor": result.transverse_load_factor,
        "warnings": [*dict.fromkeys(map(without_place, warned))],
    }
    for name, figure in FIGURES.items():
        if isinstance(figure, FigureOfErrors):
            figures[name] = np.array([figure.of(row, SMOOTHING)[0] for row in errors])
    of_roots = [
        name for name, figure in FIGURES.items() if figure.is_of_roots and not isinstance(figure, FigureOfStrength)
    ]
    for gear, name in enumerate(of_roots if scene.analysis.root_stress else ()):
        figures[name] = np.array([root_tension_norm(row) for row in result.root_tension[:, :-1, gear]])
    for name, at_edges in (("pressure_MPa", False), ("edge_pressure_norm_MPa", True)):
        positions = ([[one for one in row if one is not None] for row in rows[:-1]] for rows in result.maps)
        module = result.gear_pair.module
        figures[name] = np.array([mean_pressure_norm(rows, module, at_edges=at_edges)[0] for rows in positions])
    if len(result.path) >= FIGURES["loss_factor"].fewest_positions:
        figures["loss_factor"] = tribology_of(result, warn=False).loss_factor
    return figures | _utilisations(scene, result, figures)


def _utilisations(scene: Scene, result: MeshCycle, figures: Mapping[str, Any]) -> dict[str, Array]:
    """Utilisations of the strength by the analysis, where the scene has strengths, [rating] and enough positions."""
    of_strength = figures_of_strength(scene)
    if not of_strength or len(result.path) < FEWEST_RATED:
        return {}
    factors = [utilisation_of(scene, torque) for torque in result.torque.tolist()]
    return {
        name: figures[one.stress] * [one.factor(each) for each in factors]
        for name, one in of_strength.items()
        if one.stress in figures
    }


def _analysed_result(
    model: DesignModel,
    objective: Objective,
    limits: Sequence[Limit],
    history: Sequence[Trial],
    found: tuple[Array, DesignModel],
    executor: Executor | None,
    told_starts: list[str],
) -> DesignResult:
    """The result of a search, with the full analyses of start and optimum; ``found``: that, and the model it is of."""
    import xarray

    x, base = found
    designs = (model.start, x)
    scenes = [scene for design in designs for scene in model.scenes(design)]
    analyses = [*(map if executor is None else executor.map)(_analysed, scenes)]
    reasons = Counter(reason for one in analyses for reason in one.pop("warnings"))
    shape = len(designs), len(model.deviations)
    arrays = {
        name: np.array([one[name] for one in analyses]).reshape(*shape, *analyses[0][name].shape)
        for name in analyses[0]
    }
    held = [model.evaluate(model.start), base.evaluate(x)]
    arrays |= {f"held_{name}": np.array([one.figure(name) for one in held]) for name in model.figures}
    arrays["held_transmission_error"] = np.array([one.transmission_error for one in held])
    differs = np.abs(arrays["transmission_error"][..., :-1] - arrays["held_transmission_error"]).max(axis=-1)
    arrays["held_difference_um"] = model.micrometres * differs
    for prefix in ("", "held_"):
        arrays[f"{prefix}objective"] = np.array([objective.of(one)[0] for one in arrays[prefix + objective.figure]])
    arrays |= {
        "value": np.array(designs),
        "range": model.bounds,
        "scatter": np.array([[*one.values()] for one in model.deviations]),
    }
    arrays |= {f"history_{name}": np.array([getattr(one, name) for one in history]) for name in Trial._fields}
    coordinates = {
        "design": ["start", "optimum"],
        "key": [*model.keys],
        "torque": ("torque", model.torques, {"units": "N mm"}),
        **({"scatter_key": [*model.scatter]} if model.scatter else {}),
    }
    attributes = {"kind": DESIGN, "scene_toml": model.scene.to_toml()}
    attributes["warnings"] = "\n".join(
        f"{reason} (in {count} of {len(analyses)} analyses)" for reason, count in reasons.items()
    )
    attributes |= {"objective": objective.told, "figure": objective.figure}
    attributes |= {"distributions": "\n".join(model.told_scatter), "seeds": "; ".join(model.told_seed + told_starts)}
    attributes["limits"] = "\n".join(told_limit(one, model.torques) for one in limits)
    parts = {name: part for name, part in PARTS.items() if name in arrays}  # root tension, where the scene asks for it
    return DesignResult(xarray.Dataset(variables_of(parts, arrays), coordinates, attributes))
