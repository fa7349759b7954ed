"""Open a page in the user's browser, and decide from the environment alone whether that is possible here.

Python's `webbrowser` would also start a browser on another computer's screen (over SSH), or a text browser that takes
over the terminal.
"""

from __future__ import annotations

import html
import os
import tempfile
from pathlib import Path

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


def write_redirection(address: str, directory: Path) -> Path | None:
    """Write a page that leads to an address, and that only this user can read; a browser is started with its file.

    All users of a computer can read the command lines of its programs: an address with a key must not stand there.

    :param directory: where to write it; elsewhere if that is impossible. Some browsers are kept from temporary files
    :returns: None where a command in `BROWSER` opens addresses: an editor's passes them on to another computer, which
        has no such file
    :raises OSError: when it can be written nowhere
    """
    if os.environ.get("BROWSER"):
        return None
    shown = html.escape(address)
    text = (
        '<!doctype html><meta charset="utf-8"><meta name="referrer" content="no-referrer"><title>pyfrc</title>'
        f'<meta http-equiv="refresh" content="0; url={shown}"><p><a href="{shown}">The page of pyfrc</a></p>\n'
    )
    try:
        file, name = tempfile.mkstemp(".html", "open-", directory)
    except OSError:
        file, name = tempfile.mkstemp(".html", "pyfrc-")
    with os.fdopen(file, "w", encoding="utf-8") as opened:
        opened.write(text)
    return Path(name)


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
