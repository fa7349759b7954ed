"""Fixtures for robots, all called `robot`: each test module imports one."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import version

import pytest

from .local import LocalRobot, directory_in_memory
from .machine import Roborio, require_roborio


@pytest.fixture(name="robot")
def roborio() -> Iterator[Roborio]:
    """A look-alike with the WPILib that is installed here."""
    require_roborio()
    with Roborio(wpilib=version("wpilib")) as robot:
        yield robot


@pytest.fixture(name="robot")
def local_robot() -> Iterator[LocalRobot]:
    """A robot's directories, here."""
    with directory_in_memory() as directory:
        yield LocalRobot.new(directory / "robot")
