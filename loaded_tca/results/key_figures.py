"""What key figures are read off: a result under one torque, and its places with the highest pressures and force.

Key figures of ISO 6336-1 and -2 beside computed ones, and why these differ.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.results.declared import Row
from loaded_tca.results.load_factors import face_load_factor_by_positions, face_load_factor_error
from loaded_tca.results.root_stress import root_figures
from loaded_tca.scene.rows import Label
from loaded_tca.units import UNITS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from loaded_tca.arrays import Array
    from loaded_tca.results.numbers import CycleNumbers
    from loaded_tca.scene import Scene

STRESS = "nominal_contact_stress_iso_6336_MPa"
SINGLE_CONTACT = "pinion_single_contact_factor_iso_6336", "wheel_single_contact_factor_iso_6336"
CONTACT_RATIO, HELIX_ANGLE = "contact_ratio_factor_iso_6336", "contact_helix_angle_factor_iso_6336"
SINGLE_STIFFNESS, MESH_STIFFNESS = "single_stiffness_iso_6336_N_per_mm_um", "mesh_stiffness_iso_6336_N_per_mm_um"
TRANSVERSE_LOAD = "largest_transverse_load_factor_iso_6336"

FACTORS = Label(
    "  Z_B | Z_D, not in sigma_H0; Z_eps | Z_beta, in sigma_H0", "contact_factors", "Z_B", "Z_D", "Z_eps", "Z_beta"
)
STIFFNESSES = Label(
    "  ISO 6336-1 above 100 N/mm: c' | c_gamma_alpha [N/(mm um)]",
    "stiffness_N_per_mm_um",
    "c_prime",
    "c_gamma_alpha",
)
STRESS_ROWS = (
    ("ISO 6336-2: sigma_H0 at the pitch point [MPa]", (STRESS,)),
    (FACTORS, (*SINGLE_CONTACT, CONTACT_RATIO, HELIX_ANGLE)),
)
STIFFNESS_ROW = STIFFNESSES, (SINGLE_STIFFNESS, MESH_STIFFNESS)
LOAD_ROW = "  upper bound of K_Halpha in ISO 6336-1, the lower one is 1", (TRANSVERSE_LOAD,)
"""Labels of lines of a summary, and their key figures."""

AXES = {
    STRESS: "nominal contact stress σ_H0, ISO 6336",
    SINGLE_CONTACT[0]: "single contact factor Z_B, ISO 6336",
    SINGLE_CONTACT[1]: "single contact factor Z_D, ISO 6336",
    CONTACT_RATIO: "contact ratio factor Z_ε, ISO 6336",
    HELIX_ANGLE: "helix angle factor Z_β, ISO 6336",
    SINGLE_STIFFNESS: "single stiffness c', ISO 6336",
    MESH_STIFFNESS: "mean mesh stiffness c_γα, ISO 6336",
    TRANSVERSE_LOAD: "upper bound of K_Hα, lower 1, ISO 6336",
}
"""Key figure -> its label on axes, in the order of tables and files."""

REASONS: Mapping[str, str] = {
    STRESS: "sigma_H0 is the pressure of Hertz at the pitch point under an even load; the computed peak pressure comes "
    "from the load as tooth pairs and face share it, and from the curvature where this load acts",
    SINGLE_CONTACT[0]: "Z_B and Z_D are for the curvature where single contact begins, under the whole load; computed "
    "teeth bend and hand the load over to the next pair gradually",
    CONTACT_RATIO: "Z_eps stands for an even load on contact lines of mean length; computed contacts have the load and "
    "the length of each position",
    HELIX_ANGLE: "Z_beta = 1/sqrt(cos(beta)) is fitted to tests of helical gears; computed contacts lie askew on their "
    "flanks",
    SINGLE_STIFFNESS: "c' is the largest stiffness of one tooth pair, measured on solid steel discs above 100 N/mm; "
    "computed teeth have the fillets, bores and load of these gears",
    MESH_STIFFNESS: "c_gamma_alpha is c' (0.75 eps_alpha + 0.25), without body torsion; the computed mesh stiffness "
    "depends on load and bores, and bodies of helical gears tilt",
    TRANSVERSE_LOAD: "the computed K_Halpha may lie outside the range from 1 to the upper bound: it refers to the mean "
    "length of all contact lines, eps_alpha b/cos(beta_b), while K_Halpha of ISO 6336-1 refers to "
    "b/(Z_eps^2 cos(beta_b)); besides, the load along a contact line is uneven",
}
"""Key figure -> why the computed number beside it differs; that of Z_B holds for Z_D, too."""
WHERE_REASONS_ARE = (
    "ISO 6336: computed numbers differ from those of the standard; loaded-tca check and the report say why"
)
"""The line of a summary that has numbers of the standard."""


def iso_figures(scene: Scene, torque: float, transverse_load_factor: float = math.nan) -> dict[str, float]:
    """Return the key figures of ISO 6336-1 and -2; NaN: the standard has none.

    Parameters
    ----------
    scene : Scene
    torque : float [N mm]
        Of the pinion.
    transverse_load_factor : float
        K_Halpha as computed; its bound is given only beside it.
    """
    standard = scene.contact_standard
    bound = standard.largest_transverse_load_factor
    return {
        STRESS: standard.stress_per_root_torque * math.sqrt(torque),
        **dict(zip(SINGLE_CONTACT, standard.single_contact, strict=True)),
        CONTACT_RATIO: standard.contact_ratio,
        HELIX_ANGLE: standard.helix_angle,
        SINGLE_STIFFNESS: standard.single_stiffness,
        MESH_STIFFNESS: standard.mesh_stiffness,
        TRANSVERSE_LOAD: math.nan if math.isnan(transverse_load_factor) else bound,
    }


def reasons_beside(*figures: Mapping[str, float]) -> Iterator[str]:
    """Yield why computed numbers differ from those of the standard that some figures have."""
    for name, reason in REASONS.items():
        if any(math.isfinite(entry.get(name, math.nan)) for entry in figures):
            yield reason


ARCSEC = 1.0 / UNITS["arcsec"].factor
"""Seconds of arc per radian."""

CAPPED = 1.0 - 1e-6
"""Part of the cap on the pressure from which a pressure equals it."""
ORDERS = 3
"""Orders of the tooth mesh that the key figures name."""


def mean_over_a_pitch(values: Array) -> float:
    """Mean of the finite values at even positions of which the first and the last are a pitch apart.

    Both ends are the same place of the mesh, so that each of them counts half.

    Parameters
    ----------
    values : (n,) array

    Returns
    -------
    float
        NaN if no value is finite.

    Examples
    --------
    >>> mean_over_a_pitch(np.array([4.0, 1.0, 1.0, 4.0]))
    2.0
    """
    weights = np.ones(len(values))
    if len(values) > 1:
        weights[[0, -1]] = 0.5
    known = np.isfinite(values)
    return float(np.average(values[known], weights=weights[known])) if known.any() else math.nan


def reduced(reduction: Any, values: Array) -> float:
    """Least, largest or span of the finite values, whole for whole numbers; NaN if there is none."""
    finite = values[np.isfinite(values)]
    return reduction(finite).item() if finite.size else math.nan


@dataclass(frozen=True, eq=False)
class UnderTorque(Row):
    """A mesh cycle under one torque.

    Attributes
    ----------
    result : MeshCycle
    row : int
        Index of the torque.
    """

    result: CycleNumbers

    @cached_property
    def peak(self) -> Contact:
        """The contact with the highest peak pressure."""
        return Contact(self, self.result.peak_contact(self.row))

    @cached_property
    def edge(self) -> Contact:
        """The contact with the highest edge pressure."""
        return Contact(self, self.result.edge_contact(self.row))

    @cached_property
    def heaviest(self) -> Contact:
        """The contact with the largest force."""
        return Contact(self, self.result.most_loaded_contact(self.row))

    @cached_property
    def smooth(self) -> Contact:
        """The contact with the highest peak pressure where Hertz holds."""
        return Contact(self, self.result.peak_contact(self.row, where_hertz_holds=True))

    @property
    def length(self) -> float:
        """Of a transmission error at the base circle of the wheel [um/rad]."""
        return self.result.um_per_rad

    @property
    def arcsec(self) -> float:
        """Of a transmission error [arcsec/rad]; NaN where it is that of a gear that stands for a rack."""
        return math.nan if self.result.has("rack_force") else ARCSEC

    @cached_property
    def harmonics(self) -> Array:
        """Amplitudes of the orders of the tooth mesh (ORDERS,) [rad]."""
        return self.result.harmonics(ORDERS)[self.row]

    @property
    def pairs(self) -> Array:
        """Numbers of tooth pairs under load; NaN where they do not share it."""
        return self.loaded_pairs if self.result.scene.analysis.load_sharing else np.full(1, math.nan)

    @cached_property
    def iso(self) -> dict[str, float]:
        """Figures of ISO 6336-1 and -2 by their names."""
        factor = float(self.transverse_load_factor)
        return iso_figures(self.result.scene, float(self.torque), factor)

    @cached_property
    def root(self) -> dict[str, float]:
        """Figures of root stress by their names; none without root stress."""
        return root_figures(self.result, self.row) if self.result.has_root_stress else {}

    @property
    def face_load_factor_error(self) -> float:
        """By how much K_Hbeta is off by its cells, at the most; NaN without load."""
        return face_load_factor_error(self.result.gear_pair, self.result.path, self.result.maps[self.row])

    @cached_property
    def face_load_factor_by_positions(self) -> float:
        """How far loads of strips of the face move where every second position counts alone, over the largest."""
        return face_load_factor_by_positions(self.result.gear_pair, self.result.path, self.result.maps[self.row])

    @property
    def on_line(self) -> Array:
        """Where an unloaded line contact is loaded, (position, pair)."""
        lines = np.stack([path.on_line for path in self.result.paths], axis=-1)
        return lines & np.isfinite(self.contact_deformation)

    @property
    def capped(self) -> Array:
        """Where a pressure equals the cap, (position, pair)."""
        return np.asarray(np.fmax(self.peak_pressure, self.edge_pressure) >= CAPPED * self.result.max_pressure)


@dataclass(frozen=True, eq=False)
class Contact:
    """One contact under a torque, by index of position and pair, or none: its numbers are NaN."""

    under: UnderTorque
    place: tuple[int, int] | None

    def number(self, name: str) -> float:
        """Number of the contact in an array of the result."""
        return math.nan if self.place is None else float(getattr(self.under, name)[self.place])

    def has(self, name: str) -> bool:
        """Whether there is a contact that has a flag."""
        return self.place is not None and bool(getattr(self.under, name)[self.place])

    def unloaded(self, name: str) -> float:
        """Number of its unloaded contact point."""
        if self.place is None:
            return math.nan
        position, pair = self.place
        return float(getattr(self.under.result.paths[pair], name)[position])


def positions_with(flags: Array) -> int:
    """Positions at which a pair has the flag."""
    return int(flags.any(axis=-1).sum())


def span_of(error: Array, places: int) -> float:
    """Peak-to-peak of a transmission error at so many places of the mesh; one has none: NaN."""
    return reduced(np.ptp, error) if min(places, np.isfinite(error).sum()) > 1 else math.nan
