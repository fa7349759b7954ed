"""What an error means for a student: a sentence, the line of the robot's code, and what to do.

Libraries describe their errors from their own point of view: in the numbers of the HAL, in types of C++, in classes
that the user has never seen. `explain` returns the same in the user's words, for the errors that are common. Each
module has one kind as a table: adding an error is adding a row. All other errors are shown as they are.

Where no row fits, the explanation is made of what is there: the names that a class has, what its documentation says
that a method returns, the values at the user's line, and the user's own files.

In: an exception with its traceback. Out: an `Explanation`, or None. WPILib is imported only where the robot has
imported it, to find the module of a name: an error that it has raised brings the rest.
"""

from __future__ import annotations

from collections.abc import Callable

from ..project.robot_files import RobotFiles
from .explanation import Explanation

__all__ = ["Explanation", "explain"]


#: Returns what an error means, if it is of this kind.
Kind = Callable[[BaseException, RobotFiles], Explanation | None]


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Return what an error means, or None if it is not one of those that are known."""
    from . import (
        alliance,
        arguments,
        asserts,
        calls,
        commands,
        imports,
        libraries,
        methods,
        names,
        other_season,
        syntax,
    )

    kinds: tuple[Kind, ...] = (
        syntax.explain,
        methods.explain,
        alliance.explain,
        other_season.explain,
        imports.explain,
        commands.explain,
        calls.explain,
        libraries.explain,
        arguments.explain,
        names.explain,
        asserts.explain,
    )
    try:
        return next(filter(None, (kind(error, files) for kind in kinds)), None)
    except Exception:  # such as an object whose own methods raise: the error itself matters more
        return None
