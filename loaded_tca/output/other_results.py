"""Files of what is no mesh cycle: whole revolutions, stages, tribology, ratings, shafts under load, ease-off."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loaded_tca.arguments import checked
from loaded_tca.output.result_files import csv_table, json_text, known
from loaded_tca.plain import lasting, plain
from loaded_tca.rating.quantities import OF_SPECTRUM
from loaded_tca.rating.spectrum import OfSpectrum
from loaded_tca.results.files import Buffer, FilePath, replace_together
from loaded_tca.results.revolution import orders_table, teeth_table
from loaded_tca.supports import RollingBearing
from loaded_tca.tribology.tribology import slices_table
from loaded_tca.units import MICROMETRES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from loaded_tca.double_helical import DoubleHelicalRating, DoubleHelicalResult, DoubleHelicalRevolution
    from loaded_tca.flank_maps.ease_off_map import EaseOffMap
    from loaded_tca.loaded.shaft_lines import ShaftLine
    from loaded_tca.rating import Rating
    from loaded_tca.results.result import Result
    from loaded_tca.results.revolution import Revolution
    from loaded_tca.stages import StageRating, StageResult
    from loaded_tca.tribology import Tribology

REVOLUTION_FILES = "revolution.nc", "revolution.json", "revolution.csv", "teeth.csv", "orders.csv"
"""Names of the files."""


@checked
def write_revolution(revolution: Revolution, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write a revolution and its tables, all files or none.

    Parameters
    ----------
    revolution : Revolution
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = (
        figures_json(revolution, warnings=revolution.warnings or ()),
        csv_table(revolution.to_table()),
        teeth_csv(revolution),
        orders_csv(revolution),
    )
    contents = [revolution.to_netcdf(), *(text.encode() for text in texts)]
    return replace_together(directory, {**dict(zip(REVOLUTION_FILES, contents, strict=True)), **more})


def figures_json(result: Result, **more: Any) -> str:
    """Return the title, the figures of each torque, null where one is not known, and more of a result as JSON."""
    rows = [{name: known(value, name) for name, value in figures.items()} for figures in result.key_figures()]
    return json_text({"title": result.title, "torques": rows, **more})


def teeth_csv(revolution: Revolution) -> str:
    """Return a row for each torque, gear and tooth: the largest share, force and pressure of the tooth."""
    return csv_table(teeth_table(revolution).values)


def orders_csv(revolution: Revolution) -> str:
    """Return a row for each order of the transmission error: rigid, and under each torque."""
    return csv_table(orders_table(revolution).values)


DATA, TABLE, SLICES = TRIBOLOGY_FILES = "tribology.nc", "tribology.csv", "tribology_slices.csv"
"""Names of the files."""


@checked
def write_tribology(tribology: Tribology, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write ``tribology.nc``, ``tribology.csv`` and ``tribology_slices.csv``, all files or none.

    Parameters
    ----------
    tribology : Tribology
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    contents = tribology.to_netcdf(), csv_table(tribology.to_table()).encode(), slices_csv(tribology).encode()
    return replace_together(directory, {**dict(zip(TRIBOLOGY_FILES, contents, strict=True)), **more})


def slices_csv(tribology: Tribology) -> str:
    """Return a row for each slice of each contact under each torque, at the first speed."""
    return csv_table(slices_table(tribology).values)


RATING_FILES = "rating.json", "rating.csv"
"""Names of the files."""


@checked
def write_rating(
    rating: Rating | StageRating | DoubleHelicalRating,
    directory: FilePath,
    more: Mapping[str, Buffer] = {},
    outdated: Iterable[str] = (),
) -> tuple[Path, ...]:
    """Write ``rating.json`` and ``rating.csv``, all files or none.

    Parameters
    ----------
    rating : Rating, StageRating or DoubleHelicalRating
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.
    outdated : iterable of str
        Names of files of an older rating to remove where this one has none of that name.

    Returns
    -------
    tuple of Path
        All files. A life that does not end is null in JSON and inf in CSV.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    beside = {"spectrum": spectrum_figures(rating)} if isinstance(rating, OfSpectrum) else {}
    text = figures_json(rating, **beside, notes=rating.notes(), warnings=rating.warnings or ())
    contents = text.encode(), csv_table(rating.to_table()).encode()
    files = {**dict(zip(RATING_FILES, contents, strict=True)), **more}
    return replace_together(directory, files, {*outdated} - {*files})


def spectrum_figures(rating: OfSpectrum) -> dict[str, Any]:
    """What all bins do together: hours, and for each kind of failure of each gear its numbers, null where not known.

    Of double helical pairs those of each half, too.
    """
    rows = rating.key_figures()[0]
    together: dict[str, Any] = {
        f"{gear}_{mode}": {
            head: known(rows[f"{gear}_{mode}_{head}"], head)
            for name, number in rating.NUMBERS.items()
            if number.dims == OF_SPECTRUM
            for head in (number.head(name),)
        }
        for gear in rating.MEMBERS
        for mode in rating.modes
    }
    halves: Mapping[str, OfSpectrum] = getattr(rating, "of_halves", {})
    return {
        "required_life_h": rating.life_required,
        "bins": len(rating.torque),
        **together,
        **{f"half_{name}": spectrum_figures(half) for name, half in halves.items()},
    }


@checked
def write_stage(
    result: StageResult, directory: FilePath, more: Mapping[str, Buffer] = {}, outdated: Iterable[str] = ()
) -> tuple[Path, ...]:
    """Write a stage, its figures and its table, all files or none.

    Parameters
    ----------
    result : StageResult
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.
    outdated : iterable of str
        Names of files of an older result to remove, as those of its rating.

    Returns
    -------
    tuple of Path
        ``stage.nc``, ``sun_mesh.nc``, ``ring_mesh.nc``, ``stage.json``, ``stage.csv``, and those of ``more``.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    tables = {"stage.json": stage_json(result).encode(), "stage.csv": csv_table(result.to_table()).encode()}
    return replace_together(directory, {**result.contents(), **tables, **more}, outdated)


def stage_json(result: StageResult) -> str:
    """Return the figures of each torque, phases and orders as JSON, null where a figure is not known."""
    orders = [
        {
            "order": one.order,
            "stage_um": one.stage,
            "one_path_um": one.one_path,
            "cancelled_in_torsion": one.torsion_cancels,
            "cancelled_in_translation": one.translation_cancels,
        }
        for one in result.orders()
    ]
    return figures_json(
        result,
        sun_mesh_phase=result.sun_mesh_phase.tolist(),
        ring_mesh_phase=result.ring_mesh_phase.tolist(),
        orders_under_the_last_torque=orders,
        findings=result.findings(),
        warnings=result.warnings or (),
    )


@checked
def write_double_helical(
    result: DoubleHelicalResult,
    directory: FilePath,
    more: Mapping[str, Buffer] = {},
    outdated: Iterable[str] = (),
) -> tuple[Path, ...]:
    """Write a double helical pair, its figures and its table, all files or none.

    Parameters
    ----------
    result : DoubleHelicalResult
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.
    outdated : iterable of str
        Names of files to remove that an older result has.

    Returns
    -------
    tuple of Path
        ``double_helical.nc``, ``half_a.nc``, ``half_b.nc``, those of both halves under other torques
        (``half_a_under_400_Nm.nc``), ``double_helical.json``, ``double_helical.csv``, and those of ``more``.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    text = figures_json(result, notes=result.notes(), warnings=result.warnings or ())
    table = csv_table(result.to_table())
    files = {"double_helical.json": text.encode(), "double_helical.csv": table.encode()}
    return replace_together(
        directory, {**result.contents(), **files, **more}, {*outdated, *result.outdated(Path(directory))}
    )


@checked
def write_halves_revolution(
    result: DoubleHelicalRevolution, directory: FilePath, more: Mapping[str, Buffer] = {}
) -> tuple[Path, ...]:
    """Write a whole revolution of a double helical pair and its tables, all files or none.

    Parameters
    ----------
    result : DoubleHelicalRevolution
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures.

    Returns
    -------
    tuple of Path
        ``double_helical_revolution.nc``, ``half_a_revolution.nc``, ``half_b_revolution.nc``,
        ``double_helical_revolution.json``, ``double_helical_revolution.csv``, ``double_helical_orders.csv``, and those
        of ``more``.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    orders: dict[str, Any] = {**orders_table(result).values}
    for t, torque in enumerate(result.torque):
        orders[f"axial_motion_at_{plain(1e-3 * torque, 6)}_Nm_um"] = result.axial_spectrum(t).amplitude
    files = {
        "double_helical_revolution.json": figures_json(result, warnings=result.warnings or ()),
        "double_helical_revolution.csv": csv_table(result.to_table()),
        "double_helical_orders.csv": csv_table(orders),
    }
    texts = {name: text.encode() for name, text in files.items()}
    return replace_together(directory, {**result.contents(), **texts, **more})


FORCES = "force_x_N", "force_y_N", "force_z_N", "moment_x_Nm", "moment_y_Nm", "moment_z_Nm"
MOTIONS = "x_um", "y_um", "z_um", "about_x_rad", "about_y_rad", "about_z_rad"
INSIDE = "element_force_N", "element_pressure_MPa", "life_Mrev"
"""Columns of rolling bearings."""


def shaft_csv(lines: Sequence[ShaftLine]) -> str:
    """Return one row per gear, torque and place along its shaft, units in the header."""
    rows = [(line, n) for line in lines for n in range(len(line.places))]
    columns: dict[str, list[Any]] = {
        "gear": [line.gear for line, _ in rows],
        "pinion_torque_Nm": [1e-3 * line.torque for line, _ in rows],
        "axial_mm": [float(line.places[n]) for line, n in rows],
    }
    for k, name in enumerate(MOTIONS):
        columns[name] = [float(line.motions[n, k]) * (1e3 if k < 3 else 1.0) for line, n in rows]
    return csv_table(columns)


def bearings_csv(lines: Sequence[ShaftLine]) -> str:
    """Return one row per gear, torque and bearing: forces and moments on it, axes of the gear's own frame.

    Where a bearing is a rolling one, its largest element force, contact pressure and life stand beside; empty cells of
    linear ones, and of a life without load.
    """
    rows = [(line, n) for line in lines for n in range(len(line.bearing_forces))]
    columns: dict[str, list[Any]] = {
        "gear": [line.gear for line, _ in rows],
        "pinion_torque_Nm": [1e-3 * line.torque for line, _ in rows],
        "bearing": [n for _, n in rows],
        "axial_mm": [line.shaft.bearings[n].at for line, n in rows],
    }
    for k, name in enumerate(FORCES):
        columns[name] = [float(line.bearing_forces[n, k]) * (1.0 if k < 3 else 1e-3) for line, n in rows]
    inside = [rolling_figures(line, n) for line, n in rows]
    if any(inside):
        for name in INSIDE:
            columns[name] = [one.get(name, math.nan) for one in inside]
    return csv_table(columns)


def rolling_figures(line: ShaftLine, place: int) -> dict[str, float]:
    """Largest element force, contact pressure and life of the bearing at a place in the list; nothing of a linear one.

    Parameters
    ----------
    line : ShaftLine
    place : int
    """
    bearing, motion = line.shaft.bearings[place], line.bearing_motions[place]
    if not isinstance(bearing, RollingBearing):
        return {}
    values = float(bearing.element_forces(motion).max()), bearing.largest_pressure(motion), bearing.life(motion)
    return dict(zip(INSIDE, values, strict=True))


AXES_OF_SHAFTS = (
    "forces on the bearings and motions of the shafts, in the axes of each gear's own frame, which does not turn:",
    "z is the axis of the gear, x points to the pitch point; turns are right-handed about these axes",
)


def bearings_text(lines: Sequence[ShaftLine]) -> str:
    """Return forces on the bearings and the motion of the middles of the faces as text.

    Examples
    --------
    >>> from loaded_tca import read_scene
    >>> from loaded_tca.loaded.shaft_lines import shaft_lines
    >>> lines = shaft_lines(read_scene("examples/scenes/helical_on_shafts.toml"))
    >>> bearings_text(lines[:1]).splitlines()[0]
    'pinion under 40 N m'
    """
    text = []
    for line in lines:
        text.append(f"{line.gear} under {plain(1e-3 * line.torque, 6)} N m")
        for n, force in enumerate(line.bearing_forces):
            parts = " | ".join(f"{one:z.1f}" for one in force[:3])
            text.append(f"  bearing {n} at {plain(line.shaft.bearings[n].at, 6)} mm: force x | y | z {parts} N")
            if inside := rolling_figures(line, n):
                largest, pressure, life = inside.values()
                words = "no load" if math.isinf(life) else f"life {lasting(life)} million revolutions"
                text.append(f"    largest element force {largest:z.1f} N, pressure {pressure:z.0f} MPa, {words}")
        at = abs(line.places - line.middle).argmin()
        x, y, z, about_x, about_y, about_z = line.motions[at].tolist()
        text.append(f"  middle of the face: x | y | z {1e3 * x:z.2f} | {1e3 * y:z.2f} | {1e3 * z:z.2f} um")
        turns = " | ".join(f"{1e6 * one:z.1f}" for one in (about_x, about_y, about_z))
        text.append(f"    about x | y | z {turns} urad")
    return "\n".join([*text, *AXES_OF_SHAFTS])


def ease_off_csv(ease_off: EaseOffMap) -> str:
    """Return the ease-off of a flank as CSV, a row for each point of its grid, lengthwise first."""
    columns = {f"{name}_mm": getattr(ease_off, name) for name in ("radius", "axial", "lengthwise", "profile")}
    columns["ease_off_um"] = MICROMETRES * ease_off.ease_off
    columns["mating_gear_reaches"] = ease_off.covered.astype(int)
    return csv_table({name: values.ravel().tolist() for name, values in columns.items()})
