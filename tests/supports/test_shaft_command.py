"""Shafts under load without contact: the command, its tables and its picture."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import read_scene
from loaded_tca.cli import main
from loaded_tca.errors import InputError
from loaded_tca.loaded.shaft_lines import shaft_lines
from loaded_tca.output.other_tables import shaft_csv
from loaded_tca.plots import plot_shafts

SCENE = "examples/scenes/helical_on_shafts.toml"


def test_forces_on_bearings_are_tangential_radial_and_axial_forces() -> None:
    scene = read_scene(SCENE)
    mesh = scene.mesh()
    line = shaft_lines(scene)[1]
    tangential = 130e3 / mesh.pinion_working_radius
    radial = tangential * np.tan(mesh.working_pressure_angle)
    axial = tangential * np.tan(mesh.pinion.base_helix_angle) / np.cos(mesh.working_pressure_angle)
    assert_allclose(line.bearing_forces[:, :3].sum(axis=0), [-radial, -tangential, axial], rtol=1e-3)


def test_lines_grow_with_the_torque_and_end_at_the_ends_of_the_shaft() -> None:
    first, second, *_ = shaft_lines(read_scene(SCENE))
    # atol: mm and rad, where nothing moves
    assert_allclose(second.motions, 130.0 / 40.0 * first.motions, rtol=1e-9, atol=1e-12)
    assert (first.places[0], first.places[-1]) == (-180.0, 20.0)
    assert first.motions[0, 5] == 0.0  # where the torque enters


@pytest.mark.thorough
def test_command_writes_tables_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["shaft", SCENE, "--out", str(tmp_path / "out")]) == 0
    out = capsys.readouterr().out
    assert "pinion under 130 N m" in out
    assert out.endswith(f"Written to {tmp_path / 'out'}: shaft.csv, bearings.csv, shaft.png\n")
    rows = list(csv.DictReader((tmp_path / "out" / "bearings.csv").read_text().splitlines()))
    assert [row["axial_mm"] for row in rows[:2]] == ["-130", "-40"]
    assert len(rows) == 2 * 2 * 3
    assert (tmp_path / "out" / "shaft.png").read_bytes().startswith(b"\x89PNG")


def test_command_shows_forces_without_writing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["shaft", SCENE]) == 0
    out = capsys.readouterr().out
    assert "Written" not in out
    assert "own frame" in out
    assert "x points to the pitch point" in out


def test_both_gears_are_pressed_away_from_the_pitch_point_to_which_x_points() -> None:
    for line in shaft_lines(read_scene(SCENE)):
        assert line.bearing_forces[:, 0].sum() < 0.0
        assert line.motions[abs(line.places - line.middle).argmin(), 0] < 0.0


def test_scene_without_a_shaft_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["shaft", "examples/scenes/helical.toml"]) == 2
    assert "pinion.shaft: missing; a line of deflection needs" in capsys.readouterr().err
    with pytest.raises(InputError, match=r"pinion\.shaft: missing"):
        shaft_lines(read_scene("examples/scenes/helical.toml"))


def test_table_and_picture_have_units() -> None:
    lines = shaft_lines(read_scene(SCENE))
    assert shaft_csv(lines).splitlines()[0].startswith("gear,pinion_torque_Nm,axial_mm,x_um,y_um,z_um,about_x_rad")
    figure = plot_shafts(lines, "pair")
    labels = {axes.get_ylabel() for axes in figure.axes}
    assert labels == {"radius [mm]", "deflection along x [µm]", "deflection along y [µm]"}
    drawn = figure.axes[2].lines[4].get_ydata()
    assert_allclose(drawn, 1e3 * lines[2].motions[:, 0])
