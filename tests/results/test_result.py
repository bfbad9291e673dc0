"""The base of results: what is declared of a number once is in attribute, file, summary, figures and table."""

from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import InputError, Revolution, analyse_revolution, load_result, read_scene
from loaded_tca.results.declared import Number
from loaded_tca.results.files import read_dataset, write_dataset
from loaded_tca.tribology.quantities import TORQUE
from loaded_tca.tribology.tribology import Tribology
from tests.samples.declared import assert_comes_back, assert_declared, with_more_numbers
from tests.samples.results import FLANKS_ALONE, SCENES, result
from tests.samples.tribology import known

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")


@cache
def revolution():
    coarse = {"analysis.cells": [12, 16], "analysis.accuracy": None, "analysis.torques_Nm": [20.0, 60.0]}
    turn = {"revolution.pitches": 2, "revolution.positions_per_pitch": 2}
    return analyse_revolution(read_scene(SCENES / "mesh_cycle_spur.toml").with_changes(FLANKS_ALONE | coarse | turn))


def cycle():
    return result("mesh_cycle_spur", positions=9, torques=(40.0, 260.0))


@pytest.mark.parametrize("make", [cycle, revolution])
def test_numbers_are_where_they_are_declared_to_be_and_one_more_is_declared_once(make, tmp_path):
    more = with_more_numbers(make())
    again = assert_comes_back(more, assert_declared(more, tmp_path / "result.nc"))
    assert_allclose(again.to_table()["added_curve_um"], 1.0 + np.arange(again.added_curve.size))  # in micrometres
    assert [row["added_MPa"] for row in again.key_figures()] == [100.0, 101.0]
    (line,) = (line for line in again.summary().splitlines() if line.startswith("number added [MPa]"))
    assert line.split()[-2:] == ["100", "101"]
    make().save(tmp_path / "without.nc")
    with pytest.raises(InputError, match=r"added: missing\nadded_curve: missing"):
        type(more).load(tmp_path / "without.nc")


def of_torques(number, name):
    """Columns of a number in the table of tribology, which has a row for each torque."""
    return [number.head(name)] if number.dims == TORQUE else []


class MoreTribology(Tribology):
    NUMBERS = Tribology.NUMBERS | {
        "added": Number(("torque",), "um", "twice the film", frozenset({"speed"}), label="number added")
    }

    def _found(self, name):
        return 2.0 * self.least_film_thickness[None] if name == "added" else super()._found(name)


def test_numbers_of_tribology_are_where_they_are_declared_to_be(tmp_path):
    tribology = known(cycle())
    more = MoreTribology(tribology.result, tribology.conditions)
    place = assert_declared(
        more, tmp_path / "tribology.nc", lambda number, name: [number.head(name)] * (number.dims == TORQUE)
    )
    file = read_dataset(place)
    assert_allclose(file["added"].values, 2.0 * tribology.least_film_thickness)
    assert file.attrs["warnings"].splitlines() == [*tribology.warnings]
    assert all(f"warning: {sentence}" in tribology.summary() for sentence in tribology.warnings)
    with pytest.raises(InputError, match="tribology, not the result of a mesh cycle; its numbers"):
        load_result(place)


def test_file_of_another_kind_is_named_with_its_reader(tmp_path):
    cycle().save(tmp_path / "result.nc")
    with pytest.raises(InputError, match=r"result\.nc: not a whole revolution; read it with loaded_tca\.load_result"):
        Revolution.load(tmp_path / "result.nc")
    write_dataset(tmp_path / "study.nc", read_dataset(tmp_path / "result.nc").assign_attrs(kind="study"))
    with pytest.raises(InputError, match=r"a study, not a whole revolution; read it with loaded_tca\.studies"):
        Revolution.load(tmp_path / "study.nc")


def test_heads_of_columns_have_the_units_of_tables():
    assert [
        Number(*about).head(name)
        for name, about in {
            "tilt": (("position",), "rad", ""),
            "tilt_angle": (("position",), "rad", ""),
            "torque": (("torque",), "N mm", ""),
            "share": (("torque",), "1", ""),
        }.items()
    ] == ["tilt_arcsec", "tilt_angle_deg", "torque_Nm", "share"]
