"""What the axes of pictures call keys of a scene and key figures, with their units."""

from __future__ import annotations

import textwrap

from loaded_tca.results.figures import FIGURES
from loaded_tca.units import unit_of, without_unit

SILENT = {"pair", "modifications", "mounting", "load", "analysis", "material"}
"""Sections that a name does without: the key says enough."""
NAMES = {
    "in_plane": "axis error in plane",
    "out_of_plane": "axis error out of plane",
    "pinion_axial": "axial displacement of the pinion",
    "wheel_axial": "axial displacement of the wheel",
    "youngs_modulus": "Young's modulus",
    "poisson_ratio": "Poisson's ratio",
    "sample": "number of the variant",
    "tip_relief_start_roll": "tip relief start (roll angle)",
    "root_relief_start_roll": "root relief start (roll angle)",
    **{without_unit(name): declared.axis for name, declared in FIGURES.items() if declared.axis},
}
"""Keys and figures whose words alone do not name them."""
PROPER = {"hertz": "Hertz", "iso": "ISO"}
"""Words that are written otherwise than in names."""
SHORT_LINE = 18
"""Characters."""


def label_of(name: str) -> str:
    """Name of a key of a scene or of a key figure in words, with its unit in brackets.

    Parameters
    ----------
    name : str
        With dots between its sections.

    Returns
    -------
    str

    Examples
    --------
    >>> label_of("pinion.modifications.lead_crowning_um"), label_of("transmission_error_span_um")
    ('pinion lead crowning [µm]', 'peak-to-peak transmission error [µm]')
    """
    *sections, key = name.split(".")
    words = [*(section for section in sections if section not in SILENT), without_unit(key)]
    words = [NAMES.get(word) or word.replace("_", " ") for word in words]
    words = [PROPER.get(word, word) for word in " ".join(words).split()]
    return " ".join(words) + (f" [{unit.replace('um', 'µm')}]" if (unit := unit_of(key)) else "")


def wrapped_label_of(name: str) -> str:
    """Return ``label_of`` in lines short enough for a narrow panel or a column; units stay whole."""
    words, bracket, unit = label_of(name).partition(" [")
    lines = textwrap.wrap(words + bracket + unit.replace(" ", "\N{NO-BREAK SPACE}"), SHORT_LINE)
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")
