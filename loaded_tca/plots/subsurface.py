"""The stresses below a contact, in a plane across it."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from loaded_tca.contact import SubsurfaceStress
from loaded_tca.errors import require
from loaded_tca.plots.style import ACCENT, COLOURS, set_title
from loaded_tca.results.stress_below import NAMES, Quantity, StressBelow, depth_of_largest

LINES = 8
DEEPEST_DRAWN = 0.1


def plot_subsurface(stress: SubsurfaceStress, quantity: Quantity = "max_shear", column: int | None = None) -> Figure:
    """Depth against the direction across the contact, in the plane that holds the largest value.

    Parameters
    ----------
    stress : SubsurfaceStress
        At two depths at least.
    quantity : {"max_shear", "von_mises"}
    column : int, optional
        Index along the contact of another plane.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        For another quantity, for less than two depths or two cells across, or where there is no stress.

    Examples
    --------
    >>> import numpy as np
    >>> from loaded_tca.contact import subsurface_stress
    >>> stress = subsurface_stress(np.full((8, 8), 100.0), (0.1, 0.1), np.linspace(0.0, 1.0, 11))
    >>> plot_subsurface(stress).axes[0].get_ylabel()
    'depth [mm]'
    """
    _check(stress, quantity)
    values = stress.max_shear if quantity == "max_shear" else stress.von_mises
    column = int(np.unravel_index(int(np.argmax(values)), values.shape)[2]) if column is None else column
    row = int(values[:, :, column].max(axis=0).argmax())
    largest = float(values[:, :, column].max())
    order = np.argsort(stress.depths)
    across = (np.arange(values.shape[1]) - 0.5 * (values.shape[1] - 1)) * stress.spacing[0]
    figure = Figure(figsize=(8.0, 5.5), layout="compressed")
    axes = figure.add_subplot()
    norm, section = Normalize(0.0, largest), values[order, :, column]
    filled = axes.contourf(across, stress.depths[order], section, 4 * LINES, cmap=COLOURS, norm=norm)
    axes.contour(across, stress.depths[order], section, LINES, colors="white", linewidths=0.5)
    figure.colorbar(filled, ax=axes, label=f"{NAMES[quantity]} [MPa]")
    depth = depth_of_largest(stress.depths, values[:, row, column])
    label = f"{largest:.4g} MPa at a depth of {depth:.3g} mm"
    axes.plot(across[row], depth, "+", color=ACCENT, markersize=10.0, label=label)
    axes.invert_yaxis()
    axes.set_aspect("equal" if np.ptp(stress.depths) > DEEPEST_DRAWN * np.ptp(across) else "auto")
    axes.set_xlabel("across the contact, from the middle of the grid [mm]")
    axes.set_ylabel("depth [mm]")
    figure.legend(loc="outside lower center", fontsize="small")
    figure.suptitle(f"Below the surface: {NAMES[quantity]}, Poisson's ratio {stress.poisson_ratio:g}")
    return figure


def plot_stress_below(below: StressBelow, quantity: Quantity = "max_shear") -> Figure:
    """Stress below one pressure map of a result: depth against the direction across, where the stress is largest.

    Parameters
    ----------
    below : StressBelow
        Of :func:`loaded_tca.results.stress_below.stress_below`.
    quantity : {"max_shear", "von_mises"}

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        For another quantity.
    """
    figure = plot_subsurface(below.stress, quantity, below.beside_spike)
    set_title(figure, below.result, f"below the surface: {NAMES[quantity]}", *below.where)
    return figure


def _check(stress: SubsurfaceStress, quantity: str) -> None:
    deep = np.unique(stress.depths).size >= 2 and stress.sigma_z.shape[1] >= 2
    require(
        (quantity in NAMES, f"quantity: {quantity!r} is none of {', '.join(NAMES)}"),
        (deep, "stress: a section needs two depths and two cells across"),
        (bool(stress.max_shear.any()), "stress: there is none anywhere, nothing to draw"),
    )
