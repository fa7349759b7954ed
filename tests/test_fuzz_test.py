"""The ready-made fuzz test: its inputs, that it is repeatable, and the script that it saves when a robot fails."""

from __future__ import annotations

import itertools
import json
import random
import re
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each

from pyfrc_core.fuzz.inputs.values import SPANS, InputKind, can_be, draw, nearest
from pyfrc_core.runtime.scripts.script import load_script

#: A robot with one of everything, which says at its end what it has seen.
EVERYTHING = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            ctre = wpilib.PneumaticsModuleType.CTREPCM
            self.pad = wpilib.XboxController(0)
            self.switch = wpilib.DigitalInput(0)
            self.lamp = wpilib.DigitalOutput(1)
            self.encoder = wpilib.Encoder(2, 3)
            self.absolute = wpilib.DutyCycleEncoder(4)
            self.potentiometer = wpilib.AnalogPotentiometer(2)
            self.analog_gyro = wpilib.AnalogGyro(0)
            self.gyro = wpilib.ADXRS450_Gyro()
            self.compressor = wpilib.Compressor(0, ctre)
            self.distribution = wpilib.PowerDistribution()
            self.chooser = wpilib.SendableChooser()
            self.chooser.setDefaultOption("Left", 1)
            self.chooser.addOption("Right", 2)
            wpilib.SmartDashboard.putData("Auto", self.chooser)
            wpilib.SmartDashboard.putNumber("Gain", 0.5)
    """

#: A user's test that fuzzes matches of 20 s and records the writes, for each seed.
FUZZ_TEST = """
    import json, random
    from pathlib import Path
    import pytest
    from pyfrc_core.fuzz.inputs.gamepads import find_gamepads
    from pyfrc_core.fuzz.inputs.finders import find_controls, find_sensors
    from pyfrc_core.config.settings import MatchSettings
    from pyfrc_core.fuzz.inputs.input_generator import InputGenerator
    from pyfrc_core.fuzz.inputs.match_plan import plan_match, without_restarts
    from pyfrc_core.fuzz.inputs.values import can_be
    from pyfrc_core.runtime.scripts.script import InputScript, Step
    from pyfrc_core.runtime.scripts.targets import Targets

    @pytest.mark.parametrize("seed", range(SEEDS))
    def test_fuzz_matches(seed, control, fake_time, hal_data, robot):
        run = fake_time.run
        rng = random.Random(seed)
        plan = without_restarts(plan_match(rng, 20, MatchSettings(), ("LRL", "RLR")))
        generator = InputGenerator(rng, run, plan=plan, seconds=20)
        targets, written, steps = Targets(hal_data), [], []

        def on_step(now):
            now_us = run.clock.now_us
            writes = generator.writes(now_us)
            steps.append(Step(now_us, writes))
            for target, value in writes.items():
                written.append((now_us, target, value))
                targets.write(target, value, now_us)
            targets.count_down(now_us)
            return not generator.over(now_us)

        on_step(0.0)
        control.run_test(on_step)
        Path(f"written-{seed}.json").write_text(json.dumps(written))
        inputs = [*find_controls(hal_data, find_gamepads(robot)), *find_sensors(hal_data)]
        kinds = {each.target: each for each in inputs}
        outside = [
            (target, value)
            for _, target, value in written
            if target in kinds and not can_be(kinds[target].kind, value, kinds[target].options)
        ]
        assert not outside
        InputScript(tuple(steps), run.clock.now_us).save(Path(f"script-{seed}.jsonl"))
    """

Written = list[tuple[int, str, object]]


def fuzz(make_project, seeds: int, robot: str = EVERYTHING, **env: str) -> list[Written]:
    """Return what the generator wrote in matches from the seeds 0, 1, ..."""
    test = FUZZ_TEST.replace("SEEDS", str(seeds))
    project = make_project({"robot.py": robot, "tests/test_fuzz_matches.py": test})
    result = project.run("test", env=env)
    assert result.code == 0, result.output
    files = [project.path / f"written-{seed}.json" for seed in range(seeds)]
    return [json.loads(file.read_text()) for file in files]


@pytest.fixture(scope="module")
def matches(make_shared_project) -> list[Written]:
    """What was written in some matches of a robot with one of everything."""
    return fuzz(make_shared_project, 8)


# -- which inputs are written -------------------------------------------------------------------------------------


@for_each(
    "target",
    [
        *(f"joysticks[0].axes[{axis}]" for axis in range(6)),
        *(f"joysticks[0].buttons[{button}]" for button in range(1, 11)),
        "joysticks[0].povs[0]",
        "joysticks[0].plugged",
        "dio[0].value",
        "encoder[0].count",
        "encoder[0].rate",
        'CAN["DutyCycle:DutyCycleEncoder[4]"].Position',
        "analog_in[2].voltage",
        "analog_gyro[0].angle",
        'CAN["Gyro:ADXRS450[0]"].angle_x',
        "pcm_compressor[0].pressure_switch",
        "power.vin_voltage",
        "pdp[0].voltage",
        "mode",
        "match_time",
        "alliance_station",
        "control.dsAttached",
        "event.game_specific_message",
        "nt:/SmartDashboard/Auto/selected",
    ],
)
def test_every_input_of_the_robot_is_written(target: str, matches: list[Written]) -> None:
    assert any(target == written for match in matches for _, written, _ in match)


def test_inputs_without_a_device_are_not_written(matches: list[Written]) -> None:
    """An output, an encoder's wire, a channel that the robot has not made, a gyro's wire."""
    written = {target for match in matches for _, target, _ in match}
    assert not written & {"dio[1].value", "dio[2].value", "dio[5].value", "analog_in[0].voltage"}


def values(matches: list[Written], pattern: str) -> set[object]:
    return {value for match in matches for _, target, value in match if re.fullmatch(pattern, target)}


@for_each(
    "pattern, low, high",
    [
        (r"joysticks\[0\]\.axes\[[0145]\]", -1, 1),
        (r"joysticks\[0\]\.axes\[[23]\]", 0, 1),  # an Xbox controller's triggers
        (r"analog_in\[2\]\.voltage", 0, 5),
        (r"CAN.*Position", 0, 1),
        (r"power\.vin_voltage", 4.5, 13.5),
        (r"encoder\[0\]\.count", -1e6, 1e6),
    ],
)
def test_numbers_are_those_of_real_devices(pattern: str, low: float, high: float, matches: list[Written]) -> None:
    found = values(matches, pattern)
    assert low <= min(found) < max(found) <= high
    assert any(low + (high - low) * 0.05 < value < low + (high - low) * 0.95 for value in found)


def test_povs_have_eight_directions_and_released(matches: list[Written]) -> None:
    assert values(matches, r"joysticks\[\d\]\.povs\[0\]") == {-1, 0, 45, 90, 135, 180, 225, 270, 315}


def test_choices_are_the_choosers_options(matches: list[Written]) -> None:
    assert values(matches, r"nt:/SmartDashboard/Auto/selected") == {"Left", "Right"}


def test_messages_are_those_of_the_game_or_as_long_or_none(matches: list[Written]) -> None:
    messages = values(matches, r"event\.game_specific_message")
    assert messages & {"LRL", "RLR"}
    assert {len(message) for message in messages} <= {0, 3}


def test_a_joystick_that_is_unplugged_stays_so_until_it_is_plugged_in(matches: list[Written]) -> None:
    """Writing to one of its controls would plug it in."""
    unplugged = 0
    for match in matches:
        gone = set()
        for _, target, value in match:
            port = target.partition(".")[0]
            if target.endswith(".plugged"):
                (gone.discard if value else gone.add)(port)
                unplugged += not value
            assert target.endswith(".plugged") or port not in gone
    assert unplugged


def test_modes_come_as_from_a_driver_station(matches: list[Written]) -> None:
    """Between two modes in which the robot is enabled, it is disabled; and some are left and entered again."""
    entered_again = 0
    for match in matches:
        modes = [value for _, target, value in match if target == "mode"]
        # The program may have been started again in the middle of the match.
        assert modes[0].startswith("disabled") or modes[0] in ("autonomous", "teleop")
        assert "teleop" in modes
        for before, after in itertools.pairwise(modes):
            assert before.startswith("disabled") or after.startswith("disabled")
        entered_again += any(before == after for before, after in zip(modes, modes[2:], strict=False))
    assert entered_again


def test_the_joysticks_of_the_robot_are_used_most(make_project) -> None:
    robot = """
    import commands2.button
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = commands2.button.CommandXboxController(3)
            self.held = {'sticks': [wpilib.Joystick(4)]}
            stick = wpilib.Joystick(5)
            self.read = lambda: stick.getY()
    """
    matches = fuzz(make_project, 4, robot=robot)
    ports = [target.partition(".")[0] for match in matches for _, target, _ in match if target.startswith("joysticks")]
    used = {f"joysticks[{port}]": ports.count(f"joysticks[{port}]") for port in (3, 4, 5)}
    assert min(used.values()) > 0.1 * len(ports)
    assert sum(used.values()) > 0.8 * len(ports)


# -- chance ----------------------------------------------------------------------------------------------------------


def test_the_same_seed_writes_the_same_whatever_python_hashes(make_shared_project, matches) -> None:
    assert fuzz(make_shared_project, 1, PYTHONHASHSEED="77") == matches[:1]
    assert matches[0] != matches[1] != matches[2]


@given(kind=st.sampled_from(get_args(InputKind)), seed=st.integers(0, 2**32), now=st.floats(-1e6, 1e6))
def test_what_is_drawn_can_be(kind: InputKind, seed: int, now: float) -> None:
    options = ("a", "b")
    value = draw(kind, random.Random(seed), options, now)
    assert can_be(kind, value, options)
    assert value == draw(kind, random.Random(seed), options, now)
    if kind in SPANS:
        assert can_be(kind, nearest(kind, now))


# -- physics ---------------------------------------------------------------------------------------------------------

SIMULATED = """
    import wpilib
    from wpilib.simulation import EncoderSim

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(0)
            self.driven, self.other = wpilib.Encoder(0, 1), wpilib.Encoder(2, 3)
            self.driven_sim = EncoderSim(self.driven)

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())

        def autonomousPeriodic(self):
            self.motor.set(0.5)

        def _simulationPeriodic(self):
            self.driven_sim.setCount(self.driven_sim.getCount() + round(self.motor.get() * 100))
    """


def test_inputs_that_physics_drives_are_left_to_it(make_project) -> None:
    """Also sensors that the test has not named."""
    (match,) = fuzz(make_project, 1, robot=SIMULATED)
    targets = {target for _, target, _ in match}
    assert "encoder[1].count" in targets
    assert not targets & {"encoder[0].count", "encoder[0].rate"}


# -- the test itself -------------------------------------------------------------------------------------------------

CHORD = """
    import random
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.switch = wpilib.DigitalInput(3)
            self.motor = wpilib.PWMSparkMax(0)

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY() * random.uniform(0.5, 1))
            if self.stick.getRawButton(2) and self.stick.getRawButton(3) and not self.switch.get():
                raise RuntimeError(f"an untested combination {random.random()}")
    """


def test_the_shortest_way_to_a_failure_is_kept_and_replayed(make_project) -> None:
    project = make_project({"robot.py": CHORD, "tests/fuzz_test.py": "from pyfrc.tests.fuzz_test import *\n"})
    result = project.run("test", "--seed", "3")
    assert result.code == 1
    assert re.search(r"robot\.py:13: RuntimeError: an untested combination [\d.]+", result.output), result.output
    assert "random seed: 3" in result.output
    file = re.search(r"pyfrc replay (\S+)", result.output)
    assert file is not None, result.output
    assert file[1] == str(Path(".pyfrc", "fuzz", "seed-3.jsonl"))
    script = load_script(project.path / file[1])
    writes = {target: value for step in script.steps for target, value in step.writes.items()}
    assert writes == {
        "mode": "teleop",
        "joysticks[0].buttons[2]": True,
        "joysticks[0].buttons[3]": True,
        "dio[3].value": False,
    }
    assert re.search(r"at [\d.]+ s teleoperated begins: .*", result.output), result.output
    failed = re.search(r"at [\d.]+ s: (robot\.py:13: RuntimeError: .*)", result.output)
    assert failed is not None, result.output
    replayed = project.run("replay", file[1])
    assert replayed.code == 1
    assert f"then {failed[1]}\n" in replayed.output  # with the very number
    assert (project.path / ".pyfrc/.gitignore").read_text() == "*\n"


@pytest.mark.slow
def test_a_robot_without_a_fault_passes_and_leaves_nothing(make_project) -> None:
    project = make_project({"robot.py": EVERYTHING, "tests/pyfrc_test.py": "from pyfrc.tests import *\n"})
    result = project.run("test", "--", "-v")
    assert result.code == 0, result.output
    assert result.outcomes()["tests/pyfrc_test.py::test_fuzz"] == "PASSED"
    left = {path.name for path in (project.path / ".pyfrc").iterdir()}
    assert left == {".gitignore", "passes.json"}, "what every run of the tests writes"


def test_sensors_of_vendors_have_plausible_ranges(make_project) -> None:
    """A SPARK's temperature is not any number, and the voltage of its analog sensor not that of a battery."""
    robot = """
        import hal
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.spark = hal.SimDevice("SPARK MAX [3]")
                self.analog = hal.SimDevice("SPARK MAX [3] ANALOG SENSOR")
                measured = hal.SimDevice.Direction.kInput
                self.values = [
                    self.spark.createInt("Motor Temperature", measured, 25),
                    self.spark.createDouble("Bus Voltage", measured, 12.0),
                    self.analog.createDouble("Voltage", measured, 0.0),
                ]
    """
    test = """
        from pyfrc_core.fuzz.inputs.finders import find_sensors

        def test_it(control, hal_data, robot):
            with control.run_robot():
                control.step_timing(seconds=0.1, autonomous=False, enabled=False)
                kinds = {each.target: each.kind for each in find_sensors(hal_data)}
            assert kinds['CAN["SPARK MAX [3]"]["Motor Temperature"]'] == "celsius"
            assert kinds['CAN["SPARK MAX [3]"]["Bus Voltage"]'] == "battery"
            assert kinds['CAN["SPARK MAX [3] ANALOG SENSOR"].Voltage'] == "volts"
    """
    result = make_project({"robot.py": robot, "tests/test_inputs.py": test}).run("test")
    assert result.code == 0, result.output
