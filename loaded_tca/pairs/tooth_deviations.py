"""Where the teeth of a gear stand beside their nominal places: index deviations of single teeth, eccentricity.

Both separate a tooth pair from contact, by a length along the transverse line of action at the base circles, positive
where the flanks come apart. An index deviation belongs to its tooth; an eccentricity turns with the gear and shifts
all of its teeth together, so that on cylindrical gears it changes no share of the load.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from loaded_tca.arrays import Array, Indices
from loaded_tca.pairs.gear_pair import GearPair
from loaded_tca.roots import find_root

LONG_WAVES = (1.0, 0.35, 0.2)
"""Amplitudes of the first orders of a turn in random deviations: clamping and indexing leave mostly the first one."""
PARALLEL = 0.9
"""Cosine of the angle between the axes of cylindrical pairs, mounting errors included, at the least."""


@dataclass(frozen=True, eq=False)
class ToothDeviations:
    """Deviations of the teeth of one gear.

    Attributes
    ----------
    index : (z,) array [mm]
        Index deviation of each tooth, in the order in which the teeth come into mesh: how far its flank is set back
        from the mating flank, at the base circle.
    eccentricity : float [mm]
        Distance of the axis of the teeth from the axis of rotation; half the runout.
    phase : float [rad]
        Azimuth of that distance in the gear's own frame, from its x axis about its z axis, where tooth 0 touches at the
        pitch point.
    """

    index: Array
    eccentricity: float = 0.0
    phase: float = 0.0

    @property
    def are_none(self) -> bool:
        """Whether all teeth stand at their nominal places."""
        return not self.index.any() and self.eccentricity == 0.0


@dataclass(frozen=True, eq=False)
class ToothFlanks:
    """Flanks that differ tooth by tooth: kinds of teeth of each gear, and the gears of each pairing of them.

    Attributes
    ----------
    kinds : (array, array)
        Kind of every tooth of pinion (z1,) and wheel (z2,), whole numbers; 0: the common flanks.
    gears : mapping of (int, int) to GearPair
        With the flanks of a kind of pinion tooth and a kind of wheel tooth.
    """

    kinds: tuple[Indices, Indices]
    gears: Mapping[tuple[int, int], GearPair]


def transverse_normal(pair: GearPair) -> Array | None:
    """Normal (3,) of both base circles of a cylindrical pair at its mounted distance, out of the pinion; else None."""
    along = pair.wheel_axes[2, 2]  # about 1, of a ring, whose frame is turned about the x axis, -1
    if abs(along) < PARALLEL:
        return None
    radii = pair.base_radii[1] + np.sign(along) * pair.base_radii[0]
    cosine = min(radii / float(np.hypot(*pair.wheel_origin[:2])), 1.0)
    return np.array([np.sqrt(1.0 - cosine**2), pair.sense * pair.driving * cosine, 0.0])


def eccentric_separation(
    pair: GearPair, deviations: tuple[ToothDeviations, ToothDeviations], angles: tuple[Array, Array], direction: Array
) -> Array:
    r"""Separation (...) [mm] of tooth pairs by the eccentricity of both gears.

    .. math:: e = n \cdot (d_2 - d_1)

    to first order in the displacements d of the teeth of both gears.

    Parameters
    ----------
    pair : GearPair
    deviations : (ToothDeviations, ToothDeviations)
        Of pinion and wheel.
    angles : (array, array) [rad]
        How far the gears have turned in the motion since their teeth 0 touched at the pitch point.
    direction : (..., 3) array
        n: of cylindrical pairs :func:`transverse_normal`, which all tooth pairs have in common; else the normal out of
        the pinion at a contact, times r_b2 over its lever about the axis of the wheel.
    """
    pinion, wheel = deviations
    azimuth = pinion.phase + pair.sense * angles[0], wheel.phase - pair.sense * angles[1]
    in_wheel = direction @ pair.wheel_axes[:2].T
    of_wheel = wheel.eccentricity * (np.cos(azimuth[1]) * in_wheel[..., 0] + np.sin(azimuth[1]) * in_wheel[..., 1])
    of_pinion = pinion.eccentricity * (np.cos(azimuth[0]) * direction[..., 0] + np.sin(azimuth[0]) * direction[..., 1])
    return of_wheel - of_pinion


def random_index(teeth: int, single: float, cumulative: float, seed: int) -> Array:
    r"""Random index deviations that fill a single and a cumulative pitch tolerance.

    .. math:: i_j = a\,w_j + b\,n_j

    with w a sum of the first orders of a turn of random phases, n normally distributed. The amounts a and b >= 0 are
    such that the largest step from tooth to tooth is the single pitch tolerance, and the range of all the cumulative
    one, where both can be.

    Parameters
    ----------
    teeth : int
    single, cumulative : float
        Tolerances, in one unit.
    seed : int
        Of the random numbers.

    Returns
    -------
    (teeth,) array
        In that unit, with the mean 0.

    Examples
    --------
    >>> index = random_index(40, 9.0, 29.0, seed=1)
    >>> round(float(np.ptp(index)), 6), round(float(np.abs(index - np.roll(index, 1)).max()), 6)
    (29.0, 9.0)
    """
    generator = np.random.default_rng(seed)
    turn = 2.0 * np.pi * np.arange(teeth) / teeth
    phases = generator.uniform(0.0, 2.0 * np.pi, len(LONG_WAVES))
    waves = np.array([size * np.cos(n * turn + phases[n - 1]) for n, size in enumerate(LONG_WAVES, 1)]).sum(axis=0)
    noise = generator.standard_normal(teeth)

    def step(index: Array) -> float:
        return float(np.abs(index - np.roll(index, 1)).max())

    def with_noise(amount: float) -> Array:
        """Waves of an amount, with so much noise that the largest step is the single pitch tolerance."""
        index = amount * waves
        missing = single - step(index)
        if missing <= 0.0:
            return index
        most = 2.0 * (single + step(index)) / step(noise)
        return index + noise * find_root(lambda share: step(index + share * noise) - single, 0.0, most)

    most = min(cumulative / float(np.ptp(waves)), single / step(waves))
    excess = [float(np.ptp(with_noise(amount))) - cumulative for amount in (0.0, most)]
    if excess[0] >= 0.0:  # so few teeth that noise alone fills the cumulative tolerance
        index = noise * (cumulative / float(np.ptp(noise)))
    elif excess[1] <= 0.0:
        index = with_noise(most)
    else:
        index = with_noise(find_root(lambda amount: float(np.ptp(with_noise(amount))) - cumulative, 0.0, most))
    return index - index.mean()
