"""One run of CalculiX, and what is read from its files."""

from __future__ import annotations

import os
import re
import resource
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from validation.calculix.deck import surface_name
from validation.calculix.tooth_form import Array

PROGRAM = "ccx"
TIME_LIMIT = 7200.0
"""A run that takes longer has gone astray [s]."""
LARGEST_CORRECTION = 1e-6
"""Change of displacements in the last iteration of a step that counts as converged [mm]; the program itself is at times
content earlier."""
NUMBER = r"(?:[-+]?\d+\.\d+E[-+]\d+|NaN)"


class UnsettledError(RuntimeError):
    """A step ended although its last iteration still moved something."""


@dataclass(frozen=True)
class ContactForce:
    """What one tooth pair carries in one step, per slice or body modelled.

    Attributes
    ----------
    normal_force : float [N]
    pinion_torque : float [N mm]
        About the pinion's axis, positive against the driving torque.
    centre : (3,) array [mm]
        Centre of the contact area; NaN without contact.
    area : float [mm^2]
    """

    normal_force: float
    pinion_torque: float
    centre: Array
    area: float


@dataclass(frozen=True)
class Run:
    """Results of one run.

    Attributes
    ----------
    hub_displacement : (steps,) array [mm]
        Tangential displacement of the pinion's bore.
    forces : list of dict
        By step, of each tooth pair.
    points, pressures : arrays, (n, 3) [mm] and (steps, n) [MPa]
        Nodes of the pinion that carry pressure in any step.
    seconds : float
        Processor time of the program on one core.
    iterations : int
    """

    hub_displacement: Array
    forces: list[dict[int, ContactForce]]
    points: Array
    pressures: Array
    seconds: float
    iterations: int


def program_version() -> str:
    """What the program calls itself."""
    answer = subprocess.run([PROGRAM, "-v"], capture_output=True, text=True, check=False).stdout
    return f"CalculiX {PROGRAM} {answer.split('Version')[-1].strip()}"


def run(text: str, stem: Path, pairs: list[int], steps: int) -> Run:
    """Write the deck, run the program on one core and read what it printed.

    Parameters
    ----------
    text : str
        The deck.
    stem : Path
        Of the files, without suffix.
    pairs : list of int
    steps : int

    Raises
    ------
    UnsettledError
        If a step ended before its iterations came to rest.
    RuntimeError
        If the program fails or does not reach the last step; its files are left for a look.
    """
    log, seconds = execute(text, stem)
    _check_corrections(log, stem)
    hub, forces = _printed(stem.with_suffix(".dat").read_text(), pairs, steps)
    points, pressures = _pressures(stem.with_suffix(".frd"), steps)
    return Run(hub, forces, points, pressures, seconds, len(re.findall(r"^ iteration \d+", log, re.MULTILINE)))


def execute(text: str, stem: Path) -> tuple[str, float]:
    """Write the deck and run the program on one core: what it printed, and its processor time [s].

    Parameters
    ----------
    text : str
        The deck.
    stem : Path
        Of the files, without suffix.

    Raises
    ------
    RuntimeError
        If the program fails; its files are left for a look.
    """
    stem.parent.mkdir(parents=True, exist_ok=True)
    stem.with_suffix(".inp").write_text(text)
    began = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [PROGRAM, stem.name],
        cwd=stem.parent,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        timeout=TIME_LIMIT,
        check=False,
    )
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
    stem.with_suffix(".log").write_text(done.stdout + done.stderr)
    if done.returncode != 0 or "Job finished" not in done.stdout:
        raise RuntimeError(f"{PROGRAM} did not finish: see {stem.with_suffix('.log')}")
    return done.stdout, seconds


def _check_corrections(log: str, stem: Path) -> None:
    """Refuse a step whose last iteration still moved something."""
    for number, step in enumerate(re.split(r"^ *STEP +\d+", log, flags=re.MULTILINE)[1:], 1):
        correction = float(re.findall(r"largest correction to disp= +(\S+)", step)[-1])
        if not correction < LARGEST_CORRECTION:
            raise UnsettledError(f"{stem.name}: step {number} stopped at a correction of {correction} mm")


def _printed(text: str, pairs: list[int], steps: int) -> tuple[Array, list[dict[int, ContactForce]]]:
    """Hub displacement and contact forces of each step from the .dat file."""
    hub = re.findall(rf"for set HUB and time.*\n\n\s+\d+\s+{NUMBER}\s+({NUMBER})", text)
    if len(hub) != steps:
        raise RuntimeError(f"{len(hub)} of {steps} steps were printed")
    by_pair = {pair: _force_blocks(text, surface_name("P", pair)) for pair in pairs}
    forces = [{pair: blocks[step] for pair, blocks in by_pair.items()} for step in range(steps)]
    return np.array(hub, dtype=float), forces


def _force_blocks(text: str, slave: str) -> list[ContactForce]:
    """Statistics of one contact pair, step by step."""
    blocks = re.split(r"statistics for slave set ", text)[1:]
    return [_force(block) for block in blocks if block.startswith(f"{slave},")]


def _force(block: str) -> ContactForce:
    """One block: force, moment about the origin, centre, normal, moment, area, normal and shear force."""
    values = [float(value) for value in re.findall(NUMBER, block.split("\n", 1)[1])[:18]]
    if values[15] == 0.0:
        return ContactForce(0.0, 0.0, np.full(3, np.nan), 0.0)
    return ContactForce(-values[16], -values[5], np.array(values[6:9]), values[15])


def nodal_stresses(path: Path) -> Array:
    """Stresses (steps, n, 6) [MPa] of the nodes 1 to n: xx, yy, zz, xy, yz, zx; from the .frd file.

    Raises
    ------
    RuntimeError
        If they are not there for all nodes.
    """
    steps: list[list[list[float]]] = []
    reading, count = False, 0
    with path.open() as lines:
        for line in lines:
            if line.startswith(" -1") and reading:
                steps[-1].append([int(line[3:13]), *(float(line[at : at + 12]) for at in range(13, 85, 12))])
            elif line.startswith("    2C"):
                count = int(line.split()[1])
            elif line.startswith(" -4"):
                reading = line.startswith(" -4  STRESS")
                if reading:
                    steps.append([])
            elif line.startswith(" -3"):
                reading = False
    if not steps or any([row[0] for row in step] != list(range(1, count + 1)) for step in steps):
        raise RuntimeError(f"{path}: no stress of all nodes")
    return np.array(steps)[:, :, 1:]


def _pressures(path: Path, steps: int) -> tuple[Array, Array]:
    """Places and pressures of the slave nodes that carry load, from the .frd file."""
    places: dict[int, list[float]] = {}
    pressures: list[dict[int, float]] = []
    reading = ""
    with path.open() as lines:
        for line in lines:
            if line.startswith("    2C"):
                reading = "places"
            elif line.startswith(" -4"):
                reading = "pressures" if line.startswith(" -4  CONTACT") else ""
                if reading:
                    pressures.append({})
            elif line.startswith(" -3"):
                reading = ""
            elif reading == "places" and line.startswith(" -1"):
                places[int(line[3:13])] = [float(line[at : at + 12]) for at in (13, 25, 37)]
            elif reading == "pressures" and line.startswith(" -1"):
                pressure = float(line[49:61])
                if pressure > 0.0:
                    pressures[-1][int(line[3:13])] = pressure
    loaded = sorted(set().union(*pressures))
    if len(pressures) != steps or not loaded:
        raise RuntimeError(f"{path}: no contact pressure of {steps} steps")
    table = [[step.get(node, 0.0) for node in loaded] for step in pressures]
    return np.array([places[node] for node in loaded]), np.array(table)
