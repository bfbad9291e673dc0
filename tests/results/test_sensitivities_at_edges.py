"""Sensitivities of contacts that end at edges: against numbers of whole analyses on either side."""

import re
import warnings
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import analyse, read_scene
from loaded_tca import warning_kinds as kinds
from loaded_tca.edges.free import edge_compliance
from loaded_tca.errors import AccuracyWarning, noted_accuracy_warnings
from loaded_tca.results import gap_growth
from loaded_tca.results.face_slopes import rival_strip, top_strips, warn_of_edges, warn_of_strips_beside
from loaded_tca.results.load_factors import STRIPS, face_forces
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.separation.pair_change import value_at
from loaded_tca.warning_kinds import kind_of
from tests.samples.results import FLANKS_ALONE, SCENES
from validation.random_scenes import random_scene

DISTANCE, RELIEF = "mounting.centre_distance_error_mm", "pinion.modifications.tip_relief_um"
CROWNING, OFFSET = "pinion.modifications.lead_crowning_um", "mounting.axial_offset_mm"
MICROMETRES = 1e3
START = 177.0
"""Of a relief at the tip of the wheel of 57 teeth [mm]."""


@cache
def solved(name, cells, positions, **changes):
    """An analysis, and what a radian is at the wheel's base circle [um]."""
    wanted = {"analysis.cells": (cells, cells), "analysis.positions": positions, "analysis.torques_Nm": (130.0,)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # contacts on edges are wanted
        result = analyse(read_scene(SCENES / f"{name}.toml").with_changes(wanted | changes))
    return result, MICROMETRES * result.gear_pair.base_radii[1]


def test_spur_teeth_that_bend_and_centre_distance_as_by_whole_analyses():
    result, length = solved("mesh_cycle_spur", 32, 3, **{"analysis.free_edges": False})
    found = result.sensitivities([DISTANCE])
    # differences over 0.04 mm; over 0.08 mm they differ by up to 0.0003
    assert_allclose(found.transmission_error[0, :2, 0] * length, [-342.4787, -342.6964], rtol=0, atol=1e-3)
    assert_allclose(found.peak_to_peak[0, 0] * length, 0.2177, rtol=0.01)
    assert_allclose(found.face_load_factor[0, 0], -0.0467, rtol=0.02)


def test_helical_flanks_and_centre_distance_as_by_whole_analyses():
    result, length = solved("helical", 64, 5, **FLANKS_ALONE)
    found = result.sensitivities([DISTANCE])
    differences = [-352.5957, -352.9221, -353.7757, -353.1195]  # over 0.04 mm
    told = found.transmission_error[0, :-1, 0] * length
    # analyses place their boxes anew, by which they differ by 0.02 um/mm from position to position
    assert_allclose(told, differences, rtol=0, atol=0.03)
    assert_allclose(told.mean(), np.mean(differences), rtol=0, atol=0.01)
    assert_allclose(found.peak_to_peak[0, 0] * length, 1.180, rtol=0.02)
    assert_allclose(found.harmonics(1)[0, 0, 0] * length, 0.5758, rtol=0.02)
    assert_allclose(found.face_load_factor[0, 0], 0.323, rtol=0.02)  # 0.3255, over 0.08 mm 0.3207


def test_lines_beside_free_edges_go_with_contacts_that_a_modification_moves(monkeypatch):
    key, step = "pinion.modifications.profile_crowning_um", 1e-3
    result, _ = solved("helical", 16, 3, **{"analysis.compliance": "contact"})
    found = result.sensitivities([key])
    monkeypatch.setattr(gap_growth, "_add_moved_lines", lambda *_, **__: None)
    more = (found.growth.gaps - result.sensitivities([key]).growth.gaps)[0]
    expected = []
    for grid, shift in zip(found.tangents.grids, found.growth.shifts[0], strict=True):
        low, high = (
            edge_compliance(
                result.gear_pair,
                replace(
                    grid.separation, origin=grid.separation.origin + part * step * shift[0] * grid.separation.axes[0]
                ),
            )
            for part in (-0.5, 0.5)
        )
        deflections = ((high - low) @ grid.slice_force) / step
        expected.append(deflections[grid.active.nonzero()[1]])
    off = np.abs(more - np.concatenate(expected)).max() / np.abs(more).max()
    # on its way under load the contact moves a little more
    assert off < 0.02


def test_ends_of_the_common_face_move_with_the_wheel():
    """Faces of one width, the wheel's offset by 1 mm: one end is the wheel's, and the common face is shorter.

    Beside differences of analyses over 0.2 mm, on grids as coarse: how the end cuts their few slices is in both.
    """
    key, tilt = "mounting.axial_offset_mm", {"mounting.misalignment_um": 20.0}
    result, length = solved("helical", 32, 5, **FLANKS_ALONE, **tilt, **{key: 1.0})
    found = result.sensitivities([key])
    low, high = (solved("helical", 32, 5, **FLANKS_ALONE, **tilt, **{key: 1.0 + by})[0] for by in (-0.1, 0.1))
    face = (high.face_load_factor[0] - low.face_load_factor[0]) / 0.2
    span = (np.ptp(high.transmission_error[0]) - np.ptp(low.transmission_error[0])) / 0.2
    assert_allclose(found.face_load_factor[0, 0], face, rtol=0.02)
    assert_allclose(found.peak_to_peak[0, 0] * length, span * length, rtol=0.02)


def test_derivatives_at_cut_slices_are_warned_of_with_keys_that_change_the_gears_alone():
    result, _ = solved("helical", 16, 3, **FLANKS_ALONE, **{"analysis.accuracy": None})
    found, quiet = result.sensitivities([DISTANCE, CROWNING]), result.sensitivities([TORQUE])
    for marks, figure, reason in (
        (found.on_cut_slices, "line_load", "an edge of a flank cuts the slices with the largest line load"),
        (found.at_corners, "peak_pressure", "an edge of a flank cuts the slices with the peak pressure"),
    ):
        assert marks.any()
        assert not marks[~(result.on_edge > 0)].any(), "no edge cuts what reaches none"
        with pytest.warns(AccuracyWarning, match=rf"{reason}.* \(at {marks.sum()} of"):
            assert np.isfinite(getattr(found, figure)).any()
        with noted_accuracy_warnings() as sentences:
            assert np.isfinite(getattr(quiet, figure)).any()
        assert sentences == []


def test_starts_of_linear_reliefs_beside_the_point_are_warned_of_with_keys_that_move_them():
    form = {"tip_relief_form": "linear", "tip_relief_um": 5.0, "tip_relief_start_mm": 106.0}
    linear = {f"pinion.modifications.{name}": value for name, value in form.items()}
    result, _ = solved("mesh_cycle_helical", 16, 3, **FLANKS_ALONE, **linear, **{"analysis.accuracy": None})
    with noted_accuracy_warnings() as sentences:
        held = result.sensitivities([RELIEF])
    assert sentences == []
    with pytest.warns(AccuracyWarning, match="a linear relief starts within the contact, beside"):
        moved = result.sensitivities([DISTANCE])
    assert moved.across_relief_starts.any()
    assert_array_equal(moved.across_relief_starts, held.across_relief_starts)
    assert not moved.across_relief_starts[~(result.on_relief_start > 0)].any()


def test_peaks_beside_jumps_of_the_curvature_are_warned_of_where_they_are_read():
    result, _ = solved("mesh_cycle_helical", 16, 3, **FLANKS_ALONE, **{"analysis.accuracy": None})
    slopes = result.sensitivities([DISTANCE])
    vars(slopes)["beside_curvature_jumps"] = result.load_share > 0.0
    with noted_accuracy_warnings(given=False) as sentences:
        assert np.isfinite(slopes.peak_pressure).any()
    assert any("curvature of the gap jumps beside the peak pressure" in sentence for sentence in sentences)


def test_derivatives_of_the_strip_at_an_end_that_moves_are_warned_of():
    askew = {"mounting.misalignment_um": 10.0, "analysis.accuracy": None}
    for offset, count in ((-2.6, 1), (2.6, 0)):
        result, _ = solved("mesh_cycle_helical", 12, 3, **FLANKS_ALONE, **askew | {"mounting.axial_offset_mm": offset})
        with noted_accuracy_warnings(given=False) as sentences:
            slopes = result.sensitivities(["mounting.axial_offset_mm", CROWNING]).face_load_factor
        assert np.isfinite(slopes).all()
        told = [sentence for sentence in sentences if kind_of(sentence) is kinds.FACE_END_IN_LOAD]
        assert len(told) == count
        assert all("(mounting.axial_offset_mm; 1 of 2 keys)" in sentence for sentence in told)


@pytest.mark.parametrize(("radius", "crowning", "count"), [(0.2, 3.0, 1), (0.0, 3.0, 0), (0.2, 40.0, 0)])
def test_derivatives_of_the_strip_beside_a_rounded_end_are_warned_of(radius, crowning, count):
    """With little crowning the load reaches the ends, where cells tell how far; with much it ends before them."""
    ends = {f"{gear}.side_rounding_mm": radius for gear in ("pinion", "wheel")}
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes(
        FLANKS_ALONE
        | ends
        | {CROWNING: crowning, "mounting.misalignment_um": 10.0, "analysis.positions": 3, "analysis.accuracy": None}
        | {"analysis.cells": (16, 64)}
    )
    with noted_accuracy_warnings(given=False) as sentences:
        slopes = analyse(scene).sensitivities([CROWNING]).face_load_factor
    assert np.isfinite(slopes).all()
    assert sum(kind_of(sentence) is kinds.ARC_IN_LOAD for sentence in sentences) == count


@pytest.mark.parametrize(("key", "step"), [("wheel.modifications.tip_relief_start_mm", 0.01), (DISTANCE, 0.02)])
def test_contact_points_on_the_start_of_a_linear_relief_move_as_by_whole_analyses(key, step):
    """Beyond the start the flank has another slope: both sides of it at once give 30 times the derivative."""
    form = {"tip_relief_form": "linear", "tip_relief_um": 16.0, "tip_relief_start_mm": START}
    relief = {f"wheel.modifications.{name}": value for name, value in form.items()}
    result, length = solved("mesh_cycle_helical", 64, 5, **FLANKS_ALONE, **relief)
    assert any(grid.contact.on_relief_start for state in result.states[1][0].grids for grid in state)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # starts beside contact points
        found = result.sensitivities([key]).transmission_error[0, :, 0]
    value = START if key.endswith("start_mm") else 0.0
    low, high = (
        solved("mesh_cycle_helical", 64, 5, **FLANKS_ALONE, **relief | {key: value + by})[0].transmission_error[0]
        for by in (-step, step)
    )
    slopes = (high - low) / (2.0 * step)
    # as starts run through the cells: of 40 to 128 cells derivatives at the start are 0.80 to 0.85 um/mm, without a
    # trend, and on 48 cells analyses are 0.03 off to the other side; the slope at that point was off by 3 and by 13
    assert_allclose(found * length, slopes * length, rtol=0, atol=0.05)


@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts on edges are wanted
def test_contacts_on_a_relief_start_that_an_edge_cuts_follow_the_start_and_leave_the_edge():
    """The grid goes with the start: the tips and face ends that cut its cells, and free them, move in it."""
    key = "wheel.modifications.tip_relief_start_mm"
    scene = random_scene(13, compliance="contact", positions=2, cells=(32, 64), accuracy=None)
    result, value = analyse(scene), value_at(scene, key)
    held = [grid for grid in result.states[1][0].grids[0] if grid.contact.on_relief_start]
    assert any((grid.separation.cover < 1.0)[grid.pressure > 0.0].any() for grid in held)
    low, high = (analyse(scene.with_changes({key: value + by})).transmission_error[0] for by in (-0.02, 0.02))
    length = MICROMETRES * result.gear_pair.base_radii[1]
    told = result.sensitivities([key]).transmission_error[0, :, 0] * length
    # 0.22, by analyses 0.245
    assert_allclose(told, (high - low) / 0.04 * length, rtol=0, atol=0.1)


def test_contacts_between_two_face_ends_stay_where_they_are_though_their_point_moves_far():
    """Slight crowning: by a hundredth of a degree the point moves across the face, the contact by nothing."""
    key, changes = "mounting.out_of_plane_deg", {CROWNING: 2.0, "mounting.misalignment_um": -3.0}
    result, length = solved("mesh_cycle_spur", 48, 3, **changes)
    low, high = (
        solved("mesh_cycle_spur", 48, 3, **changes, **{key: by})[0].transmission_error[0] for by in (-4e-3, 4e-3)
    )
    told = result.sensitivities([key]).transmission_error[0, :, 0] * length
    # -3.5, -1.1, -3.5 um/deg; with grids that go half with the point -2.8, -2.3, -2.7
    assert_allclose(told, (high - low) / 8e-3 * length, rtol=0, atol=0.6)


@pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # contacts on edges are wanted
@pytest.mark.parametrize(
    ("seed", "compliance", "cells", "position", "pair", "step", "allowed"),
    [
        # at the start of a parabolic relief the curvature jumps, and the peak goes with it: 0.6 of the slope before
        (15, "contact", (32, 64), 1, 1, 2e-3, 0.1),
        # a corner of 0.7 mm, shorter than the length of the average: 1.6 times before; analyses place grids anew, by
        # which peaks jump by 0.2 MPa: by 1e-3 mm that is half of the slope, by 5e-4, 2e-3 and 4e-3 it is in none
        pytest.param(13, "contact+tooth", (48, 96), 3, 0, 2e-3, 0.02, marks=pytest.mark.thorough),
    ],
)
def test_peaks_follow_relief_starts_and_the_length_of_contacts(seed, compliance, cells, position, pair, step, allowed):
    scene = random_scene(seed, compliance=compliance, positions=5, cells=cells, accuracy=None)
    told = analyse(scene).sensitivities([DISTANCE]).peak_pressure[0, position, pair, 0]
    low, high = (analyse(scene.with_changes({DISTANCE: by})).peak_pressure[0, position, pair] for by in (-step, step))
    assert_allclose(told, (high - low) / (2.0 * step), rtol=allowed)


def test_a_strip_that_carries_as_much_is_a_kink_of_the_face_load_factor():
    """An aligned pair: K_Hbeta rises with the misalignment to either side."""
    result, _ = solved("mesh_cycle_spur", 32, 3, **FLANKS_ALONE)
    strip, lacking = rival_strip(result.gear_pair, result.path, result.maps[0])
    assert strip in (STRIPS // 2 - 1, STRIPS // 2)
    assert lacking < 1e-6
    with pytest.warns(AccuracyWarning, match="another strip of the face carries nearly the largest load"):
        (slope,) = result.sensitivities(["mounting.misalignment_um"]).face_load_factor[0]
    low, high = (
        solved("mesh_cycle_spur", 32, 3, **FLANKS_ALONE, **{"mounting.misalignment_um": by})[0] for by in (-4.0, 4.0)
    )
    forces = [face_forces(one.gear_pair, one.path, one.maps[0])[1] for one in (low, high)]
    factors = [force[strip] / force.mean() for force in forces]
    assert_allclose(abs(slope), abs(factors[1] - factors[0]) / 8.0, rtol=0.05)  # over 4 um


def test_derivatives_of_one_strip_are_told_beside_those_through_three(monkeypatch):
    """A parabola of three strips, 1 - (x - 0.3)^2/50, that moves by one strip: its top stays as high as it is."""
    strips = np.arange(-1.0, 2.0)
    forces = np.full(STRIPS, 0.5)
    forces[9:12] = 1.0 - (strips - 0.3) ** 2 / 50.0
    monkeypatch.setattr("loaded_tca.results.face_slopes.face_forces", lambda *_, **__: (None, forces))
    result = SimpleNamespace(torque=np.ones(1), maps=[None], gear_pair=None, path=None)
    rows = top_strips(result)
    assert [strip for strip, _ in rows] == [[9], [10], [11]]
    slopes = (strips - 0.3) / 25.0
    through = sum(part * slope for (_, part), slope in zip(rows, slopes, strict=True))
    assert_allclose(through, 0.0, atol=1e-12)  # three products of slopes of 0.1
    words = r"by -0\.012 per mm, while .* derivative is \S+ \(second_mm; 1 of 2 keys\)"
    with pytest.warns(AccuracyWarning, match=words):
        warn_of_strips_beside(["first_mm", "second_mm"], np.array([[1.0, slopes[1]]]), np.array([[1.05, through[0]]]))
    forces[0] = 2.0
    assert [part[0] for _, part in top_strips(result)] == [1.0, 0.0, 0.0]  # at an end of the face there is none beside


@pytest.mark.parametrize(
    ("place", "force", "rival"), [(20, 0.995, 20), (20, 0.98, None), (6, 0.9996, 6), (6, 0.995, None)]
)
def test_a_strip_counts_as_a_rival_where_it_carries_as_much(place, force, rival, monkeypatch):
    """Within 1 % if it is a maximum of its own, but for 0.05 % where it lies beside the largest one."""
    forces = 0.5 * np.exp(-np.abs(np.arange(STRIPS) - 5.0))
    forces[[5, place]] = 1.0, force
    monkeypatch.setattr("loaded_tca.results.face_slopes.face_forces", lambda *_, **__: (None, forces))
    found = rival_strip(None, None, None)
    assert (found and found[0]) == rival
    assert rival is None or found[1] == pytest.approx(1.0 - force)


@pytest.mark.parametrize(("spread", "count"), [(1.0, 1), (0.0, 0)])
def test_kinks_are_told_by_their_part_of_what_changes_over_the_positions(spread, count):
    """Derivatives of 100 at both positions: a kink of 0.2 matters to the peak to peak where they differ by 1."""
    slopes, kinks = np.array([[[100.0], [100.0 + spread]]]), np.array([[[0.2], [0.0]]])
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_edges([OFFSET], slopes, kinks, 1.0)
    assert len(sentences) == count


def test_ends_of_faces_of_one_width_are_a_kink_of_the_transmission_error_and_of_the_face_load_factor():
    """By growing values the wheel tilts by more over the shorter common face, by falling ones it ends the contact.

    Beside analyses over 0.1 mm, by which the end moves a quarter of its cell: by steps of 0.03 to 0.2 mm kinks of the
    transmission error differ by a sixth, and those of K_Hbeta by 0.15.
    """
    at = {"mounting.misalignment_um": 20.0, **FLANKS_ALONE}
    result, length = solved("helical", 32, 3, **at)
    found = result.sensitivities([OFFSET, CROWNING])
    with pytest.warns(AccuracyWarning, match=rf"edges of both gears lie .* um per mm .*{OFFSET}; 1 of 2 keys"):
        slopes = found.transmission_error[0, :, 0]
    with pytest.warns(AccuracyWarning, match=rf"faces of both gears end .*-0\.\d+ per mm .*{OFFSET}; 1 of 2 keys"):
        factor = found.face_load_factor[0, 0]
    low, high = (solved("helical", 32, 3, **at, **{OFFSET: by})[0] for by in (-0.1, 0.1))
    errors, factors = (
        [getattr(one, name)[0] for one in (low, result, high)] for name in ("transmission_error", "face_load_factor")
    )
    kinks = found.transmission_error_kinks[0]
    assert_allclose(kinks[[0, 2], 0], np.diff(errors, 2, axis=0)[0, [0, 2]] / 0.1, rtol=0.15)
    middle = (errors[2] - errors[0]) / 0.2 * length
    assert_allclose(slopes * length, middle, rtol=0, atol=0.15 * kinks.max() * length)
    assert_allclose(factor, (factors[2] - factors[0]) / 0.2, rtol=0, atol=0.2)
    assert_allclose(found.face_load_factor_kinks[0], [np.diff(factors, 2)[0] / 0.1, 0.0], rtol=0, atol=0.2)
    assert not kinks[:, 1].any(), "crowning moves neither end"


def test_aligned_faces_of_one_width_are_a_kink_without_a_slope():
    """The pair is its own mirror image: by either sign of the offset it is as much softer.

    Kinks beside analyses over 0.05 mm, by which those over 0.02 mm differ by a tenth.
    """
    result, length = solved("mesh_cycle_spur", 32, 3)
    found = result.sensitivities([OFFSET])
    with pytest.warns(AccuracyWarning, match="edges of both gears lie"):
        assert_allclose(found.transmission_error[0] * length, 0.0, rtol=0, atol=1e-3)
    high, _ = solved("mesh_cycle_spur", 32, 3, **{OFFSET: 0.05})
    kinks = 2.0 * (high.transmission_error[0] - result.transmission_error[0]) / 0.05
    assert_allclose(found.transmission_error_kinks[0, 1, 0], kinks[1], rtol=0.25)


def test_faces_that_end_apart_have_no_kink():
    at = {"mounting.misalignment_um": 20.0, OFFSET: 1.0}
    result, _ = solved("helical", 16, 3, **FLANKS_ALONE, **at)
    found = result.sensitivities([OFFSET])
    assert found.growth.kinks is None
    with noted_accuracy_warnings(given=False) as sentences:
        assert np.isfinite([found.transmission_error[0].max(), found.face_load_factor[0, 0]]).all()
    assert not any("at one place" in one for one in sentences)


def test_kinks_are_told_beside_a_torque_that_loads_nothing():
    at = {"mounting.misalignment_um": 20.0, "analysis.torques_Nm": (0.0, 130.0)}
    result, _ = solved("helical", 16, 3, **FLANKS_ALONE, **at)
    with pytest.warns(AccuracyWarning, match="edges of both gears lie") as caught:
        slopes = result.sensitivities([OFFSET]).transmission_error
    assert [one.category for one in caught] == [AccuracyWarning]
    assert np.isnan(slopes[0]).all()
    assert np.isfinite(slopes[1]).all()


def test_what_grids_change_of_derivatives_falls_with_the_cells_that_edges_cut():
    coarse, fine = (solved("helical", cells, 3, **FLANKS_ALONE) for cells in (16, 48))
    sizes = []
    for result, length in (coarse, fine):
        found = result.sensitivities([DISTANCE, CROWNING])
        assert not found.transmission_error_by_grids[..., 1].any(), "grids stay"
        sizes.append(found.transmission_error_by_grids[..., 0].max() * length)
    assert 1e-3 < sizes[1] < 0.5 * sizes[0] < 0.02  # um/mm


def test_grids_change_no_derivative_of_a_contact_that_reaches_no_edge():
    result, _ = solved("spiral_bevel", 16, 3, **FLANKS_ALONE, **{"analysis.torques_Nm": (2.0,)})
    found = result.sensitivities(["mounting.pinion_axial_mm"])
    assert found.transmission_error_by_grids.max() < 1e-3 * np.ptp(found.transmission_error)


@pytest.mark.parametrize(("part", "count"), [(0.06, 1), (0.04, 0)])
def test_what_grids_change_is_told_beside_what_derivatives_differ_by_over_the_positions(part, count, monkeypatch):
    result, _ = solved("helical", 16, 3, **FLANKS_ALONE)
    found = result.sensitivities([DISTANCE])
    spread = np.ptp(found.transmission_error[0, :, 0])
    monkeypatch.setitem(found.__dict__, "transmission_error_by_grids", np.full((1, 3, 1), part * spread))
    with noted_accuracy_warnings(given=False) as sentences:
        assert np.isfinite(found.peak_to_peak[0, 0])
    told = "derivatives of the transmission error depend on the grid by up to .* um per mm, more than 5%"
    assert sum(re.match(told, one) is not None for one in sentences) == count


@pytest.mark.parametrize(("cap", "few", "told"), [(550.0, 200, 1), (550.0, 5, 0), (1e5, 200, 0)])
def test_contacts_with_few_cells_below_the_cap_are_told(cap, few, told, monkeypatch):
    """Of a larger cap none is at it; the middle case has more cells below it than are few."""
    monkeypatch.setattr("loaded_tca.results.sensitivities.FEW", few)
    result, _ = solved("helical", 16, 2, **{"material.max_pressure_MPa": cap, **FLANKS_ALONE})
    with noted_accuracy_warnings(given=False) as sentences:
        found = result.sensitivities([DISTANCE])
        result.sensitivities([TORQUE])
    assert sum("cells of a contact below it" in one for one in sentences) == told
    assert found.nearly_plastic.any() == bool(told)
