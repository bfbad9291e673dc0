"""Stresses below a Hertz circle and a Hertz line against their closed forms; Johnson 1985, sections 4.2 and 3.4.

Greatest shear for nu = 0.3: 0.310 p0 at 0.48 a below a circle, 0.300 p0 at 0.79 a below a line.

Below a rectangle under uniform pressure, beside its middle, all six stresses are compared with those of point forces
(Boussinesq; Johnson 1985, eq. 3.20, in cylindrical coordinates about each force) integrated over the rectangle by
numerical quadrature: shear stresses in the surface's plane vanish below the middle of all other contacts here.
"""

import numpy as np
from scipy.integrate import dblquad

from loaded_tca.contact import SubsurfaceStress, subsurface_stress
from loaded_tca.reference import hertz
from validation.table import Row

SOURCE = "Johnson 1985, section 4.2"
BOUSSINESQ = "Boussinesq, by quadrature"
POISSON_RATIO = 0.3
# Over the radius; a line ends 500 half-widths from its middle.
CELLS, LINE_CELLS, LINE_STEP = 40, 25, 40.0
RECTANGLE, BELOW = ((-1.0, 1.0), (-0.5, 0.5)), (0.25, 0.75, 0.5)
"""Loaded area in x and y, and the point looked at (x, y, z); lengths in half the longer side."""
ON_AXIS = 3e-4
"""Of 40 cells over the radius, beside the closed form [p0]; 8e-5 is seen."""
QUADRATURE = 1e-10
"""What is allowed, relative; a tenth of it is asked of the quadrature."""


def _circle(depths: np.ndarray) -> SubsurfaceStress:
    x = np.arange(-CELLS, CELLS + 1) / CELLS
    pressure = np.sqrt(np.maximum(0.0, 1.0 - x[:, None] ** 2 - x**2))
    return subsurface_stress(pressure, (1.0 / CELLS, 1.0 / CELLS), depths, POISSON_RATIO)


def _line(depths: np.ndarray) -> SubsurfaceStress:
    x = np.arange(-CELLS, CELLS + 1) / CELLS
    pressure = np.repeat(np.sqrt(np.maximum(0.0, 1.0 - x**2))[:, None], LINE_CELLS, axis=1)
    return subsurface_stress(pressure, (1.0 / CELLS, LINE_STEP), depths, POISSON_RATIO)


def _on_axis_of_a_circle() -> list[Row]:
    """Normal stresses over the depth, greatest difference from the closed form in p0."""
    depths = np.linspace(0.1, 3.0, 30)
    below = _circle(depths)
    contact = hertz.point_contact(1.0, (1.0, 1.0), 1.0)
    scale = contact.max_pressure
    exact = np.array([contact.axis_stresses(z * contact.semi_minor, POISSON_RATIO) for z in depths]) / scale
    found = np.stack([below.sigma_x, below.sigma_y, below.sigma_z], axis=-1)[:, CELLS, CELLS]
    worst = float(np.abs(found - exact).max())
    return [
        Row("below a circle", "Hertz, Love 1929", "stresses on the axis, worst difference [p0]", 0.0, worst, ON_AXIS)
    ]


def _point_force(x: float, y: float, z: float) -> dict[str, float]:
    """Stresses under a unit force that presses on a half-space, at a place seen from the force, z into the body."""
    radius, distance = np.hypot(x, y), np.sqrt(x**2 + y**2 + z**2)
    surface = (1.0 - 2.0 * POISSON_RATIO) * (1.0 - z / distance) / radius**2
    radial = surface - 3.0 * z * radius**2 / distance**5
    hoop = -surface + (1.0 - 2.0 * POISSON_RATIO) * z / distance**3
    cosine, sine = x / radius, y / radius
    shear = -3.0 * radius * z**2 / distance**5
    stresses = {
        "sigma_x": radial * cosine**2 + hoop * sine**2,
        "sigma_y": radial * sine**2 + hoop * cosine**2,
        "sigma_z": -3.0 * z**3 / distance**5,
        "tau_xy": (radial - hoop) * cosine * sine,
        "tau_xz": shear * cosine,
        "tau_yz": shear * sine,
    }
    return {name: value / (2.0 * np.pi) for name, value in stresses.items()}


def _below_a_rectangle() -> list[Row]:
    """Every stress beside the middle of a rectangle under uniform pressure 1."""
    x, y, z = BELOW
    centres = np.arange(-7, 8, 2) / 4.0  # of cells as wide as a half
    pressure = np.outer(np.abs(centres) < RECTANGLE[0][1], np.abs(centres) < RECTANGLE[1][1])
    below = subsurface_stress(pressure, (0.5, 0.5), [z], POISSON_RATIO)
    place = 0, *np.searchsorted(centres, (x, y))
    found = []
    for name in _point_force(*BELOW):
        exact, _ = dblquad(
            lambda v, u, name=name: _point_force(x - u, y - v, z)[name],
            *(*RECTANGLE[0], *RECTANGLE[1]),
            epsabs=0.0,
            epsrel=0.1 * QUADRATURE,
        )
        obtained = float(getattr(below, name)[place])
        found.append(Row("below a rectangle", BOUSSINESQ, f"{name} [p]", exact, obtained, QUADRATURE))
    return found


def rows() -> list[Row]:
    """The field's numbers to the digits that they are printed with; the closed form over the depth."""
    depths = np.linspace(0.3, 1.1, 81)
    circle, line = _circle(depths), _line(depths)
    in_plane = 0.5 * (line.sigma_x - line.sigma_z)[:, CELLS, LINE_CELLS // 2]
    return [
        Row("below a circle", SOURCE, "greatest shear [p0]", 0.310, float(circle.max_shear.max()), 3e-3),
        Row("below a circle", SOURCE, "its depth [a]", 0.48, float(depths[circle.max_shear_at[0]]), 2e-2),
        Row("below a line", SOURCE, "greatest shear [p0]", 0.300, float(in_plane.max()), 3e-3),
        Row("below a line", SOURCE, "its depth [a]", 0.786, float(depths[int(np.argmax(in_plane))]), 2e-2),
        *_on_axis_of_a_circle(),
        *_below_a_rectangle(),
    ]
