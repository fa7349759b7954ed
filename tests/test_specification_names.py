"""Every name of the specification's sections 1.1 and 1.2 exists under `pyfrc`, with its signature.

The other sections' rows join this table with the code they describe.
"""

from __future__ import annotations

import importlib
import inspect
from typing import Any

import pytest

#: (module, name, parameters as documented); None where the documentation gives no signature.
SPECIFICATION: list[tuple[str, str, str | None]] = [
    ("pyfrc.tests.basic", "test_autonomous", "control, fake_time, robot, gamedata"),
    ("pyfrc.tests.basic", "test_disabled", "control, fake_time, robot"),
    ("pyfrc.tests.basic", "test_operator_control", "control, fake_time, robot"),
    ("pyfrc.tests.basic", "test_practice", "control, fake_time, robot"),
    ("pyfrc.tests.fuzz_test", "test_fuzz", "hal_data, control, fake_time, robot"),
    ("pyfrc.tests.docstring_test", "ignore_object", "o, robot_path"),
    ("pyfrc.tests.docstring_test", "test_docstrings", "robot, robot_path"),
    ("pyfrc.test_support.pytest_plugin", "PyFrcPlugin", "robot_class, robot_file, robot_path"),
    ("pyfrc.test_support.pytest_plugin", "ThreadStillRunningError", None),
    ("pyfrc.test_support.controller", "TestController", "fake_time_inst"),
    ("pyfrc.test_support.controller", "TestController.get_mode", ""),
    ("pyfrc.test_support.controller", "TestController.run_test", "controller=None"),
    ("pyfrc.test_support.controller", "TestController.set_autonomous", "enabled=True"),
    ("pyfrc.test_support.controller", "TestController.set_operator_control", "enabled=True"),
    ("pyfrc.test_support.controller", "TestController.set_practice_match", ""),
    ("pyfrc.test_support.controller", "TestController.set_test_mode", "enabled=True"),
    ("pyfrc.test_support.fake_time", "FakeTime", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.get", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.increment_new_packet", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.increment_time_by", "time"),
    ("pyfrc.test_support.fake_time", "FakeTime.initialize", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.reset", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.set_time_limit", "time_limit"),
    ("pyfrc.test_support.fake_time", "TestEnded", None),
    ("pyfrc.test_support.fake_time", "TestFroze", None),
    ("pyfrc.test_support.fake_time", "TestRanTooLong", None),
]

FIXTURES = ["control", "fake_time", "hal_data", "robot", "robot_file", "robot_path", "wpilib"]


def find(module: str, name: str) -> Any:
    found: Any = importlib.import_module(module)
    for part in name.split("."):
        found = getattr(found, part)
    return found


def documented_part(signature: inspect.Signature, parameters: str) -> str:
    """As many of the leading parameters as are documented, written as the documentation writes them.

    What we add behind them must be optional, so that documented calls still work.
    """
    known = [p for p in signature.parameters.values() if p.name != "self"]
    count = len(parameters.split(",")) if parameters else 0
    for extra in known[count:]:
        assert extra.default is not inspect.Parameter.empty, (
            f"{extra.name} is an addition that callers would have to give"
        )
    return ", ".join(
        p.name if p.default is inspect.Parameter.empty else f"{p.name}={p.default!r}" for p in known[:count]
    )


@pytest.mark.parametrize(("module", "name", "parameters"), SPECIFICATION, ids=lambda value: str(value))
def test_documented_name(module: str, name: str, parameters: str | None) -> None:
    found = find(module, name)
    if parameters is not None:
        assert documented_part(inspect.signature(found), parameters) == parameters


@pytest.mark.parametrize("name", FIXTURES)
def test_documented_fixture(name: str) -> None:
    assert find("pyfrc.test_support.pytest_plugin", f"PyFrcPlugin.{name}") is not None


def test_star_import_gives_the_ready_made_tests() -> None:
    namespace: dict[str, Any] = {}
    exec("from pyfrc.tests import *", namespace)
    assert {name for name in namespace if name.startswith("test_")} == {
        "test_autonomous",
        "test_disabled",
        "test_operator_control",
        "test_practice",
    }


def test_the_ends_of_a_run_escape_a_blanket_except() -> None:
    """As documented, `except Exception` in robot code catches neither of the two."""
    for name in ("TestEnded", "TestRanTooLong"):
        ending = find("pyfrc.test_support.fake_time", name)
        assert issubclass(ending, BaseException)
        assert not issubclass(ending, Exception)
    assert issubclass(find("pyfrc.test_support.fake_time", "TestFroze"), Exception)


@pytest.mark.parametrize(("module", "name"), [(module, name) for module, name, _ in SPECIFICATION if "." not in name])
def test_it_is_the_same_object_as_in_the_core(module: str, name: str) -> None:
    assert find(module, name) is find(module.replace("pyfrc.", "pyfrc_core.", 1), name)
