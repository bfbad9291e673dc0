"""The guide to scene files, and the reference of their keys, say what the parser does."""

import re
from pathlib import Path

import pytest

from loaded_tca.errors import InputError
from loaded_tca.scene import describe_keys, parse_scene
from loaded_tca.scene.parse import FAMILIES

ROOT = Path(__file__).parents[2]

PAGE = (ROOT / "docs" / "guide" / "scene_files.md").read_text(encoding="utf-8")


def test_shortest_scenes_are_scenes():
    cylindrical, bevel, blank, face_milled, *_ = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert parse_scene(cylindrical).hands[0] == "right"
    assert parse_scene(bevel).contact_sides == ("concave", "convex")
    rest = "[pinion]" + bevel.partition("[pinion]")[2]
    assert parse_scene(blank + rest.replace("20.0", "25.4")).blanks().has_constant_slots
    assert parse_scene(face_milled).pair().teeth == (19, 62)


def test_messages_shown_are_those_that_come():
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
    text, *_ = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    wrong = text.replace("normal_module_mm", "modul").replace("teeth = 34", "teeth = -34")
    with pytest.raises(InputError) as raised:
        parse_scene(wrong + "[wheel.modifications]\ntip_relief_um = 20.0")
    assert str(raised.value) == shown.strip()


def test_every_kind_of_default_is_described():
    text = describe_keys()
    assert "| `teeth` | a whole number from 3 to 10000 | **required** | number of teeth z |" in text
    assert "| `profile_shift` | a number from -5 to 5 | `0.0` | profile shift coefficient x |" in text
    assert (
        "| `tip_diameter_mm` | a number above 0, up to 100000 | d + 2 m_n (h_aP + x + k) | tip diameter d_a |" in text
    )


def test_scene_made_without_a_file_is_one():
    *_, code = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    made = {}
    exec(code, made)
    assert made["scene"].pair().teeth == (39, 32)


def test_reference_describes_each_section_once_for_each_family():
    titles = [line for line in describe_keys().splitlines() if line.startswith("### ")]
    assert len(set(titles)) == len(titles)
    for name in ("pinion", "mounting"):  # those of double helical gears, too
        assert sum(f"`[{name}]`" in title for title in titles) == len({*FAMILIES.values()}) + 1
    assert sum("`[pair]`" in title for title in titles) == len({*FAMILIES.values()}) + 3  # by blanks and of racks, too
    for name in ("pinion.modifications", "material", "load", "analysis", "wheel.cutter", "pair.blank", "pair.settings"):
        assert sum(f"`[{name}]`" in title for title in titles) == 1
    assert sum("`[wheel]`" in title for title in titles) == 4  # of all, of double helical gears, of rings, of racks
    assert all(any(f"`{name}`" in title for title in titles) for name in FAMILIES)


def test_measured_gear_of_the_guide_has_the_allowance_that_it_says():
    """The high-speed stage of the 5 MW gearbox, whose report has the span 154.045 mm at A_sn = -0.130 mm."""
    *_, measured, tools = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    common = 'pair = { type = "cylindrical", normal_module_mm = 14.0, helix_angle_deg = 10.0 }\n'
    rest = "[wheel]\nteeth = 95\nface_width_mm = 360.0\nprofile_shift = 0.6691\n[load]\npinion_torque_Nm = 1000.0\n"
    material = "[material]\nyoungs_modulus_MPa = 206000.0\npoisson_ratio = 0.3\n"
    gear = parse_scene(common + measured + rest + material).mesh().pinion
    assert round(gear.thickness_allowance, 3) == -0.130
    assert round(2.0 * gear.tip_radius, 2) == 380.75
    text = (ROOT / "examples" / "scenes" / "helical.toml").read_text(encoding="utf-8")
    for section in re.split(r"\n(?=\[)", tools.strip()):
        header, _, keys = section.partition("\n")
        text = text.replace(header, f"{header}\n{keys}", 1)
    assert parse_scene(text).mesh().pinion.dedendum_coefficient == 1.4


@pytest.mark.thorough
def test_sheet_of_the_guide_is_a_scene_whose_contact_can_be_changed():
    page = (ROOT / "docs" / "guide" / "bevel_blanks.md").read_text(encoding="utf-8")
    (sheet,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    assert parse_scene(sheet).cut.pinion.machine.blank_offset_mm != 0.0
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    made = {}
    exec(code.replace("examples/", f"{(ROOT / 'examples').as_posix()}/"), made)
    assert made["path"].transmission_error[0] < made["path"].transmission_error[1]
