"""Find tests that do not test the robot that runs: with a robot of their own, or with inputs that come too late."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from ...explain.places import last_name
from .kinds import Kinds, object_of
from .sources import CodeWarning, SourceFile

#: A line that sets what only robot code sets.
_OUTPUT = re.compile(r"hal_data\['(?:pwm|relay|solenoid)'\]\[\d+\](?:\['\w+'\])? = ")
_INSTEAD = (
    "Write def test_it(control, robot):, control.set_operator_control(enabled=True) and "
    "control.run_test(lambda tm: tm < 3)"
)


def find_wrong_tests(kinds: Kinds) -> Iterator[CodeWarning]:
    for source in (each for each in kinds.sources if each.is_test):
        for cls in source.all(ast.ClassDef):
            if any(last_name(each) == "TestCase" for each in cls.bases):
                text = f"{cls.name} is a unittest.TestCase, whose tests get no control and robot"
                remedy = f"Write class {cls.name}: without it, assert for self.assertEqual, and robot as a parameter"
                yield source.warning(cls, text, remedy)
        for call in source.all(ast.Call):
            made = object_of(call.func, source)
            if isinstance(made, type) and any(each.__name__ == "RobotBase" for each in made.__mro__):
                text = f"{ast.unparse(call)} makes a robot that nothing runs: no driver station, physics or time"
                yield source.warning(call, text, _INSTEAD)
        for test in source.all(ast.FunctionDef):
            yield from _of_hal_data(test, source)


def _of_hal_data(test: ast.FunctionDef, source: SourceFile) -> Iterator[CodeWarning]:
    """Yield outputs that are set, and inputs that are set after ``control.run_test(...)``."""
    calls = [at for at, each in enumerate(test.body) if "control.run_test(" in ast.unparse(each)]
    for at, each in enumerate(test.body):
        written = ast.unparse(each)
        if _OUTPUT.match(written):
            text = f"{written} sets an output, and the robot's code sets it again"
            remedy = "Set what the robot reads, such as joysticks, and assert its outputs."
            yield source.warning(each, text, remedy)
        elif isinstance(each, ast.Assign) and written.startswith("hal_data[") and len(calls) == 1 and at > calls[0]:
            text = f"{ast.unparse(each.targets[0])} is set after control.run_test(...), and the robot has ended then"
            yield source.warning(each, text, "Move this line above control.run_test(...).")
