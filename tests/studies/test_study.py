"""What a study varies: order of the variants, points of the distributions, and what it refuses before it begins."""

import math
from dataclasses import replace

import numpy as np
import pandas
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import stats

from loaded_tca.errors import InputError
from loaded_tca.scene import read_scene
from loaded_tca.studies import Study, figures
from tests.samples.results import SCENES
from tests.samples.studies import HELICAL, helical

CROWNING, RELIEF = "pinion.modifications.lead_crowning_um", "wheel.modifications.profile_crowning_um"
TILT, OFFSET = "mounting.misalignment_um", "mounting.centre_distance_error_mm"


def all_changes(study):
    return [study.changes(variant) for variant in range(len(study))]


def test_factors_combine_the_last_one_fastest():
    study = Study(helical(), {CROWNING: [1, 2.0], RELIEF: np.array([3.0, 4.0, 5.0])})
    assert [(one[CROWNING], one[RELIEF]) for one in all_changes(study)] == [
        (1.0, 3.0), (1.0, 4.0), (1.0, 5.0), (2.0, 3.0), (2.0, 4.0), (2.0, 5.0)
    ]  # fmt: skip


def test_samples_are_innermost_and_the_same_for_every_combination():
    study = Study(helical(), {CROWNING: [1.0, 2.0]}, {TILT: stats.norm(0.0, 5.0)}, samples=4)
    changes = all_changes(study)
    assert [one[CROWNING] for one in changes] == [1.0] * 4 + [2.0] * 4
    assert [one[TILT] for one in changes[:4]] == [one[TILT] for one in changes[4:]]


def test_rows_of_a_table_are_outermost():
    frame = pandas.DataFrame({CROWNING: [1.0, 2.0], RELIEF: [3, 4]})
    study = Study(helical(), {OFFSET: [0.0, 0.01]}, table=frame)
    found = [(one[CROWNING], one[RELIEF], one[OFFSET]) for one in all_changes(study)]
    assert found == [(1.0, 3.0, 0.0), (1.0, 3.0, 0.01), (2.0, 4.0, 0.0), (2.0, 4.0, 0.01)]


@pytest.mark.parametrize(("across", "along"), [(64, 1), (16, 4), (8, 8), (2, 32), (1, 64)])
def test_points_fill_every_part_of_the_joint_distribution(across, along):
    """Scrambled Sobol points of two keys, 2^6: one in each of 64 equally probable rectangles, whatever their sides."""
    given = {TILT: stats.norm(1.0, 5.0), OFFSET: stats.uniform(-0.01, 0.02)}
    changes = all_changes(Study(helical(), distributions=given, samples=64, seed=7))
    probabilities = [distribution.cdf([one[key] for one in changes]) for key, distribution in given.items()]
    column, row = (np.floor(n * probability) for n, probability in zip((across, along), probabilities, strict=True))
    assert_array_equal(np.sort(along * column + row), np.arange(64))


def test_keys_vary_independently():
    """Correlation of 256 points: random ones have 1/16, the same column 1."""
    given = dict.fromkeys((TILT, OFFSET, CROWNING, RELIEF), stats.uniform(0.0, 1.0))
    changes = all_changes(Study(helical(), distributions=given, samples=256))
    correlation = np.corrcoef([[one[key] for one in changes] for key in given])
    assert_allclose(correlation, np.eye(4), rtol=0, atol=0.05)


def test_points_depend_on_the_seed_alone():
    def points(seed):
        study = Study(helical(), distributions={TILT: stats.norm(0.0, 5.0)}, samples=5, seed=seed)
        return [one[TILT] for one in all_changes(study)]

    assert points(1) == points(1)
    assert set(points(1)).isdisjoint(points(2))


def test_mean_of_few_points_is_near_that_of_the_distribution():
    """Quasi-Monte Carlo: the error of 1024 points of a smooth function is far below 1/sqrt(1024) of the spread."""
    study = Study(helical(), distributions={TILT: stats.norm(0.0, 1.0)}, samples=1024)
    values = np.array([one[TILT] for one in all_changes(study)])
    assert_allclose(values.mean(), 0.0, atol=3e-3)
    assert_allclose(values.std(), 1.0, rtol=1e-2)


def test_whole_numbers_words_and_lists_are_what_the_keys_take():
    scene = helical()
    study = Study(
        scene,
        {"analysis.positions": np.array([5, 9]), "pinion.modifications.lead_crowning_form": ["circular"]},
        {"pinion.teeth": stats.randint(30, 34)},
        samples=2,
    )
    changes = study.changes(0)
    assert type(changes["analysis.positions"]) is int
    assert type(changes["pinion.teeth"]) is int
    assert scene.with_changes(changes).pinion.modifications.lead_crowning_form == "circular"


def test_whole_numbers_may_be_written_as_others():
    assert Study(helical(), {"pinion.teeth": [33.0]}).changes(0) == {"pinion.teeth": 33}


def test_number_out_of_its_range_is_no_fault_of_the_study():
    assert Study(helical(), {CROWNING: [-3.0]}).changes(0) == {CROWNING: -3.0}


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({}, "factors: none given, no distributions and no table"),
        ({"factors": {"pinion.modifications.lead_crowning": [1.0]}}, 'mean "pinion.modifications.lead_crowning_um"'),
        ({"factors": {"pinion.modifications": [1.0]}}, "pinion.modifications: a section"),
        ({"factors": {"pinion.teeth.more": [1]}}, "teeth.more: unknown key; pinion.teeth is a key, not a section"),
        ({"factors": {"pinion.face_width_in": [1.0]}}, "not converted here; allowed pinion.face_width_mm"),
        ({"distributions": {CROWNING: stats.norm}, "samples": 2}, "the distribution norm without parameters"),
        ({"factors": {CROWNING: []}}, f"{CROWNING}: no values"),
        ({"factors": {CROWNING: 3.0}}, f"{CROWNING}: found 3.0; allowed a list of values"),
        ({"factors": {CROWNING: "12"}}, f"{CROWNING}: found \"12\"; allowed a list of values"),
        ({"factors": {CROWNING: ["much"]}}, f'{CROWNING}: found "much"; allowed a number'),
        ({"factors": {CROWNING: [math.nan]}}, f"{CROWNING}: found nan; allowed a number"),
        ({"factors": {CROWNING: [10**400]}}, f"{CROWNING}: found a whole number of 1329 bits; allowed a number"),
        ({"factors": {"pinion.teeth": [33.5]}}, "pinion.teeth: found 33.5; allowed a whole number"),
        ({"factors": {CROWNING: range(2000), RELIEF: range(2000)}}, "all together 4000000 variants; allowed up to"),
        ({"distributions": {CROWNING: stats.yulesimon(0.01)}, "samples": 2}, "allowed a frozen distribution"),
        ({"factors": {CROWNING: [True]}}, f"{CROWNING}: found true; allowed a number"),
        ({"factors": {"analysis.compliance": ["teeth"]}}, 'allowed "contact" or "contact+tooth"'),
        ({"factors": {CROWNING: [1.0]}, "samples": 4}, "samples: given without distributions"),
        ({"factors": {CROWNING: [1.0]}, "seed": -1}, "seed: found -1; allowed a whole number from 0 on"),
        ({"distributions": {CROWNING: stats.norm(5.0, 1.0)}}, "samples: missing; allowed a whole number from 1"),
        ({"distributions": {CROWNING: stats.norm(5.0, 1.0)}, "samples": 2.5}, "samples: found 2.5"),
        ({"distributions": {CROWNING: 5.0}, "samples": 2}, "allowed a frozen distribution of scipy.stats"),
        ({"distributions": {CROWNING: stats.norm(5.0, -1.0)}, "samples": 2}, "the distribution has no median"),
        ({"distributions": {"pinion.teeth": stats.norm(30.5, 1.0)}, "samples": 2}, "allowed are whole numbers"),
        ({"distributions": {"pair.type": stats.norm(0.0, 1.0)}, "samples": 2}, "pair.type: no number"),
        ({"factors": {CROWNING: [1.0]}, "table": {CROWNING: [1.0]}}, f"{CROWNING}: varied more than once"),
        ({"table": {CROWNING: [1.0], RELIEF: [1.0, 2.0]}}, "table: columns of different lengths"),
    ],
)  # fmt: skip
def test_study_that_cannot_be_is_refused(given, told):
    with pytest.raises(InputError) as caught:
        Study(helical(), **given)
    assert len(caught.value.problems) == 1
    assert told in caught.value.problems[0]


ON_SHAFTS = SCENES / "helical_on_shafts.toml"
BEARING = "pinion.shaft.bearings.{}.radial_stiffness_N_per_um"


@pytest.mark.parametrize(
    "given",
    [
        {"factors": {BEARING.format(2): [100.0]}},
        {"distributions": {BEARING.format(2): stats.norm(100.0, 5.0)}, "samples": 2},
        {"table": {BEARING.format(2): [100.0]}},
    ],
)
def test_place_past_the_end_of_a_list_is_refused_before_variants_are_analysed(given):
    scene = read_scene(ON_SHAFTS)
    assert len(scene.pinion.shaft.bearings) == 2
    with pytest.raises(InputError) as caught:
        Study(scene, **given)
    (problem,) = caught.value.problems
    assert problem == f"{BEARING.format(2)}: 2 is past the end of a list of 2; allowed 0 to 1"


def test_last_place_of_a_list_varies():
    key = BEARING.format(1)
    study = Study(read_scene(ON_SHAFTS), {key: [100.0]})
    assert study.scene.with_changes(study.changes(0)).pinion.shaft.bearings[1].radial_stiffness_N_per_um == 100.0


def test_every_problem_is_told_at_once():
    with pytest.raises(InputError) as caught:
        Study(helical(), {"pinion.tooth": [1], CROWNING: ["a", "b", "a"]}, seed=0.5)
    assert [problem.split(":")[0] for problem in caught.value.problems] == ["seed", "pinion.tooth", CROWNING, CROWNING]


def test_torque_that_the_scene_leaves_aside_is_refused():
    several = read_scene(HELICAL).with_changes({"analysis.torques_Nm": [50.0, 100.0]})
    with pytest.raises(InputError, match=r"load\.pinion_torque_Nm: changes nothing"):
        Study(helical(), {"load.pinion_torque_Nm": [10.0], "analysis.torques_Nm": [[50.0]]})
    with pytest.raises(InputError, match=r"load\.pinion_torque_Nm: changes nothing"):
        Study(several, {"load.pinion_torque_Nm": [10.0]})
    assert len(Study(several, {"analysis.torques_Nm": [[50.0, 80.0], [10.0]]})) == 2


def test_variant_that_is_not_there():
    with pytest.raises(InputError, match="variant: 2; allowed 0 to 1"):
        Study(helical(), {CROWNING: [1.0, 2.0]}).changes(2)


def test_bins_of_a_spectrum_vary_as_one():
    cases = [{"pinion_torque_Nm": 100.0, "hours": 5.0}], [{"pinion_torque_Nm": 100.0, "hours": 9.0}]
    study = Study(helical(), {"load.case": cases})
    digest = study.digests(figures)
    assert digest(0) != digest(1)
    changed = study.scene.with_changes({"load.pinion_torque_Nm": None} | study.changes(1))
    assert changed.load.hours == 9.0


def test_digest_tells_what_a_variant_is():
    def digest(scene, values, variant, of=figures):
        return Study(scene, {CROWNING: values}).digests(of)(variant)

    scene = helical()
    one = digest(scene, [1.0, 2.0], 1)
    assert one == digest(scene, [2, 3], 0)  # the same change in another study
    assert one == digest(scene.with_changes({CROWNING: 7.0}), [2.0], 0)  # which the study varies anyway
    others = {
        digest(scene, [1.0, 2.0], 0),
        digest(scene.with_changes({RELIEF: 1.0}), [2.0], 0),
        digest(scene, [2.0], 0, len),
        digest(replace(scene, title="another"), [2.0], 0),
    }
    assert one not in others
    assert len(others) == 4


def test_study_keeps_its_values():
    values = [1.0, 2.0]
    study = Study(helical(), {CROWNING: values})
    values[0] = 9.0
    assert study.changes(0) == {CROWNING: 1.0}
