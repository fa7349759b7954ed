"""A deploy from a computer whose Driver Station is connected to a competition field."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping

from conftest import RobotProject

_WITH_DRIVER_STATION = """
import socket, subprocess, sys, threading
subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
with socket.create_server(("127.0.0.1", int(sys.argv[1]))) as listener:
    def serve():
        with listener.accept()[0] as connected:
            connected.sendall(sys.argv[2].encode() + b"\\n")
    threading.Thread(target=serve, daemon=True).start()
    sys.exit(subprocess.run([sys.executable, "-m", "pyfrc", *sys.argv[3:]]).returncode)
"""


def deploy_on_field(
    project: RobotProject, port: int, station_says: Mapping[str, object]
) -> subprocess.CompletedProcess[str]:
    """Deploy in a network namespace of its own: the port of the Driver Station is one for the whole computer."""
    deploy = ["deploy", "--skip-tests", "--team", "1234", "--no-resolve"]
    return subprocess.run(
        ["unshare", "-n", sys.executable, "-c", _WITH_DRIVER_STATION, str(port), json.dumps(station_says), *deploy],
        cwd=project.path,
        capture_output=True,
        text=True,
        check=False,
    )
