"""The names that robot code finds replaced: what they do with a run, and that without one they are WPILib's own."""

from __future__ import annotations

import threading
import time
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

from pyfrc_core.patch_table import Patch, PatchTable
from pyfrc_core.processes.fork import FORK_IS_SAFE, Fork
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.patches.active_run import active_run
from pyfrc_core.runtime.patches.install import Patches, _Instant, patches
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.runtime.threads import cooperative


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


class Robot:
    """In place of a `TimedRobot`."""


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


# -- a run's outside ---------------------------------------------------------------------------------------------------


def test_networktables_stay_in_this_process_while_there_is_a_run(run: RobotRun) -> None:
    network = ntcore.NetworkTableInstance.getDefault()
    assert network.getNetworkMode() == ntcore.NetworkTableInstance.NetworkMode.kNetModeLocal
    run.close()
    assert network.getNetworkMode() == ntcore.NetworkTableInstance.NetworkMode.kNetModeNone
