"""The result of a stage: shares of the planets over the mesh, motion of the sun, transmission error, both meshes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.errors import InputError, require
from loaded_tca.plain import plain
from loaded_tca.results import MeshCycle
from loaded_tca.results.files import (
    STAGE,
    FilePath,
    Part,
    arrays_of,
    netcdf_of,
    read_dataset,
    replace_together,
    variables_of,
)
from loaded_tca.results.summary import kind_of_edge, shown, shown_torque
from loaded_tca.stages.files import parse_stage
from loaded_tca.stages.kinematics import neutralised
from loaded_tca.stages.sections import Stage

if TYPE_CHECKING:
    import xarray

STAGE_FILE, *MESH_FILES = FILES = "stage.nc", "sun_mesh.nc", "ring_mesh.nc"
"""Names of the files of a result: the stage, and the mesh cycles of its two meshes."""
MOST_ORDERS = 6
CYCLE = "torque", "position"

QUANTITIES: dict[str, Part] = {
    "torque": (("torque",), "N mm", "torque of the sun"),
    "sun_angle": (("position",), "rad", "angle of the sun against the carrier, over one pitch of the sun"),
    "planet": (("planet",), "1", "planet, from 0"),
    "planet_angle": (("planet",), "rad", "angle of the planet on the carrier"),
    "sun_mesh_phase": (("planet",), "1", "phase of the mesh of sun and planet, in mesh cycles"),
    "ring_mesh_phase": (("planet",), "1", "phase of the mesh of planet and ring, in mesh cycles"),
    "sun_base_radius": ((), "mm", "base radius of the sun"),
    "transmission_error": (CYCLE, "rad", "transmission error, counted at the sun"),
    "one_path_transmission_error": (CYCLE, "rad", "the same of planet 0 alone under an even part of the torque"),
    "planet_share": ((*CYCLE, "planet"), "1", "part of the torque that a planet carries"),
    "sun_motion": ((*CYCLE, "axis"), "mm", "motion of the sun's axis in the frame of the carrier"),
    "mesh_load_factor": (("torque",), "1", "mesh load factor K_gamma: the largest share of a planet over an even one"),
    "sun_mesh_peak_pressure": (("torque",), "MPa", "peak pressure of sun and planet under the largest share"),
    "ring_mesh_peak_pressure": (("torque",), "MPa", "peak pressure of planet and ring under the largest share"),
}
ROOTS: dict[str, Part] = {
    "sun_root_tension": (("torque",), "MPa", "root tension of the sun under the largest share"),
    "planet_root_tension_at_sun": (("torque",), "MPa", "root tension of a planet by the sun under the largest share"),
    "planet_root_tension_at_ring": (("torque",), "MPa", "root tension of a planet by the ring under the largest share"),
    "ring_root_tension": (("torque",), "MPa", "root tension of the ring under the largest share"),
}
"""Those of stages that ask for root stress."""
EDGES: dict[str, Part] = {
    f"{mesh}_mesh_edge_pressure": (
        ("torque",),
        "MPa",
        f"pressure at an edge in the {mesh}'s mesh under the largest share, mesh-dependent if sharp; NaN: none reached",
    )
    for mesh in ("sun", "ring")
}
"""Those that results of earlier versions do not have."""
LABELS = {
    "sun_torque_Nm": "sun torque [N m]",
    "mesh_load_factor": "mesh load factor K_gamma",
    "least_planet_share": "least share of a planet in the torque",
    "largest_planet_share": "largest share of a planet in the torque",
    "transmission_error_peak_to_peak_um": "transmission error, peak to peak [um]",
    "one_path_peak_to_peak_um": "  of one path alone [um]",
    "sun_motion_largest_um": "largest motion of the sun [um]",
    "sun_mesh_peak_pressure_MPa": "peak pressure of the sun's mesh [MPa]",
    "sun_mesh_edge_pressure_MPa": "  {edge} [MPa]",
    "ring_mesh_peak_pressure_MPa": "peak pressure of the ring's mesh [MPa]",
    "ring_mesh_edge_pressure_MPa": "  {edge} [MPa]",
    **{f"{name}_MPa": f"{text.removesuffix(' under the largest share')} [MPa]" for name, (_, _, text) in ROOTS.items()},
}
"""Lines of the summary by the names of key figures; {edge} stands for the kind of edge."""
COORDINATES = "torque", "sun_angle", "planet"


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
class StageResult:
    """Planets of a stage over one pitch of the sun, under each torque.

    Attributes
    ----------
    stage : Stage
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``QUANTITIES`` with their units, over torque [N mm], position (``sun_angle`` [rad]) and planet.
    sun_mesh, ring_mesh : MeshCycle
        Of one planet with sun and ring, under torques from a small part of an even share to the whole.
    """

    stage: Stage
    dataset: xarray.Dataset
    sun_mesh: MeshCycle
    ring_mesh: MeshCycle

    def __repr__(self) -> str:
        sizes = self.dataset.sizes
        return f"StageResult({sizes['planet']} planets, {sizes['torque']} torques, {sizes['position']} positions)"

    def __getattr__(self, name: str) -> Array:
        """Values of a quantity of the dataset."""
        if name.startswith("_") or name not in {**QUANTITIES, **EDGES, **ROOTS}:
            raise AttributeError(f"StageResult has no {name}")
        return np.asarray(self.dataset[name].values)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences of the accuracy warnings of both meshes, under loads up to the largest share of a planet."""
        return tuple(str(self.dataset.attrs.get("warnings", "")).splitlines())

    def error_um(self, torque: int, *, one_path: bool = False) -> Array:
        """Transmission error (n,) [um] at the base circle of the sun, of the stage or of one planet alone."""
        name = "one_path_transmission_error" if one_path else "transmission_error"
        return np.asarray(1e3 * self.dataset[name].values[torque] * float(self.dataset["sun_base_radius"]))

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

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Figures of each torque, by names that end in their unit."""
        figures = []
        for t, torque in enumerate(self.torque.tolist()):
            shares = self.planet_share[t]
            row = {
                "sun_torque_Nm": 1e-3 * torque,
                "mesh_load_factor": float(self.mesh_load_factor[t]),
                "least_planet_share": float(shares.min()),
                "largest_planet_share": float(shares.max()),
                "transmission_error_peak_to_peak_um": float(np.ptp(self.error_um(t))),
                "one_path_peak_to_peak_um": float(np.ptp(self.error_um(t, one_path=True))),
                "sun_motion_largest_um": 1e3 * float(np.hypot(*self.sun_motion[t].T).max()),
            }
            for mesh in ("sun_mesh", "ring_mesh"):
                row[f"{mesh}_peak_pressure_MPa"] = float(getattr(self, f"{mesh}_peak_pressure")[t])
                edge = f"{mesh}_edge_pressure"
                row[f"{edge}_MPa"] = float(getattr(self, edge)[t]) if edge in self.dataset else math.nan
            figures.append(
                row | {f"{name}_MPa": float(getattr(self, name)[t]) for name in ROOTS if name in self.dataset}
            )
        return tuple(figures)

    def kind_of_edge(self, name: str) -> str:
        """At which kind of edge a mesh has its edge pressure, of the name of the figure; "" where it reaches none."""
        mesh = self.sun_mesh if name.startswith("sun") else self.ring_mesh
        figures = [row for row in mesh.key_figures() if math.isfinite(row["edge_pressure_MPa"])]
        known = any(math.isfinite(row[name]) for row in self.key_figures())
        return kind_of_edge(figures) if figures and known else ""

    def known_figures(self) -> dict[str, str]:
        """Labels of the key figures that a table has, by their names: without edges where none is reached."""
        labels = {name: LABELS[name] for name in self.key_figures()[0]}
        edges = {name: self.kind_of_edge(name) for name, label in labels.items() if "{edge}" in label}
        return {name: label.format(edge=edges.get(name)) for name, label in labels.items() if edges.get(name) != ""}

    def findings(self) -> tuple[str, ...]:
        """Sentences on planets that carry nothing: under which torque, and whether at all positions."""
        sentences = []
        for shares, torque in zip(self.planet_share, self.torque.tolist(), strict=True):
            idle = shares <= 0.0
            for words, planets in (("all", idle.all(axis=0)), ("some", idle.any(axis=0) & ~idle.all(axis=0))):
                numbers = ", ".join(map(str, np.flatnonzero(planets).tolist()))
                if numbers:
                    what = f"planet {numbers} carries" if planets.sum() == 1 else f"planets {numbers} carry"
                    sentences.append(
                        f"under {shown_torque(torque)} {what} nothing at {words} positions: pins and phases are "
                        "farther apart than the teeth give way"
                    )
        return tuple(sentences)

    def to_table(self) -> dict[str, list[float]]:
        """Columns of a table with a row for each torque and position."""
        columns: dict[str, list[float]] = {}
        planets, positions = self.dataset.sizes["planet"], self.dataset.sizes["position"]
        for t, torque in enumerate(self.torque.tolist()):
            values = {
                "sun_torque_Nm": np.full(positions, 1e-3 * torque),
                "sun_angle_deg": np.degrees(self.sun_angle),
                "transmission_error_arcsec": np.degrees(self.transmission_error[t]) * 3600.0,
                "transmission_error_um": self.error_um(t),
                **{f"planet_{i}_share": self.planet_share[t, :, i] for i in range(planets)},
                "sun_motion_x_um": 1e3 * self.sun_motion[t, :, 0],
                "sun_motion_y_um": 1e3 * self.sun_motion[t, :, 1],
            }
            for name, column in values.items():
                columns.setdefault(name, []).extend(column.tolist())
        return columns

    def summary(self) -> str:
        """The figures as a text, a line each and a column for each torque."""
        z_s, z_p, z_r = self.stage.teeth
        figures = self.key_figures()
        degrees = ", ".join(plain(math.degrees(angle)) for angle in self.stage.stage.angles)
        lines = [
            *([self.stage.title] if self.stage.title else []),
            f"sun {z_s}, planets {z_p} at {degrees} deg, ring {z_r}; the {self.stage.stage.driving} drives; "
            f"{self.dataset.sizes['position']} positions of a pitch",
            _line("phases of the sun's meshes", *(f"{phase:z.4f}" for phase in self.sun_mesh_phase)),
            _line("phases of the ring's meshes", *(f"{phase:z.4f}" for phase in self.ring_mesh_phase)),
            _line("orders that equal planets cancel", ", ".join(map(str, self.neutralised_orders)) or "none"),
        ]
        lines += [
            _line(label, *(shown(row[name], name) for row in figures)) for name, label in self.known_figures().items()
        ]
        lines.append(_line("order of the mesh", "stage [um]", "one path [um]"))
        lines += [
            _line(
                f"  {one.order}{', cancels between equal planets' if one.torsion_cancels else ''}",
                plain(one.stage),
                plain(one.one_path),
            )
            for one in self.orders()
        ]
        notes = [f"note: {sentence}" for sentence in self.findings()]
        return "\n".join([*lines, *notes, *(f"warning: {sentence}" for sentence in self.warnings)])

    @checked
    def save(self, directory: FilePath) -> tuple[Path, ...]:
        """Write ``stage.nc``, ``sun_mesh.nc`` and ``ring_mesh.nc`` into a directory, all or none.

        Raises
        ------
        InputError
            If they cannot be written.
        """
        return replace_together(directory, self.contents())

    def contents(self) -> dict[str, bytes | bytearray]:
        """Names and contents of the files that ``save`` writes."""
        about = {"kind": STAGE, "title": self.stage.title, "stage_toml": self.stage.to_toml()}
        content = netcdf_of(self.dataset.assign_attrs(about))
        return dict(zip(FILES, (content, self.sun_mesh.to_netcdf(), self.ring_mesh.to_netcdf()), strict=True))

    @classmethod
    @checked
    def load(cls, directory: FilePath) -> StageResult:
        """Read the files that ``save`` wrote into a directory.

        Parameters
        ----------
        directory : str or path
            The directory, or the file ``stage.nc`` in it.

        Raises
        ------
        InputError
            If one cannot be read, is damaged, or is no such file.
        """
        place = Path(directory)
        place = place if place.is_dir() or place.name != STAGE_FILE else place.parent
        path = place / STAGE_FILE
        file = read_dataset(path)
        if file.attrs.get("kind") != STAGE:
            raise InputError(f"{path}: not the result of a stage")
        try:
            stage = parse_stage(str(file.attrs.get("stage_toml", "")), source="stage_toml", folder=None)
            edges = {name: part for name, part in EDGES.items() if name in file}
            arrays = arrays_of(file, {**QUANTITIES, **edges, **(ROOTS if stage.analysis.root_stress else {})})
            sizes = {"planet": len(stage.stage.angles), "torque": len(stage.sun_torques), "axis": 2}
            require(*((file.sizes[name] == size, f"{name}: expected {size}") for name, size in sizes.items()))
        except InputError as error:
            raise InputError([f"{path}: not the result of a stage", *error.problems]) from None
        cycles = [MeshCycle.load(place / name) for name in MESH_FILES]
        for name, cycle, scene in zip(MESH_FILES, cycles, (stage.sun_scene, stage.ring_scene), strict=True):
            if replace(cycle.scene, analysis=scene.analysis) != scene:
                raise InputError(f"{place / name}: the mesh cycle of another stage than {STAGE_FILE} beside it")
        about = {
            name: file.attrs[name] for name in ("version", "date", "warnings", "mesh_warnings") if name in file.attrs
        }
        return cls(stage=stage, dataset=stage_dataset(arrays, **about), sun_mesh=cycles[0], ring_mesh=cycles[1])


def _line(label: str, *cells: str) -> str:
    return f"{label:<44}" + "".join(f"{cell:>16}" for cell in cells)


def stage_dataset(arrays: dict[str, Array], **about: str) -> xarray.Dataset:
    """Dataset of the arrays of ``QUANTITIES``, and of ``EDGES`` and ``ROOTS`` where they are known."""
    import xarray

    parts = {name: part for name, part in {**QUANTITIES, **EDGES, **ROOTS}.items() if name in arrays}
    return xarray.Dataset(variables_of(parts, arrays), attrs=about).set_coords(COORDINATES)
