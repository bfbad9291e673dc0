"""The finite element reference: its geometry, meshes, decks and readers, without running the program."""

import math

import numpy as np
import pytest

from loaded_tca.gears.cylindrical import CylindricalGear
from validation.calculix.campaign import first_setback
from validation.calculix.case import CENTRE_DISTANCE, VARIANTS, line_load, pinion_angle, position
from validation.calculix.crowned import crowned_deck
from validation.calculix.crowned_run import peak_of_layers
from validation.calculix.deck import THICKNESS
from validation.calculix.evaluate import evaluate, fit_half_ellipse
from validation.calculix.grading import graded
from validation.calculix.mesh_position import Position
from validation.calculix.model import Meshing, plane_deck, touching_pairs, unloaded_setback
from validation.calculix.run import ContactForce, Run, UnsettledError, _check_corrections, _pressures, _printed
from validation.calculix.tables import read_table, write_table
from validation.calculix.tooth_form import ToothForm

ROUNDING = 1e-12  # of lengths of 100 mm
TROCHOID = 1e-6
"""Points of the trochoid are interpolated between samples [mm]."""
SEARCH = 1e-6
"""The first touch is sought among points of the flank; two more lie within this of it [mm]."""
COARSE = Meshing(per_half_width=2.0, growth=0.8, coarsest=1.5, beside=3.0, far=6.0, rim=0.3)


def house(teeth):
    return CylindricalGear(teeth=teeth, normal_module=3.0, face_width=20.0)


@pytest.mark.parametrize("teeth", [25, 37])
def test_tooth_form_agrees_with_the_gear_of_the_package(teeth):
    form, gear = ToothForm(teeth), house(teeth)
    radius = np.linspace(gear.form_radius, gear.tip_radius, 30)
    thickness = [gear.tooth_thickness_at(r) for r in radius]
    np.testing.assert_allclose(2.0 * radius * form.half_angle(radius), thickness, atol=ROUNDING)
    fillet, angle = gear.root_fillet(60)
    inner = fillet[1:-1]
    np.testing.assert_allclose(inner * form.half_angle(inner), inner * angle[1:-1], atol=TROCHOID)


def test_tip_relief_removes_its_amount_at_the_tip_and_nothing_below_its_start():
    plain, relieved = VARIANTS["unmodified"][0], VARIANTS["tip_relief"][0]
    radius = np.array([37.0, 38.1, plain.tip_radius])
    removed = (plain.half_angle(radius) - relieved.half_angle(radius)) * plain.base_radius
    np.testing.assert_allclose(removed, [0.0, 0.0, 0.015], atol=ROUNDING)


def test_thinning_takes_the_same_off_flank_and_fillet():
    plain, thin = ToothForm(25), ToothForm(25, thinning=0.01)
    radius = np.array([34.5, 36.0, 40.0])
    removed = (plain.half_angle(radius) - thin.half_angle(radius)) * plain.base_radius
    np.testing.assert_allclose(removed, 0.01, atol=TROCHOID)


def test_grading_is_finest_at_its_place_and_never_coarser_than_allowed():
    line = graded(7.0, 3.0, 0.2, 0.02, 0.4, 0.8)
    size = np.diff(line[::2])
    assert line[0] == 0.0
    assert line[-1] == 7.0
    assert size.max() <= 0.8
    assert 0.018 < size.min() <= 0.02
    assert abs(line[::2][np.argmin(size)] - 3.0) < 0.2
    np.testing.assert_allclose(line[1::2], 0.5 * (line[:-1:2] + line[2::2]), atol=ROUNDING)


@pytest.mark.parametrize("index", [0, 7, 12, 20])
def test_unmodified_pairs_touch_without_lag_and_conjugate(index):
    place = position("unmodified", index, 0.0)
    assert abs(unloaded_setback(place)) < SEARCH
    touch = place.touch(0)
    roll = math.sqrt(touch.pinion_radius**2 - place.pinion.base_radius**2)
    nominal = place.pinion.base_radius * (math.tan(place.pinion.pressure_angle) + place.pinion_angle)
    assert abs(roll - nominal) < 1e-2


def test_pair_plus_one_is_pair_zero_a_pitch_later():
    pinion, wheel = VARIANTS["tip_relief"]
    now = Position(pinion, wheel, CENTRE_DISTANCE, 0.1, 0.003).touch(1)
    then = Position(pinion, wheel, CENTRE_DISTANCE, 0.1 - pinion.pitch, 0.003).touch(0)
    assert abs(now.gap - then.gap) < SEARCH
    assert abs(now.pinion_radius - then.pinion_radius) < 1e-2


def test_positions_cover_a_pitch_without_its_end():
    angles = [pinion_angle(index) for index in range(25)]
    assert angles[0] == -math.pi / 25
    assert angles[12] == 0.0
    assert abs(angles[24] - math.pi / 25) < ROUNDING


@pytest.fixture(scope="module")
def deck():
    place = position("unmodified", 0, 0.007)
    return place, plane_deck(place, line_load(100.0), COARSE)


def corners_of(section):
    return section.nodes[section.elements[:, :4]]


def test_elements_are_convex_and_cover_the_gear(deck):
    place, built = deck
    for form, section in ((place.pinion, built.pinion), (place.wheel, built.wheel)):
        points = corners_of(section)
        ahead, back = np.roll(points, -1, axis=1) - points, np.roll(points, 1, axis=1) - points
        turns = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
        assert turns.min() > 0.0
        radius = np.linspace(form.root_radius, form.tip_radius, 2001)
        below = radius < form.fillet[0][0]
        half = np.where(below, np.interp(-radius, -form.fillet[0], form.fillet[1]), form.half_angle(radius))
        teeth = form.teeth * np.trapezoid(2.0 * half * radius, radius)
        body = math.pi * (form.root_radius**2 - form.bore_radius**2)
        area = 0.25 * sum(np.sum(turns[:, k]) for k in range(4))
        assert abs(area / (teeth + body) - 1.0) < 0.01


def test_midside_nodes_of_the_loaded_flanks_lie_on_the_involute(deck):
    place, built = deck
    for pair, (elements, _) in built.flanks.items():
        middle = built.pinion.nodes[built.pinion.elements[elements, 4]]
        radius = np.hypot(*middle.T)
        angle = np.arctan2(middle[:, 1], middle[:, 0]) - place.pinion_tooth(pair)
        np.testing.assert_allclose(angle, place.pinion.half_angle(radius), atol=ROUNDING * 1e3)


def test_two_pairs_touch_at_the_end_of_the_pitch_and_one_at_the_pitch_point(deck):
    _, built = deck
    assert sorted(built.flanks) == [-1, 0]
    assert sorted(touching_pairs(position("unmodified", 12, 0.010))) == [0]
    assert first_setback("tip_relief", 20.0, 0) > first_setback("unmodified", 20.0, 0) + 0.002


def test_deck_turns_all_bore_nodes_of_the_pinion_with_one(deck):
    place, built = deck
    text = built.text()
    torque = line_load(100.0) * place.pinion.base_radius * THICKNESS
    assert built.hub_force * place.pinion.bore_radius == pytest.approx(torque, rel=ROUNDING)
    assert text.count("*EQUATION") == len(built.pinion.bore) - 1
    assert text.count("*CONTACT PAIR") == 2
    assert text.count("*STEP") == 2


def test_crowned_deck_repeats_the_section_and_removes_the_crowning_at_the_end():
    place, built = crowned_deck(0.013, COARSE, 2)
    body = built.pinion
    coordinates, elements = body.coordinates(), body.hexahedra()
    assert coordinates.shape == (body.last_node, 4)
    assert elements.shape == (2 * len(body.bottom.elements), 21)
    assert np.unique(elements[:, 1:]).size == body.last_node
    upright = coordinates[elements[:, 17:] - 1, 3]
    assert set(np.unique(upright)) == {2.5, 7.5}
    moved = np.linalg.norm(body.top.nodes - body.bottom.nodes, axis=1)
    flank = body.bottom.elements[built.flanks[0], 4]
    lever = np.hypot(*body.bottom.nodes[flank].T) / place.pinion.base_radius
    np.testing.assert_allclose(moved[flank], 0.010 * lever, rtol=1e-3)
    bore = np.hypot(*body.top.nodes[body.top.bore].T)
    np.testing.assert_allclose(bore, place.pinion.bore_radius, rtol=ROUNDING)


def test_half_ellipse_is_recovered_exactly():
    place = np.linspace(0.9, 1.1, 21)
    pressure = 800.0 * np.sqrt(np.clip(1.0 - ((place - 1.01) / 0.11) ** 2, 0.0, None))
    centre, half_width, highest = fit_half_ellipse(place, pressure)
    np.testing.assert_allclose([centre, half_width, highest], [1.01, 0.11, 800.0], rtol=1e-9)


def test_half_ellipse_of_too_few_points_is_no_number():
    centre, half_width, highest = fit_half_ellipse(np.array([0.0, 0.1]), np.array([1.0, 1.0]))
    assert centre == pytest.approx(0.05)
    assert math.isnan(half_width)
    assert math.isnan(highest)


def test_peak_of_layers_is_that_of_their_parabola():
    ends = 0.5 * np.arange(9)
    means = np.diff(200.0 * ends - ends**3 - 0.02 * ends**5) / 0.5
    assert peak_of_layers(means, 0.5) == pytest.approx(200.0, rel=1e-9)


PRINTED = """
 displacements (vx,vy,vz) for set HUB and time  0.1000000E+01

         7  0.000000E+00 {hub}  0.000000E+00 L

 statistics for slave set P0, master set W0 and time  0.1000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

   -4.8E+00 -1.3E+01 0.0E+00 0.0E+00 0.0E+00 -5.0E+02

   center of gravity and mean normal

    3.75E+01 0.0E+00 0.0E+00 3.4E-01 9.4E-01 0.0E+00

   moment about the center of gravity(mx,my,mz)

   0.0E+00 0.0E+00 0.0E+00

   area,  normal force (+ = tension) and shear force (size)

    2.2E-02 -1.419E+01 0.0E+00
"""


def test_printed_forces_are_read_with_their_signs():
    hub, forces = _printed(PRINTED.format(hub="-2.5E-05"), [0], 1)
    assert hub[0] == -2.5e-5
    assert forces[0][0].normal_force == 14.19
    assert forces[0][0].pinion_torque == 500.0
    assert forces[0][0].area == 0.022


def test_pair_that_is_apart_carries_no_force():
    block = PRINTED.format(hub="0.0E+00").replace("2.2E-02 -1.419E+01", "0.0E+00 0.0E+00").replace("3.75E+01", "NaN")
    _, forces = _printed(block, [0], 1)
    assert forces[0][0].normal_force == 0.0
    assert forces[0][0].pinion_torque == 0.0
    assert np.isnan(forces[0][0].centre).all()


def test_missing_step_is_refused():
    with pytest.raises(RuntimeError, match="1 of 2 steps"):
        _printed(PRINTED.format(hub="-2.5E-05"), [0], 2)


def test_step_that_stopped_too_early_is_refused(tmp_path):
    step = "\n STEP            1\n largest correction to disp= {}\n"
    _check_corrections(step.format("1.0e-9 in node 5"), tmp_path)
    with pytest.raises(UnsettledError, match=r"step 1 stopped at a correction of 0\.001"):
        _check_corrections(step.format("1.0e-3 in node 5"), tmp_path)


def test_results_without_pressure_are_refused(tmp_path):
    empty = tmp_path / "run.frd"
    empty.write_text("    2C\n -1         1 1.00000E+00 0.00000E+00 0.00000E+00\n -3\n")
    with pytest.raises(RuntimeError, match="no contact pressure"):
        _pressures(empty, 1)


def test_transmission_error_is_the_lag_of_the_wheel_and_of_the_pinion_still_to_turn():
    place = position("unmodified", 12, 0.010)
    built = plane_deck(place, line_load(100.0), COARSE)
    ratio = place.pinion.base_radius / place.pinion.bore_radius
    radius = np.linspace(37.4, 37.6, 15)
    angle = place.pinion_tooth() + place.pinion.half_angle(radius)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * radius], axis=-1)
    pressure = 800.0 * np.sqrt(1.0 - np.linspace(-0.99, 0.99, 15) ** 2)
    torque = built.hub_force * place.pinion.bore_radius
    force = ContactForce(14.19, torque, np.zeros(3), 0.02)
    run = Run(np.array([-4e-4, 2e-4]) / ratio, [{0: force}] * 2, points, np.stack([pressure] * 2), 1.0, 9)
    result = evaluate(place, built, run)
    assert result.transmission_error == pytest.approx(-10.2, rel=1e-9)
    assert result.mesh_stiffness == pytest.approx(0.04 * line_load(100.0) / 0.6, rel=1e-9)
    assert result.pairs[0].load_share == pytest.approx(1.0)
    assert result.pairs[0].pinion_radius + result.pairs[0].wheel_radius == pytest.approx(93.0, abs=0.01)
    assert result.pairs[0].corner == "no"


def test_table_returns_what_was_written(tmp_path):
    path = tmp_path / "table.csv"
    write_table(path, ["made here", "for a test"], [{"way": "fine", "share": 0.25}, {"way": "coarse", "share": 1.0}])
    assert path.read_text().startswith("# made here\n# for a test\nway,share\n")
    assert read_table(path) == [{"way": "fine", "share": 0.25}, {"way": "coarse", "share": 1.0}]
