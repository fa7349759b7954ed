"""A robot in WPILib's own loop and in `pyfrc test`: the same driver-station packets, and what each has noted."""

from __future__ import annotations

import json
import subprocess
import sys

from conftest import MakeProject, RobotProject

PLAN = """
    import hal
    from wpilib.simulation import DriverStationSim as Station

    MODES = {"autonomous": "AUTONOMOUS", "teleop": "TELEOPERATED", "utility": "UTILITY"}
    PLAN = [
        ("teleop", "attached", 2),
        ("teleop", "", 3),
        ("teleop", "enabled", 4),
        ("teleop", "", 2),
        ("autonomous", "enabled", 3),
        ("teleop", "enabled", 3),
        ("teleop", "e-stop", 3),
        ("teleop", "", 2),
        ("utility", "enabled", 3),
        ("utility", "enabled lost", 3),
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
            Station.set_opmode(opmodes.get(int(getattr(hal.RobotMode, MODES[mode])), 0) if mode else 0)
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
    import traceback

    import hal.simulation
    import wpilib
    import wpiutil.sync
    from wpilib.simulation import DriverStationSim as Station

    hal.simulation.pause_timing()
    import plan
    import robot

    robot.LOGS = "logs_of_wpilib"
    robot.passes = lambda: hal.simulation.step_timing_async(1_000)
    made = []


    def write():
        with open("wpilib.json", "w") as file:
            json.dump(robot.calls, file)


    def compete():
        try:
            made.append(robot.MyRobot())
            made[0].start_competition()
        except ValueError as error:
            robot.note("raised", str(error))
            write()
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            os._exit(1)


    LOOP_IN_C = issubclass(robot.MyRobot, (wpilib.TimedRobot, wpilib.OpModeRobotBase))
    real_wait = wpiutil.sync.wait_for_object
    waits = 0


    def wait_for_object(*args):
        global waits
        waits += 1
        return real_wait(*args)


    def alarm_is_set():
        return hal.simulation.get_next_notifier_timeout() < 2**62


    def packet():
        before = waits
        hal.simulation.step_timing(19_000_000)
        if Station.get_ds_attached():  # a packet of WPILib's simulation attaches the station
            hal.simulation.notify_driver_station_new_data()
        hal.simulation.step_timing(1_000_000)
        while waits == before and not LOOP_IN_C:  # a turn is over when the loop waits for the next one
            time.sleep(0.001)


    wpiutil.sync.wait_for_object = wait_for_object
    competing = threading.Thread(target=compete, daemon=True)
    competing.start()
    hal.simulation.wait_for_program_start()
    while not (alarm_is_set() if LOOP_IN_C else waits):  # reported before the loop waits for its first turn
        time.sleep(0.001)
    plan.play(robot.note, packet)
    made[0].end_competition()
    hal.simulation.step_timing(20_000_000)
    competing.join()
    write()
    log = os.path.join(robot.LOGS, "robot.wpilog")
    while os.path.exists(log) and b"complete" not in open(log, "rb").read():  # four times a second
        time.sleep(0.01)
    os._exit(0)
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


def compare(make_project: MakeProject, robot: str, plan: str = PLAN) -> RobotProject:
    """Have WPILib and pyfrc run a robot. What it notes has to be the same. Return its project.

    :param robot: its module, with `MyRobot`, the function `note`, and the list `calls`
    :param plan: a module whose function `play` sends the packets
    """
    files = {"robot.py": robot, "plan.py": plan, "by_wpilib.py": BY_WPILIB, "tests/test_calls.py": TEST}
    project = make_project(files | {"logs_of_wpilib/none": ""})  # WPILib makes no directory for a log
    script = subprocess.run([sys.executable, "by_wpilib.py"], cwd=project.path, capture_output=True, text=True)
    assert script.returncode == 0, script.stdout + script.stderr
    result = project.run("test")
    assert result.code == 0, result.output
    by_wpilib, ours = (json.loads((project.path / f"{who}.json").read_text("utf-8")) for who in ("wpilib", "pyfrc"))
    assert ours == by_wpilib
    return project
