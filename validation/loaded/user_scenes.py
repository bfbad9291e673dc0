"""Twenty scenes as users write them, by the defaults of ``[analysis]`` alone: the time told before, and the time taken.

Every scene is one of ``examples/scenes`` or of this folder, its ``[analysis]`` left out, with the keys that stand
here. Each is analysed in a process of its own on one thread, with the models of teeth and roots neither kept nor found
kept; the processor time is that of ``loaded_tca.analyse`` alone, and so is the time told, on this machine.

Eight jobs of all commands stand before them: files of ``examples`` as they are, each in such a process.

Run from the root of the repository: ``python -m validation.loaded.user_scenes``; it writes
``docs/studies/how_long.md``. With ``--constants`` it writes nothing, but prints what the constants of
``loaded_tca.effort`` are on this machine, over its speed: for an idle one.
"""

from __future__ import annotations

import cProfile
import io
import json
import math
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import loaded_tca.effort as effort
from loaded_tca import analyse, analyse_revolution, load_result, parse_scene, read_scene
from loaded_tca.cli import main
from loaded_tca.compliance import root_stress_model, tooth_compliance
from loaded_tca.compliance.influence import forget
from loaded_tca.compliance.teeth import layers_across
from loaded_tca.effort import expected_effort
from loaded_tca.machine_speed import measured_speed
from loaded_tca.plots import plot_all
from loaded_tca.stages import analyse_stage, read_stage
from validation.page import ROOT, SCENES, Page, machine, table, write_page

HERE = Path(__file__).parent
GOAL, GOAL_WITH_ROOTS = 12.0, 20.0
"""Processor time [s] that no scene should take, without and with root stress and no models kept."""


@dataclass(frozen=True)
class UserScene:
    """A scene of a file without its ``[analysis]``, with other values of some keys.

    Attributes
    ----------
    what : str
    file : str
        Without its ending.
    changes : mapping
    """

    what: str
    file: str
    changes: Mapping[str, object] = field(default_factory=dict)

    @property
    def path(self) -> Path:
        """Where the file is."""
        own = HERE / f"{self.file}.toml"
        return own if own.exists() else SCENES / f"{self.file}.toml"


PINION, WHEEL = "pinion.modifications.", "wheel.modifications."
LINEAR = {f"{gear}tip_relief_form": "linear" for gear in (PINION, WHEEL)}
SPUR_RELIEFS = {
    **{f"{gear}tip_relief_um": 15.0 for gear in (PINION, WHEEL)},
    f"{PINION}tip_relief_start_mm": 105.0,
    f"{WHEEL}tip_relief_start_mm": 173.5,
}
HELICAL_RELIEFS = {**SPUR_RELIEFS, f"{PINION}tip_relief_start_mm": 108.5, f"{WHEEL}tip_relief_start_mm": 179.5}
TORQUE, WIDTHS = "load.pinion_torque_Nm", ("pinion.face_width_mm", "wheel.face_width_mm")
ROOTS: dict[str, object] = {"analysis.root_stress": True}

USER_SCENES = (
    UserScene("electric drive: short reliefs, misaligned", "ev_stage"),
    UserScene("the same under a tenth of the torque", "ev_stage", {TORQUE: 25.0}),
    UserScene("helical, as the example", "helical"),
    UserScene(
        "helical, linear reliefs, misaligned by 20 um",
        "helical",
        {**HELICAL_RELIEFS, **LINEAR, "mounting.misalignment_um": 20.0},
    ),
    UserScene("helical, a tenth of the torque", "helical", {TORQUE: 13.0}),
    UserScene("helical, ten times the torque", "helical", {TORQUE: 1300.0}),
    UserScene("helical, face of 80 mm", "helical", dict.fromkeys(WIDTHS, 80.0)),
    UserScene("helical, face of 6 mm", "helical", dict.fromkeys(WIDTHS, 6.0)),
    UserScene("helical, twist of 10 um", "helical", {f"{PINION}twist_um": 10.0}),
    UserScene(
        "helical, end relief alone",
        "helical",
        {f"{PINION}lead_crowning_um": 0.0, f"{PINION}end_relief_um": 15.0, f"{PINION}end_relief_length_mm": 4.0},
    ),
    UserScene("helical, logarithmic crowning", "helical", {f"{PINION}lead_crowning_form": "logarithmic"}),
    UserScene(
        "helical, tips and face ends rounded",
        "helical",
        {f"{gear}.{edge}_rounding_mm": 0.2 for gear in ("pinion", "wheel") for edge in ("tip", "side")},
    ),
    UserScene("helical, pressure capped at 1500 MPa", "helical", {TORQUE: 500.0, "material.max_pressure_MPa": 1500.0}),
    UserScene("helical, three torques", "helical", {"analysis.torques_Nm": (60.0, 130.0, 260.0)}),
    UserScene("spur, linear reliefs", "spur", {**SPUR_RELIEFS, **LINEAR}),
    UserScene("spur, parabolic reliefs", "spur", SPUR_RELIEFS),
    UserScene("straight bevel", "straight_bevel"),
    UserScene("spiral bevel", "spiral_bevel"),
    UserScene("face-milled, matched", "face_milled_19x62_matched"),
    UserScene("helical, measured wheel flank", "measured_flank"),
    UserScene("helical, root stress", "helical", ROOTS),
    UserScene("spiral bevel, root stress", "spiral_bevel", ROOTS),
)


@dataclass(frozen=True)
class Job:
    """What one asks of a file of the examples.

    Attributes
    ----------
    what : str
    kind : str
        "run", "tribology", "stage" or "revolution".
    file : str
        In the folder of examples.
    changes : mapping
    """

    what: str
    kind: str
    file: str
    changes: Mapping[str, object] = field(default_factory=dict)


USUAL: dict[str, object] = {"analysis.accuracy": 1e-2}
JOBS = (
    Job("helical pair, 21 positions", "run", "scenes/helical.toml", USUAL),
    Job("the same with root stress", "run", "scenes/helical.toml", USUAL | ROOTS),
    Job("drive stage on its shafts, 17 positions, 2 torques, with its oil", "tribology", "scenes/drive_stage.toml"),
    Job("spiral bevel pair from its data sheet, 21 positions", "run", "scenes/spiral_bevel_blank.toml"),
    Job("face-milled pair by machine settings, 21 positions", "run", "scenes/face_milled_19x62_matched.toml", USUAL),
    Job("planet and ring, 15 positions", "run", "scenes/planet_ring.toml"),
    Job("planetary stage, 2 torques", "stage", "stages/helical_automotive.toml"),
    Job("a turn of the wheel with pitch deviations, 2 torques", "revolution", "scenes/revolution_helical.toml"),
)


PARTS = {
    "unloaded contact": "trace_teeth",
    "gaps": "sample_separations",
    "solver": "solve_problems",
    "models of teeth": "tooth_compliance",
    "models of roots": "root_stress_model",
    "rounded edges": "pressures_at_rounded_edges",
    "free edges": "edge_compliances",
    "warnings": "warn_of_accuracy",
    "collecting": "mesh_cycle",
}
"""Functions whose time, with what they call, is told."""


@dataclass(frozen=True)
class Taken:
    """What an analysis took.

    Attributes
    ----------
    told, seconds : float [s]
        Told before; processor time.
    largest : (int, int)
        Cells of the largest grid.
    contacts : int
        Loaded contacts.
    parts : mapping of str to float
        Of the processor time, with what they call.
    """

    told: float
    seconds: float
    largest: tuple[int, int]
    contacts: int
    parts: Mapping[str, float]


def job_alone() -> None:
    """Do the job that the command line of this process holds; print its processor time [s] as JSON."""
    kind, file, changes = json.loads(sys.argv[1])
    path = SCENES.parent / file
    if kind == "stage":
        stage = read_stage(path)
        start = time.process_time()
        analyse_stage(stage)
    else:
        scene = read_scene(path)
        scene = scene.with_changes(changes) if changes else scene
        start = time.process_time()
        if kind == "revolution":
            analyse_revolution(scene)
        elif kind == "tribology":
            analyse(scene).tribology().summary()
        else:
            analyse(scene)
    print(json.dumps(time.process_time() - start))


def jobs() -> str:
    """Table of the jobs."""
    lines = []
    for job in JOBS:
        seconds = _in_a_process("job_alone", [job.kind, job.file, dict(job.changes)], job.what)
        command = "run, tribology" if job.kind == "tribology" else job.kind
        lines.append(f"{job.what} | `{command}` | `examples/{job.file}` | {seconds:.1f}")
        print(lines[-1], file=sys.stderr)
    return table("job | command | file | s", lines)


def measure(scene: UserScene) -> Taken:
    """Analyse a scene in two processes of its own: one for the time, the other for where it goes."""
    taken, parts = (_run(scene, profiled=profiled) for profiled in (False, True))
    return Taken(
        told=taken["told"],
        seconds=taken["seconds"],
        largest=(taken["largest"][0], taken["largest"][1]),
        contacts=taken["contacts"],
        parts=parts["parts"],
    )


def _run(scene: UserScene, *, profiled: bool) -> dict[str, Any]:
    return dict(_in_a_process("alone", [str(scene.path), dict(scene.changes), profiled], scene.what))


def _in_a_process(function: str, given: list[object], what: str) -> Any:
    """What a function of this module prints as JSON, on one thread and without kept models."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "LOADED_TCA_JOBS": "1", "LOADED_TCA_CACHE": "off"}
    code = f"from validation.loaded.user_scenes import {function}; {function}()"
    command = [sys.executable, "-W", "ignore", "-c", code, json.dumps(given)]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{what}: {done.stderr.strip().splitlines()[-1]}")
    return json.loads(done.stdout)


def alone() -> None:
    """Analyse the scene that the command line of this process holds; print what it took as JSON."""
    path, changes, profiled = json.loads(sys.argv[1])
    text = Path(path).read_text(encoding="utf-8").split("\n[analysis]")[0]
    scene = parse_scene(text, folder=Path(path).parent).with_changes(changes)
    profile, start = cProfile.Profile(), time.process_time()
    result = profile.runcall(analyse, scene) if profiled else analyse(scene)
    seconds = time.process_time() - start
    maps = [one for torque in result.maps for position in torque for one in position if one is not None]
    taken = {
        "told": expected_effort(scene).seconds,
        "seconds": seconds,
        "largest": max((one.pressure.shape for one in maps), key=math.prod),
        "contacts": len(maps),
        "parts": _parts(profile) if profiled else {},
    }
    print(json.dumps(taken))


def _parts(profile: cProfile.Profile) -> dict[str, float]:
    """Parts of the time that the functions of ``PARTS`` take, those above a fiftieth, the largest first."""
    profile.create_stats()
    stats = profile.stats  # type: ignore[attr-defined]
    total = sum(entry[2] for entry in stats.values())
    parts = {name: sum(e[3] for key, e in stats.items() if key[2] == what) / total for name, what in PARTS.items()}
    return dict(sorted(((n, part) for n, part in parts.items() if part > 0.02), key=lambda one: -one[1]))


FITTED = ("helical", "ev_stage", "spiral_bevel")
"""Files of the scenes that the constants of the estimate are measured with."""


def constants_alone() -> None:
    """Print as JSON what parts of ``run`` take for the scene that the command line of this process holds.

    Its flanks alone are run twice: the second run has all imported.
    """
    started = time.process_time()
    scene = read_scene(json.loads(sys.argv[1])[0]).with_changes({"analysis.compliance": "contact"})
    with TemporaryDirectory() as folder:
        file, out = Path(folder) / "scene.toml", Path(folder) / "out"
        file.write_text(scene.to_toml(), encoding="utf-8")
        whole = [_processor_time(partial(_run_command, file, out)) for _ in range(2)]
        pair, result = scene.pair(), load_result(out / "result.nc")
        tooth_compliance(pair)  # imports of finite elements are of the first analysis
        models = [partial(tooth_compliance, pair), *(partial(root_stress_model, g) for g in (pair.pinion, pair.wheel))]
        forget()
        teeth, *roots = (_processor_time(model) for model in models)
        pictures = _processor_time(partial(plot_all, result, out)) / len(list(out.glob("*.png")))
        apart = _processor_time(partial(_in_a_process, "nothing", [], "start"), of=resource.RUSAGE_CHILDREN)
    speed, layers = measured_speed(), [layers_across(gear) for gear in (pair.pinion, pair.wheel)]
    states, factor = float(speed.states), float(speed.models)
    parts = {
        "TEETH_SECONDS": teeth / sum(layers) ** effort.TEETH_EXPONENT / factor,
        "ROOT_SECONDS": sum(roots) / sum(layers) / factor,
        "IMPORT_SECONDS": (started + whole[0] - whole[1]) / states - effort.START_SECONDS,
        "PICTURE_SECONDS": pictures / states,
        "APART_SECONDS": apart / states,
    }
    print(json.dumps({**parts, "states": states, "models": factor}))


def nothing() -> None:
    """Start a process that makes a model of root stress, but make none."""
    import skfem.quadrature  # noqa: F401

    print("0")


def _run_command(scene: Path, out: Path) -> None:
    with redirect_stdout(io.StringIO()):
        if main(["run", str(scene), "--out", str(out)]):
            raise RuntimeError(f"{scene}: cannot be run")


def _processor_time(work: Callable[[], object], of: int = resource.RUSAGE_SELF) -> float:
    before = resource.getrusage(of)
    work()
    after = resource.getrusage(of)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def constants() -> str:
    """What the constants of the estimate are on this machine, the geometric mean of some scenes, and as they are."""
    parts = [_in_a_process("constants_alone", [str(UserScene("", file).path)], file) for file in FITTED]
    lines = [f"load average {os.getloadavg()[0]:.1f}; {machine()}"]
    for name in parts[0]:
        values = [part[name] for part in parts]
        mean = math.exp(sum(map(math.log, values)) / len(values))
        now = f", now {getattr(effort, name):.3g}" if name.isupper() else ""
        lines.append(f"{name} {mean:.3g}{now}: " + ", ".join(f"{value:.3g}" for value in values))
    return "\n".join(lines)


def page() -> Page:
    """Table of all scenes."""
    lines = []
    for scene in USER_SCENES:
        taken = measure(scene)
        share = ", ".join(f"{name} {100.0 * part:.0f} %" for name, part in taken.parts.items())
        lines.append(
            f"{scene.what} | {taken.told:.1f} | {taken.seconds:.1f} | {taken.told / taken.seconds:.2f} | "
            f"{taken.contacts} | {taken.largest[0]} x {taken.largest[1]} | {share}"
        )
        print(lines[-1], file=sys.stderr)
    head = "scene | told s | taken s | told over taken | contacts | largest grid | where the time goes"
    return Page(
        "how_long", TEXT.format(jobs=jobs(), load=os.getloadavg()[1], table=table(head, lines), machine=machine())
    )


TEXT = """# How long does it take?

## Eight typical jobs

Processor time on one thread, each in a process of its own, without models of teeth or roots kept from an earlier
analysis: files of the examples, with an accuracy of 1e-2. Pictures and files of the commands come on top, some seconds.
The load of the machine was {load:.0f} meanwhile: above its number of cores, times are up to a third longer.

{jobs}

## Several cores

A process does as many works at once as `loaded-tca run --jobs N` (also of `demo`, `revolution` and `stage`) or the
environment variable `LOADED_TCA_JOBS` asks for, and no more than the cores that it may run on, which are the default.
These are the models of root stress of pinion and wheel, the states of the mesh cycle with the models of the teeth, and
without root stress the models of the teeth of both gears; large transforms take the threads that no other work has.
Results, warnings and errors do not depend on it, to the last bit. Variants of studies have one job each, in this
process and in workers. Models of root stress made at once take their memory at once: they are made one by one where
the analysis would need more than half of the machine's.

Helpers have models of root stress, and one mesh of a planetary stage, made by processes of their own: threads waited
for the interpreter with each other, which took a quarter more processor time. `loaded-tca run` of the electric drive
with root stress takes 26.5 s of wall by one job and 18.7 s by two, and 11.3 s by either once the models are kept (an
idle Intel Xeon of two cores, 30 November 2026, medians of two to four runs). By two jobs the processor time is 2 to 3 s
more, that of starting processes; 6 s are done by one core alone: imports, collecting, files, and 16 pictures. What does
not gain: states in halves by two threads, which wait for the interpreter a quarter of their time; other thresholds of
the allocator.

## Scenes by defaults

Scenes as users write them, by the defaults of `[analysis]` alone: 21 positions, accuracy 1e-2, teeth that bend, load
shared, free edges. *Told* is the time of the analysis as it is estimated before; `loaded-tca check` and `run`
say it with imports, files and pictures, by as many jobs as are done at once. The estimate is the work, counted, times
how long two works that stand for it take on this machine: half a second of processor time at its first use, kept
beside the models. *Taken* is the processor time on one thread, in a process of its own and without models of teeth or
roots kept from an earlier analysis (with them, what the last column says of models is saved). Written by `python -m
validation.loaded.user_scenes`.

{table}

{machine}

- **Models of teeth** grow with the layers of elements across the face: 24 of the wide faces, 12 of the helical pair.
  They are kept on disk, for all modifications, torques and mounting errors of a pair.
- **Accuracy**: 1e-3 takes 2.2 times as long, 1e-4 five times, where contacts are smooth; where they end at reliefs or
  lie askew on their grid up to three times more. `analysis.cells` sets all grids at once.
- **Tooth pairs in contact** share the load by balances, which take longer the more there are: 3.9 of the electric
  drive, 2.3 of the helical pair.
- **Not told before**: grids that an accuracy needs beyond what smooth contacts need.
"""


if __name__ == "__main__":
    if "--constants" in sys.argv:
        print(constants())
    else:
        write_page(__doc__, page)
