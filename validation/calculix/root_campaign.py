"""Runs with fine fillets, for the stress at the roots: the cycles of one torque, and what the mesh changes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path

from validation.calculix.campaign import Record, run_position
from validation.calculix.model import Meshing
from validation.calculix.tables import POSITIONS_FILE, read_table

TORQUE = 100.0
"""Pinion torque [N m]."""
MESHING = Meshing(fillet=0.12)
CASES = (("unmodified", 12), ("tip_relief", 0))
"""Variant and position: the pitch point with one pair, and an end of the pitch with two."""
WAYS = {"twice_as_coarse": Meshing(fillet=0.24), "standard": MESHING, "finer": Meshing(fillet=0.08)}


def run_roots(work: Path) -> Iterator[Record]:
    """Every kept position of both variants; the wheel is placed as the runs without fine fillets left it."""
    for row in read_table(POSITIONS_FILE):
        if row["torque_Nm"] == TORQUE:
            yield _run(row, work, MESHING, "_roots")


def run_root_study(work: Path) -> Iterator[Record]:
    """The cases of the study in all ways."""
    kept = {(row["variant"], row["torque_Nm"], row["position"]): row for row in read_table(POSITIONS_FILE)}
    for (variant, index), (way, meshing) in product(CASES, WAYS.items()):
        label = "_roots" if way == "standard" else f"_roots_{way}"
        record = _run(kept[variant, TORQUE, index], work, meshing, label)
        yield {"way": way, "fillet": meshing.fillet, **record}


def _run(kept: dict[str, float | str], work: Path, meshing: Meshing, label: str) -> Record:
    setback = -1e-3 * float(kept["transmission_error_um"])
    place = str(kept["variant"]), TORQUE, int(kept["position"])
    record = run_position(*place, setback, work, meshing, label=label, roots=True)
    print(_line(record), flush=True)
    return record


def _line(record: Record) -> str:
    """What is printed as a run ends."""
    found = [
        f"{root['gear']} {root[sign]['stress']:.3f} at {root[sign]['angle']:.2f} of {root[sign]['tooth']:+d}"
        for root in record["roots"]
        for sign in ("tension", "compression")
    ]
    place = f"{record['variant']} {record['torque']:g} N m, position {record['index']:2d}"
    return f"{place}: {', '.join(found)}, {record['transmission_error']:.4f} um, {record['seconds']:.1f} s"
