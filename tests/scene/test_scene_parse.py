"""Files and texts: what is read, and what can go wrong before there are keys to check."""

import re
from pathlib import Path

import pytest

from loaded_tca.errors import InputError
from loaded_tca.scene import parse_scene, read_scene
from loaded_tca.scene.parse import literal_value

ROOT = Path(__file__).parents[2]


def refusal(function, *arguments):
    with pytest.raises(InputError) as raised:
        function(*arguments)
    (problem,) = raised.value.problems
    return problem


def test_file_gives_the_scene_of_its_text(tmp_path, scene, small):
    path = tmp_path / "scene.toml"
    path.write_text(small, encoding="utf-8")
    assert read_scene(path) == read_scene(str(path)) == scene


def test_file_may_start_with_a_byte_order_mark_and_end_lines_as_windows_does(tmp_path, scene, small):
    path = tmp_path / "scene.toml"
    path.write_bytes(b"\xef\xbb\xbf" + small.replace("\n", "\r\n").encode())
    assert read_scene(path) == scene


def test_file_that_is_not_there_is_told(tmp_path):
    path = tmp_path / "none.toml"
    assert refusal(read_scene, path) == f"{path}: cannot be read: No such file or directory"


def test_directory_is_told(tmp_path):
    assert refusal(read_scene, tmp_path) == f"{tmp_path}: cannot be read: Is a directory"


def test_impossible_path_is_told():
    assert "cannot be read" in refusal(read_scene, "a\0b")


def test_file_that_is_not_utf8_is_told_with_its_line(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(b'[pair]\ntitle = "Stra\xdfe"\n')
    assert refusal(read_scene, path) == f"{path}: not a text file in UTF-8 (line 2)"


def test_file_that_is_not_toml_is_told_with_its_line(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("[pair]\nnormal_module_mm: 3\n", encoding="utf-8")
    assert re.match(rf"{re.escape(str(path))}: not a TOML file: .*line 2", refusal(read_scene, path))


def test_file_that_is_too_long_is_told(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(b"#" * 3 * 10**6)
    assert refusal(read_scene, path) == f"{path}: more than 2097152 bytes; no scene and no flank is so long"


def test_empty_text_misses_every_required_key():
    with pytest.raises(InputError) as raised:
        parse_scene("")
    assert [line.split(":")[0] for line in raised.value.problems] == [
        "pair.type",
        "pair.normal_module_mm",
        "pinion.teeth",
        "pinion.face_width_mm",
        "wheel.teeth",
        "wheel.face_width_mm",
        "load.pinion_torque_Nm",
        "material",
    ]


@pytest.mark.parametrize("text", ["a = " + "[" * 30000, "a = " + "{a=" * 15000], ids=["lists", "tables"])
def test_text_nested_too_deeply_is_told(text):
    assert refusal(parse_scene, text, "deep.toml") == "deep.toml: not a scene: nested too deeply"


def test_key_of_too_many_parts_is_told_at_once():
    assert refusal(parse_scene, "\n" + "a." * 30000 + "a = 1") == "scene: line 2 holds more than 2000 dots"


def test_many_keys_of_many_parts_are_told_at_once():
    text = "\n".join(f"a{line}." + "a." * 1900 + "a = 1" for line in range(500))
    expected = "scene: too many lines with hundreds of dots; allowed up to 100 numbers in a line"
    assert refusal(parse_scene, text) == expected


def test_whole_number_of_too_many_digits_is_told():
    text = "title = 'Long'\n[pair]\nnormal_module_mm = " + "1_0" * 2500
    assert refusal(parse_scene, text) == "scene: line 3 holds a whole number of more than 4300 digits"


def test_lone_surrogate_in_a_title_is_told_in_plain_characters(small):
    assert r"\ud800" in refusal(parse_scene, small.replace("Small", "\ud800"))


def test_date_is_no_number(small):
    text = small.replace("130.0", "2024-02-29")
    expected = "load.pinion_torque_Nm: found 2024-02-29; allowed a number from 0 to 1e9"
    assert refusal(parse_scene, text) == expected


def test_nothing_in_a_file_is_evaluated(small):
    assert "found" in refusal(parse_scene, small.replace("130.0", "\"__import__('os').getpid()\""))


EXAMPLES = sorted((ROOT / "examples" / "scenes").glob("*.toml"))


@pytest.mark.parametrize("path", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_example_is_read_and_written_back(path):
    scene = read_scene(path)
    assert scene.title
    assert parse_scene(scene.to_toml()) == scene


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("6", 6),
        ("-1.5e-3", -1.5e-3),
        ("true", True),
        ("[1, 2.5]", [1, 2.5]),
        ('"6"', "6"),
        ("left", "left"),
        ("two words", "two words"),
        ("", ""),
        ("[1, 2", "[1, 2"),
        ("1\nother = 2", "1\nother = 2"),
        ("9" * 5000, "9" * 5000),
        ("[" * 5000, "[" * 5000),
    ],
)
def test_literal_is_read_as_in_a_file_and_any_other_text_is_a_string(text, value):
    found = literal_value(text)
    assert (found, type(found)) == (value, type(value))
