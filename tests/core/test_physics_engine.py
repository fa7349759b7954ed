"""A project's physics.py: its generation, when it is made and called, and messages about invalid ones."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent
from typing import Any

import ntcore
import pytest
import wpilib
from loops import for_each

from pyfrc_core.config.sim import SimConfig
from pyfrc_core.errors import PyfrcError, RobotCodeError
from pyfrc_core.physics.core import PhysicsInitException, PhysicsInterface
from pyfrc_core.physics.engine import Physics, PhysicsModule, load_physics
from pyfrc_core.physics.pose import Pose, Walls, walls_of
from pyfrc_core.project import Project
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.wpi import station

Load = Callable[[str], PhysicsModule]


@pytest.fixture
def load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Load]:
    """Loads a text as a project's physics.py."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def load(text: str) -> PhysicsModule:
        sys.modules.pop("physics", None)
        (tmp_path / "robot.py").touch()
        (tmp_path / "physics.py").write_text(dedent(text).lstrip("\n"), "utf-8")
        return load_physics(Project(tmp_path / "robot.py"))

    yield load
    sys.modules.pop("physics", None)


def engine(constructor: str, update: str, calls: str = "pass") -> str:
    return f"""
        made = []


        class PhysicsEngine:
            def __init__({constructor}):
                self.arguments = dict(locals())
                self.calls = []
                made.append(self)

            def update_sim({update}):
                {calls}
        """


@for_each(
    "constructor, update, takes_hal_data, takes_robot",
    [
        ("self, physics_controller", "self, hal_data, now, tm_diff", True, False),
        ("self, physics_controller", "self, now, tm_diff", False, False),
        ("self, physics_controller, robot", "self, now, tm_diff", False, True),
        ("self, physics_controller, robot", "self, hal_data, now, tm_diff", True, True),
        ("self, physics_controller, robot=None", "self, now, tm_diff", False, True),
        ("self, physics_controller, robot=None", "self, hal_data, now, tm_diff", True, True),
        ("self, physics_controller, my_robot=None", "self, now, tm_diff", False, True),
        ("self, physics_controller, quiet=False", "self, hal_data, now, tm_diff", True, False),
        ("self, physics_controller", "self, hal_data, *args", True, False),
        ("self, physics_controller", "self, *args", False, False),
        ("self, *args", "self, hal_data, now, tm_diff=0", True, False),
    ],
)
def test_the_generation_is_that_of_the_signatures(
    load: Load, constructor: str, update: str, takes_hal_data: bool, takes_robot: bool
) -> None:
    module = load(engine(constructor, update))
    assert (module.takes_hal_data, module.takes_robot) == (takes_hal_data, takes_robot)


def test_a_static_update(load: Load) -> None:
    text = engine("self, physics_controller", "hal_data, now, tm_diff").replace(
        "    def update", "    @staticmethod\n            def update"
    )
    assert load(text).takes_hal_data


# -- what is wrong with it ---------------------------------------------------------------------------------------------

UPDATE = "    def update_sim(self, hal_data, now, tm_diff):\n        pass\n"
MADE = "class PhysicsEngine:\n    def __init__(self, physics_controller):\n        pass\n\n"
NOT_CALLED = "cannot be called"
WRONG = {
    "no engine": ("x = 1\n", "physics.py", "there is no class PhysicsEngine in this file"),
    "imported only": (
        "from pyfrc.physics.core import PhysicsEngine\n",
        "physics.py",
        "there is no class PhysicsEngine in this file",
    ),
    "another name": (
        f"x = 1\n\nclass Physics:\n{UPDATE}",
        "physics.py:3",
        "there is no class PhysicsEngine in this file, but a class Physics: rename it",
    ),
    "no update_sim": (MADE, "physics.py:1", "PhysicsEngine has no method update_sim"),
    "no constructor": (f"class PhysicsEngine:\n{UPDATE}", "physics.py:1", "PhysicsEngine has no constructor"),
    "one underscore": (
        f"class PhysicsEngine:\n    def _init_(self, physics_controller):\n        pass\n\n{UPDATE}",
        "physics.py:1",
        "PhysicsEngine has no constructor, but a method _init_: it needs two underscores on both sides",
    ),
    "constructor's arguments": (
        f"class PhysicsEngine:\n    def __init__(self):\n        pass\n\n{UPDATE}",
        "physics.py:2",
        f"PhysicsEngine.__init__(self) {NOT_CALLED}",
    ),
    "the robot first": (
        f"class PhysicsEngine:\n    def __init__(self, robot, physics_controller):\n        pass\n\n{UPDATE}",
        "physics.py:2",
        f"PhysicsEngine.__init__(self, robot, physics_controller) {NOT_CALLED}",
    ),
    "update_sim's arguments": (
        f"{MADE}    def update_sim(self, now):\n        pass\n",
        "physics.py:5",
        f"PhysicsEngine.update_sim(self, now) {NOT_CALLED}",
    ),
    "an argument is missing": (
        f"{MADE}    def update_sim(self, hal_data, tm_diff):\n        pass\n",
        "physics.py:5",
        f"PhysicsEngine.update_sim(self, hal_data, tm_diff) {NOT_CALLED}",
    ),
    "the other order": (
        f"{MADE}    def update_sim(self, tm_diff, now):\n        pass\n",
        "physics.py:5",
        f"PhysicsEngine.update_sim(self, tm_diff, now) {NOT_CALLED}",
    ),
    "self forgotten": (
        f"{MADE}    def update_sim(now, tm_diff):\n        pass\n",
        "physics.py:5",
        f"PhysicsEngine.update_sim(now, tm_diff) {NOT_CALLED}: self is missing",
    ),
    "initialize's arguments": (
        f"{MADE}    def initialize(self):\n        pass\n\n{UPDATE}",
        "physics.py:5",
        f"PhysicsEngine.initialize(self) {NOT_CALLED}",
    ),
}


@for_each("mistake", WRONG)
def test_a_class_that_cannot_be_is_named_with_its_line_and_what_it_must_have(load: Load, mistake: str) -> None:
    text, place, message = WRONG[mistake]
    with pytest.raises(PhysicsInitException) as wrong:
        load(text)
    assert (wrong.value.where, wrong.value.message) == (place, message)
    assert wrong.value.remedy.startswith("It must have a class PhysicsEngine with __init__(self, physics_controller)")


@for_each(
    "text, message",
    [
        ("class PhysicsEngine:\n    def\n", "physics.py:2: SyntaxError"),
        ("import math\nmath.nothing\n", "physics.py:2: AttributeError"),
    ],
)
def test_an_error_at_import_names_its_line(load: Load, text: str, message: str) -> None:
    with pytest.raises((RobotCodeError, PyfrcError)) as wrong:
        load(text)
    assert str(wrong.value).startswith(message)


# -- when what is made and called --------------------------------------------------------------------------------------


def robot_class(
    log: list[Any], period: float = 0.02, wait: Callable[[], object] = lambda: None
) -> type[wpilib.TimedRobot]:
    class Robot(wpilib.TimedRobot):
        def __init__(self) -> None:
            super().__init__(period)
            log.append(("voltage", wpilib.RobotController.getBatteryVoltage()))

        def robotInit(self) -> None:
            wait()
            log.append(("robotInit", round(wpilib.Timer.getFPGATimestamp(), 6)))

    return Robot


INITIALIZED = """
        class PhysicsEngine:
            def __init__(self, physics_controller{0}):
                import wpilib
                self.arguments = dict(locals())
                self.made_at = wpilib.Timer.getFPGATimestamp()
                self.calls = []

            def initialize(self, hal_data):
                hal_data["power"]["vin_voltage"] = 9.5

            def update_sim(self, {1}now, tm_diff):
                self.calls.append(dict(locals()))
        """


MADE = """
        class PhysicsEngine:
            def __init__(self, physics_controller, robot):
                self.arguments = dict(locals())
                self.motor = robot.motor  # made in its constructor
                self.calls = []

            def update_sim(self, now, tm_diff):
                self.calls.append(tm_diff)
        """


def attached(run: RobotRun, module: PhysicsModule, robot: type[wpilib.RobotBase], seconds: float = 0.2) -> Physics:
    physics = module.attach(run)
    run.construct(robot)
    run.start()
    run.run_until(round(seconds * 1e6))
    return physics


def test_documented_physics_are_made_before_the_robot_which_finds_what_they_set(run: RobotRun, load: Load) -> None:
    log: list[Any] = []
    physics = attached(
        run, load(INITIALIZED.format("", "hal_data, ")), robot_class(log, wait=lambda: run.threads.sleep_until(100_000))
    )
    assert (physics.engine.made_at, log) == (0.0, [("voltage", 9.5), ("robotInit", 0.1)])
    assert physics.engine.arguments["physics_controller"] is physics.controller
    assert isinstance(physics.controller, PhysicsInterface)
    assert {round(each["tm_diff"], 6) for each in physics.engine.calls} == {0.02}
    assert round(physics.engine.calls[-1]["now"], 6) == 0.2
    assert all(each["hal_data"] is run.hal_data for each in physics.engine.calls)


@pytest.mark.parametrize("robot", ["", ", robot"])
def test_todays_physics_are_made_when_the_robot_is_there(run: RobotRun, load: Load, robot: str) -> None:
    log: list[Any] = []
    physics = attached(
        run, load(INITIALIZED.format(robot, "")), robot_class(log, wait=lambda: run.threads.sleep_until(100_000))
    )
    assert log == [("voltage", 12.0), ("robotInit", 0.1)]
    assert physics.engine.made_at == pytest.approx(0.1)
    assert physics.engine.arguments.get("robot") is (run.robot if robot else None)
    assert "hal_data" not in physics.engine.calls[0]
    assert {round(each["tm_diff"], 6) for each in physics.engine.calls} == {0.02}
    assert round(physics.engine.calls[-1]["now"], 6) == 0.2


def test_the_engine_gets_a_robot_with_a_loop_of_its_own(run: RobotRun, load: Load) -> None:
    class Robot(wpilib.RobotBase):
        def __init__(self) -> None:
            super().__init__()
            self.motor = wpilib.PWMSparkMax(8)
            self.over = False

        def startCompetition(self) -> None:
            while not self.over:
                run.threads.sleep_until(run.clock.now_us + 50_000)

        def endCompetition(self) -> None:
            self.over = True

    physics = attached(run, load(MADE), Robot, 1.0)
    assert physics.engine.arguments["robot"] is run.robot
    assert [round(tm_diff, 6) for tm_diff in physics.engine.calls] == [0.02] * 50
    run.end()


@pytest.mark.parametrize(("period", "expected"), [(0.005, 0.01), (0.015, 0.015), (0.05, 0.02)])
def test_a_faster_robot_has_faster_physics_within_limits(
    run: RobotRun, load: Load, period: float, expected: float
) -> None:
    physics = attached(run, load(INITIALIZED.format("", "hal_data, ")), robot_class([], period), 0.3)
    assert {round(each["tm_diff"], 6) for each in physics.engine.calls} == {expected}


def test_a_time_that_was_set_back_still_goes_on_by_a_step(run: RobotRun, load: Load) -> None:
    physics = attached(run, load(INITIALIZED.format("", "hal_data, ")), robot_class([]), 0.1)
    physics._last_us = 900_000  # as after a reset of the clock
    run.run_until(140_000)
    assert [round(each["tm_diff"], 6) for each in physics.engine.calls[-2:]] == [0.02, 0.02]


def test_an_update_within_an_update_is_left_out(run: RobotRun, load: Load) -> None:
    physics = attached(run, load(INITIALIZED.format("", "hal_data, ")), robot_class([]), 0.04)
    count = len(physics.engine.calls)

    def update(hal_data: object, now: float, tm_diff: float) -> None:
        physics.engine.calls.append({})
        physics._update()

    physics.engine.update_sim = update
    run.run_until(80_000)
    assert len(physics.engine.calls) == count + 2


def test_outputs_of_a_disabled_robot_are_off_for_physics(run: RobotRun, load: Load) -> None:
    text = engine(
        "self, physics_controller", "self, hal_data, now, tm_diff", 'self.calls.append(hal_data["pwm"][7]["value"])'
    )

    class Robot(wpilib.TimedRobot):
        def robotInit(self) -> None:
            self.motor = wpilib.PWMSparkMax(7)

        def robotPeriodic(self) -> None:
            self.motor.set(0.5)

    physics = attached(run, load(text), Robot, 0.06)
    assert set(physics.engine.calls) == {0}
    station.set_mode(enabled=True)
    run.run_until(120_000)
    assert physics.engine.calls[-1] == pytest.approx(0.5, abs=0.01)


def test_a_disabled_robot_rolls_on_and_dashboards_see_it(run: RobotRun, load: Load) -> None:
    text = engine(
        "self, physics_controller",
        "self, hal_data, now, tm_diff",
        'self.arguments["physics_controller"].drive(1, 0, tm_diff)',
    )
    physics = attached(run, load(text), robot_class([]), 1.0)
    assert physics.field_name == "Field"
    entry = ntcore.NetworkTableInstance.getDefault().getTable("SmartDashboard/Field").getEntry("Robot")
    assert entry.getDoubleArray([])[0] == pytest.approx(physics.controller.get_pose().X(), abs=0.02)
    assert physics.controller.get_position()[0] > 0.5


def test_a_gyro_has_the_mean_rate_of_what_an_update_drives_and_none_when_it_drives_nothing(
    run: RobotRun, load: Load
) -> None:
    turn = 'now < 0.5 and [self.arguments["physics_controller"].drive(0, rate, tm_diff / 2) for rate in (1, 2)]'
    attached(run, load(engine("self, physics_controller", "self, hal_data, now, tm_diff", turn)), robot_class([]), 0.4)
    gyro = run.hal_data["analog_gyro"][0]
    assert gyro["rate"] == pytest.approx(math.degrees(1.5))
    run.run_until(800_000)
    assert gyro["rate"] == 0
    assert gyro["angle"] == pytest.approx(math.degrees(1.5 * 0.48))
    gyro["angle"] = 0.0


@pytest.mark.parametrize("takes", ["hal_data, ", ""])
def test_a_field_of_the_robots_keeps_its_name(run: RobotRun, load: Load, takes: str) -> None:
    class Robot(wpilib.TimedRobot):
        def robotInit(self) -> None:
            self.field = wpilib.Field2d()
            wpilib.SmartDashboard.putData("Field", self.field)

    physics = attached(run, load(INITIALIZED.format("", takes)), Robot, 0.1)
    assert physics.field_name == "Field (physics)"


def test_walls_hold_a_robot_by_its_corners() -> None:
    walls = Walls(across=20.0, down=10.0, length=4.0, width=2.0)
    assert walls.keep_in(Pose(-1.0, 20.0, 0.0)) == pytest.approx((2.0, 9.0, 0.0))
    assert walls.keep_in(Pose(99.0, -1.0, math.pi / 2)) == pytest.approx((19.0, 2.0, math.pi / 2))
    assert walls.keep_in(Pose(5.0, 5.0, 1.0)) == (5.0, 5.0, 1.0)
    assert Walls(3.0, 1.0, 4.0, 2.0).keep_in(Pose(9.0, 9.0, 0.0)) == (1.5, 0.5, 0.0), "a robot larger than its field"
    far = math.hypot(4.0, 2.0) / 2
    inside = [(-far, 5.0), (20.0 + far, 5.0), (5.0, -far), (5.0, 10.0 + far)]
    outside = [(-far - 0.1, 5.0), (20.1 + far, 5.0), (5.0, -far - 0.1), (5.0, 10.1 + far)]
    assert [walls.are_passed(Pose(x, y, 0.0)) for x, y in inside + outside] == [False] * 4 + [True] * 4
    config = SimConfig()
    assert walls_of(config) == (config.field.w, config.field.h, config.robot.l, config.robot.w)
