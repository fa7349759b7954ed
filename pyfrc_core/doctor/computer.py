"""Checks of this computer: a display for the simulator's window, and pyfrc's optional packages."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec

from .._version import requirement
from ..display import GET_TKINTER, has_display, has_tkinter
from .check_result import CheckResult, hint, ok

#: Each of pyfrc's extras with its module and its purpose.
EXTRAS = {
    "cluster": ("distributed", "pyfrc fuzz --scheduler"),
    "gamepads": ("pygame", "gamepads in pyfrc sim"),
    "picture": ("PIL", "--picture of pyfrc sim and pyfrc replay"),
    "profile": ("pyinstrument", "--html of pyfrc profile"),
    "wpilib-window": ("halsim_gui", "pyfrc sim --ui wpilib"),
}


def check_window() -> Iterator[CheckResult]:
    """Check whether `pyfrc sim` can show its window."""
    without = "Without a window: pyfrc sim --ui none --mode practice"
    if not has_display():
        yield hint("window", "pyfrc sim cannot show one: there is no display", without)
    elif not has_tkinter():
        yield hint("window", "pyfrc sim cannot show one: this Python has no tkinter", f"{GET_TKINTER} {without}")
    else:
        yield ok("window", "there is a display, and tkinter")


def check_extras() -> Iterator[CheckResult]:
    """Check which extras are installed."""
    for extra, (module, use) in EXTRAS.items():
        if find_spec(module) is None:
            yield hint("extras", f"{use}: not installed", f'To install it: pip install "{requirement(extra)}"')
        else:
            yield ok("extras", f"{use}: installed")
