"""Rigid punches on an elastic half-space: profiles C r^n, and flat ends."""

import math
from dataclasses import dataclass

from loaded_tca.errors import require_positive

# F/(E* L delta) of a flat square punch of side L: pi times the electrostatic capacity of the unit square, 0.36679,
# since a charged plate and a flat punch obey the same equations. Grids of Love's cells, extrapolated, agree to 1e-5.
SQUARE_PUNCH = 1.1523


@dataclass(frozen=True)
class PunchContact:
    """Contact of a rigid punch.

    Parameters
    ----------
    load : float [N]
        Normal load.
    radius : float [mm]
        Contact radius.
    approach : float [mm]
        Depth of the punch below the undeformed surface.
    """

    load: float
    radius: float
    approach: float


def power_law(radius: float, coefficient: float, exponent: float, contact_modulus: float) -> PunchContact:
    r"""Punch of the profile C r^n, pressed in until it touches within a radius a.

    .. math::
        \delta = C a^n \sqrt\pi\, \Gamma(1 + n/2)/\Gamma((1 + n)/2),\qquad F = 2 E^* a \delta\, n/(n + 1)

    n = 1 is a cone, n = 2 a sphere (C = 1/(2R)), large n tends to a flat end.

    Parameters
    ----------
    radius : float [mm]
        Contact radius a.
    coefficient : float [mm^(1-n)]
        C, positive.
    exponent : float
        n, positive.
    contact_modulus : float [MPa]
        E*.

    Returns
    -------
    PunchContact
        ``load`` [N], ``radius`` [mm], ``approach`` [mm].

    Raises
    ------
    InputError
        If an argument is not positive and finite.

    References
    ----------
    Sneddon 1965, Int. J. Eng. Sci. 3, 47-57.

    Examples
    --------
    >>> cone = power_law(1.0, 0.01, 1.0, 115e3)
    >>> round(cone.load / (0.01 * 115e3), 6), round(cone.approach / 0.01, 6)
    (1.570796, 1.570796)
    """
    require_positive(radius=radius, coefficient=coefficient, exponent=exponent, contact_modulus=contact_modulus)
    ratio = math.exp(math.lgamma(1.0 + exponent / 2.0) - math.lgamma((1.0 + exponent) / 2.0))
    approach = coefficient * radius**exponent * math.sqrt(math.pi) * ratio
    load = 2.0 * contact_modulus * radius * approach * exponent / (exponent + 1.0)
    return PunchContact(load, radius, approach)


def flat_circular(load: float, radius: float, contact_modulus: float) -> PunchContact:
    r"""Flat-ended cylinder: :math:`\delta = F/(2 a E^*)`.

    Parameters
    ----------
    load : float [N]
        Normal load, positive.
    radius : float [mm]
        Radius a of the flat end.
    contact_modulus : float [MPa]
        E*.

    Returns
    -------
    PunchContact
        ``load`` [N], ``radius`` [mm], ``approach`` [mm].

    Raises
    ------
    InputError
        If an argument is not positive and finite.

    References
    ----------
    Sneddon 1965, Int. J. Eng. Sci. 3, 47-57; Johnson 1985, Contact Mechanics, section 3.4.
    """
    require_positive(load=load, radius=radius, contact_modulus=contact_modulus)
    return PunchContact(load, radius, load / (2.0 * radius * contact_modulus))
