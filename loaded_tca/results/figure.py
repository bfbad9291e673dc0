"""What is declared of a key figure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from loaded_tca.arrays import Array
from loaded_tca.results.accuracy import Note
from loaded_tca.results.key_figures import UnderTorque, mean_over_a_pitch
from loaded_tca.results.sensitivities import Sensitivities
from loaded_tca.units import unit_of


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A key figure.

    Attributes
    ----------
    of : callable
        Its number under a torque; NaN: not known.
    label : str
        What lines of text call it, without its unit; {edge} stands for the kind of edge.
    below : str
        Its label where figures that belong together stand below each other; default: ``label``.
    column : str
        Its label in the table of the load cases; default: ``label``.
    axis : str
        Its label on axes; default: its name in words.
    is_compared, is_load_case, is_scattered : bool
        Whether it stands in comparisons, in the table of the load cases of a report, and in the summary of a study.
    rank : int, optional
        Place among the figures by which variants of a study are compared; the first one ranks them.
    slope : Slope, optional
        Its derivatives.
    is_part : bool
        Whether it is a part of one, that texts show in %.
    is_of_roots : bool
        Whether results without root stress do not have it.
    accuracy : callable, optional
        What is to be known of its accuracy, of name, result, slice of torques and figures under each.
    """

    of: Callable[[UnderTorque], float]
    label: str = ""
    below: str = ""
    column: str = ""
    axis: str = ""
    is_compared: bool = False
    is_load_case: bool = False
    is_scattered: bool = False
    rank: int | None = None
    slope: Slope | None = None
    is_part: bool = False
    is_of_roots: bool = False
    accuracy: Note | None = None


class Slope(NamedTuple):
    """Derivatives of a figure: place among the columns, their head, and their numbers (torque, key)."""

    place: int
    head: str
    of: Callable[[Sensitivities], Array]


class Line(NamedTuple):
    """A line of the summary: its label and its figures, left out where it may be and no torque knows any of these."""

    label: str
    names: tuple[str, ...]
    is_always_there: bool = False


def labelled(name: str, label: str) -> str:
    """A label of a figure with its unit in brackets."""
    return f"{label} [{unit}]" if (unit := unit_of(name)) else label


def length(found: Sensitivities) -> float:
    """Of a transmission error at the base circle of the wheel [um/rad]."""
    return 1e3 * found.result.wheel_base_radius


def slope_of_mean_error(found: Sensitivities) -> Array:
    """Derivatives of the mean transmission error (torque, key) [um per unit]."""
    means = [[mean_over_a_pitch(slope) for slope in slopes.T] for slopes in found.transmission_error]
    return length(found) * np.array(means)


def slope_of_peak(found: Sensitivities) -> Array:
    """Derivatives of the peak pressure at the place which has the highest one (torque, key) [MPa per unit]."""
    peaks = [found.result.peak_contact(torque) for torque in range(len(found.result.torque))]
    unknown = np.full(len(found.keys), math.nan)
    return np.array([unknown if at is None else found.peak_pressure[torque][at] for torque, at in enumerate(peaks)])


def slope_of_root_tension(gear: int) -> Callable[[Sensitivities], Array]:
    """Derivatives of the root tension of a gear at the position that has the largest (torque, key) [MPa per unit]."""

    def slope(found: Sensitivities) -> Array:
        at = np.nan_to_num(found.result.root_tension[..., gear]).argmax(axis=1)
        return np.asarray(found.root_tension[np.arange(len(at)), at, gear])

    return slope
