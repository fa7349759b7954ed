"""Puts the user's own file and line before everything else that pytest shows of a failure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pytest


def put_first(report: pytest.TestReport, text: str, only: bool = False) -> None:
    """Show `text` before everything else that pytest shows of a failure, and in its summary.

    :param only: leave out everything else
    """
    from _pytest._code.code import ExceptionChainRepr, ReprEntryNative

    longrepr = report.longrepr
    if isinstance(longrepr, ExceptionChainRepr):
        entry: Any = ReprEntryNative([*(f"{line}\n" for line in text.splitlines()), "\n"])
        if only:
            longrepr.chain = longrepr.chain[-1:]
        traceback = longrepr.chain[0][0]  # what is shown first
        traceback.reprentries = [entry] if only else [entry, *traceback.reprentries]
        traceback.extraline = None if only else traceback.extraline
        for _, crash, _ in longrepr.chain[-1:]:
            if crash is not None:
                crash.message = text.splitlines()[0]
        if longrepr.reprcrash is not None:
            longrepr.reprcrash.message = text.splitlines()[0]
    else:
        report.longrepr = f"{text}\n\n{longrepr}" if longrepr else text
