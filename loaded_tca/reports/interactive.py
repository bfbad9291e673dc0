"""Interactive pages of a result and of a study: one HTML file with Plotly within it, which fetches nothing."""

from __future__ import annotations

import html
import json
from dataclasses import dataclass, field
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

from loaded_tca.arguments import checked
from loaded_tca.double_helical import DoubleHelicalResult
from loaded_tca.errors import InputError, require
from loaded_tca.reports import page
from loaded_tca.reports.interactive_result import result_page
from loaded_tca.reports.interactive_study import study_page
from loaded_tca.results.files import STUDY, FilePath, make_directory, replace_file
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.stages import StageResult
from loaded_tca.threads import one_thread

MISSING = (
    "interactive report: needs the package plotly; 'pip install plotly' gets it, as does installing loaded_tca with "
    "its extra 'interactive'"
)
HEIGHT = 900
"""Of a page within a notebook, in pixels."""


@dataclass(frozen=True, eq=False)
class InteractivePage:
    """An interactive page: shown as the last line of a cell of a notebook, or saved as one HTML file.

    Attributes
    ----------
    title : str
    html : str
        The whole page.
    """

    title: str
    html: str = field(repr=False)

    def _repr_html_(self) -> str:
        """The page in a frame of its own, as notebooks show it."""
        title, content = (html.escape(text) for text in (self.title, self.html))
        style = f"width:100%;height:{HEIGHT}px;border:0"
        return f'<iframe title="{title}" style="{style}" srcdoc="{content}"></iframe>'

    @checked
    def save(self, path: FilePath) -> Path:
        """Write the page to a file, whole or not at all.

        Parameters
        ----------
        path : str or path
            Of the file; its directory is made if it does not exist.

        Raises
        ------
        InputError
            If the file cannot be written, which leaves what was there before.
        """
        target = Path(path)
        make_directory(target.parent)
        replace_file(target, self.html.encode())
        return target


@checked
def explore(subject: Any, *, date: str | None = None, rank_by: str | None = None) -> InteractivePage:
    """Return the interactive page of a result or of a study.

    Of a result: sliders over positions and torques, which move the pressure map, the contact on both flanks and in
    space, the line load, and a mark on the curves; the largest pressure over the mesh; root stress; key figures with
    their accuracy, and warnings. Of a study: parallel coordinates and a scatter of keys and figures, with all numbers
    of the variant that is clicked. Everything is within the page, which fetches nothing.

    Parameters
    ----------
    subject : MeshCycle or xarray.Dataset
        A result; a study as :func:`loaded_tca.studies.run_study` returns it.
    date : str, optional
        Of the analysis; default: of results its own, of a study today's.
    rank_by : str, optional
        Figure that colours the variants of a study; default: the peak-to-peak transmission error.

    Returns
    -------
    InteractivePage

    Raises
    ------
    InputError
        If the subject is neither, or no study with that figure; if jinja2 or plotly is not installed.
    """
    page.require_jinja2()
    bundle = _bundle()
    is_study = getattr(subject, "attrs", {}).get("kind") == STUDY
    require((rank_by is None or is_study, f"rank_by: {rank_by!r:.60}; a {type(subject).__name__} has no ranking"))
    with one_thread():  # sums of several threads differ in their last digits each time
        if isinstance(subject, MeshCycle):
            template, content, date = "interactive_result.html.j2", result_page(subject), date or subject.date
        elif is_study:
            template, content = "interactive_study.html.j2", study_page(subject, rank_by)
        else:
            raise InputError(_refusal(subject))
    data = json.dumps(content.pop("data"), allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    content["data"] = data.replace("<", "\\u003c")  # no markup, whatever titles and names say
    about = {"version": version("loaded_tca"), "date": page.shown_date(date), "bundle": bundle}
    return InteractivePage(content["title"], page.render(template, **about, **content))


def _refusal(subject: Any) -> str:
    """Why something has no interactive page, and what of it has one."""
    text = f"interactive report: found a {type(subject).__name__}; allowed a result or a study"
    if isinstance(subject, StageResult | DoubleHelicalResult):
        text += f"; its parts {' and '.join(subject.PARTS.values())} beside its file have such pages"
    return text


def _bundle() -> str:
    """Plotly's script, as its package has it; InputError if that is not installed."""
    try:
        return files("plotly").joinpath("package_data", "plotly.min.js").read_text(encoding="utf-8")
    except (ModuleNotFoundError, FileNotFoundError):
        raise InputError(MISSING) from None
