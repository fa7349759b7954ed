"""The modules from elsewhere than Python and its packages: found once, and looked up again at each look."""

from __future__ import annotations

import json
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.project import loaded_modules as module_under_test
from pyfrc_core.project.loaded_modules import LoadedModules


@pytest.fixture
def modules(monkeypatch: pytest.MonkeyPatch) -> dict[str, ModuleType]:
    """What takes the place of `sys.modules` in a test."""
    made: dict[str, ModuleType] = {}
    monkeypatch.setattr(module_under_test, "sys", SimpleNamespace(modules=made))
    return made


def module(name: str, file: str | None) -> ModuleType:
    made = ModuleType(name)
    if file is not None:
        made.__file__ = file
    return made


def names(loaded: LoadedModules) -> list[str]:
    return [each.__name__ for each in loaded.look()]


def test_python_its_packages_and_pyfrc_are_left_out(modules: dict[str, ModuleType]) -> None:
    for name, file in [
        ("json", json.__file__),
        ("wpilib", "/usr/lib/python3/site-packages/wpilib/__init__.py"),
        ("apt", "/usr/lib/python3/dist-packages/apt.py"),
        ("built_in", None),
        ("relative", "robot.py"),
        ("robot", "/home/team/robot.py"),
        ("teamlib", "/home/team/lib/teamlib.py"),
        ("pyfrc_core.project", module_under_test.__file__),
    ]:
        modules[name] = module(name, file)
    for odd in (Path("/home/team/odd.py"), "", "a\0b"):
        modules[f"odd {odd}"] = module("odd", odd)  # type: ignore[arg-type]
    loaded = LoadedModules()
    assert names(loaded) == ["robot", "teamlib"]
    assert loaded.files_of_pyfrc() == [module_under_test.__file__]


def test_a_thread_that_imports_during_a_look_does_no_harm(monkeypatch: pytest.MonkeyPatch) -> None:
    class Growing(dict[str, ModuleType]):
        """Modules to which another thread adds one while they are looked at for the first time."""

        def items(self) -> Any:
            if len(self) == 1:
                self["late"] = module("late", "/home/team/late.py")
                raise RuntimeError("dictionary changed size during iteration")
            return super().items()

    made = Growing(robot=module("robot", "/home/team/robot.py"))
    monkeypatch.setattr(module_under_test, "sys", SimpleNamespace(modules=made))
    assert names(LoadedModules()) == ["robot", "late"]
