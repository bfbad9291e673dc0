"""Variants in the order of a figure: none is lost."""

import numpy as np
import pytest
import xarray
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.studies import rank_combinations, rank_variants, study_summary
from loaded_tca.studies.ranking import figure_values, main_figures, nominal_variant, ranking, varied_keys
from tests.samples.study_datasets import LEAD, SCENE, TIP, dataset, grid, sampled

TWO_FAIL = ["ok", "refused", "ok", "ok", "not converged", "ok"]


def test_best_is_first_and_failed_variants_stand_at_the_end():
    found = rank_variants(grid(TWO_FAIL))
    assert found["sample"].tolist() == [3, 5, 2, 0, 1, 4]  # spans 1, 10, 101, 110
    assert found["rank"].tolist()[:4] == [1, 2, 3, 4]
    assert found["rank"].isna().tolist() == [False] * 4 + [True] * 2
    assert found["reason"].tolist()[4:] == ["it is refused", "it is not converged"]


def test_largest_may_be_the_best():
    assert rank_variants(grid(), "peak_pressure_MPa", largest_is_best=True)["sample"].iloc[0] == 5


def test_the_worst_torque_counts_unless_one_is_asked_for():
    study = dataset({LEAD: [0.0, 3.0]}, {"face_load_factor": [[1.0, 4.0], [2.0, 3.0]]}, torques=(40.0, 80.0))
    assert rank_variants(study, "face_load_factor")["sample"].tolist() == [1, 0]
    assert rank_variants(study, "face_load_factor", torque=0)["sample"].tolist() == [0, 1]
    best = rank_variants(study, "face_load_factor", largest_is_best=True)
    assert best["face_load_factor"].tolist() == [2.0, 1.0]


def test_unknown_figure_or_torque_is_told():
    with pytest.raises(InputError, match=r'peak_presure_MPa: no figure of the study; did you mean "peak_pressure_MPa"'):
        rank_variants(grid(), "peak_presure_MPa")
    with pytest.raises(InputError, match=r"torque: 1 is no index from 0 to 0"):
        rank_variants(grid(), torque=1)


def test_study_without_a_figure_ranks_nothing_and_loses_nothing():
    study = dataset({LEAD: [0.0, 3.0]}, {}, ["refused"] * 2).drop_vars("pinion_torque_Nm")
    assert main_figures(study) == []
    found = rank_variants(study)
    assert found["rank"].isna().all()
    assert found["status"].tolist() == ["refused"] * 2
    why = r"^anything: no figure of the study; no variant of 2 is ok \(2 refused\); the first: it is refused$"
    with pytest.raises(InputError, match=why):
        rank_variants(study, "anything")
    with pytest.raises(InputError, match=r"anything: no figure of the study; allowed nothing: there are none"):
        rank_variants(study.assign(status=("sample", ["ok", "refused"])), "anything")


def test_figures_of_variants_that_are_not_ok_are_not_known():
    study = grid(TWO_FAIL)
    study["peak_pressure_MPa"][1] = 1.0
    assert_array_equal(
        np.isfinite(figure_values(study, "peak_pressure_MPa")[:, 0]), [True, False, True, True, False, True]
    )


def test_figures_of_its_own_are_shown_where_a_study_has_no_others():
    study = dataset({LEAD: [0.0, 3.0]}, {"noise_dB": [1.0, 2.0]}).drop_vars("pinion_torque_Nm")
    assert main_figures(study) == ["noise_dB"]
    assert varied_keys(study) == [LEAD]


def test_nominal_variant_is_that_of_the_scene():
    """The scene has a crowning of its own and no misalignment."""
    own = SCENE.pinion.modifications.lead_crowning_um
    study = dataset({LEAD: [own, own + 1.0, own], "mounting.misalignment_um": [1.0, 0.0, 0.0]}, {})
    assert nominal_variant(study) == 2
    assert nominal_variant(study.isel(sample=[0, 1])) is None


def test_tables_of_words_and_numbers_are_ranked():
    study = dataset({"analysis.compliance": ["contact", "contact+tooth"], TIP: [0.0, 1.0]}, {"a_um": [2.0, 1.0]})
    assert rank_variants(study, "a_um")["analysis.compliance"].tolist() == ["contact+tooth", "contact"]


@pytest.mark.parametrize(("samples", "sign"), [(20, 1.0), (20, -1.0), (100, 1.0)])
def test_standard_error_of_a_rank_is_the_scatter_of_quantiles_of_other_samples(samples, sign):
    """Sixty designs with samples of one even distribution: their quantiles scatter by what is told of each."""
    values = np.random.default_rng(7).uniform(1.0, 2.0, (60, samples))
    designs = np.repeat(np.arange(60.0), samples)
    study = dataset({LEAD: designs.tolist(), TIP: [0.0] * designs.size}, {"face_load_factor": values.reshape(-1, 1)})
    study[TIP].attrs["sampling"] = "distribution"
    ranked = rank_combinations(study, "face_load_factor", largest_is_best=sign < 0.0)
    scatter = ranked["face_load_factor"].std()
    # of 60 designs the scatter itself is known to a tenth; the estimate of one from its few samples to a third
    assert ranked["standard_error"].mean() == pytest.approx(scatter, rel=0.3)


@pytest.mark.parametrize(("samples", "is_known"), [(1, False), (19, False), (20, True)])
def test_quantile_that_is_the_largest_sample_has_no_standard_error(samples, is_known):
    """The 19th of 20 is the first below the largest; the name of the column has the unit of the figure that ranks."""
    values = {"transmission_error_span_um": np.arange(samples, dtype=float)}
    study = dataset({LEAD: [3.0] * samples, TIP: [1.0] * samples}, values)
    study[TIP].attrs["sampling"] = "distribution"
    ranked = rank_combinations(study).iloc[0]
    assert (np.isfinite(ranked["standard_error_um"]), ranked["note"] == "") == (is_known, is_known)


def test_study_of_distributions_alone_is_one_design():
    study = sampled(21, (80.0,))
    (row,) = rank_combinations(study).to_dict("records")
    assert (row["rank"], row["samples"], [*row][2]) == (1, 21, "transmission_error_span_um")
    assert row["transmission_error_span_um"] == pytest.approx(95.0, rel=1e-12)  # of even steps from 0 to 100
    assert ranking(study).equals(rank_combinations(study))


def test_a_summary_of_several_designs_says_that_it_has_them_together():
    """As load factors of floating and rigid suns, of which no variant has the median."""
    keys = {
        "sun.support": ("sample", ["floating", "floating", "rigid", "rigid"], {"sampling": "factor"}),
        "mounting.misalignment_um": ("sample", [0.0, 9.0, 0.0, 9.0], {"sampling": "distribution"}),
    }
    words = {name: ("sample", [word] * 4) for name, word in {"status": "ok", "reason": "", "warnings": ""}.items()}
    study = xarray.Dataset({"face_load_factor": (("sample", "torque"), [[1.0], [1.1], [2.0], [2.2]]), **words}, keys)
    told = "all 2 combinations of sun.support together; ranking.csv has each by itself"
    assert told in study_summary(study)
    assert "together" not in study_summary(study.isel(sample=[0, 1])), "one combination"
    assert "together" not in study_summary(study.drop_vars("mounting.misalignment_um")), "each variant is a design"


@pytest.mark.parametrize(
    "figure",
    [
        "least_planet_share",  # of a stage: 0 where a planet carries nothing
        "wheel_bearing_life_Mrev",
        "pinion_root_compression_MPa",  # negative
        "wheel_root_stress_ratio",
        "least_film_thickness_um",
        "micropitting_safety",
        "efficiency",
    ],
)
def test_figures_of_which_the_largest_is_best_have_their_low_quantile(figure):
    """Of even steps from 0 to 1 one in twenty is below 0.05, above 0.95 one in twenty."""
    steps = np.linspace(0.0, 1.0, 21)
    study = dataset({LEAD: [3.0] * 21, TIP: steps}, {figure: steps, "largest_planet_share": steps})
    study[TIP].attrs["sampling"] = "distribution"
    row = rank_combinations(study, figure).iloc[0]
    assert_allclose(
        [row[figure], rank_combinations(study, "largest_planet_share").iloc[0, 3]], [0.05, 0.95], rtol=1e-12
    )
    assert rank_variants(study, figure)["sample"].iloc[0] == 20
    over = dataset({LEAD: [0.0, 3.0]}, {figure: [[1.0, 4.0], [2.0, 3.0]]}, torques=(40.0, 80.0))
    assert rank_variants(over, figure)[figure].tolist() == [2.0, 1.0]  # the worst torque of each
