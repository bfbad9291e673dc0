"""Where the rating after ISO 6336 and the analysis part by more than a tenth, and why, measured on three pairs.

Writes ``docs/studies/where_methods_part.md``: python -m validation.rating.methods_part. Face load factors: FZG C14, a
spur and a helical pair with straight flanks and a misalignment of 10 um in the plane of action, without running in; the
spur pair again with faces of 10 to 80 mm under one line load. Contact temperatures: FZG A gears (16/24, m_n 4.5 mm,
x 0.8532/-0.5, d_a 88.7/112.5 mm, b 20 mm, a_w 91.5 mm) at 2170 1/min and the torques of ``iso6336_21.STAGE_TORQUES``,
by the slices of a solved mesh (part 20) and by one pair at the end E of the path (part 21). Assumed: an oil of 100 and
11.1 mm2/s at 40 and 100 C, Ra 0.35 um.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np

from loaded_tca import analyse, parse_scene, read_scene
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.reference import iso6336_1, iso6336_21, iso6336_22
from loaded_tca.results import MeshCycle
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.load_factors import strip_borders, strip_forces
from loaded_tca.tribology import Lubricant
from validation.page import SCENES, Page, machine, table, write_page

MISALIGNMENT, WIDTHS, LOAD = 10.0, (10.0, 20.0, 40.0, 80.0), 10.0  # um, mm, N m of the pinion for each mm
PAIRS = (("FZG C14", "fzg_c14", 200.0), ("spur 34/57", "mesh_cycle_spur", 200.0), ("helical 34/57", "helical", 400.0))
"""Name, scene, torque [N m]."""
PLAIN: dict[str, Any] = {
    "pinion.modifications": None,
    "wheel.modifications": None,
    "mounting": None,
    "analysis.positions": 9,
    "analysis.torques_Nm": None,
    "analysis.accuracy": None,
    "analysis.cells": (8, 32),
    "analysis.root_stress": False,
}
STAGES, OIL_TEMPERATURES, SPEED, ROUGHNESS = (5, 8, 10, 12), (90.0, 80.0), 2170.0, 0.35
FZG_A = """
[pair]
type = "cylindrical"
normal_module_mm = 4.5
centre_distance_mm = 91.5
[pinion]
teeth = 16
face_width_mm = 20.0
profile_shift = 0.8532
tip_diameter_mm = 88.7
[wheel]
teeth = 24
face_width_mm = 20.0
profile_shift = -0.5
tip_diameter_mm = 112.5
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 302.0
[analysis]
positions = 13
cells = [16, 16]
"""


@dataclass(frozen=True)
class Tilted:
    """K_Hbeta of a pair with straight flanks, aligned and misaligned, and stiffnesses [N/(mm um)]."""

    width: float
    load: float
    standard: float
    mean: float
    without_torsion: float
    aligned: float
    misaligned: float
    few: float
    many: float

    @property
    def method_c(self) -> float:
        """K_Hbeta by method C with c_gamma_beta, 0.85 c_gamma_alpha."""
        return self.with_stiffness(0.85 * self.standard)

    @property
    def tilt(self) -> float:
        """Stiffness of method C with which the misalignment raises K_Hbeta as it does."""
        return 2.0 * self.load * (self.misaligned - self.aligned) / MISALIGNMENT

    def with_stiffness(self, stiffness: float) -> float:
        """K_Hbeta by the formula of method C with another stiffness."""
        return float(iso6336_1.contact_face_load_factor(MISALIGNMENT, stiffness, self.load))


def tilted(name: str, **changes: Any) -> Tilted:
    """Analyses of a scene, aligned and misaligned."""
    scene = read_scene(SCENES / f"{name}.toml").with_changes(PLAIN | changes)
    with noted_accuracy_warnings(given=False):  # straight flanks reach the ends of their faces
        aligned, misaligned = (
            analyse(scene.with_changes({"mounting.misalignment_um": amount})) for amount in (0.0, MISALIGNMENT)
        )
    mesh = scene.mesh()
    load = float(misaligned.torque[0]) / mesh.pinion.reference_radius / mesh.common_face_width
    few, many = _by_pairs(misaligned)
    mean = mean_over_a_pitch(misaligned.mesh_stiffness[0])
    return Tilted(
        mesh.common_face_width, load, scene.contact_standard.mesh_stiffness,
        mean, misaligned.without_body_torsion(mean), float(aligned.face_load_factor[0]),
        float(misaligned.face_load_factor[0]), few, many,
    )  # fmt: skip


def _by_pairs(result: MeshCycle) -> tuple[float, float]:
    """Largest over mean force of strips, the mean of positions with the fewest and of those with the most pairs."""
    borders, numbers, factors = strip_borders(result.gear_pair, result.path), [], []
    for maps in result.maps[0][:-1]:
        loaded = [one for one in maps if one is not None]
        forces = np.sum([strip_forces(result.gear_pair, one, borders)[0] for one in loaded], axis=0)
        numbers.append(len(loaded))
        factors.append(float(forces.max() / forces.mean()))
    count, values = np.array(numbers), np.array(factors)
    return float(values[count == count.min()].mean()), float(values[count == count.max()].mean())


def faces() -> tuple[str, str, str]:
    """Tables of K_Hbeta of three pairs, of the steps between, and over the width of the face."""
    pairs = {name: tilted(scene, **{"load.pinion_torque_Nm": torque}) for name, scene, torque in PAIRS}
    values = table(
        "pair | b [mm] | F_t/b [N/mm] | method C | analysis | aligned | fewest pairs | most pairs",
        (
            f"{name} | {one.width:g} | {one.load:.0f} | {one.method_c:.2f} | **{one.misaligned:.2f}** | "
            f"{one.aligned:.2f} | {one.few:.2f} | {one.many:.2f}"
            for name, one in pairs.items()
        ),
    )
    steps = table(
        "pair | c_γβ | c_γα | mean of the analysis | without torsion of bodies | against tilting | K with the mean",
        (
            f"{name} | {0.85 * one.standard:.1f} | {one.standard:.1f} | {one.mean:.1f} | {one.without_torsion:.1f} | "
            f"{one.tilt:.1f} | {one.with_stiffness(one.mean):.2f}"
            for name, one in pairs.items()
        ),
    )
    wide = [
        tilted(
            "mesh_cycle_spur",
            **{
                "pinion.face_width_mm": width, "wheel.face_width_mm": width, "load.pinion_torque_Nm": LOAD * width,
                "analysis.cells": (8, max(16, int(1.2 * width))),
            },
        )
        for width in WIDTHS
    ]  # fmt: skip
    over_width = table(
        "b [mm] | method C | analysis | mean stiffness | against tilting | ratio",
        (
            f"{one.width:g} | {one.method_c:.2f} | {one.misaligned:.2f} | {one.mean:.1f} | {one.tilt:.1f} | "
            f"{one.tilt / one.mean:.2f}"
            for one in wide
        ),
    )
    return values, steps, over_width


def temperatures() -> str:
    """Table of safeties of FZG A gears under the torque of the load stage at which their oil fails."""
    torques = [iso6336_21.STAGE_TORQUES[stage - 1] for stage in STAGES]
    with noted_accuracy_warnings(given=False):  # contacts reach tips, which are sharp
        result = analyse(parse_scene(FZG_A).with_changes({"analysis.torques_Nm": torques}))
    rows = []
    for oil_temperature in OIL_TEMPERATURES:
        oil = Lubricant(viscosity_40=100.0, viscosity_100=11.1, oil_temperature=oil_temperature)
        for place, stage in enumerate(STAGES):
            with noted_accuracy_warnings(given=False):
                hot = result.tribology(
                    SPEED, lubricant=oil, roughness_um=(ROUGHNESS, ROUGHNESS), scuffing_load_stage=stage
                )
            friction, bulk = float(hot.mean_friction[place]), float(hot.bulk_temperature[place])
            flash, mean_flash = float(hot.largest_flash_temperature[place]), _flash_at_end(result, place, friction)
            mean = iso6336_21.integral_temperature(oil_temperature, mean_flash)
            safety = iso6336_21.scuffing_integral_temperature(stage, oil.viscosity_40) / mean
            rows.append(
                f"{oil_temperature:g} | {stage} | {torques[place]:g} | {bulk:.0f} | {flash:.0f} | "
                f"{float(hot.scuffing_safety[place]):.2f} | {mean:.0f} | {safety:.2f}"
            )
    return table(
        "oil [°C] | stage | pinion torque [N m] | bulk [°C] | largest flash [K] | S_B, part 20 | integral [°C] | "
        "S_intS, part 21",
        rows,
    )


def _flash_at_end(result: MeshCycle, torque: int, friction: float) -> float:
    """Mean flash temperature of ISO/TS 6336-21 [K]: that at E, where one pair would carry all, times X_eps."""
    mesh, pair = result.scene.mesh(), result.gear_pair
    path, pitch = mesh.path_of_contact, mesh.pinion.base_pitch
    rolls, speed = (path.E, path.T2 - path.E), 2.0 * pi * SPEED / 60.0
    radius = rolls[0] * rolls[1] / sum(rolls)
    line_load = float(result.torque[torque]) / mesh.pinion.base_radius / mesh.common_face_width
    pressure = sqrt(line_load * pair.contact_modulus / (pi * radius))
    rolling = [1e-3 * speed * rolls[0], 1e-3 * speed * rolls[1] * mesh.pinion.teeth / mesh.wheel.teeth]
    coefficients = [gear.material.thermal_contact_coefficient for gear in (pair.pinion, pair.wheel)]
    flash = iso6336_22.flash_temperature(
        friction, pressure, radius, 2.0 * pair.contact_modulus, *rolling, abs(rolling[0] - rolling[1]), *coefficients
    )
    factor = iso6336_21.contact_ratio_factor((path.E - path.C) / pitch, (path.C - path.A) / pitch)
    return float(flash) * factor


def make() -> Page:
    """Measure, and write the page."""
    values, steps, over_width = faces()
    return Page(
        "where_methods_part", TEXT.format(values, steps, over_width, temperatures(), machine=machine(numpy=True))
    )


TEXT = """# Where the standard and the analysis part

Written by `python -m validation.rating.methods_part`. Machine: {machine}.

A rating takes K_Hβ of the analysis; method C of ISO 6336-1 gives another K_Hβ. The two parts of ISO 6336 on scuffing
give different temperatures. Where these numbers differ by more than a tenth, this page says why, by measured numbers.

## Face load factors: narrow faces are stiffer against tilting than in method C

The flanks are straight, with 10 µm of misalignment in the plane of action over the face and no running-in. The table
has K_Hβ by method C of ISO 6336-1, with c_γβ = 0.85 c_γα, and K_Hβ of the analysis: with this misalignment, aligned,
and with the misalignment at the positions with the fewest and with the most pairs in contact.

{0}

Method C takes equal springs along the face, each of which yields only under its own load. One stiffness then says how
far teeth yield under an even load and under a load that is concentrated at one end. In the analysis these are two
stiffnesses. With the stiffness against tilting, the formula of method C gives the rise of K_Hβ by the misalignment
that the analysis has; it is larger than the mean stiffness of the mesh [N/(mm µm)]:

{1}

1. The mean stiffness of the analysis and that of the standard differ by little, in either direction: with the mean
   stiffness of the analysis the formula gives nearly the K_Hβ of method C.
2. Teeth and bodies carry the load at one place also to its neighbours. Under an even load all places yield together,
   and their deflections add up; under a load at one end the deflections partly cancel. The stiffness against tilting
   is therefore larger than the mean stiffness, the more so the narrower the face is. The torsion of the bodies is a
   part of the mean stiffness, but not of the stiffness against tilting.
3. In double contact both pairs are misaligned, and the stiffness of both acts against the misalignment: K_Hβ at
   positions of spur gears with two pairs is larger than at positions with one pair; the standard takes a mean. Contact
   lines of helical pairs cover only a part of the face at a time, so that K_Hβ of single positions says less.
4. c_γβ is 0.85 c_γα: this is 15 % of the rise of K_Hβ.

The width alone shows the second reason: the spur pair under 10 N m per mm of face width, with 10 µm over each face. On
a face of 80 mm the stiffness against tilting is nearly the mean stiffness.

{2}

For faces as narrow as those of the pairs above, take K_Hβ of the analysis.

## Contact temperatures of FZG test gears

The load stage of an oil in the FZG test A/8.3/90 is the stage at which the test gears scuff. A gear under the torque of
the stage at which its oil fails should have a safety of 1. Part 20 compares the largest contact temperature with
θ_S = 80 °C + 2.25 X_L S², part 21 a mean temperature:

{3}

1. In both parts θ_S grows with the square of the stage, and so does the torque of the stages; S_B should therefore be
   the same at all stages. But the constant of θ_S is 80 °C, while the oil of the test has 90 °C: this difference of 10
   K is large compared with the rise at stage 5. With oil of 80 °C the safety hardly changes with the stage.
2. Part 21 divides temperatures, part 20 divides their rises above the oil: the ratio of part 21 is therefore nearer to
   1.
3. The largest flash temperature of the analysis is that of a pair that shares the load at E, or carries it alone
   farther in; part 21 takes that of one pair that carries the whole load at E, times X_ε.

S_B of gears in hot oil is therefore on the safe side, if the oil fails at a low load stage.
"""


if __name__ == "__main__":
    write_page(__doc__, make)
