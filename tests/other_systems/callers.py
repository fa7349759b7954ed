"""Whose code it is that calls: the one place that decides who gets the other system, and who keeps Linux."""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Mapping
from enum import Enum
from types import FrameType
from typing import Any

_TESTS = os.path.dirname(os.path.dirname(__file__))
_STANDARD_LIBRARY = os.path.join(os.path.dirname(os.__file__), "")

_IMITATION = os.path.join(_TESTS, "other_systems", "")
#: Starts programs faster than an interpreter starts.
_SUITE = os.path.join(_TESTS, "forked.py")


class Owner(Enum):
    """Whose a file with code is."""

    OURS = "pyfrc, a test, or a robot project"
    STANDARD_LIBRARY = "Python"
    PACKAGE = "an installed package"
    SUITE = "what runs the tests"
    IMITATION = "what imitates the other system"


@functools.cache
def owner_of(file: str) -> Owner:
    """Return whose this file is."""
    if "-packages" in file and "/pyfrc" not in file.rpartition("-packages")[2]:
        return Owner.PACKAGE
    if file.startswith(_IMITATION):
        return Owner.IMITATION
    if file == _SUITE:
        return Owner.SUITE
    if file.startswith((_STANDARD_LIBRARY, "<")) and "-packages" not in file:
        return Owner.STANDARD_LIBRARY
    return Owner.OURS


def importer(variables: Mapping[str, Any] | None) -> Owner:
    """Return whose code has these global variables, and imports something."""
    if variables is None:
        return Owner.STANDARD_LIBRARY
    file = variables.get("__file__")
    if isinstance(file, str):
        return owner_of(file)
    # Frozen modules, and code in strings: ours is a program's own, and the agent's, which has no files on a robot.
    name = str(variables.get("__name__"))
    return Owner.OURS if name == "__main__" or name.startswith("pyfrc") else Owner.STANDARD_LIBRARY


def caller(frame: FrameType | None = None) -> Owner:
    """Return whose code calls, past the standard library and the imitation: it is the one that has to stand it."""
    frame = frame or sys._getframe(1)
    while frame is not None:
        owner = owner_of(frame.f_code.co_filename)
        if owner not in (Owner.STANDARD_LIBRARY, Owner.IMITATION):
            return owner
        frame = frame.f_back  # type: ignore[assignment]
    return Owner.OURS
