"""Interference of whole gears, which the contact of one flank of each does not notice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from loaded_tca.errors import GeometryError

ROUNDING = 1e-4
"""Overlap over the module that is none: profile shifts printed with four digits leave 0.07 um at module 4.5."""
RIGID = 0.2
"""Overlap of teeth over the module to which none give way: both flanks of a tooth would have to by a tenth of a module,
with a stress at their roots of a fiftieth of Young's modulus, whatever the material."""
BOTH_WAYS = ("pinion", "wheel"), ("wheel", "pinion")
AT_MID_FACE = "at mid-face without mounting errors"
"""Place of the room of gears on meeting axes."""


class Room(NamedTuple):
    """Room that whole gears leave each other in the mesh [mm]; negative: they interfere there.

    Attributes
    ----------
    backlash : float
        Spaces less teeth, at the working or mean pitch circles.
    below_form : (float, float)
        How far the tip of the mating gear ends above the form circle of pinion and wheel, on the line of action.
    below_root : (float, float)
        How far above their roots.
    """

    backlash: float
    below_form: tuple[float, float]
    below_root: tuple[float, float]


def interferences(room: Room, module: float, place: str, *, nominal: bool = False) -> Sequence[str]:
    """Sentences on what jams gears that turn all the same where their teeth give way; none of sound gears.

    Parameters
    ----------
    room : Room
    module : float [mm]
        Normal module.
    place : str
        Where the room is that of the gears, for instance a centre distance.
    nominal : bool
        Whether the teeth are nominal ones that fill each other's spaces, so that nothing is known of the backlash of
        gears that are made after them: their teeth are thinner by tolerances of the tooth thickness.

    Raises
    ------
    GeometryError
        If nothing can turn: teeth overlap by more than 0.2 modules, or tips reach into the mating gear's root.

    Examples
    --------
    >>> len(interferences(Room(-0.02, (0.1, -0.003), (0.7, 0.7)), 3.0, "at the centre distance of 141 mm"))
    2
    """
    if problems := [*_what_stops(room, module)]:
        raise GeometryError(f"the gears cannot turn {place}: {'; '.join(problems)}")
    return [f"{sentence} ({place} by {told})" for sentence, told in _what_jams(room, module, nominal)]


def _what_jams(room: Room, module: float, nominal: bool) -> Iterator[tuple[str, str]]:
    """What interferes, and by how much."""
    if room.backlash < -ROUNDING * module and not nominal:
        yield (
            "negative backlash: teeth are thicker than the spaces of the mating gear, so that whole gears jam, while "
            "the analysis has the contact of one flank of each",
            f"{-room.backlash:.4f} mm",
        )
    for (name, mating), length in zip(BOTH_WAYS, room.below_form, strict=True):
        if length < -ROUNDING * module:
            yield (
                f"fillet interference: the tip of the {mating} reaches below the form circle of the {name}, where its "
                "flank ends",
                f"{-length:.4f} mm on the line of action",
            )


def _what_stops(room: Room, module: float) -> Iterator[str]:
    """Why nothing can turn."""
    if room.backlash < -RIGID * module:
        yield (
            f"teeth are {-room.backlash:.4g} mm thicker than the spaces of the mating gear, more than {RIGID:g} "
            "modules, to which no teeth give way"
        )
    for (name, mating), length in zip(BOTH_WAYS, room.below_root, strict=True):
        if length < -ROUNDING * module:
            yield f"the tip of the {mating} reaches {-length:.4g} mm into the root of the {name}"
