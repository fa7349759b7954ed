"""What this computer has for what pyfrc can do besides running robots: a window, gamepads, pictures."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec

from .._version import requirement
from ..display import GET_TKINTER, has_display, has_tkinter
from .findings import Finding, hint, ok

#: Each of pyfrc's extras, the module that it brings, and what it is for.
EXTRAS = {
    "gamepads": ("pygame", "gamepads in pyfrc sim"),
    "picture": ("PIL", "--picture of pyfrc sim and pyfrc replay"),
    "profile": ("pyinstrument", "--html of pyfrc profile"),
    "wpilib-window": ("halsim_gui", "pyfrc sim --ui wpilib"),
}


def examine_window() -> Iterator[Finding]:
    """Whether `pyfrc sim` can show its window."""
    without = "Without a window: pyfrc sim --ui none --mode practice"
    if not has_display():
        yield hint("window", "pyfrc sim shows none: there is no display", without)
    elif not has_tkinter():
        yield hint("window", "pyfrc sim shows none: this Python has no tkinter", f"{GET_TKINTER} {without}")
    else:
        yield ok("window", "there is a display, and tkinter")


def examine_extras() -> Iterator[Finding]:
    """Which of the extras are installed."""
    for extra, (module, use) in EXTRAS.items():
        if find_spec(module) is None:
            yield hint("extras", f"{use}: not installed", f'If you want it: pip install "{requirement(extra)}"')
        else:
            yield ok("extras", f"{use}: installed")
