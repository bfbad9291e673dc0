"""Loaded contacts on rounded edges: the limit of sharp ones, which edges count as rounded, what is told of them."""

import re
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.output.overview import describe_scene
from loaded_tca.plots import plot_contact_path
from loaded_tca.results.warnings import EDGES as EDGE_NAMES
from loaded_tca.results.warnings import reached_edges
from loaded_tca.scene import read_scene
from tests.samples.results import FLANKS_ALONE, SCENES
from tests.samples.shared import made_once

EDGES = [f"{gear}.{edge}_rounding_mm" for gear in ("pinion", "wheel") for edge in ("tip", "side")]
TOLD = "mesh-dependent"


@made_once
def analysed(name, radii=(), **changes):
    scene = read_scene(SCENES / f"{name}.toml").with_changes(
        {**FLANKS_ALONE, "analysis.positions": 5, "analysis.accuracy": None, "analysis.cells": (24, 24)}
        | {f"analysis.{key}": value for key, value in changes.items()}
        | dict(radii)
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", AccuracyWarning)
        cycle = analyse(scene)
    return cycle, tuple(str(one.message) for one in caught)


def rounded(radius, keys=EDGES):
    return tuple(dict.fromkeys(keys, radius).items())


@pytest.mark.thorough
def test_transmission_error_under_load_tends_to_that_of_sharp_edges():
    """The difference is proportional to the radius: to 15 % on this grid, whose cells are 0.02 mm wide."""
    changes = {"load_sharing": True, "cells": (48, 96)}
    sharp, radii = analysed("misaligned", **changes)[0].transmission_error[0], np.array([0.1, 0.05, 0.02, 0.01])
    blunt = [analysed("misaligned", rounded(radius), **changes)[0].transmission_error[0] for radius in radii]
    errors = np.abs(np.array(blunt) - sharp).max(axis=1)
    assert_allclose(errors / radii, errors[0] / radii[0], rtol=0.15)
    assert errors[0] < 0.05 * np.ptp(sharp)


def test_load_shares_on_rounded_edges_are_those_of_sharp_ones_where_none_is_reached():
    sharp, _ = analysed("straight_bevel", positions=3)
    blunt, told = analysed("straight_bevel", rounded(0.1), positions=3)
    assert not sharp.on_edge.any()
    assert not any("rounded edge" in one for one in told)
    for name in ("transmission_error", "peak_pressure", "hertz_pressure", "normal_force", "contact_length"):
        # exact: away from the arcs the rounding adds zeros
        assert_array_equal(getattr(blunt, name), getattr(sharp, name))


def test_edge_is_rounded_where_the_reached_edge_has_a_radius():
    """The contact of the misaligned pair ends on the upper side of the teeth."""
    sides = [key for key in EDGES if "side" in key]
    cycle, told = analysed("misaligned", rounded(0.2, sides))
    assert_array_equal(cycle.edge_is_rounded, cycle.on_edge)
    assert cycle.on_edge.any()
    assert not any(TOLD in one for one in told)
    names = {name for name, one in zip(EDGE_NAMES, reached_edges(cycle).any(axis=(0, 1, 2)), strict=True) if one}
    assert names <= {"pinion upper side", "wheel upper side"}
    assert names
    assert "at a sharp edge" not in cycle.summary()
    lines = [line.split("  ") for line in cycle.summary().splitlines()]
    (at,) = (k for k, line in enumerate(lines) if line[0] == "at a rounded edge [MPa] | its force [N]")
    assert "".join(lines[at + 1]).startswith("estimated error [%]")
    error = cycle.edge_pressure_error[0][cycle.edge_contact(0)]
    assert_allclose(float(lines[at + 1][-1]), 100.0 * error, rtol=0.05)  # two digits


def test_edge_is_sharp_where_only_other_edges_have_a_radius():
    tips = [key for key in EDGES if "tip" in key]
    cycle, told = analysed("misaligned", rounded(0.1, tips), positions=1)
    assert cycle.on_edge.all()
    assert not cycle.edge_is_rounded.any()
    assert any(TOLD in one for one in told)


def test_sharp_end_of_a_face_before_the_arc_of_the_wider_one_is_a_sharp_edge():
    """The pinion is wider by its rounding, and more: what of its face the wheel meets is the same, and not rounded."""
    pressures = []
    for wider in (0.2, 0.3, 0.6):
        keys = (("pinion.face_width_mm", 25.0 + 2.0 * wider), ("pinion.side_rounding_mm", 0.2))
        cycle, told = analysed("misaligned", keys, positions=1)
        assert cycle.on_edge.all()
        assert not cycle.edge_is_rounded.any()
        assert any(TOLD in one for one in told)
        pressures.append(cycle.edge_pressure.item())
    # the bending of a face wider by 0.4 mm of 25
    assert_allclose(pressures, pressures[0], rtol=0.1)


@pytest.mark.thorough
def test_pressure_at_a_rounded_edge_is_a_number_of_the_gear():
    """The same on grids of twice and four times as many cells, to 2 %; that of a sharp edge grows without end."""
    cells = ((24, 24), (48, 48), (96, 96))
    blunt = [analysed("misaligned", rounded(0.2), cells=one)[0].key_figures()[0] for one in cells]
    sharp = [analysed("misaligned", cells=one)[0].key_figures()[0]["edge_pressure_MPa"] for one in cells]
    found = [one["edge_pressure_MPa"] for one in blunt]
    assert_allclose(found, found[-1], rtol=0.02)
    assert sharp[2] > sharp[1] > sharp[0], sharp
    assert all(one["edge_is_rounded"] for one in blunt)
    assert all(12.5 - 0.25 < one["pinion_axial_at_edge_mm"] < 12.5 for one in blunt), "on the arc or just before it"


@pytest.mark.thorough
def test_rounded_tip_between_sharp_face_ends_is_told_to_have_no_limit():
    tips = rounded(0.2, [key for key in EDGES if "tip" in key])
    line, told = analysed("fzg_c14", tips, load_sharing=True)
    assert line.edge_pressure_error[0][line.edge_contact(0)] == np.inf
    assert not line.edge_is_rounded[0][line.edge_contact(0)]
    assert any("above 3%, without a limit" in one for one in told)
    assert re.search(r"^  estimated error \[%\] +inf$", line.summary(), re.MULTILINE)
    crowned, told = analysed("fzg_c14", (*tips, ("pinion.modifications.lead_crowning_um", 8.0)), load_sharing=True)
    assert crowned.edge_pressure_error[0][crowned.edge_contact(0)] < 0.03
    assert not any("rounded edge" in one for one in told)


@pytest.mark.thorough
def test_contacts_of_mirrored_gears_reach_the_same_roundings():
    """Their pressure ends where cells are cut by the rounded edge; right hand and left hand are each other's mirror."""
    changes = {"positions": 2, "torques_Nm": (260.0,), "load_sharing": True, "free_edges": True}
    changes |= {"cells": None, "accuracy": 0.01, "edge_pressures": "all"}
    right, left = (
        analysed("mesh_cycle_helical", (*rounded(0.1), ("pinion.hand", hand)), **changes)[0]
        for hand in ("right", "left")
    )
    assert right.on_edge.sum() == left.on_edge.sum() > 0
    for one in (right, left):
        assert_array_equal(one.edge_is_rounded, one.on_edge)
    assert_allclose(np.nanmax(left.edge_pressure), np.nanmax(right.edge_pressure), rtol=0.02)


def test_contact_that_ends_before_a_rounding_gives_no_warning_of_its_error():
    changes = {"load_sharing": True, "torques_Nm": (80.0,), "accuracy": 0.02, "cells": None, "edge_pressures": "all"}
    cycle, told = analysed("mesh_cycle_helical", rounded(0.2), **changes)
    assert not (cycle.edge_pressure_error > 0.03).any()
    assert not any("estimated error" in one for one in told)


@pytest.mark.thorough
def test_the_largest_edge_pressure_is_the_same_whether_all_are_asked_for():
    changes = {"load_sharing": True, "torques_Nm": (260.0,)}
    largest, every = (
        analysed(
            "mesh_cycle_helical", rounded(0.2, [key for key in EDGES if "tip" in key]), edge_pressures=one, **changes
        )[0]
        for one in ("largest", "all")
    )
    found = ~np.isnan(largest.edge_pressure_error)
    assert found.any()
    # exact, also below: the same contact, alone or in a stack
    assert_array_equal(largest.edge_pressure[found], every.edge_pressure[found])
    assert np.nanmax(largest.edge_pressure) == np.nanmax(every.edge_pressure)


SOFT = (("pinion.material.youngs_modulus_MPa", 3000.0), ("pinion.material.poisson_ratio", 0.4))
"""A pinion whose contacts are so wide that they reach roundings, their crossings, and roots, which are sharp."""
OF_EDGES = ("edge_pressure", "edge_pressure_error", "edge_is_rounded")


def softly(kind, which, positions, cells=(16, 24)):
    """A helical pair whose edges of a kind are rounded, and what is told of the pressure there."""
    radii = rounded(0.2, [key for key in EDGES if kind in key])
    changes = {"load_sharing": True, "positions": positions, "cells": cells, "edge_pressures": which}
    cycle, told = analysed("helical", (*radii, *SOFT), **changes)
    return cycle, {one.split(" (at ")[0] for one in told if "at a rounded edge" in one}


@pytest.mark.quick_cases("side-3")
@pytest.mark.parametrize(("kind", "positions"), [("tip", 2), ("side", 3)])
def test_largest_edge_pressure_and_its_warnings_do_not_depend_on_whether_all_are_asked_for(kind, positions):
    """Neither where a rounded edge ends at a sharp one nor where a sharp one is reached, too, whose cell has less."""
    (largest, told), (every, told_of_all) = (softly(kind, which, positions) for which in ("largest", "all"))
    assert told == told_of_all
    assert any("without a limit" in one for one in told)
    found = ~np.isnan(largest.edge_pressure)
    for name in OF_EDGES:
        # exact: the same contact, alone or in a stack
        assert_array_equal(getattr(largest, name)[found], getattr(every, name)[found])
    assert np.nanmax(largest.edge_pressure) == np.nanmax(every.edge_pressure)
    assert largest.edge_contact(0) == every.edge_contact(0)


@pytest.mark.thorough
def test_pressures_at_rounded_edges_are_the_same_a_pitch_later():
    """Pair 0 at the first position is in the place of pair 1 at the last one."""
    cycle, _ = softly("", "largest", 2, cells=(16, 16))
    pairs = cycle.dataset["pair"].values.tolist()
    first = [pairs.index(pair) for pair in pairs if pair + 1 in pairs]
    last = [pairs.index(pairs[column] + 1) for column in first]
    pressure, error, is_rounded = (
        (getattr(cycle, name)[0, 0, first], getattr(cycle, name)[0, -1, last]) for name in OF_EDGES
    )
    assert np.isfinite(pressure[0]).any()
    assert_array_equal(*map(np.isnan, pressure))
    assert (np.nan_to_num(abs(pressure[1] - pressure[0])) <= np.nan_to_num(sum(error) * pressure[0])).all()
    assert_array_equal(*is_rounded)


def test_corner_of_a_rounded_and_a_sharp_edge_is_sharp():
    """Rounded face ends over sharp roots: with no limit where both are pressed."""
    cycle, _ = softly("side", "all", 2)
    corner = cycle.edge_pressure_error == np.inf
    assert corner.any()
    assert not cycle.edge_is_rounded[corner].any()
    assert cycle.edge_is_rounded[cycle.edge_pressure_error < 1.0].all()


@pytest.mark.thorough
def test_slice_pressure_sees_the_curvature_of_the_sharp_flank():
    """With that of an arc, 1/0.2 mm, it would be tenfold."""
    sharp, blunt = (analysed("misaligned", radii)[0] for radii in ((), rounded(0.2)))
    assert_allclose(np.nanmax(blunt.peak_pressure), np.nanmax(sharp.peak_pressure), rtol=0.15)


@pytest.mark.thorough
def test_spur_line_keeps_its_hertz_pressure():
    sharp, blunt = (analysed("fzg_c14", radii, positions=1)[0] for radii in ((), rounded(0.2)))
    assert_array_equal(blunt.path.on_line, sharp.path.on_line)
    assert_allclose(blunt.path.line_ends, sharp.path.line_ends, atol=1e-9)
    assert_allclose(blunt.hertz_pressure, sharp.hertz_pressure, rtol=0.05, err_msg="by the shorter loaded length")


@pytest.mark.thorough
def test_teeth_that_bend_bend_as_those_with_sharp_edges():
    """Of the same compliance, not of another model, with which the transmission error was off by 2 um."""
    changes = {"compliance": "contact+tooth", "free_edges": True, "positions": 3, "torques_Nm": (260.0,)}
    sharp, blunt = (analysed("mesh_cycle_helical", radii, **changes)[0] for radii in ((), rounded(0.05)))
    off = np.abs(blunt.transmission_error - sharp.transmission_error).max() * sharp.wheel_base_radius
    assert off < 1e-4, "a tenth of a micrometre"


def test_check_tells_the_radii():
    text = describe_scene(read_scene(SCENES / "helical.toml").with_changes({"wheel.side_rounding_mm": 0.25}))
    rows = {line.split()[0]: line.split()[-1] for line in text.splitlines() if "rounding_mm" in line}
    assert rows == dict.fromkeys(EDGES, "sharp") | {"wheel.side_rounding_mm": "0.25"}


def test_check_tells_which_pressures_at_rounded_edges_are_found():
    sharp = read_scene(SCENES / "helical.toml")
    blunt = sharp.with_changes({"wheel.tip_rounding_mm": 0.25, "analysis.edge_pressures": "all"})
    assert "rounded edges" not in describe_scene(sharp)
    (row,) = (line for line in describe_scene(blunt).splitlines() if line.startswith("pressures at rounded edges"))
    assert row.split()[-1] == "all"


@pytest.mark.thorough
def test_arcs_are_drawn_on_both_flanks():
    panels = [
        [sum(line.get_linestyle() == "--" for line in axes.lines) for axes in plot_contact_path(cycle).axes[:2]]
        for cycle in (analysed("misaligned")[0], analysed("misaligned", rounded(0.2))[0])
    ]
    assert panels == [[0, 0], [3, 3]]
