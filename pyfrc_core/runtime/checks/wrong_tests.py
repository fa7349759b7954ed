"""Find tests that do not test the robot that runs: with a robot of their own, or with inputs that come too late."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from ...explain.places import last_name
from ...wpi import names
from .code_warning import CodeWarning
from .kinds import Kinds, object_of
from .sources import Source

#: A line that sets what only robot code sets.
_OUTPUT = re.compile(r"hal_data\['(?:pwm|relay|solenoid)'\]\[\d+\](?:\['\w+'\])? = ")
_RUNS = "control.run_test(lambda tm: tm < 3)"


def find_wrong_tests(kinds: Kinds) -> Iterator[CodeWarning]:
    for source in (each for each in kinds.sources if each.is_test):
        for node in ast.walk(source.tree):
            if isinstance(node, ast.ClassDef) and any(last_name(each) == "TestCase" for each in node.bases):
                text = f"{node.name} is a unittest.TestCase, whose tests get no control and robot"
                remedy = f"Write class {node.name}: without it, assert for self.assertEqual, and robot as a parameter"
                yield CodeWarning(source.at(node), text, remedy)
            elif isinstance(node, ast.Call):
                if ast.unparse(node.func) == f"robot.{names.INITIALIZATION}":
                    text = f"the test calls {ast.unparse(node)} itself, and a run does that again"
                    remedy = f"Write control.set_operator_control(enabled=True) and {_RUNS}, which calls it"
                    yield CodeWarning(source.at(node), text, remedy)
                made = object_of(node.func, source)
                if isinstance(made, type) and any(each.__name__ == "RobotBase" for each in made.__mro__):
                    text = f"{ast.unparse(node)} makes a robot that nothing runs: no driver station, physics or time"
                    remedy = (
                        f"Write def test_it(control, robot):, control.set_operator_control(enabled=True) and {_RUNS}"
                    )
                    yield CodeWarning(source.at(node), text, remedy)
            elif isinstance(node, ast.FunctionDef):
                yield from _too_late(node, source)


def _too_late(test: ast.FunctionDef, source: Source) -> Iterator[CodeWarning]:
    """Yield inputs that are set after ``control.run_test(...)``."""
    calls = [at for at, each in enumerate(test.body) if "control.run_test(" in ast.unparse(each)]
    for each in (each for each in test.body if _OUTPUT.match(ast.unparse(each))):
        text = f"{ast.unparse(each)} sets an output, and the robot's code sets it again"
        yield CodeWarning(source.at(each), text, "Set what the robot reads, such as joysticks, and assert its outputs.")
    for each in test.body[calls[0] + 1 :] if len(calls) == 1 else ():
        written = ast.unparse(each)
        if isinstance(each, ast.Assign) and written.startswith("hal_data["):
            text = f"{ast.unparse(each.targets[0])} is set after control.run_test(...), and the robot has ended then"
            yield CodeWarning(source.at(each), text, "Move this line above control.run_test(...).")
