"""Students' mistakes as the terminal shows them: one short block for each, with the user's line and a remedy."""

from __future__ import annotations

import pytest
from conftest import MakeProject, Result

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        pass
"""

MAGIC = """
    import magicbot
    import wpilib

    from components.arm import Arm


    class MyRobot(magicbot.MagicRobot):
        arm: Arm

        def createObjects(self):
            self.motor = wpilib.PWMSparkMax(0)
"""

COMMANDS = """
    import commands2
    import wpilib


    class Arm(commands2.Subsystem):
        def up(self):
            return self.run(print)


    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.arm = Arm()
            self.both = commands2.cmd.parallel(self.arm.up(), self.arm.up())
"""

READY_MADE = "from pyfrc.tests import *\n"


def blocks_of(result: Result) -> list[list[str]]:
    assert result.code == 1, result.output
    return [block.splitlines() for block in result.blocks().values()]


def test_an_error_inside_magicbot_is_one_block_with_the_users_class(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": MAGIC,
            "components/arm.py": "class Arm:\n    speed = 0\n\n    def excute(self):\n        pass\n",
            "tests/pyfrc_test.py": READY_MADE,
        }
    )
    first, *others = blocks_of(project.run("test", "--", "-k", "autonomous or disabled"))
    assert first[0] == "components/arm.py:1: class Arm has no execute()"
    assert "def execute(self):" in first[1]
    assert len(first) < 10
    assert {block[0].partition(", ")[0] for block in others} == {
        "components/arm.py:1: the same as in test_autonomous[]"
    }


ARM = "class Arm:\n    motr: object\n\n    def execute(self):\n        pass\n"
CLAW = "class Claw:\n    arm: Arm\n\n    def execute(self):\n        pass\n"


def test_a_component_that_asks_for_what_is_not_there(make_project: MakeProject) -> None:
    project = make_project({"robot.py": MAGIC, "components/arm.py": ARM, "tests/pyfrc_test.py": READY_MADE})
    first = blocks_of(project.run("test", "--", "-k", "autonomous"))[0]
    assert first[0] == "components/arm.py:2: class Arm asks for motr, which the robot does not have"
    assert "self.arm_motr" in first[1]


@pytest.mark.slow
def test_a_component_that_is_assigned_instead_of_declared(make_project: MakeProject) -> None:
    components = ARM.replace("    motr: object\n", "") + CLAW
    robot = MAGIC.replace("arm: Arm\n", "claw: Claw\n        arm = Arm\n").replace("import Arm", "import Arm, Claw")
    project = make_project({"robot.py": robot, "components/arm.py": components, "tests/pyfrc_test.py": READY_MADE})
    first = blocks_of(project.run("test", "--", "-k", "autonomous"))[0]
    assert first[0].startswith(f"{project.place('robot.py', 'arm = Arm')}: arm is the class itself")
    assert first[1].strip() == "Declare a component with a colon: arm: Arm"


def test_a_test_file_with_a_mistake_gets_the_lines_that_the_robot_gets(make_project: MakeProject) -> None:
    tests = {
        "tests/test_colon.py": "def test_it(control)\n    pass\n",
        "tests/test_import.py": "from robot import MyRobt\n",
    }
    result = make_project({"robot.py": ROBOT, **tests}).run("test")
    assert result.code == 2
    assert (
        "tests/test_colon.py:1: SyntaxError: expected ':'\n    def test_it(control)\n  Write a colon" in result.stdout
    )
    assert "tests/test_import.py:1: robot has no MyRobt\n  Did you mean MyRobot?" in result.stdout
    assert "_pytest" not in result.stdout


def test_nan_and_a_can_id_used_twice_are_named(make_project: MakeProject) -> None:
    robot = """
        import commands2
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.motor = wpilib.PWMSparkMax(0)
                commands2.RunCommand(print, self.motor)
                self.arm = wpilib.CAN(5)
                self.claw = wpilib.CAN(5)
                self.camera = wpilib.CAN(5, 8, 10)
                self.others = [wpilib.CAN(number) for number in (6, 7)]

            def disabledPeriodic(self):
                self.motor.set(float("nan"))
    """
    project = make_project({"robot.py": robot, "tests/pyfrc_test.py": READY_MADE})
    result = project.run("test", "--", "-k", "disabled")
    assert result.code == 0, result.output
    arm, claw = project.place("robot.py", "self.arm"), project.place("robot.py", "self.claw")
    assert f"{claw}: CAN ID 5 is used already, since {arm}, by a device of the same kind." in result.stdout
    assert f"{project.place('robot.py', 'nan')}: set() gets NaN" in result.stdout
    assert f"{project.place('robot.py', 'RunCommand')}: a requirement (PWMSparkMax) is no subsystem" in result.stdout
    section, _, warnings = result.stdout.partition("= mistakes without an error =")[2].partition("warnings summary")
    assert section.count("self.claw") == 0
    assert "CAN ID 5" in section
    assert "CAN ID 5" not in warnings


def test_a_fixture_that_does_not_exist(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": "def test_it(contrl):\n    pass\n"})
    (block,) = blocks_of(project.run("test"))
    assert block[:2] == ["tests/test_it.py:1: there is no fixture 'contrl'", "  did you mean 'control'?"]


IN_TELEOP = """
    def test_it(control, robot):
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=True)
"""


STATES = """
    import magicbot
    import wpilib


    class Shots(magicbot.StateMachine):
        @magicbot.state(first=True)
        def spin_up(self):
            self.next_state("psh")

        @magicbot.state
        def push(self):
            pass


    class MyRobot(magicbot.MagicRobot):
        shots: Shots

        def {}(self):
            pass

        def teleopPeriodic(self):
            self.shots.engage()
"""


def test_a_state_that_does_not_exist(make_project: MakeProject) -> None:
    project = make_project({"robot.py": STATES.format("createObjects"), "tests/test_it.py": IN_TELEOP})
    (block,) = blocks_of(project.run("test"))
    assert block[0] == f"{project.place('robot.py', 'psh')}: class Shots has no state psh"
    assert block[1] == "  Did you mean 'push'?"


@pytest.mark.slow
def test_a_magic_robot_with_robot_init(make_project: MakeProject) -> None:
    tests = {"tests/test_a.py": IN_TELEOP, "tests/test_b.py": READY_MADE}
    project = make_project({"robot.py": STATES.format("robotInit"), **tests})
    blocks = blocks_of(project.run("test", "--", "-k", "it or autonomous"))
    place = project.place("robot.py", "def robotInit")
    assert {block[0].partition(", ")[0] for block in blocks} == {
        f"{place}: class MyRobot has a robotInit()",
        f"{place}: the same as in test_it",
    }


def test_a_subsystem_needs_no_constructor_of_its_base(make_project: MakeProject) -> None:
    """The library registers it before its `__init__`."""
    arm = "class Arm(commands2.Subsystem):\n        def __init__(self):\n            self.turns = 0\n\n"
    arm += "        def periodic(self):\n            self.turns += 1\n\n"
    robot = COMMANDS.replace("self.both = commands2.cmd.parallel(self.arm.up(), self.arm.up())", "")
    test = f"{IN_TELEOP.rstrip()}\n            assert robot.arm.turns > 0\n"
    files = {"robot.py": robot.replace("class Arm(commands2.Subsystem):\n", arm), "tests/test_it.py": test}
    result = make_project(files).run("test")
    assert result.code == 0, result.output
    assert "super().__init__()" not in result.stdout


def test_a_module_that_only_pyfrc_imports_is_missing_here_too(make_project: MakeProject) -> None:
    robot = f"{ROBOT.rstrip()}\n    DRIVE = wpilib.drive.DifferentialDrive\n"
    result = make_project({"robot.py": robot, "tests/test_it.py": READY_MADE}).run("test", cold=True)
    assert "module 'wpilib' has no attribute 'drive'" in result.first_error
    assert "Is this line missing at the top: import wpilib.drive" in result.stderr


def test_a_test_file_with_another_name_is_named_where_it_is_the_only_one(make_project: MakeProject) -> None:
    result = make_project({"robot.py": ROBOT, "tests/arm_tests.py": "def test_it():\n    pass\n"}).run_here("test")
    assert result.code == 1
    assert "  tests/arm_tests.py: its tests are not run, since" in result.stderr
    assert "Rename it to test_arm.py." in result.stderr


@pytest.mark.parametrize("option", ["--nogui", "--headless"])
def test_an_option_of_another_simulator(make_project: MakeProject, option: str) -> None:
    result = make_project({"robot.py": ROBOT}).run_here("sim", option)
    assert result.code == 2
    assert "pyfrc sim --ui none --mode practice" in result.stderr
