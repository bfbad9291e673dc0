"""Line load of spur pairs up to the free ends of their faces, aligned and misaligned, beside finite elements in space.

Both gears of a pair touch at the pitch point, with all of the load. Each is a whole ring of 20-node hexahedra, held at
its bore, whose flank carries strips of an elliptical pressure along the pitch line, slab by slab; the displacements of
all slabs under them are the compliance of the pair. The strips are as wide as Hertz's contact at the loaded end;
elsewhere the flattening is taken to the width under the load of the slab, strain being plane. What balances the torque
gives the line load. Its largest mean over a thirtieth of the face over that of the face is K_Hbeta of this position.
Kept: line loads of slabs. The local term of the package was fitted to teeth of 25; FZG A took no part in that.

Rings, neighbouring teeth and bores are drawn as the package draws them (``loaded_tca.compliance``); neither its split
in bending and half-spaces nor its free edges enter. CalculiX with contact (``validation.calculix``), with layers of a
twelfth of half the face, agrees for the aligned pair to 0.4 % in the two layers at the end and 0.1 % in the others.

Source: ``python -m validation.loaded.face_ends_space``, some minutes.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from skfem import ElementQuadS2

from loaded_tca.analysis import analyse
from loaded_tca.compliance import MeshDensity
from loaded_tca.compliance.body import gear_nodes
from loaded_tca.compliance.dissection import factorise
from loaded_tca.compliance.finite_elements import Discretisation, discretise, node_offsets
from loaded_tca.compliance.geometry import BodyNodes
from loaded_tca.errors import AccuracyWarning
from loaded_tca.pairs.gear import Gear
from loaded_tca.results.load_factors import STRIPS, strip_borders, strip_forces
from loaded_tca.scene import Scene, parse_scene
from validation.calculix.comparison import SCENE
from validation.table import Row

Array = NDArray[np.float64]

MODULUS = 206000.0 / (2.0 * (1.0 - 0.3**2))
"""E* [MPa]."""
PRESSURE_ANGLE = math.radians(20.0)
LINE_LOAD = 150.0
"""Mean [N/mm]."""
LAYERS = {
    20.0: np.repeat([0.2, 0.2, 0.3, 0.4, 0.6, 0.8, 1.1, 1.4], 2),
    10.0: np.repeat([0.2, 0.2, 0.3, 0.4, 0.6, 0.8], 2),
}
"""By the width of the face: thickness of the layers of elements, each a slab, from its end to its middle [mm]."""
AT_THE_END = {0.0: 1.0, 5.0: 1.35, 10.0: 1.7}
"""By F_beta [um]: line load beside the loaded end over the mean, about, for the width of the strips."""
DENSITY = MeshDensity(through=8, flank=14, fillet=2, land=2, rim=4, neighbours=1, grading=2.5)
FINEST, GROWTH = 0.06, 1.7
"""Height of the elements beside the pitch line [mm], and of each over the one before."""
REPEATED = 20
"""Each repetition takes most of the error of the widths of the contact."""
KEPT = Path(__file__).parent / "data" / "face_ends_space.json"
ONE_PAIR: dict[str, object] = {"analysis.positions": 1, "analysis.load_sharing": False, "analysis.cells": [32, 192]}
SOURCE = "finite elements in space"
ASKED = 1e-2
"""A third of it is the elements': nine layers through the tooth, 0.05 mm high and 0.15 mm long at the ends, have 1.024,
1.347 and 1.674 for the 1.025, 1.350 and 1.679 of the wide pair. The rest is what one spread of the local term for all
heights of a flank leaves."""
AT_END = 2e-2
"""Of the strip at the loaded end, where the line load falls by a fifth within Hertz's half width."""


@dataclass(frozen=True)
class SpurPair:
    """A pair of spur gears, and how its scene differs from that of 25/37."""

    teeth: tuple[int, int]
    module: float
    centre_distance: float
    profile_shifts: tuple[float, float] = (0.0, 0.0)

    @property
    def radii(self) -> tuple[float, float]:
        """Of both working pitch circles [mm]."""
        first, second = (self.centre_distance * teeth / sum(self.teeth) for teeth in self.teeth)
        return first, second

    @property
    def base_radius(self) -> float:
        """Of the pinion [mm]."""
        return 0.5 * self.module * self.teeth[0] * math.cos(PRESSURE_ANGLE)

    def scene(self, width: float) -> Scene:
        """Scene with faces of a width [mm]."""
        changes: dict[str, object] = {
            "pair.normal_module_mm": self.module,
            "pair.centre_distance_mm": self.centre_distance,
        }
        for gear, teeth, shift in zip(("pinion", "wheel"), self.teeth, self.profile_shifts, strict=True):
            changes |= {f"{gear}.teeth": teeth, f"{gear}.profile_shift": shift}
        return parse_scene(SCENE.format(face_width=width)).with_changes(changes)

    def half_width(self, line_load: Array | float) -> Array:
        """Hertz's half width under line loads [mm]."""
        first, second = self.radii
        sine = math.sqrt(1.0 - (self.base_radius / first) ** 2)
        return np.sqrt(4.0 * line_load * first * second / sum(self.radii) * sine / (math.pi * MODULUS))


PAIRS = {"25/37": SpurPair((25, 37), 3.0, 93.0), "FZG A": SpurPair((16, 24), 4.5, 91.5, (0.8532, -0.5))}
CASES = (("25/37", 20.0, (0.0, 5.0, 10.0)), ("25/37", 10.0, (0.0, 5.0, 10.0)), ("FZG A", 20.0, (0.0, 10.0)))
"""Pairs, widths of their faces [mm], and F_beta [um]."""


def heights(height: float, pitch: float) -> Array:
    """Places of nodes up a flank of some height, 0 to 1, graded towards the pitch line, which is a corner."""
    below = min(max(round(DENSITY.flank * pitch / height), 4), DENSITY.flank - 4)
    parts = []
    for length, count in ((pitch, below), (height - pitch, DENSITY.flank - below)):
        sizes = FINEST * GROWTH ** np.arange(count)
        sizes[2:] *= (length - sizes[:2].sum()) / sizes[2:].sum()
        parts.append(np.cumsum(sizes))
    corners = np.concatenate([pitch - parts[0][::-1], [pitch], pitch + parts[1]]) / height
    return np.interp(np.arange(2 * DENSITY.flank + 1), 2 * np.arange(DENSITY.flank + 1), corners)


def body(gear: Gear, pitch_radius: float, layers: Array) -> tuple[BodyNodes, Array, int, int]:
    """Nodes of a gear and where they stand, graded towards the pitch line and the free end; its column and row."""
    nodes = gear_nodes(gear, replace(DENSITY, lengthwise=layers.size))
    layout = nodes.layout
    first, sector = layout.base_row + 2 * DENSITY.fillet, layout.sector(0)
    columns = slice(sector.first + 2 * DENSITY.land, sector.first + 2 * (DENSITY.land + DENSITY.through) + 1)
    flank = columns.stop - 1 if gear.flank.side > 0 else columns.start
    radius, angle = nodes.radius.copy(), nodes.angle.copy()
    root, tip = (float(radius[flank, row][0]) for row in (first, -1))
    places, even = heights(tip - root, pitch_radius - root), np.linspace(0.0, 1.0, 2 * DENSITY.flank + 1)
    for values in (radius, angle):
        values[columns, first:] = CubicSpline(even, values[columns, first:], axis=1)(places)
    nodes = replace(nodes, radius=radius, angle=angle)
    points = nodes.points
    points[..., 2] = np.interp(
        np.arange(2 * layers.size + 1), 2 * np.arange(layers.size + 1), np.append(0, layers.cumsum())
    )
    return nodes, points, flank, first + int(np.argmin(np.abs(radius[flank, first:, 0] - pitch_radius)))


def slab_compliances(gear: Gear, pitch_radius: float, layers: Array, strips: Sequence[float]) -> list[Array]:
    """Displacements (n, n) of the slabs of a gear under unit forces on each, by the half width of the strips [mm/N].

    ``gear`` has half the width of the face: the other half is its mirror image.
    """
    nodes, points, column, row = body(gear, pitch_radius, layers)
    lowest, spans, blocks = nodes.layout.bricks
    mesh = discretise(points, lowest, nodes.layout.turns, spans)
    matrices, loads = mesh.stiffness(gear.material), [nodal_forces(mesh, column, row, width) for width in strips]
    places = mesh.lowest // 2
    places[:, 2:] -= places[:, 2:] % 2  # no cut through an element that is twice as thick
    bore, middle, halves = nodes.layout.held(mesh.number), mesh.number[:, :, -1], []
    for components in ([2], [0, 1]):  # what the plane of symmetry holds under even and odd loads
        free = np.ones(mesh.points.shape, dtype=bool)
        free[bore[bore >= 0]] = False
        free[np.ix_(middle[middle >= 0], components)] = False
        factor = factorise(matrices, mesh.dofs, places, free.ravel(), kinds=mesh.kinds, blocks=blocks)
        halves.append([load.T @ factor.solve(load * free.reshape(-1, 1)) for load in loads])
    found = []
    for even, odd in zip(*halves, strict=True):
        own, other = 0.5 * (even + odd), 0.5 * (even - odd)
        found.append(np.block([[own, other[:, ::-1]], [other[::-1], own[::-1, ::-1]]]))
    return found


def nodal_forces(mesh: Discretisation, column: int, row: int, strip: float) -> Array:
    """Nodal forces (size, layers) of a unit force on every layer, as an elliptical pressure about a line of nodes."""
    section = mesh.points[mesh.number[column, :, 0]][:, :2]
    point, element = section[row], ElementQuadS2()
    tangent = section[row + 1] - section[row - 1]
    tangent /= np.hypot(*tangent)
    inward = np.array([tangent[1], -tangent[0]])
    inward *= -np.sign(inward @ point)  # towards the axis, from the flank of an external gear
    offsets = node_offsets(element)
    places, weights = (0.5 * part for part in np.polynomial.legendre.leggauss(24))
    places = places + 0.5
    forces = np.zeros((*mesh.points.shape, mesh.number.shape[2] // 2))
    for low in range(0, len(section) - 2, 2):
        ends = [float((section[low + end] - point) @ tangent) for end in (0, 2)]
        angles = np.arcsin(np.clip(ends, -strip, strip) / strip)
        angle = angles[0] + (angles[1] - angles[0]) * places  # of a place strip sin(angle)
        pressure = 2.0 / math.pi * np.cos(angle) ** 2 * (angles[1] - angles[0]) * weights
        local = (strip * np.sin(angle) - ends[0]) / (ends[1] - ends[0])
        across, along = (part.ravel() for part in np.meshgrid(local, places, indexing="ij"))
        amount = np.outer(pressure, weights).ravel()
        for number, (up, on) in enumerate(offsets):
            share = float(element.lbasis(np.array([across, along]), number)[0] @ amount)
            for layer in range(forces.shape[2] * (share != 0.0)):
                forces[mesh.number[column, low + up, 2 * layer + on], :2, layer] += share * inward
    return forces.reshape(mesh.points.size, -1)


def pair_compliances(spur: SpurPair, width: float, strips: Sequence[float]) -> list[Array]:
    """Those of both gears (n, n) [mm/N]."""
    pair = spur.scene(0.5 * width).pair()
    of_gears = [
        slab_compliances(gear, radius, LAYERS[width], strips)
        for gear, radius in zip((pair.pinion, pair.wheel), spur.radii, strict=True)
    ]
    return [one + other for one, other in zip(*of_gears, strict=True)]


def balance(spur: SpurPair, compliance: Array, layers: Array, misalignment: float, strip: float) -> Array:
    """Line load (n,) of the slabs that are displaced as far as the misaligned flanks are apart [N/mm]."""
    slab = np.concatenate([layers, layers[::-1]])
    gap = 1e-3 * misalignment * (slab.cumsum() - 0.5 * slab) / slab.sum()
    flattening = 2.0 / (math.pi * MODULUS)  # of both, per line load and unit of the logarithm
    load, count = np.full(slab.size, LINE_LOAD), slab.size
    system = np.zeros((count + 1, count + 1))
    system[-1, :-1], system[:-1, -1] = slab / slab.sum(), -1.0
    for _ in range(REPEATED):
        # of the mean displacement under the pressure; the middle lies deeper by a quarter of the flattening
        system[:-1, :-1] = compliance * slab + np.diag(flattening * (np.log(strip / spur.half_width(load)) + 0.25))
        load = np.linalg.solve(system, np.append(-gap, LINE_LOAD))[:-1]
    assert load.min() > 0.0, "the contact parts"
    return load


def over_mean(ends: Array, forces: Array) -> Array:
    """Means over the strips of K_Hbeta over that of the face (STRIPS,), from forces (n,) and where they end (n,)."""
    carried = CubicSpline(np.append(0.0, ends / ends[-1]), np.append(0.0, forces.cumsum()))
    return np.diff(carried(np.linspace(0.0, 1.0, STRIPS + 1))) * STRIPS / forces.sum()


def kept() -> dict[tuple[str, float, float], Array]:
    """Line loads of strips over the mean, by pair, width and misalignment."""
    means = {}
    for case in json.loads(KEPT.read_text())["cases"]:
        layers = LAYERS[case["width"]]
        slabs = np.concatenate([layers, layers[::-1]])
        means[case["pair"], case["width"], case["misalignment"]] = over_mean(slabs.cumsum(), slabs * case["line_load"])
    return means


def modelled(pair: str, width: float, misalignment: float) -> Array:
    """The same from an analysis of one position."""
    torque = 1e-3 * LINE_LOAD * width * PAIRS[pair].base_radius
    changes: dict[str, object] = {"load.pinion_torque_Nm": torque, "mounting.misalignment_um": misalignment}
    scene = PAIRS[pair].scene(width).with_changes({**ONE_PAIR, **changes})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the contact reaches the ends of the face
        result = analyse(scene)
    solved = result.maps[0][0][0]
    assert solved is not None
    forces, _ = strip_forces(result.gear_pair, solved, strip_borders(result.gear_pair, result.path))
    load = forces / forces.mean()
    return load if load[0] >= load[-1] else load[::-1]


def rows_of(pair: str, width: float, misalignment: float, reference: Array) -> list[Row]:
    """Largest line load over the mean, the largest difference of a strip, and the strip at the loaded end."""
    ours, case = modelled(pair, width, misalignment), f"face ends, {pair}, {width:g} mm, {misalignment:g} um"
    largest, ends = ((float(reference[n]), float(ours[m])) for n, m in ((reference.argmax(), ours.argmax()), (0, 0)))
    apart = float(np.abs(ours - reference)[1:-1].max())
    return [
        Row(case, SOURCE, "largest line load over the mean", *largest, ASKED),
        Row(case, SOURCE, "largest difference of a strip but those at the ends, over the mean", 0.0, apart, ASKED),
        Row(case, SOURCE, "line load over the mean at the loaded end", *ends, AT_END),
    ]


def short_rows() -> list[Row]:
    """Rows of the wide pair under the largest misalignment, where the hump beside the end is highest."""
    case = "25/37", 20.0, 10.0
    return rows_of(*case, kept()[case])


def rows() -> list[Row]:
    """Rows of all pairs, widths and misalignments."""
    return [row for case, reference in kept().items() for row in rows_of(*case, reference)]


def main() -> None:
    """Run the finite elements and keep the line loads."""
    cases = []
    for name, width, misalignments in CASES:
        spur, layers = PAIRS[name], LAYERS[width]
        strips = [float(spur.half_width(LINE_LOAD * AT_THE_END[value])) for value in misalignments]
        compliances = pair_compliances(spur, width, strips)
        for misalignment, strip, compliance in zip(misalignments, strips, compliances, strict=True):
            load = balance(spur, compliance, layers, misalignment, strip)
            line_load = [round(value, 2) for value in load.tolist()]
            cases.append({"pair": name, "width": width, "misalignment": misalignment, "line_load": line_load})
    provenance = "computed by python -m validation.loaded.face_ends_space"
    KEPT.parent.mkdir(exist_ok=True)
    KEPT.write_text(json.dumps({"provenance": provenance, "cases": cases}, indent=1) + "\n")


if __name__ == "__main__":
    main()
