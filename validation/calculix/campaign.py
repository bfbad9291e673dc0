"""The set of runs: every variant, torque and position, each kept in a file so that a set broken off goes on."""

from __future__ import annotations

import json
from dataclasses import asdict
from itertools import product
from pathlib import Path
from typing import Any

from validation.calculix.case import POSITIONS, TORQUES, VARIANTS, line_load, position
from validation.calculix.deck import LOAD_STEPS, PlaneDeck
from validation.calculix.evaluate import evaluate, truncated
from validation.calculix.mesh_position import Position
from validation.calculix.model import Meshing, plane_deck, unloaded_setback
from validation.calculix.roots import root_stress
from validation.calculix.run import Run, UnsettledError, nodal_stresses, run
from validation.calculix.steel import PENALTY

FIRST_STIFFNESS = 14.0
"""Guess of the secant stiffness that places the wheel of the first run [N/(mm um)]."""
SETBACK_ERROR = 0.2
"""The wheel is placed anew if the expected setback was wrong by more than this part ..."""
SETBACK_ERROR_LENGTH = 1.5e-3
"""... and more than this [mm]: phi1 then differs from the wanted one by less than 5e-5 rad."""
ATTEMPTS = 4

Record = dict[str, Any]


def run_position(
    variant: str,
    torque: float,
    index: int,
    setback: float,
    work: Path,
    meshing: Meshing = Meshing(),
    penalty: float = PENALTY,
    label: str = "",
    roots: bool = False,
) -> Record:
    """Results of one position, run until the wheel was placed as far behind as the load makes it.

    Parameters
    ----------
    variant : str
    torque : float [N m]
    index : int
        Of the position.
    setback : float [mm]
        Expected setback of the wheel under load.
    work : Path
        Directory for the files.
    meshing : Meshing
    penalty : float [MPa/mm]
    label : str
        Tells runs of the same position apart.
    roots : bool
        Whether the stress at the roots of the teeth is wanted.
    """
    stem = work / f"{variant}_{torque:g}_{index:02d}{label}"
    kept = stem.with_suffix(".json")
    if kept.exists():
        return json.loads(kept.read_text())
    seconds = 0.0
    for _ in range(ATTEMPTS):
        place = position(variant, index, setback)
        deck, done = _run_settled(place, torque, meshing, penalty, stem, roots)
        result, seconds = evaluate(place, deck, done), seconds + done.seconds
        expected, setback = setback, -1e-3 * result.transmission_error
        if abs(setback - expected) < max(SETBACK_ERROR * setback, SETBACK_ERROR_LENGTH):
            break
    else:
        raise RuntimeError(f"{stem.name}: the setback {setback} mm does not settle")
    record = {
        "variant": variant,
        "torque": torque,
        "index": index,
        **asdict(result),
        "truncated": truncated(place, deck, done),
        "nodes": deck.nodes,
        "iterations": done.iterations,
        "seconds": done.seconds,
        "seconds_with_attempts": seconds,
    }
    if roots:
        record["roots"] = [asdict(root) for root in root_stress(place, deck, nodal_stresses(stem.with_suffix(".frd")))]
    kept.write_text(json.dumps(record))
    for suffix in (".frd", ".12d"):
        stem.with_suffix(suffix).unlink(missing_ok=True)
    return record


def _run_settled(
    place: Position, torque: float, meshing: Meshing, penalty: float, stem: Path, stress: bool
) -> tuple[PlaneDeck, Run]:
    """One run; with more steps before the last ones where a step does not come to rest.

    Stress needs no second step, which gives the stiffness.
    """
    problems, last = [], LOAD_STEPS[-1:] if stress else LOAD_STEPS
    for steps in (last, (0.9, *last), (0.7, 0.85, *last)):
        deck = plane_deck(place, line_load(torque), meshing, penalty, steps, stress)
        try:
            return deck, run(deck.text(), stem, list(deck.flanks), len(steps))
        except UnsettledError as problem:
            print(problem, flush=True)
            problems.append(str(problem))
    raise UnsettledError("; ".join(problems))


def run_all(work: Path, every: int = 1) -> list[Record]:
    """Every run of the set, a line printed for each: first every second position, then those between.

    Parameters
    ----------
    work : Path
        Directory for the files; what is there already is not run again.
    every : int
        2: every second position alone.
    """
    records: dict[tuple[str, float, int], Record] = {}
    for indices in (range(0, POSITIONS, 2), range(1, POSITIONS, 2))[: 2 if every == 1 else 1]:
        for variant, torque in product(VARIANTS, TORQUES):
            for index in indices:
                before = records.get((variant, torque, index - 1)) or records.get((variant, torque, index - 2))
                setback = -1e-3 * before["transmission_error"] if before else first_setback(variant, torque, index)
                record = run_position(variant, torque, index, setback, work)
                records[variant, torque, index] = record
                print(_line(record), flush=True)
    return [records[key] for key in sorted(records, key=lambda key: (list(VARIANTS).index(key[0]), *key[1:]))]


def first_setback(variant: str, torque: float, index: int) -> float:
    """Setback of the first contact and a guess of what the load adds [mm]."""
    return unloaded_setback(position(variant, index, 0.0)) + 1e-3 * line_load(torque) / FIRST_STIFFNESS


def _line(record: Record) -> str:
    """What is printed as a run ends."""
    shares = ", ".join(f"{pair['pair']:+d}: {pair['load_share']:.4f}" for pair in record["pairs"])
    return (
        f"{record['variant']} {record['torque']:g} N m, position {record['index']:2d}:"
        f" {record['transmission_error']:8.4f} um, {record['mesh_stiffness']:.3f} N/(mm um), {shares},"
        f" {record['iterations']} iterations, {record['seconds']:.1f} s"
    )
