"""A project's physics.py: its discovery, its generation, its run with the robot, and messages about invalid ones."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from conftest import sampled

SQUARE = Path(__file__).parent / "robots" / "square"

ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.seen_by_constructor = wpilib.RobotController.getBatteryVoltage()

        def robotInit(self):
            wpilib.wait(0.1)
            self.motor = wpilib.PWMSparkMax(0)
    """

RUNS = """
    def test_it(control, robot, physics_controller):
        control.set_operator_control()
        control.run_test(lambda tm: tm < 1)
"""


@pytest.mark.slow
def test_both_generations_drive_the_same_square(make_shared_project) -> None:
    paths = []
    for physics in ("physics.py", "since_2020/physics.py"):
        project = make_shared_project({})
        project.copy(SQUARE)
        shutil.copyfile(SQUARE / physics, project.path / "physics.py")
        result = project.run("test", "--", "tests/test_square.py")
        assert result.code == 0, result.output
        paths.append(json.loads((project.path / "path.json").read_text("utf-8")))
    assert len(paths[0]) == len(paths[1]) == 700
    for documented, todays in zip(*paths, strict=True):
        assert documented == pytest.approx(todays, abs=0.01)  # turned before each step, or along its arc


# -- when what is made and called ------------------------------------------------------------------------------------

MADE = """
    import __main__

    class PhysicsEngine:
        def __init__(self, physics_controller, robot):
            self.robot = robot
            self.calls = []
            self.motor = robot.motor  # made in robotInit
            __main__.engine = self

        def update_sim(self, now, tm_diff):
            self.calls.append(tm_diff)
    """

MAGIC = """
    import magicbot, wpilib

    class MyRobot(magicbot.MagicRobot):
        def createObjects(self):
            wpilib.wait(0.5)
            self.motor = wpilib.PWMSparkMax(0)
    """


WATCHED = """
    import __main__

    class PhysicsEngine:
        def __init__(self, physics_controller):
            self.physics_controller = physics_controller
            self.calls = __main__.calls = []

        def update_sim(self, hal_data, now, tm_diff):
            self.calls.append((round(now, 6), round(tm_diff, 6)))
            self.physics_controller.drive(1, 1, tm_diff)
    """


def passes(make_project, physics: str, test: str, *options: str, robot: str = ROBOT) -> None:
    project = make_project({"robot.py": robot, "physics.py": physics, "tests/test_it.py": test})
    result = project.run("test", *options)
    assert result.code == 0, result.output


def test_the_engine_gets_the_robot_when_its_init_is_over(make_project) -> None:
    passes(
        make_project,
        MADE,
        """
        import __main__

        def test_it(control, robot):
            control.set_operator_control()
            control.run_test(lambda tm: tm < 1)
            assert __main__.engine.robot is robot
            assert set(round(tm_diff, 6) for tm_diff in __main__.engine.calls) == {0.02}
            assert len(__main__.engine.calls) == 25
        """,
        robot=MAGIC,
    )


@pytest.mark.slow
def test_its_time_begins_with_the_robots(make_project) -> None:
    passes(
        make_project,
        WATCHED,
        """
        import __main__

        def test_it(control, fake_time, robot):
            fake_time.increment_time_by(0.015)
            fake_time.reset()
            start = fake_time.get()
            control.set_operator_control()
            control.run_test(lambda tm: tm < start + 1)
            assert all(0 < tm_diff <= 0.02 for _, tm_diff in __main__.calls)
            assert __main__.calls[0][1] == 0.02
            assert __main__.calls[0][0] <= start + 0.04
        """,
        robot="import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n",
    )


def test_without_isolation_each_robot_starts_where_the_first_did(make_project) -> None:
    """What dashboards have seen of the robot before outlives it."""
    passes(
        make_project,
        WATCHED,
        """
        import pytest

        ways = []

        @pytest.mark.parametrize("number", [1, 2])
        def test_it(number, control, robot, physics_controller):
            way = []
            control.set_operator_control()
            control.run_test(lambda tm: way.append(physics_controller.get_position()) or tm < 1)
            assert way[0] != way[-1]
            ways.append(way)
            assert ways == [ways[0]] * number
        """,
        "--no-isolation",
    )


# -- what is wrong with it -------------------------------------------------------------------------------------------


def test_a_physics_module_that_cannot_be_is_told_once(make_project) -> None:
    physics = "class PhysicsEngine:\n    def __init__(self, physics_controller):\n        pass\n"
    result = make_project({"robot.py": ROBOT, "tests/test_it.py": RUNS, "physics.py": physics}).run("test")
    assert result.code == 1
    assert result.first_error == "physics.py:1: PhysicsEngine has no method update_sim"
    assert "Traceback" not in result.output


@pytest.mark.parametrize(
    ("update", "where"),
    sampled(
        [("self, hal_data, now, tm_diff", "initialize"), ("self, now, tm_diff", "update_sim")],
        ("self, now, tm_diff", "update_sim"),
    ),
)
def test_an_exception_in_physics_names_its_line_first(update: str, where: str, make_project) -> None:
    lines = dict.fromkeys(("constructor", "initialize", "update_sim"), "pass") | {where: "1 / 0  # here"}
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/test_it.py": RUNS,
            "physics.py": f"""
                class PhysicsEngine:
                    def __init__(self, physics_controller):
                        {lines["constructor"]}

                    def initialize(self, hal_data):
                        {lines["initialize"]}

                    def update_sim({update}):
                        {lines["update_sim"]}
                """,
        }
    )
    result = project.run("test")
    assert result.code == 1
    (block,) = result.blocks().values()
    assert block.startswith(f"{project.place('physics.py', '# here')}: ZeroDivisionError")
    assert "pyfrc_core/" not in block


@pytest.mark.slow
def test_asking_for_physics_that_are_not_there(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": RUNS})
    result = project.run("test")
    assert result.code == 1
    assert "there is no physics.py in this project" in result.output
    assert "pyfrc create-physics writes one" in result.output
    (project.path / "sim").mkdir()
    (project.path / "sim" / "physics.py").write_text("class PhysicsEngine: ...\n")
    assert "Move sim/physics.py beside robot.py." in project.run("test").output.replace("\\", "/")
