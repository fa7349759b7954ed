"""The names that AdvantageKit and PyKit have for what the driver station sends.

Their logs have it in the table ``/DriverStation``, and what the robot has read from dashboards in ``/NetworkInputs``.
What they publish on NetworkTables is the same in the table ``/AdvantageKit``. `NAMES` has the names of WPILib's and
pyfrc's logs for it, by which everything else knows it. Buttons are the bits of a number there.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from .known_entries import whole

#: The table of NetworkTables in which they publish what they log.
TABLE = "/AdvantageKit"
#: How names in a log begin if a kit has written it, or if WPILib has logged what a kit has published.
PREFIXES = ("", f"NT:{TABLE}")
#: How the names begin of what the robot gets from outside; the last one is that of the time of each turn of the loop.
READ = ("/DriverStation/", "/NetworkInputs/", "/DashboardInputs/", "/Timestamp")
#: What each of their logs has.
ENABLED = "/DriverStation/Enabled"
#: What a log has of what robot code has computed.
OUTPUTS = ("/RealOutputs/", "/ReplayOutputs/")

_STICKS = range(6)
NAMES = {
    ENABLED: "DS:enabled",
    "/DriverStation/Autonomous": "DS:autonomous",
    "/DriverStation/Test": "DS:test",
    "/DriverStation/EmergencyStop": "DS:estop",
    "/DriverStation/AllianceStation": "/hal_data/alliance_station",
    "/DriverStation/DSAttached": "/hal_data/control.dsAttached",
    "/DriverStation/FMSAttached": "/hal_data/control.fmsAttached",
    "/DriverStation/MatchTime": "/hal_data/time.remaining",
    "/DriverStation/EventName": "/hal_data/event.name",
    "/DriverStation/MatchNumber": "/hal_data/event.match_number",
    "/DriverStation/MatchType": "/hal_data/event.match_type",
    "/DriverStation/GameSpecificMessage": "/hal_data/event.game_specific_message",
    **{f"/DriverStation/Joystick{stick}/AxisValues": f"DS:joystick{stick}/axes" for stick in _STICKS},
    **{f"/DriverStation/Joystick{stick}/POVs": f"DS:joystick{stick}/povs" for stick in _STICKS},
}
_COUNT, _BITS = whole(0, 32), whole(-(1 << 63), 1 << 63)
#: The number of each joystick's buttons, their bits, and WPILib's name for the list of them.
BUTTONS = [
    (f"{table}/ButtonCount", f"{table}/ButtonValues", f"DS:joystick{stick}/buttons")
    for stick, table in ((stick, f"/DriverStation/Joystick{stick}") for stick in _STICKS)
]
#: A pattern of the entries of NetworkTables that robot code does not compute: its inputs, what was printed, and for how
#: long it computed.
NOT_COMPUTED = rf"{TABLE}/(?!(?:Real|Replay)Outputs/(?!Logger/|LoggedRobot/|LogTracer/|Console$))"
#: What was read from NetworkTables; until 2024, AdvantageKit left out the table, SmartDashboard.
_READ_FROM_NETWORK = re.compile(r"/(Network|Dashboard)Inputs(/.+)", re.DOTALL)
#: The tables that are not what a subsystem has measured.
_OF_THE_ROBOT = re.compile(
    r"(?:(?:Real|Replay)(?:Outputs|Metadata)|DriverStation|SystemStats|PowerDistribution|RadioStatus"
    r"|(?:Network|Dashboard)Inputs|Timestamp|\.schema)(?:/|$)"
)


def is_of_a_kit(names: Iterable[str]) -> bool:
    """Return whether entries with these names are those of a kit's log."""
    return any(name == ENABLED or name.startswith(OUTPUTS) for name in names)


def pressed(count: Any, bits: Any) -> list[bool]:
    """Return which buttons are pressed.

    :param count: how many there are; if it is no number, that is not known
    """
    number, held = _COUNT(count), _BITS(bits) or 0
    return [bool(held >> each & 1) for each in range(32 if number is None else number)]


def entry_of(name: str, type_name: str) -> str | None:
    """Return WPILib's name of the entry of NetworkTables that a value was read from; None for other values.

    :param type_name: a text of SmartDashboard is taken for the choice of a chooser, whose name it has
    """
    found = _READ_FROM_NETWORK.fullmatch(name)
    if found is None:
        return None
    entry = found[2] if found[1] == "Network" else f"/SmartDashboard{found[2]}"
    is_choice = type_name == "string" and entry.startswith("/SmartDashboard/")
    return f"NT:{entry}/selected" if is_choice else f"NT:{entry}"


def subsystems(paths: Iterable[str]) -> Iterator[str]:
    """Yield the subsystems whose measurements are among these entries of NetworkTables."""
    tables = (path.removeprefix(f"{TABLE}/") for path in paths if path.startswith(f"{TABLE}/"))
    yield from dict.fromkeys(table.partition("/")[0] for table in tables if not _OF_THE_ROBOT.match(table))
