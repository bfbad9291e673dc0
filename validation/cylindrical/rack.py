"""A pinion on a rack: pressure against Hertz's elliptical contact with a plane, and wheels that tend to the rack.

The relative curvature across the contact at the pitch point is that of the pinion alone, 1/(r sin(alpha_t)); along it
that of the lead crowning, 8 C/b^2. One tooth pair carries all, on flanks alone; the grids are those of an accuracy of
1e-3; asked for are 2e-3.

A rack stands as a gear of 2e6 teeth. With 1e4 and 1e5 teeth in their place, the same loaded analysis of the packaged
scene, with bending and load sharing, differs from it by parts that go with 1/z_2: they are in the ratio of
(1/1e4 - 1/2e6)/(1/1e5 - 1/2e6) = 10.474, to 3 %.
"""

import warnings
from math import cos, radians, sin
from pathlib import Path
from unittest.mock import patch

import numpy as np

from loaded_tca import AccuracyWarning, analyse, parse_scene, read_scene
from loaded_tca.gears.rack import RACK_TEETH
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference.hertz import point_contact
from validation.table import Row

CASE, SOURCE = "pinion on a rack", "Johnson 1985, eqs. 4.24-4.33"
EXAMPLE = Path(__file__).parents[2] / "examples" / "scenes" / "rack_and_pinion.toml"
CROWNING, WIDTH = 0.02, 25.0
SCENE = """
title = "crowned pinion on a rack"
[pair]
type = "cylindrical"
normal_module_mm = 3.0
[pinion]
teeth = 20
face_width_mm = 25.0
modifications.lead_crowning_um = 20.0
[wheel]
teeth = "rack"
face_width_mm = 25.0
height_mm = 20.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 5.0
[analysis]
positions = 1
accuracy = 1e-3
compliance = "contact"
load_sharing = false
free_edges = false
"""


def rows(counts: tuple[int, ...] = (20, 40)) -> list[Row]:
    """Peak pressures of pinions of so many teeth, over Hertz's; differences of wheels from the rack."""
    modulus = contact_modulus(*(Material(206000.0, 0.3),) * 2)
    table = []
    for teeth in counts:
        radius, alpha = 1.5 * teeth, radians(20.0)
        result = analyse(parse_scene(SCENE).with_changes({"pinion.teeth": teeth}))
        curvatures = 1.0 / (radius * sin(alpha)), 8.0 * CROWNING / WIDTH**2
        hertz = point_contact(5e3 / (radius * cos(alpha)), curvatures, modulus)
        name = f"peak pressure of {teeth}/rack, 5 N m [MPa]"
        table.append(Row(CASE, SOURCE, name, hertz.max_pressure, float(np.nanmax(result.peak_pressure)), 2e-3))
    return table + _limit_rows()


def _limit_rows() -> list[Row]:
    """Relative differences of a wheel of 1e5 teeth, and those of one of 1e4 over them."""
    scene = read_scene(EXAMPLE).with_changes({"analysis.positions": 3, "analysis.cells": (32, 64)})
    numbers = {}
    for teeth in (10_000, 100_000, RACK_TEETH):
        with patch("loaded_tca.gears.rack.RACK_TEETH", teeth), warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # the contact reaches edges
            changed = scene.with_changes({"title": f"{teeth} teeth"})
            figures = analyse(changed).key_figures()[0]
        names = "rack_transmission_error_mean_um", "peak_pressure_MPa"
        numbers[teeth] = np.array([figures[name] for name in names])
    far, near, rack = numbers.values()
    ratio = (1.0 / 10_000 - 1.0 / RACK_TEETH) / (1.0 / 100_000 - 1.0 / RACK_TEETH)
    table, source = [], "limit of many teeth"
    differences = zip(("mean transmission error", "peak pressure"), far / rack - 1.0, near / rack - 1.0, strict=True)
    for name, far_off, off in differences:
        table.append(Row(CASE, source, f"{name}: wheel of 1e5 teeth, difference", 0.0, float(off), 4e-4))
        table.append(Row(CASE, source, f"{name}: that of 1e4 over it", ratio, float(far_off / off), 0.03))
    return table
