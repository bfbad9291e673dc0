"""What keys and their tolerances change in the key figures of a double helical pair: text and table."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array
from loaded_tca.output.tables import SENSITIVITIES, slopes_csv, slopes_text
from loaded_tca.results.files import FilePath, replace_together
from loaded_tca.scene.double_helical import HALVES
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from loaded_tca.double_helical.sensitivities import DoubleHelicalSensitivities

HEADS = {
    "transmission_error_peak_to_peak_um": "TE p-p",
    "axial_motion_mean_um": "axial motion",
    **{f"half_{name}_torque_share": f"share {name}" for name in HALVES},
    **{f"half_{name}_peak_pressure_MPa": f"pressure {name}" for name in HALVES},
    **{f"half_{name}_line_load_N_per_mm": f"line load {name}" for name in HALVES},
}
"""Key figures that have derivatives, with the heads of their columns."""


def figure_slopes(sensitivities: DoubleHelicalSensitivities) -> dict[str, Array]:
    """Derivatives (torque, key) of key figures, by their names, in their units per unit of the key.

    Of the largest pressure and line load of a half at the position that has it.
    """
    result = sensitivities.result
    rows = np.arange(len(result.torque))
    slopes = {
        "transmission_error_peak_to_peak_um": result.um_per_rad * sensitivities.peak_to_peak,
        "axial_motion_mean_um": MICROMETRES * sensitivities.axial_motion.mean(axis=1),
    }
    for half, name in enumerate(HALVES):
        slopes[f"half_{name}_torque_share"] = sensitivities.torque_share[:, :, half].mean(axis=1)
    for number, ending in (("peak_pressure", "MPa"), ("line_load", "N_per_mm")):
        for half, name in enumerate(HALVES):
            largest = result.values(number)[..., half].argmax(axis=1)
            slopes[f"half_{name}_{number}_{ending}"] = getattr(sensitivities, number)[rows, largest, half]
    return {name: np.asarray(slopes[name]) for name in HEADS}


def sensitivities_of_halves_text(
    sensitivities: DoubleHelicalSensitivities, tolerances: Mapping[str, float], torque: int
) -> str:
    """Return the changes of the key figures under one torque as text: per unit of each key, and per tolerance.

    Parameters
    ----------
    sensitivities : DoubleHelicalSensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit, in the order of the keys.
    torque : int
        Index of the torque.
    """
    slopes = {name: values[torque] for name, values in figure_slopes(sensitivities).items()}
    figures = sensitivities.result.key_figures()[torque]
    return slopes_text(sensitivities.result.title or "Sensitivities", figures, [*HEADS.values()], slopes, tolerances)


@checked
def write_sensitivities_of_halves(
    sensitivities: DoubleHelicalSensitivities, tolerances: Mapping[str, float], directory: FilePath
) -> tuple[Path, ...]:
    """Write ``sensitivities.csv``: one row per torque and key.

    Parameters
    ----------
    sensitivities : DoubleHelicalSensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit, in the order of the keys.
    directory : str or path
        Made if it does not exist.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    table = slopes_csv(sensitivities.result.torque, figure_slopes(sensitivities), tolerances)
    return replace_together(directory, {SENSITIVITIES: table.encode()})
