"""Imports on first use: names of packages (PEP 562), and imports of libraries that are not needed."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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


@contextmanager
def hidden(module: str) -> Iterator[None]:
    """Let imports inside find no such module, unless it is imported already.

    Parameters
    ----------
    module : str
        What a library imports if it is installed, for something that is not used here.

    Examples
    --------
    >>> with hidden("http.server"):
    ...     import http.server
    Traceback (most recent call last):
    ...
    ModuleNotFoundError: import of http.server halted; None in sys.modules
    >>> import http.server
    """
    if module in sys.modules:
        yield
        return
    sys.modules[module] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        del sys.modules[module]
