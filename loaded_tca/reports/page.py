"""The page of a report: its template, its tables, its pictures as SVG within the page."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from loaded_tca.errors import InputError
from loaded_tca.plain import plain
from loaded_tca.plots.style import NOTE, TITLE, note_of

DOTS_PER_INCH = 160
"""Of what is rasterised within a picture."""
NAME = re.compile(r'(\bid="|url\(#|href="#)([^")]+)')
"""Where an SVG names a part of itself."""
LEFT_OUT = re.compile(r'<metadata>.*?</metadata>|<style[^>]*>.*?</style>|<!--.*?-->| id="image[^"]*"', re.DOTALL)
"""Of an SVG: its metadata; its style, which would hold for the whole page, and which the page has itself; the ids of
images, which nothing uses, and which are alike for equal images."""
SIZE = re.compile(r'<svg [^>]*?viewBox="0 0 ([\d.]+) ([\d.]+)"[^>]*>')
MICRO = re.compile(r"\bum\b")
"""Unit of lengths as files and screens have it."""
UNIT = re.compile(r"\[[^\]]*\]")
MISSING = (
    "report: needs the package jinja2; 'pip install jinja2' gets it, as does installing loaded_tca with its extra "
    "'report'"
)


@dataclass(frozen=True)
class Table:
    """A table of a report.

    Attributes
    ----------
    rows : tuple of tuple of str
        Label and cells of each; blanks in front of a label set it back.
    head : tuple of str
        Above the columns, that of the labels first; repeated on every printed page. Empty: none.
    caption : str
    of_words : bool
        Whether the cells hold words rather than numbers.
    """

    rows: tuple[tuple[str, ...], ...]
    head: tuple[str, ...] = ()
    caption: str = ""
    of_words: bool = False

    @property
    def columns(self) -> int:
        """How many there are, that of the labels included."""
        return max(map(len, (self.head, *self.rows)))


@dataclass(frozen=True)
class Picture:
    """A picture of a report: what it shows, how to read it, and the SVG."""

    title: str
    caption: str
    note: str
    svg: str


def tables_of(rows: Iterable[Sequence[str]], caption: str = "") -> tuple[Table, ...]:
    """Tables of the lines of an overview: one without a label begins the next and names its columns."""
    tables: list[Table] = []
    for row in rows:
        if not row[0] or not tables:
            tables.append(Table((), () if row[0] else tuple(row), "" if tables else caption))
        if row[0]:
            last = tables[-1]
            tables[-1] = Table((*last.rows, tuple(row)), last.head, last.caption)
    return tuple(tables)


def parts_of(columns: Sequence[Any], most: int) -> Iterator[slice]:
    """Even parts of so many columns at most, so that each fits a page."""
    count = -(-len(columns) // most)
    size = -(-len(columns) // max(1, count))
    return (slice(start, start + size) for start in range(0, len(columns), max(1, size)))


def pictures_of(figures: Mapping[str, Figure], captions: Mapping[str, str], scene: str) -> tuple[Picture, ...]:
    """Pictures of figures by their names, with the caption of the name, or of the longest one that it begins with.

    What stands below a figure is told, too, without the title of the scene, which the report has.
    """
    pictures = []
    for name, figure in figures.items():
        known = max((one for one in captions if name.startswith(one)), key=len, default="")
        title = next((text.get_text() for text in figure.texts if text.get_gid() == TITLE), name)
        svg = svg_of(figure, name.replace("_", "-"), title)
        note = note_of(figure).removeprefix(" ".join(scene.split())).removeprefix("; ")
        pictures.append(Picture(title, captions.get(known, ""), note, svg))
    return tuple(pictures)


def svg_of(figure: Figure, prefix: str, title: str) -> str:
    """A figure as SVG for a page, without its title and note, which the page has as text.

    Letters are outlines, which look alike wherever they are shown and printed. All ids begin with the prefix, so that
    pictures of one page do not use each other's parts, and are numbered: matplotlib's own are digests of places to the
    last bit, which the layout does not find alike each time.
    """
    for text in figure.texts:
        if text.get_gid() in (TITLE, NOTE):
            text.set_visible(False)
            text.set_in_layout(False)
    content = io.StringIO()
    with rc_context({"svg.hashsalt": prefix, "svg.fonttype": "path"}):
        nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
        figure.savefig(content, format="svg", dpi=DOTS_PER_INCH, bbox_inches="tight", pad_inches=0.05, metadata=nothing)
    whole = content.getvalue()
    drawing = LEFT_OUT.sub("", whole[whole.index("<svg") :])
    numbers = {name: k for k, name in enumerate(dict.fromkeys(one[2] for one in NAME.finditer(drawing)))}
    drawing = NAME.sub(lambda one: f"{one[1]}{prefix}-{numbers[one[2]]}", drawing)
    words = title.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    about = f'role="img" aria-label="{words}" xmlns="http://www.w3.org/2000/svg"'
    links = 'xmlns:xlink="http://www.w3.org/1999/xlink"'
    size = SIZE.search(drawing)
    assert size
    width, height = float(size[1]), float(size[2])
    shape = (
        f'viewBox="0 0 {plain(width, 6)} {plain(height, 6)}" style="max-width:{plain(width, 6)}pt"'
        + ' class="tall"' * (height > width)
    )
    return f"<svg {about} {links} {shape}>{drawing[size.end() :].strip()}"


def shown_date(date: str | None) -> str:
    """A date as a reader takes it, to the minute; any other text as it is; without one now."""
    date = date or datetime.now(UTC).isoformat(timespec="seconds")
    try:
        when = datetime.fromisoformat(date)
    except ValueError:
        return date
    return f"{when:%Y-%m-%d %H:%M} {when.tzname() or ''}".strip()


def render(template: str, **content: Any) -> str:
    """The page of a template; what is put into it is escaped.

    Raises
    ------
    InputError
        If jinja2 is not installed.
    """
    jinja2 = require_jinja2()
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("loaded_tca.reports"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"code": _code, "whole_units": _whole_units}
    page: str = environment.get_template(template).render(**content)
    return page


def require_jinja2() -> Any:
    """The package jinja2; InputError if it is not installed."""
    try:
        import jinja2
    except ModuleNotFoundError:
        raise InputError(MISSING) from None
    return jinja2


def _whole_units(label: str) -> str:
    """A label whose unit in brackets stays in one line, with µm for the um of files and screens."""
    return UNIT.sub(lambda unit: MICRO.sub("µm", unit[0].replace(" ", "\N{NO-BREAK SPACE}")), label)


def _code(text: str) -> Any:
    """A sentence with its code, which stands in backticks, marked as such."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(text))))
