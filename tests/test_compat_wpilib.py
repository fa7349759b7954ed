"""What pyfrc uses of WPILib without its promise: what has changed when one of these fails, the message says."""

from __future__ import annotations

import inspect
import math
import sys
from subprocess import run

import magicbot
import pytest

from pyfrc_core.compat import wpilib_private
from pyfrc_core.compat.private_name import IncompatibleLibraryError, PrivateName


@pytest.mark.parametrize("name", wpilib_private.NAMES, ids=lambda name: name.path)
def test_it_is_there(name: PrivateName) -> None:
    try:
        name.find()
    except IncompatibleLibraryError:
        pytest.fail(name.gone)


def said_by(program: str) -> list[str]:
    """Run a program that uses the HAL in an interpreter of its own, and return the lines that it prints."""
    start = "import time, hal, wpilib, hal.simulation\nhal.initialize(500, 0)\n"
    done = run([sys.executable, "-c", start + program], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return [line for line in done.stdout.splitlines() if "CameraServer" not in line]


def test_the_loop_function_calls_the_robots_functions() -> None:
    program = """
from pyfrc_core.compat import wpilib_private

class Robot(wpilib.TimedRobot):
    def disabledPeriodic(self): print("disabledPeriodic")
    def robotPeriodic(self): print("robotPeriodic")
    def _simulationInit(self): print("_simulationInit")
    def _simulationPeriodic(self): print("_simulationPeriodic")

robot = Robot()
wpilib_private.SIMULATION_INIT.of(robot)()
wpilib_private.LOOP_FUNCTION.of(robot)()
wpilib_private.SIMULATION_PERIODIC.of(robot)()
print(wpilib_private.simulation_periodic_of(robot) is Robot._simulationPeriodic)
print(wpilib_private.simulation_periodic_of(wpilib.TimedRobot()))
"""
    assert said_by(program) == [
        "_simulationInit",
        "disabledPeriodic",
        "robotPeriodic",
        "_simulationPeriodic",
        "_simulationPeriodic",
        "True",
        "None",
    ], "WPILib's loop calls the robot's functions otherwise: " + wpilib_private.LOOP_FUNCTION.used_for


def test_network_tables_call_the_function_that_starts_their_log() -> None:
    program = """
import ntcore
from pyfrc_core.compat import wpilib_private
owner, name = wpilib_private.NETWORK_LOG.place
setattr(owner, name, lambda instance: print("log of", type(instance).__name__))
ntcore.NetworkTableInstance.getDefault().startLocal()
"""
    assert said_by(program) == ["log of NetworkTableInstance"], wpilib_private.NETWORK_LOG.used_for


def test_a_call_from_a_function_of_the_same_name_reaches_wpilibs_own() -> None:
    program = """
from pyfrc_core.compat import wpilib_private

class Robot(wpilib.TimedRobot):
    def endCompetition(self): print("the robot's own")

wpilib_private.end_competition(Robot())
print("done")
"""
    assert said_by(program) == ["done"], (
        "the bindings no longer take a call from a function of the same name for one of super(): "
        "runtime.construction and fuzz.motor_calls reach WPILib's own methods by that"
    )


def test_subsystems() -> None:
    program = """
import commands2
from pyfrc_core.compat import wpilib_private

class Arm(commands2.Subsystem): pass

arm = Arm()
print([each is arm for each in wpilib_private.registered_subsystems()])
"""
    assert said_by(program) == ["[True]"], wpilib_private.SUBSYSTEMS.gone


def test_a_magic_robot_calls_it_when_robotinit_is_over() -> None:
    name = wpilib_private.MAGIC_SIMULATION_INIT
    calls = inspect.getsource(magicbot.magicrobot).count(f"self.{name.name}()")
    assert calls == 1, f"magicbot no longer calls {name.name} in one place: {name.used_for}"


def test_the_stack_of_a_report() -> None:
    program = """
import os, sys
from pyfrc_core.compat import wpilib_private

os.dup2(1, 2)
wpilib_private.show_stack(lambda: "the robot's lines")
def report():
    for _ in range(2):
        wpilib.DriverStation.getStickAxis(0, 20 + len(reports))
        reports.append(1)

reports = []
report()
wpilib_private.show_whole_stack()
time.sleep(1.1)  # WPILib reports the same kind of thing once a second
report()
"""
    said = "\n".join(said_by(program))
    robots, _, all_lines = said.partition("axis 22 out of range")
    used_for = wpilib_private.SET_STACK_TRACE_HOOK.used_for
    assert robots.count("the robot's lines") == 2, f"a report's stack does not come from the hook: {used_for}"
    assert "in report" in all_lines, wpilib_private.STACK_TRACE_HOOK.used_for
    assert "the robot's lines" not in all_lines


def test_the_channels_of_an_encoder() -> None:
    program = """
from pyfrc_core.compat import wpilib_private

encoder = wpilib.Encoder(4, 7)
print(wpilib_private.encoder_channels(0))
"""
    assert said_by(program) == ["(4, 7)"], wpilib_private.NATIVE_HAL.gone


# -- WPILib's threads -------------------------------------------------------------------------------------------------

FIND_EVENT = """
from pyfrc_core.compat.wpilib_threads import motor_safety_event
from wpiutil.sync import createEvent, setEvent, resetEvent, waitForObject

{before}
event = motor_safety_event()
print(event == motor_safety_event())
resetEvent(event)
hal.removeNewDataEventHandle(event)
{after}
"""


@pytest.mark.parametrize(
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
        "WPILib's motor-safety thread no longer waits for an event: runtime.motor_safety takes its place, or motors "
        "are stopped at random"
    )


def test_packets_set_the_event_of_the_motor_safety_thread_until_it_is_removed() -> None:
    program = """
from pyfrc_core.compat.wpilib_threads import motor_safety_event

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
    assert said[0] == "removed", "packets still wake WPILib's motor-safety thread: runtime.motor_safety stops that"
    assert "stopped" in said, "packets do not wake WPILib's motor-safety thread: is there nothing left to replace?"


@pytest.mark.parametrize("before", ["", "other, _ = hal.initializeNotifier()", "dog = wpilib.Watchdog(1, print)"])
def test_the_thread_of_watchdogs_ends(before: str) -> None:
    program = f"""
from pyfrc_core.compat import wpilib_threads
{before}
notifiers = hal.simulation.getNumNotifiers()
print(wpilib_threads.end_watchdog_thread(), hal.simulation.getNumNotifiers() - notifiers)
late = wpilib.Watchdog(0.01, lambda: print("expired"))
late.reset()
time.sleep(0.1)
"""
    less = -1 if "Watchdog" in before else 0
    assert said_by(program) == [f"True {less}"], (
        "WPILib's watchdogs no longer share a thread that waits for a notifier named Watchdog: "
        "runtime.loop_watchdog takes its place, and turns of a loop are slower with it"
    )


def test_a_thread_of_watchdogs_that_is_not_found_is_left_alone() -> None:
    program = """
from pyfrc_core.compat import wpilib_threads
other, _ = hal.initializeNotifier()
dog = wpilib.Watchdog(1, print)  # its notifier is neither the first nor new
print(wpilib_threads.end_watchdog_thread(), hal.simulation.getNumNotifiers())
"""
    assert said_by(program) == ["False 2"]


def test_the_hal_reports_devices_values_and_writes() -> None:
    program = """
import gc
from hal.simulation import getSimDeviceHandle, getSimValueHandle
from pyfrc_core.compat.hal_callbacks import HalNotes, Report, WriteFlags

notes = HalNotes()
notes.note_devices(7)
device = hal.SimDevice("Arm")
print(bool(notes), list(notes.take()), bool(notes))
notes.note_new_values(getSimDeviceHandle("Arm"), 8)
value = device.createDouble("Angle", 0, 1.0)
print(list(notes.take()))
other = device.createDouble("Infinity", 0, 1.0)  # the C library would read a number
list(notes.take())
values = [getSimValueHandle(getSimDeviceHandle("Arm"), name) for name in ("Angle", "Infinity")]
flags = WriteFlags([[Report("SimValueChanged", (value,))] for value in values])
print(flags.take())
value.set(1.0)
value.set(2.0)
print(flags.take(), flags.take())
value.reset()
other.set(1.0)
print(flags.take())
flags.keep([1])
value.set(4.0)
other.set(2.0)
other.set(3.0)
print(flags.take(), flags.take())
flags.keep([])  # it has been written before this
value.set(5.0)
print(flags.take())
other.set(4.0)
print(flags.take())
flags.close()
value.set(3.0)
print(flags.take())
del device, value
gc.collect()
print(list(notes.take()))
"""
    expected = ["True [7] False", "[8]", "[]", "[0] []", "[0, 1]", "[0] []", "[0]", "[1]", "[]", "[7]"]
    assert said_by(program) == expected, wpilib_private.NATIVE_HAL.gone


_ARM = """
from math import nan
from hal import simulation as hs
from pyfrc_core.compat.hal_memory import ManyNumbers, value_memory

device = hal.SimDevice("Arm")
made = [
    device.createDouble("d", 0, 1.5), device.createInt("i", 0, -2), device.createLong("l", 0, 1 << 40),
    device.createEnum("e", 0, ["a", "b", "c"], 2), device.createBoolean("b", 0, True),
]
handle = hs.getSimDeviceHandle("Arm")
memory = value_memory(handle)
"""


def test_the_memory_of_a_value_stays_where_it_is() -> None:
    program = (
        _ARM
        + """
names = {hs.getSimValueHandle(handle, name): name for name in "dileb"}
print({names[value]: place.read() for value, place in memory.items()})
more = [device.createDouble(f"more {number}", 0, 0.0) for number in range(500)]
others = [hal.SimDevice(f"Other {number}") for number in range(200)]
made[0].set(-0.0), made[1].set(7), made[2].set(-1 << 40), made[3].set(1), made[4].set(False)
print({names[value]: place.read() for value, place in memory.items()})
made[0].reset()
print({names[value]: place.read() for value, place in memory.items()}["d"])
"""
    )
    expected = [
        str({"d": 1.5, "i": -2, "l": 1 << 40, "e": 2}),
        str({"d": -0.0, "i": 7, "l": -1 << 40, "e": 1}),
        "0.0",
    ]
    assert said_by(program) == expected, wpilib_private.NATIVE_HAL.gone


def test_numbers_in_memory_that_have_changed_are_found() -> None:
    program = (
        _ARM
        + """
more = [device.createDouble(f"more {number}", 0, 0.0) for number in range(40)]
other = hal.SimDevice("Other")
far = other.createDouble("far", 0, nan)
memory |= value_memory(handle) | value_memory(hs.getSimDeviceHandle("Other"))
positions = {}
for position, (value, place) in enumerate(memory.items()):
    positions.setdefault(place.format, []).append(position)
places = list(memory.values())
found = [place.read() for place in places]
values = found.copy()
groups = [ManyNumbers([places[at] for at in some], some, [found[at] for at in some]) for some in positions.values()]

def update():
    changed = sorted(at for numbers in groups for at in numbers.update(found, values))
    assert repr(found) == repr(values) == repr([place.read() for place in places])
    return [(at, found[at]) for at in changed]

print(sorted(positions), update())
made[0].set(-0.5), made[1].set(7), made[2].set(-1 << 40), made[3].set(0), more[7].set(-0.0), far.set(nan)
print(update(), update())
made[0].set(0.5), made[0].set(-0.5), more[7].set(0.0), more[39].set(nan), far.set(1e300)
print(update())
"""
    )
    expected = [
        "['d', 'i', 'q'] []",
        str([(0, -0.5), (1, 7), (2, -1 << 40), (3, 0), (11, -0.0)]) + " []",
        str([(11, 0.0), (43, math.nan), (44, 1e300)]),
    ]
    assert said_by(program) == expected, wpilib_private.NATIVE_HAL.gone


def test_threads_that_write_while_others_read_do_not_block_each_other() -> None:
    """The HAL reports with its lock held, so nothing that waits for this lock may keep Python's."""
    program = """
import threading
from hal import simulation as hs
from wpilib.simulation import SimDeviceSim
from pyfrc_core.compat.hal_callbacks import HalNotes, Report, WriteFlags

device = hal.SimDevice("Arm")
value = device.createDouble("Angle", 0, 1.0)
handle = hs.getSimDeviceHandle("Arm")
notes = HalNotes()
notes.note_devices(7)
notes.note_new_values(handle, 8)
flags = WriteFlags([[Report("SimValueChanged", (hs.getSimValueHandle(handle, "Angle"),))]])
stop = threading.Event()

def write():
    while not stop.is_set():
        value.set(1.0)

thread = threading.Thread(target=write)
thread.start()
for _ in range(5000):
    SimDeviceSim.enumerateDevices("")
    SimDeviceSim("Arm").enumerateValues()
    hs.isSimDeviceEnabled("x")
    hs.getSimValueHandle(handle, "Angle")
    SimDeviceSim("Arm").getDouble("Angle").get()
    hs.getSimDeviceName(handle)
    value.set(2.0)
    flags.take()
    list(notes.take())
stop.set()
thread.join()
print("done")
"""
    assert said_by(program) == ["done"]
