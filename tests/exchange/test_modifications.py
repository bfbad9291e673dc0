"""Modifications of REXS flanks as keys of a scene: the same removed material, by the formulas of both."""

from __future__ import annotations

import math

import pytest

from loaded_tca.exchange import import_stage
from tests.samples.rexs import changed, example, part, planetary, relation

ROUNDING = 1e-12  # of roots of two squares of some 50 mm, which are subtracted
BASE = 0.5 * 21 * 2.5 / math.cos(math.radians(12.0))
TRANSVERSE = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(12.0)))
BASE_DIAMETER = 2.0 * BASE * math.cos(TRANSVERSE)
TIP_DIAMETER = 2.0 * BASE + 2.0 * 2.5 * 1.25
"""Of pinion 1, with x = 0.25."""


def roll(diameter: float) -> float:
    return 0.5 * math.sqrt(diameter**2 - BASE_DIAMETER**2)


def imported(kind, flank=42, datum="negative", drop=True, **attributes):
    """Stage 10 whose right flank of pinion 1 has one modification."""
    model = example()
    relations = [
        one for one in model.relations if one.type == "reference" and not (drop and one.roles["origin"] in ("41", "42"))
    ]
    own = {name: value if isinstance(value, tuple | str) else (value, "mm") for name, value in attributes.items()}
    model = changed(
        model,
        {"21.datum_face_orientation": (datum, "none")},
        more=[part(66, kind, **own)],
        without=["reference"],
        relations=[*relations, relation("reference", origin=flank, referenced=66)],
    )
    return import_stage(model, "10")


def keys(*args, **attributes):
    return imported(*args, **attributes).table["pinion"].get("modifications", {})


def test_crowning_at_other_places_is_scaled_to_the_ends_of_the_face() -> None:
    at = {f"coordinate_where_helix_crowning_is_specified_{face}": 12.0 for face in ("datum_face", "non_datum_face")}
    amounts = {f"helix_crowning_amount_{face}": 0.008 for face in ("datum_face", "non_datum_face")}
    found = keys("helix_crowning", **amounts, **at, shape_of_helix_crowning="circular")
    assert found["lead_crowning_um"] == pytest.approx(8.0 * (15.0 / 12.0) ** 2)
    assert found["lead_crowning_form"] == "circular"


@pytest.mark.parametrize(("datum", "ends"), [("negative", ("lower", "upper")), ("positive", ("upper", "lower"))])
def test_crowning_of_unequal_ends_is_relief_over_half_the_face(datum: str, ends: tuple[str, str]) -> None:
    amounts = {"helix_crowning_amount_datum_face": 0.008, "helix_crowning_amount_non_datum_face": 0.003}
    flank = 42 if datum == "negative" else 41  # seen from the other end the loaded flank is the left one
    found = keys("helix_crowning", flank, datum, **amounts)
    assert found == {
        f"end_relief_{ends[0]}_um": 8.0,
        f"end_relief_{ends[0]}_length_mm": 15.0,
        f"end_relief_{ends[1]}_um": 3.0,
        f"end_relief_{ends[1]}_length_mm": 15.0,
    }


@pytest.mark.parametrize(("datum", "sign"), [("negative", 1.0), ("positive", -1.0)])
def test_helix_slope_removes_material_opposite_to_the_datum_face(datum: str, sign: float) -> None:
    flank = 42 if datum == "negative" else 41
    assert keys("helix_slope", flank, datum, helix_slope=0.004) == {"helix_slope_um": sign * 4.0}
    ends = {"helix_evaluation_start": -12.0, "helix_evaluation_end": 12.0}
    found = keys("helix_slope", flank, datum, helix_slope=0.004, **ends)
    assert found["helix_slope_um"] == pytest.approx(sign * 4.0 * 30.0 / 24.0)


@pytest.mark.parametrize(
    ("kind", "datum", "end"),
    [
        ("datum_face", "negative", "lower"),
        ("non_datum_face", "negative", "upper"),
        ("datum_face", "positive", "upper"),
        ("non_datum_face", "positive", "lower"),
    ],
)
def test_end_reliefs_are_at_their_ends(kind: str, datum: str, end: str) -> None:
    flank = 42 if datum == "negative" else 41
    amounts = {f"end_relief_depth_{kind}": 0.012, f"end_relief_length_{kind}": 4.0, "shape_of_relief": "parabolic"}
    found = keys(f"end_relief_{kind}", flank, datum, **amounts)
    assert found == {f"end_relief_{end}_um": 12.0, f"end_relief_{end}_length_mm": 4.0}


@pytest.mark.parametrize(("shape", "power"), [("linear", 1), ("parabolic", 2), ("circular", 2), ("", 1)])
def test_tip_relief_is_that_at_the_tip(shape: str, power: int) -> None:
    """The amount of the file is at 58.5 mm, half a millimetre within the tip."""
    at = {"tip_relief_depth": 0.02, "tip_relief_datum_diameter": 57.0, "tip_relief_evaluation_reference": 58.5}
    found = keys("tip_relief", **at, **({"shape_of_relief": shape} if shape else {}))
    grown = ((roll(TIP_DIAMETER) - roll(57.0)) / (roll(58.5) - roll(57.0))) ** power
    assert found["tip_relief_um"] == pytest.approx(20.0 * grown, abs=1e-6)  # of amounts with six decimals
    assert found["tip_relief_start_mm"] == 57.0
    assert found["tip_relief_form"] == ("linear" if power == 1 else "parabolic")


def test_length_of_tip_relief_counts_from_the_tip() -> None:
    found = keys("tip_relief", tip_relief_depth=0.02, tip_relief_datum_length=2.0)
    assert found["tip_relief_start_length_mm"] == pytest.approx(roll(TIP_DIAMETER) - 2.0, rel=ROUNDING)


def test_root_relief_ends_at_the_start_of_the_active_profile() -> None:
    mesh = import_stage(example(), "10").scene.mesh()
    start = mesh.pinion_active_profile.start_roll_length
    found = keys("root_relief", root_relief_depth=0.01, root_relief_datum_length=1.5, shape_of_relief="linear")
    assert found["root_relief_start_length_mm"] == pytest.approx(start + 1.5, rel=ROUNDING)
    assert (found["root_relief_um"], found["root_relief_form"]) == (10.0, "linear")


def test_profile_crowning_is_the_same_parabola() -> None:
    """Between 52 and 58 mm in the file: over the active profile, with the slope that its other middle asks for."""
    where = {
        "diameter_where_profile_crowning_root_is_specified": 52.0,
        "diameter_where_profile_crowning_tip_is_specified": 58.0,
    }
    found = keys("profile_crowning", profile_crowning_at_tip=0.006, profile_crowning_at_root=0.006, **where)
    mesh = import_stage(example(), "10").scene.mesh()
    low, high = mesh.pinion_active_profile.start_roll_length, roll(TIP_DIAMETER)

    def of_file(a: float) -> float:
        return 6.0 * ((a - 0.5 * (roll(52.0) + roll(58.0))) / (0.5 * (roll(58.0) - roll(52.0)))) ** 2

    def of_scene(a: float) -> float:
        crowning = found["profile_crowning_um"] * ((a - 0.5 * (low + high)) / (0.5 * (high - low))) ** 2
        return crowning + found["profile_slope_um"] * (a - low) / (high - low)

    constant = of_file(low) - of_scene(low)  # material removed all over changes nothing
    for part_of in (0.2, 0.5, 0.8, 1.0):
        place = low + part_of * (high - low)
        assert of_file(place) - of_scene(place) == pytest.approx(constant, abs=1e-5)  # of amounts with six digits


def test_profile_slope_grows_with_the_profile() -> None:
    mesh = import_stage(example(), "10").scene.mesh()
    active = roll(TIP_DIAMETER) - mesh.pinion_active_profile.start_roll_length
    ends = {"profile_evaluation_start": 52.0, "profile_evaluation_end": 58.0}
    found = keys("profile_slope", profile_slope=-0.005, **ends)
    assert found["profile_slope_um"] == pytest.approx(-5.0 * active / (roll(58.0) - roll(52.0)), rel=1e-6)


def test_slopes_of_two_modifications_add() -> None:
    found = keys("helix_slope", drop=False, helix_slope=0.004)
    assert found["helix_slope_um"] == 8.0


LEFT = {
    "twist": ("profile_twist", {"profile_twist": 0.003}, "no modification that a scene has (profile_twist)"),
    "triangular": ("triangular_tip_relief", {"triangular_tip_relief_depth": 0.01}, "no modification that a scene has"),
    "not additive": (
        "helix_slope",
        {"helix_slope": 0.004, "is_additive_modification": "false"},
        "is_additive_modification: false; allowed true",
    ),
    "added material": ("tip_relief", {"tip_relief_depth": -0.01, "tip_relief_datum_length": 2.0}, "found -10 um"),
    "no length": ("tip_relief", {"tip_relief_depth": 0.01}, "tip_relief_datum_diameter: missing"),
    "beyond the tip": ("tip_relief", {"tip_relief_depth": 0.01, "tip_relief_datum_diameter": 70.0}, "beyond the tip"),
    "shape": (
        "tip_relief",
        {"tip_relief_depth": 0.01, "tip_relief_datum_length": 2.0, "shape_of_relief": "exponential"},
        'shape_of_relief: found "exponential"; allowed linear, parabolic or circular',
    ),
    "linear end": (
        "end_relief_datum_face",
        {"end_relief_depth_datum_face": 0.01, "end_relief_length_datum_face": 3.0, "shape_of_relief": "linear"},
        "end reliefs of scenes are parabolic",
    ),
    "end without a length": (
        "end_relief_datum_face",
        {"end_relief_depth_datum_face": 0.01, "shape_of_relief": "parabolic"},
        "end_relief_length_datum_face: missing or 0",
    ),
    "highest point": (
        "helix_crowning",
        {"helix_crowning_amount_datum_face": 0.005, "helix_highest_point": 3.0},
        "helix_highest_point: found 3 mm; allowed 0",
    ),
    "crowning in the middle": (
        "helix_crowning",
        {"helix_crowning_amount_datum_face": 0.005, "coordinate_where_helix_crowning_is_specified_datum_face": 1e-9},
        "its amounts are given in the middle of the face",
    ),
    "slope over nothing": (
        "helix_slope",
        {"helix_slope": 0.005, "helix_evaluation_start": 3.0, "helix_evaluation_end": 3.0},
        "helix_evaluation_start: found at helix_evaluation_end",
    ),
    "unequal crowning": (
        "profile_crowning",
        {"profile_crowning_at_tip": 0.005, "profile_crowning_at_root": 0.002},
        "found 5 um at the tip and 2 um at the root",
    ),
    "crowning at one place": (
        "profile_crowning",
        {
            "profile_crowning_at_tip": 0.005,
            "profile_crowning_at_root": 0.005,
            "diameter_where_profile_crowning_root_is_specified": 58.0,
            "diameter_where_profile_crowning_tip_is_specified": 58.0,
        },
        "at one place of the profile",
    ),
    "slope turned round": (
        "profile_slope",
        {"profile_slope": 0.005, "profile_evaluation_start": 58.0, "profile_evaluation_end": 52.0},
        "profile_evaluation_start: found at profile_evaluation_end, or beyond",
    ),
}


@pytest.mark.parametrize(("kind", "attributes", "reason"), LEFT.values(), ids=LEFT)
def test_what_has_another_shape_is_left_with_its_reason(kind: str, attributes: dict, reason: str) -> None:
    stage = imported(kind, **attributes)
    assert "modifications" not in stage.table["pinion"]
    assert any(one.startswith(f"{kind} 66: ") and reason in one for one in stage.not_taken), stage.not_taken


def test_a_second_crowning_is_left() -> None:
    amounts = {f"helix_crowning_amount_{face}": 0.002 for face in ("datum_face", "non_datum_face")}
    stage = imported("helix_crowning", drop=False, **amounts)
    assert stage.scene.pinion.modifications.lead_crowning_um == 5.0
    assert any("helix_crowning 66: lead_crowning_um is taken by another" in one for one in stage.not_taken)


def test_the_flank_without_load_has_its_modifications_for_itself() -> None:
    stage = import_stage(example(), "10", load_case="2")  # turns and drives the other way round
    assert (stage.scene.sense, stage.scene.driving) == ("negative", "pinion")
    assert stage.table["pinion"]["modifications"] == {"lead_crowning_um": 7.0}  # of the left flank


def test_profiles_of_ring_gears_are_left_and_ends_are_taken() -> None:
    crowning = {f"helix_crowning_amount_{face}": (0.004, "mm") for face in ("datum_face", "non_datum_face")}
    relief = {"tip_relief_depth": (0.01, "mm"), "tip_relief_datum_length": (2.0, "mm")}
    more = [part(700, "helix_crowning", **crowning), part(701, "tip_relief", **relief)]
    of_ring = [relation("reference", origin=flank, referenced=one) for flank in (580, 581) for one in (700, 701)]
    stage = import_stage(changed(planetary(), more=more, relations=of_ring), "220")
    assert stage.table["wheel"]["modifications"] == {"lead_crowning_um": 4.0}
    assert any("tip_relief 701: modifications of the profile of ring gears" in one for one in stage.not_taken)
