"""Matrices of [pinion.support] and [wheel.support]: what is refused, and with which words."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.errors import InputError
from loaded_tca.scene.shafts import SupportSection

SOFT = np.diag([1e-6, 2e-6, 1e-6, 1e-10, 1e-10, 3e-10])
STIFF = np.linalg.inv(SOFT)


def changed(matrix: np.ndarray, *entries: tuple[int, int, float]) -> list[list[float]]:
    copy = matrix.copy()
    for row, column, value in entries:
        copy[row, column] = value
    return copy.tolist()


def test_stiffness_is_the_inverse_of_compliance() -> None:
    half = np.random.default_rng(3).normal(size=(6, 6)) * np.sqrt(STIFF.diagonal())[:, None]
    stiffness = half @ half.T
    assert_allclose(SupportSection(stiffness=stiffness.tolist()).matrix @ stiffness, np.eye(6), atol=1e-7)
    assert_allclose(SupportSection(compliance=SOFT.tolist()).matrix, SOFT)


def test_zeros_are_rigid() -> None:
    assert not SupportSection(compliance=np.zeros((6, 6)).tolist()).matrix.any()


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ({}, "compliance: missing; give one of compliance and stiffness"),
        ({"compliance": SOFT.tolist(), "stiffness": STIFF.tolist()}, "compliance: found beside stiffness"),
        ({"compliance": [[1.0] * 6] * 5}, "compliance: found .*; allowed a list of 6 to 6 lists"),
        (
            {"compliance": changed(SOFT, (0, 1, 1e-7))},
            "compliance: not symmetric: found 1e-7 in row 1, column 2, and 0",
        ),
        ({"compliance": changed(SOFT, (3, 3, -1e-9))}, "compliance: found -1e-9 for the motion about x; allowed"),
        (
            {"compliance": changed(SOFT, (0, 1, 2e-6), (1, 0, 2e-6))},
            "compliance: not positive semidefinite: smallest eigenvalue -0.414",
        ),
        ({"stiffness": changed(STIFF, (2, 2, 0.0))}, "stiffness: leaves the gear free along z, its axis; allowed"),
        ({"stiffness": changed(STIFF, (5, 5, 0.0))}, "stiffness: leaves the gear free about z, its axis"),
        ({"stiffness": changed(STIFF, (0, 0, 1e20))}, r"stiffness: found .*up to|stiffness: found .*1e15"),
    ],
)
def test_matrices_that_hold_no_gear_are_refused(section: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        SupportSection(**section)  # type: ignore[arg-type]
