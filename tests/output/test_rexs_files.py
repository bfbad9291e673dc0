"""Results written back into REXS models: forces, factors and deflections under the names of the format."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse
from loaded_tca.errors import InputError
from loaded_tca.exchange import import_stage, parse_rexs, read_rexs
from loaded_tca.loaded.shaft_lines import shaft_lines
from loaded_tca.output import write_rexs
from loaded_tca.output.rexs import rexs_results
from tests.samples.rexs import EXAMPLE, as_json, changed, example, planetary

ROUNDING = 1e-12  # of factors of units, and of turns by right angles
QUICK = {
    "analysis.positions": 3,
    "analysis.cells": [12, 16],
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "analysis.torques_Nm": [60.0, 150.0],
}
LENGTH, FORCE = {"mm": 1.0}, {"N": 1.0}

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # of coarse grids


@pytest.fixture(scope="module")
def result():
    return analyse(import_stage(example(), "10").scene.with_changes(QUICK))


@pytest.fixture(scope="module")
def second():
    """Of the stage whose output shaft points the other way."""
    changes = QUICK | {"analysis.torques_Nm": [392.0], "analysis.positions": 2}
    return analyse(import_stage(example(), "11").scene.with_changes(changes))


def test_load_distribution_sums_to_the_normal_force(result) -> None:
    attributes = rexs_results(result, example(), "10")["10"]
    load = np.array(attributes["load_distribution_along_face_width"].value)
    places = np.array(attributes["load_distribution_node_positions"].value)
    assert attributes["load_distribution_along_face_width"].unit == "N / mm"
    width = places[1] - places[0]
    assert_allclose([places[0], places[-1]], [0.5 * width, 28.0 - 0.5 * width], rtol=1e-9)  # common face: 28 mm
    mesh = result.scene.mesh()
    # the torque turns the pinion by normal forces at its base circle; its supports lean the normal by 1e-3
    assert_allclose(load.sum() * width, mesh.normal_force(150e3), rtol=3e-3)


def test_face_load_factor_is_largest_over_mean_load(result) -> None:
    attributes = rexs_results(result, example(), "10")["10"]
    load = np.array(attributes["load_distribution_along_face_width"].value)
    assert_allclose(attributes["face_load_factor_flank"].value, load.max() / load.mean(), rtol=1e-9)
    smaller = rexs_results(result, example(), "10", torque=0)["10"]
    assert_allclose(smaller["face_load_factor_flank"].value, result.face_load_factor[0], rtol=ROUNDING)


def test_mesh_stiffness_is_that_of_the_whole_face(result) -> None:
    attribute = rexs_results(result, example(), "10")["10"]["meshing_stiffness_characteristic"]
    assert attribute.unit == "N / mm"
    expected = result.mesh_stiffness[1, :-1] * 28.0 * 1e3  # N/(mm um) over 28 mm
    assert_allclose(attribute.value, expected, rtol=1e-9)


@pytest.mark.quick_cases("1.1-N-False", "1.5-N / mm-True")
@pytest.mark.parametrize(
    ("version", "unit", "stiffness"), [("1.1", "N", False), ("1.4", "N / mm", False), ("1.5", "N / mm", True)]
)
def test_names_and_units_are_those_of_the_version(result, version: str, unit: str, stiffness: bool) -> None:
    attributes = rexs_results(result, changed(version=version), "10")["10"]
    load = attributes["load_distribution_along_face_width"]
    assert load.unit == unit
    whole = sum(load.value) * (1.0 if unit == "N" else 28.0 / 30)
    assert_allclose(whole, result.scene.mesh().normal_force(150e3), rtol=3e-3)
    assert ("meshing_stiffness_characteristic" in attributes) == stiffness


@pytest.mark.thorough
def test_deflection_of_a_shaft_is_along_its_own_axes(result) -> None:
    """The wheel is at +w of its pinion: x = w, y = -v, z = u."""
    attributes = rexs_results(result, example(), "10")["3"]
    line = next(one for one in shaft_lines(result.scene) if one.gear == "pinion" and one.torque == 150e3)
    places = np.array(attributes["u_coordinates_of_beam_nodes"].value)
    assert_allclose(places, line.places + 105.0, atol=1e-9)
    for axis, expected in (("u", line.motions[:, 2]), ("v", -line.motions[:, 1]), ("w", line.motions[:, 0])):
        assert attributes[f"displacement_{axis}_of_nodes"].unit == "mum"
        assert_allclose(attributes[f"displacement_{axis}_of_nodes"].value, 1e3 * expected, atol=1e-9)
    assert_allclose(attributes["torsion_u"].value, np.degrees(line.motions[:, 5]), atol=ROUNDING)


@pytest.mark.thorough
def test_a_shaft_that_points_the_other_way_has_its_own_coordinates(second) -> None:
    attributes = rexs_results(second, example(), "11")["5"]
    places = np.array(attributes["u_coordinates_of_beam_nodes"].value)
    assert (np.diff(places) > 0.0).all()
    assert_allclose([places[0], places[-1]], [0.0, 240.0], atol=1e-9)
    torsion = np.array(attributes["torsion_u"].value)
    assert_allclose(torsion[-1], 0.0, atol=1e-12)  # where the torque leaves, at u = 240 mm
    assert_allclose(torsion[0], torsion[20], atol=1e-9)  # nothing twists beyond the gear


def test_bearings_hold_the_forces_of_their_shaft(result) -> None:
    """Sums over both bearings along u, v, w: axial, tangential and radial force of the teeth."""
    results, mesh = rexs_results(result, example(), "10"), result.scene.mesh()
    tangential = 150e3 / mesh.pinion_working_radius
    radial = tangential * math.tan(mesh.working_pressure_angle)
    axial = 150e3 / mesh.pinion.reference_radius * math.tan(mesh.pinion.helix_angle)
    on_casing = np.zeros(3)
    for bearing in ("91", "92"):
        own = results[bearing]
        inner, outer = (
            np.array([own[f"force_acting_on_{side}_component_{axis}"].value for axis in "uvw"])
            for side in ("inner", "outer")
        )
        assert_allclose(inner, -outer, rtol=ROUNDING)
        on_casing += outer
    # the pinion's teeth are pressed back (-y = +v) and away from the wheel (-x = -w)
    assert_allclose(on_casing, [axial, tangential, -radial], rtol=5e-3)


@pytest.mark.thorough
def test_bearings_that_the_scene_has_elsewhere_get_no_forces(result) -> None:
    moved = analyse(result.scene.with_changes({"pinion.shaft.bearings.1.at_mm": 65.0, "analysis.torques_Nm": [150.0]}))
    results = rexs_results(moved, example(), "10")
    assert "91" in results
    assert "92" not in results


@pytest.mark.thorough
def test_rows_of_a_bearing_hold_as_one(result) -> None:
    """Bearing 92 as two rows 10 mm apart, of half its stiffness each: their sum, and the moment of their difference."""
    rows = {"stiffness": None, "radial_stiffness_N_per_um": 150.0, "axial_stiffness_N_per_um": 0.0}
    first, _ = (vars(one) for one in result.scene.pinion.shaft.bearings)
    bearings = [first, *({**first, **rows, "at_mm": 70.0 + beside} for beside in (-5.0, 5.0))]
    double = analyse(result.scene.with_changes({"pinion.shaft.bearings": bearings, "analysis.torques_Nm": [150.0]}))
    own = rexs_results(double, changed(attributes={"92.distance_between_bearing_rows": (10.0, "mm")}), "10")["92"]
    force = double.pinion_bearing_force[0, :-1].mean(axis=0)[1:]
    # x = w, y = -v, z = u
    assert own["force_acting_on_outer_component_w"].value == pytest.approx(force[:, 0].sum(), rel=1e-9)
    tilting = 1e-3 * 5.0 * (force[1, 0] - force[0, 0])  # about y = -v, N m
    assert own["torque_acting_on_outer_component_v"].value == pytest.approx(-tilting, rel=1e-6)


@pytest.mark.quick_cases("rexs")
@pytest.mark.parametrize("suffix", ["rexs", "rexsj"])
def test_written_models_are_read_again(result, tmp_path, suffix: str) -> None:
    model = tmp_path / f"model.{suffix}"
    model.write_bytes(EXAMPLE.read_bytes() if suffix == "rexs" else as_json(example()))
    path = write_rexs(result, model, "10", tmp_path / f"out.{suffix}")
    written = read_rexs(path)
    assert written.components["10"].number("face_load_factor_flank") == pytest.approx(float(result.face_load_factor[1]))
    nodes = written.components["3"].attributes["u_coordinates_of_beam_nodes"].value
    assert len(nodes) == len(written.components["3"].attributes["displacement_v_of_nodes"].value)
    assert import_stage(written, "10").scene == import_stage(example(), "10").scene


def test_version_without_names_of_results_is_refused(result) -> None:
    with pytest.raises(InputError, match=r"version 1\.0 has no names of results; allowed 1\.1 to 1\.7"):
        rexs_results(result, changed(version="1.0"), "10")


def test_results_of_other_gears_are_refused(result) -> None:
    with pytest.raises(InputError, match="stage 11: has 19/61 teeth; found a result of 21/55"):
        rexs_results(result, example(), "11")
    with pytest.raises(InputError, match="stage 211: has 17/22 teeth"):
        rexs_results(result, planetary(), "211")


def test_rigid_gears_have_results_of_the_stage_alone(result) -> None:
    rigid = analyse(result.scene.with_changes({"pinion.shaft": None, "wheel.shaft": None, "analysis.torques_Nm": None}))
    assert list(rexs_results(rigid, parse_rexs(EXAMPLE.read_bytes()), "10")) == ["10"]
