"""Sensitivities of contacts that end at edges: against numbers of whole analyses on either side."""

import warnings

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca import analyse, read_scene
from loaded_tca.errors import AccuracyWarning
from tests.samples.results import FLANKS_ALONE, SCENES

DISTANCE = "mounting.centre_distance_error_mm"
MICROMETRES = 1e3


def slopes(name, key, **changes):
    """Sensitivities to a key, and what a radian is at the wheel's base circle [um]; 9 positions, 64 cells."""
    wanted = {"analysis.cells": (64, 64), "analysis.positions": 9, "analysis.torques_Nm": (130.0,), **changes}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        result = analyse(read_scene(SCENES / f"{name}.toml").with_changes(wanted))
    return result.sensitivities([key]), MICROMETRES * result.gear_pair.base_radii[1]


def test_spur_pair_with_tip_relief_and_centre_distance_as_by_whole_analyses():
    found, length = slopes("mesh_cycle_spur", DISTANCE)  # differences over 0.04 and 0.08 mm
    assert_allclose(found.peak_to_peak[0, 0] * length, 0.272, rtol=0.01)
    assert_allclose(found.harmonics(1)[0, 0, 0] * length, -0.321, rtol=0.01)
    assert_allclose(found.face_load_factor[0, 0], -0.0867, rtol=0.02)


def test_helical_pair_and_centre_distance_as_by_whole_analyses():
    found, length = slopes("helical", DISTANCE, **FLANKS_ALONE)
    differences = [-352.5957, -352.7133, -352.9221, -353.403, -353.7759, -353.484, -353.1195, -352.6982]  # over 0.04 mm
    told = found.transmission_error[0, :-1, 0] * length
    # analyses place their boxes anew, by which they differ by 0.02 um/mm from position to position
    assert_allclose(told, differences, rtol=0, atol=0.03)
    assert_allclose(told.mean(), np.mean(differences), rtol=0, atol=0.01)
    assert_allclose(found.peak_to_peak[0, 0] * length, 1.180, rtol=0.02)
    assert_allclose(found.harmonics(1)[0, 0, 0] * length, 0.5464, rtol=0.02)
    assert_allclose(found.face_load_factor[0, 0], -0.0795, rtol=0, atol=0.005)
