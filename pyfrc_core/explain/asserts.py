"""Assertions of tests that compare numbers as no computer computes them."""

from __future__ import annotations

import ast
import re

from ..project.robot_files import RobotFiles
from .explanation import Explanation
from .places import statement_at, users_frame

_ALMOST = re.compile(r"assert (-?\d+\.\d+) == (-?\d+(?:\.\d+)?)$", re.MULTILINE)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    found, where = _ALMOST.match(str(error)), users_frame(error, files)
    statement = statement_at(*where) if where is not None else None
    test = getattr(statement, "test", statement)
    if found is None or not isinstance(test, ast.Compare) or abs(float(found[1]) - float(found[2])) > 0.05:
        return None
    left, right = ast.unparse(test.left), ast.unparse(test.comparators[0])
    text = f"{left} is {found[1]}, almost {right}: computed values are rounded"
    return Explanation(text, f"Write assert {left} == pytest.approx({right}, abs=0.02), after import pytest")
