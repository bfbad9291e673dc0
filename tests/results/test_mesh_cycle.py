import re
from dataclasses import fields, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.analysis import analyse
from loaded_tca.errors import InputError
from loaded_tca.results.files import read_netcdf, write_netcdf
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.scene import read_scene
from tests.samples.results import SCENES, assert_same, result, with_a_gap


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


def test_infinite_gaps_survive_padding(path):
    small = with_a_gap().maps[0][-1]
    gap = small.gap.copy()
    gap[0, :3] = np.inf
    maps = tuple((*row[:-1], replace(small, gap=gap)) for row in with_a_gap().maps)
    replace(with_a_gap(), maps=maps).save(path)
    found = MeshCycle.load(path).maps[0][-1].gap
    assert found.shape == gap.shape
    assert np.isinf(found[0, :3]).all()
    assert np.isfinite(found[1:]).all()


def test_result_without_any_map_survives(path):
    empty = replace(result(), maps=((None,) * 5,))
    empty.save(path)
    assert MeshCycle.load(path).maps == ((None,) * 5,)


def test_every_variable_of_a_file_has_unit_and_text(path):
    result().save(path)
    variables, attributes = read_netcdf(path)
    assert all(variable.unit and variable.text for variable in variables.values())
    assert variables["torque"].unit == "N mm"
    assert attributes["scene_toml"] == result().scene_toml


def test_xarray_opens_the_file(path):
    xarray = pytest.importorskip("xarray")
    result().save(path)
    with xarray.open_dataset(path, engine="scipy") as data:
        assert_allclose(data.peak_pressure, result().peak_pressure)
        assert data.path_touches.dtype == bool


def test_file_that_lacks_parts_is_told(path):
    result().save(path)
    variables, attributes = read_netcdf(path)
    del variables["approach"], variables["path_point"]
    write_netcdf(path, variables, attributes)
    with pytest.raises(InputError) as caught:
        MeshCycle.load(path)
    assert caught.value.problems[0] == f"{path}: not the result of a mesh cycle"
    assert "approach: missing" in caught.value.problems


def test_empty_file_of_this_package_is_told(path):
    write_netcdf(path, {}, {})
    with pytest.raises(InputError, match="not the result of a mesh cycle"):
        MeshCycle.load(path)


def test_figures_agree_with_the_fields():
    cycle = result(torques=(20.0, 80.0))
    low, high = cycle.key_figures()
    assert (low["pinion_torque_Nm"], high["pinion_torque_Nm"]) == (20.0, 80.0)
    assert high["peak_pressure_MPa"] == cycle.peak_pressure[1].max()  # clear of edges
    assert_allclose(high["pinion_diameter_at_peak_mm"], 2.0 * cycle.peak_radius[1, cycle.peak_position(1)])
    assert_allclose(high["pinion_angle_at_peak_deg"], np.degrees(cycle.pinion_angle[cycle.peak_position(1)]))
    span = np.ptp(cycle.transmission_error[1])
    assert_allclose(high["transmission_error_span_arcsec"], np.degrees(span) * 3600.0)
    assert_allclose(high["transmission_error_span_um"], span * cycle.wheel_base_radius * 1e3)


def test_figures_skip_positions_that_do_not_touch():
    for figures in with_a_gap().key_figures():
        assert figures["positions_in_contact"] == 4
        unknown = {name for name, value in figures.items() if np.isnan(value)}
        known_if_shared = {"loaded_contact_ratio", "fewest_loaded_pairs", "most_loaded_pairs"}
        known_if_shared |= {f"transmission_error_order_{order}_um" for order in (1, 2, 3)}
        assert all("edge" in name or name == "max_pressure_MPa" for name in unknown - known_if_shared)


def test_nothing_touching_leaves_figures_unknown():
    cycle = result()
    nothing = {entry.name: np.full(5, np.nan) for entry in fields(cycle) if entry.metadata}
    cycle = replace(cycle, **nothing)
    assert cycle.peak_position(0) is None
    assert np.isnan(cycle.key_figures()[0]["peak_pressure_MPa"])
    assert "- | -" in cycle.summary()


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
    hertz = float(line(text, "highest of smooth contacts").split()[-1])
    assert_allclose([peak, hertz], 706.85, rtol=5e-3)  # coarse grid
    assert re.search(r" 0 \| 0$", line(text, "  unloaded, peak to peak [arcsec | um]"))
    assert 14 <= len(text.splitlines()) <= 16


def test_peak_where_hertz_holds_leaves_edges_out():
    hertz = result().hertz_pressure.copy()
    highest = result().peak_position(0)
    hertz[highest] = np.nan
    cycle = replace(result(), hertz_pressure=hertz)
    smooth = cycle.peak_position(0, where_hertz_holds=True)
    assert cycle.peak_position(0) == highest != smooth
    (figures,) = cycle.key_figures()
    assert figures["hertz_pressure_there_MPa"] == hertz[smooth]
    assert figures["peak_pressure_where_hertz_holds_MPa"] < figures["peak_pressure_MPa"]
    assert edge_contact().peak_position(0, where_hertz_holds=True) is None


def test_summary_has_a_column_per_torque():
    torques = line(result(torques=(20.0, 80.0)).summary(), "pinion torque")
    assert torques.split()[-2:] == ["20", "80"]


def test_summary_tells_what_limits_it():
    text = edge_contact().summary()
    assert "note: at 2 of 2 positions the contact reaches an edge of a flank" in text
    assert "note: the contact point itself lies on an edge or relief start: the peak pressure given grows" in text
    assert "note: at 1 of 5 positions (all torques) the tooth pair does not touch" in with_a_gap().summary()
    assert "note" not in result(positions=1).summary()


def with_a_edge_peak(at, torques=None):
    """A contact whose largest cell lies beside cells without material at one position, as of the last torque."""
    cycle = result(torques=torques)
    one = cycle.maps[-1][at]
    pressure, gap = one.pressure.copy(), one.gap.copy()
    gap[:, -1] = np.inf
    pressure[10, -2] = 2.0 * pressure.max()
    maps = [list(row) for row in cycle.maps]
    maps[-1][at] = replace(one, pressure=pressure, gap=gap)
    peak = cycle.peak_pressure.copy()
    peak.reshape(-1, 5)[-1, at] = pressure.max()
    edge = cycle.on_edge.copy()
    edge.reshape(-1, 5)[-1, at] = True
    return replace(cycle, maps=tuple(map(tuple, maps)), peak_pressure=peak, on_edge=edge)


def test_first_number_is_no_peak_at_a_edge():
    cycle, whole = with_a_edge_peak(4), result()
    (figures,), (before,) = cycle.key_figures(), whole.key_figures()
    assert cycle.peak_at_edge.tolist() == [False] * 4 + [True]
    assert figures["peak_pressure_MPa"] == before["peak_pressure_MPa"]
    assert figures["edge_pressure_MPa"] == cycle.peak_pressure[4]
    assert_allclose(figures["pinion_angle_at_edge_deg"], np.degrees(cycle.pinion_angle[4]))
    assert_allclose(cycle.inner_pressure[4], whole.central_pressure[4])
    assert "note: at 1 of 5 positions the largest cell lies at an edge" in cycle.summary()
    assert float(line(cycle.summary(), "at an edge or relief start").split()[-3]) > figures["peak_pressure_MPa"]


def test_contact_that_reaches_a_edge_with_its_peak_mid_flank_keeps_it():
    cycle = replace(result(), on_edge=np.ones(5, dtype=bool))
    assert not cycle.peak_at_edge.any()
    assert_allclose(cycle.inner_pressure, cycle.peak_pressure)
    assert "grows" not in cycle.summary()
    assert "at an edge or relief start" not in cycle.summary()


def test_peaks_at_every_edge_leave_the_highest_central_pressure():
    cycle = result("fzg_c14", positions=3)
    (figures,) = cycle.key_figures()
    assert figures["peak_pressure_MPa"] == cycle.central_pressure.max()
    assert figures["peak_is_beside_contact_point"]
    assert not figures["contact_point_is_at_edge"]
    assert figures["pinion_axial_at_peak_mm"] == pytest.approx(0.0, abs=1e-9)
    assert figures["edge_pressure_MPa"] == cycle.peak_pressure.max()
    assert abs(figures["pinion_axial_at_edge_mm"]) > 6.0  # at an end of the face


def test_contact_points_on_a_edge_are_told():
    (figures,) = edge_contact().key_figures()
    assert np.isnan(edge_contact().inner_pressure).all()
    assert figures["contact_point_is_at_edge"]
    assert figures["peak_pressure_MPa"] == edge_contact().central_pressure.max()


def test_relief_start_in_the_contact_makes_a_peak_doubtful():
    relief_start = np.array([True, False, False, False, False])
    cycle = replace(result(), at_relief_start=relief_start)
    assert (cycle.peak_at_edge == relief_start).all()
    assert "note: at 1 of 5 positions the start of a linear relief lies in the contact" in cycle.summary()


def test_pressure_cap_is_told():
    peak = result().peak_pressure
    reached = replace(result(), max_pressure=float(peak.min()), peak_pressure=np.full(5, peak.min()))
    assert reached.capped.all()
    assert (
        f"note: at 5 of 5 positions the peak equals the cap on the pressure, {peak.min():.6g} MPa" in reached.summary()
    )
    assert "cap on the pressure, 9000 MPa, is not reached" in replace(result(), max_pressure=9000.0).summary()
    assert not result().capped.any()


def test_peak_that_reaches_the_cap_at_a_edge_is_not_the_first_number():
    cycle = with_a_edge_peak(4)
    (figures,) = replace(cycle, max_pressure=float(cycle.peak_pressure[4])).key_figures()
    assert figures["capped_positions"] == 1
    assert figures["peak_pressure_MPa"] == result().peak_pressure.max() < figures["edge_pressure_MPa"]


def test_cap_of_a_scene_reaches_the_result():
    scene = read_scene(SCENES / "helical.toml")
    changes = {"analysis.positions": 1, "analysis.cells": (20, 24), "material.max_pressure_MPa": 500.0}
    cycle = analyse(scene.with_changes(changes))
    assert cycle.max_pressure == 500.0
    assert cycle.key_figures()[0]["peak_pressure_MPa"] == pytest.approx(500.0)
    assert np.isnan(result().max_pressure)


def test_notes_say_for_which_torques():
    text = with_a_edge_peak(4, torques=(20.0, 80.0)).summary()
    assert "note: at 1 of 5 positions (80 N m) the largest cell lies at an edge" in text


def test_contact_is_no_longer_than_the_face():
    cycle = result("fzg_c14", positions=1)
    assert_allclose(cycle.contact_length[0], 14.0, rtol=1e-6)


def test_summary_of_a_line_contact_says_so():
    text = result("fzg_c14", positions=1).summary()
    assert "note: at 1 of 1 positions the unloaded contact is a line" in text


def test_summary_without_load_shows_zeros():
    text = result(torques=(0.0,), positions=2).summary()
    assert line(text, "peak pressure [MPa]").split()[-3] == "0"
    assert line(text, "transmission error, mean").split()[-3:] == ["0", "|", "0"]


def test_repr_is_short():
    assert re.fullmatch(r"MeshCycle\(5 positions, 1 torque, peak \d+\.?\d* MPa\)", repr(result()))
    assert "2 torques" in repr(with_a_gap())
