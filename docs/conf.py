"""Sphinx configuration of these pages: `make docs`. The build needs no network."""

from __future__ import annotations

import gc
import sys
from pathlib import Path
from typing import Any

import pytest

# The trees of all pages are kept until the end: looking for garbage in them takes a quarter of a build.
gc.disable()

# Document a fixture as the method in the source, not as the object that pytest creates from it.
pytest.fixture = lambda function: function

from sphinx.application import Sphinx  # noqa: E402
from sphinx.pycode import ModuleAnalyzer  # noqa: E402

from pyfrc import __version__  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))

from generated import expanded  # noqa: E402

project = "pyfrc"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc"]
default_role = "py:obj"

myst_heading_anchors = 3

autodoc_default_options = {
    "members": True,
    # Leave out the methods of tuples, exceptions, numbers and dicts.
    "inherited-members": "tuple, BaseException, int, MutableMapping, Sequence",
    "member-order": "bysource",
}
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True

html_theme = "furo"
html_title = f"pyfrc {release}"
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["copy.js"]
html_search_scorer = str(Path(__file__).with_name("scorer.js"))


#: `pyfrc` re-exports names: the comments of these modules' constants are in the modules that define them.
CONSTANTS = {
    "pyfrc.physics.drivetrains": "pyfrc_core.physics.deadzones",
    "pyfrc.physics.motor_cfgs": "pyfrc_core.physics.motor_cfgs",
    "pyfrc.physics.units": "pyfrc_core.physics.units",
}


def copy_comments() -> None:
    for module, origin in CONSTANTS.items():
        exported = ModuleAnalyzer.for_module(module)
        exported.analyze()
        exported.attr_docs.update(ModuleAnalyzer.for_module(origin).find_attr_docs())


def without_field_numbers(app: Sphinx, what: str, name: str, obj: object, options: Any, lines: list[str]) -> None:
    """Remove "Alias for field number 0": the docstring of the named tuple explains its fields."""
    if lines and lines[0].startswith("Alias for field number"):
        lines.clear()


def fixtures_without_parameters(
    app: Sphinx, what: str, name: str, obj: object, options: Any, signature: str | None, returns: str | None
) -> tuple[str, str | None] | None:
    """Hide the parameters of fixtures: tests request fixtures by name."""
    if what == "method" and name.startswith("pyfrc.test_support.pytest_plugin.PyFrcPlugin."):
        return "()", returns
    return None


def with_tables(app: Sphinx, page: str, source: list[str]) -> None:
    source[0] = expanded(source[0])


def setup(app: Sphinx) -> None:
    copy_comments()
    app.connect("source-read", with_tables)
    app.connect("autodoc-process-docstring", without_field_numbers)
    app.connect("autodoc-process-signature", fixtures_without_parameters)
