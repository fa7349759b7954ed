"""Progress output to closed or limited streams never ends a deploy."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

TELLING = """
import sys
from pyfrc_core.deploy.progress import progress_for
progress = progress_for(as_json={as_json})
for number in range(3):
    with progress.phase("upload"):
        progress.output("Größe \\u30ed \\udc80")
progress.result({{"release": 1}}, "Deployed.")
print("done", file=sys.stderr)
"""


def print_progress(as_json: bool, encoding: str = "utf-8", **streams: int) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-c", TELLING.format(as_json=as_json)],
        stderr=subprocess.PIPE,
        env=os.environ | {"PYTHONIOENCODING": encoding, "PYTHONPATH": os.pathsep.join(sys.path)},
        check=False,
        **streams,
    )


@pytest.mark.skipif(sys.platform == "win32", reason="Windows tells of pipes that nobody reads as of other mistakes")
@pytest.mark.parametrize("as_json", [False, True])
def test_a_listener_that_goes_away_does_not_end_the_deploy(as_json: bool) -> None:
    with subprocess.Popen([sys.executable, "-c", ""], stdin=subprocess.PIPE) as listener:
        listener.wait()
        assert listener.stdin is not None
        done = print_progress(as_json, stdout=listener.stdin.fileno())
    assert (done.returncode, done.stderr) == (0, b"done\n")


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "utf-8"])
def test_letters_that_the_output_does_not_have(encoding: str) -> None:
    done = print_progress(False, encoding, stdout=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (0, b"done\n")
    assert done.stdout.endswith(b"Deployed.\n")
    assert b"\\udc80" in done.stdout
    as_json = print_progress(True, encoding, stdout=subprocess.PIPE)
    assert json.loads(as_json.stdout.splitlines()[0])["text"] == "Größe \u30ed \udc80"
