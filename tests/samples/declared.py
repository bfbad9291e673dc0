"""What every kind of result makes of the numbers that it declares, and a kind with two numbers more."""

from dataclasses import fields
from pathlib import Path

import numpy as np
from numpy.testing import assert_array_equal

from loaded_tca.results.declared import CYCLE, Number
from loaded_tca.results.files import read_dataset

ADDED = {
    "added": Number(("torque",), "MPa", "a number under each torque", label="number added"),
    "added_curve": Number(CYCLE, "mm", "a number at each position", column="added_curve_um"),
}


def with_more_numbers(result):
    """The result as one of a kind that declares ``ADDED`` beside its numbers, with values of them."""

    class Kind(type(result)):
        NUMBERS = type(result).NUMBERS | ADDED

    sizes = result.dataset.sizes
    arrays = {name: result.values(name) for name in result.NUMBERS if result.has(name)}
    arrays["added"] = 100.0 + np.arange(sizes["torque"])
    arrays["added_curve"] = 1e-3 * np.arange(1.0, 1.0 + sizes["torque"] * sizes["position"]).reshape(
        sizes["torque"], -1
    )
    parts = {entry.name: getattr(result, entry.name) for entry in fields(result) if entry.init}
    return Kind(**parts | {"dataset": Kind.dataset_of(arrays, **result.dataset.attrs)})


def assert_declared(result, directory, heads=Number.heads):
    """Every number is in the file with its unit, in summary and figures by its label, in the table by its heads."""
    place = Path(result.save(directory)[0])
    file, table = read_dataset(place), result.to_table()
    figures, summary = result.key_figures(), result.summary().splitlines()
    for name, number in result.NUMBERS.items():
        if not result.has(name):
            continue
        values = np.asarray(getattr(result, name))
        assert_array_equal(values, file[name].values, err_msg=name)
        assert file[name].dims == result.dataset[name].dims
        assert (file[name].attrs["units"], file[name].attrs["long_name"]) == (number.unit, number.text)
        if number.label:
            head = number.head(name)
            assert [row[head] for row in figures] == (number.factor(head) * values).tolist()
            assert any(line.startswith(number.label) for line in summary), name
        for start, braces, _ in (head.partition("{") for head in heads(number, name)):
            assert any(column.startswith(start) if braces else column == start for column in table), name
    return place


def assert_comes_back(result, place):
    """The file has the same numbers, figures, summary, warnings and table."""
    again = type(result).load(place)
    assert again.dataset.equals(result.dataset)
    assert again.summary() == result.summary()
    assert (again.warnings, again.version, again.date) == (result.warnings, result.version, result.date)
    for name, column in result.to_table().items():
        assert_array_equal(again.to_table()[name], column)
    return again
