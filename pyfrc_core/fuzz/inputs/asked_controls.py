"""Watch which controls of its joysticks robot code asks for: drivers press what has a function.

The HAL knows only that a joystick is read. So the functions that read are intercepted in Python.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import starmap

from ...patch_table import Patch, patched
from ...wpi import joysticks


class AskedControls:
    """The controls that robot code has asked for, as targets of scripts, in the order of the first time."""

    def __init__(self) -> None:
        self.targets: dict[str, None] = {}

    def note(self, port: int, kind: str, number: int) -> None:
        """Note a control that robot code asks for.

        :param kind: its key in the joystick of `hal_data`
        """
        self.targets[f"joysticks[{port}].{kind}[{number}]"] = None


@contextmanager
def watch_controls() -> Iterator[AskedControls]:
    """Watch until the context ends."""
    asked = AskedControls()
    with patched(starmap(Patch, joysticks.replacements(asked.note))):
        yield asked
