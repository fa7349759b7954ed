"""How tests in processes of their own are reported: what each has sent, in order, and what of one that has crashed."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import types
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each

from pyfrc_core.project import Project
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.patches.data_logs import TEST_LOGS
from pyfrc_core.test_support import pytest_plugin, run_tests
from pyfrc_core.test_support.isolation import loop, messages
from pyfrc_core.test_support.isolation.loop import IsolatedTests, _made_up, _other_parameters, _report, _stop_if_asked
from pyfrc_core.test_support.isolation.spawned import TestJob, run_in_interpreter
from pyfrc_core.test_support.options import TestOptions
from pyfrc_core.test_support.pytest_plugin import PyFrcPlugin
from pyfrc_core.test_support.reporting import BUG

SEED = ("pyfrc", "random seed: 1")


class Report(SimpleNamespace):
    """A report as the test's process sends it."""


class Item:
    """A test. Its hooks note in `log` what they are called for."""

    def __init__(self, name: str, log: list[str], **options: Any) -> None:
        self.nodeid, self.location, self.keywords = name, ("t.py", 1, name), {name: 1}
        self.reports: list[Any] = []
        self.session = SimpleNamespace(shouldstop="", shouldfail="")
        self.fixturenames = options.get("fixtures", ("control",))
        self.module = options.get("module")

        def logged(report: Any) -> None:
            self.reports.append(report)
            log.append(f"{name} {report.when} {report.outcome}")

        self.ihook = SimpleNamespace(
            pytest_runtest_logreport=logged,
            pytest_runtest_logstart=lambda **about: log.append(f"{name} starts"),
            pytest_runtest_logfinish=lambda **about: log.append(f"{name} ends"),
        )
        config: Any = SimpleNamespace(rootpath="/project")
        config.hook = SimpleNamespace(pytest_report_from_serializable=lambda config, data: data)
        config.pluginmanager = SimpleNamespace(getplugin=lambda name: None)
        self.config = config


def phase(when: str, outcome: str = "passed") -> tuple[str, object]:
    return "report", Report(when=when, outcome=outcome, failed=outcome == "failed")


class Process:
    """A test's process with these messages."""

    def __init__(self, *messages: tuple[str, object], finished: bool = True, crash: str = "crashed") -> None:
        self.closed = 0
        self.worker = SimpleNamespace(
            messages=lambda: messages, finished=finished, describe_exit=lambda files, where: f"{crash} {where}"
        )

    def captured(self) -> str:
        return "printed"

    def close(self) -> None:
        self.closed += 1


PASSED = [phase("setup"), phase("call"), phase("teardown"), ("done", None)]


def reported(*messages: tuple[str, object], crash: str = "crashed") -> tuple[list[str], list[Any]]:
    log: list[str] = []
    item: Any = Item("a", log)
    process: Any = Process(*messages, crash=crash)
    _report(item, process, RobotFiles(Path("/robot")), SEED)
    return log, item.reports


def test_what_was_sent_is_reported_and_no_more() -> None:
    assert reported(*PASSED)[0] == ["a setup passed", "a call passed", "a teardown passed"]


@for_each(
    "messages, log",
    [
        ([], ["setup passed", "call failed", "teardown passed"]),
        ([phase("setup")], ["setup passed", "call failed", "teardown passed"]),
        ([phase("setup"), phase("call")], ["setup passed", "call passed", "teardown failed"]),
        ([phase("setup"), phase("call", "failed")], ["setup passed", "call failed", "teardown failed"]),
        # Of a setup that has failed, no call is made up.
        ([phase("setup", "failed")], ["setup failed", "teardown failed"]),
        (
            [phase("setup"), phase("call"), phase("teardown")],
            ["setup passed", "call passed", "teardown passed", "teardown failed"],
        ),
    ],
)
def test_a_crash_is_a_failure_of_the_phase_that_did_not_end(messages: list[Any], log: list[str]) -> None:
    found, reports = reported(*messages)
    assert found == [f"a {each}" for each in log]
    (crash,) = (each for each in reports if isinstance(each, pytest.TestReport) and each.outcome == "failed")
    assert crash.longrepr == "crashed in the middle of the test"
    assert crash.sections == [("Captured output of the process", "printed"), SEED]
    made_up = [each for each in reports if isinstance(each, pytest.TestReport) and each is not crash]
    assert all((each.longrepr, each.sections) == (None, []) for each in made_up)


def test_a_crash_at_a_robots_line_counts_as_its_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loop, "headline_is_the_robots", lambda text, files: text.startswith("robot.py"))
    _, reports = reported(crash="robot.py:12: SIGSEGV at 0x12")
    assert getattr(reports[1], BUG) == "robot.py:12: SIGSEGV at # in the middle of the test"
    _, reports = reported(crash="somewhere")
    assert not any(hasattr(each, BUG) for each in reports)


def test_a_made_up_report_without_output_has_the_seed_only() -> None:
    item: Any = Item("a", [])
    assert _made_up(item, "call", "why", "", SEED).sections == [SEED]
    assert _made_up(item, "call", None, "printed", SEED).sections == []
    assert _made_up(item, "call", "why", "", SEED).keywords == {"a": 1}


# -- the loop ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def plugin() -> Any:
    files = SimpleNamespace(is_robot_code=lambda name: name.endswith("arm.py"))
    return SimpleNamespace(
        options=SimpleNamespace(isolation="fork", seed=1, jobs="auto"), project=SimpleNamespace(files=files)
    )


def test_tests_are_reported_in_their_order_however_they_end(plugin: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    log: list[str] = []
    items: list[Any] = [Item(name, log) for name in "abc"]
    processes = [Process(*PASSED, finished=number > 0) for number in range(3)]
    tests = IsolatedTests(plugin)
    tests._running = dict(zip(items, processes, strict=True))  # type: ignore[arg-type]
    waiting = list(items)
    waits: list[int] = []

    def wait_for_any(workers: list[Any]) -> None:
        waits.append(len(workers))
        processes[0].worker.finished = True

    monkeypatch.setattr(loop, "wait_for_any", wait_for_any)
    monkeypatch.setattr(tests, "_tell_standstills", lambda config: log.append("standstills"))
    session: Any = SimpleNamespace(shouldfail="", shouldstop="", config=None)
    tests._finish(session, waiting, down_to=1)
    assert log == []  # one is running, and one may be
    tests._finish(session, waiting, down_to=0)
    of = ["starts", "setup passed", "call passed", "teardown passed", "ends"]
    assert log == ["standstills", *(f"{name} {what}" for name in "abc" for what in of)]
    assert (waits, waiting, tests._running) == ([3], [], {})
    assert [each.closed for each in processes] == [1, 1, 1]


@for_each(
    "fixtures, names, robotic",
    [
        (("control",), {}, True),
        (("tmp_path",), {}, False),
        ((), {"wpilib": types.ModuleType("wpilib")}, True),
        ((), {"Timer": type("Timer", (), {"__module__": "wpilib._wpilib"})}, True),
        ((), {"math": types.ModuleType("math"), "x": 1}, False),
        ((), {"arm": types.ModuleType("arm")}, True),
        ((), {"wpilibs": types.ModuleType("wpilibs")}, False),
    ],
)
def test_which_tests_use_the_robot(
    plugin: Any, monkeypatch: pytest.MonkeyPatch, fixtures: tuple[str, ...], names: dict[str, Any], robotic: bool
) -> None:
    monkeypatch.setitem(sys.modules, "arm", SimpleNamespace(__file__="/robot/arm.py"))
    item: Any = Item("a", [], fixtures=fixtures, module=SimpleNamespace(**names))
    assert IsolatedTests(plugin)._uses_robot(item) is robotic


def test_more_interpreters_are_started_only_where_they_have_enough_to_do(plugin: Any) -> None:
    tests = IsolatedTests(plugin)
    some: list[Any] = [Item(str(number), []) for number in range(7)]
    assert [tests._worth_starting(some[:number]) for number in (0, 1, 5, 6, 7)] == [1, 1, 1, 2, 2]
    other: Any = Item("x", [], fixtures=())
    assert tests._worth_starting([other] * 6) == 1


def test_who_runs_the_tests_otherwise(plugin: Any) -> None:
    tests = IsolatedTests(plugin)

    def left(collects: bool = False, has_dsession: bool = False, **config: Any) -> bool:
        made: Any = SimpleNamespace(option=SimpleNamespace(collectonly=collects), **config)
        made.pluginmanager = SimpleNamespace(hasplugin=lambda name: has_dsession and name == "dsession")
        session: Any = SimpleNamespace(config=made)
        return tests._left_to_others(session)

    assert [left(), left(collects=True), left(has_dsession=True), left(workerinput={})] == [False, True, True, True]
    plugin.options.isolation = "none"
    assert left()


def test_without_isolation_no_object_of_the_robot_is_destroyed_at_the_end(
    plugin: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """REV's library ended the process by SIGABRT when the interpreter did that."""
    plugin.options.isolation = "none"
    at_exit: list[object] = []
    monkeypatch.setattr(atexit, "register", at_exit.append)
    config: Any = SimpleNamespace(
        option=SimpleNamespace(collectonly=False), pluginmanager=SimpleNamespace(hasplugin=lambda name: False)
    )
    session: Any = SimpleNamespace(config=config)
    assert IsolatedTests(plugin).pytest_runtestloop(session) is None
    assert at_exit == [gc.freeze]


def test_stopping_as_pytest_does() -> None:
    class Session(SimpleNamespace):
        Failed, Interrupted = ValueError, KeyError

    _stop_if_asked(Session(shouldfail="", shouldstop=""))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="two failed"):
        _stop_if_asked(Session(shouldfail="two failed", shouldstop="asked"))  # type: ignore[arg-type]
    with pytest.raises(KeyError, match="asked"):
        _stop_if_asked(Session(shouldfail="", shouldstop="asked"))  # type: ignore[arg-type]


def test_a_shared_fixture_with_another_parameter_is_made_again(monkeypatch: pytest.MonkeyPatch) -> None:
    parameters = {"a": {"x": 1}, "b": {"x": 1, "y": 2}, "c": {"x": 2}, "d": {}}
    monkeypatch.setattr(loop.pytest_private, "shared_parameters", lambda item: parameters[item])

    def other(one: Any, two: Any) -> bool:
        return _other_parameters(one, two)

    assert [other("a", "b"), other("a", "c"), other("a", "d"), other("b", "c")] == [False, True, False, True]


def test_as_many_tests_run_at_once_as_there_are_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loop, "usable_processors", lambda: 4)
    for libraries, jobs in (((), 4), (("phoenix6",), 5)):
        monkeypatch.setattr(loop, "real_time_libraries", lambda libraries=libraries: libraries)
        assert (loop._number_of_jobs("auto"), loop._number_of_jobs(3)) == (jobs, 3)


def test_hooks_of_others() -> None:
    modules = {"pytest_rerunfailures": True, "_pytest.runner": False, "pyfrc_core.test_support.hangs": False}
    hooks = {name: SimpleNamespace(function=SimpleNamespace(__module__=name)) for name in modules}
    assert {name: loop._is_foreign(hook) for name, hook in hooks.items()} == modules


def test_a_slow_start_is_explained_once(plugin: Any) -> None:
    lines: list[str] = []
    reporter = SimpleNamespace(
        ensure_newline=lambda: None, write_line=lambda text, yellow: lines.append(text), flush=lambda: None
    )
    config: Any = SimpleNamespace(pluginmanager=SimpleNamespace(getplugin=lambda name: reporter))
    tests = IsolatedTests(plugin)
    tests._explain(config, "why")
    tests._explain(config, "why, too")
    assert lines == ["pyfrc: why"]


# -- what a test's process sends, and what is set up for several -------------------------------------------------------


class Sent:
    """Runs a test that does `protocol` as in its own process: the messages of its `ReportSender`."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, protocol: Any = lambda **about: None) -> None:
        self.messages: list[Any] = []
        monkeypatch.setattr(messages, "written_files", [])
        monkeypatch.setattr(messages, "real_time_libraries", list)
        monkeypatch.setattr(messages, "loaded_from_elsewhere", lambda project, with_pyfrc: [])
        project: Any = None
        self.sender = messages.ReportSender(self.messages.append, project)
        self.item: Any = SimpleNamespace(
            config=SimpleNamespace(pluginmanager=SimpleNamespace(register=lambda plugin, name: None)),
            session=SimpleNamespace(shouldstop=""),
            ihook=SimpleNamespace(pytest_runtest_protocol=protocol),
            parent="its module",
        )


def test_what_ends_a_test_ends_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    for raised, sent, here in (
        (KeyboardInterrupt(), ("interrupted", None), KeyboardInterrupt),
        (pytest.exit.Exception("enough", 4), ("exit", ("enough", 4)), pytest.exit.Exception),
    ):

        def protocol(raised: BaseException = raised, **about: object) -> None:
            raise raised

        made = Sent(monkeypatch, protocol)
        made.sender.run(made.item)
        assert made.messages == [sent, ("done", None)]
        with pytest.raises(here):
            messages.replay(made.item, made.messages[0])


def test_what_a_test_shares_is_left_to_the_other_side(monkeypatch: pytest.MonkeyPatch) -> None:
    following: list[object] = []
    made = Sent(monkeypatch, lambda item, nextitem: following.append(nextitem))
    made.sender.run(made.item)
    made.sender.run(made.item, shares=False)
    assert following == ["its module", None]


def test_a_run_has_one_directory_for_temporary_files(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    factory = SimpleNamespace(getbasetemp=lambda: made.append("directory"))

    @contextmanager
    def shared(session: object, item: object) -> Iterator[Any]:
        yield SimpleNamespace(getfixturevalue=lambda name: made.append(name) or factory), ["wide"]

    monkeypatch.setattr(loop.pytest_private, "shared_fixtures", shared)
    monkeypatch.setattr(loop.pytest_private, "captured_setup", nullcontext)
    session: Any = None
    loop._set_up_shared(session, Item("a", [], fixtures=("tmp_path_factory", "wide")))  # type: ignore[arg-type]
    assert made == ["tmp_path_factory", "directory", "wide"]
    made.clear()
    loop._set_up_shared(session, Item("a", []))  # type: ignore[arg-type]
    assert made == ["wide"]


# -- the run -----------------------------------------------------------------------------------------------------------


def test_pytest_starts_elsewhere_and_goes_back_to_the_users_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path.parent)
    run_tests._ChangesBack(tmp_path).pytest_load_initial_conftests()
    assert Path.cwd() == tmp_path


def test_hypothesis_reports_what_used_it(monkeypatch: pytest.MonkeyPatch) -> None:
    unregistered: list[object] = []
    plugins = SimpleNamespace(getplugin=lambda name: name, unregister=unregistered.append)
    session: Any = SimpleNamespace(config=SimpleNamespace(pluginmanager=plugins))
    run_tests._NoUnusedHypothesis().pytest_sessionfinish(session)
    assert unregistered == []
    monkeypatch.delitem(sys.modules, "hypothesis")
    run_tests._NoUnusedHypothesis().pytest_sessionfinish(session)
    assert unregistered == ["hypothesispytest"]


@pytest.fixture
def started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> PyFrcPlugin:
    """The plugin in a session that has started, beside a log of an earlier one."""
    monkeypatch.setattr(os, "dup", lambda descriptor: descriptor + 100)
    started = PyFrcPlugin.__new__(PyFrcPlugin)
    started.project = Project(tmp_path / "robot.py")
    (tmp_path / TEST_LOGS).mkdir(parents=True)
    (tmp_path / TEST_LOGS / "earlier.wpilog").touch()
    started.pytest_sessionstart()
    return started


def test_the_terminal_is_known_before_pytest_redirects_it(started: PyFrcPlugin) -> None:
    assert started._terminal == 102


def test_the_directory_of_data_logs_is_named_if_this_run_has_written_some(started: PyFrcPlugin) -> None:
    lines: list[str] = []
    reporter: Any = SimpleNamespace(write_line=lines.append)
    started.pytest_terminal_summary(reporter)
    assert lines == []
    (started.project.root / TEST_LOGS / "new.wpilog").touch()
    started.pytest_terminal_summary(reporter)
    assert [line.partition(": ")[0] for line in lines] == ["data logs"]


def test_a_new_interpreter_reads_the_settings_before_pytest_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """pytest reads the same pyproject.toml, and would stop at its byte-order mark."""
    (tmp_path / "pyproject.toml").write_text("[tool.pyfrc]\n", encoding="utf-8-sig")
    project = Project(tmp_path / "robot.py")
    read: list[bool] = []

    def main(args: list[str], plugins: list[object]) -> int:
        read.append("settings" in vars(project))
        return 3

    plugin = SimpleNamespace(forget_robot=lambda: None)
    monkeypatch.setattr(pytest_plugin, "PyFrcPlugin", lambda *args, **options: plugin)
    monkeypatch.setattr(pytest, "main", main)
    monkeypatch.chdir(tmp_path.parent)
    job = TestJob([], str(tmp_path), "test_a.py::test_b", project, TestOptions(), None, ())
    nothing: Any = None
    assert run_in_interpreter(job, nothing, nothing) == 3
    assert (read, Path.cwd()) == ([True], tmp_path)
