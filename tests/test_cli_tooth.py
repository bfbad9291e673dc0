import pytest

from tests.samples.results import result

FILES = {"pinion.vtk", "wheel.vtk", "pressure.vtk", "pinion.stl", "wheel.stl", "teeth.png"}


@pytest.fixture
def directory(tmp_path):
    """A directory with a result under two torques."""
    result("straight_bevel", positions=3, torques=(20.0, 80.0)).save(tmp_path / "result.nc")
    return tmp_path


def names(directory):
    return {path.name for path in directory.iterdir()}


def test_tooth_writes_surfaces_and_a_picture_beside_the_result(run, directory):
    code, out, errors = run("tooth", directory)
    assert (code, errors) == (0, [])
    assert names(directory) == {"result.nc", *FILES}
    assert all(name in out for name in FILES)


@pytest.mark.thorough
def test_tooth_writes_elsewhere_the_whole_gears_if_asked(run, directory):
    elsewhere = directory / "new" / "place"
    options = ("--out", elsewhere, "--torque", 20, "--position", 2, "--fillet-radius", 0.4, "--whole-gears")
    assert run("tooth", directory / "result.nc", *options)[0] == 0
    assert names(elsewhere) == FILES
    assert run("tooth", directory)[0] == 0
    whole, one = ((place / "wheel.stl").stat().st_size for place in (elsewhere, directory))
    assert whole > 20 * one


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--fillet-radius", 9), "fillet_radius: 9 mm does not fit into the space between two teeth; the largest"),
        (("--fillet-radius", -1), "fillet_radius: -1.0 mm is not positive and finite"),
        (("--torque", 30), "--torque 30: the result has 20, 80 N m"),
        (("--position", 4), "--position 4: the result has the positions 1 to 3"),
    ],
)
def test_what_does_not_fit_is_told_in_one_line(refused, directory, options, told):
    assert told in refused("tooth", directory, *options)
    assert names(directory) == {"result.nc"}


def test_help_says_what_the_files_hold(run, capsys):
    with pytest.raises(SystemExit):
        run("tooth", "--help")
    shown = capsys.readouterr().out
    assert all(name in shown for name in FILES)
    assert "mm" in shown
