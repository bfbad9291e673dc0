"""The scene: two gears, their mounting errors, a material, a load, and what is asked about them."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any, ClassVar, Literal

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS
from loaded_tca.errors import give_accuracy_warning, require
from loaded_tca.material import LARGEST_RATIO_IN_BENDING
from loaded_tca.notebooks import InNotebooks
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense
from loaded_tca.pairs.tooth_deviations import ToothDeviations, ToothFlanks
from loaded_tca.plain import plain
from loaded_tca.scene.build import (
    arguments_by_keys,
    build_rounding,
    build_tooth_deviations,
    described_gear,
    in_base_units,
)
from loaded_tca.scene.keys import Line, key
from loaded_tca.scene.load import Load, life_is_given, within_solved
from loaded_tca.scene.parse import scene_from_table, scenes_of, toml_lines
from loaded_tca.scene.pitch import REVOLUTION_RULES, Revolution
from loaded_tca.scene.rating import RatingSection
from loaded_tca.scene.rows import Label, fixed
from loaded_tca.scene.section import (
    Rule,
    Section,
    as_table,
    beyond_defaults,
    contents,
    in_keys,
    place_at,
    replaced_by,
    rule,
    subsection,
    told_as_written,
    without_keys_of,
)
from loaded_tca.scene.sections import (
    Analysis,
    ElasticMaterial,
    GearSection,
    LubricantSection,
    Operation,
    Pair,
)
from loaded_tca.scene.standards import WithStandards

Hand = Literal["right", "left"]
Row = tuple[str, ...]
"""Label and cells of a line of an overview."""
_OF_FAMILIES = frozenset({"pair", "pair.type", "pair.blank", "pair.double_helical", "wheel", "wheel.teeth"})
"""Keys whose change may make a scene one of another family or variant."""


@dataclass(frozen=True, kw_only=True)
class Scene(InNotebooks, WithStandards, ABC):
    """Input of an analysis in the engineer's units, as read from a scene file.

    Values are checked however a scene is made, ``dataclasses.replace`` included; docs/reference/scene_keys.md lists the
    keys. Each family of gear pairs (``CylindricalScene``, ``BevelScene``) has its own sections for the pair, the gears
    and their mounting errors.

    Attributes
    ----------
    title : str
    geometry : Pair
        Section [pair]: what both gears have in common.
    pinion, wheel : GearSection
    mounting : Section
        Mounting errors, zero by default.
    material : ElasticMaterial or None
        Of both gears; ``materials`` tells what holds for each.
    load : Load
    analysis : Analysis
    operation : Operation or None
    lubricant : LubricantSection or None
    rating : RatingSection or None
    revolution : Revolution or None
        Of whole revolutions; None: a turn of the wheel.
    """

    title: str = key(Line(), "stands over reports and plots", "")
    geometry: Pair = subsection(Pair, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "the mating gear of the pinion")
    mounting: Section = subsection(Section, "mounting errors")
    material: ElasticMaterial | None = subsection(
        ElasticMaterial, "material of both gears; needed unless each has its own", optional=True
    )
    load: Load = subsection(Load, "what the pair carries")
    analysis: Analysis = subsection(Analysis, "how finely it is computed")
    operation: Operation | None = subsection(Operation, "speed and factors, for tribology and rating", optional=True)
    lubricant: LubricantSection | None = subsection(
        LubricantSection, "the oil, for tribology and rating", optional=True
    )
    rating: RatingSection | None = subsection(
        RatingSection, "what is required of the pair, and factors, for rating", optional=True
    )
    revolution: Revolution | None = subsection(Revolution, "which pitches a whole revolution has", optional=True)

    vh_keys: ClassVar[tuple[str, str]]
    """Keys of the two mounting errors that a V-H check varies."""

    rules: ClassVar[tuple[Rule, ...]] = (
        rule(
            ("material", "pinion.material", "wheel.material"),
            lambda common, pinion, wheel: common is not None or None not in (pinion, wheel),
            "missing; give [material] for both gears, or [pinion.material] and [wheel.material]",
        ),
        *(
            rule(
                (f"{place}.poisson_ratio", "analysis.compliance"),
                lambda ratio, compliance: compliance == "contact" or ratio <= LARGEST_RATIO_IN_BENDING,
                f'found {{0:g}}; allowed up to {LARGEST_RATIO_IN_BENDING} with analysis.compliance = "{{1}}": finite '
                'elements of a material that keeps its volume lock; or set analysis.compliance = "contact"',
            )
            for place in ("material", "pinion.material", "wheel.material")
        ),
        *(
            rule(
                (f"{gear}.support", f"{gear}.shaft"),
                lambda support, shaft: support is None or shaft is None,
                f"found beside [{gear}.shaft]; give one of the two",
            )
            for gear in GEARS
        ),
        *(
            rule(
                (f"{gear}.bore_diameter_mm", f"{gear}.shaft", "analysis.compliance"),
                lambda bore, shaft, compliance: bore != 0.0 or shaft is None or compliance == "contact",
                f"found {{0:g}}, a solid gear, whose torsion [{gear}.shaft] has, too; allowed the diameter of its "
                "seat, or none",
            )
            for gear in GEARS
        ),
        *(
            rule(
                (f"{place}.poisson_ratio", "analysis.root_stress"),
                lambda ratio, root_stress: not root_stress or ratio <= LARGEST_RATIO_IN_BENDING,
                f"found {{0:g}}; allowed up to {LARGEST_RATIO_IN_BENDING} with analysis.root_stress = true: finite "
                "elements of a material that keeps its volume lock; or set analysis.root_stress = false",
            )
            for place in ("material", "pinion.material", "wheel.material")
        ),
        Rule(("load", "analysis.torques_Nm"), within_solved),
        Rule(("rating.life_hours", "load"), life_is_given),
        *REVOLUTION_RULES,
    )

    @abstractmethod
    def mesh(self) -> Any:
        """Return the macro geometry.

        Raises
        ------
        InputError
            If values that are sound one by one do not fit each other.
        GeometryError
            If the gears cannot exist or cannot mesh.
        """

    @property
    @abstractmethod
    def sense(self) -> Sense:
        """Sense of rotation."""

    @property
    @abstractmethod
    def hands(self) -> tuple[Hand, Hand]:
        """Hands of pinion and wheel."""

    @property
    def hand_signs(self) -> tuple[int, int]:
        """+1 for the right hand, -1 for the left one, of pinion and wheel."""
        sign = 1 if self.hands[0] == "right" else -1
        return sign, -sign

    @property
    def driving(self) -> Driving:
        """The gear that drives."""
        wanted: Any = self.geometry
        driving: Driving = wanted.driving
        return driving

    def coast_side(self) -> Scene:
        """Return the scene with the other gear driving in the same sense of rotation: the other flanks carry the load.

        Torques of the pinion are the same; the flanks in contact have the same modifications. Of a load spectrum with
        reversed bins the others are reversed then: flanks keep the loads that they carry.

        Raises
        ------
        InputError
            If a flank is measured, also that of half b or of a single tooth: the scene has no measurement of the other
            side of its teeth.

        Warns
        -----
        AccuracyWarning
            If the teeth have index deviations: those of the drive side are kept.

        Examples
        --------
        >>> from loaded_tca import parse_scene
        >>> from loaded_tca.cli import DEMO_SCENE
        >>> parse_scene(DEMO_SCENE.read_text()).coast_side().driving
        'wheel'
        """
        gears = {"pinion": self.pinion, "wheel": self.wheel}
        measured = [f"{name}.{key}" for name, gear in gears.items() for key in gear.measured_flanks]
        require(*((False, f'{key}: "measured" is one side of the teeth; allowed others') for key in measured))
        for path in (f"{name}.{own}" for name, gear in gears.items() for own in gear.index_deviations):
            give_accuracy_warning(kinds.INDEX_OF_ONE_SIDE.sentence(key=path))
        changes: dict[str, Any] = {"pair.driving": "wheel" if self.driving == "pinion" else "pinion"}
        changes["pair.sense"] = self.sense
        if hasattr(self.geometry, "pinion_flank"):
            changes["pair.pinion_flank"] = None
        bins = self.load.case or ()
        if any(case.reversed for case in bins):
            changes["load.case"] = tuple(replace(case, reversed=not case.reversed) for case in bins)
        return self.with_changes(changes)

    def on_rigid_supports(self) -> Scene:
        """Return the scene with both gears held: without their supports and shafts.

        Raises
        ------
        InputError
            If no gear has any.

        Examples
        --------
        >>> from loaded_tca import parse_scene
        >>> from loaded_tca.cli import DEMO_SCENE
        >>> stiff = {"pinion.support.stiffness": [[1e6 * (i == j) for j in range(6)] for i in range(6)]}
        >>> parse_scene(DEMO_SCENE.read_text()).with_changes(stiff).on_rigid_supports().is_supported
        False
        """
        require((self.is_supported, "no gear has supports; give one a section support or shaft"))
        gears = {"pinion": self.pinion, "wheel": self.wheel}
        given = [(name, key) for name, gear in gears.items() for key in ("support", "shaft") if getattr(gear, key)]
        return self.with_changes({f"{name}.{key}": None for name, key in given})

    @abstractmethod
    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two flanks in space by their equations, modifications included."""

    def pair(self, sense: Sense | None = None) -> GearPair:
        """Return the two flanks in space, fitted or measured where [pinion.flank] or [wheel.flank] asks for it.

        Parameters
        ----------
        sense : {"positive", "negative"}, optional
            Sense of rotation, which picks the flanks in contact; default: that of the scene. A measured flank is the
            one in contact by the scene; the other flank of its tooth follows from the equations.

        Raises
        ------
        InputError
            If the sense is neither of the two, or values that are sound one by one do not fit each other.
        GeometryError
            If the gears cannot exist or cannot mesh.

        Warns
        -----
        AccuracyWarning
            If a B-spline misses its flank by more than 0.1 um, or a measurement leaves much of it uncovered.
        """
        known = sense in (None, "positive", "negative")
        require((known, f"sense: {sense!r:.60} is not 'positive' or 'negative'"))
        with arguments_by_keys(type(self)):
            pair = self.analytic_pair(sense or self.sense)
        require(*(check for number in range(len(GEARS)) for check in self._bore_on_shaft(number, pair.face_width)))
        side = pair.pinion.flank.side if sense in (None, self.sense) else -pair.pinion.flank.side
        described = replace(
            pair,
            pinion=described_gear(pair.pinion, self.pinion.flank, "pinion", side),
            wheel=described_gear(pair.wheel, self.wheel.flank, "wheel", side),
        )
        seated = self.without_bores(described)
        described = replace(
            described,
            pinion=seated.pinion if described.pinion.bore_diameter is None else described.pinion,
            wheel=seated.wheel if described.wheel.bore_diameter is None else described.wheel,
        )
        return described.rounded(build_rounding(self.pinion), build_rounding(self.wheel))

    def _bore_on_shaft(self, number: int, face_width: float) -> Iterator[tuple[bool, str]]:
        """Whether the shaft of a gear fills the bore that is given, anywhere under the face."""
        gear, middle, half = (self.pinion, self.wheel)[number], self.face_middles[number], 0.5 * face_width
        bore, shaft = gear.bore_diameter_mm, gear.shaft
        seats = [] if shaft is None else shaft.diameters_between(middle - half, middle + half)
        if bore is not None and seats:
            name, seat = GEARS[number], max(seats)
            problem = f"{name}.bore_diameter_mm: found {plain(bore, 9)}; allowed up to {plain(seat, 9)}"
            yield bore <= seat, f"{problem}, outer_diameter_mm of [[{name}.shaft.sections]] under the face"

    def without_bores(self, pair: GearPair) -> GearPair:
        """Return a pair held as where no bores are given: at the seats of shafts, where bodies bend, or by default."""

        def held(gear: Gear, number: int) -> Gear:
            bare, shaft = replace(gear, bore_diameter=None), (self.pinion, self.wheel)[number].shaft
            if shaft is None or not self.analysis.without_bodies:
                return bare
            return bare.on_seat(shaft.diameter_at(self.face_middles[number]))

        return replace(pair, pinion=held(pair.pinion, 0), wheel=held(pair.wheel, 1))

    @property
    def has_pitch_deviations(self) -> bool:
        """Whether the teeth of a gear stand beside their places, or have flanks that are not those of the gear."""
        gears = self.pinion, self.wheel
        return any(gear.teeth_differ or (gear.tooth and gear.kinds_of_teeth()[0].any()) for gear in gears)

    def tooth_flanks(self) -> ToothFlanks | None:
        """Return which teeth have flanks of their own, and the gears with them; None if all are alike.

        Raises
        ------
        InputError, GeometryError
            As of :meth:`pair`, where flanks of single teeth cannot be made.
        """
        if not (self.pinion.tooth or self.wheel.tooth):
            return None
        numbered = [gear.kinds_of_teeth() for gear in (self.pinion, self.wheel)]
        common = {"pinion.tooth": None, "wheel.tooth": None}
        gears = {}
        for (a, first), (b, second) in product(*(enumerate(changes) for _, changes in numbered)):
            if (a, b) != (0, 0):
                changes = {f"pinion.{name}": value for name, value in first.items()}
                changes |= {f"wheel.{name}": value for name, value in second.items()}
                gears[a, b] = self.with_changes(common | changes).pair()
        return ToothFlanks((numbered[0][0], numbered[1][0]), gears)

    def tooth_deviations(self, pair: GearPair) -> tuple[ToothDeviations, ToothDeviations]:
        """Return index deviations and eccentricity of the teeth of pinion and wheel.

        Parameters
        ----------
        pair : GearPair
            Of the scene.

        Raises
        ------
        InputError
            If an index deviation is larger than 0.05 modules, or a tolerance class has no tolerances of the gear.
        """
        pinion, wheel = (
            build_tooth_deviations(gear.pitch, teeth, name, pair.module, partial(self.pitch_tolerances, number))
            for number, (name, gear, teeth) in enumerate(zip(GEARS, (self.pinion, self.wheel), pair.teeth, strict=True))
        )
        return pinion, wheel

    def vh_steps(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return three values of each key of ``vh_keys`` for a V-H check: none, and small errors of both signs.

        A hundredth of the module, and for angles that over the face width, to one digit: it moves the contact of
        crowned flanks by parts of a module.
        """
        pair = self.pair()
        sizes = {"mm": 0.01 * pair.module, "deg": math.degrees(0.01 * pair.module / pair.face_width)}
        first, second = (float(f"{sizes[key.rpartition('_')[2]]:.0e}") for key in self.vh_keys)
        return (-first, 0.0, first), (-second, 0.0, second)

    @property
    def rigid_bores(self) -> tuple[float, float] | None:
        """Diameters of bores or journals of both gears [mm] that are held; None where no gear body is meshed.

        See :attr:`GearPair.rigid_bores`.
        """
        return self.pair().rigid_bores if self.analysis.without_bodies else None

    def held_row(self, pair: GearPair) -> Row:
        """Return what is held rigid where teeth bend."""
        return Label("bores or journals held rigid", "bores_or_journals_held_rigid_mm", *GEARS), *(
            fixed(bore, 4) for bore in pair.rigid_bores
        )

    @property
    def rack_radius(self) -> float | None:
        """What turns rotations of the wheel into travels of the rack that it stands for [mm]; None of wheels."""
        return None

    @property
    def wheel_cycles(self) -> float:
        """Load cycles of a tooth of the wheel per turn of the pinion, for each mate: abs(z1/z2)."""
        return abs(self.pinion.teeth / self.wheel.teeth)

    def require_turns(self, where: str) -> None:
        """Refuse what needs whole turns of both gears, said in words, where the wheel has none; it has."""

    @abstractmethod
    def active_starts(self) -> tuple[float, float]:
        """Return where the active profiles of pinion and wheel start, as ``Flank.profile_coordinate`` counts."""

    def active_ends(self) -> tuple[float, float]:
        """Return where the active profiles end, as ``active_starts``; infinite: at the tip."""
        return math.inf, math.inf

    @abstractmethod
    def geometry_rows(self) -> Sequence[Row]:
        """Return the rows of the geometry table: of the mesh, then of pinion and wheel."""

    @property
    def have_shafts(self) -> tuple[bool, bool]:
        """Whether pinion and wheel sit on a shaft."""
        return self.pinion.shaft is not None, self.wheel.shaft is not None

    @property
    def is_supported(self) -> bool:
        """Whether a gear gives way as a whole: it has a section for its support or its shaft."""
        return any(gear.support or gear.shaft for gear in (self.pinion, self.wheel))

    @property
    def face_middles(self) -> tuple[float, float]:
        """Axial coordinates, on the gears themselves, of the middles of both faces: motions are those of them [mm]."""
        return 0.0, 0.0

    @abstractmethod
    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm], a cell for each."""

    @property
    def grinding_notches(self) -> Sequence[tuple[float, float]]:
        """Depths of the notches that grinding leaves at the roots of both gears, and roundings of the tools [mm]."""
        return ()

    def missing_shifts(self) -> Sequence[str]:
        """Return sentences on teeth that look as if a profile shift of theirs were not given."""
        return ()

    @abstractmethod
    def interferences(self) -> Sequence[str]:
        """Return sentences on what jams the whole gears, which the contact of one flank of each does not notice.

        Raises
        ------
        GeometryError
            If nothing can turn.
        """

    @property
    def gear_names(self) -> tuple[str, str]:
        """Names of pinion and wheel in pictures."""
        return GEARS

    @property
    def flank_names(self) -> tuple[str, str]:
        """Names of the two flanks in contact in pictures."""
        return self.gear_names

    @property
    def materials(self) -> tuple[ElasticMaterial, ElasticMaterial]:
        """Material of pinion and wheel: the own one, or the common one."""
        first, second = self.pinion.material or self.material, self.wheel.material or self.material
        assert first is not None  # by the rules of the scene
        assert second is not None
        return first, second

    @property
    def torques(self) -> tuple[float, ...]:
        """Every pinion torque to analyse [N mm]; of a load spectrum of many bins a dozen."""
        several = in_base_units(self.analysis).get("torques")
        return several or self.load.torques

    def with_changes(self, changes: Mapping[str, Any]) -> Scene:
        """Return a scene with other values, all checked.

        Parameters
        ----------
        changes : mapping
            Key as in a file, with dots (``"pinion.modifications.tip_relief_um"``) -> value; None: not given, as of keys
            that a scene of another kind does not have (``"wheel.height_mm"`` of a rack that becomes a wheel). Of keys
            that say the same in several ways (``file``, ``measurement`` of a flank; ``index_um``, ``single_um``,
            ``file``, ``tolerance_class`` of a pitch) the one that is changed takes the place of the others. Keys of
            drawings (``"pinion.face_width_in"``) are taken, too.

        Raises
        ------
        InputError
            Every problem at once, as for a file.

        Examples
        --------
        A grid of one's own instead of an accuracy::

            scene.with_changes({"analysis.cells": (32, 32)})
        """
        changes, writings = in_keys(self, changes)
        # Sections without a change stay what they are, since they are checked; another family may have others.
        is_of_family = _OF_FAMILIES.isdisjoint(changes)
        table = contents(self) if is_of_family else as_table(self)
        # What a file was read into, for one, gives way where another file is named.
        for path, value in (dict.fromkeys(replaced_by(type(self), changes)) | dict(changes)).items():
            *sections, name = path.split(".")
            place_at(table, sections)[name] = value
        with told_as_written(writings):
            if not is_of_family:
                said = beyond_defaults(self, table, changes)
                without_keys_of(self, table, scenes_of(table, said), changes)
            return scene_from_table(table)

    def to_toml(self) -> str:
        """Return a scene file with every key; ``parse_scene`` makes the same scene of it."""
        return "\n".join(toml_lines(self, "")) + "\n"
