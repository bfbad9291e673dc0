"""What every test shares: NaN stops at once, pictures go to no screen, random numbers are seeded."""

import os
import signal

import hypothesis
import matplotlib
import numpy as np
import pytest

from loaded_tca import cli

matplotlib.use("Agg")
hypothesis.settings.register_profile("suite", deadline=None, max_examples=100, derandomize=True)
hypothesis.settings.register_profile("nightly", deadline=None, max_examples=2000)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "suite"))


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
