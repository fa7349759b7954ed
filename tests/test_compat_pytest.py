"""What pyfrc uses of pytest without its promise: what has changed when one of these fails, the message says."""

from __future__ import annotations

import sys
from pathlib import Path
from subprocess import run
from typing import Any

import pytest

from pyfrc_core.compat import pytest_private
from pyfrc_core.compat.private_name import IncompatibleLibraryError, PrivateName


@pytest.mark.parametrize("name", pytest_private.NAMES, ids=lambda name: name.path)
def test_it_is_there(name: PrivateName) -> None:
    try:
        name.find()
    except IncompatibleLibraryError:
        pytest.fail(name.gone)


@pytest.fixture(scope="module")
def wide() -> int:
    return 1


@pytest.fixture
def narrow(wide: int) -> int:
    return wide + 1


def test_nodes_that_are_set_up(request: pytest.FixtureRequest, wide: int, narrow: int) -> None:
    session, item = request.session, request.node
    assert hasattr(session, pytest_private.SETUP_STATE.name), pytest_private.SETUP_STATE.gone
    finalizers = pytest_private.finalizers_of(session)
    used_for = pytest_private.SETUP_STATE.used_for
    assert list(finalizers) == item.listchain(), (
        f"Session._setupstate.stack is no longer the chain of nodes: {used_for}"
    )
    assert finalizers[session][0] == session.teardown, f"a node's first finalizer is not its own teardown: {used_for}"
    assert len(finalizers[item.parent]) > 1, f"a module's fixture has no finalizer in the stack: {used_for}"


@pytest.mark.parametrize("parameter", [3])
def test_the_fixtures_of_a_test(request: pytest.FixtureRequest, narrow: int, parameter: int) -> None:
    item: Any = request.node
    assert hasattr(item, pytest_private.REQUEST.name), pytest_private.REQUEST.gone
    assert hasattr(item, pytest_private.FIXTURE_INFO.name), pytest_private.FIXTURE_INFO.gone
    assert hasattr(item.callspec, pytest_private.PARAMETER_SCOPES.name), pytest_private.PARAMETER_SCOPES.gone
    assert pytest_private.REQUEST.of(item).getfixturevalue("narrow") == 2, pytest_private.REQUEST.used_for
    assert pytest_private.shared_parameters(item) == {}, pytest_private.PARAMETER_SCOPES.used_for
    definitions = pytest_private.FIXTURE_INFO.of(item).name2fixturedefs
    scopes = {name: definitions[name][-1].scope for name in ("wide", "narrow")}
    assert scopes == {"wide": "module", "narrow": "function"}, pytest_private.FIXTURE_INFO.used_for


def test_the_streams_that_are_captured(request: pytest.FixtureRequest) -> None:
    capture: Any = request.config.pluginmanager.getplugin("capturemanager")
    name = pytest_private.CAPTURE
    assert hasattr(capture, name.name), name.gone
    for needed in (
        "is_globally_capturing",
        "stop_global_capturing",
        "start_global_capturing",
        "suspend_global_capture",
    ):
        assert hasattr(capture, needed), f"the capture manager has no {needed}: {name.used_for}"
    if capture.is_globally_capturing() and request.config.getoption("capture") == "fd":
        stream = name.of(capture).out
        assert stream.targetfd == 1, f"a captured stream has no targetfd: {name.used_for}"
        assert stream.tmpfile.fileno() > 2, f"a captured stream has no tmpfile: {name.used_for}"


PLUGIN = r"""
import os
import sys
import tempfile

import pytest

from pyfrc_core.compat import pytest_private


class Plugin:
    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session):
        item, other = session.items
        with pytest_private.captured_setup(item):
            os.write(2, b"of a shared fixture\n")
        with pytest_private.shared_fixtures(session, item) as (request, shared):
            print("shared", sorted(shared), *(pytest_private.shared_parameters(each) for each in (item, other)))
            print("value", request.getfixturevalue("wide"))
        pytest_private.run_test_protocol(item, item.parent)
        print("still set up", [type(node).__name__ for node in pytest_private.finalizers_of(session)])
        pytest_private.tear_down(session, None)
        print("torn down", len(pytest_private.finalizers_of(session)))
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            pytest_private.capture_into(session.config, (out.fileno(), err.fileno()))
            capture = session.config.pluginmanager.getplugin("capturemanager")
            capture.resume_global_capture()
            os.write(1, b"into the file\n")
            capture.suspend_global_capture(in_=False)
            out.seek(0)
            print("captured", out.read())
        return True

    def pytest_runtest_logreport(self, report):
        raise AssertionError("a report was logged")

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item, call):
        report = yield
        if report.when == "setup":
            print("setup", report.sections)
        if report.failed:
            print("report", pytest_private.put_into_traceback(report, "robot.py:1: first line\nmore", only=False))
            print(report.longreprtext.splitlines()[0], "|", report.longrepr.reprcrash.message)
            print("shorter", pytest_private.put_into_traceback(report, "robot.py:2: only line", only=True))
            print(report.longreprtext.splitlines())
        else:
            print("no traceback", pytest_private.put_into_traceback(report, "text", only=False))
        return report


pytest.main([sys.argv[1], "-p", "no:cacheprovider", "--capture=fd", "-p", "no:terminal"], plugins=[Plugin()])
"""

TESTS = """
import pytest

@pytest.fixture(scope="module", params=[7, 8])
def wide(request):
    return request.param

def test_it(wide, tmp_path):
    assert wide == 0
"""


def test_one_test_run_as_isolation_runs_it(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text(TESTS, encoding="utf-8")
    (tmp_path / "plugin.py").write_text(PLUGIN, encoding="utf-8")
    words = [sys.executable, "plugin.py", "test_it.py"]
    done = run(words, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    said = [line for line in done.stdout.splitlines() if line.strip()]
    explanation = "pytest_private no longer does what isolation and reports need of it:\n" + done.stdout + done.stderr
    for expected in (
        "shared ['tmp_path_factory', 'wide'] {'wide': 0} {'wide': 1}",
        "value 7",
        "setup [('Captured stderr setup', 'of a shared fixture\\n')]",
        "report True",
        "robot.py:1: first line | robot.py:1: first line",
        "shorter True",
        "['robot.py:2: only line']",
        "no traceback False",
        "torn down 0",
        "captured b'into the file\\n'",
    ):
        assert expected in said, explanation
    (still,) = (line for line in said if line.startswith("still set up"))
    assert still.endswith("'Module']"), explanation
