"""Results beside each other: shared torques, differences of key figures, keys in which the scenes differ."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.results import compare_results
from loaded_tca.results.comparison import written_value
from loaded_tca.results.figure import compared, of_bending
from loaded_tca.results.figures import FIGURES
from loaded_tca.scene.section import as_table
from tests.refusals import refusals, refused_calls
from tests.samples.results import changed, changed_scene, result, with_a_gap


def two_torques():
    return result(torques=(20.0, 80.0))


def test_differences_are_those_to_the_first():
    first = two_torques()
    higher = changed(first, peak_pressure=1.25 * first.peak_pressure)
    figures = compare_results({"first": first, "higher": higher}).figures
    assert figures.result.values.tolist() == ["first", "higher"]
    peaks = np.nanmax(first.peak_pressure, axis=(1, 2))
    pressure = figures.sel(figure="peak_pressure_MPa")
    assert_allclose(pressure.value.transpose("result", "torque"), [peaks, 1.25 * peaks])
    assert_allclose(pressure.difference.transpose("result", "torque"), [0.0 * peaks, 0.25 * peaks])
    assert_allclose(pressure.relative_difference.sel(result="higher"), 0.25)
    others = figures.drop_sel(figure=["peak_pressure_MPa", "peak_pressure_where_hertz_holds_MPa"])
    assert not others.difference.fillna(0.0).any()


def test_relative_difference_of_a_negative_figure_is_that_of_its_size():
    """The sign is a direction: a transmission error of -9 um is by 1/8 larger than one of -8 um, and +8 um no part."""
    first = two_torques()
    behind = changed(first, transmission_error=1.125 * first.transmission_error)
    ahead = changed(first, transmission_error=-first.transmission_error)
    comparison = compare_results([first, behind, ahead])
    mean = comparison.figures.sel(figure="transmission_error_mean_um")
    assert (mean.value.sel(result="result 2") < 0.0).all()
    relative = mean.relative_difference.transpose("result", "torque")
    assert_allclose(relative[1], 0.125, rtol=1e-12)  # one difference over one number: 1e-15 seen
    assert np.isnan(relative[2]).all()
    row = next(line for line in comparison.summary().splitlines() if line.startswith("transmission error, mean"))
    assert "(+12.5 %)" in row
    assert row.count("%") == 1


@pytest.mark.parametrize("name", ["pinion_angle_at_peak_deg", "pinion_axial_at_peak_mm"])
def test_places_have_no_relative_difference(name):
    """Their zero, mid-face or the pitch point, is no amount of anything."""
    moved = changed(two_torques(), peak_axial=two_torques().peak_axial + 1.0)
    figure = compare_results([two_torques(), moved]).figures.sel(figure=name)
    assert np.isfinite(figure.difference).all()
    assert np.isnan(figure.relative_difference).all()


def test_rounding_and_unknown_figures_have_no_relative_difference():
    first = changed(two_torques(), unloaded_transmission_error=1e-18 * np.arange(5.0))
    second = changed(two_torques(), unloaded_transmission_error=5e-18 * np.arange(5.0))
    figures = compare_results([first, second]).figures.sel(result="result 2")
    assert_array_equal(figures.difference.sel(figure="unloaded_transmission_error_span_um"), 0.0)
    for name in ("unloaded_transmission_error_span_um", "transmission_error_order_1_um"):
        assert np.isnan(figures.relative_difference.sel(figure=name)).all()


def test_compared_are_the_torques_that_all_have():
    comparison = compare_results({"a": two_torques(), "b": result(torques=(80.0, 50.0)), "c": result(torques=(80.0,))})
    assert_array_equal(comparison.torque, [80e3])
    assert_array_equal(comparison.indices, [[1, 0, 0]])
    values = comparison.figures.value.sel(torque=80e3, figure="peak_pressure_MPa")
    assert_allclose(values, np.nanmax(two_torques().peak_pressure[1]), rtol=1e-6)  # to the tolerance of the solver
    note = "note: all have the torques 80 N m; left out: a 20; b 50 N m"
    assert comparison.summary().splitlines()[-1] == note
    assert "note" not in compare_results([two_torques(), two_torques()]).summary()


test_what_is_no_pair_of_results_is_told = refusals(
    compare_results,
    ([], "results: 0 given"),
    ({"alone": None}, "results: 1 given"),
    (["out", "other"], "results: result 1 is no MeshCycle but 'out'"),
)


test_comparison_refuses = refused_calls(
    (
        lambda: compare_results({"a": two_torques(), "b": result()}),
        r"have no torque in common \(a: 20, 80 N m; b: 130 N m\)",
    ),
    (
        lambda: compare_results([two_torques(), two_torques()]).summary(50e3),
        "torque: 50 N m; the results share 20, 80 N m",
    ),
)


def test_keys_of_the_scenes_that_differ():
    crowned = changed_scene(two_torques(), {"pinion.modifications.lead_crowning_um": 7.5, "title": "another"})
    comparison = compare_results({"a": two_torques(), "b": crowned})
    own = as_table(two_torques().scene)["pinion"]["modifications"]["lead_crowning_um"]
    assert comparison.differing_keys == {"pinion.modifications.lead_crowning_um": (own, 7.5)}
    row = comparison.summary().splitlines()[2]
    assert row.split() == ["pinion.modifications.lead_crowning_um", f"{own}", "7.5"]


def test_gears_of_other_families_are_compared_in_what_both_have():
    bevel = result("straight_bevel", positions=3, torques=(20.0, 80.0))
    comparison = compare_results({"helical": two_torques(), "bevel": bevel})
    assert comparison.differing_keys["pair.type"] == ("cylindrical", "straight_bevel")
    assert comparison.differing_keys["pair.helix_angle_deg"][1] is None
    assert np.isfinite(comparison.figures.difference.sel(figure="peak_pressure_MPa")).all()
    assert "more keys of the scenes differ" in comparison.summary()


def test_harmonics_of_one_pair_that_carries_all_are_unknown():
    alone = result("spur", positions=5, torques=(130.0,))
    shared = result("mesh_cycle_spur", positions=5, torques=(130.0,))
    comparison = compare_results({"shared": shared, "alone": alone})
    assert comparison.differing_keys["analysis.load_sharing"] == (True, False)
    row = next(line for line in comparison.summary().splitlines() if "order 1 of the tooth mesh" in line)
    assert row.split()[-2:] == ["-", "-"]  # neither value nor difference


def test_summary_has_values_and_both_differences():
    first = two_torques()
    lines = compare_results({"a": first, "b": changed(first, peak_pressure=2.0 * first.peak_pressure)}).summary(20e3)
    head, names, row = lines.splitlines()[:3]
    assert head.startswith("Compared with a, pinion torque 20 N m; % of absolute values")
    assert names.split() == ["a", "b"]
    peak = np.nanmax(first.peak_pressure[0])
    assert row.split()[-5:] == [f"{peak:.4g}", f"{2.0 * peak:.4g}", f"+{peak:.4g}", "(+100.0", "%)"]


def with_peak_at_an_edge(share):
    """Two torques, whose peak pressure under the larger one is 9000 MPa at an edge, on a pair with such a share."""
    cycle = two_torques()
    numbers = {name: getattr(cycle, name).copy() for name in ("peak_pressure", "load_share", "on_edge")}
    place = 1, *cycle.peak_contact(1)
    numbers["peak_pressure"][place], numbers["load_share"][place], numbers["on_edge"][place] = 9000.0, share, 1
    return changed(cycle, **numbers)


def test_peak_at_an_edge_on_a_pair_that_carries_little_is_told():
    edged = with_peak_at_an_edge(0.036)
    comparison = compare_results({"a": two_torques(), "b": edged})
    (sentence,) = comparison.findings()
    assert sentence.startswith("b: the peak pressure 9000 MPa at 80 N m lies in slices at an edge, on a pair that ")
    carrying = edged.peak_pressure[1][edged.load_share[1] >= 0.1]
    assert "carries 3.6 % of the torque; on pairs that carry a tenth of the torque or more the peak pressure is " in (
        sentence
    )
    assert float(sentence.split()[-2]) == pytest.approx(np.nanmax(carrying), rel=1e-3)  # four digits
    assert comparison.summary().splitlines()[-1] == f"finding: {sentence}"
    assert comparison.findings(20e3) == ()
    assert compare_results([two_torques(), with_peak_at_an_edge(0.2)]).findings() == ()


def test_lists_of_measured_points_are_counted():
    assert written_value([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]) == "2 lists, 6 values"
    assert written_value((8.0, 16.0)) == "[8.0, 16.0]"


def with_error(cycle, part, times=1.0):
    """The result with a discretisation error everywhere, and other peaks."""
    return changed(
        cycle,
        discretisation_error=np.full_like(cycle.discretisation_error, part),
        peak_pressure=times * cycle.peak_pressure,
    )


@pytest.mark.parametrize(("times", "expected"), [(1.015, 0.0), (1.03, 1.0)])
def test_differences_are_beyond_the_errors_of_both_results_added(times, expected):
    """Of 1 % each: 1.5 % of the first are within them, 3 % are not."""
    comparison = compare_results({"a": with_error(two_torques(), 0.01), "b": with_error(two_torques(), 0.01, times)})
    beyond = comparison.beyond_errors.sel(figure="peak_pressure_MPa")
    assert_array_equal(beyond.sel(result="b"), expected)
    assert np.isnan(beyond.sel(result="a")).all()
    peaks = np.nanmax(two_torques().peak_pressure, axis=(1, 2))
    error = comparison.figures.difference_error.sel(figure="peak_pressure_MPa", result="b")
    assert_allclose(error, 0.01 * (1.0 + times) * peaks, rtol=1e-12)  # a sum of two products
    row = next(line for line in comparison.summary().splitlines() if line.startswith("peak pressure"))
    assert row.endswith(" *") == bool(expected)


def test_differences_of_which_no_error_is_stated_are_not_marked():
    """A pressure without an estimate, an estimate without a limit, and flanks whose teeth do not bend."""
    for part in (np.nan, np.inf):
        comparison = compare_results([with_error(two_torques(), part), with_error(two_torques(), 0.01, 9.0)])
        assert not (comparison.beyond_errors == 1.0).any()
    assert comparison.relative_errors.sel(figure="transmission_error_span_um").isnull().all()


def test_errors_are_those_that_the_sentences_on_the_accuracy_state():
    alone = result("mesh_cycle_spur", positions=5, torques=(40.0, 130.0))
    bending = changed_scene(alone, {"analysis.compliance": None})
    figures, errors = bending.key_figures()[0], []
    for name, figure in FIGURES.items():
        if figure.accuracy in (compared, of_bending) and not figure.needs:
            error = figure.relative_error(name, bending, 0, figures)
            sentence = figure.accuracy(name, bending, slice(0, 1), [figures])
            assert np.isnan(error) == (sentence == "")
            assert np.isnan(error) or f"within {100.0 * error:g} % of finite elements" in sentence
            errors.append(error)
    assert np.isfinite(errors).sum() > 4


def test_positions_without_contact_do_not_hinder():
    figures = compare_results([two_torques(), with_a_gap()]).figures
    assert_array_equal(figures.difference.sel(figure="positions_in_contact", result="result 2"), -1.0)


def test_edge_pressure_is_named_by_the_edges_of_all_results():
    sharp = result("misaligned", positions=2)
    rounded = changed(sharp, edge_is_rounded=np.ones_like(sharp.edge_is_rounded))
    for results, label in (
        ([sharp, sharp], "at a sharp edge of any pair, mesh-dependent [MPa]"),
        ([rounded, sharp], "at an edge of any pair, mesh-dependent if sharp [MPa]"),
        ([rounded, rounded], "at a rounded edge [MPa]"),
        ([rounded, result(positions=1)], "at a rounded edge [MPa]"),  # the other one reaches no edge
    ):
        text = compare_results(results).summary()
        assert any(line.startswith(label) for line in text.splitlines()), text
    assert "edge" not in compare_results([result(positions=1), result(positions=1)]).summary()
