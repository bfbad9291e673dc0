"""Stage files: a sun, equal planets and a ring, with what holds them, as sections that check every key."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Literal

from loaded_tca.arrays import GEARS
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.gears import CylindricalMesh, InternalMesh
from loaded_tca.gears.involute import profile_shift_sum
from loaded_tca.notebooks import InNotebooks
from loaded_tca.pairs.gear_pair import Driving
from loaded_tca.plain import plain
from loaded_tca.scene import cylindrical
from loaded_tca.scene.blank import OTHER
from loaded_tca.scene.build import arguments_by_keys
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.equivalents import OF_HELICAL
from loaded_tca.scene.internal import InternalScene, RingSection
from loaded_tca.scene.keys import Choice, Either, Key, Line, List, Number, Whole, above_zero, key
from loaded_tca.scene.load import (
    MOST_BINS,
    AnyLoad,
    Bin,
    Load,
    TORQUE_Nm,
    alternatives_of,
    hours_of_bin,
    life_is_given,
    load_rules,
    reversed_of_bin,
    share_of_bin,
    speed_of_bin,
    torque_of_bin,
    within_solved,
)
from loaded_tca.scene.parse import toml_lines
from loaded_tca.scene.rating import ANALYSIS, LOAD_FACTOR, RatingSection
from loaded_tca.scene.section import (
    Rule,
    Section,
    Tables,
    as_table,
    check,
    contents,
    in_keys,
    key_at,
    made,
    place_at,
    replaced_by,
    subsection,
    told_as_written,
)
from loaded_tca.scene.sections import FACTOR, Analysis, DIAMETER_mm, ElasticMaterial, LubricantSection
from loaded_tca.scene.tools import ADDENDUM, DEDENDUM, ROOT_RADIUS, TIP_SHORTENING, CutSection
from loaded_tca.scene.written import Equivalents
from loaded_tca.stages.kinematics import spacing_problems

# ruff: noqa: N815  -- names are the keys of the file, units included; the calls make dataclass fields


SUN_MESH = {"pinion": "sun", "wheel": "planet"}
RING_MESH = {"pinion": "planet", "wheel": "ring"}
"""Words for the gears of both meshes: in their scenes, in the stage."""
MEMBERS = "sun", "planet", "ring"
OF_ONE_PITCH = {
    "pitch": "teeth of a stage are alike",
    "tooth": "teeth of a stage are alike",
    "shaft": "gears of a stage stand on rigid axes; for the sun give stage.sun_support_stiffness_N_per_um",
    "support": "gears of a stage stand on rigid axes; for the sun give stage.sun_support_stiffness_N_per_um",
}
"""Sections of a gear that a stage does not have, and why."""
NOT_OF_STAGES = "found a section; not allowed: {}"
MOST_PLANETS = 12
LARGEST_SHIFT = 5.0
"""Of profile shift coefficients, as of those that are given."""
SAME_DISTANCE = 1e-3
"""Difference of the centre distances of both meshes, in modules, that counts as none."""
WRITTEN_deg = 1e-3
"""Of angles that are written with four digits."""
PLACE = re.compile(r"stage\.(pin_tangential_um|pin_radial_um|planet_angles_deg)\.\d{1,3}", re.ASCII)
"""Paths to the value of one planet."""
PIN_um = List(Number(-10000.0, 10000.0), 1, MOST_PLANETS)


@dataclass(frozen=True, kw_only=True)
class PlanetaryStage(Section):
    """[stage]: planets, what drives, how the sun is held, where the pins stand."""

    type: Literal["planetary"] = key(Choice(("planetary",)), "kind of stage: the ring stands still", "planetary")
    planets: int | None = key(Whole(1, MOST_PLANETS), "number of planets, evenly spaced", None, "`planet_angles_deg`")
    planet_angles_deg: tuple[float, ...] | None = key(
        List(Number(-360.0, 360.0), 1, MOST_PLANETS), "or the angles of the planets on the carrier", None, "even ones"
    )
    driving: Literal["sun", "carrier"] = key(Choice(("sun", "carrier")), "the member that drives", "sun")
    floating_sun: bool = key(Choice((False, True)), "whether the sun is held by its planets alone", False)
    sun_support_stiffness_N_per_um: float | None = key(
        Number(0.0, 1e9), "or the radial stiffness of the sun's support; 0: it floats", None, "rigid"
    )
    pin_tangential_um: tuple[float, ...] | None = key(
        PIN_um, "displacement of each pin in the sense of rotation of the sun", None, "0 of all"
    )
    pin_radial_um: tuple[float, ...] | None = key(PIN_um, "displacement of each pin outwards", None, "0 of all")

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(
            ("planets", "planet_angles_deg"),
            lambda count, angles: (
                None
                if (count is None) != (angles is None)
                else "missing; give it or planet_angles_deg"
                if count is None
                else f"found {count} beside planet_angles_deg; give one of them"
            ),
        ),
        Rule(
            ("sun_support_stiffness_N_per_um", "floating_sun"),
            lambda stiffness, floating: (
                f"found {plain(stiffness, 6)} beside floating_sun = true; give one of them"
                if floating and stiffness is not None
                else None
            ),
        ),
        *(
            Rule(
                (name, "planets", "planet_angles_deg"),
                lambda values, count, angles: (
                    f"found {len(values)} values; allowed {count or len(angles)}, one for each planet"
                    if values is not None and (count or angles) and len(values) != (count or len(angles))
                    else None
                ),
            )
            for name in ("pin_tangential_um", "pin_radial_um")
        ),
        Rule(
            ("floating_sun", "sun_support_stiffness_N_per_um", "planets", "planet_angles_deg"),
            lambda floating, stiffness, count, angles: (
                "found a floating sun with one planet; allowed from two planets on, which hold the sun"
                if (floating or stiffness == 0.0) and (count or len(angles or ())) == 1
                else None
            ),
        ),
        Rule(
            ("planet_angles_deg", "floating_sun", "sun_support_stiffness_N_per_um"),
            lambda angles, floating, stiffness: (
                f"found planets on one side of a floating sun, with {plain(gap)} deg between two of them; allowed "
                "up to 180 deg: beyond it the planets push the sun away"
                if (floating or stiffness == 0.0)
                and len(angles or ()) > 1
                and (gap := _largest_gap(angles)) > 180.0 + WRITTEN_deg
                else None
            ),
        ),
    )

    @property
    def angles(self) -> tuple[float, ...]:
        """Angles of the planets on the carrier [rad]."""
        if self.planet_angles_deg is not None:
            return tuple(math.radians(angle) for angle in self.planet_angles_deg)
        assert self.planets is not None
        return tuple(2.0 * math.pi * number / self.planets for number in range(self.planets))

    @property
    def support_stiffness(self) -> float:
        """Radial stiffness of the sun's support [N/mm]; inf: rigid, 0: it floats."""
        if self.floating_sun:
            return 0.0
        stiffness = self.sun_support_stiffness_N_per_um
        return math.inf if stiffness is None else 1e3 * stiffness


def _planet_between(planet: float | None, sun: float | None, ring: float | None, distance: float | None) -> str | None:
    """What is wrong with a planet whose profile shift both of its mates ask for."""
    if planet is not None or sun is None or ring is None or distance is None:
        return None
    return (
        "missing; pair.centre_distance_mm asks for one value with sun.profile_shift, another with ring.profile_shift: "
        "give planet.profile_shift, or leave out one of the other two, which then follows without backlash"
    )


def _shortens_a_tip(shortening: str, *gears: CutSection) -> str | None:
    """What is wrong with a computed tip shortening that is none of any gear."""
    if shortening == "computed" and all(gear.has_own_tip for gear in gears):
        return 'found "computed" beside a tip of every gear; leave one of them to be computed, or give "none"'
    return None


def _largest_gap(angles: tuple[float, ...]) -> float:
    """Largest angle between neighbouring planets [deg]."""
    turns = sorted(angle % 360.0 for angle in angles)
    return max(after - before for before, after in zip(turns, [*turns[1:], turns[0] + 360.0], strict=True))


@dataclass(frozen=True, kw_only=True)
class StageGeometry(Section):
    """[pair]: what all gears of a stage have in common."""

    normal_module_mm: float = key(above_zero(1000.0), "normal module m_n")
    pressure_angle_deg: float = key(Number(1.0, 44.0), "normal pressure angle alpha_n", 20.0)
    helix_angle_deg: float = key(
        Number(0.0, 59.0), "helix angle beta at the reference circle; its sign is in `sun.hand`", 0.0
    )
    centre_distance_mm: float | None = key(
        DIAMETER_mm,
        "centre distance of both meshes; profile shifts that are left out then follow, without backlash, from those "
        "that are given; where none is given, all are 0 and the backlash is what the centre distance leaves",
        None,
        "follows from the profile shifts, without backlash",
    )
    addendum_coefficient: float = key(
        ADDENDUM, "addendum of the basic rack in modules, h_aP/m_n; each gear may have its own", 1.0
    )
    dedendum_coefficient: float = key(DEDENDUM, "dedendum of the basic rack in modules, h_fP/m_n", 1.25)
    root_radius_coefficient: float | str = key(
        ROOT_RADIUS,
        'root radius of the basic rack in modules, rho_fP/m_n, or "full", the largest that fits',
        0.38,
    )
    tip_shortening: str = key(
        TIP_SHORTENING,
        '"computed": tips of sun and ring are altered by k of their mesh with the planets (ISO 21771) where that '
        "shortens them, those of planets by the one that shortens more; a gear whose section says where its tip is "
        "keeps that tip",
        "none",
    )

    equivalents: ClassVar[Equivalents] = OF_HELICAL


@dataclass(frozen=True, kw_only=True)
class StageLoadCase(Bin):
    """[[load.case]] of a stage: a bin of its load spectrum."""

    MEMBER: ClassVar[str] = "sun"
    OTHER_WAY: ClassVar[str] = "stage.driving"
    sun_torque_Nm: float = torque_of_bin("magnitude of the torque on the sun")
    sun_speed_rpm: float | None = speed_of_bin(
        "speed of the sun; the ring stands still", None, "`operation.sun_speed_rpm`"
    )
    hours: float | None = hours_of_bin()
    share: float | None = share_of_bin()
    reversed: bool = reversed_of_bin()


@dataclass(frozen=True, kw_only=True)
class StageLoad(AnyLoad):
    """[load] of a stage: torque on the sun, or the bins of a load spectrum."""

    CASE: ClassVar[type[Bin]] = StageLoadCase
    sun_torque_Nm: float | None = key(
        TORQUE_Nm, "magnitude of the torque on the sun", None, "those of `case` or `spectrum`"
    )
    case: tuple[StageLoadCase, ...] | None = key(
        Tables(StageLoadCase, 1, MOST_BINS),
        "or the bins of a load spectrum, each a table `[[load.case]]` of `sun_torque_Nm`, `hours` or `share`, "
        "`sun_speed_rpm`, by default that of [operation], and `reversed`, as of pairs; of more than twelve torques, "
        "twelve in equal steps are analysed",
        None,
        "no spectrum",
    )
    spectrum: str | None = key(
        Line(1000),
        "or a CSV file, relative to the folder of the stage, a line for each bin, its keys as columns: "
        "`sun_torque_Nm`, `hours` or `share`, and where wanted `sun_speed_rpm` and `reversed` (true, false)",
        None,
        "as `case`",
    )

    alternatives: ClassVar[tuple[str, ...]] = alternatives_of(StageLoadCase)
    rules: ClassVar[tuple[Rule, ...]] = load_rules(StageLoadCase)


@dataclass(frozen=True, kw_only=True)
class StageOperation(Section):
    """[operation] of a stage: how it runs, for rating; the analysis takes nothing of it."""

    sun_speed_rpm: float = key(above_zero(1e6), "speed of the sun; the ring stands still")
    application_factor: float = key(FACTOR, "application factor K_A", 1.0)
    dynamic_factor: float = key(FACTOR, "dynamic factor K_v of both meshes", 1.0)


@dataclass(frozen=True, kw_only=True)
class StageRatingSection(RatingSection):
    """[rating] of a stage: that of a pair, with the mesh load factor."""

    mesh_load_factor: str | float = key(
        Either((Choice((ANALYSIS,)), LOAD_FACTOR)), "mesh load factor K_gamma: of the analysis, or a number", ANALYSIS
    )


@dataclass(frozen=True, kw_only=True)
class Stage(InNotebooks, Section):
    """A planetary stage in the engineer's units, as read from a stage file.

    Attributes
    ----------
    title : str
    stage : PlanetaryStage
        Section [stage].
    geometry : StageGeometry
        Section [pair].
    sun, planet : cylindrical.GearSection
    ring : internal.RingSection
    material : ElasticMaterial or None
    load : StageLoad
    operation : StageOperation or None
    lubricant : LubricantSection or None
    rating : StageRatingSection or None
    analysis : Analysis
        ``torques_Nm`` are torques of the sun.
    """

    title: str = key(Line(), "stands over reports and plots", "")
    stage: PlanetaryStage = subsection(PlanetaryStage, "planets, pins, and how the sun is held")
    geometry: StageGeometry = subsection(StageGeometry, "what all gears have in common", name="pair")
    sun: cylindrical.GearSection = subsection(cylindrical.GearSection, "the sun, which turns about +z")
    planet: cylindrical.GearSection = subsection(cylindrical.GearSection, "every planet")
    ring: RingSection = subsection(RingSection, "the ring, which stands still")
    material: ElasticMaterial | None = subsection(
        ElasticMaterial, "material of all gears; needed unless each has its own", optional=True
    )
    load: StageLoad = subsection(StageLoad, "what the sun carries")
    operation: StageOperation | None = subsection(StageOperation, "speed and factors, for rating", optional=True)
    lubricant: LubricantSection | None = subsection(LubricantSection, "the oil, for rating", optional=True)
    rating: StageRatingSection | None = subsection(
        StageRatingSection, "what is required of the gears, and factors, for rating", optional=True
    )
    analysis: Analysis = subsection(Analysis, "how finely both meshes are computed")

    rules: ClassVar[tuple[Rule, ...]] = (
        *(
            Rule(
                (f"{gear}.hand",),
                lambda hand: None if hand is None else f'found "{hand}"; not allowed: sun.hand gives the hands of all',
            )
            for gear in ("planet", "ring")
        ),
        *(
            Rule((f"{gear}.{name}",), lambda given, why=why: None if given is None else NOT_OF_STAGES.format(why))
            for gear in MEMBERS
            for name, why in OF_ONE_PITCH.items()
        ),
        Rule(("pair.tip_shortening", *MEMBERS), _shortens_a_tip),
        Rule(
            ("planet.profile_shift", "sun.profile_shift", "ring.profile_shift", "pair.centre_distance_mm"),
            _planet_between,
        ),
        Rule(
            ("load.sun_torque_Nm", "analysis.torques_Nm"),
            lambda torque, several: (
                "found 0; allowed above 0: a stage shares a torque" if torque == 0.0 and not several else None
            ),
        ),
        Rule(
            ("analysis.torques_Nm",),
            lambda several: None if all(several or (1.0,)) else "found 0; allowed above 0: a stage shares a torque",
        ),
        Rule(("load", "analysis.torques_Nm"), within_solved),
        Rule(("rating.life_hours", "load"), life_is_given),
        Rule(
            ("analysis.load_sharing",),
            lambda sharing: None if sharing else "found false; allowed true: the meshes of a stage share the load",
        ),
        Rule(
            ("analysis.positions",),
            lambda count: None if count >= 5 else f"found {count}; allowed from 5 on: shares are taken between them",
        ),
    )

    @property
    def teeth(self) -> tuple[int, int, int]:
        """Numbers of teeth of sun, planet and ring, that of the ring positive."""
        return self.sun.teeth, self.planet.teeth, -self.ring.teeth

    @property
    def sun_torques(self) -> tuple[float, ...]:
        """Torques of the sun to analyse [N mm]; of a load spectrum of many bins a dozen."""
        several = self.analysis.torques_Nm
        return tuple(1e3 * torque for torque in several) if several else self.load.torques

    @cached_property
    def centre_distance(self) -> float:
        """Centre distance of both meshes [mm].

        Raises
        ------
        GeometryError
            If it is not given and the meshes have different ones without backlash.
        """
        if self.geometry.centre_distance_mm is not None:
            return self.geometry.centre_distance_mm
        first, second = (mesh.working_centre_distance for mesh in _gears_of(*self._meshes(None)))
        if abs(first - second) > SAME_DISTANCE * self.geometry.normal_module_mm:
            raise GeometryError(
                f"ring.teeth: without backlash sun and planet have the centre distance {first:.4f} mm, planet and ring "
                f"{second:.4f} mm; numbers of teeth and profile shifts must give both the same distance, or "
                "pair.centre_distance_mm must leave both meshes some backlash"
            )
        return first

    @cached_property
    def profile_shifts(self) -> tuple[float, float, float]:
        """Profile shift coefficients of sun, planet and ring: one planet in both meshes.

        Those that are not given leave no backlash at a centre distance that is; where none is given, all are 0, since
        two meshes do not determine three shifts.

        Raises
        ------
        GeometryError
            If the centre distance asks for a profile shift that no gear has.
        """
        sun, planet, ring = given = self.sun.profile_shift, self.planet.profile_shift, self.ring.profile_shift
        distance = self.geometry.centre_distance_mm
        if distance is None or given.count(None) in (0, len(given)):
            return sun or 0.0, planet or 0.0, ring or 0.0
        of_sun = self._shift_sum(SUN_MESH, (self.sun.teeth, self.planet.teeth), distance)
        of_ring = self._shift_sum(RING_MESH, (self.planet.teeth, self.ring.teeth), distance)
        if planet is None:
            planet = of_sun - sun if sun is not None else of_ring - (ring or 0.0)
        shifts = of_sun - planet if sun is None else sun, planet, of_ring - planet if ring is None else ring
        for name, shift in zip(MEMBERS, shifts, strict=True):
            if abs(shift) > LARGEST_SHIFT:
                raise GeometryError(
                    f"pair.centre_distance_mm: found {plain(distance, 6)}; it and the profile shifts that are given "
                    f"ask for {plain(shift)} on the {name}, allowed -{plain(LARGEST_SHIFT)} to {plain(LARGEST_SHIFT)}"
                )
        return shifts

    def _shift_sum(self, gears: Mapping[str, str], teeth: tuple[int, int], distance: float) -> float:
        """Sum of the profile shifts of a mesh that leaves no backlash at a centre distance [mm]."""
        with in_words_of(gears), arguments_by_keys(StageGeometry):
            return profile_shift_sum(
                teeth,
                self.geometry.normal_module_mm,
                pressure_angle=math.radians(self.geometry.pressure_angle_deg),
                helix_angle=math.radians(self.geometry.helix_angle_deg),
                centre_distance=distance,
            )

    @cached_property
    def sun_scene(self) -> CylindricalScene:
        """Scene of the sun and a planet: the sun is the pinion; the torque is a planet's part of the first torque."""
        return self._meshes(self.centre_distance)[0]

    @cached_property
    def ring_scene(self) -> InternalScene:
        """Scene of a planet and the ring: the planet is the pinion, turning the other way."""
        return self._meshes(self.centre_distance)[1]

    @cached_property
    def meshes(self) -> tuple[CylindricalMesh, InternalMesh]:
        """Gears of the sun's and the ring's mesh; problems have the words of the stage.

        Raises
        ------
        GeometryError
            If gears are impossible, or do not mesh.
        """
        with self._following_shifts_named():
            return _gears_of(self.sun_scene, self.ring_scene)

    @contextmanager
    def _following_shifts_named(self) -> Iterator[None]:
        """Add to a refusal of gears which profile shifts the centre distance asks for, where any follow from it."""
        try:
            yield
        except (InputError, GeometryError) as error:
            distance, given = self.geometry.centre_distance_mm, (self.sun, self.planet, self.ring)
            following = [
                f"{shift:.4f} on the {name}"
                for name, gear, shift in zip(MEMBERS, given, self.profile_shifts, strict=True)
                if gear.profile_shift is None
            ]
            if distance is not None and 0 < len(following) < len(MEMBERS):
                error.add_note(
                    f"pair.centre_distance_mm = {plain(distance, 6)} and the profile shifts that are given ask for "
                    f"{' and '.join(following)}"
                )
            raise

    def _meshes(self, distance: float | None) -> tuple[CylindricalScene, InternalScene]:
        """Scenes of both meshes under a planet's part of the first torque; problems have the names of the stage."""
        common = {**contents(self.geometry), "type": "cylindrical", "centre_distance_mm": distance}
        common["tip_shortening"] = "none"  # of planets, which both meshes ask for: see _shortened
        driving: Driving = "pinion" if self.stage.driving == "sun" else "wheel"
        planets, torque = len(self.stage.angles), 1e-3 * self.sun_torques[0]
        other = OTHER[self.sun.hand or "right"]
        sun_shift, planet_shift, ring_shift = self.profile_shifts
        sun = replace(self.sun, profile_shift=sun_shift, strength=None)  # strength: of rating alone
        planet = replace(self.planet, profile_shift=planet_shift, strength=None)
        ring = replace(self.ring, profile_shift=ring_shift, strength=None)
        shared: dict[str, Any] = {"material": self.material, "analysis": replace(self.analysis, torques_Nm=None)}
        with in_words_of(SUN_MESH):
            of_sun = CylindricalScene(
                title=f"{self.title}: sun and planet".strip(": "),
                geometry=cylindrical.Geometry(**common, driving=driving),
                pinion=sun,
                wheel=planet,
                load=Load(pinion_torque_Nm=torque / planets),
                **shared,
            )
        with in_words_of(RING_MESH):
            of_ring = InternalScene(
                title=f"{self.title}: planet and ring".strip(": "),
                geometry=cylindrical.Geometry(**common, driving=driving, sense="negative"),
                pinion=replace(planet, hand=other),
                wheel=ring,
                load=Load(pinion_torque_Nm=torque * self.planet.teeth / self.sun.teeth / planets),
                **shared,
            )
        return _shortened(of_sun, of_ring) if self.geometry.tip_shortening == "computed" else (of_sun, of_ring)

    def require_assembly(self) -> None:
        """Refuse planets that cannot be put in, or touch each other.

        Raises
        ------
        GeometryError
            With every problem, and the nearest angles that are possible.
        """
        planet = self.meshes[0].wheel
        problems = spacing_problems(self.stage.angles, self.teeth, self.centre_distance, 2.0 * planet.tip_radius)
        if problems:
            raise GeometryError("; ".join(f"stage.{problem}" for problem in problems))

    def with_changes(self, changes: Mapping[str, Any]) -> Stage:
        """Return a stage with other values, all checked.

        Parameters
        ----------
        changes : mapping
            Key as in a file, with dots -> value; None: not given. A number behind a list is a place in it:
            ``"stage.pin_tangential_um.0"`` is the pin of planet 0, the others stay what they are.

        Raises
        ------
        InputError
            Every problem at once, as for a file.
        """
        changes, writings = in_keys(self, changes)
        table = as_table(self)
        of_planets = {path: value for path, value in changes.items() if PLACE.fullmatch(path)}
        for path, value in (dict.fromkeys(replaced_by(type(self), changes)) | dict(changes)).items():
            if path in of_planets:
                continue
            *sections, name = path.split(".")
            place = place_at(table, sections)
            if value is None:
                place.pop(name, None)
            else:
                place[name] = value
        own = place_at(table, ["stage"])
        for path, value in of_planets.items():
            _, name, number = path.split(".")
            count = own.get("planets") or len(own.get("planet_angles_deg") or ())
            values = list(own.get(name) or [0.0] * count)
            if int(number) >= len(values):
                raise InputError(f"{path}: no such planet; allowed 0 to {len(values) - 1}")
            values[int(number)] = value
            own[name] = values
        with told_as_written(writings):
            return stage_from_table(table)

    @classmethod
    def key_at(cls, path: str) -> Key:
        """Return what a stage says of the key at a path with dots, or of a place in a list of planets.

        Raises
        ------
        InputError
            If there is no such key, or the path leads to a section.

        Examples
        --------
        >>> Stage.key_at("stage.pin_tangential_um.0").about
        'displacement of each pin in the sense of rotation of the sun'
        """
        if not PLACE.fullmatch(path):
            return key_at(cls, path)
        entry = key_at(cls, path.rpartition(".")[0])
        assert isinstance(entry.kind, List)
        return replace(entry, kind=entry.kind.kind)

    def to_toml(self) -> str:
        """Return a stage file with every key; ``parse_stage`` makes the same stage of it."""
        return "\n".join(toml_lines(self, "")) + "\n"


def _shortened(of_sun: CylindricalScene, of_ring: InternalScene) -> tuple[CylindricalScene, InternalScene]:
    """Scenes of both meshes with tips that keep the clearances, where gears have none of their own; planets in both."""
    with in_words_of(SUN_MESH):
        sun = of_sun.computed_tip_alteration
    with in_words_of(RING_MESH):
        ring = of_ring.computed_tip_alteration
    changes = []
    for scene, *tips in ((of_sun, sun, min(sun, ring)), (of_ring, min(sun, ring), ring)):
        sections = zip(GEARS, (scene.pinion, scene.wheel), tips, strict=True)
        changes.append(
            {f"{name}.tip_alteration_coefficient": tip for name, gear, tip in sections if not gear.has_own_tip}
        )
    with in_words_of(SUN_MESH):
        external = of_sun.with_changes(changes[0])
    with in_words_of(RING_MESH):
        internal = of_ring.with_changes(changes[1])
    assert isinstance(external, CylindricalScene)
    assert isinstance(internal, InternalScene)
    return external, internal


def _gears_of(sun_scene: CylindricalScene, ring_scene: InternalScene) -> tuple[CylindricalMesh, InternalMesh]:
    """Gears of both scenes."""
    with in_words_of(SUN_MESH):
        of_sun = sun_scene.mesh()
    with in_words_of(RING_MESH):
        return of_sun, ring_scene.mesh()


@contextmanager
def in_words_of(gears: Mapping[str, str]) -> Iterator[None]:
    """Tell problems of a scene in the words of the stage.

    Examples
    --------
    >>> with in_words_of(RING_MESH):
    ...     raise GeometryError("wheel: its spaces close")
    Traceback (most recent call last):
    ...
    loaded_tca.errors.GeometryError: ring: its spaces close
    """
    try:
        yield
    except InputError as error:
        raise InputError(words_of(gears, problem) for problem in error.problems) from None
    except GeometryError as error:
        raise GeometryError(words_of(gears, str(error))) from None


def words_of(gears: Mapping[str, str], sentence: str) -> str:
    """Return a sentence on a pair in the words of the stage.

    Examples
    --------
    >>> words_of(SUN_MESH, "wheel: Y_S is large")
    'planet: Y_S is large'
    """
    sentence = sentence.replace("load.pinion_torque_Nm", "load.sun_torque_Nm")
    return re.sub(r"\b(pinion|wheel)\b", lambda word: gears[word[0]], sentence)


def stage_from_table(table: Mapping[str, Any]) -> Stage:
    """Return the stage that nested dictionaries describe, as TOML would give them.

    Raises
    ------
    InputError
        Every problem at once.
    """
    refused, known = [], dict(table)
    for gear in MEMBERS:
        if isinstance(section := table.get(gear), Mapping):
            known[gear] = {name: value for name, value in section.items() if name not in OF_ONE_PITCH}
            given = (name for name in OF_ONE_PITCH if name in section)  # whose missing keys are nothing to give
            refused += [f"{gear}.{name}: {NOT_OF_STAGES.format(OF_ONE_PITCH[name])}" for name in given]
    values, problems, _ = check(Stage, known)
    if problems := refused + list(problems):
        raise InputError(problems)
    return made(Stage, values)
