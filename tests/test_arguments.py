"""What public functions do with arrays, numbers, text and units as people have them."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
from fractions import Fraction
from functools import cached_property

import numpy as np
import pytest

import loaded_tca
from loaded_tca import AccuracyWarning, InputError, analyse, load_result, parse_scene, solve_contact, trace_contact
from loaded_tca.arguments import checked, kind_of, units_of
from loaded_tca.arrays import numbers, real
from loaded_tca.contact import ContactProblem, subsurface_stress
from loaded_tca.errors import PACKAGE, give_accuracy_warning
from loaded_tca.flanks import MeasuredDeviations, MeasuredPoints
from loaded_tca.reference import friction, hertz, iso6336, iso6336_22, weber_banaschek
from loaded_tca.supports import ShaftLoad
from loaded_tca.tribology import Lubricant
from loaded_tca.units import conversion
from tests.refusals import refusals

MADE_BY_THE_PACKAGE = {
    "Comparison", "ContactArea", "ContactPath", "ContactPattern", "ContactPoint", "ContactSolution", "DynamicFactor",
    "EaseOffMap", "FilletCurve", "FlankFactors", "GradedSolution", "MeshPath", "PressureMap", "RelativeCurvature",
    "RootFactors", "RootStressMap", "Separation", "Spectrum", "SubsurfaceStress", "ToothSurface", "VHCheck",
}  # fmt: skip
"""Results, whose constructors nobody else calls."""
ARRAYS = ("ArrayLike", "Array")
PATHS = ("FilePath", "str | os.PathLike[str]", "str | PathLike[str]")


class Quantity:
    """Numbers with a unit, as astropy has them: their array is without it."""

    def __init__(self, values, unit):
        self.values, self.unit = np.asarray(values), unit
        self.ndim = self.values.ndim

    def __array__(self, dtype=None, copy=None):
        return self.values


class Labelled(Quantity):
    """Numbers with a unit, as xarray has them."""

    def __init__(self, values, unit):
        super().__init__(values, None)
        self.data, self.attrs = self.values, {"units": unit}

    def item(self):
        return self.values.item()


class Pint(Quantity):
    """Numbers with a unit, as pint has them: turned into an array, they warn."""

    def __init__(self, values, unit):
        super().__init__(values, None)
        self.magnitude, self.units = self.values, unit

    def __array__(self, dtype=None, copy=None):
        raise AssertionError("the unit is stripped")


def public_callables():
    """Every public function, constructor and method, by name, each with what has its docstring."""
    folders = [f"loaded_tca.{info.name}" for info in pkgutil.iter_modules(loaded_tca.__path__) if info.ispkg]
    for package in map(importlib.import_module, ("loaded_tca", *folders)):
        for name in getattr(package, "__all__", ()):
            public = getattr(package, name)
            inside = vars(public).values() if inspect.ismodule(public) else (public,)
            for one in inside:
                if not str(getattr(one, "__module__", "")).startswith("loaded_tca") or getattr(
                    one, "__name__", "_"
                ).startswith("_"):
                    continue
                if not inspect.isclass(one):
                    yield one.__qualname__, one, one
                elif not issubclass(one, Exception) and not getattr(one, "_is_protocol", False):
                    if dataclasses.is_dataclass(one) and one.__name__ not in MADE_BY_THE_PACKAGE:
                        yield one.__qualname__, one.__init__, one
                    for entry, member in vars(one).items():
                        function = getattr(member, "__func__", member)
                        if inspect.isfunction(function) and not entry.startswith("_"):
                            yield function.__qualname__, function, function


def parameters(kinds):
    """Public parameters of these kinds: name of the callable, the callable, the parameter."""
    return [
        (name, function, parameter)
        for name, function, _ in public_callables()
        if not getattr(function, "__isabstractmethod__", False)
        for parameter, annotation in inspect.unwrap(function).__annotations__.items()
        if parameter != "return" and kind_of(annotation) in kinds
    ]


def unnamed(kinds, bad):
    """Those that do not refuse a value by the name of the argument."""
    wrong = []
    for name, function, parameter in parameters(kinds):
        try:
            function(*(() if "." not in name else (object(),)), **{parameter: bad})
        except InputError as error:
            if str(error).startswith(f"{parameter}: "):
                continue
        except Exception:
            pass
        wrong.append(f"{name}({parameter})")
    return wrong


@pytest.mark.parametrize(
    "bad",
    [
        np.ma.masked_less(np.eye(2), 0.5),
        [[1.0, np.ma.masked], [1.0, 2.0]],
        Quantity(np.eye(2), "furlong"),
        Labelled(np.eye(2), "mm furlong"),
        np.eye(2) + 0j,
        np.array([["1.0", "2.0"]]),
        np.array([[1.0, None]]),
        np.array([np.datetime64("2024-06-07")]),
        "1.0",
        object(),
    ],
    ids=["masked", "masked cell", "unit", "unit of attributes", "complex", "text", "None", "dates", "string", "object"],
)
def test_arrays_that_are_no_plain_numbers_are_refused_by_every_public_function(bad):
    assert unnamed(ARRAYS, bad) == []


@pytest.mark.parametrize("bad", [3, None, b"result.nc", np.zeros(2)])
def test_paths_that_are_none_are_refused_by_every_public_function(bad):
    optional = {"parse_scene(folder)", "parse_stage(folder)", "run_study(out)"}
    assert set(unnamed(PATHS, bad)) == (optional if bad is None else set())


def repr_of(value):
    return f"{value!r:.20}"


@pytest.mark.parametrize(
    "bad", ["1.0", None, 1j, [1.0], np.ma.masked, Quantity(1.0, "furlong"), True, 10**400], ids=repr_of
)
def test_numbers_that_are_none_are_refused_by_every_closed_form(bad):
    wrong = {one for one in unnamed(("float",), bad) if one.split("(")[0] in CLOSED_FORMS}
    optional = {
        "slip_layer(strength)",
        "static_notch_factor(strength)",
        "named_material(hardness)",
        "tip_section(effective_pressure_angle)",
    }
    assert wrong == (optional if bad is None else set())


CLOSED_FORMS = {
    one.__qualname__
    for name in loaded_tca.reference.__all__
    for one in vars(getattr(loaded_tca.reference, name)).values()
    if inspect.isfunction(one) and not one.__name__.startswith("_") and one.__module__ != "loaded_tca.plain"
}


def test_every_unit_of_an_argument_can_be_read_or_is_of_several():
    """Else the quantities of everybody would be refused: mixed units and powers that are not whole are."""
    units = {
        unit
        for _, function, documented in public_callables()
        if hasattr(function, "__wrapped__")
        for parameter, unit in units_of(documented).items()
        if unit and kind_of(inspect.unwrap(function).__annotations__.get(parameter))
    }
    unread = {unit for unit in units if conversion(unit, unit) != 1.0}
    assert {unit for unit in unread if ", " not in unit and "^" not in unit} == set()
    assert {"mm", "N", "MPa", "rad", "C", "N/mm", "1/mm", "m/s", "mPa s"} <= units - unread


SPACING = (0.6 / 23, 0.6 / 23)
GAP = np.add.outer(np.linspace(-0.3, 0.3, 24) ** 2, np.linspace(-0.3, 0.3, 24) ** 2) / 20.0
LAYOUTS = {
    "single precision": GAP.astype(np.float32),
    "extended precision": GAP.astype(np.longdouble),
    "columns first": np.asfortranarray(GAP),
    "every other cell": np.repeat(np.repeat(GAP, 2, axis=0), 2, axis=1)[::2, ::2],
    "backwards": GAP[::-1, ::-1].copy()[::-1, ::-1],
    "nested lists": GAP.tolist(),
    "of rows": [np.ma.masked_array(row) for row in GAP],
    "nothing masked": np.ma.masked_array(GAP),
    "other byte order": GAP.astype(GAP.dtype.newbyteorder()),
    "um": Quantity(1e3 * GAP, "um"),
    "micrometres of pint": Pint(1e3 * GAP, "micrometer"),
    "m of attributes": Labelled(1e-3 * GAP, "m"),
    "rows in um": [Quantity(1e3 * row, "um") for row in GAP],
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_pressure_does_not_depend_on_how_a_gap_is_stored(layout):
    """A twelfth of float32's last place of the gap moves the pressure by less than 1e-4 of it."""
    pressures = [
        solve_contact(gap, SPACING, 115e3, load=80.0, tolerance=1e-8).pressure for gap in (GAP, LAYOUTS[layout])
    ]
    np.testing.assert_allclose(pressures[1], pressures[0], rtol=0.0, atol=1e-4 * pressures[0].max())


def test_units_of_numbers_and_pairs_are_converted():
    radius = hertz.point_contact(Quantity(0.1, "kN"), Quantity([100.0, 100.0], "1 / m"), Quantity(113.187, "GPa"))
    assert radius.max_pressure == pytest.approx(hertz.point_contact(100.0, (0.1, 0.1), 113187.0).max_pressure)
    assert float(Lubricant(viscosity_40=100.0, viscosity_100=11.0, oil_temperature=60.0).density(15.0)) > 0.0
    stress = subsurface_stress(Labelled(np.full((4, 4), 0.5), "GPa"), Quantity([100.0, 100.0], "um"), depths=[0.1])
    same = subsurface_stress(np.full((4, 4), 500.0), (0.1, 0.1), depths=[0.1])
    np.testing.assert_allclose(stress.sigma_z, same.sigma_z, rtol=1e-12)  # the rounding of two conversions


test_unit_of_another_kind_is_refused = refusals(
    numbers,
    ("gap", Quantity([1.0], "N"), "mm", "^gap: in 'N'; allowed numbers in mm$"),
    ("gap", Pint([1.0], "second"), "", "^gap: in 'second'; allowed pure numbers$"),
    ("gap", Labelled([1.0], "mm"), None, "^gap: in 'mm', but its unit is not known here; give plain numbers$"),
    ("gap", Quantity([1.0], "K"), "C", "^gap: in 'K'; allowed numbers in C$"),
)


@pytest.mark.parametrize(
    ("written", "wanted", "factor"),
    [
        ("\N{MICRO SIGN}m", "mm", 1e-3),
        ("\N{GREEK SMALL LETTER MU}m", "mm", 1e-3),
        ("newton / millimeter ** 2", "MPa", 1.0),
        ("kg m-1 s-2", "MPa", 1e-6),
        ("N mm\N{SUPERSCRIPT TWO}", "N mm2", 1.0),
        ("degrees", "rad", np.pi / 180.0),
        ("mm / um", "", 1e3),
        ("W / (m K)", "W/(m K)", 1.0),
        ("kNm/rad", "N mm/rad", 1e6),
        ("1/min", "rpm", 1.0),
        ("5 mm", "mm", 5.0),
        ("", "mm", None),
        ("(mm", "mm", None),
        ("mm)", "mm", None),
        ("mm^99", "mm", None),
        ("1e-999 mm", "mm", None),
        ("MM", "mm", None),
        ("furlong", "mm", None),
    ],
)
def test_units_as_people_write_them(written, wanted, factor):
    # powers of units, and a few products
    assert conversion(written, wanted) == (factor if factor is None else pytest.approx(factor, rel=1e-12))


def test_number_with_a_unit_is_none_where_no_unit_is_known():
    assert np.isnan(real(Labelled(5.0, "um")))
    assert real(np.float32(0.5)) == real(Fraction(1, 2)) == 0.5


def test_results_share_no_memory_with_arrays_of_the_caller(pair_of_spur_gears):
    gap, spacing = GAP.copy(), SPACING
    angles, load, lengths = np.array([0.0, 0.01]), np.zeros(6), np.ones((2, 3, 3))
    kept = [
        ContactProblem(gap, spacing, 115e3, load=80.0).gap,
        solve_contact(gap, spacing, 115e3, load=80.0).problem.gap,
        trace_contact(pair_of_spur_gears, angles).pinion_angle,
        ShaftLoad(1.0, load).load,
        MeasuredPoints(lengths).points,
        *(getattr(MeasuredDeviations(*[lengths[..., 0]] * 3), name) for name in ("radius", "axial", "excess")),
    ]
    for array in kept:
        assert not any(np.shares_memory(array, one) for one in (gap, angles, load, lengths))


@pytest.fixture(scope="module")
def pair_of_spur_gears():
    with open("examples/scenes/spur.toml", encoding="utf-8") as file:
        return parse_scene(file.read()).pair()


test_arguments_of_another_kind_are_named = refusals(
    lambda call: call(),
    (lambda: load_result(3), "^path: the name of a file or directory is asked for, not 3$"),
    (lambda: parse_scene(None), "^text: text is asked for, not None$"),
    (lambda: iso6336.zone_factor("0.3", 0.3, 0.1), "^transverse_pressure_angle: a number in rad is asked for"),
    (lambda: friction.schlenk(1.0, 1.0, 1.0, "thick", 1.0), "^viscosity: an array of finite numbers is asked for"),
    (lambda: analyse("scene.toml"), "^scene: a Scene is asked for, not 'scene.toml'$"),
    (lambda: trace_contact(None), "^pair: a GearPair is asked for, not None$"),
    (lambda: weber_banaschek.ring_torsion(1.0, 2.0, "steel"), "^material: a Material is asked for, not 'steel'$"),
    (
        lambda: hertz.point_contact_gap((1.0, 1.0), (1.0, 1.0), (2.5, 2)),
        "^cells: a row of 2 whole numbers is asked for",
    ),
    (lambda: iso6336.zone_factor(9.0, 0.3, 0.1), "^transverse_pressure_angle: 9.0 rad is not between 0 and 90 deg$"),
    (lambda: iso6336.helix_angle_factor(np.inf), "^helix_angle: inf rad is not within 90 deg$"),
    (lambda: iso6336_22.mean_friction(1.0, 1.0, 0.0, 1.0, 1.0, 2.0), "^radius: 0.0 is not positive and finite$"),
    (
        lambda: hertz.point_contact(1.0, (1.0,), 1.0),
        r"^curvatures: a row of 2 numbers in 1/mm is asked for, not \(1.0,\)$",
    ),
)


def test_function_says_more_of_a_value_of_another_kind():
    """Its own words come first: it knows what is allowed, and what else is wrong."""
    with pytest.raises(InputError) as told:
        solve_contact(GAP, SPACING, "stiff", load=-1.0)
    assert "from 1e-30 to 1e30 MPa" in told.value.problems[0]


def test_every_array_that_cannot_be_used_is_named_at_once():
    @checked
    def sum_of(first: ArrayLike, second: Array | None = None) -> Array:  # noqa: F821 (annotations are text)
        return first if second is None else first + second

    with pytest.raises(InputError) as told:
        sum_of(np.ma.masked, second=Quantity([1.0], "mm"))
    assert [problem.split(":")[0] for problem in told.value.problems] == ["first", "second"]
    assert sum_of([1.0], second=None).tolist() == [1.0]


def test_warning_is_that_of_the_line_that_calls():
    with pytest.warns(AccuracyWarning) as given:
        solve_contact(GAP, SPACING, 115e3, load=1.0)
    assert {warning.filename for warning in given} == {__file__}


def test_warning_of_a_kept_property_is_that_of_the_line_that_reads_it():
    names = {"give": give_accuracy_warning}
    exec(compile("def coarse(self): give('the fit is coarse')", f"{PACKAGE}fit.py", "exec"), names)

    class Fit:
        error = cached_property(names["coarse"])

    with pytest.warns(AccuracyWarning, match="coarse") as given:
        assert Fit().error is None
    assert [warning.filename for warning in given] == [__file__]
