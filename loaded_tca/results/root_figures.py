"""Key figures of root stress, beside those of ISO 6336-3."""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.pairs.gear import Gear
from loaded_tca.reference.iso6336_3 import THINNEST_RIM, face_load_factor, rim_thickness_factor
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.quantities import GEARS, PLACE

FACTORS = "form", "stress_correction", "helix_angle"
"""Of ISO 6336-3, as their key figures are named."""


def root_figures(result: CycleNumbers, torque: int) -> dict[str, float]:
    """Return the figures of root stress under one torque, by names that end in their unit; NaN: not known.

    Parameters
    ----------
    result : MeshCycle
        Of a scene that asks for root stress.
    torque : int
        Index of the torque.
    """
    found: dict[str, float] = {}
    nominal = [float(result.torque[torque]) * per_torque for per_torque in result.scene.nominal_root_stress]
    ratio, factor = result.scene.tooth_height_over_width, float(result.face_load_factor[torque])
    of_roots = math.nan if math.isnan(ratio + factor) else face_load_factor(max(1.0, factor), ratio)
    gears = result.gear_pair.pinion, result.gear_pair.wheel
    for gear, name in enumerate(GEARS):
        found[f"{name}_rim_thickness_factor_iso_6336"] = math.nan if math.isnan(ratio) else rim_factor(gears[gear])
        found |= _extreme(result, torque, gear, "root_tension") | _extreme(result, torque, gear, "root_compression")
        found[f"{name}_root_stress_ratio"] = float(result.root_stress_ratio[torque, gear])
        found[f"{name}_nominal_root_stress_iso_6336_MPa"] = nominal[gear]
        factors = zip(FACTORS, result.scene.root_factors[gear], strict=True)
        found |= {f"{name}_{what}_factor_iso_6336": value for what, value in factors}
        found[f"{name}_root_stress_iso_6336_MPa"] = nominal[gear] * of_roots
    return found | {"root_face_load_factor_iso_6336": of_roots}


def rim_factor(gear: Gear) -> float:
    """Rim thickness factor Y_B of a gear with a bore, given or by default; NaN for a rim too thin for the standard."""
    rim = gear.rim_over_height
    return rim_thickness_factor(rim) if rim > THINNEST_RIM else math.nan


def _extreme(result: CycleNumbers, torque: int, gear: int, name: str) -> dict[str, float]:
    """Largest tension or compression of a gear over the positions, and where it is."""
    stress, figure = getattr(result, name)[torque, :, gear], f"{GEARS[gear]}_{name}"
    position = int(np.where(np.isnan(stress), -1.0, np.abs(stress)).argmax())

    def there(part: str) -> float:
        return float(getattr(result, f"{name}{part}")[torque, position, gear])

    place = getattr(result, f"{name}_place")[torque, position, gear]
    stressed = bool(abs(stress[position]) > 0.0)
    return {
        f"{figure}_MPa": there(""),
        f"pinion_angle_at_{figure}_deg": math.degrees(result.pinion_angle[position]) if stressed else math.nan,
        f"{figure}_angle_deg": math.degrees(there("_angle")),
        f"{figure}_axial_mm": there("_axial"),
        f"{figure}_on_back": bool(place[PLACE.index("side")] == 1),
    }
