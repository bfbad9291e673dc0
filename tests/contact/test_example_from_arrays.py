"""The example of plain arrays runs without a screen and gives its number."""

import runpy
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "plot_contact_from_arrays.py"


def test_crowned_roller_is_nearly_an_endless_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    number = runpy.run_path(str(EXAMPLE))["main"]()
    # the profile takes the load off the ends and gives 1.8 % more to the middle
    assert number == pytest.approx(1.018, abs=2e-3)
    assert (tmp_path / "contact_from_arrays.png").exists()
