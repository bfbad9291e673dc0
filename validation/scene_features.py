"""Features of scenes: what a scene file can say beyond two plain gears, each as a draw of its own.

A feature takes a random generator and a scene and returns the scene with it. Sizes are those of ordinary gears: amounts
of micrometres, roundings of hundredths of a module, shafts of the size of bores. The table at the end has them all.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from loaded_tca.arrays import GEARS, Array
from loaded_tca.flanks.measured_columns import flank_of_lines
from loaded_tca.scene import Scene
from loaded_tca.scene.parse import scene_from_table
from loaded_tca.scene.rack import RackScene
from loaded_tca.scene.section import as_table, contents

Draw = Callable[[np.random.Generator, Scene], Scene]
Section = dict[str, Any]
EXTERNAL = frozenset({"spur", "helical"})
CYLINDRICAL = EXTERNAL | {"internal"}
BEVEL = frozenset({"straight_bevel", "spiral_bevel"})
CUT = frozenset({"face_milled", "hypoid"})
RACK, HALVES = frozenset({"rack"}), frozenset({"double_helical"})
CUT_BY_RACKS = EXTERNAL | HALVES
PARALLEL = CYLINDRICAL | RACK | HALVES
ON_SHAFTS = CYLINDRICAL | BEVEL | CUT | RACK
ALL = ON_SHAFTS | HALVES
ROUNDINGS = (0.02, 0.28)
"""Least and largest radius of a rounded edge over the module; scenes allow 0.3."""
TORQUES = (1e-2, 10.0)
"""Least and largest torque over that of the line load of the scene."""
POINTS = (7, 9)
"""Of a measured flank, along the profile and lengthwise."""
IN_INCHES = {"mm": ("in", 25.4), "um": ("uin", 0.0254)}
"""Unit of a key -> that of drawings in inches, and how much of the first it is."""
TOOL = {"addendum_coefficient": (0.9, 1.0), "dedendum_coefficient": (1.2, 1.4), "root_radius_coefficient": (0.2, 0.38)}
"""Of a tool of its own: least and largest coefficients."""
LINE = 20
"""Half of the spaces between the points of a measured line."""


class Feature(NamedTuple):
    """What a scene may have: its name, the families that can have it, the chance of its coin, and how it is drawn."""

    name: str
    families: frozenset[str]
    chance: float
    draw: Draw


def _around_axes(scene: Scene) -> tuple[str, ...]:
    """Gears that turn about an axis: not a rack."""
    return GEARS[:1] if scene.rack_radius else GEARS


# Which flanks, how much load


def _wheel_drives(_: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({"pair.driving": "wheel"})


def _other_flank(_: np.random.Generator, scene: Scene) -> Scene:
    """The other flanks of the teeth: of spiral teeth by name, else by the sense of rotation."""
    spiral = getattr(scene.geometry, "pinion_flank", None) is not None
    return scene.with_changes({"pair.pinion_flank": "convex"} if spiral else {"pair.sense": "negative"})


def _other_torque(rng: np.random.Generator, scene: Scene) -> Scene:
    factor = np.exp(rng.uniform(*np.log(TORQUES)))
    return scene.with_changes({"load.pinion_torque_Nm": float(factor * scene.load.pinion_torque_Nm)})


def _several_torques(rng: np.random.Generator, scene: Scene) -> Scene:
    torques = scene.load.pinion_torque_Nm * np.array([rng.uniform(0.1, 0.6), 1.0])
    return scene.with_changes({"analysis.torques_Nm": torques.tolist()})


# Gears


def _unlike_faces(rng: np.random.Generator, scene: Scene) -> Scene:
    gear: Any = scene.pinion
    return scene.with_changes({"pinion.face_width_mm": float(rng.uniform(1.02, 1.2)) * gear.face_width_mm})


def _thinner_teeth(rng: np.random.Generator, scene: Scene) -> Scene:
    amounts = scene.pair().module * rng.uniform(-50.0, -5.0, 2)  # um
    return scene.with_changes(
        {f"{gear}.thickness_allowance_um": float(one) for gear, one in zip(GEARS, amounts, strict=True)}
    )


def _other_centre_distance(rng: np.random.Generator, scene: Scene) -> Scene:
    """A centre distance a little larger than the one without backlash."""
    distance = scene.mesh().working_centre_distance + scene.pair().module * rng.uniform(0.01, 0.1)
    if min(scene.pinion.teeth, scene.wheel.teeth) < 0:
        distance -= scene.pair().module * 0.1
    return scene.with_changes({"pair.centre_distance_mm": float(distance)})


def _shorter_tips(rng: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({f"{gear}.tip_alteration_coefficient": float(rng.uniform(-0.2, 0.0)) for gear in GEARS})


def _own_racks(rng: np.random.Generator, scene: Scene) -> Scene:
    """A rack of its own for each gear; a ring's is deeper alone."""
    changes = {f"{gear}.dedendum_coefficient": float(rng.uniform(1.2, 1.4)) for gear in GEARS}
    for gear in GEARS[: 1 if scene.wheel.teeth < 0 else 2]:
        changes[f"{gear}.root_radius_coefficient"] = float(rng.uniform(0.2, 0.4))
        changes[f"{gear}.addendum_coefficient"] = float(rng.uniform(0.9, 1.0))
    return scene.with_changes(changes)


def _few_teeth(rng: np.random.Generator, scene: Scene) -> Scene:
    """A pinion that its rack undercuts; the path of contact begins where that ends its flank."""
    return scene.with_changes({"pinion.teeth": int(rng.integers(11, 15)), "pinion.profile_shift": 0.0})


def _protuberance(rng: np.random.Generator, scene: Scene) -> Scene:
    """An undercut of a hundredth of a module that grinding leaves of one gear, or of both."""
    module = 1e3 * scene.pair().module  # um
    stock = {
        f"{gear}.grinding_stock_um": float(module * rng.uniform(0.01, 0.02)) for gear in GEARS[: rng.integers(1, 3)]
    }
    more = {key.replace("grinding_stock", "protuberance"): value + 0.01 * module for key, value in stock.items()}
    return scene.with_changes(stock | more)


def _cutter(rng: np.random.Generator, scene: Scene) -> Scene:
    """A pinion-type cutter, which generates the fillets of the ring."""
    return scene.with_changes({"wheel.cutter": {"teeth": int(rng.integers(18, 26))}})


def _tip_chamfer(rng: np.random.Generator, scene: Scene) -> Scene:
    gear = str(rng.choice(_around_axes(scene)))
    height = float(scene.pair().module * rng.uniform(0.03, 0.1))
    return scene.with_changes(
        {f"{gear}.tip_chamfer_mm": height, f"{gear}.tip_chamfer_angle_deg": float(rng.uniform(45.0, 60.0))}
    )


def _shaft_angle(rng: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({"pair.shaft_angle_deg": float(rng.uniform(60.0, 115.0))})


def _blank(rng: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({"pair.blank": {"taper": str(rng.choice(["standard", "uniform"]))}})


def _bores(rng: np.random.Generator, scene: Scene) -> Scene:
    """Other bores, or none, than those by default."""
    names = GEARS[:1] if scene.rack_radius or scene.wheel.teeth < 0 else GEARS
    bores = zip(names, scene.pair().rigid_bores, strict=False)
    return scene.with_changes({f"{name}.bore_diameter_mm": float(bore * rng.uniform(0.7, 1.1)) for name, bore in bores})


def _own_tool(rng: np.random.Generator, scene: Scene) -> Scene:
    """A tool of its own for a pinion beside a rack, whose fillets are those of [pair]."""
    own = {name: float(rng.uniform(*ends)) for name, ends in TOOL.items()}
    rack = {name: float(rng.uniform(*TOOL[name])) for name in ("dedendum_coefficient", "root_radius_coefficient")}
    places = {"pinion": own, "pair": rack}
    return scene.with_changes({f"{place}.{name}": value for place, of in places.items() for name, value in of.items()})


def _ground_pinion(rng: np.random.Generator, scene: Scene) -> Scene:
    stock, module = float(rng.uniform(0.01, 0.02)), 1e3 * scene.pair().module  # um
    changes = {"grinding_stock_um": stock * module, "protuberance_um": (stock + 0.01) * module}
    return scene.with_changes({f"pinion.{name}": value for name, value in changes.items()})


# Racks


def _distance(rng: np.random.Generator, scene: Scene) -> Scene:
    """A distance of its own: the pinion's profile shift leaves no backlash, or is given and leaves some."""
    scene, module = _as_rack(scene), scene.pair().module
    if rng.random() < 0.5:
        return scene.with_changes({"pair.distance_mm": float(scene.distance + module * rng.uniform(0.01, 0.1))})
    shift = {"pinion.profile_shift": None, "pair.distance_mm": float(scene.distance + module * rng.uniform(-0.1, 0.2))}
    return scene.with_changes(shift)


def _bar(rng: np.random.Generator, scene: Scene) -> Scene:
    """A toothed part that is just long enough, or long, above a bed near the roots or far below."""
    scene = _as_rack(scene)
    module, ways = scene.rack.normal_module, 1.0 + scene.mesh().total_contact_ratio
    length = scene.rack.pitch * ways * float(rng.choice([1.0 + 1e-6, rng.uniform(2.0, 20.0)]))
    return scene.with_changes({"wheel.length_mm": length, "wheel.height_mm": float(module * rng.uniform(2.5, 10.0))})


def _addendum(rng: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({"wheel.addendum_mm": float(scene.pair().module * rng.uniform(0.8, 1.0))})


def _as_rack(scene: Scene) -> RackScene:
    assert isinstance(scene, RackScene)
    return scene


# Double helical pairs


def _two_halves(rng: np.random.Generator, scene: Scene) -> Scene:
    """A pair of which either half is the helical pair that the scene was: on both sides of a groove."""
    gap, table = float(scene.pair().module * rng.uniform(2.0, 8.0)), as_table(scene)
    for gear in GEARS:
        table[gear]["face_width_mm"] = 2.0 * table[gear]["face_width_mm"] + gap
    table["pair"] |= {"double_helical": True, "gap_mm": gap}
    table["load"]["pinion_torque_Nm"] *= 2.0
    if torques := table["analysis"].get("torques_Nm"):
        table["analysis"]["torques_Nm"] = [2.0 * torque for torque in torques]
    return scene_from_table(table)


def _apex_offset(rng: np.random.Generator, scene: Scene) -> Scene:
    module = scene.mesh().pinion.normal_module
    return scene.with_changes({"pair.apex_offset_mm": float(5e-3 * module * rng.uniform(-1.0, 1.0))})


def _soft_along(rng: np.random.Generator, scene: Scene) -> Scene:
    """An axial support of the gear that floats, from as soft to as stiff as teeth are along the axis."""
    stiffness = float(np.exp(rng.uniform(*np.log((5.0, 500.0)))))
    return scene.with_changes({"pair.axial_stiffness_N_per_um": stiffness})


def _both_held(_: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({"pair.floating": "none", "pair.axial_stiffness_N_per_um": 0.0})


def _flanks_of_half_b(rng: np.random.Generator, scene: Scene) -> Scene:
    """Amounts of half b of one gear that half a does not have, of some micrometres; reliefs are those of both."""
    gear = str(rng.choice(GEARS))
    amounts = {"lead_crowning_um": _amount(rng, 1.0, 8.0), "profile_crowning_um": _amount(rng, 0.0, 4.0)}
    amounts |= {name: _amount(rng, -6.0, 6.0) for name in ("helix_slope_um", "profile_slope_um", "twist_um")}
    own = as_table(scene)[gear]
    return scene.with_changes(
        {f"{gear}.half_b": {**own.get("half_b", {}), "modifications": own["modifications"] | amounts}}
    )


def _fitted_half_b(rng: np.random.Generator, scene: Scene) -> Scene:
    gear = str(rng.choice(GEARS))
    own = as_table(scene)[gear].get("half_b", {})
    return scene.with_changes({f"{gear}.half_b": own | {"flank": {"form": "bspline", "points": [17, 17]}}})


def _errors_of_half_b(rng: np.random.Generator, scene: Scene) -> Scene:
    """Half b of the wheel turned and moved against half a."""
    module = scene.mesh().pinion.normal_module
    sizes = {"misalignment_um": 8.0, "in_plane_deg": 0.01, "out_of_plane_deg": 0.01,
             "centre_distance_error_mm": 5e-3 * module, "axial_offset_mm": 5e-3 * module}  # fmt: skip
    chosen = rng.choice([*sizes], 2, replace=False).tolist()
    return scene.with_changes({"mounting.half_b": {name: sizes[name] * _amount(rng, -1.0, 1.0) for name in chosen}})


# Flanks


def _amount(rng: np.random.Generator, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def _tip_reliefs(rng: np.random.Generator, scene: Scene, form: str) -> Scene:
    return _reliefs(rng, scene, form, "tip", GEARS)


def _root_relief(rng: np.random.Generator, scene: Scene, form: str) -> Scene:
    return _reliefs(rng, scene, form, "root", (str(rng.choice(GEARS)),))


def _reliefs(rng: np.random.Generator, scene: Scene, form: str, end: str, gears: tuple[str, ...]) -> Scene:
    """Reliefs over a part of the active profile, that start at a roll length; of a ring at a diameter."""
    pair, changes = scene.pair(), {}
    for gear, own, low in zip(GEARS, (pair.pinion, pair.wheel), scene.active_starts(), strict=True):
        if gear not in gears:
            continue
        radii, axial = own.flank.grid(201, 3)
        coordinates = own.flank.profile_coordinate(radii, axial).value[:, 1]
        part = rng.uniform(0.2, 0.45)
        start = low + (coordinates[-1] - low) * (part if end == "root" else 1.0 - part)
        name = f"{gear}.modifications.{end}_relief"
        changes |= {f"{name}_um": _amount(rng, 5.0, 25.0), f"{name}_form": form}
        if coordinates[0] < 0.0:  # a ring, whose roll lengths fall towards the tip
            nearest = int(np.abs(coordinates - start).argmin())
            changes[f"{name}_start_mm"] = 2.0 * float(radii[nearest, 1])
        elif gear not in _around_axes(scene):  # a rack, whose reliefs start below its tip line
            changes[f"{name}_start_mm"] = float(np.ptp(radii[:, 1]) * (part if end == "tip" else 1.0 - part))
        else:
            changes[f"{name}_start_length_mm"] = float(start * own.flank.profile_unit)
    return scene.with_changes(changes)


def _end_reliefs(rng: np.random.Generator, scene: Scene) -> Scene:
    """Reliefs at the ends of the face, unlike ones in one scene of two."""
    width, name = scene.pair().face_width, f"{rng.choice(GEARS)}.modifications.end_relief"
    changes = {f"{name}_um": _amount(rng, 5.0, 20.0), f"{name}_length_mm": width * _amount(rng, 0.1, 0.35)}
    if rng.random() < 0.5:
        changes |= {
            f"{name}_upper_um": _amount(rng, 5.0, 20.0),
            f"{name}_upper_length_mm": width * _amount(rng, 0.1, 0.3),
        }
    return scene.with_changes(changes)


def _lead_form(form: str) -> Draw:
    def draw(rng: np.random.Generator, scene: Scene) -> Scene:
        name = "wheel.modifications.lead_crowning"
        return scene.with_changes({f"{name}_um": _amount(rng, 2.0, 10.0), f"{name}_form": form})

    return draw


def _of_one_gear(name: str, low: float, high: float) -> Draw:
    """Feature: an amount [um] of a modification of either gear."""

    def draw(rng: np.random.Generator, scene: Scene) -> Scene:
        return scene.with_changes({f"{rng.choice(GEARS)}.modifications.{name}_um": _amount(rng, low, high)})

    return draw


def _polynomial(rng: np.random.Generator, scene: Scene) -> Scene:
    """Some micrometres at the ends of face and profile, by every term."""
    half, height = 0.5 * scene.pair().face_width, 1.2 * scene.pair().module
    sizes = np.array([1.0, half, height, half * height, half**2, height**2])
    amounts = 1e-3 * rng.uniform(-2.0, 2.0, 6) + 1e-3 * np.array([0.0, 0.0, 0.0, 0.0, 4.0, 3.0])
    return scene.with_changes({f"{rng.choice(GEARS)}.modifications.polynomial_mm": (amounts / sizes).tolist()})


def _fitted(rng: np.random.Generator, scene: Scene) -> Scene:
    return scene.with_changes({f"{rng.choice(_around_axes(scene))}.flank": {"form": "bspline", "points": [17, 17]}})


def _measured(rng: np.random.Generator, scene: Scene) -> Scene:
    """A measured flank with slopes, twist and a wave, of some micrometres each."""
    gear, pair = str(rng.choice(_around_axes(scene))), scene.pair()
    flank = (pair.pinion if gear == "pinion" else pair.wheel).flank
    radius, axial = (part[1::2, 1::2] for part in flank.grid(*(2 * count + 1 for count in POINTS)))
    profile, along = (np.linspace(-1.0, 1.0, 2 * count + 1)[1::2] for count in POINTS)
    profile = profile[:, None]
    slopes = rng.uniform(-2.0, 2.0, 3)
    excess = -3.0 * along**2 - 2.0 * profile**2 + slopes[0] * along + slopes[1] * profile + slopes[2] * along * profile
    excess = excess + 0.4 * np.sin(5.0 * along + rng.uniform(0.0, 6.0))
    return _with_points(scene, gear, radius, axial, excess)


def _measured_lines(rng: np.random.Generator, scene: Scene) -> Scene:
    """A flank measured along a profile and a helix, each with a slope, a crowning and a wave of some micrometres."""
    gear, pair = str(rng.choice(_around_axes(scene))), scene.pair()
    radii, axials = (pair.pinion if gear == "pinion" else pair.wheel).flank.grid(2 * LINE + 1, 2 * LINE + 1)
    middle, along = LINE, np.linspace(-1.0, 1.0, 2 * LINE + 1)[1:-1]
    line = np.repeat([0.0, 1.0], along.size)
    radius = np.concatenate([radii[1:-1, middle], np.full(along.size, radii[middle, middle])])
    axial = np.concatenate([np.full(along.size, axials[middle, middle]), axials[middle, 1:-1]])
    slope, bow, start = rng.uniform([-3.0, 1.0, 0.0], [3.0, 4.0, 6.0], (2, 3)).T[..., None]
    waves = slope * along - bow * along**2 + 0.3 * np.sin(6.0 * along + start)  # um
    grid = flank_of_lines(line, radius, axial, 1e-3 * waves.ravel())
    return _with_points(scene, gear, *grid[:2], 1e3 * grid[2])


def _with_points(scene: Scene, gear: str, radius: Array, axial: Array, excess: Array) -> Scene:
    """With a flank through measured points (n, m): radius and axial coordinate [mm], deviation [um]."""
    columns = {"radius_mm": radius, "axial_mm": axial, "deviation_um": excess}
    measurement = {name: tuple(map(tuple, values.tolist())) for name, values in columns.items()}
    form = {"form": "measured", "coefficients": [6, 6], "degree": 3, "measurement": measurement}
    return scene.with_changes({f"{gear}.flank": form})


def _rounding(edge: str) -> Draw:
    """Feature: rounded edges of both gears."""

    def draw(rng: np.random.Generator, scene: Scene) -> Scene:
        radii = scene.pair().module * np.exp(rng.uniform(*np.log(ROUNDINGS), 2))
        return scene.with_changes(
            {f"{gear}.{edge}_rounding_mm": float(one) for gear, one in zip(GEARS, radii, strict=True)}
        )

    return draw


# Where gears stand


def _mounting(name: str, size: float) -> Draw:
    """Feature: a mounting error; size of a length over the module, of others as it is."""

    def draw(rng: np.random.Generator, scene: Scene) -> Scene:
        unit = scene.pair().module if name.endswith("_mm") else 1.0
        return scene.with_changes({f"mounting.{name}": float(size * unit * rng.uniform(-1.0, 1.0))})

    return draw


def _matrix(rng: np.random.Generator, scene: Scene) -> Scene:
    """A gear on a matrix: a beam that overhangs by some modules, in one scene of two with the thrust coupled to it."""
    module = scene.pair().module
    way, turn, coupled = rng.uniform(0.2, 1.0) * 1e-5 / module, 1e-8 / module**3, 6e-8 / module**2
    matrix = np.diag([way, way, 2.0 * way, turn, turn, turn])
    matrix[0, 4] = matrix[4, 0] = coupled * rng.uniform(-1.0, 1.0)
    matrix[1, 3] = matrix[3, 1] = -matrix[0, 4]
    return scene.with_changes(
        {f"{rng.choice(_around_axes(scene))}.support": {"compliance": tuple(map(tuple, matrix.tolist()))}}
    )


def _shaft(bearings: Callable[[np.random.Generator, float, float], list[Section]], gear: str = "rigid") -> Draw:
    """Feature: the pinion on a shaft of the diameter of its bore, between two bearings or overhanging them."""

    def draw(rng: np.random.Generator, scene: Scene) -> Scene:
        pair = scene.pair()
        middle, module = scene.face_middles[0], pair.module
        width = max(pair.face_width, getattr(scene.pinion, "face_width_mm", 0.0))
        diameter = float(f"{pair.rigid_bores[0]:.3g}")
        overhangs = middle != 0.0 or rng.random() < 0.5
        places = (0.8, 2.0) if overhangs else (-1.0, 1.0)
        start, length = middle - (0.6 if overhangs else 1.5) * width, 3.0 * width
        at = [float(middle + place * width) for place in places]
        shaft = {
            "start_mm": float(start),
            "torque_at_mm": float(start + length),
            "gear": gear,
            "sections": [{"length_mm": float(length), "outer_diameter_mm": diameter}],
            "bearings": [
                {"at_mm": one} | bearing for one, bearing in zip(at, bearings(rng, diameter, module), strict=True)
            ],
        }
        return scene.with_changes({"pinion.support": None, "pinion.bore_diameter_mm": diameter, "pinion.shaft": shaft})

    return draw


def _linear(rng: np.random.Generator, _: float, module: float) -> list[Section]:
    """One that takes thrust and one that takes moments."""
    radial = (module * rng.uniform(50.0, 200.0, 2)).tolist()
    return [
        {"radial_stiffness_N_per_um": radial[0], "axial_stiffness_N_per_um": 0.4 * radial[0]},
        {"radial_stiffness_N_per_um": radial[1], "tilting_stiffness_Nm_per_mrad": 0.05 * module**3},
    ]


def _rolling(rng: np.random.Generator, diameter: float, _: float) -> list[Section]:
    """A deep groove ball bearing, which takes the thrust, and a cylindrical roller bearing, both with clearance."""
    pitch = 1.5 * diameter
    clearances = (1e3 * diameter * rng.uniform(0.0, 4e-4, 2)).tolist()
    return [
        {"type": "ball", "balls": 9, "ball_diameter_mm": 0.2 * pitch, "pitch_diameter_mm": pitch,
         "radial_clearance_um": clearances[0]},
        {"type": "roller", "rollers": 14, "roller_diameter_mm": 0.16 * pitch, "roller_length_mm": 0.16 * pitch,
         "pitch_diameter_mm": pitch, "radial_clearance_um": clearances[1]},
    ]  # fmt: skip


def _tapered(rng: np.random.Generator, diameter: float, _: float) -> list[Section]:
    """Two tapered roller bearings set against each other."""
    pitch, preload = 1.45 * diameter, 1e3 * diameter * float(rng.uniform(0.0, 1e-4))
    common = {"type": "roller", "rollers": 17, "roller_diameter_mm": 0.13 * pitch, "roller_length_mm": 0.19 * pitch,
              "pitch_diameter_mm": pitch, "contact_angle_deg": 14.0, "preload_um": preload}  # fmt: skip
    return [common | {"side": -1}, common | {"side": 1}]


# Teeth that differ


def _pitch_deviations(rng: np.random.Generator, scene: Scene) -> Scene:
    gear = str(rng.choice(GEARS))
    teeth = abs(scene.pinion.teeth if gear == "pinion" else scene.wheel.teeth)
    return scene.with_changes({f"{gear}.pitch.index_um": rng.uniform(-5.0, 5.0, teeth).tolist()})


def _runout(rng: np.random.Generator, scene: Scene) -> Scene:
    name = f"{rng.choice(GEARS)}.pitch.runout"
    return scene.with_changes({f"{name}_um": _amount(rng, 5.0, 30.0), f"{name}_phase_deg": _amount(rng, -180.0, 180.0)})


def _odd_tooth(rng: np.random.Generator, scene: Scene) -> Scene:
    tooth = {"number": 1, "modifications": {"lead_crowning_um": _amount(rng, 5.0, 15.0)}}
    return scene.with_changes({f"{rng.choice(GEARS)}.tooth": [tooth]})


# What is computed


def _cap(rng: np.random.Generator, scene: Scene) -> Scene:
    """A cap on the pressure, which contacts of usual line loads reach in part."""
    both = {gear: own for gear, own in zip(GEARS, (scene.pinion, scene.wheel), strict=True) if own.material is not None}
    places = [f"{gear}.material" for gear in both] or ["material"]
    cap = _amount(rng, 500.0, 1200.0)
    return scene.with_changes({f"{place}.max_pressure_MPa": cap for place in places})


def _unlike_materials(rng: np.random.Generator, scene: Scene) -> Scene:
    """Steel on bronze, cast iron or a plastic; the torque is one for the softer one."""
    modulus, ratio = ((105000.0, 0.34), (170000.0, 0.28), (2800.0, 0.4))[int(rng.integers(3))]
    softer, steel = (GEARS[1], GEARS[0]) if rng.random() < 0.7 else GEARS
    factor = min(1.0, (modulus / 206000.0) ** 0.7)
    return scene.with_changes(
        {
            "material": None,
            f"{softer}.material": {"youngs_modulus_MPa": modulus, "poisson_ratio": ratio},
            f"{steel}.material": {"youngs_modulus_MPa": 206000.0, "poisson_ratio": 0.3},
            "load.pinion_torque_Nm": factor * scene.load.pinion_torque_Nm,
        }
    )


def _setting(**values: Any) -> Draw:
    """Feature: settings of the section [analysis]."""
    return lambda _, scene: scene.with_changes({f"analysis.{name}": value for name, value in values.items()})


def _inches(_: np.random.Generator, scene: Scene) -> Scene:
    """Lengths of gears and mounting errors in inches, amounts of modifications in microinches."""
    return _in_inches(scene, (*GEARS, *(f"{gear}.modifications" for gear in GEARS), "mounting"))


def _pair_in_inches(_: np.random.Generator, scene: Scene) -> Scene:
    """Lengths of [pair] in inches: module, groove and apex, the distance of a rack."""
    return _in_inches(scene, ("pair",))


def _in_inches(scene: Scene, places: tuple[str, ...]) -> Scene:
    changes = {}
    for place in places:
        section: Any = scene
        for name in ("geometry" if place == "pair" else place).split("."):
            section = getattr(section, name)
        for name, value in contents(section).items():
            stem, _, unit = name.rpartition("_")
            if isinstance(value, float) and value and unit in IN_INCHES:
                ending, size = IN_INCHES[unit]
                changes[f"{place}.{stem}_{ending}"] = value / size
    return scene.with_changes(changes)


def _form(form: str, draw: Callable[[np.random.Generator, Scene, str], Scene]) -> Draw:
    return lambda rng, scene: draw(rng, scene, form)


FEATURES = (
    Feature("other flank", PARALLEL | BEVEL, 0.2, _other_flank),
    Feature("wheel drives", ALL, 0.3, _wheel_drives),
    Feature("unlike faces", PARALLEL, 0.3, _unlike_faces),
    Feature("few teeth", CUT_BY_RACKS, 0.06, _few_teeth),
    Feature("centre distance", CYLINDRICAL | HALVES, 0.15, _other_centre_distance),
    Feature("shorter tips", CUT_BY_RACKS, 0.15, _shorter_tips),
    Feature("own racks", CYLINDRICAL | HALVES, 0.1, _own_racks),
    Feature("protuberance", CUT_BY_RACKS, 0.1, _protuberance),
    Feature("cutter", frozenset({"internal"}), 0.3, _cutter),
    Feature("tip chamfer", PARALLEL, 0.1, _tip_chamfer),
    Feature("pinion of few teeth", RACK, 0.2, _few_teeth),
    Feature("tool of the pinion", RACK, 0.2, _own_tool),
    Feature("ground pinion", RACK, 0.1, _ground_pinion),
    Feature("distance", RACK, 0.3, _distance),
    Feature("addendum of the rack", RACK, 0.3, _addendum),
    Feature("bar", RACK, 0.4, _bar),
    Feature("shaft angle", BEVEL, 0.3, _shaft_angle),
    Feature("blank", BEVEL, 0.2, _blank),
    Feature("thickness allowances", PARALLEL, 0.15, _thinner_teeth),
    Feature("unlike materials", ALL, 0.15, _unlike_materials),
    Feature("pressure cap", ALL, 0.12, _cap),
    Feature("other torque", ALL, 0.4, _other_torque),
    Feature("several torques", ALL, 0.2, _several_torques),
    Feature("parabolic tip reliefs", ALL, 0.25, _form("parabolic", _tip_reliefs)),
    Feature("linear tip reliefs", ALL, 0.15, _form("linear", _tip_reliefs)),
    Feature("parabolic root relief", ALL, 0.1, _form("parabolic", _root_relief)),
    Feature("linear root relief", ALL, 0.05, _form("linear", _root_relief)),
    Feature("end reliefs", ALL, 0.2, _end_reliefs),
    Feature("circular crowning", ALL, 0.1, _lead_form("circular")),
    Feature("logarithmic crowning", ALL, 0.1, _lead_form("logarithmic")),
    Feature("profile crowning", ALL, 0.2, _of_one_gear("profile_crowning", 1.0, 5.0)),
    Feature("helix slope", ALL, 0.2, _of_one_gear("helix_slope", -8.0, 8.0)),
    Feature("profile slope", ALL, 0.15, _of_one_gear("profile_slope", -5.0, 5.0)),
    Feature("twist", ALL, 0.15, _of_one_gear("twist", -8.0, 8.0)),
    Feature("polynomial", ALL, 0.1, _polynomial),
    Feature("fitted flank", ALL, 0.08, _fitted),
    Feature("measured flank", ALL, 0.08, _measured),
    Feature("measured lines", PARALLEL, 0.06, _measured_lines),
    Feature("tip roundings", ALL, 0.2, _rounding("tip")),
    Feature("side roundings", ALL, 0.2, _rounding("side")),
    Feature("misalignment", PARALLEL, 0.3, _mounting("misalignment_um", 20.0)),
    Feature("axis error in the plane", PARALLEL, 0.15, _mounting("in_plane_deg", 0.02)),
    Feature("axis error across the plane", PARALLEL, 0.15, _mounting("out_of_plane_deg", 0.02)),
    Feature("error of the centre distance", PARALLEL, 0.15, _mounting("centre_distance_error_mm", 0.02)),
    Feature("axial offset", PARALLEL, 0.15, _mounting("axial_offset_mm", 0.3)),
    Feature("two halves", HALVES, 1.0, _two_halves),
    Feature("apex offset", HALVES, 0.5, _apex_offset),
    Feature("wheel floats", HALVES, 0.25, lambda _, scene: scene.with_changes({"pair.floating": "wheel"})),
    Feature("axial support", HALVES, 0.25, _soft_along),
    Feature("both gears held", HALVES, 0.25, _both_held),
    Feature("flanks of half b", HALVES, 0.5, _flanks_of_half_b),
    Feature("fitted half b", HALVES, 0.1, _fitted_half_b),
    Feature("errors of half b", HALVES, 0.25, _errors_of_half_b),
    Feature("offset", BEVEL | CUT, 0.25, _mounting("offset_mm", 0.015)),
    Feature("axial place of the pinion", BEVEL | CUT, 0.25, _mounting("pinion_axial_mm", 0.015)),
    Feature("axial place of the wheel", BEVEL | CUT, 0.25, _mounting("wheel_axial_mm", 0.015)),
    Feature("error of the shaft angle", BEVEL | CUT, 0.15, _mounting("shaft_angle_error_deg", 0.02)),
    Feature("matrix", ON_SHAFTS, 0.08, _matrix),
    Feature("shaft", ON_SHAFTS, 0.08, _shaft(_linear)),
    Feature("shaft along the face", EXTERNAL | RACK, 0.06, _shaft(_linear, "along")),
    Feature("rolling bearings", CYLINDRICAL | RACK, 0.08, _shaft(_rolling)),
    Feature("tapered bearings", ON_SHAFTS, 0.06, _shaft(_tapered)),
    Feature("pitch deviations", CYLINDRICAL | BEVEL | CUT, 0.1, _pitch_deviations),
    Feature("runout", CYLINDRICAL | BEVEL | CUT, 0.1, _runout),
    Feature("odd tooth", CYLINDRICAL | BEVEL | CUT, 0.05, _odd_tooth),
    Feature("teeth bend", ALL, 0.25, _setting(compliance="contact+tooth")),
    Feature("bores", CYLINDRICAL | BEVEL | RACK, 0.1, _bores),
    Feature("edges not free", ALL, 0.1, _setting(free_edges=False)),
    Feature("one pair carries", ON_SHAFTS, 0.08, _setting(load_sharing=False)),
    Feature("all edge pressures", ALL, 0.1, _setting(edge_pressures="all")),
    Feature("inches", ALL, 0.1, _inches),
    Feature("pair in inches", RACK | HALVES, 0.2, _pair_in_inches),
)
"""In the order in which they are drawn: gears before flanks, whose reliefs follow from them, before shafts."""
