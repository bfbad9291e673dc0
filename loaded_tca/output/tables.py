"""Tables of comparisons, dynamics, sensitivities, studies and stresses below a flank, and files beside them.

- Comparison: key figures as a table, and with the differing keys of the scenes as JSON.
- Dynamics, for programs of rotor and gear dynamics: curves over the pitches, and their Fourier coefficients.
- Sensitivities: all of them in NetCDF-3, those of the key figures in a table.
- Study: every figure of every variant, and the variants in the order of a figure.
- Stresses below a pressure map: all points in NetCDF-3, those below the highest pressure in a table.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from loaded_tca.arguments import checked
from loaded_tca.output.result_files import cell, csv_table, json_text
from loaded_tca.plain import plain
from loaded_tca.results.dynamics import OVER_ORDERS, OVER_PITCH, PARTS
from loaded_tca.results.figures import FIGURES, key_figures
from loaded_tca.results.files import Buffer, FilePath, Part, netcdf_of, replace_together, variables_of
from loaded_tca.results.quantities import MAP_PARTS, QUANTITIES
from loaded_tca.results.summary import known, shown
from loaded_tca.results.tolerances import key_figure_slopes
from loaded_tca.studies.ranking import main_figures, ranking
from loaded_tca.studies.rating import safeties_of, shortfall
from loaded_tca.studies.tables import to_pandas
from loaded_tca.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    import xarray

    from loaded_tca.arrays import Array
    from loaded_tca.flank_maps.vh_check import VHCheck
    from loaded_tca.results import MeshCycle, Revolution
    from loaded_tca.results.comparison import Comparison
    from loaded_tca.results.sensitivities import Sensitivities
    from loaded_tca.results.subsurface import StressBelow

COMPARISON, COMPARISON_DATA = "comparison.csv", "comparison.json"
"""Names of the two files."""


@checked
def write_comparison(
    comparison: Comparison, directory: FilePath, more: Mapping[str, Buffer] = {}, outdated: Iterable[str] = ()
) -> tuple[Path, ...]:
    """Write ``comparison.csv`` and ``comparison.json``, all files or none.

    Parameters
    ----------
    comparison : Comparison
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the same results.
    outdated : iterable of str
        Names of files of an older comparison to remove where this one has none of that name.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    texts = {COMPARISON: _comparison_table(comparison), COMPARISON_DATA: _comparison_json(comparison)}
    contents = {**{name: text.encode() for name, text in texts.items()}, **more}
    return replace_together(directory, contents, {*outdated} - {*contents})


def _comparison_table(comparison: Comparison) -> str:
    """One row per torque and key figure, columns for each result; what is rounding is zero."""
    table = comparison.table().values
    figures = table["figure"]
    columns = {
        head: values if head in ("pinion_torque_Nm", "figure") else [*map(cell, values, figures)]
        for head, values in table.items()
    }
    return csv_table(columns)


def _comparison_json(comparison: Comparison) -> str:
    """Differing keys of the scenes, and the figures of each torque by their names and those of the results."""
    figures, names = comparison.figures, list(comparison.results)
    parts = {name: values.values for name, values in figures.data_vars.items()}

    def told(torque: int, index: int, figure: str) -> dict[str, dict[str, float | None]]:
        rows = {part: zip(names, values[torque, index].tolist(), strict=True) for part, values in parts.items()}
        return {
            str(part): {name: known(value, figure) for name, value in row if part == "value" or name != names[0]}
            for part, row in rows.items()
        }

    content = {
        "compared_with": names[0],
        "titles": {name: result.scene.title for name, result in comparison.results.items()},
        "loaded_tca_versions": {name: result.version for name, result in comparison.results.items()},
        "differing_keys": {
            key: dict(zip(names, values, strict=True)) for key, values in comparison.differing_keys.items()
        },
        "torques": [
            {
                "pinion_torque_Nm": 1e-3 * float(torque),
                "findings": comparison.findings(float(torque)),
                "figures": {
                    figure: told(k, index, figure) for index, figure in enumerate(figures.figure.values.tolist())
                },
            }
            for k, torque in enumerate(comparison.torque)
        ],
    }
    return json_text(content)


DYNAMICS = "dynamics.csv"
"""Name of the first table, where none is given."""


def vh_table(check: VHCheck, keys: tuple[str, str]) -> str:
    """Table of a V-H check: a row for each pair of errors, as CSV; empty: the pattern passes between points.

    Places are those of the picture: lengthwise, and the height on the profile or the diameter.

    Parameters
    ----------
    check : VHCheck
    keys : (str, str)
        Names of the errors V and H, which end in their units.

    Examples
    --------
    >>> from loaded_tca import parse_scene
    >>> from loaded_tca.cli import DEMO_SCENE
    >>> from loaded_tca.flank_maps import vh_check
    >>> pair = parse_scene(DEMO_SCENE.read_text()).pair()
    >>> check = vh_check(lambda v, h: pair, [0.0], [0.0], positions=3, grid=(9, 9))
    >>> vh_table(check, ("v_deg", "h_deg")).splitlines()[0].replace("size_profile_mm,edge_share", "...")
    'v_deg,h_deg,centre_lengthwise_mm,centre_profile_mm,shift_lengthwise_mm,shift_profile_mm,size_lengthwise_mm,...'
    """
    v, h = np.meshgrid(check.v, check.h, indexing="ij")
    columns = {keys[0]: v, keys[1]: h}
    for name, values in (("centre", check.centre), ("shift", check.shift), ("size", check.size)):
        columns |= {f"{name}_lengthwise_mm": values[..., 0], f"{name}_profile_mm": values[..., 1]}
    columns["edge_share"] = check.edge_share
    return csv_table({name: values.ravel().tolist() for name, values in columns.items()})


@checked
def write_dynamics(result: MeshCycle | Revolution, path: FilePath) -> tuple[Path, ...]:
    """Write two tables of a result in SI units for models of gear dynamics, both or none.

    One has a row for each torque and mesh phase, over one pitch or the pitches of a revolution; the other, with
    ``_orders`` at the end of its name, a row for each torque and order of the tooth mesh. Lines that begin with ``#``
    say what the columns are and give what is no table.

    Parameters
    ----------
    result : MeshCycle or Revolution
    path : str or path
        Of the first table, as ``dynamics.csv``; the folder is made if it does not exist.

    Returns
    -------
    tuple of Path
        The two files.

    Raises
    ------
    InputError
        As ``to_dynamics`` of the result, or if they cannot be written.
    """
    dynamics, (first, orders) = result.to_dynamics(), tables_at(Path(path))
    tables = {first.name: _dynamics_table(dynamics, OVER_PITCH), orders.name: _dynamics_table(dynamics, OVER_ORDERS)}
    return replace_together(first.parent, {name: text.encode() for name, text in tables.items()})


def tables_at(first: Path) -> tuple[Path, Path]:
    """Return the files of both tables, given that of the first."""
    return first, first.with_name(f"{first.stem}_orders{first.suffix}")


def _dynamics_table(dynamics: xarray.Dataset, dimensions: tuple[str, str]) -> str:
    """The columns of these two dimensions, below comments on them, on all scalars and on what depends on the torque."""
    of_table = (dimensions[1:], dimensions)
    own = [name for name, (axes, _, _) in PARTS.items() if axes in of_table and name in dynamics.variables]
    columns = [*dimensions, *(name for name in own if name not in dimensions)]
    lines = ["Gear mesh for dynamics, in SI units", *_told(dynamics), "columns:", *_described(dynamics, columns)]
    head = "".join(f"# {line}\n" for line in lines)
    filled = {name: dynamics[name].broadcast_like(dynamics[columns[-1]]).transpose(*dimensions) for name in columns}
    return head + csv_table({name: [_cell(value) for value in one.values.flat] for name, one in filled.items()})


def _told(dynamics: xarray.Dataset) -> Iterator[str]:
    """Title, conventions and scalars; of each torque the contact ratio."""
    yield f"loaded_tca {dynamics.attrs['version']}: {dynamics.attrs['title']}"
    yield from dynamics.attrs["conventions"].splitlines()
    for name, one in dynamics.data_vars.items():
        if not one.dims:
            yield f"{name} = {_cell(one.item())}: {one.attrs['long_name']}"
    ratio = dynamics["loaded_contact_ratio"]
    for torque, value in zip(dynamics["pinion_torque_Nm"].values, ratio.values, strict=True):
        yield f"loaded_contact_ratio = {_cell(value)} under {_cell(torque)} N m: {ratio.attrs['long_name']}"


def _described(dynamics: xarray.Dataset, columns: Sequence[str]) -> Iterator[str]:
    for name in columns:
        yield f"  {name}: {dynamics[name].attrs['long_name']}"


def _cell(value: float | str) -> str:
    """Twelve digits, nothing where unknown; words as they are."""
    if isinstance(value, str):
        return value
    return f"{value:.12g}" if math.isfinite(value) else ""


SENSITIVITY_DATA, SENSITIVITIES = "sensitivities.nc", "sensitivities.csv"
"""Names of the two files."""
APART = 2
"""Blanks between columns, at least: a single one does not part cells where lines go on below themselves."""


@checked
def write_sensitivities(
    sensitivities: Sensitivities, tolerances: Mapping[str, float], directory: FilePath, more: Mapping[str, Buffer] = {}
) -> tuple[Path, ...]:
    """Write ``sensitivities.nc`` and ``sensitivities.csv``, all files or none.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the same sensitivities.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    result = sensitivities.result
    spreads = (
        "key",
        [tolerances[key] for key in sensitivities.keys],
        {"long_name": "standard deviation, in units of the key"},
    )
    texts = {"title": result.scene.title, "scene_toml": result.scene.to_toml(), "version": result.version}
    whole = sensitivities.dataset.assign_coords(tolerance=spreads).assign_attrs(texts)
    return replace_together(
        directory,
        {
            SENSITIVITY_DATA: netcdf_of(whole),
            SENSITIVITIES: sensitivities_csv(sensitivities, tolerances).encode(),
            **more,
        },
    )


def sensitivities_csv(sensitivities: Sensitivities, tolerances: Mapping[str, float]) -> str:
    """Return one row per torque and key: the changes of key figures by a unit of the key, and by its tolerance."""
    ordered = {key: tolerances[key] for key in sensitivities.keys}
    return slopes_csv(sensitivities.result.torque, key_figure_slopes(sensitivities), ordered)


def slopes_csv(torque: Array, slopes: Mapping[str, Array], tolerances: Mapping[str, float]) -> str:
    """Return one row per torque [N mm] and key: changes (torque, key) of key figures per unit and per tolerance."""
    keys, torques = [*tolerances], 1e-3 * torque
    spread = np.array([*tolerances.values()])
    columns: dict[str, list[str]] = {
        "pinion_torque_Nm": [f"{torque:.9g}" for torque in torques for _ in keys],
        "key": [key for _ in torques for key in keys],
        "tolerance": [f"{one:.9g}" for _ in torques for one in spread],
    }
    for name, values in slopes.items():
        columns[f"{name}_per_unit"] = _cells(values)
    for name, values in slopes.items():
        columns[f"{name}_per_tolerance"] = _cells(values * spread)
    return csv_table(columns)


def _cells(values: np.ndarray) -> list[str]:
    """Nine digits, nothing where unknown; small ones are no rounding: they are per unit."""
    return [f"{value:.9g}" if math.isfinite(value) else "" for value in values.ravel()]


def sensitivities_text(sensitivities: Sensitivities, tolerances: Mapping[str, float], torque: int) -> str:
    """Return the changes of the key figures under one torque as text: per unit of each key, and per tolerance.

    Parameters
    ----------
    sensitivities : Sensitivities
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    torque : int
        Index of the torque.
    """
    slopes = {name: values[torque] for name, values in key_figure_slopes(sensitivities).items()}
    heads = [slope.head for name in slopes if (slope := FIGURES[name].slope)]
    title = sensitivities.result.scene.title or "Sensitivities"
    ordered = {key: tolerances[key] for key in sensitivities.keys}
    return slopes_text(title, key_figures(sensitivities.result, torque), heads, slopes, ordered)


def slopes_text(
    title: str,
    figures: Mapping[str, float],
    heads: Sequence[str],
    slopes: Mapping[str, Array],
    tolerances: Mapping[str, float],
) -> str:
    """Return changes of key figures as text: per unit of each key, and per tolerance.

    Parameters
    ----------
    title : str
    figures : mapping of str to float
        Key figures under the torque.
    heads : sequence of str
        Of the columns, one for each figure that has slopes.
    slopes : mapping of str to (key,) array
        By the names of figures.
    tolerances : mapping of str to float
        Standard deviation of every key, in its unit.
    """
    spread = np.array([*tolerances.values()])
    together = [math.sqrt(float(((values * spread) ** 2).sum())) for values in slopes.values()]
    rows: list[tuple[str, list[str]]] = [
        (f"pinion torque {plain(figures['pinion_torque_Nm'], 6)} N m", [*heads]),
        ("", [f"[{unit_of(name) or '-'}]" for name in slopes]),
        ("this result", [shown(figures[name], name) for name in slopes]),
        ("change per unit of", []),
        *((f"  {key}", [_digits(values[k]) for values in slopes.values()]) for k, key in enumerate(tolerances)),
        ("change per tolerance (standard deviation) of", []),
        *(
            (f"  {key} = {plain(one, 6)}", [_digits(values[k] * one) for values in slopes.values()])
            for k, (key, one) in enumerate(tolerances.items())
        ),
        ("  all of them, independent", [_digits(value, sign="") for value in together]),
    ]
    labels = max(len(label) for label, _ in rows)
    width = APART + max(len(cell) for _, cells in rows for cell in cells)
    lines = [f"{label:<{labels}}" + "".join(f"{cell:>{width}}" for cell in cells) for label, cells in rows]
    return "\n".join([title, *(line.rstrip() for line in lines)])


def _digits(value: float, sign: str = "+") -> str:
    """Three digits, a dash where unknown."""
    return plain(value, 3, sign) if math.isfinite(value) else "-"


STUDY, RANKING, SHORTFALL, PICTURES = "study.csv", "ranking.csv", "shortfall.csv", "study_*.png"
"""Names of the files and of the pictures; the third one of studies with safeties."""


def write_study(
    study: xarray.Dataset,
    directory: FilePath,
    more: Mapping[str, Buffer] = {},
    rank_by: str | None = None,
    largest_is_best: bool | None = None,
) -> tuple[Path, ...]:
    """Write ``study.csv`` and ``ranking.csv``, of studies with safeties ``shortfall.csv``, all files or none.

    Parameters
    ----------
    study : xarray.Dataset
        What :func:`loaded_tca.studies.run_study` returns.
    directory : str or path
        Made if it does not exist. Pictures ``study_*.png`` of an earlier study that are not written again are removed.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the study.
    rank_by, largest_is_best
        As for :func:`loaded_tca.studies.rank_variants`.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written, or the study has figures, but not ``rank_by``.
    """
    by = rank_by if main_figures(study) else None  # where all variants were refused there is nothing to rank by
    ranked = ranking(study, by, largest_is_best=largest_is_best).to_csv(index=False)
    contents = {STUDY: study_csv(study).encode(), RANKING: ranked.encode(), **more}
    if safeties_of(study):
        contents[SHORTFALL] = shortfall(study).to_csv(index=False).encode()
    there = {path.name for pattern in (PICTURES, SHORTFALL) for path in Path(directory).glob(pattern)}
    old = there - {*contents}
    return replace_together(directory, contents, old)


def study_csv(study: xarray.Dataset) -> str:
    """Return every figure as CSV, one row per variant and torque, the varied keys first.

    Variants are numbered from 0, as are torques where variants have different ones. Columns of whole numbers, as counts
    are, have no decimals.
    """
    table: str = to_pandas(study).reset_index().to_csv(index=False)
    return table


STRESS_FIELDS, STRESS_TABLE = "subsurface.nc", "subsurface.csv"
"""Names of the two files."""

STRESSES = {
    "sigma_x": "normal stress across the contact, tension positive",
    "sigma_y": "normal stress along the contact, tension positive",
    "sigma_z": "normal stress along the normal, tension positive",
    "tau_xy": "shear stress across, along",
    "tau_xz": "shear stress across, into the body",
    "tau_yz": "shear stress along, into the body",
    "von_mises": "equivalent stress after von Mises",
    "max_shear": "greatest shear stress, half the difference of the outer principal stresses",
}
"""Field of ``SubsurfaceStress`` -> what the file says of it."""


@checked
def write_subsurface(below: StressBelow, directory: FilePath, more: Mapping[str, Buffer] = {}) -> tuple[Path, ...]:
    """Write ``subsurface.nc`` and ``subsurface.csv``, all files or none.

    Parameters
    ----------
    below : StressBelow
    directory : str or path
        Made if it does not exist.
    more : mapping of str to bytes
        Contents of files to write with these, by their names: pictures of the same stresses.

    Returns
    -------
    tuple of Path
        All files.

    Raises
    ------
    InputError
        If they cannot be written.
    """
    import xarray

    one, stress, result = below.pressure_map, below.stress, below.result
    grid = ("depth", "across", "along")
    parts_and_arrays: dict[str, tuple[Part, Any]] = {
        "pinion_torque": (((), "N mm", "pinion torque"), result.torque[below.torque]),
        "pinion_angle": (((), "rad", "angle of the pinion phi1"), result.pinion_angle[below.position]),
        "position": (((), "1", "position of the result, from 1"), below.position + 1),
        "pair": (((), *QUANTITIES["pair"][1:]), below.pair),
        "poisson_ratio": (((), "1", "Poisson's ratio of the body looked at"), stress.poisson_ratio),
        "depth": ((("depth",), "mm", "distance below the flank"), stress.depths),
        **{name: (MAP_PARTS[name], getattr(one, name)) for name in ("x", "y", "pressure")},
        **{name: ((grid, "MPa", text), getattr(stress, name)) for name, text in STRESSES.items()},
    }
    parts, arrays = ({name: entry[k] for name, entry in parts_and_arrays.items()} for k in (0, 1))
    texts = {"title": result.scene.title, "scene_toml": result.scene.to_toml(), "version": result.version}
    fields = xarray.Dataset(variables_of(parts, arrays), attrs={**texts, "gear": below.gear})
    return replace_together(
        directory, {STRESS_FIELDS: netcdf_of(fields), STRESS_TABLE: subsurface_csv(below).encode(), **more}
    )


def subsurface_csv(below: StressBelow) -> str:
    """Return the stresses at each depth below the highest pressure, and the largest of the whole depth; mm, MPa.

    Where the peak is a spike at an edge, the highest pressure is that across the contact point.
    """
    stress = below.stress
    row, column = below.highest_pressure
    columns = {"depth_mm": stress.depths}
    columns |= {f"{name}_MPa": getattr(stress, name)[:, row, column] for name in STRESSES}
    columns |= {f"largest_{name}_MPa": getattr(stress, name).max(axis=(1, 2)) for name in ("von_mises", "max_shear")}
    return csv_table({name: [f"{value:.9g}" for value in values] for name, values in columns.items()})
