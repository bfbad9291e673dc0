"""The top of a transmission error, from which the comparisons of face-milled pairs count."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.pairs.bevel import face_milled_pair
from loaded_tca.unloaded import trace_contact
from validation.face_milled import pairs


@pytest.mark.thorough
def test_error_falls_to_both_sides_of_the_top():
    top, fall, path = pairs.error_from_top(face_milled_pair(*pairs.matched_spygo_gears()), (-0.5, 0.5))
    assert_allclose(fall, [-6.018, -5.711], atol=1e-3)  # pair B; its printed digits
    assert_allclose(path.pinion_angle, top)


@pytest.mark.thorough
@pytest.mark.parametrize("lever", ["pinion_lever", "wheel_lever"])
@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_wrong_levers_give_numbers_that_miss_instead_of_an_error(lever, factor, monkeypatch):
    """Levers that have the ratio of the teeth nowhere: the comparison goes on beside the top."""

    def with_wrong_lever(*arguments, **options):
        path = trace_contact(*arguments, **options)
        return replace(path, **{lever: factor * getattr(path, lever)})

    monkeypatch.setattr(pairs, "trace_contact", with_wrong_lever)
    pair = face_milled_pair(*pairs.matched_spygo_gears())
    _, fall, path = pairs.error_from_top(pair, (-0.5, 0.5))
    assert np.isfinite(fall).all()
    assert abs(path.pinion_lever[0] / path.wheel_lever[0] / pair.ratio - 1.0) > 5e-3
    assert np.abs(fall - [-6.018, -5.711]).min() > 0.1
