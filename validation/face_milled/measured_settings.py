"""Settings from measured flanks: errors that are known are found from flanks that a swept cutter leaves.

The flanks are those of :mod:`validation.face_milled.swept_cutter`, which solves no equation of meshing and takes no
derivative: cut once with the settings and once with wrong ones, and compared as a measuring centre would. Both flanks
of each gear of the matched 19 x 62 pair are measured at 3 x 5 points, and stand at an azimuth of their own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import radians

import numpy as np

from loaded_tca import read_scene
from loaded_tca.flank_maps import MeasuredFlank, fit_settings
from loaded_tca.flanks import GeneratedFlank, MeasuredDeviations
from loaded_tca.gears.face_milled import FaceMilledGear, FlankName
from validation.face_milled.swept_cutter import turns_swept
from validation.table import Row

SCENE = "examples/scenes/face_milled_19x62_matched.toml"
ERRORS = {
    "machine.radial_mm": 0.03,
    "machine.root_angle_deg": -0.02,
    "machine.ratio_of_roll": 0.001,
    "machine.blank_offset_mm": 0.05,
    "machine.tilt_deg": 0.05,
}
FOUND = 1e-6
"""Relative, of errors; the swept flanks have 1e-10 of their movements, which are 10 um."""


def rows() -> list[Row]:
    """Errors of the settings of pinion and wheel."""
    return [*_rows("pinion"), *_rows("wheel")]


def _rows(name: str) -> Iterator[Row]:
    scene = read_scene(SCENE)
    gear: FaceMilledGear = getattr(scene.mesh(), name)
    machine = gear.machine
    wrong = replace(
        gear,
        machine=replace(
            machine,
            radial=machine.radial + ERRORS["machine.radial_mm"],
            root_angle=machine.root_angle + radians(ERRORS["machine.root_angle_deg"]),
            ratio_of_roll=machine.ratio_of_roll + ERRORS["machine.ratio_of_roll"],
            blank_offset=machine.blank_offset + ERRORS["machine.blank_offset_mm"],
            tilt=machine.tilt + radians(ERRORS["machine.tilt_deg"]),
        ),
    )
    measured = [_measured(gear, wrong, flank) for flank in ("concave", "convex")]
    fit = fit_settings(scene, measured, [f"{name}.{key}" for key in ERRORS])
    for (key, error), correction in zip(ERRORS.items(), fit.corrections, strict=True):
        quantity = f"{key}: its error, found from both flanks"
        yield Row(f"19 x 62, {name}", "swept cutter, numerically", quantity, error, -float(correction), FOUND)


def _measured(gear: FaceMilledGear, wrong: FaceMilledGear, flank: FlankName) -> MeasuredFlank:
    """Deviations of a wrongly cut flank, turned so that its first point has none."""
    surface = GeneratedFlank(gear, flank)
    rho, z = (part[1:-1, 1:-1] for part in surface.grid(5, 7))
    asked, cut = (turns_swept(one, flank, rho.ravel(), z.ravel()) for one in (gear, wrong))
    ahead = np.concatenate([[0.0], cut - asked]).reshape(rho.shape)
    excess = gear.side(flank) * ahead / surface.gradient_norm(rho, z).value
    return MeasuredFlank(gear.name, flank, MeasuredDeviations(rho, z, excess))
