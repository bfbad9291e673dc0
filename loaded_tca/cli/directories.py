"""What a directory holds of earlier commands: what does not fit beside a new result, and what is of an old one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from contextlib import suppress
from pathlib import Path

from loaded_tca.errors import InputError

PART = re.compile(r"(torque_[0-9.e+-]+_Nm|position_\d+|pair_-?\d+|below_wheel)(_(?!$)|$)")
"""Of the name of a directory that a command makes for a part of a result, as ``torque_80_Nm_position_5``."""
JOINED = re.compile(r"(sun|ring)_mesh|half_[ab](_revolution|_under_[0-9.e+-]+_Nm)?")
"""Name of a directory for a result that a stage or a double helical pair joins, as of its file ``half_a.nc``."""


def require_place_of(directory: Path, main: str) -> None:
    """Refuse a directory whose main file is another one: readers of both would take the wrong one, or a mixture.

    Parameters
    ----------
    directory : Path
        Need not exist.
    main : str
        Name of the file that is to be written: that of a result, a revolution, a stage, a pair of halves, a study or a
        comparison.

    Raises
    ------
    InputError
        If the directory has a main file of another name.
    """
    for name, kind in _main_files().items():
        if name != main and (directory / name).exists():
            raise InputError(f"--out {directory}: holds {kind} ({name}); give another directory, or remove it")


def _main_files() -> dict[str, str]:
    """Names of main files, and what each of them holds."""
    from loaded_tca.cli.inputs import DESIGN_FILE, STUDY_FILE
    from loaded_tca.double_helical.result import PAIR_FILE, PAIR_REVOLUTION_FILE
    from loaded_tca.output.result_files import RESULT
    from loaded_tca.output.tables import COMPARISON_DATA
    from loaded_tca.results.revolution import REVOLUTION_FILE
    from loaded_tca.stages.result import STAGE_FILE

    return {
        RESULT: "a result",
        STAGE_FILE: "a stage",
        PAIR_FILE: "a double helical pair",
        REVOLUTION_FILE: "a whole revolution",
        PAIR_REVOLUTION_FILE: "a whole revolution of a double helical pair",
        STUDY_FILE: "a study",
        DESIGN_FILE: "a design",
        COMPARISON_DATA: "a comparison of results",
    }


def names_of_result() -> set[str]:
    """Names of all files that commands write of one result into its directory, but for the result's own."""
    from loaded_tca.output.surface_files import TEETH_FILES
    from loaded_tca.output.tables import (
        DYNAMICS,
        SENSITIVITIES,
        SENSITIVITY_DATA,
        STRESS_FIELDS,
        STRESS_TABLE,
        tables_at,
    )
    from loaded_tca.plots import MORE_PICTURES, PICTURES
    from loaded_tca.plots.sensitivities import SENSITIVITY_PICTURES
    from loaded_tca.plots.tribology import TRIBOLOGY_PICTURES
    from loaded_tca.results.subsurface import NAMES
    from loaded_tca.tribology import Tribology

    tables = *(path.name for path in tables_at(Path(DYNAMICS))), SENSITIVITY_DATA, SENSITIVITIES
    pictures = *PICTURES, *MORE_PICTURES, *SENSITIVITY_PICTURES, *TRIBOLOGY_PICTURES
    pictures += "teeth", *(f"subsurface_{quantity}" for quantity in NAMES)
    others = "at_a_glance.pdf", REPORT, INTERACTIVE_REPORT, STRESS_FIELDS, STRESS_TABLE
    evaluated = *Tribology.file_names(), *files_of_ratings()
    return {*tables, *evaluated, *TEETH_FILES, *others, *(f"{name}.png" for name in pictures)}


def files_beside_revolution() -> set[str]:
    """Names of all files that commands write beside a whole revolution, of a pair or of a double helical one."""
    from loaded_tca.output.tables import DYNAMICS, tables_at
    from loaded_tca.plots.double_helical import HALVES_REVOLUTION_PICTURES
    from loaded_tca.plots.revolution import REVOLUTION_PICTURES

    tables = (path.name for path in tables_at(Path(DYNAMICS)))
    return {REPORT, *tables, *(f"{name}.png" for name in (*REVOLUTION_PICTURES, *HALVES_REVOLUTION_PICTURES))}


def files_beside_joined() -> set[str]:
    """Names of all files that commands write beside the result of a stage or of a double helical pair."""
    from loaded_tca.output.tables import SENSITIVITIES
    from loaded_tca.plots import DOUBLE_HELICAL_PICTURES, STAGE_PICTURES

    pictures = (f"{name}.png" for name in (*STAGE_PICTURES, *DOUBLE_HELICAL_PICTURES))
    return {REPORT, SENSITIVITIES, *files_of_ratings(), *pictures}


def files_of_ratings() -> tuple[str, ...]:
    """Names of all files that a rating of a pair, of a stage or of a double helical pair may have."""
    from loaded_tca.plots import HALVES_RATING_PICTURES, RATING_PICTURES
    from loaded_tca.rating import Rating

    return *Rating.file_names(), *(f"{name}.png" for name in (*RATING_PICTURES, *HALVES_RATING_PICTURES))


REPORT, INTERACTIVE_REPORT = "report.html", "interactive.html"
"""Names of the reports of a result, where no other is asked for."""


def outdated_files(directory: Path, names: AbstractSet[str] | None = None) -> list[str]:
    """Files that a new result makes outdated, by their paths from its directory; none of another name.

    Parameters
    ----------
    directory : Path
        Of the new result; need not exist.
    names : set of str, optional
        Of files beside the result; default: those of a mesh cycle.
    """
    of_parts = names_of_result() | files_beside_revolution()
    places = {directory: names_of_result() if names is None else names}
    places |= dict.fromkeys(_parts_of(directory), of_parts)
    files = [place / name for place, of_place in places.items() for name in sorted(of_place)]
    return [str(file.relative_to(directory)) for file in files if file.is_file()]


def remove_empty_parts(directory: Path) -> None:
    """Remove the directories of parts of a result that have nothing in them."""
    for part in [*_parts_of(directory)][::-1]:  # those within a part before it
        with suppress(OSError):  # not empty: there is something of the user's
            part.rmdir()


def _parts_of(directory: Path) -> Iterator[Path]:
    """Directories of parts of a result and of these parts, but for those that have results of their own.

    Commands name them by :func:`loaded_tca.cli.inputs.directory_of_part`.
    """
    if directory.is_dir():
        for one in sorted(directory.iterdir()):
            is_part = JOINED.fullmatch(one.name) or not PART.sub("", one.name)
            if is_part and one.is_dir() and not any((one / name).exists() for name in _main_files()):
                yield one
                yield from _parts_of(one)
