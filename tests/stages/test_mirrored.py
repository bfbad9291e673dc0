"""A stage in a mirror: other hand, other driving member, planets and pins on the other side; the same numbers."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.stages import analyse_stage, read_stage

STAGE = Path(__file__).parents[2] / "examples" / "stages" / "helical_automotive.toml"
FEW = {
    "analysis.compliance": "contact",
    "analysis.free_edges": False,
    "analysis.accuracy": 0.1,
    "analysis.positions": 5,
    "analysis.torques_Nm": [200.0],
    "stage.planets": None,
    "stage.floating_sun": False,
    "stage.sun_support_stiffness_N_per_um": 200.0,
}
ANGLES = np.array([0.0, 86.4, 180.0, 262.8])  # multiples of 3.6 deg
TANGENTIAL, RADIAL = np.array([4.0, -3.0, 0.0, 2.0]), np.array([0.0, 5.0, 0.0, 1.0])  # um
# Contacts on mirrored flanks are solved anew, on grids of 10 %: their scatter.
SOLVED_ANEW = 1e-5

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")


def analysed(angles, tangential, radial, **keys):
    pins = {"stage.pin_tangential_um": tangential.tolist(), "stage.pin_radial_um": radial.tolist()}
    more = {name.replace("__", "."): value for name, value in keys.items()}
    changes = FEW | pins | {"stage.planet_angles_deg": angles.tolist()} | more
    return analyse_stage(read_stage(STAGE).with_changes(changes))


@pytest.fixture(scope="module")
def plain():
    return analysed(ANGLES, TANGENTIAL, RADIAL)


@pytest.mark.thorough
def test_other_hand_shares_alike(plain):
    other = analysed(ANGLES, TANGENTIAL, RADIAL, sun__hand="left")
    assert_allclose(other.planet_share, plain.planet_share, rtol=SOLVED_ANEW)
    assert_allclose(other.sun_motion, plain.sun_motion, rtol=SOLVED_ANEW, atol=1e-9)
    assert_allclose(other.transmission_error, plain.transmission_error, rtol=SOLVED_ANEW)


@pytest.mark.thorough
def test_driving_carrier_mirrors_planets_pins_and_motion(plain):
    """In the plane through planet 0: angles and tangential errors change their sign, the mesh turns back in time."""
    order = [0, 3, 2, 1]
    mirrored = analysed((-ANGLES[order]) % 360.0, -TANGENTIAL[order], RADIAL[order], stage__driving="carrier")
    assert_allclose(mirrored.mesh_load_factor, plain.mesh_load_factor, rtol=SOLVED_ANEW)
    shares, means = mirrored.planet_share[0][:, order], plain.planet_share[0].mean(axis=0)
    assert_allclose(shares.mean(axis=0), means, rtol=SOLVED_ANEW)
    assert_allclose(mirrored.sun_motion.mean(axis=(0, 1)) * [1.0, -1.0], plain.sun_motion.mean(axis=(0, 1)), rtol=1e-4)
    amplitudes = [[one.stage for one in result.orders()] for result in (mirrored, plain)]
    assert_allclose(amplitudes[0], amplitudes[1], atol=1e-4)  # um
    assert (plain.transmission_error < 0.0).all()
    assert (mirrored.transmission_error > 0.0).all()
