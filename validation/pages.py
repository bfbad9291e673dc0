"""Every page of the documentation whose numbers and pictures a script makes, made anew: ``python -m validation.pages``.

Each script is run in a process of its own, one after the other, and what it prints is kept in a folder of logs. With
names, only those whose name has one of them in it: ``python -m validation.pages contact speed``. All of them take some
hours of one core; times that pages compare want a machine that does nothing else.
"""

import argparse
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from validation.page import ROOT, machine

WRITES = re.compile(r"^ +write_page\(__doc__", re.MULTILINE)
"""In scripts of ``validation`` that write a page."""


def scripts(names: Iterable[str] = ()) -> Iterator[str]:
    """Modules that write pages of ``docs/studies``, then those that draw pictures beside other pages.

    Parameters
    ----------
    names : iterable of str
        Parts of names, of which a module has one; none: all modules.
    """
    wanted = tuple(names)
    for path in [*sorted((ROOT / "validation").rglob("*.py")), *sorted((ROOT / "docs").rglob("*.py"))]:
        text, parts = path.read_text(encoding="utf-8"), path.relative_to(ROOT).with_suffix("").parts
        draws = parts[0] == "docs" and "\nif __name__ ==" in text
        name = ".".join(parts)
        if (draws or WRITES.search(text)) and (not wanted or any(word in name for word in wanted)):
            yield name


def run(name: str, logs: Path) -> str:
    """Run a script; say how it went."""
    begin = time.perf_counter()
    with (logs / f"{name}.txt").open("w", encoding="utf-8") as log:
        done = subprocess.run(
            [sys.executable, "-m", name], cwd=ROOT, env=os.environ, stdout=log, stderr=subprocess.STDOUT, check=False
        )
    taken = f"{time.perf_counter() - begin:.0f} s"
    return taken if done.returncode == 0 else f"FAILED after {taken}: see {log.name}"


def main() -> None:
    """Run the scripts whose names are asked for."""
    parser = argparse.ArgumentParser(prog="python -m validation.pages", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", help="parts of names of scripts; none: all")
    parser.add_argument("--list", action="store_true", help="list the scripts, and run none")
    parser.add_argument("--logs", type=Path, default=ROOT / "docs" / "_build" / "pages", help="what scripts print")
    options = parser.parse_args()
    chosen = [*scripts(options.names)]
    if not chosen:
        parser.error(f"no script has {' or '.join(options.names)} in its name; --list has all")
    if options.list:
        print(*chosen, sep="\n")
        return
    options.logs.mkdir(parents=True, exist_ok=True)
    print(machine(numpy=True))
    outcomes = {}
    for name in chosen:
        outcomes[name] = run(name, options.logs)
        print(f"{name}: {outcomes[name]}", flush=True)
    sys.exit(any(outcome.startswith("FAILED") for outcome in outcomes.values()))


if __name__ == "__main__":
    main()
