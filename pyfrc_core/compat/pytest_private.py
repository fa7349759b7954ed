"""What pyfrc uses of pytest although pytest may change it: to run each test in its own process, and for reports.

Other modules call these functions. To adapt pyfrc to a changed name or signature, change only this module.
`PrivateName`s are the names that begin with an underscore or are in ``_pytest``. The functions also use methods and
attributes of what these names stand for (``SetupState.teardown_exact``). tests/test_compat_pytest.py calls them as
isolation does.

pytest is imported only when one of these functions is called.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from .private_name import PrivateName

if TYPE_CHECKING:
    import pytest

RUN_TEST_PROTOCOL = PrivateName(
    "_pytest.runner:runtestprotocol", "isolation runs one test in its own process by it, without a report there"
)
EXCEPTION_CHAIN = PrivateName(
    "_pytest._code.code:ExceptionChainRepr", "a failure's report has this form: the robot's own line is put into it"
)
NATIVE_ENTRY = PrivateName(
    "_pytest._code.code:ReprEntryNative", "the robot's own line is put first in a failure's report as one of these"
)
SETUP_STATE = PrivateName(
    "pytest:Session._setupstate", "isolation sets up and tears down fixtures that several tests share by it"
)
REQUEST = PrivateName("pytest:Function._request", "isolation sets up fixtures that several tests share by it")
FIXTURE_INFO = PrivateName(
    "pytest:Function._fixtureinfo", "isolation finds by it which fixtures of a test are shared with other tests"
)
PARAMETER_SCOPES = PrivateName(
    "_pytest.python:CallSpec2._arg2scope", "isolation finds by it which parameters belong to shared fixtures"
)
CAPTURE = PrivateName(
    "_pytest.capture:CaptureManager._global_capturing",
    "isolation has the output of a test's process go to files that are still there when the process has crashed",
)

#: Those that are names in modules.
NAMES = (RUN_TEST_PROTOCOL, EXCEPTION_CHAIN, NATIVE_ENTRY)
#: Those that are attributes of instances.
ATTRIBUTES = (SETUP_STATE, REQUEST, FIXTURE_INFO, PARAMETER_SCOPES, CAPTURE)

#: The packages in which pytest's own hooks are.
HOOKS_OF_PYTEST = "_pytest."


def run_test_protocol(item: pytest.Item, nextitem: pytest.Item | pytest.Collector | None) -> None:
    """Set up, call and tear down one test, making its reports but not logging them.

    :param nextitem: what its nodes have in common with this is not torn down
    """
    RUN_TEST_PROTOCOL.find()(item, log=False, nextitem=nextitem)


# -- fixtures that several tests share -------------------------------------------------------------------------------


def finalizers_of(session: pytest.Session) -> Mapping[pytest.Collector | pytest.Item, list[Any]]:
    """Return the nodes that are set up, from the session inwards, and what is to be called when each is torn down.

    The first of these is the node's own teardown, the others are those of fixtures.
    """
    stack: Mapping[Any, tuple[list[Any], object]] = SETUP_STATE.of(session).stack
    return {node: finalizers for node, (finalizers, _) in stack.items()}


def tear_down(session: pytest.Session, nextitem: pytest.Item | None) -> None:
    """Tear down what is set up, except for the nodes that contain `nextitem`."""
    SETUP_STATE.of(session).teardown_exact(nextitem)


@contextlib.contextmanager
def shared_fixtures(session: pytest.Session, item: pytest.Item) -> Iterator[tuple[pytest.FixtureRequest, list[str]]]:
    """Set up what contains a test; give its request, and those of its fixtures that are wider than one test.

    The request gives a fixture's value, as in a test, while this lasts. The test itself is not set up.
    """
    state = SETUP_STATE.of(session)
    state.setup(item.parent)
    # pytest allows a fixture to be requested only while its test is set up: for this long, it seems to be.
    state.stack[item] = ([], None)
    try:
        yield REQUEST.of(item), shared_fixture_names(item)
    finally:
        del state.stack[item]


def shared_fixture_names(item: pytest.Item) -> list[str]:
    """Return the names of a test's fixtures that are wider than one test."""
    names = getattr(item, "fixturenames", ())
    known = FIXTURE_INFO.of(item).name2fixturedefs if names else {}
    return [name for name in names if name in known and known[name][-1].scope != "function"]


def shared_parameters(item: pytest.Item) -> dict[str, int]:
    """Return the parameters of a test that belong to fixtures wider than one test: the index of each one's value."""
    callspec: Any = getattr(item, "callspec", None)
    if callspec is None:
        return {}
    scopes = PARAMETER_SCOPES.of(callspec)
    return {name: index for name, index in callspec.indices.items() if scopes[name].value != "function"}


# -- captured output --------------------------------------------------------------------------------------------------


def captures_output(config: pytest.Config) -> bool:
    """Return whether pytest captures what tests print: false with ``-s``."""
    capture: Any = config.pluginmanager.getplugin("capturemanager")
    return capture is not None and bool(capture.is_globally_capturing())


def capture_into(config: pytest.Config, files: tuple[int, int]) -> None:
    """Restart the capture of output, into files that another process can read. Leave capturing suspended.

    Nothing happens when pytest captures nothing (``-s``).

    :param files: the descriptors of the files for standard output and standard error
    """
    if not captures_output(config):
        return
    capture: Any = config.pluginmanager.getplugin("capturemanager")
    capture.stop_global_capturing()
    capture.start_global_capturing()
    both = CAPTURE.of(capture)
    for stream, file in zip((both.out, both.err), files, strict=True):
        if hasattr(stream, "targetfd"):  # captures the file descriptor, not only sys.stdout
            os.dup2(file, stream.tmpfile.fileno())
    capture.suspend_global_capture(in_=False)


@contextlib.contextmanager
def captured_setup(item: pytest.Item) -> Iterator[None]:
    """Add what is printed in the context to the output of a test's setup."""
    capture: Any = item.config.pluginmanager.getplugin("capturemanager")
    if capture is None:
        yield
    else:
        with capture.item_capture("setup", item):
            yield


# -- reports ----------------------------------------------------------------------------------------------------------


def put_into_traceback(report: pytest.TestReport, text: str, only: bool) -> bool:
    """Show `text` before the traceback of a failure, and its first line in the summary.

    :param only: leave out the traceback, and the exceptions that led to this one
    :returns: whether the report has a traceback; else nothing is changed
    """
    longrepr: Any = report.longrepr
    if not isinstance(longrepr, EXCEPTION_CHAIN.find()):
        return False
    entry = NATIVE_ENTRY.find()([*(f"{line}\n" for line in text.splitlines()), "\n"])
    if only:
        longrepr.chain = longrepr.chain[-1:]
    traceback = longrepr.chain[0][0]  # what is shown first
    traceback.reprentries = [entry] if only else [entry, *traceback.reprentries]
    # The advice to use --full-trace, of a traceback in which nothing is the user's: the text has the user's line.
    if only or "--full-trace" in (traceback.extraline or ""):
        traceback.extraline = None
    for _, crash, _ in longrepr.chain[-1:]:
        if crash is not None:
            crash.message = text.splitlines()[0]
    if longrepr.reprcrash is not None:
        longrepr.reprcrash.message = text.splitlines()[0]
    return True
