"""Report devices on one port: PWM, digital, analog and LED channels, which SystemCore has not four of, but one."""

from __future__ import annotations

from dataclasses import dataclass

from ...season.names.table import Table
from ..report import Report

#: The base class of the motor controllers on PWM channels.
_PWM_MOTOR = "wpilib.PWMMotorController"
#: Also the simulated HAL lets only one of these have a channel.
_EXCLUSIVE = {"digital", "LED"}
#: What to do if the ports do not suffice.
_TOO_FEW = (
    "Replace some by CAN devices, such as a motor controller with an encoder; motors and servos can also be on an "
    "ExpansionHub."
)


@dataclass(frozen=True, order=True)
class _Use:
    file: str
    line: int
    kind: str
    path: str


class Ports:
    """The channels of a project's devices."""

    def __init__(self, table: Table) -> None:
        self._table = table
        self._uses: dict[int, set[_Use]] = {}

    def kind(self, path: str) -> str:
        """Return the kind of a device's channel on the roboRIO; "" for what has no channel."""
        if path.startswith("wpilib.") and _PWM_MOTOR in self._table.ancestors(path):
            return "PWM"
        found: str = self._table.corrections["ports"]["kinds"].get(path, "")
        return found

    def use(self, file: str, line: int, path: str, number: int) -> None:
        """Note a device that is made."""
        self._uses.setdefault(number, set()).add(_Use(file, line, self.kind(path), path))

    def report(self, report: Report) -> None:
        """Report the devices that share a port, or have one that SystemCore has not."""
        count: int = self._table.corrections["ports"]["count"]
        free = [str(each) for each in range(count) if each not in self._uses]
        needed = sum(len({use.kind for use in found}) for found in self._uses.values())
        ports = f"SystemCore's ports 0 to {count - 1} are for PWM, digital, analog and LEDs together"
        share, write = (f"{ports}. {do}; free: {', '.join(free)}." for do in ("Give each its own", "Write yours"))
        if needed > count:
            share = write = f"{ports}, but this project needs {needed}. {_TOO_FEW}"
        for number, found in self._uses.items():
            first, *others = sorted(found)
            for use in (first, *others):
                what = f"{use.path.rpartition('.')[2]} has channel {number}"
                if use.kind != first.kind:
                    what += f", as the {first.path.rpartition('.')[2]} in {first.file}:{first.line}."
                    stops = {use.kind, first.kind} == _EXCLUSIVE
                    report.add(use.file, use.line, what, share, done=not stops)
                elif number >= count and use.kind != "LED":
                    report.add(use.file, use.line, f"{what}.", write, done=True)
