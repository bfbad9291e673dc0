"""A stage of a drive on its shafts, with its oil
==============================================

The pinion overhangs its bearings, so that it tilts under load: the load over the face beside that on rigid supports,
what a helix slope makes up for, and how the stage runs with its oil. Writes drive_stage.png and prints the numbers.
"""

from pathlib import Path

import numpy as np

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_face_load_on_supports, save_figure

SCENE = Path(__file__).parent / "scenes" / "drive_stage.toml"
CHANGES: dict[str, object] = {"analysis.positions": 9, "analysis.accuracy": 0.03}


def main() -> float:
    """Return the force on the pinion's bearings over the normal force of the teeth: one."""
    scene = read_scene(SCENE).with_changes(CHANGES)
    result = analyse(scene)
    rigid = analyse(scene.on_rigid_supports())
    corrected = analyse(scene.with_changes({"pinion.modifications.helix_slope_um": -20.0}))
    print(result.summary())
    print("misalignment [um]", result.misalignment.mean(axis=1))
    for name, one in {"rigid supports": rigid, "shafts": result, "shafts, helix slope -20 um": corrected}.items():
        print(f"K_Hbeta, {name}:", one.face_load_factor)
    print(result.tribology().summary())
    save_figure(plot_face_load_on_supports(result, rigid), "drive_stage.png")

    on_bearings = result.dataset["pinion_bearing_force"][..., :3].sum("pinion_bearing").values
    normal_force = result.torque / (rigid.gear_pair.base_radii[0] * np.cos(scene.mesh().pinion.base_helix_angle))
    return float(np.linalg.norm(on_bearings, axis=-1).mean(axis=1)[-1] / normal_force[-1])


if __name__ == "__main__":
    main()
