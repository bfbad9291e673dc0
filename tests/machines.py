"""Run the whole suite as other machines would: other processors, versions of Python and of what the package needs.

    python tests/machines.py                          # every configuration, one after the other: about an hour
    python tests/machines.py haswell lowest           # those that are named
    python tests/machines.py busy -- tests/contact    # further arguments go to pytest

Ends with 1 if a configuration fails. Virtual environments, made with uv, and logs are kept in the folder of
``--folder``; an environment is made again where ``pyproject.toml`` has changed, and with ``--renew``, which takes the
versions of the day.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parents[1]
HEADER = f"{'configuration':14}{'passed':>8}{'failed':>8}{'skipped':>8}{'seconds':>9}"


@dataclass(frozen=True)
class Configuration:
    """What differs from ``make test``.

    Attributes
    ----------
    variables : dict of str
        Environment variables that are set.
    python : str
        Version of the Python of an environment made for it; empty: the Python that runs this script.
    resolution : str
        Which versions of its dependencies that environment has, as uv names it.
    workers : int
        Processes that run tests beside pytest's; 0: pytest's alone.
    background : bool
        Started with SIGINT ignored, as a shell starts its background jobs.
    busy : bool
        Beside one process for each core that never pauses.
    platform : str
        Types are checked for this platform, and no test runs.
    """

    variables: dict[str, str] = field(default_factory=dict)
    python: str = ""
    resolution: str = "highest"
    workers: int = 2
    background: bool = False
    busy: bool = False
    platform: str = ""


CONFIGURATIONS = {
    "two-workers": Configuration(),
    "one-worker": Configuration(workers=0),
    "haswell": Configuration({"OPENBLAS_CORETYPE": "Haswell"}),
    "skylakex": Configuration({"OPENBLAS_CORETYPE": "SkylakeX"}),
    "nehalem": Configuration({"OPENBLAS_CORETYPE": "Nehalem"}),
    "prescott": Configuration({"OPENBLAS_CORETYPE": "Prescott"}),
    "no-avx": Configuration({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL"}),
    "background": Configuration(background=True),
    "busy": Configuration(busy=True),
    "lowest": Configuration(python="3.11", resolution="lowest-direct"),
    "python-3.11": Configuration(python="3.11"),  # these three have the newest versions
    "python-3.12": Configuration(python="3.12"),
    "python-3.13": Configuration(python="3.13"),
    "win32": Configuration(platform="win32"),
    "darwin": Configuration(platform="darwin"),
}


@dataclass(frozen=True)
class Outcome:
    """What a run came to: how many tests passed and were skipped, and the names of those that failed."""

    passed: int
    skipped: int
    failed: tuple[str, ...]
    seconds: float = 0.0

    def row(self, name: str) -> str:
        """Line of the table."""
        return f"{name:14}{self.passed:8}{len(self.failed):8}{self.skipped:8}{self.seconds:9.0f}"


def command(name: str, python: Path, folder: Path, further: Sequence[str]) -> list[str]:
    """Command line of a configuration."""
    configuration = CONFIGURATIONS[name]
    if configuration.platform:
        cache = folder / f"mypy-{name}"
        return [str(python), "-m", "tests.annotations", "--platform", configuration.platform, "--cache-dir", str(cache)]
    tests = ["-n", str(configuration.workers), "--dist", "worksteal", f"--junit-xml={folder / name}.xml"]
    start = ["sh", "-c", 'trap "" INT; exec "$@"', "sh"] if configuration.background else []
    return [*start, str(python), "-m", "pytest", "-p", "no:cacheprovider", *tests, *further]


def run(name: str, folder: Path, further: Sequence[str] = (), renew: bool = False) -> Outcome:
    """Run a configuration; its log and pytest's file of results are written to a folder."""
    configuration, log = CONFIGURATIONS[name], folder / f"{name}.log"
    (folder / f"{name}.xml").unlink(missing_ok=True)
    start = time.monotonic()
    with log.open("w", encoding="utf-8") as file:
        try:
            python = interpreter(name, folder, file, renew) if configuration.python else Path(sys.executable)
        except (OSError, subprocess.CalledProcessError) as error:
            return Outcome(0, 0, (f"no environment: {error}; see {log}",), time.monotonic() - start)
        start = time.monotonic()
        with _busy_cores(configuration.busy):
            line = command(name, python, folder, further)
            variables = os.environ | configuration.variables
            done = subprocess.run(line, cwd=ROOT, env=variables, stdout=file, stderr=file, check=False)
    seconds = time.monotonic() - start
    passed, skipped, failed = _types(log) if configuration.platform else _tests(folder / f"{name}.xml")
    if done.returncode and not failed:
        failed = (f"ended with {done.returncode}; see {log}",)
    return Outcome(passed, skipped, failed, seconds)


def _tests(results: Path) -> tuple[int, int, tuple[str, ...]]:
    """Tests that passed, were skipped and failed, of pytest's file; none where it has not been written."""
    if not results.exists():
        return 0, 0, ()
    cases = list(ElementTree.parse(results).getroot().iter("testcase"))
    failed = [case for case in cases if any(case.find(kind) is not None for kind in ("failure", "error"))]
    names = dict.fromkeys(f"{case.get('classname')}::{case.get('name')}" for case in failed)
    skipped = sum(case.find("skipped") is not None for case in cases)
    return len(cases) - len(failed) - skipped, skipped, tuple(names)


def _types(log: Path) -> tuple[int, int, tuple[str, ...]]:
    """One check, passed unless mypy has written errors."""
    errors = tuple(line for line in log.read_text(encoding="utf-8").splitlines() if ": error:" in line)
    return int(not errors), 0, errors


@contextmanager
def _busy_cores(wanted: bool) -> Iterator[None]:
    """Keep every core busy meanwhile."""
    number = (os.cpu_count() or 1) if wanted else 0
    processes = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(number)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def interpreter(name: str, folder: Path, log, renew: bool = False) -> Path:
    """Python of the environment of a configuration, with the package and what its tests need; made unless it stands."""
    configuration, place = CONFIGURATIONS[name], folder / name
    python, stamp = place / "bin" / "python", place / "installed"
    wanted = f"{ROOT}\n{(ROOT / 'pyproject.toml').read_text(encoding='utf-8')}"
    if not renew and stamp.exists() and stamp.read_text(encoding="utf-8") == wanted:
        return python
    uv, base = _uv(folder, log), _python(configuration.python)
    versions = ["--resolution", configuration.resolution]
    for line in (
        [uv, "venv", "--seed", "--clear", "--python", base, str(place)],
        [uv, "pip", "install", "--python", str(python), *versions, "--editable", f"{ROOT}[dev]"],
        [uv, "pip", "list", "--python", str(python)],
    ):
        subprocess.run(line, stdout=log, stderr=log, check=True)
    stamp.write_text(wanted, encoding="utf-8")
    return python


def _uv(folder: Path, log) -> str:
    """The program uv: that of the machine, or else one in an environment of its own."""
    own = folder / "uv" / "bin" / "uv"
    if found := shutil.which("uv"):
        return found
    if not own.exists():
        subprocess.run([sys.executable, "-m", "venv", str(folder / "uv")], stdout=log, stderr=log, check=True)
        pip = [str(own.with_name("python")), "-m", "pip", "install", "uv"]
        subprocess.run(pip, stdout=log, stderr=log, check=True)
    return str(own)


def _python(version: str) -> str:
    """A Python of some version, such as 3.12: the one that runs, one on the path, or one of pyenv's."""
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    for python in (sys.executable, f"python{version}", *sorted(versions.glob(f"{version}.*/bin/python"))):
        code = "import sys; print(sys.base_prefix, '%d.%d' % sys.version_info[:2])"
        try:
            done = subprocess.run([str(python), "-c", code], capture_output=True, text=True, check=False)
        except OSError:
            continue
        prefix, _, found = done.stdout.strip().rpartition(" ")
        if found == version:
            return str(Path(prefix) / "bin" / f"python{version}")
    raise FileNotFoundError(f"no Python {version} on this machine")


def other_kernel() -> str:
    """Kernel of OpenBLAS that this machine can run and does not take by itself."""
    return "Nehalem" if _kernels() & {"Haswell", "Zen"} else "Haswell"


def _kernels() -> set[str]:
    """Kernels of OpenBLAS that NumPy and SciPy take on this machine."""
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_info

    return {library["architecture"] for library in threadpool_info() if library["internal_api"] == "openblas"}


def main(arguments: Sequence[str]) -> int:
    """Run configurations and print a table of them; 1 if one fails."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    parser = argparse.ArgumentParser(
        description="Run the suite as other machines would.",
        epilog=f"Configurations: {', '.join(CONFIGURATIONS)}. Arguments after -- go to pytest.",
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="configurations; default: all")
    parser.add_argument("--folder", type=Path, default=ROOT / ".machines", help="of environments and logs")
    parser.add_argument("--renew", action="store_true", help="make environments again")
    parser.add_argument("--other-kernel", action="store_true", help="print a kernel of OpenBLAS for make test-kernel")
    options = parser.parse_args(arguments[:end])
    if options.other_kernel:
        print(other_kernel())
        return 0
    if unknown := [name for name in options.names if name not in CONFIGURATIONS]:
        parser.error(f"no configuration {', '.join(unknown)}; there are {', '.join(CONFIGURATIONS)}")
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    outcomes = {}
    print(HEADER)
    for name in options.names or CONFIGURATIONS:
        outcomes[name] = run(name, folder, arguments[end + 1 :], options.renew)
        print(outcomes[name].row(name), flush=True)
    for name, outcome in outcomes.items():
        for failed in outcome.failed:
            print(f"{name}: {failed}")
    return int(any(outcome.failed for outcome in outcomes.values()))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
