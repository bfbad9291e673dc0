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

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.analysis import roots_of
from loaded_tca.arrays import Array, numbers, real
from loaded_tca.compliance import model_of, require_teeth
from loaded_tca.compliance.model import with_enough_teeth
from loaded_tca.errors import InputError, named, require
from loaded_tca.loaded.held_contacts import HeldContacts, ShapedContacts
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.moved_gears import pitches_apart
from loaded_tca.loaded.sensitivity import Tangents
from loaded_tca.loaded.standing import GearsUnderTorques
from loaded_tca.loaded.together import run_stacked
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.loaded.tooth_pairs import SharedLoad
from loaded_tca.plain import plain
from loaded_tca.rating.utilisation import utilisation_of
from loaded_tca.scene import Scene
from loaded_tca.scene.rating import is_rated
from loaded_tca.separation.pair_change import value_at
from loaded_tca.studies.design_figures import (
    FIGURES,
    SMOOTHING,
    FigureOfErrors,
    FigureOfStrength,
    figures_of_strength,
)
from loaded_tca.studies.study import (
    Distribution,
    deviations_of,
    is_whole,
    problems_of_key,
    problems_of_range,
    told_distribution,
)
from loaded_tca.supports import support_compliance
from loaded_tca.unloaded import ContactPoint, trace_teeth

CELLS = (24, 40)
"""Of every contact, where the scene gives none."""
TOLERANCE = 1e-6
"""Of contacts, relative."""
AGREEMENT = 10.0
"""That of the balance of the tooth pairs over it."""
FEWEST_POSITIONS, FEWEST_CELLS = 4, 4
LINEAR = 1e-7
"""Of the linear systems of gradients, relative."""


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

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> few = {"analysis.positions": 4, "analysis.compliance": "contact", "analysis.free_edges": False}
    >>> scene = parse_scene(DEMO_SCENE.read_text()).with_changes(few)
    >>> model = DesignModel(scene, {"pinion.modifications.lead_crowning_um": (0.0, 10.0)}, cells=(12, 16))
    >>> crowned = model.evaluate([8.0])
    >>> bool(crowned.gradient("face_load_factor").item() > 0.0)  # more crowning, less of the face carries
    True
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
        for name, given in (("variables", variables), ("scatter", scatter or {})):
            require((isinstance(given, Mapping), f"{name}: {given!r:.60}; allowed a mapping of keys"))
        self.scene, self.variables, self.scatter = scene, dict(variables), dict(scatter or {})
        self.torques = np.atleast_1d(numbers("torques", scene.torques if torques is None else torques))
        self.samples, self.seed, self.multiple = samples, seed, multiple
        self.smoothing, self.tolerance = smoothing, tolerance
        self.cells = cells or scene.analysis.cells or CELLS
        self._check()
        self.start = np.array([value_at(scene, key) for key in self.keys])
        self.deviations = deviations_of(scene, self.scatter, samples, seed, multiple)
        self.own_deviations = [np.array([one.get(key, 0.0) for key in self.keys]) for one in self.deviations]
        with named("within the ranges, with the scatter"):
            self.held = [self._sample(*one) for one in zip(self.deviations, self.own_deviations, strict=True)]
        pair = self.held[0][0].pair
        self.driving, self.micrometres = pair.driving, 1e3 * pair.base_radii[1]
        self.roots = roots_of(scene, pair)

    def __reduce__(self) -> tuple[Callable[..., DesignModel], tuple[Any, ...]]:
        """Made anew by pickle, for other processes: held contacts are large, and quickly made."""
        given = self.scene, self.variables, self.scatter, self.torques
        options = "samples", "seed", "multiple", "cells", "smoothing", "tolerance"
        return _made, (given, {name: getattr(self, name) for name in options})

    def with_scatter(self, multiple: float) -> DesignModel:
        """The model with samples that deviate so many times as far from the medians of their distributions."""
        make, (given, options) = self.__reduce__()
        return make(given, {**options, "multiple": multiple})

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys that vary, in the order of all arrays over them."""
        return tuple(self.variables)

    @property
    def figures(self) -> tuple[str, ...]:
        """Figures that the scene has; roots need ``analysis.root_stress``, strength needs strengths of both gears."""
        known = {name: one for name, one in FIGURES.items() if one.fewest_positions <= self.scene.analysis.positions}
        of_strength = figures_of_strength(self.scene)
        known = {
            name: one for name, one in known.items() if name in of_strength or not isinstance(one, FigureOfStrength)
        }
        return tuple(name for name, one in known.items() if not one.is_of_roots or self.roots)

    def require_figure(self, argument: str, name: Any) -> None:
        """InputError, naming the argument, if the model does not have a figure."""
        figure, way = FIGURES.get(str(name)), ""
        if isinstance(figure, FigureOfStrength) and not is_rated(self.scene):
            way = "; utilisation needs strengths of both gears and [rating]"
        elif isinstance(figure, FigureOfStrength) and name not in figures_of_strength(self.scene):
            way = (
                f"; {name} needs the pressure of elastic flanks: max_pressure_MPa caps it; design the scene without "
                "the cap, and analyse the design with it"
            )
        elif figure is not None and figure.is_of_roots:
            way = "; root tension needs analysis.root_stress = true"
        elif figure is not None and figure.fewest_positions:
            way = f"; {name} needs analysis.positions from {figure.fewest_positions} on"
        require((name in self.figures, f"{argument}: {name!r:.60}; allowed {', '.join(self.figures)}{way}"))

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
        array = np.asarray(x, dtype=float)
        require((array.shape == self.start.shape, f"x: shape {array.shape}; allowed {self.start.shape}"))
        require(*(_within(*one) for one in zip(self.variables.items(), array.tolist(), strict=True)))
        return array

    def scenes(self, x: Mapping[str, float] | ArrayLike) -> list[Scene]:
        """The scene of a design with each sample of the scatter, as the package analyses it under the torques."""
        values = dict(zip(self.keys, self.values(x).tolist(), strict=True))
        torques = {"analysis.torques_Nm": (1e-3 * self.torques).tolist()}
        return [self.scene.with_changes({**values, **self._at(one, values), **torques}) for one in self.deviations]

    def based_at(self, x: Mapping[str, float] | ArrayLike) -> DesignModel:
        """The same model made of the scene with a design: its contacts, levers and gears stand as that has them."""
        make, (given, options) = self.__reduce__()
        values = dict(zip(self.keys, self.values(x).tolist(), strict=True))
        return make((self.scene.with_changes(values), *given[1:]), options)

    def evaluate(self, x: Mapping[str, float] | ArrayLike) -> Evaluation:
        """Solve all states of a design.

        Where a contact outgrows its grid, a larger one takes its place from then on: figures of designs before and
        after differ by what two grids differ, some nanometres. Forces keep the levers and the directions that they have
        at the contact points of the scene: far from it the transmission error is off by up to 3e-4 of all that gives
        way, 15 nm of rigid helical gears and 40 nm on soft shafts. A model :meth:`based_at` a design has its own.

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
        ends, agreement = self.scene.analysis.free_edges, AGREEMENT * self.tolerance
        grid = GridChoice(
            self.cells, tolerance=self.tolerance, free_edges=ends, agreement=agreement, forces_on_grid_axis=True
        )
        states = list(np.ndindex(len(self.held), self.torques.size, self.positions))
        solved: dict[tuple[int, ...], tuple[float, SharedLoad]] = {}
        while states:
            shaped: dict[HeldContacts, ShapedContacts] = {}
            for by_torque, own in zip(self.held, values + self.own_deviations, strict=True):
                shaped |= {held: ShapedContacts(held, own) for held in dict.fromkeys(by_torque)}
            steps = [shaped[self.held[s][t]].shared(n, float(self.torques[t]), grid) for s, t, n in states]
            solved |= zip(states, run_stacked(self.held[0][0].pair, steps), strict=True)
            # once more those on grids that another state has outgrown meanwhile
            states = [state for state, (_, one) in solved.items() if not self.held[state[0]][state[1]].holds(one)]
        idle = sorted({t for (_, t, _), (_, one) in solved.items() if one.torque == 0.0})
        require(
            *((False, f"torques: {plain(self.torques[t], 6)} N mm loads no tooth pair; allowed more") for t in idle)
        )
        return Evaluation(self, values, [*solved.values()])

    @property
    def told_scatter(self) -> list[str]:
        """The scatter in words, a line for each key."""
        farther = "" if self.multiple == 1.0 else f", {plain(self.multiple, 6)} times as far from its median"
        spreads = (told_distribution(one) if hasattr(one, "ppf") else "given values" for one in self.scatter.values())
        return [f"{key}: {words}{farther}" for key, words in zip(self.scatter, spreads, strict=True)]

    @property
    def told_seed(self) -> list[str]:
        """The seed in words, where samples are drawn."""
        drawn = any(hasattr(one, "ppf") for one in self.scatter.values())
        return [f"{self.seed} of the samples"] if drawn else []

    @property
    def positions(self) -> int:
        """Positions of a pitch; the last one of the scene is the first one of the next pitch."""
        return self.scene.analysis.positions - 1

    def _at(self, deviation: Mapping[str, float], values: Mapping[str, float]) -> dict[str, float]:
        """Values of the keys that scatter, of one sample; those that shape flanks deviate from their values."""
        scattered = {}
        for key, by in deviation.items():
            shapes = not key.startswith("mounting.")
            scattered[key] = by + (values.get(key, value_at(self.scene, key)) if shapes else 0.0)
        return scattered

    def _sample(self, deviation: Mapping[str, float], own: Array) -> tuple[HeldContacts, ...]:
        """Held contacts of a sample, torque by torque, where the gears stand, each in boxes of its own torque."""
        scene = self.scene.with_changes(self._at(deviation, dict(zip(self.keys, self.start.tolist(), strict=True))))
        pair = scene.pair()
        angles = pair.pitch * (np.arange(self.positions) / self.positions - 0.5)
        if without_bodies := scene.analysis.without_bodies:
            require_teeth(pair, without_bodies)
        shifted = zip(self.variables.items(), own, strict=True)
        ranges = {key: (low + by, high + by) for (key, (low, high)), by in shifted}
        supports = support_compliance(scene, pair)
        grid = GridChoice(self.cells, tolerance=self.tolerance, free_edges=scene.analysis.free_edges)

        def under(apart: int) -> list[HeldContacts]:
            gears, held = GearsUnderTorques(pair, model_of(scene, pair, apart), angles, grid), list[HeldContacts]()
            for one in gears.standing(self.torques):
                mesh, bending = trace_teeth(one.pair, angles), (one.giving_way, one.displacement)
                held += [HeldContacts(scene, mesh, ranges, t, self.cells, *bending) for t in one.torques.tolist()]
            return held

        return tuple(with_enough_teeth(pitches_apart(pair, supports, self.torques.tolist()), under))

    def _check(self) -> None:
        wanted, torques = self.scene.analysis, self.torques
        problems = []
        for key, bounds in self.variables.items():
            problems += [*problems_of_key(self.scene, key)] or [*problems_of_range(self.scene, key, bounds)]
        for key in self.scatter:
            problems += problems_of_key(self.scene, key)
        checks = (
            (bool(self.variables), "variables: none given; a design varies one key at least"),
            (
                bool(torques.size) and torques.ndim == 1 and bool((np.isfinite(torques) & (torques > 0.0)).all()),
                f"torques: found {torques.tolist()}; allowed one or more [N mm], each above 0",
            ),
            (
                np.shape(self.cells) == (2,) and all(is_whole(one, FEWEST_CELLS, math.inf) for one in self.cells),
                f"cells: found {self.cells!r:.60}; allowed two whole numbers from {FEWEST_CELLS} on",
            ),
            (
                0.0 <= real(self.multiple) < math.inf,
                f"multiple: found {self.multiple!r:.60}; allowed a finite number from 0 on",
            ),
            (
                wanted.positions >= FEWEST_POSITIONS,
                f"analysis.positions: {wanted.positions}; allowed from {FEWEST_POSITIONS} on, for peak-to-peak values",
            ),
            (
                wanted.load_sharing,
                "analysis.load_sharing: false; allowed true: in a design all tooth pairs share the load",
            ),
        )
        problems += [problem for holds, problem in checks if not holds]
        below = {
            "smoothing": (math.inf, "a finite length [um] above 0"),
            "tolerance": (1.0, "a number between 0 and 1"),
        }
        for name, (end, allowed) in below.items():
            if not 0.0 < real(given := getattr(self, name)) < end:
                problems.append(f"{name}: found {given!r:.60}; allowed {allowed}")
        if problems:
            raise InputError(problems)


def _within(bounds: tuple[str, tuple[float, float]], value: float) -> tuple[bool, str]:
    key, (low, high) = bounds
    return low <= value <= high, f"{key}: {plain(value, 6)}; allowed {plain(low, 6)} to {plain(high, 6)}"


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
        self._grids = {
            place: [one for one in shared[k] if one.active.any()] for k, place in enumerate(np.ndindex(shape))
        }
        self._tangents: dict[tuple[int, int], tuple[Tangents, Array]] = {}
        self._found: dict[tuple[str, int, int], tuple[float, Array]] = {}

    @property
    def figures(self) -> dict[str, Array]:
        """All figures of the model, (sample, torque) each."""
        return {name: self.figure(name) for name in self.model.figures}

    @property
    def gradients(self) -> dict[str, Array]:
        """Their gradients, (sample, torque, key) each, per unit of the key."""
        return {name: self.gradient(name) for name in self.model.figures}

    def figure(self, name: str, torques: Sequence[int] | None = None) -> Array:
        """One of ``FIGURES``, (sample, torque), under some of the torques by their indices, or under all."""
        samples, chosen = range(len(self.model.deviations)), self._chosen(name, torques)
        return np.array([[self._figure(name, s, t)[0] for t in chosen] for s in samples])

    def gradient(self, name: str, torques: Sequence[int] | None = None) -> Array:
        """Its gradient, (sample, torque, key), per unit of the key."""
        samples, chosen = range(len(self.model.deviations)), self._chosen(name, torques)
        return np.array([[self._gradient(name, s, t) for t in chosen] for s in samples])

    def _chosen(self, name: str, torques: Sequence[int] | None) -> Sequence[int]:
        every = range(self.model.torques.size)
        self.model.require_figure("figure", name)
        require(
            (
                torques is None or {*torques} <= {*every},
                f"torques: {torques!r:.60}; allowed indices 0 to {len(every) - 1}",
            ),
        )
        return every if torques is None else torques

    def _figure(self, name: str, s: int, t: int) -> tuple[float, Array]:
        """A figure, and its derivatives to the errors of the positions [um], or to the forces of all active cells."""
        if (name, s, t) not in self._found:
            figure = FIGURES[name]
            if isinstance(figure, FigureOfStrength):
                (stress, by_force), factor = self._figure(figure.stress, s, t), self._factor(figure, s, t)
                self._found[name, s, t] = factor * stress, factor * by_force
            elif isinstance(figure, FigureOfErrors):
                errors = self.model.micrometres * self.transmission_error[s, t]
                self._found[name, s, t] = figure.of(errors, self.model.smoothing)
            else:
                positions = [self._grids[s, t, n] for n in range(self.model.positions)]
                value, slopes = figure.of(self.model.roots, self.model.held[s][t], positions)
                grids = (grid for position in positions for grid in position)
                active = [slope[grid.active] for slope, grid in zip(slopes, grids, strict=True)]
                self._found[name, s, t] = value, np.concatenate(active)
        return self._found[name, s, t]

    def _factor(self, figure: FigureOfStrength, s: int, t: int) -> float:
        """Utilisation per unit of its stress."""
        return figure.factor(utilisation_of(self.model.held[s][t].scene, float(self.model.torques[t])))

    def _gradient(self, name: str, s: int, t: int) -> Array:
        if isinstance(figure := FIGURES[name], FigureOfStrength):
            return self._factor(figure, s, t) * self._gradient(figure.stress, s, t)
        slopes = self._figure(name, s, t)[1]
        tangents, gaps = self._tangents_of(s, t)
        if isinstance(FIGURES[name], FigureOfErrors):
            scale = -self.model.driving * self.model.micrometres
            return np.asarray(scale * tangents.rotation_change(gaps) @ slopes)
        return np.asarray(tangents.functional_change(slopes, gaps).sum(axis=-1))

    def _tangents_of(self, s: int, t: int) -> tuple[Tangents, Array]:
        """Linear answers of all positions, and the growth of the gaps at their active cells (keys, n) [mm per unit]."""
        if (s, t) not in self._tangents:
            states = [self._grids[s, t, n] for n in range(self.model.positions)]
            tangents = Tangents(states, self.model.held[s][t].bending, LINEAR)
            gaps = tangents.gathered(self._slopes[self.model.held[s][t]][grid.contact] for grid in tangents.grids)
            self._tangents[s, t] = tangents, gaps
        return self._tangents[s, t]

    @cached_property
    def _slopes(self) -> dict[HeldContacts, dict[ContactPoint, Array]]:
        """Derivatives of the gaps of each sample."""
        samples = zip(self.model.held, self.model.own_deviations, strict=True)
        return {held: held.slopes(self.x + own) for by_torque, own in samples for held in dict.fromkeys(by_torque)}
