"""What each class of robots calls in a turn of its loop, beside WPILib's own loop, call by call.

The same robot goes through the same driver-station packets twice: in a process with nothing of pyfrc, where WPILib's
loop runs on a thread and HAL time is stepped, and in `pyfrc test`. The two lists of calls are equal.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import MakeProject

CALLS = """
    import hal.simulation
    import wpilib
    import wpilib_drivers

    calls = []
    RAISES = {raises!r}


    def note(*what):
        calls.append(" ".join(what))
        if calls.count(calls[-1]) == 2 and calls[-1] == RAISES:
            raise ValueError(RAISES)


    def noting(owner, *names):
        for name in names:
            setattr(owner, name, lambda self, name=name: note(getattr(self, "name", "robot"), name))


    MODES = ["disabled", "autonomous", "teleop", "utility"]
    TIMED = ["driver_station_connected", "simulation_init", "simulation_periodic", "robot_periodic"]
    TIMED += [f"{{mode}}_{{part}}" for mode in MODES for part in ("init", "periodic", "exit")]
    OPMODE_ROBOT = ["driver_station_connected", "simulation_init", "simulation_periodic", "robot_periodic"]
    OPMODE_ROBOT += ["none_periodic", "disabled_init", "disabled_periodic", "disabled_exit"]
    OPMODE = ["disabled_periodic", "start", "periodic", "end", "close"]
"""

TIMED = """
    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            note("robot made")
            for number, period in enumerate([0.02, 0.01, 0.04, 0.005, 0.02]):
                self.add_periodic(lambda number=number: note("callback", str(number)), period)

    noting(MyRobot, *TIMED)
"""

OPMODES = """
    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            note("robot made")
            self.add_periodic(lambda: note("callback of the robot"), 0.01)

    noting(MyRobot, *OPMODE_ROBOT)


    class Periodic(wpilib.PeriodicOpMode):
        def __init__(self):
            passes()
            super().__init__()
            note(self.name, "made")
            for period in (0.01, 0.02):
                self.add_periodic(lambda period=period: note(self.name, "callback", str(period)), period)

    noting(Periodic, *OPMODE)


    @wpilib.autonomous(name="Forward")
    class Forward(Periodic):
        name = "forward"


    @wpilib.teleop(name="Drive")
    class Drive(Periodic):
        name = "drive"


    @wpilib.utility(name="Check")
    class Check(Periodic):
        name = "check"


    def passes():
        '''On a robot, an opmode's constructor takes time.'''
"""

COMMANDS = """
    import commands2


    class Wheel(commands2.Subsystem):
        def __init__(self):
            super().__init__()
            self.set_default_command(self.run(lambda: note("default command")))

        def periodic(self):
            note("subsystem")


    class MyRobot(commands2.TimedCommandRobot):
        def __init__(self):
            super().__init__()
            self.wheel = Wheel()
            self.add_periodic(lambda: note("callback"), 0.01)

    noting(MyRobot, *TIMED)
"""

PLAN = """
    import hal
    from wpilib.simulation import DriverStationSim as Station

    MODES = {"autonomous": "AUTONOMOUS", "teleop": "TELEOPERATED", "utility": "UTILITY"}
    PLAN = [
        ("", "attached", 2),
        ("teleop", "", 3),
        ("teleop", "enabled", 4),
        ("teleop", "", 2),
        ("autonomous", "enabled", 3),
        ("teleop", "enabled", 3),
        ("teleop", "e-stop", 3),
        ("teleop", "", 2),
        ("utility", "enabled", 3),
        ("utility", "lost", 3),
        ("utility", "", 2),
        ("autonomous", "enabled", 2),
        ("", "enabled", 3),
        ("", "", 2),
    ]


    def play(note, packet):
        for mode, state, packets in PLAN:
            note("--", mode, state)
            opmodes = {int(hal.opmode_get_robot_mode(each.id)): each.id for each in Station.get_opmode_options()}
            if mode:
                Station.set_robot_mode(getattr(hal.RobotMode, MODES[mode]))
            chosen = mode and state != "lost"
            Station.set_opmode(opmodes.get(int(getattr(hal.RobotMode, MODES[mode])), 0) if chosen else 0)
            Station.set_enabled("enabled" in state)
            Station.set_e_stop("e-stop" in state)
            Station.set_ds_attached("lost" not in state)
            for _ in range(packets):
                packet()
"""

BY_WPILIB = """
    import json
    import os
    import sys
    import threading
    import time

    import hal.simulation
    from wpilib.simulation import DriverStationSim as Station

    hal.simulation.pause_timing()
    import plan
    import robot

    robot.passes = lambda: hal.simulation.step_timing_async(1_000)
    made = []


    def write_and_exit():
        with open("wpilib.json", "w") as file:
            json.dump(robot.calls, file)
        os._exit(0)


    def compete():
        try:
            made.append(robot.MyRobot())
            made[0].start_competition()
        except ValueError as error:
            robot.note("raised", str(error))
            write_and_exit()


    threading.Thread(target=compete, daemon=True).start()
    hal.simulation.wait_for_program_start()
    while hal.simulation.get_next_notifier_timeout() > 2**62:  # reported before the loop waits for its first turn
        time.sleep(0.001)


    def packet():
        hal.simulation.step_timing(19_000_000)
        Station.notify_new_data()
        hal.simulation.step_timing(1_000_000)


    plan.play(robot.note, packet)
    write_and_exit()
"""

TEST = """
    import json

    import plan
    import robot as module


    def test_calls(control, fake_time, robot):
        try:
            with control.run_robot():
                plan.play(module.note, lambda: fake_time.increment_time_by(0.02))
        except ValueError as error:
            module.note("raised", str(error))
        with open("pyfrc.json", "w") as file:
            json.dump(module.calls, file)
"""


@pytest.mark.parametrize(
    ("robot", "raises"),
    [
        (TIMED, ""),
        (TIMED, "robot teleop_init"),
        (TIMED, "robot disabled_periodic"),
        (TIMED, "callback 3"),
        (OPMODES, ""),
        (OPMODES, "drive made"),
        (OPMODES, "drive disabled_periodic"),
        (OPMODES, "drive start"),
        (OPMODES, "drive periodic"),
        (OPMODES, "drive callback 0.01"),
        (OPMODES, "drive end"),
        (OPMODES, "robot none_periodic"),
        (COMMANDS, ""),
        (COMMANDS, "default command"),
    ],
)
def test_turns_are_those_of_wpilibs_loop(make_project: MakeProject, robot: str, raises: str) -> None:
    project = make_project(
        {
            "robot.py": CALLS.format(raises=raises) + robot,
            "plan.py": PLAN,
            "by_wpilib.py": BY_WPILIB,
            "tests/test_calls.py": TEST,
        }
    )
    script = subprocess.run([sys.executable, "by_wpilib.py"], cwd=project.path, capture_output=True, text=True)
    assert script.returncode == 0, script.stdout + script.stderr
    result = project.run("test")
    assert result.code == 0, result.output
    assert calls(project.path / "pyfrc.json") == calls(project.path / "wpilib.json")


def calls(file: Path) -> list[str]:
    found: list[str] = json.loads(file.read_text(encoding="utf-8"))
    return found
