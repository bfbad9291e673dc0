"""Tables of refusals: what a call does not accept, and the words of its error."""

import inspect
import re

import pytest

from loaded_tca import InputError


def refusals(call, *rows, error=InputError, plain=False):
    """Test of a table: with the arguments of a row the call raises the error with the words at the end of the row.

    Words are a regular expression that the message matches, or a tuple with one for every problem of an InputError;
    plain words are the problem itself, or all of them. They are the name of the case. Parameters of the call that
    remain, without a default, are fixtures.
    """
    return _test([pytest.param(call, row[:-1], row[-1], error, id=str(row[-1])) for row in rows], plain)


def refused_calls(*rows, error=InputError):
    """Test of a table of calls and their words; behind them an error other than that of the table, a list of values."""
    cases = []
    for call, words, *more in rows:
        raised = next((each for each in more if not isinstance(each, list)), error)
        values = [
            ((value,), f"{words}-{getattr(value, '__name__', repr(value))}")
            for each in more
            if isinstance(each, list)
            for value in each
        ]
        cases += [pytest.param(call, given, words, raised, id=str(name)) for given, name in values or [((), words)]]
    return _test(cases)


def check(request, call, arguments, words, error=InputError, plain=False):
    """Make a call with its arguments and fixtures, and compare what it raises."""
    parameters = list(inspect.signature(call).parameters.values())[len(arguments) :]
    fixtures = [each for each in parameters if each.default is each.empty and each.kind is each.POSITIONAL_OR_KEYWORD]
    values = [request.getfixturevalue(each.name) for each in fixtures]
    with pytest.raises(error, match=words if isinstance(words, str) and not plain else None) as caught:
        call(*arguments, *values)
    problems = getattr(caught.value, "problems", ())
    if plain:
        assert list(problems) == ([words] if isinstance(words, str) else list(words)), problems
    elif not isinstance(words, str):
        assert len(problems) == len(words), problems
        assert all(map(re.search, words, problems)), problems


def _test(cases, plain=False):
    @pytest.mark.parametrize(("call", "arguments", "words", "error"), cases)
    def test(request, call, arguments, words, error):
        check(request, call, arguments, words, error, plain)

    return test
