"""Scenes of face-milled gears given by their blanks: type "face_milled" with a section [pair.blank]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Literal

from loaded_tca.gears.face_milled import FaceMilledMesh
from loaded_tca.pairs.gear_pair import GearPair, Sense
from loaded_tca.scene import bevel, spiral
from loaded_tca.scene.bevel import SIZES, BevelScene, GearSection, one_size, too_steep
from loaded_tca.scene.bevel_blank import Blank
from loaded_tca.scene.bevel_rows import MEAN_DEPTHS, blank_rows, common_blank_rows
from loaded_tca.scene.face_milled import FaceMilledScene
from loaded_tca.scene.keys import Choice, Number, key
from loaded_tca.scene.machine_settings import Method, Settings, mean_contact_rows
from loaded_tca.scene.model import Row
from loaded_tca.scene.parse import variant
from loaded_tca.scene.section import Rule, rule, subsection
from loaded_tca.scene.sections import SENSE
from loaded_tca.scene.spiral import MountingErrors


@dataclass(frozen=True, kw_only=True)
class Geometry(bevel.Geometry):
    """[pair] of face-milled gears that are given by their blanks."""

    type: Literal["face_milled"] = key(Choice(("face_milled",)), "kind of gear pair")  # type: ignore[assignment]
    spiral_angle_deg: float = key(
        bevel.SPIRAL_deg, "mean spiral angle beta_m on the pitch cone; its sign is in `pinion.hand`"
    )
    pressure_angle_deg: float | None = key(
        bevel.PRESSURE_deg,
        "transverse pressure angle alpha on the pitch cone, instead of `normal_pressure_angle_deg`",
        None,
        "follows",
    )
    normal_pressure_angle_deg: float | None = key(
        bevel.PRESSURE_deg, "mean normal pressure angle alpha_n on the pitch cone", None, "20"
    )
    sense: Sense | None = key(SENSE, "sense of rotation, instead of `pinion_flank`", None, "by `pinion_flank`")
    pinion_flank: spiral.Side | None = key(
        spiral.SIDE, "flank of the pinion that is in contact (drive side: concave)", None, '"concave", or by `sense`'
    )
    offset_mm: float = key(
        Number(-1000.0, 1000.0), "hypoid offset: 0 here; settings of hypoid pairs are given, or by `HypoidBlank`", 0.0
    )
    blank: Blank = subsection(Blank, "depths and thicknesses after ISO 23509")
    settings: Settings = subsection(Settings, "how machine settings and cutters follow from the blanks")

    rules: ClassVar[tuple[Rule, ...]] = (
        Rule(SIZES, one_size),
        rule(
            ("offset_mm",),
            lambda offset: offset == 0.0,
            "found {0:g}; with [pair.blank] axes meet: give the settings of a hypoid pair, as loaded_tca.gears."
            "HypoidBlank and loaded_tca.flanks.synthesised_gears make them (docs/guide/hypoid_pair.md)",
        ),
        spiral.FLANK_OR_SENSE,
        spiral.ONE_PRESSURE_ANGLE,
        Rule(("normal_pressure_angle_deg", "spiral_angle_deg"), too_steep),
        rule(
            ("blank.cutter_radius_mm",),
            lambda radius: radius is not None,
            "missing; a face-milled gear needs the radius of its cutter",
        ),
    )


@variant("a `face_milled` pair by its blanks: `pair` has a section `blank`, settings follow")
@dataclass(frozen=True, kw_only=True)
class BlankFaceMilledScene(BevelScene):
    """A scene of two face-milled gears given by their blanks; settings and cutters follow from these.

    The other keys are those of ``BevelScene`` with a blank.

    Attributes
    ----------
    geometry : blank_face_milled.Geometry
        With the sections ``blank`` and ``settings``.
    pinion, wheel : bevel.GearSection
    mounting : MountingErrors
    title, material, load, analysis
        As for every ``Scene``.

    Examples
    --------
    >>> from loaded_tca.scene import read_scene
    >>> scene = read_scene("examples/scenes/face_milled_blank.toml")
    >>> scene.pair()
    GearPair(14/39, module 3.20548 mm, face 25.4 mm)
    """

    geometry: Geometry = subsection(Geometry, "what both gears have in common", name="pair")
    pinion: GearSection = subsection(GearSection, "the gear that turns about +z")
    wheel: GearSection = subsection(GearSection, "the mating gear of the pinion")
    mounting: MountingErrors = subsection(MountingErrors, "mounting errors")

    rules: ClassVar[tuple[Rule, ...]] = (
        *BevelScene.rules,
        rule(
            ("pair.blank.lengthwise_curve",),
            lambda curve: curve == "logarithmic",
            'found "{0}"; not allowed with face-milled gears, whose flanks run as the cutter leaves them',
        ),
    )

    usual_flank = "concave"

    @cached_property
    def cut(self) -> FaceMilledScene:
        """The scene with all its machine settings and cutters, which is what is analysed."""
        cut = self.face_milled(self.geometry.settings)
        assert isinstance(cut, FaceMilledScene)
        return cut

    def with_method(self, method: Method) -> BlankFaceMilledScene:
        """Return the scene with settings by another method; without what only the one of the scene takes."""
        own = self.geometry.settings
        settings = own if own.method == method else Settings(method=method, edge_radius_mm=own.edge_radius_mm)
        return replace(self, geometry=replace(self.geometry, settings=settings))

    @property
    def contact_sides(self) -> tuple[str, str]:
        """Sides in contact of pinion and wheel: "concave" or "convex"."""
        return self.sides(self.sense)

    @property
    def face_middles(self) -> tuple[float, float]:
        """Axial coordinates of the mean pitch circles of both gears, from the crossing point of the axes [mm]."""
        return self.cut.face_middles

    @property
    def pairs_in_contact(self) -> float:
        """As of face-milled teeth with settings."""
        return self.cut.pairs_in_contact

    def mesh(self) -> FaceMilledMesh:  # type: ignore[override]
        """Return blanks, machine settings and cutters of both gears."""
        return self.cut.mesh()

    @property
    def tip_clearances(self) -> tuple[float, ...]:
        """As of face-milled teeth with settings."""
        return self.cut.tip_clearances

    def analytic_pair(self, sense: Sense) -> GearPair:
        """Return the two generated flanks in space."""
        return self.cut.analytic_pair(sense)

    def active_starts(self) -> tuple[float, float]:
        """Return the form lines of pinion and wheel, from which their profiles are counted."""
        return self.cut.active_starts()

    def geometry_rows(self) -> Sequence[Row]:
        """Return the dimension sheet of the blanks, angles of the flanks, machine settings, cutters, mean contact."""
        blanks, mesh = self.blanks(), self.mesh()
        assert blanks is not None
        common = common_blank_rows(blanks, self.geometry.blank, self.data_type)
        once = ("flanks along the face", *MEAN_DEPTHS)  # by the settings, and on the sheet
        rows = [row for row in (*common, *self.cut.geometry_rows()) if row[0] not in once]
        return [*rows, *blank_rows(blanks), *mean_contact_rows(mesh.gears, self.sides(self.sense)[0])]

    def interferences(self) -> Sequence[str]:
        """Return how the whole gears interfere without mounting errors."""
        return self.cut.interferences()

    def missing_shifts(self) -> Sequence[str]:
        """Return a sentence on teeth that are thin beside their spaces."""
        return self.cut.missing_shifts()

    def force_rows(self, torques: Sequence[float]) -> Sequence[Row]:
        """Return the forces under pinion torques [N mm]."""
        return self.cut.force_rows(torques)
