import importlib
import os
import re
import tracemalloc

import numpy as np
import pytest
import xarray
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from loaded_tca import load_result
from loaded_tca.errors import InputError
from loaded_tca.results.files import (
    DESIGN,
    DOUBLE_HELICAL,
    FORMAT_VERSION,
    HALVES_OVER_TURNS,
    KINDS,
    REVOLUTION,
    STAGE,
    STUDY,
    arrays_of,
    netcdf_of,
    read_dataset,
    remove,
    replace_together,
    replacing,
    variables_of,
    write_dataset,
)
from tests.refusals import refused_calls

PARTS = {
    "numbers": (("row", "column"), "mm", "some lengths"),
    "flags": (("row",), "1", "some flags"),
    "counts": (("row",), "1", "some counts"),
    "scalar": ((), "MPa", "a scalar"),
}
ARRAYS = {
    "numbers": np.array([[1.5, np.inf], [np.nan, -0.0]]),
    "flags": np.array([True, False]),
    "counts": np.array([-3, 7]),
    "scalar": np.array(2.5),
}


def dataset(**attributes):
    return xarray.Dataset(variables_of(PARTS, ARRAYS), attrs=attributes)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "result.nc"


def problem(path):
    with pytest.raises(InputError) as caught:
        read_dataset(path)
    (message,) = caught.value.problems
    return message


def test_variables_survive_with_their_types(path):
    write_dataset(path, dataset())
    found = read_dataset(path)
    arrays = arrays_of(found, PARTS)
    assert set(found.variables) == set(arrays) == set(ARRAYS)
    for name, (dimensions, unit, text) in PARTS.items():
        assert_array_equal(arrays[name], ARRAYS[name], strict=True)
        assert found[name].dims == dimensions
        assert found[name].attrs == {"units": unit, "long_name": text}


@given(text=st.text(st.characters(blacklist_characters="\0", blacklist_categories=["Cs"])))
def test_texts_survive_in_any_script(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("texts") / "a.nc"
    write_dataset(path, xarray.Dataset(attrs={"title": text}))
    assert read_dataset(path).attrs == {"title": text}


def test_every_variable_has_units_and_long_name_for_other_readers(path):
    from scipy.io import netcdf_file

    write_dataset(path, dataset(title="Räder"))
    with netcdf_file(path, mmap=False) as file:
        assert file.variables["numbers"].units == b"mm"
        assert all(variable.long_name for variable in file.variables.values())
        assert file.title.decode() == "Räder"


def test_file_is_closed_after_reading(path):
    write_dataset(path, dataset())
    arrays = arrays_of(read_dataset(path), PARTS)
    path.unlink()
    assert isinstance(arrays["numbers"], np.ndarray)
    assert arrays["numbers"].flags.writeable


def test_bytes_are_those_of_the_file(path):
    write_dataset(path, dataset(title="whole"))
    assert path.read_bytes() == netcdf_of(dataset(title="whole"))


@pytest.mark.parametrize("portion", [1, 25, 64, 1000])
def test_digest_is_the_same_wherever_portions_of_the_file_end(path, portion, monkeypatch):
    content = netcdf_of(dataset(title="whole"))
    monkeypatch.setattr("loaded_tca.results.files.PORTION", portion)
    assert netcdf_of(dataset(title="whole")) == content
    path.write_bytes(content)
    assert read_dataset(path).equals(dataset())


def test_reading_takes_no_more_memory_than_the_result(path):
    """Four megabytes of numbers and a sixteenth of them for the variable that is being decoded."""
    count, rows = 32, 2**14
    numbers = {f"number_{column}": ("row", np.full(rows, float(column))) for column in range(count)}
    write_dataset(path, xarray.Dataset(numbers))
    read_dataset(path)  # what is imported and kept by the way
    tracemalloc.start()
    try:
        found = read_dataset(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert found["number_31"][-1] == 31.0
    assert peak < 1.5 * found.nbytes  # the file beside the arrays would be twice as much


def test_texts_that_are_alike_are_one_object(path):
    texts = ["ok", "Zähne", "ok", "", "Zähne", ""] * 3
    write_dataset(path, xarray.Dataset({"status": ("row", np.array(texts, dtype=object))}))
    found = read_dataset(path)["status"].values
    assert found.tolist() == texts
    assert len({*map(id, found)}) == len({*texts})


def test_writing_leaves_one_file_alone(path):
    write_dataset(path, dataset())
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


@pytest.mark.parametrize(
    ("addition", "name"),
    [
        ({"wrong": ("row", np.array([2**40, 0]))}, "wrong"),
        ({"wrong": ("row", np.array([1j, 0]))}, "wrong"),
        ({"wrong": ("row", np.array([{}, None], dtype=object))}, "wrong"),
        ({"wrong": ("row", np.zeros(2), {"units": None})}, "wrong"),
        ({"": ("row", np.zeros(2))}, ""),
        ({3: ("row", np.zeros(2))}, "3"),
    ],
)
def test_variable_that_netcdf_cannot_hold_is_told_and_leaves_no_file(path, addition, name):
    with pytest.raises(InputError) as caught:
        write_dataset(path, dataset().assign(addition))
    assert len(caught.value.problems) == 1
    assert caught.value.problems[0].startswith(f"{name}: cannot be stored in a NetCDF-3 file: ")
    assert not os.listdir(path.parent)


def test_full_disk_is_told(path):
    with pytest.raises(InputError, match=r"cannot be written: No space left"), replacing(path):
        raise OSError(28, "No space left on device")
    assert not os.listdir(path.parent)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="a system without named pipes")
@pytest.mark.parametrize("linked", [False, True])
def test_pipe_is_not_replaced(tmp_path, linked):
    """Nor a device, which is no regular file either, or a link to one."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    target = tmp_path / "link" if linked else pipe
    if linked:
        target.symlink_to(pipe)
    with pytest.raises(InputError, match="cannot be written: not a regular file"):
        write_dataset(target, dataset())
    assert pipe.is_fifo()
    assert target.is_symlink() == linked
    assert len(os.listdir(tmp_path)) == 1 + linked


def test_directory_is_not_replaced(tmp_path):
    (tmp_path / "there").mkdir()
    with pytest.raises(InputError, match="there: cannot be written: a directory; give the name of a file"):
        replace_together(tmp_path, {"a.txt": b"a", "there": b"b"})
    assert os.listdir(tmp_path) == ["there"]


def test_link_to_a_file_is_replaced_and_the_file_is_kept(tmp_path):
    (tmp_path / "old").write_text("old")
    (tmp_path / "link").symlink_to("old")
    replace_together(tmp_path, {"link": b"new"})
    assert (tmp_path / "old").read_text() == "old"
    assert (tmp_path / "link").read_text() == "new"


def test_missing_file_is_told(path):
    assert problem(path) == f"{path}: cannot be read: No such file or directory"


def test_directory_instead_of_file_is_told(tmp_path):
    assert problem(tmp_path) == f"{tmp_path}: a directory; name the result file in it, as {tmp_path}/result.nc"


@pytest.mark.parametrize("content", [b"", b"torque = 3\n", b"\x89HDF\r\n\x1a\n", b"\xff" * 100])
def test_other_file_is_told(path, content):
    path.write_bytes(content)
    assert "not a NetCDF-3 file; expected a result file written by loaded_tca" in problem(path)


def test_truncated_file_is_told_wherever_it_ends(path):
    write_dataset(path, dataset(title="whole"))
    content = path.read_bytes()
    for length in range(4, len(content) - 4, 7):
        path.write_bytes(content[:length])
        assert str(path) in problem(path)


@pytest.mark.parametrize("bit", [1, 128])
def test_every_changed_byte_is_told(path, bit):
    write_dataset(path, dataset(title="whole"))
    content = bytearray(path.read_bytes())
    for position in range(len(content)):
        content[position] ^= bit
        path.write_bytes(content)
        with pytest.raises(InputError, match=r"damaged|not a NetCDF-3 file"):
            read_dataset(path)
        content[position] ^= bit


@pytest.mark.parametrize("change", [lambda content: content + b"\0", lambda content: content[:-4]])
def test_bytes_more_or_less_are_told(path, change):
    write_dataset(path, dataset(title="whole"))
    path.write_bytes(change(path.read_bytes()))
    assert "damaged: its bytes are not those that loaded_tca wrote" in problem(path)


def test_file_without_its_digest_is_told(path):
    marks = {"format": "loaded_tca", "format_version": str(FORMAT_VERSION)}
    dataset(**marks).to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")
    assert "damaged: it has no digest of its bytes" in problem(path)


def test_file_of_the_format_before_digests_is_told_as_such(path):
    dataset(format="loaded_tca", format_version="3").to_netcdf(path, engine="scipy", format="NETCDF3_64BIT")
    assert "written in format 3 by an earlier loaded_tca" in problem(path)


def test_netcdf_file_of_another_program_is_told(path):
    dataset().to_netcdf(path, engine="scipy")
    assert problem(path) == f"{path}: a NetCDF-3 file, but not a result of loaded_tca"


@pytest.mark.parametrize(("step", "age"), [(1, "a later"), (-1, "an earlier")])
def test_file_of_another_format_is_told(path, step, age, monkeypatch):
    other = FORMAT_VERSION + step
    monkeypatch.setattr("loaded_tca.results.files.FORMAT_VERSION", other)
    write_dataset(path, dataset())
    monkeypatch.undo()
    assert f"written in format {other} by {age} loaded_tca; this one reads format {FORMAT_VERSION}" in problem(path)
    assert "run the scene again" in problem(path)


@pytest.mark.parametrize("failure", [KeyboardInterrupt(), OSError(28, "No space left on device")])
def test_files_written_together_are_all_new_or_all_old(tmp_path, monkeypatch, failure):
    old = {"a.nc": b"old", "b.csv": b"old", "picture.png": b"old"}
    for name, content in old.items():
        (tmp_path / name).write_bytes(content)
    write = type(tmp_path).write_bytes

    def fail_at_the_second(path, content):
        write(path, content[:1])
        if "b.csv" in path.name:
            raise failure

    new = {"a.nc": b"new", "b.csv": b"new"}
    with monkeypatch.context() as patch:
        patch.setattr(type(tmp_path), "write_bytes", fail_at_the_second)
        with pytest.raises((KeyboardInterrupt, InputError)) as caught:
            replace_together(tmp_path, new, ["picture.png"])
    if isinstance(failure, OSError):
        assert str(caught.value) == f"{tmp_path / 'b.csv'}: cannot be written: No space left on device"
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == old
    assert replace_together(tmp_path, new, ["picture.png", "absent.png"]) == tuple(tmp_path / name for name in new)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == new


def test_removing_a_file_needs_none_to_be_there(tmp_path):
    (tmp_path / "old.png").write_bytes(b"old")
    for _ in range(2):
        remove(tmp_path / "old.png")
    assert list(tmp_path.iterdir()) == []


DESCRIBED = {"numbers": (("row",), "mm", ""), "absent": ((), "1", ""), "flags": (("row",), "1", "")}

test_files_refuse = refused_calls(
    (
        lambda value, path: write_dataset(path, dataset(right=1.0, wrong=value)),
        ("^attribute wrong: cannot be stored",),
        [None, {}, [1, "a"], 1j, 2**40, "\ud800"],
    ),
    (
        lambda tmp_path: write_dataset(tmp_path / "absent" / "result.nc", dataset()),
        r"absent.result\.nc: cannot be written: No such file or directory",
    ),
    (
        lambda: arrays_of(dataset().assign(flags=("row", ["a", "b"])), DESCRIBED),
        (
            r"^numbers: found dimensions \('row', 'column'\), expected \('row',\)$",
            "^absent: missing$",
            "^flags: no numbers$",
        ),
    ),
    (lambda tmp_path: remove(tmp_path), "cannot be removed"),
)


@pytest.mark.parametrize("kind", [REVOLUTION, STAGE, DOUBLE_HELICAL, HALVES_OVER_TURNS, STUDY, DESIGN])
def test_file_of_another_kind_is_refused_with_the_call_that_reads_it(kind, tmp_path):
    write_dataset(tmp_path / "other.nc", xarray.Dataset(attrs={"kind": kind}))
    with pytest.raises(InputError, match=re.escape(KINDS[kind][0])) as refused:
        load_result(tmp_path / "other.nc")
    (package, *names), *others = re.findall(r"(loaded_tca(?:\.[a-z_]+)?)\.([A-Z]\w*)?\.?(load\w*)", str(refused.value))
    assert not others
    read = importlib.import_module(package)
    for name in filter(None, names):
        read = getattr(read, name)
    assert callable(read)
