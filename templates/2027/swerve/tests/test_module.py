"""One module by itself."""

import math

import pytest
from wpilib.simulation import AnalogEncoderSim
from wpimath import Rotation2d, SwerveModuleVelocity

from swervemodule import within_full_power


@pytest.fixture
def module(control, robot):
    with control.run_robot():
        yield robot.drivetrain.front_left


def looks(module, degrees):
    AnalogEncoderSim(module.angle_encoder).set(math.radians(degrees) % math.tau)


def set_to(module, speed, degrees):
    module.set(SwerveModuleVelocity(speed, Rotation2d.from_degrees(degrees)))
    return module.drive_motor.get_throttle(), module.turn_motor.get_throttle()


def test_drives_when_it_looks_the_right_way(module):
    looks(module, 30)
    drive, turn = set_to(module, 2, 30)
    assert drive == pytest.approx(0.5, abs=0.01)
    assert turn == pytest.approx(0, abs=0.01)


def test_drives_backwards_rather_than_turn_around(module):
    looks(module, 0)
    drive, turn = set_to(module, 2, 180)
    assert drive == pytest.approx(-0.5, abs=0.01)
    assert turn == pytest.approx(0, abs=0.01)


def test_turns_the_short_way(module):
    looks(module, 170)
    drive, turn = set_to(module, 2, -170)
    assert 0 < turn < 0.5
    assert drive > 0


def test_waits_while_it_looks_sideways(module):
    looks(module, 0)
    drive, turn = set_to(module, 2, 89)
    assert abs(drive) < 0.02
    assert turn == 1.0


def test_stays_as_it_is_when_there_is_nowhere_to_go(module):
    looks(module, 45)
    assert set_to(module, 0, 0) == (0, 0)


def test_no_motor_is_told_more_than_it_can():
    assert [within_full_power(power) for power in (-3, -0.5, 0, 2)] == [-1, -0.5, 0, 1]
