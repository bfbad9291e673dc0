"""How far root stress of helical, bevel and face-milled gears is converged: the mesh of the model beside finer ones.

All have their layers along the face in full: sections and layers are made finer one after the other, since both at once
take several GiB. The table has one gear of each kind of bevel tooth, of the face-milled ones that with the largest
errors; helical roots stand beside another program's in ``root_stress_space``. All of them take minutes.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import MeshDensity, RootStress
from loaded_tca.compliance.root_stress import stress_density
from loaded_tca.gears import bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.gear import Gear
from loaded_tca.scene import read_scene
from validation.loaded.root_stress_models import CASE, FINER, finer, line_on, model_of, spur_pair_gear
from validation.table import Row

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
CONVERGED = 0.02
LINES = (
    (0.4, 1.0, 0.5, 0.0),
    (0.7, 1.0, 0.5, 0.0),
    (1.0, 1.0, 0.5, 0.0),
    (0.7, 0.3, 0.5, 0.0),
    (0.7, 0.3, 0.85, 0.0),
    (0.5, 0.6, 0.5, 0.8),
    (0.5, 0.6, 0.45, -0.8),
    (0.6, 0.3, 0.2, 0.6),
)
"""Height, part of the face, its middle, and rise of the height over the whole face, of the loads."""
FACE_MILLED = {"19x62": "face_milled_19x62_matched", "20x30": "duplex_30x20"}
"""Scenes: a generated pair with sharp fillets, and one of a duplex spread blade."""


def families() -> dict[str, Gear]:
    """Gears of the families; 12 mm wide but for the face-milled ones."""
    straight, spiral = (
        bevel_pair(bevel_mesh((20, 40), outer_module=4.0, face_width=12.0, spiral_angle=radians(angle)))
        for angle in (0.0, 30.0)
    )
    found = {
        "helical, 30 deg": spur_pair_gear(width=12.0, helix_deg=30.0),
        "straight bevel wheel": straight.wheel,
        "spiral bevel pinion": spiral.pinion,
        "spiral bevel wheel": spiral.wheel,
    }
    for name, scene in FACE_MILLED.items():
        pair = read_scene(SCENES / f"{scene}.toml").pair()
        found |= {f"face-milled pinion of {name}": pair.pinion, f"face-milled wheel of {name}": pair.wheel}
    return found


IN_TABLE = ("straight bevel wheel", "spiral bevel pinion", "face-milled wheel of 19x62")


def largest(model: RootStress) -> Array:
    """Largest tension of the loaded side and compression of the back (lines, 2) under ``LINES`` [MPa/N]."""
    found = (model.stress(0, [line_on(model, *line)]) for line in LINES)
    return np.array([(stress[0].max(), stress[1].min()) for stress in found])


def finer_meshes(density: MeshDensity) -> dict[str, MeshDensity]:
    """Half as many elements more, in sections or along the face."""
    fine = finer(density)
    return {
        "sections": replace(fine, lengthwise=density.lengthwise),
        "layers along the face": replace(density, lengthwise=fine.lengthwise),
    }


def rows() -> Iterator[Row]:
    """Largest stresses of some gears against finer meshes."""
    return _rows(IN_TABLE)


def whole_rows() -> Iterator[Row]:
    """Largest stresses of every gear against finer meshes."""
    return _rows(families())


def _rows(names: Iterable[str]) -> Iterator[Row]:
    gears = families()
    for name in names:
        gear = gears[name]
        density = stress_density(gear)
        found = largest(model_of(gear, density))
        for direction, fine in finer_meshes(density).items():
            error = np.abs(found / largest(model_of(gear, fine)) - 1.0)
            for quantity, value in zip(("tension", "compression"), error.max(axis=0), strict=True):
                words = f"{name}, {density.lengthwise} layers: {quantity}, against finer {direction}"
                yield Row(CASE, FINER, words, 0.0, float(value), CONVERGED)
