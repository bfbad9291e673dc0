"""Every example runs, writes its picture, and one number of it is what physics asks for."""

import ast
import importlib.util
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from loaded_tca import analyse, plots, trace_contact
from loaded_tca.scene import DoubleHelicalScene, read_scene
from loaded_tca.studies import DesignModel, load_design, load_study, read_study
from tests.samples.root_stress import coarsely

EXAMPLES = Path(__file__).parents[1] / "examples"

EXPECTED = {
    "plot_pressure_distribution": (1.0, 1e-10),  # the map carries the load: equilibrium
    "plot_subsurface_stress": (1.0, 5e-3),  # the shear of Hertz's ellipse, on 48 cells and 31 depths
    "plot_contact_from_arrays": (1.018, 2e-3),  # the profile takes load off the ends and gives it to the middle
    "plot_convergence_of_methods": (100.0, 1e-9),  # every start finds the contact
    "plot_misalignment_sensitivity": (-1.0, 0.02),  # shift of the contact over f/(2 c1): first order
    "plot_contact_pattern": (1.0, 2e-3),  # area of the pattern over that of the curvature ellipse
    "plot_hertz_comparison": (1.0, 2e-3),  # peak over that of Hertz, on 49 cells
    "plot_bevel_pressure": (1.0, 1e-2),  # peak over that of Hertz: the flanks bend a little over the ellipse
    "plot_transmission_error": (2.0 / 3.0, 5e-3),  # approach of a Hertz contact under growing load
    "plot_load_sharing": (1.0, 1e-3),  # half a pitch before and behind: the two pairs of one position
    "plot_revolution": (1.0, 1e-4),  # an eccentric wheel turns as far as its axis is off, loaded as unloaded
    "plot_drive_stage": (1.0, 2e-3),  # bearings carry what the teeth press, whose normals lie 2 deg about one another
    "plot_rolling_bearings": (1.0, 1e-3),  # all forces of rollers are radial, and linear near the mean load
    "plot_planetary_stage": (1.0, 1e-9),  # a sun that floats among three planets is pressed evenly
    "plot_double_helical": (1.0, 5e-3),  # the pinion follows the apex; faces are analysed where it stands
    "plot_bevel_blank": (1.165, 2.5e-3),  # printed of virtual gears; of these flanks 1.1631
    "plot_local_synthesis": (1.0, 1e-3),  # motion curve asked for, by differences that leave a fourth derivative
    "plot_tribology": (1.0, 1e-9),  # torques of friction do the friction power
    "plot_root_stress": (1.0, 1e-3),  # a pitch further the mesh is the same
    "plot_loaded_transmission_error": (1.0, 1e-3),  # a pitch further the mesh is the same
    "plot_comparison": (1.0, 5e-3),  # opposite errors mirror each other, on grids of 24 x 32 cells
    "plot_against_finite_elements": (1.0, 3e-2),  # plane strain has no free ends: 2 % stiffer
    "plot_ease_off": (1.0, 1e-3),  # the crownings of both gears add up, to first order
    "plot_vh_check": (-1.0, 0.03),  # shifts under opposite errors: first order
    "plot_vh_under_load": (-1.0, 0.03),  # shifts under opposite errors: first order
    "plot_hypoid_pair": (1.0, 1e-7),  # levers where P is held have the ratio of the teeth
    "plot_sensitivities": (1.0, 2e-3),  # the line of action turns the centre distance into sin(alpha_wt) of it
    "plot_monte_carlo": (1.0, 0.03),  # either sign of misalignment gathers the load; positions at 1 % of accuracy
    "plot_micro_geometry": (1.0, 1e-12),  # every step of crowning
    "plot_tip_relief_and_rounding": (-1.0 / 3.0, 0.01),  # the power of the radius: a pressed part much smaller than it
    "plot_teeth_in_mesh": (1.0, 1e-12),  # the wheel reaches beyond T1, and the path ends at the pinion's tip
    "plot_tooth_3d": (1.0, 5e-3),  # the pressure laid on the flank carries the load
    "plot_measured_settings": (1.0, 0.02),  # the error that was made, with three standard deviations by noise
    "plot_bidirectional_start": (1.0, 1e-7),  # five equations and ease-off find the same contact
}

QUICK = (
    "plot_subsurface_stress",
    "plot_bevel_pressure",
    "plot_ease_off",
    "plot_measured_settings",
    "plot_teeth_in_mesh",
)
"""Of half a second. The others are analyses and pictures that the tests of their folders have on fewer cells."""

ON_A_GRID = {"analysis.compliance": "contact", "analysis.cells": [12, 16], "analysis.accuracy": None}
A_WHOLE_TURN = {"revolution.positions_per_pitch": 4, "revolution.pitches": 24}
SHORTER = {
    "plot_tip_relief_and_rounding": {"RELIEFS": lambda _: [0.0, 12.0], "SCENE": lambda scene: few(scene, 3)},
    "plot_rolling_bearings": {
        "CHANGES": lambda _: {
            "analysis.positions": 3,
            "analysis.compliance": "contact",
            "analysis.torques_Nm": [40.0, 130.0],
        }
    },
    "plot_drive_stage": {
        "CHANGES": lambda all_: {**all_, **ON_A_GRID, "analysis.positions": 3, "analysis.torques_Nm": [250.0]}
    },
    "plot_double_helical": {"CHANGES": lambda all_: {**all_, **ON_A_GRID, "analysis.positions": 2}},
    "plot_revolution": {"CHANGES": lambda all_: {**all_, **ON_A_GRID, **A_WHOLE_TURN, "analysis.torques_Nm": [120.0]}},
    "export_to_dynamics": {"SPEEDS": lambda _: np.linspace(0.3, 0.7, 33), "PHASES": lambda _: np.linspace(20, 24, 257)},
}
"""Values, made of the example's own, without the analyses and times that its number does not depend on."""


def few(scene, positions):
    return scene.with_changes({"analysis.positions": positions})


def loaded(path):
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def shortened(name, monkeypatch):
    example = loaded(EXAMPLES / f"{name}.py")
    for variable, value in SHORTER.get(name, {}).items():
        monkeypatch.setattr(example, variable, value(getattr(example, variable)))
    return example


@pytest.fixture
def _coarse_roots():
    """Models of root stress are coarse: a pitch further they are the same, and every kind of picture is drawn."""
    with coarsely():
        yield


@pytest.mark.usefixtures("_coarse_roots")
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # some show contacts that reach an edge
@pytest.mark.quick_cases(*QUICK)
@pytest.mark.parametrize("name", EXPECTED)
def test_example_gives_its_number_and_its_picture(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    number, tolerance = EXPECTED[name]
    assert shortened(name, monkeypatch).main() == pytest.approx(number, abs=tolerance)
    assert [path.name for path in tmp_path.iterdir()] == [f"{name.removeprefix('plot_')}.png"]


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts that reach an edge
def test_explored_pair_has_pages_that_carry_their_script(tmp_path, monkeypatch):
    """Plotly's own is 4.8 MB; a page is 8 MB at most."""
    monkeypatch.chdir(tmp_path)
    assert 4.8 < shortened("explore_result", monkeypatch).main() < 8.0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["explore_result.html", "explore_study.html"]


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts that reach an edge
def test_second_order_of_the_tooth_mesh_has_its_resonance_at_half_the_speed(tmp_path, monkeypatch):
    """Its frequency is twice that of the mesh; a thirtieth aside: the stiffness varies, and the speeds have steps."""
    monkeypatch.chdir(tmp_path)
    assert shortened("export_to_dynamics", monkeypatch).main() == pytest.approx(0.5, abs=0.03)
    names = ["dynamics.csv", "dynamics_orders.csv", "export_to_dynamics.png"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names


@pytest.mark.thorough
@pytest.mark.usefixtures("_coarse_roots", "blank_pictures")
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts that reach an edge
def test_pages_of_pictures_have_every_kind(tmp_path, monkeypatch):
    """Those of studies have the name of their figure behind their own. The tests of each kind draw it."""
    monkeypatch.chdir(tmp_path)
    coarse = {"analysis.cells": (8, 12)}
    example, studies = loaded(EXAMPLES / "plot_all_pictures.py"), loaded(EXAMPLES / "plot_all_study_pictures.py")
    monkeypatch.setattr(example, "HELICAL", example.HELICAL.with_changes(example.FEW | coarse))
    monkeypatch.setattr(example, "BEVEL", example.BEVEL.with_changes(coarse | {"analysis.positions": 3}))
    monkeypatch.setattr(example, "FEW", example.FEW | coarse)
    monkeypatch.setattr(studies, "HELICAL", studies.HELICAL.with_changes(coarse))
    monkeypatch.setattr(studies, "DesignModel", partial(studies.DesignModel, cells=(8, 12)))
    example.main()
    studies.main()
    drawn = {re.sub("^(study_.*?)_(peak_pressure|transmission_error).*", r"\1", path.stem) for path in Path().iterdir()}
    several = {"all", "solution", "study", "subsurface"}  # of arrays: the bare solver, and stress_below
    kinds = {name.removeprefix("plot_") for name in plots.__all__ if name.startswith("plot_")} - several
    assert kinds - drawn == set()


@pytest.mark.thorough
def test_study_on_a_cluster_follows_hertz(tmp_path, monkeypatch):
    """Eight times the load: twice the pressure. Workers are threads; studies on processes are tests of engines."""
    monkeypatch.chdir(tmp_path)
    example = loaded(EXAMPLES / "study_on_dask.py")
    monkeypatch.setattr(example, "LocalCluster", partial(example.LocalCluster, processes=False))
    assert example.main() == pytest.approx(2.0, abs=5e-3)  # the flanks bend a little
    assert (load_study("study_on_dask.nc")["status"] == "ok").all()


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts that reach an edge
@pytest.mark.parametrize(("name", "quieter"), [("design_helical", 0.76), ("design_bevel", 0.61)])
def test_designed_pair_is_quieter(name, quieter, tmp_path, monkeypatch):
    """By the whole analysis, on average and in its scatter; bounds 2 to 4 % above what four steps end at."""
    monkeypatch.setattr("loaded_tca.studies.design.MOST_ITERATIONS", 4)
    monkeypatch.chdir(tmp_path)
    example = loaded(EXAMPLES / f"{name}.py")
    two_samples = lambda *model, **options: DesignModel(*model, **options | {"samples": 2})  # noqa: E731
    monkeypatch.setattr(example, "DesignModel", two_samples)
    result, scene = example.main(), example.SCENE
    before, after = result.objective
    assert load_design(f"{name}.nc").objective == (before, after)
    found = result.dataset
    spans = 1e3 * scene.pair().base_radii[1] * np.ptp(found["transmission_error"].values[..., :-1], axis=-1)
    by_sample = spans.mean(axis=-1)
    plain = by_sample.mean(axis=1) + by_sample.std(axis=1)
    # smooth spans are larger by up to 0.02 um ln 4, and scatter otherwise by half as much
    assert ((np.array([before, after]) - plain > -0.014) & (np.array([before, after]) - plain < 0.042)).all()
    assert after < quieter * before
    assert plain[1] < quieter * plain[0]
    deviation = dict(zip(example.SCATTER, found["scatter"].values[-1].tolist(), strict=True))
    torques = {"analysis.torques_Nm": (1e-3 * found["torque"].values).tolist()}
    error = analyse(scene.with_changes({**result.optimum, **deviation, **torques})).transmission_error
    assert_allclose(found["transmission_error"].sel(design="optimum").values[-1], error, rtol=1e-6)


CELL = "\n# %%\n"
"""Begin of a cell of a notebook."""
OF_CLIENTS = "dynamics_with_"
"""Models of other programs, made of many parts; they run in tests/test_clients.py, and the gallery only shows them."""


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::loaded_tca.errors.AccuracyWarning")  # contacts that reach an edge
def test_notebook_shows_cards_and_a_frame_below_its_cells(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names, shown = {}, []
    for cell in (EXAMPLES / "plot_notebook.py").read_text(encoding="utf-8").split(CELL):
        *body, last = ast.parse(cell).body
        exec(compile(ast.Module(body, []), "cell", "exec"), names)
        if not isinstance(last, ast.Expr):
            exec(compile(ast.Module([last], []), "cell", "exec"), names)
        elif (value := eval(compile(ast.Expression(last.value), "cell", "eval"), names)) is not None:
            shown.append(value._repr_html_())
    assert ["ltca" in html for html in shown] == [True, True, False, True]
    assert all("<table" in html for html in shown)
    assert {"notebook.png"} <= {path.name for path in tmp_path.iterdir()} <= {"notebook.png", "notebook.xlsx"}


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.stem)
def test_example_is_short_and_has_its_scenes(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) < (90 if path.stem.startswith(OF_CLIENTS) else 60)
    if CELL in text:
        return  # a notebook, which has no main, and runs when it is loaded
    assert callable(loaded(path).main)  # every name that it imports is there, every scene that it reads is sound


@pytest.mark.parametrize("path", sorted((EXAMPLES / "scenes").glob("*.toml")), ids=lambda path: path.stem)
def test_example_scene_is_sound(path):
    scene = read_scene(path)
    pairs = scene.halves if isinstance(scene, DoubleHelicalScene) else (scene.pair(),)
    assert all(pair.pitch > 0.0 for pair in pairs)


@pytest.mark.parametrize(
    ("name", "example"), [("misalignment", "plot_monte_carlo"), ("micro_geometry", "plot_micro_geometry")]
)
def test_example_study_is_that_of_its_script(name, example):
    read, made = read_study(EXAMPLES / "studies" / f"{name}.toml"), loaded(EXAMPLES / f"{example}.py").STUDY
    assert read.scene == made.scene
    assert [read.changes(k) for k in range(len(read))] == [made.changes(k) for k in range(len(made))]


@pytest.mark.thorough
def test_measured_flank_is_what_its_script_makes():
    stored = (EXAMPLES / "scenes" / "measured_flank.csv").read_text(encoding="utf-8")
    made = loaded(EXAMPLES / "make_measured_flank.py").main()
    numbers = [
        np.array([[float(cell) for cell in line.split(",")] for line in text.splitlines()[5:]])
        for text in (stored, made)
    ]
    assert stored.splitlines()[:5] == made.splitlines()[:5]
    assert_allclose(*numbers, rtol=0, atol=0.011)  # one unit of the last digit written


def test_other_files_of_measured_flanks_are_what_their_examples_write():
    lines, settings = (loaded(EXAMPLES / f"{name}.py") for name in ("make_measured_lines", "plot_measured_settings"))
    made = {
        "measured_lines": lines.main(),
        **{f"duplex_wheel_{side}": settings.measure(side) for side in settings.FLANKS},
    }
    for name, text in made.items():
        stored = (EXAMPLES / "scenes" / f"{name}.csv").read_text(encoding="utf-8")
        numbers = [[float(row.rpartition(",")[2]) for row in each.splitlines()[5:]] for each in (stored, text)]
        assert_allclose(*numbers, rtol=0, atol=0.011, err_msg=name)  # one unit of the last digit written


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_bspline_example_is_the_pair_of_its_equations(gear):
    fitted = read_scene(EXAMPLES / "scenes" / "bspline_bevel.toml")
    exact = fitted.with_changes({f"{gear}.flank": None})
    errors = [trace_contact(scene.pair(), [-0.1, 0.0, 0.1]).transmission_error for scene in (fitted, exact)]
    assert_allclose(*errors, rtol=0, atol=1e-10)


def test_measured_example_touches_on_the_side_of_its_slope():
    """Crowning of 8 um with a slope of 2 um: the most material lies at 1/16 of half the face, towards z > 0."""
    path = trace_contact(read_scene(EXAMPLES / "scenes" / "measured_flank.toml").pair(), [0.0])
    assert not path.on_edge.any()
    assert 0.0 < path.pinion_axial[0] < 4.0


PARTS = np.array([-0.5, 0.0, 0.5])  # of a pitch


def traced(name, angles):
    pair = read_scene(EXAMPLES / "scenes" / f"{name}.toml").pair()
    return pair, trace_contact(pair, np.atleast_1d(angles), warn=False)


def test_published_face_milled_example_scrapes_along_a_tip():
    """Two thirds of the pitch."""
    _, path = traced("face_milled_19x62", np.radians(np.linspace(-9.47, 9.47, 13)))
    assert 0.6 < path.on_edge.mean() < 0.75


@pytest.mark.parametrize(
    ("name", "top", "fall"),
    [
        ("face_milled_19x62_matched", 0.0, [-6.018, -5.711]),
        ("duplex_30x20_mended", 5.99083, [-12.29, -12.50]),
    ],
)
def test_matched_face_milled_examples_have_the_transmission_error_they_say(name, top, fall):
    """References: pair B by the five equations and the ease-off; pair D of the duplex paper."""
    pair, _ = traced(name, 0.0)
    path = trace_contact(pair, np.radians(top) + PARTS * pair.pitch)
    error = np.degrees(path.transmission_error) * 3600.0
    assert_allclose(error[[0, 2]] - error[1], fall, atol=6e-3)  # two decimals are printed
    assert not path.on_edge.any()


def test_duplex_example_first_touches_in_the_corner_of_toe_and_tip():
    """The largest transmission error of one tooth pair: the first touch of all."""
    pair, path = traced("duplex_30x20", np.radians(np.linspace(0.0, 30.0, 31)))
    first = path[int(np.nanargmax(path.transmission_error))]
    lengthwise, _ = pair.pinion.flank.frame.to_picture(np.array(first.pinion_radius), np.array(first.pinion_axial))
    assert_allclose(lengthwise, -10.0, atol=1e-6)
    tip = pair.pinion.flank.edges(np.array(first.pinion_radius), np.array(first.pinion_axial))[0]
    assert tip.value < 0.2
