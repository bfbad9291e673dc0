"""Layout of figures in half the time: the first of Matplotlib's two passes goes by estimates of texts beside panels.

Constrained layout measures everything around each panel, moves the panels, and does both again, since ticks change as
panels shrink. Measuring takes a third of the time of a picture, and the first pass only has to come near.

Matplotlib places the ticks of an axis and measures their labels up to ten times in a drawing, for the axis, its label,
the title and each side of the frame: here once where the panel lies. New ticks copy from the first one what was set
for it alone: here without its marks.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib.axes import Axes
from matplotlib.axis import Axis, Tick
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

POINTS_PER_INCH = 72.0
LINE = 13.0
"""Height of a line of text with its pad [pt]."""
BESIDE = {"left": 31.0, "right": 31.0, "bottom": 19.0, "top": 19.0}
"""Room for ticks and their labels [pt]."""
MEASURED_AGAIN = "_update_ticks", "_get_ticklabel_bboxes"
"""Methods by which Matplotlib places the ticks of an axis and measures their labels, for each text and line beside.

They are its own: of public ones ``get_tightbbox`` covers layouts, but not drawing and the places of titles and labels
of axes, which ask for ticks by these two. A later Matplotlib that has none of that name measures as it does by itself.
"""
COPY_OF_TICK = "_copy_tick_props"
"""Method by which Matplotlib gives a new tick what the first one of its axis was given by itself."""
COLORBAR = "<colorbar>"
"""What Matplotlib labels the panels of colour bars, which it measures twice in a pass."""


@contextmanager
def estimated_at_first(figure: Figure) -> Iterator[None]:
    """Let the layout inside go by estimates in its first pass, and measure in the next.

    Panels in space or around a circle are measured in both. A layout that takes another number of passes, as a later
    Matplotlib might, measures in the last one all the same, unless it takes a single one.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Drawn once inside.
    """
    panels = [axes for axes in figure.axes if axes.name == "rectilinear"]
    axles = [axis for axes in panels for part in (axes, *axes.child_axes) for axis in (part.xaxis, part.yaxis)]
    for axes in panels:
        _estimate(axes)
    for axis in axles:
        for name in MEASURED_AGAIN:
            _measure_once(axis, name)
        _copy_no_marks(axis)
    try:
        yield
    finally:
        for axes in panels:
            del axes.get_tightbbox
        for axis in axles:
            for name in MEASURED_AGAIN:
                vars(axis).pop(name, None)
            vars(axis).pop(COPY_OF_TICK, None)


def _measure_once(axis: Axis, name: str) -> None:
    """Have an axis keep what one of its methods returns as long as its panel and its limits stay as they are."""
    measure = getattr(axis, name, None)
    if measure is None:  # of another Matplotlib
        return
    place: tuple[float, ...] = ()
    kept: Any = None

    def measure_once(*arguments: Any, **options: Any) -> Any:
        nonlocal place, kept
        now = *axis.axes.bbox.extents, *axis.get_view_interval()
        if now != place:
            kept, place = measure(*arguments, **options), now
        return kept

    setattr(axis, name, measure_once)


def _copy_no_marks(axis: Axis) -> None:
    """Have new ticks copy labels and line of the grid of the first one, and not both marks, which all have alike.

    Matplotlib copies marks with all of their paths, which takes a third of the time of a tick.
    """
    if not hasattr(axis, COPY_OF_TICK):  # of another Matplotlib
        return

    def copy(first: Tick, new: Tick) -> None:
        new.label1.update_from(first.label1)
        new.label2.update_from(first.label2)
        new.gridline.update_from(first.gridline)

    setattr(axis, COPY_OF_TICK, copy)


def _estimate(axes: Axes) -> None:
    """Have a panel tell its estimated box where a layout asks for the first time, and the measured one from then on."""
    measured, told = axes.get_tightbbox, 2 if axes.get_label() == COLORBAR else 1

    def get_tightbbox(*arguments: Any, **options: Any) -> Bbox | None:
        nonlocal told
        if told and options.get("for_layout_only"):
            told -= 1
            return estimated_box(axes)
        return measured(*arguments, **options)

    axes.get_tightbbox = get_tightbbox  # type: ignore[method-assign]


def estimated_box(axes: Axes) -> Bbox:
    """About the box of a panel with its ticks, labels and title, without a look at any text but its lines [px].

    Examples
    --------
    >>> figure = Figure(dpi=72.0)
    >>> axes = figure.add_subplot(title="one line", ylabel="stiffness")
    >>> box = estimated_box(axes)
    >>> float(axes.bbox.x0 - box.x0), float(box.y1 - axes.bbox.y1)
    (44.0, 16.0)
    """
    room = dict.fromkeys(BESIDE, 0.0)
    if axes.axison:
        for axis, sides in ((axes.xaxis, ("bottom", "top")), (axes.yaxis, ("left", "right"))):
            _add_room(room, axis, sides)
    if title := axes.get_title():
        room["top"] += LINE * _lines(title) + 3.0
    pixels = axes.get_figure(root=True).dpi / POINTS_PER_INCH  # type: ignore[union-attr]
    left, right, bottom, top = (pixels * room[side] for side in BESIDE)
    box = axes.bbox
    return Bbox.from_extents(box.x0 - left, box.y0 - bottom, box.x1 + right, box.y1 + top)


def _add_room(room: dict[str, float], axis: Axis, sides: tuple[str, str]) -> None:
    """Add what an axis takes on both sides of its panel [pt]."""
    if not axis.get_visible():
        return
    parts = axis.get_tick_params()
    for side in sides:
        if parts.get(f"label{side}"):
            room[side] += BESIDE[side]
    if text := axis.get_label_text():
        room[axis.get_label_position()] += LINE * _lines(text)


def _lines(text: str) -> int:
    return 1 + text.count("\n")
