"""What the page about the bidirectional start says of its pairs holds."""

import pytest

from validation.face_milled.duplex_document import document, picture
from validation.face_milled.duplex_paper import outcomes, studies


@pytest.mark.thorough
@pytest.mark.parametrize("study", studies(), ids=lambda study: study.name)
def test_starts_lead_home_where_the_flanks_touch_inside_and_nowhere_on_edges(study):
    found = outcomes(study).values()
    assert len({outcome.on_edge for outcome in found}) == 1
    for outcome in found:
        reached = {text.endswith("steps") for text in outcome.conventional.values()}
        assert reached == {not outcome.on_edge}
        assert outcome.reduced is not None


@pytest.mark.thorough
def test_page_tells_the_misprints_and_the_toe_corner():
    text = document()
    for said in ("5.349393", "5.346931", "5.310104", "5.309104", "-1.59 deg", "+1.68 deg", "12.29 and 12.50 arcsec"):
        assert said in text
    assert "10 mm from mid-face to the toe" in " ".join(text.split())
    assert "{" not in text


@pytest.mark.thorough
def test_picture_has_a_flank_and_an_error_curve_for_either_pair():
    assert len(picture().axes) == 4
