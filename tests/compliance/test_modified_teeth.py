"""Teeth that cannot be built do not bend; where modifications alone leave none, that without them bends."""

from pathlib import Path

import pytest

from loaded_tca.compliance import require_teeth
from loaded_tca.errors import AccuracyWarning, GeometryError, InputError
from loaded_tca.scene import read_scene

SPUR = read_scene(Path(__file__).parents[2] / "examples" / "scenes" / "spur.toml")
WAY_OUT = r'; or set analysis\.compliance = "contact"$'


@pytest.mark.parametrize("amount", [1.5, 3.0])
def test_tooth_that_modifications_make_pointed_bends_as_the_one_without_them(amount):
    changes = {"pinion.modifications.polynomial_mm": [amount, 0.0, 0.0, 0.0, 0.0, 0.0]}
    with pytest.warns(
        AccuracyWarning, match=r"^pinion, with its modifications: pointed tooth: .*without modifications$"
    ):
        require_teeth(SPUR.with_changes(changes).pair())


def test_tooth_that_cannot_be_built_is_refused_with_the_way_out(monkeypatch):
    def build(*_):
        raise GeometryError("the undercut of both sides cuts off the tooth")

    monkeypatch.setattr("loaded_tca.compliance.teeth.build_tooth", build)
    other = SPUR.with_changes({"pinion.bore_diameter_mm": 41.0})  # teeth that are known are not built again
    with pytest.raises(GeometryError, match=f"^pinion: the undercut of both sides cuts off the tooth{WAY_OUT}"):
        require_teeth(other.pair())


def test_bore_without_a_rim_is_refused_with_the_way_out():
    with pytest.raises(InputError, match=f"^wheel: bore_diameter: 163 mm.*no rim is left.*{WAY_OUT}"):
        require_teeth(SPUR.with_changes({"wheel.bore_diameter_mm": 163.0}).pair())
