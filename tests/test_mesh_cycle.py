import re
from dataclasses import fields, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from results import assert_same, result, with_a_gap

from loaded_tca.errors import InputError
from loaded_tca.mesh_cycle import MeshCycle
from loaded_tca.storage import read_netcdf, write_netcdf


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
    assert high["peak_pressure_MPa"] == cycle.peak_pressure[1].max()
    assert_allclose(high["pinion_angle_at_peak_deg"], np.degrees(cycle.pinion_angle[cycle.peak_position(1)]))
    span = np.ptp(cycle.transmission_error[1])
    assert_allclose(high["transmission_error_span_arcsec"], np.degrees(span) * 3600.0)
    assert_allclose(high["transmission_error_span_um"], span * cycle.wheel_base_radius * 1e3)


def test_figures_skip_positions_that_do_not_touch():
    for figures in with_a_gap().key_figures():
        assert figures["touching_positions"] == 4
        assert np.isfinite(list(figures.values())).all()


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
        "1 position; one tooth pair carries the whole load (load sharing off)",
    ]
    assert re.search(r"\[N m\] +130$", line(text, "pinion torque"))
    peak = float(line(text, "peak pressure [MPa]").split()[-1])
    hertz = float(line(text, "  pressure after Hertz there").split()[-1])
    assert_allclose([peak, hertz], 706.85, rtol=5e-3)  # coarse grid
    assert re.search(r" 0 \| 0$", line(text, "  unloaded, peak to peak [arcsec | um]"))
    assert 12 <= len(text.splitlines()) <= 16


def test_peak_where_hertz_holds_leaves_borders_out():
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
    assert line(result(torques=(20.0, 80.0)).summary(), "pinion torque").split()[-2:] == ["20", "80"]


def test_summary_tells_what_limits_it():
    text = edge_contact().summary()
    assert "note: at 2 of 2 positions the contact reaches a border of a flank" in text
    assert "note: at 1 of 5 positions the tooth pair does not touch" in with_a_gap().summary()
    assert "note" not in result(positions=1).summary()


def test_summary_of_a_line_contact_says_so():
    text = result("fzg_c14", positions=1).summary()
    assert "note: at 1 of 1 positions the unloaded contact is a line" in text


def test_summary_without_load_shows_zeros():
    text = result(torques=(0.0,), positions=2).summary()
    assert line(text, "peak pressure [MPa]").split()[-1] == "0"
    assert line(text, "transmission error, mean").split()[-3:] == ["0", "|", "0"]


def test_repr_is_short():
    assert re.fullmatch(r"MeshCycle\(5 positions, 1 torque, peak \d+\.?\d* MPa\)", repr(result()))
    assert "2 torques" in repr(with_a_gap())
