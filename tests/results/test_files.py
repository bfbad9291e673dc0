import contextlib
import os

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.results.files import (
    FORMAT_VERSION,
    Variable,
    pack,
    read_netcdf,
    remove,
    replacing,
    unpack,
    write_netcdf,
)

NUMBERS = Variable(("row", "column"), np.array([[1.5, np.inf], [np.nan, -0.0]]), "mm", "some lengths")
FLAGS = Variable(("row",), np.array([True, False]), "1", "some flags")
COUNTS = Variable(("row",), np.array([-3, 7]), "1", "some counts")
SCALAR = Variable((), np.array(2.5), "MPa", "a scalar")
ALL = {"numbers": NUMBERS, "flags": FLAGS, "counts": COUNTS, "scalar": SCALAR}


@pytest.fixture
def path(tmp_path):
    return tmp_path / "result.nc"


def problem(path):
    with pytest.raises(InputError) as caught:
        read_netcdf(path)
    (message,) = caught.value.problems
    return message


def test_variables_survive_with_their_types(path):
    write_netcdf(path, ALL, {})
    variables, _ = read_netcdf(path)
    assert set(variables) == set(ALL)
    for name, variable in ALL.items():
        found = variables[name]
        assert_array_equal(found.data, variable.data, strict=True)
        assert found.data.dtype == variable.data.dtype
        assert (found.dimensions, found.unit, found.text) == (variable.dimensions, variable.unit, variable.text)


@given(text=st.text(st.characters(blacklist_characters="\0", blacklist_categories=["Cs"])))
def test_texts_survive_in_any_script(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("texts") / "a.nc"
    if text != " ":
        write_netcdf(path, {}, {"title": text})
        assert read_netcdf(path)[1]["title"] == text


def test_every_variable_has_units_and_long_name_for_other_readers(path):
    from scipy.io import netcdf_file

    write_netcdf(path, ALL, {"title": "Räder"})
    with netcdf_file(path, mmap=False) as file:
        assert file.variables["numbers"].units == b"mm"
        assert all(variable.long_name for variable in file.variables.values())
        assert file.title.decode() == "Räder"


def test_file_is_closed_after_reading(path):
    write_netcdf(path, ALL, {})
    variables, _ = read_netcdf(path)
    path.unlink()
    assert variables["numbers"].data.flags.owndata
    assert variables["numbers"].data.flags.writeable


def test_writing_leaves_one_file_alone(path):
    write_netcdf(path, ALL, {})
    assert os.listdir(path.parent) == [path.name]


def write_half(path, interruption):
    with replacing(path) as temporary:
        temporary.write_text("half of the ne")
        raise interruption


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, ZeroDivisionError])
def test_interrupted_writing_keeps_the_old_file_and_no_part_of_the_new(path, interruption):
    path.write_text("old")
    with pytest.raises(interruption):
        write_half(path, interruption)
    assert os.listdir(path.parent) == [path.name]
    assert path.read_text() == "old"


def test_failed_variable_leaves_no_file(path):
    wrong = Variable(("row",), np.zeros(3), "1", "of another length than the row of the others")
    with pytest.raises(ValueError):
        write_netcdf(path, {**ALL, "wrong": wrong}, {})
    assert not os.listdir(path.parent)


def test_directory_that_is_not_there_is_told(tmp_path):
    with pytest.raises(InputError, match=r"absent.result\.nc: cannot be written: No such file or directory"):
        write_netcdf(tmp_path / "absent" / "result.nc", ALL, {})


def test_full_disk_is_told(path):
    with pytest.raises(InputError, match=r"cannot be written: No space left"), replacing(path):
        raise OSError(28, "No space left on device")
    assert not os.listdir(path.parent)


def test_missing_file_is_told(path):
    assert problem(path) == f"{path}: cannot be read: No such file or directory"


def test_directory_instead_of_file_is_told(tmp_path):
    assert problem(tmp_path) == f"{tmp_path}: cannot be read: Is a directory"


@pytest.mark.parametrize("content", [b"", b"torque = 3\n", b"\x89HDF\r\n\x1a\n", b"\xff" * 100])
def test_other_file_is_told(path, content):
    path.write_bytes(content)
    assert "not a NetCDF-3 file; expected a result file written by loaded_tca" in problem(path)


def test_truncated_file_is_told_wherever_it_ends(path):
    write_netcdf(path, ALL, {"title": "whole"})
    content = path.read_bytes()
    for length in range(4, len(content) - 4, 7):
        path.write_bytes(content[:length])
        assert str(path) in problem(path)


@given(position=st.integers(0, 10**6), value=st.integers(0, 255))
def test_damaged_file_is_read_or_told(tmp_path_factory, position, value):
    path = tmp_path_factory.mktemp("damage") / "a.nc"
    write_netcdf(path, ALL, {"title": "whole"})
    content = bytearray(path.read_bytes())
    content[position % len(content)] = value
    path.write_bytes(content)
    with contextlib.suppress(InputError):
        read_netcdf(path)


def test_netcdf_file_of_another_program_is_told(path):
    write_netcdf(path, ALL, {"format": "of another program"})
    assert problem(path) == f"{path}: a NetCDF-3 file, but not a result of loaded_tca"


@pytest.mark.parametrize(("step", "age"), [(1, "a later"), (-1, "an earlier")])
def test_file_of_another_format_is_told(path, step, age):
    other = FORMAT_VERSION + step
    write_netcdf(path, ALL, {"format_version": str(other)})
    assert f"written in format {other} by {age} loaded_tca; this one reads format {FORMAT_VERSION}" in problem(path)
    assert "run the scene again" in problem(path)


def test_missing_and_misshapen_parts_are_told_together():
    parts = {"numbers": (("row",), "mm", ""), "absent": ((), "1", ""), "flags": (("row",), "1", "")}
    with pytest.raises(InputError) as caught:
        unpack(ALL, parts)
    assert caught.value.problems == (
        "numbers: found dimensions ('row', 'column'), expected ('row',)",
        "absent: missing",
    )


def test_pack_and_unpack_are_inverse():
    class Thing:
        length = np.array([1.0, 2.0])

    parts = {"length": (("row",), "mm", "a length")}
    assert_array_equal(unpack(pack(Thing(), parts, "thing_"), parts, "thing_")["length"], Thing.length)


def test_removing_a_file_needs_none_to_be_there(tmp_path):
    (tmp_path / "old.png").write_bytes(b"old")
    for _ in range(2):
        remove(tmp_path / "old.png")
    assert list(tmp_path.iterdir()) == []


def test_file_that_cannot_be_removed_is_told(tmp_path):
    with pytest.raises(InputError, match="cannot be removed"):
        remove(tmp_path)
