"""Layout of figures in half the time: the first of Matplotlib's two passes goes by estimates of texts beside panels.

Constrained layout measures everything around each panel, moves the panels, and does both again, since ticks change as
panels shrink. Measuring takes a third of the time of a picture, and the first pass only has to come near.

Matplotlib places the ticks of an axis and measures their labels up to ten times in a drawing, for the axis, its label,
the title and each side of the frame: here once where the panel lies. It lays a text out whenever it measures or draws
it: here once. It makes each tick from what its axis was given, and then copies what the first one was given by itself:
here ticks are copies of the first one from the beginning.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from copy import copy
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis, Tick
from matplotlib.figure import Figure
from matplotlib.text import Text
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
LAYOUT_OF_TEXT = "_get_layout"
"""Method by which Matplotlib lays out a text, wherever it measures or draws it: no public one does only that."""
TICKS = (("majorTicks", "get_major_ticks", "get_majorticklocs"), ("minorTicks", "get_minor_ticks", "get_minorticklocs"))
"""Of an axis: the lists of its ticks, the methods that make as many as are asked for, and those of their places."""
PARTS_OF_TICK = "tick1line", "tick2line", "gridline", "label1", "label2"
Replace = Callable[[Artist, str, Callable[..., Any]], None]
"""Sets a method of a single artist until its figure is drawn."""
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
    with ExitStack() as until_drawn:

        def replace(artist: Artist, name: str, method: Callable[..., Any]) -> None:
            setattr(artist, name, method)
            until_drawn.callback(vars(artist).pop, name, None)

        legends = [*figure.legends, *(legend for axes in figure.axes if (legend := axes.get_legend()))]
        in_legends = [text for legend in legends for text in (legend.get_title(), *legend.get_texts())]
        for text in (*figure.texts, *in_legends):
            _lay_out_once(text, replace)
        for axes in panels:
            replace(axes, "get_tightbbox", _estimated(axes))
            for part in (axes, *axes.child_axes):
                _lay_out_once(part.title, replace)
                for axis in (part.xaxis, part.yaxis):
                    _lay_out_once(axis.label, replace)
                    for name in MEASURED_AGAIN:
                        _measure_once(axis, name, replace)
                    for names in TICKS:
                        _copy_ticks(axis, names, replace)
        yield


def _measure_once(axis: Axis, name: str, replace: Replace) -> None:
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

    replace(axis, name, measure_once)


def _lay_out_once(text: Text, replace: Replace) -> None:
    """Have a text keep its layout as long as it says the same: where it stands and its colour have no part in it."""
    lay_out = getattr(text, LAYOUT_OF_TEXT, None)
    if lay_out is None or text.get_wrap():  # of another Matplotlib; lines as wide as the place allows
        return
    said: str | None = None
    kept: Any = None

    def lay_out_once(renderer: Any) -> Any:
        nonlocal said, kept
        if said != text.get_text():
            kept, said = lay_out(renderer), text.get_text()
        return kept

    replace(text, LAYOUT_OF_TEXT, lay_out_once)


def _copy_ticks(axis: Axis, names: tuple[str, str, str], replace: Replace) -> None:
    """Have an axis copy its first tick where it needs more, and lay out labels once.

    Matplotlib makes each tick with three lines and two texts, which takes a sixth of the time of a picture.
    """
    ticks_of, method, places = names
    laid_out = 0

    def get_ticks(numticks: int | None = None) -> list[Tick]:
        nonlocal laid_out
        ticks: list[Tick] = getattr(axis, ticks_of)
        count = len(getattr(axis, places)()) if numticks is None else numticks
        ticks.extend(_alike(ticks[0]) for _ in range(len(ticks), count))
        for tick in ticks[laid_out:]:
            _lay_out_once(tick.label1, replace)
            _lay_out_once(tick.label2, replace)
        laid_out = max(laid_out, len(ticks))
        return ticks[:count]

    replace(axis, method, get_ticks)


def _alike(first: Tick) -> Tick:
    """Return a copy of a tick with lines and texts of its own, which share what Matplotlib replaces as a whole."""
    tick = copy(first)
    tick.axes = first.axes  # tells the panel what becomes stale
    for name in PARTS_OF_TICK:
        part = copy(getattr(first, name))
        vars(part).pop(LAYOUT_OF_TEXT, None)
        setattr(tick, name, part)
    for label in (tick.label1, tick.label2):
        label.set_fontproperties(label.get_fontproperties())  # a copy
    return tick


def _estimated(axes: Axes) -> Callable[..., Bbox | None]:
    """A panel's box: the estimated one where a layout asks for the first time, and the measured one from then on."""
    measured, estimates = axes.get_tightbbox, 2 if axes.get_label() == COLORBAR else 1

    def get_tightbbox(*arguments: Any, **options: Any) -> Bbox | None:
        nonlocal estimates
        if estimates and options.get("for_layout_only"):
            estimates -= 1
            return estimated_box(axes)
        return measured(*arguments, **options)

    return get_tightbbox


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
