"""Robot code that replaces or closes the standard streams: commands print to those that they were started with.

`core/test_lent_streams` has each way to do that.
"""

from __future__ import annotations

import pytest
from conftest import SHORT_MATCH, MakeProject, RobotProject, sampled

#: A recorder of the console, as robots have them: with other attributes than a stream.
ROBOT = """
    import logging
    import sys

    import wpilib


    class Recorder:
        def __init__(self, orig):
            self.orig = orig
            self.buffer = ""

        def write(self, text):
            self.orig.write(text)
            self.buffer = text

        def flush(self):
            self.orig.flush()


    def replace():
        {what}

    {at_import}

    class Robot(wpilib.TimedRobot):
        def robotInit(self):
            print("printed before")
            {in_init}
            self.motor = wpilib.Spark(0)

        def teleopPeriodic(self):
            self.motor.set(0.1)
"""

REPLACES = {
    "both names": "sys.stdout = sys.__stdout__ = sys.stderr = sys.__stderr__ = Recorder(sys.stdout)",
    "none": "sys.stdout = sys.stderr = None",
    "closed": "sys.stdout.close(); sys.stderr.close()",
    "a handler": "logging.basicConfig(stream=sys.stdout); sys.stdout = Recorder(sys.stdout); logging.error('logged')",
}


def make(make_project: MakeProject, what: str, at_import: bool = False) -> RobotProject:
    text = ROBOT.replace("{what}", REPLACES[what])
    text = text.replace("{at_import}", "replace()" if at_import else "").replace(
        "{in_init}", "" if at_import else "replace()"
    )
    return make_project({"robot.py": text, "pyproject.toml": SHORT_MATCH})


@pytest.mark.parametrize(
    ("what", "at_import"),
    sampled([("closed", False), ("none", False), ("a handler", False), ("both names", True)], ("closed", False)),
)
def test_tests_and_replays(make_project: MakeProject, what: str, at_import: bool) -> None:
    project = make(make_project, what, at_import)
    tested = project.run("test", "--builtin", "--record", "scripts")
    assert tested.code == 0, tested.output
    assert "4 passed" in tested.stdout
    replayed = project.run("replay", "scripts/pyfrc.tests.test_practice.jsonl")
    assert replayed.code == 0, replayed.output
    assert "printed before\n" in replayed.stdout
    assert "The trace equals the recorded one. " in replayed.stdout.splitlines()[-1]
    if what == "a handler":
        assert "ERROR:root:logged\n" in replayed.stdout


@pytest.mark.parametrize("options", sampled([["--no-isolation"], ["--", "-s"]], ["--no-isolation"]))
def test_other_ways_to_run_tests(make_project: MakeProject, options: list[str]) -> None:
    result = make(make_project, "closed").run("test", "--builtin", *options)
    assert result.code == 0, result.output
    assert "4 passed" in result.stdout


@pytest.mark.parametrize(
    ("command", "last"),
    sampled(
        [
            (["fuzz", "--runs", "2"], "But 2 matches prove little: pyfrc fuzz --time 600 plays for ten minutes.\n"),
            (["create-physics"], ""),
            (["sim", "--ui", "none", "--mode", "practice", "--seconds", "3"], ""),
            (["coverage", "test", "--builtin"], ""),
            (["profile", "test", "--builtin"], ""),
        ],
        (["coverage", "test", "--builtin"], ""),
    ),
)
def test_other_commands(make_project: MakeProject, command: list[str], last: str) -> None:
    result = make(make_project, "closed").run(*command)
    assert result.code == 0, result.output
    assert "Traceback" not in result.output
    assert ("Nothing was found." in result.stdout) == (command[0] == "fuzz")
    assert result.stdout.endswith(last)


CAPTURED = """
    import pytest

    @pytest.fixture
    def started(control):
        with control.run_robot():
            yield control

    @pytest.mark.parametrize("name", ["capfd", "capsys"])
    def test_before(request, name, control):
        captured = request.getfixturevalue(name)
        with control.run_robot():
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert "printed in teleop\\n" in captured.readouterr().out

    @pytest.mark.parametrize("name", ["capfd", "capsys"])
    def test_after(request, name, started):
        captured = request.getfixturevalue(name)
        started.step_timing(seconds=0.1, autonomous=False, enabled=True)
        assert "printed in teleop\\n" in captured.readouterr().out
"""


@pytest.mark.parametrize("options", sampled([[], ["--no-isolation"]], []))
def test_what_a_robot_prints_is_in_the_fixtures_of_pytest(make_project: MakeProject, options: list[str]) -> None:
    robot = "import wpilib\n\nclass Robot(wpilib.TimedRobot):\n    def teleopInit(self):\n"
    robot += "        print('printed in teleop')\n"
    project = make_project({"robot.py": robot, "tests/test_captured.py": CAPTURED})
    result = project.run("test", *options)
    assert result.code == 0, result.output
    assert "4 passed" in result.stdout
