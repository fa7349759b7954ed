"""`HalData`: the root of the tree."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import hal
from wpilib import simulation as sim

from . import devices, driver_station
from .containers import LiveDict, LiveList, Slot, kept, plain
from .fields import group
from .kinds import UnknownKey, WrongPath, WrongType
from .modules import Modules
from .paths import Segment, format_path, join, parse_path
from .recording import Recording
from .sim_devices import RobotDict, SimDevices

#: The keys whose value is a part of one of the robot's pneumatics modules.
_OF_A_MODULE = ("solenoid", "compressor")


class HalData(LiveDict):
    """The robot's inputs and outputs as one tree of dicts and lists, live over WPILib's simulated HAL.

    ``hal_data['pwm'][3]['value']`` asks WPILib for the output the robot has set;
    ``hal_data['dio'][1]['value'] = True`` is what the robot reads next. There may be several trees, made
    before or after the robot's devices: none keeps a value that the HAL has. Making one sets the inputs that
    the HAL leaves open: see `apply_defaults`.

    :param defaults: whether to set them; in a run, they are set when it begins
    """

    def __init__(self, defaults: bool = True) -> None:
        super().__init__("", self._values)
        self.modules = Modules()
        self._recording: Recording | None = None
        self._rooms: dict[Any, Any] = {"custom": {}, "reports": {}}
        self._makers = self._room_makers()
        if defaults:
            self.apply_defaults()

    def apply_defaults(self) -> None:
        """Red alliance, station 1, at the event 'sim-event', where neither has been said yet."""
        if sim.DriverStationSim.getAllianceStationId() == hal.AllianceStationID.kUnknown:
            self["alliance_station"] = "red1"
        if not self["event"]["name"]:
            self["event"]["name"] = "sim-event"

    @staticmethod
    def _values() -> dict[str, Slot]:
        return {
            "alliance_station": driver_station.ALLIANCE_STATION.slot(sim.DriverStationSim),
            "fpga_button": devices.FPGA_BUTTON.slot(sim.RoboRioSim),
            "user_program_state": Slot(driver_station.program_state, None),
            "error_data": kept(),
            "pwm_loop_timing": kept(40),
            "d0_pwm_rate": kept(),
        }

    def _room_makers(self) -> dict[str, Callable[[], Any]]:
        modules = self.modules
        return {
            "control": lambda: group("control", sim.DriverStationSim, driver_station.CONTROL),
            "time": lambda: group("time", sim.DriverStationSim, driver_station.TIME),
            "event": driver_station.Event,
            "joysticks": driver_station.joysticks,
            "robot": lambda: RobotDict(self["CAN"]),
            "accelerometer": lambda: group("accelerometer", sim.BuiltInAccelerometerSim(), devices.ACCELEROMETER),
            **{kind.name: kind.devices for kind in devices.KINDS},
            "pcm": lambda: modules.pcm,
            "ph": lambda: modules.ph,
            "pcm_compressor": lambda: modules.pcm_compressor,
            "ph_compressor": lambda: modules.ph_compressor,
            "pdp": lambda: modules.pdp,
            "power": lambda: group("power", sim.RoboRioSim, devices.POWER),
            "roborio": lambda: group("roborio", sim.RoboRioSim, devices.ROBORIO),
            "CAN": SimDevices,
        }

    def __getitem__(self, key: Any) -> Any:
        try:
            return self._rooms[key]
        except (KeyError, TypeError):
            pass
        if key in _OF_A_MODULE:
            # Not kept: which module's it is depends on what the robot has made.
            return getattr(self.modules, key)
        if isinstance(key, str) and key in self._makers:
            room = self._rooms[key] = self._makers[key]()
            return room
        return super().__getitem__(key)

    def __setitem__(self, key: Any, value: Any) -> None:
        if key in self._slots:
            super().__setitem__(key, value)
            return
        room = self[key]
        if isinstance(room, (LiveDict, LiveList)):
            room.assign(value)
        elif room is not value:
            if not isinstance(value, Mapping):
                raise WrongType(f"expected a dict, not a {type(value).__name__}", where=key)
            new = dict(value)
            room.clear()
            room.update(new)

    def __contains__(self, key: object) -> bool:
        return key in self._rooms or key in self._makers or key in _OF_A_MODULE or key in self._slots

    def __iter__(self) -> Iterator[str]:
        return iter([*self._slots, *self._makers, *_OF_A_MODULE, "custom", "reports"])

    def __repr__(self) -> str:
        return f"<hal_data: {', '.join(self)}>"

    def read(self, path: str) -> Any:
        """The value at a path such as ``joysticks[0].axes[1]``.

        Raises `ValueError` for a text that is no path and for one that leads into something without parts,
        `KeyError` or `IndexError` for a part that is not there; each names the part.
        """
        return self._walk(parse_path(path))

    def write(self, path: str, value: Any) -> None:
        """Write the value at a path; raises what `read` raises, and what writing raises."""
        *parents, last = parse_path(path)
        place = self._walk(tuple(parents))
        self._has_parts(place, tuple(parents), last)
        place[last] = value

    def can_write(self, path: str) -> bool:
        """Whether the value at a path can be written, by itself or in its parts."""
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
                # The live containers say it themselves; what is free is a dict of the user's.
                if isinstance(place, (LiveDict, LiveList)):
                    raise
                where = format_path(segments[:depth])
                raise UnknownKey(f"there is no {segment!r} in {where}", where=join(where, segment)) from problem
        return place

    @staticmethod
    def _has_parts(place: Any, segments: tuple[Segment, ...], segment: Segment) -> None:
        if isinstance(place, (LiveDict, dict)):
            return
        if not isinstance(place, (LiveList, list, tuple)):
            raise WrongPath(f"{format_path(segments)} is a {type(place).__name__}: it has no part {segment!r}")
        if not isinstance(segment, int):
            where = format_path(segments)
            problem = f"{where} is a list: it has no part {segment!r}"
            raise WrongPath(problem, remedy=f"use an index, such as {where}[0]")

    def sync(self) -> None:
        """Find SimDevices that the robot has made, and hand them what was written to `robot` for them."""
        robot = self._rooms.get("robot")
        if robot is not None and robot.waits_for_devices:  # looking for them costs more than a robot's whole loop
            robot.sync()

    def anything_made(self) -> bool:
        """Return whether any device exists in the HAL."""
        return self._recorder().anything_made()

    def devices_made(self) -> list[str]:
        """Return the devices that exist in the HAL, as ``pwm[3]``."""
        return self._recorder().devices_made()

    def leaves(self) -> list[tuple[str, Any]]:
        """The robot and its inputs at this moment, as pairs of path and plain value, in a fixed order.

        Mode, match, joysticks that have any control, devices that the robot has made, SimDevices, `robot` and
        `custom`. Nothing in it depends on the wall clock or the machine.
        """
        return list(zip(*self.paths_and_values(), strict=True))

    def paths_and_values(self) -> tuple[list[str], list[Any]]:
        """The same in two lists: the paths, the same list while they are the same, and the values."""
        return self._recorder().look()

    def _recorder(self) -> Recording:
        if self._recording is None:
            self._recording = Recording(self, self.modules)
        return self._recording

    def snapshot(self) -> dict[str, Any]:
        """A copy of the whole tree in dicts, lists, numbers, strings, bools and None, fit for ``json``."""
        copy: dict[str, Any] = plain(self)
        return copy
