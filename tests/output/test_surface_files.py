import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from loaded_tca.errors import InputError
from loaded_tca.gears import CylindricalGear, Rack
from loaded_tca.output.surface_files import write_stl, write_teeth, write_vtk
from loaded_tca.pairs import mating_teeth, rack_pair
from loaded_tca.results.teeth import teeth_in_space
from loaded_tca.tooth import Resolution, TriangleMesh, build_tooth
from tests.samples import double_helical
from tests.samples.results import result

CORNERS = np.array([[0.0, 0.0, 0.1], [3.0, 0.0, 1.0 / 3.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1e-300]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2]])
MESH = TriangleMesh(
    CORNERS,
    FACES,
    point_data={"height_mm": np.array([0.1, 1.0 / 3.0, 0.0, 1e-300])},
    cell_data={"pressure_MPa": np.array([1.5, 2.5, 1e3 / 7.0]), "patch": np.array([-1, 0, 2])},
)
STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


class Reader:
    """Legacy VTK PolyData, read by the letter of its description."""

    def __init__(self, path):
        self.rest = path.read_bytes()
        self.version, self.title, kind, dataset = (self.line() for _ in range(4))
        self.binary = {"BINARY": True, "ASCII": False}[kind]
        assert dataset == "DATASET POLYDATA"

    def line(self):
        line, _, self.rest = self.rest.partition(b"\n")
        return line.decode("ascii")

    def numbers(self, count, word):
        if self.binary:
            kind = np.dtype({"double": ">f8", "int": ">i4"}[word])
            size = count * kind.itemsize
            found, self.rest = np.frombuffer(self.rest[:size], kind), self.rest[size:]
            assert self.rest[:1] == b"\n"
            self.rest = self.rest[1:]
            return found
        found = []
        while len(found) < count:
            found += self.line().split()
        return np.array(found, dtype=float if word == "double" else int)

    def read(self):
        word, count, kind = self.line().split()
        assert word == "POINTS"
        points = self.numbers(3 * int(count), kind).reshape(-1, 3)
        word, count, size = self.line().split()
        assert word == "POLYGONS"
        cells = self.numbers(int(size), "int").reshape(int(count), 4)
        data, place, length = {"POINT_DATA": {}, "CELL_DATA": {}}, "", 0
        while self.rest:
            word, *about = self.line().split()
            if word == "SCALARS":
                assert self.line() == "LOOKUP_TABLE default"
                data[place][about[0]] = self.numbers(length, about[1])
            else:
                place, length = word, int(about[0])
        return points, cells, data


@pytest.mark.parametrize("binary", [True, False])
def test_vtk_gives_every_number_back(tmp_path, binary):
    path = tmp_path / "surface.vtk"
    write_vtk(path, MESH, "a title", binary=binary)
    reader = Reader(path)
    assert reader.version == "# vtk DataFile Version 3.0"
    assert reader.title == "loaded_tca surface in mm, 3 triangles: a title"
    points, cells, data = reader.read()
    assert_array_equal(points, CORNERS)
    assert_array_equal(cells, np.insert(FACES, 0, 3, axis=1))
    assert_array_equal(data["POINT_DATA"]["height_mm"], MESH.point_data["height_mm"])
    assert list(data["CELL_DATA"]) == ["pressure_MPa", "patch"]
    for name, values in MESH.cell_data.items():
        assert_array_equal(data["CELL_DATA"][name], values)
        assert data["CELL_DATA"][name].dtype.kind == values.dtype.kind


def test_vtk_without_data_or_triangles(tmp_path):
    path = tmp_path / "nothing.vtk"
    write_vtk(
        path, TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int), cell_data={"pressure_MPa": np.zeros(0)})
    )
    points, cells, data = Reader(path).read()
    assert points.shape == (0, 3)
    assert cells.size == data["CELL_DATA"]["pressure_MPa"].size == 0


def test_stl_gives_triangles_and_normals_back_in_single_precision(tmp_path):
    path = tmp_path / "surface.stl"
    write_stl(path, MESH, "a title")
    content = path.read_bytes()
    assert content[:80].decode("ascii").rstrip() == "loaded_tca surface in mm, 3 triangles: a title"
    (count,) = struct.unpack("<I", content[80:84])
    assert count == 3
    assert len(content) == 84 + 50 * count
    for number in range(count):
        *numbers, attribute = struct.unpack("<12fH", content[84 + 50 * number : 134 + 50 * number])
        normal, *corners = np.reshape(numbers, (4, 3))
        assert_allclose(corners, CORNERS[FACES[number]], rtol=1e-7, atol=1e-30)  # 1e-300 is none
        assert_allclose(normal, MESH.normals[number] / np.linalg.norm(MESH.normals[number]), atol=1e-7)
        assert attribute == 0


def test_titles_are_one_line_of_ascii_and_not_too_long(tmp_path):
    title = "Zahnrad größer\nals " + 300 * "x"
    write_vtk(tmp_path / "a.vtk", MESH, title)
    line = Reader(tmp_path / "a.vtk").title
    assert len(line) == 255
    assert "gr??er als" in line
    write_stl(tmp_path / "a.stl", MESH, title)
    assert (tmp_path / "a.stl").read_bytes()[:80].startswith(b"loaded_tca surface in mm, 3 triangles: Zahnrad")


def test_stl_of_an_area_of_nothing_has_no_nan(tmp_path):
    flat = TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    write_stl(tmp_path / "flat.stl", flat)
    assert (tmp_path / "flat.stl").read_bytes()[84:96] == bytes(12)


def test_names_of_several_words_are_refused(tmp_path):
    mesh = TriangleMesh(CORNERS, FACES, cell_data={"contact pressure": np.zeros(3)})
    with pytest.raises(InputError, match="data 'contact pressure': a name in a VTK file is one word"):
        write_vtk(tmp_path / "a.vtk", mesh)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("write", [write_vtk, write_stl])
def test_file_that_cannot_be_written_is_told_and_nothing_is_left(tmp_path, write):
    with pytest.raises(InputError, match=r"missing.*surface.*: cannot be written"):
        write(tmp_path / "missing" / "surface", MESH)
    (tmp_path / "old").write_text("kept", encoding="utf-8")
    broken = TriangleMesh(CORNERS, FACES)
    object.__setattr__(broken, "vertices", None)
    with pytest.raises((TypeError, AttributeError)):
        write(tmp_path / "old", broken)
    assert (tmp_path / "old").read_text(encoding="utf-8") == "kept"
    assert [path.name for path in tmp_path.iterdir()] == ["old"]


@pytest.mark.parametrize("whole", [False, True])
def test_teeth_of_a_result_are_written(tmp_path, whole):
    cycle = result("straight_bevel", positions=3)
    teeth = mating_teeth(cycle.gear_pair, Resolution(9, 5, 3, 5))
    shown = teeth_in_space(cycle, teeth)
    files = write_teeth(shown, teeth, tmp_path, title=cycle.scene.title, whole_gears=whole)
    assert {path.name for path in files} == {path.name for path in tmp_path.iterdir()}
    _, _, data = Reader(tmp_path / "pressure.vtk").read()
    assert_allclose(data["CELL_DATA"]["pressure_MPa"].max(), cycle.maps[0][shown.position][0].pressure.max())
    points, _, data = Reader(tmp_path / "pinion.vtk").read()
    assert_array_equal(points, shown.pinion.vertices)
    assert set(data["CELL_DATA"]["patch"]) == set(range(7))
    for name, tooth in (("pinion", teeth.pinion), ("wheel", teeth.wheel)):
        corners = np.frombuffer((tmp_path / f"{name}.stl").read_bytes()[84:], STL_TRIANGLE)["corners"]
        assert len(corners) == len(tooth.triangles(tooth.teeth if whole else 1, closed=True).triangles)
        points, triangles = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)  # in single precision
        edges = np.sort(np.concatenate([triangles.reshape(-1, 3)[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
        assert (np.unique(edges @ [len(points), 1], return_counts=True)[1] == 2).all(), f"{name}: open"


COARSE = Resolution(9, 5, 3, 5)


def lead_and_ends(points):
    """By how much a tooth turns along its face, d theta/dz [rad/mm], and the ends of the face [mm]."""
    points = np.unique(points, axis=0)
    low, high = points[:, 2].min(), points[:, 2].max()
    turned = [
        np.arctan2(points[at, 1], points[at, 0]).mean()
        for at in (np.isclose(points[:, 2], end, atol=1e-4) for end in (low, high))
    ]
    return (turned[1] - turned[0]) / (high - low), (low, high)


def test_halves_of_a_double_helical_pair_have_their_hands_and_their_places_on_the_gears(tmp_path):
    """Half a at z from 10 to 50 mm, the pinion right-hand; half b left-hand on the other side of the groove."""
    for half, (cycle, sign) in enumerate(zip(double_helical.analysed()[0].halves, (1.0, -1.0), strict=True)):
        teeth = mating_teeth(cycle.gear_pair, COARSE)
        directory = tmp_path / str(half)
        write_teeth(teeth_in_space(cycle, teeth), teeth, directory)
        helix = np.tan(np.radians(15.0)) / (0.5 * 4.0 / np.cos(np.radians(15.0)))  # tan(beta)/r times z
        for name, hand, count in (("pinion", 1.0, 29), ("wheel", -1.0, 87)):
            content = (directory / f"{name}.stl").read_bytes()[84:]
            triangles = np.frombuffer(content, STL_TRIANGLE)
            corners = triangles["corners"].astype(float)
            lead, ends = lead_and_ends(corners.reshape(-1, 3))
            # modifications of a few um over 40 mm, on one side of two, over the radius of the pinion
            assert_allclose(lead, sign * hand * helix / count, rtol=2e-3)
            assert_allclose(sorted(np.abs(ends)), [10.0, 50.0], atol=1e-4)  # in single precision
            assert np.sign(ends[0]) == sign
            outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            assert np.einsum("ij,ij->", corners.mean(axis=1), outward) > 0.0  # volume, by the theorem of Gauss
        points, _, _ = Reader(directory / "pinion.vtk").read()
        assert_allclose(sorted(np.abs([points[:, 2].min(), points[:, 2].max()])), [10.0, 50.0])
        assert (np.sign(points[:, 2]) == sign).all()


def test_rack_is_drawn_from_its_reference_line(tmp_path):
    """A tooth of a module of 3 mm: tip line at 3 mm, root at -3.75 mm, flanks as planes of 20 deg, all of it sound."""
    pinion = CylindricalGear(teeth=20, normal_module=3.0, face_width=20.0)
    rack = Rack(normal_module=3.0, face_width=20.0, height=20.0, length=100.0)
    tooth = build_tooth(rack_pair(pinion, rack).wheel.flanks, rack_pair(pinion, rack).wheel.form, COARSE)
    write_stl(tmp_path / "rack.stl", tooth.solid())
    triangles = np.frombuffer((tmp_path / "rack.stl").read_bytes()[84:], STL_TRIANGLE)
    corners = triangles["corners"].astype(float)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(outward, axis=1)
    assert areas.min() > 0.1  # twice the area; without any it would be rounding, 1e-6
    assert_allclose(outward / areas[:, None], triangles["normal"], atol=1e-3)  # of the smallest, in single precision
    assert_allclose(corners[..., 0].max(), 3.0, atol=1e-5)  # the tip line of the gear for the rack bends by s^2/(2 r)
    places = corners.reshape(-1, 3)
    at_root = places[np.abs(places[:, 0] + 3.75) < 1e-4]
    assert_allclose([at_root[:, 1].min(), at_root[:, 1].max()], [-1.5 * np.pi, 1.5 * np.pi], atol=1e-4)
    on_flanks = places[np.abs(places[:, 0]) < 2.9]
    expected = 0.75 * np.pi - on_flanks[:, 0] * np.tan(np.radians(20.0))
    straight = np.abs(on_flanks[:, 0]) < 2.5
    assert_allclose(np.abs(on_flanks[straight, 1]), expected[straight], atol=1e-4)


def test_whole_rack_is_straight_and_has_the_teeth_of_its_length():
    """100 mm of a pitch of 3 pi mm hold ten whole teeth, all with their tips on one line."""
    pinion = CylindricalGear(teeth=20, normal_module=3.0, face_width=20.0)
    rack = {"normal_module": 3.0, "face_width": 20.0, "height": 20.0}
    wheel = rack_pair(pinion, Rack(**rack, length=100.0)).wheel
    solid = build_tooth(wheel.flanks, wheel.form, COARSE).solid(whole_gear=True)
    assert solid.is_closed
    assert_allclose(np.ptp(solid.vertices[:, 1]), 10 * 3.0 * np.pi, atol=1e-4)
    tips = solid.vertices[solid.vertices[:, 0] > 3.0 - 1e-4]
    assert len(np.unique((tips[:, 1] // (3.0 * np.pi) + 0.5).round(3))) >= 10
    one = build_tooth(wheel.flanks, wheel.form, COARSE).solid()
    assert_allclose(solid.volume, 10 * one.volume, rtol=1e-5)  # seams of the gear for the rack: 1e-6 modules
    endless = rack_pair(pinion, Rack(**rack)).wheel
    with pytest.raises(InputError, match=r"whole gears: found a rack of no given length; give wheel\.length_mm"):
        build_tooth(endless.flanks, endless.form, COARSE).solid(whole_gear=True)


def test_surface_too_far_away_for_single_precision_is_refused(tmp_path):
    """At 4e6 mm coordinates have steps of 0.25 mm, as a rack has about the axis of the gear that stands for it."""
    far = TriangleMesh(CORNERS + np.array([4e6, 0.0, 0.0]), FACES)
    with pytest.raises(
        InputError, match="vertices: the surface of 3 mm lies 4000000 mm from the origin; allowed up to"
    ):
        write_stl(tmp_path / "far.stl", far)
    write_vtk(tmp_path / "far.vtk", far)  # in double precision
    assert [path.name for path in tmp_path.iterdir()] == ["far.vtk"]
