"""Studies over planetary stages: what varies, what is kept of each variant, what a study was of.

Pins and the support of the sun change the balance alone. Mesh cycles of one process are kept, so that variants that
differ in these cost milliseconds.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from loaded_tca.arrays import Array
from loaded_tca.errors import give_accuracy_warning, noted_accuracy_warnings
from loaded_tca.input_files import is_place
from loaded_tca.scene import Scene, parse_scene
from loaded_tca.scene.keys import Key
from loaded_tca.scene.section import as_table, key_at
from loaded_tca.stages import Stage, StageResult, analyse_stage, parse_stage, rebalanced
from loaded_tca.stages.analyse import OF_BALANCE, expected_stage_effort
from loaded_tca.stages.sections import PLACE

if TYPE_CHECKING:
    import xarray

    from loaded_tca.studies.study import Study

BALANCE_SECONDS = 2e-3
"""Of a balance of the planets at a position under a torque."""
KEPT = 2
"""Stages whose mesh cycles a process keeps: a study of pins has one, one of pins within a factor goes through few."""
NUMBERS_OF_PLANETS = {"stage.planets", "stage.planet_angles_deg"}
"""Keys of which either says how many planets a stage has."""
TORQUES = ("sun_torque_Nm", "pinion_torque_Nm")
"""Figures that say of which torque a row is: in studies of stages, and of scenes."""
FIRST = (
    "mesh_load_factor",
    "transmission_error_peak_to_peak_um",
    "largest_planet_share",
    "sun_mesh_peak_pressure_MPa",
    "ring_mesh_peak_pressure_MPa",
    "sun_root_tension_MPa",
    "planet_root_tension_at_sun_MPa",
    "planet_root_tension_at_ring_MPa",
    "ring_root_tension_MPa",
)
"""Figures by which variants of a stage are compared unless others are asked for; the first one ranks them."""


def stage_figures(stage: Stage) -> dict[str, Array]:
    """Analyse a planetary stage and return its key figures: what studies over stages keep of each variant.

    Parameters
    ----------
    stage : Stage

    Returns
    -------
    dict of str to (torques,) array
        By the names of :meth:`StageResult.key_figures`, which end in their unit: ``mesh_load_factor`` (K_gamma),
        ``transmission_error_peak_to_peak_um`` of the stage, ``largest_planet_share``, pressures and root stresses under
        it, and ``sun_torque_Nm``.

    Raises
    ------
    InputError, GeometryError, ConvergenceError
        As :func:`loaded_tca.stages.analyse_stage`.

    Examples
    --------
    Pins of three planets that scatter by 8 um, on every support of the sun::

        pins = {f"stage.pin_tangential_um.{planet}": norm(0.0, 8.0) for planet in range(3)}
        study = Study(stage, {"stage.floating_sun": [True, False]}, pins, samples=256)
        rows = run_study(study)
        rows["mesh_load_factor"].quantile(0.95, "sample")
    """
    plain = stage.with_changes(dict.fromkeys(OF_BALANCE))
    own = as_table(stage.stage)
    changes = {key: own.get(key.removeprefix("stage.")) for key in OF_BALANCE}
    result = rebalanced(_meshes_of(plain.to_toml()), changes)
    for sentence in result.warnings or ():
        give_accuracy_warning(sentence)
    figures = result.figure_arrays()
    return {name: figures[name] for name in dict.fromkeys((*filter(figures.__contains__, FIRST), *figures))}


@lru_cache(maxsize=KEPT)
def _meshes_of(text: str) -> StageResult:
    """Result of a stage without pin errors, on a rigid sun; gives no warnings."""
    with noted_accuracy_warnings(given=False, alone=True):
        return analyse_stage(parse_stage(text, folder=None))


def expected_seconds(study: Study) -> float:
    """Estimate of the time of a study of a stage [s]: its meshes once, or in each variant that changes them."""
    assert isinstance(study.scene, Stage)
    varies = any(PLACE.sub(r"stage.\1", key) not in OF_BALANCE for key in study.keys)
    positions = study.scene.analysis.positions * len(study.scene.sun_torques)
    meshes = expected_stage_effort(study.scene).seconds * (len(study) if varies else 1)
    return meshes + BALANCE_SECONDS * positions * len(study)


def key_of(subject: Scene | Stage, path: str) -> Key:
    """What a scene or a stage says of the key at a path with dots; InputError if there is none."""
    return subject.key_at(path) if isinstance(subject, Stage) else key_at(type(subject), path)


def nominal_of(subject: Scene | Stage, path: str) -> Any:
    """Value that a scene or a stage has at a path with dots, as a file gives it; None: not given."""
    value: Any = as_table(subject)
    for name in path.split("."):
        if isinstance(value, dict):
            value = value.get(name)
        elif isinstance(value, tuple | list) and is_place(name) and int(name) < len(value):
            value = value[int(name)]
        else:
            return None
    return value


def problem_of_places(subject: Scene | Stage, path: str, varied: Collection[str] = ()) -> str:
    """Why a key leads past the end of a list, of bearings or of planets; nothing if it does not.

    Parameters
    ----------
    subject : Scene or Stage
    path : str
        A key that there is, with dots.
    varied : collection of str
        Keys that vary with it: a list that is one of them may be longer than that of the scene.
    """
    names = path.split(".")
    for end, index in enumerate(names[1:], 1):
        place = ".".join(names[:end])
        given, lengths = nominal_of(subject, place), {place}
        if isinstance(subject, Stage) and PLACE.fullmatch(path):
            given, lengths = subject.stage.angles, {*NUMBERS_OF_PLANETS, place}
        is_list = isinstance(given, tuple | list) and is_place(index) and lengths.isdisjoint(varied)
        if is_list and int(index) >= len(given):
            allowed = "0" if len(given) == 1 else f"0 to {len(given) - 1}"
            return f"{path}: {index} is past the end of a list of {len(given)}; allowed {allowed}"
    return ""


def subject_of(study: xarray.Dataset) -> Scene | Stage:
    """The scene, or the stage, that a study varies."""
    if "stage_toml" in study.attrs:
        return parse_stage(study.attrs["stage_toml"], source="stage_toml", folder=None)
    return parse_scene(study.attrs["scene_toml"], source="scene_toml", folder=None)


def torque_name(study: xarray.Dataset) -> str:
    """Name of the torque of a study: of the sun in one of stages, else of the pinion."""
    return next((name for name in TORQUES if name in study), TORQUES[-1])
