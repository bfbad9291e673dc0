"""The result of a whole revolution: every tooth at its own place, what it carries, and the orders of both gears.

Figures of single-flank testing (ISO 1328-1, ISO/TR 10064-1): the total composite deviation is the span of the
transmission error over the revolution, the tooth-to-tooth deviation its largest span within a pitch; both as lengths
at the base circle of the wheel.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array, index_checks
from loaded_tca.errors import InputError, require
from loaded_tca.results.dynamics import PARTS, TORQUE, teeth_and_radii
from loaded_tca.results.files import (
    REVOLUTION,
    FilePath,
    Part,
    arrays_of,
    netcdf_of,
    read_dataset,
    replace_file,
    variables_of,
)
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.quantities import (
    BEARING_QUANTITIES,
    CYCLE,
    OVER_CYCLE,
    QUANTITIES,
    ROLLING_QUANTITIES,
    ROOT_QUANTITIES,
    SUPPORT_QUANTITIES,
)
from loaded_tca.results.summary import shown
from loaded_tca.scene import Scene, parse_scene
from loaded_tca.scene.pitch import Revolution as RevolutionSection
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    import xarray

SIDEBANDS = 5
"""Orders of a gear beside a mesh order that are named its sidebands."""

OF_TEETH: dict[str, Part] = {
    "pinion_tooth": (("position", "pair"), "1", "tooth of the pinion, from 0"),
    "wheel_tooth": (("position", "pair"), "1", "tooth of the wheel, from 0"),
}
REVOLUTION_QUANTITIES: dict[str, Part] = {
    "torque": QUANTITIES["torque"],
    "pinion_angle": (("position",), "rad", "angle of the pinion phi1, from 0 at the first position"),
    "pair": (("pair",), "1", "tooth pair: 0 comes to the pitch point where the pitch begins, +1 after it"),
    "wheel_base_radius": QUANTITIES["wheel_base_radius"],
    "face_width": QUANTITIES["face_width"],
    **OF_TEETH,
    "rigid_transmission_error": (("position",), "rad", "transmission error without load, absolute"),
    **{name: QUANTITIES[name] for name in ("transmission_error", "mesh_stiffness", "loaded_pairs", "load_share")},
    **{name: QUANTITIES[name] for name in ("normal_force", "peak_pressure", "tooth_deflection", "on_edge")},
}
"""Name in ``Revolution.dataset`` -> dimensions, unit, long name."""
ROOTS: dict[str, Part] = {
    "root_tension": ROOT_QUANTITIES["root_tension"],
    "root_compression": ROOT_QUANTITIES["root_compression"],
    "root_tension_tooth": (OVER_CYCLE, "1", "tooth of the pinion and of the wheel that has the tension, from 0"),
}
"""Those of scenes that ask for root stress."""
OF_SUPPORTS = SUPPORT_QUANTITIES | BEARING_QUANTITIES | ROLLING_QUANTITIES
"""Those of gears on supports; of shafts and of rolling bearings where there are any."""
COORDINATES = "torque", "pinion_angle", "pair"


class Spectrum(NamedTuple):
    """Amplitudes of the transmission error over the orders of a gear.

    Attributes
    ----------
    order : (k,) array
        Cycles in a turn of the wheel, where the revolution is whole turns of it; else of the pinion.
    amplitude : (k,) array [um]
        Of the transmission error at the base circle of the wheel.
    kind : (k,) array of str
        "mesh 1", "mesh 2", ...; "mesh 1 -2 wheel", "mesh 1 +1 pinion": sidebands; "wheel 1", "pinion 3": orders of
        rotation; "" where an order is neither.
    """

    order: Array
    amplitude: Array
    kind: Array


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Revolution:
    """Loaded contact over the positions of a whole revolution, under each torque.

    Attributes
    ----------
    scene : Scene
        What was analysed.
    dataset : xarray.Dataset
        Numbers of ``REVOLUTION_QUANTITIES``, of gears on supports also motions of both gears and forces on bearings,
        with their units, over torque [N mm], position (``pinion_angle`` [rad]) and
        pair; NaN where a pair carries nothing, but its force and share, which are zero.
    maps : mapping
        Pressure maps by the indices of torque and position, for each pair one or None, of the positions whose maps were
        asked for; files do not have them.
    """

    scene: Scene
    dataset: xarray.Dataset
    maps: Mapping[tuple[int, int], tuple[PressureMap | None, ...]] = field(default_factory=dict)

    def __repr__(self) -> str:
        torques, positions = (self.dataset.sizes[name] for name in CYCLE)
        return f"Revolution({self.pitches} pitches x {self.per_pitch} positions, {torques} torques, {positions} each)"

    @cached_property
    def teeth(self) -> tuple[int, int]:
        """Numbers of teeth of pinion and wheel."""
        return self.scene.pinion.teeth, abs(self.scene.wheel.teeth)

    @property
    def _asked(self) -> RevolutionSection:
        return self.scene.revolution or RevolutionSection()

    @property
    def pitches(self) -> int:
        """Pitches that the revolution has."""
        return self._asked.count(self.teeth)

    @property
    def per_pitch(self) -> int:
        """Positions in each pitch."""
        return self._asked.positions_per_pitch

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences of the accuracy warnings of the analysis."""
        return tuple(str(self.dataset.attrs.get("warnings", "")).splitlines())

    @property
    def torque(self) -> Array:
        """Pinion torques (m,) [N mm]."""
        return self.dataset["torque"].values

    @property
    def um_per_rad(self) -> float:
        """What a transmission error of one rad is at the base circle of the wheel [um]."""
        return MICROMETRES * float(self.dataset["wheel_base_radius"])

    @property
    def counted_by(self) -> int:
        """Gear whose orders the spectrum counts: 1, the wheel, unless the pinion alone makes whole turns."""
        return 0 if self.pitches % self.teeth[1] and self.pitches % self.teeth[0] == 0 else 1

    def error_um(self, torque: int | None = None) -> Array:
        """Transmission error (n,) [um] at the base circle of the wheel; without a torque the rigid one."""
        require(*index_checks(torque=(torque, len(self.torque))))
        if torque is None:
            return self.um_per_rad * self.dataset["rigid_transmission_error"].values
        return self.um_per_rad * self.dataset["transmission_error"].values[torque]

    def spectrum(self, torque: int | None = None, *, rigid: bool = False) -> Spectrum:
        """Amplitudes of the transmission error over the orders of a gear, mesh orders and sidebands named.

        Parameters
        ----------
        torque : int, optional
            Index of the torque; default: the largest one.
        rigid : bool
            Whether the transmission error without load is meant instead.

        Returns
        -------
        Spectrum
            Up to half as many orders as positions. Where a gear deviates, of which the revolution is no whole turn,
            amplitudes leak into neighbouring orders.
        """
        torque = index_or_largest(self.torque, torque)
        curve = self.error_um(None if rigid else torque)
        cycles = np.arange(1, (len(curve) - 1) // 2 + 1)
        amplitude = 2.0 / len(curve) * np.abs(np.fft.rfft(curve))[cycles]
        kind = np.array([self._kind(count) for count in cycles.tolist()], dtype=str)
        return Spectrum(cycles * self.teeth[self.counted_by] / self.pitches, amplitude, kind)

    def _kind(self, cycles: int) -> str:
        """What an order is called that has so many cycles in the revolution."""
        if cycles % self.pitches == 0:
            return f"mesh {cycles // self.pitches}"
        mesh = round(cycles / self.pitches)
        offsets = {}
        for name, teeth in zip(GEARS, self.teeth, strict=True):
            turns, rest = divmod((cycles - mesh * self.pitches) * teeth, self.pitches)
            if rest == 0 and abs(turns) <= (SIDEBANDS if mesh else teeth):
                offsets[name] = turns
        if not offsets:
            return self._turns(cycles)
        name = min(offsets, key=lambda one: abs(offsets[one]))
        return f"mesh {mesh} {offsets[name]:+d} {name}" if mesh else f"{name} {offsets[name]}"

    def _turns(self, cycles: int) -> str:
        """Order of rotation of the wheel, else of the pinion; nothing where it is whole of neither."""
        for name, teeth in reversed([*zip(GEARS, self.teeth, strict=True)]):
            turns, rest = divmod(cycles * teeth, self.pitches)
            if rest == 0:
                return f"{name} {turns}"
        return ""

    def total_deviation(self, torque: int | None = None) -> float:
        """Total single-flank composite deviation F_i' [um], at the base circle; without a torque of rigid teeth."""
        return float(np.ptp(self.error_um(torque)))

    def tooth_to_tooth_deviation(self, torque: int | None = None) -> float:
        """Tooth-to-tooth single-flank composite deviation f_i' [um]: the largest span within a pitch, as above."""
        curve = self.error_um(torque)
        closed = np.concatenate([curve, curve[: self.per_pitch]]) if self.is_closed else curve
        window = min(self.per_pitch + 1, len(closed))
        return float(np.ptp(sliding_window_view(closed, window), axis=-1).max())

    @property
    def is_closed(self) -> bool:
        """Whether the revolution is whole turns of every gear whose teeth deviate."""
        return not open_turns(self.scene, self.pitches)

    def by_tooth(self, gear: str = "wheel") -> xarray.Dataset:
        """Return what each tooth of a gear carries at the most in the revolution.

        Parameters
        ----------
        gear : {"pinion", "wheel"}

        Returns
        -------
        xarray.Dataset
            Over ``torque`` and ``tooth``: ``load_share``, ``normal_force`` [N] and ``peak_pressure`` [MPa], the largest
            of each tooth, and ``pinion_angle`` [rad] where the pressure is highest; NaN of teeth that carry nothing.
        """
        import xarray

        require((gear in GEARS, f"gear: {gear!r:.60} is not 'pinion' or 'wheel'"))
        tooth = self.dataset[f"{gear}_tooth"].values.ravel()
        count, torques = self.teeth[GEARS.index(gear)], len(self.torque)
        names = "load_share", "normal_force", "peak_pressure"
        values = {name: self.dataset[name].values.reshape(torques, -1) for name in names}
        loaded = values["normal_force"] > 0.0
        largest: dict[str, Array] = {}
        for name, of_pairs in values.items():
            most = np.full((torques, count), -np.inf)
            known = np.where(loaded & np.isfinite(of_pairs), of_pairs, -np.inf)
            for t in range(torques):
                np.maximum.at(most[t], tooth, known[t])
            largest[name] = np.where(np.isinf(most), np.nan, most)
        angle = np.repeat(self.dataset["pinion_angle"].values, self.dataset.sizes["pair"])
        where = np.full((torques, count), np.nan)
        for t, k in zip(*np.nonzero(values["peak_pressure"] == largest["peak_pressure"][:, tooth]), strict=True):
            where[t, tooth[k]] = np.fmin(where[t, tooth[k]], angle[k])
        parts = {name: (("torque", "tooth"), array, self.dataset[name].attrs) for name, array in largest.items()}
        parts["pinion_angle"] = (("torque", "tooth"), where, self.dataset["pinion_angle"].attrs)
        return xarray.Dataset(parts, {"torque": self.torque, "tooth": np.arange(count)})

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of the revolution for each torque, by names that end in their unit."""
        return tuple(self._figures(torque) for torque in range(len(self.torque)))

    def _figures(self, torque: int) -> dict[str, float]:
        spectrum = self.spectrum(torque)
        kinds = dict(zip(spectrum.kind.tolist(), spectrum.amplitude.tolist(), strict=True))
        sidebands = [size for kind, size in kinds.items() if kind.startswith("mesh 1 ")]
        figures = {
            "total_single_flank_deviation_um": self.total_deviation(torque),
            "tooth_to_tooth_single_flank_deviation_um": self.tooth_to_tooth_deviation(torque),
            "rigid_total_single_flank_deviation_um": self.total_deviation(),
            "rigid_tooth_to_tooth_single_flank_deviation_um": self.tooth_to_tooth_deviation(),
            "first_mesh_order_um": kinds.get("mesh 1", math.nan),
            "largest_sideband_um": max(sidebands, default=math.nan),
        }
        for name, figure in (("largest_load_share", "largest_load_share"), ("peak_pressure", "peak_pressure_MPa")):
            values = self.dataset[name.removeprefix("largest_")].values[torque]
            known = np.where(np.isfinite(values), values, -math.inf)
            at = np.unravel_index(int(known.argmax()), known.shape)
            figures[figure] = float(values[at])
            for gear in GEARS:
                figures[f"{gear}_tooth_of_{name}"] = int(self.dataset[f"{gear}_tooth"].values[at])
        if "root_tension" in self.dataset:
            tension = self.dataset["root_tension"].values[torque]
            for k, gear in enumerate(GEARS):
                place = int(np.nanargmax(tension[:, k]))
                figures[f"{gear}_root_tension_MPa"] = float(tension[place, k])
                tooth = self.dataset["root_tension_tooth"].values[torque, place, k]
                figures[f"{gear}_tooth_of_root_tension"] = int(tooth)
        return figures

    def summary(self) -> str:
        """Return the figures, a column for each torque, and the warnings of the analysis."""
        figures = self.key_figures()
        rows = {"pinion torque [N m]": [f"{1e-3 * torque:.4g}" for torque in self.torque]}
        for name in figures[0]:
            label, _, unit = name.rpartition("_")
            titled = f"{label} [{unit}]" if unit in ("um", "MPa") else name
            rows[titled.replace("_", " ")] = [shown(one[name], name) for one in figures]
        width = 2 + max(len(cell) for cells in rows.values() for cell in cells)
        labels = max(map(len, rows))
        table = [f"{name:<{labels}}" + "".join(f"{cell:>{width}}" for cell in cells) for name, cells in rows.items()]
        scope = f"{self.pitches} pitches, {self.per_pitch} positions each, teeth counted from 0"
        warned = [f"warning: {sentence}" for sentence in self.warnings]
        return "\n".join([self.scene.title or "Whole revolution", scope, *table, *warned])

    def to_table(self) -> dict[str, Array]:
        """Return the numbers of every torque and position as columns, by names that end in their unit."""
        data, torques = self.dataset, len(self.torque)
        positions = data.sizes["position"]
        tooth = {gear: data[f"{gear}_tooth"].values[:, self._column_of_zero] for gear in GEARS}
        columns = {
            "pinion_torque_Nm": np.repeat(1e-3 * self.torque, positions),
            "pinion_angle_deg": np.tile(np.degrees(data["pinion_angle"].values), torques),
            "pinion_tooth": np.tile(tooth["pinion"], torques),
            "wheel_tooth": np.tile(tooth["wheel"], torques),
            "rigid_transmission_error_um": np.tile(self.um_per_rad * data["rigid_transmission_error"].values, torques),
            "transmission_error_um": self.um_per_rad * data["transmission_error"].values.ravel(),
            "mesh_stiffness_N_per_mm_um": data["mesh_stiffness"].values.ravel(),
            "loaded_pairs": data["loaded_pairs"].values.ravel(),
        }
        for k, pair in enumerate(data["pair"].values.tolist()):
            columns[f"load_share_pair_{pair:+d}"] = data["load_share"].values[..., k].ravel()
            columns[f"peak_pressure_pair_{pair:+d}_MPa"] = data["peak_pressure"].values[..., k].ravel()
        for name in (name for name in ROOTS if name in data):
            for k, gear in enumerate(GEARS):
                unit = "" if name.endswith("tooth") else "_MPa"
                columns[f"{gear}_{name}{unit}"] = data[name].values[..., k].ravel()
        return columns

    @property
    def _column_of_zero(self) -> int:
        """Column of tooth pair 0, or of the one next to it."""
        return int(np.abs(self.dataset["pair"].values).argmin())

    def to_dynamics(self) -> xarray.Dataset:
        """Return curves over the revolution in SI units, for models of gear dynamics, as ``MeshCycle.to_dynamics``.

        Every name ends in its unit.

        Returns
        -------
        xarray.Dataset
            Over ``pinion_torque_Nm`` and ``pinion_angle_rad``: ``transmission_error_m`` and ``_rad``,
            ``mesh_stiffness_N_per_m``, ``loaded_pairs``; ``unloaded_transmission_error_m``; base radii, numbers of
            teeth, and ``pitches``.
        """
        import xarray

        data, angle = self.dataset, "pinion_angle_rad"
        gears = teeth_and_radii(self.scene.pair())
        radius, error = gears["wheel_base_radius_m"], data["transmission_error"].values
        curves = {
            "transmission_error_rad": error,
            "transmission_error_m": radius * error,
            "mesh_stiffness_N_per_m": 1e6 * float(data["face_width"]) * data["mesh_stiffness"].values,
            "loaded_pairs": data["loaded_pairs"].values,
            "unloaded_transmission_error_m": radius * data["rigid_transmission_error"].values,
        }
        arrays: dict[str, Any] = {
            name: ((TORQUE, angle)[-curve.ndim :], curve, {"units": PARTS[name][1]}) for name, curve in curves.items()
        }
        arrays |= {name: ((), number, {"units": PARTS[name][1]}) for name, number in gears.items()}
        arrays["pitches"] = ((), self.pitches, {"units": "1"})
        coordinates = {TORQUE: 1e-3 * self.torque, angle: data["pinion_angle"].values}
        return xarray.Dataset(arrays, coordinates, {"title": self.scene.title})

    @checked
    def save(self, path: FilePath) -> None:
        """Write everything but pressure maps to a NetCDF-3 file, whole or not at all; ``load`` reads it back."""
        replace_file(path, self.to_netcdf())

    def to_netcdf(self) -> bytes | bytearray:
        """Return the bytes of the file that ``save`` writes."""
        about = {"kind": REVOLUTION, "title": self.scene.title, "scene_toml": self.scene.to_toml()}
        return netcdf_of(self.dataset.assign_attrs(about))

    @classmethod
    @checked
    def load(cls, path: FilePath) -> Revolution:
        """Read a file that ``save`` wrote.

        Raises
        ------
        InputError
            If it cannot be read, is damaged, or is no such file.
        """
        file = read_dataset(path)
        if file.attrs.get("kind") != REVOLUTION:
            raise InputError(f"{path}: not a whole revolution; read it with load_result")
        try:
            scene = parse_scene(str(file.attrs.get("scene_toml", "")), source="scene_toml", folder=None)
            on_supports = {name: part for name, part in OF_SUPPORTS.items() if name in file}
            arrays = arrays_of(file, REVOLUTION_QUANTITIES | (ROOTS if "root_tension" in file else {}) | on_supports)
        except InputError as error:
            raise InputError([f"{path}: not a whole revolution", *error.problems]) from None
        about = {name: str(file.attrs[name]) for name in ("version", "date", "warnings") if name in file.attrs}
        return cls(scene=scene, dataset=revolution_dataset(arrays, **about))


def revolution_dataset(arrays: Mapping[str, Any], **about: str) -> xarray.Dataset:
    """Make the dataset of a revolution of the arrays of ``REVOLUTION_QUANTITIES``.

    With those of ``ROOTS`` and ``OF_SUPPORTS`` that there are.
    """
    import xarray

    parts = REVOLUTION_QUANTITIES | {name: part for name, part in (ROOTS | OF_SUPPORTS).items() if name in arrays}
    variables = variables_of(parts, arrays)
    coordinates = {name: variables.pop(name) for name in COORDINATES}
    return xarray.Dataset(variables, coordinates, about)


def open_turns(scene: Scene, pitches: int) -> list[str]:
    """Gears with deviations of which so many pitches are no whole turn."""
    gears = zip(GEARS, (scene.pinion, scene.wheel), strict=True)
    return [name for name, gear in gears if gear.teeth_differ and pitches % gear.teeth]
