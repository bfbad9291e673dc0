"""Derivatives of figures by the forces of cells: against differences of the figures, scaling, known places."""

import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.contact import patch, solve_contact
from loaded_tca.errors import InputError
from loaded_tca.flanks import FlankModifications
from loaded_tca.loaded import line_load
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.results.face_slopes import face_load_factor_slopes
from loaded_tca.results.figure_slopes import (
    _curvature_jumps,
    line_load_slopes,
    peak_pressure_slopes,
    pressure_norm,
    smooth_peak_slopes,
)
from loaded_tca.results.load_factors import load_factors
from loaded_tca.results.slice_pressure import _relative_slopes, largest_slice_pressures
from loaded_tca.scene import read_scene
from loaded_tca.separation import sample_separation
from loaded_tca.separation.box import Box
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import trace_contact
from tests.samples.gear_pairs import gear_pair
from tests.samples.results import SCENES, result

STEP = 1e-6
"""Relative change of the pressures of a difference: small enough for the cells of a fit to stay the same."""
DIFFERENCES = 1e-8
"""Error of central differences of that step by rounding, of the sum of the sizes of what is added up."""
ROUNDED = 4.0 * np.finfo(float).eps / STEP
"""The same of the figure: it is known to some last digits on either side."""
ROUNDING = 1e-12  # sums over some hundred cells
SPACING = (0.013, 0.21)  # mm


def assert_changes(figure, slopes, pressure, area):
    """A figure of pressures changes as its slopes say, whatever part each cell under pressure gains or loses."""
    for seed in range(5):
        change = np.random.default_rng(seed).uniform(-1.0, 1.0, pressure.shape) * pressure
        expected = (figure(pressure + STEP * change) - figure(pressure - STEP * change)) / (2.0 * STEP)
        parts = slopes * change * area
        allowed = DIFFERENCES * np.abs(parts).sum() + ROUNDED * figure(pressure)
        assert_allclose(parts.sum(), expected, rtol=0, atol=allowed)


def hertz_pressure(cells=32, cap=None):
    """Pressure and spacing of an ellipse whose middle is off that of the grid."""
    spacing = (0.7 / cells, 2.5 / cells)
    x, y = ((np.arange(cells) - 0.5 * cells + off) * step for off, step in zip((0.3, 0.7), spacing, strict=True))
    gap = 0.5 * (0.1 * x[:, None] ** 2 + 0.01 * y**2)
    return solve_contact(gap, spacing=spacing, contact_modulus=113187.0, load=500.0, max_pressure=cap).pressure, spacing


def even_ellipse(shape=(20, 24)):
    """Pressure of an ellipse in the middle of an even grid: four cells, and two slices, are the highest."""
    x, y = (np.linspace(-1.2, 1.2, n) for n in shape)
    return 900.0 * np.sqrt(np.maximum(1.0 - x[:, None] ** 2 - y**2, 0.0))


def tilting(pressure):
    """Change of pressures whose line load is zero in the middle and grows linearly along the contact."""
    line = pressure.sum(axis=0)
    return pressure * np.linspace(-1.0, 1.0, line.size) / np.where(line > 0.0, line, 1.0)


def under_pressure(pair, contact, one):
    """The map of a result at a contact of its pair, on a grid made again."""
    return contact, sample_separation(pair, contact, cells=one.pressure.shape, box=Box.of(one)), one.pressure


def of_result(name, position=0):
    cycle = result(name, positions=3)
    contact = under_pressure(cycle.gear_pair, cycle.paths[0][position], cycle.maps[0][position][0])
    return cycle.gear_pair, contact, float(cycle.peak_pressure[0, position, 0])


@cache
def on_relief_start(cells=(32, 40)):
    """A crowned spur contact across the start of a linear relief; even about the middle of the face."""
    relief = FlankModifications(lead_crowning=0.005, tip_relief=0.02, tip_relief_start=105.0, tip_relief_form="linear")
    pair = gear_pair(relief)
    path = trace_contact(pair, np.linspace(-0.5, 0.5, 41) * pair.pitch)
    contact = path[int(abs(path.pinion_radius - 52.407).argmin())]
    loaded = solve_under_load(pair, contact, 2700.0, GridChoice(cells=cells, tolerance=1e-9))
    assert loaded.at_relief_start
    assert not loaded.at_edge
    return pair, (contact, loaded.separation, loaded.solution.pressure)


def area_of(contact):
    return contact[1].spacing[0] * contact[1].spacing[1]


def parabola_top(line):
    """Top of the parabola through the highest value and its neighbours."""
    top = int(line.argmax())
    curve = np.polynomial.Polynomial.fit([-1.0, 0.0, 1.0], line[top - 1 : top + 2], 2)
    return float(curve(curve.deriv().roots()[0]))


def test_line_load_changes_as_the_top_of_its_parabola():
    pressure, (dx, dy) = hertz_pressure()
    slopes = line_load_slopes(pressure, (dx, dy))
    assert_changes(lambda one: parabola_top(one.sum(axis=0) * dx), slopes, pressure, dx * dy)
    assert_allclose((slopes * pressure).sum() * dx * dy, parabola_top(pressure.sum(axis=0) * dx), rtol=ROUNDING)


def test_line_load_of_an_even_grid_changes_as_in_its_middle():
    """What one half of the contact gains and the other loses leaves the top as it is."""
    pressure = even_ellipse()
    slopes, tilt = line_load_slopes(pressure, SPACING), tilting(pressure)
    assert_allclose((slopes * tilt).sum(), 0.0, atol=ROUNDING * np.abs(slopes * tilt).sum())


@pytest.mark.parametrize(
    "line", [[3.0, 2.0, 1.0, 0.0], [0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 3.0, 0.0], [0.0, 0.0, 5.0, 0.0]]
)
def test_line_load_at_the_end_of_a_contact_changes_with_its_slice(line):
    slopes = line_load_slopes(np.array([line, line]), SPACING)
    assert_allclose(slopes * SPACING[1], [np.array(line) == max(line)] * 2)


def test_line_load_without_pressure_has_no_slopes():
    assert not line_load_slopes(np.zeros((4, 5)), SPACING).any()


def test_smooth_peak_changes_as_the_top_of_its_quadratic():
    pressure, (dx, dy) = hertz_pressure()
    slopes = smooth_peak_slopes(pressure)
    peak = patch.peak_pressure(pressure)
    assert peak > 1.0001 * pressure.max(), "it lies between the cells"
    assert np.count_nonzero(slopes) > 50
    assert_changes(patch.peak_pressure, slopes / (dx * dy), pressure, dx * dy)
    assert_allclose((slopes * pressure).sum(), peak, rtol=ROUNDING)


def test_smooth_peak_of_a_gear_pair_changes_as_its_own():
    pair, contact, peak = of_result("helical")
    (slopes,) = peak_pressure_slopes(pair, [contact], [None])
    assert_changes(patch.peak_pressure, slopes, contact[2], area_of(contact))
    assert_allclose((slopes * contact[2]).sum() * area_of(contact), peak, rtol=ROUNDING)


def test_smooth_peak_does_not_change_as_the_contact_moves():
    """An ellipse that moves by a tenth of a cell: what the fit gains on one side it loses on the other."""
    x, y = np.linspace(-1.2, 1.2, 40), np.linspace(-1.3, 1.3, 40)

    def moved(by):
        return np.sqrt(np.maximum(1.0 - (x[:, None] - by) ** 2 - (y - 2.0 * by) ** 2, 0.0))

    change = (moved(0.021) - moved(0.019)) / 0.002
    slopes = smooth_peak_slopes(moved(0.02))
    assert_allclose((slopes * change).sum(), 0.0, atol=1e-4 * np.abs(slopes * change).sum())


@pytest.mark.parametrize("shape", ["border", "no quadratic", "few cells", "below the cap"])
def test_peak_that_is_the_largest_cell_changes_with_it(shape):
    pressure, cap = even_ellipse(), None
    pressure[8, 9] += 1.0
    if shape == "border":
        pressure, cap = pressure[8:], None
    elif shape == "no quadratic":
        pressure = np.random.default_rng(1).random((20, 24)) * (pressure > 0.0)
    elif shape == "few cells":
        pressure = pressure[8:11, 8:11]
        pressure = np.pad(pressure, 2)
    else:
        cap = 1000.0
    largest = np.unravel_index(pressure.argmax(), pressure.shape)
    slopes = smooth_peak_slopes(pressure, cap)
    assert slopes[largest] == slopes.sum() == np.count_nonzero(slopes) == 1.0


def test_peak_at_the_cap_does_not_change():
    pressure, _ = hertz_pressure(cap=800.0)
    assert (pressure == 800.0).sum() > 10
    assert not smooth_peak_slopes(pressure, 800.0).any()
    _, contact, peak = of_result("fzg_c14")
    for cap, changes in ((0.99 * peak, False), (1.01 * peak, True)):
        capped = read_scene(SCENES / "fzg_c14.toml").with_changes({"material.max_pressure_MPa": cap}).pair()
        (slopes,) = peak_pressure_slopes(capped, [contact], largest_slice_pressures(capped, [contact]))
        assert slopes.any() == changes


@pytest.mark.parametrize(("name", "heavier"), [("fzg_c14", 0.01), ("misaligned", 0.0)])
def test_slice_pressure_where_a_contact_ends_changes_as_its_own(name, heavier):
    """Along the whole face, a little heavier at one end, and at one end of it: the place along stays.

    Each cell changes by itself: the middle of a slice goes with its forces, and its curvature is that of the middle.
    """
    pair, (point, separation, pressure), _ = of_result(name)
    pressure = pressure * (1.0 + heavier * np.linspace(-1.0, 1.0, pressure.shape[1]))
    contact = point, separation, pressure

    def figure(pressure):
        return largest_slice_pressures(pair, [(point, separation, pressure)])[0].pressure

    (slopes,) = peak_pressure_slopes(pair, [contact], largest_slice_pressures(pair, [contact]))
    assert_changes(figure, slopes, pressure, area_of(contact))
    force = (slopes * pressure).sum() * area_of(contact)
    assert_allclose(force, 0.5 * figure(pressure), rtol=ROUNDING)  # it grows with the root of the force


@pytest.mark.parametrize("name", ["spiral_bevel", "helical"])
def test_slice_pressure_of_a_contact_shorter_than_the_average_changes_with_its_length(name, monkeypatch):
    """The average is over a length that follows the forces: a longer contact has less pressure for its force."""
    monkeypatch.setattr(line_load, "AVERAGED_OVER", 100.0)
    pair, (point, separation, pressure), _ = of_result(name)

    def figure(pressure):
        return largest_slice_pressures(pair, [(point, separation, pressure)])[0].pressure

    (peak,) = largest_slice_pressures(pair, [(point, separation, pressure)])
    assert peak.slices.length < np.diff(peak.slices.ends)
    slopes = peak.slopes
    area = area_of((point, separation, pressure))
    grown = pressure * np.linspace(1.0, 3.0, pressure.shape[1])  # one end gains more
    step = 1e-4
    expected = (figure(pressure + step * grown) - figure(pressure - step * grown)) / (2.0 * step)
    assert_allclose((slopes * grown).sum() * area, expected, rtol=0.02)  # the place is one of some between slices
    assert_allclose((slopes * pressure).sum() * area, 0.5 * peak.pressure, rtol=1e-9)  # evenly more: the same length


def test_line_load_over_the_loaded_length_changes_as_that_does():
    """Slices 1, 2, 1 N, less long than the average: a force at an end makes that longer, one in the middle shorter."""
    grid = SimpleNamespace(x=np.zeros(1), y=np.arange(3.0), spacing=(1.0, 1.0), cover=np.ones((1, 3)))
    forces, step = np.array([[1.0, 2.0, 1.0]]), 1e-5

    def loads(pressure):
        return line_load.SliceLoads(100.0, grid, pressure)

    def line(pressure):
        return loads(pressure).at(np.ones(1))[2].item()

    differences = [(line(forces + step * one) - line(forces - step * one)) / (2.0 * step) for one in np.eye(3)]
    slopes = _relative_slopes(loads(forces), 1.0, np.ones(3))
    assert_allclose(slopes, np.array(differences) / line(forces), rtol=1e-6)  # of differences


def test_slice_pressure_of_a_map_is_that_of_its_result():
    pair, contact, peak = of_result("fzg_c14")
    assert_allclose(largest_slice_pressures(pair, [contact])[0].pressure, peak, rtol=ROUNDING)


def test_slice_pressure_within_a_contact_changes_as_the_top_of_a_parabola():
    """Through three line loads times curvatures, one slice apart, whose shares in the forces are counted here."""
    pair, contact = on_relief_start()
    point, separation, pressure = contact
    (peak,) = largest_slice_pressures(pair, [contact])
    x, y = peak.place
    (dx, dy), half = separation.spacing, 0.125 * pair.module
    gap = NormalGap(pair, [point], separation.axes[None])
    places = y + dy * np.array([-1.0, 0.0, 1.0])
    curvature = gap.curvature_across(np.full((1, 3), x), places[None])[0]
    borders = np.append(separation.y - 0.5 * dy, separation.y[-1] + 0.5 * dy)

    def figure(pressure):
        carried = np.concatenate([[0.0], np.cumsum(pressure.sum(axis=0))]) * dx * dy
        line_load = (np.interp(places + half, borders, carried) - np.interp(places - half, borders, carried)) / (
            2 * half
        )
        return np.sqrt(parabola_top(line_load * curvature) * pair.contact_modulus / np.pi)

    (slopes,) = peak_pressure_slopes(pair, [contact], largest_slice_pressures(pair, [contact]))
    assert_allclose(peak.pressure, figure(pressure), rtol=1e-3)  # the peak is that of one place
    changes = np.random.default_rng(2).uniform(-1.0, 1.0, (5, *pressure.shape)) * pressure
    expected = [(figure(pressure + STEP * one) - figure(pressure - STEP * one)) / (2.0 * STEP) for one in changes]
    parts = slopes * changes * dx * dy
    atol = 1e-3 * np.abs(parts).sum(axis=(1, 2)).max()  # as the peaks agree, and the curvatures at other places across
    assert_allclose(parts.sum(axis=(1, 2)), expected, rtol=0, atol=atol)


def test_slice_pressure_of_an_even_contact_does_not_change_as_it_tilts():
    pair, contact = on_relief_start()
    (slopes,) = peak_pressure_slopes(pair, [contact], largest_slice_pressures(pair, [contact]))
    tilt = slopes * tilting(contact[2])
    assert_allclose(tilt.sum(), 0.0, atol=1e-4 * np.abs(tilt).sum())  # even to the solver's tolerance


def test_peaks_of_several_contacts_are_those_of_each():
    pair, contact = on_relief_start()
    _, coarse = on_relief_start((24, 20))
    peaks = [*largest_slice_pressures(pair, [contact, coarse]), None]
    together = peak_pressure_slopes(pair, [contact, coarse, contact], peaks)
    for found, one, peak in zip(together, [contact, coarse, contact], peaks, strict=True):
        assert_array_equal(found, peak_pressure_slopes(pair, [one], [peak])[0])  # exact: each contact by itself
    assert peak_pressure_slopes(pair, [], []) == []


@pytest.mark.parametrize("exponent", [1.0, 2.5, 12.0, 40.0])
def test_pressure_norm_changes_as_its_slopes(exponent):
    pressure, (dx, dy) = hertz_pressure()
    cover = np.random.default_rng(4).uniform(0.3, 1.0, pressure.shape)
    norm, slopes = pressure_norm(pressure, cover, (dx, dy), exponent)
    assert_changes(lambda one: pressure_norm(one, cover, (dx, dy), exponent)[0], slopes, pressure, dx * dy)
    assert_allclose((slopes * pressure).sum() * dx * dy, norm, rtol=ROUNDING)


def test_pressure_norm_of_hertz_is_that_of_its_integral():
    """p0 (2 pi a b int (1 - r^2)^(m/2) r dr)^(1/m) = p0 (pi a b/(m/2 + 1))^(1/m), here with unit semi-axes."""
    x = (np.arange(400) - 199.5) / 180.0
    pressure = 900.0 * np.sqrt(np.maximum(1.0 - x[:, None] ** 2 - x**2, 0.0))
    norm, _ = pressure_norm(pressure, np.ones(pressure.shape), (1.0 / 180.0, 1.0 / 180.0))
    assert_allclose(norm, 900.0 * (np.pi / 7.0) ** (1.0 / 12.0), rtol=1e-6)


def test_pressure_norm_spreads_the_force_of_a_cut_cell_over_its_material():
    """700 MPa on 1 1/4 cells of 2 mm^2: as on material of 2.5 mm^2; without material nothing counts."""
    norm, slopes = pressure_norm(np.array([[700.0, 175.0, 0.0]]), np.array([[1.0, 0.25, 0.0]]), (1.0, 2.0), 4.0)
    assert_allclose(norm, 700.0 * 2.5**0.25, rtol=ROUNDING)
    assert slopes[0, 0] == slopes[0, 1]
    assert slopes[0, 2] == 0.0


def test_pressure_norm_tends_to_the_largest_pressure_and_to_the_force():
    pressure, spacing = hertz_pressure()
    whole = np.ones(pressure.shape)
    assert_allclose(pressure_norm(pressure, whole, spacing, 5000.0)[0], pressure.max(), rtol=5e-3)
    assert_allclose(pressure_norm(pressure, whole, spacing, 1.0)[0], 500.0, rtol=1e-6)  # N over 1 mm^2


def test_pressure_norm_without_pressure_is_zero():
    norm, slopes = pressure_norm(np.zeros((3, 4)), np.ones((3, 4)), SPACING)
    assert norm == 0.0
    assert not slopes.any()


@pytest.mark.parametrize("exponent", [0.5, -1.0, np.inf, np.nan])
def test_exponent_below_one_is_refused(exponent):
    with pytest.raises(InputError, match=r"exponent: .* is not between 1 and infinity"):
        pressure_norm(np.ones((2, 2)), np.ones((2, 2)), SPACING, exponent)


@pytest.mark.parametrize("name", ["mesh_cycle_helical", "mesh_cycle_bevel"])
def test_face_load_factor_changes_with_the_pressures_of_all_pairs(name):
    cycle = result(name)
    pair, positions = cycle.gear_pair, cycle.maps[-1]

    def factor(seed, step):
        rng = np.random.default_rng(seed)
        rows = []
        for row in positions:
            changes = [None if one is None else 1.0 + step * rng.uniform(-1.0, 1.0, one.pressure.shape) for one in row]
            rows.append(
                [
                    None if one is None else replace(one, pressure=one.pressure * by)
                    for one, by in zip(row, changes, strict=True)
                ]
            )
        return load_factors(pair, cycle.path, (rows,), 1.0)[0].item(), rows

    slopes = face_load_factor_slopes(pair, cycle.path, positions)
    for seed in range(3):
        (high, _), (low, _), (_, rows) = (factor(seed, step) for step in (STEP, -STEP, 1.0))
        parts = [
            slope * (moved.pressure - one.pressure) * one.spacing[0] * one.spacing[1]
            for triple in zip(slopes, positions, rows, strict=True)
            for slope, one, moved in zip(*triple, strict=True)
            if slope is not None
        ]
        size = sum(np.abs(part).sum() for part in parts)
        assert_allclose(sum(part.sum() for part in parts), (high - low) / (2.0 * STEP), rtol=0, atol=DIFFERENCES * size)


def test_face_load_factor_does_not_change_with_all_forces_alike():
    cycle = result("mesh_cycle_helical")
    slopes = face_load_factor_slopes(cycle.gear_pair, cycle.path, cycle.maps[0])
    places = [(n, k) for n, row in enumerate(slopes) for k, slope in enumerate(row) if slope is not None]
    assert len(places) == sum(one is not None for row in cycle.maps[0][:-1] for one in row)
    parts = [slopes[n][k] * cycle.maps[0][n][k].pressure for n, k in places]
    areas = [np.prod(cycle.maps[0][n][k].spacing) for n, k in places]
    size = sum(area * np.abs(part).sum() for area, part in zip(areas, parts, strict=True))
    total = sum(area * part.sum() for area, part in zip(areas, parts, strict=True))
    assert_allclose(total, 0.0, atol=ROUNDING * size)
    assert slopes[-1] == [None] * len(cycle.maps[0][-1]), "the last position is the first one a pitch later"


def test_face_load_factor_that_is_none_has_no_slopes():
    cycle = result("mesh_cycle_helical")
    (first, *_), unloaded = cycle.maps[0], [[None] * 2] * 3
    assert face_load_factor_slopes(cycle.gear_pair, cycle.path, [first]) == [[None] * len(first)]
    assert face_load_factor_slopes(cycle.gear_pair, cycle.path, unloaded) == unloaded
    silent = [replace(one, pressure=0.0 * one.pressure) for one in first if one is not None]
    assert face_load_factor_slopes(cycle.gear_pair, cycle.path, [silent] * 2) == [[None] * len(silent)] * 2


@pytest.mark.parametrize(("start", "beside"), [(-0.05, True), (0.03, True), (0.25, False), (math.inf, False)])
def test_curvature_that_jumps_beside_the_peak_is_seen(start, beside):
    """Half a width is 0.1 mm; a curvature that grows along the contact does not jump."""
    x = np.linspace(-0.31, 0.31, 32)
    gap = x**2 / 20.0 * (1.0 + 0.8 * x) + 0.02 * np.maximum(x - start, 0.0) ** 2
    assert _curvature_jumps(np.where(x < 0.3, gap, np.nan), np.abs(x) < 0.1, 15) is beside
