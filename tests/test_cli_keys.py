"""The command 'keys'."""

import re

import pytest

from loaded_tca.cli import terminal
from loaded_tca.scene import describe_keys
from loaded_tca.stages import describe_stage_keys


def test_all_keys_of_the_page_of_keys_are_shown(run):
    code, out, errors = run("keys")
    assert (code, errors) == (0, [])
    names = re.findall(r"^\| `(\w+)` \|", describe_keys() + describe_stage_keys(), re.MULTILINE)
    names = [name for name in names if not name.startswith("_")]  # endings of keys in inches
    shown = [line.split()[0].rpartition(".")[2].rstrip(",") for line in out.splitlines() if re.match(r"  \S", line)]
    assert shown == names


def test_word_is_looked_for_in_names_and_meanings_and_spellings(run):
    """With unit, default, what is allowed and the meaning; a section that is another one's, too, is named."""
    code, out, _ = run("keys", "LEAD_crowning_um")
    assert (code, out.splitlines()) == (
        0,
        [
            "[pinion.modifications], [wheel.modifications]: material removed from the flanks",
            "  pinion.modifications.lead_crowning_um [um] = 0.0",
            "    a number from 0 to 10000; lead crowning C_beta, at the ends of the face",
        ],
    )
    assert run("keys", "wheel.modifications.lead_crowning_um")[1] == out
    assert "pair.helix_angle_deg [deg] = 0.0" in run("keys", "helix angle beta")[1]  # of its meaning alone
    assert "pair.normal_module_mm [mm]" in run("keys", "mn")[1]


def test_word_that_no_key_has_is_refused_with_those_near(refused):
    near = "lead_crowning_um, lead_crowning_form, profile_crowning_um"
    assert refused("keys", "crowing") == f"crowing: no key has this word in its name or meaning; near are {near}"
    assert refused("keys", "%%%") == "%%%: no key has this word in its name or meaning"


@pytest.mark.parametrize("width", [50, 90])
def test_keys_fit_the_terminal(run, monkeypatch, width):
    monkeypatch.setattr("loaded_tca.cli.keys.width_of_lines", lambda: width)
    lines = run("keys", "tip")[1].splitlines()
    assert max(map(len, lines)) <= width
    assert terminal.width_of_lines() == 120
