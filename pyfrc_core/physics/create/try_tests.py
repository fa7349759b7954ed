"""Run a project's tests with a proposed ``physics.py``, in a copy of the project."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from ...project import Project
from ...project.environments import is_environment

#: Directories that tests do not need.
_LEFT_OUT = {".git", ".hg", ".pyfrc", "__pycache__", "node_modules"}

_FAILURE = re.compile(r"(?:FAILED|ERROR) (.+)")


def failures_with(project: Project, texts: dict[Path, str]) -> list[str] | None:
    """Return the tests that fail with these files, a line for each; None if the project has no tests.

    The project itself is not changed.

    :param texts: the contents of files of the project
    """
    tests = project.find_tests()
    if tests is None:
        return None
    base = project.root.parent
    with TemporaryDirectory(prefix="pyfrc-create-physics-") as temporary:
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
        command = [sys.executable, "-m", "pyfrc", "test", "--main", project.main_file.name]
        if project.class_name:
            command += ["--robot-class", project.class_name]
        done = subprocess.run(
            [*command, "--", "-q", "-p", "no:cacheprovider"],
            cwd=copy / project.root.name,
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
    return {name for name in names if name in _LEFT_OUT or is_environment(Path(directory, name))}
