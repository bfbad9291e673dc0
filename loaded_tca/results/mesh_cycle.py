"""The result of an analysis: what the tooth pairs carry over the positions of a pitch, under each torque."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import Array
from loaded_tca.compliance.torsion import body_torsion
from loaded_tca.errors import InputError, require
from loaded_tca.loaded.sensitivity import LoadedStates
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.results.dynamics import dynamics_of
from loaded_tca.results.files import Buffer, FilePath, Part, arrays_of, netcdf_of, read_dataset, replacing, variables_of
from loaded_tca.results.key_figures import key_figures
from loaded_tca.results.pressure_map import MAP_PARTS, SIZES, Maps, maps_from, stacked_maps
from loaded_tca.results.root_stress import ROOT_PARTS, RootStressMap, not_asked, root_stress_maps
from loaded_tca.results.sensitivities import Sensitivities, sensitivities
from loaded_tca.results.summary import signed, summary_text
from loaded_tca.scene import Scene, parse_scene
from loaded_tca.unloaded import ContactPath
from loaded_tca.unloaded.harmonics import harmonic_coefficients

if TYPE_CHECKING:
    import xarray

CYCLE = ("torque", "position")
PAIRS = (*CYCLE, "pair")

QUANTITIES: dict[str, Part] = {
    "torque": (("torque",), "N mm", "pinion torque"),
    "pair": (("pair",), "1", "tooth pair: 0 is in contact at the pitch point at phi1 = 0, +1 follows it"),
    "pinion_angle": (("position",), "rad", "angle of the pinion phi1"),
    "wheel_base_radius": ((), "mm", "base radius of the wheel"),
    "face_width": ((), "mm", "common face width"),
    "max_pressure": ((), "MPa", "cap on the pressure; NaN: elastic"),
    "unloaded_transmission_error": (("position",), "rad", "unloaded transmission error, absolute"),
    "face_load_factor": (("torque",), "1", "face load factor K_Hbeta, from 30 strips of the face"),
    "transverse_load_factor": (("torque",), "1", "transverse load factor K_Halpha; NaN for bevel gears"),
    "transmission_error": (CYCLE, "rad", "loaded transmission error, absolute"),
    "mesh_stiffness": (CYCLE, "N/(mm um)", "tangent of the force over the face width to the transmission error"),
    "secant_stiffness": (CYCLE, "N/(mm um)", "force over the face width, over the transmission error it adds"),
    "loaded_pairs": (CYCLE, "1", "number of tooth pairs under load"),
    "load_share": (PAIRS, "1", "share of the tooth pair in the torque"),
    "normal_force": (PAIRS, "N", "normal force on the tooth pair"),
    "peak_pressure": (
        PAIRS,
        "MPa",
        "peak contact pressure; where the contact reaches a sharp edge or a relief start, the largest of its slices",
    ),
    "edge_pressure": (
        PAIRS,
        "MPa",
        "largest pressure at an edge; NaN where none is reached, and at rounded ones that cannot hold the largest of "
        "their torque unless all are asked for",
    ),
    "edge_is_rounded": (PAIRS, "1", "whether that edge is rounded; the pressure at a sharp one is mesh-dependent"),
    "edge_pressure_error": (PAIRS, "1", "estimated relative error of the pressure at a rounded edge by its columns"),
    "edge_radius": (PAIRS, "mm", "radius on the pinion of the edge pressure"),
    "edge_axial": (PAIRS, "mm", "axial coordinate on the pinion of the edge pressure"),
    "central_pressure": (
        PAIRS,
        "MPa",
        "contact pressure beside the unloaded contact point, mesh-dependent where that is on a sharp edge",
    ),
    "peak_radius": (PAIRS, "mm", "radius on the pinion of the peak pressure"),
    "peak_axial": (PAIRS, "mm", "axial coordinate on the pinion of the peak pressure"),
    "hertz_pressure": (
        PAIRS,
        "MPa",
        "peak pressure after Hertz at the contact point or of the line; NaN where Hertz does not hold",
    ),
    "hertz_semi_minor": (PAIRS, "mm", "half width across the contact after Hertz"),
    "hertz_semi_major": (PAIRS, "mm", "half length of the Hertz ellipse, or of the loaded line"),
    "contact_width": (PAIRS, "mm", "full width of the contact across, from the pressure map"),
    "contact_length": (PAIRS, "mm", "full length of the contact, from the pressure map, but not beyond the face"),
    "line_load": (PAIRS, "N/mm", "largest force per length along the contact; at a face end mesh-dependent"),
    "line_load_ratio": (PAIRS, "1", "largest line load over the force spread evenly along the whole face"),
    "contact_deformation": (PAIRS, "mm", "approach of the two flanks as half-spaces, along the normal"),
    "tooth_deflection": (PAIRS, "mm", "deflection of the teeth and bodies along the normal"),
    "on_edge": (PAIRS, "1", "whether the contact reaches an edge of a flank"),
    "on_relief_start": (PAIRS, "1", "whether the start of a linear relief lies in the contact"),
    "cells_across": (PAIRS, "1", "cells of the grid across the contact"),
    "cells_along": (PAIRS, "1", "cells of the grid along the contact"),
    "discretisation_error": (
        PAIRS,
        "1",
        "estimated relative error of the peak pressure by the grid, from the two finest; NaN where cells are given, "
        "and without load",
    ),
    "iterations": (PAIRS, "1", "iterations of the contact solver"),
    "residual": (PAIRS, "1", "residual of the contact solver"),
}
"""Name in ``MeshCycle.dataset`` -> dimensions, unit, long name."""
COORDINATES = ("torque", "pinion_angle", "pair")

OF_THE_PEAK = frozenset(
    {"peak_pressure", "peak_radius", "peak_axial", "on_edge", "on_relief_start"}
    | {"cells_across", "cells_along", "discretisation_error", "iterations", "residual"}
)
"""Numbers whose value at a position is that of the pair with the highest peak pressure."""
OF_THE_EDGE = frozenset({"edge_pressure", "edge_is_rounded", "edge_pressure_error", "edge_radius", "edge_axial"})

PATH_PARTS: dict[str, Part] = {
    "pinion_angle": ((), "rad", "angle of the pinion phi1"),
    "wheel_angle": ((), "rad", "unloaded angle of the wheel phi2"),
    "transmission_error": ((), "rad", "unloaded transmission error, absolute"),
    "point": (("vector",), "mm", "unloaded contact point in the fixed frame"),
    "normal": (("vector",), "1", "unit normal out of the pinion"),
    "pinion_radius": ((), "mm", "radius of the contact point on the pinion"),
    "pinion_axial": ((), "mm", "axial coordinate of the contact point on the pinion"),
    "wheel_radius": ((), "mm", "radius of the contact point on the wheel"),
    "wheel_axial": ((), "mm", "axial coordinate of the contact point on the wheel"),
    "pinion_lever": ((), "mm", "torque of a unit normal force about the axis of the pinion"),
    "wheel_lever": ((), "mm", "torque of a unit normal force about the axis of the wheel"),
    "in_contact": ((), "1", "whether the tooth pair is in contact"),
    "on_edge": ((), "1", "whether the unloaded contact lies on an edge of a flank"),
    "on_relief_start": ((), "1", "whether the unloaded contact lies on the start of a linear relief"),
    "on_line": ((), "1", "whether the unloaded contact is a line"),
    "line_ends": (("end", "vector"), "mm", "ends of the line in the fixed frame"),
    "edges": (("edge",), "1", "edges that hold the point, pinion then wheel: tip, root, lower (toe), upper (heel)"),
    "iterations": ((), "1", "Newton steps of the unloaded contact"),
    "residual": ((), "1", "sine of the angle between the two normals"),
}
"""Parts of a contact path; each has the dimension position before its own."""

IN_FILES: dict[str, Part] = {
    **{f"path_{name}": (("path", "position", *own), unit, text) for name, (own, unit, text) in PATH_PARTS.items()},
    **{f"map_{name}": ((*PAIRS, *own), unit, text) for name, (own, unit, text) in MAP_PARTS.items()},
}
"""What a file has beside ``QUANTITIES``: the paths, that of the leading contact before those of the pairs; the maps."""


ABOUT = ("version", "date", "warnings")
"""Attributes of the dataset: version of the package, date and accuracy warnings of the analysis, a line each."""


def dataset_of(arrays: Mapping[str, Any], **about: str) -> xarray.Dataset:
    """Make the dataset of a mesh cycle of the arrays of all ``QUANTITIES`` and the attributes of ``ABOUT``.

    Those of ``ROOT_PARTS`` are part of it where there are any.
    """
    import xarray

    variables = variables_of(QUANTITIES | {name: part for name, part in ROOT_PARTS.items() if name in arrays}, arrays)
    coordinates = {name: variables.pop(name) for name in COORDINATES}
    return xarray.Dataset(variables, coordinates, about)


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshCycle:
    """Loaded contact over the positions of a pitch, under each torque.

    Every name of ``QUANTITIES`` and, with root stress, of ``ROOT_PARTS`` is an attribute too: ``result.peak_pressure``
    is the NumPy array of ``result.dataset["peak_pressure"]``, with the axes (torque, position, pair) whatever their
    lengths. NaN where a pair carries nothing, but its ``normal_force`` and ``load_share``, which are zero; flags and
    counts are 0 there. What is computed from these numbers is computed when it is asked for, so that it follows what is
    written into the dataset.

    Attributes
    ----------
    scene : Scene
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``QUANTITIES`` with their units, over torque [N mm], position (``pinion_angle`` [rad]) and pair.
    path : ContactPath
        The unloaded contact; where pairs share the load, of the pair that leads, in the angles of the gears.
    paths : tuple of ContactPath
        Unloaded contact of each pair, in the angles of the gears; NaN where it is out of reach.
    maps : tuple of tuple of tuple of PressureMap or None
        ``maps[torque][position][pair]`` by index; None where a pair carries nothing.
    states : (Scene, LoadedStates) or None
        The contact problems behind the maps, of all positions torque by torque, for sensitivities, and the scene they
        belong to; None if the result comes from a file, which does not keep them: they are made again when needed.
    """

    scene: Scene
    dataset: xarray.Dataset
    path: ContactPath
    paths: tuple[ContactPath, ...]
    maps: Maps
    states: tuple[Scene, LoadedStates] | None = field(default=None, repr=False, compare=False)

    def __getattr__(self, name: str) -> Any:
        if name in (*ROOT_PARTS, "root_stress") and not self.has_root_stress:
            raise not_asked(name)
        if name not in (*QUANTITIES, *ROOT_PARTS) or name not in self.dataset:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        values = self.dataset[name].values
        return values if values.ndim else values.item()

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *QUANTITIES, *(name for name in ROOT_PARTS if name in self.dataset)]

    def __repr__(self) -> str:
        peak = np.nanmax(self.peak_pressure, initial=0.0)
        torques = f"{len(self.torque)} torque" + "s" * (len(self.torque) > 1)
        return f"MeshCycle({len(self.path)} positions, {torques}, peak {peak:.6g} MPa)"

    @property
    def version(self) -> str:
        """Version of the package that made the result."""
        return str(self.dataset.attrs["version"])

    @property
    def date(self) -> str:
        """Date of the analysis after ISO 8601, in UTC; empty if the file of the result does not have it."""
        return str(self.dataset.attrs.get("date", ""))

    @property
    def warnings(self) -> tuple[str, ...] | None:
        """Sentences of the accuracy warnings of the analysis; None if the file of the result does not have them."""
        told = self.dataset.attrs.get("warnings")
        return None if told is None else tuple(str(told).splitlines())

    @cached_property
    def gear_pair(self) -> GearPair:
        """The gears of the scene in space."""
        return self.scene.pair()

    @property
    def has_root_stress(self) -> bool:
        """Whether the analysis found root stress: its scene asked for it."""
        return "root_tension" in self.dataset

    @cached_property
    def root_stress(self) -> tuple[RootStressMap, RootStressMap]:
        """Root stress of pinion and wheel over fillet and face: at the largest tension, and envelopes over the mesh.

        Raises
        ------
        NotAskedError
            If the scene does not ask for root stress.
        """
        return root_stress_maps(self)  # without any, this ends as an AttributeError in __getattr__, which says why

    def without_body_torsion(self, stiffness: float) -> float:
        """Mesh stiffness without the twist of the gear bodies, to be compared with c_gamma of ISO 6336-1.

        Parameters
        ----------
        stiffness : float [N/(mm um)]
            With it, for instance a mean of ``mesh_stiffness``.

        Returns
        -------
        float [N/(mm um)]
            NaN where teeth do not bend.
        """
        if self.scene.analysis.compliance == "contact" or not stiffness > 0.0:
            return math.nan
        return 1.0 / (1.0 / stiffness - 1e3 * self.face_width * sum(body_torsion(self.gear_pair)))

    @property
    def bending(self) -> str:
        """Whether teeth bend, in words."""
        return "teeth do not bend" if self.scene.analysis.compliance == "contact" else "teeth bend"

    @property
    def peak_column(self) -> NDArray[np.int_]:
        """Index of the pair with the highest peak pressure, (torque, position)."""
        return _column_of_largest(self.peak_pressure)

    def at_position(self, name: str) -> Array:
        """Return one number for each position, that of one of its tooth pairs: (torque, position).

        Numbers of ``OF_THE_PEAK`` belong to the pair with the highest peak pressure, those of the edge to the pair with
        the highest edge pressure, all others to the pair with the largest force: a tip corner may have the highest
        edge pressure under next to none.

        Parameters
        ----------
        name : str
            Of an array (torque, position, pair).

        Raises
        ------
        InputError
            For any other name.
        """
        if not isinstance(name, str) or name not in self.dataset or self.dataset[name].dims != PAIRS:
            known = f"; result.{name} has its numbers as they are" if name in (*QUANTITIES, *ROOT_PARTS) else ""
            raise InputError(f"name: {name!r} is no array (torque, position, pair) of the result{known}")
        values = self.dataset[name].values
        if name in OF_THE_PEAK:
            columns = self.peak_column
        elif name in OF_THE_EDGE:
            columns = _column_of_largest(self.edge_pressure)
        else:  # without load, of the pair in contact
            columns = np.where(np.isnan(self.peak_pressure), -1.0, self.normal_force).argmax(axis=-1)
        return np.take_along_axis(values, columns[..., None], axis=-1)[..., 0]

    def harmonics(self, count: int) -> Array:
        """Return the amplitudes of the orders 1 to ``count`` of the tooth mesh of the loaded transmission error.

        Parameters
        ----------
        count : int
            Of orders, at least 1.

        Returns
        -------
        (m, count) array [rad]
            For each torque; NaN where one pair carries the whole load, since its error has no period, and for orders
            of which the positions are too few.
        """
        return np.abs(self._harmonic_coefficients(count))

    def harmonic_phases(self, count: int) -> Array:
        """Return the phases of the orders 1 to ``count`` of the tooth mesh of the loaded transmission error.

        TE(phi1) = mean + sum of amplitude_k cos(k z1 phi1 + phase_k), with the amplitudes of ``harmonics``. Phases
        count from the pinion angle 0, as those of the unloaded ``MeshPath.harmonics`` do.

        Parameters
        ----------
        count : int
            Of orders, at least 1.

        Returns
        -------
        (m, count) array [rad]
            From -pi to pi; NaN where the amplitude is. That of an amplitude near zero is rounding.
        """
        return np.angle(self._harmonic_coefficients(count))

    def _harmonic_coefficients(self, count: int) -> NDArray[np.complex128]:
        """Complex amplitudes (m, count) [rad] of the orders, phases from the pinion angle 0."""
        if not isinstance(count, int | np.integer) or count < 1:
            raise InputError(f"count: {count!r} is not a whole number from 1 on")
        periodic = self.scene.analysis.load_sharing
        begin = float(self.pinion_angle[0]) / self.gear_pair.pitch
        curves = self.transmission_error[:, : None if periodic else 0]
        return np.stack([harmonic_coefficients(curve, count, begin) for curve in curves])

    def sensitivities(self, keys: Sequence[str]) -> Sensitivities:
        """Return the derivatives with respect to keys of the scene, all from one linear problem for each state.

        The loaded transmission error changes by the mean of the material removed over the contacts, weighted with the
        growth of the pressure with the torque. See :mod:`loaded_tca.loaded.sensitivity`.

        Parameters
        ----------
        keys : sequence of str
            As of ``scene.with_changes``: of the modifications of either gear, of machine settings and cutters, of
            mounting errors, and ``load.pinion_torque_Nm``, which stands for the torque of each row.

        Returns
        -------
        Sensitivities

        Raises
        ------
        InputError
            With every key that is unknown, given twice, or that the scene cannot vary.
        ConvergenceError
            If a linear problem is not solved to its tolerance.
        """
        return sensitivities(self, keys)

    def to_dynamics(self) -> xarray.Dataset:
        """Return curves over the pitch and their Fourier coefficients in SI units, for models of gear dynamics.

        Every name ends in its unit; ``dataset[name].attrs`` say what it is, and ``dataset.attrs["conventions"]`` how
        angles, phases and signs count. A curve is x(phi1) = amplitude_0 + sum of amplitude_k cos(k z1 phi1 + phase_k),
        with the orders and phases of ``harmonics`` and ``harmonic_phases``.

        Returns
        -------
        xarray.Dataset
            Over ``pinion_torque_Nm`` and ``mesh_phase``, from 0 and without the repeated end of the pitch:
            ``transmission_error_m`` and ``_rad``, ``mesh_stiffness_N_per_m``, ``torsional_stiffness_Nm_per_rad``,
            ``loaded_pairs``, ``normal_force_per_torque_N_per_Nm``; over the torque and ``order``, from 0:
            ``transmission_error_amplitude_m``, ``transmission_error_phase_rad``, and so on; base radii, numbers of
            teeth; of cylindrical gears ``working_pressure_angle_rad`` and ``pinion_base_helix_angle_rad``, whose
            sign is the hand.

        Raises
        ------
        InputError
            If there is one position alone, or no load sharing: the error of one tooth pair has no period.

        Examples
        --------
        >>> from loaded_tca import analyse, read_scene
        >>> changes = {"analysis.positions": 5, "analysis.torques_Nm": [20.0], "analysis.compliance": "contact"}
        >>> scene = read_scene("examples/scenes/mesh_cycle_spur.toml").with_changes(changes)
        >>> dynamics = analyse(scene).to_dynamics()
        >>> dynamics.mesh_phase.values, dynamics.order.values
        (array([0.  , 0.25, 0.5 , 0.75]), array([0, 1], dtype=int32))
        """
        return dynamics_of(self)

    def peak_contact(self, torque: int, *, where_hertz_holds: bool = False) -> tuple[int, int] | None:
        """Return indices of position and pair with the highest peak pressure; None if no contact qualifies."""
        known = np.isfinite(self.hertz_pressure) | (not where_hertz_holds)
        return _place_of_largest(np.where(known, self.peak_pressure, math.nan)[torque])

    def edge_contact(self, torque: int) -> tuple[int, int] | None:
        """Return indices of position and pair with the highest edge pressure; None where no edge is reached."""
        return _place_of_largest(self.edge_pressure[torque])

    def most_loaded_contact(self, torque: int) -> tuple[int, int] | None:
        """Return indices of position and pair with the largest force; None if nothing is in contact."""
        return _place_of_largest(np.where(np.isnan(self.peak_pressure), math.nan, self.normal_force)[torque])

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of the whole cycle for each torque, by names that end in their unit.

        ``peak_pressure_MPa`` is the highest ``peak_pressure``; "at_peak": at its position; "at_edge": at that of the
        highest edge pressure; "there": at that of the highest peak where Hertz holds.
        Means are over the positions. NaN: not known.
        """
        return tuple(key_figures(self, torque) for torque in range(len(self.torque)))

    def summary(self) -> str:
        """Return the key figures in the engineer's units, one column per torque, and the warnings of the analysis."""
        return summary_text(self.scene.title, self.scope, self.key_figures(), self.warnings or ())

    @property
    def scope(self) -> str:
        """Positions, tooth pairs that carry the load, and whether teeth bend, in words."""
        first, last = (math.degrees(self.pinion_angle[end]) for end in (0, -1))
        count = len(self.path)
        where = f"{count} positions, pinion angle {first:.4g} to {last:.4g} deg" if count > 1 else "1 position"
        if self.scene.analysis.load_sharing:
            numbers = [signed(number) for number in self.pair.tolist()]
            carrying = f"load shared by the tooth pairs {', '.join(numbers)}, at most {self.loaded_pairs.max()} at once"
            if len(numbers) == 1:
                carrying = f"tooth pair {numbers[0]} alone carries the load (load sharing on)"
        else:
            carrying = "one tooth pair carries the whole load (load sharing off)"
        return f"{where}; {carrying}; {self.bending}"

    def save(self, path: FilePath) -> None:
        """Write everything to a NetCDF-3 file, whole or not at all; ``load`` reads it back unchanged.

        Raises
        ------
        InputError
            If the file cannot be written, NetCDF-3 has no type for what was added to the dataset, or the scene asks for
            root stress that the result does not have.
        """
        content = self.to_netcdf()
        with replacing(path) as temporary:
            temporary.write_bytes(content)

    def to_netcdf(self) -> Buffer:
        """Return the bytes of the file that ``save`` writes, with the same errors."""
        if self.scene.analysis.root_stress and not self.has_root_stress:
            raise not_asked("scene")
        paths = (self.path, *self.paths)
        arrays = {f"path_{name}": np.stack([getattr(one, name) for one in paths]) for name in PATH_PARTS}
        arrays |= {f"map_{name}": stack for name, stack in stacked_maps(self.maps).items()}
        whole = self.dataset.assign(variables_of(IN_FILES, arrays))
        return netcdf_of(whole.assign_attrs(title=self.scene.title, scene_toml=self.scene.to_toml()))

    @classmethod
    def load(cls, path: FilePath) -> MeshCycle:
        """Read a file that ``save`` wrote.

        Raises
        ------
        InputError
            If it cannot be read, is damaged, or is no such file.
        """
        file = read_dataset(path)
        kind = file.attrs.get("kind")
        if kind in ("study", "design"):
            reader = f"loaded_tca.studies.load_{kind}"
            raise InputError(f"{path}: a {kind}, not the result of a mesh cycle; read it with {reader}")
        if not IN_FILES.keys() & file.variables.keys():  # as of sensitivities, rather than a line for all it lacks
            raise InputError(f"{path}: not the result of a mesh cycle: it has neither paths of contact nor maps")
        try:
            scene = parse_scene(str(file.attrs.get("scene_toml", "")), source="scene_toml", folder=None)
            in_dataset = QUANTITIES | (ROOT_PARTS if scene.analysis.root_stress or "root_tension" in file else {})
            arrays = arrays_of(file, in_dataset | IN_FILES)
            expected = {**SIZES, "end": 2, "edge": 8, "path": 1 + file.sizes["pair"]}
            checks = [(name, file.sizes[name] == size, f"{size}") for name, size in expected.items()]
            checks += [(name, file.sizes[name] > 0, "at least 1") for name in PAIRS]
            require(*((holds, f"{name}: {file.sizes[name]} long, expected {size}") for name, holds, size in checks))
        except InputError as error:
            raise InputError([f"{path}: not the result of a mesh cycle", *error.problems]) from None
        about = {"version": "", **{name: str(file.attrs[name]) for name in ABOUT if name in file.attrs}}
        added = {name: file.variables[name] for name in file.data_vars if name not in in_dataset | IN_FILES}
        leading, *paths = (
            ContactPath(**{entry.name: arrays[f"path_{entry.name}"][k] for entry in fields(ContactPath)})
            for k in range(expected["path"])
        )
        return cls(
            scene=scene,
            dataset=dataset_of(arrays, **about).assign(added),
            path=leading,
            paths=tuple(paths),
            maps=maps_from({name: arrays[f"map_{name}"] for name in MAP_PARTS}),
        )


def _column_of_largest(values: Array) -> NDArray[np.int_]:
    """Index along the last axis of the largest finite value; the first one where none is."""
    return np.asarray(np.where(np.isfinite(values), values, -math.inf).argmax(axis=-1))


def _place_of_largest(values: Array) -> tuple[int, int] | None:
    """Indices of the largest finite value of an array (positions, pairs); None if there is none."""
    if not np.isfinite(values).any():
        return None
    position, pair = np.unravel_index(int(np.nanargmax(values)), values.shape)
    return int(position), int(pair)
