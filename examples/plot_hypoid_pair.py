"""A hypoid pair synthesised from its sheet
========================================

Cut the hypoid pair 13/42 of ``make_hypoid.py`` with three lengthwise crownings against the conjugate of the wheel, and
draw the ease-off of the middle one: hypoid_pair.png.
"""

from math import radians

import numpy as np

from loaded_tca import trace_contact
from loaded_tca.flank_maps import ease_off_map
from loaded_tca.flanks import Mismatch, synthesised_gears
from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
from loaded_tca.pairs import face_milled_pair
from loaded_tca.plots import plot_ease_off, save_figure

TEETH, OFFSET, FACE_WIDTH, CUTTER_RADIUS = (13, 42), 15.0, 30.0, 63.5
CROWNINGS_mm = [0.03, 0.05, 0.08]


def main() -> float:
    """Return the ratio of the levers where P is held over that of the teeth: one."""
    cones = pitch_cones_by_method_1(TEETH, OFFSET, 170.0, FACE_WIDTH, radians(50), CUTTER_RADIUS)
    blank = HypoidBlank(TEETH, cones, FACE_WIDTH, CUTTER_RADIUS, profile_shift=0.3, thickness_modification=0.05)
    for crowning in CROWNINGS_mm:
        gears = synthesised_gears(blank, "left", Mismatch(profile=0.010, lengthwise=crowning))
        pair = face_milled_pair(*gears, offset=OFFSET)
        path = trace_contact(pair, np.array([-0.5, 0.0, 0.5]) * pair.pitch)
        errors = np.degrees(path.transmission_error) * 3600.0 + 0.0
        print(f"{1e3 * crowning:.0f} um: {errors.round(1)[[0, 2]]} arcsec half a pitch before and after P")
        if crowning == CROWNINGS_mm[1]:
            save_figure(plot_ease_off(ease_off_map(pair), "Hypoid pair 13/42, drive side"), "hypoid_pair.png")
    return float(path.pinion_lever[1] / path.wheel_lever[1]) * TEETH[1] / TEETH[0]


if __name__ == "__main__":
    main()
