"""Virtual cylindrical gears of bevel and hypoid pairs: printed samples of ISO/TR 10300-30."""

import math
from dataclasses import replace

import numpy as np
from numpy.testing import assert_allclose

from loaded_tca.reference.iso10300 import VirtualPair
from tests.refusals import refused_calls
from tests.samples.hypoid import annex_f3_cones, hypoid_blank

DIGIT = 1.5e-3  # 1.5 of the last digit that is printed


def deg(*angles):
    return tuple(math.radians(angle) for angle in angles)


def bevel():
    """Sample 1: spiral bevel pair 14/39, its sheet as printed."""
    return VirtualPair(
        pitch_angles=deg(19.747, 70.253),
        mean_cone_distances=(81.273, 81.273),
        spiral_angles=deg(35.0, 35.0),
        offset_angles=(0.0, 0.0),
        pressure_angle=math.radians(20.0),
        limit_pressure_angle=0.0,
        mean_normal_module=3.2133,
        mean_addenda=(4.837, 1.590),
        effective_width=0.85 * 25.4,
    )


def hypoid():
    """Sample 2: hypoid pair 13/42 with an offset of 15 mm, its sheet to all digits."""
    found, blank = annex_f3_cones(), hypoid_blank()
    cones = found.cones
    return VirtualPair(
        cones.pitch_angles,
        cones.mean_cone_distances,
        found.spiral_angles,
        (cones.axial_offset_angle, cones.offset_angle),
        blank.generated_pressure_angles[0],
        blank.limit_pressure_angle,
        blank.mean_normal_module,
        blank.mean_addenda,
        0.85 * 30.0,
    )


def test_bevel_sample_has_its_printed_numbers():
    pair = bevel()
    assert_allclose(math.degrees(pair.transverse_pressure_angle), 23.957, atol=DIGIT)
    assert_allclose(pair.path_length, 13.120, atol=3e-3)  # of diameters with five digits
    assert_allclose(pair.contact_ratios, [1.165, 1.227], atol=DIGIT)
    assert_allclose(pair.normal_radius, 13.173, atol=DIGIT)
    assert_allclose(math.degrees(pair.contact_line_angle), 13.468, atol=DIGIT)
    assert_allclose(pair.relative_radius, 12.459, atol=DIGIT)


def test_hypoid_sample_has_its_printed_numbers():
    pair = hypoid()
    assert_allclose(pair.contact_ratios, [1.010, 2.096], atol=DIGIT)
    assert_allclose(pair.normal_radius, 19.924, atol=DIGIT)
    assert_allclose(math.degrees(pair.contact_line_angle), 18.459, atol=DIGIT)
    assert_allclose(pair.relative_radius, 17.926, atol=DIGIT)


def test_larger_pairs_have_larger_radii_and_the_same_ratios():
    pair, factor = hypoid(), 2.0
    larger = replace(
        pair,
        mean_cone_distances=tuple(np.multiply(pair.mean_cone_distances, factor)),
        mean_addenda=tuple(np.multiply(pair.mean_addenda, factor)),
        mean_normal_module=pair.mean_normal_module * factor,
        effective_width=pair.effective_width * factor,
    )
    assert_allclose(larger.relative_radius, factor * pair.relative_radius)
    assert_allclose(larger.contact_ratios, pair.contact_ratios)


test_virtual_pair_refuses = refused_calls(
    (lambda: replace(bevel(), mean_cone_distances=(81.0, 0.0)), "wheel_cone_distance: 0.0 is not positive"),
    (
        lambda: replace(bevel(), mean_normal_module=-1.0, effective_width=math.inf),
        ("mean_normal_module: -1.0", "effective_width: inf"),
    ),
)
