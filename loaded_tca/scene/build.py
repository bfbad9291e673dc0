"""From sections in the engineer's units to what the numerics take: the one place where units are converted."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar

import numpy as np

from loaded_tca.errors import GeometryError, InputError, named, require
from loaded_tca.flanks.base import Flank
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.flanks.rounding import EdgeRounding
from loaded_tca.flanks.spline import DEFAULT_POINTS, fitted, measured, smoothing_coefficients
from loaded_tca.flanks.topography import LINES_NOTE, TWO_LINES, MeasuredDeviations, MeasuredPoints, Topography
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.pairs.tooth_deviations import ToothDeviations
from loaded_tca.plain import plain
from loaded_tca.scene.flank_form import FITTED_DEGREE, FlankForm, Measurement
from loaded_tca.scene.pitch import LARGEST_INDEX, Pitch
from loaded_tca.scene.section import Section, Subsection, as_table, entries
from loaded_tca.scene.sections import ElasticMaterial, GearSection
from loaded_tca.tooth import ToothForm, ToothGeometry
from loaded_tca.units import UNITS, ending_of, without_unit


def in_base_units(section: Section) -> dict[str, Any]:
    """Return the values of a section in mm, rad, MPa and N mm, by names without unit; without keys not given.

    Examples
    --------
    >>> from loaded_tca.scene import Load
    >>> in_base_units(Load(pinion_torque_Nm=130.0))
    {'pinion_torque': 130000.0}
    """
    return {
        without_unit(key): _scaled(value, UNITS[ending].factor) if (ending := ending_of(key)) else value
        for key, value in as_table(section).items()
    }


def _scaled(value: Any, factor: float) -> Any:
    return tuple(_scaled(entry, factor) for entry in value) if isinstance(value, tuple) else value * factor


def parameters_of(target: type, *sections: Section) -> dict[str, Any]:
    """Return those values of sections that a dataclass takes, in mm, rad, MPa and N mm."""
    names = {field.name for field in fields(target)}
    return {name: value for each in sections for name, value in in_base_units(each).items() if name in names}


def build_modifications(pinion: GearSection, wheel: GearSection) -> tuple[FlankModifications, FlankModifications]:
    """Return the modifications of both flanks."""
    return (
        FlankModifications(**in_base_units(pinion.modifications)),
        FlankModifications(**in_base_units(wheel.modifications)),
    )


def keys_of_arguments(scene: type[Section]) -> dict[str, str]:
    """Names of arguments, without unit -> the keys of a scene or of a section inside that give them with one.

    Examples
    --------
    >>> from loaded_tca.scene import CylindricalScene
    >>> keys_of_arguments(CylindricalScene)["tip_chamfer_angle"]
    'tip_chamfer_angle_deg'
    """
    keys: dict[str, str] = {}
    for name, (_, entry) in entries(scene).items():
        if isinstance(entry, Subsection):
            keys |= keys_of_arguments(entry.section)
        elif ending_of(name):
            keys[without_unit(name)] = name
    return keys


def _arguments_in_messages(scene: type[Section]) -> re.Pattern[str]:
    """Arguments of gears as messages name them: anywhere, but words of a sentence only in front of a colon."""
    anywhere = "|".join(name for name in keys_of_arguments(scene) if "_" in name)
    words = "|".join(name for name in keys_of_arguments(scene) if "_" not in name)
    return re.compile(rf"\b(?:{anywhere})\b|(?:^|(?<=: ))(?:{words})(?=:)")


@contextmanager
def arguments_by_keys(scene: type[Section]) -> Iterator[None]:
    """Name keys of files, with their units, where refusals of gears and pairs name arguments."""
    try:
        yield
    except (InputError, GeometryError) as error:
        keys, names = keys_of_arguments(scene), _arguments_in_messages(scene)
        problems = error.problems if isinstance(error, InputError) else (str(error),)
        sentences = [names.sub(lambda name: keys[name[0]], problem) for problem in problems]
        by_keys = InputError(sentences) if isinstance(error, InputError) else GeometryError(sentences[0])
        for note in getattr(error, "__notes__", ()):
            by_keys.add_note(note)
        raise by_keys.with_traceback(error.__traceback__) from None


Made = TypeVar("Made")
Arguments = ParamSpec("Arguments")


def named_by_keys(
    function: Callable[Concatenate[Any, Arguments], Made],
) -> Callable[Concatenate[Any, Arguments], Made]:
    """Function of a scene, its first argument, whose refusals are those of :func:`arguments_by_keys`."""

    @wraps(function)
    def with_keys(scene: Any, /, *values: Arguments.args, **options: Arguments.kwargs) -> Made:
        with arguments_by_keys(type(scene)):
            return function(scene, *values, **options)

    return with_keys


def build_rounding(gear: GearSection) -> EdgeRounding:
    """Return the radii of the edges of a gear's teeth."""
    return EdgeRounding(gear.tip_rounding_mm, gear.side_rounding_mm)


def build_materials(materials: tuple[ElasticMaterial, ElasticMaterial]) -> tuple[Material, Material]:
    """Return the materials of both gears."""
    return Material(**in_base_units(materials[0])), Material(**in_base_units(materials[1]))


def build_tooth_deviations(
    pitch: Pitch | None, teeth: int, owner: str, module: float, tolerances: Callable[[int], tuple[float, float]]
) -> ToothDeviations:
    """Return the deviations of the teeth of a gear; InputError if one is larger than 0.05 modules.

    ``tolerances`` has the single and the cumulative pitch tolerance [um] of a class.
    """
    if pitch is None:
        return ToothDeviations(np.zeros(teeth))
    with named(f"{owner}.pitch"):
        index = UNITS["um"].factor * pitch.index(teeth, tolerances)
    worst = int(np.abs(index).argmax())
    limit = LARGEST_INDEX * module
    require(
        (
            abs(index[worst]) <= limit,
            f"{owner}.pitch: index deviation of tooth {worst}: found {plain(1e3 * index[worst], 6)} um; allowed up to "
            f"{plain(1e3 * limit, 6)} um, {LARGEST_INDEX} modules",
        )
    )
    return ToothDeviations(
        index, 0.5 * UNITS["um"].factor * pitch.runout_um, UNITS["deg"].factor * pitch.runout_phase_deg
    )


def described_gear(gear: Gear, form: FlankForm, owner: str, measured_side: int) -> Gear:
    """Gear whose flanks are in the form that is asked for.

    Parameters
    ----------
    gear : Gear
        Of analytic flanks.
    form : FlankForm
    owner : str
        Name of the gear.
    measured_side : int
        s of the flank that a measurement belongs to; the other flank of the tooth stays analytic.

    Raises
    ------
    InputError
        If a flank cannot be fitted, with the section that asks for it.
    """
    if form.form == "analytic":
        return gear
    geometry = DescribedTooth(gear.geometry, form, owner, measured_side)
    return replace(gear, flank=geometry.described(gear.flank), geometry=geometry)


@dataclass(frozen=True)
class DescribedTooth(ToothGeometry):
    """Teeth whose modified flanks are fitted by B-splines or measured."""

    analytic: ToothGeometry
    description: FlankForm
    owner: str
    measured_side: int

    @property
    def unmodified(self) -> ToothGeometry:
        """The teeth by their equations, without modifications."""
        return self.analytic.unmodified

    def nominal(self, side: int) -> Flank:
        """Flank by its equations, without modifications."""
        return self.analytic.nominal(side)

    def form(self) -> ToothForm:
        """Form of a tooth without its flanks: thickness, root surface and fillet."""
        return self.analytic.form()

    def modified(self, nominal: Flank) -> Flank:
        """A flank with its modifications, as it is described."""
        return self.described(self.analytic.modified(nominal))

    def described(self, flank: Flank) -> Flank:
        """An analytic flank, fitted, or replaced by the measured one."""
        wanted = self.description
        with named(f"{self.owner}.flank"):
            if wanted.form == "bspline":
                return fitted(flank, wanted.points or DEFAULT_POINTS, wanted.degree or FITTED_DEGREE)
            if wanted.measurement is not None and flank.side == self.measured_side:
                data = build_topography(wanted.measurement, flank.frame.upwards)
                counts = wanted.coefficients or smoothing_coefficients(data.radius.shape[:2], wanted.degree)
                return measured(flank, data, degree=wanted.degree, coefficients=counts)
        return flank


def build_topography(measurement: Measurement, upwards: int = 1) -> Topography:
    """Return the measured points, or deviations; ``upwards`` is that of the frame of the flank."""
    values = in_base_units(measurement)
    notes = {"source": values["source"]} | ({LINES_NOTE: TWO_LINES} if values["two_lines"] else {})
    topography: Topography
    if measurement.x_mm is not None:
        topography = MeasuredPoints(np.stack([values["x"], values["y"], values["z"]], axis=-1), notes)
    else:
        topography = MeasuredDeviations(values["radius"], values["axial"], values["deviation"], notes)
    return in_own_frame(topography, upwards)


def in_own_frame(topography: Topography, upwards: int) -> Topography:
    """Return a topography of a file in the frame of its gear, whose y and z point against it where upwards is -1."""
    if isinstance(topography, MeasuredPoints):
        axes = np.array([1.0, upwards, upwards])
        nominal = None if topography.nominal is None else np.asarray(topography.nominal) * axes
        return replace(topography, points=np.asarray(topography.points) * axes, nominal=nominal)
    assert isinstance(topography, MeasuredDeviations)
    return replace(topography, axial=upwards * np.asarray(topography.axial))
