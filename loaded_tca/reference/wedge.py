"""Elastic wedge in plane strain under a line load normal to one of its faces."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from loaded_tca.arguments import checked
from loaded_tca.errors import require, require_positive
from loaded_tca.plain import plain

STEP, LAST = 0.1, 40.0
"""Of the argument of the transform: the trapezoidal rule converges exponentially, up to where 2 omega tau is 40."""
FARTHEST = math.exp(0.5 * math.pi / STEP)
"""Ratio of distances up to which the rule holds: half of that at which its sum would repeat."""


@checked
def extra_displacement(place: ArrayLike, load_place: ArrayLike, angle: float) -> NDArray[np.float64]:
    r"""Displacement of a face, normal to it, by a line load on it, beyond that of a half-plane.

    .. math::
        \frac{u E^*}{P} = \frac{2}{\pi} \int_0^\infty \frac{h(\tau)}{\tau}
            \left[\cos\left(\tau \ln\frac{x}{s}\right) - 1\right] d\tau - \frac{m}{\pi} \ln\frac{x s}{c^2}

    .. math::
        h = \frac{\sinh 2\omega\tau + \tau \sin 2\omega}{2 (\sinh^2 \omega\tau - \tau^2 \sin^2 \omega)}
            - \coth \pi\tau, \qquad
        m = \pi \frac{\omega + \sin\omega \cos\omega}{\omega^2 - \sin^2\omega} - 1

    from Mellin's transform of Airy's stress function, the wedge not turning far away and c = 1 mm. Where the load is,
    the face tilts by m P/(pi E* s).

    Parameters
    ----------
    place, load_place : array_like [mm]
        x and s, distances from the apex along the face, positive; of shapes that broadcast.
    angle : float [rad]
        omega, of the material, up to pi.

    Returns
    -------
    array [mm^2/N times E*]
        u E*/P.

    Raises
    ------
    InputError
        If an argument is out of range.

    References
    ----------
    Tranter 1948, Q. J. Mech. Appl. Math. 1, 125-130 (the transform for the wedge); Michell 1902, Proc. London Math.
    Soc. 34, 134-146 (m).

    Examples
    --------
    >>> extra_displacement([0.5, 1.0, 2.0], 1.0, math.radians(115.0)).round(4).tolist()
    [0.1047, 0.0, -0.156]
    """
    require((0.0 < angle <= math.pi, f"angle: {angle} rad is not between 0 and pi"))
    x, s = np.broadcast_arrays(np.asarray(place, dtype=float), np.asarray(load_place, dtype=float))
    require_positive(place=float(x.min()), load_place=float(s.min()))
    apart = np.log(x / s)
    farthest = math.exp(float(np.abs(apart).max()))
    allowed = f"allowed up to {plain(FARTHEST, 3)}"
    require((farthest <= FARTHEST, f"place, load_place: one is {plain(farthest, 3)} times the other; {allowed}"))
    sine, cosine = math.sin(angle), math.cos(angle)
    more = math.pi * (angle + sine * cosine) / (angle * angle - sine * sine) - 1.0
    tau = np.arange(STEP, 0.5 * LAST / angle, STEP)
    grown = np.sinh(angle * tau)
    h = (np.sinh(2.0 * angle * tau) + tau * math.sin(2.0 * angle)) / (2.0 * (grown**2 - (tau * sine) ** 2))
    h -= 1.0 / np.tanh(math.pi * tau)
    waves = (np.cos(apart[..., None] * tau) - 1.0) @ (h / tau)
    even = (2.0 / math.pi) * STEP * (waves - 0.25 * more / math.pi * apart**2)  # half the limit at zero
    return np.asarray(even - more / math.pi * np.log(x * s))
