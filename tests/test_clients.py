"""Files of this package in programs of others: each test is skipped where its program is not installed."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.io import netcdf_file

from loaded_tca.output import teeth_in_space, write_report, write_teeth
from loaded_tca.pairs import mating_teeth
from loaded_tca.tooth import Resolution
from tests.samples.results import result
from tests.test_examples import EXAMPLES, loaded

TORQUE = 130.0
NINE_DIGITS = 5e-9
"""Half of the last digit that tables have."""


def cycle():
    """A mesh cycle of spur gears; its four places on the pitch hold the first order."""
    return result("mesh_cycle_spur", positions=5, torques=(TORQUE,))


def client(name):
    """Module of a program, without what it says while it is imported, or the test is skipped."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        return pytest.importorskip(name)


def run_example(name, tmp_path, monkeypatch):
    """What an example returns that takes the cycle for its analysis, and writes the tables alone."""
    monkeypatch.chdir(tmp_path)
    example = loaded(EXAMPLES / f"{name}.py")
    monkeypatch.setattr(example, "analyse", lambda _: cycle())
    numbers = example.main()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dynamics.csv", "dynamics_orders.csv"]
    return numbers


@pytest.mark.thorough
def test_rotors_of_ross_have_natural_frequency_and_resonance_of_the_closed_form(tmp_path, monkeypatch):
    """Bearings of 1e13 N/m give way beside a mesh of 1e9: by 1e-4 of the stiffness each, by half of it in frequency."""
    client("ross")
    frequency, amplitude = run_example("dynamics_with_ross", tmp_path, monkeypatch)
    assert_allclose(frequency, 1.0, atol=2e-4)
    assert_allclose(amplitude, 1.0, atol=2e-4)  # at a peak, flat in the frequency


@pytest.mark.thorough
def test_bodies_of_exudyn_have_the_resonance_of_the_closed_form(tmp_path, monkeypatch):
    """Teeth that separate and a stiffness that varies bound the amplitude, which is larger than the deflection."""
    client("exudyn")
    linear, whole = run_example("dynamics_with_exudyn", tmp_path, monkeypatch)
    assert_allclose(linear, 1.0, atol=1e-2)  # the start dies away by exp(-2 pi 0.08 20) = 4e-5; the mesh phase swings
    assert 0.0 < whole < linear


def test_netcdf4_reads_the_file_of_a_result_as_scipy_does(tmp_path):
    netcdf4 = client("netCDF4")
    cycle().save(tmp_path / "result.nc")
    with netcdf_file(tmp_path / "result.nc", mmap=False) as expected, netcdf4.Dataset(tmp_path / "result.nc") as file:
        file.set_auto_mask(False)  # unknown values as NaN
        assert file.data_model == "NETCDF3_64BIT_OFFSET"
        assert file.title == cycle().scene.title
        assert {name: len(size) for name, size in file.dimensions.items()} == expected.dimensions
        assert set(file.variables) == set(expected.variables)
        for name, variable in expected.variables.items():
            assert file[name].dimensions == variable.dimensions
            assert_array_equal(file[name][...], variable.data, err_msg=name)  # exact: the same bytes
            assert (file[name].units, file[name].long_name) == (variable.units.decode(), variable.long_name.decode())


def test_pandas_reads_the_tables_of_a_result(tmp_path):
    """A row for each position, and for each pair under load; widths are full ones, lengths in um."""
    pandas = client("pandas")
    write_report(cycle(), tmp_path)
    positions, contacts = (pandas.read_csv(tmp_path / f"{name}.csv") for name in ("positions", "contacts"))
    shares = cycle().load_share[0]
    expected = {
        "pinion_angle_deg": np.degrees(cycle().pinion_angle),
        "transmission_error_um": 1e3 * cycle().wheel_base_radius * cycle().transmission_error[0],
        "peak_pressure_MPa": np.nanmax(cycle().peak_pressure[0], axis=-1),
    }
    for name, values in expected.items():
        assert_allclose(positions[name], values, rtol=NINE_DIGITS, err_msg=name)
    assert_allclose(contacts["load_share"], shares[shares > 0.0], rtol=NINE_DIGITS)
    assert (contacts.groupby("position").size() == cycle().loaded_pairs[0]).all()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Files of the teeth of a bevel pair in contact."""
    teeth, cycle = bevel_teeth()
    return write_teeth(teeth_in_space(cycle, teeth), teeth, tmp_path_factory.mktemp("teeth"))[0].parent


def bevel_teeth():
    cycle = result("straight_bevel", positions=3)
    return mating_teeth(cycle.gear_pair, Resolution(9, 5, 3, 5)), cycle


def test_pyvista_reads_surfaces_with_their_fields(folder):
    pyvista = client("pyvista")
    teeth, cycle = bevel_teeth()
    shown = teeth_in_space(cycle, teeth)
    for name in ("pinion", "wheel", "pressure"):
        surface, mesh = pyvista.read(folder / f"{name}.vtk"), getattr(shown, name)
        assert_array_equal(surface.points, mesh.vertices)  # exact: double precision
        assert_array_equal(surface.faces.reshape(-1, 4)[:, 1:], mesh.triangles)
        assert set(surface.cell_data) == set(mesh.cell_data)
        for field, values in mesh.cell_data.items():
            assert_array_equal(surface.cell_data[field], values)


@pytest.mark.parametrize("reader", ["meshio", "pyvista"])
def test_solids_are_read_as_closed_surfaces_with_their_volume(reader, folder):
    """In single precision; a sphere has two corners more than half its triangles."""
    solid = bevel_teeth()[0].wheel.triangles(1, closed=True)
    surface = client(reader).read(folder / "wheel.stl")
    faces = surface.cells_dict["triangle"] if reader == "meshio" else surface.faces.reshape(-1, 4)[:, 1:]
    assert len(faces) == len(solid.triangles)
    assert len(surface.points) == len(faces) / 2 + 2
    corners = surface.points.astype(float)[faces]
    assert_allclose(np.linalg.det(corners).sum() / 6.0, solid.volume, rtol=1e-4)
