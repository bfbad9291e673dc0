"""Load sharing
============

How the tooth pairs of a spur gear share the torque, with a tip relief that brings them in without a step.

Writes load_sharing.png.
"""

from pathlib import Path

from loaded_tca import analyse, read_scene
from loaded_tca.plots import plot_load_share, save_figure

SCENE = Path(__file__).parent / "scenes" / "mesh_cycle_spur.toml"
POSITIONS = 17


def main() -> float:
    """Return what a tooth pair carries half a pitch before and behind its pitch point, together: the whole torque."""
    scene = read_scene(SCENE).with_changes({"analysis.torques_Nm": None, "analysis.positions": POSITIONS})
    result = analyse(scene)
    print(result.summary())
    save_figure(plot_load_share(result), "load_sharing.png")

    pair_at_pitch_point = result.dataset.load_share.isel(torque=0).sel(pair=0)
    return float(pair_at_pitch_point[0] + pair_at_pitch_point[-1])


if __name__ == "__main__":
    main()
