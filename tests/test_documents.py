"""Links, pictures, files and commands that documents and docstrings name are there."""

import ast
import doctest
import importlib.util
import pkgutil
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from tests.conftest import DEAR_EXAMPLES
from validation.__main__ import CASES, LONG

ROOT = Path(__file__).parents[1]
BUILT = {"_build", "gallery", "generated", "api"}  # folders of docs/ that building the site fills
PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
PAGES += sorted(path for path in ROOT.glob("docs/**/*.md") if not BUILT & {*path.relative_to(ROOT).parts})
SOURCES = sorted(
    path
    for folder in ("loaded_tca", "validation", "examples", "tests", "docs")
    for ending in ("py", "toml")
    for path in (ROOT / folder).rglob(f"*.{ending}")
    if not (folder == "docs" and BUILT & {*path.relative_to(ROOT).parts})
)
LINK = re.compile(r"\]\(([^)\s]+)\)")
NAMED_FILE = re.compile(r"\b((?:docs|examples|validation|tests|loaded_tca)/[\w/.-]*\w\.(?:md|py|toml|csv|json|png))\b")
COMMAND = re.compile(r"python -m ((?:validation|loaded_tca)[\w.]*\w)")
TOCTREE = re.compile(r"^```{toctree}$(.*?)^```", re.MULTILINE | re.DOTALL)
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def anchors(page):
    """Anchors of the headings of a page, as GitHub makes them."""
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_links_and_pictures_of_a_page_exist(page):
    for link in LINK.findall(page.read_text(encoding="utf-8")):
        if "://" in link:
            continue
        file, _, anchor = link.partition("#")
        target = (page.parent / file).resolve() if file else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@pytest.mark.parametrize(("language", "parsed"), [("toml", tomllib.loads), ("python", ast.parse)])
def test_blocks_to_copy_can_be_parsed(language, parsed):
    fence = re.compile(rf"^```{language}\n(.*?)^```", re.MULTILINE | re.DOTALL)
    blocks = [block for page in PAGES for block in fence.findall(page.read_text(encoding="utf-8"))]
    assert len(blocks) > 10
    for block in blocks:
        parsed(doctest.script_from_examples(block) if block.startswith(">>> ") else block)


FOLDERS = sorted({path.relative_to(ROOT).parts[0] for path in SOURCES})


@pytest.mark.parametrize("folder", ["pages", *FOLDERS])
def test_files_and_commands_that_are_named_exist(folder):
    """In all files of a folder at a time: one test for each file takes longer to begin than to run."""
    absent = []
    for path in PAGES if folder == "pages" else SOURCES:
        name = path.relative_to(ROOT)
        if folder not in ("pages", name.parts[0]):
            continue
        text = path.read_text(encoding="utf-8")
        absent += [f"{name}: {file}" for file in NAMED_FILE.findall(text) if not (ROOT / file).exists()]
        absent += [f"{name}: {one}" for one in COMMAND.findall(text) if importlib.util.find_spec(one) is None]
    assert absent == []


def links(page):
    """Files that a page links or has in its table of contents."""
    text = page.read_text(encoding="utf-8")
    entries = [
        f"{line}.md" for lines in TOCTREE.findall(text) for line in lines.split("\n") if line[:1] not in ("", ":")
    ]
    return {(page.parent / link.partition("#")[0]).resolve() for link in (*LINK.findall(text), *entries)}


def test_every_page_and_picture_is_linked():
    linked = {ROOT / "docs" / "index.md"}.union(*map(links, PAGES))
    listed = subprocess.run(["git", "ls-files", "docs"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    files = [ROOT / line for line in listed.splitlines() if line.endswith((".md", ".png"))]
    assert [str(path) for path in files if path.resolve() not in linked] == []


def test_every_picture_has_a_script_that_draws_it():
    """It names the picture; numbered ones are named without their number."""
    scripts = [*(path for path in SOURCES if path.suffix == ".py" and path.relative_to(ROOT).parts[0] == "docs")]
    scripts += sorted((ROOT / "validation").rglob("*.py"))
    words = {word for path in scripts for word in re.findall(r"\w+", path.read_text(encoding="utf-8"))}
    listed = subprocess.run(["git", "ls-files", "docs"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    stems = {re.sub(r"_\d+$", "_", Path(line).stem) for line in listed.splitlines() if line.endswith(".png")}
    assert stems - words == set()


def test_cases_that_the_table_of_errors_names_are_there():
    table = (ROOT / "docs" / "how_it_works" / "errors.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`(\w+\.\w+)`", "".join(line for line in table.splitlines() if line.startswith("|"))))
    assert named, "the table names no case"
    assert named - {*CASES, *LONG} == set()


@pytest.mark.parametrize("name", DEAR_EXAMPLES)
def test_dear_example_is_there(name):
    assert ">>> " in pkgutil.resolve_name(name).__doc__
