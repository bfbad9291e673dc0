"""Teeth whose tip edges and face ends are rounded, and the radii that they have room for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.rounding import LOWER, TIP, UPPER, EdgeRounding, RoundedFlank, edge_places, material_cosines
from loaded_tca.tooth.families import ToothForm, ToothGeometry

ROUNDING = 1e-12
LARGEST = 0.3
"""Largest radius of a rounded edge, over the normal module."""


@dataclass(frozen=True)
class RoundedTooth(ToothGeometry):
    """Teeth with rounded edges; models of how they bend, which are of unmodified teeth, are those of sharp edges.

    Attributes
    ----------
    sharp : ToothGeometry
    rounding : EdgeRounding
    """

    sharp: ToothGeometry
    rounding: EdgeRounding

    @property
    def unmodified(self) -> ToothGeometry:
        """The teeth without modifications, with sharp edges."""
        return self.sharp.unmodified

    def nominal(self, side: int) -> Flank:
        """Flank of a side without modifications, with sharp edges."""
        return self.sharp.nominal(side)

    def modified(self, nominal: Flank) -> Flank:
        """A flank with its modifications and rounded edges."""
        return RoundedFlank(self.sharp.modified(nominal), self.rounding)

    def form(self) -> ToothForm:
        """Form of a tooth without its flanks: thickness, root surface and fillet."""
        return self.sharp.form()


def rounding_problems(geometry: ToothGeometry, flank: Flank, rounding: EdgeRounding, module: float) -> list[str]:
    """What is wrong with the radii of rounded edges, each with its key ``tip_rounding`` or ``side_rounding``.

    Parameters
    ----------
    geometry : ToothGeometry
    flank : Flank
        In contact, without modifications.
    rounding : EdgeRounding
    module : float [mm]
        Normal module.
    """
    of_module = LARGEST * module, f"{LARGEST:g} normal modules"
    limits = {"tip": [of_module], "side": [of_module]}
    if rounding.tip > 0.0:
        root = flank.grid(2, 33)
        height = float(np.min(flank.edges(*(part[0] for part in root))[TIP].value))
        reach = 1.0 + float(material_cosines(flank, TIP, *edge_places(flank, TIP)).max())
        limits["tip"].append(
            (height / reach, f"with which no flank is left above its root edge, {height:.4g} mm below")
        )
        limits["tip"] += _limit_of_land(geometry, flank)
    if rounding.side > 0.0:
        rho, z = edge_places(flank, LOWER)
        width = float(np.min(flank.edges(rho, z)[UPPER].value))
        reach = sum(1.0 + float(material_cosines(flank, end, *edge_places(flank, end)).max()) for end in (LOWER, UPPER))
        limits["side"].append(
            (width / reach, f"with which no flank is left between the ends of the face, {width:.4g} mm apart")
        )
    problems = []
    for name, radius in (("tip", rounding.tip), ("side", rounding.side)):
        most, why = min(limits[name])
        if radius > most * (1.0 + ROUNDING):
            problems.append(f"{name}_rounding_mm: found {radius:g}; allowed up to {most:.4g} mm, {why}")
    return problems


def _limit_of_land(geometry: ToothGeometry, flank: Flank) -> list[tuple[float, str]]:
    """Radius [mm] with which the roundings of both flanks meet on the tip land; none where a tooth has one flank."""
    try:
        flanks, form = (flank, geometry.nominal(-flank.side)), geometry.form()
    except (InputError, GeometryError):  # as of a cutter with one blade
        return []
    rho, z = edge_places(flank, TIP)
    angle, lengths, slopes = np.full(rho.shape, 2.0 * form.half_thickness_angle), np.zeros(rho.shape), []
    for own in flanks:
        jet, distance = own.theta(rho, z), own.edges(rho, z)[TIP]
        cosine = material_cosines(own, TIP, rho, z)
        angle += own.side * jet.value
        lengths += (1.0 + cosine) / np.sqrt(1.0 - cosine**2)
        slopes.append(rho * (jet.z * distance.rho - jet.rho * distance.z))
    slope: Array = 0.5 * (slopes[0] + slopes[1])
    width = np.maximum(rho * angle, 0.0) / np.sqrt(1.0 + slope**2)
    worst = int((width / lengths).argmin())
    reason = f"with which the arcs of both flanks meet on the tip land, {width[worst]:.4g} mm wide"
    return [(float(width[worst] / lengths[worst]), reason)]
