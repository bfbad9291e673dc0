"""Hand-off to dynamics: the curves of a result in SI units, and Fourier coefficients that give them back."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene
from loaded_tca.results import load_result
from tests.refusals import refused_calls
from tests.samples.results import SCENES, changed, result

TORQUES = 40.0, 260.0
SAME_PLACE = 2e-3
"""Relative difference of the first position and the last, a pitch later, each on a grid of its own."""
ROUNDING = 1e-12
"""Of factors, and of sums of eight terms; of an amplitude, of up to a hundredth of max|TE|: 1e-14 was seen."""
PHASE_ROUNDING = 6.0 * np.finfo(float).eps
"""Of a phase, times max|TE| over the amplitude: transforms round by parts of eps of the largest value; 0.6 was seen."""


def cycle(positions=8):
    """An even number of positions: every order that they hold has an amplitude and a phase."""
    return result("mesh_cycle_helical", positions=positions, torques=TORQUES)


def series(dynamics, name, unit):
    """Curves (torque, mesh phase) of the Fourier coefficients."""
    amplitude, phase = dynamics[f"{name}_amplitude{unit}"].values, dynamics[f"{name}_phase_rad"].values
    angle = dynamics.pinion_teeth.item() * dynamics.pinion_angle_rad.values * dynamics.order.values[:, None]
    return (amplitude[..., None] * np.cos(angle + phase[..., None])).sum(axis=1)


CURVES = [("transmission_error", "_m"), ("mesh_stiffness", "_N_per_m"), ("loaded_pairs", "")]


@pytest.mark.thorough
@pytest.mark.parametrize("positions", [2, 5, 8, 9])
def test_pitch_has_every_place_once_from_phase_zero(positions):
    dynamics, whole = cycle(positions).to_dynamics(), cycle(positions)
    phase = dynamics.mesh_phase.values
    assert dict(dynamics.sizes) == {
        "pinion_torque_Nm": 2,
        "mesh_phase": positions - 1,
        "order": 1 + (positions - 2) // 2,
    }
    assert ((phase >= 0.0) & (phase < 1.0)).all()
    assert_allclose(np.diff(phase), 1.0 / (positions - 1), rtol=ROUNDING)
    assert_allclose(dynamics.pinion_angle_rad, 2.0 * np.pi / 34 * phase, rtol=ROUNDING)
    for angle, error in zip(whole.pinion_angle[:-1], whole.transmission_error[1, :-1], strict=True):
        apart = np.abs((dynamics.pinion_angle_rad.values - angle + 0.05) % (2.0 * np.pi / 34) - 0.05)
        assert dynamics.transmission_error_rad.values[1, apart.argmin()] == error  # exact: copied
        assert apart.min() < ROUNDING


def test_cosine_gives_back_its_amplitude_and_phase():
    """5 um and 0.7 rad of the first order, 1 um and -2 rad of the third, about -12 um."""
    whole = cycle()
    turn = 34 * whole.pinion_angle
    lengths = -12.0 + 5.0 * np.cos(turn + 0.7) + np.cos(3 * turn - 2.0)
    cosine = changed(whole, transmission_error=np.tile(1e-3 * lengths / whole.wheel_base_radius, (2, 1)))
    found = cosine.to_dynamics()
    amplitudes, phases = found.transmission_error_amplitude_m.values, found.transmission_error_phase_rad.values
    # atol: m, of an order that is not there; 2e-21 seen
    assert_allclose(amplitudes, 1e-6 * np.tile([-12.0, 5.0, 0.0, 1.0], (2, 1)), rtol=ROUNDING, atol=1e-18)
    assert_allclose(phases[:, [0, 1, 3]], np.tile([0.0, 0.7, -2.0], (2, 1)), rtol=0, atol=ROUNDING)
    assert_allclose(found.transmission_error_m.mean("mesh_phase"), -12e-6, rtol=ROUNDING)


def test_contact_ratio_counts_the_end_of_the_pitch_once():
    """Three of seven positions have two pairs, and the last one, which is the first again."""
    pairs = np.array([2, 2, 1, 1, 1, 1, 2, 2])
    whole = changed(cycle(), loaded_pairs=np.stack([pairs, pairs + 1]))
    assert_allclose(whole.to_dynamics().loaded_contact_ratio, [10.0 / 7.0, 17.0 / 7.0], rtol=ROUNDING)
    found = [one["loaded_contact_ratio"] for one in whole.key_figures()]
    assert_allclose(found, [10.0 / 7.0, 17.0 / 7.0], rtol=ROUNDING)


@pytest.mark.parametrize(("name", "unit"), CURVES)
def test_series_with_all_orders_is_the_curve(name, unit):
    dynamics = cycle().to_dynamics()
    curve = dynamics[f"{name}{unit}"].values
    assert_allclose(series(dynamics, name, unit), curve, rtol=0, atol=ROUNDING * np.abs(curve).max())


@pytest.mark.parametrize(("name", "unit"), CURVES)
def test_mean_square_is_that_of_the_orders(name, unit):
    """Parseval: that of the mean, and half the square of every amplitude."""
    dynamics = cycle().to_dynamics()
    amplitude = dynamics[f"{name}_amplitude{unit}"].values
    of_orders = amplitude[:, 0] ** 2 + 0.5 * (amplitude[:, 1:] ** 2).sum(axis=1)
    assert_allclose((dynamics[f"{name}{unit}"].values ** 2).mean(axis=1), of_orders, rtol=ROUNDING)


def test_units_are_those_of_the_key_figures_converted():
    """25 mm of face; N/(mm um) are 1e6 N/m for each mm."""
    whole = cycle()
    dynamics, figures = whole.to_dynamics(), whole.key_figures()
    for name, figure, factor in (
        ("mesh_stiffness_amplitude_N_per_m", "mesh_stiffness_mean_N_per_mm_um", 25.0 * 1e6),
        ("transmission_error_amplitude_m", "transmission_error_mean_um", 1e-6),
        ("loaded_pairs_amplitude", "loaded_contact_ratio", 1.0),
    ):
        expected = [factor * one[figure] for one in figures]
        assert_allclose(dynamics[name].values[:, 0], expected, rtol=SAME_PLACE)
    assert_allclose(dynamics.loaded_contact_ratio, dynamics.loaded_pairs_amplitude[:, 0], rtol=ROUNDING)
    for order in (1, 2, 3):
        expected = [1e-6 * one[f"transmission_error_order_{order}_um"] for one in figures]
        assert_allclose(dynamics.transmission_error_amplitude_m.values[:, order], expected, rtol=ROUNDING)
    largest = np.abs(whole.transmission_error).max(axis=1, keepdims=True)
    apart = np.abs(dynamics.transmission_error_phase_rad.values[:, 1:] - whole.harmonic_phases(3))
    assert (apart <= PHASE_ROUNDING * largest / whole.harmonics(3)).all()
    assert dynamics.pinion_torque_Nm.values.tolist() == list(TORQUES)
    assert (dynamics.pinion_teeth, dynamics.wheel_teeth, dynamics.face_width_m) == (34, 57, 0.025)
    assert dynamics.mesh_frequency_Hz_per_pinion_rev_per_s == 34


def test_radii_turn_forces_into_torques_and_lengths_into_angles():
    """Helical teeth 34/57, m_n 3, 15 deg: r_b = z m_t/2 cos(alpha_t), and cos(beta_b) = sin(alpha_n)/sin(alpha_t)."""
    dynamics = cycle().to_dynamics()
    helix, transverse = np.radians(15.0), np.arctan(np.tan(np.radians(20.0)) / np.cos(np.radians(15.0)))
    radii = 0.5e-3 * np.array([34, 57]) * 3.0 / np.cos(helix) * np.cos(transverse)
    assert_allclose([dynamics.pinion_base_radius_m, dynamics.wheel_base_radius_m], radii, rtol=ROUNDING)
    assert_allclose(dynamics.transmission_error_m, radii[1] * dynamics.transmission_error_rad, rtol=ROUNDING)
    ratio = dynamics.torsional_stiffness_Nm_per_rad / dynamics.mesh_stiffness_N_per_m
    assert_allclose(ratio, radii[1] ** 2, rtol=ROUNDING)
    along_normal = np.sin(transverse) / np.sin(np.radians(20.0)) / radii[0]
    force = dynamics.normal_force_per_torque_N_per_Nm
    assert_allclose(force, along_normal, rtol=2e-3)  # lengthwise crowning tilts the normals a little


@pytest.mark.thorough
def test_angles_of_cylindrical_gears_give_the_direction_of_the_force():
    """sin(beta_b) = sin(beta) cos(alpha_n); no profile shift: alpha_wt = alpha_t."""
    dynamics = cycle().to_dynamics()
    helix, transverse = np.radians(15.0), np.arctan(np.tan(np.radians(20.0)) / np.cos(np.radians(15.0)))
    sign = {"right": 1.0, "left": -1.0}[cycle().scene.hands[0]]
    base_helix = sign * np.arcsin(np.sin(helix) * np.cos(np.radians(20.0)))
    assert_allclose(dynamics.pinion_base_helix_angle_rad, base_helix, rtol=ROUNDING)
    assert_allclose(dynamics.working_pressure_angle_rad, transverse, rtol=1e-7)
    bevel = result("mesh_cycle_bevel", positions=5, torques=(98.0, 100.0, 102.0)).to_dynamics()
    assert not {"pinion_base_helix_angle_rad", "working_pressure_angle_rad"} & {*bevel}


@pytest.mark.quick_cases("helical")
@pytest.mark.parametrize("name", ["helical", "bevel"])
def test_stiffness_is_the_slope_of_the_transmission_error(name):
    """Between two torques the wheel falls back by the change of T1/r_b1 over the stiffness."""
    dynamics = result(f"mesh_cycle_{name}", positions=5, torques=(98.0, 100.0, 102.0)).to_dynamics()
    fallen = dynamics.transmission_error_m[0] - dynamics.transmission_error_m[2]
    force = 4.0 / dynamics.pinion_base_radius_m.item()
    assert_allclose(force / fallen, dynamics.mesh_stiffness_N_per_m[1], rtol=0.03)  # cells come into contact in steps


def test_without_load_there_is_no_stiffness_and_no_force():
    dynamics = result("mesh_cycle_helical", positions=4, torques=(0.0, 40.0)).to_dynamics()
    assert_allclose(dynamics.transmission_error_m[0], dynamics.unloaded_transmission_error_m, rtol=ROUNDING)
    assert (dynamics.mesh_stiffness_N_per_m[0] == 0.0).all()
    assert dynamics.normal_force_per_torque_N_per_Nm[0].isnull().all()
    assert dynamics.loaded_contact_ratio.values[0] == 0.0


def test_every_variable_has_its_unit_at_the_end_of_its_name():
    dynamics = cycle().to_dynamics()
    endings = {"m": "_m", "rad": "_rad", "N/m": "_N_per_m", "N m/rad": "_Nm_per_rad", "N m": "_Nm", "1/m": "_N_per_Nm"}
    for name, one in dynamics.variables.items():
        assert one.attrs["long_name"]
        assert str(name).endswith(endings.get(one.attrs["units"], "")), name
    assert "The pinion drives; teeth do not bend." in dynamics.attrs["conventions"]


@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
def test_gears_on_supports_are_said_to_give_way_in_the_transmission_error_alone():
    """Two torques 2 % apart: the tangent of the tables is that of the teeth, several times the slope of the error."""
    compliance = [[1e-5 if i == j < 3 else 0.0 for j in range(6)] for i in range(6)]  # mm/N
    few = {"analysis.positions": 2, "analysis.torques_Nm": (128.7, 131.3), "analysis.cells": (8, 16)}
    scene = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(few | {"analysis.accuracy": None})
    for supports in ({}, {"wheel.support.compliance": compliance}):
        found = analyse(scene.with_changes({"analysis.compliance": "contact", **supports})).to_dynamics()
        slope = np.diff(found.pinion_torque_Nm) / found.pinion_base_radius_m.item()
        slope = slope / -np.diff(found.transmission_error_m.values[:, 0])
        stiffness = found.mesh_stiffness_N_per_m.values[:, 0].mean()
        said = "here it is no derivative of r_b2 TE" in found.attrs["conventions"]
        assert said == bool(supports)
        assert (stiffness > 2.0 * slope[0]) if supports else abs(stiffness / slope[0] - 1.0) < 0.05  # of few cells


def test_dataset_is_the_same_of_a_file(tmp_path):
    cycle().save(tmp_path / "result.nc")
    assert load_result(tmp_path / "result.nc").to_dynamics().identical(cycle().to_dynamics())
    cycle().to_dynamics().to_netcdf(tmp_path / "dynamics.nc", engine="scipy")  # nothing in it that NetCDF-3 has not


test_result_without_a_period_is_refused = refused_calls(
    (lambda: result().to_dynamics(), (r"^analysis\.load_sharing: found false; .* has no period",)),
    (lambda: cycle(1).to_dynamics(), (r"^analysis\.positions: found 1; .* from 2 positions on$",)),
)
