"""Devices that a vendor simulates in real time do not repeat: commands say it once, and no finding is lost.

A stand-in plays phoenix6, so that these tests need no vendor's package: `test_competition_robots` has the real one.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent

import pytest
from conftest import MakeProject, RobotProject, sampled

from pyfrc_core.compat import unrepeatable
from pyfrc_core.runtime.scripts.script import load_script
from pyfrc_core.runtime.scripts.trace_lines import repeatable_part, trace_line

#: The files of a stand-in for phoenix6.
CONTROLS = """
    class VoltageOut:
        pass


    class VelocityVoltage:
        pass
    """

PHOENIX = """
    import os

    import hal


    class ParentDevice:
        def __init__(self, device_id, model, canbus):
            pass


    class TalonFX:
        '''Like phoenix6's: a SimDevice for the motor, and one for its sensor, whose values differ in each run.'''

        def __init__(self, number):
            direction = hal.SimDevice.Direction
            self.motor = hal.SimDevice(f"CANMotor:Talon FX (v6)[{number}]")
            self.voltage = self.motor.createDouble("motorVoltage", direction.kOutput, 0.0)
            self.sensor = hal.SimDevice(f"CANEncoder:Talon FX (v6)[{number}]/Rotor Sensor")
            self.position = self.sensor.createDouble("position", direction.kBidir, 0.0)

        def set_control(self, request):
            pass

        @property
        def sim_state(self):
            return self

        def update(self):
            self.voltage.set(int.from_bytes(os.urandom(4), "big"))
            self.position.set(int.from_bytes(os.urandom(4), "big"))
    """

ROBOT = """
    import os

    import phoenix6
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.talons = [phoenix6.TalonFX(number) for number in (11, 12, 21)]
            self.motor = wpilib.PWMSparkMax(0)

        def robotPeriodic(self):
            for talon in self.talons:
                talon.update()

        def teleopPeriodic(self):
            self.motor.set(0.5)
    """

TESTS = {
    "tests/test_robot.py": """
        def test_teleop(control, robot, hal_data):
            with control.run_robot():
                control.step_timing(seconds=0.2, autonomous=False, enabled=True)
                # The library may write them while a test writes its own inputs.
                hal_data["CAN"]["CANEncoder:Talon FX (v6)[11]/Rotor Sensor"]["position"] = 4.0
                control.step_timing(seconds=0.2, autonomous=False, enabled=True)


        def test_disabled(control, robot):
            with control.run_robot():
                control.step_timing(seconds=0.2, autonomous=False, enabled=False)
        """
}

SENTENCE = (
    "Talon FX 11, Talon FX 12 and 1 more device do not repeat exactly, because phoenix6 simulates them in real time: a "
    "trace's hash leaves out their values, and tests should compare what depends on them with a tolerance."
)

TELEOP = "tests_test_robot.py.test_teleop.jsonl"


class PhoenixProject:
    """A robot project, and commands in it with the stand-in on Python's path."""

    def __init__(self, project: RobotProject, library: Path) -> None:
        self.project, self.path = project, project.path
        self.environment = {"PYTHONPATH": str(library)}

    def output(self, *args: str, code: int = 0) -> str:
        """Run ``pyfrc``, and return its output as one line of words."""
        result = self.project.run(*args, env=self.environment)
        assert result.code == code, result.output
        return " ".join(result.output.split())

    def record(self, directory: str) -> Path:
        """Record its tests, and return the script of one."""
        self.output("test", "--record", directory)
        return self.path / directory / TELEOP


@pytest.fixture
def with_phoenix(make_project: MakeProject, tmp_path: Path) -> PhoenixProject:
    """A robot with three motors of the stand-in."""
    library = tmp_path / "library"
    library.mkdir()
    files = {"__init__": "from .hardware import TalonFX", "hardware": PHOENIX, "controls": CONTROLS}
    (library / "phoenix6").mkdir()
    for name, text in files.items():
        (library / "phoenix6" / f"{name}.py").write_text(dedent(text), "utf-8")
    # Nothing here needs the time that real devices need.
    settings = "[tool.pyfrc.test]\nreal_time_speed = 10000\n"
    return PhoenixProject(make_project({"robot.py": ROBOT, "pyproject.toml": settings, **TESTS}), library)


# -- what is one of them -----------------------------------------------------------------------------------------------


def test_devices_count_only_where_the_library_is_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same names may be those of other simulations."""
    names = ["CANMotor:Talon FX (v6)[11]", "CANEncoder:Talon FX (v6)[11]/Rotor Sensor", "SPARK MAX [3]"]
    monkeypatch.delitem(sys.modules, "phoenix6", raising=False)
    assert unrepeatable.unrepeatable_devices(names) == ()
    assert not unrepeatable.is_unrepeatable(names[0])
    monkeypatch.setitem(sys.modules, "phoenix6", unrepeatable)
    assert unrepeatable.unrepeatable_devices(names) == ("phoenix6 Talon FX 11",)
    assert [unrepeatable.is_unrepeatable(name) for name in names] == [True, True, False]
    assert unrepeatable.is_unrepeatable('CAN["CANGyro:Pigeon 2 (v6)[1]"].yaw')


def test_one_sentence_names_the_device_the_reason_and_the_remedy() -> None:
    """For one device, two and many."""
    one, two = (
        unrepeatable.explain_unrepeatable([f"phoenix6 Talon FX {each}" for each in range(count)]) for count in (1, 2)
    )
    assert one.startswith("Talon FX 0 does not repeat exactly, because phoenix6 simulates it in real time: ")
    assert two.startswith("Talon FX 0 and Talon FX 1 do not repeat exactly, because phoenix6 simulates them ")
    assert unrepeatable.explain_unrepeatable([f"phoenix6 Talon FX {each}" for each in (11, 12, 21)]) == SENTENCE


# -- traces ------------------------------------------------------------------------------------------------------------


def test_recordings_have_the_same_hash_and_mark_the_values(with_phoenix: PhoenixProject) -> None:
    """Two recordings with different values of these devices; the hash is that of the lines without them."""
    first, second = (with_phoenix.record(directory) for directory in ("first", "second"))
    assert load_script(first).trace == load_script(second).trace
    assert "(v6)" not in first.read_text("utf-8"), "their values are no inputs"
    lines = first.with_name(f"{first.stem}.trace.jsonl").read_text("utf-8").splitlines()
    assert any('"unrepeatable":{"CAN[' in line for line in lines)
    changes = [json.loads(line) for line in lines[1:-1]]
    assert not any("(v6)" in path for change in changes for path in change["set"])
    repeating = [each for change in changes if (each := repeatable_part(change)) is not None]
    hashed = (trace_line(each["t"], each["set"], each.get("gone", ())) for each in repeating)
    expected = hashlib.sha256("".join(hashed).encode()).hexdigest()
    assert load_script(first).trace == expected


# -- how fast robot time passes ----------------------------------------------------------------------------------------


#: It writes the real time of each turn of its loop, and does something with its devices.
TIMED = ROBOT.replace(
    "def robotPeriodic(self):",
    """def robotPeriodic(self):
            {}
            with open("real_time.txt", "a", encoding="utf-8") as file:
                file.write(f"{{time.clock_gettime(time.CLOCK_MONOTONIC)}}\\n")""",
).replace("import os", "import os\n    import time\n    import phoenix6.controls")

#: What a robot does with its devices, where robot time waits for them, and where it does not.
WAITED_FOR = (
    "self.talons[0].set_control(phoenix6.controls.VelocityVoltage())",
    "self.talons[0].sim_state",
)
NOT_WAITED_FOR = "self.talons[0].set_control(phoenix6.controls.VoltageOut())"


def turns_in_real_time(with_phoenix: PhoenixProject, use: str, speed: float) -> Iterator[list[float]]:
    """Run this robot in a test and in its replay, and yield the real time of each turn."""
    robot = TIMED.format(use)
    settings = f"[tool.pyfrc.test]\nreal_time_speed = {speed}\n"
    with_phoenix.project.write({"pyproject.toml": settings, "robot.py": robot})
    noted = with_phoenix.path / "real_time.txt"
    for command in (
        ("test", "-j", "1", "--record", "recorded", "--", "-k", "teleop"),
        ("replay", f"recorded/{TELEOP}"),
    ):
        noted.unlink(missing_ok=True)
        with_phoenix.output(*command)
        yield [float(line) for line in noted.read_text("utf-8").split()]


@pytest.mark.parametrize("use", sampled(WAITED_FOR, WAITED_FOR[0]))
def test_robot_time_waits_where_a_device_closes_a_loop_or_is_simulated(with_phoenix: PhoenixProject, use: str) -> None:
    """In tests and replays, while the robot is enabled: at a fifth of its speed, each packet of 20 ms takes 0.1 s."""
    for times in turns_in_real_time(with_phoenix, use, speed=0.2):
        # The first turn is the program's start, and there are six waits before the ninth. A busy machine adds to them.
        assert times[8] - times[0] > 0.59, times


def test_robot_time_waits_for_no_other_device(with_phoenix: PhoenixProject) -> None:
    """At this speed, one packet would take half an hour."""
    for times in turns_in_real_time(with_phoenix, NOT_WAITED_FOR, speed=0.00001):
        assert len(times) > 8


# -- the commands say it once ------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_replay_that_differs_is_no_failure(with_phoenix: PhoenixProject) -> None:
    """What the devices do may reach everything else."""
    robot = with_phoenix.path / "robot.py"
    robot.write_text(robot.read_text("utf-8").replace("set(0.5)", "set(os.urandom(1)[0] / 256)"), "utf-8")
    output = with_phoenix.output("replay", str(with_phoenix.record("recorded")))
    assert output.count(SENTENCE) == 1
    assert "The trace differs from the recorded one, first at" in output
    assert "(v6)" not in output


@pytest.mark.slow
def test_the_simulator_says_it_once(with_phoenix: PhoenixProject) -> None:
    """As a warning in the terminal."""
    assert with_phoenix.output("sim", "--ui", "none", "--seconds", "0.5").count(SENTENCE) == 1


@pytest.mark.slow
def test_the_doctor_says_it(with_phoenix: PhoenixProject) -> None:
    """It does not construct the robot, so it names the library."""
    result = with_phoenix.project.run("doctor", env=with_phoenix.environment)
    words = " ".join(result.output.split())
    assert "phoenix6 simulates its devices in real time: runs of this robot do not repeat exactly" in words


# -- findings ----------------------------------------------------------------------------------------------------------

ONCE = """\
        def teleopPeriodic(self):
            try:
                os.close(os.open("failed", os.O_CREAT | os.O_EXCL))
            except FileExistsError:
                return
            raise RuntimeError("only once")
    """


@pytest.mark.slow
def test_a_failure_that_does_not_repeat_is_kept(with_phoenix: PhoenixProject) -> None:
    """With its story and script, marked; the regression tests leave it out."""
    with_phoenix.project.write({"robot.py": ROBOT.partition("        def teleopPeriodic")[0] + ONCE})
    output = with_phoenix.output("fuzz", "--runs", "8", code=1)
    assert output.count(SENTENCE) == 1
    assert "RuntimeError: only once" in output
    assert "This failure did not repeat in a replay. The script of the whole match is saved:" in output
    (file,) = (with_phoenix.path / "tests" / "fuzz").rglob("*.jsonl")
    assert file.parent.name == "not_repeated"
    script = load_script(file)
    assert not script.repeats
    assert script.story[-1].endswith("RuntimeError: only once")
    assert not (with_phoenix.path / "tests" / "test_fuzz_regressions.py").exists()

    (with_phoenix.path / "failed").unlink()
    with_phoenix.output("fuzz", "--runs", "8", code=1)
    assert [file] == list((with_phoenix.path / "tests" / "fuzz").rglob("*.jsonl"))
