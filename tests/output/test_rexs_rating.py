"""Ratings written back into REXS models of version 1.7, under its names for what ISO 6336 gives."""

import math

import pytest

from loaded_tca.output.rexs import rexs_results
from tests.samples.rating import solved
from tests.samples.rexs import changed

TEETH = {"21.number_of_teeth": (34.0, ""), "22.number_of_teeth": (57.0, "")}


def results(version, **changes):
    model = changed(attributes=TEETH, version=version)
    return rexs_results(solved(**changes), model, "10", torque=0)


def test_ratings_stand_in_stage_and_gears():
    rated, written = solved().rating(), results("1.7")
    assert written["10"]["face_load_factor_contact_stress_iso_6336_2019"].value == rated.K_Hbeta[0]
    assert written["10"]["resonance_ratio_iso_6336_2019"].value == rated.resonance_ratio[0]
    assert written["10"]["reduced_gear_pair_mass_iso_6336_2019"].unit == "kg / mm"
    for gear, component in enumerate(("31", "32")):
        assert written[component]["safety_factor_pitting_iso_6336_2019"].value == rated.flank_safety[0, gear]
        assert written[component]["tooth_root_stress_iso_6336_2006"].value == rated.sigma_F[0, gear]
        assert written[component]["tooth_root_stress_iso_6336_2006"].unit == "N / mm^2"
    assert all(math.isfinite(one.value) for one in written["32"].values())


@pytest.mark.parametrize(("version", "changes"), [("1.6", {}), ("1.7", {"rating": None})])
def test_early_versions_and_scenes_without_rating_have_none(version, changes):
    written = results(version, **changes)
    assert not any("iso_6336" in name for attributes in written.values() for name in attributes)


def test_of_bins_with_one_torque_the_one_of_the_least_safety_is_written():
    cases = [{"pinion_torque_Nm": 100.0, "hours": hours} for hours in (1.0, 1e5)]
    shares = [results("1.7", **{"load.case": order}) for order in (cases, cases[::-1])]
    assert shares[0] == shares[1]


def test_of_a_load_spectrum_the_bin_of_the_torque_is_written():
    cases = [{"pinion_torque_Nm": torque, "hours": 10.0} for torque in (200.0, 100.0)]
    spectrum = {"load.case": cases}
    written = results("1.7", **spectrum)
    safety = solved(**spectrum).rating().flank_safety[1, 0]
    assert written["31"]["safety_factor_pitting_iso_6336_2019"].value == safety
    assert not any("iso_6336" in name for name in results("1.7", **{"load.case": cases[:1]})["10"])
