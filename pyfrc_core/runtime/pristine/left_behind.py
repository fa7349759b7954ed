"""What a robot leaves behind: devices, entries of NetworkTables, commands, threads, objects of its classes."""

from __future__ import annotations

import gc
import threading
from collections.abc import Iterator
from enum import Enum
from typing import Any

from ...hal import existing_devices
from ...hal.reset import forget_inputs, forget_what_stays
from ...wpi import commands, dashboards, network, sim_devices
from .modules import ProjectModules
from .part import StatePart


class ScheduledCommands(StatePart):
    """The command scheduler: the next run gets a new one."""

    def restore(self) -> None:
        commands.forget_all()

    def left_over(self) -> Iterator[str]:
        yield from (f"the command {name}" for name in commands.names_of_scheduled())
        commands.forget_all()  # to ask for it has made the next scheduler


class Tables(StatePart):
    """The entries of the robot's tables."""

    def __init__(self) -> None:
        network.start()  # its thread, which lives as long as the process, is there from now on
        network.stop()

    def restore(self) -> None:
        dashboards.forget_shown()
        network.forget_entries()

    def left_over(self) -> Iterator[str]:
        for name in network.entry_names():
            if not name.startswith(network.OF_WPILIB):
                yield f"the entry {name} of NetworkTables"


class Threads(StatePart):
    """The threads that Python knows."""

    def __init__(self) -> None:
        self._before = set(threading.enumerate())

    def left_over(self) -> Iterator[str]:
        for thread in threading.enumerate():
            if thread not in self._before:
                yield f"the thread {thread.name!r}"


class ProjectObjects(StatePart):
    """The instances of classes of the project: all are gone after a run, unless something still holds them."""

    def __init__(self, modules: ProjectModules) -> None:
        self._modules = modules

    def restore(self) -> None:
        gc.collect()
        if found := self._found():
            # The collector does not see what C++ holds: a chooser holds commands, whose functions hold the robot.
            for each in found:
                attributes = getattr(each, "__dict__", None)
                if type(attributes) is dict:
                    attributes.clear()
            del found, each
            gc.collect()

    def left_over(self) -> Iterator[str]:
        kinds = {type(each) for each in self._found()}
        for kind in sorted(kinds, key=lambda kind: kind.__qualname__):
            yield f"an object of the class {kind.__module__}.{kind.__qualname__}"

    def _found(self) -> list[Any]:
        names = self._modules.names
        found = [each for each in gc.get_objects() if type(each).__module__ in names]
        # A class may stay for a while in a cache of Python's, and with it the members of an enumeration.
        return [each for each in found if not issubclass(type(each), Enum)]


class Devices(StatePart):
    """The devices: each ends with the object that has made it."""

    def __init__(self) -> None:
        self._before = existing_devices()

    def restore(self) -> None:
        forget_what_stays()
        sim_devices.forget_parts()

    def left_over(self) -> Iterator[str]:
        left = [device for device in existing_devices() if device not in self._before]
        yield from (f"the device {device}" for device in left)
        if not left:
            forget_inputs()
