"""What an uneven load along the face does to the root stress: finite elements beside ISO 6336-3.

Spur pair 25/37 of 20 mm width at the pitch point under 100 N m, its pinion crowned by 10 um (the pair that
``validation.calculix.pairs_in_space`` has), or misaligned until the load falls to nothing at one end of the face. The
load of the loaded contact, and the same force spread evenly, give the largest root tension of the pinion each; their
ratio stands beside K_Fbeta = K_Hbeta^N_F of the same load, K_Hbeta the largest load of 30 strips of the face over their
mean.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from loaded_tca.analysis import analyse
from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, RootStress, root_stress_model
from loaded_tca.errors import AccuracyWarning
from loaded_tca.reference import iso6336_3
from loaded_tca.scene import parse_scene
from validation.calculix.case import FACE_WIDTH
from validation.calculix.comparison import SCENE
from validation.calculix.pairs_in_space import CROWNING, ONE_POSITION
from validation.table import Row

CASE = "root stress under an uneven load, pitch point, 100 N m"
SOURCE, ISO = "prototype of the same finite elements", "ISO 6336-3, K_Fbeta"
PAIRS: dict[str, tuple[dict[str, object], float, float]] = {
    "crowned 10 um": (CROWNING, 1.218, 1.421),
    "misaligned 19 um": ({"mounting.misalignment_um": 19.0, "analysis.cells": [32, 96]}, 1.478, 1.616),
}
"""Changes of the scene; ratio of the largest tensions, and K_Fbeta, of the prototype."""
AS_PROTOTYPE = 0.01
STRIPS = 30
HEIGHT_OVER_WIDTH = 6.75 / FACE_WIDTH
"""Of the pinion's tooth; ISO takes no more than 1/3."""


@dataclass(frozen=True)
class Uneven:
    """Root tension of the pinion under the load of a contact.

    Attributes
    ----------
    height : (n,) array [mm]
        Of the slices along the face.
    line_load : (n,) array [N/mm]
    along : (p,) array [mm]
        Places along the face.
    tension, even : (p,) array [MPa]
        Largest of the section under this load, and under the same force spread evenly.
    contact_factor, iso_factor : float
        K_Hbeta and K_Fbeta.
    """

    height: Array
    line_load: Array
    along: Array
    tension: Array
    even: Array
    contact_factor: float
    iso_factor: float

    @property
    def ratio(self) -> float:
        """Largest tension over that under an even load."""
        return float(self.tension.max() / self.even.max())


def uneven(changes: dict[str, object], roots: RootStress | None = None) -> Uneven:
    """Analyse a pair at the pitch point, and the stress at the roots of its pinion."""
    scene = parse_scene(SCENE.format(face_width=FACE_WIDTH)).with_changes({**ONE_POSITION, **changes})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the load ends with the face
        one = analyse(scene).maps[0][0][0]
    roots = roots or root_stress_model(scene.pair().pinion)
    step = one.spacing[1]
    force = one.pressure.sum(axis=0) * one.spacing[0] * step
    inside = np.abs(one.y) < 0.5 * FACE_WIDTH + 0.5 * step
    height, force = one.y[inside], force[inside]
    radius = np.full(len(height), 37.5)
    line = FlankLine(0, radius, np.clip(height, -0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH))
    ends = np.clip(np.stack([height - 0.5 * step, height + 0.5 * step]), -0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH)
    cells = ends[1] - ends[0]
    spread = force.sum() * cells / FACE_WIDTH
    own, even = (roots.stress(0, [(line, forces)])[0].max(axis=0) for forces in (force, spread))
    strips = np.linspace(-0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH, STRIPS + 1)
    carried = np.diff(np.interp(strips, np.append(ends[0, 0], ends[1]), np.append(0.0, np.cumsum(force))))
    factor = float(carried.max() / carried.mean())
    iso = iso6336_3.face_load_factor(factor, HEIGHT_OVER_WIDTH)
    along = np.linspace(-0.5, 0.5, len(own)) * FACE_WIDTH
    return Uneven(height, force / cells, along, own, even, factor, iso)


def rows() -> list[Row]:
    """Both ratios of both pairs."""
    found = []
    for name, (changes, ratio, factor) in PAIRS.items():
        one = uneven(changes)
        note = f"K_Hbeta {one.contact_factor:.3f}"
        found += [
            Row(CASE, SOURCE, f"{name}: largest tension over that of an even load", ratio, one.ratio, AS_PROTOTYPE),
            Row(CASE, SOURCE, f"{name}: K_Fbeta of the same load", factor, one.iso_factor, AS_PROTOTYPE, note=note),
            Row(CASE, ISO, f"{name}: largest tension over that of an even load", one.iso_factor, one.ratio, None),
        ]
    return found
