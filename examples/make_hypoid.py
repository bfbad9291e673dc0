"""A hypoid pair from its dimension sheet
======================================

Make ``scenes/hypoid_13x42.toml``: pitch cones by method 1 of ISO 23509, blanks, and machine settings of both gears by
local synthesis. Numbers of the design are those of the second pair of annex F of ISO 23509, whose forces are in ISO/TR
10300-30; its taper is replaced by the duplex one, which suits a pinion both of whose flanks are cut at once.
"""

import sys
from math import radians
from pathlib import Path

from loaded_tca.flanks import Mismatch, synthesised_gears
from loaded_tca.gears import HypoidBlank, pitch_cones_by_method_1
from loaded_tca.scene import hypoid_table

SCENES = Path(__file__).parent / "scenes"
TEETH, FACE_WIDTH, CUTTER_RADIUS = (13, 42), 30.0, 63.5
HEADER = """\
# Hypoid pair 13/42 with an offset of 15 mm: teeth, offset, wheel, cutter and factors of the second pair of annex F of
# ISO 23509, with a duplex taper. Blanks and machine settings are made by examples/make_hypoid.py: the flank of the
# pinion's drive side is crowned by 10 um along the profile and 50 um along the face against the conjugate of the wheel.
# Torque: ISO/TR 10300-30 (F_mt1 9366.1 N, F_n 15298.7 N). Edge radii of the blades, mismatch, reliefs and material:
# assumed. Apexes and machine centre to back count from the crossing points of the axes.

title = "Hypoid pair 13/42, offset 15 mm"
"""
RELIEF = {"modifications": {"tip_relief_um": 20.0, "tip_relief_start_length_mm": 4.3}}
FURTHER = {"material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3}, "load": {"pinion_torque_Nm": 250.0}}


def text(sections, path=""):
    """Tables as TOML, lengths and angles to 1e-7."""
    lines = [f"\n[{path}]"] if path else []
    for key, value in sections.items():
        if not isinstance(value, dict):
            lines.append(f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {round(value, 7) + 0!r}")
    inner = {f"{path}.{key}" if path else key: value for key, value in sections.items() if isinstance(value, dict)}
    return "\n".join([*lines, *(text(value, key) for key, value in inner.items())])


def main() -> str:
    """Return the text of the scene file."""
    cones = pitch_cones_by_method_1(TEETH, 15.0, 170.0, FACE_WIDTH, radians(50), CUTTER_RADIUS)
    factors = {"profile_shift": 0.3, "thickness_modification": 0.05, "backlash": 0.2, "taper": "duplex"}
    blank = HypoidBlank(TEETH, cones, FACE_WIDTH, CUTTER_RADIUS, **factors)
    gears = synthesised_gears(blank, "left", Mismatch(0.010, 0.050), edge_radii=(0.7, 0.8))
    sections = hypoid_table(gears, blank.cones) | FURTHER | {"analysis": {"positions": 9, "accuracy": 1e-2}}
    for gear in ("pinion", "wheel"):
        sections[gear] |= RELIEF
    return HEADER + text(sections) + "\n"


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else SCENES / "hypoid_13x42.toml"
    path.write_text(main(), encoding="utf-8")
