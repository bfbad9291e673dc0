import math
from dataclasses import fields, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.compliance import FlankLine, RootStress
from loaded_tca.errors import InputError, NotAskedError
from loaded_tca.results import MeshCycle, compare_results, load_result
from loaded_tca.results.files import write_dataset
from loaded_tca.results.quantities import PLACE, QUANTITIES, ROOT_PARTS, ROOT_QUANTITIES
from loaded_tca.results.root_stress import root_stress_arrays
from tests.samples.results import assert_same
from tests.samples.root_stress import analysed, models, result, scene

ROUNDING = 1e-9  # sums over some hundred slices, times stresses of finite elements
SINGLE = 3e-4
"""Of the largest stress: what fronts of single precision may change (``validation.loaded.root_stress_precision``)."""
SHARED = 5e-4
"""Forces of several pairs, where the shares of these are iterated another way round."""
TOP = 1e-3
"""By which parabolas along fillet and face exceed the largest stress of the places that they go through."""
GEARS = "pinion", "wheel"


def assert_extreme(found, largest):
    assert (found >= largest).all()
    assert (found <= (1.0 + TOP) * largest).all()


def arrays_of(cycle, maps=None, known=None, name="mesh_cycle_spur"):
    """Root stress of the maps of a result, or of others in their place."""
    known = np.ones(cycle.transmission_error.shape, dtype=bool) if known is None else known
    pair = cycle.scene.pair()
    return root_stress_arrays(pair, models(name), cycle.pair.tolist(), known, maps or cycle.maps)


def mapped(cycle, change):
    """Maps of a result, each changed by ``change(place, map)``."""
    torques, positions, pairs = (range(length) for length in cycle.normal_force.shape)
    return tuple(
        tuple(
            tuple(None if (one := cycle.maps[t][n][k]) is None else change((t, n, k), one) for k in pairs)
            for n in positions
        )
        for t in torques
    )


def test_forces_on_the_roots_are_the_normal_forces_of_the_pairs():
    cycle, model = result(), models()[0]
    for place, force in np.ndenumerate(cycle.normal_force):
        if force > 0.0:
            t, n, k = place
            slices = cycle.maps[t][n][k].slice_force
            assert_allclose(slices.sum(), force, rtol=1e-6)  # the tolerance of the solver
            line = FlankLine(0, np.full(len(slices), 51.0), np.linspace(-9.0, 9.0, len(slices)))
            for table in model.forces_of_table(line, slices):
                assert_allclose(table.sum(), slices.sum(), rtol=ROUNDING)


@pytest.mark.quick_cases("mesh_cycle_spur")
@pytest.mark.parametrize("name", ["mesh_cycle_spur", "mesh_cycle_helical"])
def test_extremes_are_those_of_the_sum_over_the_pairs_at_all_teeth_of_the_gear(name):
    """One tooth and one pair at a time, at places of the contacts found from the frame of the pinion and the wheel."""
    cycle, t, n = result(name), 1, 1
    pair = cycle.scene.pair()
    loads = {0: [], 1: []}
    for number, one in zip(cycle.pair.tolist(), cycle.maps[t][n], strict=True):
        if one is not None:
            x, y, z = (one.origin + np.outer(one.force_line, one.axes[0]) + np.outer(one.y, one.axes[1])).T
            force = one.pressure.sum(axis=0) * one.spacing[0] * one.spacing[1]
            on_wheel = (np.column_stack([x, y, z]) - pair.wheel_origin) @ pair.wheel_axes.T
            loads[0].append((FlankLine(-number, np.hypot(x, y), z), force))
            loads[1].append((FlankLine(number, np.hypot(*on_wheel.T[:2]), on_wheel[:, 2]), force))
    assert len(loads[0]) > 1
    for gear, model in enumerate(models(name)):
        stress = np.array([model.stress(tooth, loads[gear]) for tooth in range(pair.teeth[gear])])
        assert_extreme(cycle.root_tension[t, n, gear], stress.max())
        assert_extreme(-cycle.root_compression[t, n, gear], -stress.min())
        for what, extreme in (("tension", stress.max()), ("compression", stress.min())):
            tooth, *place = getattr(cycle, f"root_{what}_place")[t, n, gear]
            assert_allclose(stress[(tooth, *place)], extreme, rtol=ROUNDING)
            assert getattr(cycle, f"root_{what}_angle")[t, n, gear] == model.tangent_angle[tuple(place)]
            assert getattr(cycle, f"root_{what}_axial")[t, n, gear] == model.point[(*place, 2)]


def test_loaded_tooth_is_pulled_on_the_side_in_contact_and_pressed_on_its_back():
    cycle = result()
    assert PLACE[1] == "side"
    assert (cycle.root_tension_place[..., 1] == 0).all()
    assert (cycle.root_compression_place[..., 1] == 1).all()
    assert (cycle.root_tension > 0.0).all()
    assert (cycle.root_compression < -cycle.root_tension).all()
    for angle in (cycle.root_tension_angle, cycle.root_compression_angle):
        assert (np.degrees(angle) > 20.0).all()
        assert (np.degrees(angle) < 60.0).all()


def test_most_stressed_tooth_is_that_of_the_pair_with_the_largest_force_where_one_carries_most():
    cycle = result()
    leading = cycle.pair[cycle.normal_force.argmax(axis=-1)]
    alone = cycle.load_share.max(axis=-1) > 0.9
    assert alone.any()
    for gear, sign in ((0, -1), (1, 1)):
        assert_array_equal(cycle.root_tension_place[..., gear, 0][alone], sign * leading[alone])


def test_stress_is_proportional_to_the_forces():
    cycle = result()
    doubled = arrays_of(cycle, mapped(cycle, lambda _, one: replace(one, pressure=2.0 * one.pressure)))
    for name in ("root_tension", "root_compression"):
        assert_allclose(doubled[name], 2.0 * getattr(cycle, name), rtol=ROUNDING)
        assert_array_equal(doubled[f"{name}_place"], getattr(cycle, f"{name}_place"))
    assert_allclose(doubled["root_stress_ratio"], cycle.root_stress_ratio, rtol=ROUNDING)
    for gear, one in zip(GEARS, cycle.root_stress, strict=True):
        assert_allclose(doubled[f"{gear}_root_stress_largest"], 2.0 * one.largest, atol=ROUNDING)


def test_envelopes_hold_the_extremes_of_every_position_and_nothing_beyond():
    cycle = result()
    for gear, one in enumerate(cycle.root_stress):
        assert_extreme(cycle.root_tension[..., gear].max(axis=1), one.largest.max(axis=(1, 2, 3)))
        assert_extreme(-cycle.root_compression[..., gear].min(axis=1), -one.smallest.min(axis=(1, 2, 3)))
        assert_extreme(cycle.root_tension[..., gear].max(axis=1), one.at_tension.max(axis=(1, 2, 3)))
        assert (one.largest >= one.at_tension).all()
        assert (one.smallest <= one.at_tension).all()
        assert (one.largest >= 0.0).all()  # out of mesh
        assert (one.smallest <= 0.0).all()


def test_envelope_of_a_mesh_is_the_union_of_those_of_its_positions():
    cycle = result()
    whole = cycle.root_stress[0]
    parts = []
    for n in range(len(cycle.path)):
        alone = tuple(tuple(row if m == n else (None,) * len(row) for m, row in enumerate(rows)) for rows in cycle.maps)
        parts.append(arrays_of(cycle, alone))
    largest, smallest = (
        np.array([one[f"pinion_root_stress_{name}"] for one in parts]) for name in ("largest", "smallest")
    )
    assert_allclose(largest.max(axis=0), whole.largest, atol=ROUNDING)
    assert_allclose(smallest.min(axis=0), whole.smallest, atol=ROUNDING)


def test_stress_ratio_is_negative_since_neighbours_press_the_root_that_is_pulled_in_its_turn():
    cycle = result()
    assert (cycle.root_stress_ratio < 0.0).all()
    assert (cycle.root_stress_ratio > -0.5).all()
    for gear, one in enumerate(cycle.root_stress):
        for t in range(2):
            place = np.unravel_index(one.largest[t].argmax(), one.largest[t].shape)
            assert cycle.root_stress_ratio[t, gear] == one.smallest[t][place] / one.largest[t][place]


def test_one_pair_that_carries_all_gives_more_stress_than_the_same_with_another():
    """At the ends of the pitch two pairs share the load; loaded at its tip by all of it, a root has nearly twice."""
    alone, shared = result(**{"analysis.load_sharing": False}), result()
    assert alone.root_tension.shape == shared.root_tension.shape
    ends = [0, -1]
    assert (alone.root_tension[:, ends].max(axis=1) > 1.5 * shared.root_tension[:, ends].max(axis=1)).all()
    middle = alone.root_tension.shape[1] // 2
    assert_allclose(alone.root_tension[:, middle], shared.root_tension[:, middle], rtol=1e-3)


def test_symmetric_pair_has_symmetric_stress_along_its_face():
    for one in result().root_stress:
        for stress in (one.largest, one.smallest, one.at_tension):
            assert_allclose(
                stress, stress[..., ::-1], atol=(1e-4 + SINGLE) * np.abs(stress).max()
            )  # solver and mesh, precision


def test_misaligned_pair_has_its_tension_where_its_load_is():
    cycle = result(**{"mounting.misalignment_um": 20.0})
    heavy = np.sign(cycle.peak_axial[1, 2, cycle.peak_column[1, 2]])
    assert (heavy * cycle.root_tension_axial[1, 2] > 3.0).all()
    assert (cycle.root_tension[1, 2] > 1.1 * result().root_tension[1, 2]).all()


@pytest.mark.thorough
def test_other_sense_of_rotation_is_the_mirror_image():
    one, other = result(), result(**{"pair.sense": "negative"})
    for name in ("root_tension", "root_compression"):
        assert_allclose(getattr(other, name), getattr(one, name), rtol=SINGLE)
    assert_allclose(other.root_stress_ratio, one.root_stress_ratio, atol=SINGLE)  # over the largest
    assert_array_equal(other.root_tension_place[..., 0], -one.root_tension_place[..., 0])
    for gear, (mirrored, stress) in enumerate(zip(other.root_stress, one.root_stress, strict=True)):
        assert_allclose(mirrored.largest, stress.largest, rtol=0.0, atol=SINGLE * stress.largest.max())
        # tensions of two stations of the fillet differ by less than precision about the top of both
        station = np.abs(np.diff(stress.tangent_angle, axis=1)).max()
        angles = (each.root_tension_angle[..., gear] for each in (other, one))
        assert_allclose(*angles, rtol=0.0, atol=1.001 * station)


@pytest.mark.thorough
def test_other_hand_of_the_helix_is_the_mirror_image():
    """In a transverse plane: along the axes all comes from the other end."""
    one, other = result("mesh_cycle_helical"), result("mesh_cycle_helical", **{"pinion.hand": "left"})
    for name in ("root_tension", "root_compression", "root_stress_ratio"):
        assert_allclose(getattr(other, name), getattr(one, name), rtol=SHARED)
    assert_allclose(other.root_tension_axial, -one.root_tension_axial, atol=0.5)  # places 0.5 mm apart


def test_bevel_teeth_are_pulled_within_their_faces():
    cycle = result("mesh_cycle_bevel")
    assert (cycle.root_tension > 0.0).all()
    for gear, one in enumerate(cycle.root_stress):
        axial = cycle.root_tension_axial[..., gear]
        assert (axial > one.point[..., 2].min()).all()
        assert (axial < one.point[..., 2].max()).all()


def test_other_numbers_of_a_result_are_what_they_are_without_root_stress():
    one, other = result(), result(**{"analysis.root_stress": False})
    for name in QUANTITIES:
        assert_array_equal(getattr(other, name), getattr(one, name))
    assert set(one.dataset.variables) - set(other.dataset.variables) == set(ROOT_PARTS)


@pytest.mark.thorough
def test_bending_teeth_have_root_stress_too():
    """Bending shares the load out more evenly."""
    cycle = result(**{"analysis.compliance": "contact+tooth"})
    assert_allclose(cycle.root_tension[:, 2], result().root_tension[:, 2], rtol=0.1)


def test_nothing_is_known_where_nothing_is_in_contact():
    cycle = result()
    known = np.ones(cycle.transmission_error.shape, dtype=bool)
    known[0, 1], known[1] = False, False
    apart = tuple(
        tuple(row if known[t, n] else (None,) * len(row) for n, row in enumerate(rows))
        for t, rows in enumerate(cycle.maps)
    )
    found = arrays_of(cycle, apart, known)
    for name, (axes, _, _) in ROOT_QUANTITIES.items():
        if "position" in axes:
            missing = found[name] == -1 if "place" in name else np.isnan(found[name])
            assert missing[~known].all()
            assert not missing[known].any()
            assert_allclose(found[name][known], getattr(cycle, name)[known], rtol=ROUNDING)
    assert np.isnan(found["root_stress_ratio"][1]).all()
    assert np.isnan(found["wheel_root_stress_largest"][1]).all()
    assert np.isfinite(found["wheel_root_stress_largest"][0]).all()


def test_without_load_there_is_no_stress_and_no_place_of_it():
    cycle = result(**{"analysis.torques_Nm": (0.0, 100.0)})
    assert_array_equal(cycle.root_tension[0], 0.0)
    assert_array_equal(cycle.root_compression[0], 0.0)
    assert np.isnan(cycle.root_tension_angle[0]).all()
    assert np.isnan(cycle.root_compression_axial[0]).all()
    assert (cycle.root_tension_place[0] == -1).all()
    assert np.isnan(cycle.root_stress_ratio[0]).all()
    assert_array_equal(cycle.root_stress[0].largest[0], 0.0)
    assert cycle.key_figures()[0]["pinion_root_tension_MPa"] == 0.0
    assert math.isnan(cycle.key_figures()[0]["pinion_angle_at_pinion_root_tension_deg"])
    assert "root tension" in cycle.summary()


def test_file_keeps_all_of_it(tmp_path):
    cycle = result()
    cycle.save(tmp_path / "result.nc")
    found = load_result(tmp_path / "result.nc")
    assert_same(found, cycle)
    for one, other in zip(found.root_stress, cycle.root_stress, strict=True):
        assert_same(one, other)


def test_file_of_a_scene_with_root_stress_that_has_none_is_refused(tmp_path):
    cycle = result()
    cycle.save(tmp_path / "result.nc")
    import xarray

    with xarray.open_dataset(tmp_path / "result.nc", engine="scipy", decode_times=False) as file:
        left = file.load().drop_vars(["root_tension", "wheel_root_angle"])
    for mark in ("digest", "format", "format_version"):
        left.attrs.pop(mark)
    write_dataset(tmp_path / "less.nc", left)
    with pytest.raises(InputError, match=r"root_tension: missing\n.*wheel_root_angle: missing"):
        load_result(tmp_path / "less.nc")


def test_file_of_a_scene_that_does_not_know_the_key_is_read(tmp_path):
    cycle = result(**{"analysis.root_stress": False})
    older = cycle.scene.to_toml().replace("root_stress = false\n", "")

    class Older(type(cycle.scene)):
        def to_toml(self):
            return older

    values = {each.name: getattr(cycle.scene, each.name) for each in fields(cycle.scene)}
    replace(cycle, scene=Older(**values)).save(tmp_path / "result.nc")
    assert load_result(tmp_path / "result.nc").scene == cycle.scene


@pytest.mark.parametrize("name", ["root_tension", "root_stress_ratio", "pinion_root_stress_largest", "root_stress"])
def test_asking_for_what_the_scene_does_not_ask_for_says_which_key(name):
    cycle = result(**{"analysis.root_stress": False})
    with pytest.raises(NotAskedError, match=rf"^{name}: .* set analysis.root_stress = true$") as told:
        getattr(cycle, name)
    assert isinstance(told.value, InputError)
    assert not hasattr(cycle, name)
    assert name == "root_stress" or name not in dir(cycle)


def test_names_of_the_result_are_listed():
    assert {"root_tension", "wheel_root_stress_largest", "root_stress"} <= {*dir(result())}
    with pytest.raises(AttributeError, match="no attribute 'root_strain'"):
        _ = result().root_strain


@pytest.mark.quick_cases("contact")
@pytest.mark.parametrize("compliance", ["contact", "contact+tooth"])
def test_models_beyond_the_memory_are_refused_before_the_analysis_starts(compliance, monkeypatch):
    wanted, done = scene(**{"analysis.compliance": "contact", "pinion.face_width_mm": 19.5}), []
    wanted = wanted.with_changes({"analysis.compliance": compliance})
    if compliance == "contact+tooth":
        analysed(wanted.with_changes({"analysis.root_stress": False}))  # bending alone is made and kept
    monkeypatch.setattr("loaded_tca.compliance.dissection.machine_memory", lambda: 2.0**20)
    way_out = r"pinion: mesh of the gear body: .* GiB, .*; or set analysis.root_stress = false$"
    with pytest.raises(InputError, match=way_out):
        analysed(wanted, lambda *progress: done.append(progress))
    assert done == []


@pytest.mark.parametrize(
    ("compliance", "way_out"),
    [
        ("contact", "analysis.root_stress = false"),
        ("contact+tooth", 'analysis.compliance = "contact" and analysis.root_stress = false'),
    ],
)
def test_bore_that_reaches_the_teeth_is_refused_with_the_way_out(compliance, way_out):
    wanted, done = scene(**{"analysis.compliance": compliance, "wheel.bore_diameter_mm": 163.0}), []
    with pytest.raises(InputError, match=rf"wheel: bore_diameter.*; or set {way_out}$"):
        analysed(wanted, lambda *progress: done.append(progress))
    assert done == []


def test_material_that_locks_is_refused_by_the_scene():
    with pytest.raises(InputError, match=r"poisson_ratio: found 0.495; .* or set analysis.root_stress = false"):
        scene(**{"material.poisson_ratio": 0.495})
    assert scene(**{"material.poisson_ratio": 0.495, "analysis.root_stress": False})


@pytest.mark.thorough  # what makes models keeps them: compliance/test_root_stress.py
def test_model_of_a_gear_is_made_once_for_all_analyses(monkeypatch):
    first = analysed(scene())  # cached results may be older than what is kept of models
    monkeypatch.setattr("loaded_tca.compliance.root_stress.root_influence", lambda _: 1 / 0)
    again = analysed(scene(**{"analysis.torques_Nm": (200.0,), "pinion.modifications.lead_crowning_um": 6.0}))
    assert_allclose(again.root_tension[0], first.root_tension[1], rtol=0.1)


def test_variants_of_one_torque_are_those_of_several():
    alone = result(**{"analysis.torques_Nm": (200.0,)})
    assert_allclose(alone.root_tension[0], result().root_tension[1], rtol=1e-6)  # the tolerance of the solver


def test_positions_come_in_blocks_without_a_difference(monkeypatch):
    cycle = result()
    monkeypatch.setattr("loaded_tca.results.root_stress.STATES_AT_A_TIME", 2)
    for name, values in arrays_of(cycle).items():
        expected = getattr(cycle, name)
        assert_allclose(values, expected, atol=ROUNDING * max(1.0, np.nanmax(np.abs(expected))))


def test_comparison_has_root_stress_of_those_that_know_it():
    one, other = result(), result(**{"analysis.root_stress": False})
    for first, second, expected in ((one, other, [True, False]), (other, one, [False, True])):
        figures = compare_results([first, second]).figures
        assert np.isfinite(figures.value.sel(figure="wheel_root_tension_MPa")[0]).values.tolist() == expected
        assert "root tension of the wheel [MPa]" in compare_results([first, second]).summary()
    assert "root tension" not in compare_results([other, other]).summary()


def test_mesh_cycle_is_made_of_its_dataset():
    """Values that are written into the dataset are followed."""
    cycle = result()
    tension = 3.0 * cycle.root_tension
    tripled = replace(cycle, dataset=cycle.dataset.assign(root_tension=cycle.dataset.root_tension.copy(data=tension)))
    assert isinstance(tripled, MeshCycle)
    assert tripled.key_figures()[1]["wheel_root_tension_MPa"] == tension[1, :, 1].max()


def test_every_tooth_of_a_gear_of_few_teeth_is_looked_at_once(monkeypatch):
    """Three loaded pairs and two neighbours on either side make seven teeth."""
    cycle = result()
    loaded = next(one for one in cycle.maps[1][2] if one is not None)
    asked, stresses = [], RootStress.stresses
    monkeypatch.setattr(RootStress, "stresses", lambda self, *given: asked.append(given[0]) or stresses(self, *given))
    for teeth, expected in ((34, 7), (5, 5)):
        asked.clear()
        pair = replace(cycle.scene.pair(), teeth=(teeth, teeth))
        root_stress_arrays(pair, models(), [-1, 0, 1], np.ones((1, 1), dtype=bool), (((loaded,) * 3,),))
        assert len({tooth % teeth for tooth in asked}) == expected
        assert len(asked) == 2 * expected  # both gears
