"""Contacts that end at faces and tips: how far rotation, mesh stiffness and shares scatter with grid and torque.

At such an end the pressure of half-spaces is singular, so that numbers converge with the first power of the cells:
beside a straight line over the width of the cells, from 24 to 64 of them along each axis, stands what depends on where
the end lies within its cell. The rotation falls from each of these grids to the next, at every position. Under nine
torques within 8 % of each other, on 32 cells, it stands beside a parabola.

The pairs: a spur pair without modifications, whose contacts end at both faces, and near a tip within the cells across;
one with a contact point off the middle of the face; a helical one whose lines end at tips and faces. The torque is that
of a scene; the teeth do not bend.
"""

from __future__ import annotations

from collections.abc import Container

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.loaded.load_sharing import share_load
from loaded_tca.loaded.loaded_grid import LoadedGrid
from loaded_tca.loaded.sensitivity import loaded_states
from loaded_tca.loaded.tooth_contact import GridChoice
from loaded_tca.loaded.tooth_pairs import tooth_pairs_at
from loaded_tca.pairs.cylindrical import Mounting, cylindrical_pair
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.unloaded import trace_teeth
from validation.table import Row

SOURCE = "convergence of first order"
GRIDS = (24, 28, 32, 40, 48, 64)
CLOSE = np.linspace(0.96, 1.04, 9)
POSITIONS = (-0.4, -0.15, 0.1, 0.35)  # pitches; within the transfer of load from pair to pair stiffness has no parabola
SCATTER = {"24 to 64 cells": 7e-4, "nine close torques": 3e-4}
STIFFNESS = 4e-3  # the tangent of the cells in contact as they are: it feels each that enters or leaves
MONOTONE = 1e-6  # what the solver leaves; the rotation falls by 1e-4 and more
TOLERANCE = 1e-7  # of the solver: a thousandth of the scatter, and less
NAMES = ("rotation", "mesh stiffness", "load share")


def short_rows() -> list[Row]:
    """Rows of the pair whose contacts lie off the middle of the face."""
    return rows(("off the middle",))


def rows(names: Container[str] | None = None) -> list[Row]:
    """Largest departures over all positions, of all pairs by default."""
    found = []
    for name, (pair, torque) in _pairs().items():
        if names is not None and name not in names:
            continue
        case = f"contacts cut by edges, {name}"
        by_cells = _numbers(pair, [(torque, cells) for cells in GRIDS])
        by_torque = _numbers(pair, [(part * torque, 32) for part in CLOSE])
        for what, over, values, degree in (
            ("24 to 64 cells", 1.0 / np.array(GRIDS), by_cells, 1),
            ("nine close torques", CLOSE - 1.0, by_torque, 2),
        ):
            for quantity, numbers in zip(NAMES, values, strict=True):
                allowed = STIFFNESS if quantity == "mesh stiffness" else SCATTER[what]
                scatter = _departure(over, numbers, degree)
                found.append(Row(case, SOURCE, f"scatter of the {quantity}, {what}", 0.0, scatter, allowed))
        rotation = by_cells[0]
        rise = max(0.0, float((rotation[1:] / rotation[:-1] - 1.0).max()))
        found.append(Row(case, SOURCE, "rise of the rotation from grid to grid", 0.0, rise, MONOTONE))
    return found


def _pairs() -> dict[str, tuple[GearPair, float]]:
    """Pairs and their torques [N mm]."""
    crowned, none = FlankModifications(lead_crowning=0.003), FlankModifications()
    spur = _mesh((25, 37), 20.0, 0.0)
    return {
        "spur": (cylindrical_pair(spur), 200e3),
        "off the middle": (
            cylindrical_pair(spur, modifications=(crowned, none), mounting=Mounting(out_of_plane=3.5e-5)),
            400e3,
        ),
        "helical": (cylindrical_pair(_mesh((23, 81), 30.0, np.radians(20.0))), 250e3),
    }


def _mesh(teeth: tuple[int, int], width: float, helix: float) -> CylindricalMesh:
    one, other = (
        CylindricalGear(teeth=count, normal_module=3.0, face_width=width, helix_angle=sign * helix)
        for count, sign in zip(teeth, (1, -1), strict=True)
    )
    return CylindricalMesh(one, other)


def _numbers(pair: GearPair, states: list[tuple[float, int]]) -> Array:
    """Rotation, mesh stiffness and largest share, (3, states, positions), of torques and numbers of cells."""
    mesh, found = trace_teeth(pair, [part * pair.pitch for part in POSITIONS]), []
    for torque, cells in states:
        grid = GridChoice(cells=(cells, cells), tolerance=TOLERANCE)
        shared = [share_load(pair, tooth_pairs_at(mesh, n), torque, grid) for n in range(len(POSITIONS))]
        share = [max(part.torque for part in one.shares) / torque for one in shared]
        states = [[LoadedGrid.of(part.tooth_pair.pair, part.loaded) for part in one.shares] for one in shared]
        found.append([[one.rotation for one in shared], loaded_states(states).stiffness, share])
    return np.array(found).swapaxes(0, 1)


def _departure(over: Array, values: Array, degree: int) -> float:
    """Largest departure, relative, of values (states, positions) from polynomials over the states."""
    fitted = np.polynomial.polynomial.polyval(over, np.polynomial.polynomial.polyfit(over, values, degree)).T
    return float(np.abs(values / fitted - 1.0).max())
