"""A face-milled bevel gear: its blank, the cutter and the machine settings that give it its flanks."""

from __future__ import annotations

from dataclasses import dataclass
from math import sin

from loaded_tca.errors import require
from loaded_tca.gears.checks import teeth_checks
from loaded_tca.gears.cutter import BLADE_SIGNS, Cutter, FlankName
from loaded_tca.gears.machine_settings import FaceMilledBlank, MachineSettings


@dataclass(frozen=True)
class FaceMilledGear:
    """One gear of a face-milled pair: blank, cutter and machine settings.

    Parameters
    ----------
    teeth : int
        Number of teeth z, at least 3.
    blank : FaceMilledBlank
    cutter : Cutter
    machine : MachineSettings
    name : str
        What messages call this gear.
    bore_diameter : float [mm], optional
        For the compliance of the body.

    Raises
    ------
    InputError
        If the number of teeth is none, or the bore reaches the root at the toe.
    """

    teeth: int
    blank: FaceMilledBlank
    cutter: Cutter
    machine: MachineSettings
    name: str = "gear"
    bore_diameter: float | None = None

    def __post_init__(self) -> None:
        bore, largest = self.bore_diameter, 2.0 * self.blank.cone_distances[0] * sin(self.blank.root_angle)
        fits = bore is None or 0.0 <= bore < largest
        told = f"bore_diameter: {bore or 0.0:.6g} mm is not below the root diameter at the toe, {largest:.6g} mm"
        require(*teeth_checks(self.teeth), (fits, told), owner=self.name)

    @property
    def mirror(self) -> int:
        """+1 for a right-hand gear, -1 for a left-hand one, which is the mirror image of a right-hand one."""
        return 1 if self.blank.hand == "right" else -1

    def side(self, flank: FlankName) -> int:
        """Sign s of the azimuthal part of the outward normal: +1 for the concave flank of a right-hand gear."""
        return self.mirror * BLADE_SIGNS[flank]

    def flank_name(self, side: int) -> FlankName:
        """The flank with a sign s."""
        return "concave" if self.side("concave") == side else "convex"


@dataclass(frozen=True)
class FaceMilledMesh:
    """Both members of a face-milled pair.

    Parameters
    ----------
    pinion, wheel : FaceMilledGear
    shaft_angle : float [rad]
        Sigma.
    """

    pinion: FaceMilledGear
    wheel: FaceMilledGear
    shaft_angle: float

    @property
    def gears(self) -> tuple[FaceMilledGear, FaceMilledGear]:
        """Pinion and wheel."""
        return self.pinion, self.wheel

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Smallest clearance between the roots of pinion and wheel and the mating gear's tip, toe or heel [mm]."""
        both_ways = (self.pinion.blank, self.wheel.blank), (self.wheel.blank, self.pinion.blank)
        pinion, wheel = (
            min(-own.root_height(distance) - mating.tip_height(distance) for distance in own.cone_distances)
            for own, mating in both_ways
        )
        return pinion, wheel
