"""What an error means: the sentence, the line and the remedy that a student gets, for errors that libraries raise."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import commands2
import pytest
import wpilib
import wpilib.drive

from pyfrc_core.config.packages import PACKAGES, SUCCESSORS, install_line, robot_line
from pyfrc_core.config.robotpy import load_robot_packages, unknown_components
from pyfrc_core.errors import SettingsError
from pyfrc_core.explain import explain
from pyfrc_core.explain.names import GONE
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.checks.failures import headline
from pyfrc_core.season import SEASONS

rev = pytest.importorskip("rev")

Raise = Callable[[str], str]


@pytest.fixture
def headline_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Raise:
    """Runs the body of a function in a file of the project, and returns the headline of its error."""

    def headline_of(text: str) -> str:
        file = tmp_path / "robot.py"
        file.write_text("def run(self):\n" + "".join(f"    {line}\n" for line in dedent(text).strip().splitlines()))
        module = ModuleType("robot")
        vars(module).update(wpilib=wpilib, commands2=commands2, rev=rev)
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


@pytest.mark.parametrize(
    ("code", "message", "remedy"),
    [
        # Devices: the channel is the user's, and not the HAL's number.
        (
            "a = wpilib.PWMSparkMax(0)\nb = wpilib.PWMSparkMax(0)",
            "PWM channel 0 is used already, since robot.py:2",
            "own",
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
            "Does speed() return something?\n  It takes: set(value: number)",
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
            "wpilib.Timer.get()",
            "get() is called on the class wpilib.Timer, and not on an object of it",
            "self.it = wpilib.Timer(...). Then call: self.it.get(...)",
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


def test_an_unknown_error_is_shown_as_it_is(headline_of: Raise) -> None:
    assert headline_of("{}['key']") == "robot.py:2: KeyError: 'key'"


def test_an_object_whose_methods_raise_does_not_hide_the_error(tmp_path: Path) -> None:
    class Broken:
        def __dir__(self) -> list[str]:
            raise ValueError

    assert explain(AttributeError("no x", name="x", obj=Broken()), RobotFiles(tmp_path)) is None


@pytest.mark.parametrize("successor", [*GONE.values(), *SUCCESSORS.values()])
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


@pytest.mark.parametrize(
    ("text", "message", "remedy"),
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
        ("if True:\nx = 1\n", "IndentationError", "indent this one by four spaces"),
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
            for name in ("one", "subsystems", "subsystems.arm"):
                sys.modules.pop(name, None)
        raise AssertionError("it raises nothing")

    assert "write subsystems, as the file or folder is called" in explained("import Subsystems.arm")
    assert "write subsystems.arm, as" in explained("import subsystems.Arm")
    assert "Did you mean one?" in explained("import onee")
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
