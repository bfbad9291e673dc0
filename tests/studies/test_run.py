"""A study in this process: what its result holds, what is kept on disk, what is computed again."""

import json
import warnings
from concurrent.futures import Executor, Future
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.stats import norm

from loaded_tca import analyse, load_result
from loaded_tca.contact import solve_contact
from loaded_tca.errors import ConvergenceError, GeometryError, InputError
from loaded_tca.plots import plot_study
from loaded_tca.studies import Study, load_study, run_study
from loaded_tca.studies.ranking import nominal_variant
from tests.samples.studies import crowning, helical

CROWNING, TEETH = "pinion.modifications.lead_crowning_um", "pinion.teeth"


def study(*values):
    return Study(helical(), {CROWNING: values})


def counting():
    """Figures that count how often they are asked for."""
    asked = []

    def counted(scene):
        asked.append(scene.pinion.modifications.lead_crowning_um)
        return crowning(scene)

    counted.asked = asked
    return counted


def test_rows_are_the_key_figures_of_each_variant():
    found = run_study(Study(helical(), {CROWNING: [2.0, 6.0]}))
    assert found.sizes == {"sample": 2, "torque": 1}
    assert_array_equal(found[CROWNING], [2.0, 6.0])
    for sample, value in enumerate([2.0, 6.0]):
        (expected,) = analyse(helical().with_changes({CROWNING: value})).key_figures()
        for name, figure in expected.items():
            assert_array_equal(found[name].values[sample], [figure], err_msg=name)
    assert list(found["status"].values) == ["ok", "ok"]
    assert (found["seconds"] > 0.0).all()


def test_torques_are_a_dimension_shorter_lists_end_in_nan():
    found = run_study(Study(helical(), {"analysis.torques_Nm": [[20.0], [20.0, 40.0]]}))
    assert_array_equal(found["pinion_torque_Nm"], [[20.0, np.nan], [20.0, 40.0]])
    assert list(found["analysis.torques_Nm"].values) == ["[20.0]", "[20.0, 40.0]"]


def ends(scene):
    return {"ends": float(scene.analysis.free_edges)}


def test_booleans_are_booleans_in_the_result_and_in_its_file(tmp_path):
    out, key = tmp_path / "study.nc", "analysis.free_edges"
    found = run_study(Study(helical(), {key: [True, False]}), out=out, figures=ends)
    for study in (found, load_study(out)):
        assert study[key].dtype == bool
        assert study["ends"].values[study[key].values == True].tolist() == [[1.0]]  # noqa: E712, as users ask for it
    assert nominal_variant(found) == 1  # without free edges, as the scene
    (axes, *_) = plot_study(found)["study_lines_ends"].axes
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["False", "True"]


def failing(scene):
    value = scene.pinion.modifications.lead_crowning_um
    errors = {
        2.0: GeometryError("pointed"),
        3.0: InputError(["one", "two"]),
        4.0: ConvergenceError("swings", last=1),
        5.0: ZeroDivisionError("by zero"),
    }
    if value in errors:
        raise errors[value]
    return {"crowning_um": value, "over_torques": [1.0, 2.0]}


def test_variants_that_fail_are_rows():
    found = run_study(study(1.0, 2.0, 3.0, 4.0, 5.0, -1.0), figures=failing)
    assert list(found["status"].values) == ["ok", "refused", "refused", "not converged", "fault", "refused"]
    assert list(found["reason"].values)[:5] == ["", "pointed", "one\ntwo", "swings", "by zero"]
    assert "found -1.0; allowed a number from 0" in found["reason"].values[5]
    assert_array_equal(found["crowning_um"][:, 0], [1.0] + 5 * [np.nan])
    assert_array_equal(found["over_torques"][0], [1.0, 2.0])


def nonsense(scene):
    return {"word": scene.title}


def test_figures_that_are_no_numbers_are_a_fault():
    with pytest.warns(UserWarning, match="^study: no variant of 1 is ok"):
        found = run_study(study(1.0), figures=nonsense)
    assert found["status"].values[0] == "fault"
    assert "could not convert string to float" in found["reason"].values[0]


def test_accuracy_warnings_are_kept_with_their_variant():
    found = run_study(Study(helical(), {"load.pinion_torque_Nm": [40.0, 400.0]}))
    assert found["warnings"].values[0] == ""
    assert "the contact reaches an edge of a flank" in found["warnings"].values[1]


def test_other_warnings_are_shown_as_always():
    def old(_):
        warnings.warn("old", DeprecationWarning, stacklevel=1)
        x = np.linspace(-1.0, 1.0, 8)
        solve_contact(np.add.outer(x**2, x**2), (0.3, 0.3), 1e5, load=1e6)  # pressed all over
        return {"load": 1.0}

    with pytest.warns(DeprecationWarning, match="old"):
        found = run_study(study(1.0), figures=old)
    assert "reaches the border of" in found["warnings"].values[0]


def test_result_can_be_reopened(tmp_path):
    out = tmp_path / "deep" / "study.nc"
    found = run_study(study(1.0, -1.0), out=out, figures=crowning)
    assert load_study(out).identical(found)
    assert found.attrs["scene_toml"] == helical().to_toml()
    frame = found.to_dataframe()
    assert_array_equal(frame["crowning_um"], [1.0, np.nan])


def test_only_what_is_missing_is_computed(tmp_path):
    out, first, second = tmp_path / "study.nc", counting(), counting()
    run_study(study(1.0, 2.0), out=out, figures=first)
    found = run_study(study(2.0, 3.0, 1.0), out=out, figures=second)
    assert first.asked == [1.0, 2.0]
    assert second.asked == [3.0]
    assert_array_equal(found["crowning_um"][:, 0], [2.0, 3.0, 1.0])


def test_what_was_done_before_an_interrupt_is_kept(tmp_path):
    out, counted = tmp_path / "study.nc", counting()

    def stop(*now):
        if now == (2, 3, 0):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as caught:
        run_study(study(1.0, 2.0, 3.0), out=out, progress=stop, figures=counted)
    assert caught.value.__notes__ == [
        f"2 variants are kept in {tmp_path / 'study.rows.jsonl'}: the same study goes on from there"
    ]
    assert not out.exists()
    run_study(study(1.0, 2.0, 3.0), out=out, figures=counted)
    assert counted.asked == [1.0, 2.0, 3.0]


def test_line_that_was_not_written_to_its_end_is_computed_again(tmp_path):
    out, counted = tmp_path / "study.nc", counting()
    run_study(study(1.0, 2.0), out=out, figures=counted)
    rows = tmp_path / "study.rows.jsonl"
    rows.write_bytes(rows.read_bytes()[:-10])
    found = run_study(study(1.0, 2.0), out=out, figures=counted)
    assert counted.asked == [1.0, 2.0, 2.0]
    assert_array_equal(found["crowning_um"][:, 0], [1.0, 2.0])
    assert len([json.loads(line) for line in rows.read_text().splitlines()]) == 2


def test_progress_counts_what_is_done_and_what_failed(tmp_path):
    told = []
    run_study(study(1.0, -1.0, 2.0), out=tmp_path / "s.nc", figures=crowning, progress=lambda *now: told.append(now))
    assert told == [(1, 3, 0), (2, 3, 1), (3, 3, 1)]
    told.clear()
    run_study(
        study(1.0, -1.0, 2.0, 3.0), out=tmp_path / "s.nc", figures=crowning, progress=lambda *now: told.append(now)
    )
    assert told == [(3, 4, 1), (4, 4, 1)]


def test_maps_of_chosen_variants_are_kept(tmp_path):
    out = tmp_path / "study.nc"
    found = run_study(study(2.0, 6.0), out=out, keep_maps=[1])
    assert [path.name for path in (tmp_path / "study_maps").iterdir()] == ["1.nc"]
    result = load_result(tmp_path / "study_maps" / "1.nc")
    assert result.scene.pinion.modifications.lead_crowning_um == 6.0
    assert_array_equal(found["peak_pressure_MPa"][1], [result.key_figures()[0]["peak_pressure_MPa"]])


def crownings_in(folder):
    """Names of kept results, and the crowning of each."""
    paths = [path for path in sorted(folder.glob("*.nc")) if path.name != "notes.nc"]
    return {path.name: load_result(path).scene.pinion.modifications.lead_crowning_um for path in paths}


def test_maps_go_with_their_variants_into_another_study_and_come_back(tmp_path):
    out, maps = tmp_path / "study.nc", tmp_path / "study_maps"
    run_study(study(2.0, 6.0, 8.0), out=out, keep_maps=[0, 1, 2])
    maps.joinpath("notes.nc").write_text("of the user")
    before = {path.name: path.read_bytes() for path in maps.iterdir()}
    with pytest.warns(UserWarning, match=r"^study: 1 kept result is of no variant of the study: moved to .*others; "):
        run_study(study(6.0, 2.0), out=out)
    assert crownings_in(maps) == {"0.nc": 6.0, "1.nc": 2.0}
    assert [*crownings_in(maps / "others").values()] == [8.0]
    run_study(study(2.0, 6.0, 8.0), out=out)
    assert {path.name: path.read_bytes() for path in maps.iterdir()} == before


def test_maps_are_lost_by_no_more_samples(tmp_path):
    out, maps = tmp_path / "study.nc", tmp_path / "study_maps"
    keys = {CROWNING: [2.0, 6.0]}, {"mounting.misalignment_um": norm(0.0, 6.0)}
    run_study(Study(helical(), *keys, samples=2), out=out, keep_maps=[1, 3])
    before = load_result(maps / "3.nc")
    found = run_study(Study(helical(), *keys, samples=4), out=out)  # sample 1 of the second crowning is 4 + 1
    after = load_result(maps / "5.nc")
    assert crownings_in(maps) == {"1.nc": 2.0, "5.nc": 6.0}
    assert after.dataset.identical(before.dataset)
    assert after.scene.mounting.misalignment_um == found["mounting.misalignment_um"].values[5]


def test_damaged_map_is_moved_aside_and_analysed_again(tmp_path):
    out, maps = tmp_path / "study.nc", tmp_path / "study_maps"
    run_study(study(2.0), out=out, keep_maps=[0])
    maps.joinpath("0.nc").write_bytes(b"CDF")
    with pytest.warns(UserWarning, match="1 kept result is of no variant"):
        run_study(study(2.0), out=out, keep_maps=[0])
    assert crownings_in(maps) == {"0.nc": 2.0}
    assert [path.read_bytes() for path in (maps / "others").iterdir()] == [b"CDF"]


def test_maps_of_variants_alike_all_find_a_number(tmp_path):
    out, maps = tmp_path / "study.nc", tmp_path / "study_maps"
    run_study(study(6.0, 6.0), out=out, keep_maps=[0, 1])
    run_study(study(2.0, 6.0, 6.0), out=out)
    assert crownings_in(maps) == {"1.nc": 6.0, "2.nc": 6.0}


def test_maps_stay_where_they_are_not_asked_for_again(tmp_path):
    out = tmp_path / "study.nc"
    run_study(study(2.0, 6.0), out=out, keep_maps=[1])
    run_study(study(2.0, 6.0), out=out)
    assert (tmp_path / "study_maps" / "1.nc").exists()


def square(scene):
    return {"square": [[1.0, scene.pinion.teeth]]}


def reserved(scene):
    return {"status": scene.pinion.teeth}


def spaced(scene):
    return {"two words": scene.pinion.teeth}


@pytest.mark.parametrize(
    ("figures", "told"),
    [
        (square, "figures: square has 2 dimensions; allowed a number, or one for each torque"),
        (reserved, "figures: name 'status'; allowed letters, digits and _, but not sample, torque"),
        (spaced, "figures: name 'two words'; allowed letters, digits and _"),
    ],
)
def test_figures_that_do_not_fit_into_the_result_are_a_fault(tmp_path, figures, told):
    with pytest.warns(UserWarning, match=r"^study: no variant of 2 is ok \(2 fault\); the first: figures: "):
        found = run_study(study(1.0, 2.0), out=tmp_path / "study.nc", figures=figures)
    assert list(found["status"].values) == ["fault", "fault"]
    assert told in found["reason"].values[0]


def test_figures_without_a_name_are_refused():
    with pytest.raises(InputError, match="allowed a function with a name, which identifies its rows"):
        run_study(study(1.0), figures=lambda scene: {"teeth": scene.pinion.teeth})


def test_maps_asked_for_later_are_computed_again(tmp_path):
    out, counted = tmp_path / "study.nc", counting()
    run_study(study(2.0, 6.0), out=out, figures=counted)
    run_study(study(2.0, 6.0), out=out, figures=counted, keep_maps=[0])
    assert counted.asked == [2.0, 6.0, 2.0]
    assert (tmp_path / "study_maps" / "0.nc").exists()


@pytest.mark.parametrize(
    ("given", "told"),
    [({"keep_maps": [0]}, "keep_maps: needs out"), ({"keep_maps": [7], "out": "a.nc"}, "not variants 0 to 1")],
)
def test_maps_that_cannot_be_kept(tmp_path, monkeypatch, given, told):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=told):
        run_study(study(1.0, 2.0), figures=crowning, **given)
    assert not list(tmp_path.iterdir())


def test_file_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be made a directory"):
        run_study(study(1.0), out=tmp_path / "file" / "study.nc", figures=crowning)


def test_result_of_an_analysis_is_no_study(tmp_path):
    analyse(helical()).save(tmp_path / "result.nc")
    with pytest.raises(InputError, match="a result of loaded_tca, but no study"):
        load_study(tmp_path / "result.nc")


def test_scene_of_the_study_stays_what_it_was():
    before = replace(helical())
    run_study(study(1.0), figures=crowning)
    assert helical() == before


class AtOnce(Executor):
    """An executor that does each task when it is given, and counts the variants of each."""

    def __init__(self):
        self.sizes = []

    def submit(self, call, tasks):
        self.sizes.append(len(tasks))
        future = Future()
        future.set_result(call(tasks))
        return future


@pytest.mark.parametrize(("task_seconds", "sizes"), [(1e9, [1, 4, 4, 1]), (0.0, [1] * 10)])
def test_quick_variants_share_tasks(monkeypatch, task_seconds, sizes):
    """The first task has one variant: how long it takes is not known before."""
    for name, value in {"AHEAD": 1, "MOST_TOGETHER": 4, "TASK_SECONDS": task_seconds}.items():
        monkeypatch.setattr(f"loaded_tca.studies.run.{name}", value)
    executor, values = AtOnce(), np.linspace(1.0, 5.0, 10)
    found = run_study(study(*values), executor, figures=crowning)
    assert executor.sizes == sizes
    assert_array_equal(found["crowning_um"][:, 0], values)
