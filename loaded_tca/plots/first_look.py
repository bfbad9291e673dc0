"""The picture to look at first: teeth in mesh or blanks, modifications, and where unloaded flanks touch.

Before any analysis; panels that would be empty are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from loaded_tca.arrays import GEARS, Array
from loaded_tca.gears import FaceMilledGear
from loaded_tca.plain import plain
from loaded_tca.plots.flanks import ToPicture, draw_flank
from loaded_tca.plots.mesh import FILLS, LINES, draw_teeth_in_mesh, extent_of_teeth, numbers_of_teeth
from loaded_tca.plots.style import ACCENT, write_title
from loaded_tca.scene.cylindrical import CylindricalScene
from loaded_tca.scene.double_helical import HALVES, DoubleHelicalScene
from loaded_tca.unloaded.path import contact_span, trace_contact

if TYPE_CHECKING:
    from loaded_tca.flanks.base import Flank
    from loaded_tca.gears import BevelGear
    from loaded_tca.pairs.gear import Gear
    from loaded_tca.pairs.gear_pair import GearPair
    from loaded_tca.scene import Scene

WIDTH = 11.0
"""Of the figure [inch]."""
HEIGHTS = {"blanks": 3.4, "modifications": 3.0, "flanks": 3.4}
"""Of rows of panels [inch]."""
POINTS = 201
"""Along a profile, and along a face."""
POSITIONS = 41
"""Of unloaded contact points, from the first to the last one on the flanks."""
LEAST_um = 1e-6
"""Below it a modification is rounding."""
DASHES = "-", "--"
"""Of pinion and wheel."""


def plot_first_look(scene: Scene) -> Figure:
    """What a scene describes, in one picture before any analysis.

    Of cylindrical pairs the teeth in mesh at the pitch point, as :func:`plot_teeth_in_mesh` draws them; of bevel pairs
    both blanks in the axial section. Then the material removed from both flanks along the profile and along the face,
    where there is any, and both flanks with the path of their contact without load, mounting errors included.

    Parameters
    ----------
    scene : Scene
        Of a double helical pair flanks and modifications are those of half a.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError, GeometryError
        If the gears of the scene cannot exist or do not mesh.
    """
    halves = isinstance(scene, DoubleHelicalScene)
    one = scene.half_scenes(scene.mounting.axial_offset_mm)[0] if isinstance(scene, DoubleHelicalScene) else scene
    pair = one.pair().sharp
    rows: list[tuple[float, list[Callable[[Axes], None]]]] = []
    numbers: list[str] = []
    if isinstance(scene, CylindricalScene):
        width, height = extent_of_teeth(scene)
        rows.append((0.9 * WIDTH * height / width, [lambda axes: _draw_teeth(axes, scene)]))
        numbers += numbers_of_teeth(scene)
    else:
        mesh = scene.mesh()
        numbers += _numbers_of_blanks(scene)
        rows.append((HEIGHTS["blanks"], [_blank_of(gear, k) for k, gear in enumerate((mesh.pinion, mesh.wheel))]))
    if panels := [*_modifications(one, pair)]:
        rows.append((HEIGHTS["modifications"], panels))
    rows.append((HEIGHTS["flanks"], _flanks(one, pair)))
    figure = Figure(figsize=(WIDTH, sum(height for height, _ in rows) + 0.6), layout="constrained")
    grid = figure.add_gridspec(len(rows), 2, height_ratios=[height for height, _ in rows])
    for k, (_, panels) in enumerate(rows):
        for n, draw in enumerate(panels):
            draw(figure.add_subplot(grid[k, :] if len(panels) == 1 else grid[k, n]))
    legends = figure.axes[:: len(figure.axes) - 1] if isinstance(scene, CylindricalScene) else figure.axes[-1:]
    handles = [handle for axes in legends for handle in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize="x-small")  # within no place is free
    what = f"geometry before any contact, flanks of half {HALVES[0]}" if halves else "geometry before any contact"
    write_title(figure, scene.title, what, *numbers)
    return figure


def _numbers_of_blanks(scene: Scene) -> list[str]:
    """What belongs to both blanks, in words with units."""
    turns = "counter-clockwise" if scene.sense == "positive" else "clockwise"
    gears = zip(GEARS, scene.tip_clearances, strict=False)  # not of all pairs
    clearances = (f"tip clearance at the root of the {name} {plain(c)}\N{NO-BREAK SPACE}mm" for name, c in gears)
    return [f"{scene.driving} drives, pinion turns {turns}", *clearances]


def _draw_teeth(axes: Axes, scene: CylindricalScene) -> None:
    draw_teeth_in_mesh(axes, scene)
    axes.set_title("teeth in mesh at the pitch point, transverse section", fontsize="small")


def _blank_of(gear: BevelGear | FaceMilledGear, member: int) -> Callable[[Axes], None]:
    """Draws the tooth of a gear between its cones in the axial section."""

    def draw(axes: Axes) -> None:
        face, pitch, root = _cones(gear)
        tooth = np.concatenate([root, face[::-1]])
        about: dict[str, Any] = {"facecolor": FILLS[member], "edgecolor": LINES[member], "linewidth": 1.2}
        axes.fill(*tooth.T, **about, label="tooth from root to face cone")
        axes.plot(*np.vstack([[0.0, 0.0], pitch]).T, "-.", color=LINES[member], linewidth=1.0, label="pitch cone")
        axes.axhline(0.0, color="black", linestyle=(0, (12, 3, 2, 3)), linewidth=0.8, label="axis")
        axes.plot(0.0, 0.0, "+", color="black", label="apex of the pitch cone")
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_title(f"blank of the {GEARS[member]}, axial section", fontsize="small")
        axes.set_xlabel("along the axis, from the apex of the pitch cone [mm]")
        axes.set_ylabel("from the axis [mm]")
        axes.legend(fontsize="x-small", loc="best")

    return draw


def _cones(gear: BevelGear | FaceMilledGear) -> tuple[Array, Array, Array]:
    """Points (2, 2) at toe and heel on face, pitch and root cone of a gear: along its axis, and from it [mm]."""
    if isinstance(gear, FaceMilledGear):
        blank = gear.blank
        ends, delta = np.array(blank.cone_distances), blank.pitch_angle
        heights = [np.array([height(one) for one in ends]) for height in (blank.tip_height, blank.root_height)]
        face, root = (
            (ends * np.cos(delta) - one * np.sin(delta), ends * np.sin(delta) + one * np.cos(delta)) for one in heights
        )
    else:
        ends, delta = np.array([gear.inner_cone_distance, gear.outer_cone_distance]), gear.pitch_angle
        angles = [[at(one) for one in ends.tolist()] for at in (gear.tip_angle_at, gear.root_cone_angle_at)]
        face, root = ((ends * np.cos(one), ends * np.sin(one)) for one in angles)
    pitch = ends * np.cos(delta), ends * np.sin(delta)
    return np.transpose(face), np.transpose(pitch), np.transpose(root)


def _modifications(scene: Scene, pair: GearPair) -> list[Callable[[Axes], None]]:
    """Panels of the material removed along profile and along face of both flanks, those where there is any."""
    gears = pair.pinion, pair.wheel
    rolls = all(gear.flank.roll_unit is not None for gear in gears) and not scene.rack_radius
    lines = {
        "along the profile, middle of the face": [_along_profile(gear, rolls) for gear in gears],
        "along the face, middle of the profile": [_along_face(gear) for gear in gears],
    }
    return [
        _panel_of(title, curves, scene.gear_names)
        for title, curves in lines.items()
        if any(np.abs(removed).max() > LEAST_um for _, _, removed in curves)
    ]


def _panel_of(title: str, curves: list[tuple[str, Array, Array]], names: tuple[str, str]) -> Callable[[Axes], None]:
    """Draws the material removed from both flanks over a coordinate."""

    def draw(axes: Axes) -> None:
        for member, (label, place, removed) in enumerate(curves):
            about: dict[str, Any] = {"color": LINES[member], "label": names[member]}
            axes.plot(place, removed, DASHES[member], **about)
            axes.set_xlabel(label)
        axes.legend(fontsize="x-small")
        axes.set_ylabel("removed material [µm]")
        axes.grid(alpha=0.3)
        axes.set_title(f"modifications {title}", fontsize="small")

    return draw


def _along_profile(gear: Gear, rolls: bool) -> tuple[str, Array, Array]:
    """Label, coordinate and removed material [um] along the profile in the middle of the face, from root to tip."""
    rho, z = (part[:, 1] for part in gear.flank.grid(POINTS, 3))
    removed = _removed(gear, rho, z)
    if rolls and gear.flank.roll_unit is not None:
        own = gear.flank.profile_coordinate(rho, z).value
        return "roll angle [deg]", np.degrees(own / gear.flank.roll_unit), removed
    return "height above the root end of the flank [mm]", np.hypot(rho - rho[0], z - z[0]), removed


def _along_face(gear: Gear) -> tuple[str, Array, Array]:
    """Label, coordinate and removed material [um] along the face in the middle of the profile."""
    rho, z = (part[1] for part in gear.flank.grid(3, POINTS))
    along = gear.flank.lengthwise_coordinate(rho, z).value
    return "from the middle of the face [mm]", along, _removed(gear, rho, z)


def _removed(gear: Gear, rho: Array, z: Array) -> Array:
    """Material [um] that a flank has less than the one without modifications, along its normal."""
    nominal: Flank = gear.nominal_flank
    turn = gear.flank.theta(rho, z).value - nominal.theta(rho, z).value
    return np.broadcast_to(-1e3 * nominal.side * turn / nominal.gradient_norm(rho, z).value, rho.shape)


def _flanks(scene: Scene, pair: GearPair) -> list[Callable[[Axes], None]]:
    """Panels of both flanks with the path of contact without load, from the first to the last point of a tooth."""
    ends = [end.pinion_angle for end in contact_span(pair) if end is not None]
    angles = np.linspace(ends[0], ends[1], POSITIONS) if len(ends) == 2 else None
    path = trace_contact(pair, angles, warn=False)
    points = path.point[path.in_contact]

    def panel(member: int) -> Callable[[Axes], None]:
        def draw(axes: Axes) -> None:
            gear = GEARS[member]
            flank = getattr(pair, gear).flank
            active = scene.active_starts()[member], scene.active_ends()[member]
            draw_flank(axes, scene.flank_names[member], flank, active)
            place = ToPicture(pair, gear)(points)
            axes.plot(*place.T, ".-", color=ACCENT, markersize=4.0, label="contact points without load")

        return draw

    return [panel(0), panel(1)]
