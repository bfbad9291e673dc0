"""Figures of studies that go wrong, and of long ones. The title of the scene names the folder of the study."""

import os
import signal
import time
from pathlib import Path

from tests.samples.studies import crowning


def folder(scene):
    return Path(scene.title)


def asked(scene):
    """The crowning; a line in the file ``asked`` for every call."""
    with open(folder(scene) / "asked", "a") as file:
        file.write(f"{crowning(scene)['crowning_um']:g}\n")
    return crowning(scene)


def lines(path):
    return path.read_text().splitlines() if path.exists() else []


def wait_for_rows(scene, count):
    while len(lines(folder(scene) / "study.rows.jsonl")) < count:
        time.sleep(0.01)


def killing(scene):
    """End the worker of the third variant, the first time that it is asked for, once two are written down."""
    mark = folder(scene) / "killed"
    if crowning(scene)["crowning_um"] == 3.0 and not mark.exists():
        wait_for_rows(scene, 2)
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return asked(scene)


def endless(scene):
    """As an analysis that takes longer than anyone waits, from the third variant on."""
    if crowning(scene)["crowning_um"] >= 3.0:
        time.sleep(600.0)
    return asked(scene)
