r"""Where planets may stand, and the phases of their meshes.

In the frame of the carrier planet i stands at psi_i and the sun has turned by phi_s. In mesh cycles the meshes are at

.. math:: \tau_{s,i} = \frac{z_s (\varphi_s - \psi_i)}{2\pi}, \qquad
          \tau_{r,i} = \frac{z_s \varphi_s + z_r \psi_i}{2\pi} + \gamma_{rs},

where a whole number is the pitch point of an unmodified pair, and z_r is positive, though stage files have it negative.
A planet touches sun and ring with opposite flanks, so
that between its two meshes lies its own thickness at both working circles:

.. math:: \gamma_{rs} = \sigma\,\frac{z_p (\psi_p(r_{ws}) + \psi_p(r_{wr}))}{2\pi} - \frac{z_p}{2},

psi_p half the angle of its tooth, sigma = 1 if the sun drives and -1 if the carrier does.

References
----------
Parker, Lin 2004, Mesh phasing relationships in planetary and epicyclic gears, J. Mech. Des. 126, 365-370.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.gears import CylindricalMesh, InternalMesh

MISPLACED = 1e-5
"""How far an angle may be from a possible one [rad]: angles in degrees that are written with four digits."""
CANCELLED = 1e-3
"""Sum of the waves of all planets over that of waves in phase that counts as none: such angles, times the teeth."""


def nearest_angle(angle: float, teeth: tuple[int, int, int]) -> float:
    """Angle [rad] nearest to another at which a planet can be put in: a multiple of 2 pi/(z_s + z_r).

    Parameters
    ----------
    angle : float [rad]
    teeth : (int, int, int)
        Of sun, planet and ring.

    Examples
    --------
    >>> round(math.degrees(nearest_angle(math.radians(90.0), (18, 36, 93))), 4)
    90.8108
    """
    step = 2.0 * math.pi / (teeth[0] + teeth[2])
    return step * round(angle / step)


def possible_angles(angles: Sequence[float], teeth: tuple[int, int, int]) -> tuple[float, ...]:
    """Angles [rad] nearest to others at which planets can be put in, multiples of 2 pi/(z_s + z_r) from the first.

    Planets that stand opposite stay so where z_s + z_r is even: of two places that are equally near, the second planet
    has the one opposite to that of the first. Their forces on sun and carrier cancel only there.

    Parameters
    ----------
    angles : sequence of float [rad]
    teeth : (int, int, int)
        Of sun, planet and ring.

    Examples
    --------
    >>> [round(math.degrees(one), 4) for one in possible_angles(tuple(math.pi / 2 * n for n in range(4)), (18, 37, 92))]
    [0.0, 91.6364, 180.0, 271.6364]
    """
    places: list[float] = []
    for angle in angles:
        place = angles[0] + nearest_angle(angle - angles[0], teeth)
        for other, its_place in zip(angles, places, strict=False):
            half_turns = round((angle - other) / math.pi)
            opposite = half_turns % 2 == 1 and abs(angle - other - half_turns * math.pi) <= MISPLACED
            if opposite and (teeth[0] + teeth[2]) % 2 == 0:
                place = its_place + half_turns * math.pi
        places.append(place)
    return tuple(places)


def spacing_problems(
    angles: Sequence[float], teeth: tuple[int, int, int], centre_distance: float, tip_diameter: float
) -> list[str]:
    """Why planets at some angles [rad] cannot be put in, or touch each other; none of sound ones.

    Parameters
    ----------
    angles : sequence of float [rad]
    teeth : (int, int, int)
        Of sun, planet and ring.
    centre_distance, tip_diameter : float [mm]
        Of the planets.

    Examples
    --------
    >>> spacing_problems((0.0, 2.0, 4.0), (18, 36, 93), 584.0, 816.0)[0][:60]
    'planet_angles_deg: planets cannot be put in at 114.5916, 229'
    """
    problems = []
    whole = teeth[0] + teeth[2]
    places = possible_angles(angles, teeth)
    off = [(angle, place) for angle, place in zip(angles, places, strict=True) if abs(angle - place) > MISPLACED]
    if off:
        wrong, near = (", ".join(f"{math.degrees(angle):.4f}" for angle in row) for row in zip(*off, strict=True))
        problems.append(
            f"planet_angles_deg: planets cannot be put in at {wrong} deg, where teeth and spaces of sun and ring do "
            f"not meet; the nearest that are possible are {near} deg, multiples of 360/(z_s + z_r) = "
            f"{360.0 / whole:.4f} deg from the first"
        )
    if len(angles) > 1 and (room := neighbours_apart(angles, centre_distance)) <= tip_diameter:
        problems.append(
            f"planets: neighbouring planets touch: their axes are {room:.4f} mm apart, their tip diameter is "
            f"{tip_diameter:.4f} mm; fewer planets, or a smaller planet.tip_diameter_mm"
        )
    return problems


def neighbours_apart(angles: Sequence[float], centre_distance: float) -> float:
    """Least distance of the axes of two planets at some angles [rad], in the unit of the centre distance.

    Examples
    --------
    >>> round(neighbours_apart((0.0, 0.5 * math.pi, math.pi), 10.0), 4)
    14.1421
    """
    turns = np.sort(np.mod(angles, 2.0 * math.pi))
    apart = np.diff(np.append(turns, turns[0] + 2.0 * math.pi))
    return 2.0 * centre_distance * math.sin(0.5 * min(apart.min(), math.pi))


def mesh_phases(
    sun_mesh: CylindricalMesh, ring_mesh: InternalMesh, angles: Sequence[float], sun_drives: bool
) -> tuple[Array, Array]:
    """Phases of the sun's and the ring's meshes where the sun has turned by nothing, (planets,) in mesh cycles.

    Parameters
    ----------
    sun_mesh : CylindricalMesh
        Of sun and planet.
    ring_mesh : InternalMesh
        Of planet and ring.
    angles : sequence of float [rad]
        Of the planets on the carrier.
    sun_drives : bool

    Returns
    -------
    sun, ring : (planets,) array
        From 0 up to, but not including, 1.
    """
    turns = np.asarray(angles) / (2.0 * math.pi)
    teeth = sun_mesh.pinion.teeth, ring_mesh.ring.tooth_count
    offset = ring_offset(sun_mesh, ring_mesh, sun_drives)
    return _fraction(-teeth[0] * turns), _fraction(teeth[1] * turns + offset)


def ring_offset(sun_mesh: CylindricalMesh, ring_mesh: InternalMesh, sun_drives: bool) -> float:
    """gamma_rs: by how much the ring's mesh of a planet at angle 0 is ahead of its sun's mesh, in mesh cycles."""
    planet, radii = ring_mesh.pinion, (sun_mesh.wheel_working_radius, ring_mesh.pinion_working_radius)
    half = sum(0.5 * planet.tooth_thickness_at(radius) / radius for radius in radii)
    sign = 1.0 if sun_drives else -1.0
    return sign * planet.teeth * half / (2.0 * math.pi) - 0.5 * planet.teeth


def _fraction(cycles: Array) -> Array:
    """Part of each number beyond a whole one; what is whole but for rounding has none."""
    part = np.mod(cycles, 1.0)
    return np.where(np.minimum(part, 1.0 - part) < 1e-9, 0.0, part)


def neutralised(order: int, angles: Sequence[float], sun_teeth: int) -> tuple[bool, bool]:
    """Whether equal planets cancel an order of the mesh in the sun's torsion, and in its translation.

    The sums of exp(2 pi i k tau) over the planets, and of the same times exp(+-i psi), vanish.

    Parameters
    ----------
    order : int
        k, of the mesh frequency.
    angles : sequence of float [rad]
    sun_teeth : int

    Examples
    --------
    >>> three = [0.0, 2.0 * math.pi / 3.0, 4.0 * math.pi / 3.0]
    >>> neutralised(1, three, 18), neutralised(1, three, 19)  # all in phase: only forces on the sun cancel
    ((False, True), (True, False))
    """
    psi = np.asarray(angles)
    waves = np.exp(-1j * order * sun_teeth * psi)
    sums = [abs((waves * np.exp(1j * turn * psi)).sum()) / len(psi) for turn in (0, 1, -1)]
    return bool(sums[0] < CANCELLED), bool(max(sums[1:]) < CANCELLED)
