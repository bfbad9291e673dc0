"""The mesh cycle: what the tooth pairs carry, and how far the wheel stays behind, over the positions of a pitch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.results.contacts import (
    CAPPED,
    CYCLE,
    NUMBERS,
    PATH_PARTS,
    ContactNumbers,
    PairContacts,
    PressureMap,
    contact_parts,
    map_variables,
    maps_from,
    pack_contacts,
    quantity,
    unpack_contacts,
)
from loaded_tca.results.files import FilePath, Part, Variable, pack, read_netcdf, unpack, write_netcdf
from loaded_tca.results.key_figures import (
    harmonic_amplitudes,
    highest_edge_peak,
    highest_peak,
    highest_where_hertz_holds,
    key_figures,
)
from loaded_tca.results.summary import summary_text
from loaded_tca.unloaded import ContactPath


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshCycle(ContactNumbers):
    """Loaded contact over the positions of a pitch.

    Arrays are (n,) over the positions, with several torques (m, n). NaN where the tooth pair does not touch. Where
    several pairs share the load, peak pressure, its place and ``maps`` are those of the pair with the highest one, the
    other numbers of a contact those of the pair with the largest force, and ``contacts`` has those of all.

    Attributes
    ----------
    title, scene_toml, version : str
        Of the scene, its whole text, and the package version that made the result.
    path : ContactPath
        The unloaded contact; where pairs share the load, of the pair that touches first, in the angles of the gears.
    torque : (m,) array [N mm]
        Pinion torques.
    pairs : (pairs,) int array
        Tooth pairs that share the load: 0 is the pair at phi1, +1 the next one.
    load_share : (..., n, pairs) array
        Share of each pair; rows sum to 1.
    maps : tuple of tuple of PressureMap or None
        ``maps[torque][position]``; None where nothing touches.
    wheel_base_radius, face_width : float [mm]
        r_b2 and the common face width: what turns the transmission error into a length and forces into line loads.
    max_pressure : float [MPa]
        Cap on the pressure; NaN: elastic.
    pair_contacts : PairContacts or None
        Of all pairs that share the load; None where one pair carries the whole load.
    """

    title: str
    scene_toml: str
    version: str
    path: ContactPath
    torque: Array
    pairs: Array
    load_share: Array
    maps: tuple[tuple[PressureMap | None, ...], ...]
    wheel_base_radius: float
    face_width: float
    max_pressure: float
    transmission_error: Array = quantity("rad", "loaded transmission error, absolute")
    mesh_stiffness: Array = quantity("N/(mm um)", "tangent of the force over the face width to the transmission error")
    secant_stiffness: Array = quantity("N/(mm um)", "the same, from no load to the load")
    pair_contacts: PairContacts | None = None

    @property
    def pinion_angle(self) -> Array:
        """phi1 of the positions (n,) [rad]."""
        return self.path.pinion_angle

    def __repr__(self) -> str:
        peak = np.nanmax(self.peak_pressure, initial=0.0)
        torques = f"{len(self.torque)} torque" + "s" * (len(self.torque) > 1)
        return f"MeshCycle({len(self.path)} positions, {torques}, peak {peak:.6g} MPa)"

    def by_torque(self, name: str) -> Array:
        """Return a field of numbers per torque and position as an (m, n) array, for a single torque too."""
        return np.asarray(getattr(self, name)).reshape(len(self.torque), len(self.path))

    @cached_property
    def contacts(self) -> PairContacts:
        """Contacts of every tooth pair that carries load, with the axes torque, position, pair."""
        if self.pair_contacts is not None:
            return self.pair_contacts
        numbers = {name: self.by_torque(name)[..., None] for name in NUMBERS}
        maps = tuple(tuple((one,) for one in row) for row in self.maps)
        return PairContacts(**numbers, pairs=self.pairs, paths=(self.path,), maps=maps)

    @property
    def peak_at_edge(self) -> Array:
        """Whether the largest cell lies at the end of a flank, or a relief start in the contact: bool, (..., n).

        There theory has an infinite pressure, and the peak grows with the grid, up to a cap if there is one.
        """
        return self.contacts.at_highest(self.contacts.peak_at_edge).reshape(self.peak_pressure.shape)

    @property
    def capped(self) -> Array:
        """Whether the peak equals the cap on the pressure: bool, (..., n)."""
        return np.asarray(self.peak_pressure >= CAPPED * self.max_pressure)

    @property
    def inner_pressure(self) -> Array:
        """Highest pressure that is no matter of the grid [MPa], (..., n).

        The peak; where that grows with the grid, the pressure beside the contact point; NaN where the contact point
        itself lies on an edge or a relief start, or nearer to an edge than half the contact is wide.
        """
        return np.fmax.reduce(self.contacts.inner_pressure, axis=-1).reshape(self.peak_pressure.shape)

    @property
    def yielding(self) -> str:
        """What yields beside the contacts, in words."""
        return "teeth bend" if np.nan_to_num(self.contacts.deflection).any() else "teeth do not bend"

    @property
    def loaded_pairs(self) -> Array:
        """How many tooth pairs carry load, (..., n)."""
        return np.asarray((self.contacts.normal_force > 0.0).sum(axis=-1).reshape(self.peak_pressure.shape))

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
        if not isinstance(count, int | np.integer) or count < 1:
            raise InputError(f"count: {count!r} is not a whole number from 1 on")
        errors = self.by_torque("transmission_error")
        periodic = self.pair_contacts is not None
        return np.stack([harmonic_amplitudes(error if periodic else error[:0], count) for error in errors])

    def peak_contact(self, torque: int, *, where_hertz_holds: bool = False) -> tuple[int, int] | None:
        """Return position and column of the pair with the highest pressure, of those asked for; None if there is none.

        By default that of ``inner_pressure``, or of the central pressure where every contact point lies on an edge.
        """
        row = self.contacts.row(torque, self.max_pressure)
        return self._place(highest_where_hertz_holds(row) if where_hertz_holds else highest_peak(row))

    def peak_position(self, torque: int, *, where_hertz_holds: bool = False) -> int | None:
        """Return the index of the position of ``peak_contact``; None if there is none."""
        place = self.peak_contact(torque, where_hertz_holds=where_hertz_holds)
        return None if place is None else place[0]

    def edge_contact(self, torque: int) -> tuple[int, int] | None:
        """Return position and column of the pair with the highest peak at an edge or relief start, or None."""
        return self._place(highest_edge_peak(self.contacts.row(torque, self.max_pressure)))

    def edge_position(self, torque: int) -> int | None:
        """Return the index of the position of ``edge_contact``; None if there is none."""
        place = self.edge_contact(torque)
        return None if place is None else place[0]

    def highest_column(self, torque: int, position: int) -> int:
        """Return the column of the pair with the highest inner pressure at a position, or else the highest peak."""
        return int(self.contacts.highest_inner[torque, position])

    def _place(self, index: int | None) -> tuple[int, int] | None:
        """Position and column of an entry of a row over positions and pairs."""
        return None if index is None else (index // len(self.pairs), index % len(self.pairs))

    def key_figures(self) -> tuple[dict[str, float], ...]:
        """Return the figures of the whole cycle for each torque, by names that end in their unit.

        ``peak_pressure_MPa`` is the highest ``inner_pressure``; "at_peak": at its position; "at_edge": at that of
        the highest peak at an edge or relief start; "there": at that of the highest pressure where Hertz holds. Means
        are over the positions. NaN: not known.
        """
        names = ("transmission_error", "mesh_stiffness", "secant_stiffness")
        pairs = (
            self.by_torque("loaded_pairs")
            if self.pair_contacts is not None
            else np.full((len(self.torque), 1), math.nan)
        )
        harmonics = self.harmonics(ORDERS)
        return tuple(
            {
                "pinion_torque_Nm": 1e-3 * float(torque),
                **key_figures(
                    self.contacts.path,
                    self.contacts.row(index, self.max_pressure),
                    {
                        **{name: self.by_torque(name)[index] for name in names},
                        "unloaded_error": self.path.transmission_error,
                        "in_contact": self.path.in_contact,
                        "loaded_pairs": pairs[index],
                        "harmonics": harmonics[index],
                    },
                    wheel_base_radius=self.wheel_base_radius,
                    max_pressure=self.max_pressure,
                ),
            }
            for index, torque in enumerate(self.torque)
        )

    def summary(self) -> str:
        """Return the key figures in the engineer's units: about 20 lines, one column per torque."""
        return summary_text(self.title, _scope(self), self.key_figures())

    def save(self, path: FilePath) -> None:
        """Write everything to a NetCDF-3 file, whole or not at all; ``load`` reads it back unchanged.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        variables = {**pack(self, cycle_parts(self.transmission_error.ndim)), **pack(self.path, PATH_PARTS, "path_")}
        variables |= map_variables(self.maps, (len(self.torque), len(self.path)), CYCLE, "map_")
        if self.pair_contacts is not None:
            variables |= pack_contacts(self.pair_contacts)
        write_netcdf(path, variables, {name: getattr(self, name) for name in TEXTS})

    @classmethod
    def load(cls, path: FilePath) -> MeshCycle:
        """Read a file that ``save`` wrote.

        Raises
        ------
        InputError
            If it cannot be read, is damaged, or is no such file.
        """
        variables, attributes = read_netcdf(path)
        texts: dict[str, Any] = {name: attributes.get(name, "") for name in TEXTS}
        try:
            return cls(**texts, **_fields_from(variables))
        except InputError as error:
            raise InputError([f"{path}: not the result of a mesh cycle", *error.problems]) from None


ORDERS = 3
"""Orders of the tooth mesh that the key figures name."""
TEXTS = ("title", "scene_toml", "version")
"""Attributes of a result file."""


def cycle_parts(axes: int) -> dict[str, Part]:
    """Parts of the cycle itself; ``axes``: 2 where the torques have an axis, 1 where there is one torque without."""
    leading = CYCLE[-axes:]
    own = {
        entry.name: (leading, entry.metadata["unit"], entry.metadata["text"])
        for entry in fields(MeshCycle)
        if entry.metadata and entry.name not in NUMBERS
    }
    return {
        "torque": (("torque",), "N mm", "pinion torque"),
        "pairs": (("pair",), "1", "tooth pairs: 0 is the pair at phi1, 1 the next one"),
        "load_share": ((*leading, "pair"), "1", "share of each tooth pair in the load"),
        "wheel_base_radius": ((), "mm", "base radius of the wheel"),
        "face_width": ((), "mm", "common face width"),
        "max_pressure": ((), "MPa", "cap on the pressure; NaN: elastic"),
        **own,
        **contact_parts(leading),
    }


def _fields_from(variables: Mapping[str, Variable]) -> dict[str, Any]:
    """Every field of a cycle but its texts; InputError if a part is missing."""
    axes = 1 if "transmission_error" in variables and variables["transmission_error"].data.ndim == 1 else 2
    own = unpack(variables, cycle_parts(axes))
    return {
        **own,
        **{name: float(own[name]) for name in ("wheel_base_radius", "face_width", "max_pressure")},
        "path": ContactPath(**unpack(variables, PATH_PARTS, "path_")),
        "maps": maps_from(variables, CYCLE, "map_"),
        "pair_contacts": unpack_contacts(variables, own["pairs"]),
    }


def _scope(cycle: MeshCycle) -> str:
    first, last = (math.degrees(cycle.pinion_angle[end]) for end in (0, -1))
    count, pairs = len(cycle.path), len(cycle.pairs)
    where = f"{count} positions, pinion angle {first:.4g} to {last:.4g} deg" if count > 1 else "1 position"
    if cycle.pair_contacts is None:
        carrying = "one tooth pair carries the whole load (load sharing off)"
    else:
        carrying = f"{pairs} tooth pairs share the load, up to {int(cycle.loaded_pairs.max(initial=0))} at once"
    return f"{where}; {carrying}; {cycle.yielding}"
