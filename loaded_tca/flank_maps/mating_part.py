"""The part of a flank that its mating gear works with at the constant ratio, and a grid over it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError
from loaded_tca.flank_maps.conjugate import conjugate_contact
from loaded_tca.flanks.base import Flank
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded.roots import find_roots

FINENESS = (129, 65)
"""Points along the profile and lengthwise between which places are interpolated; what is computed there is computed at
the very place that is returned."""
SCAN = (33, 33)
"""Shares along the profile and lengthwise at which the mating gear is looked for."""
CLOSE = 1e-9
"""Accuracy of an edge, as a share of the flank."""
ROUNDING = 1e-5
"""Distance beyond an edge [modules] that still counts as on the flank: places are interpolated so closely."""
NOWHERE = -1.0
"""Room [modules] where there is no contact at all: beyond any edge."""

Edge = Callable[[Array, NDArray[np.int_]], Array]
"""Room [modules] at shares along a line, of the lines named by the second argument."""


def mated_grid(pair: GearPair, profile: int, lengthwise: int) -> tuple[Array, Array]:
    """Even grid over the part of the pinion's flank that the wheel reaches at the constant ratio.

    Lengthwise it ends with the narrower gear, as found in the middle of the reached profile; along the profile each
    line ends where the mating gear's tip or form circle does, or the own ones.

    Parameters
    ----------
    pair : GearPair
    profile, lengthwise : int
        Points from the foot to the tip, and from the toe (z < 0) to the heel.

    Returns
    -------
    rho, z : (profile, lengthwise) array [mm]

    Raises
    ------
    GeometryError
        If the mating gear reaches no part of the flank.
    """
    u, v = (np.linspace(0.0, 1.0, count) for count in SCAN)
    _, room = _rooms(pair, *np.meshgrid(u, v, indexing="ij"))
    row = int((room >= -ROUNDING).sum(axis=1).argmax())
    first, last = _ends(v, room[row][:, None], lambda at, _: _rooms(pair, np.full_like(at, u[row]), at)[1])
    v = np.linspace(first[0], last[0], lengthwise)
    room, _ = _rooms(pair, *np.meshgrid(u, v, indexing="ij"))
    low, high = _ends(u, room, lambda at, lines: _rooms(pair, at, v[lines])[0])
    share = np.linspace(0.0, 1.0, profile)[:, None]
    return _places(pair.pinion.flank, low + share * (high - low), v)


def _rooms(pair: GearPair, u: Array, v: Array) -> tuple[Array, Array]:
    """Room [modules] along the profile, and to the nearest edge of all, at shares (...) of the pinion's flank."""
    contact = conjugate_contact(pair, *_places(pair.pinion.flank, u, v))
    along = np.where(contact.exists, contact.profile_room / pair.module, NOWHERE)
    side = np.where(contact.exists, contact.lengthwise_room / pair.module, NOWHERE)
    return along, np.minimum(along, side)


def _places(flank: Flank, u: Array, v: Array) -> tuple[Array, Array]:
    """(rho, z) at shares of the flank along the profile and lengthwise."""
    at = [part * (count - 1.0) for part, count in zip(np.broadcast_arrays(u, v), FINENESS, strict=True)]
    rho, z = (map_coordinates(part, at, order=1, mode="nearest") for part in flank.grid(*FINENESS))
    return rho, z


def _ends(shares: Array, room: Array, edge: Edge) -> tuple[Array, Array]:
    """First and last share (m,) of each line at which there is room, from samples (shares, m)."""
    on = room >= -ROUNDING
    if not on.any(axis=0).all():
        raise GeometryError(
            "no common flank: at the constant ratio the mating gear does not reach the whole length of the flank, "
            "or none of it; check the tips of the teeth and how the gears are mounted"
        )
    lines, count = np.arange(room.shape[1]), len(shares)
    first, last = on.argmax(axis=0), count - 1 - on[::-1].argmax(axis=0)
    found = []
    for inside, outside in ((first, np.maximum(first - 1, 0)), (last, np.minimum(last + 1, count - 1))):
        brackets = np.stack([shares[outside], shares[inside]])
        values = np.stack([room[outside, lines], room[inside, lines]])
        found.append(find_roots(edge, brackets, values, CLOSE))
    return found[0], found[1]
