"""The tables of refusals fail where a call is accepted, raises another error or has other words."""

import pytest

from loaded_tca import GeometryError, InputError
from tests.refusals import check, refusals, refused_calls


def raised(*problems):
    raise InputError(problems)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: None, "words"),
        (lambda: raised("load: -1 N"), "cells"),
        (lambda: raised("load: -1 N", "cells: 0"), ("^load:",)),
        (lambda: raised("load: -1 N", "cells: 0"), ("^cells:", "^load:")),
    ],
)
def test_wrong_row_fails(request, call, words):
    with pytest.raises((pytest.fail.Exception, AssertionError)):
        check(request, call, (), words)


@pytest.mark.parametrize("words", ["load: -1", "load: -1 N$", ("load: -1 N", "cells: 0")])
def test_plain_words_are_the_whole_problem(request, words):
    check(request, lambda: raised("load: -1 N"), (), "load: -1 N", plain=True)
    with pytest.raises(AssertionError):
        check(request, lambda: raised("load: -1 N"), (), words, plain=True)


def test_error_of_another_class_is_not_taken(request):
    with pytest.raises(InputError, match="load"):
        check(request, lambda: raised("load: -1 N"), (), "load", GeometryError)


def test_cases_have_the_words_and_the_values_as_names():
    rows = (lambda value: raised(f"load: {value}"), "^load:", [1, "a"]), (lambda: raised("cells"), ("cells",))
    (marked,) = refused_calls(*rows).pytestmark
    assert [case.id for case in marked.args[1]] == ["^load:-1", "^load:-'a'", "('cells',)"]


test_table_of_arguments_and_fixtures = refusals(
    lambda first, second, tmp_path: raised(f"{first} {second} {tmp_path.name}"), (1, 2, "^1 2 test_table_of")
)
