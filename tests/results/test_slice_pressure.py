"""Pressure of slices: that of Hertz on smooth contacts, and without spikes where a contact ends at a sharp edge."""

import math
import warnings
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca import AccuracyWarning, analyse, read_scene
from loaded_tca.loaded.line_load import SliceLoads, averaged_line_load
from loaded_tca.loaded.tooth_contact import GridChoice, solve_under_load
from loaded_tca.reference.hertz import point_contact
from loaded_tca.results import slice_pressure
from loaded_tca.results.sensitivities import TORQUE
from loaded_tca.results.slice_pressure import SlicePeak, largest_slice_pressures, rough_peaks
from loaded_tca.separation.normal_gap import NormalGap
from loaded_tca.unloaded import trace_contact
from tests.samples.gear_pairs import sam_paper
from tests.samples.results import ONE_PAIR, SCENES

MODULUS = 113187.0  # MPa


@pytest.mark.parametrize(("aspect", "part"), [(1.0, 0.886), (5.0, 0.984), (10.0, 0.994)])
def test_slice_pressure_of_an_ellipse_is_the_known_part_of_its_peak(aspect, part):
    """sqrt(q E* k/pi) in the middle of Hertz's ellipse, q = pi/2 p0 a: sqrt(pi)/2 of the peak for a circle."""
    across = 0.1
    low, high = 0.0, math.log(aspect) * 2.0 + 1e-9  # of the ratio of the curvatures
    for _ in range(60):
        middle = 0.5 * (low + high)
        ellipse = point_contact(1000.0, (across, across * math.exp(-middle)), MODULUS)
        low, high = (middle, high) if ellipse.ratio < aspect else (low, middle)
    y = np.linspace(-1.2, 1.2, 2401) * ellipse.semi_major
    borders = np.append(y, y[-1] + (y[1] - y[0])) - 0.5 * (y[1] - y[0])
    line_load = 0.5 * math.pi * ellipse.max_pressure * ellipse.semi_minor
    force = line_load * np.maximum(1.0 - (y / ellipse.semi_major) ** 2, 0.0) * (y[1] - y[0])
    _, averaged = averaged_line_load(force, borders, 0.01 * ellipse.semi_major)
    pressure = math.sqrt(averaged.max() * MODULUS * across / math.pi)
    assert_allclose(pressure / ellipse.max_pressure, part, atol=1e-3)  # three digits


def test_line_load_over_a_length_is_the_mean_of_what_it_covers():
    places, line_load = averaged_line_load(np.array([2.0, 0.0, 6.0]), np.array([0.0, 1.0, 2.0, 3.0]), 2.0)
    there = dict(zip(places.tolist(), line_load.tolist(), strict=True))
    assert there == {-1.0: 0.0, 0.0: 1.0, 1.0: 1.0, 2.0: 3.0, 3.0: 3.0, 4.0: 0.0}


@pytest.mark.parametrize("width", [0.25, 0.5])
def test_contact_shorter_than_the_average_has_the_pressure_of_its_own_length(width):
    """Faces below a quarter of the module: a line of an even load has Hertz's pressure, its ends not counted."""
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes(
        {
            **ONE_PAIR,
            "pinion.face_width_mm": width,
            "wheel.face_width_mm": width,
            "load.pinion_torque_Nm": 200.0 * width / 14.0,
            "analysis.positions": 1,
            "analysis.accuracy": None,
            "analysis.cells": (32, 32),
        }
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # it ends at both faces
        cycle = analyse(scene)
    assert_allclose(cycle.peak_pressure.item(), 1347.3, rtol=0.05)  # that of GEARpie on 14 mm


def test_line_load_over_a_length_does_not_follow_a_spike():
    """The same forces, those of the last millimetre in ever fewer cells."""
    found = []
    for cells in (1, 10, 100):
        borders = np.concatenate([np.linspace(0.0, 9.0, 10), 9.0 + np.linspace(0.0, 1.0, cells + 1)[1:]])
        force = np.concatenate([np.ones(9), np.diff(-np.sqrt(np.linspace(1.0, 0.0, cells + 1)))])
        found.append(averaged_line_load(force, borders, 1.0)[1].max())
    assert_allclose(found, 1.0, rtol=1e-9)


@cache
def loaded(pair, cells=(48, 48), load=2700.0, position=0.0):
    return solve_under_load(pair, trace_contact(pair, [position])[0], load, GridChoice(cells=cells, tolerance=1e-8))


def under_pressure(contact):
    return contact.contact, contact.separation, contact.solution.pressure


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_slice_pressure_is_the_peak_of_a_slender_contact(helix_deg):
    """Where both exist they agree: the ellipse is 80 times as long as wide, and longer than the 0.75 mm averaged."""
    pair = sam_paper(helix_deg)
    contact = loaded(pair)
    (peak,) = largest_slice_pressures(pair, [under_pressure(contact)])
    x, y = peak.place
    assert_allclose(peak.pressure, contact.solution.peak_pressure, rtol=2e-3)  # that of Hertz on 48 cells
    assert abs(x) < contact.separation.spacing[0]
    assert abs(y) < 0.05 * contact.extent[1]


def test_slice_pressures_of_several_contacts_are_those_of_each():
    """To the bit, on grids of any number of slices."""
    pair = sam_paper(20.0)
    grids = ((24, 16), 0.1), ((16, 48), 0.0)
    contacts = [under_pressure(loaded(pair, cells, position=position)) for cells, position in grids]
    for order in (contacts, contacts[::-1]):
        for together, contact in zip(largest_slice_pressures(pair, order), order, strict=True):
            (alone,) = largest_slice_pressures(pair, [contact])
            assert (together.pressure, together.place) == (alone.pressure, alone.place)
            assert_array_equal(together.slopes, alone.slopes)


def test_slice_pressure_at_a_jump_of_the_curvature_is_found_between_the_slices():
    """A parabolic tip relief begins within the contact: the largest pressure is that of the jump, on any slices."""
    scene = read_scene(SCENES / "helical.toml")
    start = 2.0 * scene.mesh().pinion.tip_radius - 1.5
    pair = scene.with_changes(
        {"pinion.modifications.tip_relief_um": 25.0, "pinion.modifications.tip_relief_start_mm": start}
    ).pair()
    contact = loaded(pair, (32, 48), 1000.0, 0.5 * pair.pitch)
    (peak,) = largest_slice_pressures(pair, [under_pressure(contact)])
    slices = SliceLoads(pair.module, contact.separation, contact.solution.pressure)
    gap = NormalGap(pair.sharp, [contact.contact], contact.separation.axes[None])

    def pressures(places):
        x, y, line_load = slices.at(places)
        bends = gap.curvature_across(x[None], y[None])[0]
        return np.sqrt(line_load * MODULUS * bends / math.pi), bends

    at_borders, _ = pressures(slices.places)
    between, bends = pressures(np.linspace(*slices.places[[0, -1]], 20001))
    assert np.abs(np.diff(np.log(bends))).max() > 0.5, "no jump"
    assert at_borders.max() < 0.99 * between.max()
    assert_allclose(peak.pressure, between.max(), rtol=1e-3)  # a sixty-fourth of a slice


def test_slice_pressure_takes_line_load_and_curvature_of_its_own_place():
    """At the heel of a bevel pair: line load cell by cell, curvature across from differences of the gap."""
    cycle = bevel_at_the_heel()
    (one,), pair = cycle.maps[0][0], cycle.gear_pair
    dx, dy = one.spacing
    contact = cycle.path[0]
    gap = NormalGap(pair, contact, one.axes)
    step, half, highest = 1e-3, 0.125 * pair.module, 0.0
    loaded = np.flatnonzero(one.pressure.any(axis=0))
    along = np.linspace(*one.borders[1][[loaded[0], loaded[-1] + 1]], 4001)
    inside = along[gap.at(one.x[one.pressure.any(axis=1), None], along)[1].max(axis=0) >= 0.0]
    low, high = (np.clip(one.y[loaded] + side * dy, inside[0], inside[-1]) for side in (-0.5, 0.5))
    for middle in np.linspace(inside[0] + half, inside[-1] - half, 201):
        within = np.clip(np.minimum(high, middle + half) - np.maximum(low, middle - half), 0, None) / (high - low)
        line_load = float(one.pressure.sum(axis=0)[loaded] @ within) * dx * dy / (2.0 * half)
        nearest = loaded[np.abs(one.y[loaded] - middle).argmin()]
        x = float(one.x @ one.pressure[:, nearest] / one.pressure[:, nearest].sum())
        heights = gap.at(x + step * np.array([-1.0, 0.0, 1.0]), np.array(middle))[0]
        curvature = float(heights[0] - 2.0 * heights[1] + heights[2]) / step**2
        highest = max(highest, math.sqrt(line_load * pair.contact_modulus * curvature / math.pi))
    assert_allclose(cycle.peak_pressure.item(), highest, rtol=5e-3)  # the place across is that of the nearest slice


@cache
def bevel_at_the_heel():
    scene = read_scene(SCENES / "straight_bevel.toml").with_changes(
        {**ONE_PAIR, "analysis.positions": 1, "analysis.cells": (48, 48), "mounting.offset_mm": 0.15}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # an edge contact is wanted here
        cycle = analyse(scene)
    assert cycle.on_edge.all()
    return cycle


@pytest.mark.parametrize("name", ["misaligned", "fzg_c14"])
def test_peak_at_a_sharp_edge_does_not_depend_on_the_grid(name):
    """The force beside the edge converges with the root of the cell, as its pressure grows: 3 % here, the largest cell
    by more than 15 %."""
    peaks, cells = [], []
    for count in (32, 64):
        cycle = on_cells(name, count)
        assert cycle.on_edge.all()
        peaks.append(cycle.peak_pressure.item())
        cells.append(cycle.edge_pressure.item())
    assert abs(peaks[1] / peaks[0] - 1.0) < 0.03
    assert cells[1] / cells[0] > 1.15
    assert peaks[1] < cells[1]


@cache
def on_cells(name, count):
    scene = read_scene(SCENES / f"{name}.toml")
    changes = {**ONE_PAIR, "analysis.positions": 1, "analysis.cells": (count, count), "analysis.accuracy": None}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # edge contacts are wanted here
        return analyse(scene.with_changes(changes))


def test_peak_at_an_edge_is_never_above_the_cap():
    scene = read_scene(SCENES / "misaligned.toml").with_changes(
        {**ONE_PAIR, "analysis.positions": 1, "analysis.cells": (24, 24), "material.max_pressure_MPa": 900.0}
    )
    with pytest.warns(AccuracyWarning, match="reaches an edge"):
        cycle = analyse(scene)
    assert cycle.peak_pressure.item() == 900.0
    assert_allclose(cycle.edge_pressure.item(), 900.0, rtol=1e-9)


def test_peak_across_a_relief_start_does_not_depend_on_the_grid():
    """A linear tip relief that begins at the pitch point: the largest cell goes on growing."""
    scene = read_scene(SCENES / "helical.toml")
    changes = {
        **ONE_PAIR,
        "analysis.positions": 1,
        "analysis.accuracy": None,
        "pinion.modifications.tip_relief_form": "linear",
        "pinion.modifications.tip_relief_um": 20.0,
        "load.pinion_torque_Nm": 60.0,
        "pinion.modifications.tip_relief_start_mm": 105.6,
    }
    peaks, largest = [], []
    for count in (48, 96):
        with pytest.warns(AccuracyWarning, match="start of a linear relief"):
            cycle = analyse(scene.with_changes({**changes, "analysis.cells": (count, count)}))
        assert cycle.on_relief_start.all()
        assert np.isnan(cycle.edge_pressure).all()
        peaks.append(cycle.peak_pressure.item())
        largest.append(cycle.maps[0][0][0].pressure.max())
    assert abs(peaks[1] / peaks[0] - 1.0) < 0.01
    assert largest[1] / largest[0] > 1.02
    assert peaks[1] < largest[1]


def test_place_of_the_peak_is_that_of_its_slice():
    """The contact is at the upper face end, and its largest line load lies within half a window of it."""
    cycle = on_cells("misaligned", 64)
    window = 0.25 * cycle.gear_pair.module
    end = 0.5 * cycle.face_width
    assert end - window - 0.1 <= abs(cycle.peak_axial.item()) <= end


ROUND = {
    **ONE_PAIR,
    "pinion.face_width_mm": 3.0,
    "wheel.face_width_mm": 3.0,
    "pinion.modifications": {"lead_crowning_um": 37.5},
    "wheel.modifications": {},
    "analysis.positions": 1,
    "analysis.accuracy": None,
    "analysis.cells": (48, 48),
}
"""A contact twice as long as wide, of whose peak slices have a tenth less; its ends come to those of the face."""


def under_torques(torques):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # it comes to the face ends
        return analyse(
            read_scene(SCENES / "mesh_cycle_spur.toml").with_changes({**ROUND, "analysis.torques_Nm": torques})
        )


def test_peak_goes_on_after_hertz_as_the_ends_of_a_round_contact_come_to_those_of_the_face():
    """With the cube root of the force; what the face lacks of the ellipse moves it by less than a thousandth."""
    torques = [350.0, 470.0, 550.0, 575.0]
    result = under_torques(torques)
    assert result.on_edge.ravel().tolist() == [0, 0, 1, 1]
    hertz = result.hertz_pressure[0] * np.cbrt(np.array(torques) / torques[0])
    assert_allclose(result.peak_pressure.ravel(), hertz.ravel(), rtol=1e-3)


def test_derivative_of_the_peak_of_inner_cells_is_that_after_hertz():
    """Shorter than its ellipse by 5 %, a contact has the exponent of a line, 1/2, to a part: 0.336 to 0.339."""
    result = under_torques([575.0])
    slope = result.sensitivities([TORQUE]).peak_pressure.item() * 575.0 / result.peak_pressure.item()
    assert_allclose(slope, 1.0 / 3.0, rtol=0.02)


def test_peak_where_an_edge_runs_along_the_contact_is_that_of_slices():
    """A tip cuts all of them: none is apart from it."""
    pair = read_scene(SCENES / "mesh_cycle_spur.toml").with_changes({**ROUND, "analysis.torques_Nm": [575.0]}).pair()
    contact = loaded(pair, load=5e3, position=0.9 * pair.pitch)
    assert contact.at_edge
    of_slices, peak = (find(pair, [under_pressure(contact)])[0] for find in (largest_slice_pressures, rough_peaks))
    assert peak.pressure == of_slices.pressure


@pytest.mark.parametrize(
    ("slices_away", "of_length", "pressure", "error"),
    [
        (4, 8, 1000.0, 0.1),  # half the length and half a slice are 4.5: a slice nearer it counts
        (5, 8, 1100.0, 1.0 / 11.0),  # a slice farther it does not
        (8, 8, 1100.0, 0.0),
        (1, 2, 1000.0, 0.0),  # beside the edge, where cells tell nothing
    ],
)
def test_peak_whose_place_is_half_the_average_from_an_edge_has_the_error_of_a_slice(
    slices_away, of_length, pressure, error, monkeypatch
):
    """A top of 1100 MPa in cells so many slices from the one at an edge, beside a slice pressure of 1000 MPa."""
    x, y = 0.01 * np.arange(-2.0, 3.0), 0.1 * np.arange(24.0)
    cells = 1100.0 * (1.0 - 0.05 * (x[:, None] / 0.02) ** 2) * (1.0 - 0.2 * (y / 0.1 - slices_away) ** 2 / 24.0**2)
    at_edge = np.broadcast_to(y == 0.0, cells.shape)
    monkeypatch.setattr(slice_pressure, "_rough_cells", lambda *_: at_edge)
    pair, grid = SimpleNamespace(max_pressure=None), SimpleNamespace(x=x, y=y, spacing=(0.01, 0.1))
    of_slices = SlicePeak(1000.0, (0.0, 0.0), 0.1, SimpleNamespace(length=0.1 * of_length), None)
    peak = slice_pressure._with_inner_cells(pair, grid, cells, of_slices)
    assert_allclose(peak.pressure, pressure, rtol=1e-9)
    assert_allclose(peak.error, error, atol=1e-9)


def test_derivative_of_a_peak_counts_what_forces_change_of_the_length_of_the_average():
    """A contact shorter than the longest average, of an even curvature: its peak goes with the root of the line load.

    Beside central differences by 1e-4 of each force, by which the length of the average goes with their scatter.
    """
    y = np.linspace(-0.4, 0.4, 41)
    pressure = np.outer([0.5, 1.0, 0.5], np.maximum(1.0 - (y / 0.37) ** 2, 0.0))
    grid = SimpleNamespace(x=np.array([-0.02, 0.0, 0.02]), y=y, spacing=(0.02, 0.02), cover=np.ones(pressure.shape))

    def slices(slice_pressure):
        return SliceLoads(8.0, grid, slice_pressure)

    even = slices(pressure)
    top = even.line_load.argmax()
    peak = SlicePeak(1.0, (0.0, even.places[top]), 0.02, even, np.ones(even.places.size))
    carrying = np.flatnonzero(even.force)[::6]
    expected = []
    for place in carrying:
        step = 1e-4 * pressure * (np.arange(y.size) == place)
        low, high = (slices(pressure + by * step).line_load.max() for by in (-1.0, 1.0))
        expected.append(0.5 * (high - low) / (2e-4 * even.force[place]) / even.line_load[top])
    # the largest line load is that at one of the borders of the slices; with the length held up to 2.9 times as much
    assert_allclose(peak.slopes[0, carrying], expected, rtol=0.0, atol=3e-4 * np.abs(expected).max())
