"""Pressure of a crowned pinion on a ring, convex on concave, against Hertz's elliptical contact.

The relative curvature across the contact is that of two involutes on one side of the line of action, 1/a1 - 1/a2 with
the roll lengths a1 and a2; along it that of the lead crowning, 8 C/b^2. One tooth pair carries all, on flanks alone, at
the pitch point. Hertz has bodies of constant curvature: the contact is small
against the radii, and the grids are those of an accuracy of 1e-3; asked for are 2e-3.
"""

import numpy as np

from loaded_tca import analyse, parse_scene
from loaded_tca.material import Material, contact_modulus
from loaded_tca.reference.hertz import point_contact
from validation.table import Row

CASE, SOURCE = "crowned pinion in a ring", "Johnson 1985, eqs. 4.24-4.33"
CROWNING, WIDTH = 0.02, 25.0
SCENE = """
title = "crowned pinion in a ring"
[pair]
type = "cylindrical"
normal_module_mm = 3.0
[pinion]
teeth = 25
face_width_mm = 25.0
profile_shift = 0.0
modifications.lead_crowning_um = 20.0
[wheel]
teeth = -60
face_width_mm = 25.0
tip_diameter_mm = 175.2
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


def rows(pairs: tuple[tuple[int, int], ...] = ((25, 60), (40, 60), (35, 90))) -> list[Row]:
    """Peak pressure at the pitch point of pairs, over Hertz's."""
    modulus = contact_modulus(*(Material(206000.0, 0.3),) * 2)
    table = []
    for pinion, ring in pairs:
        changes = {"pinion.teeth": pinion, "wheel.teeth": -ring, "wheel.tip_diameter_mm": 3.0 * ring - 4.8}
        scene = parse_scene(SCENE).with_changes(changes)
        mesh, result = scene.mesh(), analyse(scene)
        roll = mesh.path_of_contact.C
        curvatures = 1.0 / roll - 1.0 / (roll - mesh.path_of_contact.T2), 8.0 * CROWNING / WIDTH**2
        hertz = point_contact(5e3 / mesh.pinion.base_radius, curvatures, modulus)
        name = f"peak pressure of {pinion}/-{ring}, 5 N m [MPa]"
        peak = float(np.nanmax(result.peak_pressure))
        table.append(Row(CASE, SOURCE, name, hertz.max_pressure, peak, 2e-3))
    return table
