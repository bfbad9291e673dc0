"""Report and check of a planetary stage: phases, shares, orders, both meshes, what is held."""

import pytest

from loaded_tca.cli import main
from loaded_tca.errors import InputError
from loaded_tca.plots import STAGE_CAPTIONS, STAGE_PICTURES
from loaded_tca.reports import write_html_report
from tests.reports.test_report import Page
from tests.samples.stages import analysed

STAGE = "examples/stages/helical_automotive.toml"
WHEN = "2026-03-04T05:06:07+00:00"

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")


@pytest.fixture(scope="module")
def result():
    return analysed()[0]


@pytest.fixture
def _blank_pictures(monkeypatch):
    """Pictures are made but not drawn."""
    monkeypatch.setattr("loaded_tca.reports.page.svg_of", lambda *_: "<svg></svg>")


@pytest.mark.thorough
def test_report_of_the_same_result_is_the_same_file(result, tmp_path):
    paths = [write_html_report(result, tmp_path / f"{name}.html", date=WHEN) for name in ("report", "again")]
    assert paths[0].read_bytes() == paths[1].read_bytes()


@pytest.mark.usefixtures("_blank_pictures")
def test_report_has_phases_figures_and_pictures(result, tmp_path):
    page = Page(write_html_report(result, tmp_path / "report.html", date=WHEN))
    text = " ".join(page.text)
    assert page.headings[:5] == [result.stage.title, "What was asked", "Key figures", "Phases and orders", "Meshes"]
    phases = next(table for table in page.tables if table[0][1:] == ["sun's mesh", "ring's mesh"])
    assert phases[1:] == [
        [f"planet {k}", f"{sun:.4f}", f"{ring:.4f}"]
        for k, (sun, ring) in enumerate(zip(result.sun_mesh_phase, result.ring_mesh_phase, strict=True))
    ]
    factors = next(row for table in page.tables for row in table if row[0] == "mesh load factor")
    assert [float(cell) for cell in factors[1:]] == pytest.approx(result.mesh_load_factor.tolist(), rel=1e-3)
    assert "the outside of the ring are held rigid" in text
    assert "sun_mesh.nc" in text
    assert all(caption in page.words for caption in STAGE_CAPTIONS.values())
    assert set(STAGE_CAPTIONS) == set(STAGE_PICTURES)


@pytest.mark.thorough
@pytest.mark.usefixtures("_blank_pictures")
def test_command_writes_the_report_of_a_directory(result, tmp_path, capsys):
    result.save(tmp_path)
    assert main(["report", str(tmp_path)]) == 0
    assert "report.html" in capsys.readouterr().out
    assert result.stage.title in (tmp_path / "report.html").read_text(encoding="utf-8").replace("&#39;", "'")


def test_report_of_a_stage_has_no_ranking(result, tmp_path):
    with pytest.raises(InputError, match="a StageResult has no ranking"):
        write_html_report(result, tmp_path / "report.html", rank_by="mesh_load_factor")


def test_check_shows_a_stage(capsys):
    assert main(["check", STAGE, "--set", "stage.pin_radial_um=[0.0, 5.0, 0.0, 0.0]"]) == 0
    text = capsys.readouterr().out
    for part in (
        "teeth of sun, planet and ring",
        "carrier torque [N m]                               333.333",
        "pins displaced outwards [um]",
        "planet (pinion) and ring (wheel)",
        "involute interference: ring's tip to T1 [mm]",
        "outside of the ring are held rigid",
    ):
        assert part in text


def test_check_tells_planets_that_cannot_be_put_in(capsys):
    changes = ["--set", "stage.planets=3", "--set", "stage.pin_tangential_um=[0.0, 0.0, 0.0]"]
    assert main(["check", STAGE, *changes]) == 2
    assert "stage.planet_angles_deg: planets cannot be put in" in capsys.readouterr().err


def test_check_of_a_file_that_cannot_be_read_says_why(tmp_path, capsys):
    assert main(["check", str(tmp_path / "nothing.toml")]) == 2
    assert "cannot be read" in capsys.readouterr().err
