"""Deliberate faults of ``tests/faults.py``: their texts stand in the package, their tests among the tests."""

import re
from functools import cache
from pathlib import Path

import pytest

from tests.faults import FAULTS, ROOT

PACKAGE, TESTS = ROOT / "loaded_tca", Path(__file__).parent


@cache
def text_of(path):
    return path.read_text(encoding="utf-8")


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.what)
def test_fault_has_its_place_in_the_package_and_a_test_that_make_test_runs(fault, collected):
    """The tests are told by their files; where these are among the tests of this run, their cases by their marks."""
    assert text_of(PACKAGE / fault.file).count(fault.text) == 1
    assert fault.wrong != fault.text
    file, _, name = fault.test.partition("::")
    assert re.search(rf"^(def {name}\(|{name} = )", text_of(TESTS / file), re.MULTILINE)
    marked = re.search(rf"^@pytest\.mark\.thorough\n(@.*\n)*def {name}\(", text_of(TESTS / file), re.MULTILINE)
    assert not marked
    assert collected.get(f"tests/{fault.test}", True)


def test_faults_are_told_apart():
    assert len({fault.what for fault in FAULTS}) == len(FAULTS)
