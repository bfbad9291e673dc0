"""Key figures of ISO 6336-1 and -2 beside computed ones, and why these differ."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from loaded_tca.scene import Scene

STRESS = "nominal_contact_stress_iso_6336_MPa"
SINGLE_CONTACT = "pinion_single_contact_factor_iso_6336", "wheel_single_contact_factor_iso_6336"
CONTACT_RATIO, HELIX_ANGLE = "contact_ratio_factor_iso_6336", "contact_helix_angle_factor_iso_6336"
SINGLE_STIFFNESS, MESH_STIFFNESS = "single_stiffness_iso_6336_N_per_mm_um", "mesh_stiffness_iso_6336_N_per_mm_um"
TRANSVERSE_LOAD = "largest_transverse_load_factor_iso_6336"

STRESS_ROWS = (
    ("ISO 6336-2: sigma_H0 at the pitch point [MPa]", (STRESS,)),
    ("  times Z_B | Z_D; in it Z_eps | Z_beta", (*SINGLE_CONTACT, CONTACT_RATIO, HELIX_ANGLE)),
)
STIFFNESS_ROW = "  ISO 6336-1: c' | c_gamma_alpha [N/(mm um)]", (SINGLE_STIFFNESS, MESH_STIFFNESS)
LOAD_ROW = "  ISO 6336-1: K_Halpha from 1 to", (TRANSVERSE_LOAD,)
"""Labels of lines of a summary, and their key figures."""

AXES = {
    STRESS: "nominal contact stress σ_H0, ISO 6336",
    SINGLE_CONTACT[0]: "single contact factor Z_B, ISO 6336",
    SINGLE_CONTACT[1]: "single contact factor Z_D, ISO 6336",
    CONTACT_RATIO: "contact ratio factor Z_ε, ISO 6336",
    HELIX_ANGLE: "helix angle factor Z_β, ISO 6336",
    SINGLE_STIFFNESS: "single stiffness c', ISO 6336",
    MESH_STIFFNESS: "mean mesh stiffness c_γα, ISO 6336",
    TRANSVERSE_LOAD: "upper bound of K_Hα, lower 1, ISO 6336",
}
"""Key figure -> its label on axes, in the order of tables and files."""

REASONS: Mapping[str, str] = {
    STRESS: "sigma_H0 is the pressure of Hertz at the pitch point under an even load; the peak pressure has the load "
    "as pairs and face share it, and the curvature where it acts",
    SINGLE_CONTACT[0]: "Z_B and Z_D are for the curvature where single contact begins, under the whole load; computed "
    "teeth that bend hand it over gradually",
    CONTACT_RATIO: "Z_eps stands for an even load on contact lines of mean length; computed contacts have the load and "
    "the length of their position",
    HELIX_ANGLE: "Z_beta = 1/sqrt(cos(beta)) is fitted to tests of helical gears; computed contacts lie askew on their "
    "flanks",
    SINGLE_STIFFNESS: "c' is the largest stiffness of one tooth pair, measured on solid steel discs above 100 N/mm; "
    "computed teeth have the fillets, bores and load of these gears",
    MESH_STIFFNESS: "c_gamma_alpha is c' (0.75 eps_alpha + 0.25), without body torsion; the computed mesh stiffness "
    "depends on load and bores, and bodies of helical gears tilt",
    TRANSVERSE_LOAD: "K_Halpha may lie outside 1 to its upper bound: it is over the mean length of all contact lines, "
    "eps_alpha b/cos(beta_b), that of ISO 6336-1 over b/(Z_eps^2 cos(beta_b)), and the load along a line is uneven",
}
"""Key figure -> why the computed number beside it differs; that of Z_B holds for Z_D, too."""
WHERE_REASONS_ARE = "ISO 6336: computed numbers differ from the standard's, loaded-tca check and the report say why"
"""The line of a summary that has numbers of the standard."""


def iso_figures(scene: Scene, torque: float, transverse_load_factor: float = math.nan) -> dict[str, float]:
    """Return the key figures of ISO 6336-1 and -2; NaN: the standard has none.

    Parameters
    ----------
    scene : Scene
    torque : float [N mm]
        Of the pinion.
    transverse_load_factor : float
        K_Halpha as computed; its bound is given only beside it.
    """
    standard = scene.contact_standard
    bound = standard.largest_transverse_load_factor
    return {
        STRESS: standard.stress_per_root_torque * math.sqrt(torque),
        **dict(zip(SINGLE_CONTACT, standard.single_contact, strict=True)),
        CONTACT_RATIO: standard.contact_ratio,
        HELIX_ANGLE: standard.helix_angle,
        SINGLE_STIFFNESS: standard.single_stiffness,
        MESH_STIFFNESS: standard.mesh_stiffness,
        TRANSVERSE_LOAD: math.nan if math.isnan(transverse_load_factor) else bound,
    }


def reasons_beside(*figures: Mapping[str, float]) -> Iterator[str]:
    """Yield why computed numbers differ from those of the standard that some figures have."""
    for name, reason in REASONS.items():
        if any(math.isfinite(entry.get(name, math.nan)) for entry in figures):
            yield reason
