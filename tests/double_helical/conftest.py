"""A double helical pair of few cells whose flanks alone give way."""

import pytest

from loaded_tca import read_scene

QUICK = {
    "analysis.compliance": "contact",
    "analysis.cells": [8, 16],
    "analysis.free_edges": False,
    "analysis.positions": 2,
    "pair.apex_offset_mm": 0.0,
    "pinion.half_b": None,
}


@pytest.fixture(scope="session")
def example():
    """As its file has it."""
    return read_scene("examples/scenes/double_helical.toml")


@pytest.fixture(scope="session")
def equal_halves(example):
    """Both halves alike, nothing displaced."""
    return example.with_changes(QUICK)


@pytest.fixture(scope="session")
def unlike_halves(equal_halves):
    """Half b with a helix slope on the pinion."""
    return equal_halves.with_changes({"pinion.half_b": {"modifications": {"helix_slope_um": 8.0}}})
