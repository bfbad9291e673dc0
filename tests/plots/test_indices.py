"""Every picture that takes an index refuses one that its result does not have."""

from functools import partial
from inspect import signature
from types import SimpleNamespace

import numpy as np
import pytest

from loaded_tca import plots
from loaded_tca.errors import InputError
from tests.plots import test_design, test_first_order, test_loaded_vh_check, test_revolution
from tests.samples.pictures import told
from tests.samples.results import result
from tests.samples.tribology import known

CALLED_WITH = {
    "result": lambda: [result("mesh_cycle_spur", positions=3, torques=(40.0, 130.0))],
    "results": lambda: [[result("mesh_cycle_spur", positions=3, torques=(40.0, 130.0))] * 2],
    "sensitivities": lambda: [test_first_order.found()],
    "design": lambda: [test_design.design()],
    "revolution": lambda: [test_revolution.turn()],
}
OWN = {
    "plot_over_flank": lambda: [known(CALLED_WITH["result"]()[0]), "pressure"],
    "plot_half_envelope": lambda: [SimpleNamespace(torque=np.ones(2)), 0],  # no more is looked at before
    "plot_all": lambda: [CALLED_WITH["result"]()[0], "nowhere"],
    "plot_face_load_on_supports": lambda: CALLED_WITH["result"]() * 2,
    "plot_first_order_scatter": lambda: [test_first_order.found(), test_first_order.study()],
    "plot_loaded_vh_check": lambda: [test_loaded_vh_check.study(), dict(enumerate([test_loaded_vh_check.cycle()] * 6))],
    "plot_study_scatter_matrix": lambda: [test_first_order.study(count=9)],
    "plot_study_ranking": lambda: [test_first_order.study(count=9)],
}
INDICES = [
    (name, argument)
    for name in plots.__all__
    if name.startswith("plot_")
    for argument, one in signature(getattr(plots, name)).parameters.items()
    if argument in ("torque", "position") and one.annotation == "int | None"
]


def drawn_with(name):
    plot = getattr(plots, name)
    given = OWN.get(name) or CALLED_WITH[next(iter(signature(plot).parameters))]
    return partial(plot, *given())


@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts that reach edges
@pytest.mark.parametrize(("name", "argument"), INDICES)
@pytest.mark.parametrize("index", [7, -1, 0.5, True])
def test_index_that_the_result_does_not_have_is_told(name, argument, index):
    last = 1 if argument == "torque" else 2
    with pytest.raises(InputError, match=rf"^{argument}: {index} is no index from 0 to {last}$"):
        drawn_with(name)(**{argument: index})


def test_every_index_that_the_result_does_not_have_is_told_at_once():
    with pytest.raises(InputError) as told:
        drawn_with("plot_pressure_map")(position=3, torque=2, column=9)
    names = [problem.split(" is no index from 0 to ")[0] for problem in told.value.problems]
    assert names == ["torque: 2", "position: 3", "column: 9"]


def test_index_of_numpy_is_one():
    assert told(drawn_with("plot_contact_path")(torque=np.int64(0)))


def test_scatter_to_first_order_is_drawn():
    assert plots.png_of(drawn_with("plot_first_order_scatter")())
