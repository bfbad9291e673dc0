"""Root stress models with fronts in single precision, beside the same in double: what rounding does to three bodies.

Solid gears, rings, thin rims, thin discs on small bores, many teeth, and material that hardly changes its volume: of
some the displacements are those of a body that gives way as a whole, and single precision is not enough; the model
sees that by one step of refinement and is made again in double. Differences are those of the whole table, stress at
both roots under unit forces all over the flanks, over its largest value. Rows are of a solid gear, the thin disc of the
largest difference of all, and of material that hardly changes its volume.

Bodies of 37 gears, some minutes: ``python -m validation.loaded.root_stress_precision``.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from loaded_tca.compliance import root_stress
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.material import Material
from loaded_tca.pairs.gear import Gear
from loaded_tca.threads import one_blas_thread
from validation.loaded.root_stress_models import CASE, spur_pair_gear
from validation.table import Row, render

SOURCE = "the same in double precision"
ALLOWED = 3e-4
"""Of the largest value: a tenth of what a finer mesh changes."""
TEETH, BORES, RATIOS = (17, 25, 60, 200), (0.0, 0.1, 0.55, 0.9), (0.3, 0.49)
"""Bore diameters over those of the root circle."""
WIDTHS = (3.0, 12.0)
THREE = (0.0, 0.3), (0.1, 0.3), (0.0, 0.49)
"""Bore and Poisson's ratio of the bodies in rows."""
COARSE = {"through": 4, "flank": 4, "fillet": 6, "rim": 4, "lengthwise": 6}


def bodies() -> Iterator[tuple[str, Gear]]:
    """All gears with their names."""
    for teeth in TEETH:
        for bore in BORES:
            for ratio in RATIOS:
                yield _body(teeth, bore, ratio, WIDTHS[0])
    for bore in (*BORES, 0.05):
        yield _body(25, bore, RATIOS[0], WIDTHS[1])


def _body(teeth: int, bore: float, ratio: float, width: float) -> tuple[str, Gear]:
    gear = spur_pair_gear(teeth, width)
    root = 2.0 * float(gear.form.root_radius(np.zeros(1))[0])
    name = f"{teeth} teeth, face {width:g} mm, bore of {bore:g} of the root circle, nu {ratio:g}"
    return name, replace(gear, bore_diameter=bore * root, material=Material(poisson_ratio=ratio))


def rows(changes: Mapping[str, int] = MappingProxyType({})) -> list[Row]:
    """The largest difference of three bodies, how many were made in single precision, and the time."""
    return _rows_of([_body(17, *about, WIDTHS[0]) for about in THREE], changes)


def short_rows() -> list[Row]:
    """The same on coarse meshes."""
    return rows(COARSE)


def _rows_of(chosen: list[tuple[str, Gear]], changes: Mapping[str, int] = MappingProxyType({})) -> list[Row]:
    differences, ratios, single = {}, [], 0
    for name, gear in chosen:
        density = replace(root_stress.stress_density(gear), **changes)
        frame = ToothFrame(gear, gear_nodes(gear, density, root_stress.OUTLINE))
        start = time.process_time()
        with one_blas_thread():
            found = root_stress.root_influence(frame)
            middle = time.process_time()
            exact = root_stress.root_influence(frame, single=False)
        ratios.append((middle - start) / (time.process_time() - middle))
        parts = ((found.stress, exact.stress), (found.stress_beside, exact.stress_beside))
        largest = max(float(np.abs(one).max()) for _, one in parts)
        differences[name] = max(float(np.abs(one - other).max()) for one, other in parts) / largest
        single += differences[name] > 0.0
    worst = max(differences, key=lambda name: differences[name])
    return [
        Row(CASE, SOURCE, "largest difference of stress", 0.0, differences[worst], ALLOWED, note=worst),
        Row(CASE, SOURCE, "bodies, of them in single precision", float(len(differences)), float(single), None),
        Row(CASE, SOURCE, "time over that of double precision, median", 1.0, statistics.median(ratios), None),
    ]


if __name__ == "__main__":
    print(render(_rows_of([*bodies()])))
