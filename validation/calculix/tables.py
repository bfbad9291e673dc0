"""The kept numbers: comma-separated tables under a head of comment lines that say where they come from."""

from __future__ import annotations

import csv
import platform
from collections.abc import Iterable, Mapping
from datetime import date
from pathlib import Path

from validation.calculix.steel import PENALTY, POISSON_RATIO, YOUNGS_MODULUS

DATA = Path(__file__).parent / "data"
POSITIONS_FILE = DATA / "calculix_spur_25_37_positions.csv"
CONTACTS_FILE = DATA / "calculix_spur_25_37_contacts.csv"
MESH_FILE = DATA / "calculix_spur_25_37_mesh_study.csv"
ROOTS_FILE = DATA / "calculix_spur_25_37_roots.csv"
ROOT_MESH_FILE = DATA / "calculix_spur_25_37_roots_mesh_study.csv"
RINGS_FILE = DATA / "calculix_rings.csv"
RING_FILLETS_FILE = DATA / "calculix_ring_fillets.csv"
CROWNED_FILE = DATA / "calculix_crowned_pair.json"
FLAT_FILE = DATA / "calculix_flat_pair.json"

COMMON = (
    "Spur pair 25/37, m 3 mm, alpha 20 deg, no profile shift, face width 20 mm, centre distance 93.000 mm; tip",
    "diameters 81 and 117 mm, sharp tip corners; root cut by a rack with h_fP 1.25 m, tip rounding 0.38 m; bore",
    f"0.55 x root diameter, rigid; E {YOUNGS_MODULUS:g} MPa, nu {POISSON_RATIO:g}; no friction; geometrically linear;",
    f"torque on the pinion's bore, wheel's bore held. Penalty contact, face to face, {PENALTY:g} MPa/mm.",
)


def provenance(program: str, notes: Iterable[str], common: Iterable[str] = COMMON) -> list[str]:
    """Comment lines above a table.

    Parameters
    ----------
    program : str
        Name and version.
    notes : iterable of str
        What this table holds.
    common : iterable of str
        What was computed; by default the pair.
    """
    machine = f"{platform.system()} {platform.machine()}, Python {platform.python_version()}"
    made = f"Computed by {program} on {date.today().isoformat()} ({machine}); repeated by: make reference-fem"
    return [made, *common, *notes]


def write_table(path: Path, head: Iterable[str], rows: Iterable[Mapping[str, object]]) -> None:
    """Write a table; numbers with seven digits.

    Parameters
    ----------
    path : Path
    head : iterable of str
        Comment lines.
    rows : iterable of mappings
        All with the keys of the first one, which name the columns with their units.
    """
    rows = list(rows)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        file.writelines(f"# {line}\n" for line in head)
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: _cell(value) for key, value in row.items()} for row in rows)


def read_table(path: Path) -> list[dict[str, float | str]]:
    """Rows of a kept table; what reads as a number is one.

    Parameters
    ----------
    path : Path

    Examples
    --------
    >>> rows = read_table(POSITIONS_FILE)
    >>> rows[0]["variant"]
    'unmodified'
    """
    with path.open(newline="") as file:
        reader = csv.DictReader(line for line in file if not line.startswith("#"))
        return [{key: _value(cell) for key, cell in row.items()} for row in reader]


def _cell(value: object) -> object:
    return f"{value:.7g}" if isinstance(value, float) else value


def _value(cell: str) -> float | str:
    try:
        return float(cell)
    except ValueError:
        return cell
