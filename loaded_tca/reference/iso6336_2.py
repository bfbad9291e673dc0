"""Pitting after ISO 6336-2: what flanks withstand, method B, and their safety.

Numbers of formulas are those of the edition of 2019 where open programs print them; its text was not seen. Checked
against ISO/TR 6336-30, example 1, and the reports of KISSsoft 03/2017A on the gearbox of the NREL 5 MW turbine. The
factors of the stress itself, Z_H, Z_E, Z_eps, Z_beta, Z_B and Z_D, are in ``iso6336``, and so is sigma_H0. Arrays
broadcast: speeds and load cycles may be the bins of a spectrum.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, tan

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, interval_check
from loaded_tca.errors import InputError, require, require_positive
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_5 import material_kind
from loaded_tca.reference.iso6336_6 import LONG_LIFE, SNCurve, flank_curve

SOFT, HARD = 850.0, 1200.0
"""sigma_H_lim between which the constants of Z_L, Z_v and Z_R go from those of soft to those of hard flanks [MPa]."""
_SURFACE_HARDENED = ("Eh", "IF", "NT", "NV", "NV nitrocarburized")
_WORK_HARDENING = (130.0, 470.0)  # HBW, of the softer gear
_SMOOTHEST, _ROUGHEST = 3.0, 16.0  # um, R_zH
_LARGEST_RATIO = 20.0


@checked
def relative_radius(base_diameters: tuple[float, float], working_pressure_angle: float) -> float:
    r"""Relative radius of curvature at the pitch point rho_red, in the transverse section [mm].

    .. math:: \varrho_{red} = \frac{\varrho_1 \varrho_2}{\varrho_1 + \varrho_2},\qquad
        \varrho = \tfrac12 d_b \tan\alpha_{wt}

    Parameters
    ----------
    base_diameters : (float, float) [mm]
        d_b; negative of a ring.
    working_pressure_angle : float [rad]
        alpha_wt.

    References
    ----------
    ISO 6336-2:2019, formulas (51), (52).

    Examples
    --------
    >>> from math import radians
    >>> round(relative_radius((710.408, -1835.220), radians(15.630)), 1)
    162.1
    """
    first, second = base_diameters
    require(
        (0.0 < first < inf, f"base_diameters: {first} mm of the pinion is not positive and finite"),
        (abs(second) > 0.0 and 1.0 / first + 1.0 / second > 0.0, f"base_diameters: a ring of {second} mm is too small"),
        (0.0 < working_pressure_angle < 1.57, f"working_pressure_angle: {working_pressure_angle} rad is not acute"),
    )
    return 0.5 * tan(working_pressure_angle) / (1.0 / first + 1.0 / second)


def _between(limit_stress: float, soft: float, hard: float) -> float:
    """A constant of soft flanks, of hard ones, and a line over sigma_H_lim in between."""
    return float(np.interp(limit_stress, (SOFT, HARD), (soft, hard)))


@checked
def lubricant_factor(viscosity_40: float, limit_stress: float) -> float:
    r"""Lubricant factor Z_L of mineral oils.

    .. math:: Z_L = C_{ZL} + \frac{4 (1 - C_{ZL})}{(1.2 + 134/\nu_{40})^2}

    with C_ZL 0.83 for sigma_H_lim up to 850 MPa, 0.91 from 1200 MPa on, and a line in between.

    Parameters
    ----------
    viscosity_40 : float [mm2/s]
        Kinematic, at 40 C.
    limit_stress : float [MPa]
        sigma_H_lim of the softer flank.

    References
    ----------
    ISO 6336-2:2019, formulas (42) to (45).

    Examples
    --------
    Printed 1.04739:

    >>> round(lubricant_factor(320.0, 1500.0), 5)
    1.04739
    """
    require_positive(viscosity_40=viscosity_40, limit_stress=limit_stress)
    constant = _between(limit_stress, 0.83, 0.91)
    return constant + 4.0 * (1.0 - constant) / (1.2 + 134.0 / viscosity_40) ** 2


@checked
def velocity_factor(velocity: ArrayLike, limit_stress: float) -> Array:
    r"""Velocity factor Z_v.

    .. math:: Z_v = C_{Zv} + \frac{2 (1 - C_{Zv})}{\sqrt{0.8 + 32/v}},\qquad C_{Zv} = C_{ZL} + 0.02

    Parameters
    ----------
    velocity : array [m/s]
        v, at the reference circle, above zero.
    limit_stress : float [MPa]
        sigma_H_lim of the softer flank.

    References
    ----------
    ISO 6336-2:2019, formulas (47), (48).

    Examples
    --------
    Printed 0.96911:

    >>> round(float(velocity_factor(2.664, 1500.0)), 5)
    0.96911
    """
    require_positive(limit_stress=limit_stress)
    speed = np.asarray(velocity, dtype=float)
    require(interval_check("velocity", speed, "(0, inf)", "m/s"))
    constant = _between(limit_stress, 0.85, 0.93)
    return np.asarray(constant + 2.0 * (1.0 - constant) / np.sqrt(0.8 + 32.0 / speed))


@checked
def roughness_factor(roughness: tuple[float, float], relative_radius: float, limit_stress: float) -> float:
    r"""Roughness factor Z_R.

    .. math:: Z_R = \left(\frac{3}{R_{z10}}\right)^{C_{ZR}},\qquad
        R_{z10} = \frac{R_{z1} + R_{z2}}{2} \sqrt[3]{\frac{10}{\varrho_{red}}}

    with C_ZR 0.15 for sigma_H_lim up to 850 MPa, 0.08 from 1200 MPa on, and a line in between.

    Parameters
    ----------
    roughness : (float, float) [um]
        R_z of the flanks after running in, about 6 R_a.
    relative_radius : float [mm]
        rho_red.
    limit_stress : float [MPa]
        sigma_H_lim of the softer flank.

    References
    ----------
    ISO 6336-2:2019, formulas (49), (50), (53) to (56).

    Examples
    --------
    Printed 1.026, planet and ring:

    >>> round(roughness_factor((4.8, 8.0), 162.15, 700.0), 3)
    1.026
    """
    first, second = roughness
    require_positive(
        pinion_roughness=first, wheel_roughness=second, relative_radius=relative_radius, limit_stress=limit_stress
    )
    of_test_gear = 0.5 * (first + second) * (10.0 / relative_radius) ** (1.0 / 3.0)
    return float((3.0 / of_test_gear) ** _between(limit_stress, 0.15, 0.08))


@checked
def work_hardening_factor(
    hardness: float, roughness: tuple[float, float], relative_radius: float, velocity: ArrayLike, viscosity_40: float
) -> Array:
    r"""Work hardening factor Z_W of a through-hardened gear with a surface-hardened mate.

    .. math::
        Z_W = \left(1.2 - \frac{HB - 130}{1700}\right) \left(\frac{3}{R_{zH}}\right)^{0.15},\qquad
        R_{zH} = R_{z1}\,\frac{(10/\varrho_{red})^{0.33}\,(R_{z1}/R_{z2})^{0.66}}{(v\,\nu_{40}/1500)^{0.33}}

    with R_zH held between 3 and 16 um, HB between 130 and 470, and Z_W no smaller than 1.

    Parameters
    ----------
    hardness : float
        HBW of the softer gear.
    roughness : (float, float) [um]
        R_z of the flank of the harder gear before running in, and of the softer.
    relative_radius : float [mm]
    velocity : array [m/s]
    viscosity_40 : float [mm2/s]

    References
    ----------
    ISO 6336-2:2019, clause 13; formulas as IACS UR M56 (revision 4), M56.2.11, prints them.

    Examples
    --------
    Printed 1.135:

    >>> round(float(work_hardening_factor(240.0, (4.8, 8.0), 162.15, 4.88, 220.0)), 3)
    1.135
    """
    hard, soft = roughness
    require_positive(
        hardness=hardness, hard_roughness=hard, soft_roughness=soft, relative_radius=relative_radius,
        viscosity_40=viscosity_40,
    )  # fmt: skip
    speed = np.asarray(velocity, dtype=float)
    require(interval_check("velocity", speed, "(0, inf)", "m/s"))
    equal = hard * (10.0 / relative_radius) ** 0.33 * (hard / soft) ** 0.66 / (speed * viscosity_40 / 1500.0) ** 0.33
    smooth = (3.0 / np.clip(equal, _SMOOTHEST, _ROUGHEST)) ** 0.15
    return np.maximum(1.0, (1.2 - (float(np.clip(hardness, *_WORK_HARDENING)) - 130.0) / 1700.0) * smooth)


@checked
def through_hardened_work_factor(hardness_ratio: float, gear_ratio: float) -> float:
    r"""Work hardening factor Z_W of a through-hardened wheel with a harder through-hardened pinion.

    .. math:: Z_W = 1 + \left(0.00898\,\frac{HB_1}{HB_2} - 0.00829\right) (u - 1)

    for ratios of hardness of 1.2 to 1.7; 1 below, :math:`1 + 0.00698 (u - 1)` above. u counts up to 20.

    Parameters
    ----------
    hardness_ratio, gear_ratio : float
        HB_1/HB_2, u.

    References
    ----------
    ISO 6336-2:2019, clause 13; formulas as IACS UR M56 (revision 4), M56.2.11, prints them.

    Examples
    --------
    >>> round(through_hardened_work_factor(1.5, 5.0), 5)
    1.02072
    """
    require_positive(hardness_ratio=hardness_ratio, gear_ratio=gear_ratio)
    if hardness_ratio < 1.2:
        return 1.0
    slope = 0.00898 * hardness_ratio - 0.00829 if hardness_ratio <= 1.7 else 0.00698
    return max(1.0, 1.0 + slope * (min(gear_ratio, _LARGEST_RATIO) - 1.0))


@checked
def static_work_factor(hardness: float) -> float:
    r"""Work hardening factor Z_W of a through-hardened gear with a surface-hardened mate, of its static strength.

    .. math:: Z_W = 1.05 - \frac{HB - 130}{6800}

    with HB held between 130 and 470.

    Parameters
    ----------
    hardness : float
        HBW.

    References
    ----------
    ISO 6336-2:2006, clause 13.

    Examples
    --------
    >>> static_work_factor(130.0), static_work_factor(470.0)
    (1.05, 1.0)
    """
    require_positive(hardness=hardness)
    return 1.05 - (float(np.clip(hardness, *_WORK_HARDENING)) - 130.0) / 6800.0


@checked
def contact_stress(
    nominal_stress: ArrayLike, single_contact_factor: ArrayLike = 1.0, load_factors: ArrayLike = 1.0
) -> Array:
    r"""Contact stress sigma_H [MPa].

    .. math:: \sigma_H = Z_{B,D}\,\sigma_{H0} \sqrt{K_A K_\gamma K_v K_{H\beta} K_{H\alpha}}

    Parameters
    ----------
    nominal_stress : array [MPa]
        sigma_H0.
    single_contact_factor : array
        Z_B of the pinion, Z_D of the wheel.
    load_factors : array
        Product of the K factors.

    References
    ----------
    ISO 6336-2:2019, clause 6.

    Examples
    --------
    Printed 739.61:

    >>> round(float(contact_stress(570.79, 1.0, 1.25 * 1.092 * 1.15 * 1.069)), 1)
    739.4
    """
    stress, factor, load = (
        np.asarray(each, dtype=float) for each in (nominal_stress, single_contact_factor, load_factors)
    )
    require(
        interval_check("nominal_stress", stress, "[0, inf)", "MPa"),
        interval_check("single_contact_factor", factor, "[1, inf)"),
        interval_check("load_factors", load, "[0, inf)"),
    )
    return np.asarray(factor * stress * np.sqrt(load))


@checked
@dataclass(frozen=True)
class FlankStrength:
    """What the flanks of one gear are made of.

    Parameters
    ----------
    limit_stress : float [MPa]
        sigma_H_lim.
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    roughness : float [um]
        R_z of the flanks after running in.
    hardness : float, optional
        HBW; counts for Z_W of a through-hardened gear.

    Raises
    ------
    InputError
        If a value is out of range or the kind unknown.
    """

    limit_stress: float
    kind: str
    roughness: float
    hardness: float | None = None

    def __post_init__(self) -> None:
        material_kind(self.kind)
        require_positive(limit_stress=self.limit_stress, roughness=self.roughness)
        if self.hardness is not None:
            require_positive(hardness=self.hardness)

    @property
    def surface_hardened(self) -> bool:
        """Whether the flank is case-, flame-, induction-hardened or nitrided."""
        return material_kind(self.kind).family in _SURFACE_HARDENED

    @property
    def hardens_at_work(self) -> bool:
        """Whether the gear is of through-hardened or structural steel, whose flanks a harder mate hardens."""
        return material_kind(self.kind).family in ("V", "St")


@checked
@dataclass(frozen=True, eq=False)
class FlankFactors:
    """What the flanks of a pair withstand, gear by gear: arrays (gear, ...) where both differ.

    Attributes
    ----------
    Z_L, Z_R, Z_X : float
    Z_v : array (...)
    Z_W, Z_NT : array (gear, ...)
    Z_W_static : array (gear,)
        Work hardening factor of the static strength.
    limit_stresses : array (gear,) [MPa]
        sigma_H_lim.
    curves : (SNCurve, SNCurve)
        Strength of pinion and wheel over load cycles [MPa]: the reference strength has all factors, the static one
        Z_NT and Z_W alone, with a line in logarithms in between.
    reference_strength : array (gear, ...) [MPa]
        From the knee of the curve on where Z_NT is 1, without any larger or smaller Z_NT.
    strength : array (gear, ...) [MPa]
        sigma_HG, at the load cycles.
    notes : (str, ...)
        What lies outside the range of the standard.
    """

    Z_L: float
    Z_v: Array
    Z_R: float
    Z_W: Array
    Z_X: float
    Z_NT: Array
    Z_W_static: Array
    limit_stresses: Array
    curves: tuple[SNCurve, SNCurve]
    reference_strength: Array
    strength: Array
    notes: tuple[str, ...]

    @property
    def static_strength(self) -> Array:
        """Strength at few load cycles (gear, ...) [MPa]."""
        return np.stack(np.broadcast_arrays(*(curve.stresses[0] for curve in self.curves)))

    def permissible_stress(self, required_safety: float) -> Array:
        """sigma_HP (gear, ...) [MPa] with a required safety S_Hmin."""
        require_positive(required_safety=required_safety)
        return self.strength / required_safety

    def safety(self, contact_stress: ArrayLike) -> Array:
        """S_H (gear, ...) of contact stresses sigma_H (gear, ...) [MPa], or of one for both; inf without stress."""
        stress = np.asarray(contact_stress, dtype=float)
        require(
            interval_check("contact_stress", stress, "[0, inf)", "MPa"),
            (
                stress.shape[:1] in ((), (1,), (2,)),
                f"contact_stress: shape {stress.shape}; asked for is (2, ...), one of each gear",
            ),
        )
        most = max(stress.ndim, self.strength.ndim)
        strength, stress = (  # bins of one beside a single number of the other
            each.reshape(*each.shape[:1], *[1] * (most - each.ndim), *each.shape[1:])
            for each in (self.strength, stress)
        )
        with np.errstate(divide="ignore"):
            return np.asarray(strength / stress)


@checked
def flank_factors(
    pinion: FlankStrength,
    wheel: FlankStrength,
    *,
    relative_radius: float,
    velocity: ArrayLike,
    viscosity_40: float,
    cycles: ArrayLike,
    gear_ratio: float,
    limited_pitting: bool = False,
    long_life_factor: float = LONG_LIFE,
    size_factor: float = 1.0,
) -> FlankFactors:
    r"""Factors of the strength of flanks, and the strength itself.

    .. math:: \sigma_{HG} = \sigma_{H\,lim} Z_{NT} Z_L Z_v Z_R Z_W Z_X

    from the knee of the reference strength on; below it the line in logarithms to the static strength
    :math:`\sigma_{H\,lim} Z_{NT} Z_W`.

    Parameters
    ----------
    pinion, wheel : FlankStrength
    relative_radius : float [mm]
        rho_red.
    velocity : array (...) [m/s]
        At the reference circle, of each bin.
    viscosity_40 : float [mm2/s]
        Kinematic, at 40 C.
    cycles : array (gear, ...)
        Load cycles of pinion and wheel.
    gear_ratio : float
        z_2/z_1 without sign; below 1 the wheel is the smaller gear.
    limited_pitting : bool
        Whether some pits are allowed.
    long_life_factor : float
        Z_NT at 1e10 load cycles, 0.85 to 1.
    size_factor : float
        Z_X: 1 if the case is as deep as the size of the teeth asks for.

    Returns
    -------
    FlankFactors

    Raises
    ------
    InputError
        If a value is out of range, or the hardness that Z_W depends on is missing.

    References
    ----------
    ISO 6336-2:2019, clauses 10 to 14.

    Examples
    --------
    Example 1 of ISO/TR 6336-30, with R_z 6 um; printed 1338.48 and 1414.53 MPa:

    >>> hard = FlankStrength(1500.0, "Eh", 6.0)
    >>> factors = flank_factors(hard, hard, relative_radius=21.857, velocity=2.664, viscosity_40=320.0,
    ...                         cycles=[1.08e9, 1.7825e8], gear_ratio=103 / 17)
    >>> [round(float(stress), 1) for stress in factors.strength]
    [1338.5, 1414.5]
    """
    number = np.asarray(cycles, dtype=float)
    require(
        (
            number.ndim > 0 and len(number) == 2,
            f"cycles: shape {number.shape}; asked for is (2, ...), one of each gear",
        ),
        (0.0 < size_factor <= 1.0, f"size_factor: {size_factor}; allowed above 0, up to 1"),
        (0.0 < gear_ratio < inf, f"gear_ratio: {gear_ratio} is not positive and finite"),
    )
    gears = pinion, wheel
    softer = min(gear.limit_stress for gear in gears)
    lubricant, roughness = (
        lubricant_factor(viscosity_40, softer),
        roughness_factor((pinion.roughness, wheel.roughness), relative_radius, softer),
    )
    speed = velocity_factor(velocity, softer)
    work, static_work, notes = _work_factors(gears, relative_radius, velocity, viscosity_40, gear_ratio)
    curves, lives, references, strengths = [], [], [], []
    for place, gear in enumerate(gears):
        factors = flank_curve(gear.kind, limited_pitting=limited_pitting, long_life_factor=long_life_factor)
        reference = gear.limit_stress * lubricant * speed * roughness * work[place] * size_factor
        static = gear.limit_stress * float(factors.stresses[0]) * static_work[place]
        if bool(np.any(static < reference)):
            notes = (
                *notes,
                f"Z_NT: the static strength of kind {gear.kind!r}, {plain(static)} MPa, counts as the reference",
            )
        curves.append(factors.scaled(reference, static))
        references.append(reference)
        lives.append(factors.strength(number[place]))
        strengths.append(curves[-1].strength(number[place]))
    return FlankFactors(
        lubricant, speed, roughness, np.stack(np.broadcast_arrays(*work)), size_factor,
        np.stack(lives), np.array(static_work), np.array([gear.limit_stress for gear in gears]),
        (curves[0], curves[1]), np.stack(np.broadcast_arrays(*references)),
        np.stack(np.broadcast_arrays(*strengths)), notes,
    )  # fmt: skip


def _work_factors(
    gears: tuple[FlankStrength, FlankStrength],
    relative_radius: float,
    velocity: ArrayLike,
    viscosity_40: float,
    gear_ratio: float,
) -> tuple[list[Array], list[float], tuple[str, ...]]:
    """Z_W of both gears, of the reference and the static strength, and notes."""
    work, static, notes = [np.ones(()), np.ones(())], [1.0, 1.0], []
    for place, (gear, mate) in enumerate(zip(gears, gears[::-1], strict=True)):
        if not (gear.hardens_at_work and mate.surface_hardened):
            continue
        if gear.hardness is None:
            raise InputError(f"hardness: not given; Z_W of a gear of kind {gear.kind!r} beside {mate.kind!r} needs it")
        work[place] = work_hardening_factor(
            gear.hardness, (mate.roughness, gear.roughness), relative_radius, velocity, viscosity_40
        )
        static[place] = static_work_factor(gear.hardness)
        low, high = _WORK_HARDENING
        if not low <= gear.hardness <= high:
            notes.append(
                f"Z_W: {plain(gear.hardness, 6)} HBW is not within {plain(low, 6)} to {plain(high, 6)} HBW, "
                "and the nearer limit is used"
            )
    larger = int(gear_ratio >= 1.0)
    soft, hard = gears[larger], gears[1 - larger]
    if soft.hardens_at_work and hard.hardens_at_work and soft.hardness and hard.hardness:
        ratio, step = hard.hardness / soft.hardness, max(gear_ratio, 1.0 / gear_ratio)
        work[larger] = np.asarray(through_hardened_work_factor(ratio, step))
        if step > _LARGEST_RATIO and ratio >= 1.2:
            notes.append(
                f"Z_W: {plain(_LARGEST_RATIO, 6)} is used for the gear ratio {plain(step, 6)}, which is larger"
            )
    return work, static, tuple(notes)
