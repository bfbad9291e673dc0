"""Results written back into the REXS model that a scene came from, under the names that REXS has for them.

Of the stage: the load distribution over the common face with its places, K_Hbeta, and since version 1.5 the mesh
stiffness over the positions; in version 1.7 the rating after ISO 6336, of stage and gears. Of shafts that the scene
has: their deflection and torsion. Of their bearings: forces and tilting moments. REXS has further names for stresses,
but those of standards: what finite elements and half-spaces give is none of these.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import require
from loaded_tca.exchange.files import LARGEST_FILE, parse_rexs, with_attributes
from loaded_tca.exchange.gearbox import Gearbox, Stage
from loaded_tca.exchange.gears import gear_data
from loaded_tca.exchange.model import LENGTH, Attribute, Model, Reading
from loaded_tca.exchange.shafts import ShaftFrame
from loaded_tca.input_files import read_bytes
from loaded_tca.loaded.shaft_lines import ShaftLine, shaft_lines
from loaded_tca.results.files import replace_file
from loaded_tca.results.load_factors import STRIPS, face_forces
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.scene.rating import is_rated
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from loaded_tca.results.mesh_cycle import MeshCycle

SAME_PLACE_mm = 1e-3
"""Between places of a bearing in the scene and in the model."""
Results = dict[str, dict[str, Attribute]]
"""Attributes by the ids of components."""


@checked
def write_rexs(
    result: MeshCycle,
    model: str | PathLike[str],
    stage: str,
    path: str | PathLike[str],
    torque: int | None = None,
) -> Path:
    """Write a model with the numbers of a result, everything else as it was.

    Parameters
    ----------
    result : MeshCycle
        Of the scene of the stage.
    model : str or path
        The REXS file.
    stage : str
        Id of the stage in it.
    path : str or path
        The new file, of the format of the old one.
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If a file cannot be read or written, the model has no such stage, is of version 1.0, which has no names of
        results, or the result is of other gears.
    """
    content = read_bytes(model, LARGEST_FILE, "REXS model")
    results = rexs_results(result, parse_rexs(content, str(model)), stage, torque)
    replace_file(path, with_attributes(content, results, str(model)))
    return Path(path)


def rexs_results(result: MeshCycle, model: Model, stage: str, torque: int | None = None) -> Results:
    """Return the attributes of a result under one torque, by the components of a model.

    Parameters
    ----------
    result : MeshCycle
    model : Model
    stage : str
    torque : int, optional
        Index of the torque; default: the largest.

    Returns
    -------
    dict
        Id of a component -> name -> attribute.

    Raises
    ------
    InputError
        As of :func:`write_rexs`.
    """
    require((model.version != "1.0", f"{model.source}: version 1.0 has no names of results; allowed 1.1 to 1.7"))
    gearbox = Gearbox(Reading(model))
    of_stage = gearbox.stage(stage)
    _require_same(result, of_stage)
    index = index_or_largest(result.torque, torque)
    results: Results = {stage: _of_stage(result, model.version, index)}
    for component, attributes in _of_rating(result, gearbox, of_stage, index).items():
        results.setdefault(component, {}).update(attributes)
    for n, gear in enumerate(GEARS):
        shaft = of_stage.shafts[n]
        if shaft is None or getattr(result.scene, gear).shaft is None:
            continue
        frame = ShaftFrame(gearbox, of_stage, n, shaft)
        line = next(
            line
            for line in shaft_lines(result.scene)
            if line.gear == gear and math.isclose(line.torque, float(result.torque[index]))
        )
        results[shaft.id] = _of_shaft(line, frame)
        forces = np.nanmean(getattr(result, f"{gear}_bearing_force")[index, : _distinct(result)], axis=0)
        places = [bearing.at_mm for bearing in getattr(result.scene, gear).shaft.bearings]
        results |= _of_bearings(forces, places, frame)
    return results


def _require_same(result: MeshCycle, stage: Stage) -> None:
    """Refuse the result of another pair."""
    teeth = tuple(abs(gear.teeth) for gear in (result.scene.pinion, result.scene.wheel))
    same = teeth == stage.teeth
    require(
        (
            same,
            f"stage {stage.id}: has {stage.teeth[0]}/{stage.teeth[1]} teeth; found a result of {teeth[0]}/{teeth[1]}",
        )
    )


def _distinct(result: MeshCycle) -> int:
    """Number of positions without the last one, which is the first a pitch later."""
    return max(1, len(result.path) - 1)


def _of_stage(result: MeshCycle, version: str, torque: int) -> dict[str, Attribute]:
    """Normal force over the common face, from its end at the lower u of the pinion's shaft on, and what follows."""
    borders, forces = face_forces(result.gear_pair, result.path, result.maps[torque])
    width = float(borders[-1] - borders[0]) / STRIPS
    force = forces / _distinct(result)
    places = 0.5 * (borders[1:] + borders[:-1]) - borders[0]
    by_length = version not in ("1.1", "1.2", "1.3")
    load = force / width if by_length else force
    attributes = {
        "load_distribution_along_face_width": Attribute(_floats(load), "N / mm" if by_length else "N"),
        "load_distribution_node_positions": Attribute(_floats(places), "mm"),
    }
    factor = float(result.face_load_factor[torque])
    if math.isfinite(factor):
        attributes["face_load_factor_flank"] = Attribute(factor)
    stiffness = result.mesh_stiffness[torque, : _distinct(result)] * float(result.face_width) * MICROMETRES
    if version in ("1.5", "1.6", "1.7") and np.isfinite(stiffness).all():
        attributes["meshing_stiffness_characteristic"] = Attribute(_floats(stiffness), "N / mm")
    return attributes


RATED_SINCE = "1.7"
"""Version from which REXS has names for what ISO 6336 gives."""
OF_STAGE = {
    "K_A": ("application_factor_iso_6336_2019", "none"),
    "K_v": ("dynamic_factor_iso_6336_2019", "none"),
    "K_Hbeta": ("face_load_factor_contact_stress_iso_6336_2019", "none"),
    "K_Halpha": ("transverse_load_factor_contact_stress_iso_6336_2019", "none"),
    "K_Fbeta": ("face_load_factor_root_stress_iso_6336_2019", "none"),
    "K_Falpha": ("transverse_load_factor_root_stress_iso_6336_2019", "none"),
    "reduced_mass": ("reduced_gear_pair_mass_iso_6336_2019", "kg / mm"),
    "resonance_ratio": ("resonance_ratio_iso_6336_2019", "none"),
    "Z_H": ("zone_factor_pitting_iso_6336_2019", "none"),
    "Z_E": ("elasticity_factor_pitting_iso_6336_2019", "(N / mm^2)^0.5"),
    "Z_eps": ("contact_ratio_factor_pitting_iso_6336_2019", "none"),
    "Z_beta": ("helix_angle_factor_pitting_iso_6336_2019", "none"),
    "sigma_H0": ("nominal_contact_stress_iso_6336_2019", "N / mm^2"),
}
OF_GEARS = {
    "Z_BD": ("tooth_contact_factor_pitting_iso_6336_2019", "none"),
    "Z_NT": ("life_factor_pitting_iso_6336_2019", "none"),
    "sigma_H": ("contact_stress_iso_6336_2019", "N / mm^2"),
    "flank_safety": ("safety_factor_pitting_iso_6336_2019", "none"),
    "Y_F": ("form_factor_tooth_root_iso_6336_2006", "none"),
    "Y_S": ("stress_correction_factor_tooth_root_iso_6336_2006", "none"),
    "Y_NT": ("life_factor_tooth_root_iso_6336_2006", "none"),
    "Y_delta_relT": ("relative_notch_sensitivity_factor_tooth_root_iso_6336_2006", "none"),
    "sigma_F0": ("nominal_tooth_root_stress_iso_6336_2006", "N / mm^2"),
    "sigma_F": ("tooth_root_stress_iso_6336_2006", "N / mm^2"),
    "root_safety": ("safety_factor_tooth_root_iso_6336_2006", "none"),
}
"""Numbers of a rating -> attributes of the stage, and of what the model has of a gear in it, with their units."""


def _of_rating(result: MeshCycle, gearbox: Gearbox, stage: Stage, torque: int) -> Results:
    """Safeties and factors of ISO 6336-2:2019 and -3:2006, of scenes with strengths and [rating] and version 1.7.

    Of several bins with that torque, those of the bin with the least safety of flanks.
    """
    if gearbox.reading.model.version < RATED_SINCE or not is_rated(result.scene):
        return {}
    rating = result.rating()
    cases = np.flatnonzero((rating.torque == result.torque[torque]) & ~rating.inputs.cases.reversed)
    if not cases.size:  # no bin of a load spectrum has that torque
        return {}
    case = int(cases[rating.flank_safety[cases].min(axis=1).argmin()])
    results: Results = {stage.id: _attributes({name: rating.values(name)[case] for name in OF_STAGE}, OF_STAGE)}
    for gear, data in enumerate(gear_data(gearbox.reading, stage)):
        if data is not None:
            results[data.id] = _attributes({name: rating.values(name)[case, gear] for name in OF_GEARS}, OF_GEARS)
    return results


def _attributes(values: dict[str, Any], names: dict[str, tuple[str, str]]) -> dict[str, Attribute]:
    """Numbers that are known, by the names of the model."""
    known = {name: float(value) for name, value in values.items() if math.isfinite(value)}
    return {names[name][0]: Attribute(value, names[name][1]) for name, value in known.items()}


def _of_shaft(line: ShaftLine, frame: ShaftFrame) -> dict[str, Attribute]:
    """Deflection [um] and torsion [deg] over the nodes of a shaft, along u, v, w."""
    order = slice(None) if frame.sign > 0.0 else slice(None, None, -1)
    places = frame.middle + frame.sign * line.places[order]
    motions, turns = line.motions[order, :3] @ frame.turn, line.motions[order, 3:] @ frame.turn
    ways = {
        f"displacement_{axis}_of_nodes": Attribute(_floats(MICROMETRES * motions[:, n]), "mum")
        for n, axis in enumerate("uvw")
    }
    torsion = Attribute(_floats(np.degrees(turns[:, 0])), "deg")
    return {"u_coordinates_of_beam_nodes": Attribute(_floats(places), "mm"), **ways, "torsion_u": torsion}


def _of_bearings(forces: Array, places: Sequence[float], frame: ShaftFrame) -> Results:
    """Forces [N] and tilting moments [N m] on the shaft and on the other side of bearings, by forces (n, 6) on them.

    A bearing of the scene is that of the model at its place, or a row of it; the scene may have others, too.
    """
    results: Results = {}
    for at, bearing, side in frame.held_by():
        beside = 0.5 * (bearing.number("distance_between_bearing_rows", LENGTH) or 0.0) + SAME_PLACE_mm
        rows = [n for n, place in enumerate(places) if abs(place - at) < beside]
        if not rows:
            continue
        force, moment = forces[rows, :3].sum(axis=0), forces[rows, 3:].sum(axis=0)
        for n in rows:  # rows beside the middle of the bearing tilt it
            moment = moment + np.cross([0.0, 0.0, places[n] - at], forces[n, :3])
        along, about = force @ frame.turn, 1e-3 * moment @ frame.turn
        other = "outer" if side == "inner" else "inner"
        attributes: dict[str, Any] = {}
        for part, sign in ((side, -1.0), (other, 1.0)):
            for n, axis in enumerate("uvw"):
                attributes[f"force_acting_on_{part}_component_{axis}"] = Attribute(sign * float(along[n]) + 0.0, "N")
            for n, axis in ((1, "v"), (2, "w")):
                attributes[f"torque_acting_on_{part}_component_{axis}"] = Attribute(sign * float(about[n]) + 0.0, "N m")
        results[bearing.id] = attributes
    return results


def _floats(values: Array) -> tuple[float, ...]:
    return tuple(float(one) + 0.0 for one in values)
