"""Stresses below a pressure map of a result: Hertz, where they are asked for, their files, the command."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.output.tables import STRESSES, subsurface_csv, write_subsurface
from loaded_tca.plots import plot_stress_below
from loaded_tca.results.files import read_dataset
from loaded_tca.results.pressure_map import PressureMap
from loaded_tca.results.subsurface import NAMES, depth_of_largest, stress_below
from tests.refusals import refusals, refused_calls
from tests.samples.pictures import told
from tests.samples.results import changed, changed_scene, result, with_a_gap

COARSE = 0.02  # 20 cells across the box: pressure within 1 %, shear with it
DEPTH = 0.05  # a flat top on depths 0.1 half widths apart


def shared():
    return result("mesh_cycle_helical", positions=5, torques=(40.0,))


@pytest.mark.parametrize("name", ["helical", "straight_bevel"])
def test_greatest_shear_is_that_of_hertz(name):
    below = stress_below(result(name, positions=1))
    shear, depth, pressure, _ = below.hertz_shear
    found = below.largest("max_shear")
    assert_allclose(pressure, result(name, positions=1).hertz_pressure.item())
    assert_allclose(found.value, shear, rtol=COARSE)
    assert_allclose(found.depth, depth, rtol=DEPTH)
    assert 0.300 <= shear / pressure <= 0.311


def test_slender_ellipse_is_sheared_as_a_line():
    """0.300 p0 at 0.786 b below a line; the ellipse of this pair is 80 times longer than wide."""
    below = stress_below(result(positions=1))
    shear, depth, pressure, half_width = below.hertz_shear
    assert half_width == below.result.hertz_semi_minor.item()
    assert_allclose(shear / pressure, 0.300, rtol=0.02)
    assert_allclose(depth / half_width, 0.786, rtol=0.02)


def test_line_contact_is_compared_with_a_long_line():
    below = stress_below(result("fzg_c14", positions=1))
    assert below.result.path.on_line[0]
    shear, depth, pressure, half_width = below.hertz_shear
    assert_allclose([shear / pressure, depth / half_width], [0.3003, 0.786], rtol=1e-3)  # Johnson 1985, section 4.2
    assert_allclose(below.largest("max_shear").value, shear, rtol=0.1)  # the sides of the teeth end the line


def test_contact_at_a_edge_has_no_hertz_and_says_so():
    below = stress_below(result("misaligned", positions=2))
    assert below.hertz_shear is None
    assert "after Hertz" not in below.summary()
    assert "note: the contact reaches an edge" in below.summary()


def test_place_is_that_of_the_highest_pressure_unless_told_otherwise():
    cycle = result(torques=(20.0, 80.0))
    below = stress_below(cycle)
    assert (below.torque, below.position, below.column) == (1, *cycle.peak_contact(1))
    assert stress_below(cycle, 0, 3).position == 3


def test_pair_is_taken_by_its_number_where_its_pressure_is_highest():
    cycle = shared()
    for number in cycle.pair.tolist():
        below = stress_below(cycle, pair=number)
        assert below.pair == number
        column = cycle.peak_pressure[0, :, below.column]
        assert column[below.position] == np.nanmax(column)


def test_other_gear_has_its_own_ratio_of_poisson():
    softer = {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.2}
    other = changed_scene(result(positions=1), {"wheel.material": softer})
    assert stress_below(other, gear="wheel").stress.poisson_ratio == 0.2
    assert stress_below(other, gear="pinion").stress.poisson_ratio == 0.3


def test_summary_tells_depth_place_and_hertz():
    text = stress_below(result(positions=1)).summary()
    for words in ("position 1 of 1, tooth pair 0", *NAMES.values(), "stress after Hertz", "mm: 0.30", "at diameter"):
        assert words in text


def test_line_after_hertz_is_relative_to_its_own_pressure_and_half_width():
    """An ellipse twice as large above the same map has its greatest shear twice as deep, at the same part of its b."""
    whole = result(positions=1)
    axes = {name: 2.0 * getattr(whole, name) for name in ("hertz_semi_minor", "hertz_semi_major")}
    for cycle in (whole, changed(whole, **axes)):
        (row,) = [row for row in stress_below(cycle).summary().splitlines() if "after Hertz" in row]
        p0, b = cycle.hertz_pressure.item(), cycle.hertz_semi_minor.item()
        assert row.endswith(f" of p0 at 0.79 b of its own, p0 {p0:.4g} MPa, b {b:.4g} mm")  # 0.786 b below a line
        assert "mm: 0.30" in row


test_what_is_not_there_is_told = refusals(
    lambda asked: stress_below(with_a_gap(), **asked),
    ({"torque": 2}, "torque: 2 is no index from 0 to 1"),
    ({"torque": -1}, "torque: -1 is no index"),
    ({"position": 5}, "position: 5 is no index from 0 to 4"),
    ({"pair": 3}, "pair: 3 carries no load anywhere; the result has 0"),
    ({"position": 1}, "no stress: tooth pair 0 carries no load at position 2 under 80 N m"),
    ({"gear": "rack"}, "gear: 'rack' is neither"),
    ({"depths": 1}, "depths: 1 is not a whole number from 2 on"),
)


test_stress_below_refuses = refused_calls(
    (lambda: stress_below(with_a_gap(), torque=9, position=9, pair=9), ("^torque:", "^position:", "^pair:")),
    (lambda: stress_below(result(torques=(0.0,), positions=2)), "carries no load at position"),
)


def test_depth_of_a_parabola_is_exact_whatever_the_order():
    depths = np.array([0.9, 0.0, 0.1, 0.3, 0.55])
    # the top of a parabola through a parabola: 2e-16 seen
    assert_allclose(depth_of_largest(depths, 2.0 - (depths - 0.37) ** 2), 0.37, rtol=1e-12)


def test_depth_of_what_falls_from_the_surface_is_the_surface():
    assert depth_of_largest(np.array([0.0, 1.0, 2.0]), np.array([3.0, 2.0, 1.0])) == 0.0


# A spike at an edge


def spike():
    """A line of contact that ends at the sides of the teeth."""
    return stress_below(result("fzg_c14", positions=3))


def test_stress_beside_a_spike_is_that_across_the_contact_point():
    below = spike()
    cycle, at = below.result, (below.torque, below.position, below.column)
    assert cycle.edge_pressure[at] == below.pressure_map.pressure.max()
    row, column = below.highest_pressure
    assert abs(below.pressure_map.y[column]) <= 0.5 * below.pressure_map.spacing[1] * (1.0 + 1e-9)
    assert_allclose(below.pressure_map.pressure[row, column], cycle.central_pressure[at], rtol=COARSE)
    inner, anywhere = (below.largest("max_shear", anywhere=one) for one in (False, True))
    _, row, column = below.stress.max_shear_at
    x, y, z = below.pressure_map.points[row, column]
    assert_allclose((anywhere.radius, anywhere.axial), (np.hypot(x, y), z), rtol=1e-9)
    assert abs(z) > 5.0  # near an end of the face of 14 mm
    assert inner.value < 0.9 * anywhere.value
    assert_allclose(inner.value, 0.3003 * cycle.central_pressure[at], rtol=COARSE)  # as below a long line


def test_summary_beside_a_spike_tells_the_spike_in_its_note_alone():
    below = spike()
    peak, text = f"{below.pressure_map.pressure.max():.4g} MPa", below.summary()
    assert [peak in line for line in text.splitlines()] == [False] * (text.count("\n")) + [True]
    assert "hold across the contact point. At the edge" in text


def test_picture_and_table_show_the_plane_beside_a_spike():
    below = spike()
    label = plot_stress_below(below).axes[0].get_legend_handles_labels()[1][0]
    assert label.startswith(f"{below.largest('max_shear').value:.4g} MPa")
    first = next(csv.DictReader(subsurface_csv(below).splitlines()))
    assert float(first["sigma_z_MPa"]) == pytest.approx(-below.pressure_map.pressure[below.highest_pressure], rel=1e-8)


def test_flank_of_a_map_ends_where_its_last_cell_with_material_does():
    """Cells of 0.1 mm from -0.45 to 0.45 mm, the last two without material: it ends 0.3 mm from the contact point."""
    gap = np.zeros((10, 1))
    gap[8:] = np.inf
    x, none = np.linspace(-0.45, 0.45, 10), np.zeros(1)
    one = PressureMap(x, none, (0.1, 0.1), np.ones((10, 1)), gap, np.isfinite(gap) * 1.0, np.zeros(3), np.eye(3), none)
    assert [one.flank_ends_within(distance) for distance in (0.29, 0.31)] == [False, True]
    wide = replace(
        one, gap=np.repeat(gap, 9, 1), cover=np.ones((10, 9)), pressure=np.ones((10, 9)), y=np.linspace(-4.0, 4.0, 9)
    )
    assert wide.near_end(0.35)[:, 4].nonzero()[0].tolist() == [0, 5, 6, 7, 8, 9]  # the box ends at the first cell


def test_unloaded_contact_decides_nothing():
    """Of gears on supports it lies elsewhere: on an edge or not, a line or not."""
    spiked, line = spike(), stress_below(result("fzg_c14", positions=1))
    for below, flag in ((spiked, "on_edge"), (spiked, "on_relief_start"), (line, "on_line")):
        path = below.result.paths[below.column]
        paths = list(below.result.paths)
        paths[below.column] = replace(path, **{flag: ~getattr(path, flag)})
        other = replace(below, result=replace(below.result, paths=tuple(paths)))
        assert (other.beside_spike, other.hertz_shear) == (below.beside_spike, below.hertz_shear)


def test_contact_without_a_spike_has_no_other_plane():
    below = stress_below(result(positions=1))
    assert below.beside_spike is None
    assert below.largest("von_mises") == below.largest("von_mises", anywhere=True)


# Files


def test_files_hold_stresses_with_units(tmp_path):
    below = stress_below(result(positions=1), gear="wheel")
    fields, table = write_subsurface(below, tmp_path)
    found = read_dataset(fields)
    assert found.attrs["gear"] == "wheel"
    assert found.attrs["scene_toml"] == below.result.scene.to_toml()
    assert all(variable.attrs["units"] for variable in found.variables.values())
    for name in STRESSES:
        np.testing.assert_array_equal(found[name], getattr(below.stress, name))  # exact: the same operations
        assert found[name].dims == ("depth", "across", "along")
    assert table.read_text(encoding="utf-8") == subsurface_csv(below)


def test_table_starts_at_the_pressure_and_holds_the_largest():
    below = stress_below(result(positions=1))
    rows = list(csv.DictReader(subsurface_csv(below).splitlines()))
    assert [float(row["depth_mm"]) for row in rows] == pytest.approx(below.stress.depths, rel=1e-8)
    assert float(rows[0]["sigma_z_MPa"]) == pytest.approx(-below.pressure_map.pressure.max(), rel=1e-8)
    for name in NAMES:
        largest = max(float(row[f"largest_{name}_MPa"]) for row in rows)
        assert largest == pytest.approx(below.largest(name).value, rel=1e-8)
    assert all(name.endswith(("_MPa", "_mm")) for name in rows[0])


@pytest.mark.parametrize("quantity", NAMES)
def test_picture_names_scene_load_and_place(quantity):
    below = stress_below(shared(), pair=0)
    title = told(plot_stress_below(below, quantity))
    for words in (
        below.result.scene.title,
        NAMES[quantity],
        "pinion torque 40 N m",
        "tooth pair 0",
        "flank of the pinion",
    ):
        assert words in title


# Command

FILES = {"subsurface.nc", "subsurface.csv", "subsurface_max_shear.png", "subsurface_von_mises.png"}


@pytest.fixture
def directory(tmp_path):
    shared().save(tmp_path / "result.nc")
    return tmp_path


def test_command_writes_files_and_tells_the_largest(run, directory):
    code, out, errors = run("subsurface", directory)
    assert (code, errors) == (0, [])
    assert {path.name for path in directory.iterdir()} == {"result.nc", *FILES}
    assert " ".join(out.split()).startswith(" ".join(stress_below(shared()).summary().split()))  # long lines are broken
    assert all(name in out for name in FILES)


@pytest.mark.thorough
def test_command_takes_the_place_it_is_told(run, directory):
    elsewhere = directory / "new" / "place"
    options = ("--torque", 40, "--position", 1, "--pair", -1, "--gear", "wheel", "--out", elsewhere)
    code, out, _ = run("subsurface", directory / "result.nc", *options)
    assert code == 0
    assert "position 1 of 5, tooth pair -1" in out
    assert "flank of the wheel" in out
    assert {path.name for path in elsewhere.iterdir()} == FILES


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--torque", 30), "--torque 30: the result has 40 N m"),
        (("--position", 6), "--position 6: the result has the positions 1 to 5"),
        (("--pair", 7), "pair: 7 carries no load anywhere; the result has -1, 0, 1"),
        (("--position", 5, "--pair", -1), "no stress: tooth pair -1 carries no load at position 5 under 40 N m"),
        (("--gear", "rack"), "'rack'"),
    ],
)
def test_what_does_not_fit_is_told_in_one_line(refused, directory, options, told):
    assert told in refused("subsurface", directory, *options)
    assert {path.name for path in directory.iterdir()} == {"result.nc"}


def test_spike_beside_a_slice_without_load_is_itself_looked_at():
    """A face of a quarter millimetre: the load stands at its end, and none in the slice of the contact point."""
    whole = result("misaligned", positions=1)
    one = whole.maps[0][0][0]
    bare = replace(one, pressure=np.where(np.abs(one.y) <= one.spacing[1], 0.0, one.pressure))
    below = stress_below(replace(whole, maps=(((bare,),),)))
    assert below.beside_spike is None
    assert "of the pressure at" in below.summary()


def test_spike_that_holds_the_contact_point_is_told_as_one():
    below = stress_below(result("misaligned", positions=1))
    cycle, at = below.result, (below.torque, below.position, below.column)
    assert below.pressure_map.pressure.max() == cycle.edge_pressure[at] > cycle.peak_pressure[at]
    assert "highest pressure at the edge, mesh-dependent, " in below.where[1]
    note = below.summary().splitlines()[-1]
    assert "do not rate these numbers" in note
    assert note.endswith(f"the contact has {cycle.peak_pressure[at]:.4g} MPa")
