"""ISO 6336-3, method B, for cylindrical gears: what tooth roots withstand, its factors, and safeties.

Factors of the strength are alike in the editions of 2006 and 2019; numbers of formulas are those of 2019 where open
programs print them, its text was not seen. Checked against the reports of KISSsoft 03/2017A on the gearbox of the NREL
5 MW turbine. Arrays broadcast: load cycles and stress ratios may be the bins of a spectrum, or places of a fillet.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log10, sqrt

import numpy as np
from numpy.typing import ArrayLike

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, interval_check
from loaded_tca.errors import InputError, require, require_positive
from loaded_tca.plain import plain
from loaded_tca.reference.iso6336_5 import TEST_GEAR_CORRECTION, material_kind
from loaded_tca.reference.iso6336_6 import LONG_LIFE, SNCurve, root_curve

_SLIP_LAYERS = {
    **dict.fromkeys(("Eh", "IF"), 0.0030),
    **dict.fromkeys(("NT", "NV", "NV nitrocarburized"), 0.1005),
}
_SLIP_LAYERS_BY_STRENGTH = {
    "St": ((300.0, 400.0), (0.0833, 0.0445)),
    **dict.fromkeys(("V", "GTS", "GGG"), ((500.0, 600.0, 800.0, 1000.0), (0.0281, 0.0194, 0.0064, 0.0014))),
    **dict.fromkeys(("GG", "GGG ferritic"), ((150.0, 300.0), (0.3124, 0.3095))),
}
_SMOOTHEST, _ROUGHEST = 1.0, 40.0  # um
_SURFACES = {
    **dict.fromkeys(("V", "GTS", "GGG", "Eh", "IF"), (1.674, 0.529, 0.1, 1.12)),
    "St": (5.306, 4.203, 0.01, 1.07),
    **dict.fromkeys(("GG", "GGG ferritic", "NT", "NV", "NV nitrocarburized"), (4.299, 3.259, 0.0058, 1.025)),
}
_OF_BEVELS = {0.0058: 1.0 / 200.0}  # exponents of ISO 10300-3 in the place of these
_SIZES = {
    **dict.fromkeys(("St", "V", "GTS", "GGG"), (1.03, 0.006, 30.0)),
    **dict.fromkeys(("Eh", "IF", "NT", "NV", "NV nitrocarburized"), (1.05, 0.010, 25.0)),
    **dict.fromkeys(("GG", "GGG ferritic"), (1.075, 0.015, 25.0)),
}
_SMALL_MODULE = 5.0
_SENSITIVITIES = {
    **dict.fromkeys(("St", "V carbon", "V alloy"), (0.3, 0.5)),
    **dict.fromkeys(("St cast", "V carbon cast", "V alloy cast", "IF"), (0.4, 0.6)),
    **dict.fromkeys(("NT", "NV", "NV nitrocarburized"), (0.3, 0.3)),
}
_SHOT_PEENED, _CASE_STATIC = (0.4, 0.6), 0.7


@checked
def slip_layer(kind: str, strength: float | None = None) -> float:
    """Thickness of the slip layer rho' [mm].

    Parameters
    ----------
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    strength : float [MPa], optional
        Yield point or proof stress of St, V, GTS and GGG, tensile strength of GG and ferritic GGG: needed there, and
        held within the table. Hardened surfaces have one value.

    Raises
    ------
    InputError
        If the strength is missing.

    References
    ----------
    ISO 6336-3:2019, table 4.

    Examples
    --------
    >>> slip_layer("Eh"), round(slip_layer("V alloy", 700.0), 4)
    (0.003, 0.0129)
    """
    family = material_kind(kind).family
    if family in _SLIP_LAYERS:
        return _SLIP_LAYERS[family]
    if strength is None:
        raise InputError(f"strength: not given; the slip layer of kind {kind!r} depends on it")
    require_positive(strength=strength)
    return float(np.interp(strength, *_SLIP_LAYERS_BY_STRENGTH[family]))


@checked
def notch_sensitivity_factor(notch_parameter: float, slip_layer: float) -> float:
    r"""Relative notch sensitivity factor Y_delta_relT of the endurance strength.

    .. math:: Y_{\delta relT} = \frac{1 + \sqrt{\varrho' \chi^*}}{1 + \sqrt{\varrho' \chi^*_T}},\qquad
        \chi^* = \frac{1 + 2 q_s}{5},\quad \chi^*_T = 1.2

    Parameters
    ----------
    notch_parameter : float
        q_s = s_Fn/(2 rho_F).
    slip_layer : float [mm]
        rho'.

    References
    ----------
    ISO 6336-3:2019, formulas (75) to (77).

    Examples
    --------
    Printed 1.005, a case-hardened wheel:

    >>> round(notch_sensitivity_factor(3.036, 0.0030), 3)
    1.005
    """
    require_positive(notch_parameter=notch_parameter, slip_layer=slip_layer)
    return (1.0 + sqrt(slip_layer * 0.2 * (1.0 + 2.0 * notch_parameter))) / (1.0 + sqrt(1.2 * slip_layer))


@checked
def static_notch_factor(kind: str, stress_correction_factor: float, strength: float | None = None) -> float:
    r"""Relative notch sensitivity factor Y_delta_relT of the static strength.

    .. math::
        Y_{\delta relT} = \frac{1 + a (Y_S - 1) \sqrt[4]{\sigma_a/\sigma_S}}{1 + a \sqrt[4]{\sigma_a/\sigma_S}}

    with a = 0.93 and 200 MPa for St, 0.82 and 300 MPa for V and GGG; :math:`0.44 Y_S + 0.12` for Eh and IF,
    :math:`0.20 Y_S + 0.60` for nitrided teeth, :math:`0.075 Y_S + 0.85` for GTS, 1 for GG and ferritic GGG.

    Parameters
    ----------
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    stress_correction_factor : float
        Y_S.
    strength : float [MPa], optional
        Yield point or proof stress; needed for St, V and GGG.

    References
    ----------
    ISO 6336-3:2006, relative notch sensitivity factor for static stress.

    Examples
    --------
    >>> round(static_notch_factor("Eh", 2.28), 4), round(static_notch_factor("V alloy", 2.0, 800.0), 4)
    (1.1232, 1.0)
    """
    require_positive(stress_correction_factor=stress_correction_factor)
    family, notch = material_kind(kind).family, stress_correction_factor
    straight = {"GTS": (0.075, 0.85), "GG": (0.0, 1.0), "GGG ferritic": (0.0, 1.0)}
    straight |= dict.fromkeys(("Eh", "IF"), (0.44, 0.12)) | dict.fromkeys(
        ("NT", "NV", "NV nitrocarburized"), (0.20, 0.60)
    )
    if family in straight:
        slope, offset = straight[family]
        return slope * notch + offset
    if strength is None:
        raise InputError(f"strength: not given; the static notch factor of kind {kind!r} depends on it")
    require_positive(strength=strength)
    factor, stress = (0.93, 200.0) if family == "St" else (0.82, 300.0)
    root = factor * (stress / strength) ** 0.25
    return (1.0 + (notch - 1.0) * root) / (1.0 + root)


@checked
def surface_factor(kind: str, roughness: float, *, of_bevels: bool = False) -> float:
    r"""Relative surface factor Y_R_relT of the endurance strength.

    .. math:: Y_{R\,relT} = 1.674 - 0.529 (R_z + 1)^{0.1},\qquad 5.306 - 4.203 (R_z + 1)^{0.01},\qquad
        4.299 - 3.259 (R_z + 1)^{0.0058}

    for V, GTS, GGG, Eh and IF; for St; for GG, ferritic GGG and nitrided teeth, with 1.12, 1.07 and 1.025 below 1 um.
    Of bevel gears the last exponent is 1/200. With 0.0058 the factor is 0.994 at the 10 um of test gears, where it is 1
    by its meaning, with 1/200 1.001.

    Parameters
    ----------
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    roughness : float [um]
        R_z of the fillet, up to 40 um; rougher ones count as 40 um. No grooves deeper than 2 R_z.
    of_bevels : bool
        Whether that of ISO 10300-3 is meant.

    References
    ----------
    ISO 6336-3:2019, formulas (87) to (90); the exponent 0.0058 as IACS UR M56 (revision 4) and the rules of the Korean
    Register print it. ISO 10300-3:2023, formulas (40) to (42).

    Examples
    --------
    Printed 0.957:

    >>> round(surface_factor("Eh", 20.0), 3)
    0.957
    >>> [round(surface_factor("NT", 16.0, of_bevels=bevels), 3) for bevels in (False, True)]
    [0.986, 0.994]
    """
    require_positive(roughness=roughness)
    first, second, exponent, smooth = _SURFACES[material_kind(kind).family]
    if of_bevels:
        exponent = _OF_BEVELS.get(exponent, exponent)
    return smooth if roughness < _SMOOTHEST else first - second * (min(roughness, _ROUGHEST) + 1.0) ** exponent


@checked
def size_factor(kind: str, normal_module: float) -> float:
    r"""Size factor Y_X of the endurance strength.

    .. math:: Y_X = 1.03 - 0.006\,m_n,\qquad 1.05 - 0.010\,m_n,\qquad 1.075 - 0.015\,m_n

    for St, V, GTS and GGG up to 30 mm; for hardened teeth and for GG and ferritic GGG up to 25 mm; 1 up to 5 mm.

    Parameters
    ----------
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    normal_module : float [mm]

    References
    ----------
    ISO 6336-3:2019, table 5.

    Examples
    --------
    Printed 0.910 and 0.904:

    >>> round(size_factor("Eh", 14.0), 3), round(size_factor("V alloy", 21.0), 3)
    (0.91, 0.904)
    """
    require_positive(normal_module=normal_module)
    first, second, largest = _SIZES[material_kind(kind).family]
    return 1.0 if normal_module <= _SMALL_MODULE else first - second * min(normal_module, largest)


@checked
def mean_stress_sensitivities(
    kind: str, stress_correction_factor: float = 2.0, *, shot_peened: bool = False
) -> tuple[float, float]:
    """Mean stress sensitivity M of the endurance and of the static strength: amplitude lost for each unit of mean.

    Parameters
    ----------
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    stress_correction_factor : float
        Y_S; of bevel gears 2.
    shot_peened : bool
        Of case-hardened teeth.

    Raises
    ------
    InputError
        For cast irons, of which the standard has none.

    References
    ----------
    ISO 6336-3:2006, annex B, table B.1.

    Examples
    --------
    >>> mean_stress_sensitivities("Eh")
    (0.5, 0.7)
    """
    family = material_kind(kind).family
    require_positive(stress_correction_factor=stress_correction_factor)
    require((not shot_peened or family == "Eh", f"shot_peened: of case-hardened teeth alone, not of kind {kind!r}"))
    if family == "Eh":
        return _SHOT_PEENED if shot_peened else (0.8 - 0.15 * stress_correction_factor, _CASE_STATIC)
    if kind not in _SENSITIVITIES:
        raise InputError(f"kind: the standard has no mean stress sensitivity of {kind!r}; give the factor Y_M itself")
    return _SENSITIVITIES[kind]


@checked
def mean_stress_factor(stress_ratio: ArrayLike, sensitivity: float) -> Array:
    r"""Mean stress influence factor Y_M.

    .. math:: Y_M = \frac{1}{1 - R\,\frac{1 - M}{1 + M}}

    the largest stress that is borne under a stress ratio R, over that of pulsating stress (R = 0).

    Parameters
    ----------
    stress_ratio : array
        R, smallest over largest stress of a load cycle, from -1.2 to 0. Idlers and planets: -1.2 times the load of the
        lower over that of the higher flank, for each mm of face width. Ratios above 0 count as 0.
    sensitivity : float
        M, from 0 to 1.

    References
    ----------
    ISO 6336-3:2006, annex B.

    Examples
    --------
    >>> round(float(mean_stress_factor(-1.0, 0.5)), 3)
    0.75
    """
    ratio = np.asarray(stress_ratio, dtype=float)
    require(
        interval_check("stress_ratio", ratio, "[-1.2, 1)"),
        (0.0 <= sensitivity <= 1.0, f"sensitivity: {sensitivity}; allowed 0 to 1"),
    )
    return np.asarray(1.0 / (1.0 - np.minimum(ratio, 0.0) * (1.0 - sensitivity) / (1.0 + sensitivity)))


@checked
def reversal_factor(reversals: float) -> float:
    r"""Mean stress influence factor Y_M of gears whose direction of load changes now and then.

    .. math:: Y_M = 0.85 - 0.15\,\frac{\log_{10} N_{rev}}{6}

    from 0.85 at one reversal to 0.7, that of idlers, from a million on.

    Parameters
    ----------
    reversals : float
        N_rev, in the life of the gear; 0: none, and the factor is 1.

    References
    ----------
    ISO 6336-3:2006, annex B.

    Examples
    --------
    >>> reversal_factor(0.0), round(reversal_factor(1e3), 3), round(reversal_factor(1e9), 3)
    (1.0, 0.775, 0.7)
    """
    require((0.0 <= reversals < inf, f"reversals: {reversals} is negative or not finite"))
    return 1.0 if reversals == 0.0 else 0.85 - 0.025 * log10(min(max(reversals, 1.0), 1e6))


@checked
@dataclass(frozen=True)
class RootStrength:
    """What the roots of one gear are made of.

    Parameters
    ----------
    limit_stress : float [MPa]
        sigma_F_lim, nominal.
    kind : str
        Of the material, one of ``iso6336_5.KINDS``.
    roughness : float [um]
        R_z of the fillets.
    strength : float [MPa], optional
        As for ``slip_layer``.
    shot_peened : bool
        Of case-hardened teeth; counts for Y_M.

    Raises
    ------
    InputError
        If a value is out of range, the kind unknown or the strength missing.
    """

    limit_stress: float
    kind: str
    roughness: float
    strength: float | None = None
    shot_peened: bool = False

    def __post_init__(self) -> None:
        material_kind(self.kind)
        require_positive(limit_stress=self.limit_stress, roughness=self.roughness)
        slip_layer(self.kind, self.strength)


@checked
@dataclass(frozen=True, eq=False)
class RootFactors:
    """What the roots of one gear withstand.

    Attributes
    ----------
    Y_ST, Y_delta_relT, Y_R_relT, Y_X : float
    Y_delta_relT_static : float
        Relative notch sensitivity factor of the static strength.
    Y_NT, Y_M, Y_M_static : array (...)
    curve : SNCurve
        Strength over load cycles [MPa]: the reference strength has all factors, the static one Y_NT, Y_delta_relT and
        Y_M alone, with a line in logarithms in between.
    reference_strength : array (...) [MPa]
        From the knee of the curve on where Y_NT is 1, without any larger or smaller Y_NT.
    strength : array (...) [MPa]
        sigma_FG, at the load cycles.
    notes : (str, ...)
        What lies outside the range of the standard.
    """

    Y_ST: float
    Y_delta_relT: float
    Y_delta_relT_static: float
    Y_R_relT: float
    Y_X: float
    Y_NT: Array
    Y_M: Array
    Y_M_static: Array
    curve: SNCurve
    reference_strength: Array
    strength: Array
    notes: tuple[str, ...]

    @property
    def static_strength(self) -> Array:
        """Strength at few load cycles (...) [MPa]."""
        return np.asarray(self.curve.stresses[0])

    def permissible_stress(self, required_safety: float) -> Array:
        """sigma_FP (...) [MPa] with a required safety S_Fmin."""
        require_positive(required_safety=required_safety)
        return self.strength / required_safety

    def safety(self, root_stress: ArrayLike) -> Array:
        """S_F (...) of root stresses sigma_F (...) [MPa]; inf without stress."""
        stress = np.asarray(root_stress, dtype=float)
        require(interval_check("root_stress", stress, "[0, inf)", "MPa"))
        with np.errstate(divide="ignore"):
            return np.asarray(self.strength / stress)


@checked
def root_factors(
    gear: RootStrength,
    *,
    notch_parameter: float,
    stress_correction_factor: float,
    normal_module: float,
    cycles: ArrayLike,
    stress_ratio: ArrayLike = 0.0,
    mean_stress_factor: ArrayLike | None = None,
    long_life_factor: float = LONG_LIFE,
    of_bevels: bool = False,
) -> RootFactors:
    r"""Factors of the strength of roots, and the strength itself.

    .. math:: \sigma_{FG} = \sigma_{F\,lim} Y_{ST} Y_{NT} Y_{\delta relT} Y_{R\,relT} Y_X Y_M

    from the knee of the reference strength on; below it the line in logarithms to the static strength
    :math:`\sigma_{F\,lim} Y_{ST} Y_{NT} Y_{\delta relT} Y_M` with the static factors.

    Parameters
    ----------
    gear : RootStrength
    notch_parameter, stress_correction_factor : float
        q_s, Y_S.
    normal_module : float [mm]
    cycles : array (...)
        Load cycles.
    stress_ratio : array (...)
        R, for Y_M; 0: pulsating.
    mean_stress_factor : array (...), optional
        Y_M itself, in the place of that of the stress ratio: 0.7 for idlers and planets.
    long_life_factor : float
        Y_NT at 1e10 load cycles, 0.85 to 1.
    of_bevels : bool
        Whether Y_R_relT is that of ISO 10300-3.

    Returns
    -------
    RootFactors

    Raises
    ------
    InputError
        If a value is out of range.

    References
    ----------
    ISO 6336-3:2019, clauses 10 to 15; annex B of the edition of 2006.

    Examples
    --------
    Planet of the second stage of the NREL gearbox; printed 429.38 MPa, with 0.886, 1.002, 0.957, 0.840 and 0.700:

    >>> factors = root_factors(RootStrength(430.0, "Eh", 20.0), notch_parameter=2.743, stress_correction_factor=2.18,
    ...                        normal_module=21.0, cycles=1.2971e9, mean_stress_factor=0.7)
    >>> round(float(factors.strength), 1)
    429.4
    """
    kind = gear.kind
    require_positive(normal_module=normal_module)
    life = root_curve(kind, long_life_factor=long_life_factor)
    notch = notch_sensitivity_factor(notch_parameter, slip_layer(kind, gear.strength))
    static_notch = static_notch_factor(kind, stress_correction_factor, gear.strength)
    surface, size = surface_factor(kind, gear.roughness, of_bevels=of_bevels), size_factor(kind, normal_module)
    mean, static_mean = _mean_stress_factors(gear, stress_correction_factor, stress_ratio, mean_stress_factor)
    basic = gear.limit_stress * TEST_GEAR_CORRECTION
    reference = basic * notch * surface * size * mean
    static = basic * float(life.stresses[0]) * static_notch * static_mean
    curve = life.scaled(reference, static)
    notes = _root_notes(gear, notch_parameter, normal_module, bool(np.any(static < reference)))
    return RootFactors(
        TEST_GEAR_CORRECTION, notch, static_notch, surface, size, life.strength(cycles), mean, static_mean, curve,
        np.asarray(reference), curve.strength(cycles), notes,
    )  # fmt: skip


def _mean_stress_factors(
    gear: RootStrength, notch: float, stress_ratio: ArrayLike, factor: ArrayLike | None
) -> tuple[Array, Array]:
    """Y_M of the endurance and of the static strength."""
    if factor is not None:
        value = np.asarray(factor, dtype=float)
        require(interval_check("mean_stress_factor", value, "(0, 1]"))
        return value, value
    ratio = np.asarray(stress_ratio, dtype=float)
    if bool((ratio >= 0.0).all()):
        return mean_stress_factor(ratio, 0.0), mean_stress_factor(ratio, 0.0)
    endurance, static = mean_stress_sensitivities(gear.kind, notch, shot_peened=gear.shot_peened)
    return mean_stress_factor(ratio, max(0.0, endurance)), mean_stress_factor(ratio, static)


def _root_notes(gear: RootStrength, notch: float, module: float, flat: bool) -> tuple[str, ...]:
    """What lies outside the ranges of the factors."""
    family = material_kind(gear.kind).family
    strengths, _ = _SLIP_LAYERS_BY_STRENGTH.get(family, ((0.0, inf), ()))
    low, high, strength = strengths[0], strengths[-1], gear.strength or 0.0
    cases = (
        (not 1.0 <= notch < 8.0, f"Y_S: q_s = {plain(notch, 3)} is not within 1 to 8"),
        (
            not low <= strength <= high,
            f"Y_delta_relT: {plain(strength, 6)} MPa is not within {plain(low, 6)} to {plain(high, 6)} MPa",
        ),
        (gear.roughness > _ROUGHEST, f"Y_R_relT: {plain(gear.roughness, 6)} um counts as {plain(_ROUGHEST, 6)} um"),
        (
            module > _SIZES[family][2],
            f"Y_X: a module of {plain(module, 6)} mm counts as {plain(_SIZES[family][2], 6)} mm",
        ),
        (flat, f"Y_NT: the static strength of kind {gear.kind!r} is below that of the reference and counts as equal"),
    )
    return tuple(words for holds, words in cases if holds)
