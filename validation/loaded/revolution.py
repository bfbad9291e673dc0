"""Whole revolutions: alike teeth, flanks that are really turned, eccentric axes, slopes to single teeth.

- Teeth that are alike: the transmission error of the analysis of one pitch, which has other functions for its contacts.
  Tolerance 1e-7 um: the balances end where rotations agree, 2e-8 um is seen.
- Rigid: at every position the two flanks of each pair are turned about their axes by their index deviations, and the
  contact of the pair of turned flanks is found anew. To rounding, 2e-13 mm: 4e-14 mm is seen.
- Eccentric axis: the whole wheel is displaced, and each position is another mounting; right to e^2 over the base
  radius. Of involutes the closed form r_b2 TE = -(e_x sin alpha_wt + e_y cos alpha_wt), to rounding.
- Slope of the loaded transmission error to the deviation of one tooth. Of flanks alone it is the tangent stiffness of
  its pair, from single contacts under forces a little apart, over the sum of all; where teeth bend, the row sum of the
  inverse compliance, from the linear system of the state. 2e-3, of differences over 0.4 um.

Small grids: all of these hold on any grid.
"""

import copy
import math
import warnings
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from loaded_tca import AccuracyWarning, Revolution, Scene, analyse, analyse_revolution, read_scene
from loaded_tca.flanks import Flank
from loaded_tca.flanks.base import Jet
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.pairs.tooth_deviations import ToothDeviations
from loaded_tca.results import MeshCycle
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.revolution import RevolutionPath, trace_revolution
from validation.table import Row

CASE = "whole revolution"
SCENES = Path(__file__).parents[2] / "examples" / "scenes"
COARSE = {"analysis.cells": [16, 24], "analysis.accuracy": None, "analysis.positions": 5}
FLANKS_ALONE = {"analysis.compliance": "contact", "analysis.free_edges": False}
SMALL = {"pinion.teeth": 17, "wheel.teeth": 24, "analysis.torques_Nm": [60.0]}
FINER = {"analysis.cells": [32, 48]}
FINE = {"analysis.cells": [48, 64]}  # so many that a step of the differences loads whole rows of cells
PAIRS = {
    "spur": ("mesh_cycle_spur.toml", {"analysis.torques_Nm": [60.0]}),
    "helical": ("mesh_cycle_helical.toml", SMALL),
    "straight bevel": ("mesh_cycle_bevel.toml", {"analysis.torques_Nm": [0.8]}),
    "planet and ring": ("planet_ring.toml", {"analysis.torques_Nm": [1000.0]}),
    "face-milled": ("face_milled_19x62_matched.toml", {"analysis.torques_Nm": [50.0]}),
}
PER_PITCH, ALIKE_um, ROUNDING_mm = 4, 1e-7, 2e-13
ECCENTRICITY, PHASE = 0.01, 0.7  # mm, rad
SLOPE, STEP_um, LOAD_STEP = 2e-3, 0.2, 2e-3
SCATTER = 0.004  # mm, of random index deviations


def rows() -> list[Row]:
    """Every comparison of whole revolutions."""
    of_pairs = [row for name in PAIRS for row in _of_pair(name)]
    slopes = [*_slopes(FLANKS_ALONE | FINE, "flanks alone"), *_slopes(FINER, "teeth that bend")]
    return [*of_pairs, _closed_form(), *slopes]


def short_rows() -> list[Row]:
    """Those of the spur pair, and the closed form; the tests of revolutions have those of the other families."""
    return [*_of_pair("spur"), _closed_form()]


def _of_pair(name: str) -> list[Row]:
    return [_alike(name), _turned(name), _displaced(name)]


def _scene(name: str, changes: dict[str, object]) -> Scene:
    file, own = PAIRS[name]
    return read_scene(SCENES / file).with_changes(COARSE | own | changes)


def _revolution(scene: Scene, pitches: int) -> Revolution:
    asked = {"revolution.pitches": pitches, "revolution.positions_per_pitch": PER_PITCH}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse_revolution(scene.with_changes(asked))


@cache
def _one_pitch(scene: Scene) -> MeshCycle:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse(scene)


def _alike(name: str) -> Row:
    """Without deviations: largest difference of the transmission error to that of one pitch."""
    scene = _scene(name, FLANKS_ALONE)
    one, turn = _one_pitch(scene), _revolution(scene, 2).error_um(0)
    phase = np.round(PER_PITCH * one.pinion_angle[:-1] / scene.pair().pitch).astype(int) % PER_PITCH
    error = 1e3 * one.wheel_base_radius * one.transmission_error[0, :-1]
    most = max(float(np.abs(turn[first + phase] - error).max()) for first in (0, PER_PITCH))
    return Row(CASE, "analysis of one pitch", f"{name}: alike teeth, difference of TE [um]", 0.0, most, ALIKE_um)


def turned(flank: Flank, angle: float) -> Flank:
    """The flank turned by an angle [rad] about the axis of its gear."""

    def theta(self: Flank, rho: object, z: object, beyond: object = None) -> Jet:
        jet = type(flank).theta(self, rho, z, beyond)
        return Jet(jet.value + angle, jet.rho, jet.z, lambda: jet.bends)

    one = copy.copy(flank)
    one.__class__ = type("Turned", (type(flank),), {"theta": theta})
    return one


def error_of_turned_flanks(
    pair: GearPair, deviations: tuple[ToothDeviations, ToothDeviations], path: RevolutionPath, position: int, turn: int
) -> float:
    """Transmission error [mm] at r_b2 of flanks that are turned one by one, at a position of a pitch (``turn``)."""
    side, heights = pair.sense * pair.driving, []
    teeth = path.pinion_tooth[position], path.wheel_tooth[position]
    for column, number in enumerate(path.pairs.tolist()):
        back = [
            -side * one.index[tooth[column]] / radius
            for one, tooth, radius in zip(deviations, teeth, pair.base_radii, strict=True)
        ]
        moved = pair.with_flanks(turned(pair.pinion.flank, back[0]), turned(pair.wheel.flank, back[1]))
        own = path.pinion_angle[position] - (turn + number) * pair.pitch
        contact = trace_contact(moved, [own, 0.0], warn=False)[0]  # at 0 some contact, so that none is an error
        if contact.in_contact:
            heights.append(pair.driving * contact.transmission_error)
    return pair.driving * max(heights) * pair.base_radii[1]


def random_deviations(pair: GearPair, seed: int) -> tuple[ToothDeviations, ToothDeviations]:
    """Random index deviations of both gears."""
    generator = np.random.default_rng(seed)
    pinion, wheel = (ToothDeviations(generator.normal(0.0, SCATTER, teeth)) for teeth in pair.teeth)
    return pinion, wheel


def _turned(name: str) -> Row:
    """Largest difference of the rigid transmission error to that of flanks that are turned."""
    pair = _scene(name, FLANKS_ALONE).pair()
    deviations = random_deviations(pair, 1)
    path = trace_revolution(pair, deviations, 3, PER_PITCH, first_teeth=(5, 2))
    expected = [error_of_turned_flanks(pair, deviations, path, n, n // PER_PITCH) for n in range(len(path))]
    most = float(np.abs(path.transmission_error * pair.base_radii[1] - expected).max())
    return Row(CASE, "flanks really turned", f"{name}: rigid TE, difference [mm]", 0.0, most, ROUNDING_mm)


def _eccentric(pair: GearPair, eccentricity: float = ECCENTRICITY) -> RevolutionPath:
    z1, z2 = pair.teeth
    eccentric = ToothDeviations(np.zeros(z2), eccentricity, PHASE)
    return trace_revolution(pair, (ToothDeviations(np.zeros(z1)), eccentric), z2, 1)


def _azimuth(pair: GearPair, path: RevolutionPath) -> NDArray[np.float64]:
    """Azimuth of the eccentricity in the fixed frame: the x axis of the wheel points to the pinion."""
    return math.pi + PHASE - pair.sense * pair.ratio * path.pinion_angle


def _off_displaced(pair: GearPair, eccentricity: float) -> float:
    """Largest difference [mm] to a wheel whose axis is displaced at every position."""
    path, most = _eccentric(pair, eccentricity), 0.0
    for n, turned_by in enumerate(path.pinion_angle):
        moved = copy.copy(pair)
        azimuth = PHASE - pair.sense * pair.ratio * turned_by
        shift = eccentricity * (np.array([math.cos(azimuth), math.sin(azimuth)]) @ pair.wheel_axes[:2])
        object.__setattr__(moved, "wheel_origin", pair.wheel_origin + shift)
        errors = trace_contact(moved, pair.pitch * np.arange(-3.0, 4.0), warn=False).transmission_error
        expected = pair.driving * float(np.nanmax(pair.driving * errors)) * pair.base_radii[1]
        most = max(most, abs(float(path.transmission_error[n]) * pair.base_radii[1] - expected))
    return most


def _displaced(name: str) -> Row:
    """Eccentric wheel, beside one that is displaced: what is left out is of second order over the radii."""
    pair = _scene(name, FLANKS_ALONE).pair()
    quantity, second_order = (
        f"{name}: eccentric axis, difference of TE [mm]",
        2.0 * ECCENTRICITY**2 / min(pair.base_radii),
    )
    return Row(CASE, "displaced wheel", quantity, 0.0, _off_displaced(pair, ECCENTRICITY), second_order)


def _closed_form() -> Row:
    """Eccentric wheel of unmodified involutes: amplitude over the eccentricity, along the line of action."""
    changes = {"pinion.modifications.lead_crowning_um": 0.0, "pinion.modifications.profile_crowning_um": 0.0}
    pair = _scene("helical", FLANKS_ALONE | changes).pair()
    path = _eccentric(pair)
    alpha = math.acos(sum(pair.base_radii) / float(pair.wheel_origin[0]))
    azimuth = _azimuth(pair, path)
    expected = -ECCENTRICITY * (np.cos(azimuth) * math.sin(alpha) + np.sin(azimuth) * math.cos(alpha))
    most = float(np.abs(path.transmission_error * pair.base_radii[1] - expected).max())
    return Row(CASE, "closed form", "helical: eccentric axis, difference of TE [mm]", 0.0, most, ROUNDING_mm)


def _slopes(changes: dict[str, object], what: str) -> list[Row]:
    """Slope of the transmission error to the deviation of each tooth of the wheel in mesh, at two positions."""
    scene = _scene("helical", changes)
    one, pair = _one_pitch(scene), scene.pair()
    compared = []
    for position in (1, 3):
        phase = round(PER_PITCH * float(one.pinion_angle[position]) / pair.pitch)
        stiffness = _stiffness_of_contacts(one, pair, position) if "analysis.compliance" in changes else {}
        for number, share in (stiffness or _row_sums(one, position)).items():
            curves = []
            for sign in (1.0, -1.0):
                index = [0.0] * pair.teeth[1]
                index[1 + number] = sign * STEP_um
                turn = _revolution(scene.with_changes({"wheel.pitch.index_um": index}), 3)
                curves.append(float(turn.error_um(0)[PER_PITCH + phase]))
            slope = (curves[1] - curves[0]) / (2.0 * STEP_um)
            quantity = f"{what}: slope to a tooth, pair {number:+d}, position {position}, less its share"
            compared.append(Row(CASE, "tangent stiffnesses", quantity, 0.0, slope - share, SLOPE))
    return compared


def _stiffness_of_contacts(one: MeshCycle, pair: GearPair, position: int) -> dict[int, float]:
    """Part of each pair in the tangent stiffness, its own from single contacts under forces a little apart."""
    cells = one.maps[0][position][int(one.peak_column[0, position])]
    assert cells is not None
    grid = GridChoice(cells=(cells.pressure.shape[0], cells.pressure.shape[1]))
    stiffness = {}
    for column, number in enumerate(one.pair.tolist()):
        force = float(one.normal_force[0, position, column])
        if force > 0.0:
            own = one.pinion_angle[position] - number * pair.pitch
            contact = trace_contact(pair, [own], warn=False)[0]
            low, high = (
                solve_under_load(pair, contact, force * (1.0 + step), grid) for step in (-LOAD_STEP, LOAD_STEP)
            )
            stiffness[number] = 2.0 * LOAD_STEP * force / (high.contact_deformation - low.contact_deformation)
    whole = sum(stiffness.values())
    return {number: value / whole for number, value in stiffness.items()}


def _row_sums(one: MeshCycle, position: int) -> dict[int, float]:
    """Part of each pair in the forces that a rotation brings to all: row sums of the inverse compliance."""
    assert one.states is not None
    (states,) = one.states[1]
    grids, rates = states.grids[position], states.by_rotation[position]
    ends = np.cumsum([grid.active.sum() for grid in grids])[:-1]
    forces = [
        float(part.sum()) * grid.contact.pinion_lever for grid, part in zip(grids, np.split(rates, ends), strict=True)
    ]
    return {grid.number: force / sum(forces) for grid, force in zip(grids, forces, strict=True)}


if __name__ == "__main__":
    from validation.table import render

    print(render(rows()))
