"""Try each kind of explanation in turn."""

from __future__ import annotations

from collections.abc import Callable

from ..project.robot_files import RobotFiles
from .explanation import Explanation

#: Returns what an error means, if it is of this kind.
Kind = Callable[[BaseException, RobotFiles], Explanation | None]


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Return what an error means, or None if it is not one of those that are known."""
    from . import arguments, calls, commands, imports, libraries, names, syntax

    kinds: tuple[Kind, ...] = (
        syntax.explain,
        imports.explain,
        commands.explain,
        calls.explain,
        libraries.explain,
        arguments.explain,
        names.explain,
    )
    try:
        return next(filter(None, (kind(error, files) for kind in kinds)), None)
    except Exception:  # such as an object whose own methods raise: the error itself matters more
        return None
