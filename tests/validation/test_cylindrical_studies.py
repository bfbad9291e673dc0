"""The studies of cylindrical pairs: draws as stated, forms of equal curvature, statements and numbers of the source."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.unloaded import trace_contact
from loaded_tca.unloaded.teeth import trace_teeth
from validation.unloaded.convergence_from_random_starts import STATED, cases, stated_table
from validation.unloaded.helical_trends import equally_curved, trends_of_forms, trends_of_helical_pressure
from validation.unloaded.mounting_error_figures import areas, lines, stress_ratios, unmodified_pressure
from validation.unloaded.mounting_error_map import error_map
from validation.unloaded.mounting_error_pairs import FORMS, HELICAL, SPUR, hertz_pressure
from validation.unloaded.mounting_error_trends import Trend, verdicts
from validation.unloaded.random_starts import SPREADS, Draw, conventional
from validation.unloaded.reduced_tca_tables import TURN
from validation.unloaded.spur_trends import trends_of_spur_pressure, trends_without_relief

STEP = 0.01  # mm; of the differences in the middle of the face
SAME_CURVATURE = 1e-4  # of those differences: the fourth derivatives of the circle and of the logarithm

# The dissertation's crownings are as thick as a tooth.
pytestmark = pytest.mark.filterwarnings("ignore:.*is more than 1 mm:loaded_tca.errors.AccuracyWarning")


def judged(trends, words):
    """The one statement with these words."""
    (found,) = [trend for trend in trends if words in trend.statement]
    return found


# Draws


@pytest.fixture(scope="module")
def spur():
    return cases(200)[1]


@pytest.mark.parametrize("how", [Draw("band", -0.1, 0.6, True), Draw("point", 0.4, 0.4, True), *SPREADS])
def test_wheel_angle_is_drawn_between_its_limits_about_the_answer(spur, how):
    away = spur.draw(how)[:, 4] - spur.contact.wheel_angle
    span = how.high - how.low
    assert_allclose([away.min(), away.max()], [how.low, how.high], atol=0.02 * span + 1e-12)  # 200 draws
    assert_allclose(
        spur.draw(how.mirrored)[:, 4].mean(), spur.contact.wheel_angle - away.mean(), atol=0.1 * span + 1e-12
    )


def test_stated_draws_start_in_the_middle_of_the_wheel_flank_and_anywhere_on_the_pinion(spur):
    starts = spur.draw(Draw("point", 0.4, 0.4, True))
    rho, z = spur.pair.wheel.flank.grid(2, 2)
    assert_allclose(starts[:, 2:4], np.broadcast_to([rho.mean(), z.mean()], (200, 2)), atol=1e-9)
    assert_allclose(starts[:, :2], spur.unit_starts[:, :2])
    assert np.ptp(spur.draw(SPREADS[0])[:, 2]) > 1.0


def test_share_falls_from_all_to_few_with_the_distance_of_the_wheel_angle(spur):
    shares = [conventional(spur, Draw("", away, away, True), "y, z").percentage for away in (0.2, 0.4, 0.5)]
    assert shares[0] == 100.0
    assert shares[1] < 50.0
    assert shares[2] == 0.0


@pytest.mark.thorough
def test_every_stated_draw_stands_in_the_table_beside_the_printed_share(monkeypatch):
    monkeypatch.setattr("validation.unloaded.convergence_from_random_starts.STATED_STARTS", 20)
    found = [[cell.strip() for cell in line.strip("|").split("|")] for line in stated_table()]
    stated = [[name, str(how), f"{printed:g}"] for name, part in STATED.items() for how, printed in part]
    assert [line[:3] for line in found] == stated
    assert all(0.0 <= float(cell) <= 100.0 for line in found for cell in line[3:])
    assert all(line[3:] == ["100.0"] * 4 for line in found if line[0].startswith("helical") and "rad" in line[1])


# Forms of lead crowning


@pytest.mark.parametrize("form", FORMS)
def test_equally_curved_forms_remove_the_same_next_to_the_middle_of_the_face(form):
    parabola, half = 0.51, 0.5 * HELICAL.face_width
    flank = HELICAL.pair(
        lead_crowning=equally_curved(form, parabola, HELICAL.face_width), lead_crowning_form=form
    ).pinion.flank
    removed = flank.removal(np.full(2, 20.6), np.array([0.0, STEP])).value
    assert_allclose(removed[1] - removed[0], parabola * (STEP / half) ** 2, rtol=SAME_CURVATURE)


@pytest.mark.thorough
def test_forms_move_the_path_alike_only_if_they_are_equally_curved():
    found = trends_of_forms()
    assert judged(found, "similar paths, if they are equally curved").holds
    assert not judged(found, "similar paths, if they remove the same").holds
    assert not judged(found, "circle is nearer to the middle").holds
    assert judged(found, "logarithmic path is noticeably farther").holds


@pytest.mark.thorough
def test_logarithmic_crowning_has_no_higher_pressure_at_the_largest_angle():
    found = trends_of_helical_pressure()
    assert not judged(found, "logarithmic crowning has a significantly higher pressure").holds
    assert judged(found, "falls as the angle grows").holds
    assert not judged(found, "lowest with the parabola at 0.05").holds
    mounting = Mounting(out_of_plane=math.radians(0.2))
    pressures = []
    for form in ("logarithmic", "parabolic"):
        pair = HELICAL.pair(mounting, lead_crowning_form=form)
        pressures.append(hertz_pressure(pair, trace_teeth(pair, [0.0]).leading_contact[0], HELICAL.load))
    assert pressures[0] < 0.8 * pressures[1]


# The spur pair


@pytest.mark.thorough
def test_no_lead_parabola_makes_the_motion_of_the_spur_pair_continuous():
    found = trends_without_relief()
    assert [trend.figure for trend in found] == ["10", "11", "15", "16"]
    assert [trend.holds for trend in found] == [True, True, True, False]


def test_pressure_of_the_spur_pair_rises_towards_top_and_bottom_with_and_without_relief():
    plain, relieved = trends_of_spur_pressure()
    assert plain.holds
    assert relieved.holds
    assert plain.because != relieved.because


@pytest.mark.thorough
def test_offset_across_the_line_of_centres_turns_the_wheel_and_leaves_the_motion_even():
    pair = SPUR.pair()
    across = np.array([0.0, 0.2, 0.0])
    meshes = [trace_teeth(replace(pair, wheel_origin=pair.wheel_origin + sign * across)) for sign in (1.0, -1.0)]
    assert all(mesh.is_continuous for mesh in meshes)
    assert max(mesh.peak_to_peak for mesh in meshes) < 1e-12  # rad; conjugate, angles of order 0.1
    turn = math.atan2(0.2, pair.wheel_origin[0])  # of the line of centres: both gears see it, z1 = z2
    assert_allclose(0.5 * (meshes[1].mean - meshes[0].mean), 2.0 * turn, rtol=1e-6)


# Two errors together


def test_map_whose_contacts_climb_together_has_those_of_the_search_of_a_pair_alone():
    errors = error_map(3)
    pair = HELICAL.pair(Mounting(errors.in_plane[2]), lead_crowning=0.005, profile_crowning=0.005)
    contact, angles = trace_contact(pair, [0.0])[0], np.linspace(0.0, 1.0, 41) * pair.pitch
    searched = contact.pinion_axial, hertz_pressure(pair, contact, HELICAL.load)
    assert_allclose([errors.shift[2, 1], errors.pressure[2, 1]], searched, rtol=1e-6)  # both climb to their tolerance
    peak_to_peak = math.degrees(3600.0 * trace_teeth(pair, angles).peak_to_peak)
    assert_allclose(errors.peak_to_peak[2, 1], peak_to_peak, rtol=0.02)  # 21 positions, splines over kinks


# Printed numbers


def test_areas_of_one_figure_are_those_of_a_straight_line_whatever_the_form():
    found = areas()
    assert [one.figure for one in found] == ["24"] * 3 + ["26"] * 3
    for part in (found[:3], found[3:]):
        assert np.ptp([one.computed for one in part]) < 1e-3 * part[0].computed  # the line is straight to first order
        assert np.ptp([one.printed for one in part]) > 0.02 * part[0].printed
    # slopes that were computed twice independently [arcsec/rad], at 0.1 deg, doubled; over the turn of Tables 3 and 4
    for one, slope in ((found[0], 31.866), (found[3], 84.768)):
        assert_allclose(one.computed, 0.5 * 2.0 * slope * TURN * math.degrees(TURN), rtol=0.01)


def test_pressure_of_the_unmodified_pair_is_that_of_a_line_over_the_face():
    mesh = HELICAL.mesh
    alpha, base_helix = mesh.working_pressure_angle, mesh.pinion.base_helix_angle
    radii = mesh.pinion_working_radius, mesh.wheel_working_radius
    curvature = math.cos(base_helix) * sum(1.0 / (radius * math.sin(alpha)) for radius in radii)
    length = HELICAL.face_width / math.cos(base_helix)
    modulus = 206e3 / (2.0 * (1.0 - 0.3**2))
    expected = math.sqrt(HELICAL.load * curvature * modulus / (math.pi * length))
    assert_allclose(unmodified_pressure(), expected, rtol=1e-6)


@pytest.mark.thorough
def test_stress_ratios_fall_with_the_angle_at_half_the_printed_size():
    found = stress_ratios()
    parabolic = [one.computed for one in found if "parabolic" in one.quantity]
    assert parabolic == sorted(parabolic, reverse=True)
    assert all(0.45 < one.computed / one.printed < 0.52 for one in found)
    assert len(lines()) == len(areas()) + len(found)


def test_verdicts_are_lines_of_a_table():
    held, fallen = verdicts([Trend("1", "a", holds=True, because="b"), Trend("2", "c", holds=False, because="d")])
    assert held == "| 1 | a | holds | b |"
    assert fallen == "| 2 | c | **does not hold** | d |"
