"""The pytest plugin: fixtures for robot tests, random seeds, and failures that name the user's line first."""

from __future__ import annotations

import os
import re
import sys
import warnings
from collections.abc import Generator, Iterator
from contextlib import ExitStack
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import pytest

from ..encoding import find_wrong_encoding
from ..errors import ProjectError, PyfrcError, RobotCodeError, nearest
from ..hal import HalData
from ..invariants.load import Invariant, load_invariants
from ..processes.lent_streams import lent_streams
from ..project import NO_PHYSICS, Project
from ..runtime.checks.crash_moment import CrashMoment
from ..runtime.checks.failures import (
    NamesItsPlace,
    headline,
    headline_is_the_robots,
    leave_out_libraries,
    names_its_place,
)
from ..runtime.checks.loop_limit import LoopLimit
from ..runtime.checks.refresh import explain_missing_refresh
from ..runtime.loading import load_robot
from ..runtime.patches.data_logs import TEST_LOGS, LogPlace
from ..runtime.patches.install import patches
from ..runtime.real_time_pace import RealTimePace
from ..runtime.robot import RobotRun
from ..runtime.scripts.files import recorded, traced
from ..runtime.seeds import seed_generators
from ..runtime.threads.cooperative import line_of_thread
from ..runtime.threads.robot_threads import RobotThread
from ..wording import from_here
from ..wpi import robots
from . import opmodes
from .controller import TestController
from .device_misuse import warning_of_misuse
from .fake_time import FakeTime
from .hangs import ROBOT_FIXTURES, WatchedTests
from .options import READY_MADE_DIRECTORY, READY_MADE_TESTS, TestOptions
from .reporting import (
    BUG,
    NEVER_ENABLED,
    NEVER_RUN,
    UNREPEATABLE,
    bug_of,
    never_enabled_the_robot,
    never_ran_the_robot,
    put_first,
    seed_section,
)
from .reraise import THEIRS, ReraisePlugin

if TYPE_CHECKING:
    from ..physics.core import PhysicsInterface
    from ..physics.engine import Physics, PhysicsModule
    from ..processes.crash_report import CrashLog
    from ..wpi.opmodes import OpmodeOfTests, PublishedOpmode

_NOT_IN_FILE_NAMES = re.compile(r"[^\w.\[\]-]+")  # compiled before the fork, not in each test's process


class ThreadStillRunningError(NamesItsPlace):
    """A thread of the robot was still running after its test, although it was stopped."""


class PyFrcPlugin(WatchedTests):
    """The pytest plugin. A test function gets each fixture that it names as an argument.

    :param robot_class: your robot class; None to load it from the file when a test first needs it
    :param robot_file: the file that your robot code is started from
    :param robot_path: the directory of your robot code
    """

    #: The name by which pytest recognizes a second plugin of this kind.
    __name__ = "pyfrc.robot"

    def __init__(
        self,
        robot_class: type[object] | None,
        robot_file: str | Path,
        robot_path: str | Path,
        *,
        project: Project | None = None,
        options: TestOptions | None = None,
        published: tuple[PublishedOpmode, ...] | RobotCodeError | None = None,
    ) -> None:
        self.project = project or Project(Path(robot_file).resolve())
        self.options = options or TestOptions.combined(self.project.settings.test)
        #: That of a process that runs a single test, and ends afterwards, so that no cleanup is needed.
        self.crash_log: CrashLog | None = None
        #: The robot's opmodes, or why they are not known; None before the robot is asked.
        self.published = published
        self._former_logs: set[tuple[str, int]] = set()
        self._robot_class = robot_class
        self._robot_file = str(Path(robot_file).resolve())
        self._robot_path = str(Path(robot_path).resolve())
        patches.install(self.project.files)
        if self._robot_path not in sys.path:
            sys.path.insert(0, self._robot_path)

    def robot_class(self) -> type[Any]:
        """Return the robot class; the first call imports it, and the project's physics."""
        if self._robot_class is None:
            self._robot_class = load_robot(self.project)
            seed_generators(self.options.seed)  # a library that was imported now has one, too
        self._physics_module  # noqa: B018
        return self._robot_class

    def forget_robot(self) -> None:
        """Let go of the project's code, after the last test."""
        self._robot_class = None
        for name in ("_physics_module", "invariants"):
            vars(self).pop(name, None)

    @cached_property
    def _physics_module(self) -> PhysicsModule | None:
        if not self.project.physics_file.is_file():
            return None
        from ..physics.engine import load_physics

        return load_physics(self.project)

    @cached_property
    def invariants(self) -> tuple[Invariant, ...]:
        """The project's rules. Read it after pytest has imported the test files, which may have some of them."""
        return load_invariants(self.project)

    # -- fixtures ----------------------------------------------------------------------------------------------

    @pytest.fixture
    def control(self, fake_time: FakeTime, robot: object) -> TestController:
        """Control over the robot."""
        return TestController(fake_time, self.project, self.options.seed, self.invariants)

    @pytest.fixture
    def fake_time(self, _robot_run: RobotRun) -> FakeTime:
        """Control over robot time."""
        return FakeTime(_robot_run)

    @pytest.fixture
    def hal_data(self, _robot_run: RobotRun) -> HalData:
        """A dict with the data of all the robot's devices."""
        return _robot_run.hal_data

    @pytest.fixture
    def physics_controller(self, _physics: Physics | None, robot: object) -> PhysicsInterface:
        """The object with which your ``physics.py`` moves the robot; it knows the robot's position on the field."""
        if _physics is None:
            elsewhere = self.project.misplaced_physics
            move = f"Move {self.project.shown(elsewhere)} beside {self.project.main_file.name}." if elsewhere else None
            remedy = move or "pyfrc create-physics writes one for this robot."
            raise ProjectError(NO_PHYSICS, where=self.project.root, remedy=remedy)
        return _physics.controller

    @pytest.fixture
    def robot(self, _robot_run: RobotRun, _physics: Physics | None) -> Any:
        """Your robot instance. Its `robotInit` runs when the test starts the robot."""
        __tracebackhide__ = True
        return _robot_run.construct(self.robot_class())

    @pytest.fixture
    def opmode(self, request: pytest.FixtureRequest) -> OpmodeOfTests:
        """One of the opmodes that your robot publishes: the test runs once for each of them."""
        return opmodes.value_of(request.param)

    def opmodes(self) -> tuple[PublishedOpmode, ...]:
        """Return what the robot publishes; only the first call asks it.

        :raises RobotCodeError: when the robot cannot be made
        """
        if self.published is None:
            try:
                can_have = robots.can_have_opmodes(self._robot_class)
                self.published = opmodes.published_opmodes(self.project) if can_have else ()
            except RobotCodeError as error:
                self.published = error
        if isinstance(self.published, RobotCodeError):
            raise self.published
        return self.published

    @pytest.fixture
    def robot_file(self) -> str:
        """The absolute path of the file that your robot code is started from."""
        return self._robot_file

    @pytest.fixture
    def robot_path(self) -> str:
        """The absolute path of the directory of your robot code."""
        return self._robot_path

    @pytest.fixture
    def wpilib(self) -> ModuleType:
        """The `wpilib` module, for backwards compatibility."""
        return robots.library()

    @pytest.fixture
    def _physics(self, _robot_run: RobotRun) -> Physics | None:
        """The project's physics, attached to the run."""
        __tracebackhide__ = True
        module = self._physics_module
        return None if module is None else module.attach(_robot_run, FakeTime(_robot_run))

    @pytest.fixture
    def _robot_run(self, request: pytest.FixtureRequest) -> Iterator[RobotRun]:
        """One run of the robot, which ends with the test."""
        __tracebackhide__ = True
        self.robot_class()  # imports the robot's modules before robot time begins
        self.invariants  # noqa: B018 - likewise
        name = _file_name(request.node.nodeid).removesuffix(".jsonl")
        run = RobotRun(LogPlace.of_test(self.project.root, name))
        with ExitStack() as closing:
            run.open()
            if self.crash_log is not None:
                CrashMoment(self.crash_log, run)
            LoopLimit(run, self.project.files, self.project.settings)
            RealTimePace(run, self.project.settings)
            closing.enter_context(lent_streams())
            if self.crash_log is None:
                closing.callback(_forget, run, request.node)
            closing.enter_context(self._recorded(run, request.node))
            closing.enter_context(warning_of_misuse(self.project.files))
            yield run
            run.end()
            if getattr(request.function, "__module__", "").startswith(READY_MADE_TESTS):
                self._warn_of_missing_refresh(run)
        if run.still_running:
            raise ThreadStillRunningError("\n".join(self._still_running(record) for record in run.still_running))

    def _warn_of_missing_refresh(self, run: RobotRun) -> None:
        warning = explain_missing_refresh(run) if run.started and run.threads.failure is None else None
        if warning is not None:
            warnings.warn_explicit(warning, UserWarning, self._robot_file, 1)

    def _still_running(self, record: RobotThread) -> str:
        line = record.left_at or line_of_thread(record.ident) or self.project.main_file.name
        name = record.thread.name if record.thread is not None else "?"
        return (
            f"{line}: the thread {name!r} is still running after the test was over.\n"
            "End it in endCompetition, or make it a daemon: threading.Thread(..., daemon=True)"
        )

    def _recorded(self, run: RobotRun, item: pytest.Item) -> ExitStack:
        """Record the robot's trace and inputs, if the options ask for it."""
        closing, name, options = ExitStack(), _file_name(item.nodeid), self.options
        if options.trace_directory is not None:
            closing.enter_context(traced(run, options.trace_directory / name))
        if options.record_directory is not None:
            file = options.record_directory / name
            closing.enter_context(recorded(run, file, self.project.main_file.name, options.seed))
        return closing

    # -- hooks ------------------------------------------------------------------------------------------------

    def pytest_configure(self, config: pytest.Config) -> None:
        config.addinivalue_line("markers", f"{opmodes.MARK}(names): run with these opmodes only")
        if not config.pluginmanager.hasplugin(THEIRS):
            config.pluginmanager.register(ReraisePlugin(), "pyfrc.reraise")

    def pytest_pycollect_makemodule(self, module_path: Path, parent: pytest.Collector) -> pytest.Module | None:
        """Name the ready-made tests after the module that users import, wherever pyfrc is installed."""
        if module_path.parent != READY_MADE_DIRECTORY:
            return None
        return pytest.Module.from_parent(parent, path=module_path, nodeid="pyfrc.tests")

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """Run `test_autonomous(gamedata)` once for each message that the field may send.

        Mistakes in the settings are reported here, once, and not by each test's process.
        """
        try:
            if "gamedata" in metafunc.fixturenames:
                metafunc.parametrize("gamedata", self.project.game_specific_messages or [""])
            opmodes.run_for_each(metafunc, self.opmodes)
            if "_physics" in metafunc.fixturenames and self._physics_module is not None:
                self.project.sim_config  # noqa: B018
        except PyfrcError as wrong:
            raise pytest.Collector.CollectError(str(wrong)) from None

    @pytest.hookimpl(trylast=True)
    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Import the rules; a mistake in them is reported once, and not by every test."""
        if self._robot_class is None or session.testsfailed:
            return
        try:
            self.invariants  # noqa: B018
        except PyfrcError as wrong:
            raise pytest.UsageError(str(wrong)) from None

    def pytest_sessionstart(self) -> None:
        self._former_logs = self._data_logs()
        super().pytest_sessionstart()

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print the directory of the data logs that robots have written."""
        if self._data_logs() - self._former_logs:
            terminalreporter.write_line(f"data logs: {from_here(self.project.root / TEST_LOGS)}")

    def _data_logs(self) -> set[tuple[str, int]]:
        """Return the current data logs of tests, with their modification times."""
        try:
            with os.scandir(self.project.root / TEST_LOGS) as files:
                return {(file.name, file.stat().st_mtime_ns) for file in files}
        except OSError:
            return set()

    def pytest_exception_interact(
        self, node: pytest.Item | pytest.Collector, call: pytest.CallInfo[object], report: object
    ) -> None:
        """Explain a test file that cannot be imported, as the robot program's own are."""
        if not isinstance(report, pytest.CollectReport) or not isinstance(node, pytest.Module):
            return
        if (wrong := find_wrong_encoding(node.path)) is not None:
            place = f"{node.nodeid}:{wrong.line}" if wrong.line else node.nodeid
            report.longrepr = f"{place}: {wrong.message}\n  {wrong.remedy}"
        elif call.excinfo is not None and not node.config.option.fulltrace:
            error = call.excinfo.value.__cause__ or call.excinfo.value
            report.longrepr = headline(error, self.project.files) or report.longrepr

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        seed_generators(self.options.seed)

    @pytest.hookimpl(wrapper=True, trylast=True)
    def pytest_runtest_call(self) -> Generator[None, None, None]:
        with lent_streams():  # pytest has put its own in place again after the setup
            return (yield from super().pytest_runtest_call())

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        short = not item.config.option.fulltrace
        # Checked before pyfrc's own frames are removed from the traceback.
        never_run = call.excinfo is not None and call.when == "call" and never_ran_the_robot(item, call.excinfo)
        files = self.project.files
        text, only, explained = None, False, call.excinfo is not None
        if call.excinfo is not None:
            error = call.excinfo.value
            text = headline(error, files)
            # Without a line of the user's, the traceback has libraries' code only.
            only = short and (names_its_place(error) or files.innermost_line(error.__traceback__) is None)
            if isinstance(error, AssertionError) and "\n" in str(error) and text is not None and not only:
                text = text.partition("\n")[0]  # the traceback has the other lines
            if short:
                leave_out_libraries(error, files)
        report = yield
        if report.when == "call" and (self.options.record_directory or self.options.trace_directory):
            run = (getattr(item, "funcargs", None) or {}).get("_robot_run")
            if isinstance(run, RobotRun):
                setattr(report, UNREPEATABLE, run.hal_data["CAN"].unrepeatable_devices())
        if report.failed and call.excinfo is not None:
            error = call.excinfo.value
            if not explained:  # that of a unittest.TestCase, which pytest has only now
                text, only = headline(error, files), short and files.innermost_line(error.__traceback__) is None
            if text is not None:
                if not never_run and headline_is_the_robots(text, files):
                    setattr(report, BUG, bug_of(text))
                put_first(report, text, only)
            elif isinstance(error, pytest.FixtureLookupError) and short and error.argname is not None:
                file, line, _ = item.location
                known = nearest(error.argname, sorted(ROBOT_FIXTURES))
                report.longrepr = f"{file}:{(line or 0) + 1}: there is no fixture {error.argname!r}\n  {known}"
            if never_run:
                report.sections.append(NEVER_RUN)
            elif isinstance(error, AssertionError) and never_enabled_the_robot(item):
                report.sections.append(NEVER_ENABLED)
            elif isinstance(error, AssertionError) and not hasattr(report, BUG):
                report.sections += opmodes.hint_without_opmode(item)
            report.sections.append(seed_section(self.options, item))
        return report


def _file_name(nodeid: str) -> str:
    """Return a file name that identifies the test, and is unique."""
    file, _, test = nodeid.partition("::")
    test = test.replace("::", ".")
    plain = _NOT_IN_FILE_NAMES.sub("_", test)
    unique = "" if plain == test else "-" + sha256(test.encode()).hexdigest()[:8]
    return f"{file.replace('/', '_')}.{plain}{unique}.jsonl"


def _forget(run: RobotRun, item: pytest.Item) -> None:
    """End the run and release its robot, so that the next robot in this process can create its devices."""
    import gc

    from ..wpi import commands

    run.close()
    # Other references to the robot: the test's arguments, and the traceback of its failure.
    (getattr(item, "funcargs", None) or {}).clear()
    for name in ("last_exc", "last_value", "last_traceback"):
        vars(sys).pop(name, None)
    commands.forget_all()
    gc.collect()
