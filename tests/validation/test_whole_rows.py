"""Cases that compare the package with itself: the table has some of their scenes, ``--whole`` these and more."""

import importlib
from types import SimpleNamespace

import numpy as np
import pytest

from validation.loaded import error_estimates, moving_edges, root_stress_families, rounded_edges
from validation.table import Row

ROW = Row("case", "source", "quantity", 1.0, 1.0, None)


def calls(monkeypatch, module, function, result):
    """What a function of a module is called with by its rows, and by its whole rows; it returns a result instead."""
    every = []
    for which in ("rows", "whole_rows"):
        asked = set()
        monkeypatch.setattr(module, function, lambda *arguments, asked=asked: (asked.add(arguments), result)[1])
        assert list(getattr(module, which)())
        every.append(asked)
    return every


@pytest.mark.parametrize(
    ("name", "function", "result"),
    [
        ("jumps", "_row", ROW),
        (
            "random_sensitivities",
            "_of_scene",
            [("load share", SimpleNamespace(seed=0, key="", error=0.0, scatter=0.0))],
        ),
    ],
)
def test_seeds_of_the_table_are_some_of_all(monkeypatch, name, function, result):
    some, every = calls(monkeypatch, importlib.import_module(f"validation.loaded.{name}"), function, result)
    assert some < every


@pytest.mark.parametrize(
    ("recorded", "other"),
    [("estimates_of", "estimates_at_roundings"), ("estimates_at_roundings", "estimates_of")],
)
def test_scenes_of_estimates_in_the_table_are_some_of_all(monkeypatch, recorded, other):
    estimates = [error_estimates.Estimate(kind, 0.02, 0.01) for kind in error_estimates.KINDS]
    monkeypatch.setattr(error_estimates, other, lambda _: [])
    some, every = calls(monkeypatch, error_estimates, recorded, estimates)
    assert some < every


def test_keys_of_sensitivities_in_the_table_are_some_of_all(monkeypatch):
    module = importlib.import_module("validation.loaded.sensitivities")
    monkeypatch.setattr(module, "rows_of_closed_forms", list)
    monkeypatch.setattr(module, "rows_of_cost", list)
    some, every = calls(monkeypatch, module, "rows_of", [ROW])
    assert some < every
    assert {(scene, key) for scene, _, _, key in some} == {(scene, key) for scene, _, _, key in every}


def test_whole_rows_of_moving_edges_tell_the_wider_step(monkeypatch):
    figures = moving_edges.PEAK_TO_PEAK, moving_edges.FIRST, moving_edges.FACTOR, moving_edges.MEAN
    asked = []

    def differences(one, step):
        asked.append((one.scene, one.key, one.cells, step))
        return dict.fromkeys(figures, step)

    monkeypatch.setattr(moving_edges, "_differences", differences)
    monkeypatch.setattr(
        moving_edges, "_rows", lambda one: [ROW for _ in one.allowed if moving_edges._differences(one, one.step)]
    )
    assert all(not row.note for row in moving_edges.rows())
    assert max(cells for _, _, cells, _ in asked) < moving_edges.MOST_CELLS
    wide = [f"over twice the step {2.0 * one.step:.4g}" for one in moving_edges.KEYS for _ in one.allowed]
    assert [row.note for row in moving_edges.whole_rows()] == wide


def test_names_in_the_table_are_those_of_cases(monkeypatch):
    assert {*rounded_edges.IN_TABLE} < {case.name for case in rounded_edges.CASES}
    gears = root_stress_families.families()
    assert {*root_stress_families.IN_TABLE} < {*gears}
    monkeypatch.setattr(root_stress_families, "families", lambda: gears)
    monkeypatch.setattr(root_stress_families, "stress_density", lambda _: root_stress_families.MeshDensity())
    monkeypatch.setattr(root_stress_families, "model_of", lambda gear, _: gear)
    monkeypatch.setattr(root_stress_families, "largest", lambda _: np.ones((1, 2)))
    some, every = list(root_stress_families.rows()), list(root_stress_families.whole_rows())
    assert {row.quantity for row in some} < {row.quantity for row in every}
    assert len(every) == 4 * len(gears)
