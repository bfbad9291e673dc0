"""Error of the damage between solved torques, on laws whose damage is known."""

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.rating.cases import Cases
from loaded_tca.rating.interpolation import interpolation_error, scatter
from loaded_tca.rating.lives import Endurance, damages_of
from loaded_tca.rating.solved import SolvedLoads
from loaded_tca.reference.iso6336_6 import SNCurve

EXPONENT = 13.2
"""Of case-hardened flanks, from 1.6 at 1e5 to 1 at 5e7 load cycles."""
CURVE = SNCurve(np.array([1e5, 5e7]), np.array([1600.0, 1000.0]))
LONG = SNCurve(np.array([1.0, 1e30]), 10.0 * np.array([1e30 ** (1.0 / EXPONENT), 1.0]))
"""A line of that exponent from a stress that nothing reaches down to one that all bins exceed."""


@dataclass(frozen=True)
class Inputs:
    solved: SolvedLoads
    cases: Cases
    rating: ClassVar = SimpleNamespace(face_load_factor=1.0, transverse_load_factor=1.0)
    nearest: SolvedLoads | None = None

    @property
    def loads(self):
        return self.solved.at(self.cases.factor_torque)


def loads(torque, pressure):
    places = np.zeros((2, len(torque), 2))
    ones = np.ones(len(torque))
    return SolvedLoads(torque, ones, ones, ones, pressure, places)


def by(curve):
    """Evaluation of flanks of both gears by pressure and K_gamma."""

    def evaluate(inputs):
        stress = inputs.loads.pressure * inputs.loads.mesh_load_factor**0.5
        endurance = Endurance(curve, stress, np.full(len(inputs.cases.torque), 1e4), 1.0, 0.5)
        return {}, {"local_flank": (endurance, endurance)}, ()

    return evaluate


def error_and_damage(curve, solved, torques):
    ones = np.ones(len(torques))
    inputs, evaluate = Inputs(solved, Cases(torques, ones, ones, ones < 0.0, 1.0, is_spectrum=True)), by(curve)
    endurances = evaluate(inputs)[1]
    return interpolation_error(inputs, endurances, evaluate)[0, 0], damages_of(endurances)[:, 0, 0]


NODES, BINS = np.linspace(80e3, 200e3, 12), np.linspace(80e3, 200e3, 101)


def law(torque):
    """Pressures that grow with a power of the torque, which is interpolated exactly."""
    return 1500.0 * (torque / 200e3) ** 0.45


def test_scatter_is_that_of_noise_and_none_of_smooth_laws_and_single_kinks():
    torques, noise = np.geomspace(1.0, 300.0, 200), np.random.default_rng(3).normal(size=200)
    logarithm = np.log(torques)
    cubic = np.exp(0.3 * logarithm - 0.2 * logarithm**2 + 0.02 * logarithm**3)
    assert scatter(torques[::20], cubic[::20]) < 1e-12  # a cubic is its own polynomial through four neighbours
    kinked = cubic * np.maximum(1.0, torques / 30.0)
    # the median of 200 magnitudes has a standard deviation of 8 %; three of these
    assert_allclose(scatter(torques, kinked * np.exp(2e-3 * noise)), 2e-3, rtol=0.25)
    both = np.stack([cubic, cubic * np.exp(1e-3 * noise)], axis=-1)
    assert_allclose(scatter(torques, both), [0.0, 1e-3], rtol=0.25, atol=1e-12)
    assert np.isnan(scatter(torques, np.where(torques < 2.0, np.nan, cubic)))


def test_smooth_law_has_no_error():
    error, damage = error_and_damage(LONG, loads(NODES, law(NODES)), BINS)
    assert (damage > 0.0).all()
    assert error < 1e-9  # rounding of logarithms times the exponent


@pytest.mark.parametrize(("name", "power"), [("pressure", 1.0), ("mesh_load_factor", 0.5)])
def test_error_covers_what_scatter_of_solved_torques_does(name, power):
    chance, exact = np.random.default_rng(7), error_and_damage(LONG, loads(NODES, law(NODES)), BINS)[1].sum()
    seen, errors = [], []
    for _ in range(10):
        smooth = loads(NODES, law(NODES))
        scattered = getattr(smooth, name) * np.exp(2e-3 / power * chance.normal(size=12))
        error, damage = error_and_damage(LONG, replace(smooth, **{name: scattered}), BINS)
        seen.append(abs(damage.sum() / exact - 1.0))
        errors.append(error)
    assert np.sum(np.array(seen) < errors) >= 9  # of normal deviates 0.95 lie within two standard deviations
    assert np.mean(errors) < 6.0 * np.mean(seen)  # a mean magnitude is 0.8 of one standard deviation


def test_stress_just_below_the_end_of_a_curve_is_no_certainty_of_no_damage():
    # 1000 MPa are borne for ever; without the sixth torque stresses are by 1.5 MPa less, and may be by as much more
    nearly = loads(NODES, np.where(np.arange(12) == 5, 999.5, 998.0))
    error, damage = error_and_damage(CURVE, nearly, BINS)
    assert_array_equal(damage, 0.0)
    assert error > 0.0


def test_error_of_bins_below_the_smallest_solved_torque_counts():
    bend = 103e3  # above the third torque, of which the first two say where stresses go on below
    bent = loads(NODES, law(NODES) * np.maximum(1.0, NODES / bend) ** 0.3)
    # without the first torque, the slope below is that from the second to the fourth
    slope = 0.3 * np.log(NODES[3] / bend) / np.log(NODES[3] / NODES[1])
    expected = (NODES[1] / 30e3) ** (EXPONENT * slope) - 1.0  # as far the other way: more damage than less
    error, damage = error_and_damage(LONG, bent, np.array([30e3, 30e3]))
    assert (damage > 0.0).all()
    assert_allclose(error, expected, rtol=1e-6)


def test_life_that_a_static_overload_ends_has_no_error():
    error, damage = error_and_damage(CURVE, replace(loads(NODES, law(NODES)), pressure=2000.0 * np.ones(12)), BINS)
    assert np.isinf(damage).all()
    assert error == 0.0
