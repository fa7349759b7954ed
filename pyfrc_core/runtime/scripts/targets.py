"""What an input script can write: places in `hal_data`, and what the driver station and the network do.

- ``mode``: ``disabled``, ``autonomous``, ``teleop``, ``test``, or ``disabled autonomous``: about to be enabled
- ``match_time``: seconds left in the period; they count down from then on (``time.remaining`` stands still)
- ``joysticks[0].plugged``: false: unplugged, with no axes, buttons and POVs; true: plugged in again, nothing pressed
- ``packet``: true: a packet is delivered at once, out of turn, as tests can have it
- ``restart``: true: the robot program ends as without power, and starts again; more in `boots`
- ``nt:/SmartDashboard/x``: an entry of NetworkTables; a SendableChooser's choice is its entry ``selected``;
  more in `network_targets`
- ``hold:encoder[0].count``, ``hold:nt:/limelight/tx``: what a sensor or a camera measures, whatever physics writes;
  null ends it; more in `sensors`
- anything else: a path in `hal_data`, such as ``joysticks[0].axes[1]`` or ``event.game_specific_message``
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

from ...errors import UsageError
from ...hal import HalData, LiveDict, format_path, parse_path
from ...hal.rows import made_by_robot, row_of
from ...wpi import station
from ..clock import to_us
from .held import HeldValues
from .network_entries import NetworkEntries
from .network_targets import NETWORK
from .sensors import HOLD

MODE, MATCH_TIME, PACKET, RESTART = "mode", "match_time", "packet", "restart"
#: The path of the name of the chosen opmode.
OPMODE = "control.opmode"

#: The path of the seconds left: written, they stand still.
REMAINING = "time.remaining"

_BUTTON = re.compile(r"joysticks\[[0-5]\]\.buttons\[(\d+)\]")
#: A joystick that is plugged in or unplugged: its port.
PLUGGED = re.compile(r"joysticks\[([0-5])\]\.plugged")


def plugged(port: int) -> str:
    """The target that says whether a joystick is plugged in."""
    return f"joysticks[{port}].plugged"


class Countdown:
    """The match's time: so many seconds are left at one moment, and less and less from then on."""

    def __init__(self) -> None:
        #: When it ends; None before it was started.
        self._ends_us: int | None = None

    def start(self, left: float, now_us: int) -> None:
        self._ends_us = now_us + to_us(left)

    def stop(self) -> None:
        self._ends_us = None

    def left(self, now_us: int) -> float | None:
        """The seconds left; None before it was started."""
        return None if self._ends_us is None else max(0, self._ends_us - now_us) / 1_000_000


class Targets:
    """Writes to one run's targets.

    :param hal_data: the run's inputs and outputs
    :param deliver: delivers a packet
    :param when_network_written: called with each write to NetworkTables
    """

    def __init__(
        self,
        hal_data: HalData,
        deliver: Callable[[], object] = station.deliver_packet,
        when_network_written: Iterable[Callable[[str, Any], object]] = (),
    ) -> None:
        self._hal_data = hal_data
        self._deliver = deliver
        self._when_network_written = when_network_written
        self._entries = NetworkEntries()
        #: What a log measured.
        self.held = HeldValues(hal_data, self._entries)
        #: Where `hal_data` has what was written, if that always leads to the same dict or list: most writes do.
        self._places: dict[str, tuple[Any, Any]] = {}
        self._countdown = Countdown()

    def close(self) -> None:
        """Leave nothing to later runs in this process."""
        self.held.close()
        self._entries.close()

    def write(self, target: str, value: Any, now_us: int) -> None:
        """Write one value.

        :raises PyfrcError: when there is no such target, or it cannot have this value
        """
        kept = self._places.get(target)
        if kept is not None:
            place, key = kept
            place[key] = value
        elif target == MODE:
            station.set_mode_named(value)
        elif target == MATCH_TIME:
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise UsageError(f"match_time is a number of seconds, not {value!r}")
            self._countdown.start(value, now_us)
            station.set_match_time(value)
        elif target == PACKET:
            self._deliver()
            station.refresh()
        elif target == RESTART:
            raise UsageError("only pyfrc replay and control.replay() can start the robot program again")
        elif target.startswith(NETWORK):
            self._entries.write(target, value)
            for listener in self._when_network_written:
                listener(target, value)
        elif target.startswith(HOLD):
            self.held.write(target, value, now_us)
        elif (stick := PLUGGED.fullmatch(target)) is not None:
            station.plug_in(int(stick[1])) if value else station.unplug(int(stick[1]))
        else:
            if target == REMAINING:
                self._countdown.stop()
            place, key = self._hal_data.locate(target)
            place[key] = value
            row = row_of(target)
            if row is not None and not row.kind.by_number and target != REMAINING:
                self._places[target] = place, key

    def check(self, target: str) -> None:
        """See that there is such a target, or may be when the robot has made its devices.

        :raises PyfrcError: when there never is
        """
        if self._is_path(target):
            button = _BUTTON.fullmatch(target)
            if button is not None and int(button[1]) <= station.MAX_BUTTONS:
                return  # the script may write how many buttons the joystick has
            if not made_by_robot(target):
                self._hal_data.read(target)

    def check_made(self, target: str) -> None:
        """See that the robot has made what the target is part of.

        :raises PyfrcError: when it has not
        """
        if not self._is_path(target):
            return
        place: Any = self._hal_data
        for depth, segment in enumerate(segments := parse_path(target)):
            place = place[segment]
            if isinstance(place, LiveDict) and place.get("initialized") is False:
                raise UsageError(f"this robot has no {format_path(segments[: depth + 1])}")

    def count_down(self, now_us: int) -> None:
        """Called at each packet: the match's time goes on."""
        if (left := self._countdown.left(now_us)) is not None:
            station.set_match_time(left)

    @staticmethod
    def _is_path(target: str) -> bool:
        return (
            target not in (MODE, MATCH_TIME, PACKET, RESTART)
            and not target.startswith((NETWORK, HOLD))
            and not PLUGGED.fullmatch(target)
        )
