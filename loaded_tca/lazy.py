"""Names of a package that are imported when they are first used (PEP 562)."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from importlib import import_module


def lazy_names(package: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """``__getattr__`` and ``__dir__`` of a package that imports each of its public names when it is first used.

    Which name is in which module stands once, as ordinary imports under ``if TYPE_CHECKING:`` in the package's
    ``__init__.py``: type checkers and the import contracts read them there, and so does this function. A public name
    must not be that of a module beside it, for Python sets a package's attribute when it imports a module.

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
    origins = {alias.name: node.module for node in imports for alias in node.names if node.module != "typing"}
    del origins["lazy_names"]

    def load(name: str) -> object:
        if name not in origins:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        origin = str(origins[name])
        is_module = origin == package
        value = import_module(f"{package}.{name}") if is_module else getattr(import_module(origin), name)
        setattr(module, name, value)  # asked for only once
        return value

    return load, lambda: sorted({*vars(module), *origins})
