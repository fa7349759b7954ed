"""The documented import names of pyfrc; everything is the same object as in `pyfrc_core`.

PYTEST_DONT_REWRITE
"""

from pyfrc_core._version import __version__ as __version__
from pyfrc_core.invariants.decorator import invariant as invariant

from . import version as version
