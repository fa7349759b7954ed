"""What is in a release beside the packages: the project templates, and the README for the package index."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

REPOSITORY = "robotpy/pyfrc"


class TemplatesHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the project templates into the wheel, beside the command that copies them.

    A table in pyproject.toml would do, but for editable installations. Those find the templates in the checkout, and
    pytest would take the files named here for modules of a plugin.
    """

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "standard":
            build_data["force_include"]["templates"] = "pyfrc_cli/templates"


class ReadmeHook(MetadataHookInterface):
    """The README as the package index shows it."""

    def update(self, metadata: dict[str, Any]) -> None:
        text = (Path(self.root) / "README.md").read_text("utf-8")
        metadata["readme"] = {"content-type": "text/markdown", "text": with_addresses(text, f"v{metadata['version']}")}


def with_addresses(text: str, tag: str) -> str:
    """Return Markdown whose links into this repository are addresses of its files at a tag."""
    text = re.sub(r"(!\[[^\]]*\]\()(?!http)", rf"\1https://raw.githubusercontent.com/{REPOSITORY}/{tag}/", text)
    return re.sub(r"((?<!!)\[[^\]]*\]\()(?!http)", rf"\1https://github.com/{REPOSITORY}/blob/{tag}/", text)
