"""Errors that the HAL writes to standard error: which are found, and that nothing of the output is lost."""

from __future__ import annotations

import os

import pytest

from pyfrc_core.fuzz.oracle.hal_reports import hal_reports


def report(text: str) -> None:
    """Write as C code does."""
    os.write(2, text.encode())


def test_errors_are_found_when_their_line_is_whole(capfd: pytest.CaptureFixture[str]) -> None:
    with hal_reports() as reports:
        assert reports.error() is None
        report("some output\nError at robot.py: a fault")
        assert reports.error() is None
        assert reports.error() is None
        report("\nmore")
        assert reports.error() == ("robot.py: a fault", "", 0, "")
        assert reports.error() is None
        report(" output\nError at a.cpp: Joystick 3 is not available\nError at b.cpp: another fault\n")
        assert reports.error() == ("b.cpp: another fault", "", 0, "")
    assert capfd.readouterr().err == (
        "some output\nError at robot.py: a fault\nmore output\n"
        "Error at a.cpp: Joystick 3 is not available\nError at b.cpp: another fault\n"
    )


def test_errors_are_found_after_much_output(capfd: pytest.CaptureFixture[str]) -> None:
    lines = ["x" * 50 + "\n"] * 3000
    with hal_reports() as reports:
        for line in lines:
            report(line)
            assert reports.error() is None
        report("Error at robot.py: a fault\n")
        assert reports.error() == ("robot.py: a fault", "", 0, "")
        assert reports.error() is None
    assert capfd.readouterr().err == "".join(lines) + "Error at robot.py: a fault\n"
