"""Measured points from the columns that measuring centres give them in: along normals, by i and j, as two lines."""

from __future__ import annotations

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain

UNIT = 0.01
"""By how much the length of a normal may miss 1."""
ASKEW = 0.2
"""Sine of the angle by which normals may miss that across the lines of points: coarse lines bend by less."""
LONGER = 1.5
"""Lines of points that are longer than the others by this run along the tooth: faces are wide, teeth are low."""
LINES = {"profile": 0.0, "helix": 1.0, "lead": 1.0}
"""Words in the column of lines, and what stands for them."""
STRAIGHT = 0.05
"""Part of its length by which a line may leave the radius, or the place along the face, that it is measured at."""
FEWEST, MOST_OF_LINE = 4, 50
"""Points of a line, and means of points that are made of longer ones."""


def along_normals(points: Array, normals: Array, excess: Array) -> Array:
    """Points (n, m, 3) of a flank at distances (n, m) along normals from nominal points.

    Raises
    ------
    InputError
        If normals have another length than 1, or stand askew on the lines of points: columns in another order.
    """
    lengths = np.linalg.norm(normals, axis=-1)
    worst = np.unravel_index(int(np.abs(lengths - 1.0).argmax()), lengths.shape)
    require(
        (
            abs(lengths[worst] - 1.0) <= UNIT,
            f"nx, ny, nz: a normal of length {plain(lengths[worst])}; allowed 1: are the columns in this order?",
        )
    )
    units = normals / lengths[..., None]
    for axis, count in enumerate(lengths.shape):
        if count < 2:
            continue
        along = np.gradient(points, axis=axis)
        sizes = np.linalg.norm(along, axis=-1)
        require((bool((sizes > 0.0).all()), "x, y, z: points of one line lie on each other"))
        inner = np.take(np.abs((units * along).sum(axis=-1)) / sizes, range(1, max(count - 1, 2)), axis=axis)
        askew = float(inner.max())
        off, most = (float(np.degrees(np.arcsin(min(sine, 1.0)))) for sine in (askew, ASKEW))
        problem = (
            f"nx, ny, nz: a normal stands {plain(off, 3)} deg askew on its line of points; allowed up to {most:.0f}"
        )
        require((askew <= ASKEW, f"{problem}: are the columns in this order?"))
    return points + excess[..., None] * units


def runs_lengthwise_first(radius: Array, axial: Array) -> bool:
    """Whether the first index of points (n, m) runs along the tooth: its lines are the longer ones.

    Raises
    ------
    InputError
        If the lines of both indices are about as long.
    """
    first, second = (
        float(np.hypot(np.diff(radius, axis=axis), np.diff(axial, axis=axis)).sum(axis=axis).mean()) for axis in (0, 1)
    )
    alike = max(first, second) < LONGER * min(first, second)
    sizes = f"{plain(first, 3)} and {plain(second, 3)} mm long"
    problem = f"i, j: lines of points are {sizes}, about alike; name the columns profile_index and lengthwise_index"
    require((not alike, problem))
    return first > second


def flank_of_lines(line: Array, radius: Array, axial: Array, excess: Array) -> tuple[Array, Array, Array]:
    """Grid (n, m) of radius, axial coordinate and deviation [mm] of a cylindrical gear by its two lines.

    Parameters
    ----------
    line : (k,) array
        Of each point, a value of ``LINES``.
    radius, axial, excess : (k,) array [mm]

    Raises
    ------
    InputError
        If a line is missing or has too few points, the lines do not cross, or are those of no cylindrical gear.
    """
    profile, helix = ([part[line == kind] for part in (radius, axial, excess)] for kind in (0.0, 1.0))
    counts = {"profile": profile[0].size, "helix": helix[0].size}
    require(
        *((count >= FEWEST, f"line {name}: {count} points; allowed from {FEWEST} on") for name, count in counts.items())
    )
    profile, helix = (_rising(parts, along) for parts, along in ((profile, 0), (helix, 1)))
    problems = [
        f"line {name}: its {what} changes by {plain(np.ptp(parts[across]), 3)} mm; allowed one, as on cylindrical gears"
        for name, what, parts, along, across in (
            ("profile", "axial coordinate", profile, 0, 1),
            ("helix", "radius", helix, 1, 0),
        )
        if np.ptp(parts[across]) > STRAIGHT * np.ptp(parts[along])
    ]
    if problems:
        raise InputError(problems)
    at_radius, at_axial = float(helix[0].mean()), float(profile[1].mean())
    crossing = profile[0][0] <= at_radius <= profile[0][-1] and helix[1][0] <= at_axial <= helix[1][-1]
    ends = f"{plain(profile[0][0])} to {plain(profile[0][-1])} mm", f"{plain(helix[1][0])} to {plain(helix[1][-1])} mm"
    places = f"the helix lies at radius {plain(at_radius)} mm, the profile covers {ends[0]}"
    places += f"; the profile lies at axial {plain(at_axial)} mm, the helix covers {ends[1]}"
    require((crossing, f"line: the lines do not cross: {places}"))
    up = profile[2] - np.interp(at_radius, profile[0], profile[2])
    along_face = helix[2] - np.interp(at_axial, helix[1], helix[2])
    grid = np.meshgrid(profile[0], helix[1], indexing="ij")
    return grid[0], grid[1], up[:, None] + along_face


def _rising(parts: list[Array], along: int) -> list[Array]:
    """Points of a line by their rising coordinate; of many points means of those that follow each other."""
    order = np.argsort(parts[along], kind="stable")
    chunks = np.array_split(order, min(order.size, MOST_OF_LINE))
    return [np.array([float(part[chunk].mean()) for chunk in chunks]) for part in parts]
