"""What the axes of pictures call keys of a scene and key figures, with their units."""

from __future__ import annotations

import re
import textwrap

UNITS = {
    "N_per_mm_um": "N/(mm µm)",
    "N_per_mm": "N/mm",
    "arcsec": "arcsec",
    "um": "µm",
    "mm": "mm",
    "deg": "deg",
    "rad": "rad",
    "Nm": "N m",
    "MPa": "MPa",
    "N": "N",
}
"""Ending of a name -> unit as it is printed."""
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
    "transmission_error_mean": "mean transmission error",
    **{f"transmission_error_order_{order}": f"order {order} of the transmission error" for order in (1, 2, 3)},
    "transmission_error_span": "peak-to-peak transmission error",
    "unloaded_transmission_error_span": "peak-to-peak unloaded transmission error",
    "face_load_factor": "face load factor K_Hβ",
    "transverse_load_factor": "transverse load factor K_Hα",
    "nominal_contact_stress_iso_6336": "nominal contact stress σ_H0, ISO 6336",
    "pinion_single_contact_factor_iso_6336": "single contact factor Z_B, ISO 6336",
    "wheel_single_contact_factor_iso_6336": "single contact factor Z_D, ISO 6336",
    "contact_ratio_factor_iso_6336": "contact ratio factor Z_ε, ISO 6336",
    "contact_helix_angle_factor_iso_6336": "helix angle factor Z_β, ISO 6336",
    "single_stiffness_iso_6336": "single stiffness c', ISO 6336",
    "mesh_stiffness_iso_6336": "mean mesh stiffness c_γα, ISO 6336",
    "largest_transverse_load_factor_iso_6336": "upper bound of K_Hα, lower 1, ISO 6336",
    "pinion_rim_thickness_factor_iso_6336": "pinion rim thickness factor Y_B, ISO 6336",
    "wheel_rim_thickness_factor_iso_6336": "wheel rim thickness factor Y_B, ISO 6336",
}
"""Keys and figures whose words alone do not name them."""
PROPER = {"hertz": "Hertz", "iso": "ISO"}
"""Words that are written otherwise than in names."""
SHORT_LINE = 18
"""Characters."""
UNIT = re.compile(f"_({'|'.join(UNITS)})$")


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
    found = UNIT.search(key)
    plain = key[: found.start()] if found else key
    words = [*(section for section in sections if section not in SILENT), plain]
    words = [NAMES.get(word) or word.replace("_", " ") for word in words]
    words = [PROPER.get(word, word) for word in " ".join(words).split()]
    return " ".join(words) + (f" [{UNITS[found[1]]}]" if found else "")


def wrapped_label_of(name: str) -> str:
    """Return ``label_of`` in lines short enough for a narrow panel or a column; units stay whole."""
    words, bracket, unit = label_of(name).partition(" [")
    lines = textwrap.wrap(words + bracket + unit.replace(" ", "\N{NO-BREAK SPACE}"), SHORT_LINE)
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")
