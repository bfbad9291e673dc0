"""Run the tests that a change most likely breaks: before every commit, below a minute for most modules.

Run from the root of the repository: ``python -m tests.quick [--base REV] [ARGUMENT OF PYTEST ...]``. The change is what
differs from a revision, HEAD by default, with the files that git does not know yet. Tests mirror the package, so that
those of a module are in the folder of its name: a change of ``contact/solver.py`` has the tests of ``tests/contact``,
and of the modules that import it those named after them (``results/warnings.py``: ``tests/results/test_warnings.py``).
What else a change can reach, only the whole suite sees.
"""

import argparse
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

import grimp

ROOT = Path(__file__).parents[1]
PACKAGE = "loaded_tca"
ELSEWHERE = {
    "validation": "tests/validation",
    "examples": "tests/test_examples.py",
    "docs": "tests/test_documents.py",
    "pyproject.toml": "tests/test_release.py",
    "Makefile": "tests/test_release.py",
}
"""Tests of what is not the package, by the first part of a path."""


def changed_files(base: str) -> list[str]:
    """Paths that differ from a revision, and those that git does not know and does not ignore."""
    commands = ["diff", "--name-only", base], ["ls-files", "--others", "--exclude-standard"]
    texts = [
        subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True) for words in commands
    ]
    return [path for text in texts for path in text.stdout.splitlines()]


def importers_in_package() -> Callable[[str], set[str]]:
    """Function that returns the modules which import a module."""
    graph = grimp.build_graph(PACKAGE)
    return lambda module: graph.find_modules_that_directly_import(module) if module in graph.modules else set()


def selected(changed: Iterable[str], importers: Callable[[str], set[str]], root: Path = ROOT) -> list[str]:
    """Files and folders of tests for a change.

    Parameters
    ----------
    changed : iterable of str
        Paths from the root of the repository.
    importers : callable
        The modules that import a module, by their dotted names.
    root : Path
        Of the repository: paths that are not there are left out.
    """
    wanted = set()
    for path in changed:
        first, *others = Path(path).parts
        if first == PACKAGE and path.endswith(".py"):
            module = path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
            wanted |= {f"tests/{others[0]}"} if len(others) > 1 else mirrored(module)
            wanted |= {test for importer in importers(module) for test in mirrored(importer)}
        elif first == "tests" and len(others) > 1:
            wanted |= {path} if others[-1].startswith("test_") else {f"tests/{others[0]}"}
        elif first == "tests":
            wanted |= {path} if others[0].startswith("test_") else {f"tests/test_{others[0]}"}
        elif first in ELSEWHERE:
            wanted.add(ELSEWHERE[first])
    wanted = {path for path in wanted if (root / path).exists()}
    return sorted(path for path in wanted if str(Path(path).parent) not in wanted)


def mirrored(module: str) -> set[str]:
    """Tests that have the name of a module: of loaded_tca.results.warnings tests/results/test_warnings.py."""
    if module == PACKAGE:
        return {"tests/test_public_names.py"}
    *folders, name = module.split(".")[1:]
    return {"/".join(["tests", *folders, f"test_{name}.py"])}


def main() -> int:
    """Run the tests of a change; returns the exit code of pytest, zero where nothing has tests."""
    parser = argparse.ArgumentParser(description="The tests that a change most likely breaks.")
    parser.add_argument("--base", default="HEAD", help="revision from which the change counts (%(default)s)")
    options, arguments = parser.parse_known_args()
    tests = selected(changed_files(options.base), importers_in_package())
    print(*tests or ["nothing that has changed has tests"], sep="\n", flush=True)
    if not tests:
        return 0
    return subprocess.run([sys.executable, "-m", "pytest", *arguments, *tests], cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
