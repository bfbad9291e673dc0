"""Pairs of every family come back from pickles as they were, as results from processes of a pool do."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from loaded_tca import read_scene
from tests.samples.results import SCENES

PARTS = ("value", "rho", "z", "rho_rho", "rho_z", "z_z")


@pytest.mark.parametrize(
    "name",
    [
        "helical",
        "planet_ring",
        "rack_and_pinion",
        "measured_flank",
        "straight_bevel",
        "spiral_bevel",
        "bspline_bevel",
        "face_milled_19x62",
        "duplex_30x20",
        "hypoid_13x42",
    ],
)
def test_pair_comes_back_from_a_pickle(name):
    pair = read_scene(SCENES / f"{name}.toml").pair()
    again = pickle.loads(pickle.dumps(pair))
    assert_array_equal(again.wheel_axes, pair.wheel_axes)
    for gear, other in ((pair.pinion, again.pinion), (pair.wheel, again.wheel)):
        rho, z = gear.flank.grid(3, 3)
        theta, read = gear.flank.theta(rho, z), other.flank.theta(rho, z)
        for part in PARTS:
            assert_array_equal(np.asarray(getattr(read, part)), np.asarray(getattr(theta, part)))  # to the last bit
