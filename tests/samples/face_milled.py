"""Face-milled gears that tests share: the published 19 x 62 pair, its matched variant B, the duplex paper's pair D."""

import math
from dataclasses import replace

from loaded_tca.gears import Blade, Cutter, FaceMilledBlank, FaceMilledGear, MachineSettings

EDGE = 0.20845
OUTER, WIDTH = 132.33333847, 36.83
# tips stand off from the mating gear's root by 0.25 mean normal modules, so that the face cones have apexes of their
# own
CLEARANCE = 0.25 * 2.9402


def degrees(*angles):
    return tuple(math.radians(angle) for angle in angles)


def blank(pitch, face, root, hand, clearance=CLEARANCE, outer=OUTER, width=WIDTH):
    face_apex = -clearance / math.sin(face)
    return FaceMilledBlank(outer, width, pitch, face, root, hand, face_apex)


def published_pinion():
    blade = Blade(95.951739019, math.radians(20.0), edge_radius=EDGE)
    machine = MachineSettings(
        radial=97.959402908,
        cradle_angle=math.radians(52.796746783),
        root_angle=math.radians(15.640967271),
        machine_centre_to_back=-0.001306,
        ratio_of_roll=3.339685915,
    )
    cutter = Cutter(blade, replace(blade, point_radius=94.548260981))
    return FaceMilledGear(
        19, blank(*degrees(17.414716635, 19.336171904, 15.640967271), "left"), cutter, machine, "pinion"
    )


def published_wheel():
    """The point radius of its inside blade is inferred from the point width."""
    blade = Blade(96.439269791, math.radians(20.0), blade_radius=500.0, edge_radius=EDGE)
    machine = MachineSettings(
        radial=97.953678147,
        cradle_angle=math.radians(52.801158062),
        root_angle=math.radians(75.663828096),
        ratio_of_roll=1.023367029,
    )
    cutter = Cutter(blade, replace(blade, point_radius=94.060730209))
    return FaceMilledGear(
        62, blank(*degrees(77.585283365, 79.359032729, 75.663828096), "right"), cutter, machine, "wheel"
    )


def matched_pinion():
    """Pinion of pair B, whose concave flank fits the convex one of the published wheel."""
    pinion = published_pinion()
    blade = Blade(93.5, math.radians(18.3430), edge_radius=EDGE)
    return replace(pinion, cutter=Cutter(blade), machine=replace(pinion.machine, radial=96.8771))


def duplex_paper_gears(pinion_radial=57.1394):
    """Pair D: pinion radial setting, face width and addenda are constructed."""
    distance, width, clearance = 70.6007, 20.0, 0.564
    pitches = math.atan(20.0 / 30.0), math.atan(30.0 / 20.0)
    roots = degrees(31.09059, 52.51677)
    gears = []
    for member, (teeth, hand, radial, roll) in enumerate(
        ((20, "left", pinion_radial, 1.802776), (30, "right", 58.38392, 1.20185))
    ):
        face = pitches[member] + pitches[1 - member] - roots[1 - member]
        outline = blank(pitches[member], face, roots[member], hand, clearance, distance + 0.5 * width, width)
        blade = Blade(44.45, math.radians(20.0))
        machine = MachineSettings(radial, 0.0, roots[member], roll)
        gears.append(FaceMilledGear(teeth, outline, Cutter(blade, blade, 11), machine, ("pinion", "wheel")[member]))
    return gears


def on_machine(gear, **settings):
    """The gear with other machine settings."""
    return replace(gear, machine=replace(gear.machine, **settings))
