"""Which gear drives, which way they turn and on which side the helix climbs changes no loss, film or temperature."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.samples.tribology import known, shared

SAME = 1e-4  # of maps that are solved twice to 1e-6, on grids of their own
NAMES = ("loss_factor", "mean_friction", "least_film_thickness", "largest_flash_temperature", "pressure_velocity")


def compared(first, second, positions=slice(None)):
    one, other = known(first), known(second)
    for name in NAMES:
        assert_allclose(getattr(other, name), getattr(one, name), rtol=SAME, err_msg=name)
    assert_allclose(other.friction_power[:, positions], one.friction_power, rtol=SAME, atol=1e-9)
    return one, other


@pytest.mark.quick_cases("mesh_cycle_spur")
@pytest.mark.parametrize("name", ["mesh_cycle_spur", "mesh_cycle_helical"])
def test_loss_is_the_same_whichever_gear_drives(name):
    """Backwards with the other gear driving, the same flanks touch in the reverse order."""
    forwards = shared(name)
    backwards = shared(name, pair__driving="wheel", pair__sense="negative")
    one, other = compared(forwards, backwards, slice(None, None, -1))
    torques = np.nansum(one.friction_torque, axis=2), np.nansum(other.friction_torque, axis=2)[:, ::-1]
    power = [
        pinion + forwards.gear_pair.ratio * wheel for pinion, wheel in (np.moveaxis(each, -1, 0) for each in torques)
    ]
    assert_allclose(power[1], power[0], rtol=SAME, atol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["mesh_cycle_helical", "mesh_cycle_bevel"])
def test_a_mirrored_pair_has_the_same_tribology(name):
    own = shared(name)
    other = "left" if own.scene.hands[0] == "right" else "right"
    sense = "negative" if own.scene.sense == "positive" else "positive"
    changes = {"pinion__hand": other, "wheel__hand": None, "pair__sense": sense}
    if hasattr(own.scene.geometry, "pinion_flank"):
        changes["pair__pinion_flank"] = None
    compared(own, shared(name, **changes))


@pytest.mark.thorough
def test_loss_needs_few_positions_of_crowned_pairs():
    """1e-3 from 9 positions on, for pairs whose contacts keep off the edges; the spur pair's relief starts suddenly."""
    for name in ("mesh_cycle_bevel", "face_milled_19x62_matched"):
        few, many = (known(shared(name, positions)).loss_factor for positions in (9, 33))
        assert_allclose(few, many, rtol=1e-3)


@pytest.mark.thorough
def test_extremes_need_17_positions():
    for name in ("mesh_cycle_helical", "mesh_cycle_spur", "face_milled_19x62_matched"):
        few, many = (known(shared(name, positions)) for positions in (17, 33))
        for extreme in ("least_film_thickness", "largest_flash_temperature"):
            assert_allclose(getattr(few, extreme), getattr(many, extreme), rtol=0.02)
