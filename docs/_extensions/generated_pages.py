"""Pages that are made from the code whenever the site is built: scene keys, result fields, commands, the Python API."""

import argparse
import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import gallery
from sphinx.application import Sphinx
from sphinx.config import Config

import loaded_tca
from loaded_tca.cli import EXIT_CODES, command_line
from loaded_tca.output import describe_results
from loaded_tca.scene import describe_keys
from loaded_tca.stages import describe_stage_keys

ABSOLUTE_VALUE = re.compile(r"\|([A-Za-z ]+)\|")
NAMED_PAGE = re.compile(r"`{0,2}docs/([\w/]+)\.md`{0,2}")
EXAMPLE = re.compile(r"\]\((?:\.\./)+examples/(\w+)\.py\)")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages as soon as the folders are known, before autosummary looks for them."""
    app.connect("config-inited", _write_pages)
    app.connect("autodoc-process-docstring", _escape_docstring)
    app.connect("source-read", _complete_links)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _write_pages(app: Sphinx, config: Config) -> None:
    write_pages(Path(app.srcdir) / "reference")
    config.autosummary_generate = [f"reference/api/{name}" for name in api_pages()]  # new ones, too


def write_pages(reference: Path) -> None:
    """Write all generated pages below a folder; those of names that are gone are removed."""
    texts = {
        "generated/scene_keys.md": describe_keys().replace("### ", "## "),
        "generated/stage_keys.md": describe_stage_keys().replace("### ", "## "),
        "generated/result_fields.md": describe_results().replace("### ", "## "),
        "generated/commands.md": describe_commands(),
    } | {f"api/{name}": text for name, text in api_pages().items()}
    for folder in {path.split("/")[0] for path in texts}:
        for old in (reference / folder).glob("*.*"):
            old.unlink() if str(old.relative_to(reference)) not in texts else None
    for path, text in texts.items():
        target = reference / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_text(encoding="utf-8") != text:  # else it would be read again
            target.write_text(text, encoding="utf-8")


def describe_commands() -> str:
    """Return exit codes and the help of every command in Markdown; links to pages that it names stand below it."""
    parser = command_line()
    (commands,) = (action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    lines = ["| exit code | |", "|---|---|", *(f"| {code} | {meaning} |" for code, meaning in EXIT_CODES.items()), ""]
    for name, command in commands.choices.items():
        command.formatter_class = lambda prog: argparse.RawDescriptionHelpFormatter(prog, width=100)
        text = command.format_help().rstrip()
        pages = [f"[](../{page}.md)" for page in NAMED_PAGE.findall(text)]  # shown by their titles
        text = re.sub(rf";\s+{NAMED_PAGE.pattern} says more", "", text)
        text = NAMED_PAGE.sub(lambda named: f"the page {Path(named[1]).name!r}", text)
        lines += [f"## {name}", "", "```text", text, "```", "", *(f"More: {page}." for page in pages), ""]
    return "\n".join(lines)


def api_pages() -> dict[str, str]:
    """Return the pages of the Python API: one for each package with public names, and an index."""
    packages = ["loaded_tca"]
    packages += [f"loaded_tca.{info.name}" for info in pkgutil.iter_modules(loaded_tca.__path__) if info.ispkg]
    pages, lines = {}, []
    for package in packages:
        module = importlib.import_module(package)
        if hasattr(module, "__all__"):
            pages[f"{package}.rst"] = _page(module, module.__all__)
            for name in module.__all__:
                inner = getattr(module, name)
                if inspect.ismodule(inner):
                    pages[f"{package}.{name}.rst"] = _page(inner, _own_names(inner))
            lines.append(f"| [`{package}`]({package}.rst) | {_first_line(module)} |")
    head = (
        "# Python API\n\nPublic names by package, made from their docstrings.\n\n| package | what it has |\n|---|---|\n"
    )
    order = [name.removesuffix(".rst") for name in pages]
    head = ["# Python API", "", "Public names by package, made from their docstrings.", ""]
    head += ["| package | what it has |", "|---|---|"]
    pages["index.md"] = "\n".join([*head, *lines, "", "```{toctree}", ":hidden:", "", *order, "```", ""])
    return pages


def _page(module: ModuleType, names: list[str]) -> str:
    """One page in reStructuredText: the docstring of the module, its functions and classes, its constants."""
    name = module.__name__
    kinds: dict[str, list[str]] = {"Classes": [], "Functions": [], "Modules": [], "Constants": []}
    for public in names:
        value = getattr(module, public)
        if inspect.ismodule(value):
            kinds["Modules"].append(f"* :doc:`{name}.{public}`: {_first_line(value)}")
        elif inspect.isclass(value):
            kinds["Classes"].append(f"   {_documented_as(module, public)}")
        elif inspect.isroutine(value):
            kinds["Functions"].append(f"   {_documented_as(module, public)}")
        else:
            shown = f"``{value!r}``" if isinstance(value, tuple) else f"a ``{type(value).__name__}``"
            shown = f"``{value}``" if "Literal" in str(value) else shown
            kinds["Constants"].append(f"* ``{public}``: {shown}")
    lines = [
        name,
        "=" * len(name),
        "",
        *map(_escaped, (inspect.getdoc(module) or "").splitlines()),
        "",
        f".. currentmodule:: {name}",
        "",
    ]
    for title, entries in kinds.items():
        if entries:
            lines += [title, "-" * len(title), ""]
            if title in ("Classes", "Functions"):
                lines += [".. autosummary::", "   :toctree: generated", ""]
            lines += [*entries, ""]
    return "\n".join(lines)


def _documented_as(module: ModuleType, public: str) -> str:
    """Name under which an object has its page: of those that the package itself has, too, that of the folder."""
    value = getattr(module, public)
    folder = getattr(value, "__module__", "").split(".")[1:2]
    below = importlib.import_module(f"loaded_tca.{folder[0]}") if folder else module
    inside = module is loaded_tca and public in getattr(below, "__all__", ())
    return f"~{folder[0]}.{public}" if inside else public


def _own_names(module: ModuleType) -> list[str]:
    """Public classes and functions that a module defines itself, in the order of its text."""
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", None) == module.__name__
    ]


def _first_line(module: ModuleType) -> str:
    return (inspect.getdoc(module) or "").partition("\n")[0]


def _escape_docstring(*event: Any) -> None:
    lines: list[str] = event[-1]
    lines[:] = [_escaped(line) for line in lines]


def _escaped(line: str) -> str:
    """One line of a docstring for reStructuredText: files of pages become links with their titles.

    Bars around a word are an absolute value in a docstring, and a substitution in reStructuredText; not in LaTeX.
    """
    line = NAMED_PAGE.sub(r":doc:`/\1`", line)
    return line if "\\" in line else ABSOLUTE_VALUE.sub(r"\|\1\|", line)


def _complete_links(_: Sphinx, document: str, source: list[str]) -> None:
    """Links to a script of the repository lead to its page in the gallery; there, a link to its scenes follows."""
    up = "../" * document.count("/")
    source[0] = EXAMPLE.sub(rf"]({up}gallery/\1.rst)", source[0])
    if document.startswith("gallery/") and document != "gallery/index":
        source[0] += f"\nScenes and studies that a script reads are in {gallery.ARCHIVE_LINK}.\n"
