r"""Flanks cut by a cutter on a cradle: the angle at which a point (rho, z) of the blank is left on the tooth.

Frame of the machine: z along the axis of the cradle towards the blank, x along the root line of the blank, y upwards; a
right-hand member. The blank's axis has the direction (cos gamma_m, 0, sin gamma_m). A point (rho, theta, z) of the
blank, turned to the azimuth :math:`\alpha = \theta + \psi(\varphi)`, stands in the machine at

.. math:: x = \rho\cos\alpha\sin\gamma_m + z'\cos\gamma_m, \quad y = \rho\sin\alpha + E_m, \quad
          \zeta = -\rho\cos\alpha\cos\gamma_m + z'\sin\gamma_m + X_B + H\varphi, \quad z' = z + X_D .

Seen from the cutter, whose centre stands at the radius S_r and the angle q + phi, it lies at the height h above the
blade tips and at the distance d from the axis of the cutter. The cutter removes everything with

.. math:: G(\rho, \alpha, z, \varphi) = \pm\,[d - r(h)] < 0

(+ outside blade, - inside blade), so that material is left where the smallest G over the turn of the cradle is
positive. The flank is where it vanishes: with F(rho, theta, z, phi) = G(rho, theta + psi(phi), z, phi)

.. math:: F = 0, \qquad F_\varphi = 0 \ \text{(equation of meshing)}, \qquad F_{\varphi\varphi} > 0 .

Two equations in alpha and phi, solved by Newton's method; the derivatives of Theta follow from those of F:

.. math:: \Theta_i = -F_i/F_\theta, \qquad \varphi_i = -(F_{i\varphi} + F_{\theta\varphi}\Theta_i)/F_{\varphi\varphi},
          \qquad F_\theta\Theta_{ij} = F_{\varphi\varphi}\varphi_i\varphi_j - F_{ij} - F_{i\theta}\Theta_j
          - F_{j\theta}\Theta_i - F_{\theta\theta}\Theta_i\Theta_j .

Where F_phiphi vanishes the generated surface turns back in an edge: undercut. A formate gear has phi = 0 in place of
the equation of meshing.

References
----------
Litvin & Fuentes 2004, Gear Geometry and Applied Theory, sections 6.3 (singularities) and 21.3 (generated surfaces);
here the surface is sought over (rho, z) instead of over the parameters of the cutter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from loaded_tca.arrays import Array, Mask
from loaded_tca.flanks.base import Jet
from loaded_tca.gears.face_milled import BLADE_SIGNS, Blade, FlankName, MachineSettings

MOST_STEPS = 30
LARGEST_STEP = 0.2
"""Newton steps, and the largest change of an angle in one of them [rad]."""
RESOLVED = 1e-12
"""Steps below this [rad] end the iteration."""
RHO, Z, ALPHA, PHI = 0, 1, -2, -1
"""Entries of derivatives by (rho, z, alpha, phi), and of those by the angles alone."""


@dataclass(frozen=True, eq=False)
class Cut:
    """Position of the cutter's edge against points of the blank, with k = 4 derivatives by (rho, z, alpha, phi).

    Or with k = 2 by the angles alpha and phi alone.

    Attributes
    ----------
    value : (n,) array [mm]
        G.
    slopes : (k, n) array
        First derivatives of G.
    bends : (k, k, n) array
        Second derivatives of G.
    height, height_slopes : (n,) and (k, n) array [mm]
        h above the blade tips and its first derivatives.
    roll, roll_bend : (n,) array
        psi' and psi''.
    """

    value: Array
    slopes: Array
    bends: Array
    height: Array
    height_slopes: Array
    roll: Array
    roll_bend: Array

    @property
    def meshing(self) -> Array:
        """F_phi [mm/rad], whose root is the equation of meshing."""
        return self.slopes[PHI] + self.roll * self.slopes[ALPHA]

    @property
    def meshing_slopes(self) -> Array:
        """Derivatives (k, n) of F_phi, that by phi at fixed alpha."""
        slopes = self.bends[PHI] + self.roll * self.bends[ALPHA]
        slopes[PHI] += self.roll_bend * self.slopes[ALPHA]
        return slopes

    @property
    def sharpness(self) -> Array:
        """F_phiphi [mm/rad^2]: positive on the flank, zero where it turns back in an edge."""
        slopes = self.meshing_slopes
        return slopes[PHI] + self.roll * slopes[ALPHA]


@dataclass(frozen=True, eq=False)
class GeneratedPoints:
    """Points of a generated flank.

    Attributes
    ----------
    theta : Jet
        Theta [rad] with its derivatives, (n,) each.
    cradle : (n,) array [rad]
        phi, turn of the cradle that cuts the point.
    height : (n,) array [mm]
        h, of the cutting edge above the blade tip.
    sharpness : (n,) array
        Second derivative of the angle left by the cutter by phi: positive on the flank, 0 in an undercut edge.
    converged : (n,) bool array
    """

    theta: Jet
    cradle: Array
    height: Array
    sharpness: Array
    converged: Mask

    @property
    def found(self) -> Mask:
        """Whether there is such a point of the flank: no undercut edge lies above it."""
        return self.converged & (self.sharpness > 0.0)


class CradleGeneration:
    """Kinematics of one flank of a right-hand member.

    Parameters
    ----------
    blade : Blade
    flank : {"concave", "convex"}
    machine : MachineSettings
    """

    def __init__(self, blade: Blade, flank: FlankName, machine: MachineSettings) -> None:
        self.blade, self.machine = blade, machine
        self.sign = BLADE_SIGNS[flank]
        tilt, swivel = machine.tilt, machine.swivel
        self.axis = np.array(
            [-math.sin(tilt) * math.sin(swivel), math.sin(tilt) * math.cos(swivel), math.cos(tilt)],
        )
        self._sine, self._cosine = math.sin(machine.root_angle), math.cos(machine.root_angle)

    def solve(self, rho: Array, z: Array) -> GeneratedPoints:
        """Points of the flank at (rho, z), (n,) arrays [mm]."""
        alpha, phi = self._start(rho, z)
        moving = np.ones(rho.shape, dtype=bool)
        for _ in range(MOST_STEPS):
            place = rho[moving], alpha[moving], z[moving], phi[moving]
            steps = self._step(self.cut(*place, by_angles_alone=True), phi[moving])
            alpha[moving] += steps[0]
            phi[moving] += steps[1]
            moving[moving] = np.abs(steps).max(axis=0) > RESOLVED
            if not moving.any():
                break
        return self._points(self.cut(rho, alpha, z, phi), alpha, phi, ~moving)

    def at_height(self, height: float, distance: Array) -> tuple[Array, GeneratedPoints]:
        """Where a height of the cutting edge ends up on the flank, at cone distances (n,) [mm].

        Parameters
        ----------
        height : float [mm]
            Above the blade tip.
        distance : (n,) array [mm]
            R from the apex of the pitch cone.

        Returns
        -------
        (n,) array [rad], GeneratedPoints
            Cone angles u; converged on either side of an undercut edge.
        """
        angle = self.machine.root_angle + np.arcsin(np.clip((height + self.machine.sliding_base) / distance, -0.5, 0.5))
        alpha, phi = self._start(distance * np.sin(angle), distance * np.cos(angle))
        for _ in range(MOST_STEPS):
            rho, z = distance * np.sin(angle), distance * np.cos(angle)
            cut = self.cut(rho, alpha, z, phi)
            meshing, meshing_slopes = self._meshing(cut, phi)
            values = np.array([cut.value, meshing, cut.height - height])
            by_place = np.array([cut.slopes, meshing_slopes, cut.height_slopes])
            by_angle = by_place[:, RHO] * z - by_place[:, Z] * rho
            matrix = np.stack([by_angle, by_place[:, ALPHA], by_place[:, PHI]], axis=1)
            steps = -_solved(np.moveaxis(matrix, 2, 0), values.T)
            steps = np.clip(steps, -LARGEST_STEP, LARGEST_STEP)
            angle, alpha, phi = angle + steps[:, 0], alpha + steps[:, 1], phi + steps[:, 2]
            resolved = np.abs(steps).max(axis=1) <= RESOLVED
            if resolved.all():
                break
        rho, z = distance * np.sin(angle), distance * np.cos(angle)
        return angle, self._points(self.cut(rho, alpha, z, phi), alpha, phi, resolved)

    def cut(self, rho: Array, alpha: Array, z: Array, phi: Array, by_angles_alone: bool = False) -> Cut:
        """Position of the cutter's edge against points of the blank."""
        place, slopes, bends = self._seen_from_cutter(rho, alpha, z, phi)
        if by_angles_alone:
            slopes, bends = slopes[ALPHA:], bends[ALPHA:, ALPHA:]
        along, along_bends, height = -self.axis @ slopes, -self.axis @ bends, -self.axis @ place
        across = place + np.multiply.outer(self.axis, height)
        distance = np.sqrt(np.einsum("an,an->n", across, across))
        outward = np.einsum("an,ian->in", across, slopes) / distance
        products = np.einsum("ian,jan->ijn", slopes, slopes) + np.einsum("an,ijan->ijn", across, bends)
        squares = along[:, None] * along[None]
        products -= squares + outward[:, None] * outward[None]
        widening, steepness, bend = self.blade.widening(height)
        return Cut(
            self.sign * (distance - self.blade.point_radius) - widening,
            self.sign * outward - steepness * along,
            self.sign * products / distance - steepness * along_bends - bend * squares,
            height,
            along,
            *self.roll(phi)[1:],
        )

    def place(self, rho: Array, alpha: Array, z: Array, phi: Array) -> Array:
        """Place (3, n) of points of the blank from the cutter's centre along e_r, e_t, z [mm]."""
        return self._seen_from_cutter(rho, alpha, z, phi)[0]

    def roll(self, phi: Array) -> tuple[Array, Array, Array]:
        """Turn of the blank psi(phi) [rad], psi' and psi''."""
        machine = self.machine
        ratio, second, third = machine.ratio_of_roll, machine.modified_roll_2c, machine.modified_roll_6d
        turn = ratio * phi * (1.0 - phi * (second / 2.0 + phi * third / 6.0))
        return turn, ratio * (1.0 - phi * (second + 0.5 * phi * third)), -ratio * (second + phi * third)

    def _seen_from_cutter(self, rho: Array, alpha: Array, z: Array, phi: Array) -> tuple[Array, Array, Array]:
        """Place (3, n) from the cutter's centre along e_r, e_t, z; its slopes (4, 3, n) and bends (4, 4, 3, n)."""
        machine, sine, cosine = self.machine, self._sine, self._cosine
        turn = machine.cradle_angle + phi
        turn_sine, turn_cosine = np.sin(turn), np.cos(turn)

        def seen(x: Any, y: Any, out: Array) -> None:
            out[0], out[1] = x * turn_cosine + y * turn_sine, y * turn_cosine - x * turn_sine

        alpha_sine, alpha_cosine = np.sin(alpha), np.cos(alpha)
        withdrawn = z + machine.machine_centre_to_back
        place, slopes, bends = (np.zeros((*lead, 3, rho.size)) for lead in ((), (4,), (4, 4)))
        seen(alpha_cosine * sine, alpha_sine, slopes[RHO])
        slopes[RHO, 2] = -alpha_cosine * cosine
        seen(-alpha_sine * sine, alpha_cosine, bends[RHO, ALPHA])
        bends[RHO, ALPHA, 2] = alpha_sine * cosine
        bends[ALPHA, RHO] = bends[RHO, ALPHA]
        slopes[ALPHA], bends[ALPHA, ALPHA] = rho * bends[RHO, ALPHA], -rho * slopes[RHO]
        seen(cosine, 0.0, slopes[Z])
        slopes[Z, 2] = sine
        place += rho * slopes[RHO] + withdrawn * slopes[Z]
        place[0] += machine.blank_offset * turn_sine
        place[1] += machine.blank_offset * turn_cosine
        for entry in (RHO, ALPHA, Z):
            _turned_back(slopes[entry], bends[PHI, entry])
            bends[entry, PHI] = bends[PHI, entry]
        _turned_back(place, slopes[PHI])
        _turned_back(slopes[PHI], bends[PHI, PHI])
        slopes[PHI, 2] = machine.helical_motion
        place[2] += machine.sliding_base + machine.helical_motion * phi
        place[0] -= machine.radial
        return place, slopes, bends

    def _start(self, rho: Array, z: Array) -> tuple[Array, Array]:
        """Azimuth and turn of the cradle at which the point would stand on the root line, alpha = 0.

        A formate gear is turned instead of the cradle.
        """
        machine = self.machine
        withdrawn = z + machine.machine_centre_to_back
        along = rho * self._sine + withdrawn * self._cosine
        height = rho * self._cosine - withdrawn * self._sine - machine.sliding_base
        radius = self.blade.point_radius + self.sign * self.blade.widening(height)[0]
        cosine = (machine.radial**2 + along**2 - radius**2) / (2.0 * machine.radial * along)
        turn = np.arccos(np.clip(cosine, -1.0, 1.0)) - machine.cradle_angle
        if machine.rolls:
            return np.zeros_like(turn), turn
        return -along * turn / rho, np.zeros_like(turn)

    def _step(self, cut: Cut, phi: Array) -> Array:
        """Newton step (2, n) of alpha and phi."""
        slopes, (meshing, meshing_slopes) = cut.slopes, self._meshing(cut, phi)
        determinant = slopes[ALPHA] * meshing_slopes[PHI] - slopes[PHI] * meshing_slopes[ALPHA]
        determinant = np.where(np.abs(determinant) > 1e-300, determinant, 1e-300)
        steps = np.array(
            [
                slopes[PHI] * meshing - cut.value * meshing_slopes[PHI],
                cut.value * meshing_slopes[ALPHA] - slopes[ALPHA] * meshing,
            ]
        )
        return np.clip(steps / determinant, -LARGEST_STEP, LARGEST_STEP)

    def _meshing(self, cut: Cut, phi: Array) -> tuple[Array, Array]:
        """The second equation and its derivatives (k, n): F_phi, or phi of a formate gear."""
        if self.machine.rolls:
            return cut.meshing, cut.meshing_slopes
        slopes = np.zeros_like(cut.slopes)
        slopes[PHI] = 1.0
        return phi, slopes

    def _points(self, cut: Cut, alpha: Array, phi: Array, resolved: Array) -> GeneratedPoints:
        """Theta and its derivatives at a solution."""
        converged = resolved & (np.abs(cut.slopes[ALPHA]) > 1e-300)
        lead = np.where(converged, cut.slopes[ALPHA], 1.0)
        theta = [-cut.slopes[entry] / lead for entry in (RHO, Z)]
        sharpness = cut.sharpness if self.machine.rolls else np.ones_like(lead)
        turns_back = np.abs(sharpness) < 1e-300
        turned = [cut.meshing_slopes[entry] + cut.meshing_slopes[ALPHA] * theta[i] for i, entry in enumerate((RHO, Z))]
        parts = []
        for (i, first), (j, second) in (((0, RHO), (0, RHO)), ((0, RHO), (1, Z)), ((1, Z), (1, Z))):
            bend = cut.bends[first, second] + cut.bends[ALPHA, ALPHA] * theta[i] * theta[j]
            bend += cut.bends[first, ALPHA] * theta[j] + cut.bends[second, ALPHA] * theta[i]
            if self.machine.rolls:
                bend -= turned[i] * turned[j] / np.where(turns_back, 1.0, sharpness)
            parts.append(-bend / lead)
        jet = Jet(alpha - self.roll(phi)[0], theta[0], theta[1], parts)
        return GeneratedPoints(jet, phi, cut.height, sharpness / np.abs(lead), converged)


def _solved(matrices: Array, values: Array) -> Array:
    """Solutions (n, k) of n systems; a singular one is made regular by a trace of its own size."""
    size = np.abs(matrices).max(axis=(1, 2), keepdims=True)
    return np.linalg.solve(matrices + 1e-14 * size * np.eye(matrices.shape[-1]), values[..., None])[..., 0]


def _turned_back(place: Array, out: Array) -> None:
    """What a vector (3, n) changes by in the cradle's frame while the cradle turns by one radian."""
    out[0], out[1] = place[1], -place[0]
