"""What the report of a double helical pair tells."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

from loaded_tca.output.double_helical_overview import geometry_of_halves, held_in_words, pair_rows
from loaded_tca.plots import DOUBLE_HELICAL_CAPTIONS, double_helical_figures
from loaded_tca.plots.style import label_of
from loaded_tca.reports.page import parts_of, pictures_of, tables_of
from loaded_tca.reports.rating_page import halves_rating_content
from loaded_tca.reports.result_page import MOST_TORQUES, explained, figures_table

if TYPE_CHECKING:
    from loaded_tca.double_helical import DoubleHelicalResult
    from loaded_tca.scene.double_helical import DoubleHelicalScene


def double_helical_content(result: DoubleHelicalResult) -> dict[str, Any]:
    """Return what the template of a double helical pair takes.

    Parameters
    ----------
    result : DoubleHelicalResult
    """
    scene = result.scene
    return {
        "title": scene.title or result.TITLE,
        "analysed_by": result.version,
        "held": held_in_words(scene),
        "scope": result.scope,
        **halves_geometry(scene),
        "key_figures": [
            figures_table({name: label_of(name) for name in result.labels()}, result.key_figures()[part])
            for part in parts_of(result.torque.tolist(), MOST_TORQUES)
        ],
        "notes": result.notes(),
        "rating": halves_rating_content(result),
        "files": [*result.parts()],
        "warnings": explained(result.warnings or ()),
        "pictures": pictures_of(double_helical_figures(result), DOUBLE_HELICAL_CAPTIONS, scene.title),
    }


def halves_geometry(scene: DoubleHelicalScene, positions: int | None = None) -> dict[str, Any]:
    """Return what templates take of a scene: what was asked, the geometry of both halves, the text of the file.

    ``positions`` as of :func:`loaded_tca.output.overview.scene_sections`.
    """
    return {
        "asked": tables_of(pair_rows(scene)),
        "geometry": [
            table
            for name, sections, _ in geometry_of_halves(scene, positions)
            for table in tables_of(
                [*chain.from_iterable(sections.values())], f"{name.capitalize()}, z from the groove outwards"
            )
        ],
        "scene_toml": scene.to_toml(),
    }
