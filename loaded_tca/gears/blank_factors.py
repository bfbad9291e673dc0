r"""Factors of the basic crown gear of bevel gears: from those of data type II, from usual ones, from measured teeth.

References
----------
ISO 23509:2016, table 4, annex C.
"""

from __future__ import annotations

from math import cos, inf, pi, sqrt, tan

from loaded_tca.errors import InputError
from loaded_tca.gears.bevel import pitch_angles
from loaded_tca.plain import plain

ROUNDED = 0.02
"""By how many mean normal modules the clearances of measured depths may differ: one holds for both gears."""


def crown_gear_factors(
    addendum_share: float, depth: float = 2.0, clearance: float = 0.125, thickness: float = 0.0
) -> dict[str, float]:
    """Parameters of :class:`BevelBlank` from the factors of data type II.

    Parameters
    ----------
    addendum_share : float
        c_ham, mean addendum of the wheel over the working depth.
    depth : float
        k_d, working depth in mean normal modules.
    clearance : float
        k_c, clearance over the working depth.
    thickness : float
        k_t, circular thickness factor.

    Returns
    -------
    dict
        ``profile_shift``, ``addendum_factor``, ``dedendum_factor``, ``thickness_modification``.

    References
    ----------
    ISO 23509:2016, table 4.

    Examples
    --------
    >>> {key: round(value, 5) for key, value in crown_gear_factors(0.24737, thickness=0.0915).items()}
    {'profile_shift': 0.50526, 'addendum_factor': 1.0, 'dedendum_factor': 1.25, 'thickness_modification': 0.04575}
    """
    return {
        "profile_shift": depth * (0.5 - addendum_share),
        "addendum_factor": 0.5 * depth,
        "dedendum_factor": depth * (clearance + 0.5),
        "thickness_modification": 0.5 * thickness,
    }


def equivalent_ratio(teeth: tuple[int, int], shaft_angle: float) -> float:
    r"""Ratio u_a of the pair with a shaft angle of 90 deg that has teeth like these.

    .. math:: u_a = \sqrt{u \cos\delta_1 / \cos\delta_2}

    inf from a crown wheel on (:math:`\delta_2 \ge 90^\circ`), 0 from a crown pinion on; u = z2/z1 where the shaft angle
    is 90 deg.

    Parameters
    ----------
    teeth : (int, int)
    shaft_angle : float [rad]

    References
    ----------
    ISO 23509:2016, annex C.

    Examples
    --------
    >>> round(equivalent_ratio((14, 39), 0.5 * pi), 4), equivalent_ratio((18, 36), 2.2)
    (2.7857, inf)
    """
    pinion, wheel = (cos(angle) for angle in pitch_angles(teeth, shaft_angle))
    if wheel <= 0.0:
        return inf
    return sqrt(teeth[1] / teeth[0] * max(pinion, 0.0) / wheel)


def largest_ratio(teeth: tuple[int, int]) -> float:
    """Equivalent ratio from which on the usual thickness factor stays what it is, at least the ratio of the teeth.

    The formula rises to 11.5 + 0.2 (z1 - 30) and falls beyond without bound, for pinions ever thinner.

    Parameters
    ----------
    teeth : (int, int)
    """
    return max(teeth[1] / teeth[0], (0.092 + 0.0016 * (teeth[0] - 30)) / 0.008)


def usual_factors(teeth: tuple[int, int], shaft_angle: float = 0.5 * pi) -> dict[str, float]:
    r"""Mean addendum and thickness factor of data type II where a drawing has none.

    .. math:: c_{ham} = 0.21 + 0.29/u_a^2, \quad
              k_t = -0.088 + 0.092 u_a - 0.004 u_a^2 + 0.0016 (z_1 - 30)(u_a - 1)

    with u_a of :func:`equivalent_ratio`, in k_t up to :func:`largest_ratio`: near a crown wheel, where u_a has no
    limit, both factors pass on without a jump.

    Parameters
    ----------
    teeth : (int, int)
    shaft_angle : float [rad]
        Sigma.

    Returns
    -------
    dict
        ``addendum_share`` and ``thickness``, as :func:`crown_gear_factors` takes them; ``addendum_share`` is inf from a
        crown pinion on.

    References
    ----------
    ISO 23509:2016, annex C; the numbers of annex F.2 follow from them. The bound of u_a in k_t is of this package.

    Examples
    --------
    >>> {key: round(value, 4) for key, value in usual_factors((14, 39)).items()}
    {'addendum_share': 0.2474, 'thickness': 0.0915}
    """
    ratio = equivalent_ratio(teeth, shaft_angle)
    share = 0.21 + 0.29 / ratio**2 if ratio > 0.0 else inf
    ratio = min(ratio, largest_ratio(teeth))
    thickness = -0.088 + 0.092 * ratio - 0.004 * ratio**2 + 0.0016 * (teeth[0] - 30) * (ratio - 1.0)
    return {"addendum_share": share, "thickness": thickness}


Both = tuple[float, float]
"""Of pinion and wheel."""


def measured_depths(addenda: Both, dedenda: Both, module: float) -> dict[str, float]:
    r"""Parameters of :class:`BevelBlank` from mean addenda and dedenda.

    .. math:: k_{hap} = \frac{h_{am1} + h_{am2}}{2 m_{mn}}, \quad
              k_{hfp} = \frac{h_{fm1} + h_{fm2}}{2 m_{mn}}, \quad
              x_{hm1} = \frac{h_{am1} - h_{am2} + h_{fm2} - h_{fm1}}{4 m_{mn}}

    Parameters
    ----------
    addenda, dedenda : (float, float) [mm]
        h_am and h_fm of pinion and wheel.
    module : float [mm]
        m_mn.

    Returns
    -------
    dict
        ``profile_shift``, ``addendum_factor``, ``dedendum_factor``.

    Raises
    ------
    InputError
        If the clearances of the two gears differ by more than 0.02 modules, or one is not positive.

    Examples
    --------
    Annex F.2, of printed depths:

    >>> factors = measured_depths((4.836, 1.591), (2.394, 5.639), 3.2133)
    >>> {key: round(value, 3) for key, value in factors.items()}
    {'profile_shift': 0.505, 'addendum_factor': 1.0, 'dedendum_factor': 1.25}
    """
    first, second = dedenda[0] - addenda[1], dedenda[1] - addenda[0]
    both = f"h_fm1 - h_am2 = {plain(first)} mm and h_fm2 - h_am1 = {plain(second)} mm"
    if not min(first, second) > 0.0:
        raise InputError(f"mean_dedendum: no clearance is left, {both}; allowed above the mating gear's addendum")
    if abs(first - second) > ROUNDED * module:
        raise InputError(
            f"mean_dedendum: the clearances {both} differ by more than {plain(ROUNDED * module, 3)} mm "
            f"({plain(ROUNDED, 6)} m_mn); both gears have one"
        )
    shift = addenda[0] - addenda[1] + dedenda[1] - dedenda[0]
    return {
        "profile_shift": 0.25 * shift / module,
        "addendum_factor": 0.5 * sum(addenda) / module,
        "dedendum_factor": 0.5 * sum(dedenda) / module,
    }


def measured_thicknesses(thicknesses: Both, shift: float, module: float, pressure_angle: float) -> Both:
    r"""Thickness modification of the pinion, and backlash j_mn that mean normal thicknesses leave.

    .. math:: x_{sm1,2} = \frac{s_{mn1,2}}{2 m_{mn}} - \frac{\pi}{4} \mp x_{hm1} \tan\alpha_n, \quad
              x_{smn} = \frac{x_{sm1} - x_{sm2}}{2}, \quad j_{mn} = (\pi m_{mn} - s_{mn1} - s_{mn2}) \cos\alpha_n

    Parameters
    ----------
    thicknesses : (float, float) [mm]
        s_mn of pinion and wheel.
    shift : float
        x_hm of the pinion.
    module : float [mm]
        m_mn.
    pressure_angle : float [rad]
        alpha_n.

    Returns
    -------
    (float, float)
        x_smn and j_mn [mm].

    Raises
    ------
    InputError
        If the two teeth are thicker than the normal pitch.

    Examples
    --------
    >>> from math import radians
    >>> [round(value, 3) for value in measured_thicknesses((6.465, 3.511), 0.505, 3.2133, radians(20))]
    [0.046, 0.112]
    """
    left = pi * module - sum(thicknesses)
    if left < -1e-9 * module:
        raise InputError(
            f"mean_normal_thickness: {plain(thicknesses[0], 6)} and {plain(thicknesses[1], 6)} mm together are more "
            f"than the mean normal pitch, {pi * module:.4f} mm: the teeth would overlap"
        )
    difference = 0.25 * (thicknesses[0] - thicknesses[1]) / module - shift * tan(pressure_angle)
    return difference, max(left, 0.0) * cos(pressure_angle)
