"""Accuracy warnings: what is told, and where."""

import math
import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, InputError, analyse, read_scene
from loaded_tca.compliance.model import HeldBodies, held_bodies
from loaded_tca.results.warnings import rotation_reasons

SCENES = Path(__file__).parents[2] / "examples" / "scenes"
NET_FORCE = 1.0325
"""Displacement that a bore of 6 instead of 37.125 mm adds, over the twist of the ring between: the net force of the
teeth moves the body, too. Of a plane disc of the root diameter under such a force, by 128 quadratic elements around it
and as long as wide: 1.0318 in plane strain, 1.0333 in plane stress."""
COARSE = {"analysis.accuracy": None, "analysis.cells": (20, 20), "analysis.positions": 3}


def told(name, **changes):
    """Result and warnings of an example scene on a coarse grid."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AccuracyWarning)
        result = analyse(read_scene(SCENES / f"{name}.toml").with_changes(COARSE | changes))
    return result, [str(warning.message) for warning in caught]


@pytest.mark.quick_cases("1e-11-False", "1e-300-True")
@pytest.mark.parametrize("load_sharing", [True, False])
@pytest.mark.parametrize("torque", [1e-11, 1e-300])
def test_next_to_no_torque_is_told_and_taken_for_no_load(torque, load_sharing):
    changes = {"analysis.load_sharing": load_sharing, "analysis.torques_Nm": (torque, 1.0)}
    result, sentences = told("mesh_cycle_spur", **changes)
    assert sum(f"{torque:g} N m is next to no torque" in sentence for sentence in sentences) == 1
    assert (result.normal_force[0] == 0.0).all()
    assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=1e-9)
    assert (result.normal_force[1].sum(axis=-1) > 0.0).all()


def test_warning_names_a_place_that_has_what_it_tells():
    result, sentences = told("mesh_cycle_helical", **{"analysis.torques_Nm": (40.0, 260.0)})
    (sentence,) = (one for one in sentences if "reaches an edge" in one)
    count, total, torque, angle, number = re.search(
        r"at (\d+) of (\d+) pressure maps; the first: (\S+) N m, pinion angle (\S+) deg, tooth pair (\S+)\)", sentence
    ).groups()
    assert int(count) == result.on_edge.sum()
    assert int(total) == sum(one is not None for rows in result.maps for row in rows for one in row)
    place = (
        int(abs(result.torque - 1e3 * float(torque)).argmin()),
        int(abs(np.degrees(result.pinion_angle) - float(angle)).argmin()),
        result.pair.tolist().index(int(number)),
    )
    assert result.on_edge[place]


@pytest.mark.thorough
def test_contacts_of_the_helical_mesh_cycle_do_not_reach_their_boxes():
    """Two of its contacts did, which had grown under a corrected force."""
    changes = {"analysis.accuracy": 1e-2, "analysis.cells": None, "analysis.positions": 33}
    result, sentences = told("mesh_cycle_helical", **changes)
    assert not any("the border of its grid" in sentence for sentence in sentences)
    for rows in result.maps:
        for one in (one for row in rows for one in row if one is not None):
            assert not one.pressure[[0, -1]].any()
            assert not one.pressure[:, [0, -1]].any()


@pytest.mark.thorough
def test_twist_about_a_thin_bore_is_told():
    scene = "mesh_cycle_finite_elements"
    thin, sentences = told(scene, **{"pinion.bore_diameter_mm": 6.0})
    assert sum("twist of the gear bodies about their bores, 6 and" in sentence for sentence in sentences) == 1
    usual, sentences = told(scene)
    assert not any("twist" in sentence for sentence in sentences)
    # In closed form: the twist of the ring that is added, at the base circle, over the face of 20 mm. Whatever is
    # outside, its stress is T/(2 pi r^2), so that no bending of the body takes anything off it.
    base, width, modulus = 0.5 * 75.0 * math.cos(math.radians(20.0)), 20.0, 206000.0 / 2.6
    added = base**2 / (4.0 * math.pi * modulus * width) * (1.0 / 3.0**2 - 1.0 / (0.275 * 67.5) ** 2)
    force = 20e3 / base
    turned = (usual.transmission_error - thin.transmission_error) * usual.wheel_base_radius
    assert (turned > force * added).all()
    # half the way from plane strain to plane stress is 0.07 %, four layers of rim are 0.1 %
    assert_allclose(turned, NET_FORCE * force * added, rtol=3e-3)


def test_wide_bores_are_warned_of_with_what_they_do_to_the_stiffness():
    """A bore of 90 mm for a shaft of 17 mm: it takes away the twist of the ring between, in closed form as above.

    Scenes refuse such a bore; a pair has it.
    """
    bores = {"pair.helix_angle_deg": 0.0, "pinion.bore_diameter_mm": 45.0, "wheel.bore_diameter_mm": None}
    shaft = {"wheel.shaft.sections": [{"length_mm": 220.0, "outer_diameter_mm": 17.0}]}
    scene = read_scene(SCENES / "helical_on_shafts.toml").with_changes({**bores, **shaft})
    pair = scene.pair()
    pair = replace(pair, wheel=replace(pair.wheel, bore_diameter=90.0))
    bodies = held_bodies(scene, pair)
    width, modulus = scene.wheel.face_width_mm, 206000.0 / 2.6
    ring = pair.base_radii[1] ** 2 / (4.0 * math.pi * modulus * width) * (1.0 / 8.5**2 - 1.0 / 45.0**2)
    # bores of 17 and 6 mm are both about a tenth of the root; the rim bends, too: 1.1 %
    assert_allclose(bodies.stiffening, NET_FORCE * ring, rtol=0.02)
    assert bodies.usual_bores == (45.0, 17.0)
    rate = np.array([[0.1, 0.3]]) * math.prod(pair.base_radii) / bodies.stiffening  # of 10 and 30 % less deflection
    about = pair, np.array([1e3]), np.array([[1e-4, 1e-4]])
    (sentence,) = rotation_reasons(*about, rate, bodies)
    assert sentence.startswith(
        "bores of 45 and 90 mm are held rigid: the mesh is about 20% stiffer than with bores of 45 and 17 mm"
    )
    assert not rotation_reasons(*about, 0.2 * rate, bodies)  # 4 %


@pytest.mark.parametrize("bores", [{"pinion.bore_diameter_mm": 0.0}, {"wheel.bore_diameter_mm": 60.0}, {}])
def test_usual_bores_cost_no_model_and_give_no_warning(bores):
    scene = read_scene(SCENES / "mesh_cycle_finite_elements.toml").with_changes(bores)
    assert held_bodies(scene, scene.pair()).stiffening == 0.0
    assert held_bodies(scene.with_changes({"analysis.compliance": "contact"}), scene.pair()) == HeldBodies()


@pytest.mark.thorough
def test_pair_that_fills_its_grid_at_the_cap_gets_a_larger_one():
    """Beside a pair at its limit a light one takes several times the force that its first grid was made for."""
    capped = {"analysis.torques_Nm": (130.0,), "material.max_pressure_MPa": 50.0}
    result, sentences = told("mesh_cycle_spur", **capped, **{"analysis.positions": 9, "analysis.cells": (24, 24)})
    assert not any("the border of its grid" in sentence for sentence in sentences)
    assert_allclose(result.load_share.sum(axis=-1), 1.0, rtol=1e-8)
    assert np.nanmax(result.peak_pressure) <= 50.0


def test_cap_that_the_flanks_cannot_carry_is_told_with_its_place():
    with pytest.raises(
        InputError, match=r"130 N m at pinion angle .* deg: tooth pair (0|[+-]\d): load: .* max_pressure, 5 MPa"
    ):
        told("mesh_cycle_spur", **{"analysis.torques_Nm": (130.0,), "material.max_pressure_MPa": 5.0})
