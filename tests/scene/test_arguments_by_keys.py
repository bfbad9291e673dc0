"""Refusals of gears and pairs in scenes: every word with an underscore in them is a key that files have."""

import re

import pytest

from loaded_tca import GeometryError, InputError, parse_scene, read_scene
from loaded_tca.results.gear_warnings import warn_of_gears
from loaded_tca.scene.section import Subsection, entries
from tests.samples.internal_pairs import SCENE
from tests.samples.results import SCENES


def names_of(section):
    """Keys and sections of a section and of those inside."""
    for name, (_, entry) in entries(section).items():
        yield name
        if isinstance(entry, Subsection):
            yield from names_of(entry.section)


def base(kind):
    return parse_scene(SCENE) if kind == "internal" else read_scene(SCENES / f"{kind}.toml")


REFUSED = [
    ("helical", "pinion: tip_chamfer_mm: ", {"pinion.tip_chamfer_mm": 4.0}),
    (
        "helical",
        "pinion: tip_chamfer_angle_deg: the chamfer stands out",
        {"pinion.tip_chamfer_mm": 0.3, "pinion.tip_chamfer_angle_deg": 2.0},
    ),
    (
        "helical",
        "reduce tip_chamfer_mm or tip_chamfer_angle_deg",
        {"pinion.tip_chamfer_mm": 1.5, "pinion.tip_chamfer_angle_deg": 80.0},
    ),
    (
        "helical",
        "pinion: ball_diameter_mm: a ball of 3 mm touches no flank",
        {"pinion.ball_measurement_mm": 104.5, "pinion.ball_diameter_mm": 3.0},
    ),
    (
        "helical",
        "pinion: protuberance_um: 0.9 mm is not from 0",
        {"pinion.protuberance_um": 900.0, "pinion.grinding_stock_um": 100.0},
    ),
    (
        "helical",
        "pinion: protuberance_angle_deg: 0.5.* rad .*pressure angle 0.349066 rad .20 deg",
        {"pinion.protuberance_um": 90.0, "pinion.grinding_stock_um": 50.0, "pinion.protuberance_angle_deg": 30.0},
    ),
    ("helical", "reduce tip_diameter_mm or profile_shift", {"pinion.tip_diameter_mm": 160.0}),
    ("helical", "centre_distance_mm: 80 mm is not above", {"pair.centre_distance_mm": 80.0}),
    ("helical", "pinion: root_diameter_mm: 40 mm asks for dedendum_coefficient = ", {"pinion.root_diameter_mm": 40.0}),
    ("mesh_cycle_finite_elements", "wheel: bore_diameter_mm: 102 mm is not between", {"wheel.bore_diameter_mm": 102.0}),
    ("internal", "a tip_diameter_mm above it", {"wheel.tip_diameter_mm": 150.0}),
    ("internal", "root_diameter_mm or profile_shift", {"wheel.root_diameter_mm": 300.0}),
    ("rack_and_pinion", "wheel: height_mm: 2 mm is not above", {"wheel.height_mm": 2.0}),
    ("rack_and_pinion", "wheel: length_mm: 12 mm is below", {"wheel.length_mm": 12.0}),
    ("spiral_bevel", "pinion: bore_diameter_mm: 60 mm", {"pinion.bore_diameter_mm": 60.0}),
]


@pytest.mark.parametrize(("kind", "words", "changes"), REFUSED, ids=[words for _, words, _ in REFUSED])
def test_refusals_of_gears_in_scenes_name_keys(kind, words, changes):
    scene = base(kind).with_changes(changes)
    with pytest.raises((InputError, GeometryError), match=words) as refusal:
        warn_of_gears(scene, scene.pair())
    allowed = {*names_of(type(scene)), "wheel", "pinion"}
    named = re.findall(r"[a-z]{3,}(?:_[a-zA-Z]+)+", str(refusal.value))  # no symbols, as m_n
    assert [name for name in named if name not in allowed] == []
