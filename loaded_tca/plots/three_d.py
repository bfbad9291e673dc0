"""The teeth in contact in space, with the path of contact and the pressure on the pinion's flank."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.pairs import mating_teeth
from loaded_tca.plots.flanks import highest_of_maps
from loaded_tca.plots.style import ACCENT, COLOURS, load, place, set_title
from loaded_tca.results.mesh_cycle import MeshCycle
from loaded_tca.results.teeth import TeethInSpace, teeth_in_space
from loaded_tca.tooth import PATCHES, Resolution, TriangleMesh

if TYPE_CHECKING:
    import pyvista

PINION, WHEEL = "#8fa3b3", "#c9b68a"
SEE_THROUGH = 0.3
"""Opacity of the wheel's tooth, which stands before the pinion's flank."""
SEAMS = "0.35"
LIFT, AMBIENT = 3e-3, 0.4
"""How far pressure and path are lifted off the facets of the flank, over the length of the tooth, so that these do not
hide them; light from everywhere."""
FILLED = 0.85
"""Part of the frame that the box of the teeth fills: its ticks and labels take the rest."""
MOST_TICKS, LABEL_PAD = 5, 7.0
"""Ticks of an axis, and the distance [points] of its name, at which neither covers the other."""
DRAWN = Resolution(flank=25, fillet=9, land=3, lengthwise=25)
EXTRA = "pyvista is not installed; install it with: pip install 'loaded_tca[three-d]'"


def plot_teeth(result: MeshCycle, position: int | None = None, torque: int | None = None) -> Figure:
    """Both teeth in contact in the fixed frame, seen through the tooth of the wheel towards the flank of the pinion.

    On that flank lie the contact points of all positions and the pressure of one.

    Parameters
    ----------
    result : MeshCycle
    position : int, optional
        Index along the path; default: that of the peak pressure, ``result.peak_contact``.
    torque : int, optional
        Index of the torque; default: the largest one.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError, GeometryError
        If there is no such torque or position, nothing is in contact there, or there are no complete teeth, see
        :func:`loaded_tca.pairs.gear_pair`.
    """
    return draw_teeth(result, _shown(result, position, torque))


def draw_teeth(result: MeshCycle, shown: TeethInSpace) -> Figure:
    """Draw teeth that were placed before, as :func:`plot_teeth` does.

    Parameters
    ----------
    result : MeshCycle
    shown : TeethInSpace
        See :func:`loaded_tca.results.teeth.teeth_in_space`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = Figure(figsize=(9.0, 7.5), layout="constrained")
    axes: Any = figure.add_subplot(projection="3d", proj_type="ortho", computed_zorder=False)
    points = np.concatenate([shown.pinion.vertices, shown.wheel.vertices])
    low, high = points.min(axis=0), points.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=FILLED * _zoom(high - low, shown.eye))
    for axis, name in zip((axes.xaxis, axes.yaxis, axes.zaxis), "xyz", strict=True):
        axis.set_major_locator(MaxNLocator(MOST_TICKS))
        axis.set_rotate_label(False)  # matplotlib would turn them along the axes, that of z upside down
        axis.set_label_text(f"{name} [mm]", rotation=90.0 if name == "z" else 0.0)
        axis.labelpad = LABEL_PAD
    x, y, z = shown.eye
    axes.view_init(elev=math.degrees(math.asin(z)), azim=math.degrees(math.atan2(y, x)))
    side = shown.pair.pinion.flank.side
    axes.add_collection3d(_solid(shown.pinion, PINION, 1.0, shown.eye))
    axes.add_collection3d(_lines(shown.pinion, side))
    if shown.highest_pressure > 0.0:
        highest = highest_of_maps(result, shown.position, shown.column)
        norm, extend = Normalize(0.0, highest), "max" if shown.highest_pressure > highest else "neither"
        faces = colormaps[COLOURS](norm(shown.pressure.cell_data["pressure_MPa"]))
        corners = shown.pressure.corners
        axes.add_collection3d(Poly3DCollection(corners, facecolors=faces, edgecolors=faces, linewidths=0.2))
        bar = ScalarMappable(norm, COLOURS)
        figure.colorbar(bar, ax=axes, label="contact pressure [MPa]", shrink=0.7, pad=0.08, extend=extend)
    axes.plot(*shown.path.T, ".", color=ACCENT, markersize=3.0)
    axes.add_collection3d(_solid(shown.wheel, WHEEL, SEE_THROUGH, shown.eye))
    axes.add_collection3d(_lines(shown.wheel, side))
    names = result.scene.gear_names
    handles = [
        Patch(facecolor=PINION, label=f"{names[0]}'s tooth"),
        Patch(facecolor=WHEEL, alpha=SEE_THROUGH, label=f"{names[1]}'s tooth, see-through"),
        Line2D([], [], color=ACCENT, marker=".", linestyle="", label="unloaded contact points of all positions"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize="small")
    what = "teeth in contact" if shown.highest_pressure > 0.0 else "teeth, no load, no pressure"
    where = place(result, shown.position, shown.pair.pinion.flank.frame, shown.column)
    set_title(figure, result, f"{what}, {load(result, shown.torque)}", *where)
    return figure


def _shown(result: MeshCycle, position: int | None, torque: int | None) -> TeethInSpace:
    """Teeth of the resolution of a picture, in place."""
    return teeth_in_space(result, mating_teeth(result.gear_pair, DRAWN), position, torque)


def _zoom(size: Array, eye: Array) -> float:
    """How much a box (3,) may grow, seen from a direction, beyond what its diagonal leaves, and still be seen whole."""
    across = np.cross([0.0, 0.0, 1.0], eye)
    across /= np.linalg.norm(across)
    seen = np.abs([across, np.cross(eye, across)]) @ size
    return float(np.linalg.norm(size) / seen.max())


def _solid(mesh: TriangleMesh, colour: str, opacity: float, towards: Array) -> Poly3DCollection:
    """A tooth, lit from the eye."""
    normals = mesh.normals
    light = np.abs(normals @ towards) / np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)
    shades = (0.45 + 0.55 * light)[:, None] * np.array(to_rgb(colour))
    faces = np.column_stack([shades, np.full(len(shades), opacity)])
    edges = faces if opacity == 1.0 else "none"
    return Poly3DCollection(mesh.corners, facecolors=faces, edgecolors=edges, linewidths=0.2)


def _lines(mesh: TriangleMesh, side: int) -> Line3DCollection:
    """Where flank, fillet and lands of the side in contact meet and end: the other one lies behind."""
    patch = mesh.cell_data["patch"]
    front = side * (patch - PATCHES.index("tip land")) >= 0
    seen = TriangleMesh(mesh.vertices, mesh.triangles[front], cell_data={"patch": patch[front]})
    return Line3DCollection(seen.seams("patch"), colors=SEAMS, linewidths=0.6)


def show_teeth(
    result: MeshCycle, position: int | None = None, torque: int | None = None, *, off_screen: bool = False
) -> pyvista.Plotter:
    """Both teeth in contact in a window to turn and to look around in; needs the extra ``three-d`` (pyvista).

    Parameters
    ----------
    result : MeshCycle
    position, torque : int, optional
        As for :func:`plot_teeth`.
    off_screen : bool
        True: no window is opened; the plotter that is returned takes screenshots.

    Raises
    ------
    InputError
        If pyvista is not installed, or the result has no such torque or position.
    GeometryError
        If nothing is in contact at that position.
    """
    try:
        import pyvista
    except ImportError:
        raise InputError(EXTRA) from None
    shown = _shown(result, position, torque)
    plotter = pyvista.Plotter(off_screen=off_screen)
    lift = LIFT * float(np.ptp(shown.pinion.vertices, axis=0).max()) * shown.normal
    plotter.add_mesh(_poly_data(pyvista, shown.pinion), color=PINION, ambient=AMBIENT)
    plotter.add_mesh(_poly_data(pyvista, shown.wheel), color=WHEEL, ambient=AMBIENT, opacity=SEE_THROUGH)
    if shown.highest_pressure > 0.0:
        limits = 0.0, highest_of_maps(result, shown.position, shown.column)
        bar = {"title": "contact pressure [MPa]", "fmt": "%.0f"}
        surface = _poly_data(pyvista, shown.pressure.moved(lift, np.eye(3)))
        colours = {"scalars": "pressure_MPa", "cmap": COLOURS, "clim": limits, "scalar_bar_args": bar}
        plotter.add_mesh(surface, lighting=False, **colours)
    plotter.add_points(shown.path + lift, color=ACCENT, point_size=6.0, render_points_as_spheres=True)
    plotter.show_bounds(xtitle="x [mm]", ytitle="y [mm]", ztitle="z [mm]", location="outer")
    plotter.view_vector(shown.eye, viewup=(0.0, 0.0, 1.0))
    plotter.show(auto_close=False)
    return plotter


def _poly_data(library: Any, mesh: TriangleMesh) -> Any:
    """A surface as pyvista knows it, with its data."""
    surface = library.PolyData(mesh.vertices, np.insert(mesh.triangles, 0, 3, axis=1).ravel())
    for name, values in mesh.cell_data.items():
        surface.cell_data[name] = values
    return surface
