"""What many tests need, made once in a session: the worker that asks first keeps it in a file for all others."""

import fcntl
import hashlib
import os
import pickle
from functools import cache, wraps
from pathlib import Path

FOLDER = Path(os.environ["LOADED_TCA_CACHE"]) / "made-once"
"""Beside the models of teeth, in the folder that ``conftest.py`` makes for a session and removes at its end."""


def made_once(make):
    """The function with its values kept for the session, one for each list of arguments."""

    @cache
    @wraps(make)
    def kept(*arguments, **named):
        asked = repr((make.__module__, make.__qualname__, arguments, sorted(named.items())))
        FOLDER.mkdir(exist_ok=True)
        path = FOLDER / hashlib.sha256(asked.encode()).hexdigest()
        with open(path.with_suffix(".lock"), "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not path.exists():
                value = make(*arguments, **named)
                unfinished = path.with_suffix(".part")
                unfinished.write_bytes(pickle.dumps(value))
                unfinished.rename(path)
                return value
        return pickle.loads(path.read_bytes())

    return kept
