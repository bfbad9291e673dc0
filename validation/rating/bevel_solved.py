"""Rating of solved bevel and hypoid meshes, from the scene to safeties, against samples 1 and 2 of ISO/TR 10300-30.

Sample 1 is the pair of examples/scenes/rated_spiral_bevel.toml, whose blank follows from ISO 23509: its cones and
thicknesses instead of the printed numbers, Z_NT and Y_NT 1. K_v 1.020, K_Hbeta 1.65 and K_Halpha 1.161 are given as
printed; those of accuracy grade 8 and of the analysis stand beside, without a verdict, as do the roots of the pinion,
whose tool has an edge radius of 0.8 mm in the report and fillets of 0.38 m_mn, 1.22 mm, here (the wheel: 1.2 mm).
Sample 2 is the hypoid pair of examples/scenes/hypoid_13x42.toml: virtual gears and factors of its machine settings.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

from loaded_tca import analyse, read_scene
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.rating.bevel_sheet import bevel_sheet
from loaded_tca.reference import iso10300_2, iso10300_3
from validation.rating.iso_tr_10300_30 import BEVEL, FOUR_DIGITS, HYPOID, SOURCE
from validation.table import Row

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
FIRST, SECOND = "spiral bevel 14/39", "hypoid 13/42"
GIVEN = {
    "rating.dynamic_factor": "given", "operation.dynamic_factor": 1.020, "rating.face_load_factor": 1.65,
    "rating.transverse_load_factor": 1.161, "rating.long_life_factor": 1.0, "rating.life_hours": 1e5,
}  # fmt: skip
COARSE = {"analysis.positions": 5, "analysis.compliance": "contact", "analysis.root_stress": False}
PRINTED = {"sigma_H": (1712.8, 0), "flank_safety": (0.944, 0), "sigma_F": (700.1, 1), "root_safety": (1.328, 1)}
"""Number and gear of it."""
EDGE = 3.5e-3  # Y_Sa of the wheel with an edge radius of 1.22 mm instead of 1.2 mm: 0.3 %


def rows() -> list[Row]:
    """Compare every number: as four digits of the inputs allow, roots of the wheel with their other edge radius."""
    return [*_bevel(), *_hypoid()]


def _bevel() -> list[Row]:
    with noted_accuracy_warnings(given=False):  # contacts reach edges, on which no row depends
        result = analyse(read_scene(SCENES / "rated_spiral_bevel.toml").with_changes(COARSE))
        rating = replace(result, scene=result.scene.with_changes(GIVEN)).rating()
        of_grade = result.rating()
    compared = [_row(FIRST, "sigma_H0 [MPa]", BEVEL.printed["sigma_H0"], float(rating.sigma_H0[0]))]
    compared.append(
        _row(FIRST, "wheel: sigma_F0 [MPa]", BEVEL.printed["sigma_F0"][1], float(rating.sigma_F0[0, 1]), EDGE)
    )
    for name, (printed, gear) in PRINTED.items():
        obtained = float(rating.values(name)[0, gear])
        allowed = EDGE if gear else FOUR_DIGITS
        label = f"{('pinion', 'wheel')[gear]}: {name} of a solved mesh"
        compared.append(_row(FIRST, label, printed, obtained, allowed))
    for name, printed, note in (
        ("K_v", 1.020, "f_pt of grade 8"),
        ("K_Hbeta", 1.65, "analysis beside method C"),
        ("K_Halpha", 1.161, "with K_Hbeta of the analysis"),
    ):
        compared.append(Row(FIRST, SOURCE, name, printed, float(of_grade.values(name)[0]), None, note=note))
    edges = Row(FIRST, SOURCE, "pinion: S_F", 1.385, float(rating.root_safety[0, 0]), None, note="another edge radius")
    return [*compared, edges]


def _hypoid() -> list[Row]:
    sheet = bevel_sheet(read_scene(SCENES / "hypoid_13x42.toml"))
    pair, printed = sheet.pair, HYPOID.printed
    values: dict[str, Any] = {
        "l_bm": pair.contact_lines.lengths[1],
        "rho_rel": pair.relative_radius,
        "Z_M-B": iso10300_2.mid_zone_factor(pair),
        "Z_LS": iso10300_2.load_sharing_factor(pair),
        "Z_Hyp": iso10300_2.hypoid_factor(pair.spiral_angles, pair.contact_line_angle, pair.pressure_angle)[0],
        "Y_BS": iso10300_3.bevel_spiral_angle_factor(pair, sheet.whole_depths),
    }
    return [_row(SECOND, f"{name} of its settings", printed[name], value) for name, value in values.items()]


def _row(case: str, quantity: str, expected: float, obtained: float, allowed: float = FOUR_DIGITS) -> Row:
    return Row(case, SOURCE, quantity, expected, obtained, allowed, "K factors as printed")
