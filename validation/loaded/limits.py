"""Limits of the loaded mesh cycle: balance, energy, no load, conjugate teeth, published stiffnesses, bevel pairs.

Crowned pair: the helical pair of the SAM paper under 130 N m. Without crowning, and where the teeth do not bend,
the contact deformation of a line of length l and width w is F/l (ln(4 l/w) - 1) times a constant, so that lines share
the load nearly by their lengths; two pairs at a symmetric position carry one half each.

Stiffnesses are means over a pitch of the tangent of the whole mesh, unmodified teeth and bodies included. ISO 6336-1
gives its values, from measurements and without body torsion, an error of 10 to 20 %. ROSS is a slice model and names no
force: an order of magnitude.
"""

import math
import warnings
from functools import cache
from pathlib import Path

import numpy as np

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.loaded.load_sharing import share_load
from loaded_tca.loaded.loaded_contact import LoadedContact
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.loaded.tooth_pairs import Share, SharedLoad, tooth_pairs_at
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.reference.hertz import line_contact
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.unloaded import trace_teeth
from validation.cylindrical import iso_tr_6336_30
from validation.loaded.mesh_stiffness import mean_stiffness
from validation.table import Row

CASE = "loaded mesh cycle"
LIMIT, HERTZ, LINES = "limit of the model", "Hertz, Johnson 1985, eq. 4.24", "line contact, lengths and logarithms"
ROSS = "ROSS, mesh of two gears z 62"
GRID, FINE = GridChoice(cells=(24, 24)), GridChoice(cells=(48, 48))
CROWNED, NONE = FlankModifications(lead_crowning=0.005), FlankModifications()
TORQUE, SMALL = 130e3, (0.1, 100.0)  # N mm
MOMENT = 3e-4  # contacts cut by a tip edge are not centred: a tenth of a half width, 0.15 mm, over the base radius
HALF = 1e-9  # two pairs whose grids are each other's mirror images
POWER = 2e-6  # of ellipses far smaller than the radii, on cells that grow with them; 4e-7 is seen
CELLS, NEIGHBOURS = 1.5e-3, 2e-3  # 24 cells across a contact; two grids of neighbouring loads
LINE_ENDS = 0.02  # of the torque: oblique ends, at the tips, are stiffer than the formula of a long line has them
STANDARD, MAGNITUDE = 0.2, 0.3
COARSE = 4  # elements across the face: 0.1 % from the default density, in a tenth of its time
ROSS_TORQUE = 124e3  # 100 N/mm at the reference circle
SCENES = Path(__file__).parents[2] / "examples" / "scenes"
BEVELS = {"straight bevel": "straight_bevel.toml", "face-milled": "face_milled_19x62_matched.toml"}
LOADS = (1e-6, 0.25, 1.0, 2.0)  # over the torque of the scene
VANISHING = 1e-7  # rad: about (1e-6)^(2/3) of the rotation under the whole torque, 2e-4 rad
PITCH_FURTHER = 1e-9  # the same contacts on the same grids


def rows() -> list[Row]:
    """Every limit of load sharing."""
    bevels = [row for name in BEVELS for row in _bevel(name)]
    return [*_balance(), _energy(), *_no_load(), *_lines(), _half(), _iso(), *_ross(), *bevels]


def _row(source: str, quantity: str, expected: float, obtained: float, tolerance: float | None, *more: str) -> Row:
    return Row(CASE, source, quantity, expected, obtained, tolerance, *more)


@cache
def _pair(modifications: FlankModifications, teeth: tuple[int, int] = (34, 57), helix_deg: float = 15.0) -> GearPair:
    """Module and face of the SAM paper, the pinion modified."""
    gears = [
        CylindricalGear(z, 3.0, 25.0, helix_angle=hand * math.radians(helix_deg))
        for z, hand in zip(teeth, (1, -1), strict=True)
    ]
    return cylindrical_pair(CylindricalMesh(*gears), modifications=(modifications, NONE))


def _shared(pair: GearPair, part: float, torque: float = TORQUE, grid: GridChoice = GRID) -> SharedLoad:
    """Share a torque at a part of a pitch from phi1 = 0; the teeth do not bend."""
    return share_load(pair, tooth_pairs_at(trace_teeth(pair, [part * pair.pitch]), 0), torque, grid)


def _balance() -> list[Row]:
    """Torque of all pressures about the axis of the pinion, cell by cell: the balance knows each contact's lever."""
    found = []
    for part in (-0.45, 0.1):
        contacts = [share.loaded for share in _shared(_pair(CROWNED), part).shares]
        torque = sum(_torque(one) for one in contacts)
        quantity = f"torque of the pressures, {len(contacts)} tooth pairs [N mm]"
        found.append(_row(LIMIT, quantity, TORQUE, torque, MOMENT))
    return found


def _torque(loaded: LoadedContact) -> float:
    """Moment of the pressures on the tangent plane about the pinion's axis [N mm]."""
    x, y, _ = np.moveaxis(loaded.separation.points, -1, 0)
    across, up, _ = loaded.separation.axes[2]
    return float((loaded.solution.pressure * (x * up - y * across)).sum()) * loaded.solution.cell_area


def _energy() -> Row:
    """Slope of the elastic energy over the rotation of the wheel, against a pinion that stands."""
    pair, step = _pair(CROWNED), 0.02
    low, high = (_shared(pair, -0.15, (1.0 + sign * step) * TORQUE, FINE) for sign in (-1, 1))
    slope = (_elastic_energy(high) - _elastic_energy(low)) / (high.rotation - low.rotation)
    return _row(LIMIT, "derivative of the energy: torque [N mm]", TORQUE, pair.ratio * slope, NEIGHBOURS)


def _elastic_energy(shared: SharedLoad) -> float:
    """Half the work of the pressures over the displacements [N mm]."""
    energy = 0.0
    for share in shared.shares:
        solution = share.loaded.solution
        pressed = solution.in_contact
        displacement = solution.approach + solution.gap[pressed] - solution.problem.gap[pressed]
        energy += 0.5 * float(solution.pressure[pressed] @ displacement) * solution.cell_area
    return energy


def _no_load() -> list[Row]:
    """Rotation of the wheel under nearly no torque: one ellipse, whose approach is a power of the force."""
    small, larger = (_shared(_pair(CROWNED), 0.1, torque) for torque in SMALL)
    (share,) = larger.shares
    expected = share.loaded.hertz.approach / share.tooth_pair.contact.wheel_lever
    exponent = math.log(larger.rotation / small.rotation) / math.log(SMALL[1] / SMALL[0])
    return [
        _row(HERTZ, "T1 to 0: rotation goes with the torque to the power", 2.0 / 3.0, exponent, POWER),
        _row(HERTZ, f"rotation under {SMALL[1]:g} N mm [rad]", expected, larger.rotation, CELLS),
    ]


def _hertz_width(share: Share, length: float) -> float:
    """Width of a line contact of a length under the force of a tooth pair, even along it [mm]."""
    loaded = share.loaded
    load, modulus = loaded.solution.load / length, loaded.solution.problem.contact_modulus
    return 2.0 * line_contact(load, loaded.separation.curvatures[0], modulus).half_width


def _lines() -> list[Row]:
    """Share of the longest line of a helical pair without crowning; shown too: by the lengths alone."""
    found = []
    for part in (-0.25, 0.1):
        shares = _shared(_pair(NONE), part).shares
        lengths = np.array([np.linalg.norm(np.diff(share.tooth_pair.contact.line_ends, axis=0)) for share in shares])
        widths = np.array([_hertz_width(share, length) for share, length in zip(shares, lengths, strict=True)])
        stiffness = lengths / (np.log(4.0 * lengths / widths) - 1.0)
        longest = int(lengths.argmax())
        obtained, where = shares[longest].torque / TORQUE, f"share of the longest of {len(shares)} lines"
        expected = float(stiffness[longest] / stiffness.sum())
        found += [
            _row(LINES, where, expected, obtained, LINE_ENDS / expected),
            _row("lengths alone", where, lengths[longest] / lengths.sum(), obtained, None),
        ]
    return found


def _half() -> Row:
    shares = _shared(_pair(NONE, (30, 30), 0.0), 0.5).shares
    return _row(LIMIT, "spur, symmetric position: share of one pair", 0.5, shares[0].torque / TORQUE, HALF)


def _iso() -> Row:
    _, stiffness = mean_stiffness(iso_tr_6336_30.pair(), iso_tr_6336_30.TORQUE, layers=COARSE)
    source, bores = f"{iso_tr_6336_30.PUBLISHED}, ex. 1", "bores 0.55 of the root circles, without body torsion"
    return _row(source, "mesh stiffness c_gamma_alpha [N/(mm um)]", 17.46485, stiffness, STANDARD, bores)


def _ross() -> list[Row]:
    mesh = CylindricalMesh(*(CylindricalGear(62, 2.0, 20.0, bore_diameter=35.0) for _ in range(2)))
    hertz = 0.5 * math.pi * cylindrical_pair(mesh).contact_modulus * mesh.common_face_width
    stiffness, _ = mean_stiffness(mesh, ROSS_TORQUE, layers=COARSE)
    return [
        _row(ROSS, "contact ratio", 1.78978, mesh.transverse_contact_ratio, 5e-6),
        _row(ROSS, "Hertz stiffness pi E* b/2 [N/m]", 3.555868608e9, 1e3 * hertz, 1e-9),
        _row(
            ROSS, "mesh stiffness [N/m]", 4.096607e8, 1e6 * stiffness * mesh.common_face_width, MAGNITUDE,
            "T1 124 N m",
        ),
    ]  # fmt: skip


def _bevel(name: str) -> list[Row]:
    """Vanishing load, periodicity and trends of a pair on cones over half a pitch to either side."""
    cycle = _cycle(BEVELS[name])
    error = cycle.transmission_error
    nearly_unloaded = float(np.abs(error[0] - cycle.path.transmission_error).max())
    rises = int((np.diff(error, axis=0) >= 0.0).sum())
    softer = int((np.diff(cycle.mesh_stiffness, axis=0) <= 0.0).sum())
    fewer = int((np.diff(cycle.loaded_pairs, axis=0) < 0).sum())
    return [
        _row(LIMIT, f"{name}: T1 to 0, loaded less unloaded TE [rad]", 0.0, nearly_unloaded, VANISHING),
        _row(LIMIT, f"{name}: TE a pitch further [rad]", error[2, 0], error[2, -1], PITCH_FURTHER),
        _row(LIMIT, f"{name}: places where TE does not fall with the load", 0.0, rises, 0.0),
        _row(LIMIT, f"{name}: places where stiffness does not grow with it", 0.0, softer, 0.0),
        _row(LIMIT, f"{name}: places where fewer pairs carry more load", 0.0, fewer, 0.0),
    ]


def _cycle(name: str) -> MeshCycle:
    scene = read_scene(SCENES / name)
    torques = [1e-3 * factor * scene.torques[0] for factor in LOADS]
    changes = {"positions": 3, "cells": GRID.cells, "torques_Nm": torques, "compliance": "contact", "free_edges": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # tip corners carry load, as the trends want it
        return analyse(scene.with_changes({f"analysis.{key}": value for key, value in changes.items()}))
