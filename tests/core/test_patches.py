"""The names that robot code finds replaced: what they do with a run, and that without one they are WPILib's own."""

from __future__ import annotations

import copy
import inspect
import pickle
import threading
import time
import types
from collections.abc import Callable, Generator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import hal
import hal.simulation
import ntcore
import pytest
import wpilib
import wpilib.simulation

from pyfrc_core.hal import modes
from pyfrc_core.processes.fork import FORK_IS_SAFE, Fork
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime import cooperative, fork_obstacles, robot_stack, simulation_periodic
from pyfrc_core.runtime.clock import PACKET_US, PHYSICS
from pyfrc_core.runtime.exceptions import TestEnded
from pyfrc_core.runtime.fork_obstacles import reasons_not_to_fork
from pyfrc_core.runtime.patch_table import Patch, PatchTable
from pyfrc_core.runtime.patches import Patches, _Instant, patches
from pyfrc_core.runtime.robot import RobotRun, active_run
from pyfrc_core.runtime.scripts.files import recorded
from pyfrc_core.runtime.scripts.script import load_script, trace_beside


@pytest.fixture
def files(tmp_path: Path) -> RobotFiles:
    return RobotFiles(tmp_path)


@pytest.fixture
def patched(files: RobotFiles) -> Generator[Patches]:
    """The names are replaced for the project."""
    patches.install(files)
    try:
        yield patches
    finally:
        patches.uninstall()


@pytest.fixture
def real(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """What WPILib's own functions are called with, from tables of replacements that are made after this."""
    called: list[tuple[Any, ...]] = []

    def note(name: str, result: Any = None) -> Callable[..., Any]:
        def call(*args: Any) -> Any:
            called.append((name, *args))
            return result

        return call

    for owner, names in (
        (wpilib.simulation, "stepTiming stepTimingAsync pauseTiming resumeTiming restartTiming waitForProgramStart"),
        (hal.simulation, "stepTiming stepTimingAsync pauseTiming resumeTiming restartTiming waitForProgramStart"),
        (hal, "initializeNotifier updateNotifierAlarm cancelNotifierAlarm waitForNotifierAlarm stopNotifier"),
        (hal, "cleanNotifier setNotifierName"),
        (wpilib.TimedRobot, "addPeriodic startCompetition getLoopStartTime"),
    ):
        for name in names.split():
            monkeypatch.setattr(owner, name, note(name, f"real {name}"))
    return called


def table() -> dict[tuple[str, str], Any]:
    """The replacements, by the names of owner and function."""
    made = Patches()
    return {(owner.__name__, name): replacement for owner, name, replacement in made._patches()}


def test_names_are_replaced_once_and_restored(files: RobotFiles, tmp_path: Path) -> None:
    before = time.sleep, wpilib.wait, wpilib.Notifier, vars(wpilib.TimedRobot).get("startCompetition")
    ours = Patches()
    assert not ours.installed
    ours.install(files)
    try:
        assert ours.installed
        replaced = time.sleep, wpilib.wait
        assert (time.sleep, wpilib.wait, wpilib.Notifier) != before[:3]
        other = RobotFiles(tmp_path / "other")
        ours.install(other)
        assert (time.sleep, wpilib.wait) == replaced
        assert cooperative.scope.is_robot_code(str(tmp_path / "other/robot.py"))
        assert wpilib.getOperatingDirectory() == f"{tmp_path}/other"
        assert wpilib.getDeployDirectory() == f"{tmp_path}/other/deploy"
    finally:
        ours.uninstall()
    assert not ours.installed
    assert (time.sleep, wpilib.wait, wpilib.Notifier) == before[:3]
    assert not cooperative.scope.is_robot_code(str(tmp_path / "other/robot.py"))
    assert cooperative.scope.line_of(SimpleNamespace()) is None  # type: ignore[arg-type]


def test_without_a_run_stepping_is_wpilibs(real: list[tuple[Any, ...]]) -> None:
    names = table()
    for owner in ("wpilib.simulation", "hal.simulation"):
        names[owner, "stepTiming"](2)
        names[owner, "stepTimingAsync"](3)
        for verb in ("pauseTiming", "resumeTiming", "restartTiming", "waitForProgramStart"):
            names[owner, verb]()
    of_one = ["pauseTiming", "resumeTiming", "restartTiming", "waitForProgramStart"]
    assert real == [("stepTiming", 2), ("stepTimingAsync", 3), *((name,) for name in of_one)] * 2


def test_with_a_run_stepping_lets_its_time_pass(real: list[tuple[Any, ...]], run: RobotRun) -> None:
    names = table()
    names["wpilib.simulation", "stepTiming"](0.03)
    assert run.clock.now_us == 30_000
    names["hal.simulation", "stepTimingAsync"](5_000)
    assert run.clock.now_us == 35_000
    for owner in ("wpilib.simulation", "hal.simulation"):
        for verb in ("pauseTiming", "resumeTiming", "restartTiming", "waitForProgramStart"):
            names[owner, verb]()
    assert real == []
    slept: list[int] = []

    def body() -> None:
        names["wpilib.simulation", "stepTiming"](0.01)
        slept.append(run.clock.now_us)

    cooperative.start_in_robot_time(threading.Thread(target=body, daemon=True))
    run.run_until(60_000)
    assert slept == [45_000]


def test_stepping_raises_what_the_robot_raises(real: list[tuple[Any, ...]], run: RobotRun) -> None:
    def fail() -> None:
        run.threads.fail(ValueError("the robot's"))
        raise TestEnded

    run.clock.at(10_000, PHYSICS, fail)
    with pytest.raises(ValueError, match="the robot's"):
        table()["wpilib.simulation", "stepTiming"](0.02)


def test_alarms_of_the_hal_are_the_runs_or_the_hals_own(real: list[tuple[Any, ...]], run: RobotRun) -> None:
    names = table()
    handle, status = names["hal", "initializeNotifier"]()
    assert status == 0
    assert names["hal", "setNotifierName"](handle, "ours") == 0
    assert names["hal", "updateNotifierAlarm"](handle, 15_000) == 0
    assert names["hal", "waitForNotifierAlarm"](handle) == (15_000, 0)
    assert names["hal", "stopNotifier"](notifierHandle=handle) == 0
    assert real == []
    assert names["hal", "updateNotifierAlarm"](7, 15_000) == "real updateNotifierAlarm"
    assert names["hal", "setNotifierName"](7, "theirs") == "real setNotifierName"
    assert names["hal", "cancelNotifierAlarm"](handle) == 0
    names["hal", "cleanNotifier"](handle)
    assert names["hal", "cancelNotifierAlarm"](handle) == "real cancelNotifierAlarm"
    active_run.run, before = None, active_run.run
    try:
        assert names["hal", "initializeNotifier"]() == "real initializeNotifier"
        assert names["hal", "setNotifierName"](handle, "x") == "real setNotifierName"
    finally:
        active_run.run = before


class Robot:
    """In place of a `TimedRobot`."""


def test_a_timed_robots_functions_are_the_runs(real: list[tuple[Any, ...]], run: RobotRun) -> None:
    names = table()
    robot = Robot()
    calls: list[str] = []
    run.timed_loop = SimpleNamespace(  # type: ignore[assignment]
        add=lambda robot, call, *times: calls.append(f"add {times}"),
        begin=lambda robot: calls.append("begin"),
        run_blocking=lambda threads: calls.append("loop"),
        loop_start_us=1234,
    )
    names["TimedRobot", "addPeriodic"](robot, print, 0.01)
    names["TimedRobot", "addPeriodic"](robot, print, 0.01, 0.005)
    names["TimedRobot", "startCompetition"](robot)
    assert names["TimedRobot", "getLoopStartTime"](robot) == 1234
    assert calls == ["add (0.01, 0.0)", "add (0.01, 0.005)", "begin", "loop"]
    assert real == []
    active_run.run, before = None, active_run.run
    run.timed_loop = SimpleNamespace(stopped=False)  # type: ignore[assignment]
    try:
        names["TimedRobot", "addPeriodic"](robot, print, 0.01, 0.005)
        names["TimedRobot", "startCompetition"](robot)
        assert names["TimedRobot", "getLoopStartTime"](robot) == "real getLoopStartTime"
    finally:
        active_run.run = before
    assert real == [
        ("addPeriodic", robot, print, 0.01, 0.005),
        ("startCompetition", robot),
        ("getLoopStartTime", robot),
    ]


def test_waits_outside_the_run_take_real_time(monkeypatch: pytest.MonkeyPatch) -> None:
    slept: list[float] = []
    monkeypatch.setattr("pyfrc_core.runtime.patches._real_sleep", slept.append)
    names = table()
    names["time", "sleep"](0.5)
    names["wpilib", "wait"](0.25)
    assert slept == [0.5, 0.25]


def test_a_wait_of_nothing_or_less_takes_no_time(run: RobotRun) -> None:
    names = table()
    names["wpilib", "wait"](-1)
    names["wpilib", "wait"](0)
    assert run.clock.now_us == 0
    names["wpilib", "wait"](0.001)
    assert run.clock.now_us == 1000


def test_times_are_whole_microseconds() -> None:
    end = _Instant(0.1) + 0.2
    assert end == 0.3
    assert end - 0.3 == 0
    assert _Instant(0.3) - 0.1 == 0.2
    assert type(end - 0.1) is _Instant
    assert _Instant(1.0000014) + 0 == 1.000001


@pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork")
def test_a_process_that_robot_code_forks_lives_in_real_time(patched: Patches, run: RobotRun) -> None:
    def work(send: Callable[[bytes], None]) -> None:
        send(f"{active_run.run} {cooperative.scope.threads}".encode())

    assert active_run.run is run
    fork = Fork(work)
    while not fork.finished:
        fork.poll()
    assert fork.message == b"None None"


# -- replacements behave as what they replace --------------------------------------------------------------------------


def test_a_built_in_functions_replacement_is_one_to_all_code(patched: Patches) -> None:
    real = types.BuiltinFunctionType
    assert isinstance(time.sleep, real)
    assert (time.sleep.__name__, time.sleep.__qualname__, time.sleep.__module__) == ("sleep", "sleep", "time")
    assert (time.sleep.__doc__ or "").startswith("sleep(")
    assert repr(time.sleep) == "<built-in function sleep>"
    assert copy.copy(time.sleep) is copy.deepcopy(time.sleep) is pickle.loads(pickle.dumps(time.sleep)) is time.sleep

    function = time.sleep.__func__  # type: ignore[attr-defined]
    assert (function.__name__, function.__module__) == ("sleep", "time")  # what a traceback shows

    class Uses:
        sleep = time.sleep

    assert Uses().sleep is time.sleep  # it is not bound


def test_a_classs_replacement_has_its_name(patched: Patches) -> None:
    assert (wpilib.Notifier.__name__, wpilib.Notifier.__module__) == ("Notifier", "wpilib._wpilib")
    assert wpilib.TimedRobot.addPeriodic.__name__ == "addPeriodic"
    assert inspect.isroutine(wpilib.wait)
    assert wpilib.wait.__name__ == "wait"


def test_patches_of_a_table_are_undone_in_their_order() -> None:
    class Base:
        inherited = 1

    class Owner(Base):
        own = 2

    ours = PatchTable()
    assert not ours
    for patch in (Patch(Owner, "own", 3), Patch(Owner, "own", 4), Patch(Owner, "inherited", 5)):
        ours.patch(*patch)
    assert ours
    assert (Owner.own, Owner.inherited, Base.inherited) == (4, 5, 1)
    ours.undo()
    assert (Owner.own, Owner.inherited) == (2, 1)
    assert not ours


# -- whose call it is --------------------------------------------------------------------------------------------------


def test_whose_code_calls(patched: Patches, tmp_path: Path) -> None:
    def called_from(*frames: tuple[str, str | None]) -> bool:
        frame: Any = None
        for filename, module in reversed(frames):
            code = SimpleNamespace(co_filename=filename)
            frame = SimpleNamespace(f_code=code, f_globals={"__file__": module} if module else {}, f_back=frame)
        return cooperative.on_behalf_of_robot_code(frame)

    robot, library = str(tmp_path / "robot.py"), "/usr/lib/python3/site-packages/other.py"
    assert called_from((robot, robot))
    assert called_from((threading.__file__, None), (robot, robot))
    assert called_from(("<string>", robot), (library, library))  # generated for the project
    assert called_from(("<string>", None), (robot, robot))
    assert not called_from((library, library), (robot, robot))
    assert not called_from(("<string>", library), (robot, robot))
    assert not called_from(("<frozen importlib>", None), (robot, robot))
    assert not called_from((threading.__file__, None))
    assert not called_from()


def test_lines_of_the_project_come_with_what_wpilib_reports(
    tmp_path: Path, files: RobotFiles, monkeypatch: pytest.MonkeyPatch
) -> None:
    reported: list[tuple[str, bool]] = []
    for name in ("reportError", "reportWarning"):
        monkeypatch.setattr(wpilib, name, lambda error, trace: reported.append((error, trace)))
    ours = {patch.name: patch.value for patch in robot_stack.patches(lambda: files)}
    (tmp_path / "robot.py").write_text("def warn(report):\n    report('wrong', True)\n")
    names: dict[str, Any] = {}
    exec(compile((tmp_path / "robot.py").read_text(), str(tmp_path / "robot.py"), "exec"), names)
    names["warn"](ours["reportWarning"])
    line = f"  File \"{tmp_path}/robot.py\", line 2, in warn\n    report('wrong', True)\n"
    assert reported == [(f"wrong\n{line}", False)]
    ours["reportError"]("wrong")
    assert reported[1:] == [("wrong", False)]
    try:
        raise ValueError
    except ValueError:
        names["warn"](ours["reportError"])
    assert reported[2:] == [("wrong", True)]
    assert ours["reportError"].__name__ == "reportError"


def test_what_a_fork_would_lack(patched: Patches, monkeypatch: pytest.MonkeyPatch) -> None:
    thread = threading.Thread(target=time.sleep, name="reader")
    monkeypatch.setattr(fork_obstacles, "threads_of_the_project", lambda: [(thread, "robot.py:3")])
    monkeypatch.setattr(fork_obstacles, "devices_exist", lambda: False)
    assert reasons_not_to_fork() == ["robot.py:3 starts the thread 'reader', which runs time.sleep"]
    monkeypatch.setattr(fork_obstacles, "devices_exist", lambda: True)
    monkeypatch.setattr(fork_obstacles, "threads_of_the_project", list)
    for count, shown in ((1, "d0"), (3, "d0, d1, d2"), (4, "d0, d1, d2 and 1 more")):
        monkeypatch.setattr(fork_obstacles, "existing_devices", lambda: [f"d{each}" for each in range(count)])  # noqa: B023
        assert reasons_not_to_fork() == [f"devices are made: {shown}"]


# -- physics of the robot's own code -----------------------------------------------------------------------------------


def test_a_robots_own_physics_see_disabled_outputs_as_off(run: RobotRun) -> None:
    seen: list[tuple[bool, float]] = []

    class Physical(wpilib.TimedRobot):
        def robotInit(self) -> None:
            self.motor = wpilib.PWMSparkMax(13)

        def robotPeriodic(self) -> None:
            self.motor.set(0.5)
            self.motor.feed()

        def _simulationPeriodic(self) -> None:
            seen.append((modes.is_enabled(), run.hal_data["pwm"][13]["value"]))

    run.construct(Physical)
    run.start()
    run.run_until(40_000)
    modes.set_mode(enabled=True)
    run.run_until(80_000)
    assert seen[0] == (False, 0)
    assert seen[-1] == (True, 0.5)


def test_subsystems_own_physics_see_disabled_outputs_as_off(monkeypatch: pytest.MonkeyPatch) -> None:
    class Subsystem:
        def simulationPeriodic(self) -> None: ...

    class Arm(Subsystem):
        def simulationPeriodic(self) -> None:
            calls.append("arm")

    class Gate:
        def closed_while_disabled(self) -> Gate:
            return self

        def __enter__(self) -> None:
            calls.append("closed")

        def __exit__(self, *_: object) -> None:
            calls.append("open")

    calls: list[str] = []
    arm, plain = Arm(), Subsystem()
    monkeypatch.setitem(simulation_periodic.sys.modules, "commands2", SimpleNamespace(Subsystem=Subsystem))
    monkeypatch.setattr(simulation_periodic, "registered_subsystems", lambda: [arm, plain])
    simulation_periodic.gate_subsystems(Gate)  # type: ignore[arg-type]
    assert "simulationPeriodic" not in vars(plain)
    modes.reset_driver_station()  # what earlier tests have left
    modes.set_mode(enabled=False)
    wpilib.DriverStation.refreshData()
    arm.simulationPeriodic()
    assert calls == ["closed", "arm", "open"]
    modes.set_mode(enabled=True)
    wpilib.DriverStation.refreshData()
    arm.simulationPeriodic()
    assert calls[3:] == ["arm"]
    modes.reset_driver_station()
    monkeypatch.delitem(simulation_periodic.sys.modules, "commands2")
    simulation_periodic.gate_subsystems(Gate)  # type: ignore[arg-type]


# -- a run's outside ---------------------------------------------------------------------------------------------------


def test_networktables_stay_in_this_process_while_there_is_a_run(run: RobotRun) -> None:
    network = ntcore.NetworkTableInstance.getDefault()
    assert network.getNetworkMode() == ntcore.NetworkTableInstance.NetworkMode.kNetModeLocal
    run.close()
    assert network.getNetworkMode() == ntcore.NetworkTableInstance.NetworkMode.kNetModeNone


def test_a_run_is_recorded_with_its_trace(run: RobotRun, tmp_path: Path) -> None:
    class Quiet(wpilib.TimedRobot):
        def disabledPeriodic(self) -> None: ...

    file = tmp_path / "new/directory/match.jsonl"
    for _ in range(2):  # a second time, its directory is there
        with recorded(run, file, "robot.py", 7):
            if run.robot is None:
                run.construct(Quiet)
                run.start()
            run.run_until(run.clock.now_us + 5 * PACKET_US)
    script = load_script(file)
    assert script.robot == "robot.py"
    assert script.seed == 7
    assert trace_beside(file).stat().st_size > 0


def test_magic_robots_initialization_is_heard_of(run: RobotRun) -> None:
    calls: list[str] = []

    class Magic(wpilib.RobotBase):
        def startCompetition(self) -> None:
            calls.append("robotInit")
            self._simulationInit()

        def _simulationInit(self) -> None:
            calls.append("own")

        def endCompetition(self) -> None: ...

    run.when_initialized.append(lambda: calls.append("initialized"))
    run.construct(Magic)
    assert run.initializes
    run.start()
    assert calls == ["robotInit", "own", "initialized"]


def test_code_is_in_motion_only_while_it_runs(run: RobotRun) -> None:
    seen: list[bool] = []
    run.do(lambda: seen.append(run.in_motion))
    assert (seen, run.in_motion) == ([True], False)
    seen.clear()
    end = run.threads.end
    run.threads.end = lambda line_of: seen.append(run.in_motion) or end()  # type: ignore[method-assign, func-returns-value]
    run.end()
    assert (seen, run.in_motion) == ([True], False)
