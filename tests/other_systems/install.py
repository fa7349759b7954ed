"""Another system, in an interpreter that has just started."""

from __future__ import annotations

import os

from . import clock, processes, sockets, standard_library, text
from .files import CaseInsensitive, Open, WindowsFiles
from .imports import Imports, read_absent
from .stand_ins import INSTEAD, ONLY_WINDOWS

#: The directory of a run, with what the runner has found out.
DIRECTORY = "PYFRC_TESTS_ON_DIRECTORY"

_UNIX = {"fcntl", "grp", "posix", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty"}


def install(system: str) -> None:
    """Replace what differs, in this process and in those that it starts.

    :param system: "windows" or "macos"
    """
    absent = read_absent(os.environ[DIRECTORY])
    if system == "windows":
        _install_windows(absent)
    else:
        _install_macos(absent)


def _install_windows(absent: dict[str, frozenset[str]]) -> None:
    absent = {"ctypes": frozenset(), **absent}
    files = WindowsFiles()
    files.install()
    Open(files, text.of_file).install()
    text.install()
    clock.install()
    processes.install()
    Imports(frozenset(_UNIX), absent, INSTEAD, ONLY_WINDOWS, standard_library.WINDOWS).install()


def _install_macos(absent: dict[str, frozenset[str]]) -> None:
    files = CaseInsensitive()
    files.install()
    Open(files).install()
    sockets.install()
    instead = {"sys": {"platform": "darwin"}}
    Imports(frozenset(), absent, instead, {}, standard_library.MACOS).install()
