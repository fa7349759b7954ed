"""What pyfrc uses of pip without its promise: what has changed when one of these fails, the message says."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from loops import for_each
from package_index import add_wheel

from pyfrc_core.compat import pip_private
from pyfrc_core.compat.private_name import IncompatibleLibraryError, PrivateName
from pyfrc_core.season import CURRENT
from pyfrc_core.sync.wanted import robot_environment


@for_each("name", pip_private.NAMES)
def test_it_is_there(name: PrivateName) -> None:
    try:
        name.find()
    except IncompatibleLibraryError:
        pytest.fail(name.gone)


def test_it_has_a_value_for_each_marker() -> None:
    here = pip_private.MARKERS.find()()
    assert set(robot_environment(CURRENT)) == set(here)


def test_pip_evaluates_markers_for_the_robot(tmp_path: Path) -> None:
    add_wheel(tmp_path, "above", "1.0", ['below; platform_machine == "another"', 'not-there; os_name != "posix"'])
    add_wheel(tmp_path, "below", "1.0")
    report = tmp_path / "report.json"
    arguments = ["install", "--dry-run", "--quiet", "--no-index", "--find-links", str(tmp_path), "--ignore-installed"]
    environment = {**robot_environment(CURRENT), "platform_machine": "another"}
    command = pip_private.pip_command(environment, [*arguments, "--report", str(report), "above"])
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, f"{pip_private.MARKERS.gone}\n{done.stderr}"
    found = {each["metadata"]["name"] for each in json.loads(report.read_text("utf-8"))["install"]}
    assert found == {"above", "below"}
