"""Flexibility of one gear's teeth: a table of displacements under unit forces all over one flank, made once and kept.

A study of torques, positions or mounting errors asks again and again for the same gears. What is kept is found by a key
made of all numbers that enter: outline and nodes of the body, places of the table, material, side, and the programme
itself. Equal keys are equal models; any other outline, bore, material, density or version is another one.

On disk it lies in ``$XDG_CACHE_HOME/loaded_tca``, by default ``~/.cache/loaded_tca``; the environment variable
``LOADED_TCA_CACHE`` names another folder, or says ``off``. The folder may be removed at any time. Files that cannot be
read, or are not what they should be, are made anew; a folder that cannot be written is done without.

Models from disk save 0.9 to 2.7 s of processor time of the first analysis of a process, 30 to 50 % of it (the mesh
cycles and the matched face-milled pair among the examples' scenes).
"""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import tempfile
import zipfile
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from threading import Lock
from typing import TypeVar, cast

import numpy as np
from numpy.polynomial.chebyshev import chebpts2
from scipy.sparse import vstack

from loaded_tca.arrays import Array
from loaded_tca.compliance.body import FlankPlaces, ToothFrame, gear_body
from loaded_tca.compliance.local_term import local_flexibility

HEIGHTS = 6
"""Places along the profile between which the displacements are interpolated."""
LENGTHS_PER_LAYER = 2.0
"""Places across the face, over the layers of elements, and at least:"""
LEAST_LENGTHS = 11
FOLDER = "LOADED_TCA_CACHE"
"""Environment variable: where to keep models on disk, or "off"."""
MOST_IN_MEMORY = 8
MOST_ON_DISK = 64
"""Files of 0.1 to 2 MB each, of root stress 1 to 10; the oldest go."""
SAME_OUTLINE = 1e-9
"""Numbers are the same if they agree to this part of the size of the gear: far above rounding."""
UNREADABLE = OSError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile
_recent: OrderedDict[str, object] = OrderedDict()
_lock = Lock()
Model = TypeVar("Model")


@dataclass(frozen=True, eq=False)
class ToothFlexibility:
    """What finite elements say of one gear, loaded on one flank.

    Attributes
    ----------
    heights, lengths : (a,), (b,) array
        Parts of the flank's height and of the face width, where the finite elements were loaded and read.
    displacement : (teeth, a b, a b) array [mm/N]
        Of the teeth ``-neighbours`` to ``+neighbours``: at the second place under a force at the third on tooth 0.
    depth : (a, b) array [mm]
        From there along the normal to the middle of the tooth.
    local_height, local_value : (n,) array
        Parts of the flank's height, increasing, and the local term there [mm per N/mm].
    """

    heights: Array
    lengths: Array
    displacement: Array
    depth: Array
    local_height: Array
    local_value: Array


def grid_of_places(frame: ToothFrame) -> tuple[Array, Array, FlankPlaces]:
    """Heights (a,) and lengths (b,) of the table, and the places (a b) that they make on the flank."""
    layers = frame.nodes.layout.density.lengthwise
    heights = 0.5 + 0.5 * chebpts2(HEIGHTS)
    lengths = 0.5 + 0.5 * chebpts2(max(LEAST_LENGTHS, math.ceil(LENGTHS_PER_LAYER * layers)))
    grid = np.meshgrid(heights, lengths, indexing="ij")
    return heights, lengths, frame.places(*(parts.ravel() for parts in grid))


def tooth_flexibility(frame: ToothFrame) -> ToothFlexibility:
    """Load a gear body by unit forces all over one flank.

    Parameters
    ----------
    frame : ToothFrame

    Raises
    ------
    GeometryError
        If the mesh is turned inside out.
    """
    heights, lengths, places = grid_of_places(frame)
    mesh, factor = gear_body(frame.nodes, frame.gear.material)
    number, size, near = mesh.number, len(mesh.points), frame.nodes.layout.neighbours
    forces = frame.on_flank(places, number).along(-places.normal, size)
    teeth = [frame.on_middle(places, tooth, number) for tooth in range(-near, near + 1)]
    readings = vstack([middle.along(-places.normal, size) for middle in teeth], format="csr")
    displacement = factor.flexibility(forces, readings).reshape(len(teeth), len(places.height), -1)
    depth = places.depth.reshape(len(heights), len(lengths))
    return ToothFlexibility(heights, lengths, displacement, depth, *local_flexibility(frame.gear))


def kept_flexibility(frame: ToothFrame) -> ToothFlexibility:
    """Flexibility of a gear's teeth, made if it is not known yet; its arrays cannot be written to.

    For parameters and errors see :func:`loaded_tca.compliance.flexibility.tooth_flexibility`.
    """
    return kept(key_of(frame), ToothFlexibility, lambda: tooth_flexibility(frame))


def kept(key: str, kind: type[Model], make: Callable[[], Model]) -> Model:
    """What is known under a key, made if it is not known yet; its arrays cannot be written to.

    Parameters
    ----------
    key : str
        As :func:`key_of` makes them.
    kind : type
        A dataclass of arrays alone.
    make : callable
    """
    folder = _folder()
    with _lock:
        found = _recent.get(key)
    if found is None and folder is not None:
        found = _read(folder / f"{key}.npz", key, kind)
    if found is None:
        found = make()
        if folder is not None:
            _write(folder, key, found)
    with _lock:
        _recent[key] = found
        _recent.move_to_end(key)
        while len(_recent) > MOST_IN_MEMORY:
            _recent.popitem(last=False)
    for values in vars(found).values():
        values.setflags(write=False)
    return cast(Model, found)


def forget() -> None:
    """Forget what is kept in memory; files stay."""
    with _lock:
        _recent.clear()


def key_of(frame: ToothFrame, places: FlankPlaces | None = None, what: str = "") -> str:
    """Digest of all that the flexibility of a gear's teeth depends on, or ``what`` else of forces at ``places``."""
    nodes, material = frame.nodes, frame.gear.material
    places = places or grid_of_places(frame)[-1]
    size = float(np.nanmax(np.abs(nodes.points)))
    plain = frame.side, nodes.layout, float(material.youngs_modulus), float(material.poisson_ratio), f"{size:.9e}"
    digest = hashlib.sha256(f"{_programme()} {what}{plain}".encode())
    for lengths in (nodes.outline, nodes.points, places.point, places.depth):
        digest.update(_rounded(lengths / size))
    digest.update(_rounded(places.normal))
    return digest.hexdigest()


def _rounded(values: Array) -> bytes:
    """Values of at most about 1 as whole numbers; 2 stands for a node that is none."""
    whole = np.rint(np.nan_to_num(values, nan=2.0) / SAME_OUTLINE).astype(np.int64)
    return f"{whole.shape}".encode() + whole.tobytes()


@cache
def _programme() -> str:
    """Version of the package, and a digest of the modules that make the models: they may change between versions."""
    digest = hashlib.sha256()
    for module in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(module.read_bytes())
    return f"{version('loaded_tca')} {digest.hexdigest()}"


def _folder() -> Path | None:
    """Where models are kept on disk, if anywhere."""
    wanted = os.environ.get(FOLDER, "")
    if wanted:
        return None if wanted == "off" else Path(os.path.expanduser(wanted))
    caches = Path(os.environ.get("XDG_CACHE_HOME", ""))
    with contextlib.suppress(RuntimeError):  # nobody's home is known
        return (caches if caches.is_absolute() else Path.home() / ".cache") / "loaded_tca"
    return None


def _read(path: Path, key: str, kind: type[Model]) -> Model | None:
    """Return what a file keeps under a key; None if it is not there, damaged, or another gear's."""
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
            told = str(file["digest"])
            found = kind(**{name: file[name] for name in file.files if name != "digest"})
            return found if told == _digest(key, found) else None
    except UNREADABLE:
        return None


def _digest(key: str, model: object) -> str:
    """Digest of a key and of all numbers that are kept under it."""
    digest = hashlib.sha256(key.encode())
    for name, array in vars(model).items():
        digest.update(f"{name} {array.dtype} {array.shape}".encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()


def _write(folder: Path, key: str, model: object) -> None:
    """Write a file as a whole or not at all, and remove the oldest beyond the most."""
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        descriptor, unfinished = tempfile.mkstemp(dir=folder, suffix=".unfinished")
        try:
            with os.fdopen(descriptor, "wb") as file:
                np.savez(file, digest=np.array(_digest(key, model)), **vars(model))
            os.replace(unfinished, folder / f"{key}.npz")
        finally:
            Path(unfinished).unlink(missing_ok=True)
        files = sorted(folder.glob("*.npz"), key=lambda path: path.stat().st_mtime)
        for old in files[:-MOST_ON_DISK]:
            old.unlink(missing_ok=True)
