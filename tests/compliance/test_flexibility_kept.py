import os
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from loaded_tca.compliance import MeshDensity, flexibility, kept
from loaded_tca.compliance.body import ToothFrame, gear_nodes
from loaded_tca.compliance.flexibility import kept_flexibility, key_of
from loaded_tca.flanks import FlankModifications, SplineFlank
from loaded_tca.gears import CylindricalGear, CylindricalMesh
from loaded_tca.material import Material
from loaded_tca.pairs.cylindrical import cylindrical_pair
from loaded_tca.scene import FlankForm, Measurement
from loaded_tca.scene.build import described_gear
from tests.samples.bodies import pinion, spur_mesh

DENSITY = MeshDensity(2, 2, 1, 1, 2, 1, 1)
CHANGES = "side density neighbours bore solid modulus poisson width thickness tip fillet"
ARRAYS = "heights", "lengths", "displacement", "depth", "local_height", "local_value"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """An empty folder for models, and nothing in memory."""
    kept.forget_kept()
    monkeypatch.setenv(kept.FOLDER, str(tmp_path / "models"))
    yield tmp_path / "models"
    kept.forget_kept()


@pytest.fixture
def made(monkeypatch):
    """Frames for which a model was made."""
    frames, make = [], flexibility.tooth_flexibility

    def counted(frame):
        frames.append(frame)
        return make(frame)

    monkeypatch.setattr(flexibility, "tooth_flexibility", counted)
    return frames


def frame_of(gear=None, density=DENSITY):
    gear = gear or pinion()
    return ToothFrame(gear, gear_nodes(gear, density))


def gear_with(modifications=FlankModifications(), **changes):
    """Pinion of a spur pair with some of its geometry changed."""
    mesh = spur_mesh()
    mesh = replace(mesh, pinion=replace(mesh.pinion, **changes))
    return cylindrical_pair(mesh, modifications=(modifications, FlankModifications())).pinion


def same(one, other):
    for name in ARRAYS:
        assert_array_equal(getattr(one, name), getattr(other, name))


def test_model_is_made_once(made):
    assert kept_flexibility(frame_of()) is kept_flexibility(frame_of())
    assert len(made) == 1


def test_model_from_disk_is_the_same(made, folder):
    first = kept_flexibility(frame_of())
    kept.forget_kept()
    same(kept_flexibility(frame_of()), first)
    assert len(made) == 1
    assert [path.suffix for path in folder.iterdir()] == [".npz"]


def test_model_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        kept_flexibility(frame_of()).displacement[0] = 0.0


@pytest.mark.parametrize(
    "other",
    [
        lambda: frame_of(pinion(side=-1)),
        lambda: frame_of(density=replace(DENSITY, rim=3)),
        lambda: frame_of(density=replace(DENSITY, neighbours=2)),
        lambda: frame_of(pinion(bore_diameter=36.0)),
        lambda: frame_of(pinion(bore_diameter=0.0)),
        lambda: frame_of(pinion(material=Material(205000.0, 0.3))),
        lambda: frame_of(pinion(material=Material(206000.0, 0.29))),
        lambda: frame_of(pinion(width=20.001)),
        lambda: frame_of(gear_with(profile_shift=1e-4)),
        lambda: frame_of(gear_with(tip_diameter=81.001)),
        lambda: frame_of(gear_with(root_radius_coefficient=0.379)),
    ],
    ids=CHANGES.split(),
)
def test_another_gear_is_another_model(other):
    assert key_of(other()) != key_of(frame_of())


def test_equal_gears_are_one_model():
    mesh = CylindricalMesh(*(CylindricalGear(teeth=30, normal_module=3.0, face_width=20.0) for _ in range(2)))
    pair = cylindrical_pair(mesh)
    assert key_of(frame_of(pair.pinion)) == key_of(frame_of(pair.wheel))


@pytest.mark.parametrize(
    "modifications",
    [
        FlankModifications(lead_crowning=0.01),
        FlankModifications(tip_relief=0.02, tip_relief_start=80.0, tip_relief_form="linear"),
    ],
    ids=["crowning", "relief"],
)
def test_variants_of_the_micro_geometry_share_one_model(modifications, made):
    variant = gear_with(modifications)
    assert kept_flexibility(frame_of(variant)) is kept_flexibility(frame_of())
    assert len(made) == 1


def test_fitted_and_measured_flanks_share_the_model_of_their_gear(made):
    gear = gear_with(FlankModifications(lead_crowning=0.01))
    rho, z = gear.flank.grid(9, 9)
    points = {"radius_mm": rho, "axial_mm": z, "deviation_um": 0.0 * rho + 1.0}
    measurement = Measurement(**{name: tuple(map(tuple, values.tolist())) for name, values in points.items()})
    for form in (FlankForm(form="bspline", points=(17, 17)), FlankForm(form="measured", measurement=measurement)):
        described = described_gear(gear, form, "pinion", measured_side=1)
        assert isinstance(described.flank, SplineFlank)
        assert kept_flexibility(frame_of(described)) is kept_flexibility(frame_of())
    assert len(made) == 1


def test_a_change_far_below_rounding_is_the_same_model():
    """A part of 1e-15 of the size of the gear, in a key that tells 1e-9 apart."""
    found = [key_of(frame_of(gear_with(tip_diameter=diameter))) for diameter in (81.001, 81.001 + 1e-13)]
    assert found[0] == found[1]


def test_another_version_is_another_model(monkeypatch):
    before = key_of(frame_of())
    monkeypatch.setattr(flexibility, "_programme", lambda: "0.0.0")
    assert key_of(frame_of()) != before


def cut(**axes):
    """A change of the kept arrays: the last entry along an axis is left out."""
    return lambda arrays: {name: np.delete(arrays[name], -1, axis) for name, axis in axes.items()}


@pytest.mark.parametrize(
    "other", [cut(heights=0), cut(displacement=0), lambda arrays: {"depth": 1.01 * arrays["depth"]}]
)
def test_a_valid_file_with_other_numbers_is_made_anew(other, made, folder):
    first = kept_flexibility(frame_of())
    (path,) = folder.iterdir()
    arrays = dict(np.load(path))
    np.savez(path, **arrays | other(arrays))
    kept.forget_kept()
    same(kept_flexibility(frame_of()), first)
    assert len(made) == 2


@pytest.mark.quick_cases(every=3)
@pytest.mark.parametrize("damage", [b"", b"no archive", "cut", "changed", "foreign", "renamed", "not finite"])
def test_a_damaged_file_is_made_anew(damage, made, folder):
    first = kept_flexibility(frame_of())
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    arrays = dict(np.load(path))
    if isinstance(damage, bytes):
        path.write_bytes(damage)
    elif damage == "cut":
        path.write_bytes(whole[: len(whole) // 2])
    elif damage == "changed":
        middle = len(whole) // 2
        path.write_bytes(whole[:middle] + bytes([whole[middle] ^ 255]) + whole[middle + 1 :])
    elif damage == "foreign":
        np.savez(path, digest=arrays["digest"], pressure=np.ones(3))
    elif damage == "renamed":
        np.savez(path, **arrays | {"digest": "of another gear"})
    else:
        np.savez(path, **arrays | {"depth": np.nan * arrays["depth"]})
    kept.forget_kept()
    same(kept_flexibility(frame_of()), first)
    assert len(made) == 2
    kept.forget_kept()
    kept_flexibility(frame_of())
    assert len(made) == 2  # the file was mended


def test_a_folder_that_cannot_be_made_is_done_without(made, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv(kept.FOLDER, str(tmp_path / "file" / "models"))
    first = kept_flexibility(frame_of())
    kept.forget_kept()
    same(kept_flexibility(frame_of()), first)
    assert len(made) == 2


def test_a_folder_that_cannot_be_written_is_done_without(made, folder, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError("read-only")

    monkeypatch.setattr("tempfile.mkstemp", refuse)
    kept_flexibility(frame_of())
    assert len(made) == 1
    assert not list(folder.iterdir())


def test_a_full_disk_leaves_no_unfinished_file(folder, monkeypatch):
    def fill(file, **_):
        file.write(b"PK")
        raise OSError("no space left")

    monkeypatch.setattr(kept.np, "savez", fill)
    kept_flexibility(frame_of())
    assert not list(folder.iterdir())


def test_nothing_is_kept_on_disk_where_it_is_switched_off(made, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv(kept.FOLDER, "off")
    kept_flexibility(frame_of())
    kept.forget_kept()
    kept_flexibility(frame_of())
    assert len(made) == 2
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("variable", "inside"), [("XDG_CACHE_HOME", ()), ("HOME", (".cache",))])
def test_models_lie_in_the_cache_of_the_user(variable, inside, tmp_path, monkeypatch):
    for name in (kept.FOLDER, "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", os.devnull)
    monkeypatch.setenv(variable, str(tmp_path))
    kept_flexibility(frame_of())
    assert len(list(tmp_path.joinpath(*inside, "loaded_tca").glob("*.npz"))) == 1


def test_a_tilde_in_the_name_of_the_folder_is_the_home_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv(kept.FOLDER, "~/models")
    kept_flexibility(frame_of())
    assert len(list(tmp_path.glob("home/models/*.npz"))) == 1
    assert os.listdir(tmp_path) == ["home"]


def test_the_last_models_stay(made, folder, monkeypatch):
    monkeypatch.setattr(kept, "MOST_IN_MEMORY", 1)
    monkeypatch.setattr(kept, "MOST_ON_DISK", 2)
    for number, bore in enumerate((30.0, 31.0, 32.0)):
        kept_flexibility(frame_of(pinion(bore)))
        for path in folder.iterdir():
            os.utime(path, (number, min(number, path.stat().st_mtime)))
    assert len(list(folder.iterdir())) == 2
    for bore in (32.0, 31.0):
        kept_flexibility(frame_of(pinion(bore)))
    assert len(made) == 3
    kept_flexibility(frame_of(pinion(30.0)))
    assert len(made) == 4
