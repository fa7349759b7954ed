"""The texts that front ends show."""

from __future__ import annotations

import math
import re
from itertools import takewhile
from typing import Any

from ....physics.pose import Pose
from ....processes.standstill import REPORTED_AFTER
from ....season import CURRENT
from ...engine.commands import ChosenMode
from ...engine.messages import NO_CONNECTION, UNKNOWN_MODE
from ...engine.snapshot import Snapshot, Status

#: The alliance stations: as they are shown, in the order of their numbers, and as they are commanded.
STATIONS = {f"{color.title()} {number}": f"{color}{number}" for color in ("red", "blue") for number in (1, 2, 3)}

#: The modes that a driver can choose, as they are shown, in the order of their buttons.
MODES: dict[ChosenMode, str] = {"teleop": "Teleoperated", "autonomous": "Autonomous", "test": CURRENT.test_mode}
#: What is shown instead of an opmode's name when none is chosen.
NO_OPMODE = "No opmode"

_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?", re.ASCII)
_NUMBER = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)(e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
_MOST_QUOTED = 40
#: The longest of two differing values that is shown whole, in letters.
_LONGEST_DIFFERING = 40

# Colours and the like, for terminals.
_ESCAPES = re.compile(r"\x1b(\[[0-?]*[ -/]*[@-~]|[@-Z\\-_])|[\x00-\x08\x0b-\x1f\x7f]")


def clock(seconds: float) -> str:
    """Return a moment of robot time as ``1:02.34``, precise enough to show each packet."""
    minutes, hundredths = divmod(round(max(seconds, 0.0) * 100), 6000)
    return f"{minutes}:{hundredths // 100:02}.{hundredths % 100:02}"


def differing_texts(one: Any, other: Any) -> tuple[str, str]:
    """Return two values as texts; of long ones, the place where they differ."""
    texts = [f"{value:.6g}" if isinstance(value, float) else str(value) for value in (one, other)]
    if texts[0] == texts[1]:  # numbers that are close
        texts = [str(value) for value in (one, other)]
    equal = takewhile(lambda letters: letters[0] == letters[1], zip(*texts, strict=False))
    same = sum(1 for _ in equal)
    longest = _LONGEST_DIFFERING
    skipped = max(same - longest // 2, 0) if max(map(len, texts)) > longest else 0
    first, second = (
        ("..." if skipped else "")
        + (text[skipped:] if len(text) - skipped <= longest else f"{text[skipped : skipped + longest - 3]}...")
        for text in texts
    )
    return first, second


def speed_text(speed: float) -> str:
    """Return the wanted speed of robot time."""
    return "max" if speed == 0 else f"{speed:.2g}x"


def mode_text(snapshot: Snapshot | None, status: Status) -> tuple[str, str]:
    """Return what the robot is doing, and its kind: ``wait``, ``error``, ``disabled`` or ``enabled``."""
    if status.state == "failed":
        return "No robot code", "error"
    if not status.responding:
        stands = status.standstill
        if stands is not None and stands.seconds >= REPORTED_AFTER:
            return f"Not responding: {stands.place}", "error"
        return "Not responding", "error"
    if status.state == "starting" and status.replaying_to:
        return f"Replaying {clock(status.replayed)} of {clock(status.replaying_to)}", "wait"
    if snapshot is None or status.state == "starting":
        return "Starting…", "wait"
    if snapshot.mode in (NO_CONNECTION, UNKNOWN_MODE):
        return ("No connection", "wait") if snapshot.mode == NO_CONNECTION else ("Connected", "disabled")
    if snapshot.emergency_stopped:
        return "Emergency stopped", "error"
    if not snapshot.station_attached:
        return "Driver station lost (F8)", "disabled"
    mode = MODES[snapshot.chosen_mode]
    left = "" if snapshot.practice_since is None else f", {snapshot.match_left:.0f} s"
    if snapshot.enabled:
        return f"{mode} enabled{left}", "enabled"
    return f"{mode} disabled{left}", "disabled"


def status_texts(snapshot: Snapshot | None, status: Status) -> list[str]:
    """Return the parts of the status line."""
    time = 0.0 if snapshot is None else snapshot.time
    going = status.state == "running"
    reached = f"Speed {status.reached:.2f}x of {speed_text(status.speed)}"
    if status.speed == 0:
        reached = f"Speed {status.reached:.0f}x, as fast as it goes"
    parts = [
        f"Robot time {time:.2f} s",
        reached if going else status.state.capitalize(),
        f"Computing {status.packet_seconds * 1000:.1f} ms, worst {status.worst_packet_seconds * 1000:.1f} ms",
        f"Overruns {status.overruns}",
    ]
    if status.network_address:
        parts.append(f"NetworkTables {status.network_address}")
    return parts


def plain_output(text: str) -> str:
    """Return a program's output without control sequences for terminals."""
    return _ESCAPES.sub("", text.replace("\r\n", "\n"))


def number_text(value: float, decimals: int) -> str:
    """Return a number in few characters."""
    if not math.isfinite(value):
        return str(value)
    if abs(value) >= 1e6:
        return f"{value:.3g}"
    text = f"{value:.{decimals}f}"
    return text[1:] if float(text) == 0 and text.startswith("-") else text


def shown_number(value: float) -> str:
    """Return any number with six significant digits, and with all digits before its point."""
    if isinstance(value, int) or not math.isfinite(value):
        return str(value)
    return f"{value:.6g}" if abs(value) < 1000 else repr(round(value, 3)).removesuffix(".0")


def typed_number(text: str) -> float:
    """Return the number that a person has typed, with a point or a comma before its decimals.

    `format.js` has the same rules.

    :raises ValueError: with the reason, when it is none
    """
    typed = text.strip()
    shown = f"“{typed if len(typed) <= _MOST_QUOTED else typed[:_MOST_QUOTED] + '…'}”"
    if _THOUSANDS.fullmatch(typed):
        raise ValueError(f"write thousands without a comma and decimals with a point, not {shown}")
    if not _NUMBER.fullmatch(typed):
        raise ValueError(f"a number is needed, not {shown}")
    value = float(typed.replace(",", "."))
    if not math.isfinite(value):
        raise ValueError(f"{shown} is too large")
    return value


def pose_text(robot: Pose | None) -> str:
    """Return the robot's place and heading."""
    if robot is None:
        return "no physics.py: see pyfrc create-physics"
    degrees = (math.degrees(robot.angle) + 180) % 360 - 180
    return f"x {robot.x:.2f} ft   y {robot.y:.2f} ft   heading {number_text(degrees, 1)}°"


def station_name(station: object) -> str:
    """Return the name of an alliance station from its number in WPILib."""
    names = list(STATIONS)
    return names[station - 1] if isinstance(station, int) and 1 <= station <= len(names) else ""
