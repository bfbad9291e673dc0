"""Where derivatives of load shares depend on the grid, and where load shares and peak pressures have a kink."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import parse_scene, read_scene
from loaded_tca import warning_kinds as kinds
from loaded_tca.errors import noted_accuracy_warnings
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.results.slope_limits import (
    usual_tolerance,
    warn_of_alike_peaks,
    warn_of_leaving_pairs,
    warn_of_share_grids,
)
from loaded_tca.warning_kinds import kind_of
from tests.samples.results import FLANKS_ALONE, SCENES, result
from validation.invariances import COARSE, Subject, analysed

IN_PLANE, CROWNING = "mounting.in_plane_deg", "pinion.modifications.lead_crowning_um"
AXIAL = "mounting.wheel_axial_mm"
ON_ARCS = """
[pair]
type = "cylindrical"
normal_module_mm = 1.0
helix_angle_deg = 0.0
pressure_angle_deg = 25.0
driving = "wheel"
sense = "negative"
[pinion]
teeth = 31
face_width_mm = 6.686
profile_shift = -0.053
side_rounding_mm = 0.127
[pinion.modifications]
lead_crowning_um = 2.25
tip_relief_um = 8.13
tip_relief_start_mm = 32.0
tip_relief_form = "linear"
twist_um = 2.39
profile_slope_um = -1.11
[wheel]
teeth = 45
face_width_mm = 6.686
profile_shift = -0.184
[wheel.modifications]
lead_crowning_um = 3.07
profile_crowning_um = 1.84
helix_slope_um = -0.54
profile_slope_um = 0.73
[mounting]
misalignment_um = 2.67
in_plane_deg = -0.0105
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 9.894
[analysis]
positions = 3
"""


def kinds_of(sentences):
    return [kind_of(sentence) for sentence in sentences]


def shares_by(key, cells):
    """Derivatives of the first position, what they depend on the grids by, and kinds of warnings; and the scene."""
    scene = parse_scene(ON_ARCS).with_changes({"analysis.cells": (cells, cells)})
    slopes = analysed(scene).sensitivities([key])
    with noted_accuracy_warnings(given=False) as sentences:
        shares = slopes.load_share[0, 0, :2, 0]
    return shares, slopes.load_share_by_grids[0, 0, :2, 0], kinds_of(sentences), scene


@pytest.mark.thorough
def test_what_derivatives_of_shares_are_off_by_on_coarse_grids_is_told_and_falls_with_the_cells():
    """Beside differences of analyses over 0.04 deg, which steps of a half of that change by 0.3 %."""
    (coarse, by_grids, told, scene), step = shares_by(IN_PLANE, 48), 0.02
    value = scene.mounting.in_plane_deg
    low, high = (analysed(scene.with_changes({IN_PLANE: value + by})).load_share[0, 0, :2] for by in (-step, step))
    off = np.abs(coarse - (high - low) / (2.0 * step)) / np.abs(coarse)
    assert (off > 0.05).all()
    assert (by_grids / np.abs(coarse) > off).all()
    assert kinds.SHARES_BY_GRIDS in told
    assert_allclose(by_grids[0], by_grids[1], rtol=1e-3)  # what one pair has more, the other one has less
    fine, by_fine_grids, told, _ = shares_by(IN_PLANE, 128)
    assert (by_fine_grids < 0.05 * np.abs(fine)).all()
    assert kinds.SHARES_BY_GRIDS not in told


def test_shares_depend_on_no_grids_that_stay():
    _, by_grids, told, _ = shares_by(CROWNING, 48)
    assert not by_grids.any()
    assert kinds.SHARES_BY_GRIDS not in told


def test_shares_follow_a_crowning_that_moves_contacts_of_bending_teeth_apart():
    """Each contact goes along the face its own way, while teeth and shaft bend below both: each grid moves by itself.

    Beside differences of analyses over 1 um, which those over 0.5 um differ from by 0.3 %; where each grid moved as if
    all moved alike, the derivative was 15 % off, on any cells.
    """
    subject, key = Subject.of(10318, {**COARSE, "positions": 2}), "wheel.modifications.profile_crowning_um"
    slopes = subject.result.sensitivities([key])
    value = subject.scene.wheel.modifications.profile_crowning_um
    low, high = (analysed(subject.scene.with_changes({key: value + by})).load_share[0, 0] for by in (-0.5, 0.5))
    assert_allclose(slopes.load_share[0, 0, :, 0], high - low, rtol=0.02)


def test_a_contact_with_the_same_pressure_at_both_ends_has_a_kink_by_a_tilt_and_none_by_a_crowning():
    """A straight pinion on a wider rack: in a mirror one end is the other one, and the tilt its negative."""
    slopes = Subject.of(10244).result.sensitivities([IN_PLANE, CROWNING])
    with noted_accuracy_warnings(given=False) as sentences:
        tilted, crowned = np.moveaxis(slopes.peak_pressure[0], -1, 0)
    (told,) = [sentence for sentence in sentences if kind_of(sentence) is kinds.PEAKS_ALIKE]
    assert f"({IN_PLANE}; 1 of 2 keys)" in told
    lacking, others = slopes._other_peaks
    known = np.isfinite(tilted)
    assert (lacking[0][known] < 1e-3).all()  # the solver's tolerance leaves 1e-5
    peaks = [one for one in slopes._rough_peaks if one is not None]
    assert_allclose([one.place[1] for one in others], [-one.place[1] for one in peaks], rtol=1e-6)
    there = np.moveaxis(slopes._of_peaks(others)[0], -1, 0)
    assert_allclose(there[0][known], -tilted[known], rtol=2e-3, atol=0.0)  # the other end cuts its last cell as much
    assert_allclose(there[1][known], crowned[known], rtol=2e-3, atol=0.0)


@pytest.mark.parametrize(
    ("lacking", "slope", "other", "count"),
    [
        (0.005, 10.0, -10.0, 1),
        (0.02, 10.0, -10.0, 0),  # 20 of 1000 MPa are not reached by 1 um
        (0.02, 10.0, -20.0, 1),
        (0.005, 10.0, 9.7, 0),  # the same to both sides
        (0.005, 0.01, -0.01, 0),  # next to nothing by 1 um
        (math.nan, 10.0, -10.0, 0),
    ],
)
def test_kinks_of_peak_pressures_are_told_where_a_usual_change_sees_them(lacking, slope, other, count):
    pressures = np.array([[[1000.0, math.nan]]])
    both = (np.array([[[[value], [math.nan]]]]) for value in (slope, other))
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_alike_peaks([CROWNING], pressures, np.array([[[lacking, math.nan]]]), *both)
    assert kinds_of(sentences) == [kinds.PEAKS_ALIKE] * count


@pytest.mark.parametrize(("slope", "by_grids", "count"), [(0.1, 6e-3, 1), (0.1, 4e-3, 0), (1e-9, 1e-9, 0)])
def test_shares_by_grids_are_told_beside_the_largest_derivative(slope, by_grids, count):
    shares, slopes = np.array([[[0.4, 0.6]]]), np.array([[[[-slope], [slope]]]])
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_share_grids([IN_PLANE], shares, slopes, np.full(slopes.shape, by_grids))
    assert kinds_of(sentences) == [kinds.SHARES_BY_GRIDS] * count


@pytest.mark.parametrize(("part", "count"), [(0.06, 1), (0.04, 0)])
def test_what_grids_change_of_shares_is_told_where_these_are_read(part, count, monkeypatch):
    slopes = result("mesh_cycle_helical", positions=2).sensitivities([IN_PLANE])
    with noted_accuracy_warnings(given=False):
        largest = np.nanmax(np.abs(slopes.load_share))
    vars(slopes).pop("load_share")
    by_grids = np.full((*slopes.result.load_share.shape, 1), part * largest)
    monkeypatch.setitem(vars(slopes), "load_share_by_grids", by_grids)
    with noted_accuracy_warnings(given=False) as sentences:
        assert np.isfinite(slopes.load_share).any()
    assert kinds_of(sentences).count(kinds.SHARES_BY_GRIDS) == count


def test_a_pair_that_loses_its_load_within_a_usual_change_is_told_with_the_change():
    """Beside analyses before and beyond, and over 0.01 mm, the usual change of a position."""
    usual = {"analysis.cells": (12, 16), "analysis.accuracy": None, "analysis.positions": 3}
    scene = read_scene(SCENES / "straight_bevel.toml").with_changes({**FLANKS_ALONE, **usual})
    scene = scene.with_changes({"analysis.torques_Nm": (3.0,)})
    slopes = analysed(scene).sensitivities([AXIAL, TORQUE])
    with noted_accuracy_warnings(given=False) as sentences:
        slope = slopes.load_share[0, 0, 1, 0]
    (told,) = [sentence for sentence in sentences if kind_of(sentence) is kinds.PAIR_LEAVES]
    assert f"({AXIAL}; 1 of 2 keys)" in told
    change, size = float(told.split("change by ")[1].split()[0]), float(told.split("at least ")[1].split("%")[0])
    value, share = scene.mounting.wheel_axial_mm, slopes.result.load_share[0, 0, 1]
    before, beyond, end = (
        analysed(scene.with_changes({AXIAL: value + by})).load_share[0, 0, 1]
        for by in (0.5 * change, 2.0 * change, 0.01)
    )
    assert share > before > 0.0
    assert beyond == 0.0
    assert_allclose((end - share) / 0.01 / slope, 1.0 - 0.01 * size, rtol=0.01)  # two digits are told


@pytest.mark.parametrize(
    ("key", "share", "slope", "count"),
    [
        (CROWNING, 0.01, 0.03, 1),
        (CROWNING, 0.01, -0.03, 1),
        (CROWNING, 0.029, 0.03, 0),  # the mean slope over 1 um is 3 % smaller
        (CROWNING, 0.04, 0.03, 0),
        (CROWNING, 0.0, 0.03, 0),  # no load that it could lose
        (CROWNING, 0.01, math.nan, 0),
        (CROWNING, 1e-6, 2e-6, 0),  # next to nothing by 1 um
        (IN_PLANE, 0.01, 3.0, 1),  # by 0.01 deg
        (IN_PLANE, 0.01, 0.03, 0),
        (TORQUE, 0.01, 0.03, 0),
    ],
)
def test_pairs_that_lose_their_load_are_told_where_a_usual_change_sees_it(key, share, slope, count):
    shares, slopes = np.array([[[share, 1.0 - share, math.nan]]]), np.array([[[[slope], [-slope], [math.nan]]]])
    with noted_accuracy_warnings(given=False) as sentences:
        warn_of_leaving_pairs([key], shares, slopes)
    assert kinds_of(sentences) == [kinds.PAIR_LEAVES] * count


@pytest.mark.parametrize(
    ("key", "usual"),
    [(CROWNING, 1.0), (IN_PLANE, 0.01), ("wheel.modifications.end_relief_length_mm", 0.1), ("pair.ratio", 1.0)],
)
def test_usual_tolerances_follow_the_unit_of_a_key(key, usual):
    assert usual_tolerance(key) == usual
