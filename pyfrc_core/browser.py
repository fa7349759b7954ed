"""Open a page in the user's browser, and decide from the environment alone whether that is possible here.

Python's `webbrowser` would also start a browser on another computer's screen (over SSH), or a text browser that takes
over the terminal.
"""

from __future__ import annotations

import os

from .display import has_display

#: Browsers that run in the terminal, as `webbrowser` names them.
_TEXT_BROWSERS = ("www-browser", "links", "elinks", "lynx", "w3m")


def is_ci() -> bool:
    """Return whether this is a job of continuous integration: all known systems set `CI`."""
    return os.environ.get("CI", "").lower() not in ("", "0", "false")


def why_no_browser() -> str:
    """Return why no page can be opened in a browser here; empty if one can.

    `BROWSER` is the user's own choice, or the editor's: VS Code sets it in containers, Codespaces and SSH sessions, and
    ChromeOS in its Linux container. Such a command opens the page where the person sits.
    """
    if is_ci():
        return "CI is set"
    if os.environ.get("BROWSER"):
        return ""
    if os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"):
        return "this is an SSH session"
    return "" if has_display() else "there is no display"


def open_in_browser(address: str) -> bool:
    """Open a page, and return whether a browser was found."""
    import webbrowser

    try:
        usual = getattr(webbrowser.get(), "name", "")
        if usual in _TEXT_BROWSERS and not os.environ.get("BROWSER"):
            return False
        return webbrowser.open(address)
    except webbrowser.Error:
        return False
