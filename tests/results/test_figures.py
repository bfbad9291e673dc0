"""Declarations of key figures: every figure has what the texts that show it ask for, and stands in the reference."""

import re
from pathlib import Path

import pytest

from loaded_tca.plots.style import label_of
from loaded_tca.results.figure import labelled
from loaded_tca.results.figures import FIGURES, SUMMARY, declared, key_figures
from loaded_tca.studies.ranking import MAIN_FIGURES
from loaded_tca.units import UNITS, unit_of, without_unit
from tests.samples.results import result
from tests.samples.root_stress import result as with_root_stress

REFERENCE = (Path(__file__).parents[2] / "docs" / "reference" / "key_figures.md").read_text(encoding="utf-8")
STAND_FOR = {"wheel_(?!single)": "pinion_", "compression": "tension", "order_[23]": "order_1"}
"""What a row of the reference leaves out -> the one that it names for it."""


@pytest.mark.parametrize("name", FIGURES)
def test_figure_stands_in_the_reference_or_one_that_stands_for_it(name):
    for part, other in STAND_FOR.items():
        name = re.sub(part, other, name)
    assert f"`{name}`" in REFERENCE


def test_results_have_the_figures_that_are_declared_and_those_of_roots_where_asked():
    on_rigid_supports = [name for name, figure in FIGURES.items() if figure.is_of_roots or not figure.needs]
    of_flanks = [name for name in on_rigid_supports if not FIGURES[name].is_of_roots]
    assert [*key_figures(result(), 0)] == of_flanks
    assert [*key_figures(with_root_stress(), 0)] == on_rigid_supports


@pytest.mark.parametrize("place", [lambda figure: figure.rank, lambda figure: figure.slope and figure.slope.place])
def test_places_of_figures_in_rankings_and_columns_are_their_own(place):
    places = [at for figure in FIGURES.values() if (at := place(figure)) is not None]
    assert sorted(places) == list(range(1, len(places) + 1))


def test_peak_to_peak_transmission_error_ranks_variants():
    assert MAIN_FIGURES[0] == "transmission_error_span_um"


def test_figures_that_texts_show_have_a_label():
    shown = declared(lambda figure: figure.is_compared or figure.is_load_case or figure.is_scattered)
    assert all(FIGURES[name].label for name in shown)


def test_figures_of_texts_stand_in_the_summary():
    in_summary = {name for line in SUMMARY for name in line.names}
    apart = {name for name, figure in FIGURES.items() if figure.label or figure.slope or figure.rank}
    assert apart <= in_summary


def test_unit_is_the_longest_ending_that_a_name_has():
    assert [unit_of(f"x_{ending}") for ending in UNITS] == [unit.text for unit in UNITS.values()]
    assert without_unit("secant_stiffness_mean_N_per_mm_um") == "secant_stiffness_mean"
    assert labelled("line_load_N_per_mm", "line load") == "line load [N/mm]"
    assert labelled("face_load_factor", "K_Hbeta") == "K_Hbeta"


def test_axis_has_the_declared_words_and_the_printed_unit():
    assert label_of("transmission_error_span_um") == "peak-to-peak transmission error [µm]"
    assert label_of("pinion_axial_at_peak_mm") == "pinion axial at peak [mm]"
