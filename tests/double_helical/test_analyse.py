"""Double helical pairs: limits of one half, closed forms of axial displacements, balance, files."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import ConvergenceError, InputError, analyse
from loaded_tca.double_helical import DoubleHelicalResult, analyse_double_helical
from loaded_tca.double_helical import analyse as analyses
from loaded_tca.double_helical.balance import Shares
from loaded_tca.results import load_result
from loaded_tca.results.warnings import at_places
from loaded_tca.warning_kinds import DEFLECTION_OF_HALVES, MEASURED_HALF, SHARES_OF_HALVES, SHUTTLES, kind_of
from tests.samples import double_helical as samples
from tests.samples.root_stress import coarsely

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
HELD = {"pair.floating": "none"}
APEX = 0.005
ERRORS = ("transmission_error", "unloaded_transmission_error")


@pytest.fixture(scope="module")
def equal_halves():
    return samples.equal_halves()


@pytest.fixture(scope="module")
def unlike_halves():
    return samples.unlike_halves()


@pytest.fixture(scope="module")
def one_half(equal_halves):
    return analyse(equal_halves.half_scenes(0.0)[0])


@pytest.fixture(scope="module")
def unlike():
    return samples.analysed()[0]


@pytest.fixture(scope="module")
def unlike_and_held(unlike_halves):
    return analyse_double_helical(
        unlike_halves.with_changes({**HELD, "analysis.positions": 1, "pair.apex_offset_mm": APEX})
    )


@pytest.mark.parametrize("floating", ["pinion", "none"])
def test_equal_halves_are_one_half_under_half_the_torque(equal_halves, one_half, floating, monkeypatch):
    monkeypatch.setattr(analyses, "analyse", lambda *_: one_half)
    result = analyse(equal_halves.with_changes({"pair.floating": floating}))
    assert one_half.torque.tolist() == [0.5 * torque for torque in equal_halves.torques]
    for number, of_half in (
        (result.transmission_error, one_half.transmission_error),
        (result.mesh_stiffness, one_half.mesh_stiffness),
        (result.peak_pressure[..., 1], np.nanmax(one_half.peak_pressure, axis=-1)),
        (result.line_load[..., 0], np.nanmax(one_half.line_load, axis=-1)),
        (result.face_load_factor[:, 1], one_half.face_load_factor),
        (result.torque_share, np.full_like(result.torque_share, 0.5)),
    ):
        assert_allclose(number, of_half, rtol=1e-10)  # forces are balanced to 1e-14 of the whole
    assert_allclose(result.axial_motion, 0.0, atol=1e-12)  # mm; deflections of both halves cancel
    assert_allclose(result.axial_force_left, 0.0, atol=1e-9 * np.abs(result.axial_force).max())
    assert result.share_factor.tolist() == [1.0]


def test_an_apex_beside_the_groove_of_held_gears_shifts_load_by_the_axial_stiffness(
    equal_halves, one_half, monkeypatch
):
    monkeypatch.setattr(analyses, "_analysed", lambda *_: 2 * (analyses._Half(one_half, []),))
    offset = 1e-4
    result = analyse_double_helical(equal_halves.with_changes({**HELD, "pair.apex_offset_mm": offset}))
    mesh = equal_halves.mesh()
    stiffness = 1e3 * one_half.face_width * one_half.mesh_stiffness[0]
    # the flanks of one half part by d tan(beta_b), those of the other come together: each force changes by k of that
    shift = np.tan(abs(mesh.pinion.base_helix_angle)) * offset * stiffness
    force = result.torque_share[0] * result.torque[0] / mesh.pinion.base_radius
    even = 0.5 * result.torque[0] / mesh.pinion.base_radius
    # the stiffness changes by a part of the change of the force, 1e-3
    assert_allclose(force[:, 0] - even, shift, rtol=1e-3)  # half a is right-hand: its flanks come together
    assert_allclose(even - force[:, 1], shift, rtol=1e-3)
    assert_allclose(result.axial_force_left[0], -2.0 * shift * np.tan(mesh.pinion.base_helix_angle), rtol=1e-3)


@pytest.mark.parametrize(("floating", "sign"), [("pinion", 1.0), ("wheel", -1.0)])
def test_a_floating_gear_follows_the_apex(equal_halves, one_half, floating, sign, monkeypatch):
    monkeypatch.setattr(analyses, "analyse", lambda *_: one_half)
    apart = {"pair.floating": floating, "pair.apex_offset_mm": 0.02, "mounting.axial_offset_mm": 0.01}
    scene = equal_halves.with_changes(apart)
    monkeypatch.setattr(analyses, "_analysed", lambda *_: 2 * (analyses._Half(one_half, []),))
    result = analyse_double_helical(scene)
    assert_allclose(result.axial_motion, sign * 0.03, rtol=1e-9)
    assert_allclose(result.transmission_error, one_half.transmission_error, rtol=1e-9)


def test_axial_forces_of_unlike_halves_balance_where_a_gear_floats(unlike):
    left, whole = unlike.axial_force_left, np.abs(unlike.axial_force).max()
    assert_allclose(left, 0.0, atol=1e-9 * whole)
    for half, cycle in enumerate(unlike.halves):  # forces along the normals of the contact points
        normals = np.array([np.nan_to_num(path.normal[:, 2]) for path in cycle.paths]).T
        axial = (1.0, -1.0)[half] * (np.nan_to_num(cycle.normal_force)[0] * normals).sum(axis=-1)
        assert_allclose(unlike.axial_force[0, :, half], axial, rtol=5e-3)  # edges and slopes turn normals by 1e-3
    assert np.abs(unlike.axial_motion).min() > 1e-4  # half the way of the slope's flanks


def test_shares_of_held_halves_are_those_of_halves_by_themselves(unlike_and_held):
    scene, share = unlike_and_held.scene, unlike_and_held.torque_share[0, 0]
    torques = [[1e-3 * part * scene.torques[0]] for part in share]
    errors = [analyse(half).transmission_error[0, 0] for half in scene.half_scenes(0.0, torques)]
    mesh = scene.mesh()
    apex = APEX * np.tan(mesh.pinion.base_helix_angle) / mesh.wheel.base_radius
    assert share[0] - share[1] > 0.05  # the apex brings the flanks of half a together, so that the wheel is ahead
    # shares are told to 1e-4: between the torques that were analysed; both halves turn together
    assert_allclose(errors[0] + apex, errors[1] - apex, atol=2e-4 * abs(errors[0]))
    assert_allclose(unlike_and_held.transmission_error[0, 0], errors[0] + apex, atol=2e-4 * abs(errors[0]))
    assert unlike_and_held.share_error.max() < 1e-3


def test_a_soft_support_lets_go_and_a_stiff_one_holds(unlike_halves, unlike, unlike_and_held, monkeypatch):
    held = [analyses._Half(cycle, []) for cycle in unlike_and_held.halves]
    monkeypatch.setattr(analyses, "_analysed", lambda *_: held)
    scene = unlike_halves.with_changes({"analysis.positions": 1, "pair.apex_offset_mm": APEX})
    soft, stiff = (
        analyse_double_helical(scene.with_changes({"pair.axial_stiffness_N_per_um": stiffness}))
        for stiffness in (1e-9, 1e9)
    )
    assert_allclose(soft.torque_share, 0.5, atol=1e-9)
    assert_allclose(stiff.torque_share, unlike_and_held.torque_share, atol=1e-7)  # 1e9 N/um move by 1e-8 um
    assert unlike.torque_share.tolist() == np.full((1, 2, 2), 0.5).tolist()


def test_a_place_that_does_not_settle_is_an_error(equal_halves, one_half, monkeypatch):
    monkeypatch.setattr(analyses, "_analysed", lambda *_: 2 * (analyses._Half(one_half, []),))
    places = iter(np.arange(1.0, 20.0))
    monkeypatch.setattr(analyses, "_places", lambda *_: np.array([next(places)]))
    with pytest.raises(ConvergenceError, match=r"pair\.floating: the place of the pinion along its axis, 6 mm, is not"):
        analyse_double_helical(equal_halves)


def test_a_torque_in_a_list_has_the_numbers_that_it_has_alone(equal_halves, one_half, monkeypatch):
    rate, length = equal_halves.axial_rate, -one_half.gear_pair.driving * one_half.gear_pair.base_radii[1]

    def where_they_stand(scenes, *_):  # helices turn into themselves; pressures grow where faces lie beside each other
        halves = []
        for scene in scenes:
            offset, numbers = scene.mounting.axial_offset_mm, one_half.dataset
            moved = {name: numbers[name] + rate * offset / length for name in ERRORS}
            moved["peak_pressure"] = numbers["peak_pressure"] * (1.0 + abs(offset))
            maps = [
                [[one and replace(one, pressure=one.pressure * (1.0 + abs(offset))) for one in row] for row in rows]
                for rows in one_half.maps
            ]
            cycle = replace(one_half, scene=scene, dataset=numbers.assign(moved), maps=maps, states=None)
            halves.append(analyses._Half(cycle, []))
        return halves

    monkeypatch.setattr(analyses, "_analysed", where_they_stand)
    softly = {"pair.axial_stiffness_N_per_um": 1.0, "pair.apex_offset_mm": 8.0}  # so far apart that half a has it all
    both, *alone = (
        analyse_double_helical(equal_halves.with_changes({**softly, "analysis.torques_Nm": torques}))
        for torques in ([160.0, 1600.0], [160.0], [1600.0])
    )
    # N/um and um: the axial force of half a, T tan(beta_b)/r_b, on the support
    mesh = equal_halves.mesh()
    force = both.torque / mesh.pinion.base_radius * np.tan(mesh.pinion.base_helix_angle)
    assert_allclose(1e3 * both.axial_motion, np.broadcast_to(force[:, None], (2, 2)), rtol=1e-9)
    for name in ("peak_pressure", "mesh_stiffness", "transmission_error", "axial_motion", "face_load"):
        numbers = np.concatenate([getattr(result, name) for result in alone])
        assert_allclose(getattr(both, name), numbers, rtol=1e-9)  # places differ by rounding
    assert both.half_a.scene.mounting == alone[1].half_a.scene.mounting
    note = next(note for note in both.notes() if "half_a and half_b hold the mesh" in note)
    assert note.startswith(
        "under 160 N m the pinion stands -6.43 mm along its axis from its place under 1600 N m; half_a "
    )
    assert note.endswith("half_a_under_160_Nm.nc and half_b_under_160_Nm.nc at the place under 160 N m")
    assert both.place.tolist() == [1, 0]
    assert both.elsewhere[0][0].scene.mounting == alone[0].half_a.scene.mounting


def test_a_half_that_carries_all_has_the_numbers_that_it_has_alone_beside_a_larger_torque(equal_halves):
    scene = equal_halves.with_changes({**HELD, "pair.apex_offset_mm": 0.02})
    both = analyse(scene.with_changes({"analysis.torques_Nm": [150.0, 1600.0]}))
    assert both.torque_share[0].tolist() == [[1.0, 0.0]] * 2
    assert 0.5 < both.torque_share[1, 0, 0] < 0.9  # half b is reached there: shares of both torques differ
    half = analyse(scene.half_scenes(0.0, [[150.0], [150.0]])[0])
    apart = scene.parted[0] / (-half.gear_pair.driving * half.gear_pair.base_radii[1])  # by the apex
    for number, alone in (
        (both.transmission_error[0] - apart, half.transmission_error[0]),
        (both.peak_pressure[0, :, 0], np.nanmax(half.peak_pressure[0], axis=-1)),
        (both.line_load[0, :, 0], np.nanmax(half.line_load[0], axis=-1)),
        (both.face_load_factor[0, 0], half.face_load_factor[0]),
        (both.face_load[0, 0].max() / both.face_load[0, 0].mean(), half.face_load_factor[0]),
    ):
        assert_allclose(number, alone, rtol=1e-6)  # each state is solved by itself, to the tolerance of its balance


def test_mean_and_largest_torque_of_a_half_are_analysed_where_its_share_is_certain(equal_halves):
    scene = equal_halves.with_changes({**HELD, "analysis.torques_Nm": [100.0, 1000.0]})
    force, certain = np.zeros((2, 2, 2)), np.zeros((2, 2))
    whole = np.array([1e5, 1e6]) / scene.mesh().pinion.base_radius
    force[..., 0] = whole[:, None] * [[0.7, 0.8], [0.6, 0.61]]
    force[..., 1] = whole[:, None] - force[..., 0]
    state = Shares(force, certain, certain, certain, certain, certain)
    of_halves = analyses._wanted(scene, state, 2 * [[5e4, 5e5]])
    for wanted, asked in zip(of_halves, ([7.5e4, 8e4, 6.05e5, 6.1e5], [2.5e4, 3e4, 3.95e5, 4e5]), strict=True):
        assert np.abs(np.subtract.outer(asked, wanted) / np.array(asked)[:, None]).min(axis=1).max() <= 0.02
    assert analyses._wanted(scene, state, of_halves) == of_halves


def test_results_come_back_from_their_files(unlike, tmp_path, equal_halves):
    unlike.save(tmp_path)
    again = DoubleHelicalResult.load(tmp_path)
    assert again.dataset.identical(unlike.dataset)
    assert again.scene == unlike.scene
    assert again.half_b.dataset.identical(unlike.half_b.dataset)
    assert again.summary() == unlike.summary()
    with pytest.raises(InputError, match="a double helical pair, not the result of a mesh cycle; half_a"):
        load_result(tmp_path / "double_helical.nc")
    other = replace(unlike, scene=equal_halves)
    other.save(tmp_path)
    with pytest.raises(
        InputError, match=r"half_b\.nc: the mesh cycle of another pair than double_helical.nc beside it"
    ):
        DoubleHelicalResult.load(tmp_path)


def test_table_has_a_column_for_each_half(unlike):
    table = unlike.to_table()
    assert_allclose(table["half_a_torque_share"] + table["half_b_torque_share"], 1.0)
    assert {"axial_motion_um", "half_b_axial_force_N", "transmission_error_um"} < set(table)


def test_halves_out_of_reach_of_each_other_are_told_and_analysed_under_what_they_carry(
    equal_halves, one_half, monkeypatch
):
    asked = []

    def ready(scenes, *_):
        asked.append(scenes[0].torques)
        return 2 * (analyses._Half(one_half, []),)

    monkeypatch.setattr(analyses, "_analysed", ready)
    scene = equal_halves.with_changes({**HELD, "pair.apex_offset_mm": 1.0})
    result = analyse_double_helical(scene)
    assert result.torque_share.tolist() == [[[1.0, 0.0]] * 2]
    assert asked[-1] == (asked[0][0], equal_halves.torques[0])  # half a under the whole torque, to the last digit
    assert result.notes() == (
        "under 1600 N m half b carries no load at any position: the gap between its flanks is larger than "
        "the deflection of the other half",
    )
    assert_allclose(result.key_figures()[0]["share_factor"], 2.0)
    assert result.peak_pressure[0, 0, 1] == 0.0
    assert np.isnan(result.face_load_factor[0, 1])


@pytest.mark.thorough
def test_root_tension_of_equal_halves_is_that_of_one(equal_halves):
    with coarsely():
        result = analyse_double_helical(equal_halves.with_changes({"analysis.root_stress": True}))
    assert_allclose(result.root_tension, result.half_a.root_tension.max(axis=1)[:, None] * np.ones((2, 1)), rtol=1e-10)
    figures = result.key_figures()[0]
    assert figures["half_b_wheel_root_tension_MPa"] == pytest.approx(result.root_tension[0, 1, 1])


def test_warnings_say_whose_they_are(unlike):
    _, sentences = samples.analysed()
    assert sentences == list(unlike.warnings)
    assert {sentence[:8] for sentence in sentences} == {"half a: ", "half b: "}
    placed = [sentence for sentence in sentences if "pressure maps" in sentence]
    assert all(sentence.endswith("; N m: the torque of the half)") for sentence in placed)


def test_uncertain_shares_are_told(equal_halves, one_half, monkeypatch):
    monkeypatch.setattr(analyses, "_analysed", lambda *_: 2 * (analyses._Half(one_half, []),))
    result = analyse_double_helical(equal_halves.with_changes({**HELD, "pair.apex_offset_mm": 0.03}))
    of_shares, of_deflection = result.warnings  # far beyond the torques of one half
    assert of_shares.startswith("the shares of the halves are off by up to")
    assert of_deflection.startswith("the deflection of both halves together is off by up to")
    assert [*map(kind_of, result.warnings)] == [SHARES_OF_HALVES, DEFLECTION_OF_HALVES]


@pytest.mark.parametrize(
    ("support", "count"),
    [({}, 0), ({"pair.floating": "none"}, 1), ({"pair.axial_stiffness_N_per_um": 5.0}, 1)],
    ids=["free", "held", "soft"],
)
def test_a_measured_flank_of_one_half_that_is_held_is_warned_of(equal_halves, one_half, support, count, monkeypatch):
    monkeypatch.setattr(analyses, "_analysed", lambda *_: 2 * (analyses._Half(one_half, []),))
    points = {"radius_mm": [4 * [r] for r in (64.0, 66.0, 68.0, 70.0)], "axial_mm": 4 * [[-15.0, -5.0, 5.0, 15.0]]}
    flank = {"form": "measured", "measurement": {**points, "deviation_um": 4 * [4 * [0.0]]}}
    scene = equal_halves.with_changes({**support, "pinion.half_b": {"flank": flank}})
    sentences = [line for line in analyse_double_helical(scene).warnings if kind_of(line) is MEASURED_HALF]
    assert [line.partition(" has")[0] for line in sentences] == count * ["half b of the pinion"]
    alike = equal_halves.with_changes({**support, "pinion.flank": flank})
    assert alike.measured_halves == ()


def test_shuttling_beyond_a_thousandth_of_the_width_is_warned_of(equal_halves, one_half, monkeypatch):
    way, pair = 0.05, one_half.gear_pair  # of 40 mm
    turned = 2.0 * way * abs(equal_halves.axial_rate) / pair.base_radii[1] * np.array([1.0, -1.0])
    moved = one_half.dataset.assign({name: one_half.dataset[name] + turned for name in ERRORS})
    halves = [analyses._Half(cycle, []) for cycle in (one_half, replace(one_half, dataset=moved, states=None))]
    monkeypatch.setattr(analyses, "_analysed", lambda *_: halves)
    result = analyse_double_helical(equal_halves)
    assert_allclose(np.abs(result.axial_motion), way, rtol=1e-9)
    (sentence,) = result.warnings
    assert kind_of(sentence) is SHUTTLES
    assert "the pinion shuttles along its axis by up to 50 um from its mean place" in sentence


def test_a_sentence_without_a_torque_says_nothing_of_torques():
    sentence = "fillet interference: the wheel reaches below the form circle (at the centre distance of 262.8 mm)"
    assert analyses._of_half(sentence) == sentence
    placed = at_places("the contact is wide", ["300 N m, pinion angle 0 deg, tooth pair 0"], 4)
    assert analyses._of_half(placed) == f"{placed[:-1]}; N m: the torque of the half)"


def test_halves_say_what_their_numbers_leave_out():
    result, _ = samples.analysed()
    for half, cycle in zip("ab", result.halves, strict=True):
        assert cycle.left_out.startswith(f"half {half} of a double helical pair: ")
        assert cycle.notes()[0] == cycle.left_out
        assert f"note: {cycle.left_out}" in cycle.summary()
    assert result.left_out == ""
