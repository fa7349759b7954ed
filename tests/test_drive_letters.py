"""Places as Windows writes them: with the letter of a drive, spaces and parentheses; and files on another drive."""

from __future__ import annotations

import ntpath
import os
from pathlib import Path

import pytest
from conftest import MakeProject

from pyfrc_cli.project_options import from_here
from pyfrc_core.processes.crash_report import describe_exit
from pyfrc_core.project.robot_files import RobotFiles

TWICE = """
    import commands2
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            command = commands2.PrintCommand("a")
            command.withTimeout(1)
            command.withTimeout(2)
"""


def test_the_place_in_a_librarys_message(make_project: MakeProject) -> None:
    """As the directory of a project that was downloaded twice may be named."""
    pytest.importorskip("commands2")
    project = make_project({"my robot (1)/robot.py": TWICE})
    result = project.run("test", "--builtin", "--", "-k", "disabled", cwd=project.path / "my robot (1)")
    assert "robot.py:9: this command is already part of another one, composed at robot.py:8" in result.stdout


def test_the_place_of_a_crash() -> None:
    files = RobotFiles(Path("C:\\Users\\Jane Doe\\robot"))
    files.root = "C:\\Users\\Jane Doe\\robot\\"  # with Windows' separator
    report = (
        b'Windows fatal exception: access violation\n\n  File "C:\\Users\\Jane Doe\\robot\\arm.py", line 12 in up\n'
    )
    assert describe_exit(report, 0xC0000005, files, "in the test").startswith("arm.py:12: ")


def test_a_file_on_another_drive_is_named_by_its_whole_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os.path, "relpath", lambda file, here: ntpath.relpath(file, f"C:\\{here}"))
    assert from_here(Path("D:\\logs\\a.jsonl")) == "D:\\logs\\a.jsonl"
