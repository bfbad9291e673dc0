"""Scenes of a pinion and a ring gear: type "cylindrical" with a negative number of teeth of the wheel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from loaded_tca.errors import require
from loaded_tca.gears import CylindricalGear, InternalMesh, PinionCutter, RingGear
from loaded_tca.gears.cylindrical_mesh import ROUNDING
from loaded_tca.gears.internal_mesh import internal_interferences
from loaded_tca.gears.undercut import undercut_sentences
from loaded_tca.pairs.cylindrical import internal_pair
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.plain import plain
from loaded_tca.scene.build import build_materials, build_modifications, named_by_keys, parameters_of
from loaded_tca.scene.cylindrical import CylindricalScene, GearSection, Geometry, MountingErrors, backlash_rows
from loaded_tca.scene.keys import Choice, Number, Whole, key
from loaded_tca.scene.model import Hand, Row, Scene
from loaded_tca.scene.parse import variant
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.scene.section import Rule, Section, rule, subsection
from loaded_tca.scene.sections import DIAMETER_mm, below
from loaded_tca.scene.thickness import as_measured, gear_of, thickness_rows
from loaded_tca.scene.tools import SHORTENED_ONCE, CutSection, chamfer_rows, rack_rows


@dataclass(frozen=True, kw_only=True)
class CutterSection(Section):
    """[wheel.cutter] of a ring gear."""

    teeth: int = key(Whole(3, 10000), "number of teeth z_0 of the cutter, below that of the ring")
    profile_shift: float = key(Number(-5.0, 5.0), "profile shift coefficient x_0", 0.0)
    tip_radius_coefficient: float = key(
        Number(0.0, 1.0), "rounding of the tip in normal modules, rho_a0/m_n, at most what fits", 0.3
    )


def _above(larger_key: str, smaller_key: str) -> Rule:
    """Rule: a diameter, where it is given, lies above another one."""

    def complain(larger: float | None, smaller: float | None) -> str | None:
        if larger and smaller is not None and larger < smaller:
            return (
                f"found {plain(larger, 6)}; allowed from {smaller_key} = {plain(smaller, 6)} on: a ring's "
                "tip lies inside"
            )
        return None

    return Rule((larger_key, smaller_key), complain)


def _one_fillet(radius: float | str | None, cutter: CutterSection | None) -> str | None:
    if radius is None or cutter is None:
        return None
    return f"found {radius} beside [wheel.cutter], whose tip_radius_coefficient shapes the fillets; give one of them"


@dataclass(frozen=True, kw_only=True)
class RingSection(CutSection):
    """[wheel] of an internal pair: a ring gear."""

    teeth: int = key(Whole(-10000, -3), "number of teeth z2 of the ring, negative as in ISO 21771")
    hand: Hand | None = key(
        Choice(("right", "left")), "hand of the helix (without meaning for straight teeth)", None, "that of the pinion"
    )
    profile_shift: float | None = key(  # type: ignore[assignment]
        Number(-5.0, 5.0),
        "profile shift coefficient x with the sign of ISO 21771: positive ones thicken the teeth of the ring and move "
        "them towards the axis; with a centre distance give it for one gear: the other follows, without backlash",
        None,
        "0, or by the centre distance, without backlash",
    )
    tip_diameter_mm: float | None = key(DIAMETER_mm, "tip diameter d_a, positive", None, "d - 2 m_n (h_aP + x + k)")
    root_diameter_mm: float | None = key(DIAMETER_mm, "root diameter d_f, positive", None, "d + 2 m_n (h_fP - x_E)")
    outer_diameter_mm: float | None = key(
        DIAMETER_mm, "outer diameter, held rigid where teeth bend", None, "root diameter + 14 m_n"
    )
    cutter: CutterSection | None = subsection(
        CutterSection, "pinion-type cutter of the ring; without a cutter the fillets are arcs", optional=True
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *CutSection.rules,
        Rule(("root_radius_coefficient", "cutter"), _one_fillet),
        rule(
            ("bore_diameter_mm",),
            lambda bore: bore is None,
            "found {0:g}; a ring gear has no bore, its outside is held: give outer_diameter_mm",
        ),
        below("tip_diameter_mm", "root_diameter_mm"),
        below("tip_diameter_mm", "outer_diameter_mm"),
        below("root_diameter_mm", "outer_diameter_mm"),
        _above("modifications.tip_relief_start_mm", "tip_diameter_mm"),
        _above("modifications.root_relief_start_mm", "tip_diameter_mm"),
    )


def _same_hands(wheel: Hand | None, pinion: Hand | None) -> str | None:
    if wheel is None or pinion is None or wheel == pinion:
        return None
    return f'found "{wheel}" and "{pinion}" of the pinion; allowed "{pinion}": gears of an internal pair have one hand'


@variant("an internal pair: `wheel.teeth` is negative")
@dataclass(frozen=True, kw_only=True)
class InternalScene(CylindricalScene):
    """A scene of a pinion and a ring gear.

    Attributes
    ----------
    geometry : cylindrical.Geometry
    pinion : cylindrical.GearSection
    wheel : internal.RingSection
    mounting : cylindrical.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import ElasticMaterial, Load
    >>> scene = InternalScene(
    ...     geometry=Geometry(type="cylindrical", normal_module_mm=3.0),
    ...     pinion=GearSection(teeth=25, face_width_mm=25.0),
    ...     wheel=RingSection(teeth=-60, face_width_mm=25.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=130.0),
    ... )
    >>> scene.pair()
    GearPair(25/60, module 3 mm, face 25 mm)
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: RingSection = subsection(RingSection, "the ring gear")  # type: ignore[assignment]
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *Scene.rules,
        SHORTENED_ONCE,
        Rule(("wheel.hand", "pinion.hand"), _same_hands),
        Rule(
            ("wheel.teeth", "pinion.teeth"),
            lambda ring, pinion: (
                f"found {ring}; allowed below {-pinion}: a ring has more teeth than its pinion"
                if -ring <= pinion
                else None
            ),
        ),
    )

    @property
    def hands(self) -> tuple[Hand, Hand]:
        """Hands of pinion and ring, which are equal: as one of them is given, else right."""
        hand: Hand = self.pinion.hand or self.wheel.hand or "right"
        return hand, hand

    @property
    def hand_signs(self) -> tuple[int, int]:
        """+1 for the right hand, -1 for the left one, of pinion and ring."""
        sign = 1 if self.hands[0] == "right" else -1
        return sign, sign

    def mesh(self) -> InternalMesh:  # type: ignore[override]
        """Return the macro geometry: diameters, contact ratios, path of contact."""
        return self._mesh

    @cached_property
    @named_by_keys
    def _mesh(self) -> InternalMesh:  # type: ignore[override]
        """The macro geometry, kept as that of external pairs is."""
        of_pinion, of_ring = self._gear_values((CylindricalGear, RingGear))
        cutter = self.wheel.cutter
        of_ring["cutter"] = None if cutter is None else PinionCutter(**parameters_of(PinionCutter, cutter))
        with self._following_shift_named():
            pinion = gear_of(of_pinion, self.pinion)
            ring = as_measured(RingGear(**of_ring), self.wheel)
        return InternalMesh(pinion, ring, self.geometry.centre_distance_mm, self.mounting.axial_offset_mm)

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two involute flanks in space."""
        mesh = self.mesh()
        return internal_pair(
            mesh,
            modifications=build_modifications(self.pinion, self.wheel),
            mounting=self._mounting(mesh),
            materials=build_materials(self.materials),
            driving=self.geometry.driving,
            sense=sense,
        )

    def held_row(self, pair: GearPair) -> Row:
        """Return what is held rigid where teeth bend."""
        return "bore and outside of the ring held rigid [mm]", *(fixed(bore, 4) for bore in pair.rigid_bores)

    def active_starts(self) -> tuple[float, float]:
        """Return where the active profiles start [mm]: roll lengths, that of the ring with a minus."""
        mesh = self.mesh()
        return mesh.pinion_active_profile.start_roll_length, -mesh.wheel_active_profile.start_roll_length

    def active_ends(self) -> tuple[float, float]:
        """Return where the active profiles end [mm], as ``active_starts``: at the tip, or where an undercut ends it."""
        path = self.mesh().path_of_contact
        return path.E, path.T2 - path.A

    def geometry_rows(self) -> Sequence[Row]:
        """Return centre distance, contact ratios, diameters, and the three interferences with their room."""
        mesh = self.mesh()
        pinion, ring, path = mesh.pinion, mesh.ring, mesh.path_of_contact
        ring_tip = ring.roll_length(ring.tip_form_radius) - (path.T1 - path.T2)
        shifts = pinion.profile_shift + ring.profile_shift, mesh.profile_shift_sum_without_backlash
        return [
            ("working centre distance |a_w| [mm]", fixed(mesh.working_centre_distance, 4)),
            ("working pressure angle alpha_wt [deg]", fixed(math.degrees(mesh.working_pressure_angle), 4)),
            ("base helix angle beta_b [deg]", fixed(abs(math.degrees(pinion.base_helix_angle)), 4)),
            (
                Label("profile shift sum: given, without backlash", "profile_shift_sum", "given", "without_backlash"),
                *(fixed(value, 4) for value in shifts),
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
            ("involute interference: ring's tip to T1 [mm]", f"{ring_tip:z.4f} free"),
            ("overlap interference at the tips [mm]", _room_cell(mesh.overlap_clearance)),
            ("radial assembly [mm]", _assembly_cell(mesh)),
            ("", "pinion", "wheel (ring)"),
            ("teeth z", f"{pinion.teeth}", f"{ring.teeth}"),
            ("profile shift x", fixed(pinion.profile_shift, 4), fixed(ring.profile_shift, 4)),
            ("hand of the helix", *(self.hands if pinion.helix_angle else ("none", "none"))),
            *rack_rows(mesh),
            *_diameter_rows(mesh),
            *chamfer_rows(mesh),
            *thickness_rows(mesh, (self.pinion, self.wheel)),
            ("tip clearance of the mating gear c [mm]", *(fixed(clearance, 4) for clearance in mesh.tip_clearances)),
        ]

    def interferences(self) -> Sequence[str]:
        """Return how the whole gears interfere at their centre distance, its error included.

        A positive error makes the centre distance of an internal pair smaller.
        """
        mesh, mounted = self.mesh(), self.mounted_mesh()
        nominal = abs(mesh.backlash) <= ROUNDING * mesh.pinion.normal_module
        jams = internal_interferences(mounted, self._mounted_place, nominal=nominal)
        return [*jams, *undercut_sentences(mounted, self._mounted_place)]

    def mounted_mesh(self) -> InternalMesh:  # type: ignore[override]
        """Return the macro geometry at the centre distance with its error; errors as of external pairs."""
        error, distance = self.mounting.centre_distance_error_mm, self._mounted_distance
        require(
            (
                distance > 0.0,
                f"mounting.centre_distance_error_mm: found {plain(error, 6)}; it leaves no centre distance",
            )
        )
        return super().mounted_mesh()  # type: ignore[return-value]

    @property
    def _distance_error(self) -> float:
        return -self.mounting.centre_distance_error_mm


def _room_cell(clearance: float) -> str:
    """A clearance in words."""
    return "free" if math.isinf(clearance) else f"{clearance:z.4f} free"


def _assembly_cell(mesh: InternalMesh) -> str:
    """Clearance of a pinion that is pushed radially into its place, and where it has to stand for that, in words."""
    clearance, (tooth, space, worst) = mesh.radial_assembly_clearance, mesh.radial_assembly_clearances
    if clearance < 0.0:
        return f"{-clearance:z.4f} overlap: along the axis only"
    text = "0.0000 free: teeth touch in mesh alone" if clearance == 0.0 else _room_cell(clearance)
    if worst >= 0.0:
        return text
    free = " or ".join(name for name, room in (("a tooth", tooth), ("a space", space)) if room >= 0.0)
    return f"{text}, with {free} of the pinion towards the ring; turned, up to {-worst:z.4f} overlap"


def _diameter_rows(mesh: InternalMesh) -> list[Row]:
    """Diameters of both gears from the reference circle to the outside, and whether tips reach into fillets."""
    pinion, ring, path = mesh.pinion, mesh.ring, mesh.path_of_contact
    active = mesh.pinion_active_profile, mesh.wheel_active_profile
    radii: dict[str, tuple[float, float]] = {
        "reference diameter d [mm]": (pinion.reference_radius, ring.reference_radius),
        "base diameter d_b [mm]": (pinion.base_radius, ring.base_radius),
        "working diameter d_w [mm]": (mesh.pinion_working_radius, mesh.wheel_working_radius),
        "tip diameter d_a [mm]": (pinion.tip_radius, ring.tip_radius),
    }
    if 1.0 <= mesh.transverse_contact_ratio < 2.0:  # elsewhere always two tooth pairs touch, or none
        first, second = (
            (pinion.radius_at_roll_length(point), ring.radius_at_roll_length(point - path.T2))
            for point in (path.B, path.D)
        )
        radii["highest single tooth contact (D | B) [mm]"] = second[0], first[1]
        radii["lowest single tooth contact (B | D) [mm]"] = first[0], second[1]
    radii |= {
        "start of active profile d_Nf [mm]": (active[0].start_radius, active[1].start_radius),
        "end of active profile d_Na [mm]": (
            pinion.radius_at_roll_length(path.E),
            ring.radius_at_roll_length(path.A - path.T2),
        ),
        "root form diameter d_Ff [mm]": (pinion.form_radius, ring.form_radius),
        "root diameter d_f [mm]": (pinion.root_radius, ring.root_radius),
    }
    interference = ("yes" if profile.fillet_interference else "no" for profile in active)
    rows = [(label, *(fixed(2.0 * radius, 4) for radius in both)) for label, both in radii.items()]
    return [
        *rows,
        ("outer diameter of the ring [mm]", "", fixed(2.0 * ring.outer_radius, 4)),
        ("mating tip reaches beyond d_Ff", *interference),
    ]
