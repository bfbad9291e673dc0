"""Spur pinion 25 of 25/37 in plane strain under unit loads: the whole ring, solved here on the meshes of these runs.

Eight-node quadrilaterals with 2 x 2 points of integration, as CPE8R of CalculiX, in NumPy and SciPy alone: nothing of
the package is in it. The stress at a node is the mean of its elements' values, extrapolated from those points.

Run from the root of the repository: ``python -m validation.calculix.plane_ring``; writes data/plane_ring.csv.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from validation.calculix.fillet import fillets
from validation.calculix.grading import graded
from validation.calculix.section import Fineness, Section, gear_section
from validation.calculix.steel import POISSON_RATIO, YOUNGS_MODULUS
from validation.calculix.tables import DATA, provenance, read_table, write_table
from validation.calculix.tooth_form import Array, ToothForm

FILE = DATA / "plane_ring.csv"
LINE_LOAD = 100.0
"""Normal force per length of face [N/mm]."""
FILLETS = (0.08, 0.04, 0.02)
"""Sizes of the elements on the fillets [mm], the last one kept as the reference."""
TEETH = (-1, 0, 1)
"""Teeth whose fillets are fine; the load is on the flank of tooth 0 at the larger angle."""
CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)], dtype=float)
GAUSS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float) / math.sqrt(3.0)


def pinion() -> ToothForm:
    """The pinion: m 3 mm, bore 0.55 of the root diameter."""
    return ToothForm(25)


def loaded_radii() -> dict[str, float]:
    """Radii of the pinion where it is loaded [mm]: tip, ends of single contact, pitch point."""
    gear, wheel = ToothForm(25), ToothForm(37)
    tip, other = (math.sqrt(form.tip_radius**2 - form.base_radius**2) for form in (gear, wheel))
    base_pitch = gear.base_radius * gear.pitch
    whole = (gear.base_radius + wheel.base_radius) * math.tan(gear.transverse_angle)  # no profile shifts
    rolls = {
        "tip": tip,
        "HPSTC": whole - other + base_pitch,
        "pitch point": gear.base_radius * math.tan(gear.transverse_angle),
        "LPSTC": tip - base_pitch,
    }
    return {name: math.hypot(gear.base_radius, roll) for name, roll in rolls.items()}


def section(fillet: float) -> Section:
    """Mesh with elements of a size [mm] on the fillets of the three teeth."""
    form = pinion()
    fine = {tooth: Fineness(form.pitch_radius, 2.5, 0.0, 0.0, 0.0, 2.5) for tooth in range(form.teeth)}
    for tooth in TEETH:
        size = 3.0 * fillet
        fine[tooth % form.teeth] = Fineness(form.pitch_radius, size, 0.0, 0.0, 0.0, size, fillet)
    first = fillet / (form.root_radius - form.bore_radius)
    return gear_section(form, fine, graded(1.0, 0.0, 0.0, first, 0.45, 0.1), 0.0, 0.0, 1)


def shapes(u: float, v: float) -> tuple[Array, Array]:
    """Shape functions (8,) of the quadrilateral and their slopes (8, 2)."""
    a, b = CORNERS.T
    value = 0.25 * (1.0 + a * u) * (1.0 + b * v) * (a * u + b * v - 1.0)
    along_u = 0.25 * a * (1.0 + b * v) * (2.0 * a * u + b * v)
    along_v = 0.25 * b * (1.0 + a * u) * (2.0 * b * v + a * u)
    value[[4, 6]] = 0.5 * (1.0 - u * u) * (1.0 + b[[4, 6]] * v)
    along_u[[4, 6]], along_v[[4, 6]] = -u * (1.0 + b[[4, 6]] * v), 0.5 * b[[4, 6]] * (1.0 - u * u)
    value[[5, 7]] = 0.5 * (1.0 - v * v) * (1.0 + a[[5, 7]] * u)
    along_u[[5, 7]], along_v[[5, 7]] = 0.5 * a[[5, 7]] * (1.0 - v * v), -v * (1.0 + a[[5, 7]] * u)
    return value, np.stack([along_u, along_v], axis=-1)


def elasticity() -> Array:
    """Matrix of plane strain (3, 3) [MPa]: xx, yy, xy (engineering shear)."""
    nu = POISSON_RATIO
    factor = YOUNGS_MODULUS / ((1.0 + nu) * (1.0 - 2.0 * nu))
    return factor * np.array([[1.0 - nu, nu, 0.0], [nu, 1.0 - nu, 0.0], [0.0, 0.0, 0.5 - nu]])


class PlaneRing:
    """Factorised stiffness of a section whose bore is held, and the stress of its nodes."""

    def __init__(self, mesh: Section) -> None:
        self.mesh = mesh
        nodes = mesh.nodes[mesh.elements]  # (m, 8, 2)
        matrix, count = elasticity(), len(mesh.elements)
        stiffness, self.strains = np.zeros((count, 16, 16)), []
        for u, v in GAUSS:
            jacobian = np.einsum("ka,mkb->mab", shapes(u, v)[1], nodes)
            slopes = np.einsum("mab,kb->mka", np.linalg.inv(jacobian), shapes(u, v)[1])
            strain = np.zeros((count, 3, 16))
            strain[:, 0, 0::2] = strain[:, 2, 1::2] = slopes[..., 0]
            strain[:, 1, 1::2] = strain[:, 2, 0::2] = slopes[..., 1]
            stiffness += np.linalg.det(jacobian)[:, None, None] * (strain.transpose(0, 2, 1) @ matrix @ strain)
            self.strains.append(strain)
        self.freedoms = (2 * mesh.elements[:, :, None] + np.arange(2)).reshape(count, 16)
        rows, columns = np.repeat(self.freedoms, 16, axis=1), np.tile(self.freedoms, (1, 16))
        size = 2 * len(mesh.nodes)
        whole = coo_matrix((stiffness.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsc()
        held = (2 * mesh.bore[:, None] + np.arange(2)).ravel()
        self.free = np.setdiff1d(np.arange(size), held)
        self.factor = splu(whole[self.free][:, self.free], permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0)

    def load(self, radius: float) -> Array:
        """Nodal forces (2 n,) of the line load on the loaded flank of tooth 0 at a radius [mm]."""
        sides = self.mesh.elements[self.mesh.flanks[0]][:, [0, 1, 4]]
        ends = np.hypot(*np.moveaxis(self.mesh.nodes[sides[:, :2]], -1, 0))
        chosen = np.flatnonzero((ends.min(axis=1) <= radius + 1e-9) & (radius - 1e-9 <= ends.max(axis=1)))[0]
        points, fine = self.mesh.nodes[sides[chosen]], np.linspace(-1.0, 1.0, 2001)
        share = np.stack([0.5 * fine * (fine - 1.0), 0.5 * fine * (fine + 1.0), 1.0 - fine**2])
        place = int(np.abs(np.hypot(*(share.T @ points).T) - radius).argmin())
        x, y = share[:, place] @ points
        along = np.array([fine[place] - 0.5, fine[place] + 0.5, -2.0 * fine[place]]) @ points
        normal = np.array([along[1], -along[0]]) / np.hypot(*along)
        inwards = math.copysign(1.0, normal[0] * y - normal[1] * x) * normal
        force = np.zeros((len(self.mesh.nodes), 2))
        force[sides[chosen]] += LINE_LOAD * share[:, place, None] * inwards
        return force.ravel()

    def stress(self, force: Array) -> Array:
        """Stress of the nodes (n, 3) [MPa]: xx, yy, xy."""
        displacement = np.zeros(len(force))
        displacement[self.free] = self.factor.solve(force[self.free])
        own = displacement[self.freedoms]
        at_points = np.stack([(strain @ own[..., None])[..., 0] @ elasticity() for strain in self.strains], axis=1)
        a, b = math.sqrt(3.0) * CORNERS.T
        extrapolated = np.stack([0.25 * (1.0 + s * a) * (1.0 + t * b) for s, t in np.sign(GAUSS)], axis=-1)
        total, count = np.zeros((len(self.mesh.nodes), 3)), np.zeros(len(self.mesh.nodes))
        np.add.at(total, self.mesh.elements, extrapolated @ at_points)
        np.add.at(count, self.mesh.elements, 1.0)
        return np.asarray(total / count[:, None])


@cache
def ring(fillet: float) -> PlaneRing:
    """Ring with elements of a size [mm] on the fillets."""
    return PlaneRing(section(fillet))


def measured(fillet: float) -> Iterator[dict[str, float | str]]:
    """Largest tension and compression of both fillets of the three teeth under every load."""
    model, form = ring(fillet), pinion()
    for name, radius in loaded_radii().items():
        nodal = model.stress(model.load(radius))
        for tooth in TEETH:
            sides = fillets(form, model.mesh.nodes, tooth * form.pitch, 0.0)
            for side, one in zip(("loaded", "back"), sides, strict=True):
                angle, along = one.told(one.across(nodal[one.nodes]))
                yield {
                    "fillet_mm": fillet,
                    "load": name,
                    "radius_mm": radius,
                    "tooth": tooth,
                    "side": side,
                    "tension_MPa": float(along.max()),
                    "tension_angle_deg": math.degrees(angle[along.argmax()]),
                    "compression_MPa": float(along.min()),
                    "compression_angle_deg": math.degrees(angle[along.argmin()]),
                }


def read(path: Path = FILE) -> dict[tuple[str, int, str], dict[str, float | str]]:
    """Kept numbers of the finest mesh by load, tooth and side."""
    return {
        (str(row["load"]), int(row["tooth"]), str(row["side"])): row
        for row in read_table(path)
        if row["fillet_mm"] == FILLETS[-1]
    }


def keep(path: Path = FILE) -> None:
    """Solve on all meshes, write the table."""
    notes = (
        "Spur pinion of 25 teeth, m 3 mm, alpha 20 deg, no profile shift, root cut by a rack with h_fP 1.25 m and a",
        f"tip rounding of 0.38 m; bore 0.55 x root diameter, held; E {YOUNGS_MODULUS:g} MPa, nu {POISSON_RATIO:g}; "
        "plane strain;",
        f"{LINE_LOAD:g} N per mm of face on the flank of tooth 0 at the larger angle. Largest tension and compression",
        "along the fillets from a tangent angle of 15 deg to the middle of the space; tooth 1 is at the larger angle.",
    )
    head = provenance("validation.calculix.plane_ring", (), notes)
    head[0] = head[0].replace("make reference-fem", "python -m validation.calculix.plane_ring")
    write_table(path, head, [row for fillet in FILLETS for row in measured(fillet)])


def main() -> None:
    """Solve, and keep the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=FILE)
    keep(parser.parse_args().out)


if __name__ == "__main__":
    main()
