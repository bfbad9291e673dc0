"""docs/scene.md says what the parser does."""

import re
from pathlib import Path

import pytest

from loaded_tca.errors import InputError
from loaded_tca.scene import describe_keys, parse_scene

ROOT = Path(__file__).parents[2]

PAGE = (ROOT / "docs" / "scene.md").read_text(encoding="utf-8")


def test_reference_of_the_keys_is_up_to_date():
    head, _, reference = PAGE.partition("## Keys\n\n")
    assert head
    assert reference == describe_keys(), "put the output of loaded_tca.scene.describe_keys() below '## Keys'"


def test_shortest_scene_is_one():
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert parse_scene(text).pinion_hand == "right"


def test_messages_shown_are_those_that_come():
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    wrong = text.replace("normal_module_mm", "modul").replace("teeth = 34", "teeth = -34")
    with pytest.raises(InputError) as raised:
        parse_scene(wrong + "[wheel.modifications]\ntip_relief_um = 20.0")
    assert str(raised.value) == shown.strip()


def test_every_kind_of_default_is_described():
    text = describe_keys()
    assert "| `teeth` | a whole number from 3 to 10000 | **required** | number of teeth z |" in text
    assert "| `profile_shift` | a number from -5 to 5 | `0.0` | profile shift coefficient x |" in text
    assert "| `tip_diameter_mm` | a number above 0, up to 100000 | d + 2 m_n (1 + x) | tip diameter d_a |" in text
