"""What the interactive page of a result shows: numbers of curves, pressure maps, flanks and teeth for its script.

Curves are in full precision. Pressures are in steps of a 65534th of the largest of their map (``STEPS``); places are
single precision.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from loaded_tca.arrays import GEARS, Array
from loaded_tca.errors import GeometryError, InputError
from loaded_tca.pairs import MatingTeeth, mating_teeth
from loaded_tca.plain import signed
from loaded_tca.plots.flanks import ToPicture, flank_outlines, limits_of_flank
from loaded_tca.plots.pressure_map import pressure_seen
from loaded_tca.plots.style import position_label, torque_label
from loaded_tca.plots.three_d import DRAWN, LIFT
from loaded_tca.reports.arrays import Block, finite, scaled
from loaded_tca.reports.result_page import result_tables
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.numbers import index_or_largest
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.support_growth import gears_under_torque

AROUND = 1
"""Cells without pressure about those under pressure that the page has of a map."""
NODES = 3
"""Places of a map in each direction whose places on the flanks the page has; a parabola goes through them."""
ROOT_MAPS = {
    "at_tension": "root stress at the largest tension",
    "largest": "largest root stress in a turn",
    "smallest": "smallest root stress in a turn",
}
"""Maps of root stress that the page shows, and what it calls them."""
MOST_PER_FACE = 61
"""Places along the face at which the page has root stress, at most; those of the extremes are among the numbers."""


def result_page(result: MeshCycle) -> dict[str, Any]:
    """Return what the template of the interactive page of a result takes.

    Parameters
    ----------
    result : MeshCycle
    """
    block = Block()
    torque = index_or_largest(result.torque)
    place = result.peak_contact(torque)
    data = {
        "kind": "result",
        "positions": [position_label(result, n).removeprefix("position ") for n in range(len(result.path))],
        "torques": [torque_label(result, t).removeprefix("pinion torque ") for t in range(len(result.torque))],
        "pairs": [signed(number) for number in result.pair.tolist()],
        "begin": {"torque": torque, "position": 0 if place is None else place[0]},
        "angle": finite(np.degrees(result.pinion_angle)),
        "panels": [*_panels(result)],
        "peak_column": result.peak_column.tolist(),
        "highest": float(np.nanmax(result.peak_pressure, initial=0.0)) or 1.0,
        "hertz": [finite(getattr(result, f"hertz_{name}")) for name in ("pressure", "semi_minor", "semi_major")],
        "on_line": [path.on_line.astype(bool).tolist() for path in result.paths],
        "maps": _maps(result, block),
        "flanks": [_flank(result, gear, block) for gear in range(len(GEARS))],
        "teeth": _teeth(result, block),
    }
    return {
        **result_tables(result),
        "data": data,
        "block": block.text(),
        "positions": len(result.path),
        "torques": len(result.torque),
        "root_maps": [*ROOT_MAPS.items()],
        **{name: data[name] for name in ("begin", "panels", "teeth")},
    }


def _panels(result: MeshCycle) -> Iterator[dict[str, Any]]:
    """Curves over the positions: titles, and lines (torque, position) or (position) in the unit of the title."""
    um = result.um_per_rad
    error = {
        "under load": um * result.transmission_error,
        "unloaded": um * np.broadcast_to(result.unloaded_transmission_error, result.transmission_error.shape),
    }
    about_mean = {
        name: np.array([curve - mean_over_a_pitch(curve) for curve in values]) for name, values in error.items()
    }
    yield _panel("Transmission error less its mean", "µm", about_mean, ", as a length at the wheel's base circle")
    yield _panel("Transmission error", "µm", error, ", as a length at the wheel's base circle")
    yield _panel("Share of the torque", "%", _by_pair(result, 100.0 * result.load_share))
    yield _panel("Peak pressure", "MPa", _by_pair(result, result.peak_pressure))
    if np.isfinite(result.edge_pressure).any():
        yield _panel("Pressure at edges", "MPa", _by_pair(result, result.edge_pressure))
    yield _panel("Mesh stiffness", "N/(mm µm)", {"tangent": result.mesh_stiffness, "secant": result.secant_stiffness})
    if result.has_root_stress:
        stress = {"tension": result.root_tension, "compression": result.root_compression}
        lines = {f"{name}, {sign}": values[..., k] for k, name in enumerate(GEARS) for sign, values in stress.items()}
        yield _panel("Root stress", "MPa", lines)


def _panel(title: str, unit: str, lines: dict[str, Array], more: str = "") -> dict[str, Any]:
    shown = [{"name": name, "values": finite(values)} for name, values in lines.items()]
    return {"title": title, "unit": unit, "caption": f"over the pinion angle{more}.", "lines": shown}


def _by_pair(result: MeshCycle, values: Array) -> dict[str, Array]:
    """Values (torque, position, pair) by the names of the pairs."""
    return {f"tooth pair {signed(number)}": values[..., k] for k, number in enumerate(result.pair.tolist())}


def _maps(result: MeshCycle, block: Block) -> dict[str, Any]:
    """All maps: cells of each, their pressures end to end, and what places them.

    ``places`` has for each map the middle of its first cell, the cell sizes, the step of its pressures, the contact
    point, the directions across, along and normal, and the places in the pictures of both flanks of ``NODES`` x
    ``NODES`` points of its rectangle, from border to border.
    """
    shape = len(result.torque), len(result.path), len(result.pair)
    cells, places, pressures = np.zeros((*shape, 2), dtype=int), [], [np.zeros(0, dtype=np.uint16)]
    for t, rows in enumerate(result.maps):
        pair = gears_under_torque(result, t)[0].gear_pair
        to_pictures = [ToPicture(pair, gear) for gear in GEARS]
        for n, row in enumerate(rows):
            for k, one in enumerate(row):
                if one is None or not one.pressure.any():
                    continue
                rectangle = _rectangle(one)
                pressure = one.pressure[rectangle]
                steps, step = scaled(np.where(np.isinf(one.gap[rectangle]) & (pressure <= 0.0), np.nan, pressure))
                cells[t, n, k] = steps.shape
                pressures.append(steps.ravel())
                places.append(_place(one, rectangle, step, to_pictures))
    width = 5 + 3 + 9 + len(GEARS) * 2 * NODES**2
    return {
        "cells": block.add(cells, "uint16"),
        "pressure": block.add(np.concatenate(pressures), "uint16"),
        "places": block.add(np.array(places).reshape(-1, width)),
    }


def _rectangle(one: PressureMap) -> tuple[slice, slice]:
    """Smallest rectangle of cells with all that are under pressure, and those around."""
    across, along = (np.flatnonzero(one.pressure.any(axis=axis)) for axis in (1, 0))
    return slice(max(across[0] - AROUND, 0), across[-1] + 1 + AROUND), slice(
        max(along[0] - AROUND, 0), along[-1] + 1 + AROUND
    )


def _place(
    one: PressureMap, rectangle: tuple[slice, slice], step: float, to_pictures: Sequence[ToPicture]
) -> list[float]:
    """What places a map, see ``_maps``."""
    x, y = (centres[part] for centres, part in zip((one.x, one.y), rectangle, strict=True))
    (dx, dy), parts = one.spacing, np.linspace(0.0, 1.0, NODES)
    across, along = (centres[0] - 0.5 * size + parts * size * len(centres) for centres, size in ((x, dx), (y, dy)))
    nodes = one.origin + across[:, None, None] * one.axes[0] + along[:, None] * one.axes[1]
    on_flanks = np.concatenate([to_picture(nodes).ravel() for to_picture in to_pictures])
    return [float(x[0]), float(y[0]), dx, dy, step, *one.origin, *one.axes.ravel(), *on_flanks]


def _flank(result: MeshCycle, gear: int, block: Block) -> dict[str, Any]:
    """A flank: name, axes, outlines, fields of its picture, largest pressure over the mesh under each torque."""
    flank = (result.gear_pair.pinion.flank, result.gear_pair.wheel.flank)[gear]
    outlines, _ = flank_outlines(flank, (result.scene.active_starts()[gear], result.scene.active_ends()[gear]))
    low, high = limits_of_flank(outlines[0])
    pairs = [gears_under_torque(result, torque)[0].gear_pair for torque in range(len(result.torque))]
    envelopes = [
        pressure_seen(result, torque, ToPicture(pair, GEARS[gear]), low, high)[1] for torque, pair in enumerate(pairs)
    ]
    steps = [scaled(one) for one in envelopes]
    return {
        "name": result.scene.flank_names[gear],
        "axes": [*flank.frame.labels],
        "outlines": [finite(outline) for outline in outlines],
        "low": finite(low),
        "high": finite(high),
        "envelope": block.add(np.stack([one for one, _ in steps]), "uint16"),
        "steps": [step for _, step in steps],
    }


def _teeth(result: MeshCycle, block: Block) -> dict[str, Any]:
    """Both teeth, each in the frame of its gear, how far they are turned, and where the wheel stands; or why not."""
    try:
        teeth = mating_teeth(result.gear_pair, DRAWN)
    except (GeometryError, InputError) as error:
        return {"lacking": str(error), "root": []}
    pair = teeth.pair
    pinion, wheel = teeth.in_mesh(0.0, 0.0)
    vertices = pinion.vertices, (wheel.vertices - pair.wheel_origin) @ pair.wheel_axes.T
    turns = [path.pinion_angle - float(number) * pair.pitch for number, path in _paths(result)]
    wheel_turns = [path.wheel_angle - pair.ratio * float(number) * pair.pitch for number, path in _paths(result)]
    return {
        "lacking": "",
        "solids": [
            {"vertices": block.add(points), "triangles": block.add(mesh.triangles, "uint32")}
            for points, mesh in zip(vertices, (pinion, wheel), strict=True)
        ],
        "turns": [finite(pair.sense * np.array(turns)), finite(-pair.sense * np.array(wheel_turns))],
        "origin": finite(pair.wheel_origin),
        "axes": finite(pair.wheel_axes),
        "lift": (lift := LIFT * float(np.ptp(pinion.vertices, axis=0).max())),
        "root": _root_stress(result, teeth, lift, block) if result.has_root_stress else [],
    }


def _paths(result: MeshCycle) -> Iterator[tuple[int, Any]]:
    """Numbers of the pairs, and their paths."""
    return zip(result.pair.tolist(), result.paths, strict=True)


def _root_stress(result: MeshCycle, teeth: MatingTeeth, lift: float, block: Block) -> list[dict[str, Any]]:
    """Maps of root stress over both fillets of both gears, in the frames of the teeth as they are placed.

    Their places are so far [mm] outside of the fillets, whose facets would hide them.
    """
    side = teeth.pair.pinion.flank.side
    gears = []
    for one, tooth in zip(result.root_stress, (teeth.pinion, teeth.wheel), strict=True):
        along = _thinned(one.point.shape[2])
        points = one.point[:, :, along]
        angle = -side * tooth.half_thickness_angle
        cosine, sine = math.cos(angle), math.sin(angle)
        turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        stresses = {name: block.add(getattr(one, name)[..., along]) for name in ROOT_MAPS}
        gears.append({"points": block.add((points + lift * _outward(points)) @ turn), **stresses})
    return gears


def _outward(points: Array) -> Array:
    """Unit normals out of both sides of a tooth at points (2, n, m, 3): each side is away from the other one."""
    normals = np.cross(np.gradient(points, axis=1), np.gradient(points, axis=2))
    signs = np.sign((normals * (points - points[::-1])).sum(axis=(1, 2, 3), keepdims=True))
    return signs * normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def _thinned(count: int) -> NDArray[np.int_]:
    """Indices of so many places, both ends among them, of ``MOST_PER_FACE`` at most."""
    return np.unique(np.linspace(0, count - 1, min(count, MOST_PER_FACE)).round().astype(int))
