"""What tests need and not every machine has: they are skipped there, and the run ends with one line that says so.

The line also counts the tests that run nightly only (those marked `slow`).

In the gate, which sets ``PYFRC_NO_SKIPS``, nothing is skipped: a missing part is a failure. Only what needs a newer
Python is skipped there, too: the suite's run on that Python tests it.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections import Counter
from collections.abc import Container, Generator, Iterable, Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

#: Between what a test is about and what this machine lacks for it, in the reason of a skip.
_NEEDS = ": needs "

#: What vendors' packages need, and the look-alike of Windows' files.
_NEWER_PYTHON = "Python 3.11"

#: Where programs are, besides the PATH of an ordinary user.
_SYSTEM_PROGRAMS = ("/usr/local/sbin", "/usr/sbin", "/sbin")

#: The packages with what may be missing, by the package manager that has them.
_PACKAGES = {
    "apt-get install": {
        "Xvfb": "xvfb",
        "chromium": "chromium",
        "git": "git",
        "ip": "iproute2",
        "ssh-keygen": "openssh-client",
        "sshd": "openssh-server",
        "sudo": "sudo",
        "tkinter": "python3-tk",
        "xdotool": "xdotool",
    },
    "dnf install": {
        "Xvfb": "xorg-x11-server-Xvfb",
        "chromium": "chromium",
        "git": "git",
        "ip": "iproute",
        "ssh-keygen": "openssh-clients",
        "sshd": "openssh-server",
        "sudo": "sudo",
        "tkinter": "python3-tkinter",
        "xdotool": "xdotool",
    },
    "pacman -S": {
        "Xvfb": "xorg-server-xvfb",
        "chromium": "chromium",
        "git": "git",
        "ip": "iproute2",
        "ssh-keygen": "openssh",
        "sshd": "openssh",
        "sudo": "sudo",
        "tkinter": "tk",
        "xdotool": "xdotool",
    },
}

#: What no package brings.
_OTHERWISE = {
    "axe-core": "npm ci",
    "Dask": 'pip install "distributed>=2024.12"',
    "robotpy-rev": 'pip install "robotpy-rev>=2027.0.0a7.post1"',
    "phoenix6": 'pip install "phoenix6>=26.70.0a2"',
    _NEWER_PYTHON: "make test PYTHON=python3.11 VENV=.venv-3.11",
    "Linux": "run them on Linux (on Windows: in WSL)",
    # Not with sudo: what it writes into the checkout would belong to root.
    "root": "run them as root in a container or a virtual machine",
    "a Python with tkinter": "make test PYTHON=/usr/bin/python3 VENV=.venv-system",
    "namespaces": "run them outside of this container, or give it --privileged",
}


def missing_programs(*names: str) -> list[str]:
    """Return those of these programs that are not installed."""
    path = os.pathsep.join([os.environ.get("PATH", os.defpath), *_SYSTEM_PROGRAMS])
    return [name for name in names if shutil.which(name, path=path) is None]


def missing_python() -> list[str]:
    """Return what is missing where this Python is too old for vendors' packages."""
    return [] if sys.version_info >= (3, 11) else [_NEWER_PYTHON]


def missing_tkinter() -> list[str]:
    """Return what is missing for tkinter, which systems have in a package of its own, for their own Python."""
    if find_spec("tkinter") is not None:
        return []
    return ["tkinter" if sys.platform != "linux" or sys.base_prefix == "/usr" else "a Python with tkinter"]


def require(tested: str, missing: Iterable[str]) -> None:
    """Skip the test, or at the top of a module that cannot be imported then all of its tests, when anything is missing.

    :param tested:  what is not tested then, the same for all tests of one kind
    :param missing: the parts that this machine lacks
    """
    if parts := list(missing):
        pytest.skip(tested + _NEEDS + ", ".join(parts), allow_module_level=True)


def requires(tested: str, missing: Iterable[str]) -> pytest.MarkDecorator:
    """Return the same as a mark, for tests whose fixtures need the parts, too, and for all tests of a module."""
    parts = list(missing)
    return pytest.mark.skipif(bool(parts), reason=tested + _NEEDS + ", ".join(parts))


def _remedies(parts: set[str]) -> Iterator[str]:
    """Yield what brings these parts: one command for those that packages have."""
    if packaged := parts.intersection(*_PACKAGES.values()):
        for manager, packages in _PACKAGES.items():
            if shutil.which(manager.partition(" ")[0]):
                yield " ".join(["sudo", manager, *sorted({packages[part] for part in packaged})])
                break
        else:
            yield f"install {', '.join(sorted(packaged))}"
    yield from (_OTHERWISE[part] for part in sorted(parts & _OTHERWISE.keys()))


def summarize(skipped: Counter[str], uncounted: Container[str] = (), nightly: int = 0) -> str:
    """Return the line that says what was not tested and how to test it; empty when all was tested.

    :param skipped: how many tests were skipped, by reason
    :param uncounted: reasons for which a module was skipped that cannot be imported, so that there may be more
    :param nightly: how many tests were left out since they run nightly
    """
    sentences = []
    if skipped:
        sentences.append(_summarize_skipped(skipped, uncounted))
    if nightly:
        count = f"{nightly} test{'s' * (nightly != 1)}"
        sentences.append(f"Left for the nightly run: {count}. To run them now: make test ARGS=--run-slow")
    return ". ".join(sentences)


def _summarize_skipped(skipped: Counter[str], uncounted: Container[str]) -> str:
    groups: dict[str, tuple[int, set[str]]] = {}
    least = {reason.partition(_NEEDS)[0] for reason in skipped if reason in uncounted}
    for reason, count in skipped.items():
        tested, _, needs = reason.partition(_NEEDS)
        before, parts = groups.get(tested, (0, set()))
        groups[tested] = before + count, parts | set(filter(None, needs.split(", ")))
    listed = []
    for tested, (count, parts) in sorted(groups.items(), key=lambda group: -group[1][0]):
        needs = f"; needs {', '.join(sorted(parts))}" if parts else ""
        at_least = "at least " * (tested in least)
        listed.append(f"{tested} ({at_least}{count} test{'s' * (count != 1)}{needs})")
    line = f"Not tested on this machine: {', '.join(listed)}."
    remedy = "; ".join(_remedies(set().union(*(parts for _, parts in groups.values()))))
    return f"{line} To test this, too: {remedy}" if remedy else line


def _functions_of(report: pytest.CollectReport) -> int:
    """Return how many functions of a skipped module are tests, each at least one."""
    return len(re.findall(r"^def test_", Path(report.fspath).read_text("utf-8"), re.MULTILINE))


def _reason(report: pytest.TestReport | pytest.CollectReport) -> str:
    assert isinstance(report.longrepr, tuple)
    return report.longrepr[2].removeprefix("Skipped: ")


def _fails(report: pytest.TestReport | pytest.CollectReport) -> bool:
    """Whether this is skipped where nothing may be."""
    return (
        report.skipped
        and not hasattr(report, "wasxfail")
        and "PYFRC_NO_SKIPS" in os.environ
        and not _reason(report).endswith(_NEEDS + _NEWER_PYTHON)
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Make what is skipped a failure in the gate."""
    report = yield
    if _fails(report):
        report.outcome = "failed"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """The same for a whole module."""
    report = yield
    if _fails(report):
        report.outcome = "failed"
    return report


#: How many tests were left out since they run nightly.
_NIGHTLY = pytest.StashKey[int]()


def pytest_deselected(items: Sequence[pytest.Item]) -> None:
    """Count the tests that run nightly."""
    if slow := [item for item in items if item.get_closest_marker("slow")]:
        stash = slow[0].config.stash
        stash[_NIGHTLY] = stash.get(_NIGHTLY, 0) + len(slow)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Take the number from one of xdist's workers: each collects all tests."""
    stash = node.config.stash
    stash[_NIGHTLY] = max(stash.get(_NIGHTLY, 0), getattr(node, "workeroutput", {}).get("nightly", 0))


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> Generator[None, None, None]:
    """End the run with the line, below pytest's own last one."""
    nightly = session.config.stash.get(_NIGHTLY, 0)
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["nightly"] = nightly
    yield
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if reporter is None or hasattr(session.config, "workerinput"):
        return
    skipped: Counter[str] = Counter()
    uncounted = set()
    for report in reporter.stats.get("skipped", []):
        if isinstance(report, pytest.CollectReport):
            uncounted.add(_reason(report))
        skipped[_reason(report)] += 1 if isinstance(report, pytest.TestReport) else _functions_of(report)
    if line := summarize(skipped, uncounted, session.config.stash.get(_NIGHTLY, 0)):
        reporter.write_line(line)
