"""`pyfrc sim` without a window: how it ends, and what it leaves behind."""

from __future__ import annotations

import os
import select
import signal
import socket
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest
from conftest import RobotProject, sampled
from sim_robots import FILES, PATIENCE, wait
from started_commands import StartedCommand

from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation

SIGNALS = [
    pytest.param(name, marks=[pytest.mark.skipif(not hasattr(signal, name), reason="this system has none"), *marks])
    for name, *marks in (("SIGINT",), ("SIGTERM", pytest.mark.slow), ("SIGHUP", pytest.mark.slow))
]

#: Says when it is enabled for the tenth time.
ROBOT = """
    import os

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        packets = 0

        def robotPeriodic(self):
            self.packets += 1
            if self.packets == 10:
                print("ten packets of", os.getppid(), flush=True)
"""


def end(command: StartedCommand, name: str) -> int:
    """Send a signal, and return the exit code."""
    command.send_signal(getattr(signal, name))
    command.rest(PATIENCE)
    return command.wait()


def running(project: RobotProject, *arguments: str) -> StartedCommand:
    return project.start("sim", "--ui", "none", *arguments)


@pytest.mark.parametrize("classes", sampled([0, 2], 2))
def test_not_one_robot_class(classes: int, make_project) -> None:
    robot = "".join(f"class MyRobot{number}(wpilib.TimedRobot): pass\n" for number in range(classes))
    made = make_project({"robot.py": f"import wpilib\n{robot}"})
    result = made.run("sim", "--ui", "none", "--seconds", "1", "--record", "run.jsonl", "--wpilog", "run.wpilog")
    assert (result.code, "robot class" in result.stdout) == (2, True), result.output
    assert "wrote" not in result.stdout
    assert not (made.path / "run.jsonl").exists()


@pytest.mark.parametrize("option", ["--record", "--wpilog"])
def test_what_cannot_be_written_is_said_before_anything_runs(option: str, make_project) -> None:
    made = make_project({"robot.py": "raise Exception('this has run')", "taken": "no directory"})
    result = made.run_here("sim", "--ui", "none", "--seconds", "1", option, "taken/run.file")
    assert result.code == 2, result.output
    assert result.first_error.startswith(f"{option} {Path('taken/run.file')} cannot be written: ")
    assert "this has run" not in result.output
    assert "wrote" not in result.output


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--seconds", "2", "--from", "5"], "--seconds 2 is before --from 5"),
        (["--mode", "auto", "--from", "20"], "--from 20 is after the end, at 15 s"),
    ],
)
def test_ends_before_the_beginning(arguments: list[str], told: str, make_project) -> None:
    result = make_project(FILES).run_here("sim", "--ui", "none", *arguments)
    assert (result.code, result.first_error) == (2, told), result.output


@pytest.mark.usefixtures("hangup_ends_programs")
@pytest.mark.parametrize("name", SIGNALS)
def test_what_was_driven_is_written_however_it_ends(name: str, make_project) -> None:
    made = make_project({"robot.py": ROBOT})
    with running(made, "--nt-port", "0", "--record", "run.jsonl", "--wpilog", "run.wpilog") as sim:
        sim.until("ten packets")
        assert end(sim, name) == 128 + getattr(signal, name), sim.read
    assert "wrote run.jsonl" in sim.read
    assert "wrote run.wpilog" in sim.read
    assert (made.path / "run.jsonl").is_file()
    assert list(made.temporary.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="no file is too large there")
@pytest.mark.slow
def test_a_data_log_for_which_there_is_no_room(make_project) -> None:
    """Files that may not grow any further stand for a disk that is full."""
    made = make_project(FILES)
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))"
    command = "import sys; sys.argv[0] = 'pyfrc'; from pyfrc_cli.main import run; run()"
    arguments = ["sim", "--ui", "none", "--mode", "teleop", "--seconds", "20", "--wpilog", "run.wpilog"]
    result = subprocess.run(
        [sys.executable, "-c", f"{limit}; {command}", *arguments],
        cwd=made.path, env=os.environ | {"PYTHONHASHSEED": "0"}, capture_output=True, text=True, timeout=PATIENCE,
    )  # fmt: skip
    assert result.returncode == 2, result.stdout + result.stderr
    assert "run.wpilog is not complete: " in result.stderr
    assert "wrote" not in result.stdout
    assert "Fatal Python error" not in result.stdout + result.stderr


@pytest.mark.skipif(
    not FORK_IS_SAFE or not hasattr(os, "pidfd_open"), reason="only where robots are forked, and others' ends are seen"
)
def test_nothing_is_left_by_one_that_is_killed(make_project) -> None:
    made = make_project({"robot.py": ROBOT})
    with running(made, "--nt-port", "0") as sim:
        host = os.pidfd_open(int(sim.until("ten packets").split()[-1]))
        try:
            assert list(made.temporary.glob("pyfrc-sim-*"))
            end(sim, "SIGKILL")
            assert select.select([host], [], [], PATIENCE)[0], "the robot's processes go on"
        finally:
            os.close(host)
    assert list(made.temporary.iterdir()) == []


def save(file: Path, text: str) -> None:
    file.write_text(dedent(text), encoding="utf-8")


def test_a_mistake_that_is_saved_is_waited_out(make_project) -> None:
    made = make_project({"robot.py": ROBOT})
    robot = made.path / "robot.py"
    good = robot.read_text(encoding="utf-8")
    with running(made, "--nt-port", "0", "--watch") as sim:
        sim.until("ten packets")
        save(robot, good + "\n1 / 0\n")
        saved = sim.until("was saved")
        assert saved.startswith("robot.py was saved: going on with the new code at ")
        seconds = saved.split()[-2]
        failed = sim.until("failed at")
        assert f"{made.place('robot.py', '1 / 0')}: ZeroDivisionError" in failed
        # The robot is to go on from where it was.
        assert float(failed.split()[2]) >= float(seconds) > 0
        sim.until("waiting for the correction")
        save(robot, good.replace("ten packets", "corrected") + "\n# corrected\n")
        sim.until("was saved")
        sim.until("corrected of")
        assert end(sim, "SIGINT") == 130, sim.read
    assert "failed" not in sim.read.partition("corrected of")[2]


def test_new_code_goes_as_far_as_the_old_one_was_to(make_project) -> None:
    """With an end, a simulation that is watched ends there, also after its code has changed."""
    project = Project(make_project({"robot.py": ROBOT}).path / "robot.py")
    with Simulation(project, SimOptions(speed=0.01, run_until=0.5)) as simulation:
        wait(simulation, lambda: simulation.status.state == "running")
        simulation.reload()
        simulation.set_speed(0)
        wait(simulation, lambda: simulation.status.state == "paused")
        assert simulation.snapshot.time == 0.5


@pytest.mark.slow
def test_a_port_that_is_taken_is_said(make_project) -> None:
    with socket.socket() as other:
        other.bind(("", 0))
        other.listen()
        port = other.getsockname()[1]
        result = make_project(FILES).run("sim", "--ui", "none", "--seconds", "0.1", "--nt-port", str(port))
    assert result.code == 0, result.output
    warning = f"warning: Dashboards cannot connect: port {port} is taken. Is another simulation running?"
    assert warning in result.stdout.splitlines(), result.output
