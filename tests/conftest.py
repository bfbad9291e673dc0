"""What every test shares: NaN stops at once, pictures go to no screen, random numbers are seeded."""

import collections
import contextlib
import gc
import importlib
import itertools
import os
import signal
from pathlib import Path

import dask  # noqa: F401  # commands hide it where nobody has imported it; xarray may know by then that it is there
import hypothesis
import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from loaded_tca import cli

matplotlib.use("Agg")
hypothesis.settings.register_profile("suite", deadline=None, max_examples=20, derandomize=True)
hypothesis.settings.register_profile("nightly", deadline=None, max_examples=2000)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "suite"))

LONG = ("tests/test_site.py", "tests/test_examples.py", "tests/test_release.py", "tests/results/test_sensitivities.py")
"""Files with tests of several seconds."""
DEAR_EXAMPLES = (
    "loaded_tca.baselines.bidirectional.BidirectionalStart",
    "loaded_tca.baselines.conventional.solve_conventional",
    "loaded_tca.baselines.golden_section.search_golden_section",
    "loaded_tca.compliance.body.solid_torsion",
    "loaded_tca.compliance.compliance.tooth_compliance",
    "loaded_tca.compliance.root_stress.root_stress_model",
    "loaded_tca.flanks.hypoid_synthesis.synthesised_gears",
    "loaded_tca.reports.report.write_html_report",
    "loaded_tca.scene.face_milled.hypoid_table",
    "loaded_tca.studies.run.process_pool",
)
"""Of docstrings, of three quarters of a second and more: thorough."""
TESTS = pytest.StashKey[dict[str, bool]]()
"""Of each test that is collected whether make test runs a case of it."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items, config):
    """Mark cases beside quick ones; put long tests first: none is the last, for which other workers wait."""
    cases = collections.defaultdict(list)
    for item in items:
        if item.name in DEAR_EXAMPLES:
            item.add_marker(pytest.mark.thorough)
        if mark := item.get_closest_marker("quick_cases"):
            cases[item.nodeid.partition("[")[0]].append((item, mark))
    for test, marked in cases.items():
        ids = [item.callspec.id for item, _ in marked]
        for (item, mark), case in zip(marked, ids, strict=True):
            quick = mark.args or ids[:: mark.kwargs["every"]]
            if not ({*quick} <= {*ids} or any("::" in path for path in config.args)):
                raise pytest.UsageError(f"{test}: no case {', '.join(sorted({*quick} - {*ids}))}")
            if case not in quick:
                item.add_marker(pytest.mark.thorough)
    items.sort(key=lambda item: not item.nodeid.startswith(LONG))
    config.stash[TESTS] = collections.defaultdict(bool)
    for item in items:
        config.stash[TESTS][item.nodeid.partition("[")[0]] |= not item.get_closest_marker("thorough")


def import_last_first(config):
    """Import the test modules under the folders asked for, the last one first.

    Every second worker begins with this: whatever has not been compiled yet, with its asserts rewritten, is compiled by
    the workers from both ends, and each module once.
    """
    root = Path.cwd()
    folders = [Path(argument).resolve() for argument in config.args]
    for path in sorted((path for folder in folders for path in folder.rglob("test_*.py")), reverse=True):
        with contextlib.suppress(Exception, pytest.skip.Exception):  # the collection says what is wrong
            importlib.import_module(".".join(path.relative_to(root).with_suffix("").parts))


@pytest.hookimpl(wrapper=True)
def pytest_collect_file():
    """Of the files of tests, look for examples in no docstring: those of the package have them."""
    return [collector for collector in (yield) if type(collector) is pytest.Module]


@pytest.hookimpl(wrapper=True)
def pytest_collection(session):
    """Look for garbage seldom, and not while tests are collected: what modules and tests hold stays."""
    gc.disable()
    try:
        if int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")) % 2:
            import_last_first(session.config)
        return (yield)
    finally:
        gc.enable()
        gc.collect()
        gc.freeze()
        gc.set_threshold(50_000, 20, 50)


def pytest_configure():
    """Let SIGINT interrupt as at a terminal: jobs that a shell starts in the background inherit that it is ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True)
def _nan_stops():
    with np.errstate(all="raise", under="ignore"):
        yield


@pytest.fixture
def collected(request):
    """Of each test of this run, by its file and name, whether make test runs a case of it."""
    return request.config.stash[TESTS]


@pytest.fixture
def rng():
    """A seeded generator of random numbers."""
    return np.random.default_rng(20240607)


@pytest.fixture
def blank_pictures(monkeypatch):
    """Figures are made and files written, but nothing is drawn: each picture is of one grey of its own.

    For tests of which files there are; what pictures show is judged where they are drawn.
    """
    greys = itertools.cycle(range(256))

    class Blank(FigureCanvasAgg):
        def draw(self):
            pass

        def buffer_rgba(self):
            return np.full((8, 8, 4), next(greys), dtype=np.uint8)

    monkeypatch.setattr("loaded_tca.plots.style.FigureCanvasAgg", Blank)


@pytest.fixture
def run(capsys):
    """Run the command; returns exit code, stdout and the lines of stderr."""

    def run(*arguments):
        code = cli.main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err.splitlines()

    return run


@pytest.fixture
def refused(run):
    """Run the command with input that it refuses; returns its message, one line."""

    def refused(*arguments):
        code, out, errors = run(*arguments)
        assert (code, out, len(errors)) == (2, "", 1)
        start, _, message = errors[0].partition("loaded-tca: ")
        assert start == ""
        return message

    return refused
