"""Directories of something else than a result: what they hold is said, and what to give instead."""

import pytest

from loaded_tca.cli import main

HELD = {
    "tribology.nc": "holds only tribology",
    "comparison.json": "holds a comparison of results, which this command does not take",
    "rigid/result.nc": "holds results in rigid; give one of them: {}/rigid",
}


@pytest.mark.parametrize("command", ["report", "tribology", "plot", "dynamics", "sensitivities"])
@pytest.mark.parametrize("name", HELD)
def test_directory_of_something_else_is_told(command, name, tmp_path, capsys):
    file = tmp_path / name
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(b"")
    assert main([command, str(tmp_path)]) == 2
    assert HELD[name].format(tmp_path) in capsys.readouterr().err


@pytest.mark.parametrize("command", ["tribology", "plot", "sensitivities"])
def test_directory_of_a_revolution_is_told_with_the_commands_that_take_it(command, tmp_path, capsys):
    (tmp_path / "revolution.nc").write_bytes(b"")
    assert main([command, str(tmp_path)]) == 2
    told = "holds a whole revolution, which this command does not take; allowed in 'loaded-tca report DIR' and "
    assert told in capsys.readouterr().err


def test_directory_without_anything_is_told_as_before(tmp_path, capsys):
    assert main(["report", str(tmp_path)]) == 2
    assert "result.nc: cannot be read" in capsys.readouterr().err
