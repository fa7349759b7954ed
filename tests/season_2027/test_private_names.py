"""The names that WPILib 2027 does not promise to keep are there, with the forms that pyfrc depends on."""

from __future__ import annotations

import commands2
import hal
import hal.simulation
import magicbot
import wpilib
import wpilib.simulation
import wpilib_drivers

from pyfrc_core.wpi.season_2027 import commands, network, reports, robots, watchdogs


def test_names() -> None:
    for name in (
        robots.LOOP_FUNCTION,
        robots.OPMODE_LOOP_FUNCTION,
        network.NETWORK_LOG,
        reports.STACK_TRACE_HOOK,
        reports.SET_STACK_TRACE_HOOK,
        commands.STATE_OF_MACHINE,
    ):
        name.find()
    scheduler = commands2.CommandScheduler.get_instance()
    assert not list(commands.SUBSYSTEMS.of(scheduler))
    assert not list(commands.SCHEDULED_COMMANDS.of(scheduler))


def test_a_magic_robot_calls_its_simulation_init_when_it_is_made() -> None:
    assert "simulation_init" in vars(magicbot.MagicRobot)


def test_threads_of_wpilib_are_found_and_ended() -> None:
    assert watchdogs.end_watchdog_thread()
    assert watchdogs.motor_safety_event()


def test_the_power_of_a_pwm_motor_is_a_value_of_a_sim_device() -> None:
    motor = wpilib_drivers.PWMSparkMax(7)
    motor.set_throttle(0.25)
    device = wpilib.simulation.SimDeviceSim("PWMMotorController[7]")
    assert [name for name, _ in device.enumerate_values()] == ["Throttle"]
    assert device.get_double("Throttle").get() == 0.25


def test_hal_time_counts_nanoseconds_and_can_be_moved_on() -> None:
    hal.simulation.pause_timing()
    try:
        before = hal.get_monotonic_time()
        hal.simulation.step_timing_async(1_000_000)
        assert hal.get_monotonic_time() == before + 1_000_000
    finally:
        hal.simulation.resume_timing()
