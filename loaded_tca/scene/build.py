"""From sections in the engineer's units to what the numerics take: the one place where units are converted."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from loaded_tca.errors import InputError
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.flanks.spline import DEFAULT_POINTS, fitted, measured
from loaded_tca.flanks.topography import MeasuredDeviations, MeasuredPoints, Topography
from loaded_tca.material import Material
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.scene.flank_form import FITTED_DEGREE, FlankForm, Measurement
from loaded_tca.scene.section import Section, as_table
from loaded_tca.scene.sections import ElasticMaterial, Gear

UNITS = {"mm": 1.0, "um": 1e-3, "deg": math.pi / 180.0, "MPa": 1.0, "Nm": 1e3}
"""Unit at the end of a key -> factor to mm, rad, MPa and N mm."""


def in_base_units(section: Section) -> dict[str, Any]:
    """Return the values of a section in mm, rad, MPa and N mm, by names without unit; without keys not given.

    Examples
    --------
    >>> in_base_units(ElasticMaterial(youngs_modulus_MPa=206000, poisson_ratio=0.3))
    {'youngs_modulus': 206000.0, 'poisson_ratio': 0.3}
    """
    values = {}
    for key, value in as_table(section).items():
        name, _, unit = key.rpartition("_")
        if unit not in UNITS:
            values[key] = value
        else:
            values[name] = _scaled(value, UNITS[unit])
    return values


def _scaled(value: Any, factor: float) -> Any:
    return tuple(_scaled(entry, factor) for entry in value) if isinstance(value, tuple) else value * factor


def build_modifications(pinion: Gear, wheel: Gear) -> tuple[FlankModifications, FlankModifications]:
    """Return the modifications of both flanks."""
    return (
        FlankModifications(**in_base_units(pinion.modifications)),
        FlankModifications(**in_base_units(wheel.modifications)),
    )


def build_materials(materials: tuple[ElasticMaterial, ElasticMaterial]) -> tuple[Material, Material]:
    """Return the materials of both gears."""
    return Material(**in_base_units(materials[0])), Material(**in_base_units(materials[1]))


def build_flanks(pair: GearPair, forms: tuple[FlankForm, FlankForm], in_contact: bool) -> GearPair:
    """Return the pair with its flanks in the forms that are asked for.

    Parameters
    ----------
    pair : GearPair
        Of analytic flanks.
    forms : (FlankForm, FlankForm)
        Of pinion and wheel.
    in_contact : bool
        Whether these flanks are those in contact by the scene, which are the ones that were measured.

    Raises
    ------
    InputError
        If a flank cannot be fitted, with the section that asks for it.
    """
    pinion, wheel = (
        _build_flank(flank, form, name, in_contact)
        for name, flank, form in zip(("pinion", "wheel"), (pair.pinion.flank, pair.wheel.flank), forms, strict=True)
    )
    return pair.with_flanks(pinion, wheel)


def _build_flank(flank: Flank, form: FlankForm, owner: str, in_contact: bool) -> Flank:
    try:
        if form.form == "bspline":
            return fitted(flank, form.points or DEFAULT_POINTS, form.degree or FITTED_DEGREE)
        if form.measurement is not None and in_contact:
            return measured(
                flank, build_topography(form.measurement), degree=form.degree, coefficients=form.coefficients
            )
    except InputError as error:
        raise InputError(f"{owner}.flank: {problem}" for problem in error.problems) from None
    return flank


def build_topography(measurement: Measurement) -> Topography:
    """Return the measured points, or deviations."""
    values = in_base_units(measurement)
    notes = {"source": values["source"]}
    if measurement.x_mm is not None:
        return MeasuredPoints(np.stack([values["x"], values["y"], values["z"]], axis=-1), notes)
    return MeasuredDeviations(values["radius"], values["axial"], values["deviation"], notes)
