"""Scenes of straight and spiral bevel gears: their sections, and the gears and pairs that follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan, cos, degrees, radians, sin, tan
from typing import ClassVar, Literal

from loaded_tca.arrays import GEARS
from loaded_tca.errors import require
from loaded_tca.gears.bevel import BevelGear, pitch_angles
from loaded_tca.gears.bevel_blank import BevelBlank
from loaded_tca.gears.bevel_meshes import BevelMesh
from loaded_tca.gears.checks import LARGEST_PRESSURE_ANGLE
from loaded_tca.gears.cylindrical_mesh import AT_MID_FACE, interferences
from loaded_tca.pairs.bevel import BevelMounting, bevel_pair
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.plain import plain
from loaded_tca.scene import spiral
from loaded_tca.scene.bevel_blank import MEASURED, MEASURED_RULES, Blank, Measured, settings_table
from loaded_tca.scene.bevel_rows import blank_rows, common_blank_rows, cone_rows, depth_rows
from loaded_tca.scene.blank import BlankGearSection, BlankScene
from loaded_tca.scene.build import build_materials, build_modifications, in_base_units, named_by_keys, parameters_of
from loaded_tca.scene.equivalents import OF_BEVEL
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.machine_settings import METHODS, Method, Settings
from loaded_tca.scene.model import Row, Scene
from loaded_tca.scene.parse import family, scene_from_table
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.scene.section import Rule, as_table, rule, subsection
from loaded_tca.scene.sections import DRIVING, SENSE, ERROR_mm, Pair
from loaded_tca.scene.spiral import MountingErrors, SpiralScene
from loaded_tca.scene.written import Equivalents

SPIRAL_deg = Number(0.0, 59.0)
CONE_deg = above_zero(179.0)
DEPTH_mm = above_zero(1000.0)
PRESSURE_deg = Number(1.0, 44.0)
USUAL_PRESSURE_deg = 20.0
OF_BLANK = "face_angle", "root_angle", "face_apex", "root_apex", "mean_normal_thickness"
"""What a gear takes from its blank."""
OF_EQUATIONS = (
    "face_width_mm",
    "hand",
    "profile_shift",
    "face_angle_deg",
    "root_angle_deg",
    "face_apex_mm",
    "root_apex_mm",
    *MEASURED,
)
"""Keys of a gear that a face-milled one has in its blank, or not."""


def too_steep(normal: float | None, spiral: float | None) -> str | None:
    """What is wrong with a normal pressure angle [deg] whose transverse one is more than a gear may have."""
    spiral = spiral or 0.0
    largest = degrees(atan(tan(LARGEST_PRESSURE_ANGLE) * cos(radians(spiral))))
    if normal is None or normal <= largest:
        return None
    most = f"{plain(degrees(LARGEST_PRESSURE_ANGLE), 6)} deg of transverse pressure angle"
    return (
        f"found {plain(normal, 6)}; with spiral_angle_deg = {plain(spiral, 6)} allowed up to "
        f"{largest:z.4f}, which is {most}"
    )


SIZES = "outer_module_mm", "mean_normal_module_mm", "wheel_outer_diameter_mm"


def one_size(*values: float | None) -> str | None:
    """What is wrong with the sizes that are given."""
    given = [name for name, value in zip(SIZES, values, strict=True) if value is not None]
    if len(given) == 1:
        return None
    return f"{'missing' if not given else 'given are ' + ' and '.join(given)}; allowed one of {', '.join(SIZES)}"


@dataclass(frozen=True, kw_only=True)
class Geometry(Pair):
    """[pair] of straight and spiral bevel gears."""

    type: Literal["straight_bevel", "spiral_bevel"] = key(
        Choice(("straight_bevel", "spiral_bevel")), "kind of gear pair"
    )
    outer_module_mm: float | None = key(
        above_zero(1000.0), "outer transverse module m_et, at the heel", None, "by one of the next two"
    )
    mean_normal_module_mm: float | None = key(
        above_zero(1000.0), "mean normal module m_mn, instead of `outer_module_mm`", None, "follows"
    )
    wheel_outer_diameter_mm: float | None = key(
        above_zero(100000.0), "outer pitch diameter d_e2 of the wheel, instead of `outer_module_mm`", None, "follows"
    )
    shaft_angle_deg: float = key(spiral.SHAFT_ANGLE_deg, "shaft angle Sigma", 90.0)
    spiral_angle_deg: float | None = key(
        SPIRAL_deg,
        "mean spiral angle beta_m on the pitch cone; its sign is in `pinion.hand`",
        None,
        "0; required for `spiral_bevel`",
    )
    pressure_angle_deg: float | None = key(
        PRESSURE_deg,
        "transverse pressure angle alpha on the pitch cone",
        None,
        "20, unless `normal_pressure_angle_deg` is given",
    )
    normal_pressure_angle_deg: float | None = key(
        PRESSURE_deg,
        "mean normal pressure angle alpha_n on the pitch cone, instead of the transverse one: tan(alpha) = "
        "tan(alpha_n)/cos(beta_m)",
        None,
        "follows from `pressure_angle_deg`",
    )
    driving: Literal["pinion", "wheel"] = key(DRIVING, "the gear that drives", "pinion")
    sense: Sense | None = key(
        SENSE,
        "sense of rotation; negative: the pinion turns the other way and pushes with its other flank",
        None,
        '"positive", or what `pinion_flank` asks for',
    )
    pinion_flank: spiral.Side | None = key(
        spiral.SIDE, "flank of a spiral pinion that is in contact, instead of `sense`", None, "by `sense`"
    )
    blank: Blank | None = subsection(
        Blank, "depths and thicknesses after ISO 23509; without it: outer modules about one apex", optional=True
    )

    equivalents: ClassVar[Equivalents] = OF_BEVEL
    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(SIZES, one_size),
        rule(
            ("spiral_angle_deg", "type"),
            lambda spiral, kind: not spiral or kind == "spiral_bevel",
            'found {0:g}; allowed 0 for a "straight_bevel" pair; give type = "spiral_bevel" for other angles',
        ),
        rule(
            ("spiral_angle_deg", "type"),
            lambda spiral, kind: spiral is not None or kind == "straight_bevel",
            f'missing; a "spiral_bevel" pair needs it, {plain(SPIRAL_deg.low, 6)} to {plain(SPIRAL_deg.high, 6)}',
        ),
        rule(
            ("pinion_flank", "type"),
            lambda flank, kind: flank is None or kind == "spiral_bevel",
            'found "{0}", but straight teeth have no concave or convex flank; give sense instead',
        ),
        spiral.FLANK_OR_SENSE,
        spiral.ONE_PRESSURE_ANGLE,
        Rule(("normal_pressure_angle_deg", "spiral_angle_deg"), too_steep),
        rule(
            ("blank.lengthwise_curve", "spiral_angle_deg"),
            lambda curve, spiral: curve == "logarithmic" or bool(spiral),
            'found "{0}"; allowed with a spiral_angle_deg above 0 alone',
        ),
    )


@dataclass(frozen=True, kw_only=True)
class GearSection(BlankGearSection):
    """[pinion], [wheel] of bevel gears."""

    face_angle_deg: float | None = key(CONE_deg, "face angle delta_a", None, "pitch angle + atan((1 + x) m_et/R_e)")
    root_angle_deg: float | None = key(CONE_deg, "root angle delta_f", None, "pitch angle - atan((1.25 - x) m_et/R_e)")
    face_apex_mm: float | None = key(
        ERROR_mm, "apex t_zF of the face cone, beyond the crossing point of the axes, away from the teeth", None, "0"
    )
    root_apex_mm: float | None = key(ERROR_mm, "apex t_zR of the root cone, counted like `face_apex_mm`", None, "0")
    mean_addendum_mm: float | None = key(
        DEPTH_mm, "with [pair.blank]: measured mean addendum h_am, instead of data type I or II", None, "by the blank"
    )
    mean_dedendum_mm: float | None = key(
        DEPTH_mm, "with [pair.blank]: measured mean dedendum h_fm, instead of data type I or II", None, "by the blank"
    )
    mean_normal_thickness_mm: float | None = key(
        DEPTH_mm,
        "with [pair.blank]: measured mean normal thickness s_mn, circular, of both gears: backlash and thickness "
        "modification follow",
        None,
        "by the blank",
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankGearSection.rules,
        *(
            rule(
                (f"{cone}_apex_mm", f"{cone}_angle_deg"),
                lambda apex, angle: not apex or angle is not None,
                f"found {{0:g}}; allowed with {cone}_angle_deg, the angle of a drawing",
            )
            for cone in ("face", "root")
        ),
    )


@family("straight_bevel", "spiral_bevel")
@dataclass(frozen=True, kw_only=True)
class BevelScene(SpiralScene, BlankScene):
    """A scene of two straight or spiral bevel gears with spherical involute flanks.

    Attributes
    ----------
    geometry : bevel.Geometry
        Section [pair]: what both gears have in common.
    pinion, wheel : bevel.GearSection
    mounting : bevel.MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import ElasticMaterial, Load
    >>> scene = BevelScene(
    ...     geometry=Geometry(type="spiral_bevel", outer_module_mm=4.0, spiral_angle_deg=35.0),
    ...     pinion=GearSection(teeth=20, face_width_mm=20.0, hand="left"),
    ...     wheel=GearSection(teeth=40, face_width_mm=20.0),
    ...     material=ElasticMaterial(youngs_modulus_MPa=206000.0, poisson_ratio=0.3),
    ...     load=Load(pinion_torque_Nm=100.0),
    ... )
    >>> scene.pair()
    GearPair(20/40, module 2.91027 mm, face 20 mm)
    >>> scene.sense, scene.with_changes({"pair.pinion_flank": "concave"}).sense
    ('positive', 'negative')
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "the mating gear of the pinion")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *BlankScene.rules,
        rule(
            ("wheel.face_width_mm", "pinion.face_width_mm", "pair.blank"),
            lambda wheel, pinion, blank: blank is not None or wheel == pinion,
            "found {0:g}; allowed pinion.face_width_mm = {1:g}: both gears end on the same spheres",
        ),
        spiral.AXES_THAT_MEET,
        *MEASURED_RULES,
    )

    @property
    def contact_sides(self) -> tuple[str, str]:
        """Sides in contact of pinion and wheel: "concave" or "convex", "straight" without a spiral."""
        return self.sides(self.sense) if self.geometry.spiral_angle_deg else ("straight", "straight")

    @property
    def face_middles(self) -> tuple[float, float]:
        """Axial coordinates of the mean pitch circles of both gears, from their apexes [mm]."""
        mesh = self.mesh()
        first, second = (gear.mean_cone_distance * cos(gear.pitch_angle) for gear in (mesh.pinion, mesh.wheel))
        return first, second

    @property
    def pairs_in_contact(self) -> float:
        """The transverse contact ratio."""
        return self.mesh().transverse_contact_ratio

    @property
    def outer_module(self) -> float:
        """Outer transverse module m_et, as given or by m_mn or d_e2 [mm]."""
        wanted = self.geometry
        if wanted.outer_module_mm is not None:
            return wanted.outer_module_mm
        if wanted.wheel_outer_diameter_mm is not None:
            return wanted.wheel_outer_diameter_mm / self.wheel.teeth
        assert wanted.mean_normal_module_mm is not None  # by the rules of the section
        pitch, _ = pitch_angles((self.pinion.teeth, self.wheel.teeth), radians(wanted.shaft_angle_deg))
        mean = wanted.mean_normal_module_mm / cos(radians(wanted.spiral_angle_deg or 0.0))
        outside = 1.0 if wanted.blank is None else 2.0 * wanted.blank.outer_face_share
        return mean + outside * self.wheel.face_width_mm * sin(pitch) / self.pinion.teeth

    @property
    def normal_pressure_angle(self) -> float:
        """Mean normal pressure angle alpha_n on the pitch cone [rad]: 20 deg by default where a blank is given."""
        wanted, spiral_angle = self.geometry, radians(self.geometry.spiral_angle_deg or 0.0)
        if wanted.normal_pressure_angle_deg is not None:
            return radians(wanted.normal_pressure_angle_deg)
        if wanted.pressure_angle_deg is None and wanted.blank is not None:
            return radians(USUAL_PRESSURE_deg)
        transverse = USUAL_PRESSURE_deg if wanted.pressure_angle_deg is None else wanted.pressure_angle_deg
        return atan(tan(radians(transverse)) * cos(spiral_angle))

    def blanks(self) -> BevelBlank | None:
        """Return the blanks of [pair.blank]; None without that section."""
        if self.geometry.blank is None:
            return None
        return self.geometry.blank.build(
            (self.pinion.teeth, self.wheel.teeth),
            (self.pinion.face_width_mm, self.wheel.face_width_mm),
            shaft_angle=radians(self.geometry.shaft_angle_deg),
            spiral_angle=radians(self.geometry.spiral_angle_deg or 0.0),
            pressure_angle=self.normal_pressure_angle,
            outer_module=self.outer_module,
            measured=Measured.of(self.pinion, self.wheel),
        )

    def face_milled(self, method: Method | Settings = "duplex_spread_blade") -> Scene:
        """Return the face-milled scene of the blanks, with machine settings and cutters.

        Modifications, mounting errors, material, load and analysis are those of this scene.

        Parameters
        ----------
        method : {"duplex_spread_blade", "spread_blade", "local_synthesis"} or Settings
            See :mod:`loaded_tca.gears.basic_settings` and :mod:`loaded_tca.pairs.synthesis`; or the section
            [pair.settings], with what local synthesis is to reach.

        Raises
        ------
        InputError
            If the scene has no [pair.blank] with a cutter radius, or the method is none of the three.
        GeometryError
            If the gears cannot exist, or there are no such settings.

        Examples
        --------
        >>> from loaded_tca import read_scene
        >>> read_scene("examples/scenes/spiral_bevel_blank.toml").face_milled().pair()
        GearPair(14/39, module 3.20333 mm, face 25.4 mm)
        """
        blanks = self.blanks()
        known = isinstance(method, Settings) or method in METHODS
        require(
            (known, f"method: {method!r} is not one of {', '.join(METHODS)}"),
            (
                blanks is not None and blanks.cutter_radius is not None,
                "pair.blank.cutter_radius_mm: missing; machine settings follow from blanks and their cutter",
            ),
        )
        assert blanks is not None
        settings = method if isinstance(method, Settings) else Settings(method=method)
        flank = self.sides(self.sense)[0]
        gears = settings.gears(blanks, self.hands[0], flank)
        table = {name: value for name, value in as_table(self).items() if name not in ("pair", "pinion", "wheel")}
        table["pair"] = {
            "type": "face_milled",
            "shaft_angle_deg": self.geometry.shaft_angle_deg,
            "driving": self.geometry.driving,
            "sense": self.sense,
        }
        for name, own, gear in zip(GEARS, (self.pinion, self.wheel), gears, strict=True):
            kept = {key: value for key, value in as_table(own).items() if key not in OF_EQUATIONS}
            table[name] = kept | settings_table(gear)
        return scene_from_table(table)

    @named_by_keys
    def mesh(self) -> BevelMesh:
        """Return the macro geometry: cones, cone distances, contact ratios."""
        blanks = self.blanks()
        by_normal = blanks is not None or self.geometry.normal_pressure_angle_deg is not None

        def gear(own: GearSection, pitch_angle: float, sign: int, name: str) -> BevelGear:
            values = parameters_of(BevelGear, self.geometry, own) | {"outer_module": self.outer_module}
            values["spiral_angle"] = sign * values.get("spiral_angle", 0.0)
            if by_normal:
                values["pressure_angle"] = atan(tan(self.normal_pressure_angle) / cos(values["spiral_angle"]))
            if blanks is not None:
                blank = blanks.pinion if name == "pinion" else blanks.wheel
                values |= {each: getattr(blank, each) for each in OF_BLANK}
                if self.geometry.blank is not None and self.geometry.blank.lengthwise_curve == "cutter_circle":
                    values["cutter_radius"] = blanks.cutter_radius
                if blanks.has_own_faces:
                    _, mean, outer = blank.cone_distances
                    values["outer_module"] = 2.0 * outer * sin(pitch_angle) / own.teeth
                    values["calculation_distance"] = mean
            return BevelGear(**values, pitch_angle=pitch_angle, name=name)

        pitches = pitch_angles((self.pinion.teeth, self.wheel.teeth), radians(self.geometry.shaft_angle_deg))
        return BevelMesh(*map(gear, (self.pinion, self.wheel), pitches, self.hand_signs, GEARS))

    @property
    def tip_clearances(self) -> tuple[float, ...]:
        """Clearances of both roots and the mating gear's tip at the toe, where those about one apex are least [mm]."""
        return self.mesh().tip_clearances

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two spherical involute flanks in space."""
        return bevel_pair(
            self.mesh(),
            modifications=build_modifications(self.pinion, self.wheel),
            mounting=BevelMounting(**in_base_units(self.mounting)),
            materials=build_materials(self.materials),
            driving=self.geometry.driving,
            sense=sense,
        )

    def active_starts(self) -> tuple[float, float]:
        """Return the unwound arcs at which the active profiles of pinion and wheel start [rad]."""
        mesh = self.mesh()
        (pinion, _), (wheel, _) = mesh.active_cones
        return mesh.pinion.unwound_arc(pinion), mesh.wheel.unwound_arc(wheel)

    def geometry_rows(self) -> Sequence[Row]:
        """Return cones, cone distances, modules and contact ratios, and of blanks the dimension sheet."""
        mesh, blanks = self.mesh(), self.blanks()
        gear = mesh.wheel if blanks is not None and blanks.has_own_faces else mesh.pinion
        distances = (gear.outer_cone_distance, gear.mean_cone_distance, gear.inner_cone_distance)
        modules = (gear.outer_module, gear.mean_normal_module / cos(gear.spiral_angle))
        stated = self.geometry.normal_pressure_angle_deg
        if stated is None and self.geometry.blank is not None and self.geometry.pressure_angle_deg is None:
            stated = USUAL_PRESSURE_deg
        pressures = (gear.pressure_angle, atan(tan(gear.pressure_angle) * cos(gear.spiral_angle)))
        widths = (gear.face_width,) if blanks is None or not blanks.has_own_faces else blanks.face_widths
        return [
            ("shaft angle Sigma [deg]", fixed(degrees(mesh.shaft_angle), 4)),
            (
                Label("cone distances R_e, R_m, R_i [mm]", "cone_distance_mm", "R_e", "R_m", "R_i"),
                *(fixed(distance, 4) for distance in distances),
            ),
            (
                Label("transverse modules m_et, m_mt [mm]", "transverse_module_mm", "m_et", "m_mt"),
                *(fixed(module, 4) for module in modules),
            ),
            ("mean normal module m_mn [mm]", fixed(gear.mean_normal_module, 4)),
            ("mean spiral angle beta_m [deg]", fixed(degrees(abs(gear.spiral_angle)), 4)),
            (
                Label("pressure angles alpha_t, alpha_n [deg]", "pressure_angle_deg", "alpha_t", "alpha_n"),
                *(fixed(degrees(angle), 4) for angle in pressures),
            ),
            ("pressure angle that the scene states", "transverse" if stated is None else "normal"),
            ("backlash j_mt at the mean pitch circles [mm]", fixed(round(mesh.backlash, 4), 4)),
            ("transverse contact ratio eps_alpha", fixed(mesh.transverse_contact_ratio, 4)),
            ("overlap ratio eps_beta", fixed(mesh.overlap_ratio, 4)),
            ("total contact ratio eps_gamma", fixed(mesh.transverse_contact_ratio + mesh.overlap_ratio, 4)),
            ("face width b [mm]", *(fixed(width, 4) for width in widths)),
            *(() if blanks is None else common_blank_rows(blanks, self.geometry.blank, self.data_type)),
            ("", "pinion", "wheel"),
            ("teeth z", str(mesh.pinion.teeth), str(mesh.wheel.teeth)),
            ("hand of the spiral", *(self.hands if gear.spiral_angle else ("none", "none"))),
            ("flank in contact", *self.contact_sides),
            *cone_rows(mesh, seen=blanks is not None),
            *(depth_rows(mesh) if blanks is None else blank_rows(blanks)),
        ]

    @property
    def geometry_standard(self) -> str:
        """ISO 23509 where the blanks are the standard's."""
        return "depths by outer modules, about one apex" if self.geometry.blank is None else "ISO 23509"

    @property
    def data_type(self) -> str:
        """Type of the data of the blanks: I, II or measured."""
        blank = self.geometry.blank
        assert blank is not None
        return blank.data_type if Measured.of(self.pinion, self.wheel).addenda is None else "measured"

    def interferences(self) -> Sequence[str]:
        """Return how the whole gears interfere without mounting errors."""
        mesh = self.mesh()
        return interferences(mesh.room, mesh.pinion.mean_normal_module, AT_MID_FACE)

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        mesh = self.mesh()
        pair = self.analytic_pair(self.sense)
        first, second = (
            spiral.pitch_point(gear.mean_cone_distance, gear.pitch_angle) for gear in (mesh.pinion, mesh.wheel)
        )
        return spiral.force_rows((pair.pinion.nominal_flank, pair.wheel.nominal_flank), (first, second), torques)
