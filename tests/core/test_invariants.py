"""A project's rules: what cannot be one, and what is said of one that is broken or fails; all in this process."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import wpilib
from written_files import write_files

import pyfrc
from pyfrc_core.errors import PyfrcError
from pyfrc_core.invariants.load import Invariant, load_invariants
from pyfrc_core.invariants.watch import BrokenInvariantError, watch_invariants
from pyfrc_core.project import Project
from pyfrc_core.runtime.loading import import_file
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.wpi import station

Load = Callable[[str], tuple[Invariant, ...]]


@pytest.fixture
def load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Load]:
    """Loads the rules of a text, which is tests/rules.py of a project. Nothing of the project stays importable."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    (tmp_path / "tests").mkdir()
    (tmp_path / "robot.py").touch()

    def load(text: str) -> tuple[Invariant, ...]:
        (tmp_path / "tests/rules.py").write_text(text, "utf-8")
        return load_invariants(Project(tmp_path / "robot.py"))

    yield load
    for name, module in [*sys.modules.items()]:
        if str(getattr(module, "__file__", "")).startswith(str(tmp_path)):
            del sys.modules[name]


def rule(body: str, head: str = "def it_holds(robot, hal_data):") -> str:
    """The text of a file with one rule, whose body is in line 5."""
    return f"import pyfrc\n\n@pyfrc.invariant\n{head}\n    {body}\n"


@pytest.mark.parametrize(
    ("head", "body", "message"),
    [
        (
            "def it_holds(robots):",
            "pass",
            "tests/rules.py:4: the rule it_holds() has the parameter 'robots'\n"
            "  A rule can have the parameters hal_data and robot: did you mean 'robot'?",
        ),
        ("async def it_holds():", "pass", "tests/rules.py:4: the rule it_holds() must be a plain function"),
        ("def it_holds():", "yield", "tests/rules.py:4: the rule it_holds() must be a plain function"),
        (
            "def it_holds():",
            "pass\nimport no_such_module",
            "tests/rules.py:6: there is no module no_such_module",
        ),
        (
            "def it_holds():",
            "pass\n\n@pyfrc.invarient\ndef another():\n    pass",
            "tests/rules.py:7: AttributeError: module 'pyfrc' has no attribute 'invarient'",
        ),
        (
            "def it_holds():",
            "pass\n\nclass Rules:\n    @pyfrc.invariant\n    def another(self):\n        pass",
            ": TypeError: the rule another() is a method of Rules: write it as a function",
        ),
        (
            "def it_holds():",
            "pass\n\n@pyfrc.invariant\ndef it_holds():\n    pass",
            ": TypeError: there is another rule it_holds() above this one",
        ),
    ],
    ids=["parameter", "async", "yield", "import", "misspelled", "in a class", "twice"],
)
def test_what_cannot_be_a_rule_is_named_with_its_line(load: Load, head: str, body: str, message: str) -> None:
    with pytest.raises(PyfrcError) as raised:
        load(rule(body, head))
    assert str(raised.value).startswith("tests/rules.py:")
    assert message in str(raised.value)


def test_the_decorator_returns_the_function_and_needs_no_wpilib(load: Load) -> None:
    def holds(robot: object) -> bool:
        return True

    assert pyfrc.invariant(holds) is holds
    (found,) = load("import sys\n" + rule("assert 'pytest' not in sys.modules"))
    assert (found.name, found.parameters, found.place) == ("it_holds", ("robot", "hal_data"), "tests/rules.py:5")


def test_rules_in_a_package_of_tests_import_their_neighbors(load: Load, tmp_path: Path) -> None:
    write_files(tmp_path, {"tests/__init__.py": "", "tests/limits.py": "HIGHEST = 0.51\n"})
    text = "from .limits import HIGHEST\n" + rule("assert robot < HIGHEST", "def it_holds(robot):")
    (found,) = load(text)
    found.function(0.5)
    with pytest.raises(AssertionError):
        found.function(0.52)
    assert found.place == "tests/rules.py:5"


def test_rules_are_in_the_order_of_their_lines(load: Load) -> None:
    text = "import pyfrc\n" + "@pyfrc.invariant\ndef {}(robot): ...\n" * 3
    found = load(text.format("third", "first", "second"))
    assert [each.name for each in found] == ["third", "first", "second"]


def found_in(run: RobotRun, rules: tuple[Invariant, ...], directory: Path, robot: Any) -> list[BrokenInvariantError]:
    """Run the robot for three packets of teleoperated mode; return what is reported of the rules."""
    found: list[BrokenInvariantError] = []
    watch_invariants(run, Project(directory / "robot.py").files, rules, found.append)
    run.construct(robot)
    run.clock.at(0, 0, lambda: station.set_mode_named("teleop"))
    run.start()
    run.run_until(60_000)
    return found


#: `Arm` is code of the project, in which a rule may fail.
ARM = """
class Arm:
    height = 0.506

    def move(self, power):
        self.height += power
"""


@pytest.fixture
def robot(load: Load, tmp_path: Path) -> type[wpilib.TimedRobot]:
    """A robot with an arm."""
    (tmp_path / "arm.py").write_text(ARM, "utf-8")
    module = import_file(Project(tmp_path / "robot.py"), tmp_path / "arm.py")

    class Robot(wpilib.TimedRobot):
        def robotInit(self) -> None:
            self.arm = module.Arm()

        def robotPeriodic(self) -> None: ...

    return Robot


@pytest.mark.parametrize(
    ("body", "message", "kind"),
    [
        ("pass", "", ""),
        ("return True", "", ""),
        (
            "robot.arn",
            "tests/rules.py:5: the rule it_holds() raised AttributeError: 'Robot' object has no attribute 'arn'",
            "AttributeError",
        ),
        (
            "return 0",
            "tests/rules.py:4: the rule it_holds() returned 0: return True or False, or use assert",
            "InvariantError",
        ),
        (
            "robot.arm.move('up')",
            "tests/rules.py:5: the rule it_holds() raised TypeError: unsupported operand type(s) for +=: 'float' and "
            "'str' (at arm.py:6)",
            "TypeError",
        ),
        (
            "return robot.arm.height < 0.505",
            "tests/rules.py:4: the rule it_holds() is broken: robot.arm.height is 0.506",
            "invariant",
        ),
        (
            "below(abs(robot.arm.height))\n\nLIMIT = 0.505\ndef below(height):\n    assert height < LIMIT, 'too high'",
            "tests/rules.py:9: the rule it_holds() is broken: too high (height is 0.506, LIMIT is 0.505)",
            "invariant",
        ),
    ],
)
def test_what_a_rule_does_is_reported_once(
    run: RobotRun, load: Load, robot: type[wpilib.TimedRobot], tmp_path: Path, body: str, message: str, kind: str
) -> None:
    found = found_in(run, load(rule(body)), tmp_path, robot)
    assert [each.kind for each in found] == [kind] * bool(kind)
    for each in found:
        what, *when = str(each).splitlines()
        assert what == message
        assert when == ["  at 0.02 s of robot time, in teleop mode"] * (kind != "InvariantError")
