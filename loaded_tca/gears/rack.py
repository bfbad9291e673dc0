"""Racks: straight teeth on a bar, as the limit of external gears with more and more teeth.

A rack stands in the computation as an involute gear of ``RACK_TEETH`` teeth. All that an involute gear has at any
number of teeth is exact then: flanks are conjugate to the pinion's, the working pressure angle at the rack's reference
line is that of the basic rack, contact ratios and forces follow. What differs from a rack differs by parts of z_1/z_2:
the flank is curved by sin(alpha_t)/r_2 instead of plane, and the tip line bends away from the pinion.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, inf, pi, radians

from loaded_tca.arrays import real
from loaded_tca.errors import GeometryError, require
from loaded_tca.gears.cylindrical import CylindricalGear
from loaded_tca.gears.cylindrical_mesh import CylindricalMesh
from loaded_tca.plain import plain

RACK_TEETH = 2_000_000
"""Teeth of the gear that stands for a rack. Its flank has z_1/z_2 of the pinion's curvature, 1e-5 beside 20 teeth,
which changes the pressure of a line by half of that; rounding at its radius, 1e6 modules, changes pressures by 2e-6."""


@dataclass(frozen=True)
class Rack:
    """Rack with straight or inclined teeth.

    Parameters
    ----------
    normal_module : float [mm]
        m_n.
    face_width : float [mm]
        b.
    height : float [mm]
        From the bed, which is held rigid, to the reference line.
    pressure_angle : float [rad]
        Normal pressure angle alpha_n.
    helix_angle : float [rad]
        beta; right hand positive, left hand negative, opposite to that of the pinion.
    addendum : float [mm], optional
        From the reference line to the tip; None: m_n.
    dedendum_coefficient : float
        h_fP/m_n.
    root_radius_coefficient : float
        rho_fP/m_n of the fillets.
    thickness_allowance : float [mm]
        A_sn of the tooth thickness in the normal section at the reference line; the root follows it.
    length : float [mm], optional
        Of the toothed part, along the travel.
    name : str
        What messages call the rack.

    Raises
    ------
    InputError
        If values are out of range; every one is told.
    GeometryError
        If the tooth is pointed.

    References
    ----------
    ISO 53:1998, Cylindrical gears for general and heavy engineering - Standard basic rack tooth profile.

    Examples
    --------
    >>> rack = Rack(normal_module=3.0, face_width=25.0, height=20.0)
    >>> round(rack.pitch, 4), round(rack.bed_depth, 4)
    (9.4248, 16.25)
    """

    normal_module: float
    face_width: float
    height: float
    pressure_angle: float = radians(20)
    helix_angle: float = 0.0
    addendum: float | None = None
    dedendum_coefficient: float = 1.25
    root_radius_coefficient: float = 0.38
    thickness_allowance: float = 0.0
    length: float | None = None
    name: str = "rack"

    def __post_init__(self) -> None:
        lengths = {name: getattr(self, name) for name in ("height", "addendum", "length")}
        require(
            *(
                (value is None or 0.0 < real(value) < inf, f"{name}: {value} is not positive and finite")
                for name, value in lengths.items()
            ),
            owner=self.name,
        )
        least = self.height - self.bed_depth
        require(
            (
                self.bed_depth > 0.0,
                f"height: {plain(self.height, 6)} mm is not above {plain(least, 6)} mm, the depth of the roots below "
                "the reference line: no body is left below the teeth",
            ),
            owner=self.name,
        )

    @cached_property
    def gear(self) -> CylindricalGear:
        """The gear that stands for the rack."""
        tip = self.normal_module if self.addendum is None else self.addendum
        return CylindricalGear(
            teeth=RACK_TEETH,
            normal_module=self.normal_module,
            face_width=self.face_width,
            pressure_angle=self.pressure_angle,
            helix_angle=self.helix_angle,
            dedendum_coefficient=self.dedendum_coefficient,
            root_radius_coefficient=self.root_radius_coefficient,
            thickness_allowance=self.thickness_allowance,
            tip_alteration_coefficient=tip / self.normal_module - 1.0,
            name=self.name,
        )

    @property
    def pitch(self) -> float:
        """Transverse pitch pi m_t along the travel [mm]."""
        return pi * self.normal_module / cos(self.helix_angle)

    @property
    def radius(self) -> float:
        """What turns rotations of the gear into travels: its reference radius [mm]."""
        return self.gear.reference_radius

    @property
    def bed_depth(self) -> float:
        """Depth of the bed below the root line [mm]."""
        return self.height - self.normal_module * (self.dedendum_coefficient - self.gear.generating_profile_shift)


def rack_mesh(
    pinion: CylindricalGear, rack: Rack, distance: float | None = None, axial_offset: float = 0.0
) -> CylindricalMesh:
    """Mesh of a pinion and a rack.

    Parameters
    ----------
    pinion : CylindricalGear
    rack : Rack
    distance : float [mm], optional
        From the axis of the pinion to the reference line; None: r_1 + x_1 m_n, without backlash but for allowances.
    axial_offset : float [mm]
        Mid-face of the rack from that of the pinion.

    Raises
    ------
    InputError
        If pinion and rack do not fit each other, or the toothed part is shorter than the way of a tooth pair.
    GeometryError
        If the distance leaves no common flank, or an undercut takes away flank that the rack uses.

    Examples
    --------
    >>> pinion = CylindricalGear(teeth=20, normal_module=3.0, face_width=25.0)
    >>> mesh = rack_mesh(pinion, Rack(normal_module=3.0, face_width=25.0, height=20.0))
    >>> round(mesh.transverse_contact_ratio, 4), round(mesh.pinion_working_radius, 4)
    (1.7688, 30.0)
    """
    standing = pinion.reference_radius + pinion.profile_shift * pinion.normal_module if distance is None else distance
    require((-inf < real(standing) < inf, f"distance: {distance} mm is not finite"))
    try:
        mesh = CylindricalMesh(pinion, rack.gear, rack.radius + standing, axial_offset)
    except GeometryError as error:
        error.add_note(f"the axis of the pinion is {plain(standing, 6)} mm from the reference line of the rack")
        raise
    if rack.length is not None:
        least = (1.0 + mesh.total_contact_ratio) * rack.pitch
        require(
            (
                rack.length >= least,
                f"length: {plain(rack.length, 6)} mm is below {plain(least, 6)} mm, the length that the "
                "tooth pairs of a pitch need",
            ),
            owner=rack.name,
        )
    return mesh
