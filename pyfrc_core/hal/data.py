"""`HalData`: the root of the tree."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property, partial
from itertools import chain
from typing import Any

from . import device_table
from .change_reader import ChangeReader
from .containers import LiveDict, LiveList, Slot, plain, stored
from .kinds import UnknownKey, WrongPath, WrongType
from .modules import Modules
from .paths import Segment, format_path, join, parse_path
from .robot_devices import RobotDevices, TreeDevice
from .sim_devices import RobotDict, SimDevices
from .tree_reader import TreeReader

#: The keys whose value belongs to one of the robot's pneumatics modules.
_OF_A_MODULE = ("solenoid", "compressor")


class HalData(LiveDict):
    """The robot's inputs and outputs as one tree of dicts and lists, live over WPILib's simulated HAL.

    ``hal_data['pwm'][3]['value']`` reads the output that the robot has set; ``hal_data['dio'][1]['value'] = True`` is
    what the robot reads next. There may be several trees, created before or after the robot's devices: none stores a
    value that the HAL has. Creating one sets the inputs that the HAL leaves open: see `apply_defaults`.

    :param defaults: whether to set them; a run sets them when it begins
    """

    def __init__(self, defaults: bool = True) -> None:
        super().__init__("", self._values)
        self.modules = Modules()
        self._branches: dict[Any, Any] = {"custom": {}, "reports": {}}
        self._builders = self._branch_builders()
        if defaults:
            self.apply_defaults()

    def apply_defaults(self) -> None:
        """Set red alliance, station 1, and the event name 'sim-event', unless they were set before."""
        if self["alliance_station"] == 0:  # unknown
            self["alliance_station"] = "red1"
        if not self["event"]["name"]:
            self["event"]["name"] = "sim-event"

    @staticmethod
    def _values() -> dict[str, Slot]:
        own = [kind.slots() for kind in device_table.KINDS if not kind.name]
        missing = {"error_data": stored(), "pwm_loop_timing": stored(40), "d0_pwm_rate": stored()}
        return dict(chain.from_iterable(slots.items() for slots in (*own, missing)))

    def _branch_builders(self) -> dict[str, Callable[[], Any]]:
        kinds = [kind for kind in device_table.KINDS if kind.name]
        return {
            **{kind.name: kind.branch for kind in kinds if not kind.by_number},
            "robot": lambda: RobotDict(self["CAN"]),
            **{kind.name: partial(self.modules.by_key.__getitem__, kind.name) for kind in kinds if kind.by_number},
            "CAN": SimDevices,
        }

    def __getitem__(self, key: object) -> Any:
        try:
            return self._branches[key]
        except (KeyError, TypeError):
            pass
        if key in _OF_A_MODULE:
            # Not cached: the module depends on the devices that the robot has created.
            return getattr(self.modules, key)
        if isinstance(key, str) and key in self._builders:
            branch = self._branches[key] = self._builders[key]()
            return branch
        return super().__getitem__(key)

    def __setitem__(self, key: Any, value: Any) -> None:
        if key in self._slots:
            super().__setitem__(key, value)
            return
        branch = self[key]
        if isinstance(branch, (LiveDict, LiveList)):
            branch.assign(value)
        elif branch is not value:
            if not isinstance(value, Mapping):
                raise WrongType(f"expected a dict, not a {type(value).__name__}", where=key)
            new = dict(value)
            branch.clear()
            branch.update(new)

    def __contains__(self, key: object) -> bool:
        return key in self._branches or key in self._builders or key in _OF_A_MODULE or key in self._slots

    def __iter__(self) -> Iterator[str]:
        return iter([*self._slots, *self._builders, *_OF_A_MODULE, "custom", "reports"])

    def __repr__(self) -> str:
        return f"<hal_data: {', '.join(self)}>"

    def read(self, path: str) -> Any:
        """Return the value at a path such as ``joysticks[0].axes[1]``.

        :raises ValueError: when the text is not a path, or leads through a value without parts
        :raises LookupError: when a part does not exist; the error names it
        """
        return self._walk(parse_path(path))

    def locate(self, path: str) -> tuple[Any, Segment]:
        """Return the dict or list that contains the value at a path, and its key or index there.

        It is the same object as long as the robot removes no device: keep it to read or write a value often.

        :raises ValueError: as `read`
        :raises LookupError: as `read`, for the parts before the last one
        """
        *parents, last = parse_path(path)
        place = self._walk(tuple(parents))
        self._has_parts(place, tuple(parents), last)
        return place, last

    def write(self, path: str, value: object) -> None:
        """Write the value at a path.

        :raises ValueError: as `read`
        :raises LookupError: as `read`
        :raises PyfrcError: when the value cannot be written there
        """
        place, last = self.locate(path)
        place[last] = value

    def can_write(self, path: str) -> bool:
        """Return whether the value at a path, or its parts, can be written."""
        *parents, last = parse_path(path)
        place = self._walk(tuple(parents))
        slot = place._slots.get(str(last)) if isinstance(place, LiveDict) else None
        return slot is None or slot.set is not None or isinstance(place[last], LiveList)

    def _walk(self, segments: tuple[Segment, ...]) -> Any:
        place: Any = self
        for depth, segment in enumerate(segments):
            self._has_parts(place, segments[:depth], segment)
            try:
                place = place[segment]
            except LookupError as problem:
                # The live containers raise a complete error; the free branches are plain dicts.
                if isinstance(place, (LiveDict, LiveList)):
                    raise
                where = format_path(segments[:depth])
                raise UnknownKey(f"there is no {segment!r} in {where}", where=join(where, segment)) from problem
        return place

    @staticmethod
    def _has_parts(place: object, segments: tuple[Segment, ...], segment: Segment) -> None:
        if isinstance(place, (LiveDict, dict)):
            return
        if not isinstance(place, (LiveList, list, tuple)):
            raise WrongPath(f"{format_path(segments)} is a {type(place).__name__}: it has no part {segment!r}")
        if not isinstance(segment, int):
            where = format_path(segments)
            problem = f"{where} is a list: it has no part {segment!r}"
            raise WrongPath(problem, remedy=f"use an index, such as {where}[0]")

    def sync(self) -> None:
        """Find new SimDevices, and write the values that `robot` has stored for them."""
        robot = self._branches.get("robot")
        if robot is not None and robot.waits_for_devices:  # the search takes longer than a robot's whole loop
            robot.sync()

    def any_exist(self) -> bool:
        """Return whether any device exists in the HAL."""
        return self._robot_devices.any_exist()

    def existing(self) -> list[str]:
        """Return the devices that exist in the HAL, such as ``pwm[3]``."""
        return self._robot_devices.existing()

    def devices(self) -> list[TreeDevice]:
        """Return the devices that exist without the robot, and those that it has made; no SimDevices."""
        self.created()
        return [*self._robot_devices.always(), *self._robot_devices.made()]

    def created(self) -> list[bool]:
        """Return whether each device that the robot can make exists: the same list as long as nothing changes."""
        return self._robot_devices.created()

    def leaves(self) -> list[tuple[str, Any]]:
        """Return the current state of the robot and its inputs as pairs of path and plain value, in a fixed order.

        It contains the mode, match, joysticks with any control, the devices that the robot has created, SimDevices,
        `robot` and `custom`. It does not depend on the wall clock or the machine.
        """
        return list(zip(*self.paths_and_values(), strict=True))

    def paths_and_values(self) -> tuple[list[str], list[Any]]:
        """Return the same as two lists, of paths and of values.

        The list of paths stays the same object while it does not change.
        """
        return self._reader.read()

    def changes(self) -> ChangeReader:
        """Return a reader of what changes in `leaves` from now on; its first look finds all values."""
        return ChangeReader(self._new_reader())

    def _new_reader(self) -> TreeReader:
        return TreeReader(self, self._robot_devices)

    @cached_property
    def _reader(self) -> TreeReader:
        return self._new_reader()

    @cached_property
    def _robot_devices(self) -> RobotDevices:
        return RobotDevices(self, self.modules)

    def snapshot(self) -> dict[str, Any]:
        """Return a copy of the whole tree in dicts, lists, numbers, strings, bools and None, ready for ``json``."""
        copy: dict[str, Any] = plain(self)
        return copy
