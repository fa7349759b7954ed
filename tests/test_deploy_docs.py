"""The pages about deploying: their commands work, and their messages exist."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from roborio import Roborio, require_roborio

ROOT = Path(__file__).parents[1]
PAGES = ("how_to/deploy.md", "how_to/program_crashes_after_a_deploy.md", "reference/deploy.md")
GUIDE = "".join((ROOT / "docs" / page).read_text("utf-8") for page in PAGES)
MESSAGES = (ROOT / "docs/reference/deploy_messages.md").read_text("utf-8")


@pytest.mark.slow
def test_the_guides_commands_work_one_after_the_other(make_project) -> None:
    require_roborio()
    project = make_project({})
    assert project.run("init").code == 0
    (project.path / "tests/pyfrc_test.py").unlink()  # the ready-made ones take longest, and run in other tests of ours
    (settings,) = re.findall(r"^```toml\n(.*?)^```$", GUIDE, re.MULTILINE | re.DOTALL)
    with (project.path / "pyproject.toml").open("a") as pyproject:
        pyproject.write(settings)
    blocks = re.findall(r"^```console\n(.*?)^```$", GUIDE, re.MULTILINE | re.DOTALL)
    commands = [shlex.split(line.removeprefix("$ ")) for block in blocks for line in block.splitlines()]
    assert len(commands) >= 5
    with Roborio(wpilib=version("wpilib")) as robot:
        for number, (program, *arguments) in enumerate(commands):
            assert program == "pyfrc"
            project.write({"notes.txt": f"changed {number} times\n"})
            result = project.run(*arguments, "--robot", robot.where)
            assert result.code == 0, (arguments, result.output)
        assert (robot.home / "py/robot.py").is_file()


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
