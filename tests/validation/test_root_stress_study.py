import itertools
from dataclasses import replace

import numpy as np
import pytest

from loaded_tca.gears.basic_settings import duplex_spread_blade
from loaded_tca.pairs.bevel import face_milled_pair
from validation.face_milled.pairs import duplex_blank
from validation.loaded import root_stress, root_stress_families


def test_finer_mesh_is_finer_everywhere():
    fine, density = root_stress.finer(root_stress.SECTION), root_stress.SECTION
    for name in ("through", "flank", "fillet", "land", "rim", "lengthwise"):
        assert getattr(fine, name) > getattr(density, name)
    assert fine.skin == 0.5 * density.skin
    outermost = [1.0 / sum(one.grading**n for n in range(one.through // 2)) for one in (fine, density)]
    assert outermost[0] == pytest.approx(0.5 * outermost[1])


@pytest.mark.thorough
def test_larger_roundings_lower_the_stress_down_to_a_root_that_is_all_round():
    forms = root_stress.root_forms()
    for teeth in root_stress.FORMS:
        tensions = [forms[teeth, rounding].tension for rounding in root_stress.ROUNDINGS]
        assert all(less < more for more, less in itertools.pairwise(tensions))
    assert root_stress.full_rounding() == pytest.approx(0.472, abs=5e-4)  # ISO 53 with c = 0.25: 0.472 m_n at most
    gear = root_stress.spur_pair_gear(rounding=root_stress.full_rounding())
    curve, _ = root_stress.plane_curves(
        gear, root_stress.in_plane(root_stress.SECTION), root_stress.loaded_radii()[1:2]
    )
    assert curve.largest(1)[0][0] == pytest.approx(forms[25, 0.6].tension, rel=1e-6)


@pytest.mark.thorough
def test_roots_of_face_milled_gears_follow_the_edge_radius_of_the_blades():
    """From 0.3 to 1 mm the notch factor of ISO 6336-3 alone falls to 0.67 to 0.77, for teeth as thick as their lever
    to 1.3 times to 0.7 times; and roots become thicker."""
    density = replace(root_stress.SECTION, through=6, flank=4, rim=4, lengthwise=6, neighbours=1, skin=0.01)
    found = []
    for radius in (0.3, 1.0):
        gear = face_milled_pair(*duplex_spread_blade(duplex_blank(), edge_radius=radius)).wheel
        found.append(root_stress_families.largest(root_stress.model_of(gear, density)))
    ratio = found[1] / found[0]
    assert ((ratio > 0.5) & (ratio < 0.77)).all(), np.round(ratio, 3)


def test_largest_error_of_a_family_is_told_for_sections_and_layers():
    finer = root_stress_families.finer_meshes(root_stress.SECTION)
    sections, layers = finer.values()
    assert sections.lengthwise == root_stress.SECTION.lengthwise
    assert sections.through > root_stress.SECTION.through
    assert layers == replace(root_stress.SECTION, lengthwise=18)
