"""Start the process of `host`, in a new interpreter."""

from __future__ import annotations

import subprocess
from functools import partial

from ...processes import spawn
from .host import Hosting, main

#: What a host's interpreter reads from its environment: a fixed order of sets, and output as it is printed.
ENVIRONMENT = {"PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1", "PYTHONIOENCODING": "utf-8"}


def start_host(hosting: Hosting, output: int) -> spawn.Interpreter:
    """Start a host.

    :param output: the descriptor of what the host prints into
    :return: its process; on POSIX the leader of a session of its own
    """
    return spawn.start(
        spawn.Start(
            partial(main, hosting),
            stdout=output,
            stderr=subprocess.STDOUT,
            environment=ENVIRONMENT,
            own_session=True,
            ends_with_owner=False,  # it ends with the simulation, which is not bound to a thread
        )
    )
