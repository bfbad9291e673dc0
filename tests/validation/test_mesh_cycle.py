"""The comparison of the mesh cycle with finite elements: what it reads, and a position of it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from validation.calculix.case import line_load, pinion_angle
from validation.calculix.comparison import PairLoad, Position, model, read_cycles
from validation.calculix.mesh_cycle import is_parting, rows_of, share_difference, stiffness_errors
from validation.calculix.pairs_in_space import InSpace, read_in_space, rows_of_crowned, rows_of_flat
from validation.calculix.tables import write_table

PLAIN = {"variant": "unmodified", "torque_Nm": 20.0}
PITCH_POINT = Position(pinion_angle(12), -2.128652, 13.87221, {0: PairLoad(1.0, 363.1, 363.1, False)}, 7.8)
"""As kept of finite elements in plane strain."""
ENDS = 3e-2
"""What the free ends of a narrow face change, and what is asked."""


def position_row(index, error):
    return {
        **PLAIN,
        "position": index,
        "pinion_angle_rad": pinion_angle(index),
        "transmission_error_um": error,
        "mesh_stiffness_N_per_mm_um": 20.0,
        "seconds": 9.0,
    }


def contact_row(index, pair, share, corner="no", fitted=309.0):
    return {
        **PLAIN,
        "position": index,
        "pair": pair,
        "load_share": share,
        "peak_pressure_MPa": 310.0,
        "fitted_pressure_MPa": fitted,
        "corner": corner,
    }


@pytest.fixture
def tables(tmp_path):
    positions, contacts = tmp_path / "positions.csv", tmp_path / "contacts.csv"
    write_table(positions, ["a test"], [position_row(12, -2.0), position_row(8, -1.9)])
    rows = [
        contact_row(12, 0, 1.0),
        contact_row(8, -1, 0.1, "pinion", float("nan")),
        contact_row(8, 0, 0.9),
    ]
    write_table(contacts, ["a test"], rows)
    return positions, contacts


def test_cycles_are_read_in_the_order_of_their_positions(tables):
    cycles = read_cycles(*tables)
    assert list(cycles) == [("unmodified", 20.0)]
    before, pitch_point = cycles["unmodified", 20.0]
    np.testing.assert_allclose([before.place, pitch_point.place], [8.0, 12.0], atol=1e-6)  # seven digits are kept
    assert pitch_point.pairs[0].pressure == 309.0
    assert [before.at_corner, pitch_point.at_corner] == [True, False]
    assert before.pairs[-1].pressure == 310.0  # no half ellipse at a corner: the largest node
    assert before.share(1) == 0.0


def test_cycles_that_are_not_kept_are_none(tmp_path):
    assert read_cycles(tmp_path / "positions.csv", tmp_path / "contacts.csv") == {}
    assert read_in_space(tmp_path / "crowned.json") is None


def test_share_difference_counts_pairs_that_one_side_alone_has():
    other = replace(PITCH_POINT, pairs={0: PairLoad(0.96, 350.0, 350.0, False), 1: PairLoad(0.04, 90.0, 90.0, False)})
    assert share_difference(PITCH_POINT, other) == pytest.approx(0.04)
    assert not is_parting(PITCH_POINT, other)
    assert is_parting(PITCH_POINT, replace(other, pairs={**other.pairs, 1: PairLoad(0.01, 50.0, 50.0, False)}))


def test_stiffness_that_is_not_the_slope_of_the_deflections_is_uncertain_by_the_difference():
    """w = F' (0.1 - 0.005 ln F'), its slope 0.1 - 0.005 (ln F' + 1)."""
    kept = {}
    for torque, error in ((20.0, 0.0), (100.0, 0.01), (200.0, -0.02)):
        force = line_load(torque)
        deflection, slope = force * (0.1 - 0.005 * np.log(force)), 0.1 - 0.005 * (np.log(force) + 1.0)
        smooth = replace(PITCH_POINT, transmission_error=-deflection, mesh_stiffness=(1.0 + error) / slope)
        corner = replace(smooth, mesh_stiffness=99.0, pairs={0: PairLoad(1.0, 363.1, 363.1, True)})
        kept["unmodified", torque] = [smooth, corner]
    assert stiffness_errors(kept) == pytest.approx({20.0: 0.0, 100.0: 0.01, 200.0: 0.02}, abs=1e-9)
    assert stiffness_errors({key: kept[key] for key in [*kept][:2]}) == {}


def test_kept_deflections_under_other_torques_support_the_kept_stiffness():
    """To a fraction of what is asked; it is added to that."""
    assert all(0.0 < error < 0.02 for error in stiffness_errors(read_cycles()).values())


def test_rows_tell_a_quantity_beyond_what_is_asked():
    kept, ours = InSpace(240.0, (), 1050.0, -13.4, 600.0), InSpace(250.0, (), 1047.0, -14.3, 5.0)
    line_load, pressure, error = rows_of_crowned("a pair", kept, ours)
    assert pressure.holds
    assert not line_load.holds
    assert not error.holds


def test_rows_of_the_flat_pair_are_at_mid_face_at_the_largest_load_and_at_the_end():
    kept, ours = (
        InSpace(141.0, (141.0, 145.0, 137.0), 0.0, -10.3, 300.0),
        InSpace(140.8, (140.8, 151.0, 138.0), 0.0, -10.25, 2.0),
    )
    assert [row.obtained for row in rows_of_flat("a pair", kept, ours)] == [140.8, 151.0, 138.0, -10.25]
    assert [row.holds for row in rows_of_flat("a pair", kept, ours)] == [True, False, True, True]


@pytest.fixture(scope="module")
def narrow():
    return model(20.0, layers=6)


@pytest.mark.thorough
def test_position_agrees_with_finite_elements(narrow):
    rows = rows_of({("unmodified", 20.0): [PITCH_POINT]}, narrow)
    assert len(rows) == 5
    assert all(row.holds for row in rows)


@pytest.mark.thorough
def test_pressure_at_mid_face_is_below_that_of_the_mean_line_load(narrow):
    (ours,) = narrow.cycle("unmodified", 20.0, [0.0])
    assert ours.pairs[0].pressed < ours.pairs[0].pressure
    assert ours.pairs[0].pressure == pytest.approx(PITCH_POINT.pairs[0].pressure, rel=ENDS)


def test_pair_whose_middle_carries_nothing_has_no_pressure_there(narrow):
    """A pair in contact at the ends of its face alone, as wrong stiffnesses may give it."""
    pressure = np.zeros((4, 6))
    pressure[:, [0, -1]] = 100.0
    loaded = SimpleNamespace(
        solution=SimpleNamespace(pressure=pressure, load=10.0),
        separation=SimpleNamespace(spacing=(0.01, 3.0)),
        contact=SimpleNamespace(on_edge=False),
    )
    assert narrow._pair(loaded, 0.01) == PairLoad(0.01, 0.0, 0.0, False)


@pytest.mark.thorough
def test_relief_lets_the_wheel_lag_by_no_less(narrow):
    plain, relieved = (narrow.cycle(variant, 20.0, [pinion_angle(0)])[0] for variant in ("unmodified", "tip_relief"))
    assert relieved.transmission_error < plain.transmission_error - 2.0  # um; 1.4 and 4.6 by finite elements
