"""What every test shares: NaN stops at once, pictures go to no screen, random numbers are seeded."""

import collections
import gc
import itertools
import os
import signal

import hypothesis
import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from loaded_tca import cli

matplotlib.use("Agg")
hypothesis.settings.register_profile("suite", deadline=None, max_examples=50, derandomize=True)
hypothesis.settings.register_profile("nightly", deadline=None, max_examples=2000)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "suite"))

LONG = ("tests/test_site.py", "tests/test_examples.py", "tests/test_release.py", "tests/results/test_sensitivities.py")
"""Files with tests of several seconds."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items, config):
    """Mark cases beside quick ones; put long tests first: none is the last, for which other workers wait."""
    cases = collections.defaultdict(list)
    for item in items:
        if item.get_closest_marker("quick_cases"):
            cases[item.nodeid.partition("[")[0]].append(item)
    for test, of_test in cases.items():
        quick = of_test[0].get_closest_marker("quick_cases").args
        if not any("::" in path for path in config.args) and (
            missing := {*quick} - {case.callspec.id for case in of_test}
        ):
            raise pytest.UsageError(f"{test}: no case {', '.join(sorted(missing))}")
        for case in of_test:
            if case.callspec.id not in quick:
                case.add_marker(pytest.mark.thorough)
    items.sort(key=lambda item: not item.nodeid.startswith(LONG))


def pytest_collection_finish():
    """Look for garbage seldom: what modules and tests hold stays."""
    gc.collect()
    gc.set_threshold(50_000, 20, 50)


def pytest_configure():
    """Let SIGINT interrupt as at a terminal: jobs that a shell starts in the background inherit that it is ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True)
def _nan_stops():
    with np.errstate(all="raise", under="ignore"):
        yield


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
