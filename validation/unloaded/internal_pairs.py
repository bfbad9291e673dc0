"""A pinion in a ring: unmodified pairs are conjugate, and random crowned, misaligned ones touch where nothing overlaps.

Sixty pairs: differences of 9 to 70 teeth, helix angles up to 25 deg, crownings and mounting errors of both gears, both
senses and driving gears. Each contact is certified: the gap between the flanks, at the angles at which the tracing says
they touch, is nowhere negative on a scan of 121 by 161 places of the pinion's flank.
"""

from math import cos, radians

import numpy as np

from loaded_tca.errors import GeometryError
from loaded_tca.flank_maps.pattern import flank_gap
from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import CylindricalGear, InternalMesh, RingGear
from loaded_tca.pairs import GearPair, Mounting, internal_pair
from loaded_tca.unloaded import trace_teeth
from loaded_tca.unloaded.teeth import MeshPath
from validation.table import Row

CASE, SOURCE = "internal pairs", "conjugate flanks; scans of the gaps"
PAIRS, SEED = 60, 20
SCAN = 121, 161
ROUNDING_um, OVERLAP = 1e-9, 1e-9
"""Rounding over lengths of some 100 mm [um]; of the gap, which angles of contact carry to 1e-12 rad [mm]."""


def rows(count: int = PAIRS) -> list[Row]:
    """Largest transmission error of unmodified pairs [um], failures and overlap of random ones."""
    rng = np.random.default_rng(SEED)
    pairs = [_random_pair(rng) for _ in range(count)]
    conjugate = max(_error(mesh, driving) for mesh, _, driving in pairs)
    paths = [trace_teeth(pair) for _, pair, _ in pairs]
    untouched = sum(int(np.isnan(path.transmission_error).sum()) for path in paths)
    largest = "largest transmission error of the unmodified pairs [um]"
    return [
        Row(CASE, SOURCE, largest, 0.0, conjugate, ROUNDING_um, note=f"{count} pairs"),
        Row(CASE, SOURCE, "positions without contact of crowned, misaligned pairs", 0.0, untouched, 0.0),
        Row(CASE, SOURCE, "deepest overlap on scans at contact [mm]", 0.0, max(map(_deepest_overlap, paths)), OVERLAP),
    ]


def short_rows() -> list[Row]:
    """Rows of six pairs."""
    return rows(6)


Case = tuple[InternalMesh, GearPair, str]


def _random_pair(rng: np.random.Generator) -> Case:
    """A mesh, and the pair of it with crownings and errors; drawn again where there is interference."""
    while True:
        teeth, helix = int(rng.integers(18, 45)), radians(rng.uniform(0.0, 25.0))
        more = int(rng.integers(9, 71))
        shift, module = rng.uniform(0.0, 0.4), 3.0
        reference = (teeth + more) * module / cos(helix)
        try:
            pinion = CylindricalGear(teeth, module, 25.0, helix_angle=helix, profile_shift=shift)
            ring = RingGear(-teeth - more, module, 25.0, helix_angle=helix, tip_diameter=reference - 1.6 * module)
            mesh = InternalMesh(pinion, ring)
        except GeometryError:
            continue
        if mesh.overlap_clearance < 0.0 or mesh.pinion.base_pitch > mesh.path_of_contact.AE:
            continue
        crowned = [
            FlankModifications(lead_crowning=rng.uniform(0.003, 0.01), profile_crowning=rng.uniform(0.003, 0.01))
            for _ in range(2)
        ]
        errors = Mounting(*rng.uniform(-2e-4, 2e-4, 2), *rng.uniform(-0.05, 0.05, 2))
        driving = "pinion" if rng.random() < 0.5 else "wheel"
        sense = "positive" if rng.random() < 0.5 else "negative"
        pair = internal_pair(
            mesh, modifications=(crowned[0], crowned[1]), mounting=errors, driving=driving, sense=sense
        )
        return mesh, pair, driving


def _error(mesh: InternalMesh, driving: str) -> float:
    """Largest absolute transmission error of the pair without modifications [um]."""
    path = trace_teeth(internal_pair(mesh, driving="pinion" if driving == "pinion" else "wheel"))
    return 1e3 * mesh.ring.base_radius * float(np.abs(path.transmission_error).max())


def _deepest_overlap(path: MeshPath) -> float:
    """How far flanks overlap anywhere where a leading contact is said to be [mm]; rounding where they do not."""
    pair, contact = path.pair, path.leading_contact
    rho, z = pair.pinion.flank.grid(*SCAN)
    deepest = 0.0
    for pinion_angle, wheel_angle in zip(contact.pinion_angle[::10], contact.wheel_angle[::10], strict=True):
        gap, *_ = flank_gap(pair, "pinion", (pinion_angle, wheel_angle), (rho, z))
        deepest = max(deepest, -float(np.nanmin(gap)))
    return deepest
