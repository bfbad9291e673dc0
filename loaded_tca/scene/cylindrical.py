"""Scenes of two cylindrical gears: their sections, and the gears and pairs that follow from them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import Any, ClassVar, Literal

from loaded_tca.arrays import GEARS
from loaded_tca.errors import GeometryError, InputError, require
from loaded_tca.gears import CylindricalGear, CylindricalMesh, RingGear
from loaded_tca.gears.cylindrical_mesh import ROUNDING, interferences
from loaded_tca.gears.involute import InvoluteMesh, profile_shift_sum
from loaded_tca.gears.undercut import undercut_sentences
from loaded_tca.pairs.cylindrical import LARGEST_ANGLE, Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.plain import plain
from loaded_tca.reference import iso6336_3
from loaded_tca.reference.iso1328 import flank_tolerances
from loaded_tca.scene.blank import BlankScene
from loaded_tca.scene.build import build_materials, build_modifications, in_base_units, named_by_keys
from loaded_tca.scene.equivalents import OF_HELICAL
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.model import Row
from loaded_tca.scene.parse import family
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.scene.section import Rule, Section, subsection
from loaded_tca.scene.sections import DRIVING, SENSE, AMOUNT_um, DIAMETER_mm, ERROR_deg, ERROR_mm, Pair, SLOPE_um, below
from loaded_tca.scene.standards import ContactStandard, contact_standard, slope_tolerances
from loaded_tca.scene.thickness import gear_of, odd_backlash, thickness_rows
from loaded_tca.scene.tools import (
    ADDENDUM,
    DEDENDUM,
    ROOT_RADIUS,
    SHORTENED_ONCE,
    TIP_SHORTENING,
    CutSection,
    chamfer_rows,
    cut_parameters,
    needs_protuberance,
    needs_stock,
    odd_teeth,
    rack_rows,
    shortening,
    tip_alteration,
)
from loaded_tca.scene.written import Equivalents


@dataclass(frozen=True, kw_only=True)
class Geometry(Pair):
    """[pair] of cylindrical gears."""

    type: Literal["cylindrical"] = key(Choice(("cylindrical",)), "kind of gear pair")
    normal_module_mm: float = key(above_zero(1000.0), "normal module m_n")
    pressure_angle_deg: float = key(Number(1.0, 44.0), "normal pressure angle alpha_n", 20.0)
    helix_angle_deg: float = key(
        Number(0.0, 59.0, advice="its sign is in pinion.hand"),
        "helix angle beta at the reference circle; its sign is in `pinion.hand`",
        0.0,
    )
    centre_distance_mm: float | None = key(
        DIAMETER_mm, "working centre distance a", None, "follows from the profile shifts, without backlash"
    )
    driving: Literal["pinion", "wheel"] = key(DRIVING, "the gear that drives", "pinion")
    sense: Literal["positive", "negative"] = key(
        SENSE, "sense of rotation; negative: the pinion turns the other way and pushes with its other flank", "positive"
    )
    addendum_coefficient: float = key(
        ADDENDUM, "addendum of the basic rack in modules, h_aP/m_n; each gear may have its own", 1.0
    )
    dedendum_coefficient: float = key(
        DEDENDUM, "dedendum of the basic rack (ISO 53 profile A) in modules, h_fP/m_n; each gear may have its own", 1.25
    )
    root_radius_coefficient: float | str = key(
        ROOT_RADIUS,
        'root radius of the basic rack in modules, rho_fP/m_n, or "full", the largest that fits; each gear may differ',
        0.38,
    )
    tip_shortening: str = key(
        TIP_SHORTENING,
        '"computed": both tips are altered by k m_n = a - a_d - m_n (x1 + x2) (ISO 21771) where that shortens them',
        "none",
    )

    equivalents: ClassVar[Equivalents] = OF_HELICAL


@dataclass(frozen=True, kw_only=True)
class GearSection(CutSection):
    """[pinion], [wheel] of cylindrical gears."""

    profile_shift: float | None = key(  # type: ignore[assignment]
        Number(-5.0, 5.0),
        "profile shift coefficient x; with a centre distance give it for one gear: the other follows, without backlash",
        None,
        "0, or by the centre distance, without backlash",
    )

    protuberance_um: float | None = key(
        AMOUNT_um,
        "protuberance pr of the tool before grinding, along the normal of its flank; needs a stock",
        None,
        "0",
    )
    grinding_stock_um: float | None = key(
        AMOUNT_um,
        "stock q that this tool leaves for grinding; above pr, a notch is left. Basic rack and thickness are those of "
        "the ground gear",
        None,
        "0",
    )
    protuberance_angle_deg: float | None = key(
        Number(0.5, 44.0), "angle alpha_pr of the flank of the protuberance", None, "half the pressure angle"
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *CutSection.rules,
        Rule(("protuberance_um", "grinding_stock_um"), needs_stock),
        Rule(("protuberance_angle_deg", "protuberance_um"), needs_protuberance),
        below("bore_diameter_mm", "tip_diameter_mm"),
        below("root_diameter_mm", "tip_diameter_mm"),
        below("modifications.tip_relief_start_mm", "tip_diameter_mm"),
        below("modifications.root_relief_start_mm", "tip_diameter_mm"),
    )


@dataclass(frozen=True, kw_only=True)
class MountingErrors(Section):
    """[mounting] of parallel axes: how the wheel is displaced from its nominal place."""

    in_plane_deg: float = key(ERROR_deg, "axis error in the plane of the axes; positive: the axes part at z > 0", 0.0)
    out_of_plane_deg: float = key(
        ERROR_deg,
        "axis error across that plane; positive: at z > 0 the wheel moves towards -y, against the driving flank of the "
        'sense "positive"',
        0.0,
    )
    misalignment_um: float = key(
        SLOPE_um,
        "misalignment f in the plane of action over the common face width b, which adds f/(b cos(alpha_wt)) to "
        "`out_of_plane_deg`",
        0.0,
    )
    centre_distance_error_mm: float = key(ERROR_mm, "centre distance error; positive: apart", 0.0)
    axial_offset_mm: float = key(ERROR_mm, "axial displacement of the wheel, positive towards +z", 0.0)


@family("cylindrical")
@dataclass(frozen=True, kw_only=True)
class CylindricalScene(BlankScene):
    """A scene of two spur or helical gears.

    Attributes
    ----------
    geometry : cylindrical.Geometry
        Section [pair]: what both gears have in common.
    pinion, wheel : cylindrical.GearSection
    mounting : cylindrical.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import ElasticMaterial, Load
    >>> scene = CylindricalScene(
    ...     geometry=Geometry(type="cylindrical", normal_module_mm=3.0),
    ...     pinion=GearSection(teeth=34, face_width_mm=25.0),
    ...     wheel=GearSection(teeth=57, face_width_mm=25.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=130.0),
    ... )
    >>> scene.pair()
    GearPair(34/57, module 3 mm, face 25 mm)
    >>> scene.with_changes({"pinion.teeth": 21}).pair()
    GearPair(21/57, module 3 mm, face 25 mm)
    """

    vh_keys: ClassVar[tuple[str, str]] = ("mounting.in_plane_deg", "mounting.out_of_plane_deg")
    rules: ClassVar[tuple[Rule, ...]] = (*BlankScene.rules, SHORTENED_ONCE)

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "the mating gear of the pinion")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    def mesh(self) -> CylindricalMesh:
        """Return the macro geometry: diameters, contact ratios, path of contact."""
        return self._mesh

    @cached_property
    @named_by_keys
    def _mesh(self) -> CylindricalMesh:
        """The macro geometry, which every number of the standards asks for again."""
        of_pinion, of_wheel = self._gear_values((CylindricalGear, CylindricalGear))
        with self._following_shift_named():
            pinion = gear_of(of_pinion, self.pinion)
            wheel = gear_of(of_wheel, self.wheel)
        return CylindricalMesh(pinion, wheel, self.geometry.centre_distance_mm, self.mounting.axial_offset_mm)

    @cached_property
    def profile_shifts(self) -> tuple[float, float]:
        """Coefficients of both gears, before any gear is made: thickness is measured on teeth with their shift."""
        geometry, shifts = self.geometry, [self.pinion.profile_shift, self.wheel.profile_shift]
        following = 0.0
        if geometry.centre_distance_mm is not None and shifts.count(None) == 1:
            following = profile_shift_sum(
                (self.pinion.teeth, self.wheel.teeth),
                geometry.normal_module_mm,
                pressure_angle=math.radians(geometry.pressure_angle_deg),
                helix_angle=math.radians(geometry.helix_angle_deg),
                centre_distance=geometry.centre_distance_mm,
            ) - sum(shift for shift in shifts if shift is not None)
        pinion, wheel = (following if shift is None else shift for shift in shifts)
        return pinion, wheel

    @property
    def computed_tip_alteration(self) -> float:
        """Coefficient k of both tips as ``pair.tip_shortening = "computed"`` has it."""
        return tip_alteration(self.geometry, (self.pinion.teeth, self.wheel.teeth), self.profile_shifts)

    def _gear_values(self, kinds: tuple[type, type]) -> Iterator[dict[str, Any]]:
        """Values of both gears: of their sections, and those that follow from the pair."""
        shifts, sections = self.profile_shifts, (self.pinion, self.wheel)
        tips = shortening(self.geometry, (self.pinion.teeth, self.wheel.teeth), shifts)
        for kind, own, sign, name, shift in zip(kinds, sections, self.hand_signs, GEARS, shifts, strict=True):
            values = cut_parameters(kind, self.geometry, own) | tips | {"name": name, "profile_shift": shift}
            values["helix_angle"] *= sign
            yield values

    @contextmanager
    def _following_shift_named(self) -> Iterator[None]:
        """Add to a refusal of gears which profile shift the centre distance asks for, where one follows from it."""
        try:
            yield
        except (InputError, GeometryError) as error:
            distance = self.geometry.centre_distance_mm
            shifts = zip((self.pinion, self.wheel), self.profile_shifts, strict=True)
            following = [shift for own, shift in shifts if own.profile_shift is None]
            if distance is not None and len(following) == 1:
                error.add_note(
                    f"pair.centre_distance_mm = {plain(distance, 6)} and the given profile_shift ask for "
                    f"{following[0]:.4f} on the other gear"
                )
            raise

    @property
    def sense(self) -> Sense:
        """Sense of rotation."""
        return self.geometry.sense

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two involute flanks in space."""
        mesh = self.mesh()
        return cylindrical_pair(
            mesh,
            modifications=build_modifications(self.pinion, self.wheel),
            mounting=self._mounting(mesh),
            materials=build_materials(self.materials),
            driving=self.geometry.driving,
            sense=sense,
        )

    def _mounting(self, mesh: InvoluteMesh) -> Mounting:
        """Mounting errors beside those in the mesh, the misalignment in the plane of action as its axis error."""
        errors = in_base_units(self.mounting)
        del errors["axial_offset"]
        errors["out_of_plane"] += errors.pop("misalignment") / (
            mesh.common_face_width * math.cos(mesh.working_pressure_angle)
        )
        require(
            (
                abs(errors["out_of_plane"]) < LARGEST_ANGLE,
                f"mounting.misalignment_um: found {plain(self.mounting.misalignment_um, 6)}; over the common face "
                f"width of {plain(mesh.common_face_width, 6)} mm it makes out_of_plane_deg "
                f"{plain(math.degrees(errors['out_of_plane']))}, allowed up to {plain(math.degrees(LARGEST_ANGLE), 6)}",
            )
        )
        return Mounting(**errors)

    def pitch_tolerances(self, gear: int, tolerance_class: int) -> tuple[float, float]:
        """Return f_pT and F_pT [um] times cos(alpha_t): from the reference circle to the line of action."""
        mesh = self.mesh()
        one = (mesh.pinion, mesh.wheel)[gear]
        values = abs(one.teeth), one.normal_module, one.face_width, tolerance_class, one.helix_angle
        tolerances, factor = flank_tolerances(*values), one.base_radius / one.reference_radius
        return factor * tolerances.single_pitch, factor * tolerances.cumulative_pitch

    def active_starts(self) -> tuple[float, float]:
        """Return the roll lengths at which the active profiles of pinion and wheel start [mm]."""
        mesh = self.mesh()
        return mesh.pinion_active_profile.start_roll_length, mesh.wheel_active_profile.start_roll_length

    def active_ends(self) -> tuple[float, float]:
        """Return the roll lengths at which the active profiles end [mm]: at the tip, or where an undercut ends them."""
        path = self.mesh().path_of_contact
        return path.E, path.T2 - path.A

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Clearances c of both roots and the mating gear's tip, the error of the centre distance included."""
        error = self.mounting.centre_distance_error_mm
        pinion, wheel = (clearance + error for clearance in self.mesh().tip_clearances)
        return pinion, wheel

    @property
    def grinding_notches(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Depths of the notches that grinding leaves at both roots, and the roundings of the tools [mm]."""
        pinion, wheel = (
            (max(0.0, -gear.residual_undercut), gear.rack_tip_radius)
            if isinstance(gear, CylindricalGear)
            else (0.0, 0.0)
            for gear in (self.mesh().pinion, self.mesh().wheel)
        )
        return pinion, wheel

    def missing_shifts(self) -> Sequence[str]:
        """Return sentences on teeth that look as if a profile shift of theirs were not given."""
        mesh, sections = self.mesh(), (self.pinion, self.wheel)
        absent = [own.profile_shift is None for own in sections]
        follows = self.geometry.centre_distance_mm is not None and sum(absent) == 1
        gears = zip((mesh.pinion, mesh.wheel), sections, strict=True)
        return [*chain.from_iterable(odd_teeth(*gear, follows=follows) for gear in gears), *odd_backlash(mesh)]

    @property
    def pairs_in_contact(self) -> float:
        """The total contact ratio."""
        return self.mesh().total_contact_ratio

    @property
    def path_points(self) -> Mapping[str, float]:
        """Points A to E of the path of contact after ISO 21771, as roll lengths of the pinion: from T1 on [mm].

        In the order of the path: with a contact ratio above 2 D comes before C and B behind it.
        """
        path = self.mesh().path_of_contact
        lengths = {letter: getattr(path, letter) for letter in "ABCDE"}
        return dict(sorted(lengths.items(), key=lambda point: point[1]))

    @property
    def mean_contact_length(self) -> float:
        """Mean length of all contact lines over a pitch, eps_alpha b/cos(beta_b) [mm]."""
        mesh = self.mesh()
        return mesh.transverse_contact_ratio * mesh.common_face_width / math.cos(mesh.pinion.base_helix_angle)

    @property
    def transverse_angles(self) -> tuple[float, float]:
        """alpha_wt and beta_b of the pinion [rad], positive for the right hand."""
        mesh = self.mesh()
        return mesh.working_pressure_angle, mesh.pinion.base_helix_angle

    @cached_property
    def contact_standard(self) -> ContactStandard:
        """Contact factors and stiffnesses of ISO 6336-1 and -2 over the common face."""
        return contact_standard(self.mesh(), build_materials(self.materials))

    def slope_tolerances(self, tolerance_class: int) -> Mapping[str, float]:
        """Return the tolerances of the helix and profile slopes of both gears after ISO 1328-1 [um]."""
        return slope_tolerances(self.mesh(), tolerance_class)

    @property
    def nominal_root_stress(self) -> tuple[float, float]:
        """Nominal root stress sigma_F0 after ISO 6336-3, method B, over the common face, per torque [MPa/(N mm)].

        NaN where the standard has no critical section of the tooth.
        """
        mesh = self.mesh()
        area = mesh.common_face_width * mesh.pinion.normal_module
        pinion, wheel = (math.prod(factors) / (area * mesh.pinion.reference_radius) for factors in self.root_factors)
        return pinion, wheel

    @cached_property
    def root_factors(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Form, stress correction and helix angle factor Y_F, Y_S, Y_beta of both gears; NaN as above."""
        mesh = self.mesh()
        helix, unknown = iso6336_3.helix_angle_factor(mesh.pinion.helix_angle, mesh.overlap_ratio), 3 * (math.nan,)
        pinion, wheel = (
            (section.form_factor, section.stress_correction_factor, helix) if section else unknown
            for section in self.root_sections
        )
        return pinion, wheel

    @cached_property
    def root_sections(self) -> tuple[iso6336_3.RootSection | None, iso6336_3.RootSection | None]:
        """Critical sections of the teeth of both gears after ISO 6336-3; None where it has none."""
        mesh = self.mesh()
        return _root_section(mesh, mesh.pinion), _root_section(mesh, mesh.wheel)

    @property
    def tooth_height_over_width(self) -> float:
        """Height of the higher teeth over the common face width, h/b of ISO 6336-1."""
        mesh = self.mesh()
        heights = (abs(gear.tip_radius - gear.root_radius) for gear in (mesh.pinion, mesh.wheel))
        return max(heights) / mesh.common_face_width

    def geometry_rows(self) -> Sequence[Row]:
        """Return centre distance, contact ratios and diameters."""
        mesh = self.mesh()
        path = mesh.path_of_contact
        return [
            ("working centre distance a_w [mm]", fixed(mesh.working_centre_distance, 4)),
            ("working pressure angle alpha_wt [deg]", fixed(math.degrees(mesh.working_pressure_angle), 4)),
            ("base helix angle beta_b [deg]", fixed(abs(math.degrees(mesh.pinion.base_helix_angle)), 4)),
            (
                Label("profile shift sum: given, without backlash", "profile_shift_sum", "given", "without_backlash"),
                *(fixed(value, 4) for value in _profile_shift_sums(mesh)),
            ),
            *backlash_rows(mesh),
            ("transverse contact ratio eps_alpha", fixed(mesh.transverse_contact_ratio, 4)),
            ("overlap ratio eps_beta", fixed(mesh.overlap_ratio, 4)),
            ("total contact ratio eps_gamma", fixed(mesh.total_contact_ratio, 4)),
            (
                Label("path of contact: length AE, approach AC [mm]", "path_of_contact_mm", "length_AE", "approach_AC"),
                fixed(path.AE, 4),
                fixed(path.AC, 4),
            ),
            ("common face width b [mm]", fixed(mesh.common_face_width, 4)),
            ("", "pinion", "wheel"),
            ("teeth z", f"{mesh.pinion.teeth}", f"{mesh.wheel.teeth}"),
            ("profile shift x", fixed(mesh.pinion.profile_shift, 4), fixed(mesh.wheel.profile_shift, 4)),
            ("hand of the helix", *(self.hands if mesh.pinion.helix_angle else ("none", "none"))),
            *rack_rows(mesh),
            *_diameter_rows(mesh),
            *chamfer_rows(mesh),
            *thickness_rows(mesh, (self.pinion, self.wheel)),
            ("tip clearance of the mating gear c [mm]", *(fixed(clearance, 4) for clearance in mesh.tip_clearances)),
        ]

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        mesh = self.mesh()
        return [
            ("base tangential force F_bt [N]", *(fixed(mesh.base_tangential_force(torque), 1) for torque in torques)),
            ("normal force F_bn [N]", *(fixed(mesh.normal_force(torque), 1) for torque in torques)),
        ]

    def interferences(self) -> Sequence[str]:
        """Return how the whole gears interfere at their centre distance, its error included, and what undercuts take.

        An error takes away backlash only where the centre distance and the profile shifts give some. Without, as by
        default, the teeth are nominal: the tolerances that thin them are not in the scene.
        """
        mesh, mounted = self.mesh(), self.mounted_mesh()
        module = mesh.pinion.normal_module
        nominal = abs(mesh.backlash) <= ROUNDING * module
        jams = interferences(mounted.room, module, self._mounted_place, nominal=nominal)
        return [*jams, *undercut_sentences(mounted, self._mounted_place)]

    def mounted_mesh(self) -> CylindricalMesh:
        """Return the macro geometry at the centre distance with its error.

        Raises
        ------
        GeometryError
            If the gears do not mesh there.
        """
        mesh = self.mesh()
        try:
            return replace(mesh, centre_distance=self._mounted_distance) if self._distance_error else mesh
        except GeometryError as problem:
            raise GeometryError(f"{self._mounted_place}: {problem}") from None

    @property
    def _distance_error(self) -> float:
        """What the error of the centre distance adds to it [mm]."""
        return self.mounting.centre_distance_error_mm

    @property
    def _mounted_distance(self) -> float:
        return self.mesh().working_centre_distance + self._distance_error

    @property
    def _mounted_place(self) -> str:
        """Where whole gears interfere, in words."""
        return f"at the {'mounted ' if self._distance_error else ''}centre distance of {self._mounted_distance:z.4f} mm"


def _root_section(mesh: InvoluteMesh, gear: CylindricalGear | RingGear) -> iso6336_3.RootSection | None:
    """Critical section of a gear after ISO 6336-3; None where the standard has none."""
    module, dedendum, shift = gear.normal_module, gear.dedendum_coefficient, gear.generating_profile_shift
    try:
        if isinstance(gear, RingGear):
            dedendum = (gear.root_radius - gear.reference_radius) / module + shift
            radius = gear.fillet_radius / module
            if gear.cutter is not None:
                radius = iso6336_3.cut_root_radius(radius, dedendum, gear.cutter.teeth, gear.cutter.profile_shift)
        else:
            radius = gear.rack_tip_radius / module
        return iso6336_3.root_section(
            gear.teeth,
            shift,
            2.0 * gear.tip_form_radius / module,
            mesh.transverse_contact_ratio,
            helix_angle=gear.helix_angle,
            pressure_angle=gear.pressure_angle,
            dedendum_coefficient=dedendum,
            root_radius_coefficient=radius,
            residual_undercut=0.0 if isinstance(gear, RingGear) else max(0.0, gear.residual_undercut) / module,
        )
    except (InputError, GeometryError):
        return None


def backlash_rows(mesh: InvoluteMesh) -> tuple[Row, Row]:
    """Backlash j_wt and j_bn [mm], zero where they are rounding."""
    rounding = abs(mesh.backlash) <= 1e-9 * mesh.pinion.normal_module
    along, normal = (0.0, 0.0) if rounding else (mesh.backlash, mesh.normal_backlash)
    return (
        ("backlash j_wt at the working circles [mm]", fixed(along, 4)),
        ("normal backlash j_bn [mm]", fixed(normal, 4)),
    )


def _profile_shift_sums(mesh: CylindricalMesh) -> tuple[float, float]:
    """x1 + x2 as given, and what the centre distance needs for no backlash."""
    given = mesh.pinion.profile_shift + mesh.wheel.profile_shift
    return given, mesh.profile_shift_sum_without_backlash


def _diameter_rows(mesh: CylindricalMesh) -> list[Row]:
    """Diameters of both gears from the reference circle to the root circle, and whether tips reach into fillets."""
    gears = mesh.pinion, mesh.wheel
    active = mesh.pinion_active_profile, mesh.wheel_active_profile
    radii = {
        "reference diameter d [mm]": [gear.reference_radius for gear in gears],
        "base diameter d_b [mm]": [gear.base_radius for gear in gears],
        "working diameter d_w [mm]": [mesh.pinion_working_radius, mesh.wheel_working_radius],
        "tip diameter d_a [mm]": [gear.tip_radius for gear in gears],
    }
    path = mesh.path_of_contact
    if 1.0 <= mesh.transverse_contact_ratio < 2.0:  # elsewhere always two tooth pairs touch, or none
        at_b, at_d = (
            [mesh.pinion.radius_at_roll_length(point), mesh.wheel.radius_at_roll_length(path.T2 - point)]
            for point in (path.B, path.D)
        )
        radii["highest single tooth contact (D | B) [mm]"] = [at_d[0], at_b[1]]
        radii["lowest single tooth contact (B | D) [mm]"] = [at_b[0], at_d[1]]
    ends = mesh.pinion.radius_at_roll_length(path.E), mesh.wheel.radius_at_roll_length(path.T2 - path.A)
    radii |= {
        "start of active profile d_Nf [mm]": [profile.start_radius for profile in active],
        "end of active profile d_Na [mm]": [*ends],
        "root form diameter d_Ff [mm]": [gear.form_radius for gear in gears],
        "root diameter d_f [mm]": [gear.root_radius for gear in gears],
    }
    interference = ("yes" if profile.fillet_interference else "no" for profile in active)
    rows = [(label, *(fixed(2.0 * radius, 4) for radius in both)) for label, both in radii.items()]
    return [*rows, ("mating tip reaches below d_Ff", *interference)]
