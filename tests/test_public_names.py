"""What users import: public names are loaded when first used, and documents and examples need nothing deeper."""

import ast
import importlib
import json
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import loaded_tca
from loaded_tca.machine_speed import machine_speed

ROOT = Path(__file__).parents[1]
FOLDERS = sorted(info.name for info in pkgutil.iter_modules(loaded_tca.__path__) if info.ispkg)
PACKAGES = [
    package
    for package in ("loaded_tca", *(f"loaded_tca.{folder}" for folder in FOLDERS))
    if hasattr(importlib.import_module(package), "__all__")  # else it is there for other folders only
]
LAZY = [package for package in PACKAGES if hasattr(importlib.import_module(package), "__getattr__")]
BUILT = {"_build", "gallery", "generated", "api"}  # folders of docs/ that building the site fills
DOCS = [path for path in sorted((ROOT / "docs").rglob("*.*")) if not BUILT & {*path.relative_to(ROOT).parts}]
PAGES = [ROOT / "README.md", *(path for path in DOCS if path.suffix == ".md")]
SCRIPTS = [*sorted((ROOT / "examples").glob("*.py")), *(path for path in DOCS if path.suffix == ".py")]
IMPORT = re.compile(r"^[ >]*from (loaded_tca[\w.]*) import (\([^)]*\)|[^\n(]*)", re.MULTILINE)
MENTION = re.compile(r"\bloaded_tca\.(\w+)\.(\w+)")


def modules_after(statement):
    """Names of all modules that a fresh interpreter holds after a statement."""
    script = f"import json, sys\n{statement}\nprint(json.dumps(sorted(sys.modules)))"
    output = subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return set(json.loads(output))


def own(modules):
    return {name for name in modules if name.split(".")[0] == "loaded_tca"}


def test_importing_the_package_loads_nothing():
    loaded = modules_after("import loaded_tca")
    assert own(loaded) == {"loaded_tca", "loaded_tca.lazy"}
    assert "numpy" not in loaded


@pytest.mark.quick_cases("loaded_tca.contact")
@pytest.mark.parametrize("package", ["loaded_tca", "loaded_tca.contact"])
def test_contact_solver_loads_no_gears(package):
    loaded = modules_after(f"from {package} import solve_contact")
    modules = "lazy", "arguments", "arrays", "errors", "notebooks", "plain", "threads", "units"
    below = {"loaded_tca", *(f"loaded_tca.{module}" for module in modules)}
    assert own(loaded) <= below | {name for name in loaded if name.startswith("loaded_tca.contact")}
    assert not {"loaded_tca.contact.subsurface", "loaded_tca.contact.adaptive"} & loaded
    transforms = modules_after("import scipy.fft")  # SciPy 1.16 loads scipy.sparse with it, 1.17 does not
    assert not {"scipy.linalg", "scipy.optimize", "scipy.sparse", "matplotlib", "xarray", "skfem"} & loaded - transforms


def test_reading_a_scene_loads_no_analysis():
    loaded = modules_after("from loaded_tca import read_scene; read_scene('examples/scenes/helical.toml')")
    folders = {name.split(".")[1] for name in own(loaded) if "." in name}
    assert not {"analysis", "compliance", "contact", "loaded", "plots", "results", "separation"} & folders
    assert not {"matplotlib", "pyfftw", "xarray", "skfem"} & loaded


def test_check_and_the_imports_of_run_load_no_heavy_library():
    """SciPy's parts, xarray with pandas, and finite elements come where they are used; pictures with run."""
    machine_speed()  # measured once on a machine, by contacts and eliminations
    script = """
import io, sys
from contextlib import redirect_stdout
from loaded_tca.cli import main
with redirect_stdout(io.StringIO()):
    for name in ("hypoid_13x42", "mesh_cycle_helical"):
        assert main(["check", f"examples/scenes/{name}.toml"]) == 0
        sys.modules.update({f"after {name}: {module}": sys for module in set(sys.modules)})
checked = {name for name in sys.modules if not name.startswith("after ")}
import loaded_tca.analysis, loaded_tca.output.result_files, loaded_tca.plots
sys.modules.update({f"after check: {name}": sys for name in checked})
"""
    loaded = modules_after(script)
    parts = ("fft", "fftpack", "interpolate", "linalg", "ndimage", "optimize", "sparse", "spatial", "special", "stats")
    heavy = {"dask", "matplotlib.pyplot", "pandas", "skfem", "xarray", *(f"scipy.{part}" for part in parts)}
    assert not heavy & loaded
    assert not {"after check: matplotlib", "after check: scipy"} & loaded
    others = {f"after hypoid_13x42: loaded_tca.scene.{name}" for name in ("cylindrical", "bevel", "blank_face_milled")}
    others |= {f"after mesh_cycle_helical: loaded_tca.scene.{name}" for name in ("double_helical", "internal", "rack")}
    assert not others & loaded  # scenes of other pairs
    folders = {f"loaded_tca.{name}" for name in ("double_helical", "flank_maps", "rating", "studies", "tribology")}
    assert not folders & loaded  # what pictures of other results show
    assert {"after hypoid_13x42: loaded_tca.scene.face_milled", "loaded_tca.scene.cylindrical"} <= loaded


@pytest.mark.thorough
def test_folders_are_attributes_of_the_package():
    modules_after("import loaded_tca; loaded_tca.unloaded.trace_teeth; loaded_tca.reference.hertz.point_contact")


@pytest.mark.parametrize("package", PACKAGES)
def test_public_names_exist_and_are_listed(package):
    module = importlib.import_module(package)
    for name in module.__all__:
        assert getattr(module, name) is not None
    assert set(module.__all__) <= set(dir(module))


@pytest.mark.parametrize("package", LAZY)
def test_name_that_is_loaded_later_is_that_of_no_module_beside_it(package):
    """Else the name would be the module once that has been imported, by whomever."""
    module = importlib.import_module(package)
    beside = {info.name for info in pkgutil.iter_modules(module.__path__)}
    assert all(getattr(module, name) is sys.modules.get(f"{package}.{name}") for name in beside & set(module.__all__))


def test_unknown_name_is_told():
    with pytest.raises(AttributeError, match=r"module 'loaded_tca.contact' has no attribute 'solve_nothing'"):
        _ = importlib.import_module("loaded_tca.contact").solve_nothing


def test_no_module_imports_from_the_package_itself():
    """Its names are loaded late, so that the import contracts would not see what is behind them."""
    found = []
    for path in sorted((ROOT / "loaded_tca").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        stands_there = re.search(r"^[ \t]*from loaded_tca import", text, re.MULTILINE)  # not in examples
        if path == ROOT / "loaded_tca" / "__init__.py" or not stands_there:
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ImportFrom) and node.module == "loaded_tca":
                found.append(path)
    assert found == []


def assert_public(module, name):
    assert module in PACKAGES, f"from {module} import {name}: deeper than a folder"
    if f"{module}.{name}" not in PACKAGES:  # a folder is as public as what it lists
        assert name in importlib.import_module(module).__all__, f"{name} is not in __all__ of {module}"


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_examples_import_public_names_only(script):
    for node in ast.walk(ast.parse(script.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith("loaded_tca"):
            for alias in node.names:
                assert_public(node.module, alias.name)
        elif isinstance(node, ast.Import):
            for alias in node.names:
                assert not alias.name.startswith("loaded_tca.") or alias.name in PACKAGES


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_documents_import_and_mention_public_names_only(page):
    text = page.read_text(encoding="utf-8")
    for module, names in IMPORT.findall(text):
        for name in names.split("#")[0].strip("() \n").split(","):
            if name.strip():
                assert_public(module, name.strip())
    for folder, name in MENTION.findall(IMPORT.sub("", text)):
        assert folder not in FOLDERS or name in importlib.import_module(f"loaded_tca.{folder}").__all__, name
