"""Draw why the loss factor of the standard is low for helical gears: tribology_loss_factor.png.

Run from the root of the repository: ``python docs/how_it_works/tribology.py``.
"""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.reference import iso6336_22

HELICES = np.linspace(0.0, 20.0, 41)
EVEN, STANDARD = "#0072b2", "#d55e00"


def mesh(helix: float, width: float = 200.0) -> CylindricalMesh:
    """Return a pair with the transverse contact ratio of spur gears of 24 and 95 teeth."""
    angles = math.radians(helix), -math.radians(helix)
    gears = [CylindricalGear(z, 6.0, width, helix_angle=angle) for z, angle in zip((24, 95), angles, strict=True)]
    return CylindricalMesh(*gears)


def even_loss(one: CylindricalMesh) -> float:
    """Return the loss factor of an even line load on the plane of action."""
    path, pitch, width = one.path_of_contact, one.pinion.base_pitch, one.common_face_width
    slope, part = math.tan(abs(one.pinion.base_helix_angle)), (np.arange(300) + 0.5) / 300
    means = []
    for step in part:
        places = path.C + (np.arange(-9, 10)[:, None] + step) * pitch + (part - 0.5) * width * slope
        on = (places >= path.A) & (places <= path.E)
        means.append(np.abs(places - path.C)[on].mean())
    sliding = float(np.mean(means)) * (1.0 + 1.0 / one.gear_ratio)
    return sliding / (one.pinion.base_radius * math.cos(one.pinion.base_helix_angle))


def standard_loss(one: CylindricalMesh) -> float:
    """Return the loss factor of ISO/TR 15144-1."""
    path, pitch = one.path_of_contact, one.pinion.base_pitch
    parts = (path.E - path.C) / pitch, (path.C - path.A) / pitch
    return iso6336_22.load_loss_factor(*parts, one.pinion.teeth, one.wheel.teeth, one.pinion.base_helix_angle)


def draw() -> Figure:
    """Draw both loss factors over the overlap ratio, and the weight of each place of the path in them."""
    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    over, along = figure.subplots(1, 2)
    pairs = [mesh(helix) for helix in HELICES]
    overlap = [one.overlap_ratio for one in pairs]
    over.plot(overlap, [even_loss(one) for one in pairs], color=EVEN, label="even line load, exact")
    over.plot(overlap, [standard_loss(one) for one in pairs], "--", color=STANDARD, label="ISO/TR 15144-1")
    over.set(xlabel="overlap ratio $\\varepsilon_\\beta$", ylabel="load loss factor $H_v$")
    over.set_ylim(0.0, 0.16)
    spur = pairs[0]
    path, pitch = spur.path_of_contact, spur.pinion.base_pitch
    places = np.linspace(path.A, path.E, 800)
    single = (places > path.E - pitch) & (places < path.A + pitch)
    share = np.where(single, 1.0, 0.5)
    along.plot(places, share, color=STANDARD, linestyle="--", label="spur: half the force where two pairs touch")
    even = np.full(places.size, pitch / (path.E - path.A))
    along.plot(places, even, color=EVEN, label="overlap above 1: the same everywhere")
    for letter in "ABCDE":
        along.axvline(getattr(path, letter), color="0.5", linestyle=":", linewidth=1.0)
        along.annotate(letter, (getattr(path, letter), 1.12), ha="center", color="0.4")
    along.set(xlabel="place on the path of contact, from T1 [mm]", ylabel="part of the force", ylim=(0.0, 1.2))
    for axes in (over, along):
        axes.grid(alpha=0.3)
        axes.legend(loc="lower center", fontsize="small")
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_name("tribology_loss_factor.png"), dpi=80)
