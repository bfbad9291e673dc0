"""Plane mesh of one whole gear: eight-node quadrilaterals, fine where its loaded teeth touch, coarse elsewhere.

Each tooth is ruled between its two sides, each rim runs along radial lines from tooth and space to the bore; all
sectors share the radial layers, so that teeth of any fineness stand side by side without ties.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from validation.calculix.grading import graded
from validation.calculix.tooth_form import Array, ToothForm

Ints = NDArray[np.int64]

SIDE_SAMPLES = 4001
FILLET_SHARE = 0.6
"""Height of the lower end of the tooth's sides: this part of the way from root circle to form circle."""
MERGE = 1e-7
"""Nodes closer than this are one [mm]; the finest elements are 1000 times as large."""


@dataclass(frozen=True)
class Fineness:
    """Sizes of the elements of a tooth.

    Attributes
    ----------
    radius : float [mm]
        Where the flank is touched.
    finest : float [mm]
        Size there.
    core, depth : float [mm]
        How far to either side along the flank, and below it, the size stays the finest.
    growth : float
        Growth of the size per length beyond.
    coarsest : float [mm]
    fillet : float [mm]
        Largest element along both fillets and below them, if less.
    elements : pair of int, or None
        Along the side of the tooth and through it, where sizes are not to decide: sections of one gear with the same
        numbers have the same topology.
    """

    radius: float
    finest: float
    core: float
    depth: float
    growth: float
    coarsest: float
    fillet: float = math.inf
    elements: tuple[int, int] | None = None


@dataclass(frozen=True)
class Section:
    """Plane mesh of a gear.

    Attributes
    ----------
    nodes : (n, 2) array [mm]
        In the fixed frame.
    elements : (m, 8) int array
        Four corners, counter-clockwise, then the midside nodes, the first one between the first two corners.
    flanks : dict of int arrays
        By tooth: elements whose first side (from first to second corner) lies on the loaded flank.
    bore : int array
        Nodes on the bore.
    """

    nodes: Array
    elements: Ints
    flanks: dict[int, Ints]
    bore: Ints


def gear_section(
    form: ToothForm, fineness: dict[int, Fineness], layers: Array, first_tooth: float, centre: float, step: int
) -> Section:
    """Mesh of all teeth.

    Parameters
    ----------
    form : ToothForm
    fineness : dict
        Of every tooth 0 ... z - 1, counted as the tooth pairs are.
    layers : (k,) array
        Fractions of the way from tooth to bore, from 0 to 1.
    first_tooth : float [rad]
        Polar angle of the middle of tooth 0 about the gear's own axis.
    centre : float [mm]
        Place of the axis on the x axis.
    step : int
        +1 if tooth numbers grow with the polar angle, else -1. The loaded flank is the one at the larger angle.
    """
    patches, flanks, count = [], {}, 0
    for tooth in range(form.teeth):
        blocks = _sector(form, fineness[tooth], layers)
        middle = first_tooth + step * tooth * form.pitch
        for name, (radius, angle) in blocks.items():
            grid = np.stack([centre + radius * np.cos(angle + middle), radius * np.sin(angle + middle)], axis=-1)
            patches.append(grid)
            if name == "tooth":
                flanks[tooth] = count + np.arange(grid.shape[0] // 2) * (grid.shape[1] // 2)
            count += (grid.shape[0] // 2) * (grid.shape[1] // 2)
    nodes, elements = _merge(patches)
    bore = np.flatnonzero(np.abs(np.hypot(nodes[:, 0] - centre, nodes[:, 1]) - form.bore_radius) < 1e-6)
    return Section(nodes, elements, flanks, bore)


def side_radii(form: ToothForm, fine: Fineness) -> Array:
    """Radii of the nodes along the side of a tooth, from the tip down into the fillet."""
    lowest = form.root_radius + FILLET_SHARE * (form.fillet[0][0] - form.root_radius)
    radius = np.linspace(form.tip_radius, lowest, SIDE_SAMPLES)
    steps = np.hypot(np.diff(radius), radius[1:] * np.diff(form.half_angle(radius)))
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    place = np.interp(-fine.radius, -radius, arc)
    ends, elements = (math.inf, fine.fillet), fine.elements[0] if fine.elements else None
    along = graded(arc[-1], place, fine.core, fine.finest, fine.growth, fine.coarsest, ends, elements)
    return np.interp(along, arc, radius)


def _sector(form: ToothForm, fine: Fineness, layers: Array) -> dict[str, tuple[Array, Array]]:
    """Blocks of one pitch as polar grids: inwards along the first index, falling angle along the second."""
    radius = side_radii(form, fine)
    half = form.half_angle(radius)
    width = 2.0 * fine.radius * float(form.half_angle(fine.radius))
    ends, elements = (fine.fillet, fine.fillet), fine.elements[1] if fine.elements else None
    across = graded(width, 0.0, fine.depth, fine.finest, fine.growth, fine.coarsest, ends, elements)
    across /= width
    x = np.multiply.outer(radius * np.cos(half), np.ones_like(across))
    y = np.multiply.outer(radius * np.sin(half), 1.0 - 2.0 * across)
    tooth = (np.hypot(x, y), np.arctan2(y, x))
    blocks = {"tooth": tooth, "under": _rim(form, tooth[0][-1], tooth[1][-1], layers)}
    spaces = _space(form, radius[-1], min(fine.coarsest, fine.fillet))
    for name, sign in (("before", 1.0), ("behind", -1.0)):
        top, angle = spaces if sign < 0 else (spaces[0][::-1], spaces[1][::-1])
        blocks[name] = _rim(form, top, sign * angle, layers)
    return blocks


def _space(form: ToothForm, lowest: float, size: float) -> tuple[Array, Array]:
    """Rest of the fillet and half of the root land: radii and angles from the side of the tooth outwards."""
    radius, angle = form.fillet
    below = radius < lowest
    radius = np.concatenate([[lowest], radius[below], [form.root_radius]])
    angle = np.concatenate([form.half_angle(np.array([lowest])), angle[below], [0.5 * form.pitch]])
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(radius), radius[1:] * np.diff(angle)))])
    at = np.linspace(0.0, arc[-1], 2 * max(1, round(arc[-1] / size)) + 1)
    return np.interp(at, arc, radius), np.interp(at, arc, angle)


def _rim(form: ToothForm, top: Array, angle: Array, layers: Array) -> tuple[Array, Array]:
    """Radial lines from the nodes of the top to the bore; the angle falls along the second index."""
    radius = top + (form.bore_radius - top) * layers[:, None]
    return radius, np.broadcast_to(angle, radius.shape)


def _merge(patches: list[Array]) -> tuple[Array, Ints]:
    """Nodes of all patches without doubles and without the centres of the elements, and the elements.

    They keep the order of the patches, so that meshes of slightly different forms have the same numbers.
    """
    points = np.concatenate([patch.reshape(-1, 2) for patch in patches])
    elements, offset = [], 0
    for patch in patches:
        index = offset + np.arange(patch.shape[0] * patch.shape[1]).reshape(patch.shape[:2])
        elements.append(_quadrilaterals(index))
        offset += index.size
    corners = np.concatenate(elements)
    used = np.unique(corners)
    key = np.round(points[used] / MERGE).astype(np.int64)
    _, first, inverse = np.unique(key, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    number = np.empty_like(order)
    number[order] = np.arange(order.size)
    return points[used][first[order]], number[inverse.reshape(-1)][np.searchsorted(used, corners)]


def _quadrilaterals(index: Ints) -> Ints:
    """Eight-node elements of a grid of node numbers, odd rows and columns holding the midside nodes."""
    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))
    rows, columns = index.shape
    parts = [index[i : rows - 2 + i : 2, j : columns - 2 + j : 2] for i, j in around]
    return np.stack([part.ravel() for part in parts], axis=-1)
