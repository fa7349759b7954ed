"""The `pyfrc` command run at a terminal of its own, where it may ask."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from conftest import RobotProject


def run_at_terminal(project: RobotProject, args: Sequence[str], answers: Sequence[tuple[str, str]]) -> tuple[int, str]:
    """Run it; its exit code, and all that the terminal has shown.

    :param answers: what is typed when the terminal has shown a text, in this order
    """
    import pty

    ours, theirs = pty.openpty()
    environment = {"TERM": "xterm", "SSH_AUTH_SOCK": ""}
    command = project.start_with([theirs] * 3, *args, env=environment, own_session=True)
    os.close(theirs)
    shown, searched, waiting = "", 0, list(answers)
    while True:
        try:
            piece = os.read(ours, 65536)
        except OSError:  # so Linux tells that nobody has the other end open any more
            break
        if not piece:
            break
        shown += piece.decode(errors="replace")
        if waiting and (place := shown.find(waiting[0][0], searched)) >= 0:
            searched = place + len(waiting[0][0])
            os.write(ours, waiting.pop(0)[1].encode() + b"\n")
    os.close(ours)
    code = command.wait()
    assert not waiting, f"never shown: {waiting[0][0]!r}, but:\n{shown}"
    return code, shown.replace("\r\n", "\n")
