r"""Settings from measured flanks: corrections of machine settings and blades that bring measured deviations to zero.

The errors x of some settings are sought with which the cutter leaves the flanks as they were measured: with the
deviation e_k of point k, positive for more material, its weight w_k and the exact flank Theta,

.. math:: \sum_k w_k \Big( e_k - s\,\frac{\Theta(P_k; p + x) - \Theta(P_k; p) + \tau}{|\nabla F|_k} \Big)^2
          \;\to\; \min, \qquad |x_i| \le l_i ,

by Gauss-Newton steps with exact derivatives (:mod:`loaded_tca.flanks.setting_slopes`) at the settings reached, each a
linear problem with bounds. Corrections are -x: settings p - x cut what was asked for, where errors of the settings made
the deviations. tau turns a flank about the axis of its gear: where a tooth stands has no meaning. It is one of each
flank, or one of both flanks of a gear, whose deviations then tell the thickness of the tooth, too.

All flanks that one setting changes are in one problem: both flanks of a spread blade gear follow its machine settings.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21; Gosselin, Nonaka, Shiono, Kubo & Tatsuno 1998,
Identification of the machine settings of real hypoid gear tooth surfaces, J. Mech. Des. 120; Litvin, Kuan, Wang,
Handschuh, Masseth & Maruyama 1993, Minimization of deviations of gear real tooth surfaces determined by coordinate
measurements, J. Mech. Des. 115.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, cast, get_args

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array, GearName, Mask
from loaded_tca.errors import (
    InputError,
    named,
    require,
)
from loaded_tca.flank_maps.settings_problem import MeasuredFlank, MeasuredPlaces, SettingsProblem
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.setting_slopes import OF_ROLL, SETTINGS, setting_of
from loaded_tca.flanks.topography import read_topography
from loaded_tca.gears.face_milled import BLADE_SIGNS, FaceMilledGear, FlankName
from loaded_tca.plain import plain
from loaded_tca.scene import Scene
from loaded_tca.scene.blank_face_milled import BlankFaceMilledScene
from loaded_tca.scene.build import build_modifications
from loaded_tca.scene.face_milled import Blade, Cutter, FaceMilledScene, Machine
from loaded_tca.scene.keys import did_you_mean, nearest
from loaded_tca.scene.section import entries
from loaded_tca.tooth.face_milled import FaceMilledTooth
from loaded_tca.units import MICROMETRES, factor_of, without_unit

Turned = Literal["flank", "tooth"]
"""What is free to turn about the axis of a gear: each flank, or the tooth with both."""


def _keys() -> dict[str, str]:
    """Name of a setting -> its key in the section of a gear."""
    sections = {"machine": Machine, "cutter": Cutter} | {f"cutter.{flank}": Blade for flank in BLADE_SIGNS}
    keys = {
        f"{place}.{without_unit(name)}": f"{place}.{name}" for place, one in sections.items() for name in entries(one)
    }
    return {name: keys[name] for name in SETTINGS}


KEYS = _keys()


def read_measured_flank(
    path: str | os.PathLike[str], gear: str | None = None, flank: str | None = None
) -> MeasuredFlank:
    """Measured flank of a face-milled gear in a file, as :func:`loaded_tca.flanks.read_topography` reads it.

    Parameters
    ----------
    path : str or path
    gear : {"pinion", "wheel"}, optional
        Default: by a comment of the file, ``# gear = wheel``.
    flank : {"concave", "convex"}, optional
        Default: by a comment of the file, ``# flank = convex``.

    Raises
    ------
    InputError
        If the file cannot be read, holds problems, nothing says which flank it is of, or it says that it is another.
    """
    topography = read_topography(path)
    parts = {"gear": gear, "flank": flank}
    stated = {name: part or topography.notes.get(name, "") for name, part in parts.items()}
    with named(os.fspath(path)):
        names: dict[str, Sequence[str]] = {"gear": GEARS, "flank": (*BLADE_SIGNS,)}
        notes = {name: topography.notes.get(name, "") for name in names}
        require(
            *((bool(part), f"{name}: missing; a comment '# {name} = ...'") for name, part in stated.items()),
            *(
                (note not in names[name] or note == stated[name], f"{name}: {stated[name]}; the file says {note}")
                for name, note in notes.items()
            ),
        )
        return MeasuredFlank(cast(GearName, stated["gear"]), cast(FlankName, stated["flank"]), topography)


USUAL = {
    "generated": ("machine.radial", "machine.root_angle", "machine.ratio_of_roll"),
    "formate": ("machine.radial", "machine.cradle_angle", "machine.root_angle"),
}
"""Settings that change spiral and pressure angles of a gear and are told apart by either of its flanks."""


def usual_settings(scene: Scene, measured: Sequence[MeasuredFlank]) -> tuple[str, ...]:
    """Keys of the settings that are corrected where no others are asked for: three of each measured gear.

    Raises
    ------
    InputError
        If the gears of the scene have no machine settings.
    """
    gears = dict(zip(GEARS, _cut_scene(scene).mesh().gears, strict=True))
    named_gears = dict.fromkeys(one.gear for one in measured)
    return tuple(f"{gear}.{KEYS[name]}" for gear in named_gears for name in USUAL[gears[gear].machine.generation])


@checked
@dataclass(frozen=True, eq=False)
class FlankDeviations:
    """Deviations of a measured flank before and after the corrections [mm], positive for more material.

    Attributes
    ----------
    measured : MeasuredFlank
    nominal : Flank
        Of the scene, by its equations.
    before : (n, m) array [mm]
        As measured, less the turn of the flank that makes them smallest.
    after : (n, m) array [mm]
        What the corrections leave of them.
    """

    measured: MeasuredFlank
    nominal: Flank
    before: Array
    after: Array

    def rms(self, values: Array) -> float:
        """Weighted root of the mean square of values at the points."""
        weights = self.measured.weights
        return float(np.sqrt((weights * values**2).sum() / weights.sum()))


@checked
@dataclass(frozen=True, eq=False)
class SettingsFit:
    """Corrections of settings from measured flanks.

    Attributes
    ----------
    scene : FaceMilledScene
        With the settings that the flanks were to be cut with.
    keys : tuple of str
        Settings that were free.
    corrections : (k,) array
        To be added to them, in the units that the keys end in.
    deviation : (k,) array
        Standard deviations of the corrections if what is left is noise; 0 of those at their limits, NaN where there are
        no more points than unknowns.
    limits : (k,) array
        Largest corrections that were allowed; inf: any.
    flanks : tuple of FlankDeviations
    weakest : (k,) array
        Changes of the settings, in their units, which together change the flanks least: each by itself changes them by
        at most 10 um, root of the mean square.
    effect : float [mm]
        What they change together.
    """

    scene: FaceMilledScene
    keys: tuple[str, ...]
    corrections: Array
    deviation: Array
    limits: Array
    flanks: tuple[FlankDeviations, ...]
    weakest: Array
    effect: float

    @property
    def at_limit(self) -> Mask:
        """Whether a correction is as large as allowed, (k,)."""
        return np.abs(self.corrections) >= self.limits * (1.0 - 1e-12)

    @cached_property
    def settings(self) -> Array:
        """Values of the settings in the scene, (k,), in the units of the keys."""
        return np.array([_value(self.scene, key) for key in self.keys])

    @property
    def corrected(self) -> Scene:
        """The scene with corrected settings: to cut the next gear with."""
        return self._changed(self.settings + self.corrections)

    @property
    def as_cut(self) -> Scene:
        """The scene with the settings that cut the flanks as they were measured, as far as these settings can."""
        return self._changed(self.settings - self.corrections)

    def _changed(self, values: Array) -> Scene:
        return self.scene.with_changes(dict(zip(self.keys, values.tolist(), strict=True)))

    def summary(self) -> str:
        """Corrections with their units, and the deviations before and after them."""
        width = max(map(len, self.keys))
        head = f"{'setting':<{width}}  {'in the scene':>14}  {'correction':>12}  {'+- std':>10}  {'corrected':>14}"
        lines = [head]
        for key, value, change, deviation, at_limit in zip(
            self.keys, self.settings, self.corrections, self.deviation, self.at_limit, strict=True
        ):
            line = (
                f"{key:<{width}}  {value:>14.6f}  {change:>+12.6f}  {plain(deviation, 2):>10}  {value + change:>14.6f}"
            )
            lines.append(line + ("  at its limit" if at_limit else ""))
        lines += ["", f"{'deviations [um]':<24}{'points':>8}{'rms':>10}{'largest':>10}{'rms after':>12}{'largest':>10}"]
        for one in self.flanks:
            cells = [
                f"{MICROMETRES * value:.3f}"
                for values in (one.before, one.after)
                for value in (one.rms(values), float(np.abs(values).max()))
            ]
            widths = (10, 10, 12, 10)
            row = "".join(f"{cell:>{wide}}" for cell, wide in zip(cells, widths, strict=True))
            lines.append(f"{one.measured.name:<24}{one.before.size:>8}{row}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        before, after = (
            MICROMETRES * math.sqrt(np.mean([one.rms(getattr(one, name)) ** 2 for one in self.flanks]))
            for name in ("before", "after")
        )
        return f"SettingsFit({len(self.keys)} settings, {plain(before, 3)} um rms before, {plain(after, 3)} um after)"


@checked
def fit_settings(
    scene: Scene,
    measured: Sequence[MeasuredFlank],
    settings: Mapping[str, float | None] | Sequence[str],
    *,
    turned: Turned = "flank",
) -> SettingsFit:
    """Corrections of settings that bring measured deviations to zero in least squares.

    Parameters
    ----------
    scene : Scene
        Of face-milled gears: what the flanks were to be. Its modifications are part of the nominal flanks.
    measured : sequence of MeasuredFlank
        Of the pinion, the wheel or both, one side of the teeth or both.
    settings : sequence of str, or mapping of str to float or None
        Keys of machine settings and blades that may change, as ``"wheel.machine.radial_mm"``; with the largest change
        of each in its unit, either way; None: any.
    turned : {"flank", "tooth"}
        Whether each flank is free to turn about its axis, or the tooth with both, whose thickness then counts: of
        deviations, or points in space with the nominal points they deviate from.

    Returns
    -------
    SettingsFit

    Warns
    -----
    AccuracyWarning
        If some of the settings together hardly change the flanks, by names.

    Raises
    ------
    InputError
        If the scene has no machine settings, a key is none of them or does nothing to the measured flanks, settings do
        the same to them (told by names), points are no points of their flank, or the tooth with both flanks is to turn
        as one and points in space, or two lines, do not say where these stand to each other.
    GeometryError
        If the cutter does not leave the flank where it was measured.
    ConvergenceError
        If the steps do not settle.

    Examples
    --------
    A radial setting that was 0.02 mm too large is found:

    >>> from loaded_tca.flanks import MeasuredDeviations
    >>> from loaded_tca.flanks.setting_slopes import cut_at, with_settings
    >>> from loaded_tca.scene import read_scene
    >>> scene = read_scene("examples/scenes/duplex_30x20_mended.toml")
    >>> gear = scene.mesh().wheel
    >>> flank = scene.pair().wheel.flank
    >>> rho, z = (part[1:-1, 1:-1] for part in flank.grid(7, 9))
    >>> wrong = with_settings(gear, {"machine.radial": gear.machine.radial + 0.02})
    >>> asked, left = (cut_at(one, "convex", rho.ravel(), z.ravel())[0] for one in (gear, wrong))
    >>> excess = (asked - left).reshape(rho.shape) / flank.gradient_norm(rho, z).value
    >>> measured = MeasuredFlank("wheel", "convex", MeasuredDeviations(rho, z, excess))
    >>> fit = fit_settings(scene, [measured], ["wheel.machine.radial_mm"])
    >>> round(float(fit.corrections[0]), 9)
    -0.02
    """
    cut = _cut_scene(scene)
    limits = settings if isinstance(settings, Mapping) else dict.fromkeys(settings)
    gears = dict(zip(GEARS, cut.mesh().gears, strict=True))
    _require_sound(cut, gears, measured, limits, settings, turned)
    modifications = dict(zip(GEARS, build_modifications(cut.pinion, cut.wheel), strict=True))
    problem = SettingsProblem(
        gears,
        tuple(
            MeasuredPlaces.of(
                one, gears[one.gear], FaceMilledTooth(gears[one.gear], modifications[one.gear], exact=True)
            )
            for one in measured
        ),
        tuple(limits),
        turned,
    )
    largest = np.array([math.inf if limit is None else float(limit) for limit in limits.values()])
    directions = problem.directions()
    errors, turns = problem.solved(largest / problem.factors)
    left = problem.left(errors, turns)
    before = problem.left(np.zeros(len(limits)), problem.best_turns(problem.excess))
    fixed = np.abs(errors) * problem.factors >= largest * (1.0 - 1e-12)
    return SettingsFit(
        cut,
        tuple(limits),
        -errors * problem.factors,
        problem.deviation(errors, left, fixed) * problem.factors,
        largest,
        tuple(
            FlankDeviations(one.measured, one.nominal, one.grid(first), one.grid(last))
            for one, first, last in zip(problem.points, problem.parts(before), problem.parts(left), strict=True)
        ),
        *directions,
    )


def _cut_scene(scene: Scene) -> FaceMilledScene:
    """The scene with all its settings."""
    cut = scene.cut if isinstance(scene, BlankFaceMilledScene) else scene
    if not isinstance(cut, FaceMilledScene):
        raise InputError("pair.type: the gears have no machine settings; allowed face_milled")
    return cut


def _require_sound(
    scene: FaceMilledScene,
    gears: Mapping[GearName, FaceMilledGear],
    measured: Sequence[MeasuredFlank],
    limits: Mapping[str, float | None],
    settings: Any,
    turned: str,
) -> None:
    """Refuse what is none of the scene's, every problem at once."""
    names, places = [*settings], [(one.gear, one.flank) for one in measured]
    require(
        (bool(measured), "measured: no flank is given"),
        (bool(limits), "settings: none is given"),
        (turned in get_args(Turned), f"turned: {turned!r:.60} is not 'flank' or 'tooth'"),
        *((names.count(key) < 2, f"settings: {key} is given twice") for key in dict.fromkeys(map(str, names))),
        *(
            (places.count(place) < 2, f"measured: the {place[1]} flank of the {place[0]} is given twice")
            for place in dict.fromkeys(places)
        ),
        *(
            (
                turned != "tooth" or one.topography.has_zero or sum(gear == one.gear for gear, _ in places) < 2,
                f'turned: "tooth" needs the thickness of the tooth, which the points of the {one.name} do not tell; '
                'allowed deviations, nominal points with normals and deviations, or "flank"',
            )
            for one in measured
        ),
        *(
            (
                getattr(scene, gear).flank.form == "analytic",
                f'{gear}.flank.form: allowed "analytic": the scene says what the measured flank was to be',
            )
            for gear in dict.fromkeys(gear for gear, _ in places)
        ),
        *(
            (limit is None or limit > 0.0, f"settings: {key}: a largest change of {limit} is not positive")
            for key, limit in limits.items()
        ),
    )
    require(*(check for key in limits for check in _checks_of(str(key), gears, places)))


def _checks_of(
    key: str, gears: Mapping[GearName, FaceMilledGear], places: Sequence[tuple[str, str]]
) -> Iterator[tuple[bool, str]]:
    """Whether a key is that of a setting which a measured flank has."""
    known = {f"{gear}.{name}": (gear, setting) for gear in GEARS for setting, name in KEYS.items()}
    hint = did_you_mean(nearest(key, list(known)))
    yield key in known, f"settings: {key}: no setting that cuts a flank{hint or ', as wheel.machine.radial_mm'}"
    if key not in known:
        return
    gear, setting = known[key]
    sides = {flank for name, flank in places if name == gear}
    of = setting.split(".")[1] if setting.count(".") == 2 else None
    yield bool(sides), f"settings: {key}: no flank of the {gear} is measured"
    yield not sides or of is None or of in sides, f"settings: {key}: the {of} flank of the {gear} is not measured"
    formate = not gears[gear].machine.rolls and setting.split(".")[-1] in OF_ROLL
    yield not formate, f'settings: {key}: does nothing, {gear}.machine.generation = "formate"'
    there = setting_of(gears[gear], setting) is not None
    yield there, f"settings: {key}: not there: the blade is straight, or missing"


def _value(scene: FaceMilledScene, key: str) -> float:
    """Value of a setting in its key's unit: that of the scene, or what the gear has where it is left out."""
    gear, _, path = key.partition(".")
    value: Any = getattr(scene, gear)
    for part in path.split("."):
        value = getattr(value, part)
    if value is not None:
        return float(value)
    of_gear = setting_of(getattr(scene.mesh(), gear), without_unit(path))
    assert of_gear is not None
    return of_gear * factor_of(key)
