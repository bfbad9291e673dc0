"""Mesh stiffness beside c_gamma_alpha of ISO 6336-1: helix angle, bore, face width, torque and crowning.

The pair 23/81, m_n 2.5, alpha_n 17.5 deg, beta 28 deg, a 147.5 mm, faces 32 and 30 mm, and pairs like it without
profile shifts: with other helix angles, bores and face widths. Stiffnesses are means over a pitch of the tangent, teeth
and bodies included, without body torsion. The standard's come from measurements on solid discs, with an error of 10 to
20 %; the helix has no part in them but by cos(beta) and the contact ratio.

The tangent is that of the cells in contact as they are. How far it scatters by that tell slopes of the transmission
error over nine torques close together, of the three mesh cycles among the examples, with flanks alone and with teeth
that bend; beside it the chord, of a power law through the torque and 0.8 of it.

``docs/studies/mesh_stiffness.md`` has the tables that this prints as a script, and says what they show.
"""

import math
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.arrays import Array
from loaded_tca.compliance import MeshDensity, tooth_compliance
from loaded_tca.compliance.body import ToothFrame, gear_body, gear_nodes
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.loaded.cycle import AllPairsCycle, solve_cycles
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear import Gear
from loaded_tca.reference import iso6336
from loaded_tca.unloaded import trace_teeth
from loaded_tca.unloaded.tooth_cycle import pitches_within_reach
from validation.page import SCENES, table
from validation.table import Row

CASE, SOURCE = "mesh stiffness", "ISO 6336-1:2006, method B"
STANDARD = 0.2
GRID = GridChoice(cells=(24, 24))
POSITIONS = 4
LAYER = 3.75  # of elements across the face [mm]; in the default density 0.3 to 0.8 % softer at 28 deg
TEETH, MODULE, PRESSURE_ANGLE = (23, 81), 2.5, math.radians(17.5)
LINE_LOAD = 250e3 / 30.0  # pinion torque over the common face width [N]

FLANKS_ALONE: dict[str, Any] = {"analysis.compliance": "contact", "analysis.free_edges": False}
CLOSE, CHORD = np.linspace(0.94, 1.06, 9), 0.8  # parts of the torque
FINE: dict[str, Any] = {"analysis.accuracy": None, "analysis.cells": (128, 128)}
NONE, CROWNED = FlankModifications(), FlankModifications(lead_crowning=0.004, profile_crowning=0.002)


@dataclass(frozen=True)
class Pair:
    """A pair 23/81; bores over the root diameters, None: the default, 0.55."""

    name: str
    helix_deg: float
    widths: tuple[float, float] = (30.0, 30.0)
    shifts: tuple[float, float] = (0.0, 0.0)
    centre_distance: float | None = None
    bore: float | None = None

    @property
    def mesh(self) -> CylindricalMesh:
        """Its gears."""
        return CylindricalMesh(*(self._gear(member) for member in (0, 1)), centre_distance=self.centre_distance)

    def _gear(self, member: int) -> CylindricalGear:
        hand, bore = (1, -1)[member] * math.radians(self.helix_deg), None
        given = TEETH[member], MODULE, self.widths[member], PRESSURE_ANGLE, hand, self.shifts[member]
        if self.bore is not None:
            bore = 2.0 * self.bore * CylindricalGear(*given).root_radius
        return CylindricalGear(*given, bore_diameter=bore)


REAL = Pair("23/81", 28.0, (32.0, 30.0), (0.30, -0.1929), 147.5)
STRAIGHT, OBLIQUE, WIDE = Pair("like it", 0.0), Pair("like it", 28.0), Pair("like it", 28.0, (60.0, 60.0))


def mean_stiffness(
    mesh: CylindricalMesh,
    torque: float,
    modifications: FlankModifications = NONE,
    layers: int | None = None,
) -> tuple[float, float]:
    """Mean over a pitch of the tangent stiffness [N/(mm um)]: of teeth and bodies, and without body torsion."""
    pair = cylindrical_pair(mesh, modifications=(modifications, NONE))
    cycle = trace_teeth(pair, pair.pitch * np.linspace(-0.5, 0.5, POSITIONS, endpoint=False))
    density = MeshDensity(lengthwise=layers or round(pair.face_width / LAYER))
    teeth = tooth_compliance(pair, neighbours=max(pitches_within_reach(pair), 1), density=density)
    carried = solve_cycles([AllPairsCycle(pair, cycle, np.array([torque]), GRID, teeth)])[0]
    whole = float(np.mean(carried.torque_rate) / (1e3 * pair.base_radii[0] * pair.base_radii[1] * pair.face_width))
    return whole, 1.0 / (1.0 / whole - 1e3 * pair.face_width * sum(teeth.body_torsion))


def standard(mesh: CylindricalMesh) -> float:
    """c_gamma_alpha of ISO 6336-1 [N/(mm um)]."""
    gears = mesh.pinion, mesh.wheel
    virtual = [iso6336.virtual_teeth(gear.teeth, abs(gear.helix_angle), gear.pressure_angle) for gear in gears]
    single = iso6336.single_stiffness(
        iso6336.theoretical_single_stiffness(
            (virtual[0], virtual[1]), (gears[0].profile_shift, gears[1].profile_shift)
        ),
        abs(mesh.pinion.helix_angle),
        basic_rack_factor=iso6336.basic_rack_factor(mesh.pinion.dedendum_coefficient, mesh.pinion.pressure_angle),
    )
    return iso6336.mesh_stiffness(single, mesh.transverse_contact_ratio)


def axial_displacement(gear: Gear) -> float:
    """Displacement of the middle of a tooth along the axial part of an even unit normal force on its flank [mm/N].

    Both counted along the normal, so that it is what the axial force adds to the deflection along it.
    """
    frame = ToothFrame(gear, gear_nodes(gear, MeshDensity(lengthwise=round(30.0 / LAYER))))
    mesh, factor = gear_body(frame.nodes, gear.material)
    along, weights = np.polynomial.legendre.leggauss(12)
    places, even = frame.places(np.full(12, 0.5), 0.5 + 0.5 * along), 0.5 * weights
    axial = -places.normal * [0.0, 0.0, 1.0]
    load, reading = (
        even @ surface.along(axial, len(mesh.points)).toarray()
        for surface in (frame.on_flank(places, mesh.number), frame.on_middle(places, 0, mesh.number))
    )
    return float(reading @ factor.solve(load[:, None])[:, 0])


def departures(name: str, changes: dict[str, Any]) -> list[Array]:
    """Departures from the slopes over torques: of tangents on 128 cells and on as many as usual, of chords on 128.

    Relative, (positions,) each; "usual": to the accuracy of the scene.
    """
    scene = read_scene(SCENES / f"mesh_cycle_{name}.toml").with_changes({"analysis.positions": 9, **changes})
    torque = scene.load.pinion_torque_Nm
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts end at edges
        fine = analyse(scene.with_changes({**FINE, "analysis.torques_Nm": tuple(torque * np.append(CHORD, CLOSE))}))
        usual = analyse(scene.with_changes({"analysis.torques_Nm": (torque,)}))
    turned = np.abs(fine.transmission_error - fine.unloaded_transmission_error)
    lengths = 1e3 * math.prod(fine.gear_pair.base_radii) * fine.face_width
    fitted = np.polynomial.polynomial.polyfit(CLOSE - 1.0, turned[1:], 3)
    slope, middle = 1e3 * torque / (fitted[1] * lengths), 1 + len(CLOSE) // 2
    exponent = np.log(turned[0] / turned[middle]) / math.log(CHORD)
    chord = 1e3 * torque / (exponent * turned[middle] * lengths)
    return [found / slope - 1.0 for found in (fine.mesh_stiffness[middle], usual.mesh_stiffness[0], chord)]


def short_rows() -> list[Row]:
    """The pair itself."""
    return rows((REAL,))


def rows(pairs: Iterable[Pair] = (REAL, STRAIGHT, WIDE)) -> list[Row]:
    """The pair itself, straight teeth, and a face twice as wide."""
    found = []
    for pair in pairs:
        mesh = pair.mesh
        _, without = mean_stiffness(mesh, LINE_LOAD * mesh.common_face_width)
        quantity = f"{pair.name}, beta {pair.helix_deg:g} deg, b {pair.widths[1]:g}: c_gamma_alpha [N/(mm um)]"
        note = "without body torsion; bores 0.55 of the root circles"
        found.append(Row(CASE, SOURCE, quantity, standard(mesh), without, STANDARD, note=note))
    return found


def main() -> None:
    """Print the tables."""
    print(table("pair | beta | bore | b | torque [N m] | c | without torsion | ISO 6336-1 | ratio", _cells_of_pairs()))
    cells = []
    for teeth, changes in (("flanks alone", FLANKS_ALONE), ("bending", {})):
        for name in ("helical", "spur", "bevel"):
            sizes = [100.0 * np.abs(part) for part in departures(name, changes)]
            cells.append([name, teeth, *(f"{size.mean():.2f} (at most {size.max():.2f})" for size in sizes)])
    print(f"\n{table('mesh cycle | teeth | tangent, 128 cells | tangent, usual | chord, 128 cells', cells)}")
    print("\nDisplacement along the axial part of the normal force, beta 28 deg, b 30 [um per N/mm]")
    for bore in (0.55, 0.8):
        pair = cylindrical_pair(Pair("like it", 28.0, bore=bore).mesh)
        parts = (f"{3e4 * axial_displacement(gear):.4f}" for gear in (pair.pinion, pair.wheel))
        print(f"bore {bore:g}: pinion, wheel", *parts)


def _cells_of_pairs() -> Iterator[str]:
    """Cells of the stiffness of the pair under several torques, of like pairs with other helices, bores and faces."""
    for torque in (50e3, 250e3, 1000e3):
        for name, modifications in ((REAL.name, NONE), (f"{REAL.name}, crowned 4 and 2 um", CROWNED)):
            yield _cells(REAL, torque, modifications, name)
    for helix in (0.0, 14.0, 28.0):
        for bore in (0.3, 0.55, 0.8):
            yield _cells(Pair("like it", helix, bore=bore), LINE_LOAD * 30.0)
    for helix in (0.0, 28.0):
        yield _cells(Pair("like it", helix, (60.0, 60.0)), LINE_LOAD * 60.0)


def _cells(pair: Pair, torque: float, modifications: FlankModifications = NONE, name: str = "") -> str:
    mesh = pair.mesh
    (whole, without), iso = mean_stiffness(mesh, torque, modifications), standard(mesh)
    data = f"{pair.helix_deg:g} | {pair.bore or 0.55:g} | {pair.widths[1]:g} | {1e-3 * torque:g}"
    numbers = f"{whole:.2f} | {without:.2f} | {iso:.2f} | {without / iso:.2f}"
    return f"{name or pair.name} | {data} | {numbers}"


if __name__ == "__main__":
    main()
