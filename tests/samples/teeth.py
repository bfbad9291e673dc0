"""Complete teeth that the tests of the package ``tooth`` share, and what is computed about them apart from it."""

import math

import numpy as np

from loaded_tca.flanks import FlankModifications
from loaded_tca.gears import BevelMesh, CylindricalGear, CylindricalMesh, bevel_mesh
from loaded_tca.pairs.bevel import bevel_pair
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.tooth import Resolution, build_tooth
from tests.samples.gear_pairs import NONE, cylindrical_mesh

COARSE = Resolution(flank=9, fillet=7, land=3, lengthwise=5)
CROWNED = FlankModifications(lead_crowning=0.01, profile_crowning=0.005)
RELIEVED = FlankModifications(lead_crowning=0.02, profile_crowning=0.01, helix_slope=0.01, profile_slope=-0.01)

MESHES = {
    "spur": cylindrical_mesh((24, 57)),
    "helical": cylindrical_mesh((20, 33), helix_deg=25.0, shifts=(0.2, -0.1)),
    "undercut": CylindricalMesh(CylindricalGear(14, 3.0, 25.0), CylindricalGear(40, 3.0, 25.0, tip_diameter=124.0)),
    "full rounding": cylindrical_mesh((20, 40), root_radius_coefficient=9.0),
    "straight bevel": bevel_mesh((39, 32), 2.5, 14.0),
    "miter gear": bevel_mesh((20, 40), 3.0, 20.0, profile_shifts=(0.416, -0.416)),
    "spiral bevel": bevel_mesh((17, 17), 1.0, 4.8, spiral_angle=math.radians(35.0)),
    "crown bevel": bevel_mesh((15, 40), 3.0, 15.0, shaft_angle=math.radians(120.0)),
}


def pair_of(mesh, sense="positive", modifications=NONE, **changes):
    make = bevel_pair if isinstance(mesh, BevelMesh) else cylindrical_pair
    return make(mesh, sense=sense, modifications=(modifications, modifications), **changes)


def gear_of(mesh, member=0, modifications=NONE):
    pair = pair_of(mesh, modifications=modifications)
    return (pair.pinion, pair.wheel)[member]


def flanks_of(mesh, member=0, modifications=NONE):
    """Both flanks of a gear, s = +1 first."""
    return gear_of(mesh, member, modifications).flanks


def form_of(mesh, member=0, fillet_radius=None):
    form = gear_of(mesh, member).form
    return form if fillet_radius is None else form.with_arc(fillet_radius)


def tooth_of(mesh, member=0, modifications=NONE, resolution=COARSE, fillet_radius=None):
    return build_tooth(flanks_of(mesh, member, modifications), form_of(mesh, member, fillet_radius), resolution)


def image(outline, sections):
    """Polar coordinates (n, m) of an outline in the images of its sections."""
    rho, z = np.hypot(outline[..., 0], outline[..., 1]), outline[..., 2]
    return sections.radius(rho, z), np.unwrap(np.arctan2(outline[..., 1], outline[..., 0]), axis=0)


def crossings(points):
    """Number of pairs of segments of an open polygon (n, 2) that cross each other."""
    start, step = points[:-1], np.diff(points, axis=0)
    apart = start[None] - start[:, None]

    def cross(a, b):
        return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

    turn = cross(step[:, None], step[None])
    parallel = np.abs(turn) < 1e-14
    turn = np.where(parallel, 1.0, turn)
    first, second = cross(apart, step[None]) / turn, cross(apart, step[:, None]) / turn
    within = (first > 1e-9) & (first < 1 - 1e-9) & (second > 1e-9) & (second < 1 - 1e-9)
    return int((within & ~parallel).sum()) // 2
