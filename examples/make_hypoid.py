"""A hypoid pair from its dimension sheet
======================================

Make ``scenes/hypoid_13x42.toml``: pitch cones by method 1 of ISO 23509, blanks, and machine settings of both gears by
local synthesis. Teeth, offset, wheel diameter, face width, cutter and factors are those of the second pair of annex F
of ISO 23509, whose forces are in ISO/TR 10300-30; its taper is replaced by the duplex one, which suits a pinion both of
whose flanks are cut at once.
"""

import sys
from math import radians
from pathlib import Path

from loaded_tca.flanks import Mismatch, synthesised_gears
from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
from loaded_tca.scene import hypoid_table, scene_from_table

SCENES = Path(__file__).parent / "scenes"
TEETH, OFFSET, FACE_WIDTH, CUTTER_RADIUS = (13, 42), 15.0, 30.0, 63.5
HEADER = """\
# Hypoid pair 13/42 with an offset of 15 mm: teeth, offset, wheel, cutter and factors of the second pair of annex F of
# ISO 23509, with a duplex taper. Blanks and machine settings are made by examples/make_hypoid.py: the flank of the
# pinion's drive side is crowned by 10 um along the profile and 50 um along the face against the conjugate of the wheel.
# Torque: ISO/TR 10300-30 (F_mt1 9366.1 N, F_n 15298.7 N). Edge radii of the blades, mismatch, reliefs and material:
# assumed. Apexes and machine centre to back count from the crossing points of the axes.

title = "Hypoid pair 13/42, offset 15 mm"
"""
RELIEF = {"tip_relief_um": 20.0, "tip_relief_start_length_mm": 4.3}
FURTHER = {
    "material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3},
    "load": {"pinion_torque_Nm": 250.0},
    "analysis": {"positions": 9, "accuracy": 1e-2},
}


def blank() -> HypoidBlank:
    """Blanks of both gears."""
    cones = pitch_cones_by_method_1(
        TEETH,
        OFFSET,
        wheel_diameter=170.0,
        face_width=FACE_WIDTH,
        pinion_spiral_angle=radians(50),
        cutter_radius=CUTTER_RADIUS,
    )
    return HypoidBlank(
        TEETH,
        cones,
        FACE_WIDTH,
        CUTTER_RADIUS,
        profile_shift=0.3,
        thickness_modification=0.05,
        taper="duplex",
        backlash=0.2,
    )


def table():
    """Sections of the scene, with all digits."""
    dimensions = blank()
    gears = synthesised_gears(dimensions, "left", Mismatch(0.010, 0.050), edge_radii=(0.7, 0.8))
    sections = hypoid_table(gears, dimensions.cones) | FURTHER
    for gear in ("pinion", "wheel"):
        sections[gear]["modifications"] = RELIEF
    return sections


def text(sections, path=""):
    """Tables as TOML, lengths and angles to 1e-7."""
    lines = [f"\n[{path}]"] if path else []
    lines += [f"{key} = {shown(value)}" for key, value in sections.items() if not isinstance(value, dict)]
    inner = [(key, value) for key, value in sections.items() if isinstance(value, dict)]
    return "\n".join(lines + [text(value, f"{path}.{key}" if path else key) for key, value in inner])


def shown(value):
    """A value as TOML."""
    if isinstance(value, float):
        return f"{round(value, 7) + 0.0!r}"
    return f'"{value}"' if isinstance(value, str) else str(value)


def main() -> str:
    """Return the text of the scene file."""
    return HEADER + text(table()) + "\n"


if __name__ == "__main__":
    scene_from_table(table())  # every key is looked at
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else SCENES / "hypoid_13x42.toml"
    path.write_text(main(), encoding="utf-8")
