"""A roboRIO look-alike for people without a robot.

``python -m tests.roborio`` starts one and shows what its program prints; Ctrl-C takes it away.
``python -m tests.roborio -- COMMAND`` runs a command with its address as last argument, and takes it away afterwards.
"""

from __future__ import annotations

import argparse
import contextlib
import subprocess
import sys
import threading

from .machine import Roborio, missing_here
from .proxy import Proxy


def main() -> int:
    """Start a look-alike, say how to reach it, show what its program prints, until Ctrl-C."""
    parser = argparse.ArgumentParser("python -m tests.roborio", description=__doc__)
    parser.add_argument("--host", default="127.0.0.2", help="the loopback address at which it is found (127.0.0.2)")
    parser.add_argument("--wpilib", default="2026.2.2", metavar="VERSION", help="the version of wpilib on it")
    parser.add_argument("--image", default="FRC_roboRIO_2026_v1.2", metavar="VERSION", help="the version of its image")
    parser.add_argument("--slow", action="store_true", help="as on a field: 20 ms round trips, 4 Mbit/s")
    parser.add_argument("command", nargs="*", help="run this with the look-alike's address as last argument")
    options = parser.parse_args()
    if missing := missing_here():
        if options.command:
            print(f"no look-alike here: it needs {', '.join(missing)}")
            return 0
        print(f"error: a look-alike of a roboRIO needs {', '.join(missing)}, which this machine lacks", file=sys.stderr)
        return 1
    if options.command:
        with Roborio(wpilib=options.wpilib, image=options.image) as robot:
            return subprocess.run([*options.command, robot.where], check=False).returncode
    with contextlib.ExitStack() as stack:
        try:
            robot = Roborio(host=options.host, wpilib=options.wpilib, image=options.image)
        except OSError as error:
            print(f"error: {options.host}: {error.strerror}; another one may be running: try --host", file=sys.stderr)
            return 1
        stack.enter_context(robot)
        where = robot.where
        if options.slow:
            proxy = Proxy((robot.host, robot.port), round_trip=0.02, rate=500_000, host=robot.host)
            where = f"{robot.host}:{stack.enter_context(proxy).port}"
        print(f"A roboRIO look-alike runs at {where}. In a robot project: pyfrc deploy --robot {where}")
        print("The output of its program follows. Ctrl-C stops it.", flush=True)
        robot.echo = True
        with contextlib.suppress(KeyboardInterrupt):
            threading.Event().wait()
    return 0


sys.exit(main())
