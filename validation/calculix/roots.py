"""Largest stress at the roots of the teeth of a run in plane strain."""

from __future__ import annotations

import math
from dataclasses import dataclass

from validation.calculix.deck import PlaneDeck
from validation.calculix.fillet import fillets
from validation.calculix.mesh_position import Position
from validation.calculix.tooth_form import Array


@dataclass(frozen=True)
class Extreme:
    """Largest tension or compression of a gear.

    Attributes
    ----------
    stress : float [MPa]
    angle : float [deg]
        Between the tangent of the fillet and the middle of the tooth.
    tooth : int
        Number of its tooth pair.
    side : str
        "loaded" or "back".
    """

    stress: float
    angle: float
    tooth: int
    side: str


@dataclass(frozen=True)
class RootResult:
    """Both extremes of a gear over both fillets of its loaded teeth and of their neighbours.

    Attributes
    ----------
    gear : str
        "pinion" or "wheel".
    tension, compression : Extreme
    """

    gear: str
    tension: Extreme
    compression: Extreme


def root_stress(position: Position, deck: PlaneDeck, stress: Array) -> tuple[RootResult, RootResult]:
    """Extremes of pinion and wheel in the last step.

    Parameters
    ----------
    position : Position
    deck : PlaneDeck
        With fine fillets.
    stress : (steps, n, 6) array [MPa]
        At the nodes: xx, yy, zz, xy, yz, zx; the wheel's after the pinion's.
    """
    last = stress[-1][:, [0, 1, 3]]
    split = len(deck.pinion.nodes)
    teeth = sorted({pair + beside for pair in deck.flanks for beside in (-1, 0, 1)})
    gears = (
        ("pinion", position.pinion, deck.pinion, position.pinion_tooth, 0.0, last[:split]),
        ("wheel", position.wheel, deck.wheel, position.wheel_tooth, position.centre_distance, last[split:]),
    )
    results = []
    for name, form, section, middle, axis, nodal in gears:
        found = []
        for tooth in teeth:
            sides = fillets(form, section.nodes, middle(tooth), axis)
            for side, fillet in zip(("loaded", "back"), sides, strict=True):
                angle, along = fillet.told(fillet.across(nodal[fillet.nodes]))
                for place in (along.argmax(), along.argmin()):
                    found.append(Extreme(float(along[place]), math.degrees(angle[place]), tooth, side))
        found.sort(key=lambda extreme: extreme.stress)
        results.append(RootResult(name, found[-1], found[0]))
    return results[0], results[1]
