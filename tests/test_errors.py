"""The errors: one root, every problem at once, and a way across a process pool."""

import pickle

import pytest

from loaded_tca import AccuracyWarning, ConvergenceError, GeometryError, InputError, LoadedTCAError


@pytest.mark.parametrize(
    ("error", "builtin"), [(InputError, ValueError), (GeometryError, ValueError), (ConvergenceError, RuntimeError)]
)
def test_every_error_is_caught_by_the_common_root_and_by_its_builtin(error, builtin):
    assert issubclass(error, LoadedTCAError)
    assert issubclass(error, builtin)


def test_input_error_tells_every_problem_on_its_own_line():
    error = InputError(["load: -1 N is negative", "cells: 0 is not positive"])
    assert error.problems == ("load: -1 N is negative", "cells: 0 is not positive")
    assert str(error) == "load: -1 N is negative\ncells: 0 is not positive"


def test_input_error_takes_a_single_sentence_whole():
    assert InputError("load: -1 N is negative").problems == ("load: -1 N is negative",)


def test_input_error_takes_any_iterable():
    assert InputError(f"problem {n}" for n in (1, 2)).problems == ("problem 1", "problem 2")


def test_input_error_survives_pickling():
    again = pickle.loads(pickle.dumps(InputError(["one", "two"])))
    assert isinstance(again, InputError)
    assert again.problems == ("one", "two")


def test_convergence_error_survives_pickling_with_its_last_iterate():
    again = pickle.loads(pickle.dumps(ConvergenceError("stopped after 3 steps", last={"residual": 0.5})))
    assert (str(again), again.last) == ("stopped after 3 steps", {"residual": 0.5})


def test_geometry_error_survives_pickling():
    assert str(pickle.loads(pickle.dumps(GeometryError("no common flank")))) == "no common flank"


def test_accuracy_warning_is_a_warning_and_no_error():
    assert issubclass(AccuracyWarning, UserWarning)
    assert not issubclass(AccuracyWarning, LoadedTCAError)
