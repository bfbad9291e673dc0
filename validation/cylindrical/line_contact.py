"""Unmodified spur and helical pairs: the pressure in the middle of the face against Hertz's line contact.

A finite line contact carries more at its ends, where the half-space of the solver goes on and gives a spike; the middle
has less than the mean line load. Its pressure is compared with line-contact Hertz at the line load of that section;
what the middle lacks of the mean line load F/l, and its pressure of Hertz's at F/l, is shown.
"""

from math import radians

import numpy as np

from loaded_tca import sample_separation, solve_contact, trace_contact
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import line_contact
from validation.table import Row

SOURCE = "Hertz, line contact"
CELLS = (64, 64)
MIDDLE = 1.5e-3
"""Three times what is seen: the line load of a section changes along the face."""


def rows() -> list[Row]:
    """Both pairs of the SAM paper without their crowning, and FZG C14, all at the pitch point."""
    return [
        *_middle("spur 34/57, unmodified", _pair((34, 57), 3.0, 25.0), 130e3),
        *_middle("helical 34/57, unmodified", _pair((34, 57), 3.0, 25.0, helix_angle=15.0), 130e3),
        *_middle("FZG C14", _pair((16, 24), 4.5, 14.0, shifts=(0.1817, 0.1715), centre_distance=91.5), 200e3),
    ]


def _pair(
    teeth: tuple[int, int],
    module: float,
    face_width: float,
    helix_angle: float = 0.0,
    shifts: tuple[float, float] = (0.0, 0.0),
    centre_distance: float | None = None,
) -> GearPair:
    gears = [
        CylindricalGear(z, module, face_width, helix_angle=hand * radians(helix_angle), profile_shift=x)
        for z, hand, x in zip(teeth, (1, -1), shifts, strict=True)
    ]
    return cylindrical_pair(CylindricalMesh(*gears, centre_distance))


def _middle(case: str, pair: GearPair, torque: float) -> list[Row]:
    contact = trace_contact(pair, [0.0])[0]
    load = torque / contact.pinion_lever
    separation = sample_separation(pair, contact, cells=CELLS, load=load)
    solution = solve_contact(separation.gap, separation.spacing, pair.contact_modulus, load=load, warn=False)
    columns = solution.pressure[:, CELLS[1] // 2 - 1 : CELLS[1] // 2 + 1].mean(axis=1)
    line_load = columns.sum() * separation.spacing[0]
    length = float(np.linalg.norm(contact.line_ends[1] - contact.line_ends[0]))
    hertz = line_contact(line_load, separation.curvatures[0], pair.contact_modulus)
    mean = line_contact(load / length, separation.curvatures[0], pair.contact_modulus)
    return [
        Row(case, SOURCE, "p0 in the middle of the face [MPa]", hertz.max_pressure, columns.max(), MIDDLE),
        Row(case, "Hertz at F/l", "p0 in the middle of the face [MPa]", mean.max_pressure, columns.max(), None),
        Row(case, "mean F/l", "line load in the middle of the face [N/mm]", load / length, line_load, None),
    ]
