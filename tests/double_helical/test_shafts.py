"""Double helical pairs on shafts: one shaft under both halves, limits, closed forms, equilibrium of bearings."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy
from numpy.testing import assert_allclose

from loaded_tca import ConvergenceError, InputError, analyse
from loaded_tca.double_helical import (
    DoubleHelicalResult,
    analyse_double_helical,
    analyse_double_helical_revolution,
)
from loaded_tca.double_helical import analyse as analyses
from loaded_tca.double_helical.analyse import expected_double_helical_effort
from loaded_tca.double_helical.laws import half_law
from loaded_tca.double_helical.rating import _largest_shares
from loaded_tca.double_helical.shafts import OnShafts, Stations, loads_at_first, mean_over_pitch
from loaded_tca.material import Material
from loaded_tca.output import write_result
from loaded_tca.output.double_helical_overview import bearing_rows_of_halves, held_in_words
from loaded_tca.scene.half_shafts import MIRRORED, HalfLoads
from loaded_tca.supports import Bearing, Shaft, ShaftLoad, ShaftSection, shafts_of
from loaded_tca.supports.support import rotation
from tests.samples import double_helical as samples

pytestmark = pytest.mark.filterwarnings("ignore::loaded_tca.AccuracyWarning")  # few cells
LEVER = 30.0  # from the groove of 20 mm to the middles of halves of 40 mm
ONE = {"analysis.positions": 1, "analysis.cells": [8, 16]}
HELD = {"pair.floating": "none"}


def shaft(diameter=60.0, torque_at=-100.0, axial=0.0, radial=500.0, at=90.0, tilting=0.0, **more):
    """A shaft of 200 mm about the groove, between two bearings."""
    stiffness = {"radial_stiffness_N_per_um": radial, "tilting_stiffness_Nm_per_mrad": tilting}
    bearings = [{"at_mm": z, "axial_stiffness_N_per_um": axial, **stiffness} for z in (-at, at)]
    section = {"length_mm": 200.0, "outer_diameter_mm": diameter}
    return {"start_mm": -100.0, "torque_at_mm": torque_at, "sections": [section], "bearings": bearings, **more}


def shares_and_errors(result):
    return result.torque_share[0, 0, 0], result.transmission_error[0, 0]


STEPPED = shaft(
    axial=100.0,
    sections=[{"length_mm": 70.0, "outer_diameter_mm": 50.0}, {"length_mm": 130.0, "outer_diameter_mm": 70.0}],
    loads=[{"at_mm": 95.0, "force_N": [100.0, 200.0, 50.0], "moment_Nm": [0.3, 0.2, 0.1]}],
)


def own_stepped_shaft(loads):
    stiffness = np.diag([5e5, 5e5, 1e5, 0.0, 0.0, 0.0])
    return Shaft(
        -100.0,
        [ShaftSection(70.0, 50.0), ShaftSection(130.0, 70.0)],
        Material(206000.0, 0.3),
        -100.0,
        [Bearing(z, stiffness) for z in (-90.0, 90.0)],
        [ShaftLoad(95.0, np.array([100.0, 200.0, 50.0, 300.0, 200.0, 100.0])), *loads],
    )


@pytest.fixture(scope="module")
def stepped():
    return samples.equal_halves().with_changes({**HELD, "pinion.shaft": STEPPED})


@pytest.fixture(scope="module")
def loads():
    """Loads of half a and half b on their mid-faces on the pinion's shaft, as each half counts; none on the wheel."""
    drawn = np.random.default_rng(4).normal(size=(2, 6)) * np.repeat([3e3, 1e5], 3)
    return [[HalfLoads(np.zeros(1), load[None]), HalfLoads(np.zeros(1), np.zeros((1, 6)))] for load in drawn]


def test_shafts_of_both_halves_are_one_shaft_under_all_loads(stepped, loads):
    (of_a,), (of_b,) = (of_half[0].loads for of_half in loads)
    whole = own_stepped_shaft([ShaftLoad(LEVER, of_a), ShaftLoad(-LEVER, of_b * MIRRORED)])
    motions = whole.solved([LEVER, -LEVER]).at_places[..., -1]
    for scene, load, motion in zip(
        stepped.half_scenes(0.0, None, loads), (of_a, of_b), (motions[0], motions[1] * MIRRORED), strict=True
    ):
        half, none = shafts_of(scene)
        assert none is None
        moved = half.solved([0.0]).at_places[0] @ np.append(load, 1.0)
        # rounding of a stiffness matrix of condition 1e6
        assert_allclose(moved, motion, rtol=0.0, atol=1e-9 * np.abs(motion).max())


def test_halves_couple_by_the_shaft_between_them(stepped, loads):
    pair = OnShafts(stepped, stepped.half_scenes(0.0, None, loads), (), loads)
    (gear,) = pair._shafts
    compliance = own_stepped_shaft([]).compliance([LEVER, -LEVER])
    across = compliance[:6, 6:] * MIRRORED
    # rounding of a stiffness matrix of condition 1e6
    assert_allclose(pair._shafts[gear].across, across, rtol=0.0, atol=1e-9 * np.abs(across).max())
    units = [(np.ones((3, 6)) * (1.0 + half), np.zeros((3, 6))) for half in range(2)]
    moved, coupling = pair._coupling(units)
    assert_allclose(coupling, 2.0 * across.sum(), rtol=1e-9)
    means = [of_half[0].loads[0] for of_half in loads]
    assert_allclose(moved[0], -(across @ means[1]).sum(), rtol=1e-9)
    assert_allclose(moved[1], -2.0 * (across.T @ means[0]).sum(), rtol=1e-9)


def test_bearings_of_a_mirrored_shaft_are_mirrored():
    rows = np.diag([5e5, 5e5, 1e5, 1e9, 1e9])
    rows[0, 4] = rows[4, 0] = 1e5
    ball = {"type": "ball", "balls": 9, "ball_diameter_mm": 16.0, "pitch_diameter_mm": 90.0, "contact_angle_deg": 15.0}
    bearings = [{"at_mm": -90.0, "stiffness": rows.tolist()}, {"at_mm": 90.0, "side": 1, **ball}]
    scene = samples.equal_halves().with_changes({**HELD, "pinion.shaft": shaft(bearings=bearings)})
    half_a, half_b = (half.pinion.shaft.bearings for half in scene.half_scenes(0.0))
    assert [bearing.at_mm for bearing in half_a] == [-120.0, 60.0]
    assert [bearing.at_mm for bearing in half_b] == [60.0, -120.0]
    assert (half_a[1].side, half_b[1].side) == (1, -1)
    # a way along x of the mirrored shaft tilts it the other way about y
    assert half_a[0].stiffness[0][4] == 1e5
    assert half_b[0].stiffness[0][4] == -1e5
    assert half_b[0].stiffness[2][2] == 1e5


def test_the_shaft_of_a_floating_gear_is_held_in_the_middle_of_its_groove():
    scene = samples.equal_halves().with_changes({"pinion.shaft": shaft()})
    for half in scene.half_scenes(0.0):
        *_, held = half.pinion.shaft.bearings
        assert (held.at_mm, held.radial_stiffness_N_per_um) == (-LEVER, 0.0)
        of_shaft, _ = shafts_of(half)
        # E A/l of the shaft from there to mid-face: 206000 N/mm^2, 60 mm
        elastic = LEVER / (206000.0 * 0.25 * math.pi * 60.0**2)
        assert of_shaft.compliance([0.0])[2, 2] == pytest.approx(elastic, rel=1e-4)  # beside 1e12 N/mm


def test_loads_of_stations_follow_the_torque_between_those_analysed():
    units = np.array([[[1.0] * 6], [[3.0] * 6]])
    stations = Stations(np.array([100.0, 200.0]), (units, 2.0 * units))
    pinion, wheel = stations.under(np.array([150.0]))
    assert_allclose(pinion, 2.0)
    assert_allclose(wheel, 4.0)
    assert_allclose(stations.under(np.array([500.0]))[0], 3.0)
    assert_allclose(Stations(np.array([100.0]), (units[:1], units[:1])).under(np.array([7.0]))[0], 1.0)
    assert_allclose(mean_over_pitch(np.array([[1.0], [3.0], [9.0]])), [2.0])  # the end is the next beginning


def test_first_loads_are_those_of_the_torque_at_the_pitch_point(stepped):
    half_a, _ = loads_at_first(stepped, 0.0)
    torque = 0.5 * stepped.torques[0]
    # other loads of the shaft tilt the pinion: the cosine of 1e-3 rad
    assert_allclose(np.abs(half_a[0].loads[0, 5]), torque, rtol=1e-5)
    assert_allclose(half_a[0].loads[0, :3], -half_a[1].loads[0, :3] * [-1.0, -1.0, 1.0], rtol=1e-2)  # x to each other


def test_check_has_the_bearing_forces_of_both_halves_and_says_what_bends():
    scene = samples.equal_halves().with_changes({"pinion.shaft": shaft(torque_at=0.0)})
    rows = dict(bearing_rows_of_halves(scene))
    mesh = samples.equal_halves().mesh()
    # axial forces cancel, each bearing takes the transverse force of a half
    force = 0.5e3 * 1600.0 / mesh.pinion.base_radius
    assert [float(cell) for cell in rows.values()] == pytest.approx([force, force], rel=1e-3)
    held = held_in_words(scene)
    assert "shaft of the pinion bends and twists under and between the halves" in held
    assert held.endswith("the wheel has a rigid bore.")
    assert list(rows) == [f"pinion, bearing {n} at {z} mm: force [N]" for n, z in enumerate((-90, 90))]


def on_bearings(**forces):
    """Unlike halves over two positions on shafts whose bearings carry given forces (position, bearing, 6)."""
    result, _ = samples.analysed()
    shafts = {f"{gear}.shaft": shaft(axial=100.0) for gear in forces}
    arrays = {
        f"{gear}_bearing_force": (("torque", "position", f"{gear}_bearing", "motion"), np.array([values]))
        for gear, values in forces.items()
    }
    return replace(
        result, scene=result.scene.with_changes({**HELD, **shafts}), dataset=result.dataset.assign(arrays), elsewhere=()
    )


FIRST = [[300.0, -400.0, 20.0, 1e3, 2e3, 0.0], [0.0, -100.0, 0.0, 0.0, 0.0, 0.0]]
SECOND = [[500.0, 0.0, 40.0, 3e3, 2e3, 0.0], [0.0, -300.0, 0.0, 0.0, 0.0, 0.0]]


def test_forces_on_bearings_stand_in_summary_and_tables(tmp_path):
    """Means over both positions, in N and N m; the largest force is a vector's length, hypot(500, 40)."""
    result = on_bearings(pinion=[FIRST, SECOND])
    table = result.to_pandas("bearings")
    assert list(table.index) == [("pinion", 1600.0, 0), ("pinion", 1600.0, 1)]
    assert_allclose(table["axial_mm"], [-90.0, 90.0])
    assert_allclose(table[["force_x_N", "force_y_N", "force_z_N"]], [[400.0, -200.0, 30.0], [0.0, -200.0, 0.0]])
    assert_allclose(table[["moment_x_Nm", "moment_y_Nm", "moment_z_Nm"]], [[2.0, 2.0, 0.0], [0.0, 0.0, 0.0]])
    assert_allclose(table["largest_force_N"], [math.hypot(500.0, 40.0), 300.0])
    (figures,) = result.key_figures()
    assert figures["pinion_bearing_force_N"] == table["largest_force_N"].max()
    assert "wheel_bearing_force_N" not in figures  # it has no shaft
    (line,) = [line for line in result.summary().splitlines() if "largest force on a bearing, pinion [N]" in line]
    assert float(line.split()[-1]) == pytest.approx(501.6, abs=0.05)
    files = [path.name for path in write_result(result, tmp_path)]
    assert files[-2:] == ["double_helical.csv", "double_helical_bearings.csv"]
    head, first, _ = (tmp_path / files[-1]).read_text().splitlines()
    assert head.startswith("gear,pinion_torque_Nm,bearing,axial_mm,force_x_N")
    assert first.startswith("pinion,1600,0,-90,400,-200,30,2,2,0,")
    write_result(samples.analysed()[0], tmp_path)  # without shafts: the table of the earlier result goes
    assert not (tmp_path / files[-1]).exists()


def test_shares_of_bins_lie_between_those_of_the_torques_analysed(stepped):
    shares = np.array([[[0.6, 0.4]], [[0.7, 0.3]]])
    result = SimpleNamespace(scene=stepped, torque=np.array([2e6, 1e6]), torque_share=shares)
    bins = _largest_shares(result, np.array([1.5e6, 0.0, 2e6]))
    assert_allclose(bins, [[0.65, 0.35], [0.5, 0.5], [0.6, 0.4]])


def test_what_shafts_do_not_have_is_refused(stepped):
    result = replace(samples.analysed()[0], scene=stepped)
    with pytest.raises(InputError, match="sensitivities: both halves load the shafts, and derivatives"):
        result.sensitivities(["load.pinion_torque_Nm"])
    with pytest.raises(InputError, match=r"pinion\.shaft: found a section; not allowed in whole revolutions"):
        analyse_double_helical_revolution(stepped)


def test_a_shaft_that_ends_under_a_half_is_refused_for_it(stepped):
    short = stepped.with_changes({"pinion.shaft": {**STEPPED, "sections": STEPPED["sections"][:1], "loads": []}})
    with pytest.raises(
        InputError, match=r"half a: pinion\.shaft: bearings: at 60 mm, beside the shaft, which goes from"
    ):
        loads_at_first(short, 0.0)


def test_analyses_on_shafts_are_expected_to_take_several_rounds(stepped):
    rigid = expected_double_helical_effort(stepped.with_changes({"pinion.shaft": None}))
    assert expected_double_helical_effort(stepped).contacts == 6 * rigid.contacts  # unlike halves, three rounds


@pytest.mark.parametrize(
    ("motion", "settled", "words"),
    [
        (0.0, False, "shafts: the loads of both halves under 1600 N m are not settled in 12 steps"),
        (5.0, True, r"pair\.floating: the place of the pinion along its axis, .* is not settled in 12 steps"),
    ],
)
def test_loads_and_places_that_do_not_settle_are_errors(stepped, motion, settled, words, monkeypatch):
    class Restless:
        def __init__(self, scene, *_):
            self.scene, self.force = scene, np.full((1, 1, 2), 1.0)

        def balance(self):
            motion_of_wheel = np.full((1, 1), next(ways))
            return SimpleNamespace(force=self.force, error=np.zeros((1, 1)), motion=motion_of_wheel), None

        def is_settled(self, _):
            return settled

        def next_loads(self, _):
            return None

    ways = iter(motion * (-1.0) ** n for n in range(20))
    monkeypatch.setattr(analyses, "OnShafts", Restless)
    monkeypatch.setattr(analyses, "_analysed", lambda *_: 2 * (analyses._Half(None, []),))
    monkeypatch.setattr(analyses, "_wanted", lambda *arguments: arguments[2])
    scene = stepped.with_changes({"pair.floating": "pinion", "pinion.shaft": shaft()})
    with pytest.raises(ConvergenceError, match=words):
        analyse_double_helical(scene)


@pytest.mark.thorough
@pytest.mark.parametrize("floating", ["pinion", "none"])
def test_a_rigid_shaft_is_none(floating):
    held = 1e9 if floating == "none" else 0.0
    rigid = shaft(2e4, 0.0, held, 1e9, LEVER)
    scene = samples.unlike_halves().with_changes({**ONE, "pair.floating": floating, "pair.apex_offset_mm": 2e-4})
    # its shear over 30 mm, Q l/(kappa G A), and bearings of 1e9 N/um
    on_shaft, none = (analyse_double_helical(scene.with_changes({"pinion.shaft": each})) for each in (rigid, None))
    assert_allclose(shares_and_errors(on_shaft), shares_and_errors(none), rtol=1e-5)
    assert_allclose(on_shaft.axial_motion, none.axial_motion, atol=1e-7)


@pytest.mark.thorough
def test_equal_halves_see_the_same_on_a_symmetric_shaft():
    tilted = shaft(torque_at=0.0, bearings=[{"at_mm": 0.0, **STIFF_IN_TILT}])
    result = analyse_double_helical(samples.equal_halves().with_changes({**ONE, "pinion.shaft": tilted}))
    first, second = result.halves
    # the same solution of both halves, of which one is a mirror image; their shafts are solved as one
    assert_allclose(first.transmission_error, second.transmission_error, rtol=1e-12)
    assert_allclose(first.pinion_motion, second.pinion_motion, rtol=1e-12)
    assert result.torque_share.tolist() == [[[0.5, 0.5]]]
    # half the difference of both deflections, over kappa: zero by symmetry, up to the rounding of these
    deflection = np.abs(first.transmission_error).max() * result.scene.mesh().wheel.base_radius
    assert_allclose(result.axial_motion, 0.0, atol=0.5e-12 * deflection / abs(result.scene.axial_rate))
    # the one bearing carries both halves, axial forces and tilting moments cancel
    force = result.pinion_bearing_force[0, 0, 0]
    transverse = result.torque[0] / result.scene.mesh().pinion.base_radius
    assert_allclose(np.hypot(*force[:2]), transverse, rtol=1e-3)  # normals at edges
    assert_allclose(force[2:], 0.0, atol=1e-9 * transverse)


STIFF_IN_TILT = {"radial_stiffness_N_per_um": 500.0, "tilting_stiffness_Nm_per_mrad": 500.0}


@pytest.mark.thorough
def test_a_shaft_soft_in_torsion_takes_load_from_the_half_that_is_farther_from_the_torque():
    diameter = 90.0
    held = shaft(diameter, -100.0, 1e9, 1e9, LEVER, 1e9)
    scene = samples.equal_halves().with_changes({**ONE, **HELD})
    result = analyse_double_helical(scene.with_changes({"pinion.shaft": held}))
    torques = [300.0, 450.0, 600.0, 700.0, 800.0, 900.0, 1000.0, 1150.0, 1300.0]
    law = half_law(analyse(scene.half_scenes(0.0, 2 * [torques])[0]), scene.axial_rate)
    radius = scene.mesh().pinion.base_radius
    twist = radius**2 / (206000.0 / 2.6 * math.pi / 32.0 * diameter**4)  # at the base circle for each N and mm
    whole = 1e6 * 1.6 / radius

    def way(force):
        return float(law.at(np.array([force]), np.array([0]))[0][0])

    force = scipy.optimize.brentq(
        lambda first: way(first) + 2.0 * LEVER * twist * first - way(whole - first), 0.2 * whole, 0.5 * whole
    )
    assert 0.3 < force / whole < 0.45
    expected = way(whole - force) + (100.0 - LEVER) * twist * whole
    # tooth contact of 8 x 16 cells under other torques: 1e-3 of the deflection
    assert_allclose(result.torque_share[0, 0, 0], force / whole, rtol=2e-3)
    length = result.scene.mesh().wheel.base_radius
    assert_allclose(np.abs(result.transmission_error[0, 0]) * length, expected, rtol=1e-3)


@pytest.mark.thorough
def test_an_axial_bearing_in_the_groove_is_the_support_of_a_floating_gear():
    stiffness = 100.0
    free = shaft()
    thrust = {"at_mm": 0.0, "radial_stiffness_N_per_um": 0.0, "axial_stiffness_N_per_um": stiffness}
    scene = samples.unlike_halves().with_changes({**ONE, "pair.apex_offset_mm": 0.01})
    borne = {**HELD, "pinion.shaft": {**free, "bearings": [*free["bearings"], thrust]}}
    floating = {"pair.axial_stiffness_N_per_um": stiffness, "pinion.shaft": free}
    on_bearing, on_support = (analyse_double_helical(scene.with_changes(each)) for each in (borne, floating))
    # faces stand within a thousandth of their width; loads of both halves are settled to 2e-5 modules
    assert_allclose(shares_and_errors(on_bearing), shares_and_errors(on_support), rtol=1e-4)
    thrusts = on_bearing.pinion_bearing_force[0, 0, 2, 2], stiffness * 1e3 * on_support.axial_motion[0, 0]
    assert_allclose(*thrusts, rtol=1e-3)


@pytest.mark.thorough
@pytest.mark.parametrize("floating", ["wheel", "none"])
def test_a_mirrored_pair_has_mirrored_results(floating):
    """Halves, shafts, their loads and the apex change sides; hands stay, since half b is described in the mirror."""
    modified = {"helix_slope_um": 3.0, "lead_crowning_um": 6.0}, {"helix_slope_um": -2.0, "lead_crowning_um": 8.0}

    def of(side, floats):
        parts = [{"length_mm": 90.0, "outer_diameter_mm": 60.0}, {"length_mm": 110.0, "outer_diameter_mm": 80.0}]
        bearings = [
            {"at_mm": side * at, "radial_stiffness_N_per_um": radial, "axial_stiffness_N_per_um": thrust}
            for at, radial, thrust in ((-95.0, 400.0, 0.0 if floats else 80.0), (85.0, 600.0, 0.0))
        ]
        load = {"force_N": [100.0, 200.0, side * 50.0], "moment_Nm": [side * 1.0, side * 2.0, 3.0]}
        own = {"bearings": bearings, "sections": parts[::side], "loads": [{"at_mm": side * 50.0, **load}]}
        return shaft(torque_at=side * -100.0, **own)

    one, other = (
        analyse_double_helical(
            samples.equal_halves().with_changes(
                {
                    **ONE,
                    "pair.floating": floating,
                    "pair.apex_offset_mm": side * 0.004,
                    "pinion.modifications": modified[::side][0],
                    "pinion.half_b": {"modifications": modified[::side][1]},
                    "pinion.shaft": of(side, False),
                    "wheel.shaft": of(side, floating == "wheel"),
                }
            )
        )
        for side in (1, -1)
    )
    # where mesh cycles begin and end follows the rounding of mean loads: 3e-8 of forces
    assert_allclose(one.torque_share, other.torque_share[..., ::-1], rtol=1e-6)
    assert_allclose(one.transmission_error, other.transmission_error, rtol=1e-6)
    assert_allclose(one.axial_motion, -other.axial_motion, rtol=1e-6)
    for name in ("pinion_bearing_force", "wheel_bearing_force"):
        forces = getattr(one, name)
        assert_allclose(forces, getattr(other, name) * MIRRORED, rtol=0.0, atol=1e-6 * np.abs(forces).max())


@pytest.fixture(scope="module")
def both_on_shafts():
    """Unlike halves of gears on shafts that follow these, under two torques, the wheel's shaft under other loads."""
    loads = [{"at_mm": 80.0, "force_N": [100.0, 200.0, 50.0]}]
    shafts = {
        "pinion.shaft": shaft(100.0, axial=100.0, gear="along"),
        "wheel.shaft": shaft(240.0, 100.0, 100.0, loads=loads),
    }
    torques = {"analysis.torques_Nm": [800.0, 1600.0]}
    return analyse_double_helical(samples.unlike_halves().with_changes({**ONE, **HELD, **shafts, **torques}))


@pytest.mark.thorough
def test_bearings_carry_the_teeth_of_both_halves(both_on_shafts):
    result, teeth = both_on_shafts, np.zeros(6)
    for cycle, share, signs in zip(result.halves, result.torque_share[1, 0], (1.0, MIRRORED), strict=True):
        under = []
        for maps in cycle.maps:
            force = np.zeros(6)
            for one in (each for each in maps[0] if each is not None):
                normals = -one.axes[2] * one.pressure.ravel()[:, None] * math.prod(one.spacing)
                points = one.points.reshape(-1, 3) + np.array([0.0, 0.0, LEVER])
                force += np.concatenate([normals.sum(axis=0), np.cross(points, normals).sum(axis=0)])
            under.append(force)
        torque = share * result.torque[1]
        force = [np.interp(torque, cycle.torque, column / cycle.torque) * torque for column in np.transpose(under)]
        turned = rotation(cycle.pinion_motion[-1, 0, 3:])  # the fixed frame stays with the pinion
        teeth += np.concatenate([turned @ force[:3], turned @ force[3:]]) * signs
    borne = result.pinion_bearing_force[1, 0]
    places = np.array([[0.0, 0.0, -90.0], [0.0, 0.0, 90.0]])
    moments = borne[:, 3:].sum(axis=0) + np.cross(places, borne[:, :3]).sum(axis=0)
    whole = np.abs(teeth[:3]).max()
    assert_allclose(borne[:, :3].sum(axis=0), teeth[:3], atol=1e-4 * whole)  # motions of the frame: 3e-5
    assert_allclose(moments[:2], teeth[3:5], atol=1e-4 * whole * LEVER)
    assert_allclose(moments[2], 0.0, atol=1e-9 * whole * LEVER)  # torque leaves elsewhere
    on_wheel = result.wheel_bearing_force[1, 0, :, :3].sum(axis=0)
    across = np.diag([-1.0, -1.0, 1.0])  # x of each gear towards the other one
    assert_allclose(on_wheel - [100.0, 200.0, 50.0], across @ -teeth[:3], atol=2e-3 * whole)  # its frame is tilted
    assert_allclose(result.axial_force_left[1, 0], -teeth[2], atol=5e-3 * np.abs(result.axial_force[1]).max())


@pytest.mark.thorough
def test_results_on_shafts_come_back_and_say_of_which_torque_halves_are(both_on_shafts, tmp_path):
    both_on_shafts.save(tmp_path)
    again = DoubleHelicalResult.load(tmp_path)
    assert again.dataset.identical(both_on_shafts.dataset)
    assert again.pinion_bearing_force.shape == (2, 1, 2, 6)
    (note,) = again.notes()
    assert note.startswith("half_a and half_b hold the mesh cycles under 1600 N m, with the shaft loads of both")
    other = replace(both_on_shafts, scene=both_on_shafts.scene.with_changes({"pinion.shaft.start_mm": -101.0}))
    other.save(tmp_path)
    with pytest.raises(InputError, match="the mesh cycle of another pair"):
        replace(other).load(tmp_path)
