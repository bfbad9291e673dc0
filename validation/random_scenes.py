"""Random scenes of all families: gear pairs that nobody has tried, for what must hold of every one.

A scene is known by its seed. Sizes, teeth, angles, modifications, mounting errors and torques are drawn from ranges of
ordinary gears; the torque is that of a line load drawn for the size of the teeth. What makes no gears is drawn again.

``random_scene`` draws gears with crownings, reliefs and mounting errors. ``featured_scene`` starts from plainer ones
and tosses a coin for every feature of ``validation.scene_features`` that its family has: whatever a scene file can say.
"""

import warnings
from pathlib import Path
from typing import Any, NamedTuple
from zlib import crc32

import numpy as np

from loaded_tca import AccuracyWarning, parse_scene, read_scene
from loaded_tca.arrays import GEARS
from loaded_tca.errors import LoadedTCAError
from loaded_tca.scene import Scene
from loaded_tca.scene.double_helical import DoubleHelicalScene
from validation.scene_features import FEATURES, Feature

SCENES = Path(__file__).parents[1] / "examples" / "scenes"
FAMILIES = (
    "helical",
    "helical",
    "helical",
    "spur",
    "helical",
    "straight_bevel",
    "helical",
    "spiral_bevel",
    "face_milled",
)
"""By seed, in turn: most gears are helical, and have most kinds of edges and reliefs."""
ALL_FAMILIES = (
    "helical",
    "spur",
    "internal",
    "spiral_bevel",
    "helical",
    "straight_bevel",
    "helical",
    "internal",
    "spiral_bevel",
    "face_milled",
    "spur",
    "hypoid",
)
"""By seed, in turn, of scenes with features: flanks that machines cut take ten times as long as others."""
FROM_HERE, LATER_FAMILIES = 10_000, ("rack", "double_helical")
"""Seeds from here on have these families in turn: later kinds leave the scenes of earlier seeds as they are."""
MOST_DRAWS = 100
Section = dict[str, Any]


def random_scene(seed: int, **analysis: Any) -> Scene:
    """Scene of a seed, with these keys of its section [analysis]."""
    rng, family = np.random.default_rng(seed), FAMILIES[seed % len(FAMILIES)]
    for _ in range(MOST_DRAWS):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)
                scene = _DRAWS[family](rng).with_changes({f"analysis.{key}": value for key, value in analysis.items()})
                scene.pair()
        except LoadedTCAError:
            continue
        return scene
    raise RuntimeError(f"seed {seed}: no {family} pair in {MOST_DRAWS} draws")


class FeaturedScene(NamedTuple):
    """A scene with what it has beyond plain gears.

    Attributes
    ----------
    seed : int
    family : str
    features : tuple of str
        Names of ``validation.scene_features.FEATURES``.
    scene : Scene
    """

    seed: int
    family: str
    features: tuple[str, ...]
    scene: Scene


def featured_scene(seed: int, **analysis: Any) -> FeaturedScene:
    """Scene of a seed with its features, and these keys of its section [analysis].

    Gears and features are drawn each by generators of their own, so that a new feature leaves all others as they are. A
    feature that does not go with those before it is left out.
    """
    family, tossed = coins(seed)
    scene, features = _plain(family, np.random.default_rng([seed, 0])), []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        for feature, rng in tossed:
            try:
                more = feature.draw(rng, scene)
                _make(more)
            except LoadedTCAError:
                continue
            scene = more
            features.append(feature.name)
        scene = scene.with_changes({f"analysis.{key}": value for key, value in analysis.items()})
    return FeaturedScene(seed, family, tuple(features), scene)


def coins(seed: int) -> tuple[str, list[tuple[Feature, np.random.Generator]]]:
    """Family of a seed, and the features whose coins fall for it, each with the generator that draws it."""
    families = ALL_FAMILIES if seed < FROM_HERE else LATER_FAMILIES
    family, tossed = families[seed % len(families)], []
    for feature in FEATURES:
        rng = np.random.default_rng([seed, crc32(feature.name.encode())])
        if family in feature.families and rng.random() < feature.chance:
            tossed.append((feature, rng))
    return family, tossed


def _plain(family: str, rng: np.random.Generator) -> Scene:
    """Two gears of a family, crowned a little, under the torque of a usual line load; their flanks alone deform."""
    for _ in range(MOST_DRAWS):
        try:
            scene = _PLAIN[family](rng).with_changes({"analysis.compliance": "contact"})
            _make(scene)
        except LoadedTCAError:
            continue
        return scene
    raise RuntimeError(f"no {family} pair in {MOST_DRAWS} draws")


def _make(scene: Scene) -> None:
    """Make the gears of a scene, which its values may not allow."""
    if isinstance(scene, DoubleHelicalScene):
        assert scene.halves
    else:
        scene.pair()
    scene.interferences()


def _crowned(rng: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({"pinion.modifications.lead_crowning_um": float(rng.uniform(1.0, 8.0))})


def _cylindrical(rng: np.random.Generator, helix_angle: float) -> Scene:
    """A spur or helical pair at its standard centre distance, with reliefs and crownings as engineers choose them."""
    return _with_reliefs(rng, _two_cylinders(rng, helix_angle))


def _two_cylinders(rng: np.random.Generator, helix_angle: float) -> Scene:
    """A spur or helical pair at its standard centre distance, aligned in one scene of two."""
    module, teeth = rng.choice([1.5, 2.0, 2.5, 3.0, 4.0]), (int(rng.integers(18, 40)), int(rng.integers(30, 90)))
    face, shift = float(module * rng.uniform(6.0, 14.0)), float(rng.uniform(0.0, 0.4))
    line_load = module * rng.uniform(40.0, 130.0)  # N/mm
    radius = 0.5 * module * teeth[0] / np.cos(np.radians(helix_angle))
    table: dict[str, Section] = {
        "pair": {"type": "cylindrical", "normal_module_mm": module, "helix_angle_deg": helix_angle},
        "pinion": {"teeth": teeth[0], "face_width_mm": face + rng.choice([0.0, 2.0]), "profile_shift": shift},
        "wheel": {"teeth": teeth[1], "face_width_mm": face, "profile_shift": -shift},
        "mounting": {"misalignment_um": rng.choice([0.0, rng.uniform(-20.0, 20.0)])},
        "load": {"pinion_torque_Nm": 1e-3 * line_load * face * radius},
    }
    if helix_angle:
        table["pinion"]["hand"] = str(rng.choice(["left", "right"]))
    return parse_scene(_toml(_steel(table)))


def _with_reliefs(rng: np.random.Generator, scene: Any) -> Scene:
    """A cylindrical pair with crownings, a helix slope and tip reliefs."""
    mesh, module = scene.mesh(), scene.geometry.normal_module_mm
    changes: Section = {"pinion.modifications.lead_crowning_um": rng.uniform(0.0, 8.0)}
    changes["pinion.modifications.helix_slope_um"] = rng.choice([0.0, rng.uniform(-8.0, 8.0)])
    changes["pinion.modifications.profile_crowning_um"] = rng.choice([0.0, rng.uniform(0.0, 4.0)])
    form = str(rng.choice(["parabolic", "linear"]))
    for gear, tip in (("pinion", 2.0 * mesh.pinion.tip_radius), ("wheel", 2.0 * mesh.wheel.tip_radius)):
        if rng.random() < 0.7:
            changes[f"{gear}.modifications.tip_relief_um"] = rng.uniform(5.0, 30.0)
            changes[f"{gear}.modifications.tip_relief_start_mm"] = tip - module * rng.uniform(0.4, 1.6)
            changes[f"{gear}.modifications.tip_relief_form"] = form
    changed: Scene = scene.with_changes(changes)
    return changed


def _internal(rng: np.random.Generator) -> Scene:
    """A pinion in a ring."""
    helix_angle = float(rng.choice([0.0, rng.uniform(8.0, 25.0)]))
    module, teeth = float(rng.choice([1.5, 2.0, 3.0])), int(rng.integers(18, 32))
    face, radius = float(module * rng.uniform(6.0, 12.0)), 0.5 * module * teeth / np.cos(np.radians(helix_angle))
    table: dict[str, Section] = {
        "pair": {"type": "cylindrical", "normal_module_mm": module, "helix_angle_deg": helix_angle},
        "pinion": {"teeth": teeth, "face_width_mm": face + float(rng.choice([0.0, 2.0])), "profile_shift": 0.3},
        "wheel": {"teeth": -teeth - int(rng.integers(25, 60)), "face_width_mm": face, "profile_shift": -0.3},
        "load": {"pinion_torque_Nm": float(1e-3 * module * rng.uniform(40.0, 130.0) * face * radius)},
    }
    return parse_scene(_toml(_steel(table)))


def _rack(rng: np.random.Generator) -> Scene:
    """A pinion on a rack."""
    helix_angle = float(rng.choice([0.0, rng.uniform(8.0, 25.0)]))
    module, teeth = float(rng.choice([1.5, 2.0, 3.0, 4.0])), int(rng.integers(17, 40))
    face, radius = float(module * rng.uniform(6.0, 12.0)), 0.5 * module * teeth / np.cos(np.radians(helix_angle))
    shift, height = float(rng.uniform(0.0, 0.4)), float(module * rng.uniform(5.0, 9.0))
    table: dict[str, Section] = {
        "pair": {"type": "cylindrical", "normal_module_mm": module, "helix_angle_deg": helix_angle},
        "pinion": {"teeth": teeth, "face_width_mm": face + float(rng.choice([0.0, 2.0])), "profile_shift": shift},
        "wheel": {"teeth": "rack", "face_width_mm": face, "height_mm": height},
        "load": {"pinion_torque_Nm": float(1e-3 * module * rng.uniform(40.0, 130.0) * face * radius)},
    }
    if helix_angle:
        table["pinion"]["hand"] = str(rng.choice(["left", "right"]))
    return parse_scene(_toml(_steel(table)))


def _bevel(rng: np.random.Generator, kind: str) -> Scene:
    """A straight or spiral bevel pair with crownings and mounting errors."""
    module, teeth = rng.choice([1.0, 2.0, 3.0]), (int(rng.integers(16, 25)), int(rng.integers(25, 45)))
    cone_distance = 0.5 * module * float(np.hypot(*teeth))
    face = float(rng.uniform(0.2, 0.3)) * cone_distance
    table: dict[str, Section] = {
        "pair": {"type": kind, "outer_module_mm": module, "shaft_angle_deg": 90.0, "pressure_angle_deg": 20.0},
        "pinion": {"teeth": teeth[0], "face_width_mm": face},
        "wheel": {"teeth": teeth[1], "face_width_mm": face},
        "mounting": {name: 0.01 * module * rng.normal() for name in ("offset_mm", "pinion_axial_mm")},
        "load": {"pinion_torque_Nm": 1e-3 * module * rng.uniform(20.0, 60.0) * face * 0.4 * module * teeth[0]},
    }
    table["pinion.modifications"] = {
        "lead_crowning_um": rng.uniform(4.0, 15.0),
        "profile_crowning_um": rng.uniform(2.0, 8.0),
    }
    if kind == "spiral_bevel":
        table["pair"] |= {"spiral_angle_deg": rng.uniform(25.0, 38.0), "pinion_flank": "concave"}
        table["pinion"]["hand"] = "left"
    return parse_scene(_toml(_steel(table)))


def _face_milled(rng: np.random.Generator) -> Scene:
    """The matched pair 19/62 with mounting errors, under some torque."""
    errors = {f"mounting.{name}": 0.04 * rng.normal() for name in ("offset_mm", "pinion_axial_mm", "wheel_axial_mm")}
    torque = {"load.pinion_torque_Nm": float(rng.uniform(50.0, 400.0))}
    return read_scene(SCENES / "face_milled_19x62_matched.toml").with_changes(errors | torque)


def _hypoid(rng: np.random.Generator) -> Scene:
    """The hypoid pair 13/42 under some torque, without its tip reliefs."""
    reliefs = {f"{gear}.modifications.tip_relief_um": 0.0 for gear in GEARS}
    torque = {"load.pinion_torque_Nm": float(rng.uniform(50.0, 300.0))}
    return read_scene(SCENES / "hypoid_13x42.toml").with_changes(reliefs | torque)


_PLAIN = {
    "spur": lambda rng: _crowned(rng, _two_cylinders(rng, 0.0)),
    "helical": lambda rng: _crowned(rng, _two_cylinders(rng, float(rng.uniform(8.0, 32.0)))),
    "internal": lambda rng: _crowned(rng, _internal(rng)),
    "straight_bevel": lambda rng: _bevel(rng, "straight_bevel"),
    "spiral_bevel": lambda rng: _bevel(rng, "spiral_bevel"),
    "face_milled": lambda rng: _face_milled(rng),
    "hypoid": _hypoid,
    "rack": lambda rng: _crowned(rng, _rack(rng)),
    "double_helical": lambda rng: _crowned(rng, _two_cylinders(rng, float(rng.uniform(15.0, 35.0)))),
}

_DRAWS = {
    "spur": lambda rng: _cylindrical(rng, 0.0),
    "helical": lambda rng: _cylindrical(rng, float(rng.uniform(10.0, 32.0))),
    "straight_bevel": lambda rng: _bevel(rng, "straight_bevel"),
    "spiral_bevel": lambda rng: _bevel(rng, "spiral_bevel"),
    "face_milled": _face_milled,
}


def _steel(table: dict[str, Section]) -> dict[str, Section]:
    return table | {"material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3}}


def _toml(table: dict[str, Section]) -> str:
    """Text of a scene file."""
    lines = []
    for section, keys in table.items():
        lines.append(f"[{section}]")
        for name, value in keys.items():
            lines.append(f'{name} = "{value}"' if isinstance(value, str) else f"{name} = {value}")
    return "\n".join(lines) + "\n"
