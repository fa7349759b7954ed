"""What the robot program prints, as it arrives through the robot's console service."""

from __future__ import annotations

import contextlib
import io
import os
import sys
import time
from pathlib import Path

_SECONDS_BETWEEN_TRIES = 1.0


def follow_console(host: str, without_driver_station: bool = False, quiet: bool = False) -> None:
    """Print what the robot program prints, until Ctrl-C; connect again whenever the robot goes away.

    :param without_driver_station: have the robot send it although no Driver Station is connected to it
    :param quiet: do not tell of waiting and connecting
    """
    import netconsole  # type: ignore[import-untyped]

    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # each line when it comes, into a pipe as well
    waiting = False
    with contextlib.ExitStack() as telling, contextlib.suppress(KeyboardInterrupt):
        if quiet:  # that is all that it prints there
            telling.enter_context(contextlib.redirect_stderr(telling.enter_context(Path(os.devnull).open("w"))))
        while True:
            try:
                # It connects again by itself; only the Driver Station's part has to succeed at once.
                netconsole.run(host, fakeds=without_driver_station)
            except OSError as error:
                if not waiting and not quiet:
                    print(f"waiting for {host} ({error.strerror or error})")
                waiting = True
                time.sleep(_SECONDS_BETWEEN_TRIES)
