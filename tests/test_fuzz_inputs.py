"""The inputs that `pyfrc fuzz` varies: code for each kind, which fails when it meets a certain value."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from types import FunctionType
from typing import Any

import ntcore
import pytest
from conftest import sampled

from pyfrc_core.errors import UsageError
from pyfrc_core.fuzz.guidance.seed_schedule import SeedSchedule
from pyfrc_core.fuzz.inputs.drivers import MODELS
from pyfrc_core.fuzz.inputs.match_plan import FieldData
from pyfrc_core.fuzz.inputs.network_values import NetworkRead, NetworkValues
from pyfrc_core.fuzz.inputs.robot_constants import find_constants
from pyfrc_core.fuzz.inputs.values import UNKNOWN, RobotConstants, can_be
from pyfrc_core.hal import HalData
from pyfrc_core.runtime.scripts.network_targets import entry_target, parse_entry_target
from pyfrc_core.runtime.scripts.script import load_script
from pyfrc_core.runtime.scripts.targets import Targets

#: Robots have such a class for each kind of input: its `look` fails when it meets a certain value.
CLASS = """
    class Kind{number}:
        def __init__(self, pad):
            self.pad = pad
            self.network = ntcore.NetworkTableInstance.getDefault()
            self.camera = self.network.getTable("limelight")
            {first}

        def look(self):
            {then}
    """

ROBOT = """
    import ntcore
    import wpilib
    from wpilib import DriverStation, Preferences, RobotController, SmartDashboard
    from wpimath.geometry import Pose2d
    {classes}
    KINDS = {kinds}

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            pad = wpilib.XboxController(0)
            self.kinds = [kind(pad) for kind in KINDS]

        def teleopPeriodic(self):
            for kind in self.kinds:
                {look}
    """

#: Notes which kinds have failed, and goes on.
NOTES = """try:
                    kind.look()
                except Exception:
                    open(f"met {type(kind).__name__}", "w").close()"""

#: What is in a class: a line of its `__init__`, and one of `look`.
KINDS = {
    "a camera's numbers": (
        "pass",
        "if self.camera.getNumber('tv', 0) == 1 and self.camera.getNumber('tx', 0) < -20: raise ValueError",
    ),
    "a camera's array": (
        "pass",
        "if self.pad.getAButton(): self.camera.getEntry('botpose').getDoubleArray([0.0] * 6)[5]",
    ),
    "a subscription to a string": (
        "self.state = self.network.getStringTopic('/vision/state').subscribe('idle')",
        "if self.state.get() == 'LOCKED' and self.pad.getBButton(): raise ValueError",
    ),
    "a subscription to an integer": (
        "self.count = self.network.getIntegerTopic('/vision/count').subscribe(0)",
        "if self.count.get() > 12: raise ValueError",
    ),
    "a subscription to a struct": (
        "self.pose = self.network.getStructTopic('/vision/pose', Pose2d).subscribe(Pose2d())",
        "if self.pose.get().x > 8: raise ValueError",
    ),
    "a pose that is not a number": (
        "self.pose = self.network.getStructTopic('/vision/second', Pose2d).subscribe(Pose2d())",
        "round(self.pose.get().x)",
    ),
    "a latency that jumps": (
        "self.history = list(range(100))",
        "self.history[-1 - int(self.camera.getNumber('tl', 0.0) / 20)]",
    ),
    "pulses that are counted": (
        "self.balls = wpilib.Counter(5)",
        "if self.balls.get() > 1: raise ValueError",
    ),
    "a preference, read once": (
        "self.demo = Preferences.getBoolean('demo', False)",
        "if self.demo: raise ValueError",
    ),
    "a preference that is 0": (
        "Preferences.initDouble('divider', 4.0)",
        "1 / Preferences.getDouble('divider', 4.0)",
    ),
    "a number of the dashboard that was 0": (
        "SmartDashboard.putNumber('trim', 0.0)",
        "if SmartDashboard.getNumber('trim', 0.0) > 0.3: raise ValueError",
    ),
    "a number beside constants": (
        "SmartDashboard.putNumber('speed', 1.0)",
        "if 3.2 < SmartDashboard.getNumber('speed', 1.0) < 3.4: raise ValueError",
    ),
    "a string of the dashboard": (
        "SmartDashboard.putString('side', 'none')",
        "if SmartDashboard.getString('side', 'none') == 'left': raise ValueError",
    ),
    "a distance beside constants": (
        "self.lift = wpilib.Encoder(0, 1); self.lift.setDistancePerPulse(0.005)",
        "if 10.0 <= self.lift.getDistance() <= 10.05: raise ValueError",
    ),
    "an absolute encoder that begins again": (
        "self.absolute, self.last = wpilib.DutyCycleEncoder(4), 0.5",
        "now = self.absolute.get(); before, self.last = self.last, now; 1 / (not before > 0.97 > 0.03 > now)",
    ),
    "a wheel that stands still at a rate": (
        "self.wheel, self.last, self.still = wpilib.Encoder(6, 7), 0, 0",
        "stands = self.wheel.getRate() and self.wheel.get() == self.last;"
        " self.last, self.still = self.wheel.get(), self.still + 1 if stands else 0;"
        " 1 / (self.still < 12)",
    ),
    "a switch that is closed at first and stays so": (
        "self.switch, self.opened, self.loops = wpilib.DigitalInput(3), False, 0",
        "self.opened |= self.switch.get(); self.loops += 1; 1 / (self.opened or self.loops < 30)",
    ),
    "an entry of another type than the code reads": (
        "self.gain = SmartDashboard.getNumber('gain', 1.0)",
        "if not SmartDashboard.putNumber('gain', 2.0): raise ValueError",
    ),
    "the controller's temperature": ("pass", "if RobotController.getCPUTemp() > 80: raise ValueError"),
    "a brown-out": ("pass", "if RobotController.isBrownedOut(): raise ValueError"),
    "the controller's comment": (
        "self.is_practice = RobotController.getComments() == 'practice'",
        "if self.is_practice: raise ValueError",
    ),
    "time that is not counted": ("pass", "if DriverStation.getMatchTime() < 0: raise ValueError"),
    "an event's name": ("pass", "if 'casj' in DriverStation.getEventName(): raise ValueError"),
    "a joystick with few axes": ("pass", "if 0 < self.pad.getAxisCount() < 5: raise ValueError"),
    "a button that most joysticks lack": ("pass", "if self.pad.getRawButton(14): raise ValueError"),
}


def robot(*kinds: tuple[str, str], look: str = "kind.look()") -> str:
    classes = [CLASS.format(number=number, first=first, then=then) for number, (first, then) in enumerate(kinds)]
    names = ", ".join(f"Kind{number}" for number in range(len(kinds)))
    return ROBOT.format(classes="".join(classes), kinds=f"[{names}]", look=look)


#: Met in the first matches only, or seldom beside the constants of other code: each has a robot of its own.
ALONE = ("an entry of another type than the code reads", "a number beside constants")
#: Met at a start only, by a text of the code, or while a camera measures nothing else: sooner beside few others.
RARE = (
    "a latency that jumps",
    "a preference, read once",
    "a string of the dashboard",
    "an event's name",
    "the controller's comment",
)
#: Met in long matches.
LONG = ("an absolute encoder that begins again",)

#: Numbers of matches, each of another campaign: few matches meet some kinds, and those of another Python are others.
RUNS = ("8", "24", "24", "24", "24", "24")


@pytest.mark.parametrize("kind", sampled(["a preference that is 0", *ALONE], "a preference that is 0"))
def test_what_a_kind_of_input_finds_fails_again_in_a_replay(kind: str, make_project: Any) -> None:
    settings = "[tool.pyfrc.fuzz]\nmatch_seconds = 5\n"
    project = make_project({"robot.py": robot(KINDS[kind]), "pyproject.toml": settings})
    campaigns = (project.run("fuzz", "--seed", str(seed), "--runs", runs) for seed, runs in enumerate(RUNS, 1))
    assert any(result.code == 1 for result in campaigns)
    (file,) = (project.path / "tests/fuzz").glob("*.jsonl")
    assert sum(len(step.writes) for step in load_script(file).steps) <= 5


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kinds", "seconds"),
    [(RARE, 5), (LONG, 15), ([kind for kind in KINDS if kind not in ALONE + RARE + LONG], 5)],
    ids=["rare", "in long matches", "the others"],
)
def test_each_kind_of_input_is_varied(kinds: Sequence[str], seconds: int, make_project: Any) -> None:
    """Of another Python, the matches are others: more campaigns are played until each kind was met."""
    code = robot(*(KINDS[kind] for kind in kinds), look=NOTES)
    settings = f"[tool.pyfrc.fuzz]\nmatch_seconds = {seconds}\n"
    project = make_project({"robot.py": code, "pyproject.toml": settings})
    missing = list(kinds)
    for seed, runs in enumerate(RUNS, 1):
        result = project.run("fuzz", "--seed", str(seed), "--runs", runs)
        assert result.code == 0, result.output
        missing = [kind for number, kind in enumerate(kinds) if not (project.path / f"met Kind{number}").exists()]
        if not missing:
            break
    assert missing == []


#: What is no input.
NO_INPUTS = {
    "a list that the program publishes": (
        "SmartDashboard.putNumberArray('states', [0.0] * 8)",
        "SmartDashboard.putNumberArray('states', [1.0] * 8); SmartDashboard.getNumberArray('states', [0.0] * 8)[7]",
    ),
    "a list that is read before the program publishes it": (
        "SmartDashboard.getNumberArray('early', [0.0] * 8)[7]; SmartDashboard.putNumberArray('early', [0.0] * 8)",
        "SmartDashboard.getNumberArray('early', [0.0] * 8)[7]",
    ),
    "a number that the program writes all the time": (
        "SmartDashboard.putNumber('loops', 0.0)",
        "loops = SmartDashboard.getNumber('loops', 0.0); 1 / (loops >= 0);"
        " SmartDashboard.putNumber('loops', loops + 1)",
    ),
    "telemetry that no one reads": (
        "SmartDashboard.putNumber('speed', 1.0); SmartDashboard.putBoolean('ready', True)",
        "1 / (self.network.getEntry('/SmartDashboard/speed').getValue().value() == 1.0)",
    ),
}

SIMULATED = """
        def simulationPeriodic(self):
            if ntcore.NetworkTableInstance.getDefault().getTable("limelight").getNumber('tv', 0) == 1: raise ValueError
    """


@pytest.mark.slow
def test_what_the_program_publishes_or_only_simulations_read_is_no_input(make_project: Any) -> None:
    files = {
        "robot.py": robot(*NO_INPUTS.values()) + SIMULATED,
        "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 5\n",
    }
    result = make_project(files).run("fuzz", "--seed", "1", "--runs", "24")
    assert result.code == 0, result.output


# -- values ------------------------------------------------------------------------------------------------------------


def drawn(read: NetworkRead, before: Any, setting: bool, constants: RobotConstants = UNKNOWN) -> list[Any]:
    values = NetworkValues(random.Random(1), constants)
    found = [values.draw(read, before, setting) for _ in range(300)]
    assert all(can_be("entry", value) for value in found)
    again = NetworkValues(random.Random(1), constants)
    assert found == [again.draw(read, before, setting) for _ in range(300)]
    return found


def test_a_pose_that_a_camera_cannot_compute_is_not_a_number() -> None:
    assert ("nan",) * 3 in drawn(NetworkRead("/vision/robot", "struct:Pose2d"), None, False)
    assert ("nan",) * 6 in drawn(NetworkRead("/vision/botpose", "double[]"), [0.0] * 6, False)
    for name, type_name, setting in (
        ("/limelight/botpose", "double[]", False),
        ("/vision/corners", "double[]", False),
        ("/vision/speeds", "struct:ChassisSpeeds", False),
        ("/SmartDashboard/pose", "double[]", True),
    ):
        found = drawn(NetworkRead(name, type_name), [1.0] * 3, setting)
        assert not any("nan" in value for value in found)


def test_what_the_field_says() -> None:
    found = [FieldData(random.Random(seed)) for seed in range(300)]
    late = [each.later[0] for each in found if each.at_start["alliance_station"] == "unknown" and each.later]
    assert min(late) < 0.5
    assert max(late) > 10
    assert {each.at_start.get("event.name") for each in found} >= {None, "", "CASJ"}
    assert {each.at_start.get("event.match_type") for each in found} == {
        None, "practice", "qualification", "elimination"
    }  # fmt: skip
    assert any(not each.counts for each in found)
    assert all(each.counts for each in found if "control.fmsAttached" in each.at_start)


# -- constants ---------------------------------------------------------------------------------------------------------

TOP = 42.5
HEIGHTS = {"low": 0.3, "high": 1.7}


def decide(value: float) -> str:
    """Return which of the heights it is."""
    if value > TOP or value == 77:
        return "above"
    return min(HEIGHTS, key=lambda name: abs(HEIGHTS[name] - value) + 0.125)


def test_constants_are_those_that_functions_use() -> None:
    assert isinstance(decide, FunctionType)
    found = find_constants([decide])
    assert {42.5, 0.3, 1.7, 0.125} <= set(found.numbers)
    assert {"above", "low", "high"} <= set(found.texts)
    assert not any("heights" in text for text in found.texts)
    assert found.compared == (77.0,)
    assert found.asks("abs", "nothing")
    assert not found.asks("nothing")


def test_numbers_near_constants_are_in_their_range_and_mostly_compared_ones() -> None:
    constants = RobotConstants((0.5, 8.2, 11.0, 5000.0), (8.2,))
    found = [constants.near(random.Random(seed), 4.5, 13.5) for seed in range(300)]
    inside = [each for each in found if each is not None]
    assert 4.5 <= min(inside) < max(inside) <= 13.5
    assert len(inside) > 200  # the others were negated
    assert sum(abs(each - 8.2) < 0.9 for each in inside) > sum(abs(each - 11.0) < 1.2 for each in inside) > 20
    assert constants.near(random.Random(1), 20.0, 30.0) is None


def test_of_a_gyro_what_code_reads_changes_most() -> None:
    constants = RobotConstants(names=frozenset({"getRotation2d", "setPitchLimit"}))
    asked = [name for name in ("Yaw", "Pitch", "Roll", "CompassHeading", "rawYaw") if constants.asks_for(name)]
    assert asked == ["Yaw", "Pitch", "rawYaw"]


def test_a_joystick_that_is_plugged_in_says_how_many_controls_it_has() -> None:
    for model in MODELS:
        writes = model.writes(1)
        counts = [writes[f"joysticks[1].{sort}_count"] for sort in ("axis", "button", "pov")]
        assert counts == [model.axes, model.buttons, model.povs]


def test_the_robots_own_random_numbers_differ_between_matches() -> None:
    seeds = [SeedSchedule(((0, f"fuzz 1 {number}"), (20_000, "other"))).robot_seed for number in range(50)]
    assert len(set(seeds)) > 45
    assert SeedSchedule(((0, "fuzz 1 7"),)).robot_seed == seeds[7]  # one that continues it begins in the same way


# -- targets -----------------------------------------------------------------------------------------------------------


def test_entries_have_the_type_that_the_target_names() -> None:
    targets, network = Targets(HalData()), ntcore.NetworkTableInstance.getDefault()
    for target, value, type_name in (
        ("nt:int:/typed/id", 3, "int"),
        ("nt:double[]:/typed/pose", (), "double[]"),
        ("nt:string[]:/typed/names", ["a"], "string[]"),
        ("nt:struct:Pose2d:/typed/at", [1.0, 2.0, 0.5], "struct:Pose2d"),
        ("nt:double[]:/typed/unknown", ["nan", 1.0], "double[]"),
        ("nt:/typed/plain", 3, "double"),
        ("nt:typed/plain", 3, "double"),
        ("nt:struct:Rotation2d:typed_without_slash", [0.5], "struct:Rotation2d"),
        ("nt:double[]:typed/without slash", (1.0,), "double[]"),
    ):
        targets.write(target, value, 0)
        name, named = parse_entry_target(target)
        assert network.getTopic(name).getTypeString() == type_name
        assert named in ("", type_name)
        assert entry_target(name, named) == target
    assert math.isnan(network.getEntry("/typed/unknown").getDoubleArray([])[0])
    with pytest.raises(UsageError, match=r"/typed/id is int, and cannot be 'x'"):
        targets.write("nt:int:/typed/id", "x", 0)
    with pytest.raises(UsageError, match="NetworkTables has no type 'whole'"):
        targets.write("nt:whole:/typed/other", 1, 0)
