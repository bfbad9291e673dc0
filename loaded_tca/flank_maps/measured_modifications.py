r"""What a measured flank is in terms of modifications: slopes, crownings and twist, beside those of its scene.

The material that is missing at the points of a measurement, -e, is taken for the sum of what the modifications of a
scene remove, each of an amount of its own, and a turn of the flank,

.. math:: \sum_k w_k \Big( e_k + \sum_m C_m\, f_m(P_k) - s\,\tau / |\nabla F|_k \Big)^2 \to \min ,

with the shapes f of the scene: the slopes over the face width and the active profile, parabolic crownings (or what
forms of crownings it has) at their ends, and the twist. What no such modification is remains as form deviations and
waviness.

References
----------
ISO 1328-1:2013, clause 4.4 (slopes by least squares, form deviations); ISO 21771, clause 5 (modifications).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array, GearName
from loaded_tca.errors import InputError, named, require
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.removal import removal_change
from loaded_tca.flanks.topography import LINES_NOTE, Topography, excess_problems
from loaded_tca.pairs.gear import Gear
from loaded_tca.plain import plain
from loaded_tca.scene import Scene
from loaded_tca.scene.build import build_topography
from loaded_tca.scene.section import Section
from loaded_tca.units import MICROMETRES

MeasuredFrom = Literal["modified", "unmodified"]
"""What deviations were measured from: the flank with the modifications of the scene, or without."""
AMOUNTS = ("helix_slope_um", "profile_slope_um", "lead_crowning_um", "profile_crowning_um", "twist_um")
"""Keys of the modifications that a measured flank is written as."""
ALIKE = 1e-6
"""Singular value, over the largest, below which points do not tell modifications apart."""


@checked
@dataclass(frozen=True, eq=False)
class MeasuredModifications:
    """Modifications of a measured flank, beside those of its scene.

    Attributes
    ----------
    scene : Scene
    gear : {"pinion", "wheel"}
    keys : tuple of str
        Of ``AMOUNTS``; without the twist where the flank was measured in two lines.
    design : (k,) array [um]
        Amounts of the scene.
    measured : (k,) array [um]
        Those of the measured flank.
    deviation : (k,) array [um]
        Standard deviations of these if what is left is noise.
    excess : (n, m) array [mm]
        Deviations as measured, positive for more material, less a turn of the flank.
    left : (n, m) array [mm]
        Of them what the modifications leave: form deviations.
    """

    scene: Scene
    gear: GearName
    keys: tuple[str, ...]
    design: Array
    measured: Array
    deviation: Array
    excess: Array
    left: Array

    @property
    def written(self) -> Scene:
        """The scene with these modifications in the place of its own, on a flank by its equations.

        Raises
        ------
        InputError
            If a scene cannot have them: crownings that are hollow.
        """
        changes: dict[str, Any] = {
            f"{self.gear}.modifications.{key}": float(value)
            for key, value in zip(self.keys, self.measured, strict=True)
        }
        return self.scene.with_changes(
            changes | {f"{self.gear}.flank.form": "analytic"} | dict.fromkeys(_of_form(self.gear))
        )

    def summary(self) -> str:
        """Amounts of the scene and of the measured flank, and the form deviations that are left."""
        width = max(map(len, self.keys))
        lines = [f"{self.gear + ' [um]':<{width}}  {'design':>10}{'measured':>10}{'+- std':>10}{'difference':>12}"]
        for key, design, measured, deviation in zip(self.keys, self.design, self.measured, self.deviation, strict=True):
            cells = f"{design:>10.2f}{measured:>10.2f}{plain(deviation, 2):>10}{measured - design:>+12.2f}"
            lines.append(f"{key:<{width}}  {cells}")
        left = MICROMETRES * self.left
        lines.append(f"form deviations left: rms {np.sqrt((left**2).mean()):.2f}, span {np.ptp(left):.2f} um")
        return "\n".join(lines)

    def __repr__(self) -> str:
        amounts = ", ".join(f"{key} {value:.2f}" for key, value in zip(self.keys, self.measured, strict=True))
        return f"MeasuredModifications({self.gear}: {amounts})"


def _of_form(gear: str) -> tuple[str, ...]:
    """Keys of a measured flank that one by its equations has not."""
    return tuple(f"{gear}.flank.{key}" for key in ("degree", "coefficients", "file", "measurement"))


@checked
def measured_modifications(
    scene: Scene, gear: str, topography: Topography | None = None, *, measured_from: str = "modified"
) -> MeasuredModifications:
    """Modifications that a measured flank has, beside those of its scene.

    Parameters
    ----------
    scene : Scene
        The measured flank is the one of the gear in contact.
    gear : {"pinion", "wheel"}
    topography : Topography, optional
        Default: that of ``[pinion.flank]`` or ``[wheel.flank]`` of the scene.
    measured_from : {"modified", "unmodified"}
        What deviations count from: the flank with the modifications of the scene, or the bare one (involute). Points in
        space count from neither: both give the same.

    Returns
    -------
    MeasuredModifications

    Raises
    ------
    InputError
        If there is no measurement, points lie beside the flank, or they do not tell the modifications apart.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> made = measured_modifications(read_scene("examples/scenes/measured_flank.toml"), "wheel")
    >>> [round(float(value)) for value in made.measured]  # slopes, crownings and twist that were put in
    [-2, 2, 8, 3, -4]
    """
    require(
        (gear in GEARS, f"gear: {gear!r:.60} is not 'pinion' or 'wheel'"),
        (
            measured_from in get_args(MeasuredFrom),
            f"measured_from: {measured_from!r:.60} is not 'modified' or 'unmodified'",
        ),
    )
    name = GEARS[GEARS.index(gear)]
    topography = _own(scene, name) if topography is None else topography
    section: Any = getattr(scene, gear).modifications
    keys = tuple(key for key in AMOUNTS if key != "twist_um" or LINES_NOTE not in topography.notes)
    bare = _with(scene, gear, {})
    flank = (_with(scene, gear, section) if measured_from == "modified" else bare).flank
    with named(f"{gear}.flank"):
        excess = _excess(topography, flank, bare.nominal_flank)
        shapes = [
            removal_change(bare.flank, _with(scene, gear, amount).flank, topography.radius, topography.axial)
            for amount in ({"lead_crowning_form": section.lead_crowning_form, key: 1.0} for key in keys)
        ]
        fit = _Fit.of(keys, topography, bare.nominal_flank, [MICROMETRES * shape for shape in shapes], excess)
    design = np.array([float(getattr(section, key)) for key in keys])
    base = design if measured_from == "modified" else np.zeros(len(keys))
    amounts = base + MICROMETRES * fit.amounts
    return MeasuredModifications(
        scene, name, keys, design, amounts, MICROMETRES * fit.deviation, fit.left + fit.modified, fit.left
    )


def _excess(topography: Topography, flank: Flank, nominal: Flank) -> Array:
    """Deviations of points that lie on a flank [mm]."""
    inside = nominal.inside(topography.radius, topography.axial, OFF_EDGE * min(nominal.extent))
    require((bool(np.all(inside)), f"{int((~inside).sum())} of {inside.size} points lie beside the flank"))
    excess = topography.excess_over(flank, turned=True)
    if problems := excess_problems(flank, excess):
        raise InputError(problems)
    return excess


@dataclass(frozen=True, eq=False)
class _Fit:
    """Amounts (k,) of modifications [mm], their standard deviations, what they make of the points and what is left."""

    amounts: Array
    deviation: Array
    modified: Array
    left: Array

    @classmethod
    def of(
        cls, keys: tuple[str, ...], topography: Topography, nominal: Flank, shapes: list[Array], excess: Array
    ) -> _Fit:
        """Least squares of the deviations (n, m) by what units of the modifications remove, and a turn of the flank."""
        shape = excess.shape
        turning = np.broadcast_to(
            nominal.side / nominal.gradient_norm(topography.radius, topography.axial).value, shape
        )
        columns = np.stack([*(-one.ravel() for one in shapes), turning.ravel()], axis=1)
        weights = topography.weights
        root = np.ones(excess.size) if weights is None else np.sqrt(np.asarray(weights).ravel())
        sizes = np.linalg.norm(root[:, None] * columns, axis=0)
        require((bool((sizes > 0.0).all()), f"the points do not determine {', '.join(keys)}; measure more points"))
        matrix = root[:, None] * columns / sizes
        values = np.linalg.svd(matrix, compute_uv=False)
        apart = excess.size >= len(sizes) and values[-1] > ALIKE * values[0]
        require((apart, f"{excess.size} points do not distinguish {', '.join(keys)}; measure more lines"))
        inverse = np.linalg.pinv(matrix) / sizes[:, None]
        amounts = inverse @ (root * excess.ravel())
        left = excess.ravel() - columns @ amounts
        free = max(1, int((root > 0.0).sum()) - len(sizes))
        deviation = float(np.linalg.norm(root * left)) / free**0.5 * np.linalg.norm(inverse, axis=1)[:-1]
        if LINES_NOTE in topography.notes:  # the noise of a point of a line is that of all points across it
            deviation *= [shape["profile" in key] ** 0.5 for key in keys]
        modified = columns[:, :-1] @ amounts[:-1]
        return cls(amounts[:-1], deviation, modified.reshape(shape), left.reshape(shape))


OFF_EDGE = 0.02
"""Part of the flank's height and width by which points may lie beyond its edges, as those of measured flanks."""


def _own(scene: Scene, gear: GearName) -> Topography:
    """The measurement of a gear of a scene."""
    frame = getattr(scene.analytic_pair(scene.sense), gear).flank.frame  # refuses scenes of more pairs than one
    measurement = getattr(scene, gear).flank.measurement
    require((measurement is not None, f'{gear}.flank: no measurement; allowed form = "measured", or a topography'))
    return build_topography(measurement, frame.upwards)


def _with(scene: Scene, gear: str, modifications: Section | dict[str, Any]) -> Gear:
    """Gear by its equations with other modifications."""
    changed = scene.with_changes({f"{gear}.modifications": modifications})
    made: Gear = getattr(changed.analytic_pair(changed.sense), gear)
    return made
