"""Processes that handle requests."""

from __future__ import annotations

import os
import sys
from typing import Any

import pytest

from pyfrc_core.processes.request_process import RequestProcess

CODE = """
import os, sys

def handle(request):
    if request == "exit":
        os._exit(3)
    print("this is not a result")
    return request, os.environ["NAME"], sys.stdin.read()
"""


def test_requests_one_after_the_other(tmp_path, monkeypatch) -> None:
    (tmp_path / "handler_of_requests.py").write_text(CODE)
    monkeypatch.syspath_prepend(tmp_path)
    import handler_of_requests

    process = RequestProcess(handler_of_requests.handle, {"NAME": "a"})
    try:
        large: Any = b"x" * 300_000
        assert [process.request(each) for each in (1, large)] == [(1, "a", ""), (large, "a", "")]
        for _ in range(2):  # also when it is known to have ended
            with pytest.raises(EOFError):
                process.request("exit")
    finally:
        process.kill()
        sys.modules.pop("handler_of_requests")
    with pytest.raises(ProcessLookupError):
        os.kill(process.pid, 0)
