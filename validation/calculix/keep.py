"""From records of runs to the kept tables."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from validation.calculix.campaign import Record
from validation.calculix.crowned_run import run_crowned
from validation.calculix.mesh_study import run_study
from validation.calculix.model import Meshing
from validation.calculix.root_campaign import run_root_study, run_roots
from validation.calculix.tables import (
    CONTACTS_FILE,
    CROWNED_FILE,
    FLAT_FILE,
    MESH_FILE,
    POSITIONS_FILE,
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
    "neighbours, from a tangent angle of 15 deg to the middle of the tooth on; that angle, the tooth pair of the tooth",
    "and its side, loaded or back. seconds: processor time. variant tip_relief: 15 um on both gears, parabolic over the",
    "roll length from d 76.200 and 112.450 mm.",
)


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
