"""Progress output to closed or limited streams never ends a deploy."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys

import pytest
from loops import for_each

from pyfrc_core.deploy.progress import progress_for

REPORTING = """
import sys
from pyfrc_core.deploy.progress import progress_for
progress = progress_for(as_json=False)
for number in range(3):
    with progress.phase("upload"):
        progress.output("Größe")
progress.result({"release": 1}, "Deployed.")
print("done", file=sys.stderr)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows tells of pipes that nobody reads as of other mistakes")
def test_a_listener_that_goes_away_does_not_end_the_deploy() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    with os.fdopen(writer, "wb") as stdout:
        command = [sys.executable, "-c", REPORTING]
        done = subprocess.run(command, stdout=stdout, stderr=subprocess.PIPE, env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, b"done\n")


@for_each("encoding", ["ascii", "cp1252", "utf-8"])
def test_letters_that_the_output_does_not_have(encoding: str) -> None:
    printed = []
    for as_json in (False, True):
        output = io.BytesIO()
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sys, "stdout", io.TextIOWrapper(output, encoding=encoding, write_through=True))
            progress_for(as_json=as_json).output("Größe \u30ed \udc80")
            printed.append(output.getvalue())
    assert b"\\udc80" in printed[0]
    assert json.loads(printed[1])["text"] == "Größe \u30ed \udc80"
