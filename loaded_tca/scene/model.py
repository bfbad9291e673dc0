"""The scene: two gears, their mounting errors, a material, a load, and what is asked about them."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any, ClassVar, Literal, TypeVar

from loaded_tca.arrays import GEARS
from loaded_tca.errors import InputError, require
from loaded_tca.material import LARGEST_RATIO_IN_BENDING
from loaded_tca.pairs.gear_pair import Driving, GearPair, Sense
from loaded_tca.pairs.tooth_deviations import ToothDeviations, ToothFlanks
from loaded_tca.scene.build import build_rounding, build_tooth_deviations, described_gear, in_base_units
from loaded_tca.scene.keys import Choice, Line, key, literal
from loaded_tca.scene.lubrication import LubricantSection, Operation
from loaded_tca.scene.pitch import REVOLUTION_RULES, Revolution
from loaded_tca.scene.section import (
    Rule,
    Section,
    Subsection,
    as_given,
    as_table,
    check,
    contents,
    entries,
    made,
    rule,
    subsection,
)
from loaded_tca.scene.sections import (
    Analysis,
    ContactStandard,
    ElasticMaterial,
    GearSection,
    Load,
    Pair,
)
from loaded_tca.scene.tolerance_class import scatter_of_class

Hand = Literal["right", "left"]
Row = tuple[str, ...]
"""Label and cells of a line of an overview."""
_OF_FAMILIES = frozenset({"pair", "pair.type", "pair.blank", "wheel", "wheel.teeth"})
"""Keys whose change may make a scene one of another family or variant."""


@dataclass(frozen=True, kw_only=True)
class Scene(Section, ABC):
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
    revolution : Revolution or None
        Of whole revolutions; None: a turn of the wheel.
    """

    title: str = key(Line(), "stands over reports and plots", "")
    geometry: Pair = subsection(Pair, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "its mating gear")
    mounting: Section = subsection(Section, "mounting errors")
    material: ElasticMaterial | None = subsection(
        ElasticMaterial, "material of both gears; needed unless each has its own", optional=True
    )
    load: Load = subsection(Load, "what the pair carries")
    analysis: Analysis = subsection(Analysis, "how finely it is computed")
    operation: Operation | None = subsection(Operation, "speed and factors, for tribology", optional=True)
    lubricant: LubricantSection | None = subsection(LubricantSection, "the oil, for tribology", optional=True)
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
                f"found {{0:g}}, a solid gear, whose torsion [{gear}.shaft] has, too; allowed the diameter of its seat",
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
        *REVOLUTION_RULES,
    )

    @classmethod
    def describes(cls, table: Mapping[str, Any]) -> bool:  # noqa: ARG003 (of families without variants)
        """Whether a table is one of this class; asked of the variants of a family alone."""
        return True

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

        Torques of the pinion are the same; the flanks in contact have the same modifications.

        Raises
        ------
        InputError
            If a flank is measured: the scene has no measurement of the other side of its teeth.

        Examples
        --------
        >>> from loaded_tca import parse_scene
        >>> from loaded_tca.cli import DEMO_SCENE
        >>> parse_scene(DEMO_SCENE.read_text()).coast_side().driving
        'wheel'
        """
        gears = {"pinion": self.pinion, "wheel": self.wheel}
        measured = [name for name, gear in gears.items() if gear.flank.form == "measured"]
        require(
            *((False, f'{name}.flank.form: "measured" is one side of the teeth; allowed others') for name in measured)
        )
        changes: dict[str, Any] = {"pair.driving": "wheel" if self.driving == "pinion" else "pinion"}
        changes["pair.sense"] = self.sense
        if hasattr(self.geometry, "pinion_flank"):
            changes["pair.pinion_flank"] = None
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
        pair = self.analytic_pair(sense or self.sense)
        side = pair.pinion.flank.side if sense in (None, self.sense) else -pair.pinion.flank.side
        described = replace(
            pair,
            pinion=described_gear(pair.pinion, self.pinion.flank, "pinion", side),
            wheel=described_gear(pair.wheel, self.wheel.flank, "wheel", side),
        )
        return described.rounded(build_rounding(self.pinion), build_rounding(self.wheel))

    @property
    def has_pitch_deviations(self) -> bool:
        """Whether the teeth of a gear stand beside their places, or have flanks of their own."""
        return any(gear.teeth_differ for gear in (self.pinion, self.wheel))

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

    def pitch_tolerances(self, gear: int, tolerance_class: int) -> tuple[float, float]:  # noqa: ARG002
        """Return the single and the cumulative pitch tolerance of a gear [um], along the transverse line of action.

        Parameters
        ----------
        gear : int
            0 the pinion, 1 the wheel.
        tolerance_class : int
            Of ISO 1328-1:2013.

        Raises
        ------
        InputError
            Where the standard has none, as for bevel gears.
        """
        raise InputError(
            f"tolerance_class: found {tolerance_class}; ISO 1328-1 has classes of cylindrical gears "
            "alone; give index_um"
        )

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

    @abstractmethod
    def active_starts(self) -> tuple[float, float]:
        """Return where the active profiles of pinion and wheel start, as ``Flank.profile_coordinate`` counts."""

    @abstractmethod
    def geometry_rows(self) -> Sequence[Row]:
        """Return the rows of the geometry table: of the mesh, then of pinion and wheel."""

    @property
    def tip_clearances(self) -> tuple[float, ...]:
        """Clearances c of both roots and the mating gear's tip [mm]; none of bevel gears, whose blanks have them."""
        return ()

    @property
    def pairs_in_contact(self) -> float:
        """Tooth pairs that are in contact on the mean, roughly."""
        return 3.0  # of face-milled teeth, whose contact ratio is not known before their contact

    @property
    def geometry_standard(self) -> str:
        """What the rows of the geometry follow, as titles have it."""
        return "ISO 21771" if self.path_points else "ISO 23509"

    @property
    def path_points(self) -> Mapping[str, float]:
        """Points A to E of the path of contact after ISO 21771, as roll lengths of the pinion; none of bevel gears."""
        return {}

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

    @property
    def mean_contact_length(self) -> float:
        """Mean length of all contact lines over a pitch [mm]; NaN for gears outside ISO 6336-1."""
        return math.nan

    @property
    def transverse_angles(self) -> tuple[float, float]:
        """Working transverse pressure angle, and base helix angle of the pinion [rad]; NaN for bevel gears."""
        return math.nan, math.nan

    @property
    def nominal_root_stress(self) -> tuple[float, float]:
        """Nominal root stress sigma_F0 of pinion and wheel after ISO 6336-3 per pinion torque [MPa/(N mm)].

        NaN for gears of which the standard does not speak.
        """
        return math.nan, math.nan

    @property
    def contact_standard(self) -> ContactStandard:
        """Contact factors and stiffnesses of ISO 6336; all NaN for gears outside the standard."""
        return ContactStandard()

    @property
    def root_factors(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Y_F, Y_S, Y_beta of pinion and wheel after ISO 6336-3; NaN for gears outside the standard."""
        unknown = (math.nan, math.nan, math.nan)
        return unknown, unknown

    @property
    def tooth_height_over_width(self) -> float:
        """Height of the teeth over the common face width, h/b of ISO 6336-1; NaN for gears outside the standard."""
        return math.nan

    @abstractmethod
    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm], a cell for each."""

    @abstractmethod
    def interferences(self) -> Sequence[str]:
        """Return sentences on what jams the whole gears, which the contact of one flank of each does not notice.

        Raises
        ------
        GeometryError
            If nothing can turn.
        """

    def slope_tolerances(self, tolerance_class: int) -> Mapping[str, float]:
        """Return the tolerances of slopes of both gears of a class, by their keys [um].

        Raises
        ------
        InputError
            If there is no standard for gears of this kind, or it has no such class.
        """
        raise InputError(f"tolerance_class: {tolerance_class}; ISO 1328-1 holds for cylindrical gears alone")

    def scatter_of_class(self, tolerance_class: int, *, deviations: bool = False) -> Mapping[str, Any]:
        """Return how helix and profile slopes of both gears scatter that are of a tolerance class of ISO 1328-1:2013.

        Each slope is normal about its value in the scene, with three standard deviations to its tolerance f_HbetaT or
        f_HalphaT to either side, and independent of the others.

        Parameters
        ----------
        tolerance_class : int
            From 1 to 11.
        deviations : bool
            About zero instead, as the scatter of ``DesignModel`` counts it.

        Returns
        -------
        mapping of str to frozen distribution of ``scipy.stats``
            Key -> its distribution [um], as ``Study`` takes it.

        Raises
        ------
        InputError
            If the gears are not cylindrical, or outside the classes and ranges of the standard.

        Examples
        --------
        >>> from loaded_tca import read_scene
        >>> scatter = read_scene("examples/scenes/helical.toml").scatter_of_class(6)
        >>> round(float(scatter["wheel.modifications.helix_slope_um"].std()), 3)
        3.0
        """
        return scatter_of_class(self, tolerance_class, deviations=deviations)

    @property
    def flank_names(self) -> tuple[str, str]:
        """Names of the two flanks in contact in pictures."""
        return GEARS

    @property
    def materials(self) -> tuple[ElasticMaterial, ElasticMaterial]:
        """Material of pinion and wheel: the own one, or the common one."""
        first, second = self.pinion.material or self.material, self.wheel.material or self.material
        assert first is not None  # by the rules of the scene
        assert second is not None
        return first, second

    @property
    def torques(self) -> tuple[float, ...]:
        """Every pinion torque to analyse [N mm]."""
        several = in_base_units(self.analysis).get("torques")
        return several or (in_base_units(self.load)["pinion_torque"],)

    def with_changes(self, changes: Mapping[str, Any]) -> Scene:
        """Return a scene with other values, all checked.

        Parameters
        ----------
        changes : mapping
            Key as in a file, with dots (``"pinion.modifications.tip_relief_um"``) -> value; None: not given.

        Raises
        ------
        InputError
            Every problem at once, as for a file.

        Examples
        --------
        A grid of one's own instead of an accuracy::

            scene.with_changes({"analysis.cells": (32, 32)})
        """
        # Sections without a change stay what they are, since they are checked; another family may have others.
        table = contents(self) if _OF_FAMILIES.isdisjoint(changes) else as_table(self)
        for path, value in changes.items():
            *sections, name = path.split(".")
            place = table
            for section in sections:
                inner = place.get(section)
                inner = contents(inner) if isinstance(inner, Section) else inner
                if isinstance(inner, tuple) and inner and isinstance(inner[0], Section | dict):
                    inner = {str(n): one for n, one in enumerate(inner)}  # a list of tables: names are places
                place[section] = place = dict(inner) if isinstance(inner, dict) else {}
            place[name] = value
        return scene_from_table(table)

    def to_toml(self) -> str:
        """Return a scene file with every key; ``parse_scene`` makes the same scene of it."""
        return "\n".join(_lines(self, "")) + "\n"


FAMILIES: dict[str, type[Scene]] = {}
"""Type of a gear pair, as files call it -> the scenes of its family; filled by ``family``."""

VARIANTS: dict[type[Scene], dict[type[Scene], str]] = {}
"""Class of a family -> its variants, which scenes of other keys are, and of what; filled by ``variant``."""

SceneType = TypeVar("SceneType", bound=type[Scene])


def family(*types: str) -> Callable[[SceneType], SceneType]:
    """Make a class of scenes known to scene files, under the types of gear pairs of its section [pair]."""

    def known(scene: SceneType) -> SceneType:
        FAMILIES.update(dict.fromkeys(types, scene))
        return scene

    return known


def variant(scenes: type[Scene], about: str) -> Callable[[SceneType], SceneType]:
    """Make a class known as a variant of a family, for the tables that it describes; ``about`` says when."""

    def known(scene: SceneType) -> SceneType:
        VARIANTS.setdefault(scenes, {})[scene] = about
        return scene

    return known


def scene_from_table(table: Mapping[str, Any]) -> Scene:
    """Return the scene that nested dictionaries describe, as TOML would give them; ``pair.type`` picks the family.

    Raises
    ------
    InputError
        Every problem at once.
    """
    pair = {} if table.get("pair") is None else table["pair"]
    pair = contents(pair) if isinstance(pair, Section) else pair
    kind = pair.get("type") if isinstance(pair, Mapping) else None
    try:
        scenes = FAMILIES[Choice(tuple(FAMILIES)).read(kind)]  # type: ignore[index]
    except ValueError as refused:
        raise InputError(_problems_without_type(table, pair, kind, str(refused))) from None
    scenes = next((one for one in VARIANTS.get(scenes, {}) if one.describes(table)), scenes)
    values, problems = check(scenes, table)
    if problems:
        raise InputError(problems)
    return made(scenes, values)


def _problems_without_type(table: Mapping[str, Any], pair: Any, kind: Any, refusal: str) -> list[str]:
    """Every problem of a scene of no known type: the others are those as the type that knows the most keys."""
    if not isinstance(pair, Mapping):
        return check(next(iter(FAMILIES.values())), table)[1]
    complaint = f"missing; allowed {Choice(tuple(FAMILIES)).allowed}" if kind is None else refusal
    trials = [check(scenes, {**table, "pair": {**pair, "type": name}})[1] for name, scenes in FAMILIES.items()]
    fewest = min(trials, key=lambda problems: (sum("unknown key" in problem for problem in problems), len(problems)))
    return [f"pair.type: {complaint}", *fewest]


def _lines(section: Section, path: str) -> list[str]:
    """Keys first, then the sections inside, each under its header."""
    keys, sections = [], []
    values = contents(section)
    for name, (_, entry) in entries(type(section)).items():
        value = values[name]
        if isinstance(value, Section):
            sections += ["", f"[{path}{name}]", *_lines(value, f"{path}{name}.")]
        elif isinstance(entry, Subsection):
            sections += ["", f"# [{path}{name}] is not given"]
        elif value is None:
            keys.append(f"# {name} is not given: {entry.absent}")
        else:
            keys.append(f"{name} = {literal(as_given(value))}")
    return keys + sections
