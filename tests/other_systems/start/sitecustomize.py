"""Python imports this at its start: the other system is installed before anything else is imported."""

from __future__ import annotations

import os
import sys

if "PYFRC_TESTS_ON" in os.environ:
    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(__file__))))
    from other_systems.install import install

    del sys.path[0]
    install(os.environ["PYFRC_TESTS_ON"])
