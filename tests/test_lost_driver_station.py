"""A lost driver station: the robot is disabled, joysticks read zero, no packet comes, motor safety stops motors."""

from __future__ import annotations

import random

import pytest
from conftest import MakeProject
from sim_robots import FILES, run, settle

from pyfrc_core.config.settings import MatchSettings
from pyfrc_core.fuzz.inputs.match_plan import plan_match
from pyfrc_core.project import find_project
from pyfrc_core.sim import SimOptions, Simulation

ROBOT = """
    import wpilib
    from wpilib import DriverStation as DS


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(1)
            self.motor = wpilib.PWMSparkMax(0)
            self.motor.setSafetyEnabled(True)
            self.unsafe = wpilib.PWMSparkMax(1)
            self.unsafe.setSafetyEnabled(False)
            self.seen = []

        def robotPeriodic(self):
            self.seen.append((
                DS.isDSAttached(), DS.isEnabled(), DS.isAutonomous(), DS.isFMSAttached(), self.stick.getY(),
                self.stick.getRawButton(2), self.stick.getPOV(), DS.isJoystickConnected(1), DS.getAlliance(),
                DS.getMatchTime(), DS.getGameSpecificMessage(),
            ))

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())
            self.unsafe.set(0.25)
"""

TESTS = """
    import hal
    from wpilib import DriverStation as DS
    from wpilib.simulation import DriverStationSim as Station
    from wpiutil.sync import createEvent, destroyEvent, waitForObject

    RED, BLUE = DS.Alliance.kRed, DS.Alliance.kBlue
    DRIVING = (True, True, False, True, 0.5, True, 90, True, RED, 30.0, "LRL")
    LOST = (False, False, False, False, 0.0, False, -1, False, RED, 30.0, "LRL")
    BACK = (True, True, False, True, 0.75, True, 90, True, BLUE, 20.0, "RRR")


    def drive(control, hal_data):
        hal_data["joysticks"][1]["axes"][1] = 0.5
        hal_data["joysticks"][1]["buttons"][2] = True
        hal_data["joysticks"][1]["povs"][0] = 90
        hal_data["event"]["game_specific_message"] = "LRL"
        hal_data["control"]["fmsAttached"] = True
        Station.setMatchTime(30)
        control.step_timing(seconds=0.5, autonomous=False, enabled=True)


    def test_lost_and_back(control, hal_data, robot):
        pwm, lost, stick = hal_data["pwm"], hal_data["control"], hal_data["joysticks"][1]
        with control.run_robot():
            drive(control, hal_data)
            assert robot.seen[-1] == DRIVING and pwm[0]["value"] == 0.5
            lost["dsAttached"] = False
            seen = len(robot.seen)
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert robot.seen[seen:] == [LOST] * 5
            assert control.get_mode() == "disabled" and not lost["dsAttached"] and lost["enabled"]
            assert pwm[0]["value"] == 0.5
            control.step_timing(seconds=0.02, autonomous=False, enabled=True)
            assert pwm[0]["value"] == 0 and round(pwm[1]["value"], 2) == 0.25
            # What is written meanwhile comes with the packet that comes next.
            assert (stick["axes"][1], stick["buttons"][2], stick["povs"][0]) == (0.5, True, 90)
            stick["axes"][1] = 0.75
            hal_data["alliance_station"] = "blue1"
            hal_data["event"]["game_specific_message"] = "RRR"
            Station.setMatchTime(20)
            seen = len(robot.seen)
            control.step_timing(seconds=1, autonomous=False, enabled=True)
            assert robot.seen[seen:] == [LOST] * 50
            assert hal_data["event"]["game_specific_message"] == "RRR" and hal_data["alliance_station"] == "blue1"
            assert stick["axes"][1] == 0.75 and pwm[0]["value"] == 0
            lost["dsAttached"] = True
            control.step_timing(seconds=0.02, autonomous=False, enabled=True)
            assert robot.seen[-1] == BACK and round(pwm[0]["value"], 2) == 0.75
            assert control.get_mode() == "teleop"


    def test_no_packet_comes_while_it_is_lost(control, hal_data, robot):
        packets, event = [], createEvent(False, False)
        hal.provideNewDataEventHandle(event)

        def on_step(now):
            signaled, timed_out = waitForObject(event, 0)
            packets.append(signaled)  # since the step before
            if len(packets) == 25:
                Station.setDsAttached(False)
            if len(packets) == 50:
                Station.setDsAttached(True)
            return len(packets) < 70

        control.run_test(on_step)
        hal.removeNewDataEventHandle(event)
        destroyEvent(event)
        assert [seen[0] for seen in robot.seen] == [True] * 24 + [False] * 25 + [True] * 20
        # The last one brings the loss: the joysticks are gone.
        assert packets == [False] + [True] * 25 + [False] * 24 + [True] * 20


    def test_disabled_meanwhile_stays_disabled(control, hal_data, robot):
        with control.run_robot():
            drive(control, hal_data)
            hal_data["control"]["dsAttached"] = False
            control.step_timing(seconds=0.5, autonomous=False, enabled=False)
            hal_data["control"]["dsAttached"] = True
            control.step_timing(seconds=0.1, autonomous=False, enabled=False)
            assert robot.seen[-1][:2] == (True, False)


    def test_a_packet_out_of_turn_does_not_attach(control, hal_data, robot):
        with control.run_robot():
            drive(control, hal_data)
            Station.setDsAttached(False)
            Station.notifyNewData()
            assert not DS.isDSAttached() and DS.isDisabled()
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert robot.seen[-1] == LOST
            Station.setDsAttached(True)
            Station.notifyNewData()
            assert DS.isDSAttached() and DS.isEnabled()


    def test_an_emergency_stop_disables_until_it_is_over(control, hal_data, robot):
        with control.run_robot():
            drive(control, hal_data)
            hal_data["control"]["eStop"] = True
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert DS.isEStopped() and DS.isDisabled()
            assert robot.seen[-1][:2] == (True, False)
            hal_data["control"]["eStop"] = False
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert robot.seen[-1] == DRIVING


    def test_a_reset_of_the_simulated_data_loses_nothing(control, hal_data, robot):
        with control.run_robot():
            Station.resetData()
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert robot.seen[-1][:2] == (True, True)
"""


@pytest.mark.season_2026
def test_a_lost_driver_station_in_tests_and_in_their_replay(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_lost.py": TESTS})
    result = project.run("test", "--no-isolation", "--record", "recordings")
    assert result.code == 0, result.output
    for test in ("test_lost_and_back", "test_no_packet_comes_while_it_is_lost"):
        replayed = project.run("replay", f"recordings/tests_test_lost.py.{test}.jsonl")
        assert replayed.code == 0, replayed.output
        assert "The trace equals the recorded one." in replayed.stdout


@pytest.mark.parametrize("seconds", [15, 150])
def test_fuzz_loses_the_driver_station_in_some_matches(seconds: float) -> None:
    lost = 0
    for seed in range(40):
        plan = plan_match(random.Random(seed), seconds, MatchSettings())
        lost += any(event.at_us > 0 and event.writes.get("control.dsAttached") is False for event in plan)
    assert 4 <= lost <= 36


def test_the_simulator_loses_the_driver_station_and_attaches_it(make_project: MakeProject) -> None:
    project = find_project(make_project(FILES).path)
    with Simulation(project, SimOptions(paused=True)) as simulation:
        settle(simulation)
        simulation.enable()
        simulation.set_axis(0, 1, -0.5)
        run(simulation, 0.5)
        assert simulation.snapshot is not None
        assert simulation.snapshot.enabled
        simulation.attach_driver_station(False)
        run(simulation, 0.5)
        assert not simulation.snapshot.station_attached
        assert not simulation.snapshot.enabled
        assert simulation.snapshot.values["user_program_state"] == "disabled"
        assert simulation.snapshot.values["pwm[0].value"] == 0
        simulation.attach_driver_station(True)
        run(simulation, 0.5)
        assert simulation.snapshot.enabled
        assert simulation.snapshot.values["pwm[0].value"] > 0.4
