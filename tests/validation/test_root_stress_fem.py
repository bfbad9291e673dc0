"""Finite element references of the root stress: fillets, rings and readers, without running the program."""

import math
from dataclasses import replace

import numpy as np
import pytest

from loaded_tca.gears.cylindrical import CylindricalGear
from validation.calculix.case import VARIANTS, line_load, position
from validation.calculix.fillet import LEAST_ANGLE, fillets
from validation.calculix.grading import graded
from validation.calculix.model import Meshing, plane_deck
from validation.calculix.ring import RingMeshing, loaded_ring, serendipity
from validation.calculix.ring_run import LINE_LOAD, loaded_line, pinion
from validation.calculix.roots import root_stress
from validation.calculix.run import nodal_stresses
from validation.calculix.tables import RING_FILLETS_FILE, RINGS_FILE, ROOT_MESH_FILE, ROOTS_FILE, read_table
from validation.calculix.tooth_form import ToothForm
from validation.loaded import root_face_load, root_stress_cycle, root_stress_space

ROUNDING = 1e-12  # of a few operations
COARSE = Meshing(per_half_width=2.0, growth=0.8, coarsest=1.5, beside=3.0, far=6.0, rim=0.3, fillet=0.3)
RING = RingMeshing(fillet=0.6, flank=1.5, beside=3.0, far=6.0, end=2.0, layer=5.0)
WIDTH = 20.0


def test_ends_of_a_line_may_be_fine():
    size = np.diff(graded(5.0, 2.5, 0.0, 1.0, 0.0, 1.0, (math.inf, 0.1))[::2])
    assert size[-1] < 0.13
    assert 0.7 < size[0] <= 1.0
    assert (np.diff(size) < ROUNDING).all()


@pytest.mark.parametrize("helix_deg", [0.0, 20.0])
def test_form_and_fillet_tangents_agree_with_the_gear_of_the_package(helix_deg):
    beta = math.radians(helix_deg)
    form = ToothForm(25, helix_angle=beta)
    gear = CylindricalGear(teeth=25, normal_module=3.0, face_width=WIDTH, helix_angle=beta)
    assert form.tip_radius == pytest.approx(gear.tip_radius, rel=ROUNDING)
    radius = np.linspace(gear.form_radius, gear.tip_radius, 20)
    thickness = [gear.tooth_thickness_at(r) for r in radius]
    np.testing.assert_allclose(2.0 * radius * form.half_angle(radius), thickness, atol=ROUNDING)
    ring = loaded_ring(form, WIDTH, form.pitch_radius, RING).ring
    loaded, back = fillets(form, ring.bottom.nodes, 0.0, 0.0)
    np.testing.assert_allclose(loaded.angle, back.angle, atol=1e-9)
    r, away = gear.root_fillet(4001)
    radial, hoop = gear.root_fillet_tangent(4001)
    slope = np.arctan2(radial * np.sin(away) + hoop * np.cos(away), hoop * np.sin(away) - radial * np.cos(away))
    at = np.hypot(*ring.bottom.nodes[loaded.nodes].T)
    on_fillet = (at > r[-1] + 1e-6) & (at < r[0])
    assert on_fillet.sum() >= 4
    expected = np.interp(-at[on_fillet], -r, slope)
    np.testing.assert_allclose(loaded.angle[on_fillet], expected, atol=1e-3)  # read between points of the trochoid
    assert loaded.angle[-1] == pytest.approx(0.5 * math.pi - math.pi / 25, abs=1e-6)  # the middle of the space


@pytest.fixture(scope="module")
def plane():
    place = position("unmodified", 12, 0.010)
    return place, plane_deck(place, line_load(100.0), COARSE, load_steps=(1.0,), stress=True)


def test_deck_asks_for_stress_only_where_it_is_wanted(plane):
    _, deck = plane
    assert deck.text().count("*EL FILE") == 1
    assert "*EL FILE" not in replace(deck, stress=False).text()


def test_root_stress_of_a_known_field_is_told_with_its_place(plane):
    """Stress of 1 MPa along y everywhere: along the fillet it is the square of the tangent's y."""
    place, deck = plane
    stress = np.zeros((1, deck.nodes, 6))
    stress[..., 1] = 1.0
    for found, middle in zip(root_stress(place, deck, stress), (place.pinion_tooth, place.wheel_tooth), strict=True):
        tooth, side = found.tension.tooth, 1.0 if found.tension.side == "loaded" else -1.0
        tangent = middle(tooth) + side * (math.pi - math.radians(found.tension.angle))
        assert found.tension.stress == pytest.approx(math.sin(tangent) ** 2, abs=2e-3)  # a spline between the nodes
        assert 0.99 < found.tension.stress < 1.005
        assert -5e-3 < found.compression.stress < 0.01
        assert min(found.tension.angle, found.compression.angle) >= math.degrees(LEAST_ANGLE)
        assert tooth in (-1, 0, 1)


def test_nodal_stresses_are_read_by_step(tmp_path):
    lines = [f"    2C{2:31d}", " -1         1 0.00000E+00 0.00000E+00 0.00000E+00", " -3"]
    for step in (1.0, 2.0):
        lines += [" -4  STRESS      6    1", " -5  SXX         1    4    1    1"]
        lines += [f" -1{node:10d}" + f"{step * node:12.5E}" + 5 * f"{-0.25:12.5E}" for node in (1, 2)] + [" -3"]
    path = tmp_path / "run.frd"
    path.write_text("\n".join(lines) + "\n")
    stress = nodal_stresses(path)
    assert stress.shape == (2, 2, 6)
    np.testing.assert_array_equal(stress[:, :, 0], [[1.0, 2.0], [2.0, 4.0]])
    path.write_text("\n".join(lines[:3]) + "\n")
    with pytest.raises(RuntimeError, match="no stress of all nodes"):
        nodal_stresses(path)


def test_shape_functions_are_those_of_a_quadratic_face():
    value, slope = serendipity(0.3, -0.6)
    around = [(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)]
    u, v = np.array(around, dtype=float).T
    for field, expected, along in ((u * 0 + 1, 1.0, (0, 0)), (u * v, -0.18, (-0.6, 0.3)), (u**2, 0.09, (0.6, 0.0))):
        assert value @ field == pytest.approx(expected)
        np.testing.assert_allclose(field @ slope, along, atol=ROUNDING)


@pytest.mark.parametrize("name", ["spur", "helical"])
@pytest.mark.parametrize("change", [0.0, 1.0])
def test_nodal_forces_have_the_sum_and_the_moments_of_the_line_load(name, change):
    form, rolls = pinion(name), loaded_line(name)
    loaded = loaded_ring(form, WIDTH, math.hypot(form.base_radius, rolls[0]), RING)
    forces = loaded.forces(rolls, (LINE_LOAD, change))
    nodes = loaded.ring.coordinates()[np.array(list(forces)) - 1, 1:]
    values = np.array(list(forces.values()))
    whole = LINE_LOAD * WIDTH
    assert np.linalg.norm(values.sum(axis=0)) == pytest.approx(whole, rel=1e-3)  # normals of an interpolated flank
    # the line of action of an involute: base radius, and the base helix along the axis
    base_helix = math.atan(math.tan(form.helix_angle) * form.base_radius / form.pitch_radius)
    moment = np.cross(nodes, values).sum(axis=0)[2]
    assert abs(moment) == pytest.approx(whole * form.base_radius * math.cos(base_helix), rel=1e-3)
    assert moment < 0.0  # onto the flank at the larger angle
    assert abs(values[:, 2].sum()) == pytest.approx(whole * math.sin(base_helix), abs=1e-3 * whole)
    along = values @ values.sum(axis=0) / whole
    centre = float(nodes[:, 2] @ along / along.sum())
    assert centre == pytest.approx(change * WIDTH / 6.0, abs=0.02)


def test_ring_turns_with_its_helix_and_reads_tension_across_the_helix():
    form = pinion("helical")
    loaded = loaded_ring(form, WIDTH, form.pitch_radius, RING)
    ring = loaded.ring
    places = ring.coordinates()[:, 1:]
    first, last = places[ring.plane(0) - 1], places[ring.plane(ring.layers) - 1]
    turn = np.angle((last[:, 0] + 1j * last[:, 1]) / (first[:, 0] + 1j * first[:, 1]))
    np.testing.assert_allclose(turn, WIDTH * math.tan(form.helix_angle) / form.pitch_radius, rtol=1e-9)
    hydrostatic = np.zeros((ring.last_node, 6))
    hydrostatic[:, :3] = -7.0
    angle, sides = loaded.stress(hydrostatic)
    assert angle[0] >= LEAST_ANGLE
    for stress in sides:
        np.testing.assert_allclose(stress, -7.0, rtol=1e-9)
    lengthwise = np.zeros((ring.last_node, 6))
    lengthwise[:, 2] = 1.0  # along the axis: across the helix sin^2 of its angle at the fillet, none on radial tangents
    _, sides = loaded.stress(lengthwise)
    largest = math.sin(math.atan(ring.twist * form.fillet[0][0])) ** 2
    assert 0.0 <= min(side.min() for side in sides) < 0.3 * largest
    assert 0.7 * largest < max(side.max() for side in sides) < largest


def test_deck_of_a_ring_has_a_step_for_each_load():
    form, rolls = pinion("spur"), loaded_line("spur")
    loaded = loaded_ring(form, WIDTH, math.hypot(form.base_radius, rolls[0]), RING)
    loads = {name: loaded.forces(rolls, (LINE_LOAD, change)) for name, change in (("even", 0.0), ("uneven", 1.0))}
    text = loaded.text(loads)
    assert text.count("*STEP") == text.count("*CLOAD,OP=NEW") == text.count("*EL FILE") == 2
    assert text.count("*BOUNDARY\nBORE,1,3") == 1


def test_load_beyond_the_flank_is_refused():
    form = pinion("spur")
    loaded = loaded_ring(form, WIDTH, form.pitch_radius, RING)
    with pytest.raises(ValueError, match="no element of the flank"):
        loaded.forces((30.0, 0.0), (LINE_LOAD, 0.0))


def test_kept_cycles_have_all_positions_of_both_variants():
    cycles = root_stress_cycle.read_roots()
    assert list(cycles) == list(VARIANTS)
    for cycle in cycles.values():
        assert cycle.pinion_angle.shape == (24,)
        assert all(stress.shape == (24,) for stress in cycle.stress.values())
        assert min(cycle.stress[gear, "tension"].min() for gear in ("pinion", "wheel")) > 0.0
        assert max(cycle.stress[gear, "compression"].max() for gear in ("pinion", "wheel")) < 0.0


def test_kept_meshes_are_converged():
    """Half a percent between the kept mesh and a finer one in the plane, one percent in space."""
    study = {(r["variant"], r["gear"], r["way"]): r for r in read_table(ROOT_MESH_FILE)}
    for (variant, gear, way), row in study.items():
        for sign in ("tension_MPa", "compression_MPa") if way == "standard" else ():
            assert row[sign] == pytest.approx(study[variant, gear, "finer"][sign], rel=5e-3)
    rings, coarser = (root_stress_space.read_rings(RINGS_FILE, way) for way in ("finer", "standard"))
    assert len(rings) == 4
    for key, rows in rings.items():
        for name, largest in (("tension_MPa", max), ("compression_MPa", min)):
            found = largest(row[name] for row in rows)
            assert found == pytest.approx(largest(row[name] for row in coarser[key]), rel=1e-2)


def test_tables_that_are_not_kept_give_nothing(tmp_path):
    assert root_stress_cycle.read_roots(tmp_path / "roots.csv") == {}
    assert root_stress_space.read_rings(tmp_path / "rings.csv") == {}
    assert ROOTS_FILE.exists()
    assert RING_FILLETS_FILE.exists()


def test_rows_tell_a_stress_beyond_what_is_asked():
    kept = root_stress_cycle.read_roots()["unmodified"]
    wrong = {key: 1.03 * values for key, values in kept.stress.items()}
    rows = list(root_stress_cycle.rows_of("unmodified", kept, replace(kept, stress=wrong)))
    assert len(rows) == 8
    assert not any(row.holds for row in rows)
    assert all(row.holds for row in root_stress_cycle.rows_of("unmodified", kept, kept))


def test_k_f_beta_is_that_of_the_whole_tooth():
    one = root_face_load.Uneven(np.zeros(2), np.array([3.0, 2.0]), np.array([2.0, 2.0]), 2.0)
    assert one.ratio == 1.5
    assert one.iso_factor == pytest.approx(2.0 ** (9.0 / 13.0))  # h/b limited to 1/3
