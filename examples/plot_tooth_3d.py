"""Teeth in contact in space
=========================

Teeth of a spiral bevel pair in contact, in space, with the contact path and the pressure on the pinion's flank.

Writes tooth_3d.png. For a viewer, ``loaded-tca run`` and then ``loaded-tca tooth`` write the same as VTK and STL files.
"""

from pathlib import Path

import numpy as np

from loaded_tca import analyse, read_scene
from loaded_tca.output import teeth_in_space
from loaded_tca.pairs import mating_teeth
from loaded_tca.plots import draw_teeth, save_figure
from loaded_tca.tooth import Resolution

SCENE = Path(__file__).parent / "scenes" / "spiral_bevel.toml"


def main() -> float:
    """Return the force that the pressure on the flank adds up to, over the one that the torque asks for."""
    scene = read_scene(SCENE).with_changes(
        {"analysis.positions": 9, "analysis.accuracy": None, "analysis.cells": (48, 48)}
    )
    result = analyse(scene)
    middle = len(result.path) // 2

    teeth = mating_teeth(scene.pair(), Resolution(flank=25, fillet=9, land=3, lengthwise=25))
    pinion = teeth.pinion.triangles(closed=True)
    print(f"one tooth of the pinion with its part of the rim: {pinion.volume:.2f} mm3, {pinion.area:.2f} mm2")

    shown = teeth_in_space(result, teeth, middle)
    save_figure(draw_teeth(result, shown), "tooth_3d.png")

    sizes = np.linalg.norm(shown.pressure.normals, axis=1)  # mm2
    carried = float((sizes * shown.pressure.cell_data["pressure_MPa"]).sum())  # N
    return carried / float(result.normal_force[0, middle, shown.column])


if __name__ == "__main__":
    main()
