"""The result of a double helical pair: how both halves share the torque, how far the gears move, and both halves."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from loaded_tca.arrays import GEARS, Array, Indices
from loaded_tca.errors import InputError, require
from loaded_tca.plain import apart, plain
from loaded_tca.results import MeshCycle, Revolution
from loaded_tca.results.declared import CYCLE, Asked, Number, Row, numbers
from loaded_tca.results.figure import Figure
from loaded_tca.results.files import DOUBLE_HELICAL
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.quantities import BEARING_QUANTITIES, SHAFT_ASKED
from loaded_tca.results.result import AnalysisResult, JoinedResult, figures_of
from loaded_tca.results.summary import shown_torque
from loaded_tca.results.tables import FORCES, Columns
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.double_helical import HALVES, DoubleHelicalScene
from loaded_tca.scene.half_shafts import without_other_half
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    import xarray

    from loaded_tca.double_helical.rating import DoubleHelicalRating
    from loaded_tca.double_helical.sensitivities import DoubleHelicalSensitivities

OF_TORQUE = re.compile(r"half_[ab]_under_[^/]*_Nm\.nc")
"""Names of files of mesh cycles under other torques than the largest."""
PAIR_FILE = "double_helical.nc"
"""Name of the file of both halves together."""
PAIR_REVOLUTION_FILE = "double_helical_revolution.nc"
"""Name of the file of both halves over a whole revolution."""
FACES = 1e-3
"""How far the gears may stand from where their faces were analysed, over the width of a half. A motion along the axis
turns a helix into itself, and moves its ends and modifications by as much: 1e-4 of the motion was left in the
transmission error of helical pairs that are crowned by 5 um."""
TORQUE, HALF, OVER_HALVES = ("torque",), ("torque", "half"), (*CYCLE, "half")
NUMBERS = numbers(
    {
        "torque": Number(
            TORQUE, "N mm", "pinion torque of both halves", column="pinion_torque_Nm", label="pinion torque"
        ),
        "pinion_angle": (("position",), "rad", "angle of the pinion phi1, 0 at the pitch point in mid-face of a half"),
        "wheel_base_radius": ((), "mm", "base radius of the wheel"),
        "face_width": ((), "mm", "face width of both halves of the narrower gear, without the groove"),
        "transmission_error": Number(
            CYCLE, "rad", "loaded transmission error, absolute, of both halves together", at_base_circle=True
        ),
        "mesh_stiffness": (
            CYCLE,
            "N/(mm um)",
            "derivative of the force over the face width of both halves with respect to the transmission error",
        ),
        "torque_share": Number(OVER_HALVES, "1", "share of the half in the torque", columns=("half_{}_torque_share",)),
        "axial_motion": Number(
            CYCLE, "mm", "motion of the floating gear along its axis, towards half a", columns=("axial_motion_um",)
        ),
        "axial_force": Number(
            OVER_HALVES, "N", "axial force of the half on the wheel, towards half a", columns=("half_{}_axial_force_N",)
        ),
        "axial_force_left": (CYCLE, "N", "axial force of both halves on the wheel, which its bearings take"),
        "share_error": (CYCLE, "1", "estimated error of the share of a half, between torques that were analysed"),
        "peak_pressure": Number(
            OVER_HALVES, "MPa", "peak contact pressure in the half", columns=("half_{}_peak_pressure_MPa",)
        ),
        "line_load": Number(
            OVER_HALVES,
            "N/mm",
            "largest line load in the half; at a face end mesh-dependent",
            columns=("half_{}_line_load_N_per_mm",),
        ),
        "face_load_factor": (HALF, "1", "face load factor K_Hbeta of the half, under its mean torque; NaN: no load"),
        "face_border": Number(
            (*HALF, "border"),
            "mm",
            "borders of strips of the face, from the middle of the pinion's groove outwards",
            columns=(),
        ),
        "face_load": Number(
            (*HALF, "strip"), "N/mm", "normal force per face width in each strip, mean over the pitch", columns=()
        ),
        "place": Number(
            TORQUE,
            "1",
            "mesh cycles of both halves under the torque: 0 half_a and half_b, from 1 on those of elsewhere",
            columns=(),
            asked=Asked(
                lambda scene, _: len(scene.torques) > 1, "the file does not say which mesh cycles each torque has"
            ),
        ),
        "share_factor": Number(
            TORQUE,
            "1",
            "largest share of a half over an even share",
            label="largest share of a half over an even share",
        ),
    }
)
ROOTS = numbers(
    {"root_tension": ((*HALF, "gear"), "MPa", "largest root tension of a gear in the half, over the pitch")},
    Asked(
        lambda scene, _: scene.analysis.root_stress, "the result has no root stress; set analysis.root_stress = true"
    ),
)
BEARINGS = numbers(BEARING_QUANTITIES, SHAFT_ASKED)
"""Numbers of a double helical pair: those that all have, those of root stress, those of gears on shafts."""


def _of_half(name: str, half: int, row: Row) -> float:
    return float(getattr(row, name)[..., half].max())


def _share(half: int, row: Row) -> float:
    return float(row.torque_share[..., half].mean())


def _root(half: int, gear: int, row: Row) -> float:
    return float(row.root_tension[half, gear])


def _on_bearing(name: str, row: Row) -> float:
    return float(np.linalg.norm(getattr(row, name)[..., :3], axis=-1).max())


FIGURES: dict[str, Figure] = {
    **figures_of({"torque": NUMBERS["torque"]}),
    "transmission_error_peak_to_peak_um": Figure(
        of=lambda row: float(np.ptp(row.result.um_per_rad * row.transmission_error)),
        label="transmission error, peak to peak",
    ),
    **figures_of({"share_factor": NUMBERS["share_factor"]}),
    **{
        f"half_{name}_torque_share": Figure(of=partial(_share, half), label=f"share of half {name} in the torque, mean")
        for half, name in enumerate(HALVES)
    },
    "axial_motion_mean_um": Figure(
        of=lambda row: MICROMETRES * float(row.axial_motion.mean()), label="axial motion towards half a, mean"
    ),
    "axial_motion_span_um": Figure(
        of=lambda row: MICROMETRES * float(np.ptp(row.axial_motion)), label="  over the pitch, peak to peak"
    ),
    "axial_force_left_N": Figure(
        of=lambda row: float(np.abs(row.axial_force_left).max()), label="largest axial force of both halves together"
    ),
    **{
        f"half_{name}_peak_pressure_MPa": Figure(
            of=partial(_of_half, "peak_pressure", half), label=f"peak pressure of half {name}"
        )
        for half, name in enumerate(HALVES)
    },
    **{
        f"half_{name}_line_load_N_per_mm": Figure(
            of=partial(_of_half, "line_load", half),
            label=f"largest line load of half {name}; mesh-dependent at sharp ends",
        )
        for half, name in enumerate(HALVES)
    },
    **{
        f"half_{name}_face_load_factor": Figure(
            of=partial(_of_half, "face_load_factor", half), label=f"face load factor K_Hbeta of half {name}"
        )
        for half, name in enumerate(HALVES)
    },
    **{
        f"half_{name}_{gear}_root_tension_MPa": Figure(
            of=partial(_root, half, number), label=f"root tension of half {name} of the {gear}", needs="root_tension"
        )
        for half, name in enumerate(HALVES)
        for number, gear in enumerate(GEARS)
    },
    **{
        f"{gear}_bearing_force_N": Figure(
            of=partial(_on_bearing, f"{gear}_bearing_force"),
            label=f"largest force on a bearing, {gear}",
            needs=f"{gear}_bearing_force",
        )
        for gear in GEARS
    },
}
"""Key figures by their names."""


class OfHalves(JoinedResult):
    """Result of a double helical pair that joins those of its halves."""

    def along(self, axis: str) -> list[Any]:
        """What counts along an axis: halves by their names, too."""
        return [*HALVES] if axis == "half" else super().along(axis)

    @classmethod
    def require_parts(
        cls, subject: DoubleHelicalScene, places: Sequence[Path], parts: Sequence[MeshCycle | Revolution]
    ) -> None:
        """Refuse results of halves that are not those of a scene, wherever the gear floats to and under any torques."""
        for half, (place, cycle) in enumerate(zip(places, parts, strict=True)):
            torques = [1e-3 * torque for torque in cycle.scene.torques]
            expected, scene = subject.half_scenes(0.0, [torques, torques])[half], cycle.scene
            assert isinstance(scene, CylindricalScene)  # half a pair
            stands = replace(expected.mounting, axial_offset_mm=scene.mounting.axial_offset_mm)
            expected = replace(expected, mounting=stands, load=scene.load, analysis=scene.analysis)
            if _by_itself(scene, expected) != expected:
                what = "mesh cycle" if isinstance(cycle, MeshCycle) else "revolution"
                raise InputError(f"{place}: the {what} of another pair than {cls.FILE} beside it")


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class DoubleHelicalResult(OfHalves):
    """Both halves of a double helical pair over one pitch, under each torque.

    Attributes
    ----------
    scene : DoubleHelicalScene
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``NUMBERS`` with their units, over torque [N mm], position (``pinion_angle`` [rad]) and half.
    half_a, half_b : MeshCycle
        Of each half, with z from the groove outwards, under the torques between which its shares lie; where a floating
        gear stands apart under several torques, or on shafts, those under the largest.
    elsewhere : tuple of (MeshCycle, MeshCycle)
        The same under the other torques: where ``place`` of a torque is 1, the first two. In files named by the largest
        torque of a place, ``half_a_under_400_Nm.nc``.
    """

    KIND: ClassVar = DOUBLE_HELICAL
    WHAT: ClassVar = "the result of a double helical pair"
    TITLE: ClassVar = "Double helical pair"
    NUMBERS: ClassVar = NUMBERS | ROOTS | BEARINGS
    COORDINATES: ClassVar = ("torque", "pinion_angle")
    FIGURES: ClassVar = FIGURES
    FILE: ClassVar = PAIR_FILE
    JSON: ClassVar = "double_helical.json"
    TABLES: ClassVar = {"double_helical.csv": "positions", "double_helical_bearings.csv": "bearings"}
    PARTS: ClassVar = {"half_a": "half_a.nc", "half_b": "half_b.nc"}
    PART: ClassVar = MeshCycle

    scene: DoubleHelicalScene
    dataset: xarray.Dataset
    half_a: MeshCycle
    half_b: MeshCycle
    elsewhere: tuple[tuple[MeshCycle, MeshCycle], ...] = ()

    def __repr__(self) -> str:
        sizes = self.dataset.sizes
        return f"DoubleHelicalResult({sizes['torque']} torques, {sizes['position']} positions)"

    @property
    def halves(self) -> tuple[MeshCycle, MeshCycle]:
        """Mesh cycles of half a and half b."""
        return self.half_a, self.half_b

    @property
    def halves_by_place(self) -> tuple[tuple[MeshCycle, MeshCycle], ...]:
        """Mesh cycles of both halves at each ``place``."""
        return (self.halves, *self.elsewhere)

    @property
    def place_of_torque(self) -> Indices:
        """``place`` (torque,) as indices of ``halves_by_place``."""
        return self.place.astype(int) if self.has("place") else np.zeros(len(self.torque), dtype=int)

    def tables(self) -> dict[str, Callable[[], Columns]]:
        """Figures, positions, and where gears are on shafts the forces on their bearings."""
        of_bearings = {"bearings": self._of_bearings} if self.scene.is_supported else {}
        return {**super().tables(), **of_bearings}

    def _of_bearings(self) -> Columns:
        """A row for each gear, torque and bearing: means of forces and moments over a pitch, and the largest force."""
        rows = []
        for gear in filter(lambda name: self.has(f"{name}_bearing_force"), GEARS):
            bearings = getattr(self.scene, gear).shaft.bearings
            for torque, forces in zip(self.torque, self.values(f"{gear}_bearing_force"), strict=True):
                means = np.apply_along_axis(mean_over_a_pitch, 0, forces) * np.repeat([1.0, 1e-3], 3)
                largest = np.linalg.norm(forces[..., :3], axis=-1).max(axis=0)
                rows += [
                    (gear, 1e-3 * torque, n, bearing.at_mm, *means[n], largest[n]) for n, bearing in enumerate(bearings)
                ]
        heads = "gear", "pinion_torque_Nm", "bearing", "axial_mm", *FORCES, "largest_force_N"
        return Columns(dict(zip(heads, zip(*rows, strict=True), strict=True)), heads[:3])

    def parts(self) -> dict[str, AnalysisResult]:
        """Mesh cycles of both halves under all torques, by the names of their files."""
        names = _files_elsewhere(self.dataset)
        both = zip(names, self.elsewhere, strict=True)
        return {**super().parts(), **{file: cycle for files, of in both for file, cycle in zip(files, of, strict=True)}}

    def outdated(self, directory: Path) -> set[str]:
        """Names of mesh cycles under other torques that an older result has in a directory."""
        there = directory.glob("half_*_Nm.nc") if directory.is_dir() else ()
        return {path.name for path in there if OF_TORQUE.fullmatch(path.name)} - {*self.parts()}

    @property
    def scope(self) -> str:
        """Halves, what floats, positions, in words."""
        geometry = self.scene.geometry
        held = f"the {geometry.floating} floats along its axis"
        if geometry.floating == "none":
            held = "both gears held along the axes"
        if geometry.axial_stiffness_N_per_um > 0.0:
            held += f" on {plain(geometry.axial_stiffness_N_per_um, 6)} N/um"
        widths = " and ".join(plain(self.scene.half_width(gear)) for gear in (self.scene.pinion, self.scene.wheel))
        return (
            f"two halves of {widths} mm, a groove of {plain(geometry.gap_mm)} mm; {held}; "
            f"{self.dataset.sizes['position']} positions of a pitch"
        )

    def notes(self) -> tuple[str, ...]:
        """Sentences on halves that carry nothing, and on torques under which the gear stands apart from both halves."""
        sentences = []
        for shares, torque in zip(self.torque_share, self.torque.tolist(), strict=True):
            for name, share in zip(HALVES, shares.T, strict=True):
                if (share <= 0.0).any():
                    words = "any position" if (share <= 0.0).all() else "some positions"
                    sentences.append(
                        f"under {shown_torque(torque)} half {name} carries no load at {words}: the gap between "
                        "its flanks is larger than the deflection of the other half"
                    )
        return (*sentences, *self.notes_of_places())

    def beside_figures(self) -> dict[str, Any]:
        """Notes and warnings."""
        return {"notes": self.notes(), **super().beside_figures()}

    def notes_of_places(self) -> list[str]:
        """Sentences on torques under which the mesh cycles of both halves are those of another place or other loads."""
        places = self.axial_motion.mean(axis=1)
        largest = int(self.torque.argmax())
        files = {n: " and ".join(names) for n, names in enumerate(_files_elsewhere(self.dataset), start=1)}
        on_shafts = [
            f"half_a and half_b hold the mesh cycles under {shown_torque(self.torque[largest])}, with the shaft loads "
            f"of both halves under this torque; {', '.join(files.values())} hold those under other torques"
        ]
        return (on_shafts if self.scene.is_supported and len(self.torque) > 1 else []) + [
            f"under {shown_torque(torque)} the {self.scene.geometry.floating} stands {plain(way, 3)} mm along its axis "
            f"from its place under {shown_torque(self.torque[largest])}; half_a and half_b hold the mesh cycles at the "
            f"place under {shown_torque(self.torque[largest])}, {files[place]} at the place under "
            f"{shown_torque(torque)}"
            for torque, way, place in zip(
                self.torque.tolist(), (places - places[largest]).tolist(), self.place_of_torque.tolist(), strict=True
            )
            if place and abs(way) > FACES * self.scene.narrow_half
        ]

    def rating(self) -> DoubleHelicalRating:
        """Return safeties, damage and lives of both halves under their shares, and of the whole gear after ISO 6336.

        Each half is rated under the largest of its shares over the pitch with its own load factors; under a load
        spectrum its share is that of each bin. Of the pair the worse half counts.

        Returns
        -------
        loaded_tca.double_helical.DoubleHelicalRating
            ``half_a``, ``half_b`` and ``whole`` with every factor, None of a half that carries nothing under any
            torque; ``flank_safety`` and its sisters over case and gear, ``damage`` and ``life_hours`` over kinds of
            failure, too.

        Raises
        ------
        InputError
            If a section that it needs is missing, as of :meth:`loaded_tca.MeshCycle.rating`.

        Warns
        -----
        AccuracyWarning
            As there, of both halves.
        """
        from loaded_tca.double_helical.rating import double_helical_rating_of  # which takes results

        return double_helical_rating_of(self)

    def sensitivities(self, keys: Sequence[str]) -> DoubleHelicalSensitivities:
        """Return the derivatives with respect to keys of the scene, of both halves together.

        Those of the halves (:meth:`loaded_tca.MeshCycle.sensitivities`) by the chain rule through the share of the
        torque and the axial motion, of which the balance at each position is differentiated; between torques that were
        analysed they are interpolated.

        Parameters
        ----------
        keys : sequence of str
            ``load.pinion_torque_Nm``, ``pair.apex_offset_mm``, mounting errors, those of half b too, and modifications
            of both gears: of both halves, where half b has none of its own, or of ``pinion.half_b``.

        Returns
        -------
        DoubleHelicalSensitivities
            ``transmission_error``, ``peak_to_peak``, ``axial_motion``, ``torque_share``, ``peak_pressure`` and
            ``line_load``, each over keys last.

        Raises
        ------
        InputError
            With every key that is unknown, given twice, or not among these, and where the gear stands elsewhere under
            other torques.
        """
        from loaded_tca.double_helical.sensitivities import double_helical_sensitivities  # which takes results

        return double_helical_sensitivities(self, keys)

    @classmethod
    def parts_of(
        cls,
        subject: DoubleHelicalScene,
        file: xarray.Dataset,
        arrays: Mapping[str, Array],  # noqa: ARG003
    ) -> dict[str, Any]:
        """Nothing else, of lengths as the scene has them."""
        sizes = {"half": len(HALVES), "torque": len(subject.torques), "position": subject.analysis.positions}
        require(*((file.sizes[name] == size, f"{name}: expected {size}") for name, size in sizes.items()))
        return {}

    @classmethod
    def parts_beside(cls, path: Path, subject: DoubleHelicalScene, dataset: xarray.Dataset) -> dict[str, Any]:
        """Mesh cycles of both halves under all torques, of the files beside that of the pair."""
        elsewhere = tuple(cls.read_parts(path, subject, names) for names in _files_elsewhere(dataset))
        return {**super().parts_beside(path, subject, dataset), "elsewhere": elsewhere}


def _files_elsewhere(dataset: xarray.Dataset) -> list[tuple[str, ...]]:
    """Names of the files of both halves at each place from 1 on, by the largest torque there."""
    if "place" not in dataset:  # of one torque, from earlier files
        return []
    place, torques = dataset["place"].to_numpy().astype(int), dataset["torque"].to_numpy()
    largest = [1e-3 * float(torques[place == n].max()) for n in range(1, int(place.max()) + 1)]
    return [tuple(f"half_{half}_under_{text}_Nm.nc" for half in HALVES) for text in apart(largest)]


def _by_itself(scene: CylindricalScene, expected: CylindricalScene) -> CylindricalScene:
    """The scene of a half without the loads of the other half, which ``expected`` has not."""
    for name in GEARS:
        gear, shaft = getattr(scene, name), getattr(expected, name).shaft
        if shaft is not None and gear.shaft is not None:
            scene = replace(scene, **{name: replace(gear, shaft=without_other_half(gear.shaft, shaft))})
    return scene
