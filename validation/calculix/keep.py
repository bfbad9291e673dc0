"""From records of runs to the kept tables."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from itertools import product
from pathlib import Path

from validation.calculix.campaign import Record
from validation.calculix.case import FACE_WIDTH
from validation.calculix.crowned_run import run_crowned
from validation.calculix.mesh_study import run_study
from validation.calculix.model import Meshing
from validation.calculix.ring_run import ANGLES, HELICES, LOADS, ROLLS, WAYS, run_ring
from validation.calculix.root_campaign import run_root_study, run_roots
from validation.calculix.steel import POISSON_RATIO, YOUNGS_MODULUS
from validation.calculix.tables import (
    CONTACTS_FILE,
    CROWNED_FILE,
    FLAT_FILE,
    MESH_FILE,
    POSITIONS_FILE,
    RING_FILLETS_FILE,
    RINGS_FILE,
    ROOT_MESH_FILE,
    ROOTS_FILE,
    provenance,
    write_table,
)

SIGNS = (
    "phi1 = 0: tooth pair 0 touches at the pitch point; pair +1 comes into mesh after it. transmission_error_um is",
    "r_b2 (phi2 - z1/z2 phi1) against the unmodified pair, negative where the wheel stays behind; position i stands at",
    "phi1 = (2 i/24 - 1) pi/25, pinion_angle_rad is where the load left it.",
)
PLANE = (
    "Plane strain, CPE8R, whole rings; {per_half_width:g} elements (nodes twice as dense) to the Hertz half width of a",
    "contact. seconds: processor time. variant tip_relief: 15 um on both gears, parabolic over the roll length from",
    "d 76.200 and 112.450 mm.",
)
ROOTS = (
    "Plane strain, CPE8R, whole rings; elements on the fillets no larger than 0.12 mm. Stress along the fillet at its",
    "nodes, a spline between them: the largest of both gears over both fillets of all teeth in contact and of their",
    "neighbours, from a tangent angle of 15 deg against the middle of the tooth on; that angle, the tooth pair of the",
    "tooth, and its side, loaded or back. seconds: processor time. variant tip_relief: 15 um on both gears, parabolic",
    "over the roll length from d 76.200 and 112.450 mm.",
)
RINGS = (
    "Pinion of 25 teeth, m_n 3 mm, alpha_n 20 deg, no profile shift, face 20 mm, root cut by a rack with h_fP 1.25 m",
    "and a tip rounding of 0.38 m; bore 0.55 x root diameter, held; whole ring; C3D20R;",
    f"E {YOUNGS_MODULUS:g} MPa, nu {POISSON_RATIO:g}. ring spur: straight teeth, loaded along d 75.956 mm; helical:",
    "20 deg, the section turns in the sense of the polar angle along +z, the loaded flank is at the larger angle,",
    f"loaded along its generator of roll length {ROLLS['helical']:g} mm at mid-face. load even: normal force of",
    "100 N per mm of face; uneven: from 0 at z -10 mm to 200 at z +10 mm. Stress at right angles to the lengthwise",
    "lines of the fillet, at its nodes; angle: of its tangent in the section against the middle of the tooth, from",
    "15 deg on. loaded: the side of the loaded flank; back: the other one.",
)
RING_LEVELS = ("Largest tension of the loaded side and compression of the back at every height; seconds: both loads.",)
RING_CURVES = ("Stress along the fillets at the ends, the quarters and the middle of the face, finer mesh.",)


def keep_cycles(program: str, records: list[Record]) -> None:
    """Tables of positions and of the contacts of their tooth pairs.

    Parameters
    ----------
    program : str
        Name and version of what computed them.
    records : list of Record
    """
    plane = [line.format(per_half_width=Meshing().per_half_width) for line in PLANE]
    head = provenance(
        program, [*plane, *SIGNS, "mesh_stiffness: change of line load over deflection, 96 to 100 % torque."]
    )
    write_table(POSITIONS_FILE, head, map(_position_row, records))
    notes = (
        "load_share: of the pinion's torque. peak_pressure_MPa: largest node; fitted: of the half ellipse through p^2.",
        "radii: of the largest pressure. corner: whose tip corner the contact reaches; pressures there are the mesh's.",
    )
    write_table(CONTACTS_FILE, provenance(program, [*plane, *SIGNS, *notes]), _contact_rows(records))


def keep_roots(program: str, work: Path) -> None:
    """Tables of the root stress of the cycles and of its mesh study, run if need be."""
    head = provenance(program, [*ROOTS, *SIGNS])
    rows = [{**_key(record), **row} for record in run_roots(work) for row in _root_rows(record)]
    write_table(ROOTS_FILE, head, rows)
    rows = [
        {**_key(record), "way": record["way"], "fillet_mm": record["fillet"], **row}
        for record in run_root_study(work)
        for row in _root_rows(record)
    ]
    write_table(ROOT_MESH_FILE, head, rows)


def keep_rings(program: str, work: Path) -> None:
    """Tables of the rings in space: every section along the face, and whole fillets of some of them; run if need be."""
    records = [run_ring(work, name, way) for way, name in product(WAYS, HELICES)]
    write_table(RINGS_FILE, provenance(program, RING_LEVELS, RINGS), _ring_rows(records))
    finer = [record for record in records if record["way"] == "finer"]
    write_table(RING_FILLETS_FILE, provenance(program, RING_CURVES, RINGS), _ring_fillet_rows(finer))


def keep_study(program: str, work: Path) -> None:
    """Table of the mesh study, run if need be."""
    write_table(MESH_FILE, provenance(program, ["Plane strain; what mesh and penalty change."]), run_study(work))


def keep_in_space(program: str, work: Path) -> None:
    """Tables of the crowned pair and of the flat one, run if need be."""
    notes = (
        "In space: C3D20R, half the face (z >= 0), whole rings; 100 N m, phi1 = 0; crowned pair: pinion with parabolic",
        "lead crowning of 10 um at the ends of the face; flat pair: none. transmission_error [um] at the hubs, height",
        "[mm] of the layers' middles, line_load [N/mm] their means, covered_width [mm] the area under pressure over",
        "the height of the layer, peak_line_load [N/mm] at mid-face, total [N] of the whole face, mid_pressure [MPa]",
        "and mid_half_width [mm] of the half ellipse through the pressures at mid-face, seconds of processor time.",
    )
    for name, file in (("crowned", CROWNED_FILE), ("flat", FLAT_FILE)):
        content = {"provenance": provenance(program, notes), **asdict(run_crowned(work, name))}
        file.write_text(json.dumps(content, indent=1) + "\n")


def _position_row(record: Record) -> dict[str, object]:
    """Row of one position."""
    return {
        **_key(record),
        "pinion_angle_rad": record["pinion_angle"],
        "transmission_error_um": record["transmission_error"],
        "mesh_stiffness_N_per_mm_um": record["mesh_stiffness"],
        "tooth_pairs": len(record["pairs"]),
        "at_corner": int(any(pair["corner"] != "no" for pair in record["pairs"])),
        "nodes": record["nodes"],
        "iterations": record["iterations"],
        "seconds": record["seconds"],
    }


def _root_rows(record: Record) -> Iterator[dict[str, object]]:
    """Rows of both gears of one position."""
    for root in record["roots"]:
        row = {"pinion_angle_rad": record["pinion_angle"], "gear": root["gear"]}
        for sign in ("tension", "compression"):
            row[f"{sign}_MPa"] = root[sign]["stress"]
            row[f"{sign}_angle_deg"] = root[sign]["angle"]
            row[f"{sign}_pair"] = root[sign]["tooth"]
            row[f"{sign}_side"] = root[sign]["side"]
        row["transmission_error_um"] = record["transmission_error"]
        yield {**row, "nodes": record["nodes"], "seconds": record["seconds"]}


def _ring_rows(records: list[Record]) -> Iterator[dict[str, object]]:
    """Rows of every section of the face."""
    for record, load in product(records, LOADS):
        sides = record[load]
        for n, height in enumerate(record["height"]):
            yield {
                "ring": record["name"],
                "load": load,
                "way": record["way"],
                "height_mm": height,
                "tension_MPa": sides["loaded"]["extreme"][n],
                "tension_angle_deg": sides["loaded"]["angle"][n],
                "compression_MPa": sides["back"]["extreme"][n],
                "compression_angle_deg": sides["back"]["angle"][n],
                "nodes": record["nodes"],
                "seconds": record["seconds"],
            }


def _ring_fillet_rows(records: list[Record]) -> Iterator[dict[str, object]]:
    """Rows of the fillets at the ends, the quarters and the middle of the face."""
    for record, load, part in product(records, LOADS, (-0.5, -0.25, 0.0, 0.25, 0.5)):
        height = part * FACE_WIDTH
        level = min(range(len(record["height"])), key=lambda n: abs(record["height"][n] - height))
        for n in range(0, len(ANGLES), 5):
            stress = {f"{side}_MPa": record[load][side]["stress"][n][level] for side in ("loaded", "back")}
            yield {"ring": record["name"], "load": load, "height_mm": height, "angle_deg": float(ANGLES[n]), **stress}


def _contact_rows(records: list[Record]) -> Iterator[dict[str, object]]:
    """Rows of all loaded tooth pairs."""
    for record in records:
        for pair in record["pairs"]:
            yield {
                **_key(record),
                "pair": pair["pair"],
                "load_share": pair["load_share"],
                "line_load_N_per_mm": pair["line_load"],
                "peak_pressure_MPa": pair["peak_pressure"],
                "fitted_pressure_MPa": pair["fitted_pressure"],
                "half_width_mm": pair["half_width"],
                "pinion_radius_mm": pair["pinion_radius"],
                "wheel_radius_mm": pair["wheel_radius"],
                "corner": pair["corner"],
            }


def _key(record: Record) -> dict[str, object]:
    """What tells the positions apart."""
    return {"variant": record["variant"], "torque_Nm": record["torque"], "position": record["index"]}
