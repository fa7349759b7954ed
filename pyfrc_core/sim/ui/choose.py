"""Which front end shows a simulation."""

from __future__ import annotations

from ...display import GET_TKINTER, has_display, has_tkinter
from ...errors import UsageError
from . import FrontEnd

#: What there is, and which of them the user can choose.
NAMES = ("tk", "wpilib", "none")


def default_name() -> tuple[str, str]:
    """The front end where nobody chooses one, and, where it is not the window, why."""
    if not has_display():
        return "none", "there is no display"
    if not has_tkinter():
        return "none", f"this Python has no tkinter. {GET_TKINTER}"
    return "tk", ""


def window(name: str) -> FrontEnd:
    """The front end of this name, ``tk`` or ``wpilib``.

    :raises UsageError: when there cannot be one here, saying what to do
    """
    if not has_display():
        raise UsageError(
            f"--ui {name} needs a display, and there is none",
            remedy="Run without a window: pyfrc sim --ui none --mode practice. "
            "In a container or over SSH: xvfb-run, or ssh -X.",
        )
    if name == "wpilib":
        from .wpilib import WpilibWindow

        return WpilibWindow()
    try:
        from .tk import TkFrontEnd
    except ImportError as missing:
        if missing.name not in ("tkinter", "_tkinter"):
            raise
        raise UsageError("--ui tk needs tkinter, which this Python has not", remedy=GET_TKINTER) from None
    return TkFrontEnd()
