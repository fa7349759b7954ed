"""The order of a set of commands, subsystems or devices is the same in every run."""

from __future__ import annotations

import importlib
import json
import re

import pytest
from conftest import MakeProject
from skips import missing_python, require

from pyfrc_core.runtime.patches.object_hashes import hash_by_number, patches, restart_numbers

#: Its sets are large: without numbers, two runs practically never have the same order.
ROBOT = """
import commands2
import wpilib


class Noted(commands2.Command):
    def __init__(self, number, order):
        super().__init__()
        self.number, self.order = number, order

    def initialize(self):
        self.order.append(self.number)


class Arm(commands2.Subsystem):
    pass


class Robot(commands2.TimedCommandRobot):
    def robotInit(self):
        arms = [Arm() for _ in range(20)]
        holds = [arm.run(lambda: None) for arm in arms]
        self.order = []
        race = commands2.ParallelRaceGroup(*(Noted(number, self.order) for number in range(40)))
        commands2.CommandScheduler.getInstance().schedule(race.ignoringDisable(True))
        print("commands", self.order)
        print("requirements", [arms.index(arm) for arm in commands2.ParallelRaceGroup(*holds).getRequirements()])
        print("devices", [device.getChannel() for device in {wpilib.DigitalInput(channel) for channel in range(10)}])
"""

TEST = """
import pytest

@pytest.mark.parametrize("run", [1, 2])
def test_orders(control, robot, run):
    with control.run_robot():
        control.step_timing(seconds=0.1, autonomous=False, enabled=False)
"""


@pytest.mark.parametrize(
    "args",
    [(), pytest.param(("--isolation", "reuse"), marks=pytest.mark.slow)],
    ids=["isolated", "reused"],
)
def test_each_run_has_the_same_order(make_project: MakeProject, args: tuple[str, ...]) -> None:
    project = make_project({"robot.py": ROBOT, "tests/orders_test.py": TEST})
    result = project.run("test", *args, "--", "-s")
    for what, count in (("commands", 40), ("requirements", 20), ("devices", 10)):
        found = [json.loads(order) for order in re.findall(rf"{what} (\[.*\])", result.stdout)]
        assert found == [list(range(count))] * 2, result.output


@pytest.fixture
def numbered() -> type:
    """A class whose objects are hashed by their numbers."""
    restart_numbers()
    return type("Numbered", (), {"__hash__": hash_by_number})


def test_an_object_keeps_its_number(numbered: type) -> None:
    first, second = numbered(), numbered()
    assert [hash(first), hash(second), hash(first)] == [0, 1, 0]
    restart_numbers()
    third = numbered()
    assert [hash(third), hash(second)] == [0, 1]
    assert len({first, second, third}) == 3


@pytest.mark.parametrize(
    "names",
    [
        "commands2.Command",
        "commands2.Subsystem",
        "wpilib.DigitalInput",
        "wpilib.Field2d",
        "wpilib.TimedRobot",
        *(pytest.param(each, marks=pytest.mark.season_2026) for each in ("navx.AHRS", "rev.SparkMax")),
    ],
)
def test_it_is_the_base_of_wpilibs_and_vendors_classes(names: str) -> None:
    module, _, name = names.partition(".")
    require("sets of vendors' devices", missing_python() if module in ("navx", "rev") else [])
    cls = getattr(importlib.import_module(module), name)
    assert any(issubclass(cls, each.owner) and cls.__hash__ is each.owner.__hash__ for each in patches()), (
        "sets of these have another order in each run"
    )
