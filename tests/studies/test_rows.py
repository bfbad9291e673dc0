"""Rows of a study on disk: a malformed one costs its own variant, no other, and is reported with its number."""

import json
import math
import warnings
from collections import Counter

import numpy as np
import pytest

from loaded_tca.errors import DamageWarning
from loaded_tca.studies import Study, run_study
from loaded_tca.studies.rows import PARTS, dataset_of, line_of, row_of
from tests.refusals import refused_calls
from tests.samples.studies import helical

KEY = "pinion.modifications.lead_crowning_um"
asked = []


def figures(scene):
    """A number, and numbers over the torques, that cost nothing."""
    crowning = scene.pinion.modifications.lead_crowning_um
    asked.append(crowning)
    return {"crowning_um": crowning, "over_torques": [crowning, 2.0 * crowning]}


def study():
    return Study(helical(), {KEY: [1.0, 2.0, 3.0]})


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The result of a study of three variants, and its rows on disk."""
    out = tmp_path_factory.mktemp("whole") / "study.nc"
    result = run_study(study(), out=out, figures=figures)
    return result.drop_vars("seconds"), out.with_suffix(".rows.jsonl").read_bytes().splitlines(keepends=True)


def again(folder, lines):
    """The study with these rows on disk: its result, the variants that were analysed, and the warnings."""
    (folder / "study.rows.jsonl").write_bytes(b"".join(lines))
    asked.clear()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = run_study(study(), out=folder / "study.nc", figures=figures)
    return result.drop_vars("seconds"), list(asked), caught


def with_part(name, value):
    return lambda row: json.dumps(row | {name: value})


def with_figure(name, value):
    return lambda row: json.dumps(row | {"figures": row["figures"] | {name: value}})


def without(name):
    return lambda row: json.dumps({part: value for part, value in row.items() if part != name})


MALFORMED = {
    "truncated": lambda row: json.dumps(row)[:50],
    "empty": "",
    "text": '"row"',
    "number": "3",
    "list": "[1, 2]",
    "no mapping, nested": lambda row: json.dumps([row]),
    "nested without end": "[" * 100_000,
    "nested deeply": "[" * 100_000 + "]" * 100_000,
    "whole number of 5000 digits": "1" * 5000,
    "given twice": lambda row: json.dumps(row)[:-1] + ', "seconds": 1.0}',
    "figure given twice": lambda row: json.dumps(row).replace('"crowning_um"', '"crowning_um": [9.0], "crowning_um"'),
    "more": with_part("variant", 1),
    **{f"without {name}": without(name) for name in PARTS},
    "digest null": with_part("digest", None),
    "digest number": with_part("digest", 1),
    "digest list": with_part("digest", []),
    "status of no kind": with_part("status", "good"),
    "status null": with_part("status", None),
    "status number": with_part("status", 0),
    "status list": with_part("status", ["ok"]),
    "reason null": with_part("reason", None),
    "reason number": with_part("reason", 3.5),
    "reason half of a surrogate pair": with_part("reason", "\ud800"),
    "warnings null": with_part("warnings", None),
    "warnings text": with_part("warnings", "edge"),
    "warnings table": with_part("warnings", {"edge": 1}),
    "warnings numbers": with_part("warnings", [1.0]),
    "seconds null": with_part("seconds", None),
    "seconds text": with_part("seconds", "NaN"),
    "seconds boolean": with_part("seconds", True),
    "seconds list": with_part("seconds", [1.0]),
    "seconds below 0": with_part("seconds", -1.0),
    "seconds NaN": with_part("seconds", math.nan),
    "seconds huge": with_part("seconds", 10**400),
    "figures null": with_part("figures", None),
    "figures list": with_part("figures", [[1.0]]),
    "figures text": with_part("figures", "none"),
    "figure null": with_figure("crowning_um", None),
    "figure of nulls": with_figure("crowning_um", [None]),
    "figure without torques": with_figure("crowning_um", 2.0),
    "figure empty": with_figure("crowning_um", []),
    "figure boolean": with_figure("crowning_um", [True]),
    "figure text": with_figure("crowning_um", ["2.0"]),
    "figure NaN as text": with_figure("crowning_um", ["NaN"]),
    "figure nested": with_figure("crowning_um", [[2.0]]),
    "figure table": with_figure("crowning_um", {"0": 2.0}),
    "figure huge": with_figure("crowning_um", [10**400]),
    "figure of other torques": with_figure("crowning_um", [2.0, 4.0, 6.0]),
    "figure without a name": with_figure("", [1.0]),
    "figure named as a column": with_figure("status", [1.0]),
    "figure with a space": with_figure("two words", [1.0]),
}


@pytest.mark.parametrize("seal", [True, False], ids=["checksum of before", "no checksum"])
@pytest.mark.parametrize("kind", MALFORMED)
def test_malformed_row_costs_its_own_variant_and_no_other(tmp_path, whole, kind, seal):
    result, lines = whole
    row = json.loads(lines[1]) if seal else row_of(lines[1])
    damage = MALFORMED[kind]
    second = (damage if isinstance(damage, str) else damage(row)).encode() + b"\n"
    found, analysed, (warning,) = again(tmp_path, [lines[0], second, lines[2]])
    assert analysed == [2.0]
    assert found.identical(result)
    assert warning.category is DamageWarning
    assert f"{tmp_path / 'study.rows.jsonl'}: rows that cannot be used" in str(warning.message)
    assert "again: row 2: " in str(warning.message)


CHANGED = {
    "figure": with_figure("crowning_um", [7.0]),
    "figure NaN": with_figure("crowning_um", [math.nan]),
    "figure that is new": with_figure("other", [1.0]),
    "status": with_part("status", "refused"),
    "warnings": with_part("warnings", ["edge"]),
    "digest": with_part("digest", 64 * "0"),
}


@pytest.mark.parametrize("kind", CHANGED)
def test_changed_row_is_found_by_its_checksum(tmp_path, whole, kind):
    result, lines = whole
    second = CHANGED[kind](json.loads(lines[1])).encode() + b"\n"
    found, analysed, (warning,) = again(tmp_path, [lines[0], second, lines[2]])
    assert analysed == [2.0]
    assert found.identical(result)
    assert "row 2: its bytes are not those that were written" in str(warning.message)


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("seal", [True, False], ids=["checksum of before", "no checksum"])
def test_row_under_the_digest_of_another_variant_replaces_nothing(tmp_path, whole, order, seal):
    result, lines = whole
    row = json.loads(lines[1]) if seal else row_of(lines[1])
    second = with_part("digest", row_of(lines[0])["digest"])(row).encode() + b"\n"
    found, analysed, _ = again(tmp_path, [lines[0], second, lines[2]][::order])
    assert analysed == [2.0]
    assert found.identical(result)


@pytest.mark.parametrize("bit", [1, 128])
def test_every_changed_byte_of_a_row_is_found(whole, bit):
    """But for the line feed at its end, without which it is not written to its end."""
    line = bytearray(whole[1][0])
    for position in range(len(line) - 1):
        line[position] ^= bit
        with pytest.raises(ValueError, match=r"bytes|no JSON|no row of a study"):
            row_of(bytes(line))
        line[position] ^= bit


def test_rows_without_a_checksum_are_read(tmp_path, whole):
    """As 0.2.0 wrote them."""
    result, lines = whole
    before = [json.dumps(row_of(line)).encode() + b"\n" for line in lines]
    found, analysed, caught = again(tmp_path, before)
    assert found.identical(result)
    assert (analysed, caught) == ([], [])


def test_damage_that_costs_nothing_any_more_is_not_reported(tmp_path, whole):
    damaged = [whole[1][0], b"3\n", *whole[1][1:]]
    assert again(tmp_path, damaged)[1:] == ([], [])


def test_many_damaged_rows_make_one_warning(tmp_path, whole):
    result, lines = whole
    found, analysed, (warning,) = again(tmp_path, [b"3\n"] * 40 + lines[1:])
    assert found.identical(result)
    assert analysed == [1.0]
    assert str(warning.message).count("no row of a study") == 5
    assert str(warning.message).endswith("; and 35 more")


@pytest.mark.parametrize("value", [0.5, math.inf, math.nan, 5e-324])
def test_row_survives_with_all_its_numbers(value):
    row = {"digest": "ä", "status": "ok", "reason": "", "warnings": ["|"], "seconds": 0.0, "figures": {"a": [value]}}
    assert line_of(row_of(line_of(row))) == line_of(row)


def unequal(scene):
    return {"two": [1.0, 2.0], "three": [1.0, 2.0, 3.0], "teeth": scene.pinion.teeth}


def test_figures_of_different_numbers_of_torques_are_a_fault():
    with pytest.warns(UserWarning, match="^study: no variant of 1 is ok"):
        (reason,) = run_study(Study(helical(), {KEY: [1.0]}), figures=unequal)["reason"].values
    assert reason.startswith("figures: different numbers of torques: two 2 and three 3; allowed a number, or one for")


def refused_row(**parts):
    row = {"digest": "a", "status": "ok", "reason": "", "warnings": [], "seconds": 0.0, "figures": {}}
    row_of(line_of(row | parts))


test_rows_refuse = refused_calls(
    (
        lambda: refused_row(status=1),
        "^status: found 1; allowed ok, refused, not converged, fault$",
        ValueError,
    ),
    (lambda: refused_row(seconds="1"), '^seconds: found "1"; allowed a number from 0 on$', ValueError),
    (lambda: refused_row(reason=None), "^reason: found None; allowed a text$", ValueError),
    (
        lambda: refused_row(figures={"a": None}),
        "^figures: a: found None; allowed a list of decimal numbers$",
        ValueError,
    ),
    (lambda: row_of(b"{"), "^no JSON: ", ValueError),
)


def test_dataset_has_one_array_for_each_figure_however_many_rows(monkeypatch):
    """An array as long as the study for each row made a million variants take hours."""
    made, full = Counter(), np.full
    monkeypatch.setattr(np, "full", lambda shape, *rest: made.update([shape]) or full(shape, *rest))
    study = Study(helical(), {"pinion.modifications.lead_crowning_um": [*map(float, range(1, 41))]})
    row = {"digest": "", "status": "ok", "reason": "", "warnings": [], "seconds": 0.5}
    rows = [{**row, "figures": {"span_um": [number, 1.0], "force_N": [2.0]}} for number in np.arange(40.0).tolist()]
    dataset = dataset_of(study, rows, {})
    assert made[40, 2] == 2
    assert dataset["span_um"].values.tolist() == [[float(number), 1.0] for number in range(40)]


def test_torques_are_a_coordinate_where_all_variants_that_were_analysed_have_the_same():
    """Figures of a variant of one torque stand in the first column, whatever torque others have there."""

    def with_torques(torques):
        parts = {"digest": "", "reason": "", "warnings": [], "seconds": 0.0}
        return parts | {"status": "ok", "figures": {"pinion_torque_Nm": torques} if torques else {}}

    three = [50.0, 100.0, 200.0]
    same = dataset_of(study(), map(with_torques, (three, [], three)), {})
    assert same["torque"].values.tolist() == [5e4, 1e5, 2e5]
    assert "torque" not in dataset_of(study(), map(with_torques, ([300.0], three, three)), {}).coords
