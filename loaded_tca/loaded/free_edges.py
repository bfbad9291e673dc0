r"""Free edges of teeth: what tip edges and face ends add to the deflection of the half-spaces, slice by slice.

A body that ends beside its contact is softer than a half-space. Hetenyi's solution of the quarter-space is met by
an image of the pressure in the end, at the distance R from the place that it displaces, with a factor that
depends on where both lie:

.. math:: \psi(S) = \psi + 0.4 \left(S - 0.9\right),\qquad S = 4 d d'/R^2

d and d' are the distances of the two from the end, S = 1 for a place and its own image. At other angles than 90 deg
psi(S) is scaled as psi is (:func:`loaded_tca.contact.wedge_factor`). What the image displaces in the middle of the
tooth is taken off, since bending counts it, or nothing does: far below a short contact a tooth is no quarter-space.
There S = 1/2 stands for all. The rest falls with the distance from the end over the thickness of the tooth, and
is faded out to nothing. No length in this depends on the load or on the grid.

References
----------
Hetenyi 1960, J. Appl. Mech. 27, 289-296; Guilbault 2011, J. Tribol. 133, 031402 (one image and a factor).
``validation/contact/free_edge.py`` and ``validation/contact/free_block.py`` compare.
"""

from __future__ import annotations

import math

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.compliance.half_space import depth_displacement
from loaded_tca.contact.edges import quarter_space_factor, wedge_factor
from loaded_tca.errors import named
from loaded_tca.flanks.base import outward_normal
from loaded_tca.material import Material
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.separation import Separation

DEPTH = 0.25 * math.pi
"""Of the middle of a tooth below its flank, over the module: half the thickness on the pitch circle."""
REACHES = {0: 0.5, 2: 3.0 * DEPTH, 3: 3.0 * DEPTH}
"""Distance over the module from which on an edge of a flank counts no more: of the tip edge, where bending knows the
tip from there on, and of both face ends. At the root a tooth goes on as the fillet."""
VARIATION, MEAN_PLACE, PLACE_BELOW = 0.4, 0.9, 0.5
"""psi(S) = psi + VARIATION (S - MEAN_PLACE), and the S that stands for all places in the middle of the tooth."""
WIDTH = 0.02
"""Distance across the contact that stands for its width, over the module. It is that of a half width of a twentieth
module, and matters within such a length from the end."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)


def edge_compliance(pair: GearPair, separation: Separation) -> Array | None:
    """What tip edges and face ends of both gears add to the deflection of the slices of a contact's grid.

    Parameters
    ----------
    pair : GearPair
    separation : Separation
        Grid of the contact.

    Returns
    -------
    (ny, ny) array or None [mm/N]
        Deflection of every slice under a unit force on each, symmetric; None where no end is in reach.

    Raises
    ------
    InputError
        If a tooth ends at an edge sharper than 30 degrees.

    Examples
    --------
    >>> from loaded_tca.gears import CylindricalGear, CylindricalMesh
    >>> from loaded_tca.pairs.cylindrical import cylindrical_pair
    >>> from loaded_tca.separation import sample_separation
    >>> from loaded_tca.unloaded import trace_contact
    >>> mesh = CylindricalMesh(*(CylindricalGear(teeth=z, normal_module=3.0, face_width=25.0) for z in (34, 57)))
    >>> pair = cylindrical_pair(mesh)
    >>> separation = sample_separation(pair, trace_contact(pair, [0.0])[0], cells=(16, 17), load=2700.0)
    >>> added = edge_compliance(pair, separation)
    >>> float(added[1, 1].round(8)), float(added[8, 8])  # the first slice of the face, and that in its middle
    (1.4e-06, 0.0)
    """
    points = separation.origin + separation.y[:, None] * separation.axes[1]
    radius, _, axial = pair.to_wheel(points)
    places = (np.hypot(points[:, 0], points[:, 1]), points[:, 2]), (radius, axial)
    there, found = separation.cover.any(axis=0), np.zeros((separation.y.size,) * 2)
    for name, gear, (rho, z) in zip(("pinion", "wheel"), (pair.pinion, pair.wheel), places, strict=True):
        jets, ends = gear.flank.edges(rho, z), []
        for edge, reach in REACHES.items():
            distance = jets[edge].value / np.hypot(jets[edge].rho, jets[edge].z)
            near = np.flatnonzero(there & (np.abs(distance) < reach * pair.module))
            if near.size:
                ends.append((edge, reach, distance, near, near[np.abs(distance[near]).argmin()]))
        if not ends:
            continue
        nearest = [end[-1] for end in ends]
        normals = outward_normal(gear.flank, rho[nearest], z[nearest]).tolist()
        for (edge, reach, distance, near, end), (out_rho, _, out_z) in zip(ends, normals, strict=True):
            in_rho, in_z = (float(np.broadcast_to(by, rho.shape)[end]) for by in (jets[edge].rho, jets[edge].z))
            cosine = (out_rho * in_rho + out_z * in_z) / math.hypot(in_rho, in_z)
            with named(f"analysis.free_edges: {gear.flank.frame.edges[edge]} of the {name}"):
                factor = wedge_factor(math.acos(min(max(cosine, -1.0), 1.0)), gear.material.poisson_ratio)
            added = _added(distance, near, separation, pair.module, factor, gear.material)
            faded = _faded(np.maximum(distance[near], 0.0) / (reach * pair.module))
            found[near[:, None], near] += faded[:, None] * added * faded
    return found if found.any() else None


def _faded(part: Array) -> Array:
    """From 1 at an edge to 0 at the end of its reach, without a kink."""
    return np.asarray(1.0 - part**2 * (3.0 - 2.0 * part))


def _added(
    distance: Array, near: Indices, separation: Separation, module: float, factor: float, material: Material
) -> Array:
    """What an edge at distances (ny,) adds to the deflection of the slices (n,) near it: (n, n) [mm/N].

    The image of a slice is a straight line, so that 1/R has its mean over it in closed form; the mean over the slice
    that it displaces is taken at three places.
    """
    scale, length = factor / quarter_space_factor(material.poisson_ratio), separation.spacing[1]
    y, rise, first = separation.y[near], np.zeros(near.size), near[0]
    if near.size > 1:
        rise = np.gradient(distance[first : near[-1] + 1], length)[near - first]
        rise = np.minimum(np.maximum(rise, -1.0), 1.0)
    inside = np.maximum(distance[near], 0.0)  # a contact on an edge is beside it by rounding, or curves beyond it
    width = WIDTH * module
    offset = 0.5 * length * NODES[:, None, None]  # (3, 1, 1) of the places in the slice that is displaced
    own = np.maximum(distance[near][:, None] + rise[:, None] * offset, 0.0)
    apart, both = y[:, None] + offset - y, own + inside
    aside = apart**2 * (1.0 - rise**2)
    along = apart * (1.0 - rise**2) - both * rise  # of the place, from the middle of the image along it
    square = both**2 + aside + width**2
    off = np.sqrt(np.maximum(square - along**2, width**2))
    inverse = (np.arcsinh((0.5 * length - along) / off) + np.arcsinh((0.5 * length + along) / off)) / length
    varied = factor + scale * VARIATION * (4.0 * own * inside / square - MEAN_PLACE)
    below = factor + scale * VARIATION * (PLACE_BELOW - MEAN_PLACE)
    surface = depth_displacement(np.asarray(0.0), np.asarray(1.0), material) * inverse
    middle = depth_displacement(np.asarray(DEPTH * module), np.sqrt(square), material)
    mean = ((0.5 * WEIGHTS) @ (varied * surface - below * middle).reshape(3, -1)).reshape(near.size, near.size)
    return np.asarray(0.5 * (mean + mean.T))
