"""The reference of results in Markdown, of what is declared of their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from loaded_tca.double_helical import DoubleHelicalResult, DoubleHelicalRevolution
from loaded_tca.rating.quantities import NUMBERS as RATING_NUMBERS
from loaded_tca.rating.quantities import SPECTRUM_NUMBERS
from loaded_tca.results.declared import PAIRS, Number
from loaded_tca.results.quantities import (
    CYCLE_NUMBERS,
    MAP_LOADS,
    MAP_PARTS,
    OF_A_HALF,
    OF_RACKS,
    OF_SUPPORTS,
    PATH_PARTS,
    QUANTITIES,
    ROOT_STRESS,
)
from loaded_tca.results.revolution import REVOLUTION_QUANTITIES
from loaded_tca.scene.double_helical import HALVES
from loaded_tca.stages import StageResult
from loaded_tca.stages.rating import STAGE_RATING_NUMBERS, STAGE_SPECTRUM_NUMBERS
from loaded_tca.tribology.quantities import NUMBERS, TORQUE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from loaded_tca.results.files import Part


def describe_results() -> str:
    """Return the reference of all kinds of results in Markdown: tables for datasets, paths and maps.

    Examples
    --------
    >>> print(describe_results().splitlines()[4])
    | `torque` | (torque) | N mm | pinion torque | `pinion_torque_Nm` |
    """
    of_all = {name: CYCLE_NUMBERS[name] for name in QUANTITIES}
    of_turns = {name: number for name, number in REVOLUTION_QUANTITIES.items() if name not in OF_SUPPORTS}
    sections: dict[str, list[str]] = {
        "The result and `result.dataset`": _numbers(of_all, of_contacts=True),
        "Supports, where the scene has them": _numbers(OF_SUPPORTS),
        "Root stress, where the scene asks for it": _numbers(ROOT_STRESS),
        "Along a rack": _numbers(OF_RACKS),
        "Halves of a double helical pair": _numbers(OF_A_HALF),
        "`result.path` and `result.paths[pair]`: the unloaded contact": _parts(PATH_PARTS),
        "`result.maps[torque][position][pair]`: one pressure map": _parts(MAP_PARTS | MAP_LOADS),
        "Whole revolutions; on supports those of above, too": _numbers(of_turns),
        "Planetary stages": _numbers(StageResult.NUMBERS),
        "Double helical pairs; axial directions are those of half a": _numbers(DoubleHelicalResult.NUMBERS),
        "Whole revolutions of double helical pairs": _numbers(DoubleHelicalRevolution.NUMBERS),
        "Tribology; of several speeds most with an axis `speed`": _numbers(NUMBERS, of_torques=True),
        "Rating": _numbers(RATING_NUMBERS, of_torques=True),
        "Rating under a load spectrum, beside or in the place of these": _numbers(
            {name: number for name, number in SPECTRUM_NUMBERS.items() if RATING_NUMBERS.get(name) is not number},
            of_torques=True,
        ),
        "Rating of planetary stages: gears are sun, planet and ring": _numbers(STAGE_RATING_NUMBERS, of_torques=True),
        "Rating of planetary stages under a load spectrum, beside or in the place of these": _numbers(
            {
                name: number
                for name, number in STAGE_SPECTRUM_NUMBERS.items()
                if STAGE_RATING_NUMBERS.get(name) is not number
            },
            of_torques=True,
        ),
    }
    return "\n".join("\n".join([f"### {title}", "", *lines, ""]) for title, lines in sections.items())


def _parts(parts: Mapping[str, Part], heads: Mapping[str, str] | None = None) -> list[str]:
    """A table of arrays, with their columns in tables where there are any."""
    titles = ["name", "axes", "unit", "what it is", *(["in the tables"] if heads else [])]
    rows = [titles, ["---"] * len(titles)]
    for name, (axes, unit, text) in parts.items():
        cells = [f"`{name}`", f"({', '.join(axes)})" if axes else "", "-" if unit == "1" else unit, text]
        rows.append([*cells, *([heads[name]] if heads else [])])
    return [f"| {' | '.join(cells)} |" for cells in rows]


def _numbers(numbers: Mapping[str, Number], *, of_contacts: bool = False, of_torques: bool = False) -> list[str]:
    """A table of numbers, with their columns in tables of positions, of contacts beside, or of torques instead."""
    heads = {}
    for name, number in numbers.items():
        some = () if of_torques else number.heads(name)
        alone = number.dims == TORQUE if of_torques else of_contacts and number.dims in (PAIRS, PAIRS[-1:])
        heads[name] = ", ".join(
            f"`{head}`" for head in _filled((*([number.head(name)] if alone else []), *some), number)
        )
    return _parts(numbers, heads)


def _filled(heads: tuple[str, ...], number: Number) -> Iterator[str]:
    """Heads, those of several columns with the first names or numbers along their axis."""
    labels: dict[str, tuple[object, ...]] = {
        "gear": ("pinion", "wheel"),
        "axis": ("x", "y"),
        "half": HALVES,
    }
    for head in dict.fromkeys(heads):
        if "{" not in head:
            yield head
            continue
        yield from (head.format(label) for label in labels.get(number.dims[-1], (0, 1)))
        yield from () if number.dims[-1] in labels else ["..."]
