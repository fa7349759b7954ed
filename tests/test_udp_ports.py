"""UDP ports that libraries of the robot need: tests that run side by side do not take them from each other."""

from __future__ import annotations

import socket
from collections.abc import Generator

import pytest
from conftest import MakeProject, RobotProject, sampled

from pyfrc_core.patch_table import PatchTable
from pyfrc_core.runtime.patches import udp_ports

# As photonlibpy's time server does: on a fixed port, in a thread of the library.
LIBRARY = """
    import socket
    import threading


    class Server:
        def __init__(self, port):
            self.port = port
            self.address = None
            threading.Thread(target=self._serve, daemon=True).start()

        def _serve(self):
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as server:
                server.bind(("127.0.0.1", self.port))
                self.address = server.getsockname()
                while True:
                    data, sender = server.recvfrom(1024)
                    server.sendto(data.upper(), sender)
"""

ROBOT = """
    import site
    import sys
    from pathlib import Path

    import wpilib

    sys.path.append(str(Path(__file__).parent / "lib" / "site-packages"))
    import camera_library


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.server = camera_library.Server(PORT)
"""

TESTS = """
    import socket
    import time


    def serves(control, robot):
        with control.run_robot():
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            limit = time.monotonic() + 30
            while robot.server.address is None and time.monotonic() < limit:
                time.sleep(0.01)
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
                client.settimeout(30)
                client.sendto(b"ping", robot.server.address)
                assert client.recv(1024) == b"PING"


    def test_one(control, robot):
        serves(control, robot)


    def test_another(control, robot):
        serves(control, robot)
"""

BINDS_TWICE = """
    import socket

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
            for each in self.sockets:
                each.bind(("127.0.0.1", PORT))
"""


@pytest.fixture
def taken() -> Generator[int]:
    """A port that this process uses, as another program would."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        yield other.getsockname()[1]


@pytest.fixture
def library_project(make_project: MakeProject, taken: int) -> RobotProject:
    return make_project(
        {
            "robot.py": ROBOT.replace("PORT", str(taken)),
            "lib/site-packages/camera_library.py": LIBRARY,
            "tests/test_server.py": TESTS,
        }
    )


@pytest.mark.parametrize("isolation", sampled(["fork", "reuse", "none"], "fork"))
def test_a_library_gets_another_port_than_the_one_in_use(library_project: RobotProject, isolation: str) -> None:
    strict = ("--", "-W", "error", "-k", "test_one")
    result = library_project.run("test", "-j", "2", "--isolation", isolation, *strict)
    assert result.code == 0, result.output
    assert "Address already in use" not in result.output
    assert "warning" not in result.output


@pytest.mark.slow
def test_tests_that_run_side_by_side_do_not_collide(library_project: RobotProject) -> None:
    result = library_project.run("test", "-j", "2", "--", "-W", "error")
    assert result.code == 0, result.output
    assert "2 passed" in result.output
    assert "warning" not in result.output


def test_a_robot_that_binds_a_port_twice_fails_as_on_the_field(make_project: MakeProject, taken: int) -> None:
    robot = BINDS_TWICE.replace("PORT", str(taken))
    project = make_project(
        {
            "robot.py": robot,
            "tests/test_it.py": "def test_it(control, robot):\n    control.run_test(lambda tm: tm < 1)\n",
        }
    )
    result = project.run("test")
    assert result.code == 1
    assert "Address already in use" in result.output, result.output


# -- the replacement itself --------------------------------------------------------------------------------------------


@pytest.fixture
def replaced() -> Generator[None]:
    table = PatchTable()
    for owner, name, value in udp_ports.patches():
        table.patch(owner, name, value)
    yield
    table.undo()
