"""Each test that uses the robot in a process of its own, several at a time, reported in order.

WPILib's HAL, and robots that keep devices in classes and modules, do not survive a second robot in one process.
The process that collects the tests has imported everything already, the robot's modules too, so each test is a fork of
it. Where processes cannot be forked, each is a new interpreter.

Fixtures wider than one test (of a class, a module, the session) are set up here, before the fork, once, and torn down
here, as everywhere in pytest.
"""

from __future__ import annotations

import atexit
import contextlib
import gc
import os
import sys
from typing import Any

import pytest

from ...compat import pytest_private
from ...compat.unrepeatable import real_time_libraries
from ...display import has_terminal
from ...errors import UsageError
from ...processes.fork import is_forked
from ...processes.reuse import Interpreters
from ...processes.worker import wait_for_any
from ...processors import usable_processors
from ...project.robot_files import RobotFiles
from ...runtime.checks.failures import headline_is_the_robots
from ...runtime.threads.fork_obstacles import reasons_not_to_fork
from ...runtime.turns import taking_turns
from ..hangs import ROBOT_FIXTURES
from ..options import Jobs
from ..pytest_plugin import PyFrcPlugin
from ..remembered_passes import PASSES
from ..reporting import BUG, bug_of, seed_section
from .interpreters import start_interpreters
from .messages import replay
from .processes import TestProcess, forked_test, spawned_test
from .reruns import reruns_notice
from .uncaptured import UncapturedOutput, uncaptured_output

#: A test file that has anything of these in it may touch the HAL even without a fixture.
_ROBOT_LIBRARIES = frozenset({"wpilib", "hal", "ntcore", "commands2", "magicbot"})

_NOT_FORKED = "Each robot test imports the robot again, which is slower: on import, {}. Do that in robotInit."
_NOT_AS_GOOD_AS_NEW = "A new interpreter for each test, because a test has left {}."


#: For so many tests another interpreter is worth its start.
_TESTS_WORTH_A_START = 3


class IsolatedTests:
    """The part of the plugin that runs tests in processes of their own.

    :param interpreters: those that were started ahead for tests that cannot be forked; this ends them
    """

    def __init__(self, plugin: PyFrcPlugin, interpreters: Interpreters | None = None) -> None:
        self._plugin = plugin
        #: For tests that are not forked.
        self._interpreters = interpreters
        self._running: dict[pytest.Item, TestProcess] = {}
        self._announced: pytest.Item | None = None
        self._explained = False
        #: Where tests print to, if pytest captures nothing.
        self._output: UncapturedOutput | None = None
        #: Whether it need not be printed that interpreters take long to start: it was, or no person waits.
        self._loading_told = not has_terminal()

    @pytest.hookimpl
    def pytest_runtestloop(self, session: pytest.Session) -> bool | None:
        if self._left_to_others(session):
            # At the end of this process, the collector would destroy the robot's objects, in any order and when the
            # interpreter is half gone: libraries such as REV's then end the process by SIGABRT.
            atexit.register(gc.freeze)
            return None
        if session.testsfailed and not session.config.option.continue_on_collection_errors:
            problems = session.testsfailed
            raise session.Interrupted(f"{problems} error{'s' if problems != 1 else ''} during collection")
        with uncaptured_output(session.config) as self._output, taking_turns():
            try:
                self._run_all(session)
            except KeyboardInterrupt:
                self._tell_interrupted(session.config)
                raise
            finally:
                for process in self._running.values():
                    process.close()
                self._running.clear()
                self._end_interpreters(session.config)
        return True

    def _left_to_others(self, session: pytest.Session) -> bool:
        config = session.config
        if config.option.collectonly or self._plugin.options.isolation == "none":
            return True
        # pytest-xdist has processes, and a loop, of its own.
        return hasattr(config, "workerinput") or config.pluginmanager.hasplugin("dsession")

    def _run_all(self, session: pytest.Session) -> None:
        jobs = 1 if session.config.option.usepdb else _number_of_jobs(self._plugin.options.jobs)
        items = session.items
        if self._interpreters is not None and self._plugin.options.jobs == "auto":
            jobs = min(jobs, self._worth_starting(items))
        waiting: list[pytest.Item] = []
        if notice := reruns_notice(session.config, filter(self._uses_robot, items)):
            self._print(session.config, f"pyfrc: {notice}")
        gc.freeze()  # what is there now stays: a collection in a fork would copy all its memory
        previous: pytest.Item | None = None
        for position, item in enumerate(items):
            if not self._uses_robot(item):
                self._finish(session, waiting, down_to=0)
                _tear_down_shared(session, previous, item)
                previous = item
                nextitem = items[position + 1] if position + 1 < len(items) else None
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=nextitem)
                _stop_if_asked(session)
                continue
            waiting.append(item)
            self._finish(session, waiting, down_to=jobs - 1)
            other_parameters = previous in self._running and _other_parameters(previous, item)
            if other_parameters or _would_tear_down_fixtures(session, item):
                self._finish(session, waiting, down_to=0)
            _tear_down_shared(session, previous, item)
            previous = item
            forked = self._can_fork(session.config)
            if forked:  # a new interpreter sets up everything itself
                _set_up_shared(session, item)
            plugin = self._plugin
            if item is waiting[0]:
                self._announce(item)
            if forked:
                self._running[item] = forked_test(item, plugin, self._output)
            else:
                if self._interpreters is None:
                    self._interpreters = start_interpreters(plugin.project)
                self._running[item] = spawned_test(item, plugin, self._interpreters, len(items) - 1 - position)
        self._finish(session, waiting, down_to=0)
        _tear_down_shared(session, previous, None)

    def _worth_starting(self, items: list[pytest.Item]) -> int:
        """Return how many interpreters have enough to do."""
        return max(1, sum(map(self._uses_robot, items)) // _TESTS_WORTH_A_START)

    def _end_interpreters(self, config: pytest.Config) -> None:
        if self._interpreters is None:
            return
        if config.get_verbosity() > 0 and (reason := self._interpreters.why_not_again()):
            self._explain(config, _NOT_AS_GOOD_AS_NEW.format(reason))
        if (passes := config.pluginmanager.getplugin(PASSES)) is not None:
            passes.record_left_over(self._interpreters.reason)
        self._interpreters.close()

    def _finish(self, session: pytest.Session, waiting: list[pytest.Item], down_to: int) -> None:
        """Report tests that have ended, in their order, until no more than `down_to` are running."""
        while waiting:
            process = self._running.get(waiting[0])
            if process is None or not process.worker.finished:
                workers = [each.worker for each in self._running.values()]
                if sum(not worker.finished for worker in workers) <= down_to:
                    return
                wait_for_any(workers)
                self._tell_standstills(session.config)
                continue
            item = waiting.pop(0)
            self._announce(item)
            del self._running[item]
            if self._output is not None:
                self._output.flush()
                process.show()
            _report(item, process, self._plugin.project.files, seed_section(self._plugin.options, item))
            process.close()
            item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
            _stop_if_asked(session)
            if waiting and waiting[0] in self._running:
                self._announce(waiting[0])

    def _tell_standstills(self, config: pytest.Config) -> None:
        """Print the lines of tests that make no progress: pytest shows nothing of a test before it ends."""
        for process in self._running.values():
            if not process.worker.finished:
                standstill = process.worker.standstill(self._plugin.project.files)
                if standstill is None and not self._loading_told:
                    standstill = process.worker.loading()
                    self._loading_told = standstill is not None
                if (text := process.notice.look(standstill)) is not None:
                    self._print(config, text)

    def _tell_interrupted(self, config: pytest.Config) -> None:
        """Print what was running, and where it stood, when the user ended the tests."""
        for item, process in self._running.items():
            if not process.worker.finished:
                standstill = process.worker.standstill(self._plugin.project.files)
                self._print(config, f"interrupted: {standstill.text(item.nodeid) if standstill else item.nodeid}")

    def _print(self, config: pytest.Config, text: str) -> None:
        reporter: Any = config.pluginmanager.getplugin("terminalreporter")
        if reporter is not None:
            reporter.ensure_newline()
            reporter.write_line(text, yellow=True)
            reporter.flush()

    def _announce(self, item: pytest.Item) -> None:
        if self._announced is not item:
            self._announced = item
            item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)

    def _can_fork(self, config: pytest.Config) -> bool:
        isolation = self._plugin.options.isolation
        try:
            if not is_forked(isolation):
                return False
        except UsageError as error:
            raise pytest.UsageError(str(error)) from None
        with contextlib.suppress(Exception):  # each test that needs it reports it
            self._plugin.robot_class()
            self._plugin.invariants  # noqa: B018
        reasons = "; ".join(reasons_not_to_fork())
        if not reasons:
            return True
        if isolation == "fork":
            raise pytest.UsageError(
                "the robot's tests cannot be forked: importing the robot, or a test file, has made devices or threads, "
                f"which a fork would lack ({reasons}). Leave out --isolation fork."
            )
        self._explain(config, _NOT_FORKED.format(reasons))
        return False

    def _explain(self, config: pytest.Config, text: str) -> None:
        """Print once why the tests are slower than they could be."""
        if not self._explained:
            self._explained = True
            self._print(config, f"pyfrc: {text}")

    def _uses_robot(self, item: pytest.Item) -> bool:
        if ROBOT_FIXTURES.intersection(getattr(item, "fixturenames", ())):
            return True
        module = getattr(item, "module", None)
        return module is not None and any(self._is_robotic(value) for value in vars(module).values())

    def _is_robotic(self, value: object) -> bool:
        name = getattr(value, "__name__", None) if isinstance(value, type(os)) else getattr(value, "__module__", None)
        if not isinstance(name, str):
            return False
        origin = getattr(sys.modules.get(name), "__file__", None) or ""
        return name.partition(".")[0] in _ROBOT_LIBRARIES or self._plugin.project.files.is_robot_code(origin)


def _stop_if_asked(session: pytest.Session) -> None:
    """``-x``, ``--maxfail`` and their like."""
    if session.shouldfail:
        raise session.Failed(session.shouldfail)
    if session.shouldstop:
        raise session.Interrupted(session.shouldstop)


def _report(item: pytest.Item, process: TestProcess, files: RobotFiles, seed: tuple[str, str]) -> None:
    """Report what the test's process has sent, and why it has sent no more."""
    done, phases, failed = False, [], False
    for message in process.worker.messages():
        if message[0] == "done":
            done = True
        elif (report := replay(item, message)) is not None:
            phases.append(report.when)
            failed = failed or (report.failed and report.when == "setup")
    if done:
        return
    crash = process.worker.describe_exit(files, "in the middle of the test")
    # After the call's report (or a setup that failed) came the teardown; it may have been reported itself.
    crashed = "teardown" if "call" in phases or failed else "call"
    for phase in ("setup", "call", "teardown"):
        if phase == crashed or (phase not in phases and not (failed and phase == "call")):
            text = crash if phase == crashed else None
            report = _made_up(item, phase, text, process.captured(), seed)
            if text is not None and headline_is_the_robots(text, files):
                setattr(report, BUG, bug_of(text))
            item.ihook.pytest_runtest_logreport(report=report)


def _made_up(
    item: pytest.Item, phase: Any, failure: str | None, captured: str, seed: tuple[str, str]
) -> pytest.TestReport:
    return pytest.TestReport(
        nodeid=item.nodeid,
        location=item.location,
        keywords=dict.fromkeys(item.keywords, 1),
        outcome="failed" if failure else "passed",
        longrepr=failure,
        when=phase,
        sections=[*([("Captured output of the process", captured)] if captured else []), seed] if failure else [],
    )


# -- fixtures that several tests share -------------------------------------------------------------------------------


def _would_tear_down_fixtures(session: pytest.Session, item: pytest.Item) -> bool:
    """Whether making way for `item` ends a fixture that a running test may still use."""
    chain = set(item.listchain())
    return any(
        len(finalizers) > 1  # the first is the node's own teardown
        for node, finalizers in pytest_private.finalizers_of(session).items()
        if node not in chain
    )


def _set_up_shared(session: pytest.Session, item: pytest.Item) -> None:
    """Set up what `item` shares with others. What fails here fails again, and is reported, in the test's process."""
    with (
        pytest_private.captured_setup(item),  # as in pytest: output belongs to the test that first needs a fixture
        contextlib.suppress(Exception, pytest.fail.Exception, pytest.skip.Exception),
        pytest_private.shared_fixtures(session, item) as (request, shared),
    ):
        if "tmp_path_factory" in getattr(item, "fixturenames", ()):
            # One numbered directory for the whole run, not one for each process.
            request.getfixturevalue("tmp_path_factory").getbasetemp()
        for name in shared:
            request.getfixturevalue(name)


def _number_of_jobs(jobs: Jobs) -> int:
    """Return how many tests run at the same time; the robot's modules have been imported."""
    return usable_processors() + bool(real_time_libraries()) if jobs == "auto" else jobs


def _other_parameters(before: pytest.Item, item: pytest.Item) -> bool:
    """Whether a fixture that both share is made again for `item`, with another parameter."""
    old, new = pytest_private.shared_parameters(before), pytest_private.shared_parameters(item)
    return any(old[name] != new[name] for name in old.keys() & new.keys())


def _tear_down_shared(session: pytest.Session, last: pytest.Item | None, nextitem: pytest.Item | None) -> None:
    """What outlived the last test ends with it; a failure in that is that test's."""
    if last is None:
        return
    call = pytest.CallInfo.from_call(lambda: pytest_private.tear_down(session, nextitem), when="teardown")
    if call.excinfo is not None:
        # Plugins with a protocol of their own (pytest-rerunfailures) have seen the test in its own process only.
        plugins = session.config.pluginmanager
        strangers = {hook.plugin for hook in plugins.hook.pytest_runtest_protocol.get_hookimpls() if _is_foreign(hook)}
        make_report = plugins.subset_hook_caller("pytest_runtest_makereport", strangers)
        report = make_report(item=last, call=call)
        last.ihook.pytest_runtest_logreport(report=report)


def _is_foreign(hook: Any) -> bool:
    """Return whether a hook is neither pytest's nor pyfrc's."""
    return not hook.function.__module__.startswith((pytest_private.HOOKS_OF_PYTEST, "pyfrc_core."))
