"""A periodic function that waits: the robot's loop is one thread, so it has stopped the robot, which is a failure."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject
from sim_robots import run, settle, wait

from pyfrc_core.project import find_project
from pyfrc_core.sim import SimOptions, Simulation

TIMED = """
    import time

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.gamepad = wpilib.XboxController(0)
            self.motor = wpilib.PWMSparkMax(0)

        def teleopPeriodic(self):
            try:
                self.wait_for_button()
            except Exception:
                pass

        def wait_for_button(self):
            while not self.gamepad.getAButton():
                time.sleep(0.02)
            self.motor.set(0.25)
"""

MAGIC = """
    import time

    import magicbot
    import wpilib


    class Arm:
        gamepad: wpilib.XboxController

        def execute(self):
            while not self.gamepad.getAButton():
                time.sleep(0.02)


    class MyRobot(magicbot.MagicRobot):
        arm: Arm

        def createObjects(self):
            time.sleep(2.5)  # not a periodic function
            self.gamepad = wpilib.XboxController(0)

        def robotPeriodic(self):
            pass
"""

READY_MADE = """
    from pyfrc.tests.basic import *
"""


@pytest.mark.parametrize(
    ("robot", "function", "line", "now"),
    [
        (TIMED, "teleopPeriodic", "time.sleep(0.02)", "2 s"),
        pytest.param(MAGIC, "execute", "time.sleep(0.02)", "2 s", marks=pytest.mark.slow),
    ],
    ids=["timed", "magic"],
)
def test_a_loop_that_waits_fails_and_names_its_line(
    make_project: MakeProject, robot: str, function: str, line: str, now: str
) -> None:
    """Of every kind of robot, in the ready-made test of teleoperated mode."""
    project = make_project({"robot.py": robot, "tests/test_ready_made.py": READY_MADE})
    result = project.run("test", "--", "-k", "test_operator_control")
    assert result.code == 1, result.output
    expected = f"{project.place('robot.py', line)}: {function} has not returned after {now} of robot time"
    assert result.blocks()["test_operator_control"].startswith(expected), result.output
    assert "loop_seconds under [tool.pyfrc.test]" in result.output


@pytest.mark.slow
def test_campaigns_find_it_and_keep_a_script(make_project: MakeProject) -> None:
    """Its script fails in a replay in the same way."""
    robot = TIMED.replace("while not self.gamepad.getAButton():", "while True:")
    settings = "[tool.pyfrc.fuzz]\nmatch_seconds = 10\n"
    project = make_project({"robot.py": robot, "pyproject.toml": settings})
    result = project.run("fuzz", "--runs", "2", "-j", "1")
    assert result.code == 1, result.output
    place = project.place("robot.py", "time.sleep(0.02)")
    assert f"{place}: teleopPeriodic has not returned after 2 s of robot time" in result.output
    (script,) = (project.path / "tests/fuzz").glob("loop_waits-*.jsonl")
    replayed = project.run("replay", script)
    assert replayed.code == 1, replayed.output
    assert f"{place}: teleopPeriodic has not returned" in replayed.output


# -- in the simulator ------------------------------------------------------------------------------------------------

SETTINGS = """
    [tool.pyfrc.match]
    before = 0.2
    autonomous = 0.5
    pause = 0.2
    teleop = 4
"""


@pytest.mark.slow
def test_a_headless_simulation_shows_the_line_and_ends(make_project: MakeProject) -> None:
    """Also with a recorded script, whose trace a replay repeats."""
    project = make_project({"robot.py": TIMED, "pyproject.toml": SETTINGS})
    result = project.run("sim", "--ui", "none", "--mode", "practice", "--record", "match.jsonl")
    assert result.code == 0, result.output
    place = project.place("robot.py", "time.sleep(0.02)")
    assert result.stdout.count(f"warning: {place}: teleopPeriodic has not returned after 2 s") == 1, result.output
    assert "simulated 5.40 s of robot time" in result.stdout
    assert "loop overruns: 1, the longest turn 4.480 s" in result.stdout
    script = (project.path / "match.jsonl").read_text("utf-8")
    assert '"teleop"' in script
    again = project.run("sim", "--ui", "none", "--script", "match.jsonl", "--from", "2", "--seconds", "4.5")
    assert again.code == 0, again.output
    assert "simulated 4.50 s of robot time" in again.stdout
    assert f"warning: {place}" in again.stdout


#: Joysticks keep their values while a loop waits, as on the field; a digital input does not.
SWITCH = TIMED.replace("self.gamepad = wpilib.XboxController(0)", "self.switch = wpilib.DigitalInput(3)").replace(
    "not self.gamepad.getAButton()", "self.switch.get()"
)
PRESSED = {"dio[3].value": False}


@pytest.fixture
def simulation(make_project: MakeProject) -> Iterator[Simulation]:
    """A simulation of a robot whose loop waits for a limit switch, at 1.5 s of robot time, enabled since 0 s."""
    project = make_project({"robot.py": SWITCH, "pyproject.toml": SETTINGS})
    with Simulation(find_project(project.path), SimOptions(speed=0, paused=True)) as simulation:
        settle(simulation)
        simulation.enable()
        run(simulation, 1.5)
        yield simulation


def motor(simulation: Simulation) -> float:
    """What the loop sets when the switch is pressed."""
    assert simulation.snapshot is not None
    return round(float(simulation.snapshot.values["pwm[0].value"] or 0), 2)


def test_time_is_the_persons_while_a_loop_waits(simulation: Simulation) -> None:
    """Pause, step, and the switch that it waits for, which lets the loop go on."""
    assert simulation.snapshot is not None
    assert (simulation.snapshot.time, simulation.snapshot.mode) == (1.5, "teleop")
    assert (simulation.status.overruns, simulation.status.note) == (1, "")
    simulation.step()
    wait(simulation, lambda: simulation.snapshot is not None and simulation.snapshot.time == 1.52)
    run(simulation, 1.0)
    assert "teleopPeriodic has not returned after 2 s" in simulation.status.note
    assert simulation.status.state == "paused"
    assert motor(simulation) == 0
    simulation.write(PRESSED)
    run(simulation, 0.1)
    assert motor(simulation) == 0.25
    assert simulation.status.overruns == 1
    assert simulation.status.worst_loop_seconds == pytest.approx(2.5, abs=0.05)


@pytest.mark.slow
def test_back_into_a_wait_and_on_with_new_code(simulation: Simulation, tmp_path: Path) -> None:
    """The robot is brought into the middle of its wait; what is recorded there does the same in a replay."""
    simulation.rewind(1.0)
    wait(simulation, lambda: simulation.status.state == "paused")
    assert simulation.snapshot is not None
    assert simulation.snapshot.time == 1.0
    simulation.write(PRESSED)
    run(simulation, 0.5)
    assert motor(simulation) == 0.25
    script = tmp_path / "waits.jsonl"
    simulation.save(script)
    replayed = RobotProject(Path(simulation.project.root), tmp_path).run("replay", script)
    assert replayed.code == 0, replayed.output
    assert "differs" not in replayed.output
    simulation.rewind(0.9)
    wait(simulation, lambda: simulation.status.state == "paused")
    file = Path(simulation.project.root, "robot.py")
    file.write_text(file.read_text("utf-8").replace("0.25", "0.75"), "utf-8")
    simulation.reload()
    wait(simulation, lambda: simulation.status.state == "paused")
    assert simulation.snapshot.time == 0.9
    simulation.write(PRESSED)
    run(simulation, 0.5)
    assert motor(simulation) == 0.75


def test_a_robot_init_that_waits_is_shown_while_it_does(make_project: MakeProject) -> None:
    """It is not a periodic function, and may take its time; the simulation ends all the same."""
    robot = """
        import time

        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                while not wpilib.DriverStation.isFMSAttached():
                    time.sleep(0.02)
    """
    project = make_project({"robot.py": robot})
    result = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "12")
    assert result.code == 0, result.output
    assert "simulated 12.00 s" in result.stdout
    assert f"warning: {project.place('robot.py', 'time.sleep')}: the robot still waits here" in result.stdout
