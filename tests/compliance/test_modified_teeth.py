"""Finite elements follow the flanks without modifications, but a tooth that these make impossible is still refused."""

from pathlib import Path

import pytest

from loaded_tca.compliance import tooth_compliance
from loaded_tca.errors import GeometryError
from loaded_tca.scene import read_scene

SPUR = Path(__file__).parents[2] / "examples" / "scenes" / "spur.toml"


@pytest.mark.parametrize("amount", [1.5, 3.0])
def test_tooth_that_modifications_make_pointed_is_refused(amount):
    changes = {"pinion.modifications.polynomial_mm": [amount, 0.0, 0.0, 0.0, 0.0, 0.0]}
    with pytest.raises(GeometryError, match="pinion: pointed tooth"):
        tooth_compliance(read_scene(SPUR).with_changes(changes).pair())
