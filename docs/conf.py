"""Sphinx configuration of the documentation site: `make docs` builds it in docs/_build/html, without the network."""

import sys
from importlib.metadata import version as version_of
from importlib.resources import files
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE / "_extensions")]

import gallery
from jinja2.sandbox import SandboxedEnvironment
from numpydoc import docscrape_sphinx

project = "loaded_tca"
version = release = version_of("loaded_tca")
copyright = "the authors of loaded_tca"
extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "numpydoc",
    "myst_parser",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "generated_pages",
]
exclude_patterns = ["_build", "reference/generated"]

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4

autodoc_typehints = "none"  # the docstrings name types and units
autodoc_member_order = "bysource"
numpydoc_show_class_members = False  # they are documented in full

sphinx_gallery_conf = {
    "examples_dirs": str(gallery.WORKING_DIRECTORY),
    "gallery_dirs": "gallery",
    "filename_pattern": r"^(?!.*dynamics_with_).*\.py$",  # every example is run but those of ROSS and Exudyn
    "ignore_pattern": "^$",
    "image_scrapers": ("gallery.collect_pictures",),
    "reset_modules": ("gallery.define_file",),
    "reset_argv": "gallery.arguments",
    "within_subsection_order": "FileNameSortKey",
    "notebook_extensions": set(),  # but of gallery.NOTEBOOKS
    "download_all_examples": False,
    "show_signature": False,
    "abort_on_example_error": False,
    "write_computation_times": False,
}
gallery.prepare()

environments = []


def same_environment(loader):
    """Environment of numpydoc's template, which is compiled once: for each docstring anew it is a fifth of a build."""
    if not environments:
        environments.append(SandboxedEnvironment(loader=loader))
    return environments[0]


docscrape_sphinx.SandboxedEnvironment = same_environment

templates_path = ["_templates"]

html_theme = "pydata_sphinx_theme"
html_title = "loaded_tca"
html_static_path = ["_static", str(files("mathjax") / "static" / "mathjax" / "es5" / "tex-svg.js")]
html_css_files = ["site.css"]
mathjax_path = "tex-svg.js"
html_copy_source = html_show_sourcelink = False
html_theme_options = {
    "navbar_align": "left",
    "navbar_end": ["theme-switcher"],
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
