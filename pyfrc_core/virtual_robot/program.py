"""Runs a robot program in WPILib's simulation in real time, as ``python -m robotpy --main FILE run`` does on a robot.

The supervisor starts it and keeps its standard input open. The program ends when its standard input is closed.
"""

from __future__ import annotations

import argparse
import importlib.util
import logging
import os
import select
import socket
import sys
import threading
from pathlib import Path

from ..deploy.agent.host import NETWORK_TABLES_PORT
from . import children


def main() -> None:
    """Import the main file, and run its robot class."""
    parser = argparse.ArgumentParser("robotpy")
    parser.add_argument("--main", required=True, type=Path)
    parser.add_argument("-v", "--verbose", action="store_true")
    parser.add_argument("command", choices=["run"])
    options = parser.parse_args()
    supervisor = _end_with_supervisor()
    logging.basicConfig(
        level=logging.DEBUG if options.verbose else logging.INFO,
        format="%(asctime)s:%(msecs)03d %(levelname)-8s: %(name)-20s: %(message)s",
        datefmt="%H:%M:%S",
    )
    try:
        sys.exit(0 if _run(options.main) else 1)
    finally:
        # Its output is lost with the supervisor, which may end the program before the thread has killed the rest.
        if sys.platform == "linux" and select.select([supervisor], [], [], 0)[0]:
            children.kill_marked(os.environ[children.MARK])


def _end_with_supervisor() -> int:
    """Have this process end when its standard input is closed. Return that input's file descriptor."""
    supervisor = os.dup(0)
    with Path(os.devnull).open("rb") as nothing:
        os.dup2(nothing.fileno(), 0)

    def wait() -> None:
        while os.read(supervisor, 1024):
            pass
        children.kill_marked(os.environ[children.MARK])
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
    return supervisor


def _run(main: Path) -> bool:
    print("********** Robot program starting **********")
    from ..project import Project
    from ..runtime.robot_class import choose_robot_class
    from ..wpi import network, robots, station

    sys.path[0] = str(main.parent)
    robots.set_deploy_directory(main.parent / "deploy")
    # It has no joysticks: the warnings, with a stack each second, would hide what the program prints.
    station.silence_joystick_warnings()
    # WPILib's own server would listen at all addresses of this computer.
    network.serve_this_computer(_tables_port())
    specification = importlib.util.spec_from_file_location("robot", main)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules["robot"] = module
    specification.loader.exec_module(module)
    return robots.run_program(choose_robot_class(Project(main), module))


def _tables_port() -> int:
    """Return the standard port if it is free, else another free port."""
    for port in (NETWORK_TABLES_PORT, 0):
        try:
            with socket.create_server(("127.0.0.1", port)) as probe:
                return int(probe.getsockname()[1])
        except OSError:
            continue
    return NETWORK_TABLES_PORT


if __name__ == "__main__":
    main()
