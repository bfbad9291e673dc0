"""Numbers in sentences: those that a person reads without an exponent have none."""

import ast
import math
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import loaded_tca
from loaded_tca.plain import Sentence, plain
from loaded_tca.results.summary import shown
from loaded_tca.scene.section import rule
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
        (4.4e-8, 2, "4.4e-8"),
        (206e9, 4, "2.06e11"),
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
    odd = ODD_INPUT.sentence(key="k", value=2.06e8, unit="MPa", what="more than the modulus of any gear material")
    assert odd.startswith("k: 206000000 MPa is more")
    kink = ANOTHER_POSITION.sentence(figure="peak to peak", change=130.0, unit="um", size=0.5, key="k", count=1, keys=2)
    assert "by +130 um another position" in kink


FOR_PROGRAMS = 9
"""Digits from which a general format is that of a table, which programs read."""


def general_formats(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of each field of a format string whose numbers would have exponents where people write none."""
    if "g}" not in source:  # the end of every such field: most modules need not be parsed
        return
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FormattedValue) and node.format_spec is not None:
            parts = node.format_spec.values
            spec = "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in parts)
            if (digits := re.fullmatch(r"[^.]*\.?(\d*)g", spec)) and int(digits[1] or 6) < FOR_PROGRAMS:
                yield node.lineno, spec
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "format":
            template = node.func.value
            if isinstance(template, ast.Constant) and re.search(r"\{[^{}]*:[^{}]*g\}", str(template.value)):
                yield node.lineno, template.value


def test_scan_sees_general_formats():
    """Those of tables, of sentences and of whole numbers are none."""
    source = 'f"{a:.2g} {b:>8.4g} {c:g} {d:.9g} {e:+.1f} {f:d}" + "{:g}".format(g) + Sentence().format("{:g}", h)'
    assert {spec for _, spec in general_formats(source)} == {".2g", ">8.4g", "g", "{:g}"}


def test_messages_have_plain_numbers():
    """A general format writes 1.3e+02 for 130 with two digits; ``plain`` and ``Sentence`` do not."""
    package = Path(loaded_tca.__file__).parent
    formats = [
        f"{path.relative_to(package)}:{line}: {spec}"
        for path in sorted(package.rglob("*.py"))
        if path.name != "plain.py"
        for line, spec in general_formats(path.read_text(encoding="utf-8"))
    ]
    assert formats == []


def test_rules_of_scenes_have_plain_numbers():
    """Their templates have general formats, which ``Sentence`` fills in."""
    too_long = rule(("length_mm",), lambda length: length < 1.0, "found {0:g}; allowed below 1")
    assert too_long.complain(2.06e6) == "found 2060000; allowed below 1"
