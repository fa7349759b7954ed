"""`pyfrc create-physics`: what it writes runs, and moves the robot as its driver means it."""

from __future__ import annotations

import json
import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent, indent

import pytest
from conftest import MakeProject, RobotProject, sampled
from loops import for_each
from wpimath.kinematics import DifferentialDriveKinematics

from pyfrc_core.errors import PyfrcError
from pyfrc_core.physics.create.names import Reached, find_track_width
from pyfrc_core.physics.create.physics_file import checked

ROBOTS = Path(__file__).parent / "robots"

FILES = ["physics.py", "sim/config.json"]


def create(project: RobotProject) -> str:
    """Run the command, which must succeed; return its output."""
    result = project.run("create-physics")
    assert result.code == 0, result.output
    return result.stdout


def run_tests(project: RobotProject, *args: str) -> None:
    result = project.run("test", *args)
    assert result.code == 0, result.output


@dataclass(frozen=True)
class Variant:
    """A robot, and what its driver does to drive it forward and to turn it left: axes by port and index.

    :param init: its robotInit
    :param teleop: its teleopPeriodic
    :param distances: the expressions for the ways of its left and right encoder, in metres
    :param heading: the expression for its gyro's angle in degrees, counter-clockwise
    """

    init: str
    teleop: str
    distances: str = "None"
    heading: str = "None"
    forward: str = "{(0, 1): -1.0}"
    left: str = "{(0, 0): -1.0}"
    says: str = ""

    def files(self) -> dict[str, str]:
        body = indent(dedent(self.init).strip(), " " * 8)
        head = "import hal\nimport wpilib\nimport wpilib.drive\nfrom wpimath.filter import SlewRateLimiter\n"
        return {
            "robot.py": f"{head}\n\nclass MyRobot(wpilib.TimedRobot):\n    def robotInit(self):\n{body}\n\n"
            f"    def teleopPeriodic(self):\n        {self.teleop}\n",
            "tests/test_physics.py": _DRIVES.format(variant=self),
        }


_DRIVES = '''
import math

import pytest
from wpimath.geometry import Transform2d


def drive(control, hal_data, physics_controller, sticks):
    """Push the sticks for a second, then release them; return how the robot has moved."""
    start = physics_controller.get_pose()
    control.step_timing(seconds=0.5, autonomous=False, enabled=True)
    assert physics_controller.get_pose() == start
    for value in (1.0, 0.0):
        for (port, axis), pushed in sticks.items():
            hal_data["joysticks"][port]["axes"][axis] = value * pushed
        control.step_timing(seconds=1.0, autonomous=False, enabled=True)
    return Transform2d(start, physics_controller.get_pose())


def test_forward(control, hal_data, robot, physics_controller):
    with control.run_robot():
        moved = drive(control, hal_data, physics_controller, {variant.forward})
        assert moved.X() > 1.0
        assert moved.Y() == pytest.approx(0.0, abs=1e-6)
        assert moved.rotation().radians() == pytest.approx(0.0, abs=1e-6)
        distances = {variant.distances}
        assert distances is None or distances == pytest.approx((moved.X(), moved.X()), abs=0.01)


def test_turning_left(control, hal_data, robot, physics_controller):
    with control.run_robot():
        moved = drive(control, hal_data, physics_controller, {variant.left})
        distances, heading, turned = {variant.distances}, {variant.heading}, moved.rotation().radians()
        if distances is not None:
            left, right = distances
            assert right - left > 0.1
            # The robot turns by this much, the wheels being 22 inches apart.
            assert math.remainder((right - left) / 0.5588 - turned, math.tau) == pytest.approx(0.0, abs=0.05)
        if heading is not None:
            assert heading > 10.0
            assert math.remainder(heading - math.degrees(turned), 360.0) == pytest.approx(0.0, abs=0.1)
'''

VARIANTS = {
    "setInverted, arcade, an analog gyro": Variant(
        """
        self.left_motor, self.right_motor = wpilib.Talon(0), wpilib.Talon(1)
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)
        self.stick = wpilib.Joystick(0)
        self.left_encoder, self.right_encoder = wpilib.Encoder(0, 1), wpilib.Encoder(4, 5, True)
        self.left_encoder.setDistancePerPulse(0.001)
        self.right_encoder.setDistancePerPulse(-0.001)
        self.gyro = wpilib.AnalogGyro(1)
        self.gyro.setDeadband(0)
        """,
        "self.drive.arcadeDrive(-self.stick.getY(), -self.stick.getX())",
        "(robot.left_encoder.getDistance(), robot.right_encoder.getDistance())",
        "-robot.gyro.getAngle()",
        says="right: PWM 1 (right_motor), forward at -1",
    ),
    "right side first, followers, not inverted by the code": Variant(
        """
        self.right_1, self.right_2 = wpilib.Talon(5), wpilib.Talon(6)
        self.left_1, self.left_2 = wpilib.Talon(7), wpilib.Talon(8)
        for motor, follower in ((self.right_1, self.right_2), (self.left_1, self.left_2)):
            motor.addFollower(follower)
        self.drive = wpilib.drive.DifferentialDrive(self.left_1, self.right_1)
        self.pad = wpilib.XboxController(0)
        self.gyro = wpilib.ADXRS450_Gyro()
        self.TRACK_WIDTH = 0.61
        """,
        "self.drive.arcadeDrive(-self.pad.getLeftY(), -self.pad.getRightX())",
        heading="-robot.gyro.getAngle()",
        left="{(0, 4): -1.0}",
        says="left: PWM 7 (left_1), PWM 8 (left_2)\n",
    ),
}


@pytest.mark.parametrize("variant", sampled(VARIANTS.values(), list(VARIANTS.values())[-1]), ids=VARIANTS.keys())
def test_the_robot_moves_as_its_driver_means_it(make_project: MakeProject, variant: Variant) -> None:
    project = make_project(variant.files())
    assert variant.says in create(project)
    width = "0.61 * units.metre" if "TRACK_WIDTH" in variant.init else "22 * units.inch"
    assert f"TRACK_WIDTH = {width}  # from" in (project.path / "physics.py").read_text()
    run_tests(project)


MECANUM = """
import wpilib
import wpilib.drive


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.{0}, self.{1}, self.{2}, self.{3} = motors = [wpilib.Talon(channel) for channel in (3, 0, 2, 1)]
        motors[2].setInverted(True)
        motors[3].setInverted(True)
        self.drive = wpilib.drive.MecanumDrive(*motors)
        self.stick = wpilib.Joystick(0)
        self.encoder_fl, self.encoder_rr = wpilib.Encoder(0, 1), wpilib.Encoder(2, 3)
        for encoder in (self.encoder_fl, self.encoder_rr):
            encoder.setDistancePerPulse(0.001)

    def teleopPeriodic(self):
        self.drive.driveCartesian(-self.stick.getY(), self.stick.getRawAxis({sideways}), self.stick.getRawAxis({turn}))
"""

MECANUM_TEST = """
import pytest
from wpimath.geometry import Transform2d


@pytest.mark.parametrize("axis, way", [(1, "X"), ({sideways}, "Y"), ({turn}, "turn")])
def test_ways(control, hal_data, robot, physics_controller, axis, way):
    with control.run_robot():
        start = physics_controller.get_pose()
        hal_data["joysticks"][0]["axes"][axis] = -1.0
        control.step_timing(seconds=0.2, autonomous=False, enabled=True)
        moved = Transform2d(start, physics_controller.get_pose())
        ways = dict(X=moved.X(), Y=moved.Y(), turn=moved.rotation().radians())
        assert ways.pop(way) > 0.3
        assert ways == pytest.approx(dict.fromkeys(ways, 0.0), abs=1e-6)
        front_left, rear_right = robot.encoder_fl.getDistance(), robot.encoder_rr.getDistance()
        assert (front_left > 0.1, rear_right > 0.1) == dict(X=(True, True), Y=(False, False), turn=(False, True))[way]
"""


def test_mecanum(make_project: MakeProject) -> None:
    names, axes = ("front_left", "rear_left", "front_right", "rear_right"), {"sideways": 0, "turn": 4}
    project = make_project(
        {"robot.py": MECANUM.format(*names, **axes), "tests/test_ways.py": MECANUM_TEST.format(**axes)}
    )
    printed = create(project)
    assert f"front left: PWM 3 ({names[0]})\n  rear left: PWM 0 ({names[1]})" in printed
    assert f"front right: PWM 2 ({names[2]}), forward at -1" in printed
    assert "TRACK_WIDTH = 22 * units.inch  # from" in (project.path / "physics.py").read_text()
    run_tests(project)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("template", "says"),
    [
        ("tank", "The project's tests pass."),
        ("swerve", "since 8 of the project's tests fail with it:\n  tests/test_drivetrain.py::test_every"),
    ],
)
def test_templates(make_project: MakeProject, template: str, says: str) -> None:
    """What is written passes the template's tests, or it is not put in place."""
    project = make_project({})
    assert project.run("init", "-t", template).code == 0
    (project.path / "physics.py").unlink()
    result = project.run("create-physics")
    assert says in result.stdout + result.stderr
    assert result.code == ("not put in place" in result.stderr)
    assert (project.path / "physics.py").exists() == (result.code == 0)
    assert (project.path / ".pyfrc/create-physics/physics.py").exists() == (result.code == 1)


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["command", "magic", "worker"])
def test_sample_robots_run_with_it(make_project: MakeProject, robot: str) -> None:
    """Of each kind of loop: WPILib's with commands, magicbot's, and one of its own with threads."""
    project = make_project({})
    project.copy(ROBOTS / robot)
    for name in ("tests", "sim"):
        shutil.rmtree(project.path / name, ignore_errors=True)
    printed = create(project)
    assert "wrote sim/config.json\nwrote sim/config.schema.json\nwrote physics.py" in printed
    assert json.loads((project.path / "sim/config.json").read_text("utf-8"))["pyfrc"]["field"] == {"walls": True}
    run_tests(project, "--builtin", "--", "-k", "operator")


@pytest.mark.slow
def test_a_lift_moves_its_encoder(make_project: MakeProject) -> None:
    """No drivetrain here; and reset() in the robot's code counts."""
    project = make_project(
        {
            "robot.py": """
            import wpilib

            class Lift:
                def __init__(self):
                    self.motor = wpilib.PWMSparkMax(4)
                    self.motor.setInverted(True)
                    self.encoder = wpilib.Encoder(8, 9)
                    self.encoder.setDistancePerPulse(0.01)

            class MyRobot(wpilib.TimedRobot):
                def robotInit(self):
                    self.lift = Lift()
                    self.spare = wpilib.PWMSparkMax(5)

                def teleopInit(self):
                    self.lift.encoder.reset()

                def teleopPeriodic(self):
                    self.lift.motor.set(0.5)

                def autonomousPeriodic(self):
                    self.lift.motor.set(1.0)
            """,
            "tests/test_lift.py": """
            import pytest

            def test_lift(control, robot):
                with control.run_robot():
                    control.step_timing(seconds=2, autonomous=True, enabled=True)
                    assert robot.lift.encoder.getDistance() == pytest.approx(2.0, abs=0.05)
                    assert robot.lift.encoder.getRate() == pytest.approx(1.0)
                    control.step_timing(seconds=2, autonomous=False, enabled=True)
                    assert robot.lift.encoder.getDistance() == pytest.approx(1.0, abs=0.05)
            """,
        }
    )
    printed = create(project)
    assert "no drivetrain recognised" in printed
    assert "four_motor_swerve_drivetrain" in printed
    assert "PWM 4 (lift.motor) with lift.encoder (DIO 8, 9), which you need to complete\n" in printed
    failed = "tests/test_lift.py::test_lift - tests/test_lift.py:6: AssertionError: assert 0.0 == 2.0 ± 0.05"
    assert f"those that fail now failed without it, too:\n  {failed}\n" in printed
    unknown = "Not simulated, since their purpose is unknown: PWM 5 (spare)."
    assert f"note: {unknown}" in printed
    physics = project.path / "physics.py"
    text = physics.read_text()
    assert unknown in text.replace("\n# ", " ")
    assert "# TODO: how fast does PWM 4 (lift.motor) turn lift.encoder (DIO 8, 9)?\n" in text
    physics.write_text(text.replace("LIFT_SPEED = 0.0\n", "LIFT_SPEED = 1.0\n"))
    run_tests(project)


TANK = """
import wpilib

class Drive:
    {0}

class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.left_motor, self.right_motor, self.drive = wpilib.Talon(0), wpilib.Talon(1), Drive()
        self.left_encoder = wpilib.Encoder(0, 1)

    def teleopPeriodic(self):
        self.left_motor.set(0.5)
"""


@pytest.mark.slow
def test_only_what_it_breaks_keeps_it_from_its_place(make_project: MakeProject) -> None:
    still = """
        def test_it_stands_still(control, robot):
            control.set_operator_control(enabled=True)
            control.run_test(lambda tm: tm < 1)
            assert robot.left_encoder.getDistance() == 0
        """
    files = {"tests/test_it.py": still, "tests/test_other.py": "def test_other():\n    assert 1 == 2\n"}
    project = make_project({"robot.py": TANK.format("pass"), **files})
    result = project.run("create-physics")
    assert result.code == 1
    assert "since a test fails with it:\n  tests/test_it.py::test_it_stands_still - " in result.stderr
    assert "test_other" not in result.stderr
    (project.path / "tests/test_it.py").unlink()
    assert "failed without it, too:\n  tests/test_other.py::test_other - " in create(project)


@for_each(
    "path, thing, width",
    [
        ("TRACK_WIDTH", 0.61, 0.61),
        ("kTrackwidth", 0.55, 0.55),
        ("kinematics", DifferentialDriveKinematics(0.7), 0.7),
        ("TRACK_WIDTH", 24.0, None),  # inches, probably
        ("WIDTH", 0.61, None),
        ("TRACK_WIDTH", 1, None),
    ],
)
def test_the_width_is_that_of_the_robots_code(path: str, thing: object, width: float | None) -> None:
    objects = [Reached(("drive",), object(), "robot.drive"), Reached(("drive", path), thing, f"robot.drive.{path}")]
    assert find_track_width(objects) == width


@pytest.mark.slow
def test_names_and_inversion_tell_where_no_stick_does(make_project: MakeProject) -> None:
    """A climber has sides too, a conveyor runs by itself, and a loop that sleeps takes its time: none of it matters."""
    project = make_project(
        {
            "robot.py": """
            import time

            import wpilib

            class MyRobot(wpilib.TimedRobot):
                def robotInit(self):
                    self.climber_left, self.climber_right = wpilib.Talon(0), wpilib.Talon(1)
                    self.motors = {"right": wpilib.Talon(3), "left": wpilib.Talon(2)}
                    self.motors["left"].setInverted(True)
                    self.conveyor = wpilib.Talon(4)
                    self.lift_encoder = wpilib.Encoder(0, 1)

                def robotPeriodic(self):
                    time.sleep(1)
                    self.conveyor.set((self.conveyor.get() + 0.3) % 1)

                def autonomousPeriodic(self):
                    for motor in self.motors.values():
                        motor.set(0.5)
            """,
            "tests/test_forward.py": """
            from wpimath.geometry import Transform2d

            def test_forward(control, robot, physics_controller):
                start = physics_controller.get_pose()
                with control.run_robot():
                    control.step_timing(seconds=3, autonomous=True, enabled=True)
                assert Transform2d(start, physics_controller.get_pose()).X() > 1.0
            """,
        }
    )
    printed = create(project)
    assert "left: PWM 2 (motors[left]), forward at -1\n  right: PWM 3 (motors[right])\nnote: No stick drove" in printed
    assert "encoder: lift" not in printed
    run_tests(project)


EMPTY = {
    "robot.py": """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        pass
    """
}


def test_existing_files_are_left_alone(make_project: MakeProject) -> None:
    project = make_project(EMPTY | {"physics.py": "# mine\n"})
    assert create(project).startswith("no drivetrain recognised\nunchanged: physics.py (exists)\nwrote sim/config.json")
    assert (project.path / "physics.py").read_text() == "# mine\n"
    # Both there: nothing is run, not even the robot.
    project.write({"robot.py": "raise RuntimeError\n"})
    assert create(project) == "unchanged: physics.py (exists)\nunchanged: sim/config.json (exists)\n"
    assert {path.name for path in project.path.iterdir()} - {"__pycache__"} == {"physics.py", "robot.py", "sim"}
    assert sorted(path.name for path in (project.path / "sim").iterdir()) == ["config.json", "config.schema.json"]


IN_THE_WAY = {
    "sim, a file": ("sim", "sim is a file, but the directory of sim/config.json needs this name"),
    "capitals": ("Physics.py", "there is a Physics.py: rename it to physics.py"),
    "a package": ("physics/__init__.py", "there is a package physics/, but pyfrc runs a file physics.py"),
}


@pytest.mark.parametrize(("file", "message"), IN_THE_WAY.values(), ids=IN_THE_WAY.keys())
def test_something_else_in_the_place_of_a_file(make_project: MakeProject, file: str, message: str) -> None:
    project = make_project(EMPTY | {file: "# mine\n"})
    result = project.run_here("create-physics")
    assert (result.code, result.stdout) == (2, "")
    assert result.first_error == message
    assert not any((project.path / name).is_file() for name in FILES)


def test_files_are_named_from_the_current_directory(make_project: MakeProject) -> None:
    settings = '[tool.pyfrc]\nmain = "src/robot.py"\n'
    project = make_project({"src/robot.py": EMPTY["robot.py"], "pyproject.toml": settings})
    printed = create(project)
    assert "\nwrote src/sim/config.json\nwrote src/sim/config.schema.json\nwrote src/physics.py\n" in printed
    assert "at the top of src/physics.py to" in printed
    printed = project.run("create-physics", cwd=project.path / "src").stdout
    assert "unchanged: physics.py (exists)\n" in printed


#: Each with what is said behind its place.
FAILING = {
    "in robotInit": ("self.motor = wpilib.Talon(1 // 0)", "ZeroDivisionError"),
    "by leaving": ("raise SystemExit('gone')", "SystemExit: gone"),
    "by hanging and not letting go": (
        "def ever():\n            while True: pass\n"
        "        while True:\n            try: ever()\n            except BaseException: pass",
        "the robot code hangs here",
    ),
    "by sleeping": (
        "time.sleep(1e9)",
        "the robot is still in this line after 10000 s of robot time, and cannot be driven.",
    ),
    "in C": ("ctypes.string_at(0)", "the robot's process was ended by signal 11 (SIGSEGV, segmentation fault)"),
}


@pytest.mark.parametrize(
    ("code", "message"),
    sampled(FAILING.values(), *(FAILING[each] for each in ("in robotInit", "in C"))),
    ids=FAILING.keys(),
)
def test_a_robot_that_fails_is_told_by_its_line(make_project: MakeProject, code: str, message: str) -> None:
    if "string_at" in code and sys.platform == "win32":
        pytest.skip("there, a fault in C is an exception of Python's")
    project = make_project({"pyproject.toml": "[tool.pyfrc.test]\nhang_seconds = 0.25\n"})
    head = "import ctypes, os, time\nimport wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n"
    (project.path / "robot.py").write_text(f"{head}    def robotInit(self):\n        {code}\n")
    result = project.run("create-physics")
    assert (result.code, result.stdout) == (1, "")
    assert result.first_error.startswith(f"robot.py:{8 if 'ever' in code else 7}: {message}")
    assert "Traceback" not in result.output
    assert not any((project.path / file).exists() for file in ("physics.py", "sim"))
    assert not list(project.temporary.iterdir())


@pytest.mark.slow
def test_a_robot_that_fails_when_driven_still_gets_its_files(make_project: MakeProject) -> None:
    """Then the names are enough."""
    project = make_project(
        {
            "robot.py": """
            import wpilib

            class MyRobot(wpilib.TimedRobot):
                def robotInit(self):
                    self.left_motor, self.right_motor = wpilib.Talon(0), wpilib.Talon(1)
                    self.right_motor.setInverted(True)

                def teleopPeriodic(self):
                    self.left_motor.put(1)
            """
        }
    )
    result = project.run("create-physics")
    assert result.code == 0
    assert "right: PWM 1 (right_motor), forward at -1" in result.stdout
    place = project.place("robot.py", "put(1)")
    assert result.stderr.startswith(f"warning: the joysticks could not be tested: {place}: AttributeError")
    assert place in (project.path / "physics.py").read_text()


def test_any_names_make_a_valid_file(make_project: MakeProject) -> None:
    """The keys of dicts may be anything at all, and two gyros may have names that come out the same."""
    project = make_project(
        {
            "robot.py": """
            import hal
            import wpilib

            ARMS = ["arm²", "ß", "ss", "½", "x\\0y", "a\\nb = (", "class", "\\ud800", "größe", "1st", '"']

            class MyRobot(wpilib.TimedRobot):
                def robotInit(self):
                    self.talons = {name: wpilib.Talon(i) for i, name in enumerate(ARMS)}
                    # These become mechanisms, by these words.
                    self.lifts = {f"lift {name}": wpilib.Talon(i + 12) for i, name in enumerate(ARMS[:5])}
                    self.lift_encoders = {name: wpilib.Encoder(2 * i, 2 * i + 1) for i, name in enumerate(ARMS[:5])}
                    self.left, self.right = wpilib.Talon(18), wpilib.Talon(19)
                    self.g, self.g_angle = Gyro(1), wpilib.AnalogGyro(0)
                    self.odd = hal.SimDevice('odd\\n"', 3)
                    self.output = self.odd.createDouble("Output", hal.SimDevice.Direction.kOutput, 0.0)

            class Gyro:
                def __init__(self, number):
                    self.device = hal.SimDevice("CANGyro:Pigeon 2 (v6)", number)
                    self.yaw = self.device.createDouble("rawYawInput", hal.SimDevice.Direction.kInput, 0.0)

                def getDeviceId(self):
                    return 1
            """
        }
    )
    create(project)
    text = (project.path / "physics.py").read_text(encoding="utf-8")
    made = re.findall(r"^        self\.(\w+) = ", text.partition("class PhysicsEngine")[2], re.MULTILINE)
    assert len(made) == len(set(made))
    assert {"g_angle", "g_angle_2"} < set(made)
    numbers = re.findall(r"^(LIFT_\w+_SPEED) = ", text, re.MULTILINE)
    assert len(numbers) == len(set(numbers)) == 5
    run_tests(project, "--builtin", "--", "-k", "operator")


def test_a_file_that_is_not_valid_is_never_written() -> None:
    with pytest.raises(PyfrcError, match=r"(?s)not valid Python.*\n    def = 1\n.*please report it"):
        checked("x = 1\ndef = 1\n")


def test_swerve_is_recognised_and_left_to_the_team(make_project: MakeProject) -> None:
    module = """
class Module:
    def __init__(self, i):
        self.drive, self.turn = wpilib.Talon(i), wpilib.Talon(i + 4)
        self.turn_encoder = wpilib.Encoder(2 * i, 2 * i + 1)
"""
    head = "class MyRobot(wpilib.TimedRobot):\n    def robotInit(self):\n        "
    init = "self.modules, self.arm_pivot = [Module(i) for i in range(4)], wpilib.Talon(9)\n"
    project = make_project({"robot.py": f"import wpilib\n\n{module}\n\n{head}{init}"})
    printed = create(project)
    assert printed.startswith("no drivetrain recognised\n")
    assert "names such as left_motor or front_left" in printed
    assert "for a swerve drive, its four_motor_swerve_drivetrain" in printed
    assert "docs/how_to/simulate_a_drivetrain.md" in printed
    assert "  left" not in printed
