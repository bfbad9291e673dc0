"""Every example runs, writes its picture, and one number of it is what physics asks for."""

import importlib.util
from pathlib import Path

import pytest

from loaded_tca.scene import read_scene

EXAMPLES = Path(__file__).parents[1] / "examples"

EXPECTED = {
    "plot_pressure_distribution": (1.0, 1e-10),  # the map carries the load: equilibrium
    "plot_contact_from_arrays": (1.018, 2e-3),  # the profile takes load off the ends and gives it to the middle
    "plot_convergence_of_methods": (100.0, 1e-9),  # every start finds the contact
    "plot_misalignment_sensitivity": (-1.0, 0.02),  # shift of the contact over f/(2 c1): first order
    "plot_contact_pattern": (1.0, 2e-3),  # area of the pattern over that of the curvature ellipse
    "plot_hertz_comparison": (1.0, 2e-3),  # peak over that of Hertz, on 49 cells
    "plot_transmission_error": (2.0 / 3.0, 5e-3),  # approach of a Hertz contact under growing load
    "plot_tooth_3d": (1.0, 5e-3),  # the pressure laid on the flank carries the load
}


def loaded(path):
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", EXPECTED)
def test_example_gives_its_number_and_its_picture(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    number, tolerance = EXPECTED[name]
    assert loaded(EXAMPLES / f"{name}.py").main() == pytest.approx(number, abs=tolerance)
    assert [path.name for path in tmp_path.iterdir()] == [f"{name.removeprefix('plot_')}.png"]


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.stem)
def test_example_is_short(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) < 60


@pytest.mark.parametrize("path", sorted((EXAMPLES / "scenes").glob("*.toml")), ids=lambda path: path.stem)
def test_example_scene_is_sound(path):
    assert read_scene(path).pair().pitch > 0.0
