"""A small scene to change and to break."""

import tomllib

import pytest

from loaded_tca.scene import Scene, parse_scene

SMALL = """
title = "Small"
[pair]
type = "cylindrical"
normal_module_mm = 3
helix_angle_deg = 15.0
[pinion]
teeth = 34
face_width_mm = 25.0
[wheel]
teeth = 57
face_width_mm = 20.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 130.0
"""


@pytest.fixture
def small() -> str:
    return SMALL


@pytest.fixture
def scene() -> Scene:
    return parse_scene(SMALL)


SPIRAL = """
title = "Spiral"
[pair]
type = "spiral_bevel"
outer_module_mm = 4
spiral_angle_deg = 35.0
[pinion]
teeth = 20
face_width_mm = 20.0
[wheel]
teeth = 40
face_width_mm = 20.0
[material]
youngs_modulus_MPa = 206000.0
poisson_ratio = 0.3
[load]
pinion_torque_Nm = 100.0
"""


@pytest.fixture
def spiral() -> Scene:
    return parse_scene(SPIRAL)


@pytest.fixture
def spiral_table() -> dict:
    """The same scene as nested dictionaries."""
    return tomllib.loads(SPIRAL)


@pytest.fixture
def table() -> dict:
    """The same scene as nested dictionaries."""
    return {
        "title": "Small",
        "pair": {"type": "cylindrical", "normal_module_mm": 3, "helix_angle_deg": 15.0},
        "pinion": {"teeth": 34, "face_width_mm": 25.0},
        "wheel": {"teeth": 57, "face_width_mm": 20.0},
        "material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3},
        "load": {"pinion_torque_Nm": 130.0},
    }
