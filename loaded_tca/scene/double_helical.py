"""Scenes of double helical pairs: two halves of opposite hands on each gear, and how the gears stand along the axes.

Half a lies at z > 0 and has the hands of the scene. Half b is its mirror image in the middle of the groove, and its
keys count in that image: in both halves z runs from the groove outwards. So each half is an ordinary scene of two
helical gears, and two equal halves are one scene.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar, Literal

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError, named
from loaded_tca.gears import CylindricalMesh
from loaded_tca.pairs.gear_pair import GearPair, Sense, signs_of
from loaded_tca.plain import plain
from loaded_tca.scene import cylindrical
from loaded_tca.scene.cylindrical import CylindricalScene, MountingErrors
from loaded_tca.scene.flank_form import FlankForm
from loaded_tca.scene.half_shafts import HalfLoads, fault_of_floating, shaft_of_half
from loaded_tca.scene.keys import Choice, Number, above_zero, key
from loaded_tca.scene.parse import scene_from_table, variant
from loaded_tca.scene.pitch import Pitch
from loaded_tca.scene.rating import RatingSection
from loaded_tca.scene.section import Rule, Section, contents, rule, subsection
from loaded_tca.scene.sections import ERROR_mm, Modifications
from loaded_tca.scene.variants import OF_HALVES

# ruff: noqa: N815  -- names are the keys of the file, units included; the calls make dataclass fields

HALVES = "a", "b"
SIGNS = 1.0, -1.0
"""Of z of the pair, along the z of each half, which runs outwards."""
ONE_BY_ONE = (
    "found true; allowed false here, where one pair of flanks is needed. Both halves together are analysed by "
    "'loaded-tca run' and 'revolution', in Python by analyse and analyse_revolution. Each half by itself: half_a.nc "
    "and half_b.nc of a result, the pairs scene.halves, and the scenes scene.half_scenes(0.0) with measured flanks"
)
WHERE_BEARINGS_ARE = (
    "; forces on bearings: those of even shares are in 'loaded-tca check', those under load in "
    "double_helical_bearings.csv of 'loaded-tca run'"
)
SHARED = "found a torque of 0; allowed above 0: the halves share a torque"
NOT_OF_HALVES = {
    "tooth": "teeth have the flanks of their half; give the half by itself, as a helical pair",
    "support": "a matrix takes the loads of one mesh at one place, and two halves load the gear at two; give the shaft",
}
"""Sections of a gear that a double helical pair does not have, and why."""


@dataclass(frozen=True, kw_only=True)
class Geometry(cylindrical.Geometry):
    """[pair] of double helical gears."""

    double_helical: bool = key(
        Choice((False, True)), "whether each gear has two halves of opposite hands; leave it out where it has none"
    )
    gap_mm: float = key(above_zero(10000.0), "width of the groove between the halves, of both gears")
    apex_offset_mm: float = key(
        ERROR_mm,
        "axial distance from the apex of the pinion's teeth to the apex of the wheel's, where the middles of both "
        "grooves face each other; positive: the apex of the wheel lies nearer to half a",
        0.0,
    )
    floating: Literal["pinion", "wheel", "none"] = key(
        Choice((*GEARS, "none")),
        "the gear that moves along its axis until the axial forces of both halves balance; none: both are held",
        "pinion",
    )
    axial_stiffness_N_per_um: float = key(
        Number(0.0, 1e9), "axial stiffness of the support of the floating gear; 0: nothing holds it", 0.0
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *cylindrical.Geometry.rules,
        rule(("double_helical",), bool, "found false; allowed true, or leave it and the other keys of halves out"),
        rule(
            ("helix_angle_deg",),
            lambda angle: angle > 0.0,
            "found {0:g}; allowed above 0: the halves of spur teeth are one pair",
        ),
        rule(
            ("axial_stiffness_N_per_um", "floating"),
            lambda stiffness, floating: stiffness == 0.0 or floating != "none",
            'found {0:g} beside floating = "{1}"; it holds the gear that floats: name it, or leave the stiffness out',
        ),
    )


@dataclass(frozen=True, kw_only=True)
class HalfSection(Section):
    """[pinion.half_b], [wheel.half_b]: what the teeth of half b have instead of those of half a."""

    modifications: Modifications | None = subsection(
        Modifications, "material removed from the flanks of half b; default: as of half a", optional=True
    )
    flank: FlankForm | None = subsection(
        FlankForm, "how the flanks of half b are described; default: as of half a", optional=True
    )
    pitch: Pitch | None = subsection(Pitch, "pitch deviations of half b; default: as of half a", optional=True)


@dataclass(frozen=True, kw_only=True)
class GearSection(cylindrical.GearSection):
    """[pinion], [wheel] of double helical gears."""

    face_width_mm: float = key(
        above_zero(10000.0), "overall face width b of both halves with the groove; a half has (b - gap_mm)/2"
    )
    half_b: HalfSection | None = subsection(
        HalfSection, "teeth of half b, where they differ from those of half a", optional=True
    )
    apex_runout_um: float = key(
        Number(0.0, 10000.0),
        "axial runout of the apex of the teeth, peak to peak in a turn, in whole revolutions",
        0.0,
    )
    apex_runout_phase_deg: float = key(
        Number(-360.0, 360.0),
        "by how much the gear turns from where tooth 0 meshes until its apex lies nearest to half a",
        0.0,
    )

    rules: ClassVar[tuple[Rule, ...]] = (
        *cylindrical.GearSection.rules,
        rule(
            ("apex_runout_phase_deg", "apex_runout_um"),
            lambda phase, runout: phase == 0.0 or runout > 0.0,
            "found {0:g} without apex_runout_um, whose phase it is",
        ),
        *(
            Rule(
                (name,),
                lambda given, why=why: None if not given else f"found a section; not allowed of halves: {why}",
            )
            for name, why in NOT_OF_HALVES.items()
        ),
    )

    @property
    def teeth_differ(self) -> bool:
        """Whether a tooth of a half has a place of its own."""
        of_half_b = None if self.half_b is None else self.half_b.pitch
        return super().teeth_differ or self.apex_runout_um > 0.0 or (of_half_b is not None and of_half_b.is_given)

    @property
    def index_deviations(self) -> tuple[str, ...]:
        """Keys of the pitch deviations of both halves that are of one side of the teeth, in the section of the gear."""
        of_half_b = None if self.half_b is None else self.half_b.pitch
        keys = () if of_half_b is None else of_half_b.given_index
        return super().index_deviations + tuple(f"half_b.pitch.{key}" for key in keys)

    @property
    def measured_flanks(self) -> tuple[str, ...]:
        """Keys of the flanks of both halves that are measured, in the section of the gear."""
        of_half_b = None if self.half_b is None else self.half_b.flank
        is_measured = of_half_b is not None and of_half_b.form == "measured"
        return super().measured_flanks + (("half_b.flank.form",) if is_measured else ())

    def apex(self) -> Array:
        """Where the apex of the teeth lies as each of them meshes (teeth,) [mm], positive towards half a."""
        turned = 2.0 * math.pi / self.teeth * np.arange(self.teeth) - math.radians(self.apex_runout_phase_deg)
        return 0.5e-3 * self.apex_runout_um * np.cos(turned)


@dataclass(frozen=True, kw_only=True)
class Mounting(MountingErrors):
    """[mounting] of double helical gears: the whole wheel turns and moves about the middle of its groove."""

    half_b: MountingErrors | None = subsection(
        MountingErrors, "further errors of half b of the wheel, as counted from the groove outwards", optional=True
    )


def _within_face(gap: float, pinion: float, wheel: float) -> str | None:
    narrow = min(pinion, wheel)
    return None if gap < narrow else f"found {plain(gap, 6)}; allowed below the overall face width, {plain(narrow, 6)}"


@variant("a double helical pair: `pair.double_helical` is true")
@dataclass(frozen=True, kw_only=True)
class DoubleHelicalScene(CylindricalScene):
    """A scene of two double helical gears.

    Attributes
    ----------
    geometry : double_helical.Geometry
    pinion, wheel : double_helical.GearSection
    mounting : double_helical.Mounting
    title, material, load, analysis
        As for every ``Scene``; torques are those of both halves together.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> scene = read_scene("examples/scenes/double_helical.toml")
    >>> scene.halves
    (GearPair(29/87, module 4 mm, face 40 mm), GearPair(29/87, module 4 mm, face 40 mm))
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "the mating gear of the pinion")
    mounting: Mounting = subsection(Mounting, "mounting errors of the whole wheel")

    rules: ClassVar[tuple[Rule, ...]] = (
        *CylindricalScene.rules,
        Rule(("pair.gap_mm", "pinion.face_width_mm", "wheel.face_width_mm"), _within_face),
        rule(
            ("analysis.load_sharing",), bool, "found false; allowed true: the tooth pairs of both halves share the load"
        ),
        rule(("analysis.torques_Nm",), lambda several: all(several or ()), SHARED),
        rule(
            ("load.pinion_torque_Nm", "analysis.torques_Nm"), lambda torque, several: several or torque != 0.0, SHARED
        ),
        *(
            Rule(
                (f"{gear}.shaft", "pair.floating"),
                lambda shaft, floating, gear=gear: fault_of_floating(shaft) if floating == gear else None,
            )
            for gear in GEARS
        ),
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self.half_scenes(self.mounting.axial_offset_mm)  # which checks what is of halves: lengths over half the face

    @cached_property
    def halves(self) -> tuple[GearPair, GearPair]:
        """Flanks of both halves in space, each with z from the groove outwards."""
        first, second = (scene.pair() for scene in self.half_scenes(self.mounting.axial_offset_mm))
        return first, second

    def half_scenes(
        self,
        axial_mm: float,
        torques_Nm: Sequence[Sequence[float]] | None = None,
        loads: Sequence[Sequence[HalfLoads]] | None = None,
    ) -> tuple[CylindricalScene, CylindricalScene]:
        """Return the scenes of both halves, each with z from the groove outwards.

        Parameters
        ----------
        axial_mm : float [mm]
            Where the wheel stands along the axis, positive towards half a: how far the faces lie beside each other.
        torques_Nm : two sequences of float [N m], optional
            Pinion torques of each half; default: halves of those of the scene.
        loads : two sequences of HalfLoads, optional
            Of each half on pinion and wheel, which load the shafts of the other half, too; default: none.

        Raises
        ------
        InputError
            If values that are sound one by one do not fit a half.
        """
        torques = torques_Nm or 2 * [[0.5e-3 * torque for torque in self.torques]]
        scenes = []
        for half, name in enumerate(HALVES):
            with named(f"half {name}"):
                others = (None, None) if loads is None else loads[1 - half]
                scenes.append(self._half(half, axial_mm, tuple(torques[half]), others))
        return scenes[0], scenes[1]

    def _half(
        self, half: int, axial_mm: float, torques: tuple[float, ...], others: Sequence[HalfLoads | None]
    ) -> CylindricalScene:
        mounting = self.mounting_of_half(half, axial_mm)
        load = replace(self.load, pinion_torque_Nm=torques[-1], case=None)
        analysis = replace(self.analysis, torques_Nm=torques)
        title = f"{self.title}: half {HALVES[half]}".strip(": ")
        changes = {"title": title, "mounting": mounting, "load": load, "analysis": analysis}
        changes["rating"] = self.rating_of_halves
        scene = scene_from_table({**contents(self), **self._gears_of_half(half, others), **changes})
        assert isinstance(scene, CylindricalScene)
        pitches = {name: self._pitch_with_apex(scene, half, number) for number, name in enumerate(GEARS)}
        gears = {name: replace(getattr(scene, name), pitch=pitch) for name, pitch in pitches.items()}
        return replace(scene, **gears)

    def _pitch_with_apex(self, scene: CylindricalScene, half: int, number: int) -> Pitch | None:
        """Pitch deviations of a gear of a half; an apex beside its place sets the flanks of one half back, too."""
        gear: GearSection = (self.pinion, self.wheel)[number]
        pitch = (scene.pinion, scene.wheel)[number].pitch
        if gear.apex_runout_um == 0.0:
            return pitch
        rate = SIGNS[half] * (-1.0, 1.0)[number] * self.axial_rate
        index = 1e3 * rate * gear.apex()
        if pitch is None:
            return Pitch(index_um=tuple(index.tolist()))
        index = index + pitch.index(gear.teeth, partial(scene.pitch_tolerances, number))
        return Pitch(index_um=tuple(index.tolist()), runout_um=pitch.runout_um, runout_phase_deg=pitch.runout_phase_deg)

    def _gears_of_half(self, half: int, others: Sequence[HalfLoads | None] = (None, None)) -> dict[str, Any]:
        """Sections of both gears of a half, and what they have in common."""
        sections = {"pair": {k: v for k, v in contents(self.geometry).items() if k not in OF_HALVES}}
        for name, gear, loads in zip(GEARS, (self.pinion, self.wheel), others, strict=True):
            own = {key: value for key, value in contents(gear).items() if not key.startswith("apex_runout")}
            of_half: HalfSection | None = own.pop("half_b")
            if half and of_half is not None:
                own |= {section: value for section, value in contents(of_half).items() if value is not None}
            if gear.shaft is not None:
                floats = self.geometry.floating == name
                own["shaft"] = shaft_of_half(gear.shaft, SIGNS[half], self.lever_of(gear), floats=floats, others=loads)
            sections[name] = own | {"face_width_mm": self.half_width(gear)}
        return sections

    def mounting_of_half(self, half: int, axial_mm: float) -> dict[str, float]:
        """Mounting errors of a half: of the whole wheel, which turns about the middle of its groove, and its own."""
        sign, lever = SIGNS[half], self.lever_of(self.wheel)
        beside = sign * axial_mm + lever - self.lever_of(self.pinion)
        in_plane, out_of_plane = self.mounting.in_plane_deg, self.out_of_plane_deg
        apart = lever * math.sin(math.radians(in_plane)) * math.cos(math.radians(out_of_plane))
        own = contents(self.mounting.half_b) if half and self.mounting.half_b is not None else {}
        errors = {
            "in_plane_deg": sign * in_plane,
            "out_of_plane_deg": sign * out_of_plane,
            "centre_distance_error_mm": self.mounting.centre_distance_error_mm + sign * apart,
            "axial_offset_mm": beside,
        }
        return {name: value + own.get(name, 0.0) + 0.0 for name, value in {"misalignment_um": 0.0, **errors}.items()}

    @property
    def rating_of_halves(self) -> RatingSection | None:
        """What is required of each half, whose scene has no load spectrum: for the hours of that of the pair."""
        wanted = self.rating
        return wanted if wanted is None or wanted.life_hours else replace(wanted, life_hours=self.load.hours)

    def half_width(self, gear: cylindrical.GearSection) -> float:
        """Face width of a half of a gear [mm]."""
        return 0.5 * (gear.face_width_mm - self.geometry.gap_mm)

    @property
    def floats_freely(self) -> bool:
        """Whether nothing holds the floating gear along its axis."""
        return self.geometry.floating != "none" and self.geometry.axial_stiffness_N_per_um == 0.0

    @property
    def measured_halves(self) -> tuple[tuple[str, str], ...]:
        """Halves with a measured flank that is not that of the other half, and the gear of each."""
        halves = []
        for name, gear in zip(GEARS, (self.pinion, self.wheel), strict=True):
            of_half_b = None if gear.half_b is None else gear.half_b.flank
            forms = gear.flank, of_half_b or gear.flank
            if forms[0] != forms[1]:
                halves += [(half, name) for half, form in zip(HALVES, forms, strict=True) if form.form == "measured"]
        return tuple(halves)

    @property
    def narrow_half(self) -> float:
        """Face width of a half of the narrower gear [mm]."""
        return min(self.half_width(self.pinion), self.half_width(self.wheel))

    def lever_of(self, gear: cylindrical.GearSection) -> float:
        """Distance from the middle of the groove of a gear to the middle of the face of a half [mm]."""
        return 0.25 * (gear.face_width_mm + self.geometry.gap_mm)

    @property
    def out_of_plane_deg(self) -> float:
        """Axis error of the whole wheel across the plane of the axes, the misalignment included."""
        if self.mounting.misalignment_um == 0.0:
            return self.mounting.out_of_plane_deg
        narrow = min(self.pinion.face_width_mm, self.wheel.face_width_mm)
        pressure_angle = self.mesh().working_pressure_angle
        slope = 1e-3 * self.mounting.misalignment_um / (narrow * math.cos(pressure_angle))
        return self.mounting.out_of_plane_deg + math.degrees(slope)

    @property
    def axial_rate(self) -> float:
        """By how much flanks of half a part along the line of action as the wheel moves towards it: +-tan(beta_b).

        Those of half b come together by as much.
        """
        turning, drive = signs_of(self.driving, self.sense)
        return -self.hand_signs[0] * turning * drive * math.tan(abs(self.mesh().pinion.base_helix_angle))

    @property
    def parted(self) -> tuple[float, float]:
        """How far the flanks of both halves stand apart along the line of action beside what their scenes have [mm].

        By where the wheel stands along the axis, its apex, and where an axis error moves the middles of its halves.
        """
        turning, drive = signs_of(self.driving, self.sense)
        across = turning * drive * math.cos(self.mesh().working_pressure_angle)
        moved = -self.lever_of(self.wheel) * math.sin(math.radians(self.out_of_plane_deg))
        along = self.mounting.axial_offset_mm + self.geometry.apex_offset_mm
        whole = across * moved + self.axial_rate * along
        own = 0.0 if self.mounting.half_b is None else self.mounting.half_b.axial_offset_mm
        return whole, self.axial_rate * own - whole

    def mesh(self) -> CylindricalMesh:
        """Return the macro geometry of a half."""
        return self._mesh_of_half

    @cached_property
    def _mesh_of_half(self) -> CylindricalMesh:
        scene = scene_from_table({**contents(self), **self._gears_of_half(0), "mounting": None})
        assert isinstance(scene, CylindricalScene)
        return scene.mesh()

    def analytic_pair(self, sense: Sense) -> GearPair:  # noqa: ARG002
        """Refuse to make one pair of two halves.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(f"pair.double_helical: {ONE_BY_ONE}{WHERE_BEARINGS_ARE if self.is_supported else ''}")
