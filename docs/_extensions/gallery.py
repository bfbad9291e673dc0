"""What sphinx-gallery needs to run the scripts of ``examples/`` without writing into that folder.

The scripts are copied into a working directory and run there, so that their pictures and results land there; they find
their scenes by ``__file__``, which sphinx-gallery leaves undefined and which is that of the original here.
"""

import builtins
import re
import shutil
import warnings
import zipfile
from pathlib import Path

from sphinx_gallery.scrapers import figure_rst

DOCS = Path(__file__).parents[1]
EXAMPLES = DOCS.parent / "examples"
WORKING_DIRECTORY = DOCS / "_build" / "examples"
ARCHIVE = DOCS / "_build" / "loaded_tca_examples.zip"
ARCHIVE_LINK = f":download:`the archive of all examples </_build/{ARCHIVE.name}>`"
ROW = re.compile(r"^\| `(\w+)` \| (.*) \|$", re.MULTILINE)
"""Of a table of the guide: a kind of picture, and what one reads from it."""


def prepare() -> None:
    """Copy the scripts and the heading of the gallery into a new working directory; pack the folder with its scenes."""
    shutil.rmtree(WORKING_DIRECTORY, ignore_errors=True)
    WORKING_DIRECTORY.mkdir(parents=True)
    for path in (*EXAMPLES.glob("*.py"), EXAMPLES / "GALLERY_HEADER.rst"):
        shutil.copy2(path, WORKING_DIRECTORY)
    with zipfile.ZipFile(ARCHIVE, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(
            [*EXAMPLES.glob("*.py"), *(one for one in EXAMPLES.glob("*/*") if one.suffix in (".toml", ".csv", ".rexs"))]
        ):
            archive.write(path, path.relative_to(EXAMPLES.parent))


NOTEBOOKS = {"plot_notebook"}
"""Scripts that are notebooks, too; the others find their scenes by ``__file__``, which notebooks do not have."""


def define_file(configuration: dict[str, object], script: str) -> None:
    """Let ``__file__`` be the original of a script that is about to be run; its warnings show no path."""
    configuration["notebook_extensions"] = {".py"} if Path(script).stem in NOTEBOOKS else set()
    builtins.__file__ = str(EXAMPLES / Path(script).name)
    warnings.formatwarning = lambda message, category, *_: f"{category.__name__}: {message}\n"


WRITTEN = {
    "make_measured_flank": ["measured_flank.csv"],
    "make_measured_lines": ["measured_lines.csv"],
    "plot_measured_settings": ["."],
}
"""Arguments of scripts that write into the folder of scenes otherwise."""


def arguments(_: object, script: dict[str, object]) -> list[str]:
    """Command line of a script: none, but that of the one which writes a file of scenes has a place of its own."""
    return WRITTEN.get(Path(str(script["src_file"])).stem, [])


def collect_pictures(_: object, script: dict[str, object], configuration: dict[str, str]) -> str:
    """Move the pictures that a script has written into the gallery, in this order; of several each with a caption."""
    targets, shown = [], []
    pictures = sorted(WORKING_DIRECTORY.glob("*.png"), key=lambda path: path.stat().st_mtime_ns)
    for picture, target in zip(pictures, script["image_path_iterator"], strict=False):
        shutil.move(picture, target)
        targets.append(target)
        shown.append(f"{figure_rst([target], configuration['src_dir'])}\n{caption_of(picture.stem)}\n")
    return "\n".join(shown) if len(shown) > 1 else figure_rst(targets, configuration["src_dir"])


def caption_of(name: str) -> str:
    """Return what the guide tells to read from a picture, with a link to the function that draws it; else nothing."""
    sentences = dict(ROW.findall((DOCS / "guide" / "pictures.md").read_text(encoding="utf-8")))
    kind = max((one for one in sentences if name.startswith(one)), key=len, default=None)
    return "" if kind is None else f"``{name}``: {sentences[kind]} (:func:`~loaded_tca.plots.plot_{kind}`)\n"
