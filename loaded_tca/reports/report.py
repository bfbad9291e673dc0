"""Reports of results, stages, studies and designs as one HTML file that needs nothing else."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from loaded_tca.errors import InputError, require
from loaded_tca.reports import page
from loaded_tca.reports.result_page import result_content
from loaded_tca.reports.stage_page import stage_content
from loaded_tca.reports.study_page import design_content, study_content
from loaded_tca.results.files import STUDY, FilePath, make_directory, replace_file
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.stages import StageResult
from loaded_tca.studies.design import DesignResult
from loaded_tca.threads import one_thread


def write_html_report(subject: Any, path: FilePath, *, date: str | None = None, rank_by: str | None = None) -> Path:
    """Write the report of a result, a stage, a study or a design: one HTML file with pictures, which needs no other.

    It tells what was asked, the geometry, the load cases, the key figures with their units and how accurate they are,
    every accuracy warning with its meaning, and the scene file. It prints on A4. The same subject and date give the
    same file.

    Parameters
    ----------
    subject : MeshCycle, StageResult, xarray.Dataset or DesignResult
        A result; a planetary stage; a study as :func:`loaded_tca.studies.run_study` returns it; a design.
    path : str or path
        Of the file; its directory is made if it does not exist.
    date : str, optional
        Of the analysis; default: of a result and of a stage its own, of a study or design today's.
    rank_by : str, optional
        Figure that ranks the variants of a study, the least is best; default: the peak-to-peak transmission error.
        Where the study has distributions, combinations of its other values are ranked, by the 95 % quantile over their
        samples.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InputError
        If the subject is none of these, or no study with the figure that is to rank it; if jinja2 is not installed, or
        the file cannot be written, which leaves what was there before.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from loaded_tca import analyse, read_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> alone = {"load_sharing": False, "compliance": "contact", "positions": 1, "torques_Nm": None}
    >>> scene = read_scene(DEMO_SCENE).with_changes({f"analysis.{key}": value for key, value in alone.items()})
    >>> with TemporaryDirectory() as directory:
    ...     write_html_report(analyse(scene), Path(directory, "report.html")).name
    'report.html'
    """
    page.require_jinja2()
    is_study = getattr(subject, "attrs", {}).get("kind") == STUDY
    require((rank_by is None or is_study, f"rank_by: {rank_by!r:.60}; a {type(subject).__name__} has no ranking"))
    with one_thread():  # sums of several threads differ in their last digits each time
        if isinstance(subject, MeshCycle):
            template, content = "result.html.j2", result_content(subject)
            date = date or subject.date
        elif isinstance(subject, DesignResult):
            template, content = "design.html.j2", design_content(subject)
        elif isinstance(subject, StageResult):
            template, content = "stage.html.j2", stage_content(subject)
            date = date or str(subject.dataset.attrs.get("date", ""))
        elif is_study:
            template, content = "study.html.j2", study_content(subject, rank_by)
        else:
            raise InputError(
                f"report: found a {type(subject).__name__}; allowed a result, a stage, a study or a design"
            )
    content = {"version": version("loaded_tca"), **content}
    content["date"] = _shown(date or datetime.now(UTC).isoformat(timespec="seconds"))
    text = page.render(template, **content)
    target = Path(path)
    make_directory(target.parent)
    replace_file(target, text.encode())
    return target


def _shown(date: str) -> str:
    """A date as a reader takes it: to the minute; any other text as it is."""
    try:
        when = datetime.fromisoformat(date)
    except ValueError:
        return date
    return f"{when:%Y-%m-%d %H:%M} {when.tzname() or ''}".strip()
