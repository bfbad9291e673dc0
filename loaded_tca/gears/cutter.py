r"""Face-milling cutter: the blade that cuts a flank, as a profile turned about the axis of the cutter.

With h the height above the blade tip, the cutting edge lies at the radius r(h): it grows with h on the outside blade,
which cuts the concave flank, and falls on the inside blade, which cuts the convex one.

.. math:: r(h) = r_p \pm h \tan\alpha \quad\text{(straight)}, \qquad
          r(h) = r_p \pm \left(\varrho\cos\alpha - \sqrt{\varrho^2 - (h + \varrho\sin\alpha)^2}\right)
          \quad\text{(hollow, radius } \varrho)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, inf, isfinite, radians, sin, tan
from typing import Any, Literal, get_args

import numpy as np

from loaded_tca.errors import InputError, require

FlankName = Literal["concave", "convex"]

MINUTES_PER_NUMBER = 10.0
"""Minutes of arc by which one unit of the cutter number corrects the blade angles."""
BLADE_SIGNS: dict[FlankName, int] = {"concave": 1, "convex": -1}
"""Whether the radius of a cutting edge grows (outside blade) or falls with the height above its tip."""
_LARGEST_BLADE_ANGLE = radians(60)
_LARGEST_SINE = 0.95


@dataclass(frozen=True)
class Blade:
    """Cutting edge of one blade.

    Parameters
    ----------
    point_radius : float [mm]
        r_p, of the (sharp) blade tip from the axis of the cutter.
    blade_angle : float [rad]
        alpha, against the axis of the cutter, at the tip; positive where the blade is narrower at its tip.
    blade_radius : float [mm], optional
        Of a hollow blade: a circular arc with its centre on the side of the workpiece, which crowns the flank along
        its profile. None: straight.
    edge_radius : float [mm]
        Of the rounding at the tip, which cuts the fillet and no part of the flank.

    Raises
    ------
    InputError
        If values are out of range; every one is told.

    References
    ----------
    Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21.
    """

    point_radius: float
    blade_angle: float
    blade_radius: float | None = None
    edge_radius: float = 0.0

    def __post_init__(self) -> None:
        upright = abs(self.blade_angle) < _LARGEST_BLADE_ANGLE
        straight_or_round = self.blade_radius is None or 0.0 < self.blade_radius < inf
        require(
            (0.0 < self.point_radius < inf, f"point_radius: {self.point_radius} mm is not positive and finite"),
            (upright, f"blade_angle: {self.blade_angle:.6g} rad is not within 1.047 rad (60 deg)"),
            (straight_or_round, f"blade_radius: {self.blade_radius} mm is not positive and finite"),
            (0.0 <= self.edge_radius < inf, f"edge_radius: {self.edge_radius} mm is negative or not finite"),
        )

    @property
    def form_height(self) -> float:
        r"""Height above the tip where the rounding ends and the flank begins [mm].

        .. math:: h = r_e (1 - \sin\alpha) \frac{\varrho}{\varrho + r_e}
        """
        height = self.edge_radius * (1.0 - sin(self.blade_angle))
        if self.blade_radius is None:
            return height
        return height * self.blade_radius / (self.blade_radius + self.edge_radius)

    def widening(self, height: Any) -> tuple[Any, Any, Any]:
        """By how much the cutting edge recedes from its tip at a height [mm], with its first and second derivatives.

        Beyond the end of a circular arc the edge goes on as a tangent there.
        """
        if self.blade_radius is None:
            slope = tan(self.blade_angle)
            return slope * height, slope + 0.0 * height, 0.0 * height
        radius = self.blade_radius
        sine = height / radius + sin(self.blade_angle)
        inner = np.clip(sine, -_LARGEST_SINE, _LARGEST_SINE)
        cosine = np.sqrt(1.0 - inner**2)
        slope, beyond = inner / cosine, sine - inner
        bend = np.where(beyond == 0.0, 1.0 / (radius * cosine**3), 0.0)
        return radius * (cos(self.blade_angle) - cosine + slope * beyond), slope, bend


@dataclass(frozen=True)
class Cutter:
    """Blades of a cutter, one for each flank, and the number of the blade group.

    Parameters
    ----------
    concave, convex : Blade, optional
        Outside blade, which cuts the concave flank, and inside blade, which cuts the convex one. The two need not be
        on one cutter head. None: that flank is not asked for.
    number : float
        Of the blade group: corrects both blade angles by 10 minutes each, so that the flanks of a tapered tooth get
        the same pressure angle. The outside blade becomes steeper, the inside blade less steep.

    Raises
    ------
    InputError
        If there is no blade, or the number is not finite or turns a blade beyond its range.

    Examples
    --------
    >>> from math import degrees, radians
    >>> cutter = Cutter(Blade(45.0, radians(20)), Blade(44.0, radians(20)), number=11)
    >>> [round(60.0 * degrees(cutter.blade(flank).blade_angle)) for flank in ("concave", "convex")]  # minutes
    [1090, 1310]
    """

    concave: Blade | None = None
    convex: Blade | None = None
    number: float = 0.0

    def __post_init__(self) -> None:
        some = self.concave is not None or self.convex is not None
        require(
            (isfinite(self.number), f"number: {self.number} is not finite"),
            (some, "concave, convex: a blade is needed for at least one flank"),
        )
        for name in get_args(FlankName):
            if getattr(self, name) is not None:
                self.blade(name)

    def blade(self, flank: FlankName) -> Blade:
        """Blade that cuts a flank, its angle corrected by the number of the blade group.

        Raises
        ------
        InputError
            If the cutter has no blade for this flank.
        """
        blade: Blade | None = getattr(self, flank)
        if blade is None:
            raise InputError(f"cutter.{flank}: missing; it cuts the flank that is asked for")
        turn = radians(self.number * MINUTES_PER_NUMBER / 60.0)
        return replace(blade, blade_angle=blade.blade_angle + BLADE_SIGNS[flank] * -turn)
