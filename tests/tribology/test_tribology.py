"""What holds for loss, temperatures and films of any result: work, invariances, what each number needs."""

import inspect
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import AccuracyWarning, InputError, NotAskedError
from loaded_tca.material import Material
from loaded_tca.reference import iso6336_22
from loaded_tca.reference.friction import xu_kahraman
from loaded_tca.tribology import Lubricant
from loaded_tca.tribology.evaluate import Evaluation
from loaded_tca.tribology.quantities import COLUMNS, EXTREMES, PLACES, QUANTITIES, over_speed
from tests.refusals import refused_calls
from tests.samples.tribology import FAMILIES, OIL, ROUGHNESS, known, shared

ROUNDING = 1e-12  # sums over some thousand cells
MIRROR = 2e-5  # two solutions of one problem, each to the tolerance of its solver and grids


@pytest.fixture(params=FAMILIES)
def result(request):
    return shared(request.param)


@pytest.mark.parametrize("friction", ["local", "Xu-Kahraman", 0.06])
def test_torques_of_friction_do_the_friction_power(result, friction):
    found = known(result, friction=friction)
    omega = 2.0 * math.pi * 1500.0 / 60.0
    torques = np.nansum(found.friction_torque, axis=2)
    work = -omega * (torques[..., 0] + result.gear_pair.ratio * torques[..., 1])
    assert_allclose(1e-3 * work, found.friction_power, rtol=0.0, atol=ROUNDING * found.friction_power.max())


def test_specific_sliding_of_both_gears_belongs_together(result):
    own = known(result).specific_sliding
    product = (1.0 - own[..., 0]) * (1.0 - own[..., 1])
    assert_allclose(product[np.isfinite(product)], 1.0, rtol=ROUNDING)
    assert np.isfinite(product).any()


def test_loss_factor_is_the_mean_loss_of_a_constant_friction(result):
    found = known(result, friction=0.05)
    assert_allclose(1.0 - found.efficiency, 0.05 * found.loss_factor, rtol=1e-9)  # the difference of two near 1
    assert_allclose(found.mean_friction, 0.05, rtol=ROUNDING)
    power = 1e-3 * 2.0 * math.pi * 1500.0 / 60.0 * result.torque
    assert_allclose(found.mean_friction_power, 0.05 * found.loss_factor * power, rtol=ROUNDING)


def test_loss_and_sliding_ask_for_nothing(result):
    found = result.tribology()
    assert (found.loss_factor > 0.0).all()
    assert np.isfinite(found.specific_sliding).any()
    assert {"loss_factor", "specific_sliding"} == set(found.dataset.data_vars)


def test_velocities_scale_with_the_speed_and_flash_with_its_root(result):
    """Sliding heats in proportion, and moving surfaces carry away heat with the root of their velocity."""
    slow, fast = (known(result, pinion_speed_rpm=speed, friction=0.05) for speed in (500.0, 2000.0))
    assert_allclose(fast.sliding_velocity, 4.0 * slow.sliding_velocity, rtol=ROUNDING)
    assert_allclose(fast.flash_temperature, 2.0 * slow.flash_temperature, rtol=ROUNDING)
    assert_allclose(fast.loss_factor, slow.loss_factor, rtol=ROUNDING)


def test_speeds_in_a_list_are_a_dimension(result):
    several, one = known(result, pinion_speed_rpm=[500.0, 1500.0]), known(result)
    assert several.dataset.sizes["speed"] == 2
    for name, quantity in QUANTITIES.items():
        if name in one.dataset:
            assert several.dataset[name].dims == (("speed",) if over_speed(quantity) else ()) + quantity.dims
            of_second = several.dataset[name].isel(speed=1) if over_speed(quantity) else several.dataset[name]
            assert_allclose(of_second, one.dataset[name], rtol=ROUNDING, err_msg=name)


def test_factors_raise_pressure_but_not_the_loss(result):
    """K_A and K_v: films and temperatures see the dynamic load, the friction power of a given friction does not."""
    plain, loaded = (
        known(result, friction=0.05),
        known(result, friction=0.05, application_factor=1.5, dynamic_factor=1.2),
    )
    assert_allclose(loaded.efficiency, plain.efficiency, rtol=ROUNDING)
    assert_allclose(loaded.flash_temperature, 1.8**0.75 * plain.flash_temperature, rtol=ROUNDING)


def test_slices_carry_the_forces_of_the_contacts(result):
    table = known(result).slices(0)
    loaded = result.normal_force[0] > 0.0
    assert len(table) > loaded.sum()
    of_pairs = table.groupby(["position", "pair"])["friction_power"].sum()
    assert_allclose(of_pairs.groupby("position").sum(), known(result).friction_power[0], rtol=ROUNDING)


def test_extremes_are_those_of_the_slices_and_lie_at_their_places(result):
    found = known(result)
    table = found.slices(0)
    for name, column in EXTREMES.items():
        least = name.startswith("least")
        row = table.loc[table[column].idxmin() if least else table[column].idxmax()]
        assert getattr(found, name)[0] == row[column]
        for end, own in (
            ("position", "position"),
            ("pair", "pair"),
            ("radius", "pinion_radius"),
            ("axial", "pinion_axial"),
        ):
            assert getattr(found, f"{name}_{end}")[0] == row[own], (name, end)
        assert set(PLACES) == {"position", "pair", "radius", "axial"}


def test_over_flank_holds_the_extremes_and_the_whole_friction_power(result):
    found = known(result)
    for gear in ("pinion", "wheel"):
        assert_allclose(found.over_flank("film_thickness", 0, gear).min(), found.least_film_thickness[0])
        assert_allclose(found.over_flank("flash_temperature", 0, gear).max(), found.largest_flash_temperature[0])
        assert_allclose(found.over_flank("friction_power", 0, gear).sum(), found.mean_friction_power[0], rtol=1e-9)


def test_heat_thins_the_film(result):
    found = known(result)
    held = np.isfinite(found.film_thickness)
    assert (found.isothermal_film_thickness >= found.film_thickness)[held].all()
    assert_allclose(found.film_ratio, found.film_thickness / 0.55, rtol=ROUNDING)


def test_a_file_keeps_the_numbers(result, tmp_path):
    found = known(result, pinion_speed_rpm=[500.0, 1500.0])
    found.save(tmp_path / "tribology.nc")
    with xarray.open_dataset(tmp_path / "tribology.nc", engine="scipy") as file:
        assert_allclose(file["least_film_ratio"], found.least_film_ratio)
        assert file["least_film_ratio"].attrs["units"] == "1"


def test_results_from_files_have_the_same_tribology(result, tmp_path):
    result.save(tmp_path / "result.nc")
    again = type(result).load(tmp_path / "result.nc")
    for name in ("loss_factor", "least_film_ratio", "largest_contact_temperature"):
        assert_allclose(getattr(known(again), name), getattr(known(result), name), rtol=ROUNDING)


def test_summary_tells_what_is_known_and_what_is_missing():
    text = known(shared("mesh_cycle_spur")).summary()
    assert "loss factor H_VL" in text
    assert "safety against scuffing S_B: needs scuffing_load_stage" in text
    assert "needs pinion_speed_rpm" in shared("mesh_cycle_spur").tribology().summary()


def test_summary_says_where_the_hottest_and_the_thinnest_film_lie():
    found = known(shared("mesh_cycle_bevel", analysis__torques_Nm=(0.0, 1.6)))
    lines = found.summary().splitlines()
    for label, column, worst in (
        ("largest contact temperature [°C]", "contact_temperature", "idxmax"),
        ("least film thickness [um]", "film_thickness", "idxmin"),
    ):
        table = found.slices(1)
        row = table.loc[getattr(table[column], worst)()]
        at = next(n for n, line in enumerate(lines) if line.startswith(label))
        angle, place = (
            line.replace("[deg]", "]").replace("[mm]", "]").split("]")[1] for line in lines[at + 1 : at + 3]
        )
        degrees = math.degrees(found.result.pinion_angle[int(row["position"])])
        assert angle.split() == ["-", f"{degrees:.4g}"]  # without torque there is no place
        diameter, axial = 2.0 * row["pinion_radius"], row["pinion_axial"]
        assert place.split() == ["-", "|", "-", f"{diameter:.4g}", "|", f"{axial:.4g}"]
    assert "pinion angle" not in shared("mesh_cycle_spur").tribology().summary()


def test_every_number_says_what_it_lacks():
    bare = shared("mesh_cycle_bevel").tribology()
    for name, quantity in QUANTITIES.items():
        if quantity.needs <= {"load_sharing", "positions"}:
            continue
        with pytest.raises(NotAskedError, match=f"{name}: needs "):
            getattr(bare, name)
    with pytest.raises(NotAskedError, match="largest_contact_temperature_radius: needs"):
        _ = bare.largest_contact_temperature_radius
    with pytest.raises(AttributeError, match="nothing"):
        _ = bare.nothing


NEEDED = [
    ({"pinion_speed_rpm": None}, "film_ratio", "pinion_speed_rpm"),
    ({"lubricant": None}, "film_ratio", "lubricant"),
    ({"roughness_um": (0.6, None)}, "film_ratio", "roughness_um"),
    ({}, "scuffing_safety", "scuffing_load_stage"),
    ({}, "micropitting_safety", "permissible_film_ratio"),
]


@pytest.mark.parametrize(("given", "name", "words"), NEEDED)
def test_a_missing_input_is_named(given, name, words):
    with pytest.raises(NotAskedError, match=words):
        getattr(known(shared("mesh_cycle_spur"), **given), name)


@pytest.mark.parametrize("missing", ["viscosity_100_mm2_s", "oil_temperature_C"])
def test_an_oil_for_ratings_alone_is_none_for_tribology(missing):
    """Z_L of ISO 6336-2 takes the viscosity at 40 C, viscosities at other temperatures take two."""
    result = shared("mesh_cycle_spur")
    oil = {"viscosity_40_mm2_s": 220.0, "viscosity_100_mm2_s": 19.0, "oil_temperature_C": 80.0}
    whole = replace(result, scene=result.scene.with_changes({"lubricant": oil}))
    assert np.nanmin(known(whole, lubricant=None).film_ratio) > 0.0
    del oil[missing]
    part = replace(result, scene=result.scene.with_changes({"lubricant": oil}))
    with pytest.raises(NotAskedError, match=r"needs lubricant, or \[lubricant\] with viscosity_100_mm2_s and oil_temp"):
        _ = known(part, lubricant=None).film_ratio


def test_bevel_gears_need_a_friction_and_a_bulk_temperature():
    result = shared("mesh_cycle_bevel")
    with pytest.raises(NotAskedError, match="needs friction"):
        _ = known(result, friction=None).efficiency
    with pytest.raises(NotAskedError, match="needs bulk_temperature_C"):
        _ = known(result, bulk_temperature_C=None).contact_temperature
    with pytest.raises(InputError, match="is for cylindrical gears only"):
        known(result, friction="ISO/TS 6336-22")


@pytest.mark.thorough
def test_one_tooth_pair_and_one_position_have_no_mean():
    for few in (1, 2, 4):
        with pytest.raises(NotAskedError, match=r"analysis\.positions"):
            _ = known(shared("mesh_cycle_spur", positions=few)).loss_factor
    alone = shared("mesh_cycle_spur", analysis__load_sharing=False)
    with pytest.raises(NotAskedError, match=r"analysis\.load_sharing"):
        _ = alone.tribology().loss_factor
    with pytest.raises(NotAskedError, match=r"friction_power: needs the load sharing of tooth pairs"):
        _ = known(alone, bulk_temperature_C=90.0, friction=0.05).friction_power
    with pytest.raises(NotAskedError, match=r"friction_power: needs the load sharing of tooth pairs"):
        known(alone, bulk_temperature_C=90.0, friction=0.05).over_flank("friction_power")
    assert np.isfinite(known(alone, bulk_temperature_C=90.0, friction=0.05).contact_temperature).any()


def test_without_torque_numbers_are_not_known():
    found = known(shared("mesh_cycle_spur", torque=0.0))
    assert np.isnan(found.loss_factor).all()
    assert np.isnan(found.least_film_ratio).all()
    assert np.isnan(found.film_ratio).all()
    assert np.isnan(found.dataset.specific_sliding).all()


def test_without_friction_nothing_is_lost_and_nothing_heats():
    found = known(shared("mesh_cycle_spur"), friction=0.0)
    assert (found.efficiency, found.mean_friction, found.mean_friction_power) == (1.0, 0.0, 0.0)
    assert found.bulk_temperature == OIL.oil_temperature
    assert_allclose(found.film_thickness, found.isothermal_film_thickness, rtol=ROUNDING)


def test_the_hottest_films_are_thin_and_known():
    """The density of the oil falls by 0.7 kg/m3 a kelvin; beyond 1290 C nothing would be left of it."""
    found = known(shared("mesh_cycle_spur"), pinion_speed_rpm=20000.0, friction=1.0, application_factor=20.0)
    assert found.largest_contact_temperature > 1500.0
    films = found.slices()["film_thickness"].to_numpy()
    assert (films >= 0.0).all()


def test_a_scuffing_temperature_names_what_it_lacks():
    with pytest.raises(NotAskedError, match="scuffing_temperature: needs lubricant"):
        _ = shared("mesh_cycle_spur").tribology(1500.0).scuffing_temperature


def test_extremes_on_the_arc_of_a_rounded_tip_are_marked_and_warned_of():
    """A film on an arc of 0.8 mm is that of the arc, several times thinner than on the flank beside it."""
    flanks = {"pinion__modifications": None, "wheel__modifications": None, "pinion__tip_rounding_mm": 0.8}
    rounded = shared("mesh_cycle_spur", positions=13, torque=50.0, **flanks)
    table = known(rounded).slices()
    on_arc = table.relative_radius < 1.0
    assert on_arc.any()
    assert table.on_edge[on_arc].all()
    assert not table.on_edge[table.pinion_radius < rounded.scene.mesh().pinion.tip_radius - 1.5].all()
    assert known(rounded).extreme_on_edge("least_film_thickness")
    with pytest.warns(AccuracyWarning) as caught:
        rounded.tribology(1500.0, OIL, ROUGHNESS)
    assert any("the least film thickness lies at an edge of a flank" in str(one.message) for one in caught)


def test_a_loss_factor_of_few_positions_is_doubted():
    flanks = {"pinion__modifications": None, "wheel__modifications": None}
    with pytest.warns(AccuracyWarning) as caught:
        shared("mesh_cycle_spur", positions=5, **flanks).tribology()
    assert any("from every second position alone the loss factor differs by" in str(one.message) for one in caught)


@pytest.mark.thorough
def test_loss_factor_of_half_the_positions_is_that_of_an_analysis_of_as_many():
    few = known(shared("mesh_cycle_spur", positions=6))
    assert np.isnan(few.loss_factor_of_half).all()
    halved = known(shared("mesh_cycle_spur", positions=17)).loss_factor_of_half
    assert_allclose(halved, known(shared("mesh_cycle_spur", positions=9)).loss_factor, rtol=1e-3)


SPUR = "mesh_cycle_spur"


def call(**given):
    return lambda: known(shared(SPUR), **given)


test_bad_input_is_refused = refused_calls(
    *(
        (call(pinion_speed_rpm=bad), "pinion_speed_rpm: .*above 0")
        for bad in (0.0, -1.0, math.nan, "fast", [], [1.0, 0.0], "1500", True, 1e300)
    ),
    *((call(roughness_um=bad), "roughness_um: ") for bad in ((0.0, 1.0), (1.0,), (11.0, 1.0), 0.5, (math.nan, 1.0))),
    (call(application_factor=0.9), "application_factor: 0.9; allowed a number from 1"),
    (call(dynamic_factor=math.nan), "dynamic_factor: nan"),
    *((call(friction=bad), "friction: .*allowed") for bad in ("smooth", -0.1, 1.5, math.nan, [0.05, 0.06])),
    (call(bulk_temperature_C=900.0), "bulk_temperature_C: 900"),
    *((call(scuffing_load_stage=bad), "scuffing_load_stage: ") for bad in (0, 15, math.inf)),
    (call(permissible_film_ratio=0.0), "permissible_film_ratio: 0"),
    (call(lubricant="oil"), "lubricant: 'oil'"),
    *((call(supply=bad), "supply: .*; allowed 'dip' or 'spray' or 'submerged'") for bad in ("rain", 1.2, ["dip"])),
    (lambda: known(shared(SPUR)).slices(3), "torque: 3 is no index"),
    (lambda: known(shared(SPUR)).slices(speed=None), "speed: .* is no index"),
    (lambda: known(shared(SPUR)).over_flank("beauty"), "name: 'beauty'"),
    (lambda: known(shared(SPUR)).over_flank(["pressure"]), "name: "),
    (lambda: known(shared(SPUR)).over_flank("pressure", 0, "ring"), "gear: 'ring'"),
    *(
        (lambda cells=cells: known(shared(SPUR)).over_flank("pressure", cells=cells), "cells: ")
        for cells in ((0, 3), 5, (3,), (2.5, 3), "ab")
    ),
)


def test_every_wrong_argument_is_told_at_once():
    with pytest.raises(InputError) as caught:
        known(shared(SPUR), pinion_speed_rpm=-1.0, application_factor=0.0, friction="x")
    assert len(caught.value.problems) == 3


def test_a_scene_gives_the_defaults():
    changes = {
        "operation": {"pinion_speed_rpm": 1500.0, "application_factor": 1.25},
        "lubricant": {
            "viscosity_40_mm2_s": 220.0,
            "viscosity_100_mm2_s": 19.0,
            "oil_temperature_C": 80.0,
            "friction": "mean",
            "scuffing_load_stage": 12,
            "permissible_film_ratio": 0.2,
        },
        "pinion.roughness_Ra_um": 0.6,
        "wheel.roughness_Ra_um": 0.5,
    }
    result = shared(SPUR)
    scene = replace(result, scene=result.scene.with_changes(changes))
    own = known(scene, pinion_speed_rpm=None, lubricant=None, roughness_um=None)
    told = known(result, application_factor=1.25, scuffing_load_stage=12, permissible_film_ratio=0.2)
    for name in QUANTITIES:
        assert_allclose(getattr(own, name), getattr(told, name), rtol=ROUNDING, err_msg=name)
    assert_allclose(known(scene, friction=0.1).mean_friction, 0.1)


@pytest.mark.parametrize(("supply", "factor"), [("dip", 1.0), ("spray", 1.2), ("submerged", 0.2)])
def test_supply_of_the_oil_scales_the_rise_of_the_bulk_temperature_alone(supply, factor):
    """X_S of ISO/TS 6336-20; the loss, and the flash on top of the bulk, are those of any supply."""
    plain, found = known(shared(SPUR)), known(shared(SPUR), supply=supply)
    oil = OIL.oil_temperature
    assert_allclose(found.bulk_temperature - oil, factor * (plain.bulk_temperature - oil), rtol=ROUNDING)
    for name in ("mean_friction_power", "flash_temperature"):
        assert_array_equal(getattr(found, name), getattr(plain, name), err_msg=name)
    hotter = found.bulk_temperature - plain.bulk_temperature
    assert_allclose(found.largest_contact_temperature - plain.largest_contact_temperature, hotter, atol=1e-9)
    assert np.sign(plain.least_film_thickness - found.least_film_thickness) == np.sign(hotter)


def test_supply_of_the_call_goes_before_that_of_the_scene():
    spray = {"viscosity_40_mm2_s": 220.0, "viscosity_100_mm2_s": 19.0, "oil_temperature_C": 80.0, "supply": "spray"}
    result = shared(SPUR)
    of_scene = replace(result, scene=result.scene.with_changes({"lubricant": spray}))
    spray, dip = (known(result, supply=supply).bulk_temperature for supply in ("spray", "dip"))
    assert_allclose(known(of_scene).bulk_temperature, spray, rtol=ROUNDING)
    assert_allclose(known(of_scene, supply="dip").bulk_temperature, dip, rtol=ROUNDING)


def test_supply_changes_nothing_where_the_bulk_temperature_is_given():
    given = {"bulk_temperature_C": 95.0}
    one, other = (known(shared(SPUR), supply=supply, **given) for supply in ("dip", "submerged"))
    assert_array_equal(one.contact_temperature, other.contact_temperature)


def test_safeties_follow_from_the_extremes():
    found = known(shared(SPUR), scuffing_load_stage=12, permissible_film_ratio=0.2)
    scuffing = 80.0 + (0.85 + 1.4) * float(OIL.viscosity(80.0)) ** -0.05 * 12**2
    assert_allclose(found.scuffing_safety, (scuffing - 80.0) / (found.largest_contact_temperature - 80.0))
    assert_allclose(found.micropitting_safety, found.least_film_ratio / 0.2)


@pytest.mark.parametrize("name", [SPUR, "mesh_cycle_helical"])
def test_mean_friction_is_that_of_the_standard(name):
    """With the radius of the normal section: that of the transverse one over cos(beta_b)."""
    result = shared(name)
    mesh, factors = result.scene.mesh(), result.face_load_factor[0] * max(1.0, result.transverse_load_factor[0])
    path = mesh.path_of_contact
    omega = 2.0 * math.pi * 1500.0 / 60.0
    load = factors * result.torque[0] / (mesh.pinion.base_radius * result.face_width)
    radius = 1.0 / (1.0 / path.C + 1.0 / (path.T2 - path.C)) / math.cos(mesh.pinion.base_helix_angle)
    velocity, viscosity = 2e-3 * omega * path.C, float(OIL.viscosity(80.0))
    friction = iso6336_22.mean_friction(load, velocity, radius, viscosity, 0.55, mesh.total_contact_ratio)
    assert_allclose(known(result).mean_friction, friction, rtol=1e-9)


def test_roughness_of_xu_and_kahraman_is_the_root_mean_square_of_both_flanks():
    """Of heights with a normal distribution, whose mean is sqrt(2/pi) of it: Rq^2 = (Ra1^2 + Ra2^2) pi/2."""
    table = known(shared(SPUR), friction="Xu-Kahraman").slices(0)
    entraining = 0.5 * table["sum_velocity"]
    rough = math.sqrt((ROUGHNESS[0] ** 2 + ROUGHNESS[1] ** 2) * math.pi / 2.0)
    about = float(OIL.viscosity(80.0)), table["relative_radius"], rough
    friction = xu_kahraman(table["pressure"], table["sliding_velocity"] / entraining, entraining, *about)
    assert_allclose(table["friction"], friction, rtol=1e-9)


def test_flash_temperature_is_bloks_with_each_gears_own_coefficient():
    """1.11 mu w v_g/(sqrt(2 b) (B_1 sqrt(v_1) + B_2 sqrt(v_2))); the standard is 1.6 to 1.8 % above, digits of 1.11."""
    tribology, steel, other = known(shared(SPUR), friction=0.05), Material(), Material(conductivity=200.0)
    pair = SimpleNamespace(
        contact_modulus=shared(SPUR).gear_pair.contact_modulus,
        pinion=SimpleNamespace(material=steel),
        wheel=SimpleNamespace(material=other),
    )
    flash = Evaluation(SimpleNamespace(gear_pair=pair), tribology.sweep, tribology.conditions).flash_temperature[0]
    table = tribology.slices(0)
    first, second = (
        material.thermal_contact_coefficient * np.sqrt(table[f"{gear}_rolling_velocity"])
        for gear, material in (("pinion", steel), ("wheel", other))
    )
    source = 0.05 * 1e3 * table["line_load"] * table["sliding_velocity"]
    blok = 1.11 * source / (np.sqrt(2e-3 * table["half_width"]) * (first + second))
    ratio = (flash / blok)[np.isfinite(flash) & (blok > 0.0)]
    assert 1.012 < ratio.min() <= ratio.max() < 1.022


def test_wear_of_both_gears_is_as_their_ways():
    """Over the same sliding way each point of a gear is worn the more the slower it rolls: as v_1/v_2."""
    table = known(shared(SPUR)).slices(0)
    ratio = table["pinion_rolling_velocity"] / table["wheel_rolling_velocity"]
    assert_allclose(table["wheel_wear"], ratio * table["pinion_wear"], rtol=1e-9)


WARNINGS = [
    ({"bulk_temperature_C": 60.0}, "the bulk temperature, 60 °C, is below the temperature of the oil, 80 °C"),
    ({"pinion_speed_rpm": 10.0}, "the pitch line velocity, 0.0534 m/s, is outside 1 to 60 m/s"),
]


@pytest.mark.parametrize(("given", "words"), WARNINGS)
def test_inputs_beyond_the_standards_are_warned_of(given, words):
    usual = {"pinion_speed_rpm": 1500.0, "lubricant": OIL, "roughness_um": ROUGHNESS}
    with pytest.warns(AccuracyWarning) as caught:
        shared(SPUR).tribology(**{**usual, **given})
    assert any(words in str(one.message) for one in caught)


def test_extremes_at_edges_and_between_positions_are_warned_of():
    with pytest.warns(AccuracyWarning) as caught:
        shared("fzg_c14").tribology(1500.0, OIL, ROUGHNESS)
    told = " ".join(str(one.message) for one in caught)
    assert "from every second position alone the largest flash temperature differs by" in told
    with pytest.warns(AccuracyWarning) as caught:
        shared("mesh_cycle_helical").tribology(1500.0, OIL, ROUGHNESS)
    assert any("the least film thickness lies at an edge of a flank" in str(one.message) for one in caught)


def test_a_cut_pressure_is_warned_of():
    capped = shared(SPUR, material__max_pressure_MPa=400.0)
    with pytest.warns(AccuracyWarning) as caught:
        capped.tribology(1500.0, OIL, ROUGHNESS)
    assert any("cut at the cap" in str(one.message) for one in caught)
    assert known(capped).slices(0)["pressure"].max() == 400.0


def test_columns_of_the_table_are_those_declared():
    assert list(known(shared(SPUR)).slices(0)) == list(COLUMNS)


def test_an_oil_without_a_formula_of_friction_is_told():
    with pytest.raises(InputError, match="base: 'water'"):
        Lubricant(viscosity_40=220.0, viscosity_100=19.0, oil_temperature=80.0, base="water")


def test_what_is_of_the_call_is_not_of_the_oil():
    """Scenes have it in [lubricant], so that it is looked for here."""
    with pytest.raises(InputError) as caught:
        Lubricant(viscosity_40=220.0, viscosity_100=19.0, oil_temperature=80.0, supply="spray", friction="local")
    assert [problem.split(";")[0] for problem in caught.value.problems] == [
        f"{name}: belongs to the pair, not to the oil" for name in ("supply", "friction")
    ]
    assert "tribology(supply=...)" in caught.value.problems[0]
    assert "supply" not in inspect.signature(Lubricant).parameters


@pytest.mark.thorough
def test_report_has_a_section_of_scenes_that_say_how_the_pair_runs(tmp_path, monkeypatch):
    from loaded_tca.reports import write_html_report

    monkeypatch.setattr("loaded_tca.reports.result_page.result_figures", lambda *_, **__: {})  # no matter here
    plain = write_html_report(shared(SPUR), tmp_path / "plain.html").read_text(encoding="utf-8")
    changes = {
        "operation": {"pinion_speed_rpm": 1500.0},
        "lubricant": {"viscosity_40_mm2_s": 220.0, "viscosity_100_mm2_s": 19.0, "oil_temperature_C": 80.0},
        "pinion.roughness_Ra_um": 0.6,
        "wheel.roughness_Ra_um": 0.5,
    }
    scene = replace(shared(SPUR), scene=shared(SPUR).scene.with_changes(changes))
    page = write_html_report(scene, tmp_path / "oil.html").read_text(encoding="utf-8")
    assert "<h2>Lubrication</h2>" not in plain
    assert "<h2>Lubrication</h2>" in page
    assert f"{known(scene).loss_factor[0]:.4g}" in page
    assert "needs scuffing_load_stage" in page
    assert page.count("<svg") > plain.count("<svg")
