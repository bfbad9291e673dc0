"""Flexibility of one gear's teeth: a table of displacements under unit forces all over one flank."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebpts2
from scipy.sparse import vstack

from loaded_tca.arrays import Array
from loaded_tca.compliance.body import FlankPlaces, ToothFrame, gear_body
from loaded_tca.compliance.local_term import local_flexibility

HEIGHTS = 6
"""Places along the profile between which the displacements are interpolated."""
LENGTHS_PER_LAYER = 2.0
"""Places across the face, over the layers of elements, and at least:"""
LEAST_LENGTHS = 11


@dataclass(frozen=True, eq=False)
class ToothFlexibility:
    """What finite elements say of one gear, loaded on one flank.

    Attributes
    ----------
    heights, lengths : (a,), (b,) array
        Parts of the flank's height and of the face width, where the finite elements were loaded and read.
    displacement : (teeth, a b, a b) array [mm/N]
        Of the teeth ``-neighbours`` to ``+neighbours``: at the second place under a force at the third on tooth 0.
    depth : (a, b) array [mm]
        From there along the normal to the middle of the tooth.
    local_height, local_value : (n,) array
        Parts of the flank's height, increasing, and the local term there [mm per N/mm].
    """

    heights: Array
    lengths: Array
    displacement: Array
    depth: Array
    local_height: Array
    local_value: Array


def grid_of_places(frame: ToothFrame) -> tuple[Array, Array, FlankPlaces]:
    """Heights (a,) and lengths (b,) of the table, and the places (a b) that they make on the flank."""
    layers = frame.nodes.layout.density.lengthwise
    heights = 0.5 + 0.5 * chebpts2(HEIGHTS)
    lengths = 0.5 + 0.5 * chebpts2(max(LEAST_LENGTHS, math.ceil(LENGTHS_PER_LAYER * layers)))
    grid = np.meshgrid(heights, lengths, indexing="ij")
    return heights, lengths, frame.places(*(parts.ravel() for parts in grid))


def tooth_flexibility(frame: ToothFrame) -> ToothFlexibility:
    """Load a gear body by unit forces all over one flank.

    Parameters
    ----------
    frame : ToothFrame

    Raises
    ------
    GeometryError
        If the mesh is turned inside out.
    """
    heights, lengths, places = grid_of_places(frame)
    mesh, factor = gear_body(frame.nodes, frame.gear.material)
    number, size, near = mesh.number, len(mesh.points), frame.nodes.layout.neighbours
    forces = frame.on_flank(places, number).along(-places.normal, size)
    teeth = [frame.on_middle(places, tooth, number) for tooth in range(-near, near + 1)]
    readings = vstack([middle.along(-places.normal, size) for middle in teeth], format="csr")
    displacement = factor.flexibility(forces, readings).reshape(len(teeth), len(places.height), -1)
    depth = places.depth.reshape(len(heights), len(lengths))
    return ToothFlexibility(heights, lengths, displacement, depth, *local_flexibility(frame.gear))
