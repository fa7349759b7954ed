"""Ready-made tests for any robot: put ``from pyfrc.tests import *`` in a file in your tests directory."""

from ..errors import ProjectError
from ..season import CURRENT, installed_wpilib, refuse_unknown_wpilib

try:
    refuse_unknown_wpilib(installed_wpilib())
except ProjectError as unknown:
    import pytest

    raise pytest.Collector.CollectError(f"pyfrc: {unknown}") from None  # pytest shows this text instead of a traceback

from .basic import test_autonomous, test_disabled, test_operator_control, test_practice
from .fuzz_test import test_fuzz

__all__ = ["test_autonomous", "test_disabled", "test_fuzz", "test_operator_control", "test_practice"]

if CURRENT.opmodes:
    from .opmode_test import test_opmode as test_opmode

    __all__ += ["test_opmode"]
