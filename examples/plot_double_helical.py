"""A double helical pair
=====================

The teeth of the wheel have their apex beside the middle of the groove, and half b of the pinion a helix slope. With
both gears held one half carries most of the torque, with a pinion that floats both carry the same. Writes
double_helical.png, the load over both halves of the gears that are held, and prints both summaries.
"""

from pathlib import Path

from loaded_tca import read_scene
from loaded_tca.double_helical import analyse_double_helical
from loaded_tca.plots import plot_halves_face_load, save_figure

SCENE = read_scene(Path(__file__).parent / "scenes" / "double_helical.toml")
CHANGES: dict[str, object] = {"analysis.positions": 5, "analysis.accuracy": 0.03}


def main() -> float:
    """Return how far the floating pinion follows the apex of the wheel, over the offset of that."""
    scene = SCENE.with_changes(CHANGES)
    held = analyse_double_helical(scene.with_changes({"pair.floating": "none"}))
    print(held.summary())
    save_figure(plot_halves_face_load(held), "double_helical.png")

    floating = analyse_double_helical(scene)
    print(floating.summary())
    without = analyse_double_helical(scene.with_changes({"pair.apex_offset_mm": 0.0}))
    return float((floating.axial_motion - without.axial_motion).mean()) / 0.03


if __name__ == "__main__":
    main()
