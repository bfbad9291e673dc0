"""Numbers in sentences: those that a person reads without an exponent have none."""

import math

import pytest

from loaded_tca.plain import Sentence, plain
from loaded_tca.results.summary import shown
from loaded_tca.warning_kinds import ANOTHER_POSITION, ODD_INPUT


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (130.0, 2, "130"),
        (118204.0, 2, "120000"),
        (999.96, 4, "1000"),
        (0.05, 4, "0.05"),
        (-0.0, 4, "0"),
        (-3.25e-5, 3, "-0.0000325"),
        (4.4e-8, 2, "4.4e-08"),
        (206e9, 4, "2.06e+11"),
        (math.inf, 4, "inf"),
    ],
)
def test_number_is_that_of_the_general_format_without_an_exponent(value, digits, text):
    assert plain(value, digits) == text
    assert float(text) == float(f"{value:.{digits}g}")


@pytest.mark.parametrize("name", ["pinion_bearing_life_Mrev", "wheel_root_life_h"])
def test_lives_beyond_a_million_are_those_of_catalogues(name):
    """Of L10 by the cube of the load a hundredth of the load has a million times the life: digits say nothing."""
    texts = [shown(life, name) for life in (51234.0, 1e6, 3.21e11, math.inf)]
    assert texts == ["51230", "1000000", ">1e6", "inf"]
    assert shown(3.21e11, "normal_force_N") == "321000000000"


def test_sentences_have_plain_numbers_signs_and_words():
    assert Sentence().format("{a:+.2g} {b:g} {c} {d:.0%}", a=120.0, b=1e6, c="um", d=0.25) == "+120 1000000 um 25%"


def test_warnings_have_plain_numbers():
    odd = ODD_INPUT.sentence(key="k", value=2.06e8, unit="MPa", what="more than that of any material of gears")
    assert odd.startswith("k: 206000000 MPa is more")
    kink = ANOTHER_POSITION.sentence(figure="peak to peak", change=130.0, unit="um", size=0.5, key="k", count=1, keys=2)
    assert "by +130 um another position" in kink
