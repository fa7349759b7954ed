"""What tests print where something is missing: a reader, a place to write, or an effect of an option."""

from __future__ import annotations

import os
import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each

from pyfrc_core.test_support.isolation.reruns import reruns_notice


@pytest.mark.skipif(sys.platform == "win32", reason="pipes end otherwise there")
def test_output_that_is_no_longer_read_is_no_failed_test() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "pyfrc", "config", "schema"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    done = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, env=environment, text=True, check=False)
    assert done.returncode == 141
    assert done.stderr == "interrupted: the output is no longer read\n"
    done = subprocess.run(command, stdout=writer, stderr=writer, env=environment, check=False)
    assert done.returncode == 141
    os.close(writer)


def config(**options: object) -> Any:
    return SimpleNamespace(option=SimpleNamespace(**options))


def robot_test(*marks: str) -> Any:
    return SimpleNamespace(get_closest_marker=lambda name: name if name in marks else None)


@for_each(
    "given, tests, expected",
    [
        ({"reruns": 2}, [robot_test()], "--reruns has no effect"),
        ({"retries": 1}, [robot_test()], "--retries has no effect"),
        ({"force_flaky": True}, [robot_test()], "--force-flaky has no effect"),
        ({"reruns": None}, [robot_test(), robot_test("flaky")], "the mark flaky has no effect"),
        ({"reruns": 2}, [], ""),
        ({"reruns": None}, [robot_test("slow")], ""),
        ({}, [robot_test("flaky")], ""),
    ],
)
def test_an_option_to_run_tests_again_is_not_silent(given: dict[str, object], tests: list[Any], expected: str) -> None:
    notice = reruns_notice(config(**given), tests)
    assert notice.startswith(expected)
    assert bool(notice) == bool(expected)
