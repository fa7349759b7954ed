"""The other end of `processes.SpawnedTest`: collect the tests again in this new interpreter, run one, tell of it.

Run as ``python -m pyfrc_core.test_support.isolation.spawned``, with its job pickled on standard input.
"""

from __future__ import annotations

import os
import pickle
import sys
from pathlib import Path
from typing import Any

import pytest

from ...measure.processes import measure_here, save_here


class OnlyOneTest:
    """Runs the one test of the job, silently, through the same protocol as a forked test."""

    def __init__(self, job: dict[str, Any], plugin: Any) -> None:
        self._job = job
        self._plugin = plugin

    @pytest.hookimpl(trylast=True)
    def pytest_configure(self, config: pytest.Config) -> None:
        # What is reported, the other end reports.
        for name in ("terminalreporter", "junitxml"):
            reporter = config.pluginmanager.getplugin(name)
            if reporter is not None:
                config.pluginmanager.unregister(reporter)

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        from .messages import Teller
        from .processes import leave_word_on_crash

        with (
            Path(self._job["output"]).open("wb", buffering=0) as output,
            Path(self._job["last_words"]).open("w+b", buffering=0) as last_words,
        ):
            leave_word_on_crash(self._plugin, last_words.fileno())
            for item in session.items:
                if item.nodeid == self._job["nodeid"]:
                    Teller(output.write).run(item, shares=False)  # type: ignore[arg-type]
        return True


def main() -> None:
    job = pickle.load(sys.stdin.buffer)
    sys.path[:] = job["path"]
    os.chdir(job["directory"])
    measure_here()
    from ...project import Project
    from ..pytest_plugin import PyFrcPlugin

    project = Project(Path(job["main_file"]), job["class_name"])
    _ = project.settings  # before pytest reads the same pyproject.toml, which may begin with a byte-order mark
    plugin = PyFrcPlugin(None, project.main_file, project.root, project=project, options=job["options"])
    status = pytest.main(job["args"], plugins=[plugin, OnlyOneTest(job, plugin)])
    save_here()
    sys.stdout.flush()
    os._exit(int(status))  # without waiting for what the robot left running


if __name__ == "__main__":
    main()
