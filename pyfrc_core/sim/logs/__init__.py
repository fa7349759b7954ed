"""Logs of robots, as runs that are over: `open_log` reads a file, and the page shows what it returns.

In: a file of WPILib's data logs (also those of AdvantageKit and PyKit), of the driver station, or of pyfrc. Out: a
`PastRun`, with what is wrong with the file in one sentence. Each reader makes columns of a file, `Column`: the moments
at which one entry changed, and a function that decodes its values when they are looked at. So a large log opens
quickly, and its memory is that of the moments. `layout` finds the mode, the robot's place and the joysticks among them.

Needs no WPILib: a log of another season, and one that is cut, can be read.
"""

from .open import LogError, OpenedLog, open_log

__all__ = ["LogError", "OpenedLog", "open_log"]
