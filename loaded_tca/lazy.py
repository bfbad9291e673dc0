"""Names of a package that are imported when they are first used (PEP 562)."""

from __future__ import annotations

import dis
import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec


def lazy_names(package: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """``__getattr__`` and ``__dir__`` of a package that imports each of its public names when it is first used.

    Which name is in which module stands once, as ordinary imports under ``if TYPE_CHECKING:`` in the package's
    ``__init__.py``: type checkers and the import contracts read them there, and this function reads them in the
    compiled module, which is there without the source, too. The modules of
    the package are found, too. A public name must not be that of a module beside it: importing the module would put it
    in the name's place.

    Parameters
    ----------
    package : str
        ``__name__`` of the package, which is just being imported.

    Returns
    -------
    (callable, callable)
        ``__getattr__``, ``__dir__``.
    """
    module = sys.modules[package]
    origins, origin = {}, ""
    for step in dis.get_instructions(module.__loader__.get_code(package)):  # type: ignore[union-attr]
        if step.opname == "IMPORT_NAME":
            origin = step.argval
        elif step.opname == "IMPORT_FROM" and origin != package:
            origins[step.argval] = origin

    def load(name: str) -> object:
        if name in origins:
            setattr(module, name, getattr(import_module(origins[name]), name))  # asked for only once
            return getattr(module, name)
        if find_spec(f"{package}.{name}") is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return import_module(f"{package}.{name}")

    return load, lambda: sorted({*vars(module), *origins})
