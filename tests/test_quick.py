"""Which tests a change has: those of its folder, and those named after the modules that import it."""

import pytest

from tests.quick import selected

IMPORTERS = {
    "loaded_tca.contact.solver": {"loaded_tca.contact.adaptive", "loaded_tca.separation.box", "loaded_tca"},
    "loaded_tca.errors": {"loaded_tca.arrays", "loaded_tca.contact.checks"},
}
FILES = (
    "tests/contact/test_solver.py",
    "tests/separation/test_box.py",
    "tests/test_errors.py",
    "tests/test_public_names.py",
    "tests/test_examples.py",
    "tests/test_faults.py",
    "tests/scene/conftest.py",
)


@pytest.fixture
def repository(tmp_path):
    for name in FILES:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    return tmp_path


@pytest.mark.parametrize(
    ("changed", "tests"),
    [
        (
            "loaded_tca/contact/solver.py",
            ["tests/contact", "tests/separation/test_box.py", "tests/test_public_names.py"],
        ),
        ("loaded_tca/errors.py", ["tests/test_errors.py"]),  # contact/test_checks.py is not there
        ("loaded_tca/contact/kernel.bin", []),
        ("tests/contact/test_solver.py", ["tests/contact/test_solver.py"]),
        ("tests/scene/conftest.py", ["tests/scene"]),
        ("tests/faults.py", ["tests/test_faults.py"]),
        ("examples/plot_tooth_3d.py", ["tests/test_examples.py"]),
        ("README.md", []),
    ],
)
def test_change_has_the_tests_of_its_folder_and_of_its_importers(changed, tests, repository):
    assert selected([changed], lambda module: IMPORTERS.get(module, set()), repository) == tests


def test_files_of_a_folder_that_is_selected_are_not_named_again(repository):
    changed = ["loaded_tca/contact/solver.py", "tests/contact/test_solver.py"]
    assert selected(changed, lambda _: set(), repository) == ["tests/contact"]
