"""Where the tips of cylindrical gears end beside their basic racks: the shortening that keeps the clearance.

Lengths are in mm, angles in rad.
"""

from __future__ import annotations

from math import atan, cos, tan

from loaded_tca.errors import require
from loaded_tca.gears.involute import inverse_involute, involute_without_backlash
from loaded_tca.plain import plain


def computed_tip_alteration(
    teeth: tuple[int, int],
    shifts: tuple[float, float],
    normal_module: float,
    *,
    pressure_angle: float,
    helix_angle: float = 0.0,
    centre_distance: float | None = None,
) -> float:
    r"""Tip alteration coefficient k of both gears with which the clearance is that of gears without profile shifts.

    .. math:: k = \frac{a - a_d}{m_n} - (x_1 + x_2), \qquad a_d = \frac{(z_1 + z_2) m_n}{2 \cos\beta}

    with the signs of ISO 21771: number of teeth, centre distance and a_d of a pair with a ring are negative. Tips are
    shortened only: where the formula lengthens them, as of most pairs with a ring, k is 0.

    Parameters
    ----------
    teeth : (int, int)
        z1, z2; that of a ring negative.
    shifts : (float, float)
        x1, x2.
    normal_module : float [mm]
    pressure_angle, helix_angle : float [rad]
    centre_distance : float [mm], optional
        abs(a); None: the one without backlash.

    Returns
    -------
    float
        k, at most 0, in normal modules.

    Raises
    ------
    InputError
        If no centre distance is without backlash.

    References
    ----------
    ISO 21771:2007, 4.2.5 (tip alteration); DIN 3960:1987, 3.4.7.

    Examples
    --------
    >>> from math import radians
    >>> round(computed_tip_alteration((19, 17), (0.6170, 0.8021), 45.0, pressure_angle=radians(20)), 3)
    -0.241
    """
    transverse = normal_module / cos(helix_angle)
    reference = 0.5 * abs(sum(teeth)) * transverse
    distance = centre_distance
    if distance is None:
        angle = atan(tan(pressure_angle) / cos(helix_angle))
        value = involute_without_backlash(sum(teeth), sum(shifts), pressure_angle, angle)
        require(
            (value > 0.0, f"profile_shift: for the sum {plain(sum(shifts), 6)} no centre distance is without backlash"),
        )
        distance = reference * cos(angle) / cos(inverse_involute(value))
    side = 1 if teeth[1] > 0 else -1
    return min(0.0, side * (distance - reference) / normal_module - sum(shifts))
