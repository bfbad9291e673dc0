"""Life under variable load, ISO 6336-6: S-N curves, damage after Palmgren and Miner, lives, safeties, equivalents.

An S-N curve is a chain of straight lines in logarithms between its knees. The knees are those of the tables of life
factors in ISO 6336-2 and ISO 6336-3; they are the same in the editions of 2006 and 2019. Arrays broadcast, with the
bins of a spectrum last; curves may differ from bin to bin, since their levels may be arrays.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import exp, inf, log
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import loaded_tca.roots as roots
from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, interval_check
from loaded_tca.errors import InputError, require
from loaded_tca.reference.iso6336_5 import material_kind

LONG_LIFE, LONG_LIFE_CYCLES = 0.85, 1e10
"""Life factor at the end of a curve, up to 1 by experience with material, making and oil; load cycles there."""


_BROKEN = 100.0  # logarithm of a damage that no spectrum bears
_LEVEL = 1.0 + 1e-6  # static over reference strength of a line that is all but level


class Knees(NamedTuple):
    """Cycles of the knees of a curve, and life factors there, from the static to the reference strength."""

    cycles: tuple[float, ...]
    factors: tuple[float, ...]


_HARD = ("St", "V", "GGG", "GTS", "Eh", "IF")
_SOFT_CASE = ("GG", "GGG ferritic", "NT", "NV")
FLANK_KNEES: dict[str, Knees] = {
    **dict.fromkeys(_HARD, Knees((1e5, 5e7), (1.6, 1.0))),
    **dict.fromkeys(_SOFT_CASE, Knees((1e5, 2e6), (1.3, 1.0))),
    "NV nitrocarburized": Knees((1e5, 2e6), (1.1, 1.0)),
}
"""Of Z_NT, by family: ISO 6336-2, table of life factors."""
LIMITED_PITTING_KNEES = Knees((6e5, 1e7, 1e9), (1.6, 1.3, 1.0))
"""Of the families St, V, GGG, GTS, Eh and IF where some pits are allowed."""
ROOT_KNEES: dict[str, Knees] = {
    **dict.fromkeys(("V", "GGG", "GTS"), Knees((1e4, 3e6), (2.5, 1.0))),
    **dict.fromkeys(("Eh", "IF"), Knees((1e3, 3e6), (2.5, 1.0))),
    **dict.fromkeys(("St", "GG", "GGG ferritic", "NT", "NV"), Knees((1e3, 3e6), (1.6, 1.0))),
    "NV nitrocarburized": Knees((1e3, 3e6), (1.1, 1.0)),
}
"""Of Y_NT, by family: ISO 6336-3, table of life factors."""


@checked
@dataclass(frozen=True, eq=False)
class SNCurve:
    r"""Strength over load cycles, straight between its knees in logarithms.

    Between two knees :math:`N = N_k (\sigma_k/\sigma)^{p_k}`; constant before the first, the static strength, and
    after the last. A stress below the last knee is borne for ever.

    Parameters
    ----------
    cycles : array (knee,)
        N of the knees, ascending.
    stresses : array (knee, ...)
        Strength there [MPa], or the factor on it, descending.
    static_limit : bool
        Whether the first load cycle above the static strength breaks the tooth; else the first line goes on above it,
        as in the example of ISO 6336-6, annex C.

    Raises
    ------
    InputError
        If knees are out of order, not positive or not finite.

    Examples
    --------
    >>> curve = SNCurve([1e5, 5e7], [1.6, 1.0])
    >>> [round(float(each), 3) for each in curve.strength([1e3, 1e6, 5e7, 1e9])]
    [1.6, 1.344, 1.0, 1.0]
    >>> [f"{life:.3g}" for life in curve.life([1.7, 1.6, 1.0, 0.99])]
    ['0', '1e+05', '5e+07', 'inf']
    """

    cycles: Array
    stresses: Array
    static_limit: bool = True

    def __post_init__(self) -> None:
        for name in ("cycles", "stresses"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=float))
        cycles, stresses = self.cycles, self.stresses
        knees = cycles.ndim == 1 and len(cycles) > 1 and stresses.shape[:1] == cycles.shape
        require(
            (knees, f"stresses: shape {stresses.shape} for knees of shape {cycles.shape}, two or more are asked for")
        )
        require(*(interval_check(name, getattr(self, name), "(0, inf)") for name in ("cycles", "stresses")))
        ascend = bool((np.diff(cycles) > 0.0).all())
        require(
            (ascend, "" if ascend else f"cycles: {cycles} do not ascend"),  # arrays take half a millisecond to write
            (bool((np.diff(stresses, axis=0) < 0.0).all()), "stresses: they do not descend from knee to knee"),
        )

    @cached_property
    def logarithms(self) -> tuple[Array, Array]:
        """Logarithms of the cycles and of the stresses of the knees."""
        return np.log(self.cycles), np.log(self.stresses)

    @cached_property
    def exponents(self) -> Array:
        """p of each line between two knees (knee - 1, ...)."""
        cycles, stresses = self.logarithms
        lengths = np.diff(cycles).reshape(-1, *[1] * (stresses.ndim - 1))
        return np.asarray(lengths / -np.diff(stresses, axis=0))

    def strength(self, cycles: ArrayLike) -> Array:
        """Stress that is borne for a number of load cycles."""
        number = np.asarray(cycles, dtype=float)
        require(interval_check("cycles", number, "[0, inf]"))
        knees, levels = self.logarithms
        clipped, height = np.log(np.clip(number, self.cycles[0], self.cycles[-1])), levels[0]
        for start, end, exponent in zip(knees[:-1], knees[1:], self.exponents, strict=True):
            height = height - (np.clip(clipped, start, end) - start) / exponent
        return np.asarray(np.exp(height))

    def life(self, stress: ArrayLike) -> Array:
        """Load cycles that a stress is borne for: inf below the last knee, 0 above the static strength."""
        level = np.asarray(stress, dtype=float)
        require(interval_check("stress", level, "[0, inf]"))
        with np.errstate(divide="ignore"):
            return np.exp(self.logarithm_of_life(np.log(level)))

    def logarithm_of_life(self, log_stress: Array) -> Array:
        """Logarithm of the life under the logarithm of a stress: inf below the last knee, -inf above the first."""
        knees, levels = self.logarithms
        number = knees[-1]
        for place, exponent in enumerate(self.exponents):
            low, high = levels[place + 1], None if place == 0 and not self.static_limit else levels[place]
            number = number - exponent * (np.clip(log_stress, low, high) - low)
        life = np.where(log_stress < levels[-1], inf, number)
        return np.where((log_stress > levels[0]) & self.static_limit, -inf, life)

    def scaled(self, reference: ArrayLike, static: ArrayLike | None = None) -> SNCurve:
        r"""Curve of a gear from that of life factors, whose reference strength is 1.

        .. math:: \sigma = \sigma_{ref} \left(\frac{\sigma_{stat}}{\sigma_{ref}}\right)^{\ln Z/\ln Z_{stat}}
            \quad (Z \ge 1),\qquad \sigma = \sigma_{ref} Z \quad (Z < 1)

        which is the interpolation in logarithms between static and reference strength of the standard.

        Parameters
        ----------
        reference, static : array [MPa]
            Strengths with their own factors; static, if not given: reference times its life factor. One below the
            reference counts as equal: the line is then all but level.
        """
        factors, level = self.stresses, np.asarray(reference, dtype=float)
        if factors.ndim != 1 or 1.0 not in factors:
            raise InputError("scaled: a curve of life factors is asked for, with the factor 1 at one of its knees")
        largest = level * factors[0] if static is None else np.asarray(static, dtype=float)
        largest = np.maximum(largest, level * _LEVEL)
        parts = np.log(np.maximum(factors, 1.0)) / log(factors[0])
        rows = [
            level * (largest / level) ** part * min(factor, 1.0) for part, factor in zip(parts, factors, strict=True)
        ]
        return replace(self, stresses=np.stack(np.broadcast_arrays(*rows)))


def _curve(knees: Knees, long_life_factor: float, static_limit: bool) -> SNCurve:
    require(
        (LONG_LIFE <= long_life_factor <= 1.0, f"long_life_factor: {long_life_factor}; allowed {LONG_LIFE} to 1"),
    )
    cycles, factors = knees
    if long_life_factor < 1.0:
        cycles, factors = (*cycles, LONG_LIFE_CYCLES), (*factors, long_life_factor)
    return SNCurve(np.array(cycles), np.array(factors), static_limit)


@checked
def flank_curve(
    kind: str, *, limited_pitting: bool = False, long_life_factor: float = LONG_LIFE, static_limit: bool = True
) -> SNCurve:
    """S-N curve of the life factor Z_NT.

    Parameters
    ----------
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    limited_pitting : bool
        Whether some pits are allowed.
    long_life_factor : float
        Z_NT at 1e10 load cycles, 0.85 to 1; at 1 the reference strength is borne for ever.
    static_limit : bool
        As for ``SNCurve``.

    Raises
    ------
    InputError
        If the kind is unknown or has no curve with pits, or the factor is out of range.

    References
    ----------
    ISO 6336-2:2019, clause 10, table of life factors.

    Examples
    --------
    >>> curve = flank_curve("Eh")
    >>> [round(float(each), 3) for each in curve.strength([1e4, 5e7, 1.08e9, 1e10])]
    [1.6, 1.0, 0.91, 0.85]
    """
    family = material_kind(kind).family
    if not limited_pitting:
        return _curve(FLANK_KNEES[family], long_life_factor, static_limit)
    require((family in _HARD, f"limited_pitting: the standard has no life factors with pits for kind {kind!r}"))
    return _curve(LIMITED_PITTING_KNEES, long_life_factor, static_limit)


@checked
def root_curve(kind: str, *, long_life_factor: float = LONG_LIFE, static_limit: bool = True) -> SNCurve:
    """S-N curve of the life factor Y_NT.

    Parameters
    ----------
    kind, long_life_factor, static_limit
        As for ``flank_curve``.

    References
    ----------
    ISO 6336-3:2019, clause 10, table of life factors.

    Examples
    --------
    >>> [round(float(each), 2) for each in root_curve("Eh").strength([1e3, 3e6, 1e10])]
    [2.5, 1.0, 0.85]
    """
    return _curve(ROOT_KNEES[material_kind(kind).family], long_life_factor, static_limit)


@checked
def damages(curve: SNCurve, stresses: ArrayLike, cycles: ArrayLike) -> Array:
    r"""Damage of each bin, :math:`U_i = n_i/N_i`.

    Parameters
    ----------
    curve : SNCurve
    stresses : array (..., bin) [MPa]
    cycles : array (..., bin)
        n, load cycles of each bin.

    Returns
    -------
    array (..., bin)
        inf where a stress is above the static strength, unless the bin is empty.

    Raises
    ------
    InputError
        If load cycles are negative or not finite.

    References
    ----------
    ISO 6336-6:2019, Palmgren-Miner.
    """
    number = np.asarray(cycles, dtype=float)
    require(interval_check("cycles", number, "[0, inf)"))
    life = curve.life(stresses)
    number, life = np.broadcast_arrays(number, life)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(number > 0.0, number / life, 0.0)


@checked
def miner_sum(curve: SNCurve, stresses: ArrayLike, cycles: ArrayLike) -> Array:
    r"""Sum of damages over a spectrum, :math:`U = \sum n_i/N_i`: at 1 the life is used up.

    Parameters
    ----------
    curve, stresses, cycles
        As for ``damages``.

    Returns
    -------
    array (...)

    References
    ----------
    ISO 6336-6:2019, Palmgren-Miner.

    Examples
    --------
    >>> curve = flank_curve("Eh").scaled(1500.0)
    >>> round(float(miner_sum(curve, [1500.0, 2400.0], [2.5e7, 2.5e4])), 9)
    0.75
    """
    return np.asarray(damages(curve, stresses, cycles).sum(axis=-1))


@checked
def repetitions(curve: SNCurve, stresses: ArrayLike, cycles: ArrayLike, *, safety: float = 1.0) -> Array:
    """How often a spectrum is borne until the damage is 1, with a safety on stress.

    Parameters
    ----------
    curve, stresses, cycles
        As for ``damages``; load cycles of the spectrum once.
    safety : float
        Factor on the stresses.

    Returns
    -------
    array (...)
        Times the hours of the spectrum: life in hours. inf if no bin does damage.
    """
    require((0.0 < safety < inf, f"safety: {safety} is not positive and finite"))
    _require_cycles(cycles)
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 / miner_sum(curve, np.asarray(stresses, dtype=float) * safety, cycles))


@checked
def spectrum_safety(curve: SNCurve, stresses: ArrayLike, cycles: ArrayLike) -> float:
    r"""Safety on stress for the life of a spectrum: the factor S with :math:`U(S \sigma_i) = 1`.

    Parameters
    ----------
    curve : SNCurve
    stresses, cycles : array (bin,)
        As for ``damages``; load cycles of the whole life.

    Returns
    -------
    float
        Where the damage jumps over 1, at the static strength or at the end of the curve, the place of the jump; inf
        without stress.

    References
    ----------
    ISO 6336-6:2019, safety factor of a spectrum, iterated.

    Examples
    --------
    >>> curve = flank_curve("Eh").scaled(1500.0)
    >>> round(spectrum_safety(curve, [1000.0], [5e7]), 6)
    1.5
    """
    _require_cycles(cycles)
    level, number = np.broadcast_arrays(np.asarray(stresses, dtype=float), np.asarray(cycles, dtype=float))
    require(interval_check("stresses", level, "[0, inf)", "MPa"))
    loaded = (level > 0.0) & (number > 0.0)
    if not loaded.any():
        return inf
    if curve.stresses.ndim > 1:
        curve = replace(curve, stresses=np.broadcast_to(curve.stresses, (len(curve.cycles), *level.shape))[:, loaded])
    heights, counts = np.log(level[loaded]), np.log(number[loaded])
    limits = curve.logarithms[1]

    def excess(log_safety: float) -> float:
        life = curve.logarithm_of_life(heights + log_safety)
        damage = float(np.exp(np.minimum(counts - life, _BROKEN)).sum())
        return 0.5 - 1.0 / (1.0 + damage)  # from -0.5 without damage to 0.5 when the tooth is broken

    low, high = float((limits[-1] - heights).min()) - 1e-9, float((limits[0] - heights).min()) + 1e-9
    while excess(high) < 0.0:  # above the static strength, where the first line goes on
        high += 1.0
    return exp(roots.find_root(excess, low, high))


@checked
def equivalent_stress(curve: SNCurve, stresses: ArrayLike, cycles: ArrayLike) -> float:
    r"""Constant stress with the damage of a spectrum over the same number of load cycles [MPa].

    .. math:: \sigma_{eq} = \sigma_{SN}(N),\qquad N = \sum n_i / U

    Where most load cycles do no damage and N lies beyond the last knee, that of the knee, which does more.

    Parameters
    ----------
    curve : SNCurve
        With the same levels for all bins.
    stresses, cycles : array (bin,)

    Raises
    ------
    InputError
        If the spectrum does no damage, or breaks the tooth: there is no such stress.

    Examples
    --------
    >>> round(equivalent_stress(flank_curve("Eh").scaled(1500.0), [1600.0, 1600.0], [1e6, 2e6]), 6)
    1600.0
    """
    _require_cycles(cycles)
    if curve.stresses.ndim != 1:
        raise InputError(f"curve: one for all bins is asked for, not stresses of shape {curve.stresses.shape}")
    level, number_of_each = np.broadcast_arrays(np.asarray(stresses, dtype=float), np.asarray(cycles, dtype=float))
    require((level.ndim < 2, f"stresses: shape {level.shape} with that of the cycles; asked for is (bin,)"))
    total, damage = float(number_of_each.sum()), float(np.sum(damages(curve, level, number_of_each)))
    require((0.0 < damage < inf, f"stresses: their damage is {damage}; there is no equivalent stress"))
    number = total / damage
    if number < curve.cycles[0]:
        return float(curve.stresses[0] * (curve.cycles[0] / number) ** (1.0 / curve.exponents[0]))
    return float(curve.strength(number))


@checked
def equivalent_torque(torques: ArrayLike, cycles: ArrayLike, exponent: float) -> float:
    r"""Equivalent torque of a spectrum by one line of the S-N curve.

    .. math:: T_{eq} = \left(\frac{\sum n_i T_i^p}{\sum n_i}\right)^{1/p}

    Parameters
    ----------
    torques : array (bin,) [N m]
    cycles : array (bin,)
    exponent : float
        p over torque: half that of the stress of flanks, which grows with the root of the torque; that of the stress of
        roots. 6.6 for flanks of case-hardened and through-hardened steel, 8.7 and 6.2 for their roots.

    References
    ----------
    ISO 6336-6:2019, annex A.

    Examples
    --------
    >>> round(equivalent_torque([100.0, 200.0], [1e6, 1e6], 6.61), 2)
    180.37
    """
    _require_cycles(cycles)
    level, number = np.broadcast_arrays(np.asarray(torques, dtype=float), np.asarray(cycles, dtype=float))
    require(
        interval_check("torques", level, "[0, inf)", "N m"),
        (0.0 < exponent < inf, f"exponent: {exponent} is not positive and finite"),
    )
    largest = float(level.max())
    if largest == 0.0:
        return 0.0
    return largest * float(np.average((level / largest) ** exponent, weights=number)) ** (1.0 / exponent)


def _require_cycles(cycles: ArrayLike) -> None:
    require(interval_check("cycles", cycles, "[0, inf)"))
    require((float(np.sum(cycles)) > 0.0, "cycles: they sum to nothing"))
