"""From a position of the pair to the deck of a run: which teeth touch, and how fine their meshes must be."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from validation.calculix.deck import LOAD_STEPS, THICKNESS, PlaneDeck
from validation.calculix.grading import graded
from validation.calculix.mesh_position import Position, ToothPair
from validation.calculix.section import Fineness, Ints, Section, gear_section
from validation.calculix.steel import PENALTY, half_width
from validation.calculix.tooth_form import Array, ToothForm

PAIRS = (-2, -1, 0, 1, 2)
REACH = 0.3
"""Pairs whose gap is below this part of the setback may come into contact as the others deflect."""
FAINTEST = 0.1
"""Share of the load for which the mesh of the least loaded pair is still fine enough."""
SURFACE_REACH = 1.5
"""Half length of the contact surfaces in half widths under the whole load ..."""
SURFACE_MARGIN = 0.08
"""... and beyond these [mm]: a contact moves a little as the teeth bend."""
CORE_REACH, CORE_MARGIN = 1.3, 0.04
"""Half length of the finest part of the mesh in expected half widths, and beyond these [mm]."""


@dataclass(frozen=True)
class Meshing:
    """How fine the mesh is; elements are quadratic.

    Attributes
    ----------
    per_half_width : float
        Contact elements to the Hertz half width; their nodes are half as far apart.
    growth : float
        Growth of the element size per length away from the contact.
    coarsest, beside, far : float [mm]
        Largest element of a loaded tooth, of its neighbours, and of all others.
    rim : float
        Size of the first layer of the rim over its height.
    fillet : float [mm]
        Largest element on the fillets of loaded teeth and their neighbours, if less.
    """

    per_half_width: float = 5.0
    growth: float = 0.45
    coarsest: float = 1.0
    beside: float = 2.0
    far: float = 4.0
    rim: float = 0.1
    fillet: float = math.inf

    def finer(self, factor: float) -> Meshing:
        """The same with all elements smaller by a factor."""
        return Meshing(
            self.per_half_width * factor,
            self.growth / factor,
            self.coarsest / factor,
            self.beside / factor,
            self.far / factor,
            self.rim / factor,
            self.fillet / factor,
        )


def touching_pairs(position: Position) -> dict[int, ToothPair]:
    """Tooth pairs that overlap at a position, or nearly so."""
    touches = {pair: position.touch(pair) for pair in PAIRS}
    return {pair: touch for pair, touch in touches.items() if touch and touch.gap < REACH * position.setback}


def unloaded_setback(position: Position) -> float:
    """Setback at which the first tooth pair is in contact, whatever that of the position is [mm]."""
    gaps = [touch.gap for touch in map(position.touch, PAIRS) if touch]
    return position.setback + min(gaps)


def plane_deck(
    position: Position,
    line_load: float,
    meshing: Meshing,
    penalty: float = PENALTY,
    load_steps: tuple[float, ...] = LOAD_STEPS,
    stress: bool = False,
) -> PlaneDeck:
    """Deck of a plane strain slice.

    Parameters
    ----------
    position : Position
        Its setback is the one expected under load, so that the pinion hardly turns.
    line_load : float [N/mm]
        Torque over pinion base radius and face width.
    meshing : Meshing
    penalty : float [MPa/mm]
    load_steps : tuple of float
    stress : bool
        Whether the stress of all nodes is asked for.
    """
    touches = touching_pairs(position)
    pinion, wheel = sections(position, touches, line_load, meshing)
    flanks = {
        pair: (
            flank_within_reach(pinion, pair % position.pinion.teeth, 0.0, touch.pinion_radius, reach),
            flank_within_reach(wheel, pair % position.wheel.teeth, position.centre_distance, touch.wheel_radius, reach),
        )
        for pair, touch in touches.items()
        for reach in [surface_reach(position, touch, line_load)]
    }
    force = line_load * position.pinion.base_radius / position.pinion.bore_radius * THICKNESS
    return PlaneDeck(pinion, wheel, position.centre_distance, flanks, force, penalty, load_steps, stress)


def sections(
    position: Position, touches: dict[int, ToothPair], line_load: float, meshing: Meshing
) -> tuple[Section, Section]:
    """Plane meshes of pinion and wheel, fine where their teeth touch."""
    widths = expected_half_widths(position, touches, line_load)
    pinion = _fineness(position.pinion, {k: touch.pinion_radius for k, touch in touches.items()}, widths, meshing)
    wheel = _fineness(position.wheel, {k: touch.wheel_radius for k, touch in touches.items()}, widths, meshing)
    return (
        gear_section(position.pinion, pinion, rim_layers(position.pinion, meshing), position.pinion_tooth(), 0.0, -1),
        gear_section(
            position.wheel,
            wheel,
            rim_layers(position.wheel, meshing),
            position.wheel_tooth(),
            position.centre_distance,
            1,
        ),
    )


def rim_layers(form: ToothForm, meshing: Meshing) -> Array:
    """Fractions of the way from tooth to bore, the first layer no thicker than the elements on the fillets."""
    first = min(meshing.rim, meshing.fillet / (form.root_radius - form.bore_radius))
    return graded(1.0, 0.0, 0.0, first, 0.6 * meshing.growth, 6.0 * meshing.rim)


def expected_half_widths(position: Position, touches: dict[int, ToothPair], line_load: float) -> dict[int, float]:
    """Hertz half width of each pair [mm], the load shared as the overlaps."""
    overlap = {pair: max(-touch.gap, 0.0) for pair, touch in touches.items()}
    total = sum(overlap.values())
    return {
        pair: half_width(line_load * max(overlap[pair] / total, FAINTEST), relative_radius(position, touch))
        for pair, touch in touches.items()
    }


def surface_reach(position: Position, touch: ToothPair, line_load: float) -> float:
    """Half length of the contact surfaces of a tooth pair [mm]."""
    return SURFACE_REACH * half_width(line_load, relative_radius(position, touch)) + SURFACE_MARGIN


def relative_radius(position: Position, touch: ToothPair) -> float:
    """Radius of relative curvature rho1 rho2/(rho1 + rho2) of the involutes at a touch [mm]."""
    first = math.sqrt(touch.pinion_radius**2 - position.pinion.base_radius**2)
    second = math.sqrt(touch.wheel_radius**2 - position.wheel.base_radius**2)
    return first * second / (first + second)


def flank_within_reach(section: Section, tooth: int, axis: float, radius: float, reach: float) -> Ints:
    """Elements of a loaded flank around the radius at which it is touched.

    Parameters
    ----------
    section : Section
    tooth : int
    axis : float [mm]
        Place of the gear's axis on the x axis.
    radius, reach : float [mm]
    """
    chosen = section.flanks[tooth]
    middle = section.nodes[section.elements[chosen, 4]]
    touched = middle[np.argmin(np.abs(np.hypot(middle[:, 0] - axis, middle[:, 1]) - radius))]
    return chosen[np.hypot(*(middle - touched).T) < reach]


def _fineness(
    form: ToothForm, radii: dict[int, float], widths: dict[int, float], meshing: Meshing
) -> dict[int, Fineness]:
    """Fineness of every tooth of a gear: fine in contact, coarser beside, coarsest far away."""
    table = {tooth: _even(form, meshing.far) for tooth in range(form.teeth)}
    for pair in radii:
        for beside in (pair - 1, pair + 1):
            table[beside % form.teeth] = replace(_even(form, meshing.beside), fillet=meshing.fillet)
    for pair, radius in radii.items():
        a = widths[pair]
        core = CORE_REACH * a + CORE_MARGIN
        finest = a / meshing.per_half_width
        table[pair % form.teeth] = Fineness(radius, finest, core, a, meshing.growth, meshing.coarsest, meshing.fillet)
    return table


def _even(form: ToothForm, size: float) -> Fineness:
    return Fineness(form.pitch_radius, size, 0.0, 0.0, 0.0, size)
