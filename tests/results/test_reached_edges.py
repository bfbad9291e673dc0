"""Edges that loaded contacts reach: told by name, and there wherever a contact is said to reach one."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray

from loaded_tca.analysis import analyse
from loaded_tca.errors import AccuracyWarning
from loaded_tca.results.warnings import EDGES, reached_edges
from loaded_tca.scene import read_scene
from tests.samples.results import FLANKS_ALONE, SCENES, changed, result, with_a_gap


def analysed(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # edge contacts are wanted here
        return analyse(scene)


def test_finding_names_the_edges_of_the_largest_edge_pressure_and_the_relief_that_frees_them():
    cycle = result("misaligned", positions=2)
    sentences = [sentence for sentence in cycle.findings() if sentence.startswith("edge pressure")]
    assert len(sentences) == 1
    pressures = np.where(cycle.load_share[0] >= 1e-3, cycle.edge_pressure[0], -1.0)
    at = (0, *np.unravel_index(pressures.argmax(), pressures.shape))
    assert f"edge pressure {cycle.edge_pressure[at]:.4g} MPa at 130 N m on " in sentences[0]
    reached = [name for name, one in zip(EDGES, reached_edges(cycle)[at], strict=True) if one]
    assert " + ".join(reached) in sentences[0]
    assert "end_relief_um on the pinion or wheel of more than" in sentences[0]
    assert f"finding: {sentences[0]}" in cycle.summary()
    deflection = 1e3 * cycle.contact_deformation[at]  # of flanks alone, and one pair
    assert (
        f"{deflection:.2g} um at the edge itself, the deflection of the mesh there, since the pair first touches at "
        "this edge even without load; analyse again with several starts and amounts: a short relief presses"
    ) in sentences[0]
    assert "mating gear" not in sentences[0]  # ends of the face


def test_torques_that_press_on_one_edge_are_one_finding_under_the_largest_pressure(monkeypatch):
    one = result("misaligned", positions=2)
    parts = [
        one.dataset.assign(edge_pressure=factor * one.dataset.edge_pressure).assign_coords(torque=factor * one.torque)
        for factor in (1.0, 2.0, 3.0, 4.0)
    ]
    whole = xarray.concat(parts, "torque", data_vars="minimal", coords="minimal", compat="override")
    four = replace(one, dataset=whole, maps=list(one.maps) * 4, states=None)
    (sentence,) = [told for told in four.findings() if told.startswith("edge pressure")]
    largest = [np.nanmax(np.where(part.load_share >= 1e-3, part.edge_pressure, 0.0)) for part in parts]
    assert sentence.startswith(f"edge pressure {largest[3]:.4g} MPa at 520 N m on ")
    assert sentence.endswith(
        "; under 3 other torques from 130 to 390 N m the pressure at this edge is "
        f"{largest[0]:.4g} to {largest[2]:.4g} MPa"
    )
    tips = [np.array([name == edge for name in EDGES]) for edge in ("wheel tip", "pinion tip")]
    monkeypatch.setattr("loaded_tca.results.warnings._edges_of_pressure", lambda _, torque, *__: tips[torque > 1])
    lower, upper = [told for told in four.findings() if told.startswith("edge pressure")]
    assert lower.startswith(f"edge pressure {largest[1]:.4g} MPa at 260 N m on wheel tip (")
    assert lower.endswith(f"; under 130 N m the pressure at this edge is {largest[0]:.4g} MPa")
    assert upper.startswith(f"edge pressure {largest[3]:.4g} MPa at 520 N m on pinion tip (")


def test_finding_at_a_root_edge_has_the_gear_and_what_the_mesh_deflects_not_a_pair_that_just_begins_to_carry():
    """All pairs turn the wheel by one angle: from where the leading one touches without load to where it is loaded."""
    none = {f"pinion.modifications.root_relief_{end}": None for end in ("um", "start_mm", "form")}
    coarse = {"analysis.positions": 3, "analysis.accuracy": None, "analysis.cells": (16, 16)}
    cycle = analysed(read_scene(SCENES / "undercut_10x40.toml").with_changes(none | coarse | FLANKS_ALONE))
    (sentence,) = (one for one in cycle.findings() if "pinion root" in one)
    turned = np.abs(cycle.transmission_error[0, 0] - cycle.unloaded_transmission_error[0])
    mesh = 1e3 * turned * cycle.wheel_base_radius
    assert f"use root_relief_um on the pinion of more than {mesh:.2g} um at the edge itself, the deflection" in sentence
    assert np.nanmin(cycle.contact_deformation[0, 0]) < 0.7e-3 * mesh  # of the pair at the edge


@pytest.mark.parametrize(("end", "side"), [(-1.0, "lower side"), (1.0, "upper side")])
def test_finding_names_the_edge_where_the_pressure_lies_not_every_edge_of_the_contact(end, side):
    """A line contact along the whole face, whose pressure is highest at one of its ends."""
    line = result("fzg_c14", positions=1)
    place = np.full_like(line.edge_axial, end * np.abs(line.edge_axial).max())
    pressed = changed(line, edge_axial=place, edge_pressure=np.full_like(line.edge_pressure, 1e4))
    (sentence,) = [one for one in pressed.findings() if one.startswith("edge pressure")]
    assert f" on pinion {side} + wheel {side} (" in sentence


@pytest.mark.parametrize(("edge", "mating"), [("wheel tip", True), ("wheel upper side", False)])
def test_finding_at_a_tip_says_that_the_mating_tip_may_need_relief_too(monkeypatch, edge, mating):
    """Of a bevel pair 17/46 with relief of one tip alone the edge pressure was at the other: 4576 MPa after 4824."""
    there = np.array([name == edge for name in EDGES])
    monkeypatch.setattr("loaded_tca.results.warnings._edges_of_pressure", lambda *_: there)
    (sentence,) = [one for one in result("misaligned", positions=2).findings() if one.startswith("edge pressure")]
    relief = "tip_relief_um" if mating else "end_relief_um"
    assert f"to unload this edge, use {relief} on the wheel of " in sentence
    assert sentence.endswith("load of this one" + ", and the tip of the mating gear may need relief, too" * mating)


def test_edge_pressure_below_the_peak_pressure_is_no_finding():
    cycle = result("misaligned", positions=2)
    higher = np.where(np.isnan(cycle.peak_pressure), np.nan, 1.01 * np.nanmax(cycle.edge_pressure))
    smooth = changed(cycle, peak_pressure=higher, load_share=np.ones_like(cycle.load_share)).findings()
    assert not [sentence for sentence in smooth if sentence.startswith("edge pressure")]


def test_finding_and_summary_have_the_same_largest_edge_pressure():
    """That of a pair with next to no load is beside the finding, of a pair that carries."""
    cycle = result("mesh_cycle_spur", positions=3)
    place, light = (0, 1, int(cycle.load_share[0, 1].argmax())), (0, 0, int(cycle.load_share[0, 0].argmin()))
    shares, edges = cycle.load_share.copy(), np.full_like(cycle.edge_pressure, np.nan)
    shares[light], edges[place], edges[light] = 5e-4, 1868.0, 5181.0
    pressed = changed(cycle, load_share=shares, edge_pressure=edges)
    (sentence,) = [one for one in pressed.findings() if one.startswith("edge pressure 1868 MPa")]
    assert sentence.endswith("; the largest edge pressure, 5181 MPa, is on a pair with less than 0.1% of the torque")
    assert pressed.key_figures()[0]["edge_pressure_MPa"] == 5181.0


def test_edge_pressure_of_pairs_that_carry_next_to_nothing_is_no_finding():
    cycle = result("misaligned", positions=2)
    light = changed(cycle, load_share=np.full_like(cycle.load_share, 1e-4)).findings()
    assert not [sentence for sentence in light if sentence.startswith("edge pressure")]


def test_peak_at_an_edge_of_a_pair_that_carries_little_is_a_finding_beside_that_of_others():
    cycle = result("mesh_cycle_spur", positions=3)
    assert cycle.findings() == ()
    place = (0, 1, int(cycle.load_share[0, 1].argmin()))
    peaks, shares, edges = cycle.peak_pressure.copy(), cycle.load_share.copy(), cycle.on_edge.copy()
    shares[place], edges[place] = 0.05, 1
    peaks[place] = 2.0 * np.nanmax(peaks)
    (sentence,) = changed(cycle, peak_pressure=peaks, load_share=shares, on_edge=edges).findings()
    assert f"the peak pressure {peaks[place]:.4g} MPa" in sentence
    words = "carries 5 % of the torque; on pairs that carry a tenth of the torque or more the peak pressure is"
    assert f"{words} {0.5 * peaks[place]:.4g} MPa" in sentence


def test_relief_of_the_deflection_takes_the_load_off_the_edge():
    changes = {"analysis.positions": 2, "analysis.accuracy": None, "analysis.cells": (24, 32)}
    scene = read_scene(SCENES / "spur.toml").with_changes(changes | FLANKS_ALONE)
    pressed = analysed(scene.with_changes({"pinion.modifications.lead_crowning_um": 1.0}))
    (sentence,) = pressed.findings()
    deflection = float(re.search(r"end_relief_um on the pinion or wheel of up to about (\S+) um at", sentence).group(1))
    relief = {"pinion.modifications.end_relief_um": 1.3 * deflection, "pinion.modifications.end_relief_length_mm": 5.0}
    relieved = analysed(pressed.scene.with_changes(relief))  # what the ends carried deflects the rest by as much more
    assert relieved.findings() == ()
    assert np.isnan(relieved.edge_pressure).all()


def names(cycle):
    return {name for name, one in zip(EDGES, reached_edges(cycle).any(axis=(0, 1, 2)), strict=True) if one}


def test_point_contact_in_the_middle_reaches_none():
    assert names(result(positions=1)) == set()


def test_line_contact_reaches_the_sides_of_the_teeth():
    assert names(result("fzg_c14", positions=1)) >= {"pinion lower side", "pinion upper side"}


def test_misaligned_contact_reaches_one_side():
    """Out-of-plane error positive: the contact goes to z > 0."""
    assert names(result("misaligned", positions=1)) in (
        {"pinion upper side"},
        {"wheel upper side"},
        {
            "pinion upper side",
            "wheel upper side",
        },
    )


def test_contact_that_comes_into_mesh_early_reaches_the_tip_of_the_wheel():
    cycle = result("mesh_cycle_helical", positions=5, torques=(260.0,))
    reached = reached_edges(cycle)[0]
    column = {int(pair): k for k, pair in enumerate(cycle.pair)}
    tips = [EDGES.index("wheel tip"), EDGES.index("pinion tip")]
    assert reached[:, column[1], tips[0]].any()
    assert not reached[:, column[1], tips[1]].any()
    assert reached[:, column[-1], tips[1]].any()
    assert not reached[:, column[-1], tips[0]].any()


@pytest.mark.parametrize(
    "make",
    [
        lambda: result("mesh_cycle_helical", positions=5, torques=(40.0, 260.0)),
        lambda: result("mesh_cycle_spur", positions=5, torques=(260.0,)),
        lambda: result("misaligned", positions=2),
        with_a_gap,
    ],
)
def test_edge_is_named_where_and_only_where_a_contact_reaches_one(make):
    cycle = make()
    np.testing.assert_array_equal(reached_edges(cycle).any(axis=-1), cycle.on_edge)
