"""Fixtures for robots, all called `robot`: each test module imports one."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import pytest

from .local import LocalRobot
from .machine import Roborio, require_roborio


@pytest.fixture(name="robot")
def roborio() -> Iterator[Roborio]:
    """A look-alike with the WPILib that is installed here."""
    require_roborio()
    with Roborio(wpilib=version("wpilib")) as robot:
        yield robot


@pytest.fixture(name="robot")
def local_robot(in_memory: Path) -> LocalRobot:
    """A robot's directories, here."""
    return LocalRobot.new(in_memory / "robot")
