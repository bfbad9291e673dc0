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

from loaded_tca.arrays import Array
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
        jets = gear.flank.edges(rho, z)
        for edge, reach in REACHES.items():
            value, slope_rho, slope_z = np.broadcast_arrays(jets[edge].value, jets[edge].rho, jets[edge].z)
            steep = np.hypot(slope_rho, slope_z)
            distance = value / steep
            near = np.flatnonzero(there & (np.abs(distance) < reach * pair.module))
            if not near.size:
                continue
            end = near[np.abs(distance[near]).argmin()]
            inwards = np.array([slope_rho[end], 0.0, slope_z[end]]) / steep[end]
            angle = math.acos(float(np.clip(outward_normal(gear.flank, rho[end], z[end]) @ inwards, -1.0, 1.0)))
            with named(f"analysis.free_edges: {gear.flank.frame.edges[edge]} of the {name}"):
                factor = wedge_factor(angle, gear.material.poisson_ratio)
            slices = distance[near], separation.y[near], separation.spacing[1]
            faded = _faded(np.maximum(distance[near], 0.0) / (reach * pair.module))
            found[np.ix_(near, near)] += faded[:, None] * _added(*slices, pair.module, factor, gear.material) * faded
    return found if found.any() else None


def _faded(part: Array) -> Array:
    """From 1 at an edge to 0 at the end of its reach, without a kink."""
    return np.asarray(1.0 - part**2 * (3.0 - 2.0 * part))


def _added(distance: Array, y: Array, length: float, module: float, factor: float, material: Material) -> Array:
    """What an edge adds to the deflection of slices (n,) of a ``length`` at distances from it: (n, n) [mm/N].

    The image of a slice is a straight line, so that 1/R has its mean over it in closed form; the mean over the slice
    that it displaces is taken at three places.
    """
    scale = factor / quarter_space_factor(material.poisson_ratio)
    rise = np.clip(np.gradient(distance, y), -1.0, 1.0) if y.size > 1 else np.zeros(1)
    inside = np.maximum(distance, 0.0)  # a contact on an edge is beside it by rounding, or curves beyond it
    width = WIDTH * module
    offset = 0.5 * length * NODES[:, None, None]  # (3, 1, 1) of the places in the slice that is displaced
    own = np.maximum(distance[:, None] + rise[:, None] * offset, 0.0)
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
    mean = np.tensordot(0.5 * WEIGHTS, varied * surface - below * middle, axes=1)
    return np.asarray(0.5 * (mean + mean.T))
