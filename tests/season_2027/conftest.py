"""Tests of season 2027: collected where WPILib 2027 is installed.

That is ``pytest tests/season_2027``, with Python 3.11 or later, on Linux with glibc 2.39 or later.
"""

from __future__ import annotations

from importlib.util import find_spec

from pyfrc_core.season import CURRENT

collect_ignore_glob = [] if CURRENT.year == 2027 else ["test_*.py"]
collect_ignore_glob += [
    test for test, needs in (("test_page.py", "playwright"), ("test_window.py", "tkinter")) if find_spec(needs) is None
]
