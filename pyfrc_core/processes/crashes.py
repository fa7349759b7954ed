"""Exit codes of processes that have not ended themselves: signals, and what Windows has in their place."""

from __future__ import annotations

import signal

#: Those that programs end with; Microsoft calls them NTSTATUS values.
_EXCEPTIONS = {
    0xC0000005: "access violation",
    0xC000001D: "illegal instruction",
    0xC0000094: "integer division by zero",
    0xC00000FD: "stack overflow",
    0xC0000135: "a DLL was not found",
    0xC0000139: "a DLL lacks a function",
    0xC000013A: "Ctrl-C",
    0xC0000142: "a DLL could not be initialized",
    0xC0000374: "heap corruption",
    0xC0000409: "abort, or stack buffer overrun",
}
_FIRST_EXCEPTION = 0x80000000


def crash_of(status: int) -> str | None:
    """Return what has ended a process, such as ``signal 11 (SIGSEGV, segmentation fault)``; None if it was the process.

    :param status: its exit code; a signal's number, negative
    """
    if status < 0:
        return f"signal {-status} ({_signal_name(-status)})"
    if status >= _FIRST_EXCEPTION:
        return f"exception 0x{status:08X} ({_EXCEPTIONS.get(status, 'unknown')})"
    return None


def _signal_name(number: int) -> str:
    try:
        name = signal.Signals(number).name
    except ValueError:
        return "unknown"
    return f"{name}, segmentation fault" if name == "SIGSEGV" else name
