"""Pressure of a crowned pinion on a ring, convex on concave, against Hertz's elliptical contact.

The relative curvature across the contact is that of two involutes on one side of the line of action, 1/a1 - 1/a2 with
the roll lengths a1 and a2; along it that of the lead crowning, 8 C/b^2. One tooth pair carries all, on flanks alone, at
pinion angles at which the ellipse lies inside the flank. Hertz has bodies of constant curvature: the contact is small
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
profile_shift = 0.3
modifications.lead_crowning_um = 20.0
[wheel]
teeth = -60
face_width_mm = 25.0
tip_diameter_mm = 175.2
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 20.0
[analysis]
positions = 3
accuracy = 1e-3
compliance = "contact"
load_sharing = false
free_edges = false
"""


def rows(torques: tuple[float, ...] = (20.0,)) -> list[Row]:
    """Peak pressure and the approach's counterpart, the normal force, at the positions, over Hertz's."""
    scene = parse_scene(SCENE).with_changes({"analysis.torques_Nm": list(torques)})
    result = analyse(scene)
    mesh = scene.mesh()
    modulus = contact_modulus(*(Material(206000.0, 0.3),) * 2)
    table = []
    for t, torque in enumerate(torques):
        for n in (1, 2):  # the pitch point, and half a pitch behind it
            roll = float(np.sqrt(result.path.pinion_radius[n] ** 2 - mesh.pinion.base_radius**2))
            of_ring = roll - mesh.path_of_contact.T2
            across, along = 1.0 / roll - 1.0 / of_ring, 8.0 * CROWNING / WIDTH**2
            hertz = point_contact(1e3 * torque / mesh.pinion.base_radius, (across, along), modulus)
            peak = float(np.nanmax(result.peak_pressure[t, n]))
            name = f"peak pressure, {torque:g} N m, roll length {roll:.2f} mm [MPa]"
            table.append(Row(CASE, SOURCE, name, hertz.max_pressure, peak, 2e-3))
    return table
