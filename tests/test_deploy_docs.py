"""The pages about deploying: their settings are read, and their messages exist."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from pyfrc_core.config.settings import DeploySettings, load_settings

ROOT = Path(__file__).parents[1]
PAGES = ("how_to/deploy.md", "how_to/program_crashes_after_a_deploy.md", "reference/deploy.md")
GUIDE = "".join((ROOT / "docs" / page).read_text("utf-8") for page in PAGES)
MESSAGES = (ROOT / "docs/reference/deploy_messages.md").read_text("utf-8")


def test_the_guides_settings_are_read(tmp_path: Path) -> None:
    (settings,) = re.findall(r"^```toml\n(.*?)^```$", GUIDE, re.MULTILINE | re.DOTALL)
    (tmp_path / "pyproject.toml").write_text(settings, "utf-8")
    assert load_settings(tmp_path / "pyproject.toml").deploy != DeploySettings()


def test_the_guides_messages_are_those_that_there_are() -> None:
    source = "".join(file.read_text("utf-8") for file in (ROOT / "pyfrc_core/deploy").rglob("*.py"))
    source = (
        source.replace("{user}", "lvuser")
        .replace("{controller.name}", "roboRIO")
        .replace("{LARGE:,}", "250,000")
        .replace("{year}", "...")
    )
    rows = [line.split("|")[1] for line in MESSAGES.splitlines() if line.startswith("| `")]
    assert len(rows) > 10
    for row in rows:
        for fragment in re.findall(r"`([^`]+)`", row):
            for part in fragment.split("..."):
                assert part.strip() in source, part


def test_nothing_of_a_deploy_imports_wpilib_or_what_only_a_connection_or_a_terminal_needs() -> None:
    code = """
import importlib, pkgutil, sys
import pyfrc_core.deploy
for module in pkgutil.walk_packages(pyfrc_core.deploy.__path__, "pyfrc_core.deploy."):
    importlib.import_module(module.name)
big = {"wpilib", "hal", "pytest", "pydantic", "paramiko", "rich"}
assert not big & set(sys.modules), big & set(sys.modules)
"""
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
