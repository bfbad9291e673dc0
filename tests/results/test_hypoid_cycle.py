"""The loaded mesh cycle of a hypoid pair: equilibrium, compliance, sensitivities, sliding, supports."""

import math
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.flank_maps.conjugate import conjugate_contact
from loaded_tca.pairs.gear_pair import mating_teeth
from loaded_tca.results.load_factors import face_ends
from loaded_tca.tribology import Lubricant
from loaded_tca.tribology.slices import slices_of
from loaded_tca.unloaded import trace_contact
from tests.samples.results import SCENES
from tests.samples.root_stress import analysed
from tests.samples.shared import made_once

BALANCED = 1e-6  # of the torque: what balances of a position leave
SLOPES = 5e-3  # of the largest slope: analyses with differences find their boxes and grids anew, on 32 cells
FLANKS = {"analysis.compliance": "contact", "analysis.accuracy": None, "analysis.cells": (32, 32)}
MOUNTING = {
    "mounting.offset_mm": 0.002,
    "mounting.pinion_axial_mm": 0.002,
    "mounting.wheel_axial_mm": 0.002,
    "mounting.shaft_angle_error_deg": 0.002,
}


@cache
def scene(positions=3):
    return read_scene(SCENES / "hypoid_13x42.toml").with_changes(FLANKS | {"analysis.positions": positions})


@made_once
def cycle(*changes, positions=3):
    return analyse(scene(positions).with_changes(dict(changes)))


@made_once
def bending():
    return analyse(scene().with_changes({"analysis.compliance": "contact+tooth", "analysis.cells": (24, 24)}))


@pytest.mark.thorough
@pytest.mark.parametrize("result", [cycle, pytest.param(bending, marks=pytest.mark.thorough)])
def test_pressures_on_both_flanks_carry_the_torque(result):
    """Each cell with the normal of the flank there: contacts have the lever of their contact point for all cells."""
    found = result()
    torques = np.zeros((2, 3))
    for position, maps in enumerate(found.maps[0]):
        for one in maps:
            if one is not None:
                torques[:, position] += _torques(found.gear_pair, one)
    assert_allclose(torques[0], 250e3, rtol=2e-3)
    assert_allclose(torques[1] * 13 / 42, 250e3, rtol=2e-3)
    assert_allclose(np.nansum(found.load_share, axis=-1), 1.0, rtol=BALANCED)


def _torques(pair, one):
    """Torques about both axes [N mm] of a pressure map: a unit normal has the lever 1/|grad F| about its axis."""
    pressed = one.pressure > 0.0
    points = (one.origin + one.x[:, None, None] * one.axes[0] + one.y[:, None] * one.axes[1])[pressed]
    forces = one.pressure[pressed] * np.prod(one.spacing)
    radius, _, axial = pair.to_wheel(points)
    places = ((np.hypot(points[:, 0], points[:, 1]), points[:, 2]), (radius, axial))
    flanks = pair.pinion.flank, pair.wheel.flank
    return [(forces / flank.gradient_norm(*place).value).sum() for flank, place in zip(flanks, places, strict=True)]


@pytest.mark.thorough
def test_bending_lets_the_wheel_lag_and_spreads_the_load():
    stiff, soft = cycle(), bending()
    assert (soft.transmission_error < stiff.transmission_error).all()
    assert np.nanmax(soft.load_share) < np.nanmax(stiff.load_share)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("key", "step"),
    [
        next(iter(MOUNTING.items())),
        *(pytest.param(*one, marks=pytest.mark.thorough) for one in [*MOUNTING.items()][1:]),
    ],
)
def test_sensitivity_to_mounting_errors_is_the_difference_of_analyses(key, step):
    slopes = _sensitivities().transmission_error[0, :, [*MOUNTING].index(key)]
    above, below = (cycle((key, sign * step)).transmission_error[0] for sign in (1, -1))
    difference = (above - below) / (2.0 * step)
    assert_allclose(slopes, difference, atol=SLOPES * np.abs(difference).max())


@cache
def _sensitivities():
    return cycle().sensitivities([*MOUNTING])


def test_sliding_in_p_runs_along_the_tooth_as_the_offset_asks():
    """v = omega_1 r_1 sin(zeta_mp)/cos(beta_m2): both gears have one velocity across the teeth there."""
    slices, cones = slices_of(cycle()), scene().mesh().cones
    delta = cones.pitch_angles[0]
    point = cones.mean_cone_distances[0] * np.array([math.sin(delta), 0.0, math.cos(delta)])
    distance = np.linalg.norm(slices.point - point, axis=1)
    near = np.argsort(distance)[:4]
    _, spiral = cones.rolling_spiral_angles((13, 42))
    expected = cones.radii[0] * math.sin(cones.offset_angle) / math.cos(spiral)
    assert_allclose(slices.sliding[near], expected, rtol=0.05)  # within half a millimetre of P
    # most of it is not across the contact, where films and rolling are
    across = np.abs(np.subtract(*slices.rolling))[near]
    assert (across < 0.6 * slices.sliding[near]).all()


@pytest.mark.thorough
def test_torques_of_friction_do_its_power():
    result = cycle(positions=5)
    oil = Lubricant(viscosity_40=220.0, viscosity_100=19.0, oil_temperature=80.0)
    with pytest.warns(Warning, match="every second position"):
        tribology = result.tribology(1500.0, oil, (0.4, 0.4), friction="local", bulk_temperature_C=90.0)
    data = tribology.dataset
    torques, omega = data["friction_torque"].sum("pair"), 1500.0 * 2.0 * math.pi / 60.0
    work = -1e-3 * omega * (torques.sel(gear="pinion") + result.gear_pair.ratio * torques.sel(gear="wheel"))
    assert_allclose(work.values, data["friction_power"].values, rtol=1e-9)
    # a multiple of that of the spiral bevel pair 19/62, 0.11: in P alone both flanks slide by 0.25 r_1
    assert 0.3 < float(tribology.loss_factor[0]) < 0.6


def test_no_edge_of_the_example_is_loaded():
    assert not cycle().on_edge.any()


def test_ease_off_field_vanishes_where_p_is_held():
    pair = scene().with_changes({f"{gear}.modifications": {} for gear in ("pinion", "wheel")}).pair()
    cones = scene().mesh().cones
    distance, delta = cones.mean_cone_distances[0], cones.pitch_angles[0]
    contact = conjugate_contact(pair, np.array([distance * math.sin(delta)]), np.array([distance * math.cos(delta)]))
    assert_allclose(contact.lead, 0.0, atol=1e-6)
    assert_allclose(contact.angle, 0.0, atol=1e-4)


@pytest.mark.thorough
def test_gears_on_supports_give_way_as_their_forces_ask():
    """A pinion that gives way along its axis alone moves by the axial force of its teeth."""
    soft = [[0.0] * 6 for _ in range(6)]
    soft[2][2] = 1e-6  # mm/N
    with pytest.warns(AccuracyWarning, match="have a moment about its axis"):  # one normal for the whole of a contact
        found = analyse(scene().with_changes({"pinion.support.compliance": soft}))
    axial = np.zeros(3)
    for position, maps in enumerate(found.maps[0]):
        axial[position] = sum(-one.slice_force.sum() * one.axes[2][2] for one in maps if one is not None)
    assert_allclose(np.abs(found.pinion_motion[0, :, 2]), 1e-6 * np.abs(axial), rtol=1e-3)
    assert (np.abs(axial) > 10e3).all()  # 12 kN at P: a hypoid pinion of 50 deg is pushed along its axis


@pytest.mark.thorough
def test_root_stress_of_both_gears_is_the_same_a_pitch_further():
    found = analysed(scene(2).with_changes({"analysis.root_stress": True, "analysis.compliance": "contact+tooth"}))
    tension, compression = (found.dataset[name].values[0] for name in ("root_tension", "root_compression"))
    assert_allclose(tension[0], tension[1], rtol=1e-4)
    assert_allclose(compression[0], compression[1], rtol=1e-4)
    # of the size of F_mt1/(b m_mn) = 118 MPa times factors of form and notch, on a third of the face
    assert ((tension > 400.0) & (tension < 1000.0)).all()
    assert (compression < -400.0).all()


def test_teeth_are_as_thick_at_p_as_the_blank_says():
    """s_mn1 = 4.922 mm of annex F.3, s_mn2 = 3.241 mm, less what the fit to a duplex taper changes."""
    teeth = mating_teeth(scene().pair())
    radii, spirals = scene().mesh().cones.radii, scene().mesh().cones.rolling_spiral_angles((13, 42))
    found = [
        2.0 * tooth.half_thickness_angle * radius * math.cos(spiral)
        for tooth, radius, spiral in zip((teeth.pinion, teeth.wheel), radii, spirals, strict=True)
    ]
    assert_allclose(found, [4.922, 3.241], atol=5e-3)


@pytest.mark.parametrize("key", ["pinion.modifications.profile_crowning_um", "mounting.offset_mm"])
def test_common_face_does_not_depend_on_where_the_path_of_contact_runs(key):
    """Coordinates along both faces part by 0.8 mm over the path of a hypoid pair, which leaps where teeth take turns.

    Crowning moves no end of a face; the offset moves the wheel across its own cone distances, by 0.02 mm for each mm.
    """
    base, step = scene(5).with_changes({"analysis.cells": (8, 12)}), 0.04
    ends = []
    for part in (-1.0, 0.0, 1.0):
        pair = base.with_changes({key: part * step if key.startswith("mounting") else 5.0 + 2.0 * part}).pair()
        ends.append(face_ends(pair, trace_contact(pair, warn=False)))
    assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-3)  # of strips 1 mm wide
    assert_allclose(ends[2], ends[1], rtol=0.0, atol=1e-3)
