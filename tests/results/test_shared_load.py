"""Results of a cycle whose tooth pairs share the load: what a whole cycle has to fulfil, its files, its figures."""

import json
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import AccuracyWarning, InputError, analyse, load_result, read_scene
from loaded_tca.output.result_files import positions_csv, summary_json
from loaded_tca.pairs import mating_teeth
from loaded_tca.plots import MORE_PICTURES, ON_SUPPORTS, PICTURES, plot_all
from loaded_tca.reference.weber_banaschek import ring_torsion
from loaded_tca.results.files import read_dataset, write_dataset
from loaded_tca.results.teeth import teeth_in_space
from loaded_tca.unloaded.teeth import harmonic_coefficients
from tests.samples.results import FLANKS_ALONE, ONE_PAIR, PER_PAIR, SCENES, assert_same
from tests.samples.shared import made_once

EQUILIBRIUM = 1e-8
"""Asked for: the torques of the pairs sum up to that of the pinion."""
ROUNDING = 1e-12
"""Of shares, which are divided by their sum; a torque in a stack is solved as alone: 2e-16 was seen."""
PERIOD = 1e-3
"""Agreement of positions a pitch apart: the same contacts from other starts, on boxes that may differ."""


@made_once
def cycle(name="spur", positions=5, torques=(40.0, 130.0)):
    scene = read_scene(SCENES / f"mesh_cycle_{name}.toml")
    changes = {
        **FLANKS_ALONE,
        "analysis.positions": positions,
        "analysis.cells": (20, 20),
        "analysis.accuracy": None,
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts at tips are wanted here
        return analyse(scene.with_changes({**changes, "analysis.torques_Nm": torques}))


def helical():
    return cycle("helical", 9, (130.0,))


def bevel():
    return cycle("bevel", 5, (0.8,))


@pytest.mark.parametrize("make", [cycle, helical, bevel])
def test_forces_of_the_pairs_balance_the_torque(make):
    result = make()
    levers = np.stack([path.pinion_lever for path in result.paths], axis=-1)
    torques = np.nansum(result.normal_force * levers, axis=-1)
    assert_allclose(torques, np.broadcast_to(result.torque[:, None], torques.shape), rtol=EQUILIBRIUM)


@pytest.mark.parametrize("make", [cycle, helical, bevel])
def test_shares_sum_up_to_one(make):
    assert_allclose(make().load_share.sum(axis=-1), 1.0, rtol=ROUNDING)


@pytest.mark.parametrize("make", [cycle, helical, bevel])
def test_cycle_repeats_after_a_pitch(make):
    result = make()
    share = result.load_share
    added = result.path.transmission_error - result.transmission_error
    assert_allclose(added[:, 0], added[:, -1], rtol=PERIOD)
    assert result.pair.tolist() == [-1, 0, 1]
    assert_allclose(share[:, 0, 1], share[:, -1, 2], atol=PERIOD)  # pair 0 is pair +1 a pitch later
    assert_allclose(share[:, 0, 0], share[:, -1, 1], atol=PERIOD)


def test_no_number_depends_on_the_other_torques():
    """Each torque starts from its own Hertz law: alone, in another order, or beside others it is the same."""
    alone, beside = cycle(torques=(130.0,)), cycle(torques=(260.0, 130.0, 40.0))
    for name in PER_PAIR:
        one, other = getattr(alone, name), getattr(beside, name)[1:2]
        assert_allclose(one, other[..., np.isin(beside.pair, alone.pair)], rtol=ROUNDING)
    assert_allclose(alone.transmission_error, beside.transmission_error[1:2], rtol=ROUNDING)


def test_driving_wheel_sees_the_same_cycle_backwards():
    """Time reversed: the same contacts in the opposite order, the transmission error of the other sign."""
    scene = read_scene(SCENES / "mesh_cycle_spur.toml").with_changes(
        {**FLANKS_ALONE, "analysis.positions": 5, "analysis.cells": (16, 16), "analysis.torques_Nm": (40.0,)}
    )
    forwards, backwards = (analyse(scene.with_changes({"pair.driving": gear})) for gear in ("pinion", "wheel"))
    assert_allclose(backwards.load_share[0, ::-1, 1], forwards.load_share[0, :, 1], atol=PERIOD)
    assert_allclose(backwards.transmission_error[:, ::-1], -forwards.transmission_error, rtol=PERIOD)
    assert (backwards.transmission_error > 0.0).all()


def test_sharing_lowers_the_force_and_raises_the_stiffness():
    result = cycle(torques=(130.0,))
    alone = analyse(
        read_scene(SCENES / "mesh_cycle_spur.toml").with_changes(
            {
                "analysis.positions": 5,
                "analysis.cells": (20, 20),
                "analysis.accuracy": None,
                "analysis.torques_Nm": (130.0,),
                **ONE_PAIR,
                "pinion.modifications.tip_relief_um": 0.0,
                "wheel.modifications.tip_relief_um": 0.0,
            }
        )
    )
    assert alone.peak_pressure.shape == (1, 5, 1)
    shared = result.loaded_pairs > 1
    assert shared.any()
    assert not shared.all()
    assert (result.at_position("normal_force")[shared] < alone.at_position("normal_force")[shared]).all()
    assert (result.mesh_stiffness[shared] > alone.mesh_stiffness[shared]).all()


def test_zero_torque_gives_the_unloaded_transmission_error():
    result = cycle(positions=3, torques=(0.0, 40.0))
    assert_array_equal(result.transmission_error[0], result.path.transmission_error)
    assert_allclose(result.at_position("peak_pressure")[0], 0.0, atol=0)
    assert_allclose(result.at_position("line_load")[0], 0.0, atol=0)
    assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=ROUNDING)


def test_secant_stiffness_is_the_force_over_the_lag():
    result = cycle()
    lag = result.path.transmission_error - result.transmission_error
    pair = result.scene.pair()
    force = result.torque[:, None] / pair.base_radii[0] / result.face_width
    assert_allclose(result.secant_stiffness, force / (1e3 * result.wheel_base_radius * lag), rtol=1e-9)
    assert (result.mesh_stiffness > result.secant_stiffness).all()  # flanks stiffen


def test_numbers_of_the_cycle_are_those_of_the_highest_pair():
    result = cycle()
    assert_array_equal(result.at_position("peak_pressure"), np.nanmax(result.peak_pressure, axis=-1))
    for torque, position in np.ndindex(result.transmission_error.shape):
        column = np.nanargmax(result.peak_pressure[torque, position])
        for name in ("peak_radius", "peak_axial", "iterations", "on_edge"):
            assert result.at_position(name)[torque, position] == getattr(result, name)[torque, position, column]


def test_forces_of_the_cycle_are_those_of_the_pair_that_carries_most():
    """A tip corner may have the highest peak under next to no force."""
    result = cycle()
    assert_array_equal(result.at_position("normal_force"), np.nanmax(result.normal_force, axis=-1))
    for torque, position in np.ndindex(result.transmission_error.shape):
        column = np.nanargmax(result.normal_force[torque, position])
        for name in ("line_load", "contact_deformation", "contact_width"):
            assert result.at_position(name)[torque, position] == getattr(result, name)[torque, position, column]


def test_edge_pressure_of_a_position_is_the_highest_of_its_pairs():
    result = cycle("helical", 9, (260.0,))
    assert_array_equal(result.at_position("edge_pressure"), np.fmax.reduce(result.edge_pressure, axis=-1))
    assert np.isfinite(result.at_position("edge_pressure")).any()


def test_edge_pressure_is_that_of_the_cells_beside_no_material():
    one = next(one for row in cycle().maps[0] for one in row if one is not None)
    pressure, gap = np.zeros_like(one.pressure), np.zeros_like(one.gap)
    gap[:, 15:] = np.inf
    pressure[5, 14], pressure[6, 14], pressure[5, 10] = 2.0, 3.0, 9.0
    assert replace(one, pressure=pressure, gap=gap).edge_cell == (6, 14)
    pressure[7, 0] = 4.0  # at the end of the grid
    assert replace(one, pressure=pressure, gap=gap).edge_cell == (7, 0)


def test_pair_that_is_apart_has_no_map_and_no_force():
    contacts = cycle()
    apart = np.array([[[one is None for one in row] for row in rows] for rows in contacts.maps])
    assert apart.any()
    assert_array_equal(contacts.normal_force[apart], 0.0)
    assert np.isnan(contacts.peak_pressure[apart]).all()
    assert (contacts.normal_force[~apart] > 0.0).all()


def test_line_load_carries_the_force():
    """The largest line load is above the mean over the length, below twice that: an ellipse has 3/2 of it."""
    contacts = cycle()
    mean = contacts.normal_force / contacts.contact_length
    loaded = contacts.normal_force > 0.0
    ratio = contacts.line_load[loaded] / mean[loaded]
    assert (ratio > 1.0).all()
    assert (ratio < 2.0).all()
    assert (contacts.line_load_ratio[loaded] > 1.0).all()


def test_line_load_of_a_hertzian_ellipse_is_three_halves_of_its_mean():
    result = cycle(positions=1, torques=(40.0,))
    mean = result.at_position("normal_force") / (2.0 * result.at_position("hertz_semi_major"))
    assert_allclose(result.at_position("line_load") / mean, 1.5, rtol=2e-2)  # 20 cells across a contact of 16


def test_harmonics_make_up_the_transmission_error():
    """Parseval: the mean square about the mean is half the sum of the squared amplitudes, all orders known."""
    result = helical()
    error = result.transmission_error[0, :-1]
    amplitudes = result.harmonics(3)[0]
    rest = np.abs(np.fft.rfft(error)[4]) / len(error)  # the order of half the positions counts in full
    variance = float(((error - error.mean()) ** 2).mean())
    assert_allclose(0.5 * (amplitudes**2).sum() + rest**2, variance, rtol=1e-9)


def test_harmonics_of_too_few_positions_are_unknown():
    assert np.isnan(harmonic_coefficients(np.zeros(1), 2)).all()
    assert_array_equal(np.isnan(harmonic_coefficients(np.zeros(5), 3)), [False, True, True])
    assert np.isnan(harmonic_coefficients(np.array([0.0, np.nan, 0.0, 0.0]), 1)).all()


@pytest.mark.parametrize("count", [0, 1.5, None])
def test_count_of_harmonics_that_is_no_whole_number_is_refused(count):
    with pytest.raises(InputError, match="count"):
        cycle().harmonics(count)


@pytest.mark.parametrize("make", [cycle, helical, lambda: cycle(positions=1, torques=(40.0,))])
def test_result_survives_its_file_unchanged(make, tmp_path):
    make().save(tmp_path / "result.nc")
    assert_same(load_result(tmp_path / "result.nc"), make())


def test_file_that_lacks_parts_of_the_pairs_is_told(tmp_path):
    cycle().save(tmp_path / "result.nc")
    whole = read_dataset(tmp_path / "result.nc")
    write_dataset(tmp_path / "result.nc", whole.drop_vars("contact_deformation"))
    with pytest.raises(InputError, match="contact_deformation: missing"):
        load_result(tmp_path / "result.nc")


def test_figures_tell_the_pairs():
    (figures,) = helical().key_figures()
    assert 1.0 < figures["loaded_contact_ratio"] < 3.0
    assert figures["transmission_error_order_1_um"] > figures["transmission_error_order_3_um"] > 0.0
    assert figures["positions"] == figures["positions_in_contact"] == 9
    assert figures["edge_positions"] <= 9
    assert figures["line_load_max_N_per_mm"] == np.nanmax(helical().line_load)
    assert figures["unloaded_transmission_error_span_um"] > 0.0


def test_peak_of_the_figures_is_the_highest_of_any_pair():
    result = helical()
    (figures,) = result.key_figures()
    assert figures["peak_pressure_MPa"] == np.nanmax(result.peak_pressure)
    position, column = result.peak_contact(0)
    assert figures["normal_force_at_peak_N"] == result.normal_force[0, position, column]
    assert figures["peak_pressure_MPa"] == result.peak_pressure[0, position, column]


def test_summary_names_the_pairs_and_whether_teeth_bend():
    text = helical().summary()
    assert "load shared by the tooth pairs -1, 0, +1, at most 2 at once; teeth do not bend" in text
    alone = cycle("spur", 1).summary().splitlines()[1]
    assert alone == "1 position; tooth pair 0 alone carries the load (load sharing on); teeth do not bend"
    assert "  orders 1 | 2 | 3 of the tooth mesh [um]" in text
    assert json.loads(summary_json(helical()))["tooth_pairs_sharing_load"] == 3


def test_table_has_a_share_for_every_pair():
    header = positions_csv(cycle()).splitlines()[0].split(",")
    assert [name for name in header if name.startswith("load_share")] == [
        "load_share_pair_-1",
        "load_share_pair_0",
        "load_share_pair_1",
    ]
    assert "loaded_pairs" in header
    assert "line_load_N_per_mm" in header


def test_numbers_of_every_pair_have_the_axes_torque_position_pair():
    for make, shape in ((cycle, (2, 5, 3)), (helical, (1, 9, 3))):
        assert all(getattr(make(), name).shape == shape for name in PER_PAIR)
        assert [len(make().maps), len(make().maps[0]), len(make().maps[0][0])] == list(shape)


ALWAYS = (
    {name for name in PICTURES if not name.startswith("root_stress")}
    - set(ON_SUPPORTS)
    - {"pressure_map_edge", "pressure_map_hertz"}
)


@pytest.mark.thorough
def test_every_picture_of_a_shared_load_is_drawn_and_those_on_request_go_without(tmp_path, request):
    drawn = {path.stem for path in plot_all(cycle(), tmp_path, more=True)}
    assert drawn >= ALWAYS | set(MORE_PICTURES)
    request.getfixturevalue("blank_pictures")
    plot_all(cycle(), tmp_path)
    assert not {path.stem for path in tmp_path.iterdir()} & set(MORE_PICTURES)


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_one_torque_has_every_picture_but_those_over_torques(tmp_path):
    """The tests of its report draw them."""
    drawn = {path.stem for path in plot_all(helical(), tmp_path, more=True)}
    assert drawn >= ALWAYS
    assert "contact_patterns" not in drawn


@pytest.mark.usefixtures("blank_pictures")
def test_pictures_of_a_shared_load_go_where_one_pair_carries_all(tmp_path):
    (tmp_path / "load_share.png").write_bytes(b"")
    plot_all(cycle(positions=1, torques=(40.0,)), tmp_path)
    assert not (tmp_path / "load_share.png").exists()


def test_teeth_are_placed_where_the_pair_with_the_pressure_stands():
    result = cycle(positions=9, torques=(130.0,))
    columns = result.peak_column[0]
    position = int(np.flatnonzero(columns != 1)[0])
    teeth = mating_teeth(result.gear_pair)
    shown = teeth_in_space(result, teeth, position, 0)
    one = result.maps[0][position][columns[position]]
    cells = shown.pressure.vertices
    turned = result.unloaded_transmission_error[position] - result.transmission_error[0, position]
    half = 0.5 * turned * result.gear_pair.base_radii[1]  # the contact under load lies at the middle of its way
    assert np.linalg.norm(shown.point - one.origin) < half
    assert np.linalg.norm(cells - one.origin, axis=1).min() < 1.0  # mm: the pressure lies on the tooth at its place


@made_once
def bending(load_sharing):
    scene = read_scene(SCENES / "mesh_cycle_spur.toml")
    narrow = {"pinion.face_width_mm": 6.0, "wheel.face_width_mm": 6.0, "analysis.torques_Nm": (30.0,)}
    coarse = {"analysis.positions": 2, "analysis.cells": (16, 16), "analysis.accuracy": None}
    how = {"analysis.load_sharing": load_sharing, "analysis.free_edges": False}
    return analyse(scene.with_changes({**narrow, **coarse, **how}))


@cache
def bending_face_milled(load_sharing, compliance="contact+tooth"):
    scene = read_scene(SCENES / "face_milled_19x62_matched.toml")
    coarse = {"analysis.positions": 2, "analysis.cells": (20, 20), "analysis.accuracy": None}
    how = {"analysis.load_sharing": load_sharing, "analysis.compliance": compliance, "analysis.free_edges": False}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts at tips are wanted here
        return analyse(scene.with_changes({**coarse, **how}))


@pytest.mark.parametrize("load_sharing", [pytest.param(False, marks=pytest.mark.thorough), True])
@pytest.mark.parametrize("make", [bending, pytest.param(bending_face_milled, marks=pytest.mark.thorough)])
def test_transmission_error_of_teeth_that_bend_is_their_deflection(make, load_sharing):
    result = make(load_sharing)
    added = result.path.transmission_error - result.transmission_error[0]
    for column, path in enumerate(result.paths):
        loaded = result.normal_force[0, :, column] > 0.0
        deflection = (result.contact_deformation + result.tooth_deflection)[0, loaded, column]
        apart = (result.path.transmission_error - path.transmission_error)[loaded]
        assert_allclose(deflection / path.wheel_lever[loaded], added[loaded] - apart, rtol=1e-4)
    assert (result.tooth_deflection[result.normal_force > 0.0] > 0.0).all()
    assert "teeth bend" in result.summary()


@pytest.mark.thorough
def test_bending_teeth_are_half_as_stiff_as_their_contacts():
    """The contact of steel flanks yields about as much as their teeth do: 12 to 20 N/(mm um) for a pair, ISO 6336-1."""
    alone = bending(False).mesh_stiffness
    assert ((alone > 10.0) & (alone < 20.0)).all()
    assert (bending(True).mesh_stiffness > 1.2 * alone).all()  # two pairs at both ends of the pitch


@pytest.mark.thorough
def test_face_milled_teeth_that_bend_are_softer_and_share_more_evenly():
    """Both ends of a pitch are one state of the mesh, with and without bending."""
    bends, stiff = (bending_face_milled(True, compliance) for compliance in ("contact+tooth", "contact"))
    assert (bends.mesh_stiffness < 0.7 * stiff.mesh_stiffness).all()
    assert bends.load_share[0, 0].max() < stiff.load_share[0, 0].max()
    for result in (bends, stiff):
        assert_allclose(result.transmission_error[0, 0], result.transmission_error[0, 1], rtol=PERIOD)


def test_mesh_stiffness_without_body_torsion_is_told_beside_the_whole_one():
    """The twist of two rings, 0.55 of the root circles, in series with the rest; bodies of solid gears twist, too."""
    result = bending(True)
    (figures,) = result.key_figures()
    gears = result.scene.mesh().pinion, result.scene.mesh().wheel
    rings = [gear.base_radius**2 * ring_torsion(0.55 * gear.root_radius, gear.root_radius) for gear in gears]
    whole = figures["mesh_stiffness_mean_N_per_mm_um"]
    without = figures["mesh_stiffness_without_body_torsion_mean_N_per_mm_um"]
    assert_allclose(1.0 / whole - 1.0 / without, 1e3 * sum(rings), rtol=1e-9)
    assert without > 1.02 * whole
    assert "without body torsion [N/(mm um)]" in result.summary()
    solid = replace(result, scene=result.scene.with_changes({"pinion.bore_diameter_mm": 0.0}))
    assert solid.without_body_torsion(whole) > without


def test_flanks_that_deform_alone_have_no_body_torsion():
    bends = bending(True)
    result = replace(bends, scene=bends.scene.with_changes({"analysis.compliance": "contact"}))
    assert np.isnan(result.key_figures()[0]["mesh_stiffness_without_body_torsion_mean_N_per_mm_um"])
    assert "tangent, without body torsion" not in result.summary()


@pytest.mark.thorough
def test_progress_is_told_after_every_torque_and_position():
    told = []
    scene = read_scene(SCENES / "mesh_cycle_spur.toml")
    changes = {"analysis.positions": 2, "analysis.cells": (12, 12), "analysis.torques_Nm": (40.0, 50.0)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # a coarse grid is wanted here
        analyse(scene.with_changes(changes), progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_pressure_of_a_tip_corner_is_none_of_the_flank():
    """The spike at the tip of the pair that leaves the mesh is not its peak, nor that of the cycle."""
    result = cycle_at_the_tip()
    (figures,) = result.key_figures()
    position, column = result.edge_contact(0)
    assert result.load_share[0, position, column] < 0.25
    assert result.edge_pressure[0, position, column] > 1.2 * figures["peak_pressure_MPa"]
    assert result.peak_pressure[0, position, column] < figures["peak_pressure_MPa"]


@cache
def cycle_at_the_tip():
    """At one of its positions the contact point of pair -1 lies a tenth of a millimetre from the tip."""
    scene = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes(
        {
            **FLANKS_ALONE,
            "analysis.positions": 33,
            "analysis.cells": (20, 20),
            "analysis.accuracy": None,
            "analysis.torques_Nm": [260.0],
        }
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse(scene)
