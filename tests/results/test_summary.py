"""The text of the key figures."""

from loaded_tca.results.summary import summary_text
from tests.samples.results import result


def summary(**changes):
    (figures,) = result(positions=1).key_figures()
    return summary_text("title", "scope", [{**figures, **changes}])


def cells(text, label):
    return next(row for row in text.splitlines() if row.startswith(label))[len(label) :].split()


def test_numbers_are_plain_up_to_any_size():
    text = summary(peak_pressure_MPa=11783.2, normal_force_at_peak_N=9999.6, line_load_at_largest_force_N_per_mm=9999.4)
    assert cells(text, "peak pressure [MPa] | pinion angle [deg]")[0] == "11783"
    assert cells(text, "  normal force of that tooth pair [N]") == ["10000"]
    assert cells(text, "line load under the largest force; mesh-dependent at sharp ends [N/mm]") == ["9999"]
    assert "e+" not in text


def test_force_is_told_as_that_of_one_pair_and_not_beside_the_torque():
    text = summary()
    assert cells(text, "pinion torque [N m]") == ["130"]
    assert "normal force of that tooth pair" in text.splitlines()[4]


def test_first_figure_is_the_peak_pressure_and_an_edge_stands_apart_with_its_force():
    text = summary(edge_pressure_MPa=20070.0, normal_force_at_edge_N=0.06)
    first = next(row for row in text.splitlines() if "[MPa]" in row)
    assert first.startswith("peak pressure [MPa]")
    assert cells(text, "at a sharp edge of any pair, mesh-dependent [MPa] | its force [N]") == ["20070", "|", "0.06"]
    assert "at an edge" not in summary()


def test_edges_are_told_apart_by_whether_they_are_rounded():
    """Under two torques a tip is reached, at the larger one beyond its rounding."""
    (figures,) = result(positions=1).key_figures()
    known = {"edge_pressure_MPa": 2000.0, "normal_force_at_edge_N": 5.0}
    rounded = figures | known | {"edge_is_rounded": True, "edge_pressure_error": 0.0123}
    sharp = figures | known | {"edge_is_rounded": False}
    for entries, label, errors in (
        ([rounded, rounded, figures], "at a rounded edge", ["1.2", "1.2", "-"]),
        ([rounded, sharp], "at an edge of any pair, mesh-dependent if sharp", ["1.2", "-"]),
    ):
        text = summary_text("title", "scope", entries)
        assert cells(text, f"{label} [MPa] | its force [N]")[:3] == ["2000", "|", "5"]
        blocks = text.split("\n\n")  # of three torques, the last stands below
        assert [cell for block in blocks for cell in cells(block, "  estimated error [%]")] == errors
        count = ", ".join(["130"] * entries.count(rounded))
        assert f"above the peak pressure, which leaves edges out ({count} N m)" in text
    assert "estimated error" not in summary_text("title", "scope", [sharp, figures])
    assert "leaves edges out" not in summary_text("title", "scope", [rounded | {"edge_pressure_MPa": 1.0}])


def test_row_after_hertz_is_left_out_where_it_holds_nowhere():
    assert "highest where Hertz holds" in summary()
    nothing = dict.fromkeys(
        (
            "peak_pressure_where_hertz_holds_MPa",
            "hertz_pressure_there_MPa",
            "hertz_length_there_mm",
            "hertz_width_there_mm",
        ),
        float("nan"),
    )
    assert "highest where Hertz holds" not in summary(**nothing)
