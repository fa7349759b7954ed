"""Start the process of `host`, in a new interpreter."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from .host import Hosting

#: What a host's interpreter reads from its environment: a fixed order of sets, and output as it is printed.
ENVIRONMENT = {"PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1", "PYTHONIOENCODING": "utf-8"}

#: Where no module of the user's is in Python's way.
DIRECTORY = Path(__file__).resolve().parents[3]


class HostProcess(Protocol):
    """A host's process, as far as its simulation needs it; with the methods of `subprocess.Popen`."""

    @property
    def pid(self) -> int: ...

    def poll(self) -> int | None: ...

    def wait(self, timeout: float | None = None) -> int: ...

    def terminate(self) -> None: ...

    def kill(self) -> None: ...


def start_host(hosting: Hosting, output: int) -> HostProcess:
    """Start a host.

    Always called as an attribute of this module, so that tests can replace it by a function that starts hosts faster.

    :param hosting: sent to the host on its standard input
    :param output: the descriptor of what the host prints into
    :return: its process; on POSIX the leader of a session of its own
    """
    host = subprocess.Popen(
        [sys.executable, "-c", f"from {__package__}.host import main; main()"],
        stdin=subprocess.PIPE,
        stdout=output,
        stderr=subprocess.STDOUT,
        cwd=DIRECTORY,
        env=os.environ | ENVIRONMENT,
        start_new_session=os.name == "posix",
    )
    assert host.stdin is not None
    with suppress(OSError), host.stdin as stdin:  # an error: it has ended already
        stdin.write(pickle.dumps(hosting))
    return host
