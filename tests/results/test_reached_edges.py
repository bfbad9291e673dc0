"""Edges that loaded contacts reach: told by name, and there wherever a contact is said to reach one."""

import numpy as np
import pytest

from loaded_tca.results.mesh_cycle import NAMES, reached_edges
from tests.samples.results import result, with_a_gap


def names(cycle):
    return {name for name, one in zip(NAMES, reached_edges(cycle).any(axis=(0, 1, 2)), strict=True) if one}


def test_point_contact_in_the_middle_reaches_none():
    assert names(result(positions=1)) == set()


def test_line_contact_reaches_the_sides_of_the_teeth():
    assert names(result("fzg_c14", positions=1)) >= {"pinion lower side", "pinion upper side"}


def test_misaligned_contact_reaches_one_side():
    """Out-of-plane error positive: the contact goes to z > 0."""
    assert names(result("misaligned", positions=1)) in (
        {"pinion upper side"},
        {"wheel upper side"},
        {
            "pinion upper side",
            "wheel upper side",
        },
    )


def test_contact_that_comes_into_mesh_early_reaches_the_tip_of_the_wheel():
    cycle = result("mesh_cycle_helical", positions=5, torques=(260.0,))
    reached = reached_edges(cycle)[0]
    column = {int(pair): k for k, pair in enumerate(cycle.pair)}
    tips = [NAMES.index("wheel tip"), NAMES.index("pinion tip")]
    assert reached[:, column[1], tips[0]].any()
    assert not reached[:, column[1], tips[1]].any()
    assert reached[:, column[-1], tips[1]].any()
    assert not reached[:, column[-1], tips[0]].any()


@pytest.mark.parametrize(
    "make",
    [
        lambda: result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0)),
        lambda: result("mesh_cycle_spur", positions=5, torques=(260.0,)),
        lambda: result("misaligned", positions=2),
        with_a_gap,
    ],
)
def test_edge_is_named_where_and_only_where_a_contact_reaches_one(make):
    cycle = make()
    np.testing.assert_array_equal(reached_edges(cycle).any(axis=-1), cycle.on_edge)
