"""What an error means: the sentence, the line and the remedy that a student gets, for errors that libraries raise."""

from __future__ import annotations

import ast
import importlib
import linecache
import re
import sys
from collections.abc import Callable
from fnmatch import fnmatchcase
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import commands2
import commands2.button
import hal
import pytest
import wpilib
import wpilib.drive
import wpimath
from loops import for_each
from skips import missing_python, require
from wpilib import Color
from wpimath.geometry import Rotation2d

from pyfrc_core.config.packages import PACKAGES, SUCCESSORS, install_line, robot_line
from pyfrc_core.config.robotpy import load_robot_packages, unknown_components
from pyfrc_core.errors import SettingsError
from pyfrc_core.explain import explain, other_season
from pyfrc_core.explain.commands import no_command, users_definitions
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.checks.failures import headline
from pyfrc_core.season import SEASONS
from pyfrc_core.season.names.table import earlier_names

if missing := missing_python():
    require("explanations of vendors' names", missing)

import rev

Raise = Callable[[str], str]


@pytest.fixture
def headline_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Raise:
    """Runs the body of a function in a file of the project, and returns the headline of its error."""
    # Another test's station may have been connected.
    wpilib.simulation.DriverStationSim.setAllianceStationId(hal.AllianceStationID.kUnknown)
    wpilib.simulation.DriverStationSim.notifyNewData()

    def headline_of(text: str) -> str:
        file = tmp_path / "robot.py"
        file.write_text("def run(self):\n" + "".join(f"    {line}\n" for line in dedent(text).strip().splitlines()))
        module = ModuleType("robot")
        vars(module).update(wpilib=wpilib, commands2=commands2, rev=rev, __file__=str(file))
        monkeypatch.setitem(sys.modules, "robot", module)
        linecache.checkcache(str(file))
        exec(compile(file.read_text(), str(file), "exec"), vars(module))
        try:
            module.run(module)
        except Exception as error:
            found = headline(error, RobotFiles(tmp_path))
            assert found is not None
            return found
        raise AssertionError("it raises nothing")

    yield headline_of  # type: ignore[misc]
    wpilib.simulation.DriverStationSim.resetData()
    commands2.CommandScheduler.resetInstance()


@pytest.mark.filterwarnings("ignore::ImportWarning")  # Python's, of the dot before a module's name
@for_each(
    "code, message, remedy",
    [
        # Devices: the channel is the user's, and not the HAL's number.
        (
            "a = wpilib.PWMSparkMax(0)\nb = wpilib.PWMSparkMax(0)",
            "PWM channel 0 is used already, since robot.py:2",
            "own",
        ),
        (
            "class Old:\n    LEFT = 7\nclass Ports:\n    LEFT = 0\n"
            "a = wpilib.PWMSparkMax(0)\nb = wpilib.PWMSparkMax(Ports.LEFT)",
            "PWM channel 0 is used already, since robot.py:6",
            "Ports.LEFT is set in robot.py:5.",
        ),
        (
            "class Robot:\n    def auto(self): self.shooter = wpilib.PWMSparkMax(3)\n"
            "    def teleop(self): self.shooter = wpilib.PWMSparkMax(3)\nit = Robot()\nit.auto()\nit.teleop()",
            "PWM channel 3 is used already, since robot.py:3",
            "Both lines make self.shooter. Make it once, in the __init__ of the robot",
        ),
        (
            "class Left:\n    def __init__(self): self.motor = wpilib.PWMSparkMax(3)\n"
            "class Right:\n    def __init__(self): self.motor = wpilib.PWMSparkMax(3)\nit = Left(), Right()",
            "PWM channel 3 is used already, since robot.py:3",
            "Each device needs a channel of its own",
        ),
        (
            "m = wpilib.PneumaticsModuleType.REVPH\na = wpilib.Solenoid(m, 4)\nb = wpilib.DoubleSolenoid(m, 3, 4)",
            "channel 4 of this pneumatics module has a solenoid already",
            "A DoubleSolenoid has two channels",
        ),
        (
            "m = wpilib.PneumaticsModuleType.CTREPCM\na = wpilib.Compressor(m)\nb = wpilib.Compressor(m)",
            "the pneumatics module 0 has a Compressor object already",
            "Create it once",
        ),
        ("wpilib.PWMSparkMax(42)", "there is no channel 42 for such a device", "PWM 0 to 9, DIO 0 to 9"),
        (
            "t = rev.SparkMax.MotorType.kBrushed\na = rev.SparkMax(25, t)\nb = rev.SparkMax(25, t)",
            "CAN ID 25 is used already, by another SparkMax",
            "REV Hardware Client",
        ),
        # Arguments
        (
            "wpilib.PWMSparkMax(1).set(speed())",
            "NameError: name 'speed' is not defined",
            "Nothing has given speed a value",
        ),
        (
            "def speed(): pass\nwpilib.PWMSparkMax(1).set(speed())",
            "set() got None, from speed()",
            "speed() returns nothing: write return its value in robot.py:2\n  It takes: set(value: number)",
        ),
        ("wpilib.PWMSparkMax(1).set(speed=1)", "set() has no argument speed", "It takes: set(value: number)"),
        (
            "x = wpilib.XboxController(0)\nwpilib.PWMSparkMax(1).set(x.getLeftY)",
            "set() got the function x.getLeftY, and not its value",
            "Write x.getLeftY()",
        ),
        (
            "commands2.RunCommand(print())",
            "toRun must be a function, but is None, from print()",
            "lambda: print()",
        ),
        # Calls
        (
            "wpilib.Encoder(0)",
            "Encoder() was called with 1 value, but takes 2 to 4",
            "encodingType: EncodingType = EncodingType.k4X)",
        ),
        (
            "wpilib.SmartDashboard.getNumber('Shooter Speed')",
            "getNumber() was called with 1 value, but takes 2",
            "Write wpilib.SmartDashboard.getNumber('Shooter Speed', defaultValue)",
        ),
        (
            "wpilib.Timer.get()",
            "get() is called on the class wpilib.Timer, and not on an object of it",
            "self.it = wpilib.Timer(...). Then call: self.it.get(...)",
        ),
        (
            "class Drive:\n    left = wpilib.PWMSparkMax\n    def go(self): self.left.set(1)\nDrive().go()",
            "self.left is the class wpilib.PWMSparkMax, and no object: = in the class Drive sets it to that",
            "For magicbot, write left: wpilib.PWMSparkMax. Else create it in __init__: self.left = wpilib.PWM",
        ),
        ("'a' + 3", 'can only concatenate str (not "int") to str', 'f"speed: {value}"'),
        ("[1][1]", "IndexError: list index out of range", "Indexes begin with 0"),
        ("for each in 5: pass", "'int' object is not iterable", "for number in range(5):"),
        (
            "if not self:\n    speed = 1\nprint(speed)",
            "UnboundLocalError",
            "Not every way through the function sets speed",
        ),
        (
            "class Arm:\n    def up(self, speed): pass\na = Arm()\na.up(sped=1)",
            "a.up() was called with sped=",
            "It takes: a.up(speed) (robot.py:3)",
        ),
        # commands2
        (
            "c = commands2.PrintCommand('a')\nc.withTimeout(1)\nc.withTimeout(2)",
            "this command is already part of another one, composed at robot.py:3",
            "create a second one",
        ),
        (
            "d = commands2.Subsystem()\nc = commands2.RunCommand\nc(print, d).alongWith(c(print, d))",
            "two commands that run at the same time both need Subsystem",
            "one.andThen(other)",
        ),
        (
            "d = commands2.Subsystem()\nd.setDefaultCommand(commands2.RunCommand(print))",
            "the default command of Subsystem does not require it",
            "self.addRequirements",
        ),
        # Names
        (
            "wpilib.XBoxController(0)",
            "AttributeError: module 'wpilib' has no attribute 'XBoxController'",
            "XboxController?",
        ),
        ("wpilib.IterativeRobot", "wpilib has no IterativeRobot any more", "Instead: wpilib.TimedRobot."),
        ("wpilib.SendableChooser().addObject('a', 1)", "SendableChooser has no addObject any more", "addOption"),
        ("rev.CANSparkMax", "rev has no CANSparkMax any more", "Instead: rev.SparkMax."),
        # A method, a class or a value where another is expected
        (
            "t = wpilib.Timer()\nif t.get < 2: pass",
            "t.get is a function, and not its value",
            "Write t.get()",
        ),
        ("t = wpilib.Timer()\nwith t.start: pass", "t.start is a function, and not its value", "Write t.start()"),
        ("t = wpilib.Timer()\nfor each in t.get: pass", "t.get is a function, and not its value", "Write t.get()"),
        ("t = wpilib.Timer()\nt.get.hasElapsed(1)", "t.get is a function, and not its value", "Write t.get()"),
        ("t = wpilib.Timer()\nprint(round(t.get))", "t.get is a function, and not its value", "Write t.get()"),
        (
            "if wpilib.XboxController.POV.kUp: pass",
            "wpilib.XboxController.POV is a function",
            "Instead: getPOV(), an angle in degrees",
        ),
        ("speed = 3\nspeed()", "speed is a value (int), and no function", "Write speed, without ()"),
        ("speed = None\nspeed()", "speed is None, and no function", "Has anything set speed before?"),
        ("axes = [1]\naxes(0)", "axes is a value (list), and no function", "Write axes[...], without ()"),
        (
            "class Arm:\n    def up(self): pass\n    def go(self):\n        self.up = wpilib.Timer()\n"
            "        self.up()\n"
            "self.Arm = Arm\nArm.__module__ = 'robot'\nArm().go()",
            "robot.py:5 sets self.up, which hides the method of line 3",
            "another name",
        ),
        (
            "class Arm:\n    def up(self, speed): pass\na = Arm()\na.up.stop()",
            "a.up is a function, and returns nothing",
            "Is the name right?",
        ),
        (
            "def drive(forward, turn):\n    (lambda: forward() + turn())()\n"
            "t = wpilib.Timer()\ndrive(-t.get(), turn=t.get())",
            "robot.py:5: forward and turn must be functions, but are values (float)",
            "Write there: lambda: -t.get(), lambda: t.get()",
        ),
        (
            "m = wpilib.PWMSparkMax(1)\ncommands2.Subsystem().runEnd(m.set(-1.0), m.stopMotor)",
            "run must be a function, but is None, from m.set(-1.0)",
            "  Write lambda: m.set(-1.0)",
        ),
        (
            "class Drive:\n    def __init__(self):\n        self.m = wpilib.PWMSparkMax(0)\na = Drive()\nb = Drive()",
            "robot.py:6: PWM channel 0 is used already: this makes a second Drive, and robot.py:5 the first",
            "Use the first here, too",
        ),
        (
            "from wpimath.kinematics import SwerveModuleState as State\nfrom wpimath.geometry import Rotation2d\n"
            "wanted = State()\nstate = State.optimize(wanted, Rotation2d())\nstate.speed",
            "state is None: State.optimize(wanted, Rotation2d()) in line 5 returns nothing",
            "write wanted.optimize(Rotation2d()), and use wanted for state",
        ),
        (
            "wpilib.Solenoid(wpilib.PneumaticsModuleType, 0)",
            "Solenoid() got the class wpilib.PneumaticsModuleType, and no object of it",
            "Write one of its values.\n  PneumaticsModuleType is one of: CTREPCM, REVPH",
        ),
        (
            "class Arm:\n    def up(self): pass\na = Arm()\na.up = True\na.up()",
            "a.up was a method, but something has set it to True",
            "Search for up =",
        ),
        (
            "def drive(forward):\n    forward()\ndrive(0.5)",
            "forward must be a function, but is a value (float)",
            "lambda: 0.5",
        ),
        (
            "from wpimath.geometry import Rotation2d\nr = Rotation2d(1)\nif r > 30: pass",
            "r is an object of Rotation2d, and no number",
            ".cos(), .degrees(), .radians()",
        ),
        ("a = '3'\nprint(a - 1)", "a is a text, and no number", "Write float(a)"),
        (
            "commands2.CommandScheduler.run()",
            "run() is called on the class commands2.CommandScheduler",
            "Write commands2.CommandScheduler.getInstance().run(...)",
        ),
        (
            "c = commands2.PrintCommand\nself.c = c\nself.c.schedule()",
            "self.c is the class PrintCommand, and no object of it",
            "Write PrintCommand(...)",
        ),
        (
            "c = wpilib.DigitalInput\nwpilib.Encoder(c, c)",
            "Encoder() got the class c, and no object of it",
            "Write c(...)",
        ),
        (
            "b = wpilib.DigitalInput(0)\ncommands2.PrintCommand('a').until(b.get())",
            "until() got the value True, and no function",
            "Pass the function itself: b.get without ()",
        ),
        (
            "d = commands2.Subsystem()\ndef drive(): pass\nd.setDefaultCommand(drive)",
            "setDefaultCommand() got drive, which is a function",
            "Write drive()",
        ),
        (
            "wpilib.Field2d().setRobotPose((1, 2, 0))",
            "setRobotPose() got (1, 2, 0), and no Pose2d",
            "Write Pose2d(...)",
        ),
        ("wpilib.PWMSparkMax(1).set(wpilib.Timer())", "got wpilib.Timer(), an object of Timer", "Pass a number."),
        ("kForward", "name 'kForward' is not defined", "Did you mean wpilib.DoubleSolenoid.Value.kForward?"),
        ("a, b = 3.0", "cannot unpack", "write one name before the =."),
        (
            "s = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.REVPH, 0, 1)\ns.set(True)",
            "set() does not take True",
            "DoubleSolenoid.Value is one of: kOff, kForward, kReverse",
        ),
        (
            "m = wpilib.PWMSparkMax(1)\nm.setInverted = True",
            "m.setInverted is a method, and cannot be set",
            "Write m.setInverted(True)",
        ),
        ("m = wpilib.PWMSparkMax(1)\nm.inverted = True", "m.inverted cannot be set", "Did you mean setInverted?"),
        ("speed += 1", "speed has no value yet", "Write self.speed += 1, and self.speed = 0 in robotInit"),
        ("self.speed = 1\nspeed += 1", "speed has no value yet", "Write self.speed += 1."),
        ("max = 0.5\nmax(1, 2)", "max is 0.5 here, and no longer Python's function max()", "another name"),
        ("speed = 0.5,\nwpilib.PWMSparkMax(1).set(speed)", "set() got speed, which is (0.5,)", "a comma too much"),
        ("class A:\n    def __init__(self): super.__init__()\nA()", "super is a function", "Write super().__init__()"),
        ("wpilib.applyDeadband(1, 2)", "has no attribute 'applyDeadband'", "from wpimath import applyDeadband"),
        ("inchesToMeters(3)", "'inchesToMeters' is not defined", "from wpimath.units import inchesToMeters"),
        # A name that another class has
        (
            "self.pad = wpilib.Joystick(0)\nself.pad.getLeftY()",
            "self.pad, an object of Joystick, has no getLeftY",
            "XboxController has it: write wpilib.XboxController(0) in robot.py:2, where it is made",
        ),
        (
            "import ntcore\nt = ntcore.NetworkTableInstance.getDefault().getDoubleTopic('a')\nt.set(1)",
            "t, an object of DoubleTopic, has no set",
            "write publisher = t.publish() once, and then publisher.set(...)",
        ),
        (
            "p = commands2.button.CommandXboxController(0)\np.getAButton()",
            "has no getAButton",
            "XboxController has it: write p.getHID().getAButton(...)",
        ),
        ("wpilib.DoubleSolenoid.kForward", "has no kForward", "Write wpilib.DoubleSolenoid.Value.kForward"),
        ("wpilib.XboxController(0).getRightTrigger()", "has no getRightTrigger", "Did you mean getRightTriggerAxis?"),
        (
            "class Arm:\n    def go(self): self.runOnce(self.go)\nArm().go()",
            "Arm has no runOnce",
            "Arm(commands2.Subsystem):",
        ),
        (
            "import wpilib.drive.DifferentialDrive",
            "is a class of wpilib.drive",
            "from wpilib.drive import DifferentialDrive",
        ),
        (
            "commands2.PrintCommand('a').addRequirements([self])",
            "addRequirements() got a list",
            "addRequirements(self)",
        ),
        (
            "s = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.REVPH, 0, 1)\ns.set('forward')",
            "set() got 'forward', a text",
            "Write wpilib.DoubleSolenoid.Value.kForward",
        ),
        (
            "commands2.button.JoystickButton(0, 1).onTrue(commands2.PrintCommand('a'))",
            "JoystickButton() got 0, which is a number",
            "an object with getRawButton",
        ),
        ("s = {'Fast': 1}\ns['fast']", "s has no key 'fast'", "Did you mean 'Fast'?"),
        ("2.0 * '0.5'", "a text or a list is multiplied", "float(text)"),
        # What only the driver station knows
        (
            "sign = {1: 2}[wpilib.DriverStation.getAlliance()]",
            "the alliance is None: it is not known until the driver station is connected",
            "Read it in autonomousInit and teleopInit",
        ),
        ("alliance = wpilib.DriverStation.getAlliance()\nprint(alliance.value)", "the alliance is None", "Read it in"),
        ("wpilib.DriverStation.getGameSpecificMessage()[0]", "string index out of range", "Game data are empty until"),
        # Names, from what a class has
        ("wpilib.Timer().delay(1)", "Timer has no delay any more", "Instead: timer.get() or hasElapsed(seconds)"),
        ("wpilib.PWMSparkMax(0).follow(1)", "PWMSparkMax has no follow any more", "LEADER.addFollower(FOLLOWER)"),
        ("wpilib.DutyCycleEncoder(3).getAbsolutePosition()", "has no getAbsolutePosition any more", "Instead: get()"),
        ("wpilib.AlertType.kError", "has no attribute 'AlertType'", "Did you mean wpilib.Alert.AlertType?"),
        ("wpilib.Preferences.get('a')", "the class Preferences, has no get", "Did you mean getBoolean or getDouble"),
        (
            "wpilib.Encoder(0, 1).getPosition()",
            "has no attribute 'getPosition'",
            "It has: get, getDirection, getDistance",
        ),
        ("wpilib.Timer().elapsed_has(1)", "an object of Timer, has no elapsed_has", "Did you mean hasElapsed?"),
        (
            "import phoenix6\nconfigs = phoenix6.configs.MotorOutputConfigs()\n"
            f"configs{'.with_duty_cycle_neutral_deadband(0.001)' * 2}.with_inverts(1)",
            "robot.py:4: an object of MotorOutputConfigs has no with_inverts",
            "Did you mean with_inverted?",
        ),
        ("wpilib.Pose2d()", "has no attribute 'Pose2d'", "from wpimath.geometry import Pose2d"),
        ("Pose2d()", "name 'Pose2d' is not defined", "from wpimath.geometry import Pose2d"),
        ("(0.5).get()", "0.5 is a number (0.5) and has no get", ""),
        ("{'value': 1}.value", "{'value': 1} has no attributes: its values have keys", "Write {'value': 1}['value']"),
        # Modules
        (
            "import networktables",
            "there is no module networktables",
            'Instead: import ntcore, and ntcore.NetworkTableInstance.getDefault().getTable("SmartDashboard")',
        ),
        (
            "from ctre import WPI_TalonSRX",
            "there is no module ctre",
            "Instead: from phoenix6.hardware import TalonFX, CANcoder, Pigeon2; or for a Talon SRX or Victor SPX: "
            "from phoenix5 import WPI_TalonSRX, WPI_VictorSPX\n  Install it: python -m pip install robotpy-ctre",
        ),
        ("from .arm import Arm", "a dot before a module's name means", "Write: from arm import Arm"),
        (
            "import choreo",
            "there is no module choreo",
            "python -m pip install sleipnirgroup-choreolib\n  For the robot, write",
        ),
    ],
)
def test_an_error_of_a_library_in_words(headline_of: Raise, code: str, message: str, remedy: str) -> None:
    text = headline_of(code)
    first, _, rest = text.partition("\n")
    assert re.match(r"robot\.py:\d+: ", first)
    assert message in first
    assert remedy in rest
    assert "0x" not in text


@pytest.mark.parametrize(
    ("test", "message"),
    [
        (
            "def test_it(control, robot):\n    hal_data['pwm']\n    control.run_test(fake_time)",
            "NameError: name 'hal_data' is not defined\n"
            "  Write it as a parameter: def test_it(control, robot, fake_time, hal_data):",
        ),
        (
            "def test_it(control, robot):\n    robot.teleopPeriodic()",
            "tests/test_it.py:2: the test calls teleopPeriodic() itself, but robotInit (robot.py:3), which sets drive, "
            "has not run\n  Instead: control.set_operator_control(enabled=True)",
        ),
    ],
)
def test_an_error_of_a_test(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, test: str, message: str) -> None:
    robot = "class Robot:\n    def robotInit(self):\n        self.drive = 1\n    def teleopPeriodic(self): self.drive\n"
    (tmp_path / "tests").mkdir()
    (tmp_path / "robot.py").write_text(robot)
    (tmp_path / "tests" / "test_it.py").write_text(test)
    module = ModuleType("robot")
    module.__file__ = str(tmp_path / "robot.py")
    monkeypatch.setitem(sys.modules, "robot", module)
    exec(compile(robot, module.__file__, "exec"), vars(module))
    names: dict[str, Callable[..., None]] = {}
    exec(compile(test, str(tmp_path / "tests" / "test_it.py"), "exec"), names)
    with pytest.raises((NameError, AttributeError)) as caught:
        names["test_it"](None, module.Robot())
    assert message in str(headline(caught.value, RobotFiles(tmp_path)))


COMMANDS = """
class Arm:
    def up(self): return self.run(print)
    def down(self): self.run(print)
    def stop(self): self.motor = 0
class Raise: ...
"""


@for_each(
    "bound, text, remedy",
    [
        ("arm.down()", "None, from arm.down()", "Write return before the command in down() (robot.py:4)."),
        ("arm.stop()", "None, from arm.stop()", "Write commands2.cmd.runOnce(lambda: arm.stop(), SUBSYSTEM), with"),
        ("arm.up().schedule()", "None, from arm.up().schedule(), which runs here", "Write arm.up() without it."),
        ("arm.up", "the function arm.up, and no command", "Write arm.up(), which returns the command."),
        ("arm.down", "the function arm.down, and no command", "Write commands2.cmd.runOnce(arm.down, SUBSYSTEM), with"),
        ("lambda: f(1)", "the function lambda: f(1), and no command", "Write commands2.cmd.runOnce(lambda: f(1), SUB"),
        ("Raise", "the class Raise, and no command", "Write Raise(...), with what its __init__ needs (robot.py:6)."),
    ],
)
def test_what_is_bound_to_a_trigger_and_is_no_command(bound: str, text: str, remedy: str) -> None:
    defined = dict(users_definitions([("robot.py", ast.parse(COMMANDS))]))
    found = no_command(ast.parse(bound, mode="eval").body, defined)
    assert found is not None
    assert found[0].startswith(text)
    assert found[1].startswith(remedy)


@for_each("bound", ["arm.up()", "Raise()", "command"])
def test_what_may_be_a_command(bound: str) -> None:
    defined = dict(users_definitions([("robot.py", ast.parse(COMMANDS))]))
    assert no_command(ast.parse(bound, mode="eval").body, defined) is None


def test_an_unknown_error_is_shown_as_it_is(headline_of: Raise) -> None:
    assert headline_of("{}['key']") == "robot.py:2: KeyError: 'key'"


def test_an_object_whose_methods_raise_does_not_hide_the_error(tmp_path: Path) -> None:
    class Broken:
        def __dir__(self) -> list[str]:
            raise ValueError

    assert explain(AttributeError("no x", name="x", obj=Broken()), RobotFiles(tmp_path)) is None


@for_each("successor", [*earlier_names().values(), *SUCCESSORS.values()])
def test_successors_exist(successor: str) -> None:
    """Dotted names of modules in the tables can be imported, and have the attribute."""
    for dotted in re.findall(r"\b(?:wpilib|wpimath|commands2|rev|phoenix6|ntcore|navx)\.[\w.]*\w", successor):
        parts = dotted.split(".")
        found: object = None
        for length in range(len(parts), 0, -1):
            try:
                found = importlib.import_module(".".join(parts[:length]))
            except ImportError:
                continue
            for name in parts[length:]:
                found = getattr(found, name)
            break
        assert found is not None, dotted


def test_modules_belong_to_the_packages_in_the_table() -> None:
    from importlib.metadata import packages_distributions

    for module, distributions in packages_distributions().items():
        if module in PACKAGES and module in sys.modules:
            names = {each.lower().replace("_", "-") for each in distributions}
            assert PACKAGES[module].lower() in names


def test_the_line_for_the_robot(tmp_path: Path) -> None:
    file = tmp_path / "pyproject.toml"
    assert robot_line("robotpy-rev", file) == (
        'for the robot, write requires = ["robotpy-rev"] under [tool.robotpy] in pyproject.toml'
    )
    file.write_text('[tool.robotpy]\nrequires = ["phoenix6"]\n')
    assert robot_line("robotpy-rev", file) == 'for the robot, add "robotpy-rev" to requires in pyproject.toml:2'
    assert robot_line("phoenix6", file) == ""
    assert robot_line("opencv-python", file).endswith('components = ["cscore"] under [tool.robotpy] in pyproject.toml')
    assert robot_line("robotpy-commands-v2", file).endswith('["commands2"] under [tool.robotpy] in pyproject.toml')
    assert robot_line("pyntcore", file) == ""
    assert install_line("robotpy-rev") == "python -m pip install robotpy-rev"


#: What is raised, and the whole of what is said of it.
WHOLE = {
    "range(10 / 2)": "range() takes whole numbers, and 10 / 2 is none: / makes a float\n  Write 10 // 2",
    "range(2.5)": "range() takes whole numbers\n  Write int(2.5)",
    "speed = None\nspeed += 1": "speed is None, and no number\n  Has anything set speed before?",
    "speed = None\nreturn -speed": "speed is None, and no number\n  Has anything set speed before?",
    "speed = None\nreturn 1 + speed * 2": "speed is None, and no number\n  Has anything set speed before?",
    "speed = None\nreturn 3 < speed": "speed is None, and no number\n  Has anything set speed before?",
    "import time as t\nt()": "t is a module, and cannot be called\n  Write t.time(), or what else it has",
    "import wpimath.geometry as g\ng()": "g is a module, and cannot be called\n  Write g.NAME(), or what else it has",
    "def f(a, b=2): pass\nf()": "f() was called without 'a'\n  It takes: f(a, b=2) (robot.py:2)",
    "def f(a, b=2): pass\nf(1, 2, c=3)": "f() was called with c=\n  It takes: f(a, b=2) (robot.py:2)",
    "def f(a, *, b): pass\nf(1)": "f() was called without 'b'\n  It takes: f(a, b=...) (robot.py:2)",
    "class A:\n    def f(self, x): pass\n    def g(self): self.f(self, 1)\nA().g()": (
        "self.f() gets self twice: before the dot, and in ()\n  Write self.f(1) (robot.py:3)"
    ),
    "class A:\n    def __init__(self, x): pass\nA()": "A() was called without 'x'\n  It takes: A(x) (robot.py:3)",
    "class A:\n    def f(self): pass\nA.f()": (
        "f() is called on the class A, and not on an object of it\n"
        "  Create an object in __init__, as in: self.it = A(...). Then call: self.it.f(...)"
    ),
    "class A:\n    def f(self): pass\na = A()\nA.f()": (
        "f() is called on the class A, and not on an object of it\n  Write a.f(...)"
    ),
    "class A:\n    def robotInit(self): wpilib.Timer.get()\nA().robotInit()": (
        "get() is called on the class wpilib.Timer, and not on an object of it\n"
        "  Create an object in robotInit, as in: self.it = wpilib.Timer(...). Then call: self.it.get(...)"
    ),
    "class B:\n    def f(self): pass\nclass A(B):\n    def g(self): B.f()\nA().g()": (
        "f() is called without self\n  Write super().f(), with what it takes."
    ),
    "t = wpilib.Timer\nt.get()": (
        "t is the class Timer, and no object of it\n  Write Timer(...), with what its __init__ needs."
    ),
    "wpilib.Encoder(0, 1, False, 'k4x')": (
        "Encoder() got 'k4x', a text\n  Write wpilib.interfaces.CounterBase.EncodingType.k4X\n*"
    ),
    "import wpilib.drive\nwpilib.drive.DifferentialDrive(0, 1)": (
        "DifferentialDrive() got 0, a number, and no MotorController\n"
        "  Write wpilib.PWMSparkMax(0), or the name of a motor controller that is made already.\n*"
    ),
    "wpilib.SmartDashboard.putData('a', 3)": (
        "putData() got 3, a number, and no Sendable\n  Write Sendable(...), from wpiutil import Sendable\n*"
    ),
    "from wpimath.geometry import Rotation2d\nRotation2d().rotateBy(3)": (
        "rotateBy() got 3, a number, and no Rotation2d\n"
        "  Write Rotation2d.fromDegrees(3), if it is in degrees: from wpimath.geometry import Rotation2d\n*"
    ),
    "wpilib.PWMSparkMax(None)": ("PWMSparkMax() got None\n  Pass a value.\n  It takes: PWMSparkMax(channel: number)"),
    "wpilib.PWMSparkMax('0')": (
        "PWMSparkMax() got '0', a text\n  Write it without quotes: 0\n  It takes: PWMSparkMax(channel: number)"
    ),
    "wpilib.PWMSparkMax(0).set('fast')": (
        "set() got 'fast', a text\n  Pass a number, and no text.\n  It takes: set(value: number)"
    ),
    "from wpimath.geometry import Rotation2d as R\nwpilib.PWMSparkMax(0).set(R(1))": (
        "set() got R(1), an object of Rotation2d\n"
        "  Pass a number, such as one of these of it: .cos(), .degrees(), .radians(), .sin(), .tan()\n*"
    ),
    "wpilib.SmartDashboard.putString('a', 3)": (
        "putString() got 3, which is no text\n  Write str(3), or the text in quotes.\n*"
    ),
    "self.x = self2": "NameError: name 'self2' is not defined\n  Did you mean self?",
    "arm = 1\nreturn amr": "NameError: name 'amr' is not defined\n  Nothing has given amr a value: *",
    "this.x = 1": "NameError: name 'this' is not defined\n  Did you mean self?",
    "class A:\n    def f(self): return gain\n    gain = 1\nA().f()": (
        "NameError: name 'gain' is not defined\n  Did you mean self.gain?"
    ),
    "return self.Beta\nclass Beta: pass": "AttributeError: module 'robot' has no attribute 'Beta'",
    "x = 'abc'\nx.foo": "x is a text ('abc') and has no foo",
    "x = True\nx.foo": "x is True or False (True) and has no foo",
    "x = 3\nx.numeratr": "x is a number (3) and has no numeratr\n  Did you mean numerator?",
    "x = [1]\nx[3]": "x[3]: x has 1 value, and indexes begin with 0\n  The last one is x[0]",
    "x = []\nx[0]": "x[0]: x has 0 values, and indexes begin with 0\n  Has anything filled x?",
    "k = 'lef'\nd = {'left': 1}\nd[k]": "d has no key 'lef', from d[k]\n  Did you mean 'left'?",
    "x = {}\nx()": "x is a value (dict), and no function\n  Write x[...], without ()",
    "class A:\n    def __init__(self):\n        x = 1\nA().x": (
        "AttributeError: 'A' object has no attribute 'x'\n"
        "  Write self.x = ... in robot.py:4: without self, the name is known there only."
    ),
    "class A:\n    def __init__(self):\n        self.x = 1\na = A()\nA.x": (
        "A is the class, and only an object of it has x (robot.py:4 sets it)\n  Write a.x"
    ),
    "def f():\n    print(y)\n    y = 1\nf()": (
        "UnboundLocalError: *\n  Not every way through the function sets y: give it a value at the beginning."
    ),
    "import photonlib": "there is no module photonlib\n  *photonlibpy*",
    "from . import arm": (
        "a dot before a module's name means: of the same package, and this file is in none\n"
        "    from . import arm\n  Write: import arm"
    ),
    "wpilib.Solenoid(0)": (
        "Solenoid() was called with 1 value, but takes 2 to 3\n  It takes: *\n"
        "  PneumaticsModuleType is one of: CTREPCM, REVPH"
    ),
}


@pytest.mark.filterwarnings("ignore::ImportWarning")
@for_each("code, said", WHOLE.items())
def test_an_error_in_all_its_words(headline_of: Raise, code: str, said: str) -> None:
    whole = headline_of(code).partition(": ")[2]
    assert fnmatchcase(whole, said.replace("[", "[[]")), whole


@pytest.mark.parametrize(
    ("error", "text", "instead"),
    [
        (ModuleNotFoundError("", name="wpimath.geometry"), "there is no module wpimath.geometry", "wpimath"),
        (AttributeError(name="geometry", obj=wpimath), "there is no module wpimath.geometry", "wpimath"),
        (AttributeError(name="PWMSparkMax", obj=wpilib), "wpilib has no PWMSparkMax", "wpilib_drivers.PWMSparkMax"),
        (AttributeError(name="kRed", obj=Color), "Color has no kRed", "RED"),
        (AttributeError(name="fromDegrees", obj=Rotation2d()), "Rotation2d has no fromDegrees", "from_degrees"),
        (ModuleNotFoundError("", name="commands2"), None, ""),
        (ModuleNotFoundError("", name="arm"), None, ""),
        (AttributeError(name="x", obj=[]), None, ""),
        (AttributeError(name="no_such", obj=wpilib), None, ""),
        (KeyError("x"), None, ""),
    ],
)
def test_a_name_of_2026_beside_wpilib_2027(
    error: Exception, text: str | None, instead: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the table of names alone, where WPILib 2027 is not installed; its classes are those of 2026 here."""
    monkeypatch.setattr(other_season, "CURRENT", SEASONS[2027])
    monkeypatch.setattr(Color, "RED", 1, raising=False)
    monkeypatch.setattr(Rotation2d, "from_degrees", 1, raising=False)
    found = other_season.explain(error, RobotFiles(tmp_path))
    if text is None:
        assert found is None
        return
    assert found is not None
    remedy = f'Instead: {instead}.\n  If the robot is for WPILib 2026: pip install "{SEASONS[2026].requirement}"'
    assert (found.text, found.remedy) == (f"{text} in WPILib 2027", remedy)
    (tmp_path / "pyproject.toml").write_text('[tool.robotpy]\nrobotpy_version = "2027.0.0a7"\n')
    found = other_season.explain(error, RobotFiles(tmp_path))
    assert found is not None
    assert found.remedy == f"Instead: {instead}."


def test_a_remedy_in_the_names_of_2027(monkeypatch: pytest.MonkeyPatch) -> None:
    for text in ("Rotation2d.fromDegrees(90)", "autonomousInit"):
        assert other_season.in_2027(text) == text
    monkeypatch.setattr(other_season, "CURRENT", SEASONS[2027])
    for text, new in {
        "Write wpimath.geometry.Rotation2d.fromDegrees(90)": "Write wpimath.Rotation2d.from_degrees(90)",
        "{}.set(wpilib.DoubleSolenoid.Value.kReverse)": "{}.set(wpilib.DoubleSolenoid.Value.REVERSE)",
        "Read it in autonomousInit.": "Read it in autonomous_init.",
        "It is self.leftMotor.": "It is self.left_motor.",
    }.items():
        assert other_season.in_2027(text) == new


@pytest.mark.parametrize(
    ("code", "text"),
    [
        ("import wpilib_drivers", "there is no module wpilib_drivers"),
        ("import telemetry", "there is no module telemetry"),
        ("wpilib.OpModeRobot()", "wpilib has no OpModeRobot"),
        ("from wpilib import PeriodicOpMode", "wpilib has no PeriodicOpMode"),
    ],
)
def test_a_name_of_2027(headline_of: Raise, code: str, text: str) -> None:
    assert headline_of(code) == (
        f'robot.py:2: {text} in WPILib 2026\n  If the robot is for WPILib 2027: pip install "wpilib>=2027.0.0a7,<2028"'
    )


def test_while_there_are_only_previews_pip_is_asked_for_one() -> None:
    assert SEASONS[2026].requirement_of("robotpy-rev") == "robotpy-rev"
    assert SEASONS[2027].requirement_of("robotpy-rev") == '"robotpy-rev>=2027.0.0a1,<2028"'


def test_a_method_with_other_parameters(headline_of: Raise, tmp_path: Path) -> None:
    robot = """
        class Drive(commands2.Subsystem):
            def periodic(self, dt): pass
        class Go(commands2.Command):
            def end(self): pass
        class Test:
            def it(control, robot): control.enable()
    """
    assert headline_of(f"{dedent(robot)}vars(self).update(locals())\nTest().it(1)") == (
        "robot.py:7: the method it(control, robot) has no parameter self: write def it(self, control, robot):"
    )


@for_each(
    "text, message, remedy",
    [
        (
            "x = 1\n<<<<<<< HEAD\nx = 2\n=======\nx = 3\n>>>>>>> arm\n",
            "robot.py:2: a merge conflict of git",
            "Keep one",
        ),
        ("print(\u201chello\u201d)\n", "robot.py:1: the character \u201c is a quotation mark", 'Write " with'),
        ("x = 3 \u2013 1\n", "robot.py:1: the character \u2013 is a dash", "Write - with"),
        ("x =\u00a03\n", "robot.py:1: U+00A0 is a special space", "an ordinary space"),
        ("def f()\n    pass\n", "robot.py:1: SyntaxError: expected ':'", "Write a colon"),
        ("if True:\nx = 1\n", "IndentationError", "by four spaces more than that line"),
        ("if True:\n    x = 1\n   y = 2\n", "IndentationError", "Indent this line exactly"),
        ("if True:\n\tx = 1\n        y = 2\n", "robot.py:3: TabError", "spaces only"),
        ("if True:\n    x = 1\nelse if x:\n    y = 2\n", "robot.py:3: SyntaxError", "Write elif, in one word."),
        ("if !x:\n    y = 2\n", "robot.py:1: SyntaxError", "Write not for !"),
        ("self.count++\n", "robot.py:1: SyntaxError", "Write self.count += 1"),
        ("arm = new Arm()\n", "robot.py:1: SyntaxError", "Write Arm(...) without new."),
        ("if a && b:\n    y = 2\n", "robot.py:1: SyntaxError", "Write and for &&"),
        ("double speed = 1\n", "robot.py:1: SyntaxError", "Write speed = ... without the words before it."),
        ("speed = 0.5f\n", "robot.py:1: SyntaxError", "Write the number without a letter."),
        ("if (a) {\n    b()\n}\n", "robot.py:1: SyntaxError", "Write a colon for the brace"),
        ("x = 1 // the left one\n", "robot.py:1: SyntaxError", "A comment begins with #."),
        ("self.in = 3\n", "robot.py:1: SyntaxError", "in is a word of Python"),
        ("else:\n    y = 2\n", "robot.py:1: SyntaxError", "Write else exactly below its if"),
        ("x = 1 +\n", "robot.py:1: SyntaxError", ""),
        ("x = (1\ny = 2\n", "'(' was never closed", "Close the bracket"),
    ],
)
def test_a_file_that_python_cannot_read(tmp_path: Path, text: str, message: str, remedy: str) -> None:
    file = tmp_path / "robot.py"
    file.write_text(text, "utf-8")
    with pytest.raises(SyntaxError) as caught:
        compile(text, str(file), "exec")
    explained = explain(caught.value, RobotFiles(tmp_path))
    assert explained is not None
    assert message in f"{explained.place}: {explained.text}"
    assert remedy in explained.remedy


def test_a_file_that_is_not_there_any_more(tmp_path: Path) -> None:
    file = str(tmp_path / "robot.py")
    for text, shown in ((None, ""), (" \n", ""), (" x = \n", "\n    x =")):
        explained = explain(SyntaxError("odd", (file, 3, 1, text)), RobotFiles(tmp_path))
        assert explained is not None
        assert (explained.text, explained.place) == (f"SyntaxError: odd{shown}", "robot.py:3")
    assert explain(SyntaxError("odd", ("/elsewhere.py", 3, 1, "x")), RobotFiles(tmp_path)) is None
    marks = "".join(f"<<<<<<< {number}\n" for number in range(8))
    Path(file).write_text(marks, "utf-8")
    explained = explain(SyntaxError("odd", (file, 3, 1, "x")), RobotFiles(tmp_path))
    assert explained is not None
    marked = "a merge conflict of git is not resolved: its marks are in lines 1, 2, 3, 4, 5, 6 and more"
    assert (explained.text, explained.place) == (marked, "robot.py:1")


def test_imports_of_the_projects_own_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "subsystems").mkdir()
    (tmp_path / "subsystems" / "arm.py").write_text("from one import Two\n")
    (tmp_path / "one.py").write_text("import subsystems.arm\nclass Two: pass\n")
    monkeypatch.syspath_prepend(tmp_path)
    files = RobotFiles(tmp_path)

    def explained(text: str) -> str:
        try:
            exec(text)
        except ImportError as error:
            found = explain(error, files)
            assert found is not None
            return f"{found.text}. {found.remedy}"
        finally:
            for name in ("one", "two", "subsystems", "subsystems.arm"):
                sys.modules.pop(name, None)
        raise AssertionError("it raises nothing")

    assert "write subsystems, as the file or folder is called" in explained("import Subsystems.arm")
    assert "write subsystems.arm, as" in explained("import subsystems.Arm")
    assert "Did you mean one?" in explained("import onee")
    (tmp_path / "two.py").write_text("def _turn(): pass\n")
    assert "Is the name right?" in explained("from two import turn"), "what is private is not suggested"
    circle = explained("import one")
    assert "subsystems/arm.py imports one.py, which is importing subsystems/arm.py and does not have Two yet" in circle
    assert "if TYPE_CHECKING:" in circle


def test_components_that_do_not_exist(tmp_path: Path) -> None:
    file = tmp_path / "pyproject.toml"
    file.write_text('[tool.robotpy]\ncomponents = ["command2", "cscore", "sim"]\n')
    assert list(unknown_components(load_robot_packages(file))) == [
        ("components has 'command2', which does not exist", "Did you mean 'commands2'?")
    ]
    file.write_text('[tool.robotpy]\ncomponents = "commands2"\n')
    with pytest.raises(SettingsError, match=r"pyproject.toml:2: components must be a list\n  .*\[.commands2.\]"):
        load_robot_packages(file)


def test_a_name_of_another_language_is_no_missing_import(headline_of: Raise) -> None:
    assert "import this" not in headline_of("this.arm = 1")
    assert "import math" in headline_of("return math.pi")
    assert "None" in headline_of("return 1 < None < 3")
