"""Overviews of scenes and stages as JSON: the numbers of the table, by names with units."""

import json
import re
from pathlib import Path

import pytest

from loaded_tca.output.overview import spectrum_rows
from loaded_tca.output.overview_text import Overview, as_name
from loaded_tca.scene import Load, read_scene
from loaded_tca.scene.load import LoadCase

EXAMPLES = Path(__file__).parents[2] / "examples"
SPUR = EXAMPLES / "scenes" / "spur.toml"


def overview(**sections):
    return Overview("Pair", sections, {}, {"seconds": "2.5"}, ("analysis [s]", "2.5"), (), ["w"], ["n"])


def test_lines_are_values_lists_and_objects_of_their_columns():
    rows = [("a [mm]", "1.5"), ("b", "3", "-", "inf"), ("", "pinion", "wheel"), ("c", "1", "on"), ("d [um]", "7")]
    data = json.loads(overview(geometry=rows).to_json(files=["x"]))
    assert data == {
        "title": "Pair",
        "geometry": {"a_mm": 1.5, "b": [3, None, "inf"], "c": {"pinion": 1, "wheel": "on"}, "d_um": 7},
        "analysis": {"seconds": 2.5},
        "sentences": [],
        "warnings": ["w"],
        "notes": ["n"],
        "files": ["x"],
    }


def test_indented_lines_have_the_name_of_the_line_above():
    rows = [(f"bearing {k}: force [N]", f"{k}.0") for k in (1, 2)]
    rows = [rows[0], ("  life [h]", "3.0"), rows[1], ("  life [h]", "4.0")]
    data = json.loads(overview(bearings=rows).to_json())["bearings"]
    names = ["bearing_1_force_N", "bearing_1_force_life_h", "bearing_2_force_N", "bearing_2_force_life_h"]
    assert (list(data), list(data.values())) == (names, [1.0, 3.0, 2.0, 4.0])


def leaves(value):
    inside = value.values() if isinstance(value, dict) else value if isinstance(value, list) else None
    return [value] if inside is None else [leaf for each in inside for leaf in leaves(each)]


@pytest.mark.quick_cases("scenes/spur.toml")
@pytest.mark.parametrize("file", ["scenes/spur.toml", "stages/wind_spur.toml", "scenes/double_helical.toml"])
def test_check_writes_the_table_as_json_alone(run, file):
    """Each number of the table is there, none under a name that another one has."""
    code, out, _ = run("check", EXAMPLES / file, "--json", "--quiet")
    table = run("check", EXAMPLES / file)[1]
    data = json.loads(out)
    values = leaves(data)
    numbers = [value for value in values if isinstance(value, int | float)]
    lines = [line for line in table.splitlines() if not line.startswith("analysis")]  # it is another each time
    cells = [cell for line in lines for cell in re.split(r"\s{2,}", line)[1:]]
    shown = [cell for cell in cells if re.fullmatch(r"-?\d+(\.\d+)?", cell)]
    assert (code, data["title"], len(shown) > 20) == (0, table.splitlines()[0], True)
    for cell in shown:  # of the table the digits, of JSON all
        rounding = 0.5 * 10.0 ** -len(cell.partition(".")[2]) * (1.0 + 1e-9)
        assert min(abs(float(cell) - number) for number in numbers) <= rounding


def test_numbers_of_a_pair_have_their_units_in_their_names(run):
    data = json.loads(run("check", SPUR, "--json")[1])
    scene = read_scene(SPUR)
    distance = scene.mesh().working_centre_distance
    assert data["geometry"]["working_centre_distance_a_w_mm"] == distance  # exact: all digits
    assert data["load_and_analysis"]["pinion_torque_N_m"] == pytest.approx(1e-3 * scene.torques[0])
    assert {"from_T1_mm", "roll_deg", "diameter_mm"} == set(data["path_of_contact"]["A_ISO_21771"])


def test_cells_of_a_line_have_the_names_that_the_line_gives_them(run):
    """As a program reads them: no list without names, no count in a name, no two numbers in a text."""
    data = json.loads(run("check", EXAMPLES / "scenes" / "rated_spectrum.toml", "--json")[1])
    load, mesh = data["load_and_analysis"], read_scene(EXAMPLES / "scenes" / "rated_spectrum.toml").mesh()
    assert load["pinion_torques_N_m"] == {"least": 50, "largest": 840}
    assert load["count"] == {"positions": 11, "torques": 12}
    span = data["geometry"]["span"]["pinion"]
    assert span == {"W_k_mm": mesh.pinion.span_measurement(span["k"]), "k": mesh.pinion.span_teeth}
    assert {"c_prime", "c_gamma_alpha"} == set(data["ISO_6336"]["stiffness_N_per_mm_um"])
    assert data["strength_and_rating"]["required"] == {"S_H": 1.1, "S_F": 1.4, "life_h": 20000}


def test_warnings_of_a_scene_are_in_its_json(run):
    changes = ("--set", "pinion.face_width_mm=0.5", "--set", "wheel.face_width_mm=0.5")
    code, out, errors = run("check", SPUR, "--json", *changes)
    lines = run("check", SPUR, *changes)[1].splitlines()
    told = [line.removeprefix("warning: ") for line in lines if line.startswith("warning: ")]
    assert (code, errors, json.loads(out)["warnings"]) == (0, [], told)
    assert told


def test_units_of_labels_end_names():
    assert as_name("misalignment F_beta, [um]") == "misalignment_F_beta_um"


def test_spectrum_shows_its_bins_those_that_are_reversed_and_their_hours():
    case, other = (LoadCase(pinion_torque_Nm=50.0, hours=hours, reversed=hours > 2.0) for hours in (1.5, 4.0))
    rows = dict(spectrum_rows(Load(case=(case, other, case, other))))
    assert [*rows.values()] == ["4", "bins 2, 4 of 4", "11"]
    assert dict(spectrum_rows(Load(case=(case, other))))["bins that are reversed"] == "bin 2 of 2"
    assert dict(spectrum_rows(Load(case=(case, case))))["bins that are reversed"] == "none"
    assert not [*spectrum_rows(Load(pinion_torque_Nm=50.0))]
