"""Tooth pairs that can be in contact at one position, and what a shared load has of each."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import ContactPoint, MeshPath


@dataclass(frozen=True, eq=False)
class ToothPair:
    """A tooth pair that may carry load at a position.

    Attributes
    ----------
    pair : int
        Its number.
    contact : ContactPoint
        Its first contact, unloaded, in the angles of its own tooth; of a pair under load that in the middle of its way.
    initial_separation : float [rad]
        Rotation of the wheel that brings it into contact; zero for the leading pair.
    gears : GearPair or None
        With the flanks of its own teeth, where they differ from those of the others; None: the common ones.
    """

    pair: int
    contact: ContactPoint
    initial_separation: float
    gears: GearPair | None = None

    def at_middle(self, middle: ContactPoint) -> ToothPair:
        """Return the pair with its contact as it is traced at the middle of its way from first contact under load.

        The way times the wheel's lever there is how far the flanks overlap. The pair still touches first where it did,
        and the torque is balanced by the lever of the pinion where it stands.
        """
        error, lever = self.contact.transmission_error, self.contact.pinion_lever
        return replace(self, contact=replace(middle, transmission_error=error, pinion_lever=lever))


@dataclass(frozen=True, eq=False)
class Share:
    """What one tooth pair carries.

    Attributes
    ----------
    tooth_pair : ToothPair
    loaded : LoadedContact
        Its contact under its force.
    tooth_deflection : float [mm]
        Bending of the teeth under the forces of all pairs, on top of the contact deformation.
    """

    tooth_pair: ToothPair
    loaded: LoadedContact
    tooth_deflection: float

    @property
    def force(self) -> float:
        """Normal force [N]."""
        return self.loaded.solution.load

    @property
    def torque(self) -> float:
        """Its part of the pinion torque [N mm]."""
        return float(self.force * self.tooth_pair.contact.pinion_lever)

    @property
    def rotation(self) -> float:
        """Rotation that its deflection asks for [rad]."""
        deflection = self.loaded.contact_deformation + self.tooth_deflection
        return float(self.tooth_pair.initial_separation + deflection / self.tooth_pair.contact.wheel_lever)


@dataclass(frozen=True, eq=False)
class SharedLoad:
    """Equilibrium of the tooth pairs of one position under one torque.

    Attributes
    ----------
    torque : float [N mm]
        Of the pinion; zero where next to none is taken for none.
    rotation : float [rad]
        Of the wheel back by the load; zero without load.
    shares : tuple of Share
        Of the k pairs that carry load, their numbers ascending; without load the leading one.
    residual : float
        Largest difference of the rotation that a pair asks for from the common one, over the rotation.
    balances : int
        How often the forces were balanced.
    """

    torque: float
    rotation: float
    shares: tuple[Share, ...]
    residual: float
    balances: int


def tooth_pairs_at(mesh: MeshPath, position: int) -> tuple[ToothPair, ...]:
    """Tooth pairs that can be in contact at a position: those within reach, corner contacts included.

    Parameters
    ----------
    mesh : MeshPath
        Unloaded contact of all teeth, :func:`loaded_tca.unloaded.trace_teeth`.
    position : int
        Index of the pinion angle.
    """
    separations = mesh.initial_separation[:, position]
    pairs = zip(mesh.pairs.tolist(), mesh.paths, separations.tolist(), strict=True)
    return tuple(ToothPair(number, path[position], max(gap, 0.0)) for number, path, gap in pairs if math.isfinite(gap))
