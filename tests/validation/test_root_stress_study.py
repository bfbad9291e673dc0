import pytest

from validation.loaded import root_stress


@pytest.mark.parametrize("rows", [root_stress.plane_rows, root_stress.nine_rows])
def test_root_stress_in_the_plane_is_that_of_the_reference(rows):
    found = list(rows())
    assert len(found) >= 18
    assert not [row.quantity for row in found if not row.holds]


def test_finer_mesh_is_finer_everywhere():
    fine, density = root_stress.finer(root_stress.SECTION), root_stress.SECTION
    for name in ("through", "flank", "fillet", "land", "rim", "lengthwise"):
        assert getattr(fine, name) > getattr(density, name)
    assert fine.skin == 0.5 * density.skin
    outermost = [1.0 / sum(one.grading**n for n in range(one.through // 2)) for one in (fine, density)]
    assert outermost[0] == pytest.approx(0.5 * outermost[1])
