"""Whole revolutions under load: limits, slopes, shares, files, refusals."""

import io
import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import InputError, Revolution, analyse, analyse_revolution, load_result, read_scene
from loaded_tca import warning_kinds as kinds
from loaded_tca.plots.revolution import plot_revolution_error, plot_revolution_spectrum
from loaded_tca.revolution import _Numbers, _sentences, expected_revolution_effort
from loaded_tca.studies import Study, revolution_figures, run_study
from loaded_tca.unloaded.tooth_cycle import REACH
from tests.refusals import refused_calls
from tests.samples.pictures import told
from tests.samples.revolutions import FIRST, small_turn
from tests.samples.root_stress import coarsely

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")

A_CELL = 3e-4
"""Of the tangent of 16 x 16 cells, of which one more just carries or does not: rounding decides."""
ROUNDING_um = 1e-12
"""Of amplitudes of curves of tens of um."""
AS_ONE_PITCH_um = 1e-4
"""Asked for: without deviations the transmission error of the analysis of one pitch."""
SLOPES = 2e-3
"""Asked for: of the slope to the deviation of one tooth."""
STEP_um = 0.2
"""Of differences: a few thousandths of the deflection, so that the tangent holds within 1e-4 of it."""
COARSE = {"analysis.cells": [16, 24], "analysis.accuracy": None}
FINE = {"analysis.cells": [48, 64]}
"""Of tangents: with COARSE whole cells that come into contact move them by 3e-3, with these by 5e-4."""
CONTACT = COARSE | {"analysis.compliance": "contact", "analysis.free_edges": False}
SMALL = {"pinion.teeth": 17, "wheel.teeth": 24, "analysis.torques_Nm": [60.0]}


def scene_of(name, changes):
    return read_scene(f"examples/scenes/{name}.toml").with_changes(changes)


def helical(changes=CONTACT):
    return scene_of("mesh_cycle_helical", SMALL | dict(changes))


def revolution_of(scene, pitches, per_pitch=4, **changes):
    asked = {"revolution.pitches": pitches, "revolution.positions_per_pitch": per_pitch}
    return analyse_revolution(scene.with_changes(asked | changes))


@pytest.mark.quick_cases("mesh_cycle_spur-changes0", "mesh_cycle_bevel-changes2")
@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("mesh_cycle_spur", CONTACT | {"analysis.torques_Nm": [60.0]}),
        ("mesh_cycle_helical", COARSE | SMALL),
        ("mesh_cycle_bevel", CONTACT | {"analysis.torques_Nm": [0.8]}),
        ("face_milled_19x62", CONTACT | {"analysis.torques_Nm": [50.0]}),
    ],
)
def test_revolution_of_alike_teeth_is_the_analysis_of_one_pitch(name, changes):
    scene = scene_of(name, changes | {"analysis.positions": 5})
    one, turn = analyse(scene), revolution_of(scene, 2)
    places = np.round(4.0 * one.pinion_angle[:4] / scene.pair().pitch).astype(int) % 4
    error = 1e3 * one.wheel_base_radius * one.transmission_error[0, :4]
    assert_allclose(turn.error_um(0)[places], error, atol=AS_ONE_PITCH_um)
    assert_allclose(turn.error_um(0)[4 + places], error, atol=AS_ONE_PITCH_um)
    assert_allclose(turn.dataset.mesh_stiffness.values[0, places], one.mesh_stiffness[0, :4], rtol=A_CELL)
    of_one, of_turn = one.peak_pressure[0, :4], turn.dataset.peak_pressure.values[0, places]
    assert_allclose(np.nanmax(of_turn, axis=-1), np.nanmax(of_one, axis=-1), rtol=1e-3)
    pitch, two = one.to_dynamics(), turn.to_dynamics()
    assert_allclose(two.mesh_phase, 0.25 * np.arange(8))
    same = np.searchsorted(two.mesh_phase.values, pitch.mesh_phase.values - A_CELL)
    apart = two.transmission_error_m.values[:, same] - pitch.transmission_error_m.values
    assert_allclose(apart, 0.0, atol=1e-6 * AS_ONE_PITCH_um)
    first, of_pitch = ({k: one.sel(order=k) for k in (0, 1)} for one in (two, pitch))
    for k in (0, 1):
        series = [
            one[k].transmission_error_amplitude_m * np.exp(1j * one[k].transmission_error_phase_rad)
            for one in (first, of_pitch)
        ]
        assert_allclose(series[0], series[1], rtol=0.0, atol=1e-6 * AS_ONE_PITCH_um)
    between = two.transmission_error_amplitude_m.sel(order=[0.5, 1.5])  # no tooth differs from its neighbours
    assert_allclose(between, 0.0, atol=1e-6 * AS_ONE_PITCH_um)


def slopes(scene, tooth, positions):
    """Change of the transmission error (n,) [um/um] by the deviation of one tooth of the wheel, of its differences."""
    curves = []
    for sign in (1.0, -1.0):
        index = [0.0] * 24
        index[tooth] = sign * STEP_um
        curves.append(revolution_of(scene.with_changes({"wheel.pitch.index_um": index}), 3, 4).error_um(0)[positions])
    return (curves[0] - curves[1]) / (2.0 * STEP_um)


@pytest.mark.thorough
@pytest.mark.parametrize("changes", [CONTACT | FINE, COARSE | FINE], ids=["flanks alone", "bending"])
def test_slope_to_the_deviation_of_one_tooth_is_its_share_of_the_tangent_stiffness(changes):
    """Of flanks alone the own stiffness of the pair over the sum; with bending the row sum of the inverse compliance.

    Both are the forces that a rotation brings to the pair over those that it brings to all.
    """
    scene = helical(changes)
    one = analyse(scene.with_changes({"analysis.positions": 5}))
    (states,), pitch = one.states[1], scene.pair().pitch
    for position in (1, 3):
        phase = round(4.0 * one.pinion_angle[position] / pitch)
        grids, rates = states.grids[position], states.by_rotation[position]
        ends = np.cumsum([grid.active.sum() for grid in grids])[:-1]
        levers = [grid.contact.pinion_lever for grid in grids]
        rate = np.array([part.sum() for part in np.split(rates, ends)]) * levers
        for grid, expected in zip(grids, rate / rate.sum(), strict=True):
            slope = slopes(scene, 1 + grid.number, [4 + phase])[0]  # 4: the begin of the second pitch
            assert slope == pytest.approx(-expected, abs=SLOPES)


@pytest.mark.thorough
def test_eccentricity_changes_no_share_and_adds_one_order():
    scene = helical()
    alike, eccentric = (revolution_of(scene, "wheel", 2, **more) for more in ({}, {"wheel.pitch.runout_um": 10.0}))
    # the same tooth pairs, solved once for all pitches: no gap knows of the eccentricity
    assert_array_equal(eccentric.dataset.load_share, alike.dataset.load_share)
    assert_array_equal(eccentric.dataset.peak_pressure, alike.dataset.peak_pressure)
    spectrum = eccentric.spectrum(0)
    assert spectrum.kind[0] == "wheel 1"
    assert spectrum.amplitude[0] == pytest.approx(5.0, abs=1e-9)
    assert_allclose(spectrum.amplitude[1:], alike.spectrum(0).amplitude[1:], atol=1e-9)


def test_tooth_that_is_set_back_carries_less_and_its_neighbours_more():
    index = [0.0] * 24
    index[6] = 4.0
    turn = revolution_of(helical(), 12, 4, **{"wheel.pitch.index_um": index})
    share, tooth = turn.dataset.load_share.values[0], turn.dataset.wheel_tooth.values
    carried = [share[tooth == number].sum() for number in (3, 5, 6, 7)]
    assert carried[2] < carried[0] < min(carried[1], carried[3])
    assert np.isnan(turn.by_tooth("wheel").load_share.values[0, 20])
    total = turn.dataset.load_share.sum("pair").values
    assert_allclose(total, 1.0, atol=1e-9)


def test_teeth_are_counted_from_the_first_pair():
    data = small_turn().dataset.sel(pair=0)
    assert data.pinion_tooth.values[[0, 4, 60]].tolist() == [3, 4, (3 + 15) % 17]
    assert data.wheel_tooth.values[[0, 4, 95]].tolist() == [7, 8, (7 + 23) % 24]


def test_tooth_of_shares_that_tie_is_that_of_the_highest_pressure():
    data, pair = small_turn().dataset.copy(deep=True), 1
    data.load_share.values[...] = np.minimum(data.load_share.values, 0.9)
    data.load_share.values[0, [8, 41], pair] = 1.0, 1.0 - 1e-12
    data.peak_pressure.values[0, [8, 41], pair] = 500.0, 600.0
    figures = replace(small_turn(), dataset=data).key_figures()[0]
    assert figures["largest_load_share"] == 1.0
    for gear in ("pinion", "wheel"):
        assert figures[f"{gear}_tooth_of_largest_load_share"] == data[f"{gear}_tooth"].values[41, pair]


def with_edges(at_edge):
    """The small turn with 900 MPa on a pair with 7 % of the torque, 800 MPa on another one, less elsewhere."""
    data = small_turn().dataset.copy(deep=True)
    data.peak_pressure.values[...] = np.minimum(data.peak_pressure.values, 700.0)
    data.on_edge.values[...] = 0
    data.load_share.values[0, 41, 1] = 0.07
    data.peak_pressure.values[0, [41, 8], 1] = 900.0, 800.0
    for place in at_edge:
        data.on_edge.values[(0, *place)] = 1
    return replace(small_turn(), dataset=data)


def test_peak_at_an_edge_is_told_with_its_angle_teeth_and_share():
    turn = with_edges([(41, 1)])
    (sentence,) = turn.findings()
    angle = np.rad2deg(turn.pinion_angle[41])
    assert "the peak pressure 900 MPa at 20 N m lies in slices at an edge" in sentence
    assert float(re.search(r"pinion angle (\S+) deg", sentence)[1]) == pytest.approx(angle, rel=1e-3)  # four digits
    pinion, wheel = (int(turn.dataset[f"{gear}_tooth"].values[41, 1]) for gear in ("pinion", "wheel"))
    assert f"tooth {pinion} of the pinion and tooth {wheel} of the wheel, which carry 7 % of the torque" in sentence
    assert "the largest of contacts away from edges is 800 MPa" in sentence
    assert f"finding: {sentence}" in turn.summary().splitlines()
    assert turn.beside_figures()["findings"] == (sentence,)


def test_peak_away_from_edges_is_no_finding():
    assert with_edges([(8, 1)]).findings() == ()


def test_peak_of_contacts_that_all_reach_an_edge_says_so():
    (sentence,) = with_edges(np.argwhere(small_turn().normal_force[0] > 0.0)).findings()
    assert "all contacts reach an edge" in sentence


def test_composite_deviations_are_spans_of_the_curve():
    turn = small_turn()
    curve = turn.error_um(1)
    assert turn.total_deviation(1) == pytest.approx(curve.max() - curve.min())
    closed = np.concatenate([curve, curve[:4]])
    spans = [np.ptp(closed[n : n + 5]) for n in range(len(curve))]
    assert turn.tooth_to_tooth_deviation(1) == pytest.approx(max(spans))
    figures = turn.key_figures()[1]
    assert figures["total_single_flank_deviation_um"] == turn.total_deviation(1)
    assert figures["rigid_total_single_flank_deviation_um"] == turn.total_deviation()


def test_spectrum_has_the_power_of_the_curve_and_names_its_orders():
    turn = small_turn()
    order, amplitude, kind = turn.spectrum(0)
    curve = turn.error_um(0)
    highest = np.abs(np.fft.rfft(curve)[-1] / len(curve)) ** 2  # of an even number of positions, in no order
    assert 0.5 * (amplitude**2).sum() + highest == pytest.approx(np.var(curve), rel=1e-9)
    named = dict(zip(kind.tolist(), order.tolist(), strict=True))
    assert named["mesh 1"] == 24.0
    assert named["mesh 1 -2 wheel"] == 22.0
    assert named["wheel 3"] == 3.0
    assert turn.counted_by == 1
    assert np.array_equal(turn.spectrum().amplitude, turn.spectrum(1).amplitude)


def test_spectrum_of_a_hunting_period_has_orders_of_both_gears():
    scene = helical({**CONTACT, "pinion.teeth": 20, "wheel.teeth": 30, "analysis.torques_Nm": [0.0]})
    runout = {"pinion.pitch.runout_um": 8.0, "wheel.pitch.runout_um": 6.0}
    turn = revolution_of(scene, "hunting", 2, **runout)
    assert turn.pitches == 60
    named = dict(zip(turn.spectrum().kind.tolist(), turn.spectrum().amplitude.tolist(), strict=True))
    assert named["pinion 1"] == pytest.approx(4.0, abs=1e-9)
    assert named["wheel 1"] == pytest.approx(3.0, abs=1e-9)


TWICE_A_TURN = [10.0 * float(np.cos(4.0 * np.pi * tooth / 40)) for tooth in range(40)]
OF_BOTH_GEARS = {
    "the wheel deviates": ({"wheel.pitch.index_um": TWICE_A_TURN}, "wheel 2", "mesh 1 -2 wheel"),
    "the pinion deviates": ({"pinion.pitch.runout_um": 20.0}, "pinion 1", "mesh 1 -1 pinion"),
    "both deviate": (
        {"wheel.pitch.index_um": TWICE_A_TURN, "pinion.pitch.runout_um": 1.0},
        "pinion 1 = wheel 2",
        "mesh 1 -1 pinion = -2 wheel",
    ),
}


@pytest.mark.parametrize(("deviations", "largest", "sideband"), OF_BOTH_GEARS.values(), ids=OF_BOTH_GEARS)
def test_order_of_both_gears_has_the_names_of_those_that_deviate(deviations, largest, sideband):
    """Of 20/40 the first order of the pinion is the second one of the wheel: 2 cycles in 40 pitches."""
    scene = helical({**CONTACT, "pinion.teeth": 20, "wheel.teeth": 40, "analysis.torques_Nm": [0.0]})
    turn = revolution_of(scene, "wheel", 2, **deviations)
    spectrum = turn.spectrum()
    assert spectrum.amplitude.argmax() == 1
    assert spectrum.kind[1] == largest
    assert spectrum.kind[40 - 2 - 1] == sideband
    by_number = [turn.order_amplitude(spectrum, *order) for order in (("pinion", 1), ("wheel", 2))]
    assert by_number == [spectrum.amplitude[1]] * 2  # by whatever name


def test_order_that_a_revolution_does_not_have_has_no_amplitude():
    turn = small_turn()
    assert np.isnan(turn.order_amplitude(turn.spectrum(), "mesh", 100))


def test_largest_of_each_tooth_is_that_of_the_positions_where_it_is_in_mesh():
    turn = small_turn()
    data, teeth = turn.dataset, turn.by_tooth("pinion")
    for tooth in (0, 4):
        rows = data.pinion_tooth.values == tooth
        assert teeth.load_share.values[1, tooth] == data.load_share.values[1][rows].max()
        assert teeth.peak_pressure.values[1, tooth] == np.nanmax(data.peak_pressure.values[1][rows])


def test_index_deviations_of_a_tolerance_class_are_those_that_moved_the_teeth():
    """Rigid teeth at the pitch point: its pair is set back, if no other comes first."""
    scene = helical({**CONTACT, "pinion.teeth": 20, "wheel.teeth": 30, "analysis.torques_Nm": [0.0]})
    turn = revolution_of(scene, "wheel", 1, **{"wheel.pitch.tolerance_class": 7, "wheel.pitch.seed": 4})
    index = turn.by_tooth("wheel")["index_deviation"]
    assert index.attrs["units"] == "um"
    assert np.ptp(index.values) > 10.0
    assert not turn.by_tooth("pinion")["index_deviation"].values.any()
    alike = revolution_of(scene, 1, 1).error_um()[0]  # of modified flanks whose teeth stand where they should
    sooner = turn.error_um() - alike + index.values[turn.at_position("wheel_tooth")]
    assert sooner.min() > -1e-6
    assert (sooner < 1e-6).mean() > 0.5


def test_revolution_comes_back_from_its_file(tmp_path):
    turn = small_turn()
    turn.save(tmp_path / "turn.nc")
    back = Revolution.load(tmp_path / "turn.nc")
    assert back.dataset.equals(turn.dataset)
    assert back.summary() == turn.summary()
    assert back.scene == turn.scene
    with pytest.raises(InputError, match=r"a whole revolution, .* loaded_tca\.Revolution\.load"):
        load_result(tmp_path / "turn.nc")


def test_maps_are_kept_of_the_positions_asked_for():
    scene = helical().with_changes({"revolution.pitches": 1, "revolution.positions_per_pitch": 2})
    turn = analyse_revolution(scene, maps=[1])
    assert set(turn.maps) == {(0, 1)}
    for one, force in zip(turn.maps[0, 1], turn.dataset.normal_force.values[0, 1], strict=True):
        assert (one is None) == (force == 0.0)
        assert one is None or one.pressure.sum() * math.prod(one.spacing) == pytest.approx(force, rel=1e-9)


def test_curves_for_dynamics_are_those_of_the_dataset():
    turn = small_turn()
    dynamics, data = turn.to_dynamics(), turn.dataset
    radius = 1e-3 * float(data.wheel_base_radius)
    # also below: a product
    assert_allclose(dynamics.transmission_error_m, radius * data.transmission_error, rtol=1e-12)
    assert_allclose(dynamics.unloaded_transmission_error_m, radius * data.rigid_transmission_error, rtol=1e-12)
    stiffness = data.mesh_stiffness.values * float(data.face_width) * 1e6
    assert_allclose(dynamics.mesh_stiffness_N_per_m, stiffness, rtol=1e-12)
    assert_allclose(dynamics.pinion_angle_rad, data.pinion_angle, rtol=1e-12)
    assert_allclose(dynamics.mesh_phase, 0.25 * np.arange(24 * 4), rtol=1e-12)
    assert_allclose(dynamics.normal_force_per_torque_N_per_Nm[1], data.normal_force[1].sum("pair") / 60.0, rtol=1e-12)
    assert (dynamics.pitches, dynamics.periodic, dynamics.pinion_teeth, dynamics.wheel_teeth) == (24, 1, 17, 24)
    assert (dynamics.first_pinion_tooth, dynamics.first_wheel_tooth) == FIRST
    dynamics.to_netcdf(io.BytesIO(), engine="scipy")  # nothing in it that NetCDF-3 has not


def test_orders_for_dynamics_are_those_of_the_spectrum():
    turn = small_turn()
    dynamics = turn.to_dynamics()
    assert dynamics.kind.values[[0, 3, 22, 24]].tolist() == ["mean", "wheel 3", "mesh 1 -2 wheel", "mesh 1"]
    for torque in (0, 1):
        order, amplitude, kind = turn.spectrum(torque)
        found = dynamics.transmission_error_amplitude_m.values[torque]
        assert_allclose(found[1:], 1e-6 * amplitude, rtol=1e-9, atol=1e-6 * ROUNDING_um)
        assert_allclose(dynamics.order_of_wheel[1:], order, rtol=1e-12)
        assert dynamics.kind.values[1:].tolist() == kind.tolist()
    assert_allclose(dynamics.order_of_pinion, 17.0 / 24.0 * dynamics.order_of_wheel, rtol=1e-12)
    assert dynamics.order_of_wheel.sel(order=1.0) == 24.0


@pytest.mark.parametrize(
    ("name", "unit"), [("transmission_error", "_m"), ("mesh_stiffness", "_N_per_m"), ("loaded_pairs", "")]
)
def test_series_for_dynamics_is_the_curve_over_all_pitches(name, unit):
    """Of an even number of positions without the order that alternates, which has no phase."""
    dynamics = small_turn().to_dynamics()
    curve = dynamics[f"{name}{unit}"].values
    signs = (-1.0) ** np.arange(curve.shape[-1])
    curve = curve - signs * (signs * curve).mean(axis=-1, keepdims=True)
    amplitude, phase = (dynamics[f"{name}_{part}"].values[..., None] for part in (f"amplitude{unit}", "phase_rad"))
    angle = 17.0 * dynamics.order.values[:, None] * dynamics.pinion_angle_rad.values
    series = (amplitude * np.cos(angle + phase)).sum(axis=1)
    assert_allclose(series, curve, rtol=0.0, atol=1e-12 * np.abs(curve).max())  # rounding of sums of 48 terms


def test_known_orders_come_back_with_their_phases():
    """4 um at a sideband two orders of the wheel below the mesh, 2 um once a turn of the wheel, about -9 um."""
    turn, data = small_turn(), small_turn().dataset
    of_wheel = 17.0 / 24.0 * data.pinion_angle.values
    curve = -9.0 + 4.0 * np.cos(22.0 * of_wheel + 0.7) + 2.0 * np.cos(of_wheel - 2.0)
    error = np.tile(1e-3 * curve / float(data.wheel_base_radius), (2, 1))
    known = replace(turn, dataset=data.assign(transmission_error=(("torque", "position"), error)))
    found = known.to_dynamics().swap_dims(order="kind")
    for kind, amplitude, phase in (("mean", -9.0, 0.0), ("mesh 1 -2 wheel", 4.0, 0.7), ("wheel 1", 2.0, -2.0)):
        of_kind = found.sel(kind=kind)
        assert_allclose(of_kind.transmission_error_amplitude_m, 1e-6 * amplitude, rtol=1e-12)
        assert_allclose(of_kind.transmission_error_phase_rad, phase, atol=1e-12)


def test_first_teeth_say_where_the_rotation_of_a_gear_begins():
    """Rigid flanks, an eccentric wheel: from seven teeth further on the order k has turned 7 k pitches further."""
    changes = {"analysis.torques_Nm": [0.0], "wheel.pitch": {"runout_um": 10.0, "runout_phase_deg": 60.0}}
    from_0, from_7 = (
        revolution_of(helical(), "wheel", 1, **changes, **{"revolution.first_pair": first}).to_dynamics()
        for first in ([0, 0], [3, 7])
    )
    assert (from_7.first_pinion_tooth, from_7.first_wheel_tooth) == (3, 7)
    first, moved = (one.swap_dims(order="kind").sel(kind="wheel 1") for one in (from_0, from_7))
    assert_allclose(moved.transmission_error_amplitude_m, 5e-6, rtol=1e-9)  # half the runout
    turned = moved.transmission_error_phase_rad - first.transmission_error_phase_rad
    assert_allclose(np.exp(1j * turned), np.exp(2j * np.pi * 7.0 / 24.0), rtol=1e-9)


def test_curves_for_dynamics_that_do_not_repeat_say_so():
    dynamics = open_turn().to_dynamics()
    assert (dynamics.pitches, dynamics.periodic) == (12, 0)
    assert "Not periodic: 12 pitches are no whole turn of the wheel, whose teeth" in dynamics.attrs["conventions"]
    assert "Not periodic" not in small_turn().to_dynamics().attrs["conventions"]
    both = {"pinion.pitch.runout_um": 5.0, "revolution.pitches": 12}
    of_both = replace(open_turn(), scene=open_turn().scene.with_changes(both)).to_dynamics()
    assert "no whole turn of the pinion and of the wheel, whose teeth" in of_both.attrs["conventions"]


def test_one_position_has_no_curves_for_dynamics():
    turn = open_turn()
    one = turn.scene.with_changes({"revolution.pitches": 1})
    with pytest.raises(InputError, match=r"^revolution: found 1 position; .* from 2 positions on$"):
        replace(turn, scene=one, dataset=turn.dataset.isel(position=[0])).to_dynamics()


def test_analysis_of_one_pitch_says_that_deviations_are_left_out():
    scene = helical().with_changes({"wheel.pitch.runout_um": 5.0, "analysis.positions": 1})
    with pytest.warns(match="takes all teeth as alike"):
        analyse(scene)


def open_turn():
    """Half a turn of an eccentric wheel without load, a position in each pitch."""
    return revolution_of(helical(), 12, 1, **{"wheel.pitch.runout_um": 5.0, "analysis.torques_Nm": [0.0]})


def test_revolution_that_is_not_closed_says_so():
    with pytest.warns(match="12 pitches are no whole turn of the wheel"):
        turn = open_turn()
    assert not turn.is_closed
    labels = turn.labels()
    assert labels["total_single_flank_deviation_um"] == "single flank deviation over 12 pitches [um]"
    assert "span of 12 pitches, no whole turn: " in told(plot_revolution_error(turn))


def test_orders_of_a_gear_that_makes_no_whole_turn_leak_where_they_lie():
    """A sine of the pinion's rotation over a turn of the wheel: its largest amplitude is at the order that names it."""
    scene = helical({"revolution.pitches": "wheel", "revolution.positions_per_pitch": 4, "pinion.pitch.runout_um": 5.0})
    data = small_turn().dataset
    for own in (1, 2, 5):
        sine = np.sin(own * data.pinion_angle.values + 0.3)
        turn = replace(
            small_turn(), scene=scene, dataset=data.assign(transmission_error=data.transmission_error * 0.0 + sine)
        )
        (leaking,) = turn.leaking_orders().values()
        assert leaking[turn.spectrum(0).amplitude.argmax()] == own
    assert "leaking_order_of_pinion" in turn.tables()["orders"]().values
    assert "no whole turn of the pinion: its orders leak" in told(plot_revolution_spectrum(turn))


def test_orders_half_way_between_those_of_the_revolution_leak():
    scene = helical({"revolution.pitches": 12, "revolution.positions_per_pitch": 4, "wheel.pitch.runout_um": 5.0})
    leaking = replace(small_turn(), scene=scene).leaking_orders()
    assert_allclose(leaking["wheel"] % 2, 1.0)  # 12 pitches of 24 have the even orders


def test_whole_turns_have_no_leaking_orders():
    assert small_turn().leaking_orders() == {}
    assert "leaking" not in " ".join(small_turn().tables()["orders"]().values)


def test_progress_is_told_to_its_end():
    told = []
    analyse_revolution(
        helical().with_changes({"revolution.pitches": 2, "revolution.positions_per_pitch": 2}),
        progress=lambda done, total: told.append((done, total)),
    )
    assert told[-1] == (4, 4)


def test_effort_grows_with_the_states():
    scene = helical(COARSE)
    efforts = [
        expected_revolution_effort(scene.with_changes({"revolution.pitches": pitches}))
        for pitches in (24, 48, "hunting")
    ]
    seconds = [effort.seconds for effort in efforts]
    assert seconds[2] - seconds[1] == pytest.approx((408 - 48) / 24 * (seconds[1] - seconds[0]), rel=1e-9)
    assert efforts[0].memory <= efforts[2].memory < 1.5 * efforts[0].memory


@pytest.mark.thorough
def test_study_of_a_class_scatters_over_its_seeds_within_its_tolerance():
    """Rigid, without modifications: the total deviation is that of the class, but for where two pairs overlap."""
    bare = {"pinion.modifications.lead_crowning_um": 0.0, "pinion.modifications.profile_crowning_um": 0.0}
    scene = helical().with_changes(bare | {"analysis.torques_Nm": [0.0], "revolution.positions_per_pitch": 2})
    study = Study(scene, {"wheel.pitch.tolerance_class": [4, 6], "wheel.pitch.seed": [0, 1]})
    found = run_study(study, figures=revolution_figures)
    total = found["rigid_total_single_flank_deviation_um"].values[:, 0]
    assert_allclose(total[2:], 2.0 * total[:2], rtol=0.05)  # two classes: twice the tolerances, but for their rounding
    assert len(set(total.tolist())) == 4


def asked(changes):
    return analyse_revolution(helical().with_changes(changes))


FEW = {"revolution.pitches": 1, "revolution.positions_per_pitch": 1}
test_refusals = refused_calls(
    (
        lambda: asked({"wheel.pitch.index_um": [1.0, 2.0, 3.0]}),
        r"^wheel\.pitch: index_um: found 3 values; allowed 24, one for each tooth$",
    ),
    (lambda: asked({"pinion.pitch.single_um": [1.0] * 17}), "single_um: the single pitch deviations add up to 17 um"),
    (lambda: asked({"wheel.pitch.index_um": [math.nan] * 24}), r"wheel\.pitch\.index_um: found \[nan"),
    (
        lambda: asked({"wheel.pitch.index_um": [0.0] * 23 + [151.0]}),
        r"wheel\.pitch: index deviation of tooth 23: found 151 um; allowed up to 150 um, 0\.05 modules",
    ),
    (
        lambda: asked({"wheel.pitch.index_um": [0.0] * 24, "wheel.pitch.tolerance_class": 6}),
        "index_um: found index_um beside tolerance_class; give one of them",
    ),
    (lambda: asked({"revolution.positions_per_pitch": 2.5}), "positions_per_pitch: found 2.5; allowed a whole number"),
    (lambda: asked({"revolution.pitches": 409}), r"revolution\.pitches: found 409; allowed up to 408"),
    (lambda: asked({"revolution.pitches": "turn"}), '"pinion" or "wheel" or "hunting", or a whole number'),
    (lambda: asked({"revolution.first_pair": [17, 0]}), "first_pair: found .* up to 16 of the pinion"),
    (lambda: asked({"analysis.load_sharing": False}), "load_sharing: found false; allowed true in a whole revolution"),
    (
        lambda: analyse_revolution(helical().with_changes(FEW), maps=[7]),
        r"maps: \[7\] are no positions; allowed 0 to 0",
    ),
    (lambda: small_turn().spectrum(2), "torque: 2 is no index from 0 to 1"),
    (lambda: small_turn().by_tooth("planet"), "gear: 'planet' is not 'pinion' or 'wheel'"),
    (
        lambda: analyse_revolution(scene_of("mesh_cycle_bevel", CONTACT | {"wheel.pitch.tolerance_class": 6})),
        r"wheel\.pitch: tolerance_class: found 6; .* cylindrical gears",
    ),
)


def with_teeth(numbers, modifications, gear="wheel"):
    return {f"{gear}.tooth": [{"number": number, "modifications": modifications} for number in numbers]}


CROWNED = {"lead_crowning_um": 3.0, "profile_crowning_um": 5.0}


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_all_teeth_with_flanks_of_their_own_are_a_gear_with_these_flanks(gear):
    """One pairing among others: bending is that of the common teeth, which these flanks leave as it is here."""
    scene = helical()
    count = 17 if gear == "pinion" else 24
    of_teeth = revolution_of(scene, 2, 4, **with_teeth(range(count), CROWNED, gear))
    of_gear = revolution_of(scene, 2, 4, **{f"{gear}.modifications.{name}": um for name, um in FULL.items()})
    assert_allclose(of_teeth.error_um(), of_gear.error_um(), atol=1e-9)
    assert_allclose(of_teeth.error_um(0), of_gear.error_um(0), atol=AS_ONE_PITCH_um)
    assert_allclose(of_teeth.dataset.peak_pressure, of_gear.dataset.peak_pressure, rtol=1e-4)


FULL = {"lead_crowning_um": 0.0, "profile_crowning_um": 0.0} | CROWNED


@pytest.mark.thorough
@pytest.mark.parametrize("changes", [CONTACT, COARSE], ids=["flanks alone", "bending"])
def test_tooth_with_less_material_all_over_is_one_that_is_set_back(changes):
    """An amount along the normal is 1/cos(beta_b) of it along the transverse line of action."""
    scene, removed_um = helical(changes), 3.0
    base_helix = math.asin(math.sin(math.radians(15.0)) * math.cos(math.radians(20.0)))
    index = [0.0] * 24
    index[2] = removed_um / math.cos(base_helix)
    thinner = revolution_of(scene, 5, 4, **with_teeth([2], {"polynomial_mm": [1e-3 * removed_um] + [0.0] * 5}))
    set_back = revolution_of(scene, 5, 4, **{"wheel.pitch.index_um": index})
    assert_allclose(thinner.error_um(), set_back.error_um(), atol=2e-3)  # it turns by a ten thousandth, and is as large
    assert_allclose(thinner.error_um(0), set_back.error_um(0), atol=5e-3)
    assert_allclose(thinner.dataset.load_share, set_back.dataset.load_share, atol=2e-3)


@pytest.mark.thorough
def test_tooth_with_its_own_relief_changes_its_own_mesh_alone():
    relief = {"tip_relief_um": 20.0, "tip_relief_start_roll_deg": 30.0}
    scene = helical()
    alike, one = revolution_of(scene, 8, 4), revolution_of(scene, 8, 4, **with_teeth([4], relief))
    meshes = (one.dataset.wheel_tooth.values == 4) & (one.dataset.load_share.values[0] > 0.0)
    touched = meshes.any(axis=1)
    difference = np.abs(one.error_um(0) - alike.error_um(0))
    assert 0 < touched.sum() < len(touched)
    assert difference[touched].max() > 0.1
    before = ~(one.dataset.wheel_tooth.values == 4).any(axis=1)  # neither in mesh nor within reach
    assert before.any()
    assert_allclose(difference[before], 0.0, atol=1e-9)


def test_root_stress_is_that_of_one_pitch_and_names_its_teeth(tmp_path):
    changes = CONTACT | {"analysis.root_stress": True, "analysis.positions": 5}
    scene = helical(changes | {"pinion.face_width_mm": 15.0, "wheel.face_width_mm": 15.0})
    with coarsely():
        one = analyse(scene)
        turn = revolution_of(scene, 2, 4, **{"revolution.first_pair": [3, 5]})
    places = np.round(4.0 * one.pinion_angle[:4] / scene.pair().pitch).astype(int) % 4
    assert_allclose(turn.dataset.root_tension.values[0, places], one.root_tension[0, :4], rtol=1e-4)
    teeth = turn.dataset.root_tension_tooth.values[0]
    assert teeth[0].tolist() == [3, 5]  # at the pitch point, where its pair carries the most
    assert teeth[4].tolist() == [4, 6]
    loaded = turn.dataset.load_share.values[0] > 0.0
    for gear, name in enumerate(("pinion", "wheel")):  # those that carry, of whichever pair
        carrying = np.where(loaded, turn.dataset[f"{name}_tooth"].values, -1)
        assert (carrying == teeth[:, gear, None]).any(axis=1).all()
        assert (turn.dataset[f"{name}_tooth"].sel(pair=0).values != teeth[:, gear]).any()
    figures = turn.key_figures()[0]
    assert figures["pinion_root_tension_MPa"] == np.nanmax(turn.dataset.root_tension.values[0, :, 0])
    turn.save(tmp_path / "turn.nc")
    assert Revolution.load(tmp_path / "turn.nc").dataset.equals(turn.dataset)
    columns = turn.to_table()
    assert_allclose(columns["wheel_root_tension_MPa"], turn.dataset.root_tension.values[0, :, 1])
    assert columns["wheel_root_tension_tooth"].tolist() == teeth[:, 1].tolist()
    assert columns["wheel_root_tension_tooth"].dtype.kind == "i"


def test_warnings_of_contacts_name_their_tooth_pairs(monkeypatch):
    monkeypatch.setattr("loaded_tca.revolution.reasons_of", lambda *_: ["reason"])
    path = SimpleNamespace(pinion_angle=np.radians([2.0, 5.0]), pairs=np.array([-1, 0, 2]))
    numbers = SimpleNamespace(torques=np.array([6e4]), path=path, pair=None, grid=None, places={}, solved=0)
    _Numbers._note(numbers, {(0, 0, 0): object(), (0, 0, 1): None, (0, 0, 2): object()}, 1)
    where = "60 N m, pinion angle 5 deg, tooth pair"
    assert numbers.places == {"reason": [f"{where} -1", f"{where} +2"]}


def test_warnings_of_several_torques_are_given_once():
    """Gears on supports stand elsewhere under each torque, and are worked on one by one."""
    of_torques = [
        SimpleNamespace(
            torques=np.array([torque]),
            arrays={"normal_force": np.ones((1, 1, 1)), "rotation": np.array([[turn]]), "stiffness": np.ones((1, 1))},
            places={"reason": [f"{torque:g}"] * count},
            solved=5,
        )
        for torque, turn, count in ((1.0, 1e-3, 2), (2.0, 2e-3, 1))
    ]
    pair = SimpleNamespace(base_radii=(1.0, 300.0), module=1.0)
    sentences = [*_sentences(pair, of_torques, SimpleNamespace(torsion=0.0, stiffening=0.0))]
    assert sentences == [
        "reason (at 3 of 10 pressure maps; the first: 1)",
        kinds.DEFLECTION.sentence(deflection=0.6, reach=REACH),
    ]


test_refusals_of_teeth = refused_calls(
    (lambda: asked(with_teeth([24], CROWNED)), r"wheel\.tooth: number: found 24; allowed 0 to 23"),
    (lambda: asked(with_teeth([3, 3], CROWNED)), r"wheel\.tooth: number: found 3 twice; allowed once"),
    (lambda: asked({"wheel.tooth": [{"modifications": {}}]}), r"wheel\.tooth: table 0: number: missing"),
    (
        lambda: asked({"wheel.tooth": [{"number": 1}, {"number": 2, "modifications": {"lead_um": 3.0}}]}),
        r"wheel\.tooth: table 1: modifications\.lead_um: unknown key",
    ),
    (lambda: asked({"wheel.tooth": 3}), r"wheel\.tooth: found 3; allowed a list of 0 to 10000 tables of number"),
)
