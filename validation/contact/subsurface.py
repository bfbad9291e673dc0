"""Stresses below a Hertz circle and a Hertz line against their closed forms; Johnson 1985, sections 4.2 and 3.4.

Greatest shear for nu = 0.3: 0.310 p0 at 0.48 a below a circle, 0.300 p0 at 0.79 a below a line.
"""

import numpy as np

from loaded_tca.contact import SubsurfaceStress, subsurface_stress
from loaded_tca.reference import hertz
from validation.table import Row

SOURCE = "Johnson 1985, section 4.2"
POISSON_RATIO = 0.3
# Over the radius; a line ends 500 half-widths from its middle.
CELLS, LINE_CELLS, LINE_STEP = 40, 25, 40.0


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
    return [Row("below a circle", "Hertz, Love 1929", "stresses on the axis, worst difference [p0]", 0.0, worst, 5e-3)]


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
    ]
