import doctest
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray
from matplotlib.figure import Figure
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import InputError
from loaded_tca.results.files import read_dataset, write_dataset
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.quantities import QUANTITIES
from loaded_tca.scene import read_scene
from tests.refusals import refused_calls
from tests.samples.results import ONE_PAIR, PER_PAIR, PER_POSITION, SCENES, assert_same, changed, result, with_a_gap

SCENE = str(SCENES / "helical.toml")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "result.nc"


def edge_contact():
    return result("misaligned", positions=2)


@pytest.mark.parametrize(
    "make",
    [
        result,
        with_a_gap,
        edge_contact,
        lambda: result(positions=1),
        lambda: result(torques=(0.0, 40.0, 90.0), positions=2),
        lambda: result(positions=1, title="Räder „µ“ 歯車 $x_1"),
    ],
)
def test_result_survives_its_file_unchanged(path, make):
    before = make()
    before.save(path)
    assert_same(MeshCycle.load(path), before)


def test_infinite_gaps_survive(path):
    small = with_a_gap().maps[0][-1][0]
    gap = small.gap.copy()
    gap[0, :3] = np.inf
    maps = tuple((*row[:-1], (replace(small, gap=gap),)) for row in with_a_gap().maps)
    replace(with_a_gap(), maps=maps).save(path)
    found = MeshCycle.load(path).maps[0][-1][0].gap
    assert found.shape == gap.shape
    assert np.isinf(found[0, :3]).all()
    assert np.isfinite(found[1:]).all()


def test_file_grows_with_the_cells_of_the_maps_not_with_the_largest(path, tmp_path):
    """One map refined four times each way adds its own cells, 24 bytes each, and three lines of them."""
    before = with_a_gap()
    before.save(path)
    one = before.maps[0][-1][0]
    nx, ny = 4 * one.pressure.shape[0], 4 * one.pressure.shape[1]
    zeros = {"pressure": np.zeros((nx, ny)), "gap": np.zeros((nx, ny)), "cover": np.ones((nx, ny))}
    fine = replace(one, x=np.arange(nx) * 1.0, y=np.arange(ny) * 1.0, force_line=np.zeros(ny), **zeros)
    larger = replace(before, maps=tuple((*row[:-1], (fine,)) for row in before.maps))
    larger.save(tmp_path / "larger.nc")
    added = 8 * len(before.maps) * (3 * (nx * ny - one.pressure.size) + nx - len(one.x) + 2 * (ny - len(one.y)))
    assert (tmp_path / "larger.nc").stat().st_size - path.stat().st_size == added
    assert_same(MeshCycle.load(tmp_path / "larger.nc"), larger)


def test_file_with_fewer_values_than_its_maps_have_cells_is_told(path):
    result().save(path)
    file = read_dataset(path)
    write_dataset(path, file.isel(cell=slice(1, None)))
    cells = file.sizes["cell"]
    with pytest.raises(InputError) as caught:
        MeshCycle.load(path)
    assert caught.value.problems[1:] == tuple(
        f"map_{name}: {cells - 1} values, expected {cells} of all maps together"
        for name in ("pressure", "gap", "cover")
    )


def test_result_without_any_map_survives(path):
    empty = replace(result(), maps=(((None,),) * 5,))
    empty.save(path)
    assert MeshCycle.load(path).maps == (((None,),) * 5,)


def test_every_variable_of_a_file_has_unit_and_text(path):
    result().save(path)
    found = read_dataset(path)
    for variables in (found.variables, result().dataset.variables):
        assert all(one.attrs["units"] and one.attrs["long_name"] for one in variables.values())
        assert variables["torque"].attrs["units"] == "N mm"
    assert found.attrs["scene_toml"] == result().scene.to_toml()


def test_xarray_opens_the_file(path):
    result().save(path)
    with xarray.open_dataset(path, engine="scipy") as data:
        assert_allclose(data.peak_pressure, result().peak_pressure)
        assert data.path_in_contact.dtype == bool


def test_file_that_lacks_parts_is_told(path):
    result().save(path)
    write_dataset(path, read_dataset(path).drop_vars(["contact_deformation", "path_point"]))
    with pytest.raises(InputError) as caught:
        MeshCycle.load(path)
    assert caught.value.problems[0] == f"{path}: not the result of a mesh cycle"
    assert caught.value.problems[1:] == ("contact_deformation: missing", "path_point: missing")


def test_empty_file_of_this_package_is_told(path):
    write_dataset(path, xarray.Dataset())
    with pytest.raises(InputError, match="not the result of a mesh cycle"):
        MeshCycle.load(path)


def test_file_with_a_dimension_of_another_length_is_told(path):
    result().save(path)
    write_dataset(path, read_dataset(path).isel(path=[0], vector=[0, 1]))
    with pytest.raises(InputError) as caught:
        MeshCycle.load(path)
    assert caught.value.problems[1:] == ("vector: 2 long, expected 3", "path: 1 long, expected 2")


def test_file_without_a_torque_is_told(path):
    result().save(path)
    write_dataset(path, read_dataset(path).isel(torque=[]))
    with pytest.raises(InputError) as caught:
        MeshCycle.load(path)
    assert caught.value.problems[1:] == ("torque: 0 long, expected at least 1",)


def test_what_a_user_adds_to_the_dataset_is_kept(path):
    cycle = result()
    added = {"wear": (("torque", "position"), np.array([[0.1, 0.2, 0.3, 0.4, 0.5]]), {"units": "um"})}
    replace(cycle, dataset=cycle.dataset.assign(added)).save(path)
    found = MeshCycle.load(path)
    assert_same(found, replace(cycle, dataset=cycle.dataset.assign(added)))


def test_what_netcdf_cannot_hold_is_told_and_keeps_the_old_file(path):
    result().save(path)
    before = path.read_bytes()
    with pytest.raises(InputError, match="wear: cannot be stored"):
        replace(result(), dataset=result().dataset.assign(wear=("position", [1j] * 5))).save(path)
    assert path.read_bytes() == before


def test_flipped_bytes_are_always_told(path):
    result(positions=1).save(path)
    content = path.read_bytes()
    for position in np.linspace(0, len(content) - 1, 400).astype(int):  # header, scene, numbers, padding
        damaged = bytearray(content)
        damaged[position] ^= 4
        path.write_bytes(damaged)
        with pytest.raises(InputError):
            MeshCycle.load(path)


@pytest.mark.parametrize("text", ["", "pair = ", "[pair]\ntype = 'worm'"])
def test_file_without_a_scene_is_told(path, text):
    result().save(path)
    write_dataset(path, read_dataset(path).assign_attrs(scene_toml=text))
    with pytest.raises(InputError, match="not the result of a mesh cycle"):
        MeshCycle.load(path)


@pytest.mark.parametrize("torques", [None, (20.0, 80.0)])
def test_every_quantity_is_an_array_with_its_axes(torques):
    cycle = result(torques=torques)
    sizes = {"torque": len(torques or [0]), "position": 5, "pair": 1}
    for name, (axes, *_) in QUANTITIES.items():
        values = getattr(cycle, name)
        assert name in dir(cycle)
        if axes:
            assert isinstance(values, np.ndarray)
            assert values.shape == tuple(sizes[axis] for axis in axes)
            assert cycle.dataset[name].dims == axes
        else:
            assert isinstance(values, int if name == "coupled_pitches" else float)


test_mesh_cycle_refuses = refused_calls(
    (lambda tmp_path: MeshCycle.load(tmp_path), r"a directory; name the result file in it, as .*result\.nc"),
    (lambda: result().peak, "'MeshCycle' object has no attribute 'peak'", AttributeError),
)


def test_dataset_selects_tabulates_and_draws():
    cycle = result(torques=(20.0, 80.0))
    low = cycle.dataset.sel(torque=20e3, pair=0)
    assert_allclose(low.peak_pressure, cycle.peak_pressure[0, :, 0])
    table = cycle.dataset[["peak_pressure", "load_share"]].to_dataframe()
    assert_allclose(table.loc[(80e3, slice(None), 0), "peak_pressure"], cycle.peak_pressure[1, :, 0])
    axes = Figure().add_subplot()
    cycle.dataset.transmission_error.plot.line(x="pinion_angle", hue="torque", ax=axes)
    assert "[rad]" in axes.get_xlabel()
    assert_allclose(axes.lines[1].get_ydata(), cycle.transmission_error[1])


@pytest.mark.thorough
def test_guide_to_the_dataset_shows_what_happens(monkeypatch):
    monkeypatch.chdir(SCENES.parents[1])
    found = doctest.testfile(str(SCENES.parents[1] / "docs" / "guide" / "results.md"), module_relative=False)
    assert found.attempted >= 8
    assert found.failed == 0


@pytest.mark.parametrize(
    "command", ["import loaded_tca", f"from loaded_tca.cli import main; main(['check', {SCENE!r}])"]
)
def test_xarray_is_not_imported_before_there_is_a_result(command):
    done = subprocess.run(
        [sys.executable, "-c", f"{command}\nimport sys; assert 'xarray' not in sys.modules"], capture_output=True
    )
    assert done.returncode == 0, done.stderr.decode()


def test_figures_agree_with_the_fields():
    cycle = result(torques=(20.0, 80.0))
    low, high = cycle.key_figures()
    assert (low["pinion_torque_Nm"], high["pinion_torque_Nm"]) == (20.0, 80.0)
    assert high["peak_pressure_MPa"] == cycle.peak_pressure[1].max()  # clear of edges
    position, _ = cycle.peak_contact(1)
    assert_allclose(high["pinion_diameter_at_peak_mm"], 2.0 * cycle.peak_radius[1, position, 0])
    assert_allclose(high["pinion_angle_at_peak_deg"], np.degrees(cycle.pinion_angle[position]))
    span = np.ptp(cycle.transmission_error[1])
    assert_allclose(high["transmission_error_span_arcsec"], np.degrees(span) * 3600.0)
    assert_allclose(high["transmission_error_span_um"], span * cycle.wheel_base_radius * 1e3)


def test_figures_skip_positions_that_do_not_touch():
    for figures in with_a_gap().key_figures():
        assert figures["positions_in_contact"] == 4
        unknown = {name for name, value in figures.items() if np.isnan(value)}
        known_if_shared = {"loaded_contact_ratio", "fewest_loaded_pairs", "most_loaded_pairs"}
        known_if_shared |= {f"transmission_error_order_{order}_um" for order in (1, 2, 3)}
        known_if_asked_for = {"max_pressure_MPa", "mesh_stiffness_without_body_torsion_mean_N_per_mm_um"}
        known_if_asked_for |= {"largest_discretisation_error"}
        assert all("edge" in name or name in known_if_asked_for for name in unknown - known_if_shared)


def test_nothing_touching_leaves_figures_unknown():
    cycle = nothing_in_contact()
    assert cycle.peak_contact(0) is None
    assert np.isnan(cycle.key_figures()[0]["peak_pressure_MPa"])
    assert "- | -" in cycle.summary()


def nothing_in_contact():
    """A result of which every number is unknown."""
    cycle = result()
    unknown = {name: np.full((1, 5), np.nan) for name in PER_POSITION}
    unknown |= {name: np.full((1, 5, 1), np.nan) for name in PER_PAIR if getattr(cycle, name).dtype.kind == "f"}
    none = {name: np.zeros((1, 5, 1), getattr(cycle, name).dtype) for name in PER_PAIR if name not in unknown}
    return replace(changed(cycle, **unknown, **none), maps=(((None,),) * 5,))


def line(text, label):
    return next(row for row in text.splitlines() if row.startswith(label))


def test_summary_shows_the_pitch_point_in_engineers_units():
    text = result(positions=1).summary()
    assert text.splitlines()[:2] == [
        "Crowned helical pair 34/57",
        "1 position; one tooth pair carries the whole load (load sharing off); teeth do not bend",
    ]
    assert line(text, "pinion torque").split()[-1] == "130"
    assert line(text, "  normal force of that tooth pair [N]").split()[-1] == "2713"
    assert re.search(r"20 \| 24 \| [0-9.e-]+$", line(text, "most cells"))
    assert re.search(r"\d \| \d", line(text, "mesh stiffness, mean, tangent | secant"))
    assert not any(row.startswith("  orders") for row in text.splitlines())  # one pair has no period
    peak = float(line(text, "peak pressure [MPa]").split()[-3])
    hertz = float(line(text, "highest where Hertz holds").split()[-1])
    assert_allclose([peak, hertz], 706.85, rtol=5e-3)  # coarse grid
    for label in ("  peak to peak [arcsec | um]", "  unloaded, peak to peak [arcsec | um]"):
        assert line(text, label).split()[-3:] == ["-", "|", "-"]  # of one position not known
    assert 14 <= len(text.splitlines()) <= 20


def test_peak_where_hertz_holds_leaves_edges_out():
    hertz = result().hertz_pressure.copy()
    highest = result().peak_contact(0)
    hertz[0][highest] = np.nan
    cycle = changed(result(), hertz_pressure=hertz)
    smooth = cycle.peak_contact(0, where_hertz_holds=True)
    assert cycle.peak_contact(0) == highest != smooth
    (figures,) = cycle.key_figures()
    assert figures["hertz_pressure_there_MPa"] == hertz[0][smooth]
    assert figures["peak_pressure_where_hertz_holds_MPa"] < figures["peak_pressure_MPa"]
    assert edge_contact().peak_contact(0, where_hertz_holds=True) is None


def test_what_is_written_into_the_dataset_is_followed_by_what_comes_from_it():
    """In place and as a new variable, after it was looked at."""
    cycle = changed(result(), peak_pressure=result().peak_pressure.copy())
    assert cycle.peak_contact(0) != (4, 0)
    assert cycle.peak_pressure[0, 4, 0] < 9000.0
    cycle.dataset.peak_pressure[0, 4, 0] = 9000.0
    assert cycle.peak_contact(0) == (4, 0)
    assert cycle.key_figures()[0]["peak_pressure_MPa"] == 9000.0
    cycle.dataset["edge_pressure"] = cycle.dataset.edge_pressure.copy(data=np.arange(5.0)[None, :, None])
    assert cycle.edge_contact(0) == (4, 0)


@pytest.mark.parametrize("name", ["transmission_error", "torque", "wheel_base_radius", "peak", "maps", "save", 3])
def test_number_of_every_position_is_told_what_it_is_taken_from(name):
    with pytest.raises(
        InputError, match=rf"^name: '?{name}'? is no array \(torque, position, pair\) of the result"
    ) as told:
        result().at_position(name)
    assert ("has its numbers as they are" in str(told.value)) is (name in QUANTITIES)


def test_numbers_of_edges_are_those_of_the_pair_with_the_highest_pressure_at_one():
    cycle = result("mesh_cycle_spur")
    pressure, others = np.zeros(cycle.peak_pressure.shape), np.zeros(cycle.peak_pressure.shape)
    pressure[..., 0], others[..., 1] = 900.0, 800.0
    radius = np.broadcast_to([30.0, 40.0, 50.0], cycle.peak_pressure.shape)
    one = changed(cycle, edge_pressure=others, peak_pressure=pressure, edge_radius=radius, peak_radius=radius)
    assert_allclose(one.at_position("edge_radius"), 40.0)
    assert_allclose(one.at_position("peak_radius"), 30.0)


def test_summary_has_a_column_per_torque():
    torques = line(result(torques=(20.0, 80.0)).summary(), "pinion torque")
    assert torques.split()[-2:] == ["20", "80"]


def test_summary_tells_what_limits_it():
    text = edge_contact().summary()
    assert "note: at 2 of 2 positions the contact reaches an edge of a flank" in text
    assert line(text, "at a sharp edge of any pair, mesh-dependent [MPa]")
    assert "note: at 1 of 5 positions (all torques) no tooth pair is in contact" in with_a_gap().summary()
    assert "note" not in result(positions=1).summary()


def with_an_edge_pressure(at, torques=None):
    """A contact that reaches an edge with twice the peak pressure at one position, as of the last torque."""
    cycle = result(torques=torques)
    edge_pressure, edge = cycle.edge_pressure.copy(), cycle.on_edge.copy()
    edge_pressure[-1, at], edge[-1, at] = 2.0 * cycle.peak_pressure[-1].max(), True
    return changed(cycle, edge_pressure=edge_pressure, on_edge=edge)


def test_pressure_at_an_edge_is_never_the_peak():
    cycle, whole = with_an_edge_pressure(4), result()
    (figures,), (before,) = cycle.key_figures(), whole.key_figures()
    assert figures["peak_pressure_MPa"] == before["peak_pressure_MPa"]
    assert figures["edge_pressure_MPa"] == 2.0 * whole.peak_pressure.max()
    assert_allclose(figures["pinion_angle_at_edge_deg"], np.degrees(cycle.pinion_angle[4]))
    assert "note: at 1 of 5 positions the contact reaches an edge of a flank" in cycle.summary()
    shown = line(cycle.summary(), "at a sharp edge of any pair, mesh-dependent [MPa] | its force [N]").split()[-3:]
    assert shown == [f"{figures['edge_pressure_MPa']:.4g}", "|", f"{cycle.normal_force[0, 4, 0]:.4g}"]


def test_no_edge_has_no_pressure():
    cycle = result(positions=1)
    assert not cycle.on_edge.any()
    assert np.isnan(cycle.edge_pressure).all()
    assert cycle.edge_contact(0) is None
    assert "at an edge" not in cycle.summary()


def test_edge_pressure_of_contacts_on_an_edge_is_that_of_their_largest_cell():
    cycle = edge_contact()
    largest = [one.pressure.max() for row in cycle.maps[0] for one in row]
    assert_allclose(cycle.edge_pressure.ravel(), largest)
    assert (cycle.peak_pressure < cycle.edge_pressure).all()
    assert not cycle.edge_is_rounded.any()
    (figures,) = cycle.key_figures()
    assert figures["peak_pressure_MPa"] == cycle.peak_pressure.max()
    assert figures["edge_pressure_MPa"] == cycle.edge_pressure.max()


def test_relief_start_in_the_contact_is_told():
    relief_start = np.array([True, False, False, False, False])[None, :, None]
    cycle = changed(result(), on_relief_start=relief_start)
    assert "note: at 1 of 5 positions the start of a linear relief lies in the contact" in cycle.summary()


def test_pressure_cap_is_told():
    peak = result().peak_pressure
    reached = changed(result(), max_pressure=peak.min(), peak_pressure=np.full((1, 5, 1), peak.min()))
    assert reached.key_figures()[0]["capped_positions"] == 5
    assert (
        f"note: at 5 of 5 positions the pressure equals the cap on the pressure, {peak.min():.6g} MPa"
        in reached.summary()
    )
    assert "cap on the pressure, 9000 MPa, is not reached" in changed(result(), max_pressure=9000.0).summary()
    assert result().key_figures()[0]["capped_positions"] == 0


def test_cap_that_is_reached_at_an_edge_alone_is_told():
    cycle = with_an_edge_pressure(4)
    (figures,) = changed(cycle, max_pressure=cycle.edge_pressure[0, 4, 0]).key_figures()
    assert figures["capped_positions"] == 1
    assert figures["peak_pressure_MPa"] == result().peak_pressure.max() < figures["edge_pressure_MPa"]


def test_cap_of_a_scene_reaches_the_result():
    scene = read_scene(SCENES / "helical.toml")
    changes = {**ONE_PAIR, "analysis.positions": 1, "analysis.cells": (20, 24), "material.max_pressure_MPa": 500.0}
    cycle = analyse(scene.with_changes(changes))
    assert cycle.max_pressure == 500.0
    assert cycle.key_figures()[0]["peak_pressure_MPa"] == pytest.approx(500.0)
    assert np.isnan(result().max_pressure)


def test_notes_say_for_which_torques():
    text = with_an_edge_pressure(4, torques=(20.0, 80.0)).summary()
    assert "note: at 1 of 5 positions (80 N m) the contact reaches an edge of a flank" in text


def test_contact_is_no_longer_than_the_face():
    cycle = result("fzg_c14", positions=1)
    assert_allclose(cycle.contact_length, [[[14.0]]], rtol=1e-6)


def test_summary_of_a_line_contact_says_so():
    text = result("fzg_c14", positions=1).summary()
    assert "note: at 1 of 1 positions the unloaded contact is a line" in text


@pytest.mark.parametrize("name", ["helical", "misaligned"])
def test_peak_without_load_lies_at_the_contact_point(name):
    """Where a load that vanishes presses, on an edge as elsewhere; the search for the point leaves 1e-3 mm."""
    cycle = result(name, torques=(0.0,), positions=2)
    path = cycle.paths[0]
    for place in ("peak", "edge") if cycle.on_edge.all() else ("peak",):
        assert_allclose(
            getattr(cycle, f"{place}_radius")[0, :, 0], path.pinion_radius, atol=1e-3
        )  # where it is searched
        assert_allclose(getattr(cycle, f"{place}_axial")[0, :, 0], path.pinion_axial, atol=1e-3)


def test_summary_without_load_shows_zeros():
    text = result(torques=(0.0,), positions=2).summary()
    assert line(text, "peak pressure [MPa]").split()[-3] == "0"
    assert line(text, "transmission error, mean").split()[-3:] == ["0", "|", "0"]


def test_repr_is_short():
    assert re.fullmatch(r"MeshCycle\(5 positions, 1 torque, peak \d+\.?\d* MPa\)", repr(result()))
    assert "2 torques" in repr(with_a_gap())
