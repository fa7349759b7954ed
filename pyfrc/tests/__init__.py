"""Ready-made tests for any robot: put ``from pyfrc.tests import *`` in a file in your tests directory."""

from pyfrc_core.season import CURRENT
from pyfrc_core.tests import test_autonomous, test_disabled, test_fuzz, test_operator_control, test_practice

__all__ = ["test_autonomous", "test_disabled", "test_fuzz", "test_operator_control", "test_practice"]

if CURRENT.opmodes:
    from pyfrc_core.tests import test_opmode as test_opmode

    __all__ += ["test_opmode"]
