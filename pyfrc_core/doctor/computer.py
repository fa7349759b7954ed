"""Checks of this computer: a browser and a display for the simulator, and pyfrc's optional packages."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec

from .._version import requirement
from ..browser import why_no_browser
from ..display import GET_TKINTER, WITHOUT_DISPLAY, has_display, has_tkinter
from .check_result import CheckResult, hint, ok

#: Each of pyfrc's extras with its module and its purpose.
EXTRAS = {
    "cluster": ("distributed", "pyfrc fuzz --scheduler"),
    "gamepads": ("pygame", "gamepads in pyfrc sim"),
    "picture": ("PIL", "--picture of pyfrc sim and pyfrc replay"),
    "profile": ("pyinstrument", "--html of pyfrc profile"),
    "wpilib-window": ("halsim_gui", "pyfrc sim --ui wpilib"),
}


def check_browser() -> Iterator[CheckResult]:
    """Check whether `pyfrc sim` can open its page."""
    if why := why_no_browser():
        yield hint(
            "browser",
            f"pyfrc sim cannot open one: {why}",
            "It prints the address of its page. Open that in a browser, on another computer through a forwarded port.",
        )
    else:
        yield ok("browser", "pyfrc sim opens its page in one")


def check_window() -> Iterator[CheckResult]:
    """Check whether `pyfrc sim --ui tk` can show its window."""
    if not has_display():
        yield hint("window", "pyfrc sim --ui tk cannot show one: there is no display", WITHOUT_DISPLAY)
    elif not has_tkinter():
        yield hint("window", "pyfrc sim --ui tk cannot show one: this Python has no tkinter", GET_TKINTER)
    else:
        yield ok("window", "there is a display, and tkinter")


def check_extras() -> Iterator[CheckResult]:
    """Check which extras are installed."""
    for extra, (module, use) in EXTRAS.items():
        if find_spec(module) is None:
            yield hint("extras", f"{use}: not installed", f'To install it: pip install "{requirement(extra)}"')
        else:
            yield ok("extras", f"{use}: installed")
