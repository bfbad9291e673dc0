r"""Figures of a loaded mesh as smooth functions of the micro-geometry, with exact gradients, under scatter.

All contacts are held (:mod:`loaded_tca.loaded.held_contacts`): an evaluation changes their gaps, shares the torque
over the tooth pairs at all positions, under all torques and of all samples of the scatter together, and reads off

.. math:: \mathrm{span} = \tau \ln \sum_n e^{\mathrm{TE}_n/\tau} + \tau \ln \sum_n e^{-\mathrm{TE}_n/\tau}, \qquad
          \hat p = \Bigl(\tfrac1N \sum_n \sum_c A_c\, p_c^m / 1\,\mathrm{mm}^2\Bigr)^{1/m}, \quad m = 12,

over N positions of a pitch and all cells c of their contacts. Gradients are those of the discrete problem, one linear
solution for the transmission error and one more for each other figure, however many keys there are
(:mod:`loaded_tca.loaded.sensitivity`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import binary_dilation

from loaded_tca.arrays import Array, Mask
from loaded_tca.compliance import require_teeth, tooth_compliance, way_out_told
from loaded_tca.errors import InputError, require
from loaded_tca.loaded.cycle import farthest_apart
from loaded_tca.loaded.held_contacts import HeldContacts, ShapedContacts
from loaded_tca.loaded.load_sharing import SharedLoad
from loaded_tca.loaded.sensitivity import LoadedGrid, Tangent
from loaded_tca.loaded.together import found_together
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.results.load_factors import STRIPS, common_face, strip_shares
from loaded_tca.scene import Scene
from loaded_tca.separation.gap_change import value_at
from loaded_tca.studies.study import Distribution, Study, is_finite
from loaded_tca.unloaded import ContactPoint, trace_teeth

CELLS = (24, 40)
"""Of every contact, where the scene gives none."""
SMOOTHING = 0.01
"""tau of the span [um]: it exceeds the span by 2 tau ln(N) at the most."""
EXPONENT = 12
TOLERANCE = 1e-6
"""Of contacts and of the balance of the tooth pairs, relative."""
FEWEST_POSITIONS = 4
State = tuple[int, int, int]
"""Sample, torque, position."""


class DesignModel:
    """Micro-geometry to be designed: keys that vary within ranges, under a scatter of others.

    Parameters
    ----------
    scene : Scene
        Where the design starts; says what is in the model, ``analysis.positions`` over how many positions.
    variables : mapping of str to (float, float)
        Keys of modifications, machine settings and cutters of either gear, as of ``scene.with_changes`` -> lowest and
        highest value, between which that of the scene lies.
    scatter : mapping of str to frozen distribution of ``scipy.stats``, optional
        Keys of mounting errors -> their distributions; of keys of flanks -> the distributions of what they deviate by
        from the value of the design. Or to given values, all equally many, each of them a sample.
    torques : sequence of float, optional [N mm]
        Of the pinion; default: those of the scene.
    samples : int
        Of the scatter; as of :class:`Study`.
    seed : int
        Of the samples.
    multiple : float
        Samples deviate so many times as far from the medians of their distributions.
    cells : (int, int), optional
        Of every contact across and along; default: ``analysis.cells``, or 24 and 40.
    smoothing : float [um]
        tau of the smooth span.
    tolerance : float
        Of contacts and of the balance of the tooth pairs, relative.

    Raises
    ------
    InputError
        With every problem of the arguments.
    GeometryError
        If the gears cannot exist or mesh with a value of a key that is allowed here.
    """

    def __init__(
        self,
        scene: Scene,
        variables: Mapping[str, tuple[float, float]],
        scatter: Mapping[str, Distribution | Sequence[float]] | None = None,
        torques: Sequence[float] | None = None,
        *,
        samples: int = 8,
        seed: int = 0,
        multiple: float = 1.0,
        cells: tuple[int, int] | None = None,
        smoothing: float = SMOOTHING,
        tolerance: float = TOLERANCE,
    ) -> None:
        self.scene, self.variables, self.scatter = scene, dict(variables), dict(scatter or {})
        self.torques = np.asarray(scene.torques if torques is None else torques, dtype=float)
        self.samples, self.seed, self.multiple = samples, seed, multiple
        self.smoothing, self.tolerance = smoothing, tolerance
        given = scene.analysis.cells
        self.cells = tuple(cells or given or CELLS)
        self._check()
        self.start = np.array([float(value_at(scene, key)) for key in self.keys])
        self.deviations = self._samples()
        self.own_deviations = [np.array([one.get(key, 0.0) for key in self.keys]) for one in self.deviations]
        self.held = [self._sample(*one) for one in zip(self.deviations, self.own_deviations, strict=True)]
        pair = self.held[0].pair
        self.driving, self.micrometres = pair.driving, 1e3 * pair.base_radii[1]
        faces = [common_face(one.pair, one.mesh.leading_contact) for one in self.held]
        self.strips = [np.linspace(*face, STRIPS + 1) for face in faces]

    def __reduce__(self) -> tuple[Any, ...]:
        """Made anew by pickle, for other processes: held contacts are large, and quickly made."""
        given = self.scene, self.variables, self.scatter, self.torques
        options = "samples", "seed", "multiple", "cells", "smoothing", "tolerance"
        return _made, (given, {name: getattr(self, name) for name in options})

    def with_scatter(self, multiple: float) -> DesignModel:
        """The model with samples that deviate so many times as far from the medians of their distributions."""
        make, (given, options) = self.__reduce__()
        return make(given, {**options, "multiple": multiple})  # type: ignore[no-any-return]

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that vary, in the order of all arrays over them."""
        return tuple(self.variables)

    @property
    def bounds(self) -> Array:
        """Lowest and highest values (keys, 2)."""
        return np.array([*self.variables.values()], dtype=float)

    def values(self, x: Mapping[str, float] | ArrayLike) -> Array:
        """Values (keys,) of a mapping or of an array of them; InputError if they are not within the ranges."""
        if isinstance(x, Mapping):
            require(
                *((key in self.variables, f"{key}: unknown; allowed {', '.join(self.keys)}") for key in x),
                *((key in x, f"{key}: missing") for key in self.keys),
            )
            x = [x[key] for key in self.keys]
        found = np.asarray(x, dtype=float)
        require((found.shape == self.start.shape, f"x: shape {found.shape}; allowed {self.start.shape}"))
        require(*(_within(*one) for one in zip(self.variables.items(), found.tolist(), strict=True)))
        return found

    def scenes(self, x: Mapping[str, float] | ArrayLike) -> list[Scene]:
        """The scene of a design with each sample of the scatter, as the package analyses it under the torques."""
        values = dict(zip(self.keys, self.values(x).tolist(), strict=True))
        torques = {"analysis.torques_Nm": (1e-3 * self.torques).tolist()}
        return [self.scene.with_changes({**values, **self._at(one, values), **torques}) for one in self.deviations]

    def evaluate(self, x: Mapping[str, float] | ArrayLike) -> Evaluation:
        """Solve all states of a design.

        Parameters
        ----------
        x : mapping of key to value, or (keys,) array

        Returns
        -------
        Evaluation

        Raises
        ------
        InputError
            If a value is not within its range.
        ConvergenceError
            If a contact, or the balance of the tooth pairs, is not solved to the tolerance.
        """
        values = self.values(x)
        grid = GridChoice(self.cells, tolerance=self.tolerance, free_edges=self.scene.analysis.free_edges, agreement=self.tolerance)
        while True:
            grown = sum(one.grown for one in self.held)
            shaped = [ShapedContacts(*one) for one in zip(self.held, values + self.own_deviations, strict=True)]
            order = [
                one.shared(n, torque, grid)
                for one in shaped
                for torque in self.torques.tolist()
                for n in range(self.positions)
            ]
            found = found_together(self.held[0].pair, order)
            if sum(one.grown for one in self.held) == grown:  # else some were solved on grids that are held no more
                return Evaluation(self, values, tuple(found))

    def _samples(self) -> list[dict[str, float]]:
        """What the keys of the scatter have, or deviate by, in each sample."""
        if not self.scatter:
            return [{}]
        given = {key: one for key, one in self.scatter.items() if not hasattr(one, "ppf")}
        drawn: dict[str, Any] = {key: one for key, one in self.scatter.items() if key not in given}
        require((not given or not drawn, "scatter: distributions and given values; allowed one or the other"))
        if given:
            study = Study(self.scene, table=given)
            medians = {key: float(np.median(column)) for key, column in study.table.items()}
        else:
            study = Study(self.scene, distributions=drawn, samples=self.samples, seed=self.seed)
            medians = {key: float(one.ppf(0.5)) for key, one in drawn.items()}
        samples = (study.changes(sample) for sample in range(len(study)))
        return [{key: medians[key] + self.multiple * (by - medians[key]) for key, by in one.items()} for one in samples]

    @property
    def positions(self) -> int:
        """Positions of a pitch; the last one of the scene is the first one of the next pitch."""
        return self.scene.analysis.positions - 1

    def _at(self, deviation: Mapping[str, float], values: Mapping[str, float]) -> dict[str, float]:
        """Values of the keys that scatter, of one sample; those that shape flanks deviate from their values."""
        found = {}
        for key, by in deviation.items():
            shapes = not key.startswith("mounting.")
            found[key] = by + (values.get(key, float(value_at(self.scene, key))) if shapes else 0.0)
        return found

    def _sample(self, deviation: Mapping[str, float], own: Array) -> HeldContacts:
        scene = self.scene.with_changes(self._at(deviation, dict(zip(self.keys, self.start.tolist(), strict=True))))
        pair = scene.pair()
        mesh = trace_teeth(pair, pair.pitch * (np.arange(self.positions) / self.positions - 0.5))
        bending = None
        if scene.analysis.compliance != "contact":
            require_teeth(pair)
            with way_out_told():
                bending = tooth_compliance(pair, neighbours=max(farthest_apart(mesh), 1))
        ranges = {key: (low + by, high + by) for (key, (low, high)), by in zip(self.variables.items(), own, strict=True)}
        return HeldContacts(scene, mesh, ranges, float(self.torques.max()), self.cells, bending)

    def _check(self) -> None:
        problems = []
        if not self.variables:
            problems.append("variables: none given; a design varies one key at least")
        for key, bounds in self.variables.items():
            try:
                value = float(value_at(self.scene, key))
            except InputError as error:
                problems += [f"{key}: {problem}" for problem in error.problems]
                continue
            if key.startswith("mounting."):
                problems.append(f"{key}: a mounting error, which no design shapes; allowed in scatter")
            elif not (isinstance(bounds, Sequence) and len(bounds) == 2 and all(map(is_finite, bounds)) and bounds[0] < bounds[1]):
                problems.append(f"{key}: range {bounds!r:.60}; allowed two numbers (low, high), low < high")
            elif not bounds[0] <= value <= bounds[1]:
                problems.append(f"{key}: the scene, where the design starts, has {value:g}; allowed {bounds[0]:g} to {bounds[1]:g}")
        for key in self.scatter:
            try:
                value_at(self.scene, key)
            except InputError as error:
                problems += [f"scatter: {key}: {problem}" for problem in error.problems]
        if not self.torques.size or not (np.isfinite(self.torques) & (self.torques > 0.0)).all():
            problems.append(f"torques: found {self.torques.tolist()}; allowed one or more [N mm], each above 0")
        wanted = self.scene.analysis
        if wanted.positions < FEWEST_POSITIONS:
            problems.append(f"analysis.positions: {wanted.positions}; allowed from {FEWEST_POSITIONS} on: a span needs them")
        if not wanted.load_sharing:
            problems.append("analysis.load_sharing: false; allowed true: designs let all tooth pairs share the load")
        if problems:
            raise InputError(problems)


def _within(bounds: tuple[str, tuple[float, float]], value: float) -> tuple[bool, str]:
    key, (low, high) = bounds
    return low <= value <= high, f"{key}: {value:g}; allowed {low:g} to {high:g}"


def _made(given: tuple[Any, ...], options: dict[str, Any]) -> DesignModel:
    return DesignModel(*given, **options)


class Evaluation:
    """Figures of a design and their gradients, found when they are asked for.

    Attributes
    ----------
    model : DesignModel
    x : (keys,) array
    transmission_error : (sample, torque, position) array [rad]
        Loaded, absolute.
    """

    def __init__(self, model: DesignModel, x: Array, states: Sequence[tuple[float, SharedLoad]]) -> None:
        self.model, self.x = model, x
        shape = len(model.deviations), model.torques.size, model.positions
        self.transmission_error = np.array([error for error, _ in states]).reshape(shape)
        shared = [[LoadedGrid.of(one.tooth_pair.pair, one.loaded) for one in state.shares] for _, state in states]
        self._grids = dict(zip(np.ndindex(shape), shared, strict=True))
        self._tangents: dict[State, Tangent] = {}
        self._found: dict[tuple[str, int, int], tuple[float, Sequence[Array]]] = {}

    @property
    def figures(self) -> dict[str, Array]:
        """All of ``FIGURES``, (sample, torque) each."""
        return {name: self.figure(name) for name in FIGURES}

    @property
    def gradients(self) -> dict[str, Array]:
        """Their gradients, (sample, torque, key) each, per unit of the key."""
        return {name: self.gradient(name) for name in FIGURES}

    def figure(self, name: str, torques: Sequence[int] | None = None) -> Array:
        """One of ``FIGURES``, (sample, torque), under some of the torques by their indices, or under all."""
        samples, chosen = range(len(self.model.deviations)), self._chosen(torques)
        return np.array([[self._figure(name, s, t)[0] for t in chosen] for s in samples])

    def gradient(self, name: str, torques: Sequence[int] | None = None) -> Array:
        """Its gradient, (sample, torque, key), per unit of the key."""
        samples, chosen = range(len(self.model.deviations)), self._chosen(torques)
        return np.array([[self._gradient(name, s, t) for t in chosen] for s in samples])

    def _chosen(self, torques: Sequence[int] | None) -> Sequence[int]:
        return range(self.model.torques.size) if torques is None else torques

    def _figure(self, name: str, s: int, t: int) -> tuple[float, Sequence[Array]]:
        """A figure, and its derivatives to the errors [um] or to the forces of the active cells at each position."""
        if (name, s, t) not in self._found:
            errors = self.model.micrometres * self.transmission_error[s, t]
            if name in OF_ERRORS:
                self._found[name, s, t] = OF_ERRORS[name](errors, self.model.smoothing)
            elif name == "face_load_factor":
                self._found[name, s, t] = self._face_load_factor(s, t)
            else:
                self._found[name, s, t] = self._pressure(s, t, at_edges=name == "edge_pressure_MPa")
        return self._found[name, s, t]

    def _gradient(self, name: str, s: int, t: int) -> Array:
        _, slopes = self._figure(name, s, t)
        found = np.zeros(len(self.model.keys))
        for n, slope in enumerate(slopes):
            tangent, gaps = self._tangent((s, t, n))
            if name in OF_ERRORS:
                change = -self.model.driving * tangent.rotation_change(gaps)
                found += self.model.micrometres * slope * change
            elif slope.any():
                found += tangent.functional_change(slope, gaps)[0]
        return found

    def _tangent(self, state: State) -> tuple[Tangent, Array]:
        """Linear answer of a state, and the growth of the gaps at its active cells (keys, n) [mm per unit]."""
        if state not in self._tangents:
            self._tangents[state] = Tangent(self._grids[state], self.model.held[state[0]].bending)
        slopes = self._slopes[state[0]]
        return self._tangents[state], self._tangents[state].gathered([slopes[g.contact] for g in self._tangents[state].grids])

    @cached_property
    def _slopes(self) -> list[dict[ContactPoint, Array]]:
        """Derivatives of the gaps of each sample."""
        return [one.slopes(self.x + own) for one, own in zip(self.model.held, self.model.own_deviations, strict=True)]

    def _pressure(self, s: int, t: int, *, at_edges: bool) -> tuple[float, Sequence[Array]]:
        """Norm of the pressure of the cells beside an end of a flank, or of all others."""
        pressures = [
            [np.where(beside_ends(one.separation.gap) == at_edges, one.pressure, 0.0) for one in self._grids[s, t, n]]
            for n in range(self.model.positions)
        ]
        areas = [[one.problem.cell_area for one in self._grids[s, t, n]] for n in range(self.model.positions)]
        norm, slopes = pressure_norm(pressures, areas), []
        for n, own in enumerate(pressures):
            active = [one[grid.active] for one, grid in zip(own, self._grids[s, t, n], strict=True)]
            relative = np.concatenate([np.zeros(0), *active]) / (norm or 1.0)
            slopes.append(relative ** (EXPONENT - 1) / self.model.positions)
        return norm, slopes

    def _face_load_factor(self, s: int, t: int) -> tuple[float, Sequence[Array]]:
        """Largest force of a strip of the face over the mean; the strip with the largest one is held in derivatives."""
        held, forces, shares = self.model.held[s], np.zeros(STRIPS), []
        for n in range(self.model.positions):
            own = [np.zeros((STRIPS, 0))]
            for grid in self._grids[s, t, n]:
                loaded = grid.pressure > 0.0
                parts, _ = strip_shares(held.pair, grid.separation, loaded, self.model.strips[s])
                forces += parts @ grid.pressure[loaded] * grid.problem.cell_area
                own.append(parts[:, grid.active[loaded]])
            shares.append(np.concatenate(own, axis=1))
        top, mean = int(forces.argmax()), float(forces.mean())
        factor = float(forces[top]) / mean
        return factor, [(parts[top] - factor / STRIPS) / mean for parts in shares]


def beside_ends(gap: Array) -> Mask:
    """Cells of a gap (nx, ny) with the end of a flank, or of the grid, beside them."""
    beyond = np.pad(np.isinf(gap), 1, constant_values=True)
    return np.asarray(binary_dilation(beyond, np.ones((3, 3), dtype=bool))[1:-1, 1:-1])


def pressure_norm(pressures: Sequence[Sequence[Array]], areas: Sequence[Sequence[float]]) -> float:
    """Norm [MPa] of pressures by position and contact, on cells of such areas [mm^2]; see the module."""
    sums = [area * float((one**EXPONENT).sum()) for row in zip(pressures, areas, strict=True) for one, area in zip(*row, strict=True)]
    return float((sum(sums) / len(pressures)) ** (1.0 / EXPONENT))


def span(errors: Array, _: float) -> tuple[float, Array]:
    """Largest less smallest of errors (n,), and its derivatives, those at these two places."""
    weights = np.zeros(errors.size)
    weights[errors.argmax()] += 1.0
    weights[errors.argmin()] -= 1.0
    return float(np.ptp(errors)), weights


def smooth_span(errors: Array, smoothing: float) -> tuple[float, Array]:
    """The same with smooth maxima, which are larger by up to ``smoothing`` ln n each.

    Examples
    --------
    >>> value, weights = smooth_span(np.array([0.0, 0.3, 0.3]), 0.01)
    >>> round(value, 6), weights.round(6)
    (0.306931, array([-1. ,  0.5,  0.5]))
    """
    value, weights = 0.0, np.zeros(errors.size)
    for sign in (1.0, -1.0):
        top = float((sign * errors).max())
        parts = np.exp((sign * errors - top) / smoothing)
        value += top + smoothing * float(np.log(parts.sum()))
        weights += sign * parts / parts.sum()
    return value, weights


def mean(errors: Array, _: float) -> tuple[float, Array]:
    """Mean of errors (n,), and its derivatives."""
    return float(errors.mean()), np.full(errors.size, 1.0 / errors.size)


OF_ERRORS = {"span_um": span, "smooth_span_um": smooth_span, "mean_transmission_error_um": mean}
OF_FORCES = ("pressure_MPa", "edge_pressure_MPa", "face_load_factor")
FIGURES = (*OF_ERRORS, *OF_FORCES)
"""Figures of a design under one torque with one sample: peak-to-peak transmission error at the wheel's base circle, the
same with smooth maxima, its mean; norm of the pressure away from the ends of the flanks, and beside them; K_Hbeta."""
