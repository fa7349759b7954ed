"""What pyfrc uses of WPILib without its promise: what has changed when one of these fails, the message says."""

from __future__ import annotations

import inspect
import sys
from pathlib import Path
from subprocess import DEVNULL, PIPE

import magicbot
import pytest
from loops import for_each

from pyfrc_core import wpi
from pyfrc_core.compat.private_name import IncompatibleLibraryError, PrivateName
from pyfrc_core.processes import spawn
from pyfrc_core.season import CURRENT
from pyfrc_core.wpi import commands, network, reports, robots


def private_names() -> list[PrivateName]:
    """Return all private names of WPILib that its room uses, of the season that is installed."""
    season = Path(wpi.__file__).parent / f"season_{CURRENT.year}"
    topics = [getattr(wpi, file.stem) for file in sorted(season.glob("[!_]*.py"))]
    return [value for topic in topics for value in vars(topic).values() if isinstance(value, PrivateName)]


#: These two are attributes of an instance.
NAMES = [name for name in private_names() if name not in (commands.SUBSYSTEMS, commands.SCHEDULED_COMMANDS)]


@for_each("name", NAMES)
def test_it_is_there(name: PrivateName) -> None:
    try:
        name.find()
    except IncompatibleLibraryError:
        pytest.fail(name.gone)


def said_by(program: str) -> list[str]:
    """Run a program that uses the HAL in a process of its own, and return the lines that it prints."""
    start = "import time, hal, wpilib, hal.simulation\nhal.initialize(500, 0)\n"
    process = spawn.popen([sys.executable, "-c", start + program], stdin=DEVNULL, stdout=PIPE)
    assert process.stdout is not None
    with process.stdout as stdout:
        said = stdout.read().decode()
    assert process.wait() == 0, said
    return [line for line in said.splitlines() if "CameraServer" not in line]


def test_the_loop_function_calls_the_robots_functions() -> None:
    program = """
from pyfrc_core.wpi import robots

class Robot(wpilib.TimedRobot):
    def disabledPeriodic(self): print("disabledPeriodic")
    def robotPeriodic(self): print("robotPeriodic")
    def _simulationInit(self): print("_simulationInit")
    def _simulationPeriodic(self): print("_simulationPeriodic")

robot = Robot()
robots.initialize(robot)
robots.turn_of(robot)()
print(robots.own_simulation(robot))
print(robots.own_simulation(wpilib.TimedRobot()))
"""
    assert said_by(program) == [
        "_simulationInit",
        "disabledPeriodic",
        "robotPeriodic",
        "_simulationPeriodic",
        "_simulationPeriodic",
        "None",
    ], "WPILib's loop calls the robot's functions otherwise: " + robots.LOOP_FUNCTION.used_for


def test_network_tables_call_the_function_that_starts_their_log() -> None:
    program = """
import ntcore
from pyfrc_core.wpi import network
owner, name = network.NETWORK_LOG.place
setattr(owner, name, lambda instance: print("log of", type(instance).__name__))
ntcore.NetworkTableInstance.getDefault().startLocal()
"""
    assert said_by(program) == ["log of NetworkTableInstance"], network.NETWORK_LOG.used_for


def test_a_call_from_a_function_of_the_same_name_reaches_wpilibs_own() -> None:
    program = """
from pyfrc_core.wpi import robots

class Robot(wpilib.TimedRobot):
    def endCompetition(self): print("the robot's own")

robots.cancel_first_alarm(Robot())
print("done")
"""
    assert said_by(program) == ["done"], (
        "the bindings no longer take a call from a function of the same name for one of super(): "
        "runtime.patches.construction and fuzz.motor_calls reach WPILib's own methods by that"
    )


def test_subsystems() -> None:
    program = """
import commands2
from pyfrc_core.wpi import commands

class Arm(commands2.Subsystem):
    def simulationPeriodic(self): pass

arm, other = Arm(), commands2.Subsystem()
print([(each is arm, name) for each, name in commands.simulated_subsystems()])
"""
    assert said_by(program) == ["[(True, 'simulationPeriodic')]"], commands.SUBSYSTEMS.gone


def test_a_magic_robot_calls_it_when_robotinit_is_over() -> None:
    name = robots.MAGIC_SIMULATION_INIT
    calls = inspect.getsource(magicbot.magicrobot).count(f"self.{name.name}()")
    assert calls == 1, f"magicbot no longer calls {name.name} in one place: {name.used_for}"


def test_the_stack_of_a_report() -> None:
    program = """
import os, sys
from pyfrc_core.wpi import reports

os.dup2(1, 2)
reports.show_stack(lambda: "the robot's lines")
def report():
    for _ in range(2):
        wpilib.DriverStation.getStickAxis(0, 20 + len(said))
        said.append(1)

said = []
report()
reports.show_whole_stack()
time.sleep(1.1)  # WPILib reports the same kind of thing once a second
report()
"""
    said = "\n".join(said_by(program))
    robots, _, all_lines = said.partition("axis 22 out of range")
    used_for = reports.SET_STACK_TRACE_HOOK.used_for
    assert robots.count("the robot's lines") == 2, f"a report's stack does not come from the hook: {used_for}"
    assert "in report" in all_lines, reports.STACK_TRACE_HOOK.used_for
    assert "the robot's lines" not in all_lines


# -- WPILib's threads -------------------------------------------------------------------------------------------------

FIND_EVENT = """
from pyfrc_core.wpi.season_2026.watchdogs import motor_safety_event
from wpiutil.sync import createEvent, setEvent, resetEvent, waitForObject

{before}
event = motor_safety_event()
print(event == motor_safety_event())
resetEvent(event)
hal.removeNewDataEventHandle(event)
{after}
"""


@for_each(
    "before",
    [
        "",
        "motor = wpilib.PWMSparkMax(1); time.sleep(0.05)",  # the thread is there, and its event the first
        "mine = [createEvent(manual, is_set) for manual in (False, True) for is_set in (False, True)]",
        "mine = [createEvent(False, False) for _ in range(100)]; motor = wpilib.PWMSparkMax(1)",
    ],
)
def test_the_event_of_the_motor_safety_thread(before: str) -> None:
    """The thread takes what its event is set to; other events stay as they were."""
    after = """
for _ in range(100):
    setEvent(event)
    time.sleep(0.01)
    if not waitForObject(event, 0)[0]:
        print("taken")
        break
made = globals().get("mine", [])
print(event in made, [waitForObject(each, 0)[0] for each in made if len(made) == 4])
"""
    states = "[False, True, False, True]" if "manual" in before else "[]"
    assert said_by(FIND_EVENT.format(before=before, after=after)) == ["True", "taken", f"False {states}"], (
        "WPILib's motor-safety thread no longer waits for an event: runtime.time.motor_safety takes its place, "
        "or motors are stopped at random"
    )


def test_packets_set_the_event_of_the_motor_safety_thread_until_it_is_removed() -> None:
    program = """
from pyfrc_core.wpi.season_2026.watchdogs import motor_safety_event

class Motor(wpilib.MotorSafety):
    def stopMotor(self): print("stopped")
    def getDescription(self): return "motor"

motor = Motor()
motor.setExpiration(0.001)
motor.setSafetyEnabled(True)
motor.feed()
event = motor_safety_event()
hal.simulation.setDriverStationDsAttached(True)
hal.simulation.setDriverStationEnabled(True)
time.sleep(0.01)

def packets():
    for _ in range(20):
        hal.simulation.notifyDriverStationNewData()
        hal.refreshDSData()
        time.sleep(0.02)

hal.removeNewDataEventHandle(event)
packets()
print("removed")
hal.provideNewDataEventHandle(event)
packets()
"""
    said = said_by(program)
    assert said[0] == "removed", "packets still wake WPILib's motor-safety thread: runtime.time.motor_safety stops that"
    assert "stopped" in said, "packets do not wake WPILib's motor-safety thread: is there nothing left to replace?"


@for_each("before", ["", "other, _ = hal.initializeNotifier()", "dog = wpilib.Watchdog(1, print)"])
def test_the_thread_of_watchdogs_ends(before: str) -> None:
    program = f"""
from pyfrc_core.wpi import watchdogs
{before}
notifiers = hal.simulation.getNumNotifiers()
print(watchdogs.end_watchdog_thread(), hal.simulation.getNumNotifiers() - notifiers)
late = wpilib.Watchdog(0.01, lambda: print("expired"))
late.reset()
time.sleep(0.1)
"""
    less = -1 if "Watchdog" in before else 0
    assert said_by(program) == [f"True {less}"], (
        "WPILib's watchdogs no longer share a thread that waits for a notifier named Watchdog: "
        "runtime.time.loop_watchdog takes its place, and turns of a loop are slower with it"
    )


def test_a_thread_of_watchdogs_that_is_not_found_is_left_alone() -> None:
    program = """
from pyfrc_core.wpi import watchdogs
other, _ = hal.initializeNotifier()
dog = wpilib.Watchdog(1, print)  # its notifier is neither the first nor new
print(watchdogs.end_watchdog_thread(), hal.simulation.getNumNotifiers())
"""
    assert said_by(program) == ["False 2"]
