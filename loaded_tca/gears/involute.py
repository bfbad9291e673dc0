"""The involute function and its inverse."""

from math import atan, inf, tan

from loaded_tca.errors import InputError


def involute(angle: float) -> float:
    """Involute function inv(alpha) = tan(alpha) - alpha [rad]."""
    return tan(angle) - angle


def inverse_involute(value: float) -> float:
    r"""Angle whose involute function is the value given, to machine precision.

    Newton on :math:`t - \arctan t = \mathrm{inv}\,\alpha` with t = tan(alpha): convex, and started above the
    root, so that the iterates fall until rounding stops them.

    Parameters
    ----------
    value : float [rad]
        inv(alpha), not negative.

    Examples
    --------
    >>> round(inverse_involute(involute(0.35)), 12)
    0.35
    """
    if not 0.0 <= value < inf:
        raise InputError(f"value: an involute function of {value} rad has no angle between 0 and 90 deg")
    if value == 0.0:
        return 0.0
    tangent = inf
    smaller = (3.0 * value) ** (1.0 / 3.0) + value
    while smaller < tangent:
        tangent = smaller
        smaller = tangent - (tangent - atan(tangent) - value) * (1.0 + tangent**-2)
    return atan(tangent)
