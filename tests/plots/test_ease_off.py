import numpy as np
import pytest

from loaded_tca.flank_maps.ease_off_map import ease_off_map
from loaded_tca.flank_maps.vh_check import vh_check
from loaded_tca.flanks import FlankModifications
from loaded_tca.pairs.cylindrical import Mounting
from loaded_tca.plots import save_figure
from loaded_tca.plots.vh_check import plot_ease_off, plot_vh_check
from tests.samples.gear_pairs import gear_pair
from tests.samples.pictures import told

TWISTED = FlankModifications(twist=0.020, lead_crowning=0.004)


def written(figure):
    figure.draw_without_rendering()
    found = [told(figure), figure.get_supxlabel(), figure.get_supylabel()]
    for axes in figure.axes:
        found += [axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
        found += [text.get_text() for text in axes.texts]
        found += [cell.get_text().get_text() for table in axes.tables for cell in table.get_celld().values()]
    return found


@pytest.mark.thorough
def test_ease_off_picture_has_corner_values_and_coefficients(tmp_path):
    figure = plot_ease_off(ease_off_map(gear_pair(TWISTED)), "Twisted $pair")
    texts = written(figure)
    assert texts[0] == "ease-off of the pinion against the conjugate of its mating flank; Twisted $pair"
    corners = 1e3 * ease_off_map(gear_pair(TWISTED)).corners
    assert {f"{corner:.1f}" for corner in corners.ravel()} <= set(texts)
    assert texts[texts.index("twist [µm]") + 1] == "20"
    assert texts[texts.index("lengthwise crowning [µm]") + 1] == "4"
    assert "diameter [mm]" in texts
    save_figure(figure, tmp_path / "ease_off.png")
    assert (tmp_path / "ease_off.png").stat().st_size > 10_000


def test_corner_values_stand_at_their_corners():
    found = ease_off_map(gear_pair(TWISTED))
    axes = plot_ease_off(found).axes[0]
    for note, (i, j) in zip(axes.texts[-4:], np.ndindex(2, 2), strict=True):
        assert note.get_text() == f"{1e3 * found.corners[i, j]:.1f}"
        assert note.xy == (found.axial[-i, -j], 2.0 * found.radius[-i, -j])


def test_no_label_of_a_contour_stands_under_the_value_of_a_corner():
    figure = plot_ease_off(ease_off_map(gear_pair(TWISTED, mounting=Mounting(out_of_plane=3e-4))))
    axes = figure.axes[0]
    figure.draw_without_rendering()
    *labels, _, _, _, _ = axes.texts
    values = [note.get_bbox_patch().get_window_extent() for note in axes.texts[-4:]]
    shown = [label.get_window_extent() for label in labels if label.get_visible()]
    assert 0 < len(shown) < len(labels)
    assert not any(value.overlaps(label) for value in values for label in shown)


def test_conjugate_pair_is_drawn_flat_not_as_rounding():
    figure = plot_ease_off(ease_off_map(gear_pair(helix_deg=15.0), "wheel"))
    assert written(figure)[0].startswith("ease-off of the wheel")
    assert figure.axes[0].collections[0].get_clim()[1] >= 0.009


@pytest.mark.thorough
def test_part_that_the_mate_does_not_cover_is_hatched():
    covered, slanted = (
        plot_ease_off(ease_off_map(gear_pair(TWISTED, mounting=Mounting(out_of_plane=angle)))) for angle in (0.0, 2e-3)
    )
    hatched = [any("///" in part.hatches for part in one.axes[0].collections) for one in (covered, slanted)]
    assert hatched == [False, True]


@pytest.fixture(scope="module")
def check():
    def build(v, h):
        crowned = FlankModifications(lead_crowning=0.05, profile_crowning=0.01)
        return gear_pair(crowned, mounting=Mounting(in_plane=v, out_of_plane=h))

    return vh_check(build, [0.0, 1e-3], [2e-2, 0.0, -1e-3], positions=7)


def panels(figure, check):
    return np.reshape(figure.axes[: check.edge_share.size], check.edge_share.shape)


@pytest.mark.thorough
def test_vh_picture_has_a_cell_for_each_pair_of_errors_in_their_order(check, tmp_path):
    figure = plot_vh_check(check, ("in-plane [rad]", "out-of-plane [rad]"), "A pair")
    cells = panels(figure, check)
    assert [axes.get_ylabel() for axes in cells[:, 0]] == ["0.001", "0"]  # upwards
    assert [axes.get_xlabel() for axes in cells[-1]] == ["-0.001", "0", "0.02"]
    texts = written(figure)
    assert texts[0] == "contact pattern on the pinion, marking compound 6.35 µm, no load; A pair"
    assert texts[1:3] == ["out-of-plane [rad]", "in-plane [rad]"]
    save_figure(figure, tmp_path / "vh_check.png")
    assert (tmp_path / "vh_check.png").stat().st_size > 10_000


def test_vh_picture_marks_the_centre_and_the_edge(check):
    cells = panels(plot_vh_check(check), check)
    (dot,) = cells[1, 2].lines
    np.testing.assert_array_equal(dot.get_xydata()[0], check.centre[0, 0])
    widths = [axes.spines["left"].get_linewidth() for axes in cells[1]]
    assert check.edge_share[0, 0] == 1.0
    assert widths[2] > widths[1]
