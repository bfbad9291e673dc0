"""Draw the pictures of the pages on the method: one for each page, all of them computed.

Run from the root of the repository: ``python -m docs.how_it_works.pictures``.
"""

import warnings
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca import AccuracyWarning, analyse, read_scene, sample_separation, solve_contact, trace_contact
from loaded_tca.compliance import tooth_compliance
from loaded_tca.reference import hertz
from loaded_tca.scene import Scene
from loaded_tca.unloaded import EaseOff

FOLDER = Path(__file__).parent
SCENES = FOLDER.parents[1] / "examples" / "scenes"
STEEL = 113187.0  # E* of two steel bodies, MPa
BLUE, ORANGE, GREEN = "#0072b2", "#d55e00", "#009e73"


def minimum_problem() -> Figure:
    """Gap before and under load, and pressure, across the middle of a crowned roller with a groove on a plate."""
    x = (np.arange(256) + 0.5) / 256 * 1.2 - 0.6
    y = (np.arange(48) - 23.5) * 0.15
    groove = 0.0006 * np.exp(-(((x - 0.12) / 0.03) ** 2))
    gap = (x**2 / 40.0 + groove)[:, None] + y**2 / 800.0
    solution = solve_contact(gap, (x[1] - x[0], y[1] - y[0]), STEEL, load=1200.0)
    middle = y.size // 2
    figure = Figure(figsize=(7.5, 5.0), layout="constrained")
    gaps, pressures = figure.subplots(2, 1, sharex=True)
    gaps.plot(x, 1e3 * gap[:, middle], "--", color="0.5", label="before load, h")
    gaps.plot(x, 1e3 * solution.gap[:, middle], color=BLUE, label=r"under load, $h + Kp - \lambda$")
    gaps.set(ylabel="gap [µm]", ylim=(-0.3, 6.0))
    gaps.legend(loc="upper center")
    pressures.fill_between(x, solution.pressure[:, middle], color=ORANGE, alpha=0.3)
    pressures.plot(x, solution.pressure[:, middle], color=ORANGE)
    pressures.set(xlabel="across the contact [mm]", ylabel="pressure p [MPa]", ylim=(0.0, None))
    figure.suptitle("No gap where there is pressure: a crowned roller with a groove on a plate", fontsize="medium")
    return figure


def ease_off_field() -> Figure:
    """The rotary ease-off over a pinion flank at one pinion angle, and the contact at its top."""
    scene = read_scene(SCENES / "helical.toml").with_changes(
        {"pinion.modifications.profile_crowning_um": 4.0, "mounting.misalignment_um": 4.0}
    )
    pair = scene.pair()
    radius, axial = pair.pinion.flank.grid(160, 160)
    value, inside = EaseOff(pair).heights(np.zeros(radius.shape), radius, axial)
    drop = np.where((inside >= 0.0).all(axis=-1), 1e3 * (value - np.nanmax(value)), np.nan)
    contact = trace_contact(pair, [0.0])[0]
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    axes = figure.subplots()
    drawn = axes.contourf(axial, 2.0 * radius, drop, levels=np.linspace(-60.0, 0.0, 13), extend="min")
    axes.plot(contact.pinion_axial, 2.0 * contact.pinion_radius, "o", color=ORANGE, label="contact: the maximum")
    axes.set(xlabel="axial position on the pinion [mm]", ylabel="pinion diameter [mm]")
    axes.legend(loc="lower right")
    figure.colorbar(drawn, label="ease-off below its maximum [µm]")
    figure.suptitle("Helical pair 34/57, crowned, 4 µm out of line, pinion angle 0", fontsize="medium")
    return figure


def half_space_and_bending() -> Figure:
    """Line load along the face of a misaligned spur pair on half-spaces, and with teeth that bend."""
    return _line_loads(
        {
            "half-spaces alone": {"analysis.compliance": "contact"},
            "half-spaces and bending": {"analysis.compliance": "contact+tooth"},
        },
        {
            "mounting.misalignment_um": 3.0,
            "pinion.modifications.lead_crowning_um": 3.0,
            "analysis.cells": (32, 64),
        },
        "3 µm lead crowning, 3 µm out of line: bending spreads the load",
    )


def edges() -> Figure:
    """Line load along the face of an unmodified spur pair: half-spaces, and free face ends."""
    return _line_loads(
        {
            "half-spaces": {"analysis.free_edges": False},
            "free edges": {"analysis.free_edges": True},
        },
        {"analysis.cells": (32, 128)},
        "no modifications: the face ends are softer than half-spaces",
    )


def errors() -> Figure:
    """Error of the peak pressure of a Hertz contact over the cells, and what the solver estimates."""
    point = hertz.point_contact(500.0, (0.2, 0.02), STEEL)
    counts = np.array([16, 24, 32, 48, 64, 96, 128, 192])
    found, told = [], []
    for count in counts:
        x, y = ((np.arange(count) + 0.5) / count - 0.5) * 2.6 * np.array([[point.semi_minor], [point.semi_major]])
        gap = 0.1 * x[:, None] ** 2 + 0.01 * y**2
        solution = solve_contact(gap, (x[1] - x[0], y[1] - y[0]), STEEL, load=500.0)
        found.append(abs(solution.peak_pressure / point.max_pressure - 1.0))
        told.append(solution.error_estimate.peak_pressure)
    figure = Figure(figsize=(7.5, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.loglog(counts / 1.3, found, "o-", color=BLUE, label="error against Hertz")
    axes.loglog(counts / 1.3, told, "s--", color=ORANGE, label="estimate from two grids")
    axes.set(xlabel="cells across the contact", ylabel="relative error of the peak pressure")
    axes.set_xticks((12, 25, 50, 100, 150))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("")
    axes.legend()
    axes.grid(which="both", alpha=0.3)
    figure.suptitle(f"Hertz ellipse of axes 1 : {point.ratio:.1f}", fontsize="medium")
    return figure


def load_sharing() -> Figure:
    """Shares of the tooth pairs of a helical pair over one pitch, and its mesh stiffness, under two torques."""
    scene = read_scene(SCENES / "mesh_cycle_helical.toml").with_changes({"analysis.torques_Nm": [40.0, 260.0]})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the contacts end at the face ends
        result = analyse(scene)
    angle = np.degrees(result.pinion_angle)
    figure = Figure(figsize=(7.5, 5.0), layout="constrained")
    shares, stiffness = figure.subplots(2, 1, sharex=True)
    for torque, style in enumerate(("--", "-")):
        newton_metres = f"{result.torque[torque] / 1e3:g} N m"
        for pair, share, colour in zip(result.pair, result.load_share[torque].T, (GREEN, BLUE, ORANGE), strict=True):
            shares.plot(angle, 100.0 * share, style, color=colour, label=f"pair {pair}, {newton_metres}")
        stiffness.plot(angle, result.mesh_stiffness[torque], style, color="k", label=newton_metres)
    shares.set(ylabel="share of the torque [%]", ylim=(-2.0, 102.0))
    stiffness.set(xlabel="pinion angle [deg]", ylabel="mesh stiffness [N/(mm µm)]", ylim=(0.0, None))
    for axes in (shares, stiffness):
        axes.legend(fontsize="small", ncols=2)
    figure.suptitle("Helical pair 34/57: tooth pairs that share the torque, over one pitch", fontsize="medium")
    return figure


def bending() -> Figure:
    """Bending of a spur pair along its face under 1 N on one slice: of the same tooth pair, and of the next one."""
    pair = read_scene(SCENES / "mesh_cycle_finite_elements.toml").pair()
    contacts = trace_contact(pair, [-0.5 * pair.pitch, 0.5 * pair.pitch])  # of pairs +1 and 0, in their own angles
    following, own = (sample_separation(pair, contact, cells=(8, 80), box=(0.2, 10.0)) for contact in contacts)
    compliance = tooth_compliance(pair)
    figure = Figure(figsize=(7.5, 4.0), layout="constrained")
    axes = figure.subplots()
    for place, colour in ((0.0, BLUE), (8.0, ORANGE)):
        loaded = int(np.abs(own.y - place).argmin())
        for matrix, grid, style, name in (
            (compliance.within(0, own), own, "-", "same tooth pair"),
            (compliance.between((1, following), (0, own)), following, "--", "next tooth pair"),
        ):
            axes.plot(grid.y, 1e6 * matrix[:, loaded], style, color=colour, label=f"force at {place:g} mm, {name}")
    axes.set(xlabel="along the face [mm]", ylabel="displacement [nm/N]", ylim=(0.0, None))
    axes.legend(fontsize="small")
    figure.suptitle("Spur pair 25/37, 20 mm wide: what bending adds to half-spaces", fontsize="medium")
    return figure


def _line_loads(variants: dict[str, dict[str, object]], common: dict[str, object], subtitle: str) -> Figure:
    """Line load along the face of the spur pair 25/37 at the pitch point, a curve for each variant."""
    scene = read_scene(SCENES / "mesh_cycle_finite_elements.toml").with_changes({"analysis.positions": 3, **common})
    figure = Figure(figsize=(7.5, 4.0), layout="constrained")
    axes = figure.subplots()
    for (name, changes), colour in zip(variants.items(), (BLUE, ORANGE), strict=True):
        axes.plot(*_line_load(scene.with_changes(changes)), color=colour, label=name)
    axes.set(xlabel="along the face, from the unloaded contact point [mm]", ylabel="line load [N/mm]", ylim=(0.0, None))
    axes.legend()
    figure.suptitle(f"Spur pair 25/37, {scene.load.pinion_torque_Nm:g} N m, pitch point; {subtitle}", fontsize="medium")
    return figure


def _line_load(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Places along the face [mm], line loads [N/mm], at the position in the middle: the pitch point."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AccuracyWarning)  # the contact ends at the face ends
        result = analyse(scene)
    middle = len(result.path) // 2
    pressure_map = result.maps[0][middle][int(np.nanargmax(result.normal_force[0, middle]))]
    load = pressure_map.pressure.sum(axis=0) * pressure_map.spacing[0]
    loaded = load > 0.0
    return pressure_map.y[loaded], load[loaded]


def main() -> None:
    """Draw all."""
    for draw in (minimum_problem, ease_off_field, half_space_and_bending, edges, errors, load_sharing, bending):
        draw().savefig(FOLDER / f"{draw.__name__}.png", dpi=100)


if __name__ == "__main__":
    main()
