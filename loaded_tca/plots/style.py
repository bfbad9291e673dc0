"""What all pictures share: colours, titles, how they are saved.

What the axes of pictures call keys of a scene and key figures, with their units.
"""

from __future__ import annotations

import io
import math
import struct
import textwrap
import zlib
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib import colormaps, rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from numpy.typing import NDArray
from PIL import Image

from loaded_tca.arguments import checked
from loaded_tca.arrays import Array, index_checks
from loaded_tca.errors import require
from loaded_tca.flanks.base import FlankFrame
from loaded_tca.input_files import is_place
from loaded_tca.plain import plain, signed
from loaded_tca.plots.layout import estimated_at_first
from loaded_tca.results.figures import FIGURES
from loaded_tca.results.files import FilePath, replace_file
from loaded_tca.results.numbers import CycleNumbers
from loaded_tca.results.summary import shown_torque
from loaded_tca.units import unit_of, without_unit

COLOURS = "viridis"
"""Even in lightness, and told apart by colour-blind readers and in grey."""
ACCENT, NO_MATERIAL, NOT_REACHED = "#d55e00", "0.8", "0.9"
MARKERS = "osD^vP*X"
DISTINCT_COLOURS = "#0072b2", "#d55e00", "#56b4e9", "#cc79a7", "#e69f00", "#009e73"
"""Of tooth pairs and results, in no order: told apart by colour-blind readers (Okabe and Ito)."""
MOST_PANELS = 4
"""Torques with a panel each."""
HERTZ: dict[str, Any] = {"linestyle": "--", "linewidth": 4.0, "alpha": 0.4, "zorder": 1.0}
"""How a curve after Hertz is drawn: broad, below the curve that it is compared with, in the colour of its torque."""
NO_LOAD = "no load, no pressure"
MOST_LABELS = 8
SHORTEST_STRETCH = 3
"""Positions in a row from which a curve after Hertz is drawn: single ones are chance."""
HEADROOM = 0.08
"""Part of an axis above the highest curve."""
CHARACTERS_PER_INCH = 11.5
"""Of a title, at most."""
SHORTEST_LINE = 12
"""Characters of what is said in an empty panel, at least."""
LINE_OF_NOTE = 0.16
"""Height [inch] of a line below a picture."""
PAD_OF_LEGEND = 0.06
"""Above and below a legend [inch]."""
TITLE, NOTE = "title", "note"
"""Group ids by which the title and the lines below a picture are found in a figure."""
DOTS_PER_INCH = 120
LARGEST_PICTURE = 300_000
"""Bytes above which a PNG file has a palette."""
PNG_SIGNATURE, COLOUR_OF_PIXELS, COLOUR_OF_PALETTE, METRES_PER_INCH = b"\x89PNG\r\n\x1a\n", 2, 3, 0.0254
"""Of the format: its first bytes, its types of colour, and its unit of length."""
PACKING = 3
"""Level of compression: of 16 pictures 1 takes 8 % more bytes in 0.85 of the time, 6 takes 10 % less in 2.4 times."""
FAST_TEXT: Any = {"text.hinting": "no_hinting"}
"""Letters as they are, not moved onto pixels: a tenth of the time of a picture, and even spaces."""


@checked
def save_figure(figure: Figure, path: FilePath) -> None:
    """Save a figure as PNG, whole or not at all; InputError if that cannot be done."""
    replace_file(path, png_of(figure))


def png_of(figure: Figure, dots_per_inch: float = DOTS_PER_INCH, largest: int = LARGEST_PICTURE) -> bytes:
    """Return a figure as the content of a PNG file, with a palette if it has more bytes than ``largest``."""
    shown = figure.get_dpi()
    canvas: Any = FigureCanvasAgg(figure)
    figure.set_dpi(dots_per_inch)
    with estimated_at_first(figure), rc_context(FAST_TEXT):
        canvas.draw()  # once: savefig would draw the figure to lay it out, and then again
    figure.set_dpi(shown)
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]  # figures let nothing shine through
    content = _png_content(pixels, dots_per_inch=dots_per_inch)
    if len(content) <= largest:
        return content
    return _png_content(*_with_palette(pixels), dots_per_inch=dots_per_inch)


def pngs_of(figures: Mapping[str, Figure]) -> dict[str, bytes]:
    """PNG files of figures, by their names."""
    return {f"{name}.png": png_of(figure) for name, figure in figures.items()}


def _png_content(
    pixels: NDArray[np.uint8], palette: NDArray[np.uint8] | None = None, *, dots_per_inch: float = DOTS_PER_INCH
) -> bytes:
    """PNG of pixels (m, n, 3), or of their places (m, n) in a palette (256, 3).

    Rows are not filtered: Pillow tries four filters on each, takes three times as long, and letters and curves take as
    many bytes with them as without. One colour after the other is copied to them, in a tenth of the time of all three.
    """
    values = pixels.reshape(*pixels.shape[:2], -1)
    rows, count = np.zeros((len(values), 1 + values[0].size), dtype=np.uint8), values.shape[-1]
    for colour in range(count):
        rows[:, 1 + colour :: count] = values[..., colour]
    kind = COLOUR_OF_PIXELS if palette is None else COLOUR_OF_PALETTE
    dots = round(dots_per_inch / METRES_PER_INCH)
    parts = [
        (b"IHDR", struct.pack(">2I5B", pixels.shape[1], pixels.shape[0], 8, kind, 0, 0, 0)),
        (b"pHYs", struct.pack(">2IB", dots, dots, 1)),
        (b"PLTE", b"" if palette is None else palette.tobytes()),
        (b"IDAT", zlib.compress(rows.data, PACKING)),
        (b"IEND", b""),
    ]
    chunks = [
        struct.pack(">I", len(part)) + name + part + struct.pack(">I", zlib.crc32(part, zlib.crc32(name)))
        for name, part in parts
        if part or name != b"PLTE"
    ]
    return b"".join([PNG_SIGNATURE, *chunks])


def _with_palette(pixels: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Places (m, n) of pixels (m, n, 3) in a palette of their 256 colours, and the palette (256, 3).

    A quarter of the bytes where antialiased lines have tens of thousands of colours. The octree takes a tenth of the
    time of Pillow's median cut, and its colours are nearer: 2 of 255 off in the mean and 35 at most, of 3 and 66. The
    ground, as at the first corner, keeps its colour.
    """
    picture = Image.fromarray(pixels).quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    palette = np.zeros((256, 3), dtype=np.uint8)
    colours = np.array(picture.getpalette(), dtype=np.uint8).reshape(-1, 3)
    palette[: len(colours)] = colours
    places = np.asarray(picture)
    palette[places[0, 0]] = pixels[0, 0]
    return places, palette


def pdf_of(figure: Figure) -> bytes:
    """Return a figure as the content of a PDF file, the same bytes each time."""
    content = io.BytesIO()
    figure.savefig(content, format="pdf", metadata={"CreationDate": None})
    return content.getvalue()


def one_panel(height: float = 5.0) -> tuple[Figure, Axes]:
    """Return a figure of so many inches with one panel for curves over the pinion angle."""
    figure = Figure(figsize=(8.0, height), layout="constrained")
    axes = figure.add_subplot()
    axes.set_xlabel("pinion angle [deg]")
    axes.grid(alpha=0.3)
    return figure, axes


def finished(figure: Figure, axes: Axes, result: CycleNumbers, *about: str, columns: int = 3) -> Figure:
    """Return the figure with the legend of its panel below, if that has labels, and its title."""
    return finished_under(figure, axes, result.scene.title, *about, columns=columns)


def finished_under(figure: Figure, axes: Axes, scene: str, *about: str, columns: int = 3) -> Figure:
    """The same under the title of a scene or a stage."""
    handles, labels = axes.get_legend_handles_labels()
    if labels:
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, fontsize="small")
    write_title(figure, scene, *about)
    return figure


def torque_styles(result: CycleNumbers) -> Iterator[tuple[int, str, str, str]]:
    """Index, label, colour and marker of each torque; of many torques only some have a label."""
    count = len(result.torque)
    every = math.ceil(count / MOST_LABELS)
    for torque in range(count):
        label = torque_label(result, torque) if torque % every == 0 else "_unlabelled"
        yield torque, label, torque_colour(torque, count), MARKERS[torque % len(MARKERS)]


def rising_torques(torques: Array, gear: str = "pinion") -> Iterator[tuple[int, dict[str, Any]]]:
    """Index of each torque [N mm] of a gear, from the smallest on, and how its curve is drawn and called."""
    for torque in np.argsort(torques).tolist():
        yield (
            torque,
            {
                "color": torque_colour(torque, len(torques)),
                "marker": MARKERS[torque % len(MARKERS)],
                "label": f"{gear} torque {shown_torque(torques[torque])}",
            },
        )


def torque_colour(torque: int, count: int) -> str:
    """Colour of one of so many torques."""
    return to_hex(colormaps[COLOURS](0.15 + 0.7 * torque / max(1, count - 1)))


def widen(axes: Axes, smallest: float) -> None:
    """Give the vertical axis a span that does not blow up rounding."""
    low, high = axes.get_ylim()
    if high - low < smallest:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * smallest, middle + 0.5 * smallest)


def from_zero(axes: Axes, part: float = 1.0) -> None:
    """Let the vertical axis begin at zero and end above all curves, whose markers stay whole below a part of it."""
    heights = [np.asarray(line.get_ydata(), dtype=float) for line in axes.lines]
    highest = max((float(np.nanmax(one)) for one in heights if np.isfinite(one).any()), default=0.0)
    if highest > 0.0:
        axes.set_ylim(0.0, (1.0 + HEADROOM) * highest / part)
    else:
        axes.set_ylim(bottom=0.0)


def over_a_stretch(values: Array) -> Array:
    """Values (n,) that stand in a row of three or more, of fewer positions all of them; others NaN."""
    known = np.isfinite(values)
    rows = np.cumsum(np.diff(known, prepend=False) & known) * known  # number of the stretch, from one on
    long = np.bincount(rows) >= min(SHORTEST_STRETCH, len(values))
    return np.where(known & long[rows], values, np.nan)


def tell(axes: Axes, why: str) -> None:
    """Say in a picture why it is empty."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    longest = max(SHORTEST_LINE, int(CHARACTERS_PER_INCH * figure.get_figwidth() * axes.get_position().width))
    axes.text(0.5, 0.65, textwrap.fill(why, longest), transform=axes.transAxes, ha="center", va="center")


def highest_torque(result: CycleNumbers) -> int:
    """Return the index of the largest torque."""
    return int(np.argmax(result.torque))


def torque_or_largest(torques: Array, torque: int | None) -> int:
    """Return the index of a torque among all, by default of the largest; InputError if there is none."""
    require(*index_checks(torque=(torque, len(torques))))
    return int(np.argmax(torques)) if torque is None else torque


def chosen_torque(
    result: CycleNumbers, torque: int | None, position: int | None = None, column: int | None = None
) -> int:
    """Return the index of a torque, by default of the largest; InputError with every index that the result has not."""
    counts = {"position": (position, len(result.path)), "column": (column, len(result.pair))}
    require(*index_checks(torque=(torque, len(result.torque)), **counts))
    return highest_torque(result) if torque is None else torque


def torques_with_panels(result: CycleNumbers) -> list[int]:
    """Return the indices of all torques in ascending order, of many torques four from the least to the largest."""
    order = np.argsort(result.torque, kind="stable")
    spread = np.linspace(0.0, len(order) - 1.0, min(len(order), MOST_PANELS)).round().astype(int)
    return order[np.unique(spread)].tolist()


def torque_label(result: CycleNumbers, torque: int) -> str:
    """Return what legends and panels say of one torque."""
    return f"pinion torque {shown_torque(result.torque[torque])}"


def load(result: CycleNumbers, torque: int) -> str:
    """Return what a title says of one torque, and which of several it is."""
    count = len(result.torque)
    which = "the largest" if torque == highest_torque(result) else f"number {torque + 1}"
    return torque_label(result, torque) + (f" ({which} of {count})" if count > 1 else "")


def loads(result: CycleNumbers, panels: int | None = None) -> str:
    """Return what a title says of all torques, and how many of them have panels where those are fewer."""
    count, low = len(result.torque), shown_torque(result.torque.min()).split()[0]
    if count == 1:
        return load(result, 0)
    left_out = f" ({panels} of {count} shown)" if panels is not None and panels < count else ""
    return f"pinion torques {low} to {shown_torque(result.torque.max())}{left_out}"


def position_label(result: CycleNumbers, position: int, column: int | None = None) -> str:
    """Return what a title says of one position, and of one of several tooth pairs there."""
    several = column is not None and len(result.pair) > 1
    which = f", tooth pair {signed(int(result.pair[column]))}" if several else ""
    angle = _degrees(result.pinion_angle[position])
    return f"position {position + 1} of {len(result.path)}{which}: pinion angle {angle} deg"


def place(result: CycleNumbers, position: int, frame: FlankFrame, column: int) -> tuple[str, str]:
    """Return what a title says of one position, and of a pair's contact point in the frame of the pinion's flank."""
    where = result.paths[column][position]
    return (
        position_label(result, position, column),
        f"unloaded contact point on the pinion: {frame.place(where.pinion_radius, where.pinion_axial)}",
    )


def range_of_positions(result: CycleNumbers) -> str:
    """Return what a title says of all positions."""
    first, last = (_degrees(result.pinion_angle[end]) for end in (0, -1))
    if len(result.path) == 1:
        return f"pinion angle {first} deg"
    return f"{len(result.path)} positions, pinion angle {first} to {last} deg"


def set_title(figure: Figure, result: CycleNumbers, *about: str) -> None:
    """Write what is shown over a picture, and below it the scene and the rest."""
    write_title(figure, result.scene.title, *about)


def write_title(figure: Figure, scene: str, shown: str, *rest: str) -> None:
    """Write what is shown as a title of one line, and below the picture the title of the scene and the rest.

    Of what is longer than a line the last parts, from a comma on, stand below, too. All is taken literally, TeX
    included. To be called once all else is in the figure, which grows by the lines below.
    """
    longest, parts = int(CHARACTERS_PER_INCH * figure.get_figwidth()), shown.split(", ")
    lengths = np.cumsum([len(part) + 2 for part in parts]) - 2
    fitting = max(1, int((lengths <= longest).sum()))
    title = ", ".join(parts[:fitting])
    size = FontProperties(size="medium").get_size_in_points() * min(1.0, longest / max(1, len(title)))
    _write_note(figure, [scene, ", ".join(parts[fitting:]), *rest])
    figure.suptitle(title, fontsize=size, parse_math=False).set_gid(TITLE)


def note_of(figure: Figure) -> str:
    """Return what stands below a picture, in one line."""
    return next((" ".join(text.get_text().split()) for text in figure.texts if text.get_gid() == NOTE), "")


def _write_note(figure: Figure, sentences: Iterable[str]) -> None:
    """Lines below a picture, for which it grows; legends and whatever else is placed below the panels move up."""
    longest = int(1.2 * CHARACTERS_PER_INCH * figure.get_figwidth())
    lines = parts_of("; ".join(filter(None, sentences)), longest)
    width, height = figure.get_size_inches()
    note = LINE_OF_NOTE * len(lines)
    below, rest = note / (height + note), height / (height + note)
    figure.set_size_inches(width, height + note)
    engine: Any = figure.get_layout_engine()
    left, bottom, across, upwards = engine.get()["rect"]
    if bottom == 0.0:  # else there is room for the legend already
        bottom = _height_of_legend(figure) / height
        upwards -= bottom
    engine.set(rect=(left, below + rest * bottom, across, rest * upwards))
    for legend in figure.legends:
        legend.set_bbox_to_anchor((0.0, below, 1.0, rest), figure.transFigure)
    for text in figure.texts:
        text.set_y(below + rest * text.get_position()[1])
    about: dict[str, Any] = {"ha": "center", "va": "bottom", "fontsize": "small", "color": "0.3", "gid": NOTE}
    figure.text(0.5, 0.2 * below, "\n".join(lines), **about, parse_math=False)


def _height_of_legend(figure: Figure) -> float:
    """Inches that the highest legend of a figure takes; the layout leaves none for one that is anchored."""
    canvas: Any = FigureCanvasAgg(figure)
    renderer = canvas.get_renderer()
    heights = [legend.get_window_extent(renderer).height / figure.get_dpi() for legend in figure.legends]
    return max(heights) + 2.0 * PAD_OF_LEGEND if heights else 0.0


def parts_of(line: str, longest: int) -> list[str]:
    """Return a line, or as many of even length as it takes, so that no short end is left over."""
    count = math.ceil(len(line) / longest)
    return textwrap.wrap(line, min(longest, len(line) // max(1, count) + 10))


def _degrees(angle: float) -> str:
    return plain(round(math.degrees(angle), 3))


SILENT = {"pair", "modifications", "mounting", "load", "analysis", "material"}
"""Sections that a name does without: the key says enough."""
NAMES = {
    "in_plane": "axis error in plane",
    "out_of_plane": "axis error out of plane",
    "pinion_axial": "axial displacement of the pinion",
    "wheel_axial": "axial displacement of the wheel",
    "youngs_modulus": "Young's modulus",
    "poisson_ratio": "Poisson's ratio",
    "sample": "number of the variant",
    "tip_relief_start_roll": "tip relief start (roll angle)",
    "root_relief_start_roll": "root relief start (roll angle)",
    **{name: f"safety {name}" for name in ("S_H", "S_F")},
    **{f"{name}_local": f"local safety {name}" for name in ("S_H", "S_F")},
    "life_local": "life by local stresses",
    **{without_unit(name): declared.axis for name, declared in FIGURES.items() if declared.axis},
}
"""Keys and figures whose words alone do not name them."""
PROPER = {"hertz": "Hertz", "iso": "ISO"}
"""Words that are written otherwise than in names."""
SHORT_LINE = 18
"""Characters."""


def label_of(name: str) -> str:
    """Name of a key of a scene or of a key figure in words, with its unit in brackets.

    Parameters
    ----------
    name : str
        With dots between its sections; a number at its end is a place in a list.

    Returns
    -------
    str

    Examples
    --------
    >>> label_of("pinion.modifications.lead_crowning_um"), label_of("transmission_error_span_um")
    ('pinion lead crowning [µm]', 'peak-to-peak transmission error [µm]')
    >>> label_of("stage.pin_tangential_um.0")
    'stage pin tangential 0 [µm]'
    """
    *sections, key = name.split(".")
    place = [key] if is_place(key) and sections else []  # in a list
    key = sections.pop() if place else key
    words = [*(section for section in sections if section not in SILENT), without_unit(key), *place]
    words = [NAMES.get(word) or word.replace("_", " ") for word in words]
    words = [PROPER.get(word, word) for word in " ".join(words).split()]
    return " ".join(words) + (f" [{unit.replace('um', 'µm')}]" if (unit := unit_of(key)) else "")


def wrapped_label_of(name: str) -> str:
    """Return ``label_of`` in lines short enough for a narrow panel or a column; units stay whole."""
    words, bracket, unit = label_of(name).partition(" [")
    lines = textwrap.wrap(words + bracket + unit.replace(" ", "\N{NO-BREAK SPACE}"), SHORT_LINE)
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")
