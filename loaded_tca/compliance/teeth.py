"""Whether the teeth of gears can be built, and how many layers of elements they have: all that a scene tells before."""

from __future__ import annotations

from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

import loaded_tca.warning_kinds as kinds
from loaded_tca.compliance.kept import MOST_IN_MEMORY
from loaded_tca.errors import GeometryError, InputError, give_accuracy_warning, named
from loaded_tca.flanks.rounding import sharp
from loaded_tca.tooth.surface import Resolution, build_tooth

if TYPE_CHECKING:
    from collections.abc import Iterator

    from loaded_tca.pairs.gear import Gear
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.tooth.families import ToothGeometry

CHECKED = Resolution(flank=9, fillet=5, land=3, lengthwise=5)
"""Points of a tooth that is built to see whether it exists."""
LAYERS_PER_HEIGHT = 2.5
"""Layers of elements across a face as wide as the teeth are high; between the two numbers below."""
FEWEST_LAYERS, MOST_LAYERS = 6, 24
TEETH_DO_NOT_BEND = 'analysis.compliance = "contact"'


@contextmanager
def way_out_told(way_out: str = TEETH_DO_NOT_BEND) -> Iterator[None]:
    """Add to errors about gear bodies the setting with which an analysis needs no gear bodies."""
    try:
        yield
    except (InputError, GeometryError) as error:
        raise type(error)(f"{error}; or set {way_out}") from None


def require_teeth(pair: GearPair, way_out: str = TEETH_DO_NOT_BEND) -> None:
    """Refuse gears whose teeth cannot be built, so that an analysis cannot let them bend.

    Parameters
    ----------
    pair : GearPair
    way_out : str
        What a scene may say so that nothing asks for complete teeth.

    Raises
    ------
    InputError
        If a bore reaches the teeth, or a cutter has no blade for their backs.
    GeometryError
        If a tooth is pointed or cut off without its modifications.

    Warns
    -----
    AccuracyWarning
        If a tooth is so with its modifications alone: it bends as the one without them.
    """
    with way_out_told(way_out):
        for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
            with named(name):
                _require_tooth(gear.geometry.unmodified)
        _ = pair.rigid_bores
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        if gear.sharp.flank is not gear.nominal_flank and (fault := _fault_of(gear)):
            give_accuracy_warning(kinds.UNMODIFIED_TOOTH.sentence(gear=name, fault=fault))


def warn_of_teeth(pair: GearPair) -> None:
    """Warn of teeth that cannot exist, though only their flanks in contact are computed.

    Parameters
    ----------
    pair : GearPair

    Warns
    -----
    AccuracyWarning
        If a tooth is pointed or cut off, or its back cannot be cut; one whose cutter has no blade for its back is not
        looked at.
    """
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        if fault := _fault_of(gear):
            give_accuracy_warning(kinds.NO_TOOTH.sentence(gear=name, fault=fault))


def _fault_of(gear: Gear) -> GeometryError | None:
    """Why the teeth of a gear cannot exist with their modifications; None: they do, or have no back."""
    try:
        if gear.sharp.flank is gear.nominal_flank:
            _require_tooth(gear.geometry.unmodified)
        else:
            build_tooth((sharp(gear.flanks[0]), sharp(gear.flanks[1])), gear.form, CHECKED)
    except GeometryError as error:
        return error
    except InputError:
        return None
    return None


@lru_cache(maxsize=MOST_IN_MEMORY)
def _require_tooth(teeth: ToothGeometry) -> None:
    """Refuse teeth that cannot be built; variants of the micro-geometry ask once."""
    build_tooth((teeth.nominal(1), teeth.nominal(-1)), teeth.form(), CHECKED)


def layers_across(gear: Gear) -> int:
    """Layers of elements across the face of a gear, by its width in heights of the tooth: the mean of both flanks."""
    layers = 0.0
    for flank in gear.nominal_flanks:
        rho, z = flank.grid(2, 2)
        height = float(np.hypot(rho[1] - rho[0], z[1] - z[0]).mean())
        layers += 0.5 * float(np.ptp(gear.form.sections.coordinate(rho, z))) / height
    return min(max(round(LAYERS_PER_HEIGHT * layers), FEWEST_LAYERS), MOST_LAYERS)
