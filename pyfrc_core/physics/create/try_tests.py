"""Run a project's tests with a proposed ``physics.py`` and without."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import dataclass

from ...processes.spawn import WRITES_UTF_8
from ...project import NO_PHYSICS, Project
from ...text_files import write_whole

_FAILURE = re.compile(r"(?:FAILED|ERROR) (.+)")


@dataclass(frozen=True)
class Failures:
    """The tests that fail with the proposed ``physics.py``, a line for each.

    :param new: those that pass without it, or cannot run without one
    :param old: those that fail without it, too
    """

    new: list[str]
    old: list[str]


def failures_with(project: Project, physics: str) -> Failures | None:
    """Return the tests that fail with this ``physics.py``, which is in its place meanwhile; None without tests.

    :param physics: its text; the project has none
    """
    if project.find_tests() is None:
        return None
    write_whole(project.physics_file, physics)
    try:
        failed = _failures(project)
    finally:
        project.physics_file.unlink()
    old = {_test(line) for line in _failures(project) if NO_PHYSICS not in line} if failed else set()
    return Failures(
        [line for line in failed if _test(line) not in old], [line for line in failed if _test(line) in old]
    )


def _test(line: str) -> str:
    return line.partition(" - ")[0]


def _failures(project: Project) -> list[str]:
    command = [sys.executable, "-m", "pyfrc", "test", "--main", project.main_file.name]
    if project.class_name:
        command += ["--robot-class", project.class_name]
    done = subprocess.run(
        [*command, "--", "-q", "-p", "no:cacheprovider"],
        cwd=project.root,
        env={**os.environ, **WRITES_UTF_8, "COLUMNS": "10000"},  # otherwise pytest cuts the lines
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    if done.returncode == 0:
        return []
    lines = (done.stdout + done.stderr).splitlines()
    failed = [found[1] for line in lines if (found := _FAILURE.fullmatch(line))]
    return failed or [line for line in lines if line.strip()][-1:] or [f"pyfrc test ended with {done.returncode}"]
