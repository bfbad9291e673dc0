"""Report of a whole revolution: figures, orders by their size and kind, deviations of the teeth, both halves."""

from dataclasses import replace

import numpy as np
import pytest

from loaded_tca import analyse_revolution
from loaded_tca.cli import main
from loaded_tca.errors import InputError
from loaded_tca.plots.double_helical import HALVES_REVOLUTION_PICTURES
from loaded_tca.plots.revolution import REVOLUTION_PICTURES
from loaded_tca.reports import write_html_report
from loaded_tca.reports.revolution_page import MOST_ORDERS, ORDER_GROUPS, order_in_words
from tests.double_helical.test_revolution import OPPOSED, scene_with, shuttling
from tests.reports.test_report import Page, undrawn
from tests.samples.revolutions import INDEX_um, small_turn

WHEN = "2026-03-04T05:06:07+00:00"
FOUR_DIGITS = 5e-4
HALF_A_PLACE = 0.005
"""Of numbers with two decimal places."""

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Reports whose pictures are made but not drawn."""
    monkeypatch.setattr("loaded_tca.reports.page.svg_of", undrawn)
    return lambda turn: Page(write_html_report(turn, tmp_path / "report.html", date=WHEN))


def with_pitches(turn, pitches, **changes):
    """The first pitches of the small turn."""
    scene = turn.scene.with_changes({"revolution.pitches": pitches, **changes})
    return replace(turn, scene=scene, dataset=turn.dataset.isel(position=range(4 * pitches)))


def table_of(page, head):
    """The one table of a page whose first cell is this."""
    (table,) = (table for table in page.tables if table[0][0] == head)
    return table


def numbers(cells):
    return [float(cell) for cell in cells]


def test_report_has_its_sections_and_the_figures_of_the_result(written):
    turn = small_turn()
    page = written(turn)
    assert page.headings == [
        turn.scene.title,
        "What was asked",
        "Key figures",
        "Orders",
        "Deviations of the teeth",
        "Geometry",
        "Accuracy warnings",
        "Pictures",
        "Appendix: scene file",
    ]
    head, *rows = table_of(page, "pinion torque [N m]")
    assert numbers(head[1:]) == [20.0, 60.0]
    figures = {label: numbers(cells) for label, *cells in rows}
    deviations = [turn.total_deviation(torque) for torque in (0, 1)]
    assert figures["total single flank deviation [µm]"] == pytest.approx(deviations, rel=FOUR_DIGITS)
    pressures = np.nanmax(turn.peak_pressure, axis=(1, 2))
    assert figures["peak pressure [MPa]"] == pytest.approx(pressures.tolist(), rel=FOUR_DIGITS)
    assert len(rows) == len(turn.figures) - 1
    assert [row[1:3] for row in page.rows("positions, torques")] == [["96", "2"]]
    assert "24 pitches, 4 positions each, teeth counted from 0" in page.words
    assert all(picture.caption in page.words for picture in REVOLUTION_PICTURES.values())
    assert "no whole turn" not in page.words
    assert "revolutions of their own" not in page.words


def test_orders_are_the_largest_of_the_spectra_with_what_they_are(written):
    """Mesh orders are 24 and, beyond the 47 that 96 positions resolve, 48 of the wheel, five beside them sidebands."""
    turn = small_turn()
    page = written(turn)
    spectra = turn.spectrum(rigid=True), turn.spectrum(0), turn.spectrum(1)
    orders = spectra[0].order
    beside = np.minimum(np.abs(orders - 24.0), np.abs(orders - 48.0))
    for group, of_group in (
        ("orders of the tooth mesh", orders == 24.0),
        ("sidebands of the tooth mesh", (beside > 0.0) & (beside <= 5.0)),
        ("orders of rotation", beside > 5.0),
    ):
        head, *rows = table_of(page, group)
        told = ["cycles per pinion turn", "per wheel turn", "without load [µm]", "20 N m [µm]", "60 N m [µm]"]
        assert head[1:] == told
        assert_orders_are_those_of_spectra(rows, spectra, of_group)
    first = table_of(page, "orders of the tooth mesh")[1]
    assert first[:3] == ["mesh order 1", "17", "24"]
    assert not any(table[0][0] == "other orders" for table in page.tables)


def assert_orders_are_those_of_spectra(rows, spectra, of_group):
    """Rows of a table are the largest amplitudes of a group of orders, with those of all torques."""
    assert len(rows) == min(MOST_ORDERS, np.count_nonzero(of_group))
    of_wheel = np.array([float(row[2]) for row in rows])
    assert np.isin(of_wheel, spectra[0].order[of_group]).all()
    assert numbers(row[1] for row in rows) == pytest.approx((17.0 / 24.0 * of_wheel).tolist(), rel=FOUR_DIGITS)
    for column, spectrum in enumerate(spectra, 3):
        shown = dict(zip(spectrum.order.tolist(), spectrum.amplitude.tolist(), strict=True))
        expected = [shown[order] for order in of_wheel.tolist()]
        assert numbers(row[column] for row in rows) == pytest.approx(expected, rel=FOUR_DIGITS)
    largest = [max(numbers(row[4:])) for row in rows]
    assert largest == sorted(largest, reverse=True)
    left_out = of_group & ~np.isin(spectra[0].order, of_wheel)
    rest = [spectrum.amplitude[left_out].max(initial=0.0) for spectrum in spectra[1:]]
    assert max(rest) <= largest[-1] * (1.0 + FOUR_DIGITS)
    kinds = dict(zip(spectra[0].order.tolist(), spectra[0].kind.tolist(), strict=True))
    assert [row[0] for row in rows] == [order_in_words(kinds[order]) for order in of_wheel.tolist()]


def test_deviations_of_the_teeth_are_those_of_the_scene(written):
    page = written(small_turn())
    rows = {row[0]: row[1:] for table in page.tables for row in table}
    index = np.array(INDEX_um)
    span = "cumulative pitch deviation: span of the index deviations [µm]"
    assert numbers(rows[span]) == pytest.approx([0.0, np.ptp(index)], abs=HALF_A_PLACE)
    steps = np.diff(INDEX_um, append=INDEX_um[0])
    largest = [0.0, np.abs(steps).max()]
    assert numbers(rows["largest single pitch deviation [µm]"]) == pytest.approx(largest, abs=HALF_A_PLACE)
    head, *lines = table_of(page, "tooth")
    assert head[1:] == [f"+{n}" for n in range(10)]
    assert [line[0] for line in lines] == ["0", "10", "20"]
    assert numbers(cell for line in lines for cell in line[1:] if cell) == pytest.approx(INDEX_um, abs=HALF_A_PLACE)


def test_runout_and_teeth_with_flanks_of_their_own_are_told(written):
    changes = {
        "wheel.pitch": {"runout_um": 12.0, "runout_phase_deg": 60.0},
        "pinion.tooth": [{"number": 4}, {"number": 9}],
    }
    turn = small_turn()
    page = written(replace(turn, scene=turn.scene.with_changes(changes)))
    rows = {row[0]: row[1:] for table in page.tables for row in table}
    assert rows["runout, twice the eccentricity [µm]"] == ["0.00", "12.00"]
    assert rows["azimuth of the eccentricity [deg]"] == ["0", "60"]
    assert rows["teeth with flanks of their own"] == ["4, 9", "none"]
    assert "tooth" not in {table[0][0] for table in page.tables}  # no index deviations


def test_revolution_that_is_no_whole_turn_names_its_leaking_orders(written):
    turn = with_pitches(small_turn(), 12)
    page = written(turn)
    assert "12 pitches are no whole turn of the wheel, whose teeth deviate" in page.words
    assert page.rows("single flank deviation over 12 pitches [µm]")
    assert not page.rows("total single flank deviation [µm]")
    head, *rows = table_of(page, "orders of rotation")
    column = head.index("leaking wheel order")
    orders = turn.spectrum().order.tolist()
    leaking = dict(zip(orders, turn.leaking_orders()["wheel"].tolist(), strict=True))
    for row in rows:
        assert (row[column] == "-") == np.isnan(leaking[float(row[2])])
        assert row[column] == "-" or float(row[column]) == leaking[float(row[2])]


def test_teeth_that_are_alike_have_no_deviations_and_no_small_orders(written):
    data = small_turn().dataset
    nothing = data.assign(transmission_error=0.0 * data.transmission_error)
    scene = small_turn().scene.with_changes({"wheel.pitch": None})
    page = written(replace(small_turn(), scene=scene, dataset=nothing))
    assert "All teeth stand at their nominal places and have the same flanks." in page.words
    assert "No order of the transmission error has an amplitude above 0.0001 µm." in page.words
    assert not any(table[0][0] in ORDER_GROUPS for table in page.tables)


def test_finding_on_the_peak_pressure_is_told(written):
    data = small_turn().dataset.copy(deep=True)
    data.on_edge.values[...] = 1
    turn = replace(small_turn(), dataset=data)
    page = written(turn)
    assert len(turn.findings()) == 2
    assert all(f"Note: {sentence}." in page.words for sentence in turn.findings())


def test_command_writes_the_report_of_a_directory(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("loaded_tca.reports.page.svg_of", undrawn)
    small_turn().save(tmp_path / "revolution.nc")
    assert main(["report", str(tmp_path)]) == 0
    assert "report.html" in capsys.readouterr().out
    assert Page(tmp_path / "report.html").headings[0] == small_turn().scene.title


@pytest.mark.thorough
def test_report_of_the_same_revolution_is_the_same_file(tmp_path):
    paths = [write_html_report(small_turn(), tmp_path / f"{name}.html", date=WHEN) for name in ("report", "again")]
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_what_a_revolution_does_not_have_is_refused(tmp_path):
    place = tmp_path / "report.html"
    for way, words in (
        ({"rank_by": "peak_pressure_MPa"}, "a Revolution has no ranking"),
        ({"torque": 60e3}, "a Revolution has all torques"),
        ({"interactive": True}, "found a Revolution; allowed a result or a study"),
    ):
        with pytest.raises(InputError, match=words):
            write_html_report(small_turn(), place, **way)
    assert not place.exists()


def test_double_helical_revolution_has_both_halves_and_the_orders_of_the_motion(written):
    whole = shuttling(analyse_revolution(scene_with(**OPPOSED)))
    whole = replace(whole, scene=whole.scene.with_changes({"wheel.apex_runout_um": 12.0}))
    page = written(whole)
    rows = {row[0]: row[1:] for table in page.tables for row in table}
    assert rows["apex runout, peak to peak [µm]"] == ["0", "12"]
    assert numbers(rows["axial motion: amplitude of order pinion 1 [µm]"]) == [10.0]
    assert rows["wheel order 1"] == ["1", "1", "10"]  # of gears of equal teeth the one that deviates; the motion alone
    assert rows["runout, twice the eccentricity [µm]"] == ["0.00", "8.00"]
    assert rows["azimuth of the eccentricity [deg]"] == ["0", "180"]  # of half b, below half a
    assert "wheel of half b" in page.words
    assert "half_a_revolution.nc and half_b_revolution.nc: loaded-tca report shows each of them" in page.words
    assert all(picture.caption in page.words for picture in HALVES_REVOLUTION_PICTURES.values())
