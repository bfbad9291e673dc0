"""Double helical pairs against one half, closed forms of axial displacements, and balance along the axis.

- Equal halves in their places are one half under half the torque: nothing is computed twice, 1e-10.
- The wheel of held gears displaced by d parts the flanks of the halves by 2 d tan(beta_b) without load: of involute
  helicoids exactly, to where contacts are traced, 1e-9.
- It takes load from one half to the other by that and both stiffnesses, F_a - F_b = k d tan(beta_b) with k of both
  halves. The ends of the faces and the crowning move with it, and stiffness grows with the load: of both halves alike,
  but for what is left in third order, 1e-4; 2e-5 is seen.
- The axial forces of unlike halves of a gear that floats balance, 1e-9 of one of them.
- A gear that floats on a support of K takes what is left of them to K times its motion, 1e-9.
- A gear that floats follows an apex that runs out by R: by R/2 where the tooth meshes whose apex lies farthest out,
  less what the teeth in contact up to two pitches of 87 beside it leave, 1 - cos(360 deg 2/87) of them at the most:
  0.01. No axial force is left, 1e-9.
- A shaft that can only twist, of the pinion of equal halves that are held, is a spring in the way of the half that is
  farther from the torque: D(F_a) + 2 l r_b^2/(G I_p) F_a = D(F - F_a), D of one half under several torques. Grids of
  halves differ from torque to torque, by 6e-5 of the share as seen: 3e-4.
"""

import math
import warnings
from pathlib import Path

import numpy as np
import scipy

from loaded_tca import AccuracyWarning, analyse, read_scene, trace_contact
from loaded_tca.double_helical import (
    DoubleHelicalResult,
    analyse_double_helical,
    analyse_double_helical_revolution,
)
from loaded_tca.scene import DoubleHelicalScene
from validation.table import Row

CASE, FORM = "double helical pairs", "closed form"
SCENE = Path(__file__).parents[2] / "examples" / "scenes" / "double_helical.toml"
EQUAL = {"pinion.half_b": None, "pair.apex_offset_mm": 0.0, "pair.floating": "none"}
OFFSET, SUPPORT = 0.005, 20.0  # mm, N/um
RUNOUT = 20.0  # um
SHAFT, LEVER = 90.0, 30.0  # mm
SAME, TRACED, LINEAR, BALANCED, FOLLOWED, TWISTED = 1e-10, 1e-9, 1e-4, 1e-9, 0.01, 3e-4


def rows() -> list[Row]:
    """Rows of all."""
    return [*unloaded_rows(), *equal_rows(), *floating_rows(), *shaft_rows(), *revolution_rows()]


def short_rows() -> list[Row]:
    """Those without load."""
    return unloaded_rows()


def scene_with(**changes: object) -> DoubleHelicalScene:
    """The example on five positions, with other values of keys whose dots are double underscores."""
    own = {key.replace("__", "."): value for key, value in changes.items()}
    scene = read_scene(SCENE).with_changes({"analysis.positions": 5, **own})
    assert isinstance(scene, DoubleHelicalScene)
    return scene


def result_of(scene: DoubleHelicalScene) -> DoubleHelicalResult:
    """Its result, without warnings of contacts that reach an edge."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        return analyse_double_helical(scene)


def unloaded_rows() -> list[Row]:
    """Flanks of both halves, traced where the wheel stands aside."""
    plain = {"pinion__modifications": None, "wheel__modifications": None}
    scene = scene_with(**{key.replace(".", "__"): value for key, value in EQUAL.items()}, **plain)
    angles = []
    for half in scene.half_scenes(OFFSET):
        pair = half.pair()
        angles.append(float(trace_contact(pair, np.zeros(1)).transmission_error[0]) * pair.base_radii[1])
    apart = 2.0 * OFFSET * math.tan(abs(scene.mesh().pinion.base_helix_angle))
    what = f"flanks of both halves apart, wheel aside by {OFFSET:g} mm [mm]"
    return [Row(CASE, FORM, what, apart, abs(angles[0] - angles[1]), TRACED)]


def equal_rows() -> list[Row]:
    """Equal halves in their places, and with the wheel aside."""
    scene = scene_with().with_changes(EQUAL)
    assert isinstance(scene, DoubleHelicalScene)
    result = result_of(scene)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        half = analyse(scene.half_scenes(0.0)[0])
    table = [
        Row(CASE, "one half under half the torque", what, float(expected), float(obtained), SAME)
        for what, expected, obtained in (
            (
                "transmission error, first position [rad]",
                half.transmission_error[0, 0],
                result.transmission_error[0, 0],
            ),
            ("peak pressure [MPa]", np.nanmax(half.peak_pressure), result.peak_pressure.max()),
            ("K_Hbeta of half b", half.face_load_factor[0], result.face_load_factor[0, 1]),
        )
    ]
    aside = scene.with_changes({"mounting.axial_offset_mm": OFFSET})
    assert isinstance(aside, DoubleHelicalScene)
    displaced, mesh = result_of(aside), scene.mesh()
    stiffness = 1e3 * result.face_width * result.mesh_stiffness[0, 0]
    force = (displaced.torque_share[0, 0] @ [1.0, -1.0]) * displaced.torque[0] / mesh.pinion.base_radius
    shift = stiffness * OFFSET * math.tan(abs(mesh.pinion.base_helix_angle))
    what = f"F_a - F_b of held gears, wheel aside by {OFFSET:g} mm [N]"
    table.append(Row(CASE, FORM, what, float(shift), float(force), LINEAR))
    return table


def floating_rows() -> list[Row]:
    """Unlike halves of a pinion that floats, freely and on a support."""
    free = result_of(scene_with())
    left = float(np.abs(free.axial_force_left).max() / np.abs(free.axial_force).max())
    held = result_of(scene_with(pair__axial_stiffness_N_per_um=SUPPORT))
    support = -SUPPORT * 1e3 * held.axial_motion[0, 0]  # the pinion's motion is the wheel's backwards
    return [
        Row(CASE, "balance", "axial force left of a pinion that floats, over that of a half", 0.0, left, BALANCED),
        Row(
            CASE,
            "balance",
            f"axial force left of a pinion on {SUPPORT:g} N/um [N]",
            float(support),
            float(held.axial_force_left[0, 0]),
            BALANCED,
        ),
    ]


def shaft_rows() -> list[Row]:
    """Equal halves on a shaft that can only twist, by two springs."""
    held = {"radial_stiffness_N_per_um": 1e9, "axial_stiffness_N_per_um": 1e9, "tilting_stiffness_Nm_per_mrad": 1e9}
    shaft = {
        "start_mm": -100.0,
        "torque_at_mm": -100.0,
        "sections": [{"length_mm": 200.0, "outer_diameter_mm": SHAFT}],
        "bearings": [{"at_mm": at, **held} for at in (-LEVER, LEVER)],
    }
    scene = scene_with(analysis__positions=1, analysis__compliance="contact").with_changes(EQUAL)
    assert isinstance(scene, DoubleHelicalScene)
    on_shaft = scene.with_changes({"pinion.shaft": shaft})
    assert isinstance(on_shaft, DoubleHelicalScene)
    share = float(result_of(on_shaft).torque_share[0, 0, 0])
    torques = [200.0, 350.0, 500.0, 650.0, 800.0, 950.0, 1100.0, 1250.0, 1400.0]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        half = analyse(scene.half_scenes(0.0, 2 * [torques])[0])
    pair = half.gear_pair
    ways = -pair.driving * pair.base_radii[1] * half.transmission_error[:, 0]
    deflection = scipy.interpolate.CubicSpline(half.torque / pair.base_radii[0], ways)
    twist = 2.0 * LEVER * pair.base_radii[0] ** 2 / (206000.0 / 2.6 * math.pi / 32.0 * SHAFT**4)
    whole = scene.torques[0] / pair.base_radii[0]
    force = scipy.optimize.brentq(
        lambda first: deflection(first) + twist * first - deflection(whole - first), 0.2 * whole, 0.5 * whole
    )
    what = f"share of half a, {2.0 * LEVER:g} mm of a shaft of {SHAFT:g} mm farther from the torque"
    return [Row(CASE, FORM, what, force / whole, share, TWISTED)]


def revolution_rows() -> list[Row]:
    """Equal halves of a pinion that floats, over a pitch of a wheel whose apex runs out."""
    scene = scene_with().with_changes(
        {**EQUAL, "pair.floating": "pinion", "wheel.apex_runout_um": RUNOUT, "revolution.pitches": 1}
    )
    assert isinstance(scene, DoubleHelicalScene)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)
        revolution = analyse_double_helical_revolution(scene.with_changes({"revolution.positions_per_pitch": 2}))
    left = float(np.abs(revolution.axial_force_left).max() / np.abs(revolution.axial_force).max())
    what = f"motion of a floating pinion, apex of the wheel runs out by {RUNOUT:g} um [um]"
    moved = 1e3 * float(revolution.axial_motion[0, 0])
    return [
        Row(CASE, FORM, what, 0.5 * RUNOUT, moved, FOLLOWED),
        Row(CASE, "balance", "axial force left as it shuttles, over that of a half", 0.0, left, BALANCED),
    ]
