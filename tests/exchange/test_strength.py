"""Strength of gears and load spectra of REXS models."""

import pytest

from loaded_tca.errors import InputError
from loaded_tca.exchange import import_stage, load_spectrum, read_rexs
from loaded_tca.exchange.model import Attribute
from loaded_tca.exchange.strength import KIND_OF_TYPE
from loaded_tca.reference.iso6336_5 import KINDS
from loaded_tca.scene import parse_scene
from tests.samples.rexs import EXAMPLE, as_json, changed, part

MM2, MUM = "N / mm^2", "mum"
ROUGH = {
    f"{gear}.arithmetic_average_roughness_{where}": (value, MUM)
    for gear in ("21", "22")
    for where, value in (("flank", 0.6), ("root", 3.0))
}
LIMITS = {"70.endurance_limit_flank": (1500.0, MM2), "70.endurance_limit_root": (430.0, MM2)}
HARD = {"70.surface_hardness_vickers": (720.0, "HV"), "70.yield_strength": (850.0, MM2)}


def strengths(attributes):
    stage = import_stage(changed(attributes=attributes), "10")
    return stage, stage.scene.pinion.strength, stage.scene.wheel.strength


def test_steel_by_its_name_has_limits_of_the_file():
    stage, pinion, wheel = strengths(ROUGH | LIMITS | HARD)
    assert pinion == wheel
    assert (pinion.material, pinion.limits, pinion.hardness_HV) == ("16MnCr5", (1500.0, 430.0), 720.0)
    assert (pinion.flank_Rz_um, pinion.root_Rz_um) == pytest.approx((3.6, 18.0), rel=1e-12)  # 6 Ra
    assert pinion.proof_stress_MPa is None  # of case-hardened teeth it does not count
    assert any("Rz is 6 times the average roughness" in sentence for sentence in stage.read_as)
    assert "[pinion.strength]" in stage.to_toml()


def test_limits_of_gears_are_those_of_early_versions():
    of_gears = {f"{gear}.{name.partition('.')[2]}": value for gear in ("21", "22") for name, value in LIMITS.items()}
    _, pinion, _ = strengths(ROUGH | of_gears)
    assert pinion.limits == (1500.0, 430.0)


def test_stress_numbers_of_the_standard_go_before_endurance_limits():
    numbers = {
        "70.allowable_stress_number_contact_iso_6336_2016": (1400.0, MM2),
        "70.nominal_stress_number_tooth_root_iso_6336_2016": (400.0, MM2),
    }
    assert strengths(ROUGH | LIMITS | numbers)[1].limits == (1400.0, 400.0)


def test_kind_of_material_goes_before_a_name():
    soft = {
        "70.heat_treated_material_type_iso_6336_2006": ("through_hardened_wrought_steel", ""),
        "70.surface_hardness_vickers": (300.0, "HV"),
        "70.yield_strength": (700.0, MM2),
    }
    stage, pinion, _ = strengths(ROUGH | soft)
    assert (pinion.kind, pinion.hardness_HV, pinion.proof_stress_MPa) == ("V alloy", 300.0, 700.0)
    assert any("taken as alloyed" in sentence for sentence in stage.read_as)


def test_kinds_are_those_of_the_standard():
    assert {*KIND_OF_TYPE.values()} < {*KINDS}


INCOMPLETE = [
    (LIMITS, "a scene needs flank_Rz_um and root_Rz_um, too"),
    (ROUGH | {"70.surface_hardness_vickers": (100.0, "HV")}, "its strength: hardness_HV: found 100 HV"),
]


@pytest.mark.parametrize(("attributes", "words"), INCOMPLETE)
def test_incomplete_strength_is_not_taken(attributes, words):
    stage, pinion, _ = strengths(attributes)
    assert pinion is None
    assert any(words in sentence for sentence in stage.not_taken)


def test_name_alone_is_no_strength():
    stage, pinion, wheel = strengths(ROUGH)
    assert pinion is wheel is None
    assert not any("its strength" in sentence for sentence in stage.not_taken)


def spectrum(tmp_path, times):
    """Model of a file whose load cases have times of the gear unit."""
    model = changed(more=[part(99, "gear_unit")])
    cases = []
    for case, time in zip(model.load_cases, times, strict=True):
        own = {name: Attribute(*value) for name, value in time.items()}
        cases.append(type(case)(case.id, case.spectrum, {**case.components, "99": own}))
    model = type(model)(model.version, model.components, model.relations, tuple(cases), model.source)
    path = tmp_path / "model.rexsj"
    path.write_bytes(as_json(model))
    return read_rexs(path)


def test_load_cases_have_torque_speed_and_time_of_the_pinion(tmp_path):
    times = {"load_duration_fraction": (20.0, "%")}, {"load_duration_fraction": (0.8, "none")}
    first, second = load_spectrum(spectrum(tmp_path, times), "10")
    assert (first.torque, first.speed, first.share, first.reversed) == (150.0, 1500.0, 0.2, False)
    assert (second.torque, second.speed, second.share, second.reversed) == (60.0, 3000.0, 0.8, True)
    hours = {"operating_time": (90.0, "min")}, {"operating_time": (2.0, "h"), "load_duration": (5.0, "h")}
    assert [one.hours for one in load_spectrum(spectrum(tmp_path, hours), "10")] == [1.5, 2.0]


def test_torques_of_bins_are_those_of_import():
    for one in load_spectrum(read_rexs(EXAMPLE), "11"):
        scene = import_stage(read_rexs(EXAMPLE), "11", load_case=one.case).scene
        assert (scene.load.pinion_torque_Nm, scene.operation.pinion_speed_rpm) == (one.torque, one.speed)


def test_negative_time_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"load_duration: found -1; allowed from 0 on"):
        load_spectrum(spectrum(tmp_path, ({"load_duration": (-1.0, "h")}, {})), "10")


def test_import_has_load_cases_with_times_as_a_spectrum(tmp_path):
    hours = {"operating_time": (90.0, "min")}, {"operating_time": (2.0, "h")}
    imported = import_stage(spectrum(tmp_path, hours), "10")
    first, second = imported.scene.load.case
    assert (first.pinion_torque_Nm, first.pinion_speed_rpm, first.hours, first.reversed) == (150.0, 1500.0, 1.5, False)
    assert (second.pinion_torque_Nm, second.pinion_speed_rpm, second.hours, second.reversed) == (
        60.0,
        3000.0,
        2.0,
        True,
    )
    assert parse_scene(imported.to_toml()).load == imported.scene.load
    assert any(one.startswith("load spectrum of 2 bins: load cases 1:1, 1:2") for one in imported.read_as)
    one = import_stage(spectrum(tmp_path, hours), "10", load_case="2").scene.load
    assert (one.case, one.pinion_torque_Nm) == (None, 60.0)


def test_share_that_no_load_case_has_is_idle(tmp_path):
    shares = {"load_duration_fraction": (20.0, "%")}, {"load_duration_fraction": (0.5, "none")}
    *_, idle = import_stage(spectrum(tmp_path, shares), "10").scene.load.case
    assert (idle.pinion_torque_Nm, idle.share) == (0.0, pytest.approx(0.3))


def test_what_all_bins_of_a_spectrum_share_is_told(tmp_path):
    """The wheel's shaft carries the second stage, whose forces are those of 150 N m in each bin; bin 2 is reversed."""
    hours = {"operating_time": (90.0, "min")}, {"operating_time": (2.0, "h")}
    read_as = import_stage(spectrum(tmp_path, hours), "10").read_as
    alike = "its loads are the same in every bin of the spectrum, those under the torques of the components themselves"
    assert [one for one in read_as if alike in one] == [f"shaft 4: {alike}, 150 N m on the pinion"]
    reversed_bins = "reversed bins load the other flanks; the scene gives these the modifications of the loaded ones"
    assert reversed_bins in read_as
    alone = import_stage(spectrum(tmp_path, hours), "10", load_case="2").read_as
    assert not any(alike in one or one == reversed_bins for one in alone)


def test_times_of_some_load_cases_make_no_spectrum(tmp_path):
    imported = import_stage(spectrum(tmp_path, ({"operating_time": (2.0, "h")}, {})), "10")
    assert imported.scene.load.case is None
