"""What ISO 10300 takes of the gears of a scene: both at the calculation point, and their virtual cylindrical gears.

Depths are those of the cones at the mean cone distance, thicknesses those of the teeth, angles of face-milled gears
those of the flanks as they are cut. x_hm is half the difference of both addenda in m_mn; h_a0 and x_sm follow from
dedendum and thickness, so that the tooth is the one of the scene whatever it was made by.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, degrees, inf, pi, sin, tan

from loaded_tca.arrays import GEARS
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import BevelMesh
from loaded_tca.gears.face_milled import FaceMilledGear, FaceMilledMesh
from loaded_tca.gears.hypoid import HypoidMesh
from loaded_tca.gears.pitch_cones import limit_pressure_angle
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_3 import RootSection
from loaded_tca.reference.iso10300_1 import EFFECTIVE_SHARE, Both, VirtualPair
from loaded_tca.reference.iso10300_3 import tip_section
from loaded_tca.scene.bevel_rows import flanks_and_points, mean_thickness
from loaded_tca.scene.spiral import Side, SpiralScene
from loaded_tca.tooth.families import FILLET_RADIUS_COEFFICIENT

_ROUNDING = 1e-9
_OTHER: dict[Side, Side] = {"concave": "convex", "convex": "concave"}


@dataclass(frozen=True)
class BevelMember:
    """One gear at its calculation point.

    Parameters
    ----------
    pitch_angle, spiral_angle : float [rad]
        delta, beta_m of the flank in contact, without sign.
    mean_cone_distance, addendum, dedendum, thickness : float [mm]
        R_m, h_am, h_fm, s_mn.
    edge_radius : float [mm]
        rho_a0, of the blade that cuts the flank in contact; 0: not known.
    generated : bool
    """

    pitch_angle: float
    spiral_angle: float
    mean_cone_distance: float
    addendum: float
    dedendum: float
    thickness: float
    edge_radius: float = 0.0
    generated: bool = True

    @property
    def mean_diameter(self) -> float:
        """d_m [mm]."""
        return 2.0 * self.mean_cone_distance * sin(self.pitch_angle)


@dataclass(frozen=True)
class BevelSheet:
    """Both gears of a scene as ISO 10300 takes them.

    Parameters
    ----------
    members : (BevelMember, BevelMember)
    pair : VirtualPair
    teeth : (int, int)
    face_width : float [mm]
        b_2 of the wheel.
    mean_pressure_angle : float [rad]
        Mean alpha_n of both sides of the teeth.
    offset : float [mm]
        a.
    cutter_radius : float [mm]
        r_c0; inf: none.
    notes : (str, ...)
        What the standard asks for and the scene does not have.
    """

    members: tuple[BevelMember, BevelMember]
    pair: VirtualPair
    teeth: tuple[int, int]
    face_width: float
    mean_pressure_angle: float
    offset: float
    cutter_radius: float
    notes: tuple[str, ...]

    @property
    def mean_diameters(self) -> Both:
        """d_m of both gears [mm]."""
        first, second = (member.mean_diameter for member in self.members)
        return first, second

    @property
    def whole_depths(self) -> Both:
        """h_m [mm]."""
        first, second = (member.addendum + member.dedendum for member in self.members)
        return first, second

    @property
    def coast_pair(self) -> VirtualPair:
        """Virtual gears of the sides that are not loaded, whose alpha_e is alpha_n and alpha_lim together."""
        pair, coast = self.pair, 2.0 * self.mean_pressure_angle - self.pair.pressure_angle
        return replace(pair, pressure_angle=coast, limit_pressure_angle=-pair.limit_pressure_angle)

    @property
    def wheel(self) -> int:
        """The gear with more teeth, 1 unless that is the one that the scene calls pinion."""
        return int(self.teeth[0] > self.teeth[1]) ^ 1

    @property
    def gear_ratio(self) -> float:
        """z_2/z_1, below 1 where the wheel is the smaller gear."""
        return self.teeth[1] / self.teeth[0]

    def tolerance_diameter(self, gear: int) -> float:
        """d_T of ISO 17485, in the middle of the working depth [mm]."""
        own, mate = self.members[gear], self.members[1 - gear]
        return own.mean_diameter + (own.addendum - mate.addendum) * cos(own.pitch_angle)

    def root_section(self, gear: int) -> RootSection:
        """Critical section of a gear under a load at its tip.

        Raises
        ------
        GeometryError
            If there is none.
        """
        own, module, coast = self.members[gear], self.pair.mean_normal_module, self.coast_pair
        shift, thickness, depth = self._tooth(gear)
        room = self._room(gear)
        if room <= 0.0:
            raise GeometryError(f"{GEARS[gear]}: the slot closes above the root at the mean point")
        return tip_section(
            self.pair.normal_teeth[gear],
            self.pair.normal_tip_diameters[gear] / module,
            tool_depth=depth,
            edge_radius=min(own.edge_radius / module or FILLET_RADIUS_COEFFICIENT, room),
            profile_shift=shift,
            thickness_shift=thickness,
            pressure_angle=self.pair.pressure_angle,
            effective_pressure_angle=self.pair.effective_pressure_angle,
            coast=(coast.normal_teeth[gear], self._angles(gear)[1]),
            generated=own.generated,
        )

    def edge_notes(self, gear: int) -> tuple[str, ...]:
        """What of the edge radius of a gear's tool does not count."""
        asked, most = self.members[gear].edge_radius, self._room(gear) * self.pair.mean_normal_module
        return (f"rho_a0: {plain(asked)} mm does not fit the slot; {plain(most)} mm is used",) if asked > most else ()

    def _tooth(self, gear: int) -> tuple[float, float, float]:
        """x_hm, x_sm and h_a0/m_mn of a gear."""
        own, mate, module = self.members[gear], self.members[1 - gear], self.pair.mean_normal_module
        shift = 0.5 * (own.addendum - mate.addendum) / module
        thickness = 0.5 * own.thickness / module - 0.25 * pi - shift * tan(self.mean_pressure_angle)
        return shift, thickness, own.dedendum / module + shift

    def _angles(self, gear: int) -> Both:
        """Pressure angles of both sides of a gear's tool, first that of the loaded one: alpha_e of gears that roll."""
        sides = self.pair, self.coast_pair
        rolls = self.members[gear].generated
        loaded, coast = (side.effective_pressure_angle if rolls else side.pressure_angle for side in sides)
        return loaded, coast

    def _room(self, gear: int) -> float:
        """Largest edge radius that fits on the bottom of the slot, in mean normal modules."""
        (_, thickness, depth), angles = self._tooth(gear), self._angles(gear)
        bottom = 0.5 * pi - 2.0 * thickness - depth * sum(tan(each) for each in angles)
        return bottom / sum((1.0 - sin(each)) / cos(each) for each in angles)


def bevel_sheet(scene: SpiralScene) -> BevelSheet:
    """Both gears of a scene of bevel or hypoid gears.

    Raises
    ------
    InputError
        If the standard has no virtual gears for them.
    """
    mesh = scene.mesh()
    steep = [
        f"pair: the pitch angle of the {name}, {plain(degrees(angle))} deg, is not below 90 deg; ISO 10300 has virtual "
        "cylindrical gears for external bevel gears only"
        for name, angle in zip(GEARS, _pitch_angles(mesh), strict=True)
        if angle >= 0.5 * pi
    ]
    if steep:
        raise InputError(steep)
    return _of_equations(mesh) if isinstance(mesh, BevelMesh) else _of_settings(mesh, scene.sides(scene.sense))


def _pitch_angles(mesh: BevelMesh | FaceMilledMesh) -> Both:
    if isinstance(mesh, BevelMesh):
        return mesh.pinion.pitch_angle, mesh.wheel.pitch_angle
    return mesh.pinion.blank.pitch_angle, mesh.wheel.blank.pitch_angle


def _virtual_pair(
    members: tuple[BevelMember, BevelMember], wheel_teeth: int, face_width: float, pressures: Both, offsets: Both
) -> VirtualPair:
    first, second = members
    return VirtualPair(
        pitch_angles=(first.pitch_angle, second.pitch_angle),
        mean_cone_distances=(first.mean_cone_distance, second.mean_cone_distance),
        spiral_angles=(first.spiral_angle, second.spiral_angle),
        offset_angles=offsets,
        pressure_angle=pressures[0],
        limit_pressure_angle=pressures[1],
        mean_normal_module=second.mean_diameter * cos(second.spiral_angle) / wheel_teeth,
        mean_addenda=(first.addendum, second.addendum),
        effective_width=EFFECTIVE_SHARE * face_width,
    )


def _of_equations(mesh: BevelMesh) -> BevelSheet:
    """Sheet of spherical involutes, which no tool is known of."""
    first, second = (
        BevelMember(
            pitch_angle=gear.pitch_angle,
            spiral_angle=abs(gear.spiral_angle),
            mean_cone_distance=gear.mean_cone_distance,
            addendum=gear.mean_addendum,
            dedendum=gear.mean_dedendum,
            thickness=gear.half_thickness_angle * 2.0 * gear.mean_cone_distance * sin(gear.pitch_angle)
            * cos(gear.spiral_angle),
        )
        for gear in (mesh.pinion, mesh.wheel)
    )  # fmt: skip
    pressure, width = mesh.wheel.normal_pressure_angle, mesh.wheel.face_width
    pair = _virtual_pair((first, second), mesh.wheel.teeth, width, (pressure, 0.0), (0.0, 0.0))
    circle = mesh.wheel.cutter_circle
    notes = [
        f"rho_a0: spherical involutes have no tool; it is taken as {plain(FILLET_RADIUS_COEFFICIENT, 6)} m_mn, or as "
        "the largest radius that fits the slots"
    ]
    if circle is None and pair.spiral_angle:
        notes.append("K_F0: taken as 1, since no cutter makes the lengthwise curve")
    shifts = mesh.pinion.profile_shift + mesh.wheel.profile_shift
    if abs(shifts) > _ROUNDING:
        notes.append(f"scope: profile shifts have a sum of {plain(shifts)}; the standard holds for a sum of 0")
    radius = inf if circle is None else circle.radius
    teeth = mesh.pinion.teeth, mesh.wheel.teeth
    return BevelSheet((first, second), pair, teeth, width, pressure, 0.0, radius, tuple(notes))


@lru_cache(maxsize=16)
def _of_settings(mesh: FaceMilledMesh, sides: tuple[Side, Side]) -> BevelSheet:
    """Sheet of face-milled gears, of their flanks as they are cut; kept, since these take 0.1 s to make."""
    _require_drive_side(mesh, sides)
    flanks, _ = flanks_and_points(mesh, sides)
    spirals = abs(flanks[0].angles.spiral), abs(flanks[1].angles.spiral)
    offsets, limit = (0.0, 0.0), 0.0
    if isinstance(mesh, HypoidMesh):
        cones = mesh.cones
        spirals = cones.rolling_spiral_angles((mesh.pinion.teeth, mesh.wheel.teeth))
        offsets, limit = (cones.axial_offset_angle, cones.offset_angle), limit_pressure_angle(cones, spirals)
    members = [_milled(gear, side, spiral) for gear, side, spiral in zip(mesh.gears, sides, spirals, strict=True)]
    others = flanks_and_points(mesh, (_OTHER[sides[0]], _OTHER[sides[1]]))[0]
    pressure, coast = (0.5 * (both[0].angles.pressure + both[1].angles.pressure) for both in (flanks, others))
    blades = [mesh.wheel.cutter.concave, mesh.wheel.cutter.convex]
    radius = 0.5 * sum(blade.point_radius for blade in blades if blade is not None)
    width, (first, second) = mesh.wheel.blank.face_width, members
    pair = _virtual_pair((first, second), mesh.wheel.teeth, width, (pressure, limit), offsets)
    notes = [
        f"rho_a0: the blades of the {name} have no edge radius; it is taken as {plain(FILLET_RADIUS_COEFFICIENT, 6)} "
        "m_mn, or as the largest radius that fits the slots"
        for name, member in zip(GEARS, members, strict=True)
        if not member.edge_radius
    ]
    teeth = mesh.pinion.teeth, mesh.wheel.teeth
    return BevelSheet((first, second), pair, teeth, width, 0.5 * (pressure + coast), mesh.offset, radius, tuple(notes))


def _require_drive_side(mesh: FaceMilledMesh, sides: tuple[Side, Side]) -> None:
    """Refuse teeth of one flank, and the flank of a hypoid pair of which formulas are missing."""
    problems = [
        f"{gear.name}.cutter: has one blade; a rating needs whole teeth with a concave and a convex flank"
        for gear in mesh.gears
        if None in (gear.cutter.concave, gear.cutter.convex)
    ]
    if isinstance(mesh, HypoidMesh) and sides[0] != "concave":
        problems.append(
            "pair.pinion_flank: the convex flank of a hypoid pinion is in contact; the formulas of ISO 10300-1 for its "
            "curvature were not found, so that a rating covers the drive side only"
        )
    if problems:
        raise InputError(problems)


def _milled(gear: FaceMilledGear, side: Side, spiral: float) -> BevelMember:
    blank = gear.blank
    return BevelMember(
        pitch_angle=blank.pitch_angle,
        spiral_angle=spiral,
        mean_cone_distance=blank.mean_cone_distance,
        addendum=blank.tip_height(blank.mean_cone_distance),
        dedendum=-blank.root_height(blank.mean_cone_distance),
        thickness=mean_thickness(gear),
        edge_radius=gear.cutter.blade(side).edge_radius,
        generated=gear.machine.rolls,
    )
