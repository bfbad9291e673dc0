"""The script that says what became of every test."""

from tests.names import changes, names_of

BEFORE = """a.py::test_kept
a.py::test_cases[1]
a.py::test_cases[2]
a.py::test_gone
a.py::test_moved[x]
a.py::test_cases_added[1]
b.py::test_kept

7 tests collected in 0.01s"""
AFTER = """a.py::test_kept
a.py::test_cases[one]
a.py::test_cases_added[1]
a.py::test_cases_added[2]
a.py::test_table[gone]
a.py::test_table[cases]
b.py::test_kept
b.py::test_moved[x]"""


def test_names_are_kept_gone_new_or_moved():
    assert [*changes(names_of(BEFORE.splitlines()), names_of(AFTER.splitlines()))] == [
        "7 before, 8 after",
        "3 kept, 4 gone, 5 new",
        "a.py: 4 gone, 4 new",
        "  ~ test_cases: 2 cases, now 1",
        "  - test_gone (1)",
        "  > test_moved (1): now in b.py",
        "  ~ test_cases_added (1)",
        "  + test_table (2)",
        "b.py: 0 gone, 1 new",
        "  + test_moved (1)",
    ]
