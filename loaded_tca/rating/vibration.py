"""What excites a mesh and how near it is to its resonance: reduced mass of the bodies, N, transmission error."""

from __future__ import annotations

from functools import lru_cache
from math import inf, nan, pi
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.gears import RingGear
from loaded_tca.gears.cylindrical import half_tooth
from loaded_tca.reference import iso6336, iso6336_1

if TYPE_CHECKING:
    from loaded_tca.gears import CylindricalGear
    from loaded_tca.rating.inputs import RatingInputs
    from loaded_tca.scene.shafts import ShaftSection

POINTS = 40
"""Along each part of the outline of a tooth: twice as many change its second moment of area by less than 1e-5."""
PER_VOLUME = 1e-9
"""Of a density in kg/m3: kg/mm3."""


@lru_cache(maxsize=16)
def full_second_moment(gear: CylindricalGear) -> float:
    """Polar second moment of area of the transverse section of a gear without a bore, its teeth with it [mm^4].

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear
    >>> gear = CylindricalGear(teeth=40, normal_module=3.0, face_width=25.0)
    >>> disc = pi / 32.0 * (gear.tip_radius + gear.root_radius) ** 4
    >>> round(full_second_moment(gear) / disc, 2)  # teeth have more of their material outside the mean diameter
    1.02
    """
    outline = np.concatenate([*half_tooth(gear, POINTS).values()])
    x, y = outline.T
    ends = x[:-1], x[1:], y[:-1], y[1:]
    squares = ends[0] ** 2 + ends[0] * ends[1] + ends[1] ** 2 + ends[2] ** 2 + ends[2] * ends[3] + ends[3] ** 2
    return 2.0 * gear.teeth * float((ends[0] * ends[3] - ends[1] * ends[2]) @ squares) / 12.0


def _body_moment(gear: CylindricalGear | RingGear) -> float:
    """Polar second moment of area of a gear without a bore, of a ring from the middle of its teeth on [mm^4]."""
    if isinstance(gear, RingGear):
        mean = gear.tip_radius + gear.root_radius
        return pi / 32.0 * ((2.0 * gear.outer_radius) ** 4 - mean**4)
    return full_second_moment(gear)


def _hole_moment(bore: float, shaft: ShaftSection | None, middle: float, face_width: float) -> float:
    """Polar second moment of area of what is hollow under the face of a gear, its mean over the face [mm^4]."""
    alone = pi / 32.0 * bore**4
    if shaft is None:
        return alone
    ends = shaft.start_mm + np.cumsum([0.0, *(part.length_mm for part in shaft.sections)])
    low, high = middle - 0.5 * face_width, middle + 0.5 * face_width
    lengths = np.clip(np.minimum(ends[1:], high) - np.maximum(ends[:-1], low), 0.0, None)
    hollow = np.array([pi / 32.0 * part.inner_diameter_mm**4 for part in shaft.sections])
    return float((lengths @ hollow + (face_width - lengths.sum()) * alone) / face_width)


def reduced_mass(inputs: RatingInputs) -> float:
    """m_red of both gears for each mm of the common face [kg/mm].

    Teeth by their outline, bodies over their own faces down to the bores that the scene gives, or to those of the
    shafts under them; solid ones where it gives none. A ring reaches from the middle of its teeth to its outer
    diameter; one that is held does not swing.
    """
    scene, mesh = inputs.scene, inputs.mesh
    gears, sections = (mesh.pinion, mesh.wheel), (scene.pinion, scene.wheel)
    inertias = [
        (_body_moment(gear) - _hole_moment(section.bore_diameter_mm or 0.0, section.shaft, middle, width))
        * (PER_VOLUME * material.density_kg_m3 * width / mesh.common_face_width)
        for gear, section, material, middle in zip(gears, sections, scene.materials, scene.face_middles, strict=True)
        for width in (gear.face_width,)
    ]
    of_wheel = inf if inputs.duty.wheel_is_held else inertias[1]
    radii = mesh.pinion.base_radius, mesh.wheel.base_radius
    return iso6336_1.reduced_mass((inertias[0], of_wheel), radii, meshes=inputs.duty.meshes)


def resonance_ratio(inputs: RatingInputs, stiffness: Array) -> Array:
    """N (c,): speed of the pinion over that at which the mesh resonates with a stiffness (c,) [N/(mm um)]."""
    mass, teeth = reduced_mass(inputs), inputs.mesh.pinion.teeth
    known = stiffness > 0.0  # NaN: not known
    at_unit = iso6336_1.resonance_speed(teeth, 1.0, mass)
    return np.where(known, inputs.cases.speed / (at_unit * np.sqrt(np.where(known, stiffness, 1.0))), nan)


def standard_stiffness(inputs: RatingInputs) -> Array:
    """c_gamma_alpha of the standard (c,), NaN where it has none [N/(mm um)]."""
    return np.asarray(inputs.standard.mesh_stiffness * iso6336.share_of_stiffness(inputs.load))


def vibration(inputs: RatingInputs) -> dict[str, Array]:
    """Reduced mass, resonance ratios and what excites the mesh (c,), by their names."""
    excitation = inputs.loads.excitation
    return {
        "reduced_mass": np.full(len(inputs.torque), reduced_mass(inputs)),
        "resonance_ratio": resonance_ratio(inputs, standard_stiffness(inputs)),
        "resonance_ratio_of_analysis": resonance_ratio(inputs, excitation["mesh_stiffness"]),
        **errors_of(excitation),
    }


def errors_of(excitation: dict[str, Array]) -> dict[str, Array]:
    """Those of the excitation that a rating has: transmission error of the analysis, peak to peak and order 1 [um]."""
    return {name: excitation[name] for name in ("transmission_error_span", "transmission_error_order_1")}
