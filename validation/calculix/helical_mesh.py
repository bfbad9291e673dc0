"""A helical pair with short tip reliefs in space: where a tooth pair touches, and rings that are fine along that line.

Lead crowning and a helix slope of the pinion place the unloaded contact point at z = -1.5 mm, and the ends of the face
and the tips carry nothing. At some positions that point is the start of the pinion's tip relief.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from validation.calculix.grading import graded, with_midpoints
from validation.calculix.mesh_position import SAMPLES, Position
from validation.calculix.ring import Ring, turn
from validation.calculix.section import Fineness, Section, gear_section, side_radii
from validation.calculix.tooth_form import Array, ToothForm

TEETH, MODULE, HELIX_ANGLE, FACE_WIDTH = 25, 3.0, math.radians(27.0), 12.0
"""Of both gears; the pinion is left-handed."""
RELIEF, RELIEF_LENGTH = 0.040, 1.5
"""Parabolic tip relief of both gears along the normal, and its length on the path of contact [mm]."""
CROWNING, SLOPE = 0.020, 0.020
"""Of the pinion's lead along the normal: at the ends of the face, and over the whole face [mm]."""
TORQUE = 100.0
"""On the pinion [N m], all of it on one tooth pair."""
GROWTH = 0.5
"""Growth of the element size per length away from the contact."""
COARSEST, FAR = 1.2, 6.0
"""Largest elements of the loaded tooth and of all others [mm]."""
RIM = 0.06, 0.45, 0.35
"""First layer of the rim over its height, growth, and thickest layer."""
LOADED_HEIGHTS = (-4.4, 4.4)
"""Part of the face with fine layers [mm]: somewhat longer than the contact."""


def unmodified() -> ToothForm:
    """Form of both gears without relief."""
    return ToothForm(TEETH, MODULE, helix_angle=HELIX_ANGLE)


def cosine_at_base() -> float:
    """cos(beta_b) = cos(alpha_n) cos(beta)/cos(alpha_t)."""
    form = unmodified()
    return math.cos(form.pressure_angle) * math.cos(HELIX_ANGLE) / math.cos(form.transverse_angle)


def relieved() -> ToothForm:
    """Form with the relief as the transverse section has it."""
    form = unmodified()
    start = math.sqrt(form.tip_radius**2 - form.base_radius**2) - RELIEF_LENGTH
    return replace(form, relief=RELIEF / cosine_at_base(), relief_start=2.0 * math.hypot(form.base_radius, start))


@dataclass(frozen=True)
class Course:
    """Flanks over each other in one transverse section.

    Attributes
    ----------
    pinion, wheel : (n,) arrays [mm]
        Radii of the points that meet as the pinion turns; the pinion's rise.
    gap : (n,) array [mm]
        Way along the pinion's base circle until they meet.
    """

    pinion: Array
    wheel: Array
    gap: Array

    @property
    def touched(self) -> tuple[float, float]:
        """Radii where the gap is smallest [mm]."""
        least = int(self.gap.argmin())
        return float(self.pinion[least]), float(self.wheel[least])


@dataclass(frozen=True)
class HelicalPosition:
    """The pair at one pinion angle; sections are turned along the face, the pinion's clockwise along +z.

    Attributes
    ----------
    pinion_angle : float [rad]
    setback : float [mm]
        By which the wheel is behind, along its base circle.
    """

    pinion_angle: float
    setback: float

    @cached_property
    def section(self) -> Position:
        """The gears at mid-face, without lead modifications."""
        form = relieved()
        return Position(form, form, 2.0 * form.pitch_radius, self.pinion_angle, self.setback)


@lru_cache(maxsize=64)
def course(position: HelicalPosition, height: float) -> Course:
    """Flanks over each other at a position and a height [mm]."""
    pair, twist = position.section, math.tan(HELIX_ANGLE) / position.section.pinion.pitch_radius
    wheel = np.linspace(pair.wheel.root_radius, pair.wheel.tip_radius, SAMPLES)
    angle = pair.wheel_tooth() + twist * height + pair.wheel.half_angle(wheel)
    place = pair.centre_distance + wheel * np.exp(1j * angle)
    pinion = np.abs(place)
    flank = pair.pinion_tooth() - twist * height + pair.pinion.half_angle(pinion)
    lead = CROWNING * (2.0 * height / FACE_WIDTH) ** 2 + SLOPE * (height / FACE_WIDTH + 0.5)
    gap = (np.angle(place) - flank) * pair.pinion.base_radius + lead / cosine_at_base()
    both = np.flatnonzero((pinion <= pair.pinion.tip_radius) & (pinion >= pair.pinion.fillet[0][0]))[::-1]
    return Course(pinion[both], wheel[both], gap[both])


@dataclass(frozen=True)
class HelicalMeshing:
    """How fine the mesh is along the contact.

    Attributes
    ----------
    across : float [mm]
        Elements across the contact, and the depth of the first ones below it.
    along : float [mm]
        Layers along the face under the contact.
    core, depth : float [mm]
        How far to either side of the line of first touch, and below it, the elements are that fine.
    """

    across: float
    along: float
    core: float = 0.45
    depth: float = 0.2

    def levels(self) -> Array:
        """Heights of the planes between the layers [mm]."""
        low, high = LOADED_HEIGHTS
        middle = np.linspace(low, high, round((high - low) / self.along) + 1)
        ends = [
            graded(length, 0.0, 0.0, self.along, GROWTH, COARSEST)[::2]
            for length in (0.5 * FACE_WIDTH + low, 0.5 * FACE_WIDTH - high)
        ]
        return np.concatenate([low - ends[0][:0:-1], middle, high + ends[1][1:]])


@dataclass(frozen=True)
class LineRing(Ring):
    """A ring whose loaded tooth is fine along a line that moves up or down the flank over the height.

    Attributes
    ----------
    at_height : callable
        Section of the ring at a height, before it is turned.
    """

    at_height: Callable[[float], Section]

    def _at(self, height: float) -> Array:
        """Nodes of the section at a height, (n, 3)."""
        turned = self.at_height(height).nodes @ turn(self.twist * height)
        return np.column_stack([turned, np.full(len(turned), height)])


def line_ring(line: Callable[[float], float], hand: int, meshing: HelicalMeshing) -> LineRing:
    """Ring of one gear whose tooth 0 is fine along a line of radii over the height.

    Parameters
    ----------
    line : callable
        Radius of the line [mm] at a height.
    hand : {1, -1}
        Sense in which the section turns along +z.
    meshing : HelicalMeshing
    """
    form, levels = unmodified(), meshing.levels()
    first = meshing.across, meshing.core, meshing.depth, GROWTH, COARSEST
    fine = [Fineness(line(z), *first) for z in with_midpoints(levels).tolist()]
    middle = fine[len(fine) // 2]
    through = graded(_width(form, middle), 0.0, middle.depth, middle.finest, GROWTH, COARSEST).size // 2
    elements = max(side_radii(form, fineness).size // 2 for fineness in fine), through
    layers = graded(1.0, 0.0, 0.0, *RIM)
    coarse = Fineness(form.pitch_radius, FAR, 0.0, 0.0, 0.0, FAR)

    def at_height(height: float) -> Section:
        loaded = Fineness(line(height), *first, elements=elements)
        fineness = dict.fromkeys(range(1, form.teeth), coarse) | {0: loaded}
        return gear_section(form, fineness, layers, 0.0, 0.0, 1)

    section = at_height(0.0)
    twist = hand * math.tan(HELIX_ANGLE) / form.pitch_radius
    return LineRing(section, section, len(levels) - 1, 0.5 * FACE_WIDTH, 1, 1, levels, twist, at_height)


def _width(form: ToothForm, fine: Fineness) -> float:
    return 2.0 * fine.radius * float(form.half_angle(fine.radius))
