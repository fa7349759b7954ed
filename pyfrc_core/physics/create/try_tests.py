"""Run a project's tests with a proposed ``physics.py`` and without, in a copy of the project."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from ...processes.spawn import WRITES_UTF_8
from ...project import NO_PHYSICS, Project
from ...project.environments import is_environment
from ...project.walk import LEFT_OUT
from ...temporary import temporary_directory

_FAILURE = re.compile(r"(?:FAILED|ERROR) (.+)")


@dataclass(frozen=True)
class Failures:
    """The tests that fail with the proposed files, a line for each.

    :param new: those that pass without the proposed ``physics.py``, or cannot run without one
    :param old: those that fail without it, too
    """

    new: list[str]
    old: list[str]


def failures_with(project: Project, texts: dict[Path, str]) -> Failures | None:
    """Return the tests that fail with these files; None if the project has no tests.

    The project itself is not changed.

    :param texts: the contents of files of the project, ``physics.py`` among them
    """
    tests = project.find_tests()
    if tests is None:
        return None
    base = project.root.parent
    with temporary_directory("create-physics") as temporary:
        copy = Path(temporary)
        shutil.copytree(project.root, copy / project.root.name, symlinks=True, ignore=_not_needed)
        if not tests.is_relative_to(project.root):  # beside the code's directory
            shutil.copytree(tests, copy / tests.relative_to(base), symlinks=True, ignore=_not_needed)
        if project.pyproject.parent == base and project.pyproject.is_file():
            shutil.copy(project.pyproject, copy)
        for file, text in texts.items():
            target = copy / file.relative_to(base)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        failed = _failures(project, copy / project.root.name)
        if not failed:
            return Failures([], [])
        (copy / project.physics_file.relative_to(base)).unlink()
        before = _failures(project, copy / project.root.name)
    old = {_test(line) for line in before if NO_PHYSICS not in line}
    return Failures(
        [line for line in failed if _test(line) not in old], [line for line in failed if _test(line) in old]
    )


def _test(line: str) -> str:
    return line.partition(" - ")[0]


def _failures(project: Project, root: Path) -> list[str]:
    command = [sys.executable, "-m", "pyfrc", "test", "--main", project.main_file.name]
    if project.class_name:
        command += ["--robot-class", project.class_name]
    done = subprocess.run(
        [*command, "--", "-q", "-p", "no:cacheprovider"],
        cwd=root,
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


def _not_needed(directory: str, names: list[str]) -> set[str]:
    paths = {name: Path(directory, name) for name in names}
    copied = {name for name, path in paths.items() if path.is_symlink() or path.is_file() or path.is_dir()}  # no pipes
    return {name for name, path in paths.items() if name in LEFT_OUT or name not in copied or is_environment(path)}
