"""Tests of season 2027: collected where its WPILib is installed, as by ``make test-2027``."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest
from conftest import MakeProject, new_project

from pyfrc_core.season import CURRENT

collect_ignore_glob = [] if CURRENT.year == 2027 else ["test_*.py"]
collect_ignore_glob += [
    test for test, needs in (("test_page.py", "playwright"), ("test_window.py", "tkinter")) if find_spec(needs) is None
]


@pytest.fixture
def make_project(tmp_path: Path) -> MakeProject:
    """Makes a robot project of files in this season's spelling; for one test."""
    return lambda files: new_project(tmp_path, files, as_written=True)
