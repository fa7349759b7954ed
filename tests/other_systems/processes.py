"""Processes as Windows has them: no signals, exit codes without them, groups in place of sessions."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from enum import IntEnum
from typing import Any

from .callers import Owner, caller
from .files import error

_kill = os.kill
_to_exitcode = os.waitstatus_to_exitcode
_start = subprocess.Popen.__init__
_signal, _getsignal = signal.signal, signal.getsignal

CREATE_NEW_PROCESS_GROUP = 0x200

_NOT_A_PROGRAM = (193, 8, "%1 is not a valid Win32 application")
_WRONG = (87, 22, "The parameter is incorrect")

#: What Windows reports of a process that one of these signals has ended on Linux.
_EXIT_CODES = {
    signal.SIGINT: 0xC000013A,
    signal.SIGILL: 0xC000001D,
    signal.SIGABRT: 3,
    signal.SIGFPE: 0xC0000094,
    signal.SIGSEGV: 0xC0000005,
    signal.SIGBUS: 0xC0000005,
}


class Signals(IntEnum):
    """Those of Windows, with Linux's numbers where Linux has them."""

    CTRL_C_EVENT = 0
    CTRL_BREAK_EVENT = 1
    SIGINT = signal.SIGINT
    SIGILL = signal.SIGILL
    SIGABRT = signal.SIGABRT
    SIGFPE = signal.SIGFPE
    SIGSEGV = signal.SIGSEGV
    SIGTERM = signal.SIGTERM
    SIGBREAK = signal.SIGUSR1  # it ends a process that has no handler, too


_SETTABLE = {each for each in Signals if each.name.startswith("SIG")}

#: What `signal` has there in place of its own, or besides.
SIGNAL: dict[str, Any] = {
    "Signals": Signals,
    **Signals.__members__,
    "valid_signals": lambda: set(_SETTABLE),
    "signal": lambda number, handler: _signal(_settable(number), handler),
    "getsignal": lambda number: _getsignal(_settable(number)),
}

#: The same for `subprocess`, whose own functions these are.
_CONSTANTS = {
    "CREATE_NEW_PROCESS_GROUP": CREATE_NEW_PROCESS_GROUP,
    "CREATE_NEW_CONSOLE": 0x10,
    "CREATE_NO_WINDOW": 0x8000000,
    "DETACHED_PROCESS": 0x8,
}


def _settable(number: int) -> int:
    if number not in _SETTABLE:
        raise ValueError("signal number out of range" if number > 64 else "invalid signal value")
    return int(number)


def kill(pid: int, number: int) -> None:
    """End a process, or send one of the two events of a console to a group of processes."""
    if isinstance(number, Signals) and number in (Signals.CTRL_C_EVENT, Signals.CTRL_BREAK_EVENT):
        os.killpg(pid, signal.SIGINT if number == Signals.CTRL_C_EVENT else Signals.SIGBREAK)
    elif number in (0, 1) and caller() is Owner.OURS:
        raise error(_WRONG, "os.kill(pid, 0) asks for Ctrl-C in a group of processes")
    else:
        _kill(pid, signal.SIGKILL if number else 0)


def exit_code(status: int) -> int:
    """Return the exit code of what `os.waitpid` has returned."""
    code = _to_exitcode(status)
    return _EXIT_CODES.get(-code, 1) if code < 0 else code


def _popen(self: subprocess.Popen[Any], args: Any, *arguments: Any, **options: Any) -> None:
    flags = options.pop("creationflags", 0)
    options.pop("startupinfo", None)
    if caller() is Owner.OURS:
        for name in ("preexec_fn", "pass_fds", "user", "group", "extra_groups", "process_group"):
            if options.get(name) not in (None, (), []) and options.get(name) != -1:
                raise ValueError(f"{name} is not supported on Windows platforms")
        options["start_new_session"] = False  # there are none
        args = _program(args)
    if flags & CREATE_NEW_PROCESS_GROUP:
        options["start_new_session"] = True
    _start(self, args, *arguments, **options)
    if self.text_mode and self.stdin is not None:  # type: ignore[attr-defined]
        self.stdin.reconfigure(newline="\r\n")  # type: ignore[attr-defined]


def _program(args: Any) -> Any:
    """Return how a program is started here.

    :raises OSError: for a script, which Windows does not start
    """
    if isinstance(args, str | os.PathLike) or not args:
        return args
    if args[0] == "taskkill":
        return [sys.executable, "-I", "-S", os.path.join(os.path.dirname(__file__), "taskkill.py"), *args[1:]]
    try:
        with open(args[0], "rb") as file:
            script = file.read(2) == b"#!"
    except OSError:
        script = False
    # Those beside Python have the suffix .exe there.
    if script and os.path.dirname(args[0]) != os.path.dirname(sys.executable):
        raise error(_NOT_A_PROGRAM, args[0])
    return args


def _send_signal(self: subprocess.Popen[Any], number: int) -> None:
    if self.poll() is not None:
        return
    if number == signal.SIGTERM or isinstance(number, Signals):
        os.kill(self.pid, number)
    else:
        raise ValueError(f"Unsupported signal: {number}")


def _terminate(self: subprocess.Popen[Any]) -> None:
    if self.poll() is None:
        _kill(self.pid, signal.SIGKILL)


def install() -> None:
    """Replace what starts and ends processes."""
    os.kill = kill
    os.waitstatus_to_exitcode = exit_code
    popen: Any = subprocess.Popen
    popen.__init__ = _popen
    if hasattr(subprocess, "_del_safe"):  # from Python 3.13 on
        subprocess._del_safe.waitstatus_to_exitcode = exit_code
    else:
        popen._handle_exitstatus.__defaults__ = (exit_code, *popen._handle_exitstatus.__defaults__[1:])
    popen.send_signal, popen.terminate, popen.kill = _send_signal, _terminate, _terminate
    for name, value in _CONSTANTS.items():
        setattr(subprocess, name, value)
