"""Load factors: forces in strips of the face, against even loads and against integrals known beforehand."""

import math
import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import AccuracyWarning, analyse, load_result, parse_scene, read_scene
from loaded_tca.errors import ConvergenceError
from loaded_tca.results.load_factors import (
    face_load_factor_by_positions,
    face_load_factor_error,
    in_pairs,
    load_factors,
    strip_borders,
    strip_forces,
    strip_motions,
)
from tests.samples.internal_pairs import SCENE
from tests.samples.results import SCENES, result

ROUNDING = 1e-12
"""Of line loads and lengths, sums over some hundred slices: 3e-15 was seen."""


def evenly_loaded(line_load=200.0, shape=(8, 50), face_part=1.0):
    """Maps of an unmodified spur pair whose contact carries so many N/mm over part of its face."""
    cycle = result("fzg_c14", positions=3)
    (one,) = cycle.maps[0][1]
    length = face_part * cycle.face_width
    dx, dy = 0.05, length / shape[1]
    even = replace(
        one,
        x=(np.arange(shape[0]) - 0.5 * (shape[0] - 1)) * dx,
        y=(np.arange(shape[1]) - 0.5 * (shape[1] - 1)) * dy,
        spacing=(dx, dy),
        pressure=np.full(shape, line_load / (shape[0] * dx)),
        gap=np.zeros(shape),
    )
    return cycle, even


def test_even_load_has_a_face_load_factor_of_one():
    cycle, even = evenly_loaded()
    face, transverse = load_factors(cycle.gear_pair, cycle.path, (((even,),) * 3,), 14.0)
    assert_allclose(face, 1.0, rtol=ROUNDING)
    assert_allclose(transverse, 1.0, rtol=ROUNDING)  # one pair alone, its whole face: the mean length of the lines


def test_positions_that_load_unlike_parts_of_the_face_move_its_strips():
    """Whole face and its middle half in turn: strips carry 1.5 and 0.5, of halves 1 and 1, or 2 and 0 of the mean."""
    cycle, even = evenly_loaded()
    _, half = evenly_loaded(line_load=400.0, face_part=0.5)
    rows = ((even,), (half,), (even,), (half,), (even,))
    pair, path = cycle.gear_pair, cycle.path
    assert_allclose(face_load_factor_by_positions(pair, path, rows), 1.0 / 3.0, rtol=ROUNDING)
    assert face_load_factor_by_positions(pair, path, ((even,),) * 3) < ROUNDING
    assert np.isnan([face_load_factor_by_positions(pair, path, some) for some in (rows[:1], rows[:4])]).all()
    assert math.isnan(face_load_factor_by_positions(pair, path, ((even,), (None,), (even,))))


def test_pair_that_carries_half_the_load_of_a_longer_mesh_is_told_by_the_transverse_factor():
    """Two pairs with 3/4 and 1/4 of the force: the largest line load is 1.5 times the mean over both lines."""
    cycle, even = evenly_loaded()
    heavy, light = (replace(even, pressure=factor * even.pressure) for factor in (1.5, 0.5))
    _, transverse = load_factors(cycle.gear_pair, cycle.path, (((heavy, light),) * 3,), 28.0)
    assert_allclose(transverse, 1.5, rtol=ROUNDING)


def test_strips_share_the_force_of_a_cell_by_its_overlap():
    """Cells of 0.28 mm on strips of 0.4667 mm: an even load is even in the strips, and no force is lost."""
    cycle, even = evenly_loaded(line_load=300.0)
    borders = np.linspace(-7.0, 7.0, 30 + 1)
    force, length = strip_forces(cycle.gear_pair, even, borders)
    assert_allclose(force, 300.0 * 14.0 / 30, rtol=ROUNDING)
    assert_allclose(length, 14.0 / 30, rtol=ROUNDING)
    beyond = replace(even, origin=even.origin + np.array([0.0, 0.0, 1.0]))
    force, _ = strip_forces(cycle.gear_pair, beyond, borders)
    assert_allclose(force.sum(), 300.0 * 14.0, rtol=ROUNDING)
    assert force[0] == force[1] == 0.0


def test_contact_line_across_a_strip_is_as_long_as_its_helix_says():
    cycle = result(positions=1)
    _, length = strip_forces(cycle.gear_pair, cycle.maps[0][0][0], np.linspace(-12.5, 12.5, 31))
    base_helix = cycle.scene.mesh().pinion.base_helix_angle
    assert base_helix > 0.1
    assert_allclose(length, 25.0 / 30.0 / np.cos(base_helix), rtol=1e-3)  # crowning turns the contact a little


def test_load_that_grows_linearly_along_the_face_has_the_factor_of_its_last_strip():
    """Line load proportional to the distance from one end: the strip at the other has 2 - 1/30 of the mean."""
    cycle, even = evenly_loaded(shape=(8, 3000))
    part = (even.y - even.y[0] + 0.5 * even.spacing[1]) / 14.0
    rising = replace(even, pressure=even.pressure * part)
    face, _ = load_factors(cycle.gear_pair, cycle.path, (((rising,),) * 3,), 14.0)
    assert_allclose(face, 2.0 - 1.0 / 30, rtol=1e-6)


def test_last_position_does_not_count():
    cycle, even = evenly_loaded()
    half = np.where(even.y > 0.0, 2.0, 0.0) * even.pressure
    maps = (((even,), (even,), (replace(even, pressure=half),)),)
    assert_allclose(load_factors(cycle.gear_pair, cycle.path, maps, 14.0), 1.0, rtol=ROUNDING)


def test_factors_are_unknown_with_one_position_and_without_load():
    one = result(positions=1)
    assert np.isnan([one.face_load_factor, one.transverse_load_factor]).all()
    several = result(torques=(0.0, 40.0), positions=2)
    assert np.isnan(several.face_load_factor).tolist() == [True, False]
    assert np.isnan(several.transverse_load_factor).tolist() == [True, False]


@pytest.mark.parametrize(
    ("name", "mean_cone_distance", "face"),
    [("mesh_cycle_bevel", 8.5 * np.sqrt(2.0) - 2.4, 4.8), ("face_milled_19x62_matched", 113.91834, 36.83)],
)
def test_face_load_factor_of_bevel_gears_is_that_of_forces_by_their_cone_distance(name, mean_cone_distance, face):
    """Each cell's force, in parts along the contact, counted in strips by its distance from the apex."""
    cycle = result(name, positions=3)
    borders, parts = mean_cone_distance + face * np.linspace(-0.5, 0.5, 31), 64
    strips = np.zeros(30)
    for one in (one for row in cycle.maps[0][:-1] for one in row if one is not None):
        x, y = one.x[:, None, None], one.y[:, None] + one.spacing[1] * ((np.arange(parts) + 0.5) / parts - 0.5)
        points = one.origin + x[..., None] * one.axes[0] + y[..., None] * one.axes[1]
        force = np.broadcast_to(one.pressure[..., None], points.shape[:-1])
        strips += np.histogram(np.linalg.norm(points, axis=-1), borders, weights=force * np.prod(one.spacing))[0]
    assert_allclose(cycle.face_load_factor, strips.max() / strips.mean(), rtol=5e-3)  # contacts curve in a strip
    assert cycle.face_load_factor > 2.0, "crowned: forces are far from even"
    assert np.isnan(cycle.transverse_load_factor).all()


def test_axial_offset_of_the_wheel_moves_the_common_face():
    """Half the face is shared: an even load on that half alone is even, on the whole face it is not."""
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes(
        {"mounting.axial_offset_mm": 7.0, "analysis.positions": 2, "analysis.cells": (16, 16)}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # a line that ends at the faces
        cycle = analyse(scene)
    _, even = evenly_loaded(face_part=0.5)
    shared = replace(even, origin=cycle.maps[0][0][0].origin)
    face, _ = load_factors(cycle.gear_pair, cycle.path, (((shared,),) * 2,), 14.0)
    assert_allclose(face, 1.0, rtol=1e-6)


def test_strips_of_an_even_load_grow_as_the_ends_of_the_common_face_move_apart():
    """Each is a thirtieth of the face, wherever it lies: 200 N/mm over 30 for each end."""
    cycle, even = evenly_loaded()
    borders = strip_borders(cycle.gear_pair, cycle.path)
    for strip in (3, 26):
        growth = strip_motions(cycle.gear_pair, even, borders, strip)
        assert_allclose(growth[6:], [-200.0 / 30.0, 200.0 / 30.0], rtol=1e-6)


@pytest.mark.parametrize("scene", [read_scene(SCENES / "helical.toml"), parse_scene(SCENE)], ids=("external", "ring"))
def test_overlap_counts_the_face_that_an_axial_offset_leaves_in_common(scene):
    """eps_beta = b sin(beta)/(pi m_n), eps_gamma and Y_beta of ISO 6336-3 with it, over the common face b."""
    module, offset = scene.geometry.normal_module_mm, 0.25 * scene.pinion.face_width_mm
    moved = scene.with_changes({"mounting.axial_offset_mm": offset})
    overlap = 3.0 * offset * math.sin(math.radians(15.0)) / (math.pi * module)
    assert_allclose(moved.mesh().overlap_ratio, overlap, rtol=ROUNDING)
    assert_allclose(moved.pairs_in_contact - moved.mesh().transverse_contact_ratio, overlap, rtol=ROUNDING)
    helix_factors = [factors[2] for factors in moved.root_factors]
    assert_allclose(helix_factors, 1.0 - overlap * 15.0 / 120.0, rtol=ROUNDING)
    assert_allclose(moved.pair().wheel_origin[2], offset, rtol=ROUNDING)


def test_lines_of_contact_are_as_long_as_the_faces_in_common():
    """FZG C14: eps_alpha of GEARpie, 14 mm of face, the wheel 6 mm wider and moved by 9 mm: 8 mm in common."""
    scene = read_scene(SCENES / "fzg_c14.toml")
    moved = scene.with_changes({"mounting.axial_offset_mm": 9.0, "wheel.face_width_mm": 20.0})
    assert_allclose(moved.mean_contact_length / scene.mean_contact_length, 8.0 / 14.0, rtol=ROUNDING)
    assert moved.pair().face_width == 8.0
    along = [one.with_changes({"mounting.misalignment_um": 8.0}).pair().wheel_axes[2, 1] for one in (scene, moved)]
    assert_allclose(along[1] / along[0], 14.0 / 8.0, rtol=1e-6)  # the tilt that parts the common face by 8 um


@cache
def crowned(out_of_plane_deg, cells=32):
    """A spur pair whose crowning keeps the load off the face ends; flanks alone, without free edges."""
    scene = read_scene(SCENES / "mesh_cycle_spur.toml").with_changes(
        {
            "analysis.positions": 5,
            "analysis.accuracy": None,
            "analysis.cells": (cells, cells),
            "analysis.torques_Nm": (130.0,),
            "analysis.load_sharing": True,
            "analysis.compliance": "contact",
            "analysis.free_edges": False,
            "pinion.modifications.lead_crowning_um": 15.0,
            "mounting.out_of_plane_deg": out_of_plane_deg,
        }
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # misaligned far enough, the contact comes to the face end
        return analyse(scene)


@pytest.mark.thorough
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_face_load_factor_rises_with_misalignment_on_both_sides(sign):
    factors = [crowned(sign * error).face_load_factor.item() for error in (0.0, 0.04, 0.08, 0.12)]
    assert (np.diff(factors) > 0.0).all()


@pytest.mark.quick_cases("0.04")
@pytest.mark.parametrize("error", [0.0, 0.04])
def test_face_load_factor_does_not_depend_on_the_grid(error):
    coarse, fine = (crowned(error, cells).face_load_factor.item() for cells in (32, 64))
    assert abs(fine / coarse - 1.0) < 0.03


def without_crowning(cells, **changes):
    """FZG C14 as half-spaces on cells of so many along the contact, with sharp face ends in one plane."""
    flanks = {"positions": 3, "compliance": "contact", "free_edges": False, "accuracy": None, "cells": (16, cells)}
    scene = read_scene(SCENES / "fzg_c14.toml").with_changes({f"analysis.{key}": one for key, one in flanks.items()})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse(scene.with_changes(changes))


def test_face_load_factor_at_sharp_ends_misses_what_is_estimated_on_any_cells():
    """Strips hold: what is missing falls with the cells, here against cells that lack a hundredth themselves."""
    *coarse, fine = (without_crowning(cells) for cells in (32, 64, 256))
    missing = [fine.face_load_factor.item() / one.face_load_factor.item() - 1.0 for one in coarse]
    errors = [one.key_figures()[0]["face_load_factor_error"] for one in coarse]
    assert all(0.4 * error < true < error for true, error in zip(missing, errors, strict=True))
    assert missing[1] < 0.65 * missing[0]
    (line,) = [line for line in coarse[0].summary().splitlines() if "K_Hbeta off by its cells" in line]
    assert line.split()[-1] == f"{100.0 * errors[0]:.2g}"


@pytest.mark.parametrize(("width", "bounded"), [(3.6, True), (3.2, False)])
def test_face_load_factor_of_a_narrow_face_has_no_bound_of_its_error(width, bounded):
    """Even load on 0.8 and 0.71 modules of teeth with free ends: its K_Hbeta is 1."""
    faces = {"pinion.face_width_mm": width, "wheel.face_width_mm": width, "load.pinion_torque_Nm": 5.0 * width}
    cycle = without_crowning(32, **faces, **{"analysis.free_edges": True})
    assert any(one.startswith("the face is 0.71 modules wide") for one in cycle.warnings) is not bounded
    error = cycle.key_figures()[0]["face_load_factor_error"]
    assert error < 0.1 if bounded else math.isinf(error)


def test_face_load_factor_away_from_ends_misses_at_most_what_is_estimated():
    """What a crowned pair misses falls faster than in proportion to the cells, and its estimate, too."""
    coarse, fine = crowned(0.0, 32), crowned(0.0, 64)
    errors = [one.key_figures()[0]["face_load_factor_error"] for one in (coarse, fine)]
    missing = abs(fine.face_load_factor.item() / coarse.face_load_factor.item() - 1.0)
    assert missing < errors[0] < 0.1
    assert errors[1] < 0.5 * errors[0]


ROUNDED = {"analysis.free_edges": True} | {f"{gear}.side_rounding_mm": 0.6 for gear in ("pinion", "wheel")}
"""Roundings that begin just before the second strip of a face of 14 mm."""


@cache
def rounded(cells):
    """FZG C14 with rounded ends of both faces."""
    return without_crowning(cells, **ROUNDED)


def by_cells(cycle):
    """A mesh cycle's pressure maps whose cells alone tell the load along the face."""
    (rows,) = cycle.maps
    return tuple(tuple(one and replace(one, strip_force=None) for one in row) for row in rows)


def test_face_load_factor_beside_rounded_ends_is_that_of_fine_cells():
    """384 cells are off by 1.5 % at the most, half a cell where the line load doubles; coarse ones alone by 8 %."""
    coarse, fine = rounded(64), rounded(384)
    of_cells = [
        load_factors(cycle.gear_pair, cycle.path, (by_cells(cycle),), math.nan)[0].item() for cycle in (coarse, fine)
    ]
    error = coarse.key_figures()[0]["face_load_factor_error"]
    assert abs(coarse.face_load_factor.item() / fine.face_load_factor.item() - 1.0) < error < 0.04
    assert_allclose(coarse.face_load_factor, of_cells[1], rtol=0.015)
    assert abs(of_cells[0] / of_cells[1] - 1.0) > 0.05


@pytest.mark.parametrize("cells", [64, 128])
def test_face_load_factor_of_cells_beside_rounded_ends_is_off_by_at_most_what_is_estimated(cells):
    cycle = rounded(cells)
    maps, pair, path = by_cells(cycle), cycle.gear_pair, cycle.path
    error = face_load_factor_error(pair, path, maps)
    off = abs(load_factors(pair, path, (maps,), math.nan)[0].item() / rounded(384).face_load_factor.item() - 1.0)
    assert 0.01 < off < error < 0.4


def test_strips_of_columns_carry_the_force_of_the_contact():
    cycle = rounded(64)
    *rows, last = cycle.maps[0]
    for n, row in enumerate(rows):
        for k, one in enumerate(row):
            if one is not None:
                assert_allclose(one.strip_force.sum(axis=1), cycle.normal_force[0, n, k], rtol=1e-3)  # 10 tolerances
    assert all(one is None or one.strip_force is None for one in last)
    assert all(one.strip_force is None for row in without_crowning(32).maps[0] for one in row if one is not None)


def test_forces_of_columns_are_those_of_loaded_results(tmp_path):
    cycle = rounded(64)
    cycle.save(tmp_path / "result.nc")
    again = load_result(tmp_path / "result.nc")
    for row, same in zip(cycle.maps[0], again.maps[0], strict=True):
        for one, other in zip(row, same, strict=True):
            assert (one is None) == (other is None)
            if one is not None and one.strip_force is not None:
                assert (one.strip_force == other.strip_force).all()
            elif one is not None:
                assert other.strip_force is None
    errors = [one.key_figures()[0]["face_load_factor_error"] for one in (again, cycle)]
    assert errors[0] == errors[1]


def test_files_have_forces_of_columns_only_where_a_contact_ends_on_an_arc(tmp_path):
    """A file without them, as earlier versions wrote all, is read: its K_Hbeta is that of the cells."""
    assert "map_strip_force" in rounded(64).stored().variables
    sharp = without_crowning(32)
    assert "map_strip_force" not in sharp.stored().variables
    sharp.save(tmp_path / "result.nc")
    again = load_result(tmp_path / "result.nc")
    assert all(one is None or one.strip_force is None for row in again.maps[0] for one in row)
    assert again.face_load_factor == sharp.face_load_factor


def test_contacts_whose_columns_are_not_solved_keep_the_load_and_the_error_of_their_cells(monkeypatch):
    def unsolved(*_, **__):
        raise ConvergenceError("no", None)

    monkeypatch.setattr("loaded_tca.edges.rounded.solve_graded", unsolved)
    cycle = without_crowning(64, **ROUNDED)
    same = rounded(64)
    maps = by_cells(same)
    assert cycle.face_load_factor == load_factors(same.gear_pair, same.path, (maps,), math.nan)[0]
    error = cycle.key_figures()[0]["face_load_factor_error"]
    assert error == face_load_factor_error(same.gear_pair, same.path, maps) > 0.1


def test_face_load_factor_with_free_edges_misses_less_than_half_spaces_do_at_most():
    coarse, fine = (without_crowning(cells, **{"analysis.free_edges": True}) for cells in (32, 64))
    error = coarse.key_figures()[0]["face_load_factor_error"]
    assert 0.0 < abs(fine.face_load_factor.item() / coarse.face_load_factor.item() - 1.0) < error


def test_slices_share_their_load_in_pairs_where_both_carry_some():
    pressure = np.array([[0.0, 1.0, 3.0, 2.0, 6.0, 5.0, 0.0], [0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 0.0]])
    shared = [in_pairs(replace(a_map(), pressure=pressure), first).pressure for first in (0, 1)]
    assert shared[0].tolist() == [[0.0, 1.0, 2.5, 2.5, 5.5, 5.5, 0.0], [0.0, 0.0, 1.0, 1.0, 0.5, 0.5, 0.0]]
    assert shared[1].tolist() == [[0.0, 2.0, 2.0, 4.0, 4.0, 5.0, 0.0], [0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]]


def a_map():
    return next(one for one in crowned(0.0).maps[0][0] if one is not None)


def test_face_load_factor_of_a_crowned_pair_is_that_of_its_mean_parabola():
    """Hertz's ellipse has the line load 1 - (y/a)^2: its strip in the middle over the mean of the face, weighted."""
    cycle = crowned(0.0, 64)
    borders = np.linspace(-12.5, 12.5, 30 + 1)
    mean = np.zeros(30)
    for n, k in np.argwhere(cycle.normal_force[0, :-1] > 0.0):
        half = cycle.hertz_semi_major[0, n, k]
        inside = np.clip(borders / half, -1.0, 1.0)
        mean += cycle.normal_force[0, n, k] * np.diff(0.75 * (inside - inside**3 / 3.0))
    assert_allclose(cycle.face_load_factor, mean.max() / mean.mean(), rtol=5e-3)  # of a cell at either end
