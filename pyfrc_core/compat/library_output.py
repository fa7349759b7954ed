"""What libraries print about themselves while a robot runs, and which of it a user sees.

The lines come from C++ code, some of it on threads of its own, so they can be removed from the output only. Only
whole lines are removed, and no errors.
"""

from __future__ import annotations

import re

_HIDDEN = re.compile(
    "|".join(
        (
            # WPILib, of its camera server on a roboRIO.
            r"Not loading CameraServerShared",
            # WPILib, of a method that only pyfrc overrides.
            r"Default SimulationPeriodic\(\) method\.\.\. Override me!",
            # NetworkTables, of its ports, and of the file that a robot keeps.
            r"NT: Listening on NT3 port \d+, NT4 port \d+",
            r"NT: could not open persistent file .* \(this can be ignored .*\)",
            # Data logs: pyfrc prints their names.
            r"DataLog: Logging to '.*' \(.* free space\)",
            # WPILib, of an opmode: what robot code does then is what a user looks for.
            r"\*{10} (Creating|Starting|Ending|Closing) OpMode .* \*{10}",
            # Studica's navX, of the sensor that it simulates.
            r"Instantiating NavX on .*",
            r"navX-Sensor SimDevice created\.",
            r"NavX: (Library for FRC|Connected\.|Board Type \d+ \(.*\)|firmware version [\d.]+"
            r"|startup initialization and startup calibration complete\.|onboard startup calibration complete\."
            r"|Yaw angle auto-reset to 0\.0 due to startup calibration\.)",
            # CTRE's phoenix6, of its simulated bus, and of the port for its diagnostics, which one process can have.
            r"\[phoenix\] (CANbus Connected: sim|CANbus Network Up: sim|Library initialization is complete\.)",
            r"\[phoenix-diagnostics\] Server .* (running on port: \d+|first attempt to open server failed at port \d+)",
        )
    )
)
#: WPILib, of a method that the robot does not have: said once, since each test starts the robot again.
_ONCE = re.compile(r"Default \w+\(\) method\.\.\. Override me!")
#: The lines after which phoenix6 prints a line with only a tab.
_THEN_TAB = re.compile(r"\[phoenix\] Library|\[phoenix-diagnostics\]")
_TAB = "\t"

#: What the lines above begin with.
_STARTS = (
    "Not loading ",
    "Default ",
    "NT: ",
    "DataLog: ",
    "*" * 10,
    "Instantiating NavX ",
    "navX-",
    "NavX: ",
    "[phoenix",
)
#: Longer lines are none of these.
_LONGEST = 400


class LibraryOutput:
    """Removes libraries' lines from the output of one or more robots."""

    def __init__(self) -> None:
        #: The beginning of a line that may be one to remove.
        self._held = ""
        self._in_line = False
        self._tabs = 0
        self._said: set[str] = set()

    def feed(self, text: str) -> str:
        """Return the next piece of the output without these lines.

        The beginning of a line is kept back as long as it may be the beginning of such a line.
        """
        *whole, last = (self._held + text).split("\n")
        shown = []
        for line in whole:
            if self._in_line or not self._hides(line):
                shown.append(f"{line}\n")
            self._in_line = False
        if last and (self._in_line or not self._may_be_hidden(last)):
            shown.append(last)
            self._in_line, last = True, ""
        self._held = last
        return "".join(shown)

    def flush(self) -> str:
        """Return what is kept back, at the end of an output."""
        held, self._held = self._held, ""
        hides = self._hides(held)
        self._in_line = self._in_line or bool(held and not hides)
        return "" if hides else held

    def end(self) -> str:
        """Return what is kept back; the next piece is the beginning of another output."""
        held = self.flush()
        self._in_line, self._tabs = False, 0
        return held

    def of_whole(self, text: str) -> str:
        """Return an output that is complete without these lines."""
        return self.feed(text) + self.end()

    def _hides(self, line: str) -> bool:
        line = line.removesuffix("\r")
        if line == _TAB and self._tabs:
            self._tabs -= 1
            return True
        if _HIDDEN.fullmatch(line):
            self._tabs += bool(_THEN_TAB.match(line))
            return True
        if _ONCE.fullmatch(line):
            said = line in self._said
            self._said.add(line)
            return said
        return False

    def _may_be_hidden(self, beginning: str) -> bool:
        if self._tabs and beginning == _TAB:
            return True
        return len(beginning) < _LONGEST and any(
            beginning.startswith(start) or start.startswith(beginning) for start in _STARTS
        )
