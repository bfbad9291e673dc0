"""Root stress of a spur and a helical pinion in space under line loads beside finite elements.

Source: the kept rings of ``validation.calculix``: pinion 25 of 25/37, 20 mm wide, straight teeth loaded along the
highest points of single contact, teeth of 20 deg helix along a generator of the flank; 100 N/mm all along the face, or
rising from nothing at one end to twice that at the other.
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.compliance import FlankLine, RootStress, root_stress_model
from validation.calculix.case import FACE_WIDTH
from validation.calculix.ring_run import HELICES, LINE_LOAD, LOADS, loaded_line, pinion
from validation.calculix.tables import RING_FILLETS_FILE, RINGS_FILE, read_table
from validation.loaded.root_stress_models import spur_pair_gear
from validation.table import Row

SOURCE = "finite elements in space (CalculiX)"
IN_SPACE = 0.03
"""Asked of the largest tension and compression, and of both all along the face, over the largest."""
SIDES = {"loaded": ("tension", 1.0), "back": ("compression", -1.0)}
SLICES = 400
"""Parts of the face that the line load is cut into."""


@dataclass(frozen=True)
class Fillets:
    """Both fillets of the loaded tooth.

    Attributes
    ----------
    height : (n,) array [mm]
        Along the face, in the frame of the kept rings.
    angle, stress : dict of (m, n) arrays [deg], [MPa]
        Tangent angles and stress of the "loaded" side and the "back".
    """

    height: Array
    angle: dict[str, Array]
    stress: dict[str, Array]

    def largest(self, side: str) -> Array:
        """Largest tension of the loaded side or compression of the back along the face (n,) [MPa]."""
        sign = SIDES[side][1]
        return np.asarray(sign * (sign * self.stress[side]).max(axis=0))

    def at(self, side: str, heights: Array) -> Array:
        """The same at heights (k,) [mm]."""
        return np.interp(heights, self.height, self.largest(side))

    def along(self, side: str, height: float, angles: Array) -> Array:
        """Stress at tangent angles (k,) [deg] of a section [MPa]."""
        column = int(np.abs(self.height - height).argmin())
        return np.interp(angles, self.angle[side][:, column], self.stress[side][:, column])


def read_rings(path: Path = RINGS_FILE, way: str = "finer") -> dict[tuple[str, str], list[dict[str, float | str]]]:
    """Kept levels of the face by ring and load; none where the table is missing."""
    found: dict[tuple[str, str], list[dict[str, float | str]]] = {}
    for row in read_table(path) if path.exists() else []:
        if row["way"] == way:
            found.setdefault((str(row["ring"]), str(row["load"])), []).append(row)
    return found


@cache
def model_of(ring: str) -> RootStress:
    """Root stress model of the package."""
    return root_stress_model(spur_pair_gear(helix_deg=HELICES[ring]))


def fillets_under(ring: str, load: str) -> Fillets:
    """Stress of the package under a load of the kept rings."""
    model, (roll, change) = model_of(ring), loaded_line(ring)
    gear = model.frame.gear
    ends = np.linspace(-0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH, SLICES + 1)
    height = 0.5 * (ends[1:] + ends[:-1])  # in the frame of the rings
    radius = np.hypot(pinion(ring).base_radius, roll + change * height)
    helix = (
        gear.nominal_flank.theta(radius[:1], np.array([1.0])).value
        - gear.nominal_flank.theta(radius[:1], np.array([-1.0])).value
    )
    sense = -1.0 if helix[0] * gear.flank.side < 0.0 else 1.0  # the rings' loaded side turns towards +z
    forces = LINE_LOAD * (1.0 + LOADS[load] * height / ends[-1]) * np.diff(ends)
    stress = model.stress(0, [(FlankLine(0, radius, sense * height), forces)])
    angle = np.degrees(model.tangent_angle)
    along = np.linspace(-0.5, 0.5, stress.shape[2]) * FACE_WIDTH * sense
    order = np.argsort(along)
    return Fillets(
        along[order],
        {side: angle[n][:, order] for n, side in enumerate(SIDES)},
        {side: stress[n][:, order] for n, side in enumerate(SIDES)},
    )


def short_rows() -> list[Row]:
    """Rows of the helical ring under either load; ``root_face_load`` has the spur one."""
    return rows(("helical",))


def rows(rings: Container[str] = tuple(HELICES)) -> list[Row]:
    """Rows of kept rings under every load."""
    curves = read_table(RING_FILLETS_FILE) if RING_FILLETS_FILE.exists() else []
    return [
        row
        for (ring, load), kept in read_rings().items()
        if ring in rings
        for row in rows_of(
            f"{ring} pinion in space, {load} load",
            kept,
            [curve for curve in curves if (curve["ring"], curve["load"]) == (ring, load)],
            fillets_under(ring, load),
        )
    ]


Table = list[dict[str, float | str]]


def rows_of(case: str, kept: Table, curves: Table, ours: Fillets) -> Iterator[Row]:
    """Largest stress, its course along the face, and the stress along the fillets of the kept sections."""
    heights = np.array([float(row["height_mm"]) for row in kept])
    for side, (name, sign) in SIDES.items():
        values, found = np.array([float(row[f"{name}_MPa"]) for row in kept]), ours.at(side, heights)
        highest = sign * (sign * values).max()
        yield Row(case, SOURCE, f"{name}, largest [MPa]", highest, sign * (sign * ours.largest(side)).max(), IN_SPACE)
        apart = np.abs(found - values) / abs(highest)
        note = f"at {heights[apart.argmax()]:g} mm"
        words = f"{name} along the face, largest difference of {len(heights)} sections, of the largest"
        yield Row(case, SOURCE, words, 0.0, float(apart.max()), IN_SPACE, note=note)
        for place, ends, tolerance in (("inner sections", False, IN_SPACE), ("end faces", True, None)):
            worst, where = 0.0, ""
            for height in dict.fromkeys(float(curve["height_mm"]) for curve in curves):
                if (abs(height) == 0.5 * FACE_WIDTH) != ends:
                    continue
                own = [curve for curve in curves if curve["height_mm"] == height]
                angles, stress = (
                    np.array([float(curve[key]) for curve in own]) for key in ("angle_deg", f"{side}_MPa")
                )
                apart = np.abs(ours.along(side, height, angles) - stress) / abs(highest)
                if apart.max() > worst:
                    worst, where = float(apart.max()), f"at {height:g} mm, {angles[apart.argmax()]:g} deg"
            if where:
                words = f"along the fillet, {side} side, {place}, largest difference, of the largest"
                yield Row(case, SOURCE, words, 0.0, worst, tolerance, note=where)
