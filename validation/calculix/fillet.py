"""Stress along the fillets of one tooth: the nodes on them, the tangents there, and what a run says of both."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from validation.calculix.section import Ints
from validation.calculix.tooth_form import Array, ToothForm

LEAST_ANGLE = math.radians(15.0)
"""Tangent angle from which on stress is told, as in the package: above, a low load leaves local stress."""
OFF_PROFILE = 1e-6
"""A node this close to the profile [mm] is on it."""
PLACES = 2001
"""Places along a fillet among which the largest stress is sought."""


@dataclass(frozen=True)
class Fillet:
    """One side of a tooth from the end of its involute to the middle of the space.

    Attributes
    ----------
    nodes : (n,) int array
        Of the section.
    angle : (n,) array [rad]
        Between the profile and the middle of the tooth.
    tangent : (n, 2) array
        Along the profile, in the frame of the section.
    arc : (n,) array [mm]
        Along the profile.
    """

    nodes: Ints
    angle: Array
    tangent: Array
    arc: Array

    def across(self, stress: Array) -> Array:
        """Stress along the profile (n, ...) of stresses (n, ..., 3) at its nodes: xx, yy, xy [MPa]."""
        x, y = (self.tangent[:, k].reshape(-1, *(1,) * (stress.ndim - 2)) for k in (0, 1))
        return x * x * stress[..., 0] + y * y * stress[..., 1] + 2.0 * x * y * stress[..., 2]

    def told(self, stress: Array) -> tuple[Array, Array]:
        """Tangent angles (m,) [rad] from :data:`LEAST_ANGLE` on, and the stress (n, ...) of the nodes there."""
        fine = np.linspace(0.0, self.arc[-1], PLACES)
        angle = np.interp(fine, self.arc, self.angle)
        first = int(np.flatnonzero(angle < LEAST_ANGLE)[-1]) + 1
        return angle[first:], CubicSpline(self.arc, stress)(fine)[first:]


def fillets(form: ToothForm, nodes: Array, middle: float, centre: float) -> tuple[Fillet, Fillet]:
    """Fillets of a tooth: first the one on the side of the larger polar angle.

    Parameters
    ----------
    form : ToothForm
    nodes : (n, 2) array [mm]
        Of the section.
    middle : float [rad]
        Polar angle of the middle of the tooth about the gear's own axis.
    centre : float [mm]
        Place of the axis on the x axis.
    """
    outline, slope = _outline(form)
    radius = np.hypot(nodes[:, 0] - centre, nodes[:, 1])
    away = (np.arctan2(nodes[:, 1], nodes[:, 0] - centre) - middle + math.pi) % (2.0 * math.pi) - math.pi
    on_land = np.abs(radius - form.root_radius) < OFF_PROFILE
    on_fillet = (radius < form.fillet[0][0]) & (np.abs(np.abs(away) - form.half_angle(radius)) * radius < OFF_PROFILE)
    reach = (on_land & (np.abs(away) > form.fillet[1][-1]) | on_fillet) & (
        np.abs(away) < 0.5 * form.pitch + OFF_PROFILE / form.root_radius
    )
    found = []
    for side in (1.0, -1.0):
        chosen = np.flatnonzero(reach & (side * away > 0.0))
        chosen = chosen[np.argsort(np.abs(away[chosen]))]
        angle = np.interp(np.abs(away[chosen]), outline, slope)
        turned = middle + side * (math.pi - angle)  # the profile runs down and outwards
        tangent = np.stack([np.cos(turned), np.sin(turned)], axis=-1)
        arc = np.append(0.0, np.cumsum(np.hypot(*np.diff(nodes[chosen], axis=0).T)))
        found.append(Fillet(chosen, angle, tangent, arc))
    return found[0], found[1]


def _outline(form: ToothForm) -> tuple[Array, Array]:
    """Polar angles (rising) and tangent angles against the middle of the tooth, down to the middle of the space."""
    radius, angle = form.fillet
    land = np.linspace(angle[-1], 0.5 * form.pitch, 101)[1:]
    place = np.append(radius * np.exp(1j * angle), form.root_radius * np.exp(1j * land))
    along = np.gradient(place[: len(radius)], edge_order=2)
    tangent = np.append(along, 1j * np.exp(1j * land))
    return np.append(angle, land), np.arctan2(tangent.imag, -tangent.real)
