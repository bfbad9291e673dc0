"""Rating of bevel and hypoid pairs: stresses, strengths, safeties, lives after ISO 10300, method B1, and local ones."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, pi
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import GeometryError, InputError, named
from loaded_tca.rating.bevel_sheet import BevelSheet, bevel_sheet
from loaded_tca.rating.evaluate import (
    Evaluated,
    OfRoot,
    both,
    endurances_of_flanks,
    flank_conditions,
    flank_strengths,
    in_order,
    local_flanks,
    of_both_roots,
    of_flanks,
    of_root,
    on_drive,
)
from loaded_tca.rating.inputs import CommonInputs, common_inputs
from loaded_tca.rating.loads import flank_face_load_factor, run_in
from loaded_tca.rating.vibration import errors_of
from loaded_tca.reference import iso6336, iso6336_1, iso10300_1, iso10300_2, iso10300_3
from loaded_tca.reference.iso6336_2 import FlankFactors
from loaded_tca.reference.iso17485 import single_pitch_tolerance
from loaded_tca.scene.rating import ANALYSIS, METHOD_B
from loaded_tca.scene.spiral import SpiralScene

if TYPE_CHECKING:
    from loaded_tca.rating.lives import Endurance
    from loaded_tca.reference.iso6336_3 import RootSection
    from loaded_tca.results.numbers import CycleNumbers

Arrays = dict[str, Array]
STEEL_MODULUS = 206e3 / (2.0 * (1.0 - 0.3**2))
"""E* of two steel gears, whose stiffnesses the standard has [MPa]."""
NEARLY = 0.05
ALIKE = "K_Halpha: from the analysis of equal teeth, without the pitch deviations that method B covers"


@dataclass(frozen=True, eq=False)
class BevelInputs(CommonInputs):
    """What a rating after ISO 10300 takes besides.

    Attributes
    ----------
    sheet : BevelSheet
    """

    scene: SpiralScene
    sheet: BevelSheet
    of_bevels: ClassVar[bool] = True

    @property
    def normal_module(self) -> float:
        """m_mn [mm]."""
        return self.sheet.pair.mean_normal_module

    def root_section(self, place: int) -> RootSection:
        """Critical section of the pinion, 0, or the wheel, 1, after ISO 10300-3."""
        return self.sheet.root_section(place)

    def of_scene(self, scene: Any, **changes: Any) -> Self:
        """The same of another scene of the same gears, with changes of other fields."""
        return replace(self, scene=scene, sheet=bevel_sheet(scene), **changes)

    @property
    def mean_force(self) -> Array:
        """F_mt1, tangential at the mean point of the pinion (c,) [N]."""
        return self.torque / (0.5 * self.sheet.mean_diameters[0])

    @property
    def virtual_force(self) -> Array:
        """F_vmt, of the virtual gears (c,) [N]."""
        return self.mean_force * self._virtual

    @property
    def factor_force(self) -> Array:
        """F_vmt for load factors (c,) [N]."""
        return self.cases.factor_torque / (0.5 * self.sheet.mean_diameters[0]) * self._virtual

    @property
    def _virtual(self) -> float:
        """F_vmt over F_mt1."""
        pair = self.sheet.pair
        return cos(pair.spiral_angle) / cos(pair.spiral_angles[0])

    @property
    def velocity(self) -> Array:
        """v_mt2, of the wheel at its mean point (c,) [m/s]."""
        teeth, speed = self.sheet.teeth, self.cases.speed
        return 1e-3 * pi * self.sheet.mean_diameters[1] * speed * teeth[0] / teeth[1] / 60.0


def bevel_inputs_of(result: CycleNumbers) -> BevelInputs:
    """Sections of the scene of a result that a rating of bevel pairs needs.

    Raises
    ------
    InputError
        With everything that is missing or not covered.
    """
    scene = result.scene
    assert isinstance(scene, SpiralScene)
    problems: list[str] = []
    try:
        sheet = bevel_sheet(scene)
        for place in range(len(GEARS)):
            sheet.root_section(place)
    except InputError as error:
        problems += error.problems
    except GeometryError as error:
        problems.append(f"pair: ISO 10300-3 gives no root stress for this pair: {error}")
    common = common_inputs(result, problems)
    return BevelInputs(result, scene, **common, sheet=sheet)


def bevel_evaluated(inputs: BevelInputs) -> Evaluated:
    """Numbers after ISO 10300, and by the local stresses."""
    share = iso10300_2.load_sharing_factor(inputs.sheet.pair, inputs.rating.profile_crowning)
    loads, notes = _load_factors(inputs, share**2)
    stresses, hypoid, held = _contact_stresses(inputs, loads, share)
    flanks = _flank_factors(inputs, hypoid)
    rated = of_flanks(inputs, flanks, stresses["sigma_H"])
    roots, endurances, root_notes = _of_roots(inputs, loads, share**2)
    local = local_flanks(inputs, loads, flanks.strength)
    arrays = {"torque": np.asarray(inputs.torque), "cycles": inputs.cycles}
    arrays |= loads | errors_of(inputs.loads.excitation) | stresses | rated | roots | local
    endurances |= endurances_of_flanks(inputs, flanks.curves, arrays)
    scope = iso10300_1.scope_notes(inputs.sheet.pair, inputs.sheet.face_width)
    remarks = (*scope, *notes, *inputs.sheet.notes, *held, *flanks.notes, *root_notes)
    return arrays, in_order(endurances), tuple(dict.fromkeys(remarks))


def _pitch_deviation(inputs: BevelInputs) -> Array:
    """f_pt of the gear with more teeth after running in (c,) [um]."""
    sheet, grade = inputs.sheet, inputs.rating.tolerance_class
    assert grade is not None
    gear = sheet.wheel
    with named(f"rating.tolerance_class: {GEARS[gear]}"):
        deviation = single_pitch_tolerance(
            sheet.teeth[gear], sheet.pair.mean_normal_module, sheet.tolerance_diameter(gear), grade
        )
    return deviation - run_in(inputs, deviation)


def _load_factors(inputs: BevelInputs, share: float) -> tuple[Arrays, tuple[str, ...]]:
    """K_A, K_v, K_Hbeta, K_Halpha, K_Fbeta and K_Falpha (c,) by their names, and notes; ``share`` is Z_LS^2.

    K_Halpha of the analysis is the largest share of a tooth pair in the load over that of the standard, from 1 on.
    """
    wanted, sheet, ones = inputs.rating, inputs.sheet, np.ones(len(inputs.torque))
    application = inputs.operation.application_factor
    effective, whole = sheet.pair.widths
    softer = iso10300_1.load_share(inputs.factor_force * application / effective)
    load = inputs.factor_force * application / whole
    dynamic, notes = ones * inputs.operation.dynamic_factor, _stiffness_notes(inputs)
    if wanted.dynamic_factor == METHOD_B:
        dynamic, more = _dynamic_factor(inputs, load, softer)
        notes += more
    face = flank_face_load_factor(inputs)
    if wanted.transverse_load_factor == METHOD_B:
        transverse = iso10300_1.transverse_load_factor(
            load * dynamic * face,
            mesh_stiffness=iso10300_1.MESH_STIFFNESS * softer,
            pitch_deviation=_pitch_deviation(inputs),
            total_contact_ratio=sheet.pair.total_contact_ratio,
            relative_offset=2.0 * abs(sheet.offset) / sheet.mean_diameters[1],
        )
    elif wanted.transverse_load_factor == ANALYSIS:
        transverse = np.maximum(inputs.loads.transverse_load_factor / share, 1.0)
        notes += (ALIKE,)
    else:
        transverse = ones * float(wanted.transverse_load_factor)
    curved = iso10300_1.lengthwise_curvature_factor(
        sheet.cutter_radius, sheet.members[1].mean_cone_distance, sheet.members[1].spiral_angle
    )
    factors = {
        "K_A": ones * application, "K_gamma": ones, "K_v": dynamic, "K_Hbeta": face, "K_Halpha": transverse,
        "K_Fbeta": face / curved, "K_Falpha": transverse,
    }  # fmt: skip
    return factors, notes


def _stiffness_notes(inputs: BevelInputs) -> tuple[str, ...]:
    """What is to be known of the stiffnesses by method B."""
    wanted, modulus = inputs.rating, inputs.result.gear_pair.contact_modulus
    if METHOD_B not in (wanted.dynamic_factor, wanted.transverse_load_factor):
        return ()
    if abs(modulus / STEEL_MODULUS - 1.0) <= NEARLY:
        return ()
    return ("c', c_gamma: the values are those of steel, but the gears are not of steel",)


def _dynamic_factor(inputs: BevelInputs, load: Array, softer: Array) -> tuple[Array, tuple[str, ...]]:
    """K_v (c,) by method B, and notes."""
    sheet, (first, second) = inputs.sheet, inputs.scene.materials
    mass = iso10300_1.reduced_mass(
        sheet.mean_diameters, sheet.mean_pressure_angle, (first.density_kg_m3, second.density_kg_m3)
    )
    speeds = iso6336_1.resonance_speed(sheet.teeth[0], iso10300_1.MESH_STIFFNESS, mass) * np.sqrt(softer)
    return iso10300_1.dynamic_factor(
        inputs.cases.speed / speeds,
        load,
        pitch_deviation=_pitch_deviation(inputs),
        total_contact_ratio=sheet.pair.total_contact_ratio,
        single_stiffness=iso10300_1.SINGLE_STIFFNESS * softer,
    )


def _contact_stresses(inputs: BevelInputs, loads: Arrays, share: float) -> tuple[Arrays, float, tuple[str, ...]]:
    """Contact stress of the standard and its factors; Z_Hyp, and a note where a bound of it counts."""
    pair, ones = inputs.sheet.pair, np.ones(len(inputs.torque))
    elastic = iso6336.elasticity_factor(inputs.result.gear_pair.contact_modulus)
    zone = iso10300_2.mid_zone_factor(pair)
    hypoid, bounded = 1.0, False
    if inputs.sheet.offset:
        hypoid, bounded = iso10300_2.hypoid_factor(pair.spiral_angles, pair.contact_line_angle, pair.pressure_angle)
    of_force = iso10300_2.nominal_contact_stress(1.0, pair, zone * share * elastic)
    nominal = of_force * np.sqrt(inputs.mean_force / (cos(pair.pressure_angle) * cos(pair.spiral_angles[0])))
    product = loads["K_A"] * loads["K_v"] * loads["K_Hbeta"] * loads["K_Halpha"]
    arrays = {
        "Z_MB": zone * ones, "Z_LS": share * ones, "Z_E": elastic * ones, "Z_KP": iso10300_2.BEVEL_FACTOR * ones,
        "Z_Hyp": hypoid * ones, "sigma_H0": nominal,
        "sigma_H": on_drive(inputs, both(inputs, np.stack([nominal * np.sqrt(product)] * len(GEARS)))),
    }  # fmt: skip
    return arrays, hypoid, ("Z_Hyp: counts as 0.6, the least of the standard",) if bounded else ()


def _flank_factors(inputs: BevelInputs, hypoid: float) -> FlankFactors:
    """What both flanks withstand."""
    with named("rating of flanks"):
        return iso10300_2.bevel_flank_factors(
            *flank_strengths(inputs),
            hypoid_factor=hypoid,
            relative_radius=inputs.sheet.pair.relative_radius,
            gear_ratio=inputs.sheet.gear_ratio,
            **flank_conditions(inputs),
        )


def _of_roots(
    inputs: BevelInputs, loads: Arrays, share: float
) -> tuple[Arrays, dict[str, tuple[Endurance, Endurance]], tuple[str, ...]]:
    """Root stress, strength and safety of both gears after ISO 10300-3, and by the computed root tension."""
    pair, ones = inputs.sheet.pair, np.ones(len(inputs.torque))
    ratio = iso10300_3.contact_ratio_factor(pair)
    spiral = iso10300_3.bevel_spiral_angle_factor(pair, inputs.sheet.whole_depths)
    nominal = inputs.virtual_force * (ratio * spiral * share / (pair.widths[1] * pair.mean_normal_module))
    straight = () if pair.spiral_angle else ("Y_BS: 1; the standard has not validated it for straight teeth",)
    arrays, endurances, notes = of_both_roots(inputs, lambda place: _of_root(inputs, loads, nominal, place))
    return (
        arrays | {"Y_eps": ratio * ones, "Y_BS": spiral * ones, "Y_LS": share * ones},
        endurances,
        (*straight, *notes),
    )


def _of_root(inputs: BevelInputs, loads: Arrays, nominal: Array, place: int) -> OfRoot:
    """Root of one gear; ``nominal`` lacks Y_Fa Y_Sa."""
    section = inputs.root_section(place)
    nominal = nominal * section.form_factor * section.stress_correction_factor
    stress = nominal * loads["K_A"] * loads["K_v"] * loads["K_Fbeta"] * loads["K_Falpha"]
    standard, endurances, notes = of_root(inputs, loads, place, stress)
    factors = {"Y_Fa": section.form_factor, "Y_Sa": section.stress_correction_factor, "sigma_F0": nominal}
    arrays = {name: np.asarray(value, dtype=float) for name, value in factors.items()} | standard
    return arrays, endurances, (*inputs.sheet.edge_notes(place), *notes)
