"""Ctrl-C in the middle of an analysis, as a user at a terminal sees it."""

import os
import re
import signal
import struct
import subprocess
import sys
from pathlib import Path

import pytest
import xarray

from loaded_tca.results.files import write_dataset

pty = pytest.importorskip("pty")
fcntl = pytest.importorskip("fcntl")
termios = pytest.importorskip("termios")

SCENE = Path(__file__).parents[1] / "examples" / "scenes" / "mesh_cycle_spur.toml"


def interrupted(scene, directory, shown):
    """Run a scene, press Ctrl-C once the terminal shows something; exit code and all that it showed."""
    near, far = pty.openpty()
    fcntl.ioctl(far, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
    command = [sys.executable, "-m", "loaded_tca", "run", str(scene), "--out", "out"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=far, cwd=directory) as process:
        os.close(far)
        text, pressed = "", False
        while part := _read(near):
            text += part.decode(errors="replace")
            if not pressed and re.search(shown, text):
                process.send_signal(signal.SIGINT)
                pressed = True
        code = process.wait()
    os.close(near)
    assert pressed, text
    return code, text


def _read(terminal):
    """What comes next; nothing once the other end is closed."""
    try:
        return os.read(terminal, 4096)
    except OSError:
        return b""


PRESSED_WHILE_IMPORTING = """
import os, runpy, signal, sys

class PressCtrlC:
    def find_spec(self, name, *_):
        if name == NAME:
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, PressCtrlC())
sys.argv = ["loaded-tca", "run", "absent.toml", "--out", "out"]
runpy.run_module("loaded_tca", run_name="__main__", alter_sys=True)
"""


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["loaded_tca.cli", "argparse", "loaded_tca.scene", "numpy", "xarray"])
def test_interrupt_while_a_module_is_imported_is_one_line(tmp_path, name):
    code = PRESSED_WHILE_IMPORTING.replace("NAME", repr(name))
    if name == "xarray":  # a result is read by it
        write_dataset(tmp_path / "absent.nc", xarray.Dataset())
        code = code.replace('"run", "absent.toml", "--out", "out"', '"plot", "absent.nc"')
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stderr.splitlines() == ["loaded-tca: interrupted; no file is half written"]
    assert done.returncode == 130


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("compliance", "shown"),
    [
        ("contact+tooth", r" 0/99"),  # on its way to the first position: the teeth are modelled
        ("contact", r" [1-9]\d?/99"),
    ],
    ids=["in models of teeth", "between positions"],
)
def test_interrupted_cycle_leaves_no_file_and_one_line(tmp_path, compliance, shown):
    scene = tmp_path / "cycle.toml"
    text = SCENE.read_text(encoding="utf-8")
    assert text.rstrip().splitlines()[-1].startswith("torques_Nm")  # of [analysis]
    scene.write_text(f'{text}compliance = "{compliance}"\n', encoding="utf-8")
    code, told = interrupted(scene, tmp_path, shown)
    assert code == 130
    assert "3 torques x 33 positions:" in told
    assert " left" in told
    assert told.splitlines()[-1] == "loaded-tca: interrupted; no file is half written"
    assert "Traceback" not in told
    assert os.listdir(tmp_path) == ["cycle.toml"]
