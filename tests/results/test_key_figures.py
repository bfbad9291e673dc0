"""Figures of a whole cycle: means over a pitch, and which contact a figure is of."""

import warnings
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.ndimage import binary_dilation

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning, InputError
from loaded_tca.plots import plot_transmission_error
from loaded_tca.results.key_figures import mean_over_a_pitch
from loaded_tca.results.pressure_map import place_on_material
from loaded_tca.scene import read_scene
from loaded_tca.unloaded.teeth import harmonic_coefficients
from tests.samples.results import FLANKS_ALONE, SCENES, changed, result

ROUNDING = 1e-12  # of sums over nine positions of terms up to 12 um


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.floats(0.0, 6.3), st.integers(4, 40))
def test_mean_of_a_harmonic_over_a_pitch_is_its_constant(constant, amplitude, phase, intervals):
    """Both ends are one place: counted twice, the mean would follow the phase."""
    wave = constant + amplitude * np.cos(np.linspace(0.0, 2.0 * np.pi, intervals + 1) + phase)
    assert_allclose(mean_over_a_pitch(wave), constant, atol=1e-9)


WAVES = st.lists(st.tuples(st.floats(0.1, 10.0), st.floats(-3.1, 3.1)), min_size=1, max_size=5)


@given(st.floats(-100.0, 100.0), WAVES, st.integers(12, 40))
def test_harmonics_of_a_known_curve_are_its_amplitudes_and_phases(constant, waves, intervals):
    turn = np.linspace(0.0, 2.0 * np.pi, intervals + 1)
    curve = constant + sum(height * np.cos(k * turn + phase) for k, (height, phase) in enumerate(waves, start=1))
    found = harmonic_coefficients(curve, len(waves))
    assert_allclose(found, [height * np.exp(1j * phase) for height, phase in waves], atol=1e-11)  # rounding of 100


def test_phases_of_the_transmission_error_count_from_the_pitch_point():
    """TE = mean + sum of amplitude cos(order z1 phi1 + phase), whatever pinion angle the positions begin at."""
    cycle = result("mesh_cycle_spur", positions=7, torques=(40.0, 130.0))
    turn = 34 * cycle.pinion_angle
    waves = [(3e-5, 0.4), (1e-5, -2.0)]
    curve = sum(height * np.cos(k * turn + phase) for k, (height, phase) in enumerate(waves, start=1))
    cycle = changed(cycle, transmission_error=np.stack([curve - 1e-4, -2.0 * curve]))
    heights, phases = np.transpose(waves)
    assert_allclose(cycle.harmonics(2), [heights, 2.0 * heights], rtol=1e-9)
    assert_allclose(cycle.harmonic_phases(2)[0], phases, rtol=1e-9)
    assert_allclose(np.exp(1j * cycle.harmonic_phases(2)[1]), -np.exp(1j * phases), rtol=1e-9)  # upside down
    assert np.isnan(cycle.harmonic_phases(3)[:, 2]).all()  # six positions know the orders below three
    assert np.isnan(result(positions=5).harmonic_phases(1)).all()  # one pair carries all


def test_orders_of_the_transmission_error_are_its_amplitudes_at_the_base_circle():
    """4, 2 and 1 um of the orders 1 to 3, half their peak-to-peak: TE = mean + sum of amplitude cos(...)."""
    cycle = result("mesh_cycle_spur", positions=9, torques=(130.0,))
    turn = np.linspace(0.0, 2.0 * np.pi, 9)
    curve = 4.0 * np.cos(turn + 0.3) + 2.0 * np.cos(2.0 * turn - 1.0) + np.cos(3.0 * turn)
    wheel_base_radius = 0.5 * 57 * 3.0 * np.cos(np.radians(20.0))
    (figures,) = changed(cycle, transmission_error=1e-3 / wheel_base_radius * (curve - 12.0)[None]).key_figures()
    found = [figures[f"transmission_error_order_{order}_um"] for order in (1, 2, 3)]
    assert_allclose(found, [4.0, 2.0, 1.0], rtol=ROUNDING)
    assert_allclose(figures["transmission_error_mean_um"], -12.0, rtol=ROUNDING)


@pytest.mark.parametrize("count", [0, 1.5, None])
def test_count_of_phases_that_is_no_whole_number_is_refused(count):
    with pytest.raises(InputError, match="count"):
        result().harmonic_phases(count)


def test_mean_leaves_positions_without_a_value_out():
    assert mean_over_a_pitch(np.array([np.nan, 2.0, 2.0, 8.0])) == (2.0 + 2.0 + 4.0) / 2.5
    assert np.isnan(mean_over_a_pitch(np.full(3, np.nan)))
    assert mean_over_a_pitch(np.array([7.0])) == 7.0


@pytest.mark.parametrize("name", ["mesh_stiffness", "secant_stiffness"])
def test_mean_stiffness_counts_the_end_of_the_pitch_once(name):
    cycle = result("mesh_cycle_spur", positions=5, torques=(130.0,))
    (figures,) = cycle.key_figures()
    (values,) = getattr(cycle, name)
    assert_allclose(values[0], values[-1], rtol=2e-3)  # a pitch apart: the same, to the grid
    assert_allclose(figures[f"{name}_mean_N_per_mm_um"], values[:-1].mean(), rtol=1e-3)


def test_mean_transmission_error_is_drawn_as_it_is_told():
    cycle = result("mesh_cycle_spur", positions=5, torques=(130.0,))
    (figures,) = cycle.key_figures()
    about_mean = plot_transmission_error(cycle).axes[1].get_lines()[1].get_ydata()
    arcsec = np.degrees(cycle.transmission_error[0]) * 3600.0
    assert_allclose(arcsec - about_mean, figures["transmission_error_mean_arcsec"], rtol=1e-9)


def test_line_load_and_its_ratio_are_of_the_most_loaded_pair():
    cycle = result("mesh_cycle_helical", positions=5, torques=(260.0,))
    (figures,) = cycle.key_figures()
    at = np.unravel_index(int(np.nanargmax(cycle.normal_force)), cycle.normal_force.shape)
    assert figures["line_load_at_largest_force_N_per_mm"] == cycle.line_load[at]
    assert figures["line_load_ratio_at_largest_force"] == cycle.line_load_ratio[at]
    assert figures["line_load_max_N_per_mm"] >= cycle.line_load[at]
    along = cycle.face_width / np.cos(cycle.scene.mesh().pinion.base_helix_angle)  # of a line of contact over the face
    mean = cycle.normal_force[at] / along
    assert_allclose(cycle.line_load_ratio[at], cycle.line_load[at] / mean, rtol=2e-3)  # crowning turns lines a little


def test_edge_pressure_stands_with_its_force_and_place():
    cycle = result("misaligned", positions=5)
    (figures,) = cycle.key_figures()
    at = np.unravel_index(int(np.nanargmax(cycle.edge_pressure)), cycle.edge_pressure.shape)
    assert figures["edge_pressure_MPa"] == cycle.edge_pressure[at] > figures["peak_pressure_MPa"]
    assert figures["normal_force_at_edge_N"] == cycle.normal_force[at]
    assert_allclose(figures["pinion_angle_at_edge_deg"], np.degrees(cycle.pinion_angle[at[1]]))
    assert 0.5 * cycle.face_width - 1.0 < figures["pinion_axial_at_edge_mm"] < 0.5 * cycle.face_width  # mm
    assert figures["edge_is_rounded"] is False
    (smooth,) = result(positions=1).key_figures()
    assert np.isnan([smooth["edge_pressure_MPa"], smooth["normal_force_at_edge_N"]]).all()


@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # that it is reached
@pytest.mark.parametrize("cells", [(16, 16), (24, 31)])
def test_place_of_a_cell_beyond_an_edge_is_on_the_edge(cells):
    """Whatever part of a cell the end of either face leaves, and at their corners; the others keep their middles."""
    scene = read_scene(SCENES / "misaligned.toml").with_changes({**FLANKS_ALONE, "analysis.positions": 2})
    cycle = analyse(scene.with_changes({"analysis.cells": cells}))
    pair, one = cycle.gear_pair, cycle.maps[0][0][int(cycle.peak_column[0, 0])]
    diagonal, bare = np.hypot(*one.spacing), np.isinf(one.gap)
    beside = binary_dilation(~bare, np.ones((3, 3), dtype=bool)) & bare
    assert beside.any()

    def room(x, y):
        """Distance to the nearest edge of both flanks."""
        point = one.origin + x * one.axes[0] + y * one.axes[1]
        radius, _, axial = pair.to_wheel(point)
        return min(pair.pinion.flank.room(np.hypot(*point[:2]), point[2]), pair.wheel.flank.room(radius, axial))

    beyond = 0
    for row, column in np.argwhere(beside | ~bare).tolist():
        middle = one.x[row], one.y[column]
        found = place_on_material(pair, one, (row, column))
        if bare[row, column] and room(*middle) < 0.0:  # in the plane, from which the flanks fall away
            beyond += 1
            assert_allclose(room(*found), 0.0, atol=1e-4)
            assert np.hypot(*np.subtract(found, middle)) <= 1.001 * diagonal
        else:
            assert_array_equal(found, middle)
    assert beyond > 5


def test_load_factors_of_the_figures_are_those_of_the_result():
    cycle = result("mesh_cycle_helical", positions=5, torques=(130.0, 260.0))
    for figures, face, transverse in zip(
        cycle.key_figures(), cycle.face_load_factor, cycle.transverse_load_factor, strict=True
    ):
        assert (figures["face_load_factor"], figures["transverse_load_factor"]) == (face, transverse)
    row = next(row for row in cycle.summary().splitlines() if row.startswith("load factors K_Hbeta | K_Halpha"))
    assert row.split()[-3:] == [f"{face:.4g}", "|", f"{transverse:.4g}"]
    assert "K_Hbeta" not in result(positions=1).summary()


@cache
def refined(accuracy, torques=(65.0, 130.0)):
    """Pairs of which some reach an edge at every position, on grids that an accuracy chooses."""
    changes = {**FLANKS_ALONE, "analysis.positions": 3, "analysis.torques_Nm": torques, "analysis.accuracy": accuracy}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # some contacts reach an edge
        return analyse(read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(changes))


@pytest.mark.thorough
def test_discretisation_error_bounds_the_error_of_the_peak_by_the_grid():
    coarse, fine = refined(1e-2), refined(1e-4)
    known = np.isfinite(coarse.discretisation_error) & np.isfinite(fine.discretisation_error)
    assert known.sum() > 4
    error = np.abs(coarse.peak_pressure / fine.peak_pressure - 1.0)[known]
    assert (error <= (coarse.discretisation_error + fine.discretisation_error)[known]).all()
    for cycle, accuracy in ((coarse, 1e-2), (fine, 1e-4)):
        assert (cycle.discretisation_error[known & ~cycle.on_edge] <= accuracy).all()
    moved = np.abs(coarse.transmission_error - fine.transmission_error)
    assert (moved <= coarse.transmission_error_by_grids + fine.transmission_error_by_grids).all()


def test_discretisation_error_is_known_of_every_contact_under_load():
    cycle = refined(1e-2)
    under_load = cycle.normal_force > 0.0
    assert (cycle.on_edge & under_load).any()
    assert_array_equal(np.isfinite(cycle.discretisation_error), under_load)
    assert np.isnan(refined(1e-2, (0.0, 130.0)).discretisation_error[0]).all()
    cells_given = result("mesh_cycle_helical", positions=3, torques=(130.0,))
    assert np.isnan(cells_given.discretisation_error).all()


def test_error_of_the_rotation_by_grids_is_a_part_of_it_that_the_accuracy_bounds():
    """Each approach is at most the way of the wheel along that normal, and changes by less than the accuracy."""
    cycle = refined(1e-2, (0.0, 130.0))
    idle, loaded = cycle.transmission_error_by_grids
    assert_array_equal(idle, 0.0)
    deflection = np.abs(cycle.transmission_error - cycle.unloaded_transmission_error)[1]
    assert (loaded > 0.0).all()
    assert (loaded <= 1e-2 * deflection).all()
    cells_given = result("mesh_cycle_helical", positions=3, torques=(130.0,))
    assert np.isnan(cells_given.transmission_error_by_grids).all()


def test_errors_by_grids_are_told_of_given_cells_that_the_solver_starts_from_half_of():
    """From 32 cells along an axis on; slices of a contact at an edge would need a second grid of their own."""
    scene = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes({**FLANKS_ALONE, "analysis.positions": 3})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # some contacts reach an edge
        fewer, enough = (analyse(scene.with_changes({"analysis.cells": (16, along)})) for along in (31, 32))
    assert np.isnan(fewer.transmission_error_by_grids).all()
    assert np.isnan(fewer.discretisation_error).all()
    assert (enough.transmission_error_by_grids > 0.0).all()
    smooth = (enough.normal_force > 0.0) & ~enough.on_edge & ~enough.on_relief_start
    assert smooth.any()
    assert (enough.discretisation_error[smooth] > 0.0).all()
    assert np.isnan(enough.discretisation_error[enough.on_edge]).all()


def test_largest_discretisation_error_is_that_of_its_torque():
    cycle = refined(1e-2, (0.0, 130.0))
    without, loaded = (figures["largest_discretisation_error"] for figures in cycle.key_figures())
    assert np.isnan(without)
    assert loaded == np.nanmax(cycle.discretisation_error[1])
