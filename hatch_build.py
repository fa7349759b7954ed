"""Puts the project templates into the wheel, beside the command that copies them."""

from __future__ import annotations

from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class TemplatesHook(BuildHookInterface):  # type: ignore[type-arg]
    """A table in pyproject.toml would do, but for editable installations.

    Those find the templates in the checkout, and pytest would take the files named here for modules of a plugin.
    """

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "standard":
            build_data["force_include"]["templates"] = "pyfrc_cli/templates"
