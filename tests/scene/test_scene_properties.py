"""A file of any content ends in a scene or an InputError, and every scene survives its own text."""

import copy
import json
import tomllib
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from loaded_tca.errors import GeometryError, InputError
from loaded_tca.scene import Scene, parse_scene, read_scene, scene_from_table
from loaded_tca.scene.keys import Choice, Either, Grid, Key, Line, List, Number, Whole, ZeroOr
from loaded_tca.scene.parse import FAMILIES
from loaded_tca.scene.section import Subsection, Tables, as_table, entries

ROOT = Path(__file__).parents[2]

SCENES = ROOT / "examples" / "scenes"
EXAMPLES = [path.read_text(encoding="utf-8") for path in sorted(SCENES.glob("*.toml"))]
TABLES = [tomllib.loads(text) for text in EXAMPLES]
READ = [read_scene(path) for path in sorted(SCENES.glob("*.toml"))]
CYLINDRICAL = (SCENES / "fzg_c14.toml").read_text(encoding="utf-8")


def names(section: type) -> set[str]:
    found = set(entries(section))
    for _, entry in entries(section).values():
        if isinstance(entry, Subsection):
            found |= names(entry.section)
    return found


FAMILY_SCENES = list(dict.fromkeys(FAMILIES.values()))
NAMES = sorted(set().union(*(names(scene) for scene in FAMILY_SCENES)))
key_names = st.sampled_from(NAMES) | st.text(max_size=8)
values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.integers(min_value=10**300, max_value=10**320)
    | st.floats()
    | st.text(max_size=20)
    | st.sampled_from(
        ["cylindrical", "straight_bevel", "spiral_bevel", "face_milled", "pinion", "concave", "linear", "contact"]
    )
    | st.dates()
    | st.datetimes()
    | st.times(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(key_names, inner, max_size=6),
    max_leaves=20,
)


def outcome(function, argument):
    """The Scene, or the lines of the InputError; nothing else may come out."""
    try:
        return function(argument)
    except InputError as error:
        return error.problems


def ends_well(function, argument):
    """Assert that a scene or readable lines come out, and that the scene survives its own text."""
    result = outcome(function, argument)
    if isinstance(result, Scene):
        assert parse_scene(result.to_toml()) == result
    else:
        assert result
        assert all(len(problem.encode()) < 500 for problem in result)


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


@given(st.sampled_from(READ), st.data())
def test_changes_are_told_as_those_of_a_whole_file_are(scene, data):
    """Sections without a change are not checked again, which must make no difference."""
    table = as_table(scene)
    places = [".".join(place) for place in all_places(table)]
    deeper = st.tuples(st.sampled_from(places), st.sampled_from(NAMES)).map(".".join)
    paths = st.sampled_from(places) | deeper
    changes = data.draw(st.dictionaries(paths, values | st.floats(0.1, 100.0), min_size=1, max_size=4))
    given_before = copy.deepcopy(changes)
    found = outcome(scene.with_changes, changes)
    for path, value in copy.deepcopy(changes).items():
        *sections, name = path.split(".")
        place = table
        for section in sections:
            place[section] = place[section] if isinstance(place.get(section), dict) else {}
            place = place[section]
        place[name] = value
    assert found == outcome(scene_from_table, table)
    assert changes == given_before


def sound_values(kind):
    """Every value that a kind allows."""
    if isinstance(kind, Number):
        return st.floats(kind.low, kind.high, exclude_min=kind.above)
    if isinstance(kind, ZeroOr):
        return st.one_of(st.just(0.0), sound_values(kind.number))
    if isinstance(kind, Whole):
        return st.integers(kind.low, kind.high)
    if isinstance(kind, Choice):
        return st.sampled_from(kind.options)
    if isinstance(kind, Either):
        return st.one_of(*map(sound_values, kind.kinds))
    if isinstance(kind, Tables):
        return st.lists(sound_tables(kind.section), max_size=2)
    if isinstance(kind, Line):
        return st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]), max_size=kind.longest)
    if isinstance(kind, Grid):
        return st.integers(kind.shortest, kind.shortest + 1).flatmap(
            lambda length: st.lists(
                st.lists(sound_values(kind.number), min_size=length, max_size=length),
                min_size=kind.shortest,
                max_size=kind.shortest + 1,
            )
        )
    if isinstance(kind, Tables):
        return st.lists(sound_tables(kind.section), min_size=kind.shortest, max_size=kind.shortest + 1)
    assert isinstance(kind, List)
    return st.lists(sound_values(kind.kind), min_size=kind.shortest, max_size=max(kind.shortest, min(kind.longest, 5)))


@st.composite
def sound_tables(draw, section=None):
    """Tables that hold only values allowed one by one, by default of a scene of any family."""
    section = section or draw(st.sampled_from(FAMILY_SCENES))
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
    result = outcome(scene_from_table, table)
    if isinstance(result, Scene):
        assert parse_scene(result.to_toml()) == result
    else:
        assert not any("unknown" in problem or "allowed a number" in problem for problem in result)


@given(st.sampled_from(TABLES), st.sampled_from(NAMES), st.data())
def test_misspelt_key_is_never_taken_silently(table, name, data):
    table = copy.deepcopy(table)
    section = data.draw(st.sampled_from(["pair", "pinion", "wheel", "material", "load", "analysis"]))
    table.setdefault(section, {})[name + "x"] = 1.0
    with pytest.raises(InputError, match=rf"{section}\.{name}x: unknown key"):
        scene_from_table(table)


@given(st.text(max_size=30))
def test_title_is_kept_to_the_character(title):
    text = CYLINDRICAL.split("title =")[0] + "[pair]" + CYLINDRICAL.split("[pair]")[1]
    encoded = json.dumps(title).replace("\x7f", "\\u007f")
    result = outcome(parse_scene, f"title = {encoded}\n" + text)
    if isinstance(result, Scene):
        assert result.title == title
        assert parse_scene(result.to_toml()).title == title


gears = st.fixed_dictionaries(
    {"pinion.teeth": st.integers(3, 10000), "wheel.teeth": st.integers(3, 10000)},
    optional={
        "pair.helix_angle_deg": st.floats(0.0, 45.0),
        "pair.pressure_angle_deg": st.floats(10.0, 30.0),
        "pair.driving": st.sampled_from(["pinion", "wheel"]),
        "pair.centre_distance_mm": st.floats(1.0, 1000.0),
        "pinion.profile_shift": st.floats(-1.0, 1.0),
        "pinion.tip_diameter_mm": st.floats(1.0, 1000.0),
        "pinion.face_width_mm": st.floats(1e-3, 100.0),
        "pinion.modifications.lead_crowning_um": st.floats(0.0, 10000.0),
        "pinion.modifications.lead_crowning_form": st.sampled_from(["circular", "logarithmic"]),
        "mounting.in_plane_deg": st.floats(-10.0, 10.0),
        "mounting.misalignment_um": st.floats(-10000.0, 10000.0),
    },
)


@pytest.mark.filterwarnings("ignore:pinion.modifications.lead_crowning")
@given(gears)
def test_scene_makes_a_pair_or_says_why_not(changes):
    scene = parse_scene(CYLINDRICAL).with_changes(
        {"pair.centre_distance_mm": None, "pinion.tip_diameter_mm": None, "wheel.tip_diameter_mm": None} | changes
    )
    try:
        pair = scene.pair()
    except (InputError, GeometryError) as problem:
        told = str(problem)
    else:
        told = repr(pair)
    assert "nan" not in told


bevel_gears = st.fixed_dictionaries(
    {"pinion.teeth": st.integers(3, 200), "wheel.teeth": st.integers(3, 200)},
    optional={
        "pair.shaft_angle_deg": st.floats(1.0, 179.0),
        "pair.spiral_angle_deg": st.floats(0.0, 59.0),
        "pair.pressure_angle_deg": st.none() | st.floats(1.0, 44.0),
        "pair.normal_pressure_angle_deg": st.floats(1.0, 44.0),
        "pair.pinion_flank": st.sampled_from(["concave", "convex"]),
        "pair.driving": st.sampled_from(["pinion", "wheel"]),
        "pinion.hand": st.sampled_from(["left", "right"]),
        "wheel.profile_shift": st.floats(-1.0, 1.0),
        "wheel.face_angle_deg": st.floats(1.0, 179.0),
        "pinion.root_angle_deg": st.floats(1.0, 179.0),
        "pinion.bore_diameter_mm": st.floats(1.0, 100.0),
        "pinion.modifications.tip_relief_um": st.floats(0.0, 100.0),
        "pinion.modifications.tip_relief_start_roll_deg": st.floats(0.0, 60.0),
        "mounting.shaft_angle_error_deg": st.floats(-10.0, 10.0),
        "mounting.offset_mm": st.floats(-5.0, 5.0),
    },
)


@pytest.mark.thorough
@given(bevel_gears)
def test_bevel_scene_makes_a_pair_or_says_why_not(changes):
    nominal = parse_scene((SCENES / "spiral_bevel.toml").read_text(encoding="utf-8"))
    try:
        scene = nominal.with_changes({"wheel.hand": None, **changes})
        told = repr(scene.pair())
        assert all("nan" not in cell for row in (*scene.geometry_rows(), *scene.force_rows([1e3])) for cell in row[1:])
    except (InputError, GeometryError) as problem:
        told = str(problem)
    assert "nan" not in told.split()
