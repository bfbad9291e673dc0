r"""Measured topographies: where the points of a measured flank lie, and how far they are off the nominal one.

The excess e is a distance along the normal, positive where the flank has **more** material than the nominal one, as
gear measuring centres count; a modification counts the material removed, delta = -e. Both are turned into an angle by
the same rule, :math:`\Theta = \Theta_n + s\, e\, |\nabla F|`.

References
----------
ISO/TR 10064-6 and ISO 17485 (measurement of bevel gears: flank form grids, deviations normal to the flank).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.flanks.base import Flank

LARGEST_EXCESS = 0.1
"""Part of the flank's height that no deviation reaches: beyond it the points belong to another flank."""


class Topography(ABC):
    """Points of a measured flank in rows and columns, axes (profile, lengthwise), in the gear's own frame.

    Attributes
    ----------
    radius, axial : (n, m) array [mm]
        Cylindrical coordinates of the points; axial from mid-face (cylindrical) or from the apex (bevel).
    notes : mapping
        What the file said about the measurement.
    """

    radius: Array
    axial: Array
    notes: Mapping[str, str]

    @abstractmethod
    def excess_over(self, nominal: Flank, turned: bool) -> Array:
        """Material (n, m) in excess of a nominal flank [mm]; ``turned``: the azimuth of the tooth has no meaning."""


@dataclass(frozen=True, eq=False)
class MeasuredPoints(Topography):
    """Points of one flank, measured in the gear's own frame (z along its axis).

    Parameters
    ----------
    points : (n, m, 3) array [mm]
        x, y, z; the azimuth of the tooth is free where the flank is turned to its pitch point.
    notes : mapping, optional

    Raises
    ------
    InputError
        If the shape is another one or a point is not finite.
    """

    points: ArrayLike
    notes: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        points = _grid("points", self.points, 3)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "radius", np.hypot(points[..., 0], points[..., 1]))
        object.__setattr__(self, "axial", points[..., 2])

    def excess_over(self, nominal: Flank, turned: bool) -> Array:
        """Azimuth ahead of the nominal flank, as a distance along its normal [mm]."""
        points = np.asarray(self.points)
        ahead = np.arctan2(points[..., 1], points[..., 0]) - nominal.theta(self.radius, self.axial).value
        middle = np.angle(np.exp(1j * ahead).mean()) if turned else 0.0
        ahead = np.angle(np.exp(1j * (ahead - middle)))
        return nominal.side * ahead / nominal.gradient_norm(self.radius, self.axial).value


@dataclass(frozen=True, eq=False)
class MeasuredDeviations(Topography):
    """Deviations from the nominal flank along its normal.

    Parameters
    ----------
    radius, axial : (n, m) array [mm]
        Where they were measured.
    excess : (n, m) array [mm]
        Positive where there is more material than nominal.
    notes : mapping, optional

    Raises
    ------
    InputError
        If the shapes differ or are no grid, a value is not finite, or a radius is not positive.
    """

    radius: ArrayLike  # type: ignore[assignment]
    axial: ArrayLike  # type: ignore[assignment]
    excess: ArrayLike
    notes: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        arrays: dict[str, Array] = {}
        problems: list[str] = []
        for name in ("radius", "axial", "excess"):
            try:
                arrays[name] = _grid(name, getattr(self, name))
            except InputError as error:
                problems += error.problems
        if not problems and len({array.shape for array in arrays.values()}) > 1:
            problems.append(f"shapes {', '.join(f'{name} {array.shape}' for name, array in arrays.items())} differ")
        if "radius" in arrays and not (arrays["radius"] > 0.0).all():
            problems.append(f"radius: {arrays['radius'].min():.6g} mm is not positive")
        if problems:
            raise InputError(problems)
        for name, array in arrays.items():
            object.__setattr__(self, name, array)

    def excess_over(self, nominal: Flank, turned: bool) -> Array:  # noqa: ARG002 (the nominal flank they belong to)
        """The deviations themselves [mm]."""
        return np.asarray(self.excess)


def excess_problems(nominal: Flank, excess: Array) -> list[str]:
    """What keeps distances from a flank from being deviations of it."""
    limit, largest = LARGEST_EXCESS * min(nominal.extent), float(np.abs(excess).max())
    if largest <= limit:
        return []
    return [
        f"the points lie up to {largest:.4g} mm off the nominal flank along its normal, more than the {limit:.4g} mm "
        "of any deviation: wrong gear, hand, side of the tooth, frame or unit?"
    ]


def _grid(name: str, values: ArrayLike, parts: int | None = None) -> Array:
    """Array (n, m) or (n, m, parts) of finite numbers."""
    shape = "(n, m)" if parts is None else f"(n, m, {parts})"
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name}: an array {shape} of numbers is asked for, not {values!r:.60}") from None
    if array.ndim != (2 if parts is None else 3) or (parts is not None and array.shape[-1] != parts) or not array.size:
        raise InputError(f"{name}: shape {array.shape}; allowed {shape}, axes (profile, lengthwise)")
    bad = np.argwhere(~np.isfinite(array))
    if bad.size:
        where = f"profile line {bad[0][0] + 1}, lengthwise line {bad[0][1] + 1}"
        raise InputError(f"{name}: {len(bad)} values are not finite, the first at {where}")
    return array
