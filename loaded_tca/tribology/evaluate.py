"""From slices and conditions to friction, temperatures and films: formulas on flat arrays (speed, slice)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.reference.friction import schlenk, xu_kahraman
from loaded_tca.reference.iso6336_22 import bulk_temperature, film_thickness, flash_temperature, mean_friction
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.tribology.conditions import LOCAL, MEAN, Conditions, Lubricant
from loaded_tca.tribology.slices import Slices, cylindrical_mesh

MILLI, MICRO = 1e-3, 1e-6
RMS_OF_MEAN = math.sqrt(0.5 * math.pi)
"""Root mean square over arithmetic mean roughness, of heights with a normal distribution."""


def pitch_weights(positions: int) -> Array:
    """Weights (n,) of a mean over a pitch whose first and last position are the same place of the mesh.

    Examples
    --------
    >>> pitch_weights(3)
    array([0.25, 0.5 , 0.25])
    """
    weights = np.ones(positions)
    weights[[0, -1]] *= 0.5
    return weights / weights.sum()


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Numbers of all slices under conditions, each found when it is first asked for.

    Attributes
    ----------
    result : MeshCycle
    slices : Slices
    conditions : Conditions
    """

    result: CycleNumbers
    slices: Slices
    conditions: Conditions

    @cached_property
    def omega(self) -> Array:
        """Angular velocity of the pinion (s, 1) [rad/s]."""
        return self.conditions.speeds[:, None] * (2.0 * math.pi / 60.0)

    @cached_property
    def rolling(self) -> Array:
        """Rolling velocities of both gears (2, s, n) [m/s]."""
        return MILLI * self.omega * self.slices.rolling[:, None]

    @cached_property
    def sum_velocity(self) -> Array:
        """Sum of both (s, n) [m/s]."""
        return np.abs(self.rolling.sum(axis=0))

    @cached_property
    def sliding_velocity(self) -> Array:
        """Sliding velocity (s, n) [m/s]."""
        return MILLI * self.omega * self.slices.sliding

    @cached_property
    def pressure_velocity(self) -> Array:
        """Pressure times sliding velocity (s, n) [MPa m/s]."""
        return self.slices.pressure * self.sliding_velocity

    @cached_property
    def dynamic_pressure(self) -> Array:
        """Pressure with K_A and K_v (n,) [MPa]: the load distribution is that of the contact analysis."""
        return self.slices.pressure * math.sqrt(self.conditions.dynamic)

    @property
    def oil(self) -> Lubricant:
        """The lubricant."""
        assert self.conditions.lubricant is not None  # what needs it is asked for only where there is one
        return self.conditions.lubricant

    @cached_property
    def friction(self) -> Array:
        """Coefficient of friction (s, n)."""
        wanted, shape = self.conditions.friction, (self.conditions.speeds.size, len(self.slices))
        if wanted == MEAN:
            return self.standard_friction[:, self.slices.torque]
        if isinstance(wanted, float):
            return np.full(shape, wanted)
        oil, slices = self.oil, self.slices
        viscosity = oil.viscosity(oil.oil_temperature)
        if wanted == LOCAL:
            load = self.conditions.dynamic * slices.line_load
            about = slices.relative_radius, viscosity, self.conditions.mean_roughness, oil.friction_factor
            return schlenk(load, self.sum_velocity, *about)
        assert self.conditions.roughness is not None
        entraining = 0.5 * self.sum_velocity
        slide_to_roll = np.divide(self.sliding_velocity, entraining, out=np.zeros(shape), where=entraining > 0.0)
        rough = RMS_OF_MEAN * math.hypot(*self.conditions.roughness)
        return xu_kahraman(self.dynamic_pressure, slide_to_roll, entraining, viscosity, slices.relative_radius, rough)

    @cached_property
    def standard_friction(self) -> Array:
        """Mean coefficient of ISO/TS 6336-22 (s, torque), with the load factors of the result."""
        result, mesh, oil = self.result, self._mesh, self.oil
        path = mesh.path_of_contact
        factors = self.conditions.dynamic * np.prod(
            [np.where(one >= 1.0, one, 1.0) for one in (result.face_load_factor, result.transverse_load_factor)], axis=0
        )
        load = factors * result.torque / (mesh.pinion.base_radius * result.face_width)
        radius = path.C * (path.T2 - path.C) / path.T2 / math.cos(mesh.pinion.base_helix_angle)
        viscosity = float(oil.viscosity(oil.oil_temperature))
        rough = self.conditions.mean_roughness
        velocity = 2.0 * MILLI * self.omega * path.C
        return mean_friction(load, velocity, radius, viscosity, rough, mesh.total_contact_ratio, oil.friction_factor)

    @cached_property
    def _mesh(self) -> Any:
        """Macro geometry of cylindrical gears."""
        return cylindrical_mesh(self.result)

    @cached_property
    def loss(self) -> Array:
        """Friction power of a coefficient of 1 over the angular velocity, (torque, position) [N mm]."""
        loss = np.zeros((len(self.result.torque), len(self.result.path)))
        np.add.at(loss, (self.slices.torque, self.slices.position), self.slices.loss)
        return loss

    @cached_property
    def friction_work(self) -> Array:
        """Friction power over the angular velocity, (s, torque, position) [N mm]."""
        work = np.zeros((self.conditions.speeds.size, *self.loss.shape))
        product = self.friction * self.slices.loss
        for speed, row in enumerate(product):
            np.add.at(work[speed], (self.slices.torque, self.slices.position), row)
        return work

    @cached_property
    def mean_loss(self) -> Array:
        """Mean over a pitch of ``loss`` over the torque: H_VL (torque,); NaN without torque."""
        return self._over_torque(self.loss @ pitch_weights(self.loss.shape[-1]))

    @property
    def mean_loss_of_half(self) -> Array:
        """The same of every second position; NaN of an even number, whose half does not end at the end of the pitch."""
        half = self.loss[:, ::2]
        if self.loss.shape[-1] % 2 == 0:
            return np.full(len(half), math.nan)
        return self._over_torque(half @ pitch_weights(half.shape[-1]))

    @cached_property
    def mean_friction_work(self) -> Array:
        """The same with the coefficients of friction, (s, torque): the part of the power that is lost."""
        return self._over_torque(self.friction_work @ pitch_weights(self.loss.shape[-1]))

    def _over_torque(self, work: Array) -> Array:
        torque = np.broadcast_to(self.result.torque, work.shape)
        return np.divide(work, torque, out=np.full(work.shape, math.nan), where=torque > 0.0)

    @cached_property
    def mean_friction(self) -> Array:
        """Mean coefficient of friction, weighted with the loss, (s, torque)."""
        return self.mean_friction_work / self.mean_loss

    @cached_property
    def bulk_temperature(self) -> Array:
        """Bulk temperature (s, torque) [C]."""
        if (given := self.conditions.bulk_temperature) is not None:
            return np.full((self.conditions.speeds.size, len(self.result.torque)), float(given))
        power = MICRO * self.omega * self.result.torque
        width, distance = self.result.face_width, self._mesh.working_centre_distance
        lost = self.mean_friction, self.mean_loss
        return bulk_temperature(self.oil.oil_temperature, power, *lost, distance, width, self.conditions.supply_factor)

    @cached_property
    def reduced_modulus(self) -> float:
        """E_r = 2 E* [MPa]."""
        return 2.0 * self.result.gear_pair.contact_modulus

    @cached_property
    def flash_temperature(self) -> Array:
        """Flash temperature (s, n) [K]."""
        pair = self.result.gear_pair
        first, second = (gear.material.thermal_contact_coefficient for gear in (pair.pinion, pair.wheel))
        return flash_temperature(
            self.friction,
            self.dynamic_pressure,
            self.slices.relative_radius,
            self.reduced_modulus,
            self.rolling[0],
            self.rolling[1],
            self.sliding_velocity,
            first,
            second,
        )

    @cached_property
    def contact_temperature(self) -> Array:
        """Contact temperature (s, n) [C]."""
        return self.bulk_temperature[:, self.slices.torque] + self.flash_temperature

    @cached_property
    def film_thickness(self) -> Array:
        """Film thickness (s, n) [um]."""
        return self._film(self.contact_temperature)

    @cached_property
    def isothermal_film_thickness(self) -> Array:
        """Film thickness without the thinning by the heat of sliding (s, n) [um]."""
        return self._film(self.bulk_temperature[:, self.slices.torque])

    def _film(self, hot: Array) -> Array:
        slices, bulk = self.slices, self.bulk_temperature[:, self.slices.torque]
        about = slices.relative_radius, self.reduced_modulus, self.dynamic_pressure, self.sum_velocity
        return film_thickness(*about, self.oil, bulk, hot)

    @cached_property
    def film_ratio(self) -> Array:
        """Film thickness over the mean roughness (s, n)."""
        return self.film_thickness / self.conditions.mean_roughness

    @cached_property
    def friction_power(self) -> Array:
        """Friction power of each slice (s, n) [W]."""
        return MILLI * self.omega * self.friction * self.slices.loss
