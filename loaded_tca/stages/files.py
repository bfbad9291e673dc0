"""Stage files: read, told apart from scenes and studies, their keys described."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from loaded_tca.arguments import checked
from loaded_tca.errors import InputError
from loaded_tca.input_files import read_text
from loaded_tca.scene.key_reference import SectionReference, section_reference
from loaded_tca.scene.parse import LARGEST_FILE, is_table_of_stage, toml_table, with_files_from
from loaded_tca.scene.section import Section

if TYPE_CHECKING:
    from loaded_tca.stages.sections import Stage

# Whether a file is a stage is asked of scenes, too: they need not know the sections of stages.


@checked
def parse_stage(text: str, source: str = "stage", folder: str | os.PathLike[str] | None = ".") -> Stage:
    r"""Make a stage of the text of a stage file.

    Parameters
    ----------
    text : str
        TOML.
    source : str
        What messages call the text.
    folder : str or path, optional
        Where the files of measured flanks lie, or below; None: it may name none.

    Raises
    ------
    InputError
        If the text is not TOML, names a file that lies elsewhere, or with every problem that it holds.

    Examples
    --------
    >>> parse_stage("[stage]\nplanets = 13")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    loaded_tca.errors.InputError: stage.planets: found 13; allowed a whole number from 1 to 12
    ...
    """
    from loaded_tca.stages.sections import stage_from_table

    table = toml_table(text, source)
    if "stage" not in table and ("pinion" in table or "wheel" in table):
        raise InputError(f"{source}: not a stage but the scene of a pair; run it with 'loaded-tca run'")
    if isinstance(table.get("stage"), str):
        raise InputError(f"{source}: not a stage but a study of {table['stage']}; run it with 'loaded-tca study'")
    return stage_from_table(with_files_from(None if folder is None else Path(folder), table))


def is_stage_file(path: str | os.PathLike[str]) -> bool:
    """Whether a file is TOML with a section [stage] and a sun: a stage rather than a scene; False if it is no TOML."""
    try:
        table = toml_table(read_text(path, LARGEST_FILE), os.fspath(path))
    except InputError:
        return False
    return is_table_of_stage(table)


@checked
def read_stage(path: str | os.PathLike[str]) -> Stage:
    """Read a stage file.

    Parameters
    ----------
    path : str or path
        A TOML file in UTF-8. The files that it names lie in its folder, or below.

    Returns
    -------
    Stage

    Raises
    ------
    InputError
        If the file cannot be read, or with every problem that it holds, one per line.

    Examples
    --------
    >>> stage = read_stage("examples/stages/wind_spur.toml")
    >>> stage.teeth, stage.centre_distance
    ((18, 36, 93), 584.0)
    """
    return parse_stage(read_text(path, LARGEST_FILE), source=os.fspath(path), folder=Path(path).parent)


def stage_reference() -> list[SectionReference]:
    """Return the sections that stage files alone have."""
    from loaded_tca.stages.sections import PlanetaryStage, StageGeometry, StageLoad, StageOperation, StageRatingSection

    sections: tuple[tuple[str, type[Section], str], ...] = (
        ("stage", PlanetaryStage, "planets, pins, and how the sun is held"),
        ("pair", StageGeometry, "what all gears have in common"),
        ("load", StageLoad, "what the sun carries: a torque, or the bins of a load spectrum"),
        ("operation", StageOperation, "speed and factors, for rating"),
        ("rating", StageRatingSection, "what is required of the gears, and factors, for rating"),
    )
    return [section_reference(name, section, about, {}) for name, section, about in sections]


def describe_stage_keys() -> str:
    """Return the reference of the sections that stage files alone have, in Markdown: a table each, a row for each key.

    Examples
    --------
    >>> print(describe_stage_keys().splitlines()[4])
    | `type` | "planetary" | `"planetary"` | kind of stage: the ring stands still |
    """
    return "\n".join(line for section in stage_reference() for line in section.in_markdown()).strip() + "\n"
