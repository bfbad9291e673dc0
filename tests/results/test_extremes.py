"""Where first order of the figures of single positions ends, and the warning of it."""

import warnings
from types import SimpleNamespace

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.results.extremes import changes_to_another, warn_of_positions
from loaded_tca.warning_kinds import ANOTHER_POSITION

ROUNDING = 1e-12  # of a difference of two slopes of order one
KEY = "mounting.offset_mm"


def sensitivities_of(errors, slopes):
    """As of a result whose transmission errors are straight lines over a key, all pressures alike."""
    errors, slopes = np.append(errors, errors[0]), np.append(slopes, slopes[0])
    none = np.full((1, len(errors), 1), 900.0)
    result = SimpleNamespace(
        torque=[1e5], path=errors, um_per_rad=1.0, transmission_error=errors[None], peak_pressure=none
    )
    result.has_root_stress = False
    by_key = np.zeros((1, len(errors), 1, 1))
    return SimpleNamespace(result=result, keys=(KEY,), transmission_error=slopes[None, :, None], peak_pressure=by_key)


def told(errors, slopes, tolerance):
    with warnings.catch_warnings(), noted_accuracy_warnings(given=False) as sentences:
        warn_of_positions(sensitivities_of(np.array(errors), np.array(slopes)), {KEY: tolerance})
    return sentences


def test_beyond_the_change_another_value_is_the_largest():
    rng = np.random.default_rng(2)
    values, slopes = rng.normal(size=9), rng.normal(size=(9, 4))
    changes, kinks = changes_to_another(values, slopes)
    top = int(values.argmax())
    for side, key in np.ndindex(2, 4):
        change = changes[side, key]
        if not np.isfinite(change):
            continue
        within, beyond = (values + part * change * slopes[:, key] for part in (0.999, 1.001))
        assert within.argmax() == top
        assert beyond.argmax() != top
        assert_allclose(slopes[beyond.argmax(), key] - slopes[top, key], kinks[side, key], rtol=ROUNDING)


def test_peak_to_peak_that_turns_within_the_tolerance_is_told():
    """3, 2.9 and 0 um: the second is the highest from +0.01 on, where the peak to peak rises instead of falling."""
    (sentence,) = told([3.0, 2.9, 0.0], [-9.0, 1.0, 0.0], 0.02)
    assert sentence.startswith(
        "peak to peak: its derivatives do not hold over the whole tolerance: beyond a change by +0.01 mm "
    )
    assert f"({KEY}; 1 of 1 keys)" in sentence
    assert ANOTHER_POSITION.words in sentence


def test_derivatives_that_turn_by_a_twentieth_or_more_are_told():
    assert len(told([3.0, 2.9, 0.0], [-10.0, -8.0, 0.0], 0.1)) == 1  # by a fifth, from +0.05 on
    assert not told([3.0, 2.95, 0.0], [-10.0, -9.7, 0.0], 0.25)  # by 3 %, from +0.17 on


def test_the_lowest_position_counts_too():
    (sentence,) = told([3.0, 0.1, 0.0], [0.0, 10.0, 0.0], 0.02)
    assert "by -0.01 mm another position" in sentence


def test_nothing_is_told_beyond_the_tolerance_nor_of_a_pitch_that_closes():
    assert not told([3.0, 2.9, 0.0], [-9.0, 1.0, 0.0], 0.005)
    assert not told([3.0, 1.0, 0.0], [-9.0, -9.0, 0.0], 0.05)
