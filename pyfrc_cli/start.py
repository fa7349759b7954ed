"""Entry point of the `pyfrc` command: fix Python's hash seed, then run the command line.

Python orders sets of strings by a random number, drawn at each start. A robot that iterates over such a set repeats
itself only when that number is fixed, so commands that run robots restart Python with a fixed one, before
other modules are imported.
"""

from __future__ import annotations

import os
import sys

_RUN_ROBOTS = {"create-physics", "fuzz", "replay", "test"}


def main() -> None:
    """Run the command."""
    _open_closed_streams()
    _remove_current_directory(_current_directory())
    from pyfrc_core.interruption import interruption
    from pyfrc_core.processes.exit import end_without_destruction

    set_status = end_without_destruction()
    status = 0
    try:
        interruption.begin()
        if "PYTHONHASHSEED" not in os.environ and _RUN_ROBOTS.intersection(sys.argv[1:]):
            _restart_with_fixed_seed()
        from .main import run

        run()
    except KeyboardInterrupt:  # during the import; later, `run` handles it
        print("interrupted", file=sys.stderr)
        status = 130
    except SystemExit as ended:
        status = ended.code if isinstance(ended.code, int) else int(ended.code is not None)
    interruption.end()
    set_status(status := interruption.exit_code(status))
    sys.exit(status)


def _open_closed_streams() -> None:
    """Read nothing, and write to nowhere, in place of standard streams that are closed, as services may start programs.

    pytest needs them; and the next file that is opened would have a closed one's number.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            os.dup2(os.open(os.devnull, os.O_RDWR), number)
            setattr(sys, name, open(number, "w" if number else "r", encoding="utf-8", closefd=False))  # noqa: SIM115


def _current_directory() -> str:
    """Return the current directory; end the command if there is none."""
    try:
        # Not pathlib, which imports modules that the user's files may hide.
        return os.getcwd()  # noqa: PTH109
    except OSError as error:
        print(f"error: the current directory cannot be found: {error.strerror}", file=sys.stderr)
        print("  It may have been removed. Go to another directory, and run the command again.", file=sys.stderr)
        sys.exit(2)


def _remove_current_directory(here: str) -> None:
    """Remove the current directory from Python's path, where ``python -m pyfrc`` has put it.

    Otherwise our own libraries would import a `random.py` beside robot.py, before it can be detected.
    """
    if getattr(sys.flags, "safe_path", False) or not sys.path:
        return
    if sys.path[0] in ("", here) and not __file__.startswith(os.path.join(here, "pyfrc_cli", "")):  # noqa: PTH118
        del sys.path[0]


def _restart_with_fixed_seed() -> None:
    os.environ["PYTHONHASHSEED"] = "0"
    sys.exit(become([sys.executable, *sys.orig_argv[1:]]))


def become(command: list[str]) -> int:
    """Replace this process by `command`; on Windows, run it, with this process's streams, and return its exit code."""
    if sys.platform != "win32":
        os.execv(command[0], command)
    # Windows' exec returns to the shell while the new process still runs.
    import signal
    import subprocess

    # Ctrl-C reaches every process of a terminal. The new one handles it, and may take its time to save files.
    signal.signal(signal.SIGINT, lambda number, frame: None)
    with subprocess.Popen(command) as process:
        code = process.wait()
    # Codes of crashes, such as 0xC0000005, are too large for `sys.exit`, which takes the signed number.
    return code - (1 << 32) if code >= 1 << 31 else code
