"""A project of one season to the next: `pyfrc migrate`, from 2026 to 2027.

In: a project's directory. Out: a `Migration`, the new content of its files and a report of what a person must do.
Whether a name is WPILib's or the team's is decided by what the object is, not by how it is spelled: `types` finds that
out. `names` has what became of each of WPILib's names. `rewrite` changes them with LibCST, which keeps comments and
layout. Nothing imports WPILib, so that a machine with either season can migrate.
"""

from __future__ import annotations

from .._version import requirement
from ..errors import PyfrcError


def need_libcst() -> None:
    """Check that LibCST is installed.

    :raises PyfrcError: with how to install it
    """
    try:
        import libcst  # noqa: F401
    except ImportError:
        raise PyfrcError(
            "pyfrc migrate needs the package libcst",
            remedy=f'Install it with: python -m pip install "{requirement("migrate")}"',
        ) from None
