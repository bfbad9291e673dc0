"""What files of others reach: what SECURITY.md says of scenes, results and studies."""

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

from loaded_tca import InputError, load_result, parse_scene, read_scene
from loaded_tca.compliance import flexibility, kept
from loaded_tca.exchange import files
from loaded_tca.flanks import topography
from loaded_tca.results.files import read_dataset, write_dataset
from loaded_tca.scene import parse
from loaded_tca.scene.keys import shown
from loaded_tca.studies import read, read_study
from tests.samples.results import result

ROOT = Path(__file__).parents[1]
SCENES = ROOT / "examples" / "scenes"
FLANK = "measured_flank.csv"

WATCHED = """
import json, sys
import loaded_tca, xarray, pandas, scipy.io, scipy.stats
from loaded_tca.studies import read_study

WATCHED = "open", "exec", "compile", "pickle", "socket", "subprocess", "os", "shutil", "urllib", "ctypes", "import"
reads, events = [{reads}], []
def watch(event, arguments):
    if seen is not None and event.partition(".")[0] in WATCHED and event not in ("os.listdir", "os.scandir"):
        seen.add((event, str(arguments[0]) if event == "open" else ""))
seen = None
for read in reads:
    read()  # all is imported
sys.addaudithook(watch)
for read in reads:
    seen = set()
    read()
    last, seen = seen, None
    events.append(sorted(last))
print(json.dumps(events))
"""


def seen(reads, folder):
    """What a fresh interpreter does in each of its readings: files opened, and any other event by its name."""
    script = WATCHED.format(reads=", ".join(reads))
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return [[tuple(event) for event in events] for events in json.loads(done.stdout)]


@pytest.fixture
def folder(tmp_path):
    """A folder with a scene, its measured flank, a result and a study with a table, in one that has another flank."""
    place = tmp_path / "scenes"
    place.mkdir()
    for name in ("measured_flank.toml", FLANK):
        shutil.copy(SCENES / name, place)
    shutil.copy(SCENES / FLANK, tmp_path / "other.csv")
    result().save(place / "result.nc")
    (place / "table.csv").write_text("mounting.misalignment_um\n1\n2\n")
    (place / "study.toml").write_text('scene = "measured_flank.toml"\ntable = "table.csv"\n')
    return place


def scene_with(folder, file):
    """The text of the scene with another name of its measured flank."""
    text = (folder / "measured_flank.toml").read_text(encoding="utf-8")
    assert f'file = "{FLANK}"' in text
    return text.replace(f'file = "{FLANK}"', f"file = {json.dumps(str(file))}")


READS = {
    "lambda: loaded_tca.read_scene('measured_flank.toml').pair()": ["measured_flank.csv", "measured_flank.toml"],
    "lambda: loaded_tca.load_result('result.nc').scene.pair()": ["result.nc"],
    "lambda: read_study('study.toml')": ["measured_flank.csv", "measured_flank.toml", "study.toml", "table.csv"],
}


@pytest.mark.thorough
def test_reading_opens_the_named_files_and_does_nothing_else(folder):
    """No pickles, no code, no processes, no connections."""
    assert seen(READS, folder) == [[("open", name) for name in files] for files in READS.values()]


@pytest.mark.parametrize(
    "name", ["../other.csv", "{outside}/other.csv", "/etc/hostname", "below/../../other.csv", "link.csv"]
)
def test_scene_reads_no_file_outside_of_its_folder(folder, name):
    """Not by the way up, by a whole path or by a link; the file is not looked at."""
    (folder / "below").mkdir()
    (folder / "link.csv").symlink_to("../other.csv")
    name = name.format(outside=folder.parent)
    told = f"wheel.flank.file: found {shown(name)}; allowed a file in the folder of the scene, or below it"
    (folder / "scene.toml").write_text(scene_with(folder, name))
    with pytest.raises(InputError) as caught:
        read_scene(folder / "scene.toml")
    assert caught.value.problems == (told,)
    with pytest.raises(InputError) as caught:
        parse_scene(scene_with(folder, name), folder=folder)
    assert caught.value.problems == (told,)


@pytest.mark.parametrize("name", ["below/flank.csv", "./measured_flank.csv", "link.csv", "below/../measured_flank.csv"])
def test_scene_reads_files_beside_it_and_below(folder, name):
    (folder / "below").mkdir()
    shutil.copy(folder / FLANK, folder / "below" / "flank.csv")
    (folder / "link.csv").symlink_to(FLANK)
    (folder.parent / "entry").symlink_to(folder, target_is_directory=True)  # the folder itself may be a link
    for place in (folder, folder.parent / "entry", folder / "below" / ".."):
        (place / "scene.toml").write_text(scene_with(folder, name))
        assert read_scene(place / "scene.toml").wheel.flank.measurement is not None


def test_name_that_is_none_is_told_as_such(folder):
    with pytest.raises(InputError, match=r"wheel\.flank\.file"):
        parse_scene(scene_with(folder, "flank\0.csv"), folder=folder)


def test_file_of_the_caller_may_lie_anywhere(folder):
    """What is named in Python or by --set is the caller's own word."""
    changes = {"wheel.flank": {"form": "measured", "file": str(folder.parent / "other.csv")}}
    assert read_scene(folder / "measured_flank.toml").with_changes(changes).wheel.flank.measurement is not None


def test_result_names_no_file(folder, monkeypatch):
    """Its digest is of no help: whoever writes a file can compute it."""
    monkeypatch.chdir(folder)
    whole = read_dataset("result.nc")
    write_dataset("result.nc", whole.assign_attrs(scene_toml=scene_with(folder, FLANK)))
    with pytest.raises(InputError) as caught:
        load_result("result.nc")
    assert caught.value.problems == (
        "result.nc: not the result of a mesh cycle",
        f'wheel.flank.file: found "{FLANK}"; allowed no file here',
    )


@pytest.mark.parametrize("kind", ["study", "design"])
def test_report_of_a_study_or_design_opens_no_file_that_its_scene_names(folder, kind, refused, monkeypatch):
    """Not even one in the folder where the command runs."""
    monkeypatch.chdir(folder)
    shutil.copy(FLANK, "secret.csv")
    told = {"kind": kind, "scene_toml": scene_with(folder, "secret.csv"), "figure": "span_um"}
    told |= dict.fromkeys(("warnings", "objective", "limits"), "")
    numbers = dict.fromkeys(("value", "objective", "held_objective"), 1.0)
    write_dataset("forged.nc", xarray.Dataset(numbers, attrs=told))
    assert refused("report", "forged.nc") == 'wheel.flank.file: found "secret.csv"; allowed no file here'
    assert not Path("report.html").exists()


def test_packed_result_is_not_unpacked(tmp_path):
    path = tmp_path / "result.nc"
    path.write_bytes(gzip.compress(bytes(result().to_netcdf())))
    with pytest.raises(InputError, match="not a NetCDF-3 file"):
        load_result(path)


def test_dimensions_that_the_file_does_not_hold_take_no_memory(tmp_path):
    """A length of two thousand million positions in the header of a small file."""
    content = bytearray(result().to_netcdf())
    place = content.index(b"position\0\0\0") + len("position")
    content[place : place + 4] = (2**31 - 1).to_bytes(4, "big")
    content = bytes(content).replace(b"digest", b"digets", 1)  # else the digest tells it
    (tmp_path / "result.nc").write_bytes(content)
    with pytest.raises(InputError, match="damaged"):
        load_result(tmp_path / "result.nc")


class Pickled:
    """What runs if it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return os.mkdir, (str(self.path),)


def test_kept_model_is_never_unpickled(tmp_path):
    path = tmp_path / "model.npz"
    np.savez(path, digest=np.array([Pickled(tmp_path / "run")], dtype=object))
    assert kept._read(path, "key", flexibility.ToothFlexibility) is None
    assert not (tmp_path / "run").exists()
    np.load(path, allow_pickle=True)["digest"]
    assert (tmp_path / "run").exists()  # so it would have


@pytest.mark.parametrize("name", ["os", "stats", "norm.__class__", "linregress", "__builtins__"])
def test_distribution_of_a_study_is_no_other_name_of_python(folder, name):
    (folder / "study.toml").write_text(
        'scene = "measured_flank.toml"\nsamples = 2\n[distributions]\n'
        f'mounting.misalignment_um = {{ distribution = "{name}" }}\n'
    )
    with pytest.raises(InputError, match=r"^distributions\.mounting\.misalignment_um: found"):
        read_study(folder / "study.toml")


def test_note_tells_the_sizes_that_are_read():
    text = (ROOT / "SECURITY.md").read_text(encoding="utf-8")
    told = {int(number) * 2**20 for number in re.findall(r"(\d+) MiB", text)}
    assert told == {parse.LARGEST_FILE, topography.LARGEST_FILE, read.LARGEST_TABLE, files.LARGEST_FILE}
