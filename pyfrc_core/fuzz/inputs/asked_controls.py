"""Watch which controls of its joysticks robot code asks for: drivers press what has a function.

The HAL knows only that a joystick is read. So the functions that read are intercepted in Python.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager
from typing import Any

from ...wpi import joysticks
from ..prepared_patches import PreparedPatches


class AskedControls:
    """The controls that robot code has asked for, as targets of scripts, in the order of the first time."""

    def __init__(self) -> None:
        self.targets: dict[str, None] = {}

    def note(self, port: int, kind: str, number: int) -> None:
        """Note a control that robot code asks for.

        :param kind: its key in the joystick of `hal_data`
        """
        self.targets[f"joysticks[{port}].{kind}[{number}]"] = None


def watch_controls() -> AbstractContextManager[AskedControls]:
    """Watch until the context ends."""
    return _watches.watching(AskedControls)


def prepare_control_watch(prepare: bool = True) -> None:
    """Prepare `watch_controls` for the forks of this process, or undo that."""
    if prepare:
        _watches.prepare(AskedControls())
    else:
        _watches.undo()


def _replacements(asked: AskedControls) -> Iterator[tuple[Any, str, Any]]:
    return joysticks.replacements(asked.note)


_watches = PreparedPatches(_replacements)
