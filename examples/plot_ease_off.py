"""Ease-off topography
===================

Ease-off topography of a helical pair whose two gears are modified and whose axes are not parallel.

Writes ease_off.png: how much the pinion lacks of the conjugate of the wheel's flank, in um, with the values at the
corners of the flank, and what the field is to second order: angles, crownings and twist. Both modifications and the
mounting error are in it, as if they were all on the pinion.
"""

from pathlib import Path

import numpy as np

from loaded_tca import read_scene
from loaded_tca.flank_maps import ease_off_map
from loaded_tca.plots import plot_ease_off, save_figure

SCENE = Path(__file__).parent / "scenes" / "helical.toml"
CHANGES = {
    "pinion.modifications.lead_crowning_um": 8.0,
    "pinion.modifications.twist_um": 6.0,
    "wheel.modifications.lead_crowning_um": 4.0,
    "wheel.modifications.profile_crowning_um": 5.0,
    "mounting.out_of_plane_deg": 0.02,
}


def main() -> float:
    """Return the lengthwise crowning of the ease-off over the sum of both crownings: 1 to first order."""
    scene = read_scene(SCENE).with_changes(CHANGES)
    ease_off = ease_off_map(scene.pair())
    numbers = ease_off.second_order
    print(f"corners [um], foot and tip, each at z < 0 and z > 0: {np.round(1e3 * ease_off.corners, 1).tolist()}")
    print(numbers)
    save_figure(
        plot_ease_off(ease_off, "Helical pair, both gears modified, out-of-plane error 0.02 deg"), "ease_off.png"
    )
    crownings = (gear.modifications.lead_crowning_um for gear in (scene.pinion, scene.wheel))
    return 1e3 * numbers.lengthwise_crowning / sum(crownings)


if __name__ == "__main__":
    main()
