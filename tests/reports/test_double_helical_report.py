"""Report of a double helical pair: figures of both halves, what may differ between them, pictures."""

import pytest

from loaded_tca.cli import main
from loaded_tca.plots import DOUBLE_HELICAL_CAPTIONS, DOUBLE_HELICAL_PICTURES
from tests.reports.test_report import Page
from tests.samples.double_helical import analysed

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")


def test_report_has_both_halves_and_every_picture(tmp_path, monkeypatch):
    monkeypatch.setattr("loaded_tca.reports.page.svg_of", lambda *_: "<svg></svg>")  # made but not drawn
    result = analysed()[0]
    result.save(tmp_path)
    assert main(["report", str(tmp_path)]) == 0
    page = Page(tmp_path / "report.html")
    text = " ".join(page.text)
    assert page.headings[:4] == [result.scene.title, "What was asked", "Key figures", "Halves"]
    rows = {row[0]: row[1:] for table in page.tables for row in table}
    assert rows["half b torque share"] == ["0.5"]
    assert rows["pinion.modifications.helix_slope_um"] == ["8.0"]  # of half b
    assert [float(cell) for cell in rows["axial motion mean [µm]"]] == pytest.approx(
        [1e3 * result.axial_motion.mean()], rel=1e-3
    )
    assert "half_b.nc" in text
    assert all(caption in page.words for caption in DOUBLE_HELICAL_CAPTIONS.values())
    assert set(DOUBLE_HELICAL_CAPTIONS) == set(DOUBLE_HELICAL_PICTURES)
