"""How Sphinx builds these pages: `make docs`. Nothing is fetched from the network."""

from __future__ import annotations

from typing import Any

import pytest

# A fixture is documented as the method that it is written as, not as the object that pytest makes of it.
pytest.fixture = lambda function: function

from sphinx.application import Sphinx  # noqa: E402
from sphinx.pycode import ModuleAnalyzer  # noqa: E402

from pyfrc import __version__  # noqa: E402

project = "pyfrc"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc"]
default_role = "py:obj"

myst_heading_anchors = 3

autodoc_default_options = {
    "members": True,
    # Not what every tuple, exception, number and dict can do.
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


#: `pyfrc` only hands names on: what is said of these modules' constants stands where they are defined.
CONSTANTS = {
    "pyfrc.physics.drivetrains": "pyfrc_core.physics.deadzones",
    "pyfrc.physics.motor_cfgs": "pyfrc_core.physics.motor_cfgs",
    "pyfrc.physics.units": "pyfrc_core.physics.units",
}


def hand_on_comments() -> None:
    for module, origin in CONSTANTS.items():
        handed_on = ModuleAnalyzer.for_module(module)
        handed_on.analyze()
        handed_on.attr_docs.update(ModuleAnalyzer.for_module(origin).find_attr_docs())


def without_field_numbers(app: Sphinx, what: str, name: str, obj: object, options: Any, lines: list[str]) -> None:
    """Named tuples say "Alias for field number 0" of what their own docstring explains."""
    if lines and lines[0].startswith("Alias for field number"):
        lines.clear()


def fixtures_without_parameters(
    app: Sphinx, what: str, name: str, obj: object, options: Any, signature: str | None, returns: str | None
) -> tuple[str, str | None] | None:
    """Tests ask for fixtures by name: what those themselves ask for is no user's concern."""
    if what == "method" and name.startswith("pyfrc.test_support.pytest_plugin.PyFrcPlugin."):
        return "()", returns
    return None


def setup(app: Sphinx) -> None:
    hand_on_comments()
    app.connect("autodoc-process-docstring", without_field_numbers)
    app.connect("autodoc-process-signature", fixtures_without_parameters)
