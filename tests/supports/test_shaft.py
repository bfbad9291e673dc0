"""Shafts on linear bearings: closed forms of beams, what is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from loaded_tca.arrays import Array
from loaded_tca.errors import InputError
from loaded_tca.material import Material
from loaded_tca.supports import Bearing, Shaft, ShaftLoad, ShaftSection

CLOSED_FORM, QUADRATURE = 1e-8, 1e-5
STEEL = Material(206000.0, 0.3)
E, G = 206000.0, 206000.0 / 2.6
RIGID = 1e18
"""Of a bearing [N/mm]: so stiff that it gives way by less than the tolerance."""
LENGTH, DIAMETER = 200.0, 20.0
INERTIA, AREA = math.pi / 64.0 * DIAMETER**4, 0.25 * math.pi * DIAMETER**2
KAPPA = 6.0 * 1.3 / (7.0 + 6.0 * 0.3)


def pinned(at: float, axial: float = 0.0, tilting: float = 0.0) -> Bearing:
    return Bearing(at, np.diag([RIGID, RIGID, axial, tilting, tilting, 0.0]))


def solid(*bearings: Bearing, torque_at: float = 0.0, loads: tuple[ShaftLoad, ...] = ()) -> Shaft:
    return Shaft(0.0, [ShaftSection(LENGTH, DIAMETER)], STEEL, torque_at, bearings, loads)


def simply_supported() -> Shaft:
    return solid(pinned(0.0, RIGID), pinned(LENGTH))


@pytest.mark.parametrize("axis", [0, 1])
def test_simply_supported_shaft_bends_and_shears_as_a_beam(axis: int) -> None:
    a, b = 70.0, 130.0
    bending = a**2 * b**2 / (3.0 * E * INERTIA * LENGTH)
    shear = a * b / (LENGTH * KAPPA * G * AREA)
    assert_allclose(simply_supported().compliance([a])[axis, axis], bending + shear, rtol=CLOSED_FORM)


def test_overhung_shaft_bends_and_tilts_as_a_beam() -> None:
    span, overhang = 120.0, 80.0
    shaft = solid(pinned(0.0, RIGID), pinned(span))
    matrix = shaft.compliance([LENGTH])
    bending = overhang**2 * (span + overhang) / (3.0 * E * INERTIA)
    shear = (overhang + overhang**2 / span) / (KAPPA * G * AREA)
    slope = overhang * (2.0 * span + 3.0 * overhang) / (6.0 * E * INERTIA)
    slope += overhang / (span * KAPPA * G * AREA)  # the reactions shear the span: its chord tilts
    assert_allclose(matrix[0, 0], bending + shear, rtol=CLOSED_FORM)
    assert_allclose(matrix[4, 0], slope, rtol=CLOSED_FORM)  # a force along +x tilts about +y
    assert_allclose(matrix[3, 1], -slope, rtol=CLOSED_FORM)  # one along +y about -x


def test_torsion_and_axial_force_of_a_bar() -> None:
    matrix = simply_supported().compliance([150.0])
    assert_allclose(matrix[5, 5], 150.0 / (2.0 * G * INERTIA), rtol=CLOSED_FORM)
    assert_allclose(matrix[2, 2], 150.0 / (E * AREA), rtol=CLOSED_FORM)


def test_rotation_is_counted_from_where_the_torque_enters() -> None:
    shaft = solid(pinned(0.0, RIGID), pinned(LENGTH), torque_at=120.0)
    assert_allclose(shaft.compliance([150.0])[5, 5], 30.0 / (2.0 * G * INERTIA), rtol=CLOSED_FORM)
    assert shaft.compliance([120.0])[5, 5] == 0.0


def test_stepped_hollow_shaft_agrees_with_unit_loads() -> None:
    sections = [ShaftSection(60.0, 30.0, 10.0), ShaftSection(50.0, 45.0, 20.0), ShaftSection(90.0, 25.0)]
    shaft = Shaft(0.0, sections, STEEL, 0.0, [pinned(0.0, RIGID), pinned(LENGTH)])
    at, ends = 80.0, (60.0, 110.0, 200.0)

    def section(z: float) -> ShaftSection:
        return sections[int(np.searchsorted(ends, z))]

    def energy(z: float) -> float:
        moment = z * (LENGTH - at) / LENGTH if z < at else (LENGTH - z) * at / LENGTH
        force = (LENGTH - at) / LENGTH if z < at else -at / LENGTH
        part = section(z)
        inertia = math.pi / 64.0 * (part.outer_diameter**4 - part.inner_diameter**4)
        area = 0.25 * math.pi * (part.outer_diameter**2 - part.inner_diameter**2)
        m = (part.inner_diameter / part.outer_diameter) ** 2
        kappa = 6.0 * 1.3 * (1.0 + m) ** 2 / (8.8 * (1.0 + m) ** 2 + 23.6 * m)
        return moment**2 / (E * inertia) + force**2 / (kappa * G * area)

    pieces = (0.0, *sorted({*ends, at}))
    expected = sum(quad(energy, low, high)[0] for low, high in pairwise(pieces))
    assert_allclose(shaft.compliance([at])[0, 0], expected, rtol=QUADRATURE)


def test_nodes_added_change_nothing() -> None:
    whole = simply_supported()
    parts = Shaft(0.0, [ShaftSection(LENGTH / 8.0, DIAMETER)] * 8, STEEL, 0.0, whole.bearings)
    assert_allclose(parts.compliance([70.0]), whole.compliance([70.0]), atol=1e-8 * whole.compliance([70.0])[0, 0])


def test_bearing_forces_balance_the_loads() -> None:
    rng = np.random.default_rng(4)
    soft = [Bearing(at, np.diag([2e5, 1e5, 3e4, 1e8, 1e8, 0.0])) for at in (20.0, 180.0)]
    load = ShaftLoad(120.0, np.array([300.0, -200.0, 100.0, 4e3, -3e3, 0.0]))
    motions = solid(*soft, loads=(load,)).solved([70.0])
    unit, own = np.append(rng.normal(size=5), [0.0, 1.0]), np.zeros(3)
    forces = motions.on_bearings @ unit
    z = np.array([0.0, 0.0, 1.0])

    def moment(at: float, wrench: Array) -> Array:
        return np.asarray(wrench[3:] + np.cross(at * z, wrench[:3]))

    applied = unit[:3] + load.load[:3]
    assert_allclose(forces[:, :3].sum(axis=0) - applied, own, atol=1e-8 * 400.0)
    about = sum(moment(at, one) for at, one in zip((20.0, 180.0), forces, strict=True))
    expected = moment(70.0, unit[:6]) + moment(120.0, load.load)
    assert_allclose(about[:2], expected[:2], atol=1e-8 * 1e5)


@pytest.mark.parametrize(
    ("bearings", "message"),
    [
        ([pinned(0.0, RIGID)], "1 bearing leaves the shaft free about [xy]"),
        ([pinned(50.0, RIGID), pinned(50.0)], "2 bearings leave the shaft free about [xy]"),
        ([pinned(0.0), pinned(LENGTH)], "2 bearings leave the shaft free along its axis"),
        ([pinned(0.0, RIGID), pinned(300.0)], "bearings: at 300 mm, beside the shaft, which goes from 0 to 200 mm"),
    ],
)
def test_shafts_that_are_not_held_are_refused(bearings: list[Bearing], message: str) -> None:
    with pytest.raises(InputError, match=message):
        solid(*bearings)


def test_one_bearing_that_holds_tilting_is_enough() -> None:
    assert solid(pinned(0.0, RIGID, RIGID)).compliance([100.0])[0, 0] > 0.0


def test_soft_axial_bearing_beside_rigid_ones_holds() -> None:
    matrix = solid(pinned(0.0, 1e3), pinned(LENGTH)).compliance([0.0])
    assert_allclose(matrix[2, 2], 1e-3, rtol=CLOSED_FORM)


def test_places_and_sections_that_cannot_be_are_refused() -> None:
    with pytest.raises(InputError, match="gear: at 250 mm, beside the shaft"):
        simply_supported().compliance([250.0])
    with pytest.raises(InputError, match="torque_at: at -5 mm"):
        solid(pinned(0.0, RIGID), pinned(LENGTH), torque_at=-5.0)
    with pytest.raises(InputError, match="inner_diameter: found 20 mm; allowed from 0 to below the outer diameter"):
        ShaftSection(10.0, 20.0, 20.0)
    with pytest.raises(InputError, match="length: found 0 mm"):
        ShaftSection(0.0, 20.0)
    with pytest.raises(InputError, match="sections: none given"):
        Shaft(0.0, [], STEEL, 0.0, [pinned(0.0)])
