import json
from pathlib import Path

import pytest

from loaded_tca import plots
from tests.samples.results import changed_scene, result

PICTURES = "comparison", "compared_maps", "compared_patterns", "compared_face_load"
FILES = {"comparison.csv", "comparison.json", *(f"{name}.png" for name in PICTURES)}


@pytest.fixture(autouse=True)
def _in_an_empty_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def saved(directory, cycle=None, **changes):
    """The directory with a result in it."""
    cycle = cycle or result("mesh_cycle_spur", positions=5, torques=(40.0, 130.0))
    Path(directory).mkdir(parents=True)
    changed_scene(cycle, changes).save(Path(directory, "result.nc"))
    return directory


def compared(out="out"):
    return json.loads(Path(out, "comparison.json").read_text(encoding="utf-8"))


@pytest.mark.usefixtures("blank_pictures")
def test_compare_writes_table_and_pictures_and_tells_the_differences(run):
    saved("plain")
    saved("crowned", **{"pinion.modifications.lead_crowning_um": 7.5})
    Path("out").mkdir()
    Path("out", "compared_root_stress.png").write_bytes(b"of an earlier comparison")
    code, out, errors = run("compare", "plain", "crowned/result.nc", "--out", "out")
    assert (code, errors) == (0, [])
    assert {path.name for path in Path("out").iterdir()} == FILES
    assert out.startswith("Compared with plain, pinion torque 130 N m; % of absolute")
    assert "pinion.modifications.lead_crowning_um" in out
    assert "(+0.0 %)" in out
    assert f"Written to out: {', '.join(sorted(FILES, key=out.index))}" in out
    assert compared()["titles"].keys() == {"plain", "crowned"}


@pytest.mark.thorough
@pytest.mark.usefixtures("blank_pictures")
def test_compare_names_results_by_what_differs_in_their_paths_or_as_told(run):
    paths = [saved(f"{first}/{second}") for first in ("old", "new") for second in ("a", "b")]
    Path("new", "b", "result.nc").rename("new/c.nc")
    assert run("compare", *paths[:2], "--out", "out")[0] == 0
    assert list(compared()["titles"]) == ["a", "b"]
    assert run("compare", *paths[:3], "new/c.nc", "--out", "out")[0] == 0
    assert list(compared()["titles"]) == ["old/a", "old/b", "new/a", "new/c"]
    assert run("compare", *paths[:2], "--out", "out", "--names", "as is", "mended")[0] == 0
    assert compared()["compared_with"] == "as is"


@pytest.mark.thorough
def test_compare_draws_another_torque_and_position(run):
    saved("a")
    saved("b")
    run("compare", "a", "b", "--out", "out")
    code, out, _ = run("compare", "a", "b", "--out", "else", "--torque", 40, "--position", 2)
    assert code == 0
    assert out.startswith("Compared with a, pinion torque 40 N m\n")
    for name in ("comparison.png", "compared_maps.png"):
        assert Path("out", name).read_bytes() != Path("else", name).read_bytes()
    assert Path("out", "comparison.csv").read_bytes() == Path("else", "comparison.csv").read_bytes()


@pytest.mark.usefixtures("blank_pictures")
def test_compare_tells_torques_that_are_left_out(run):
    saved("a")
    saved("b", result("mesh_cycle_spur", positions=5, torques=(130.0,)))
    code, out, _ = run("compare", "a", "b", "--out", "out")
    assert code == 0
    assert "note: all have the torques 130 N m; left out: a 40 N m" in out
    assert [one["pinion_torque_Nm"] for one in compared()["torques"]] == [130.0]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["a"], "results: 1 given; a comparison takes two or more"),
        (["a", "a/result.nc"], "a/result.nc: given twice; a comparison takes different results"),
        (["a", "bevel"], "results: have no torque in common (a: 40, 130 N m; bevel: 0.2 N m)"),
        (["a", "absent"], "absent: cannot be read: No such file or directory"),
        (["a", "b", "--names", "one"], "--names one: 2 results need 2 different names"),
        (["a", "b", "--names", "one", "one"], "--names one one: 2 results need 2 different names"),
        (["a", "b", "--torque", "50"], "torque: 50 N m; the results share 40, 130 N m"),
        (["a", "b", "--position", "6"], "--position 6: the result has the positions 1 to 5"),
    ],
)
def test_what_cannot_be_compared_is_told_in_one_line(refused, arguments, told):
    saved("a")
    saved("b")
    saved("bevel", result("mesh_cycle_bevel", positions=3, torques=(0.2,)))
    assert told in refused("compare", *arguments, "--out", "out")
    assert not Path("out").exists()


def test_place_that_cannot_be_written_is_told_before_anything_is_read(refused):
    Path("out").write_bytes(b"")
    assert "is a file; give a directory" in refused("compare", "absent", "other", "--out", "out")


@pytest.mark.thorough
def test_plot_draws_more_pictures_on_request(run, monkeypatch):
    """These alone: the others are drawn without the request, too."""
    figures = plots.result_figures
    monkeypatch.setattr(
        plots,
        "result_figures",
        lambda *given, **options: {
            name: figure for name, figure in figures(*given, **options).items() if name in plots.MORE_PICTURES
        },
    )
    saved("a")
    assert run("plot", "a", "--all")[0] == 0
    assert {"contact_patterns.png", "full_mesh.png"} <= {path.name for path in Path("a").iterdir()}
    assert run("plot", "a", "--all", "--position", 4)[0] == 0
    assert Path("a", "position_4", "full_mesh.png").read_bytes() != Path("a", "full_mesh.png").read_bytes()


def test_help_says_what_the_files_hold(run, capsys):
    with pytest.raises(SystemExit):
        run("compare", "--help")
    shown = capsys.readouterr().out
    assert all(name in shown for name in FILES)
