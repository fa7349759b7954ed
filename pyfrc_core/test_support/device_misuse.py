"""Warn of what robot code does with objects that raises no error here: NaN as a speed, one CAN ID for two devices,
a motor as the requirement of a command."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ..compat.cpython_private import get_frame
from ..fuzz.oracle.motor_calls import watch_motor_calls
from ..patch_table import Patch, patched
from ..project.robot_files import RobotFiles
from ..wpi import devices


class DeviceWarning(UserWarning):
    """A device gets what it does not work with, although that raises no error here."""


@contextmanager
def warning_of_misuse(files: RobotFiles) -> Iterator[None]:
    """Warn, with the robot's line, until the context ends. The robot's modules must be imported."""
    misuse = _Misuse(files)
    with patched(misuse.patches()), watch_motor_calls() as calls:
        calls.listener = misuse.on_motor_call
        yield


class _Misuse:
    def __init__(self, files: RobotFiles) -> None:
        self._files = files
        self._warned: set[str] = set()
        #: The line that has created the device with an ID, by kind, bus and ID.
        self._created: dict[tuple[object, ...], str] = {}

    def on_motor_call(self, motor: object, name: str, numbers: tuple[float, ...], is_power: bool) -> None:
        if any(number != number for number in numbers):
            what = "which is no number: a motor stops then. Is something divided by 0, or a sensor without a value?"
            self._warn(f"{name}() gets NaN, {what}")

    def patches(self) -> Iterator[Patch]:
        """Yield the patches of the constructors of CAN devices that allow an ID twice."""
        owner = devices.CanDevice
        yield Patch(owner, "__init__", self._counted(owner.__init__, devices.can_key))
        phoenix = sys.modules.get("phoenix6.hardware")
        if phoenix is not None:
            device = phoenix.ParentDevice
            # Talons of all models are of one kind on the bus.
            key = lambda id, model, bus: (id, bus.name, "talon" if "talon" in model.lower() else model)  # noqa: E731
            yield Patch(device, "__init__", self._counted(device.__init__, key))

        if (commands2 := sys.modules.get("commands2")) is not None:
            command, subsystem = commands2.Command, commands2.Subsystem
            for name in {"addRequirements", "add_requirements"} & set(vars(command)):
                yield Patch(command, name, self._requiring(getattr(command, name), subsystem))

    def _requiring(self, real: Callable[..., None], subsystem: type[Any]) -> Callable[..., None]:
        def addRequirements(command: object, *requirements: object) -> None:
            __tracebackhide__ = True
            real(command, *requirements)
            for each in requirements:
                if not isinstance(each, subsystem):
                    what = f"the class {each.__name__}" if isinstance(each, type) else type(each).__name__
                    text = "is no subsystem: other commands can use it at the same time. Require its subsystem."
                    self._warn(f"a requirement ({what}) {text}")

        return addRequirements

    def _counted(self, real: Callable[..., None], key_of: Callable[..., tuple[Any, ...]]) -> Callable[..., None]:
        def __init__(device: object, *args: Any, **kwargs: Any) -> None:
            __tracebackhide__ = True
            real(device, *args, **kwargs)
            self._on_creation(key_of(*args, *kwargs.values()))

        return __init__

    def _on_creation(self, key: tuple[Any, ...]) -> None:
        line = self._files.line_of_call(get_frame(1)) or ""
        before = self._created.setdefault(key, line)
        if before != line:
            remedy = "Each needs an ID of its own, and one object in the program."
            self._warn(f"CAN ID {key[0]} is used already, since {before}, by a device of the same kind. {remedy}")

    def _warn(self, text: str) -> None:
        line = self._files.line_of_call(get_frame(1)) or ""
        if line and line not in self._warned:
            self._warned.add(line)
            file, _, number = line.rpartition(":")
            warnings.warn_explicit(f"{line}: {text}", DeviceWarning, self._files.root + file, int(number))
