"""Whole revolutions of double helical pairs: shuttling by closed forms, no axial force, files, the command."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError, analyse_revolution
from loaded_tca.cli import main
from loaded_tca.double_helical import DoubleHelicalRevolution, analyse_double_helical_revolution
from loaded_tca.results import load_result
from tests.samples.double_helical import equal_halves

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
TEETH = 12
FEW_TEETH = {
    **{
        f"{gear}.{key}": value
        for gear in ("pinion", "wheel")
        for key, value in (("teeth", TEETH), ("profile_shift", 0.3))
    },
    "pinion.modifications": None,
    "analysis.cells": [8, 8],
    "revolution": {"pitches": 2, "positions_per_pitch": 1},
}
OPPOSED = {"wheel.pitch.runout_um": 8.0, "wheel.half_b.pitch": {"runout_um": 8.0, "runout_phase_deg": 180.0}}


def scene_with(**changes):
    return equal_halves().with_changes({**FEW_TEETH, **changes})


@pytest.fixture(scope="module")
def wobbling():
    """A wheel whose halves are eccentric to opposite sides."""
    return analyse_revolution(scene_with(**OPPOSED))


def test_no_maps_are_kept_of_two_halves():
    with pytest.raises(InputError, match=r"maps: found \[0\]; allowed \(\): no maps are kept of a double helical"):
        analyse_revolution(scene_with(**OPPOSED), maps=[0])


@pytest.mark.parametrize(("floating", "sign"), [("pinion", 1.0), ("wheel", -1.0)])
def test_floating_gear_follows_an_apex_that_runs_out(floating, sign):
    runout, one = 10.0, {"revolution.pitches": 1}
    scene = scene_with(**{**one, "wheel.apex_runout_um": runout, "pair.floating": floating})
    revolution = analyse_double_helical_revolution(scene)
    half = revolution.half_a
    # tooth 0 meshes, whose apex lies nearest to half a; the others in contact hold the gear where theirs are
    offsets = 0.5e-3 * runout * np.cos(2.0 * np.pi / TEETH * half.wheel_tooth[0])
    mean = float(half.load_share[0, 0] @ offsets)
    # they hold it by their stiffnesses, which differ from their loads by less than half: of 0.15 beside tooth 0, whose
    # apexes lie by 1 - cos(30 deg) less far, that is 0.01
    assert_allclose(revolution.axial_motion, sign * mean, rtol=0.01)
    assert_allclose(revolution.axial_force_left, 0.0, atol=1e-9 * np.abs(revolution.axial_force).max())
    assert_allclose(revolution.torque_share, 0.5, rtol=1e-12)  # equal axial forces of helices alike: none seen


def test_eccentric_halves_of_opposite_phases_shuttle_by_their_closed_form(wobbling):
    """Flanks of the halves part by +-e cos along the line of action, which a motion of e cos/tan(beta_b) takes back."""
    amplitude = 0.5e-3 * 8.0 / np.tan(wobbling.scene.mesh().pinion.base_helix_angle)
    first, second = wobbling.axial_motion[0]
    step = 2.0 * np.pi / TEETH  # two values of A cos(x) a step apart
    square = (first**2 + second**2 - 2.0 * first * second * np.cos(step)) / np.sin(step) ** 2
    assert_allclose(np.sqrt(square), amplitude, rtol=1e-6)  # states are solved to the tolerance of the balance
    assert_allclose(wobbling.axial_force_left, 0.0, atol=1e-9 * np.abs(wobbling.axial_force).max())
    # neither transmission error nor shares know of it
    assert np.ptp(wobbling.error_um(0)) < 1e-3 * 1e3 * amplitude
    assert wobbling.share_factor.tolist() == [1.0]


def test_alike_halves_do_not_shuttle_and_are_one_half():
    scene = scene_with(**{"revolution.pitches": 1, "pinion.pitch.index_um": [3.0, *(TEETH - 1) * [0.0]]})
    revolution = analyse_double_helical_revolution(scene)
    # mm; deflections of both halves cancel, and are added by halves below
    assert_allclose(revolution.axial_motion, 0.0, atol=1e-12)
    assert_allclose(revolution.transmission_error, revolution.half_a.transmission_error, rtol=1e-12)
    assert_allclose(revolution.rigid_transmission_error, revolution.half_b.rigid_transmission_error, rtol=1e-12)


@pytest.mark.parametrize(
    ("holding", "left"),
    [
        ({"pair.floating": "none"}, 0.0),
        pytest.param(
            {"pair.floating": "pinion", "pair.axial_stiffness_N_per_um": 100.0}, 0.0, marks=pytest.mark.thorough
        ),
        ({"pair.floating": "pinion"}, 0.5),
    ],
    ids=["held", "spring", "free"],
)
def test_without_load_the_half_that_touches_first_leads_gears_that_are_held(holding, left):
    """Half b of the wheel stands back all around: half a drives; a free gear moves until both touch, half as far."""
    back = 20.0  # um on the line of action
    behind = {"wheel.half_b.pitch": {"index_um": TEETH * [back]}, "wheel.pitch": {"index_um": TEETH * [0.0]}}
    scene = scene_with(**{"revolution.pitches": 1, **behind, **holding})
    whole, alike = (
        analyse_double_helical_revolution(one).error_um()
        for one in (scene, scene.with_changes({"wheel.half_b.pitch.index_um": TEETH * [0.0]}))
    )
    assert_allclose(np.abs(whole - alike), left * back, atol=1e-3 * back)  # the flanks are crowned, as they are not


def test_command_writes_both_halves_with_orders_of_the_shuttling(wobbling, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("loaded_tca.revolution.analyse_revolution", lambda *_, **__: wobbling)
    monkeypatch.setattr("loaded_tca.plots.png_of", lambda _: b"")
    (tmp_path / "scene.toml").write_text(wobbling.scene.to_toml())
    stale = tmp_path / "out" / "half_b_revolution" / "dynamics_orders.csv"
    stale.parent.mkdir(parents=True)
    stale.write_bytes(b"of an older revolution")
    assert main(["revolution", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out")]) == 0
    assert not stale.parent.exists()
    summary = capsys.readouterr().out
    assert "axial motion towards half a, mean" in summary
    assert "axial motion: amplitude of order pinion 1 [um]" in summary
    again = DoubleHelicalRevolution.load(tmp_path / "out")
    assert again.dataset.identical(wobbling.dataset)
    assert again.half_b.dataset.identical(wobbling.half_b.dataset)
    (row,) = json.loads((tmp_path / "out" / "double_helical_revolution.json").read_text())["torques"]
    assert row["axial_motion_span_um"] == pytest.approx(1e3 * np.ptp(wobbling.axial_motion))
    with (tmp_path / "out" / "double_helical_orders.csv").open(newline="") as file:
        assert "axial_motion_at_1600_Nm_um" in next(csv.reader(file))
    with pytest.raises(InputError, match="a whole revolution of a double helical pair, not the result of a mesh cycle"):
        load_result(tmp_path / "out" / "double_helical_revolution.nc")
    assert main(["plot", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert "holds a whole revolution, which this command does not take; allowed in 'loaded-tca report DIR'; " in told
    assert "the numbers are in double_helical_revolution.json and the tables" in told
    assert main(["dynamics", str(tmp_path / "out")]) == 2
    assert "half_a_revolution.nc and half_b_revolution.nc beside it are revolutions" in capsys.readouterr().err
    monkeypatch.setattr("loaded_tca.reports.page.svg_of", lambda *_: "<svg></svg>")  # made but not drawn
    assert main(["report", str(tmp_path / "out")]) == 0
    assert "over a whole revolution of a double helical pair" in (tmp_path / "out" / "report.html").read_text()


@pytest.mark.parametrize("floating", ["pinion", "none"])
def test_half_says_what_its_numbers_leave_out(floating, tmp_path):
    """In its tables for dynamics, its summary and its file: of a floating gear the axial motion, and the other half."""
    revolution = analyse_revolution(scene_with(**{"wheel.apex_runout_um": 8.0, "pair.floating": floating}))
    half = revolution.half_b
    of_half = half.to_dynamics().attrs["conventions"].replace("\n", " ")
    assert "Only half b of a double helical pair: " in of_half
    assert "stiffness is that of this half alone; the result of the pair has transmission error" in of_half
    without = "the transmission error is that of gears held along their axes, without the axial motion of the pinion"
    assert (without in of_half) == (floating == "pinion")
    assert f"note: {half.left_out}" in half.summary()
    assert "double helical" not in analyse_revolution(half.scene).to_dynamics().attrs["conventions"]  # a pair by itself
    half.save(tmp_path / "half.nc")
    assert type(half).load(tmp_path / "half.nc").left_out == half.left_out


def test_transmission_error_of_a_floating_pair_has_no_apex_runout_which_its_halves_have():
    """The runout sets one half back and the other one forward by R/2 tan(beta_b); the pair moves along the axis."""
    one = {"revolution.pitches": 1, "wheel.apex_runout_um": 20.0}
    pair = analyse_revolution(scene_with(**one))
    halves = [half.error_um(0)[0] for half in pair.halves]
    back = 20.0 * abs(pair.scene.axial_rate)  # of both halves together, reduced by the teeth beside tooth 0
    assert abs(halves[0] - halves[1]) == pytest.approx(back, rel=0.05)
    assert pair.error_um(0)[0] == pytest.approx(np.mean(halves), abs=0.01 * back)


def test_a_revolution_under_several_torques_comes_back_from_its_files(tmp_path):
    changes = {"revolution.pitches": 1, "analysis.torques_Nm": [400.0, 1600.0]}
    revolution = analyse_revolution(scene_with(**OPPOSED, **changes))
    revolution.save(tmp_path)
    again = DoubleHelicalRevolution.load(tmp_path)
    assert again.dataset.identical(revolution.dataset)
    assert again.summary() == revolution.summary()


def shuttling(revolution):
    """A turn of 12 pitches whose axial motion is a cosine of the wheel's rotation of 10 um; all else is constant."""
    curve = 0.01 * np.cos(2.0 * np.pi * np.arange(TEETH) / TEETH)
    turn = revolution.dataset.isel(position=[0] * TEETH).assign(axial_motion=(("torque", "position"), curve[None]))
    return replace(revolution, scene=revolution.scene.with_changes({"revolution.pitches": "wheel"}), dataset=turn)


def test_orders_of_the_shuttling_are_those_of_its_curve(wobbling):
    whole = shuttling(wobbling)
    spectrum = whole.axial_spectrum(0)
    assert_allclose(spectrum.amplitude[spectrum.order == 1.0], 10.0)
    figures = whole.key_figures()[0]
    amplitudes = [figures[f"axial_motion_{gear}_1_um"] for gear in ("pinion", "wheel")]
    assert_allclose(amplitudes, 10.0)  # of gears of equal teeth the first order of either is that of the other one


def test_orders_that_the_positions_do_not_resolve_have_no_amplitude(wobbling):
    figures = wobbling.key_figures()[0]  # of two positions over two pitches
    for kind in ("pinion_1", "wheel_1", "mesh_1"):
        assert np.isnan(figures[f"axial_motion_{kind}_um"])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"pinion.apex_runout_phase_deg": 30.0}, "pinion.apex_runout_phase_deg: found 30 without apex_runout_um"),
        ({"pinion.apex_runout_um": -1.0}, "pinion.apex_runout_um: found -1"),
        ({"wheel.half_b.pitch": {"index_um": [0.0, 1.0, -1.0]}}, "half b: wheel.pitch: index_um: found 3 values"),
        ({"pinion.tooth": [{"number": 0}]}, "pinion.tooth: found a section; not allowed of halves"),
    ],
)
def test_refused(changes, words):
    with pytest.raises(InputError, match=words):
        equal_halves().with_changes(changes)
