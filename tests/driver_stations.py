"""A Driver Station on this computer, and a deploy from a computer whose Driver Station is on a competition field."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress

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


@contextmanager
def driver_station(port: int, says: Mapping[str, object]) -> Iterator[None]:
    """A Driver Station that says this to each program that connects to its port."""
    said = json.dumps(says).encode() + b"\n"
    with _alone_on_port(port) as listener:

        def serve() -> None:
            with suppress(OSError):
                while True:
                    with listener.accept()[0] as connected:
                        connected.sendall(said)

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        try:
            yield
        finally:  # or the thread would go on accepting, and no other test could ever listen there
            listener.shutdown(socket.SHUT_RDWR)
            thread.join()


def _alone_on_port(port: int) -> socket.socket:
    """Listens there, when it is this test's turn: another run of this suite may be at the same test."""
    for _ in range(2000):
        try:
            return socket.create_server(("127.0.0.1", port))
        except OSError:
            threading.Event().wait(0.1)
    raise AssertionError(f"port {port} is in use all the time: by a Driver Station?")


def deploy_on_field(project: RobotProject, port: int, says: Mapping[str, object]) -> subprocess.CompletedProcess[str]:
    """Deploy in a network namespace of its own: the port of the Driver Station is one for the whole computer."""
    deploy = ["deploy", "--skip-tests", "--team", "1234", "--no-resolve"]
    return subprocess.run(
        ["unshare", "-n", sys.executable, "-c", _WITH_DRIVER_STATION, str(port), json.dumps(says), *deploy],
        cwd=project.path,
        capture_output=True,
        text=True,
        check=False,
    )
