"""What only the driver station knows, read before it is connected: the alliance is None then."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from ..errors import text_of
from ..project.robot_files import RobotFiles
from .explanation import Explanation
from .other_season import in_2027
from .places import last_name, parsed, statement_at, users_frame

#: The functions that return None until the driver station is connected, and what they return afterwards.
UNKNOWN_AT_FIRST = {
    **dict.fromkeys(("getAlliance", "get_alliance"), "alliance"),
    **dict.fromkeys(("getLocation", "get_location"), "location"),
}
READ_LATER = (
    "Read it in autonomousInit and teleopInit, or where it is used, and not before: without a driver station, it is "
    "None there, too."
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    where = users_frame(error, files)
    if "None" not in text_of(error) or where is None:
        return None
    sources = dict(UNKNOWN_AT_FIRST) | dict(_holders(parsed(where[0].f_code.co_filename)))
    for node in ast.walk(statement_at(*where)):
        what = sources.get(last_name(node)) if isinstance(node, ast.expr) else None
        if what is not None:
            text = f"the {what} is None: it is not known until the driver station is connected, after robotInit"
            return Explanation(in_2027(text), in_2027(READ_LATER))
    return None


def _holders(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield the names that a file assigns such a value to, and its functions that return one."""
    for node in ast.walk(tree):
        value = node.value if isinstance(node, (ast.Assign, ast.Return)) else None
        if isinstance(node, ast.FunctionDef):
            returned = next((each.value for each in ast.walk(node) if isinstance(each, ast.Return)), None)
            names, value = [node.name], returned
        else:
            names = [last_name(target) for target in node.targets] if isinstance(node, ast.Assign) else []
        if isinstance(value, ast.Call) and (what := UNKNOWN_AT_FIRST.get(last_name(value.func))):
            yield from ((name, what) for name in names if name)
