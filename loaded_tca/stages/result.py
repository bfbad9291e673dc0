"""The result of a stage: shares of the planets over the mesh, motion of the sun, transmission error, both meshes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.results import MeshCycle
from loaded_tca.results.declared import CYCLE, Asked, Number, numbers
from loaded_tca.results.figure import Figure, Figures
from loaded_tca.results.files import STAGE
from loaded_tca.results.result import JoinedResult, figures_of
from loaded_tca.results.summary import kind_of_edge, shown_torque
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.stages.files import parse_stage
from loaded_tca.stages.kinematics import neutralised
from loaded_tca.stages.sections import SAME_DISTANCE, Stage
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    import xarray

    from loaded_tca.scene import Scene
    from loaded_tca.stages.rating import StageRating

STAGE_FILE = "stage.nc"
"""Name of the file of the stage."""
MOST_ORDERS = 6
TORQUE, PLANETS = ("torque",), ("planet",)

MESH_NAMES = {"sun": "sun and planet", "ring": "planet and ring"}
STAGE_NUMBERS = numbers(
    {
        "torque": Number(TORQUE, "N mm", "torque of the sun", column="sun_torque_Nm", label="sun torque"),
        "sun_angle": (("position",), "rad", "angle of the sun against the carrier, over one pitch of the sun"),
        "planet": (PLANETS, "1", "planet, from 0"),
        "planet_angle": (PLANETS, "rad", "angle of the planet on the carrier"),
        "sun_mesh_phase": (PLANETS, "1", "phase of the mesh of sun and planet, in mesh cycles"),
        "ring_mesh_phase": (PLANETS, "1", "phase of the mesh of planet and ring, in mesh cycles"),
        "sun_base_radius": ((), "mm", "base radius of the sun"),
        "transmission_error": Number(CYCLE, "rad", "transmission error, counted at the sun", at_base_circle=True),
        "one_path_transmission_error": Number(
            CYCLE, "rad", "transmission error of planet 0 alone under an even share of the torque", columns=()
        ),
        "planet_share": Number(
            (*CYCLE, "planet"), "1", "part of the torque that a planet carries", columns=("planet_{}_share",)
        ),
        "sun_motion": Number(
            (*CYCLE, "axis"),
            "mm",
            "motion of the sun's axis in the frame of the carrier",
            columns=("sun_motion_{}_um",),
        ),
        "mesh_load_factor": Number(
            TORQUE,
            "1",
            "mesh load factor K_gamma: the largest share of a planet over an even share",
            label="mesh load factor K_gamma",
        ),
        **{
            f"{mesh}_mesh_peak_pressure": Number(
                TORQUE,
                "MPa",
                f"peak pressure of {gears} under the largest share",
                label=f"peak pressure of the {mesh}'s mesh",
            )
            for mesh, gears in MESH_NAMES.items()
        },
    }
)
EDGES = numbers(
    {
        f"{mesh}_mesh_edge_pressure": (
            TORQUE,
            "MPa",
            f"pressure at an edge in the {mesh}'s mesh under the largest share, mesh-dependent if sharp; "
            "NaN: no edge is reached",
        )
        for mesh in MESH_NAMES
    },
    Asked(lambda *_: False, "the result is of an earlier version, without pressures at edges"),
)
ROOTS = numbers(
    {
        name: Number(TORQUE, "MPa", f"{text} under the largest share", label=text)
        for name, text in (
            ("sun_root_tension", "root tension of the sun"),
            ("planet_root_tension_at_sun", "root tension of a planet by the sun"),
            ("planet_root_tension_at_ring", "root tension of a planet by the ring"),
            ("ring_root_tension", "root tension of the ring"),
        )
    },
    Asked(
        lambda stage, _: stage.analysis.root_stress, "the result has no root stress; set analysis.root_stress = true"
    ),
)
"""Numbers of a stage: those that all have, those that results of earlier versions do not have, of root stress."""
COORDINATES = "torque", "sun_angle", "planet"


def _of_mesh(mesh: str) -> dict[str, Figure]:
    """Pressures of a mesh under the largest share."""
    peak, edge = f"{mesh}_mesh_peak_pressure", f"{mesh}_mesh_edge_pressure"
    return {
        **figures_of({peak: STAGE_NUMBERS[peak]}),
        f"{edge}_MPa": Figure(
            of=lambda under: float(getattr(under, edge)) if under.result.has(edge) else math.nan, label="  {edge}"
        ),
    }


FIGURES: dict[str, Figure] = {
    **figures_of({name: STAGE_NUMBERS[name] for name in ("torque", "mesh_load_factor")}),
    "least_planet_share": Figure(
        of=lambda under: float(under.planet_share.min()),
        label="least share of a planet in the torque",
        largest_is_best=True,
    ),
    "largest_planet_share": Figure(
        of=lambda under: float(under.planet_share.max()), label="largest share of a planet in the torque"
    ),
    "transmission_error_peak_to_peak_um": Figure(
        of=lambda under: float(np.ptp(under.result.error_um(under.row))), label="transmission error, peak to peak"
    ),
    "one_path_peak_to_peak_um": Figure(
        of=lambda under: float(np.ptp(under.result.error_um(under.row, one_path=True))), label="  of one path alone"
    ),
    "sun_motion_largest_um": Figure(
        of=lambda under: MICROMETRES * float(np.hypot(*under.sun_motion.T).max()), label="largest motion of the sun"
    ),
    **_of_mesh("sun"),
    **_of_mesh("ring"),
}
"""Key figures of a stage by their names; {edge} of a label stands for the kind of edge."""


@dataclass(frozen=True)
class Order:
    """An order of the mesh.

    Attributes
    ----------
    order : int
    stage, one_path : float [um]
        Amplitude of the transmission error of the stage, and of one planet alone, at the base circle of the sun.
    torsion_cancels, translation_cancels : bool
        Whether equal planets cancel it in the rotation, and in the forces on the sun's axis.
    """

    order: int
    stage: float
    one_path: float
    torsion_cancels: bool
    translation_cancels: bool


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class StageResult(JoinedResult):
    """Planets of a stage over one pitch of the sun, under each torque.

    Attributes
    ----------
    stage : Stage
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``STAGE_NUMBERS`` with their units, over torque [N mm], position (``sun_angle`` [rad]) and planet.
    sun_mesh, ring_mesh : MeshCycle
        Of one planet with sun and ring, under torques from a small part of an even share to the whole.
    """

    KIND: ClassVar = STAGE
    WHAT: ClassVar = "the result of a stage"
    TITLE: ClassVar = "Planetary stage"
    SUBJECT: ClassVar = "stage"
    BASE_RADIUS: ClassVar = "sun_base_radius"
    NUMBERS: ClassVar = STAGE_NUMBERS | EDGES | ROOTS
    COORDINATES: ClassVar = COORDINATES
    FIGURES: ClassVar = FIGURES
    FILE: ClassVar = STAGE_FILE
    JSON: ClassVar = "stage.json"
    TABLES: ClassVar = {"stage.csv": "positions"}
    PARTS: ClassVar = {"sun_mesh": "sun_mesh.nc", "ring_mesh": "ring_mesh.nc"}
    PART: ClassVar = MeshCycle
    ABOUT: ClassVar = (*JoinedResult.ABOUT, "mesh_warnings")

    stage: Stage
    dataset: xarray.Dataset
    sun_mesh: MeshCycle
    ring_mesh: MeshCycle

    def __repr__(self) -> str:
        sizes = self.dataset.sizes
        return f"StageResult({sizes['planet']} planets, {sizes['torque']} torques, {sizes['position']} positions)"

    def error_um(self, torque: int, *, one_path: bool = False) -> Array:
        """Transmission error (n,) [um] at the base circle of the sun, of the stage or of one planet alone."""
        errors = self.one_path_transmission_error if one_path else self.transmission_error
        return np.asarray(self.um_per_rad * errors[torque])

    def orders(self, torque: int = -1) -> tuple[Order, ...]:
        """Orders of the mesh under a torque, by its index; default: the last one."""
        of_stage, of_path = (
            2.0 / len(curve) * np.abs(np.fft.rfft(curve))
            for curve in (self.error_um(torque), self.error_um(torque, one_path=True))
        )
        count = min(MOST_ORDERS, (self.dataset.sizes["position"] - 1) // 2)
        angles = self.stage.stage.angles
        return tuple(
            Order(k, float(of_stage[k]), float(of_path[k]), *neutralised(k, angles, self.stage.sun.teeth))
            for k in range(1, count + 1)
        )

    @cached_property
    def neutralised_orders(self) -> tuple[int, ...]:
        """Orders of the mesh, up to six, that equal planets cancel in the rotation of the sun."""
        angles, teeth = self.stage.stage.angles, self.stage.sun.teeth
        return tuple(k for k in range(1, MOST_ORDERS + 1) if neutralised(k, angles, teeth)[0])

    def kind_of_edge(self, name: str) -> str:
        """At which kind of edge a mesh has its edge pressure, of the name of the figure; "" where it reaches none."""
        mesh = self.sun_mesh if name.startswith("sun") else self.ring_mesh
        figures = [row for row in mesh.key_figures() if math.isfinite(row["edge_pressure_MPa"])]
        known = any(math.isfinite(row[name]) for row in self.key_figures())
        return kind_of_edge(figures) if figures and known else ""

    def known_figures(self) -> dict[str, str]:
        """Labels of the key figures that a table has, by their names: without edges where none is reached."""
        edges = {name: self.kind_of_edge(name) for name in self.figures if name.removesuffix("_MPa") in EDGES}
        labels = super().labels()
        return {name: labels[name].format(edge=edges.get(name)) for name in labels if edges.get(name) != ""}

    def labels(self) -> dict[str, str]:
        """Labels of the lines of the summary."""
        return self.known_figures()

    def findings(self) -> tuple[str, ...]:
        """Sentences on planets that carry nothing: under which torque, and whether at all positions."""
        sentences = []
        for shares, torque in zip(self.planet_share, self.torque.tolist(), strict=True):
            idle = shares <= 0.0
            for words, planets in (
                ("any position", idle.all(axis=0)),
                ("some positions", idle.any(axis=0) & ~idle.all(axis=0)),
            ):
                numbers = ", ".join(map(str, np.flatnonzero(planets).tolist()))
                if numbers:
                    what = f"planet {numbers} carries" if planets.sum() == 1 else f"planets {numbers} carry"
                    sentences.append(
                        f"under {shown_torque(torque)} {what} no load at {words}: the gap that pins and phases "
                        "leave there is larger than the deflection of the teeth"
                    )
        return tuple(sentences)

    notes = findings

    def beside_figures(self) -> dict[str, Any]:
        """Phases, orders, findings and warnings."""
        orders = [
            {
                "order": order.order,
                "stage_um": order.stage,
                "one_path_um": order.one_path,
                "cancelled_in_torsion": order.torsion_cancels,
                "cancelled_in_translation": order.translation_cancels,
            }
            for order in self.orders()
        ]
        return {
            "sun_mesh_phase": self.sun_mesh_phase.tolist(),
            "ring_mesh_phase": self.ring_mesh_phase.tolist(),
            "orders_under_the_last_torque": orders,
            "findings": self.findings(),
            **super().beside_figures(),
        }

    @property
    def scope(self) -> str:
        """Teeth, places of the planets and positions, in words."""
        z_s, z_p, z_r = self.stage.teeth
        degrees = ", ".join(plain(math.degrees(angle)) for angle in self.stage.stage.angles)
        return (
            f"sun {z_s}, planets {z_p} at {degrees} deg, ring {z_r}; the {self.stage.stage.driving} drives; "
            f"meshes at {self.stage.analysis.positions} positions of a pitch, both ends among them; shares at "
            f"{self.dataset.sizes['position']} even positions, a multiple of the planets"
        )

    def rows(self, figures: Sequence[Figures]) -> list[tuple[str, ...]]:
        """Lines of the summary: phases, figures, orders of the mesh."""
        orders = (
            (
                f"  {order.order}{', cancels between equal planets' if order.torsion_cancels else ''}",
                plain(order.stage),
                plain(order.one_path),
            )
            for order in self.orders()
        )
        return [
            ("phases of the sun's meshes", *(f"{phase:z.4f}" for phase in self.sun_mesh_phase)),
            ("phases of the ring's meshes", *(f"{phase:z.4f}" for phase in self.ring_mesh_phase)),
            ("orders that equal planets cancel", ", ".join(map(str, self.neutralised_orders)) or "none"),
            *super().rows(figures),
            ("order of the mesh", "stage [um]", "one path [um]"),
            *orders,
        ]

    def rating(self) -> StageRating:
        """Return safeties and lives of sun, planets and ring, after ISO 6336 and by the local stresses.

        Materials, required safeties, speed and oil are those of the stage: [sun.strength], [planet.strength],
        [ring.strength], [rating], [operation], [lubricant]. Each torque is a load case for itself; under a load
        spectrum of the stage, ``load.case``, the cases are its bins, and their damage adds up.

        Returns
        -------
        loaded_tca.stages.StageRating
            Under a load spectrum a :class:`loaded_tca.stages.StageSpectrumRating`.

        Raises
        ------
        InputError
            With every section that is missing, and as of the rating of a pair.

        Warns
        -----
        AccuracyWarning
            As of the rating of a pair, of both meshes; of a spectrum where stresses between the torques that were
            solved make the damage of a gear wrong by more than 1 %.
        """
        from loaded_tca.stages.rating import stage_rating_of  # which takes results

        return stage_rating_of(self)

    @staticmethod
    def parse(text: str, source: str) -> Stage:
        """The stage of its text."""
        return parse_stage(text, source=source, folder=None)

    @classmethod
    def parts_of(cls, subject: Stage, file: xarray.Dataset, arrays: Mapping[str, Array]) -> dict[str, Any]:  # noqa: ARG003
        """Nothing else, of lengths as the stage has them."""
        sizes = {"planet": len(subject.stage.angles), "torque": len(subject.sun_torques), "axis": 2}
        require(*((file.sizes[name] == size, f"{name}: expected {size}") for name, size in sizes.items()))
        return {}

    @classmethod
    def require_parts(cls, subject: Stage, places: Sequence[Path], parts: Sequence[MeshCycle]) -> None:
        """Refuse mesh cycles of another stage, whatever their strengths and cells, and how they have profile shifts."""
        for place, cycle, scene in zip(places, parts, (subject.sun_scene, subject.ring_scene), strict=True):
            if not _is_of(cycle.scene, scene):
                raise InputError(f"{place}: the mesh cycle of another stage than {STAGE_FILE} beside it")


def _is_of(saved: Scene, scene: CylindricalScene) -> bool:
    """Whether the scene of a saved mesh cycle has the gears of a mesh, their profile shifts given or following."""
    if not isinstance(saved, CylindricalScene) or type(saved) is not type(scene):
        return False
    gears = {
        gear: replace(getattr(saved, gear), strength=None, profile_shift=getattr(scene, gear).profile_shift)
        for gear in GEARS  # strengths are of rating alone
    }
    return replace(saved, analysis=scene.analysis, **gears) == scene and bool(
        np.allclose(saved.profile_shifts, scene.profile_shifts, rtol=0.0, atol=SAME_DISTANCE)
    )
