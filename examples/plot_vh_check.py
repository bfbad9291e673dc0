"""V-H check without load
======================

V-H check of a crowned spiral bevel pair: where the marking compound is squeezed out under mounting errors.

Writes vh_check.png: the contact pattern on the pinion for offsets V of the wheel and axial displacements H of the
pinion, and prints how far its centre goes.
"""

from pathlib import Path

import numpy as np

from loaded_tca import read_scene
from loaded_tca.flank_maps import vh_check
from loaded_tca.pairs import GearPair
from loaded_tca.plots import plot_vh_check, save_figure

SCENE = read_scene(Path(__file__).parent / "scenes" / "spiral_bevel.toml")
OFFSETS = (-0.02, 0.0, 0.02)  # mm
DISPLACEMENTS = (-0.02, -0.01, 0.0, 0.01, 0.02)  # mm


def build(offset: float, displacement: float) -> GearPair:
    """Return the pair under an offset V and an axial displacement H of the pinion."""
    return SCENE.with_changes({"mounting.offset_mm": offset, "mounting.pinion_axial_mm": displacement}).pair()


def main() -> float:
    """Return the shift for H over that for -H, which to first order is -1."""
    check = vh_check(build, OFFSETS, DISPLACEMENTS)
    names = ("V: offset [mm]", "H: axial displacement of the pinion [mm]")
    save_figure(plot_vh_check(check, names, SCENE.title), "vh_check.png")
    along = check.shift[:, :, 0]
    print(f"towards the heel [mm], V down, H to the right:\n{np.round(along, 2)}")
    return float(along[1, 3] / along[1, 1])


if __name__ == "__main__":
    main()
