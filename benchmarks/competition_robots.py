"""Copies of the robots in tests/robots/competition, which benchmarks run and change."""

from __future__ import annotations

import shutil
from pathlib import Path

_ROBOTS = Path(__file__).resolve().parents[1] / "tests" / "robots" / "competition"

NAMES = sorted(path.name for path in _ROBOTS.iterdir() if (path / "robot.py").is_file())


def copy_robot(name: str, directory: Path, settings: str) -> Path:
    """Copy a robot into a directory, without what runs have left, and return its project.

    :param settings: added to its pyproject.toml
    """
    left_out = shutil.ignore_patterns("__pycache__", ".pyfrc", "ctre_sim", "logs")
    project = Path(shutil.copytree(_ROBOTS / name, directory / name, ignore=left_out))
    with (project / "pyproject.toml").open("a") as file:
        file.write(settings)
    return project
