"""Models that take long are made once: the last ones are kept in memory, and more on disk.

On disk they lie in ``$XDG_CACHE_HOME/loaded_tca``, by default ``~/.cache/loaded_tca``; the environment variable
``LOADED_TCA_CACHE`` names another folder, or says ``off``. The folder may be removed at any time. Files that cannot be
read, or are not what they should be, are made anew; a folder that cannot be written is done without.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import zipfile
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from threading import RLock
from typing import TypeVar, cast

import numpy as np

FOLDER = "LOADED_TCA_CACHE"
"""Environment variable: where to keep models on disk, or "off"."""
MOST_IN_MEMORY = 8
MOST_ON_DISK = 64
"""Files of 0.1 to 2 MB each, of root stress 1 to 10; the oldest go."""
UNREADABLE = OSError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile
_recent: OrderedDict[str, object] = OrderedDict()
_lock = RLock()  # a handler of a signal may ask for a model amidst another call
Model = TypeVar("Model")


def kept(key: str, kind: type[Model], make: Callable[[], Model]) -> Model:
    """What is known under a key, made if it is not known yet; its arrays cannot be written to.

    Parameters
    ----------
    key : str
        A digest of all that the model depends on.
    kind : type
        A dataclass of arrays alone.
    make : callable
    """
    folder = _folder()
    with _lock:
        model = _recent.get(key)
    if model is None and folder is not None:
        model = _read(folder / f"{key}.npz", key, kind)
    if model is None:
        model = make()
        if folder is not None:
            _write(folder, key, model)
    for values in vars(model).values():
        values.setflags(write=False)
    with _lock:
        _recent.pop(key, None)
        _recent[key] = model
        while len(_recent) > MOST_IN_MEMORY:
            _recent.popitem(last=False)
    return cast(Model, model)


def forget_kept() -> None:
    """Forget what is kept in memory; files stay."""
    with _lock:
        _recent.clear()


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
            digest = str(file["digest"])
            model = kind(**{name: file[name] for name in file.files if name != "digest"})
            return model if digest == _digest(key, model) else None
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
    import tempfile  # few analyses write

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
