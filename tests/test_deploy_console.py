"""What the robot program prints, here: with `pyfrc console`, and after a deploy."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest
from roborio import Roborio
from roborio.fixtures import roborio  # noqa: F401 - `robot`

import pyfrc_core.deploy.console

ROBOT = """
import wpilib

class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        print("the words of our robot")
"""


@contextlib.contextmanager
def running(project, *args: str) -> Iterator[subprocess.Popen[str]]:
    """The command, ended by Ctrl-C at the end; one that hangs is killed before it holds up the suite."""
    command = [sys.executable, "-m", "pyfrc", *args]
    with subprocess.Popen(
        command,
        cwd=project.path,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,  # where it is told how the connection is
        text=True,
    ) as it:
        guard = threading.Timer(60, it.kill)
        guard.start()
        try:
            yield it
        finally:
            it.send_signal(signal.SIGINT)
            it.communicate()
            guard.cancel()


def wait_for(process: subprocess.Popen[str], text: str) -> None:
    assert process.stdout is not None
    shown = []
    for line in process.stdout:
        shown.append(line)
        if text in line:
            return
    raise AssertionError(f"{text!r} was not printed, but:\n{''.join(shown)}")


@pytest.mark.parametrize("option", [[], ["--nc-ds"]], ids=["", "nc-ds"])
def test_the_console_shows_what_the_program_prints_and_connects_again(option, robot: Roborio, make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    with running(project, "console", "--robot", robot.where, *option) as console:
        wait_for(console, "OK")
        assert project.run("deploy", "--skip-tests", "--robot", robot.where).code == 0
        wait_for(console, "the words of our robot")
        robot.power_off()
        wait_for(console, ":(")
        robot.power_on()
        wait_for(console, "OK")
        assert project.run("deploy", "--skip-tests", "--robot", robot.where).code == 0
        wait_for(console, "the words of our robot")
    assert console.returncode == 0


def test_the_console_waits_for_a_robot_that_is_not_there_yet(make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    for option in ([], ["--nc-ds"]):
        with running(project, "console", "--robot", "127.0.0.1", *option) as console:
            wait_for(console, "waiting for 127.0.0.1" if option else "Connecting to 127.0.0.1")
        assert console.returncode == 0


@pytest.mark.parametrize("quiet", [False, True])
def test_a_quiet_console_tells_only_what_the_program_prints(
    quiet: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import netconsole

    tries = []

    def run(host: str, fakeds: bool) -> None:
        print(f"Connecting to {host}...", file=sys.stderr)
        if not tries:
            tries.append(host)
            raise ConnectionRefusedError
        print("the words of our robot")
        raise KeyboardInterrupt

    monkeypatch.setattr(netconsole, "run", run)
    monkeypatch.setattr(pyfrc_core.deploy.console, "_SECONDS_BETWEEN_TRIES", 0.0)
    pyfrc_core.deploy.console.follow_console("10.12.34.2", without_driver_station=True, quiet=quiet)
    told, connection = capsys.readouterr()
    assert told.splitlines()[-1] == "the words of our robot"
    assert (told.count("\n"), connection.count("Connecting")) == ((1, 0) if quiet else (2, 2))


@pytest.mark.parametrize("option", ["--netconsole", "--nc-ds"])
def test_a_deploy_may_end_in_the_console(option: str, robot: Roborio, make_project) -> None:
    project = make_project({"robot.py": ROBOT})
    with running(project, "deploy", "--skip-tests", "--robot", robot.where, option) as deploying:
        wait_for(deploying, "Deployed.")
        wait_for(deploying, "OK")
        robot.run("/usr/local/frc/bin/frcKillRobot.sh", "-t", "-r")
        wait_for(deploying, "the words of our robot")
    assert deploying.returncode == 0
