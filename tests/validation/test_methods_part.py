"""What the page on methods that part states."""

import pytest

from validation.rating.methods_part import tilted


@pytest.mark.thorough
def test_stiffness_against_tilting_nears_the_mean_one_on_wide_faces():
    narrow, wide = (
        tilted(
            "mesh_cycle_spur",
            **{
                "pinion.face_width_mm": width,
                "wheel.face_width_mm": width,
                "load.pinion_torque_Nm": 10.0 * width,
                "analysis.cells": (8, cells),
                "analysis.positions": 5,
            },
        )
        for width, cells in ((10.0, 16), (60.0, 60))
    )
    assert narrow.misaligned > 1.2 * narrow.method_c
    assert narrow.tilt / narrow.mean > 1.5
    assert 1.0 < wide.tilt / wide.mean < 1.3
