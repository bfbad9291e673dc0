"""A file of any content ends in a scene or an InputError, and every scene survives its own text."""

import copy
import json
import tomllib

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from loaded_tca import InputError
from loaded_tca.scene import Scene, parse_scene, read_scene, scene_from_table
from loaded_tca.scene.keys import Choice, Key, Line, List, Number, Whole
from loaded_tca.scene.section import Subsection, entries
from tests.scene.conftest import ROOT

EXAMPLES = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "examples" / "scenes").glob("*.toml"))]
TABLES = [tomllib.loads(text) for text in EXAMPLES]


def names(section: type) -> set[str]:
    found = set(entries(section))
    for _, entry in entries(section).values():
        if isinstance(entry, Subsection):
            found |= names(entry.section)
    return found


NAMES = sorted(names(Scene))
key_names = st.sampled_from(NAMES) | st.text(max_size=8)
values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.integers(min_value=10**300, max_value=10**320)
    | st.floats()
    | st.text(max_size=20)
    | st.sampled_from(["cylindrical", "pinion", "linear", "contact"])
    | st.dates()
    | st.datetimes()
    | st.times(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(key_names, inner, max_size=6),
    max_leaves=20,
)


def ends_well(function, argument):
    """Whether a Scene came out (True) or an InputError with readable lines (False); nothing else may happen."""
    try:
        scene = function(argument)
    except InputError as error:
        assert error.problems
        str(error).encode("utf-8")
        assert all(len(problem) < 400 for problem in error.problems)
        return False
    assert isinstance(scene, Scene)
    assert parse_scene(scene.to_toml()) == scene
    return True


@given(st.text())
def test_random_text_ends_well(text):
    ends_well(parse_scene, text)


@given(st.text(alphabet="[]{}=.\"',\n #abc0123456789-_+:TZ"))
def test_random_text_of_toml_characters_ends_well(text):
    ends_well(parse_scene, text)


@given(st.binary(max_size=200))
def test_random_bytes_end_well(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "random.toml"
    path.write_bytes(content)
    ends_well(read_scene, path)


@given(st.dictionaries(key_names, values, max_size=8))
def test_random_table_ends_well(table):
    ends_well(scene_from_table, table)


@given(st.sampled_from(EXAMPLES), st.data())
def test_text_with_a_piece_replaced_ends_well(text, data):
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 30)))
    piece = data.draw(st.text(max_size=10) | st.text(alphabet='[]{}=."\n #0123456789', max_size=10))
    ends_well(parse_scene, text[:start] + piece + text[end:])


def all_places(table: dict, path: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    found = []
    for name, value in table.items():
        found.append((*path, name))
        if isinstance(value, dict):
            found += all_places(value, (*path, name))
    return found


@st.composite
def mutated(draw):
    """A valid scene with one to four keys deleted, renamed, moved, or given another value."""
    table = copy.deepcopy(draw(st.sampled_from(TABLES)))
    for _ in range(draw(st.integers(1, 4))):
        *sections, name = draw(st.sampled_from(all_places(table)))
        place = table
        for section in sections:
            place = place[section]
        action = draw(st.sampled_from(["delete", "rename", "change", "scale", "add"]))
        if action in ("delete", "rename"):
            value = place.pop(name)
        if action == "rename":
            place[draw(key_names)] = value
        elif action == "change":
            place[name] = draw(values)
        elif action == "scale" and isinstance(place[name], int | float):
            place[name] *= draw(st.sampled_from([-1, 0, 10, 10**6, 10**400 if isinstance(place[name], int) else 1e300]))
        elif action == "add":
            place[draw(key_names)] = draw(values)
        assume(all_places(table))
    return table


@given(mutated())
def test_mutated_scene_ends_well(table):
    ends_well(scene_from_table, table)


def sound_values(kind):
    """Every value that a kind allows."""
    if isinstance(kind, Number):
        return st.floats(kind.low, kind.high, exclude_min=kind.above)
    if isinstance(kind, Whole):
        return st.integers(kind.low, kind.high)
    if isinstance(kind, Choice):
        return st.sampled_from(kind.options)
    if isinstance(kind, Line):
        return st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]), max_size=kind.longest)
    assert isinstance(kind, List)
    return st.lists(sound_values(kind.kind), min_size=kind.shortest, max_size=min(kind.longest, 5))


@st.composite
def sound_tables(draw, section=Scene):
    """Tables that hold only values allowed one by one."""
    table = {}
    for name, (_, entry) in entries(section).items():
        if isinstance(entry, Key):
            if entry.required or draw(st.booleans()):
                table[name] = draw(sound_values(entry.kind))
        elif not entry.optional or draw(st.booleans()):
            table[name] = draw(sound_tables(entry.section))
    return table


@given(sound_tables())
def test_sound_values_break_only_rules(table):
    """Values within their ranges are refused only for what they do together, never by their own key."""
    try:
        scene = scene_from_table(table)
    except InputError as error:
        assert not any("unknown" in problem or "allowed a number" in problem for problem in error.problems)
    else:
        assert parse_scene(scene.to_toml()) == scene


@given(st.sampled_from(TABLES), st.sampled_from(NAMES), st.data())
def test_misspelt_key_is_never_taken_silently(table, name, data):
    table = copy.deepcopy(table)
    section = data.draw(st.sampled_from(["pair", "pinion", "wheel", "material", "load", "analysis"]))
    table[section][name + "x"] = 1.0
    with pytest.raises(InputError, match=rf"{section}\.{name}x: unknown key"):
        scene_from_table(table)


@given(st.text(max_size=30))
def test_title_is_kept_to_the_character(title):
    text = EXAMPLES[0].split("title =")[0] + "[pair]" + EXAMPLES[0].split("[pair]")[1]
    try:
        encoded = json.dumps(title).replace("\x7f", "\\u007f")
        scene = parse_scene(f"title = {encoded}\n" + text)
    except InputError:
        return
    assert scene.title == title
    assert parse_scene(scene.to_toml()).title == title
