"""Names of a package that are imported when they are first used (PEP 562)."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec


def lazy_names(package: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """``__getattr__`` and ``__dir__`` of a package that imports each of its public names when it is first used.

    Which name is in which module stands once, as ordinary imports under ``if TYPE_CHECKING:`` in the package's
    ``__init__.py``: type checkers and the import contracts read them there, and so does this function. The modules of
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
    source = module.__loader__.get_source(package)  # type: ignore[union-attr]
    imports = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ImportFrom)]
    origins = {name.name: str(node.module) for node in imports for name in node.names if node.module != package}

    def load(name: str) -> object:
        if name in origins:
            setattr(module, name, getattr(import_module(origins[name]), name))  # asked for only once
            return getattr(module, name)
        if find_spec(f"{package}.{name}") is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return import_module(f"{package}.{name}")

    return load, lambda: sorted({*vars(module), *origins})
