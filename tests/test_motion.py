"""`LinearMotion`: where it is, what its encoder counts, and what the simulator shows."""

from __future__ import annotations

import math
from typing import Any

import pytest
from conftest import MakeProject
from hypothesis import given
from hypothesis import strategies as st

from pyfrc.physics.motion import LinearMotion


def test_it_moves_at_its_motors_speed_and_counts_ticks() -> None:
    motion = LinearMotion("Elevator", 2, 360, 6)
    assert (motion.position_ft, motion.position_ticks) == (0, 0)
    assert motion.compute(0.5, 1.5) == 540
    assert (motion.position_ft, motion.position_ticks) == (1.5, 540)
    assert motion.compute(-0.25, 1) == 360
    assert motion.compute(0, 10) == 360


def test_it_has_limits_only_with_an_upper_one_as_in_2019() -> None:
    """An encoder on a wheel runs backwards, too; `min_position` is 0 by default, since that was documented."""
    assert LinearMotion("Wheel", 2, 360).compute(-1, 1) == -720
    assert LinearMotion("Wheel", 2, 360, min_position=None).compute(-1, 1) == -720
    assert LinearMotion("Wheel", 2, 360, max_position=None, min_position=-1).compute(-1, 1) == -720
    assert LinearMotion("Wheel", 2, 360, min_position=3).position_ft == 0
    assert LinearMotion("Elevator", 2, 360, max_position=6).compute(-1, 1) == 0
    assert LinearMotion("Elevator", 2, 360, max_position=6, min_position=None).compute(-1, 1) == -720
    assert LinearMotion("Elevator", 2, 360, max_position=0, min_position=-1).compute(1, 1) == 0
    assert LinearMotion("Elevator", 2, 360, max_position=6, min_position=3).position_ft == 3
    assert LinearMotion("Elevator", 2, 360).compute(1, 1000) == 720_000


def test_a_tick_counts_when_it_is_complete() -> None:
    motion = LinearMotion("Elevator", 10, 360)
    assert motion.compute(0.55, 0.03) == 59  # 59.4
    motion.compute(0.55, 0.03)  # 118.8
    assert motion.position_ticks == 118
    assert LinearMotion("Elevator", 10, 360).compute(-0.55, 0.03) == -59


@given(
    moves=st.lists(st.tuples(st.floats(-2, 2), st.floats(0, 1)), max_size=20),
    lower=st.none() | st.floats(-5, 0),
    upper=st.none() | st.floats(0, 5),
)
def test_it_never_leaves_its_limits_nor_exceeds_its_speed(
    moves: list[tuple[float, float]], lower: float | None, upper: float | None
) -> None:
    motion = LinearMotion("Elevator", 3, 100, upper, lower)
    for motor, time in moves:
        before = motion.position_ft
        assert motion.compute(motor, time) == motion.position_ticks
        if upper is not None:
            assert (-math.inf if lower is None else lower) <= motion.position_ft <= upper
        else:
            assert motion.position_ft == pytest.approx(before + 3 * max(-1.0, min(motor, 1.0)) * time)
        assert abs(motion.position_ft - before) <= 3 * time + 1e-9


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: LinearMotion("Elevator", math.nan, 360), "^motor_ft_per_sec = nan"),
        (lambda: LinearMotion("Elevator", 2, math.inf), "^ticks_per_feet = inf"),
        (lambda: LinearMotion("Elevator", 2, 360, "6"), "^max_position = '6'"),  # type: ignore[arg-type]
        (lambda: LinearMotion("Elevator", 2, 360, 6, math.nan), "^min_position = nan"),
        (lambda: LinearMotion("Elevator", 2, 360, -6), "^min_position = 0 is above max_position = -6"),
        (lambda: LinearMotion("Elevator", 2, 360).compute(math.nan, 0.02), "^motor_val is not a number"),
        (lambda: LinearMotion("Elevator", 2, 360).compute(1, -0.02), "^tm_diff = -0.02"),
        (lambda: LinearMotion("Elevator", 2, 360).compute(1, math.nan), "^tm_diff = nan"),
    ],
)
def test_what_cannot_be_is_named(call: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def test_without_a_time_the_first_call_moves_nothing_since_nobody_knows_for_how_long() -> None:
    assert LinearMotion("Elevator", 1e9, 360).compute(1) == 0


def test_the_documented_example_in_robot_time(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib

                class Robot(wpilib.TimedRobot):
                    def robotInit(self):
                        self.motor = wpilib.PWMSparkMax(0)
                        self.encoder = wpilib.Encoder(0, 1)

                    def teleopPeriodic(self):
                        self.motor.set(1)
                """,
            # As documented, apart from what it forgot to import.
            "example.py": """
                import pyfrc.physics.motion
                from pyfrc.physics import motion

                class PhysicsEngine:

                    def __init__(self, physics_controller):
                        self.motion = pyfrc.physics.motion.LinearMotion('Motion', 2, 360, 6)

                    def update_sim(self, hal_data, now, tm_diff):

                        motor_value = hal_data['pwm'][0]['value']
                        hal_data['encoder'][0]['value'] = self.motion.compute(motor_value)
                """,
            "tests/test_example.py": """
                from example import PhysicsEngine

                def test_example(control, fake_time, hal_data):
                    engines = []
                    shown = []

                    def step(now):
                        if not engines:
                            engines.append(PhysicsEngine(None))
                            shown.append(hal_data["custom"]["Motion"])
                        engines[0].update_sim(hal_data, now, None)
                        shown.append(hal_data["custom"]["Motion"])
                        return now < 4

                    control.set_operator_control(enabled=True)
                    control.run_test(step)
                    assert shown[:2] == [0.0, 0.0], shown
                    assert shown[-1] == 6.0, shown
                    assert {type(each) for each in shown} == {float}
                    assert hal_data["encoder"][0]["value"] == 6 * 360
                    # At 2 ft/s, from the first packet on.
                    moving = [feet for feet in shown if 0 < feet < 6]
                    steps = {round(after - before, 2) for before, after in zip(moving, moving[1:])}
                    assert steps == {0.04}, steps
                """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output
