"""A process that has run a robot is put back into the state of a new one; what cannot be put back is noticed."""

from __future__ import annotations

import sys
import textwrap
import time
from collections.abc import Iterator
from contextlib import closing
from functools import partial
from pathlib import Path
from types import ModuleType

import pytest
from conftest import sampled

from pyfrc_core.processes.crash_report import CrashLog
from pyfrc_core.processes.interpreter import InitialState, SpawnedWorker
from pyfrc_core.processes.reuse import Interpreters
from pyfrc_core.processes.worker import Send, wait_for_any
from pyfrc_core.project.robot_files import RobotFiles

#: Wall seconds, for what takes a hundredth of that.
PATIENCE = 60


def prepare(root: Path) -> InitialState:
    """Return the state of an interpreter for the robots of a project."""
    from pyfrc_core.runtime.patches.install import patches
    from pyfrc_core.runtime.pristine.state import ProcessState

    files = RobotFiles(root)
    patches.install(files)
    return ProcessState(files)


def run_code(code: str, root: Path) -> None:
    """Run code as a module of the project's tests: its threads are real ones at once."""
    module = sys.modules["leaky"] = ModuleType("leaky")
    module.__file__ = str(root / "tests" / "leaky.py")
    exec(compile(textwrap.dedent(code), module.__file__, "exec"), vars(module))


def do(code: str, root: Path, send: Send, log: CrashLog) -> None:
    """Run code, and send what it leaves in ``found``."""
    run_code(code, root)
    send(vars(sys.modules["leaky"]).get("found"))


def notice(code: str, root: Path, send: Send, log: CrashLog) -> None:
    """Run code, and send what is noticed of it."""
    from pyfrc_core.runtime.pristine.state import ProcessState

    state = prepare(root)
    assert isinstance(state, ProcessState)
    run_code(code, root)
    send(list(state.left_over()))


@pytest.fixture
def interpreters(tmp_path: Path) -> Iterator[Interpreters]:
    with closing(Interpreters(partial(prepare, tmp_path))) as interpreters:
        yield interpreters


def finished(worker: SpawnedWorker) -> SpawnedWorker:
    """Wait for a worker, and return it."""
    deadline = time.monotonic() + PATIENCE
    while not worker.finished:
        assert time.monotonic() < deadline
        wait_for_any([worker])
    return worker


def result_of(interpreters: Interpreters, code: str, root: Path) -> object:
    """Run code in one of these, and return what it has found."""
    worker = finished(interpreters.begin(partial(do, code, root)))
    messages = list(worker.messages())
    assert messages, worker.describe_exit(RobotFiles(root), "here")
    interpreters.end(worker)
    return messages[0]


#: What code leaves; what is said of it; and whether it can be put back.
LEAKS = {
    "thread": (
        """
        import threading
        threading.Thread(target=threading.Event().wait, name="camera", daemon=True).start()
        """,
        "the thread 'camera'",
        False,
    ),
    "device in a library": (
        """
        import json, wpilib
        json.motor = wpilib.PWMSparkMax(3)
        """,
        "the device pwm[3]",
        False,
    ),
    "function": (
        """
        import math
        math.sqrt = abs
        """,
        "the replaced math.sqrt",
        True,
    ),
    "method": (
        """
        import wpilib
        wpilib.Timer.getFPGATimestamp = lambda: 0.0
        """,
        "getFPGATimestamp",
        True,
    ),
    "variable": ("import os; os.environ['PLANTED'] = 'x'", "the environment variable PLANTED", True),
    "directory": ("import os; os.chdir(os.sep)", "the current directory", True),
    "entry": (
        """
        import json, ntcore
        json.publisher = ntcore.NetworkTableInstance.getDefault().getDoubleTopic("/planted").publish()
        json.publisher.set(1.0)
        """,
        "the entry /planted of NetworkTables",
        False,
    ),
    "entry of a dashboard": (
        "import wpilib; wpilib.SmartDashboard.putNumber('planted', 1.0)",
        "the entry /SmartDashboard/planted of NetworkTables",
        True,
    ),
    "command": (
        """
        import commands2, wpilib
        wpilib.DriverStation.refreshData()
        from wpilib.simulation import DriverStationSim
        DriverStationSim.setEnabled(True)
        DriverStationSim.notifyNewData()
        commands2.RunCommand(lambda: None).withName("planted").schedule()
        """,
        "the command planted",
        True,
    ),
    "object": (
        """
        import json
        class Registered: pass
        json.registered = [Registered()]
        """,
        "an object of the class leaky.Registered",
        False,
    ),
    "module": ("", "the module leaky", True),
    "signal": ("import signal; signal.signal(signal.SIGTERM, lambda *_: None)", "SIGTERM", True),
    "stream": ("import io, sys; sys.stdout = io.StringIO()", "sys.stdout", True),
    "log": ("import logging; logging.getLogger().setLevel(logging.DEBUG)", "the logger root", True),
    "chance": ("import random; random.random()", "the state of random", True),
    "search path": ("import sys; sys.path.append('planted')", "sys.path", True),
}


def test_what_code_leaves_is_noticed(interpreters: Interpreters, tmp_path: Path) -> None:
    everything = "\n".join(textwrap.dedent(code) for code, _, _ in LEAKS.values())
    worker = finished(interpreters.begin(partial(notice, everything, tmp_path)))
    (noticed,) = worker.messages()
    missing = [said for _, said, _ in LEAKS.values() if not any(said in each for each in noticed)]
    assert not missing, noticed
    interpreters.end(worker)


def test_the_next_one_finds_nothing(interpreters: Interpreters, tmp_path: Path) -> None:
    everything = "\n".join(textwrap.dedent(code) for code, _, restored in LEAKS.values() if restored)
    look = "import math, os, sys; found = os.getpid(), math.sqrt(4), os.getcwd(), 'PLANTED' in os.environ, sys.path"
    before = result_of(interpreters, look, tmp_path)
    result_of(interpreters, everything, tmp_path)
    assert result_of(interpreters, look, tmp_path) == before
    assert interpreters.why_not_again() == ""


def test_what_cannot_be_put_back_has_the_next_interpreter_take_over(interpreters: Interpreters, tmp_path: Path) -> None:
    process = result_of(interpreters, "import os; found = os.getpid()", tmp_path)
    for code, said, restored in LEAKS.values():
        if restored:
            continue
        interpreters.reason = ""
        result_of(interpreters, code, tmp_path)
        before, process = process, result_of(interpreters, "import os; found = os.getpid()", tmp_path)
        assert before != process
        assert said in interpreters.why_not_again()


def test_one_that_crashes_is_replaced(interpreters: Interpreters, tmp_path: Path) -> None:
    worker = finished(interpreters.begin(partial(do, "import os; os._exit(5)", tmp_path)))
    assert worker.status == 5
    assert "leaky.py:1" in worker.describe_exit(RobotFiles(tmp_path), "here")
    interpreters.end(worker)
    assert result_of(interpreters, "found = 1", tmp_path) == 1


def test_what_is_printed_belongs_to_its_work(tmp_path: Path) -> None:
    with closing(Interpreters(partial(prepare, tmp_path), keeps_output=True)) as interpreters:
        for text in ("first", "second"):
            worker = finished(interpreters.begin(partial(do, f"print('{text}')", tmp_path)))
            assert worker.printed() == f"{text}\n"
            interpreters.end(worker)


def test_one_that_is_done_is_used_again_before_its_result_is_needed(tmp_path: Path) -> None:
    with closing(Interpreters(partial(prepare, tmp_path), keeps_output=True)) as interpreters:
        code = "import os; print('{}'); found = os.getpid()"
        workers = []
        for text in ("first", "second", "third"):
            workers.append(finished(interpreters.begin(partial(do, code.format(text), tmp_path))))
        assert len({next(iter(worker.messages())) for worker in workers}) == 1
        for worker, text in zip(workers, ("first", "second", "third"), strict=True):
            assert worker.printed() == f"{text}\n"
            interpreters.end(worker)
        assert result_of(interpreters, "import os; found = os.getpid()", tmp_path) == next(iter(workers[0].messages()))


def test_libraries_of_a_rehearsal_stay_and_nothing_else(interpreters: Interpreters, tmp_path: Path) -> None:
    interpreters.rehearse(partial(do, "import os, wave; os.environ['PLANTED'] = ''", tmp_path))
    look = "import os, sys; found = 'wave' in sys.modules, 'PLANTED' in os.environ"
    assert result_of(interpreters, look, tmp_path) == (True, False)
    assert interpreters.why_not_again() == ""


@pytest.mark.parametrize(
    "code", sampled(["import os; os._exit(5)", "raise SystemExit", "raise ValueError"], "raise SystemExit")
)
def test_a_rehearsal_that_fails_changes_nothing(code: str, interpreters: Interpreters, tmp_path: Path) -> None:
    interpreters.rehearse(partial(do, code, tmp_path))
    assert result_of(interpreters, "found = 1", tmp_path) == 1


def test_devices_of_the_xrp_can_be_made_only_once(interpreters: Interpreters, tmp_path: Path) -> None:
    code = "import os, sys, types; sys.modules['xrp'] = types.ModuleType('xrp'); found = os.getpid()"
    assert result_of(interpreters, code, tmp_path) != result_of(interpreters, code, tmp_path)
    assert "the devices of xrp" in interpreters.why_not_again()
