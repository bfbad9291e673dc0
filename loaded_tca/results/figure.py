"""What is declared of a key figure.

What is to be known of the accuracy of key figures, in words.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from loaded_tca.plain import plain
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.units import unit_of

if TYPE_CHECKING:
    from loaded_tca.arrays import Array
    from loaded_tca.results.sensitivities import Sensitivities

Figures = Mapping[str, float]
"""Name with its unit -> number, for one torque."""

Note = Callable[[str, CycleNumbers, slice, Sequence[Figures]], str]
"""A sentence on a figure by its name, of a result, some of its torques, and the figures under each of these."""

WIDE = 33.0
"""Face width over the module from which the ends of a face matter little."""
COMPARED: dict[str, dict[str, float]] = {
    f"spur teeth on a face of {plain(WIDE, 6)} modules or more": {
        "transmission_error_mean_": 1.1,
        "transmission_error_span_": 0.5,
        "mesh_stiffness_mean_": 3.1,
    },
    f"spur teeth on a face below {plain(WIDE, 6)} modules": {
        "transmission_error_mean_": 2.9,
        "transmission_error_span_": 3.0,
        "mesh_stiffness_mean_": 5.0,
    },
    "spur teeth": {"root_tension_MPa": 0.5, "root_compression_MPa": 0.6},
    "helical teeth": {"root_tension_MPa": 0.9, "root_compression_MPa": 1.5},
}
"""Kind of gears -> by how many percent key figures with such words in their names differ from finite elements in the
studies of the documentation: the mesh cycle, and root stress. Gears of other kinds were not compared."""
NO_ESTIMATE = "no estimate"
ROOT = "root_tension"
"""Array that all results with root stress have."""


def saying(sentence: str) -> Note:
    """Make a note that says the same of every result."""
    return lambda *_: sentence


def of_peak(_: str, result: CycleNumbers, part: slice, figures: Sequence[Figures]) -> str:
    """How accurate the peak pressure is."""
    of_slices = any(entry["edge_positions"] or entry["relief_start_positions"] for entry in figures)
    beside = "; at edges and relief starts the error of the pressure of slices" if of_slices else ""
    return f"mesh-independent; error of the grid: {_errors_at_peak(result, part)}{beside}"


def of_edge(_: str, __: CycleNumbers, ___: slice, figures: Sequence[Figures]) -> str:
    """What is to be known of the pressure at an edge."""
    rounded = {bool(entry["edge_is_rounded"]) for entry in figures if math.isfinite(entry["edge_pressure_MPa"])}
    if rounded == {True}:
        return "rounded edge: its error stands below"
    return "mesh-dependent at sharp edges: not for rating"


def of_error_at_edge(_: str, __: CycleNumbers, ___: slice, figures: Sequence[Figures]) -> str:
    """Why there is no estimate at a sharp edge, and what to do."""
    at_edges = [entry for entry in figures if math.isfinite(entry["edge_pressure_MPa"])]
    if all(entry["edge_is_rounded"] for entry in at_edges):
        return ""
    return f"{NO_ESTIMATE} at a sharp edge, where pressure grows with finer cells: give the edge a radius"


def of_face_load(_: str, result: CycleNumbers, __: slice, figures: Sequence[Figures]) -> str:
    """What strips and positions do to K_Hbeta."""
    moves = [entry["face_load_factor_by_positions"] for entry in figures]
    known = [f"{move:.1%}" for move in moves if math.isfinite(move)]
    strips = f"{max(known, key=lambda text: float(text[:-1]))} of the largest" if known else ""
    by = f"; with every second position only, loads of strips differ by {strips}" if known else ""
    return f"from 30 strips of the face and {len(result.path)} positions{by}"


def of_line_load(_: str, __: CycleNumbers, ___: slice, figures: Sequence[Figures]) -> str:
    """Where the line load depends on the mesh."""
    return "mesh-dependent where it lies at a sharp face end" if any(one["edge_positions"] for one in figures) else ""


def of_largest(_: str, result: CycleNumbers, *__: object) -> str:
    """What positions do to the largest of a curve."""
    return f"the largest of {len(result.path)} positions: more may find a larger one"


def of_orders(_: str, result: CycleNumbers, *__: object) -> str:
    """What positions do to orders of the tooth mesh."""
    return f"from {len(result.path)} positions: higher orders are aliased into this order"


def of_bending(name: str, result: CycleNumbers, *_: object) -> str:
    """By how much a figure to which the bending of teeth belongs differs from finite elements."""
    if not result.scene.analysis.teeth_bend:
        return "of the flanks alone: the teeth do not bend"
    return compared(name, result)


def compared(name: str, result: CycleNumbers, *_: object) -> str:
    """By how much a key figure of gears of this kind differs from finite elements; nothing of most figures."""
    if not any(words in name for percents in COMPARED.values() for words in percents):
        return ""
    for kind, percent in _percents(name, result):
        return f"{kind}: compared gears are within {plain(percent, 6)} % of finite elements"
    within = {kind: percent for kind, of in COMPARED.items() for words, percent in of.items() if words in name}
    others = ", ".join(f"{kind} within {plain(percent, 6)} %" for kind, percent in within.items())
    kinds = "helical teeth" if math.isfinite(result.scene.transverse_angles[1]) else "teeth of bevel gears"
    return (
        f"{NO_ESTIMATE}: for {kinds} this figure was not compared with finite elements ({others}); compare it with "
        "finite elements or a measurement of such gears"
    )


def in_percent(error: float) -> str:
    """A relative error as a percentage."""
    if error == math.inf:
        return "no limit"
    return f"{error:.2%}" if math.isfinite(error) else NO_ESTIMATE


def _errors_at_peak(result: CycleNumbers, part: slice) -> str:
    """Estimated error of the peak pressure itself under some torques."""
    torques = range(len(result.torque))[part]
    errors = [
        math.nan if place is None else float(result.discretisation_error[torque][place])
        for torque in torques
        for place in (result.peak_contact(torque),)
    ]
    if np.isnan(errors).all():
        return f"{NO_ESTIMATE}, since `cells` are given or no pair is under load: give `accuracy`, or compare two grids"
    return ", ".join(map(in_percent, errors))


def _percents(name: str, result: CycleNumbers) -> Iterator[tuple[str, float]]:
    """Kinds of gears that a result is of, and by how many percent a key figure of them differs from finite elements."""
    for kind in _kinds(result):
        yield from ((kind, percent) for words, percent in COMPARED[kind].items() if words in name)


def _kinds(result: CycleNumbers) -> Iterator[str]:
    """Kinds of gears of ``COMPARED`` that a result is of."""
    spur_wide, spur_narrow, spur, helical = COMPARED
    _, helix = result.scene.transverse_angles
    if helix == 0.0:
        yield spur_wide if result.face_width >= WIDE * result.gear_pair.module else spur_narrow
        yield spur
    elif math.isfinite(helix):
        yield helical


def _part_at_peak(_: str, result: CycleNumbers, torque: int, __: Figures) -> float:
    """Estimated error of the peak pressure itself."""
    place = result.peak_contact(torque)
    return math.nan if place is None else float(result.discretisation_error[torque][place])


def _part_of_face_load(_: str, __: CycleNumbers, ___: int, figures: Figures) -> float:
    """What strips and positions do to K_Hbeta, the larger one."""
    return float(np.fmax(figures["face_load_factor_error"], figures["face_load_factor_by_positions"]))


def _part_compared(name: str, result: CycleNumbers, *_: object) -> float:
    """Difference from finite elements of a figure of such gears."""
    return next((0.01 * percent for _, percent in _percents(name, result)), math.nan)


def _part_of_bending(name: str, result: CycleNumbers, *_: object) -> float:
    """The same of a figure to which the bending of teeth belongs."""
    return _part_compared(name, result) if result.scene.analysis.teeth_bend else math.nan


ERRORS: dict[Note, Callable[[str, CycleNumbers, int, Figures], float]] = {
    of_peak: _part_at_peak,
    of_edge: lambda _, __, ___, figures: figures["edge_pressure_error"],
    of_face_load: _part_of_face_load,
    of_bending: _part_of_bending,
    compared: _part_compared,
}
"""Sentence on the accuracy of a figure -> the relative error that it states, of name, result, torque and figures."""


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A key figure.

    Attributes
    ----------
    of : callable
        Its number, of the result under a torque; NaN: not known.
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
    largest_is_best : bool
        Whether of variants of a study that with the largest value is best, as of a life; default: that with the least.
    rank : int, optional
        Place among the figures by which variants of a study are compared; the first one ranks them.
    slope : Slope, optional
        Its derivatives.
    is_part : bool
        Whether it is a part of one, that texts show in %.
    needs : str
        Array of a result without which it does not have it; default: all have it.
    accuracy : callable, optional
        What is to be known of its accuracy, of name, result, slice of torques and figures under each.
    """

    of: Callable[[Any], float]
    label: str = ""
    below: str = ""
    column: str = ""
    axis: str = ""
    is_compared: bool = False
    is_load_case: bool = False
    is_scattered: bool = False
    largest_is_best: bool = False
    rank: int | None = None
    slope: Slope | None = None
    is_part: bool = False
    needs: str = ""
    accuracy: Note | None = None

    def relative_error(self, name: str, result: CycleNumbers, torque: int, figures: Figures) -> float:
        """The relative error that its accuracy states of a result under a torque; NaN: none is known.

        Parameters
        ----------
        name : str
        result : CycleNumbers
        torque : int
            Index.
        figures : mapping of str to float
            Under this torque.
        """
        error = None if self.accuracy is None else ERRORS.get(self.accuracy)
        return math.nan if error is None else error(name, result, torque, figures)

    @property
    def is_of_roots(self) -> bool:
        """Whether results without root stress do not have it."""
        return self.needs == ROOT


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


def length(sensitivities: Sensitivities) -> float:
    """Of a transmission error at the base circle of the wheel [um/rad]."""
    return sensitivities.result.um_per_rad


def slope_of_mean_error(sensitivities: Sensitivities) -> Array:
    """Derivatives of the mean transmission error (torque, key) [um per unit]."""
    means = [[mean_over_a_pitch(slope) for slope in slopes.T] for slopes in sensitivities.transmission_error]
    return length(sensitivities) * np.array(means)


def slope_of_peak(sensitivities: Sensitivities) -> Array:
    """Derivatives of the peak pressure at the place which has the highest one (torque, key) [MPa per unit]."""
    peaks = [sensitivities.result.peak_contact(torque) for torque in range(len(sensitivities.result.torque))]
    unknown = np.full(len(sensitivities.keys), math.nan)
    return np.array(
        [unknown if at is None else sensitivities.peak_pressure[torque][at] for torque, at in enumerate(peaks)]
    )


def slope_of_root_tension(gear: int) -> Callable[[Sensitivities], Array]:
    """Derivatives of the root tension of a gear at the position that has the largest (torque, key) [MPa per unit]."""

    def slope(sensitivities: Sensitivities) -> Array:
        at = np.nan_to_num(sensitivities.result.root_tension[..., gear]).argmax(axis=1)
        return np.asarray(sensitivities.root_tension[np.arange(len(at)), at, gear])

    return slope
