r"""How a generated flank changes with the settings that it is cut with: exact derivatives in closed form.

A setting p moves the flank at a fixed place (rho, z) of the blank. With F(rho, theta, z, phi; p) of
:mod:`loaded_tca.flanks.cradle`, whose F_phi vanishes on the flank, the turn of the cradle at which the point is cut is
of no account to first order, and

.. math:: \frac{\partial\Theta}{\partial p} = -\frac{F_p}{F_\theta}, \qquad
          F_p = G_p + \psi_p\, G_\alpha .

With the place P of the point seen from the centre of the cutter, and its gradient
:math:`g = \pm(P + h\,a)/d + r'(h)\,a` for the axis a of the cutter, G_p is g . P_p for what moves the cutter's centre
or the blank, a derivative by a for tilt and swivel, and one of the blade's edge for point radius, blade angle and blade
radius. Ratio of roll and modified roll enter by psi alone.

Settings have the names of their keys in scenes without gear and unit: ``machine.radial``, ``cutter.number``,
``cutter.concave.point_radius``. The blade of the other flank changes nothing.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, chapter 21 (the settings); the derivatives are those of an
envelope by a parameter.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError
from loaded_tca.flanks.cradle import ALPHA, CradleGeneration, Z
from loaded_tca.gears.face_milled import BLADE_SIGNS, MINUTES_PER_NUMBER, FaceMilledGear, FlankName
from loaded_tca.plain import plain

OF_MACHINE = (
    "radial",
    "cradle_angle",
    "root_angle",
    "ratio_of_roll",
    "machine_centre_to_back",
    "sliding_base",
    "blank_offset",
    "tilt",
    "swivel",
    "modified_roll_2c",
    "modified_roll_6d",
    "helical_motion",
)
"""Machine settings, which change both flanks of a gear."""
OF_ROLL = ("ratio_of_roll", "modified_roll_2c", "modified_roll_6d", "helical_motion")
"""Those that only a gear that rolls has."""
OF_BLADE = ("point_radius", "blade_angle", "blade_radius")
"""Of one blade, which change the flank that it cuts."""
SETTINGS = (
    *(f"machine.{name}" for name in OF_MACHINE),
    "cutter.number",
    *(f"cutter.{flank}.{name}" for flank in BLADE_SIGNS for name in OF_BLADE),
)


def setting_of(gear: FaceMilledGear, name: str) -> float | None:
    """Value of a setting [mm, rad]; None where the gear has none: of a blade that is not there, or is straight."""
    value: Any = gear
    for part in name.split("."):
        value = None if value is None else getattr(value, part)
    return value


def with_settings(gear: FaceMilledGear, values: Mapping[str, float]) -> FaceMilledGear:
    """Return a gear with other values of settings that it has.

    Raises
    ------
    InputError
        If a value is out of its range.
    """
    parts: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        section, _, setting = name.rpartition(".")
        parts.setdefault(section, {})[setting] = value
    cutter = replace(gear.cutter, **parts.get("cutter", {}))
    for flank in BLADE_SIGNS:
        if f"cutter.{flank}" in parts:
            cutter = replace(cutter, **{flank: replace(getattr(cutter, flank), **parts[f"cutter.{flank}"])})
    return replace(gear, machine=replace(gear.machine, **parts.get("machine", {})), cutter=cutter)


def cut_at(
    gear: FaceMilledGear, flank: FlankName, rho: Array, z: Array, settings: Sequence[str] = ()
) -> tuple[Array, Array]:
    """Theta that the cutter leaves at points of a right-hand member, and its derivatives by settings.

    Parameters
    ----------
    gear : FaceMilledGear
    flank : {"concave", "convex"}
    rho, z : (n,) array [mm]
        On the flank, from the apex of the pitch cone.
    settings : sequence of str
        Some of ``SETTINGS``.

    Returns
    -------
    (n,) array [rad]
        Not turned to the pitch point: a turn of the whole flank counts.
    (k, n) array [rad per mm, rad or 1]

    Raises
    ------
    GeometryError
        If the cutter does not leave the flank at all points.

    Examples
    --------
    >>> from loaded_tca.gears import BevelBlank, spread_blade
    >>> blank = BevelBlank((20, 30), 5.0, 22.0, spiral_angle=math.radians(35), cutter_radius=50.0, taper="duplex")
    >>> wheel, (rho, z) = spread_blade(blank)[1], (np.array([part]) for part in (60.5, 40.3))
    >>> slopes = cut_at(wheel, "concave", rho, z, ["machine.radial", "cutter.convex.point_radius"])[1]
    >>> [round(float(one), 6) for one in slopes[:, 0]]
    [0.004811, 0.0]
    """
    generation = CradleGeneration(gear.cutter.blade(flank), flank, gear.machine)
    points = generation.solve(rho, z)
    if not points.found.all():
        missing, worst = int((~points.found).sum()), int(np.argmin(points.found))
        raise GeometryError(
            f"{gear.name}, {flank} flank: at {missing} of {rho.size} points the cutter leaves no flank, first at "
            f"rho = {plain(rho[worst], 6)}, z = {plain(z[worst], 6)} mm"
        )
    if not settings:
        return points.theta.value, np.zeros((0, rho.size))
    phi = points.cradle
    slopes = _Slopes(generation, rho, points.theta.value + generation.roll(phi)[0], z, phi)
    parts = [slopes.of(name, flank) for name in settings]
    return points.theta.value, np.array([np.broadcast_to(part, rho.shape) for part in parts]) / -slopes.cut.slopes[
        ALPHA
    ]


class _Slopes:
    """F_p at points of a flank; arguments as of ``CradleGeneration.cut``."""

    def __init__(self, generation: CradleGeneration, rho: Array, alpha: Array, z: Array, phi: Array) -> None:
        self.generation, self.phi = generation, phi
        self.cut = generation.cut(rho, alpha, z, phi)
        self.place = generation.place(rho, alpha, z, phi)
        self.turn = generation.machine.cradle_angle + phi
        axis, height = generation.axis, self.cut.height
        across = self.place + np.multiply.outer(axis, height)
        self.distance = np.sqrt(np.einsum("an,an->n", across, across))
        self.steepness = generation.blade.widening(height)[1]
        self.gradient = generation.sign * across / self.distance + np.multiply.outer(axis, self.steepness)

    def of(self, name: str, flank: FlankName) -> Any:
        """F_p (n,) of a setting."""
        section, _, setting = name.rpartition(".")
        if section == "machine":
            return self._of_machine(setting)
        if name == "cutter.number":
            return -BLADE_SIGNS[flank] * math.radians(MINUTES_PER_NUMBER / 60.0) * self._of_blade("blade_angle")
        return self._of_blade(setting) if section == f"cutter.{flank}" else 0.0

    def _of_machine(self, setting: str) -> Any:
        (x, y, z), machine, phi = self.gradient, self.generation.machine, self.phi
        sine, cosine = np.sin(self.turn), np.cos(self.turn)
        out = self.place[0] + machine.radial  # the point from the axis of the cradle, along e_r
        if setting in ("tilt", "swivel"):
            return self._of_axis(setting)
        if setting == "root_angle":  # x and zeta of the machine turn about y
            along = out * cosine - self.place[1] * sine
            raised = self.place[2] - machine.sliding_base - machine.helical_motion * phi
            return -raised * (x * cosine - y * sine) + along * z
        by_setting = {
            "radial": lambda: -x,
            "cradle_angle": lambda: x * self.place[1] - y * out,
            "ratio_of_roll": lambda: self._roll(1.0 - phi * (machine.modified_roll_2c / 2.0 + phi * self._sixth)),
            "machine_centre_to_back": lambda: self.cut.slopes[Z],
            "sliding_base": lambda: z,
            "blank_offset": lambda: x * sine + y * cosine,
            "modified_roll_2c": lambda: self._roll(-machine.ratio_of_roll * phi / 2.0),
            "modified_roll_6d": lambda: self._roll(-machine.ratio_of_roll * phi**2 / 6.0),
            "helical_motion": lambda: z * phi,
        }
        return by_setting[setting]()

    @property
    def _sixth(self) -> float:
        return self.generation.machine.modified_roll_6d / 6.0

    def _roll(self, turn: Any) -> Any:
        """F_p of what turns the blank by ``turn`` times the turn of the cradle."""
        return self.cut.slopes[ALPHA] * self.phi * turn

    def _of_axis(self, setting: str) -> Any:
        """F_p of tilt or swivel: the axis of the cutter turns about its centre."""
        machine = self.generation.machine
        (sine, cosine), (across, along) = (
            (math.sin(angle), math.cos(angle)) for angle in (machine.tilt, machine.swivel)
        )
        if setting == "tilt":
            axis = np.array([-cosine * across, cosine * along, -sine])
        else:
            axis = np.array([-sine * along, -sine * across, 0.0])
        nearer = axis @ self.place
        return (self.generation.sign * self.cut.height / self.distance + self.steepness) * nearer

    def _of_blade(self, setting: str) -> Any:
        """F_p of the blade's edge, -r_p(h)."""
        blade, height = self.generation.blade, self.cut.height
        if setting == "point_radius":
            return -float(self.generation.sign)
        angle, radius = blade.blade_angle, blade.blade_radius
        if setting == "blade_angle":
            if radius is None:
                return -height / math.cos(angle) ** 2
            return -radius * (self.steepness * math.cos(angle) - math.sin(angle))
        assert radius is not None
        return (self.steepness * height - blade.widening(height)[0]) / radius
