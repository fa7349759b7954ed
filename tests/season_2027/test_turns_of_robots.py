"""What each class of robots calls in a turn of its loop, beside WPILib's own loop, call by call.

The same robot goes through the same driver-station packets twice: in a process with nothing of pyfrc, where WPILib's
loop runs on a thread and HAL time is stepped, and in `pyfrc test`. The two lists of calls are equal.
"""

from __future__ import annotations

import pytest
from conftest import MakeProject

from .beside_wpilib import PLAN, compare

CALLS = """
    import hal
    import wpilib

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

BASE = """
    class MyRobot(wpilib.OpModeRobotBase):
        def __init__(self):
            super().__init__(0.01)
            self.add_opmode_factory(hal.RobotMode.TELEOPERATED, "Drive", Drive)
            self.add_opmode_factory(hal.RobotMode.UTILITY, "Check", Check)
            self.publish_opmodes()

    noting(MyRobot, *OPMODE_ROBOT)


    class Drive(wpilib.OpMode):
        name = "drive"

    noting(Drive, *OPMODE)


    class Check(wpilib.PeriodicOpMode):
        def start(self):
            note("check start")
            self.add_periodic(lambda: note("callback that was added late"), 0.02)

        def periodic(self):
            note("check periodic")
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

OWN_LOOP = """
    import wpiutil.sync


    def state():
        words = [name[3:] for name in STATES if getattr(wpilib.RobotState, name)()]
        return " ".join([*words, wpilib.RobotState.get_opmode() or "no opmode"])


    STATES = ["is_enabled", "is_e_stopped", "is_ds_attached", "is_autonomous", "is_teleop", "is_utility"]


    class MyRobot(wpilib.RobotBase):
        def __init__(self):
            super().__init__()
            self.alarm, _ = hal.create_notifier()
            note("robot made")

        def start_competition(self):
            hal.set_notifier_alarm(self.alarm, 20_000_000, 20_000_000, False, True)
            wpilib.DriverStationBackend.observe_user_program_starting()
            while wpiutil.sync.wait_for_object(self.alarm):
                note("turn", state())
                wpilib.DriverStationBackend.refresh_data()
                note("refreshed", state())
                hal.acknowledge_notifier_alarm(self.alarm)
            note("over")

        def end_competition(self):
            note("end_competition")
            hal.destroy_notifier(self.alarm)
"""

#: As `OWN_LOOP`, with a turn for each packet of the driver station.
BY_PACKETS = OWN_LOOP.replace("self.alarm, _ = hal.create_notifier()", "self.alarm = wpiutil.sync.make_event()")
BY_PACKETS = BY_PACKETS.replace(
    "hal.set_notifier_alarm(self.alarm, 20_000_000, 20_000_000, False, True)",
    "hal.provide_new_data_event_handle(self.alarm)",
)
BY_PACKETS = BY_PACKETS.replace("hal.acknowledge_notifier_alarm(self.alarm)", "pass")
BY_PACKETS = BY_PACKETS.replace("hal.destroy_notifier(self.alarm)", "wpiutil.sync.destroy_event(self.alarm)")

AROUND = (
    TIMED
    + """
    def start_competition(robot):
        note("before")
        wpilib.TimedRobot.start_competition(robot)
        note("over")

    MyRobot.start_competition = start_competition
"""
)

MAGIC = """
    import magicbot


    class Arm:
        def setup(self):
            note("arm setup")

        def on_enable(self):
            note("arm on_enable")

        def on_disable(self):
            note("arm on_disable")

        def execute(self):
            note("arm execute")


    class MyRobot(magicbot.MagicRobot):
        arm: Arm

        def create_objects(self):
            note("create_objects")

        def end_competition(self):
            note("end_competition")
            super().end_competition()

    noting(MyRobot, *[name for name in TIMED if hasattr(magicbot.MagicRobot, name)])
"""

TIMESLICE = """
    class MyRobot(wpilib.TimesliceRobot):
        def __init__(self):
            super().__init__(0.002, 0.02)
            for number in range(2):
                self.schedule(lambda number=number: note("slice", str(number)), 0.003)

    noting(MyRobot, *TIMED)
"""


@pytest.mark.parametrize(
    ("robot", "raises"),
    [
        (TIMED, ""),
        (TIMED, "robot teleop_init"),
        pytest.param(TIMED, "robot disabled_periodic", marks=pytest.mark.slow),
        pytest.param(TIMED, "callback 3", marks=pytest.mark.slow),
        (OPMODES, ""),
        pytest.param(OPMODES, "drive made", marks=pytest.mark.slow),
        pytest.param(OPMODES, "drive disabled_periodic", marks=pytest.mark.slow),
        (OPMODES, "drive start"),
        (OPMODES, "drive periodic"),
        pytest.param(OPMODES, "drive callback 0.01", marks=pytest.mark.slow),
        pytest.param(OPMODES, "drive end", marks=pytest.mark.slow),
        pytest.param(OPMODES, "robot none_periodic", marks=pytest.mark.slow),
        (BASE, ""),
        (COMMANDS, ""),
        (COMMANDS, "default command"),
        (TIMESLICE, ""),
        (AROUND, ""),
        (OWN_LOOP, ""),
        (BY_PACKETS, ""),
        (OWN_LOOP, "refreshed enabled ds_attached autonomous no opmode"),
        (MAGIC, ""),
        (MAGIC, "robot teleop_init"),
        (MAGIC, "arm execute"),
    ],
)
def test_turns_are_those_of_wpilibs_loop(make_project: MakeProject, robot: str, raises: str) -> None:
    # A robot that waits for packets gets one at the loss from pyfrc; WPILib's simulation sends nothing.
    plan = PLAN.replace('("utility", "enabled lost", 3),', "") if robot == BY_PACKETS else PLAN
    compare(make_project, CALLS.format(raises=raises) + robot, plan)
