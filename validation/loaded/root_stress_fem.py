"""Page of the root stress beside finite elements: ``python -m validation.loaded.root_stress_fem`` from the root.

It repeats the comparisons of ``root_stress_cycle``, ``root_stress_space`` and ``root_face_load`` (a minute).
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.plots.style import DOTS_PER_INCH
from validation.calculix.case import pinion_angle
from validation.calculix.ring_run import WAYS
from validation.calculix.tables import RING_FILLETS_FILE, RINGS_FILE, ROOT_MESH_FILE, read_table
from validation.loaded import root_face_load, root_stress_cycle, root_stress_space
from validation.loaded.root_stress_cycle import GEARS, SIGNS, WIDE, RootCycle
from validation.loaded.root_stress_space import SIDES, Fillets
from validation.page import Page, formatted, lines, machine, write_page
from validation.table import Row, render

PAGE = """# Tooth root stress against finite elements

Written by `python -m validation.loaded.root_stress_fem`. Machine: {machine}.

The stress at the roots of the teeth beside runs of CalculiX that share nothing with the package
([how they were made](reference_fem.md)): both gears over the loaded mesh in plane strain, and one gear in space under
line loads along its tooth. Stress is that along the fillet at right angles to the lengthwise lines of the tooth, from a
tangent angle of 15 deg against the middle of the tooth down to the middle of the space.

## Over the loaded mesh

Spur pair 25/37, m 3 mm, 100 N m on 20 mm, unmodified and with 15 um of tip relief on both gears; 24 positions over a
base pitch. The loads of the tooth pairs are those of the package's own contact on a face of {wide:g} mm (free
ends matter little there), the stress under them that of one section of its root stress model in plane strain. Positions
with tip corners in contact are compared, too.

![Largest tension and compression of both gears over the mesh](root_stress_fem_cycle.png)

| variant | gear | | largest, finite elements [MPa] | here | difference, % | at the worst position, % of the largest |
|---|---|---|---|---|---|---|
{cycle}

Asked: 2 %. What the mesh of the finite elements changes, the largest tension and compression of pinion and wheel [MPa]:

| variant, position | elements on the fillet [mm] | pinion | | wheel | |
|---|---|---|---|---|---|
{meshes}

## In space

Pinion 25, 20 mm wide, straight teeth loaded along the highest points of single contact, teeth of 20 deg helix along a
generator of the flank; 100 N/mm all along the face (even), or rising from nothing to 200 N/mm (uneven).

![Stress along the face and along the fillets](root_stress_fem_space.png)

| ring | load | | largest, finite elements [MPa] | coarser mesh | here | difference, % | along the face, % |
|---|---|---|---|---|---|---|---|
{rings}

Asked: 3 %. Along the face: largest difference in any section, of the largest stress. The coarser mesh has elements of
{coarser:g} mm on the fillets instead of {finer:g} mm, and fewer layers.

Whole fillets agree within 3 % of the largest stress in all kept sections inside the face (rows below). In the end faces
themselves the stress of the package is wavy along the fillet, and with helical teeth 6 % of the largest stress too high
deep in the space (75 deg), where it is half of that at the worst place: the maximum of these sections is right, so this
is shown and not judged.

## An uneven load, and what ISO 6336-3 makes of it

Largest tension under an uneven load over that under the same force spread evenly, spur pinion, 20 mm wide, beside
K_Fbeta = K_Hbeta^N_F, N_F = 0.692 (h/b no more than 1/3):

| load | K_Hbeta | K_Fbeta | ratio of the largest tensions |
|---|---|---|---|
{ratios}

K_Fbeta is larger in every line, for three reasons:

- A load on one place of the face bends the tooth beside it, too: the root stress follows the mean load over about a
  tooth height of the face, not the peak. N_F stands for this, but it depends on h/b alone, not on the shape of the
  load: it is right for a peak that is wide against the height of the tooth. Here (h/b 0.34) the load of the crowned
  pair falls from its peak to nothing within one and a half tooth heights.
- An even load does not stress the root evenly: the middle of the face has 1.04 of the stress of plane strain, the ends
  have 0.73 of it, because nothing holds the material lengthwise there. A load that is largest at the end, as that of a
  misaligned pair, meets the sections with the least stress per load: the largest stress under the linear load lies
  {inside:.1f} mm away from the end, where the load is less. ISO multiplies the largest load by the stress of an even
  section, wherever both are.
- K_Hbeta takes the very peak of the line load. At an end of the face that is free, a real contact raises it over a
  length too short to affect the root: the pair at the pitch point has less tension than the linear load although its
  K_Hbeta is larger.

So K_Fbeta is on the safe side here. A root stress by finite elements needs no such factor: the spread of the load and
the notch are part of it.

## Rows

```
{rows}
```
"""

COLOURS = {"pinion": "#0072B2", "wheel": "#D55E00"}
"""Okabe and Ito."""
SECTIONS = {-10.0: "#0072B2", -5.0: "#56B4E9", 0.0: "#009E73", 5.0: "#E69F00", 10.0: "#D55E00"}
NAMES = {"unmodified": "unmodified", "tip_relief": "tip relief 15 µm on both gears"}
Cycles = dict[str, tuple[RootCycle, RootCycle]]
"""Kept and ours by variant."""
Rings = dict[tuple[str, str], tuple[list[dict[str, float | str]], Fillets]]


def cycle_cells(cycles: Cycles) -> Iterable[Iterable[str]]:
    """Lines of the table of the cycles."""
    for variant, (kept, ours) in cycles.items():
        for (gear, sign), values in kept.stress.items():
            factor, found = SIGNS[sign], ours.stress[gear, sign]
            highest, own = factor * (factor * values).max(), factor * (factor * found).max()
            apart = 100.0 * np.abs(found - values).max() / abs(highest)
            sizes = *formatted(".2f", highest, own), f"{100.0 * (own / highest - 1.0):+.2f}", f"{apart:.2f}"
            yield variant.replace("_", " "), gear, sign, *sizes


def mesh_cells() -> Iterable[Iterable[str]]:
    """Lines of the mesh study of the kept runs in plane strain."""
    table = read_table(ROOT_MESH_FILE)
    places = dict.fromkeys((row["variant"], row["position"], row["fillet_mm"]) for row in table)
    for place in places:
        variant, position, fillet = place
        own = [row for row in table if (row["variant"], row["position"], row["fillet_mm"]) == place]
        stress = [f"{float(row[f'{sign}_MPa']):.2f}" for row in own for sign in SIGNS]
        kept = ", kept" if own[0]["way"] == "standard" else ""
        yield f"{str(variant).replace('_', ' ')}, {position:g}", f"{fillet:g}{kept}", *stress


def ring_cells(rings: Rings) -> Iterable[Iterable[str]]:
    """Lines of the table of the rings."""
    coarser = root_stress_space.read_rings(RINGS_FILE, "standard")
    for (ring, load), (kept, ours) in rings.items():
        heights = np.array([float(row["height_mm"]) for row in kept])
        for side, (name, sign) in SIDES.items():
            values = np.array([float(row[f"{name}_MPa"]) for row in kept])
            before = sign * max(sign * float(row[f"{name}_MPa"]) for row in coarser[ring, load])
            highest, own = sign * (sign * values).max(), sign * (sign * ours.largest(side)).max()
            apart = 100.0 * np.abs(ours.at(side, heights) - values).max() / abs(highest)
            sizes = formatted(".2f", highest, before, own)
            yield ring, load, name, *sizes, f"{100.0 * (own / highest - 1.0):+.2f}", f"{apart:.2f}"


def cycle_picture(cycles: Cycles) -> Figure:
    """Tension and compression of both gears over the mesh, a column for each variant."""
    figure = Figure(figsize=(10.0, 6.5), layout="constrained")
    axes = figure.subplots(2, len(cycles), sharex=True, sharey="row", squeeze=False)
    pitch = 2.0 * abs(pinion_angle(0))
    for column, (variant, (kept, ours)) in zip(axes.T, cycles.items(), strict=True):
        column[0].set_title(NAMES[variant])
        for gear in GEARS:
            for row, sign in zip(column, SIGNS, strict=True):
                colour = COLOURS[gear]
                row.plot(ours.pinion_angle / pitch, ours.stress[gear, sign], color=colour, linewidth=1.2, label=gear)
                row.plot(kept.pinion_angle / pitch, kept.stress[gear, sign], "o", color=colour, markersize=4)
                row.grid(alpha=0.3)
        column[-1].set_xlabel("pinion angle / pitch")
    for row, sign in zip(axes[:, 0], SIGNS, strict=True):
        row.set_ylabel(f"largest {sign} [MPa]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2, title="lines: here; dots: finite elements")
    return figure


def space_picture(rings: Rings) -> Figure:
    """Largest stress along the face, and fillets of some sections under the uneven load; a column for each ring."""
    curves = read_table(RING_FILLETS_FILE)
    names = list(dict.fromkeys(ring for ring, _ in rings))
    figure = Figure(figsize=(10.0, 10.0), layout="constrained")
    axes = figure.subplots(3, len(names), sharey="row", squeeze=False)
    for (ring, load), (kept, ours) in rings.items():
        top = axes[0, names.index(ring)]
        heights = [float(row["height_mm"]) for row in kept]
        for side, (name, _) in SIDES.items():
            style = {"color": COLOURS["pinion" if side == "loaded" else "wheel"]}
            dash = "-" if load == "even" else "--"
            top.plot(ours.height, ours.largest(side), dash, linewidth=1.2, label=f"{name}, {load}", **style)
            top.plot(heights, [float(row[f"{name}_MPa"]) for row in kept], "o", markersize=3.5, **style)
        top.set(title=f"{ring} pinion", xlabel="along the face [mm]")
    for ring, column in zip(names, axes.T, strict=True):
        ours = rings[ring, "uneven"][1]
        for axis, side in zip(column[1:], SIDES, strict=True):
            for height, colour in SECTIONS.items():
                own = [c for c in curves if (c["ring"], c["load"], c["height_mm"]) == (ring, "uneven", height)]
                angles = np.linspace(15.0, 80.0, 131)
                line = ours.along(side, height, angles)
                axis.plot(angles, line, color=colour, linewidth=1.2, label=f"z {height:g} mm")
                axis.plot(
                    [c["angle_deg"] for c in own], [c[f"{side}_MPa"] for c in own], "o", color=colour, markersize=2.5
                )
            axis.set_xlabel("tangent angle [deg]")
    for axis, label in zip(
        axes[:, 0], ("largest stress [MPa]", "loaded side, uneven load [MPa]", "back, uneven load [MPa]"), strict=True
    ):
        axis.set_ylabel(label)
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    axes[0, 0].legend(fontsize=8)
    axes[1, 0].legend(fontsize=8)
    figure.suptitle("lines: here; dots: finite elements", fontsize=10)
    return figure


def page() -> Page:
    """The page and its pictures, if there is anything to compare."""
    if not (root_stress_cycle.read_roots() and root_stress_space.read_rings()):
        raise SystemExit("no runs are kept: make reference-fem")
    model = root_stress_cycle.model(WIDE)
    cycles = {
        variant: (kept, root_stress_cycle.root_cycle(model, variant, kept.pinion_angle))
        for variant, kept in root_stress_cycle.read_roots().items()
    }
    rings = {
        (ring, load): (kept, root_stress_space.fillets_under(ring, load))
        for (ring, load), kept in root_stress_space.read_rings().items()
    }
    crowned, misaligned = root_face_load.of_the_crowned_pair(), root_face_load.of_a_misaligned_pair()
    assert crowned is not None
    loads = {
        "line load of the crowned pair of finite elements, highest points of single contact": crowned,
        "0 to twice the mean, highest points of single contact": misaligned,
    } | {
        f"pair {name}, pitch point, its own contact": root_face_load.of_the_pair(changes)
        for name, changes in root_face_load.PAIRS.items()
    }
    rows: list[Row] = [*root_stress_cycle.rows(), *root_stress_space.rows(), *root_face_load.rows()]
    text = PAGE.format(
        machine=machine(numpy=True),
        wide=WIDE,
        cycle=lines(cycle_cells(cycles)),
        meshes=lines(mesh_cells()),
        rings=lines(ring_cells(rings)),
        coarser=WAYS["standard"].fillet,
        finer=WAYS["finer"].fillet,
        ratios=lines(
            [name, *formatted(".3f", one.contact_factor, one.iso_factor, one.ratio)] for name, one in loads.items()
        ),
        inside=float(np.abs(misaligned.along).max() - abs(misaligned.along[misaligned.tension.argmax()])),
        rows=render(rows),
    )
    pictures = {"root_stress_fem_cycle": cycle_picture(cycles), "root_stress_fem_space": space_picture(rings)}
    return Page("root_stress_fem", text, pictures, DOTS_PER_INCH)


if __name__ == "__main__":
    write_page(__doc__, page)
