"""A simulated robot's messages, what it printed, and its exit come in this order, whichever is late."""

from __future__ import annotations

import os
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject
from sim_robots import PATIENCE, wait

from pyfrc_core.processes import channel, output_pipe
from pyfrc_core.processes.channel import Channel
from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.engine import processes
from pyfrc_core.sim.engine.host import Hosting
from pyfrc_core.sim.engine.messages import Failed
from pyfrc_core.sim.engine.processes import start_host

FAILS = """
    import ctypes
    import os
    import signal

    import wpilib

    LEAVES_A_CHILD = False


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            # As a C library forks: Python hears nothing of it.
            if LEAVES_A_CHILD and ctypes.CDLL(None).fork() == 0:
                ctypes.CDLL(None).pause()

        def robotPeriodic(self):
            print("the last words")
            raise LookupError("the user's error")
"""
LEAVES_A_CHILD = FAILS.replace("LEAVES_A_CHILD = False", "LEAVES_A_CHILD = True")
DIES = FAILS.replace('raise LookupError("the user\'s error")', "os._exit(3)")

BOTH_WAYS = [False, pytest.param(True, marks=pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork"))]
only_forked = pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")


@contextmanager
def failed(make_project: MakeProject, robot: str, fork: bool | None = None) -> Iterator[Simulation]:
    """A simulation whose robot has failed."""
    project = Project(make_project({"robot.py": robot}).path / "robot.py")
    with Simulation(project, SimOptions(speed=0, fork=fork)) as simulation:
        wait(simulation, lambda: simulation.status.state == "failed")
        yield simulation


def see_the_users_error(simulation: Simulation) -> None:
    failure = simulation.status.failure
    assert failure is not None
    assert failure.headline == "robot.py:18: LookupError: the user's error"
    assert "the last words" in simulation.output_cursor().read()


class Gate(threading.Event):
    """What is late waits here."""

    def hold(self) -> None:
        assert self.wait(PATIENCE), "it was to come first, and waits itself"


@pytest.fixture
def exit_reported(monkeypatch: pytest.MonkeyPatch) -> Gate:
    """Opened when the exit of a robot's process is known, and before anything is made of it."""
    gate = Gate()
    wait_for_connections = processes.RobotProcesses._all_accepted

    def known(self: processes.RobotProcesses) -> None:
        gate.set()
        wait_for_connections(self)

    monkeypatch.setattr(processes.RobotProcesses, "_all_accepted", known)
    return gate


def late(function: Callable[..., Any], gate: Gate) -> Callable[..., Any]:
    def called_late(*arguments: Any) -> Any:
        gate.hold()
        return function(*arguments)

    return called_late


@pytest.mark.parametrize("fork", BOTH_WAYS)
def test_the_exit_is_reported_before_a_message_is_read(
    fork: bool, make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No message is read until the channel waits for nothing but that."""
    gate = Gate()
    end_of_input = channel.end_of_input

    def ending(connection: Connection) -> None:
        end_of_input(connection)
        gate.set()

    monkeypatch.setattr(channel, "end_of_input", ending)
    monkeypatch.setattr(channel, "receive", late(channel.receive, gate))
    with failed(make_project, FAILS, fork) as simulation:
        see_the_users_error(simulation)


@pytest.mark.parametrize("fork", BOTH_WAYS)
def test_the_exit_is_reported_before_the_connection_is_known(
    fork: bool, make_project: MakeProject, exit_reported: Gate, monkeypatch: pytest.MonkeyPatch
) -> None:
    introduced = processes.introduced

    def introduced_late(connection: Connection) -> object:
        who = introduced(connection)
        if isinstance(who, int):
            exit_reported.hold()
        return who

    monkeypatch.setattr(processes, "introduced", introduced_late)
    with failed(make_project, FAILS, fork) as simulation:
        see_the_users_error(simulation)


def test_a_host_that_was_ended_is_not_taken_for_the_one_after_it(
    make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A restart ends it while it starts; its connection is accepted when the next host has been started."""
    first_is_there, next_is_started = Gate(), Gate()
    introduced, start_host = processes.introduced, processes.start_host

    def introduced_late(connection: Connection) -> object:
        who = introduced(connection)
        if not first_is_there.is_set():
            first_is_there.set()
            next_is_started.hold()
        return who

    def start(*arguments: Any) -> Any:
        host = start_host(*arguments)
        if first_is_there.is_set():
            next_is_started.set()
        return host

    monkeypatch.setattr(processes, "introduced", introduced_late)
    monkeypatch.setattr(processes, "start_host", start)
    project = Project(make_project({"robot.py": FAILS}).path / "robot.py")
    with Simulation(project, SimOptions(speed=0, fork=False)) as simulation:
        first_is_there.hold()
        simulation.restart()
        wait(simulation, lambda: simulation.status.state == "failed")
        see_the_users_error(simulation)


def test_the_messages_are_read_before_the_exit_is_reported(
    make_project: MakeProject, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate = Gate()
    fail = Simulation._fail

    def failing(self: Simulation, failure: Any) -> None:
        fail(self, failure)
        gate.set()

    monkeypatch.setattr(Simulation, "_fail", failing)
    monkeypatch.setattr(Channel, "ended", late(Channel.ended, gate))
    with failed(make_project, FAILS) as simulation:
        see_the_users_error(simulation)


@pytest.mark.parametrize("robot", [FAILS, DIES], ids=["fails", "dies"])
def test_what_was_printed_is_read_late(
    robot: str, make_project: MakeProject, exit_reported: Gate, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate = Gate()

    receive = channel.receive

    def receiving(connection: Connection) -> Any:
        message = receive(connection)
        if isinstance(message, Failed):
            gate.set()
        return message

    monkeypatch.setattr(channel, "receive", receiving)
    monkeypatch.setattr(output_pipe, "read", late(output_pipe.read, gate if robot is FAILS else exit_reported))
    with failed(make_project, robot) as simulation:
        assert "the last words" in simulation.output_cursor().read()


@only_forked
def test_a_child_holds_the_connection_open(make_project: MakeProject) -> None:
    with failed(make_project, LEAVES_A_CHILD) as simulation:
        see_the_users_error(simulation)


@only_forked
def test_a_child_holds_the_connection_of_a_robot_that_dies_open(make_project: MakeProject) -> None:
    with failed(make_project, LEAVES_A_CHILD.replace('raise LookupError("the user\'s error")', "os._exit(3)")) as dead:
        assert dead.status.failure is not None
        assert dead.status.failure.headline.startswith("robot.py:18: the robot's process ended itself with exit code 3")
        assert "the last words" in dead.output_cursor().read()


def test_a_host_that_finds_no_simulation_leaves_without_a_word(tmp_path: Path) -> None:
    left = tmp_path / "pyfrc-sim"
    left.mkdir()
    address = str(left / "listener") if os.name == "posix" else r"\\.\pipe\pyfrc-no-simulation"
    with (tmp_path / "output").open("w+b") as output:
        host = start_host(Hosting(address, b"key", FORK_IS_SAFE, str(left)), output.fileno())
        assert host.wait(PATIENCE) == 0
        output.seek(0)
        assert output.read() == b""
    assert not left.exists()


@only_forked
def test_the_host_is_killed(make_project: MakeProject) -> None:
    # Its robot waits for its own end: it must not go on to kill the process that adopts it.
    robot = FAILS.replace('raise LookupError("the user\'s error")', "os.kill(os.getppid(), 9); signal.pause()")
    with failed(make_project, robot) as simulation:
        assert simulation.status.failure is not None
        assert "signal 9" in simulation.status.failure.headline


@pytest.mark.parametrize(
    "local_socket",
    [
        pytest.param(True, marks=pytest.mark.skipif(sys.platform != "linux", reason="no local sockets without files")),
        False,
    ],
)
def test_the_robot_fails_with_commands_unread(
    local_socket: bool,
    make_project: MakeProject,
    exit_reported: Gate,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    """Over TCP, the end of such a process reset the connection, and its last message was lost."""
    if local_socket:  # the name of a file would be too long
        directory = tmp_path / ("long" * 20)
        directory.mkdir()
        monkeypatch.setattr(tempfile, "tempdir", str(directory))
    else:
        listener = processes.Listener
        monkeypatch.setattr(processes, "Listener", lambda address, **key: listener(("127.0.0.1", 0), **key))
    monkeypatch.setattr(channel, "receive", late(channel.receive, exit_reported))
    project = Project(make_project({"robot.py": FAILS}).path / "robot.py")
    with Simulation(project, SimOptions(speed=0)) as simulation:
        for _ in range(20):
            simulation.enable()
        wait(simulation, lambda: simulation.status.state == "failed")
        see_the_users_error(simulation)
        assert simulation._processes is not None
        assert isinstance(simulation._processes._listener.address, tuple) is not local_socket
