"""What is odd about whole gears before any contact: gears that jam or are no gears, inputs that look like slips."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import loaded_tca.warning_kinds as kinds
from loaded_tca.arrays import GEARS
from loaded_tca.compliance import require_teeth, warn_of_teeth
from loaded_tca.errors import give_accuracy_warning
from loaded_tca.gears.protuberance import notch_factor
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_3 import THIN_RIM
from loaded_tca.results.load_factors import NARROWEST_FACE, is_narrow
from loaded_tca.scene.build import arguments_by_keys
from loaded_tca.scene.section import values_of

if TYPE_CHECKING:
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.scene import Scene

ROUNDING = 1e-9
"""Relative, of a tip clearance."""
SMALLEST_um = 0.1
"""Amount of a modification or an error below which a question is asked; grinding holds a micrometre."""
SOFTEST, STIFFEST, LARGEST_TORQUE_Nm = 500.0, 1e6, 1e6
"""Moduli [MPa] of gear materials, from polyethylene to hard metal, and a torque [N m] beyond which a question is asked.
A modulus of metals in GPa is below the first."""
LEAST_CLEARANCE = 0.1
"""Tip clearance over the module below which a warning says so: basic racks have 0.17 to 0.4 (ISO 53)."""
HARDEST_MPa = 4000.0
"""Contact pressure that no gear steel carries: endurance limits of ISO 6336-5 end at 1650 MPa."""
STEEL_MPa, SOFTEST_METAL_MPa, HARDEST_PLASTIC = 206000.0, 1e4, 0.06
"""Moduli of steel and of the softest metal; the pressure that no plastic carries over its modulus: yield begins at 1.67
yield stresses (Johnson 1985, section 6.2), which are 3.5 % of the modulus at the most."""
HARDEST_ROOT_MPa = 1500.0
"""Root stress that no gear steel carries: nominal strengths sigma_FE of ISO 6336-5 end at 1050 MPa."""


def warn_of_gears(scene: Scene, pair: GearPair, *, whole_revolution: bool = False) -> None:
    """Give one AccuracyWarning for each reason why whole gears are not what the contact of two flanks says of them.

    Parameters
    ----------
    scene : Scene
    pair : GearPair
        Of the scene.
    whole_revolution : bool
        Whether the teeth stand at their own places in the analysis.

    Raises
    ------
    InputError, GeometryError
        If nothing can turn, or gear bodies that the scene asks for cannot be built.
    """
    for sentence in [
        *scene.interferences(),
        *scene.missing_shifts(),
        *_short_path(scene),
        *_odd_inputs(scene),
        *_small_clearances(scene, pair),
        *_notches(scene),
        *_constant_loads(scene),
        *_narrow_face(pair),
    ]:
        give_accuracy_warning(sentence)
    if scene.has_pitch_deviations and not whole_revolution:
        give_accuracy_warning(kinds.PITCH_DEVIATIONS.sentence())
    if scene.analysis.without_bodies:
        with arguments_by_keys(type(scene)):
            require_teeth(pair, scene.analysis.without_bodies)
    else:
        warn_of_teeth(pair)
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        if scene.analysis.root_stress and (rim := gear.rim_over_height) < THIN_RIM:
            give_accuracy_warning(kinds.THIN_RIM.sentence(gear=name, rim=rim, least=THIN_RIM))


def _short_path(scene: Scene) -> list[str]:
    """A sentence on cylindrical gears of which one pair leaves contact before the next one comes."""
    if scene.path_points and scene.pairs_in_contact < 1.0:
        return [kinds.CONTACT_RATIO.sentence(ratio=scene.pairs_in_contact)]
    return []


def hardest_pressure(*moduli: float) -> float:
    """Contact pressure [MPa] that no material with the least of some Young's moduli carries without yielding.

    That of metals is in proportion to their moduli, 4000 MPa of steel.
    """
    softest = min(moduli)
    return softest * (HARDEST_PLASTIC if softest < SOFTEST_METAL_MPa else HARDEST_MPa / STEEL_MPa)


def _odd_inputs(scene: Scene) -> list[str]:
    """Questions about numbers that look like those of another unit."""
    sentences = []
    for modulus in dict.fromkeys(material.youngs_modulus_MPa for material in scene.materials):
        what = f"{'less' if modulus < SOFTEST else 'more'} than the modulus of any gear material"
        if not SOFTEST <= modulus <= STIFFEST:
            key = "material.youngs_modulus_MPa"
            sentences.append(kinds.ODD_INPUT.sentence(key=key, value=modulus, unit="MPa", what=what))
    largest = 1e-3 * max(scene.torques)
    if largest > LARGEST_TORQUE_Nm:
        what = "more than the torque of any pinion on land"
        sentences.append(kinds.ODD_INPUT.sentence(key="load.pinion_torque_Nm", value=largest, unit="N m", what=what))
    return sentences


def questions(scene: Scene) -> list[str]:
    """Questions about numbers of a scene that look like those of another unit, or like a slip, before any contact.

    Amounts below a tenth of a micrometre are mm, mostly, and stresses of the standard beyond yield torques in N mm.
    """
    sentences = []
    for place, section in (("pinion", scene.pinion), ("wheel", scene.wheel), ("mounting", scene.mounting)):
        for key, value in values_of(section).items():
            if key.endswith("_um") and isinstance(value, float) and 0.0 < abs(value) < SMALLEST_um:
                what = f"less than {plain(SMALLEST_um, 6)} um, which nobody makes"
                name = f"{place}.{key}"
                sentences.append(kinds.ODD_INPUT.sentence(key=name, value=value, unit="um", what=what))
    torque = max(scene.torques)
    contact = scene.contact_standard.stress_per_root_torque * math.sqrt(torque)
    root = torque * max(scene.nominal_root_stress)
    hardest = hardest_pressure(*(material.youngs_modulus_MPa for material in scene.materials))
    for stress, most, name in ((contact, hardest, "sigma_H0"), (root, HARDEST_ROOT_MPa, "sigma_F0")):
        if stress > most:
            above = f"above {plain(most)} MPa, which no gear material carries"
            what = f"a torque with a {name} of {plain(stress)} MPa, {above}"
            sentences.append(
                kinds.ODD_INPUT.sentence(key="load.pinion_torque_Nm", value=1e-3 * torque, unit="N m", what=what)
            )
    return sentences


def _notches(scene: Scene) -> list[str]:
    """Sentences on the notches that grinding leaves at roots."""
    return [
        kinds.NOTCH.sentence(gear=gear, depth=1e3 * depth, percent=100.0 * (notch_factor(depth, radius) - 1.0))
        for gear, (depth, radius) in zip(GEARS, scene.grinding_notches, strict=False)
        if depth > 0.0
    ]


def _narrow_face(pair: GearPair) -> list[str]:
    """A sentence on a face whose ends are close together."""
    width = pair.face_width / pair.module
    return [kinds.NARROW_FACE.sentence(width=width, least=NARROWEST_FACE)] if is_narrow(pair) else []


def _constant_loads(scene: Scene) -> list[str]:
    """Sentences on loads on shafts under several torques, to analyse or of a load spectrum."""
    torques = {*scene.torques, *(1e3 * case.torque_Nm for case in scene.load.case or ())} - {0.0}
    return [
        kinds.CONSTANT_LOADS.sentence(gear=name, count=len(torques))
        for name, gear in zip(GEARS, (scene.pinion, scene.wheel), strict=True)
        if len(torques) > 1 and gear.shaft is not None and gear.shaft.loads
    ]


def _small_clearances(scene: Scene, pair: GearPair) -> list[str]:
    """Sentences on tips that come near to roots, or touch them; where they reach into them, nothing can turn."""
    return [
        kinds.CLEARANCE.sentence(clearance=max(0.0, round(clearance, 4)), gear=gear, least=LEAST_CLEARANCE)
        for gear, clearance in zip(GEARS, scene.tip_clearances, strict=False)
        if clearance < LEAST_CLEARANCE * pair.module * (1.0 - ROUNDING)
    ]
