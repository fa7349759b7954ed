"""Nothing is run twice: `pyfrc test --changed`, and deploys after tests that passed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROBOT = """
    import wpilib

    from parts.arm import Arm
    from parts.drive import Drive

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.arm, self.drive = Arm(), Drive()

        def autonomousPeriodic(self):
            self.drive.forward()

        def teleopPeriodic(self):
            self.arm.lift()
"""
ARM = '''
    """The arm."""

    import wpilib

    POWER = 0.5

    class Arm:
        def __init__(self):
            self.motor = wpilib.PWMSparkMax(1)

        def lift(self):
            # as far as it goes
            self.motor.set(POWER)

        @property
        def power(self):
            return self.motor.get()

        @power.setter
        def power(self, value):
            self.motor.set(value)

        def unused(self):
            return 1
'''
DRIVE = """
    import wpilib

    class Drive:
        def __init__(self):
            self.motor = wpilib.PWMSparkMax(0)

        def forward(self):
            self.motor.set(1)
"""
TESTS = """
    def run(control, autonomous):
        with control.run_robot():
            control.step_timing(seconds=0.1, autonomous=autonomous, enabled=True)

    def test_auto(control, robot):
        run(control, True)

    def test_teleop(control, robot, hal_data):
        run(control, False)
        assert hal_data["pwm"][1]["value"] > 0

    def test_power(control, robot):
        with control.run_robot():
            robot.arm.power = 0.25
            assert 0.2 < robot.arm.power < 0.3
"""
NUMBER_TESTS = """
    from parts.numbers import double

    def test_double():
        assert double(2) == 4
"""
NUMBERS = """
    def double(number):
        return 2 * number
"""
SMALL = "import wpilib\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
FILES = {
    "robot.py": ROBOT,
    "parts/__init__.py": "",
    "parts/arm.py": ARM,
    "parts/drive.py": DRIVE,
    "parts/numbers.py": NUMBERS,
    "deploy/speeds.json": "[1, 2]",
    "tests/test_robot.py": TESTS,
    "tests/test_numbers.py": NUMBER_TESTS,
}
ALL = {"auto", "teleop", "power", "double"}


def ran(made, *options: str, code: int = 0) -> set[str]:
    """The tests that a run with --changed has run."""
    result = made.run("test", "--changed", "-v", *options)
    assert result.code == code, result.output
    return set(re.findall(r"::test_(\w+) (?:PASSED|FAILED)", result.output))


def edit(made, name: str, old: str, new: str) -> None:
    file: Path = made.path / name
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.slow
def test_what_failed_runs_until_it_passes(make_project) -> None:
    project = make_project(FILES)
    edit(project, "parts/arm.py", "self.motor.set(POWER)", "self.motor.set(-POWER)")
    assert ran(project, code=1) == ALL
    assert ran(project, code=1) == {"teleop"}
    edit(project, "parts/arm.py", "self.motor.set(-POWER)", "self.motor.set(POWER)")
    assert ran(project) == ALL


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (["--coverage"], "--changed and --coverage are mutually exclusive"),
        (["--", "-n", "2"], "--changed and pytest-xdist's -n are mutually exclusive"),
    ],
)
def test_what_does_not_go_together(make_project, options: list[str], expected: str) -> None:
    result = make_project(FILES).run("test", "--changed", *options)
    assert result.code in (2, 4)
    assert expected in result.output


# -- deploys ---------------------------------------------------------------------------------------------------------

PASSED_ALREADY = re.compile(
    r"^tests +passed at \d\d:\d\d; the project's files, Python and packages have not changed since ", re.MULTILINE
)
NO_ROBOT = ("deploy", "--robot", "127.0.0.1:1")


def test_neither_a_run_nor_a_deploy_after_tests_that_passed_runs_them_again(make_project) -> None:
    made = make_project(FILES)
    assert ran(made) == ALL
    result = made.run("test", "--changed")
    assert result.code == 0
    expected = "4 tests passed before; the project's files that they depend on, Python and packages have not changed"
    assert expected in result.output
    result = made.run(*NO_ROBOT)
    assert PASSED_ALREADY.search(result.output), result.output
    assert "4 passed" not in result.output
    edit(made, "parts/arm.py", "return 1", "return 2")
    result = made.run(*NO_ROBOT)
    assert "4 passed" in result.output, "a deploy of something else is tested as a whole"
    assert PASSED_ALREADY.search(made.run(*NO_ROBOT).output), "its tests count, too"


#: Tests during which a file is saved, by the user or by the tests.
SAVES = """
    from pathlib import Path

    def test_saves():
        file = Path(__file__).parents[1] / {name!r}
        file.write_text({text})
"""


def small_project(make_project, name: str, text: str):
    files = {"robot.py": SMALL, "parts/arm.py": "", "log.txt": "", "tests/test_saves.py": ""}
    return make_project({**files, "tests/test_saves.py": SAVES.format(name=name, text=text)})


@pytest.mark.slow
def test_a_source_that_is_saved_while_the_tests_run_is_not_deployed_untested(make_project) -> None:
    name = "parts/arm.py"
    made = small_project(make_project, name, repr(SMALL + "# saved\n"))
    result = made.run(*NO_ROBOT)
    assert result.code == 1
    assert "1 passed" in result.output
    assert result.first_error == f"not deployed: files have changed since the tests began, and were not tested: {name}"
    assert "Run the command again." in result.stderr
    assert "1 passed" in (again := made.run(*NO_ROBOT)).output
    assert "not deployed" not in again.output, "the tests write the same again"


@pytest.mark.slow
def test_part_of_the_tests_or_a_failure_is_not_enough_for_a_deploy(make_project) -> None:
    made = make_project(FILES)
    assert made.run("test", "--", "-k", "auto").code == 0
    assert made.run("test", "tests/test_robot.py").code == 0
    assert "4 passed" in made.run(*NO_ROBOT).output
    made.run("test", "--seed", "3")
    assert "4 passed" in made.run(*NO_ROBOT).output, "a deploy tests with the usual seed"
    edit(made, "parts/arm.py", "POWER = 0.5", "POWER = -0.5")
    assert made.run("test").code == 1
    refused = made.run(*NO_ROBOT)
    assert "1 failed, 3 passed" in refused.output
    assert "the tests failed" in refused.stderr
