"""A pinion and a rack: geometry, place and motion of a rack in closed form."""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.flanks.base import outward_normal
from loaded_tca.flanks.modification import FlankModifications
from loaded_tca.gears import CylindricalGear, Rack, rack_mesh
from loaded_tca.gears.rack import RACK_TEETH
from loaded_tca.pairs import Mounting, rack_pair
from loaded_tca.unloaded import trace_contact

PINION = CylindricalGear(teeth=20, normal_module=3.0, face_width=20.0, helix_angle=radians(15.0))
RACK = Rack(normal_module=3.0, face_width=20.0, height=20.0, helix_angle=radians(-15.0))
LIMIT = 2.0 * PINION.teeth / RACK_TEETH
"""Parts by which the gear that stands for a rack differs from it, of lengths up to a module."""
ROUNDING = 1e-8
"""A few roundings of its radius, 3e6 mm [mm]."""


def test_path_of_contact_is_that_of_a_plane_flank() -> None:
    """It ends on the tip line of the rack, h_a/sin(alpha_t) before the pitch point, and on the tip circle."""
    mesh = rack_mesh(PINION, RACK)
    sine = sin(PINION.transverse_pressure_angle)
    beyond = sqrt(PINION.tip_radius**2 - PINION.base_radius**2) - PINION.reference_radius * sine
    expected = (beyond + 3.0 / sine) / PINION.base_pitch
    assert mesh.transverse_contact_ratio == pytest.approx(expected, rel=LIMIT)
    assert mesh.working_pressure_angle == pytest.approx(PINION.transverse_pressure_angle, rel=LIMIT)


def test_backlash_of_a_distance_and_a_thickness_allowance() -> None:
    """Apart by e it is 2 e tan(alpha_t); teeth thinner by A in the normal section leave A/cos(beta)."""
    apart = rack_mesh(PINION, RACK, PINION.reference_radius + 0.2)
    assert apart.backlash == pytest.approx(0.4 * tan(PINION.transverse_pressure_angle), rel=LIMIT)
    thin = Rack(normal_module=3.0, face_width=20.0, height=20.0, helix_angle=radians(-15.0), thickness_allowance=-0.05)
    assert rack_mesh(PINION, thin).backlash == pytest.approx(0.05 / cos(radians(15.0)), abs=ROUNDING)


def test_flank_is_a_plane_of_the_pressure_angle() -> None:
    flank = rack_pair(PINION, RACK).wheel.nominal_flank
    normals = outward_normal(flank, *flank.grid(5, 3)).reshape(-1, 3)
    alpha, beta = radians(20.0), radians(15.0)
    expected = [sin(alpha), cos(alpha) * cos(beta), cos(alpha) * sin(beta)]
    assert np.abs(normals) == pytest.approx(np.tile(expected, (len(normals), 1)), abs=LIMIT)


@pytest.mark.parametrize("tilts", [(0.002, 0.0), (0.0, 0.003)])
def test_rack_tilts_about_its_reference_line(tilts: tuple[float, float]) -> None:
    """The axis of the gear that stands for it is far away, and goes round it."""
    pair = rack_pair(PINION, RACK, mounting=Mounting(*tilts, 0.1, 0.5))
    z = 5.0
    place = pair.wheel_origin + RACK.radius * pair.wheel_axes[0] + z * pair.wheel_axes[2]
    x = PINION.reference_radius + 0.1 + z * sin(tilts[0])
    expected = [x, -z * sin(tilts[1]), 0.5 + z * cos(tilts[0]) * cos(tilts[1])]
    assert place == pytest.approx(expected, abs=ROUNDING)


def test_rack_apart_stays_behind_by_the_slope_of_its_flank() -> None:
    """By e tan(alpha_t) at every position: a rack and an involute stay conjugate at any distance."""
    crowned = FlankModifications(lead_crowning=0.005), FlankModifications()
    pair = rack_pair(PINION, RACK, modifications=crowned, mounting=Mounting(centre_distance_error=0.1))
    path = trace_contact(pair, np.linspace(-0.1, 0.1, 3))
    behind = -0.1 * tan(PINION.transverse_pressure_angle)
    assert RACK.radius * path.transmission_error == pytest.approx(np.full(3, behind), rel=LIMIT)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"height": 3.0}, "height: 3 mm is not above 3.75 mm"),
        ({"height": -1.0}, "height: -1.0 is not positive"),
        ({"addendum": 0.0}, "addendum: 0.0 is not positive"),
        ({"length": float("inf")}, "length: inf is not positive and finite"),
    ],
)
def test_impossible_racks_are_refused(changes: dict[str, float], message: str) -> None:
    values = {"normal_module": 3.0, "face_width": 20.0, "height": 20.0} | changes
    with pytest.raises(InputError, match=message):
        Rack(**values)


def test_meshes_that_cannot_be_are_refused() -> None:
    with pytest.raises(GeometryError, match="no common flank") as refused:
        rack_mesh(PINION, RACK, 40.0)
    assert "40 mm from the reference line" in refused.value.__notes__[0]
    with pytest.raises(InputError, match="distance: nan mm is not finite"):
        rack_mesh(PINION, RACK, float("nan"))
    short = Rack(normal_module=3.0, face_width=20.0, height=20.0, helix_angle=radians(-15.0), length=2.0 * pi * 3.0)
    with pytest.raises(InputError, match=r"length: 18\.8496 mm is below"):
        rack_mesh(PINION, short)
