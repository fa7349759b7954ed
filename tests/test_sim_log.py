"""`pyfrc sim --log`: the inputs of a log drive today's code, and where the two differ first."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from browser_pages import opened_page
from conftest import MakeProject, RobotProject
from loops import for_each
from sim_robots import PATIENCE
from test_sim_source import Elsewhere
from web_pages import Served, served_source
from wpiutil import DataLogWriter
from wpiutil.log import BooleanLogEntry, DoubleArrayLogEntry, DoubleLogEntry, StringLogEntry
from written_logs import a_match

from pyfrc_core.project import find_project
from pyfrc_core.runtime.scripts.inputs_file import load_inputs
from pyfrc_core.runtime.scripts.script import InputScript
from pyfrc_core.season import CURRENT
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.engine.changes import Change, RunBegan
from pyfrc_core.sim.engine.past_run import Comparison, PastRun
from pyfrc_core.sim.engine.scene import Scene
from pyfrc_core.sim.engine.snapshot import Snapshot
from pyfrc_core.sim.engine.source import Abilities
from pyfrc_core.sim.engine.value_history import ValueHistory
from pyfrc_core.sim.log_report import LogReport
from pyfrc_core.sim.log_run import LogRun, log_run
from pyfrc_core.sim.ui.web.differences import FirstDifference

if TYPE_CHECKING:
    from playwright.sync_api import Browser

ROBOT = """
    import wpilib

    GAIN = 0.5

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.pad = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(0)
            self.lift = wpilib.PWMSparkMax(1)
            self.encoder = wpilib.Encoder(0, 1)
            self.height = wpilib.AnalogInput(0)
            self.far = wpilib.AnalogInput(1)
            wpilib.SmartDashboard.setDefaultNumber("kP", 1.0)

        def teleopPeriodic(self):
            self.motor.set(-self.pad.getRawAxis(1))
            setpoint = GAIN if self.pad.getRawButton(2) else 0.0
            wpilib.SmartDashboard.putNumber("Elevator/setpoint", setpoint)
            kP = wpilib.SmartDashboard.getNumber("kP", 1.0)
            self.lift.set(kP * (setpoint - self.height.getVoltage()) + self.encoder.get() / 1000)

        def disabledInit(self):
            self.motor.set(0)
            self.lift.set(0)
"""
PHYSICS = """
    class PhysicsEngine:
        def __init__(self, physics_controller):
            self.turns = 0.0

        def update_sim(self, hal_data, now, tm_diff):
            self.turns += hal_data["pwm"][0]["value"] * SPEED
            hal_data["encoder"][0]["count"] = int(self.turns)
            hal_data["analog_in"][0]["voltage"] = 0.25 if now >= 2 else 0.0

    SPEED = 1.0
"""
DRIVEN = """{"format": "pyfrc-input 1", "end": 4.0}
{"t": 1.0, "set": {"mode": "teleop"}}
{"t": 1.5, "set": {"joysticks[0].axes[1]": -0.6}}
{"t": 2.5, "set": {"joysticks[0].buttons[2]": true}}
{"t": 3.5, "set": {"mode": "disabled"}}
"""
SIM = ("sim", "--ui", "none")


def log_of(project: RobotProject, *arguments: str) -> str:
    """Return what `pyfrc sim --log` says."""
    result = project.run(*SIM, "--log", *arguments)
    assert result.code == 0, result.output
    return result.stdout


def rounded(said: str) -> str:
    """Return a text with its numbers rounded to one digit, since PWM outputs are in microseconds."""
    return re.sub(r"\b\d\.\d{3,}", lambda found: f"{float(found[0]):.1f}", said)


def change(project: RobotProject, file: str, old: str, new: str) -> None:
    place = project.path / file
    text = place.read_text(encoding="utf-8")
    assert old in text
    place.write_text(text.replace(old, new), encoding="utf-8")


@pytest.fixture(scope="module")
def recording(make_shared_project: MakeProject) -> RobotProject:
    """Return a project with a drive that was recorded in both forms, which tests do not change."""
    project = make_shared_project({"robot.py": ROBOT, "physics.py": PHYSICS, "drive.jsonl": DRIVEN})
    files = ("--record", "match.jsonl", "--wpilog", "match.wpilog")
    result = project.run(*SIM, "--script", "drive.jsonl", *files)
    assert result.code == 0, result.output
    return project


@pytest.fixture
def recorded(recording: RobotProject, make_project: MakeProject) -> RobotProject:
    """Return a copy of it."""
    project = make_project({})
    project.copy(recording.path)
    return project


def test_unchanged_code_does_the_same_and_changed_code_differs_where_the_change_acts(recorded: RobotProject) -> None:
    said = log_of(recorded, "match.wpilog")
    assert "no difference: " in said
    assert "exactly the same" in said
    change(recorded, "robot.py", "GAIN = 0.5", "GAIN = 0.75")
    said = log_of(recorded, "match.wpilog")
    assert "differs first at 0:02.50, in Elevator/setpoint: " in said  # the button is pressed with this packet
    assert "pwm[1].value" in said
    from_log = "analog_in[0], analog_in[1], dio[0], dio[1], encoder[0], fpga_button, power"
    assert f"sensors from the log, whatever today's code does: {from_log}" in said


def test_sensors_measure_what_they_measured_in_the_log(recorded: RobotProject) -> None:
    change(recorded, "physics.py", "SPEED = 1.0", "SPEED = 7.0")
    assert "no difference: " in log_of(recorded, "match.wpilog", "--record", "again.jsonl")
    # The recording has them, too.
    result = recorded.run("replay", "again.jsonl")
    assert result.code == 0, result.output
    writes = [target for step in load_inputs(recorded.path / "again.jsonl").steps for target in step.writes]
    assert "hold:encoder[0].count" in writes
    said = log_of(recorded, "match.wpilog", "--sensors", "physics")
    assert "differs first at 0:01." in said
    assert "sensors from physics: analog_in[0], encoder[0]\n" in said
    assert "sensors from the log" not in said


SIMULATED = """
    import commands2
    import wpilib
    from wpilib.simulation import EncoderSim

    STEP = 2

    class Lift(commands2.Subsystem):
        def __init__(self):
            super().__init__()
            self.encoder = wpilib.Encoder(0, 1)
            self.simulated = EncoderSim(self.encoder)
            self.turns = 0

        def periodic(self):
            wpilib.SmartDashboard.putNumber("in periodic", self.encoder.get())

        def simulationPeriodic(self):
            self.turns += STEP
            self.simulated.setCount(self.turns)

    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.lift = Lift()
            encoder = self.lift.encoder
            show = commands2.cmd.run(lambda: wpilib.SmartDashboard.putNumber("in a command", encoder.get()), self.lift)
            self.lift.setDefaultCommand(show.ignoringDisable(True))
"""


@pytest.mark.slow
def test_commands_see_the_sensors_of_the_log_whatever_a_subsystem_simulates(make_project: MakeProject) -> None:
    project = make_project({"robot.py": SIMULATED})
    assert project.run(*SIM, "--mode", "teleop", "--seconds", "0.5", "--wpilog", "match.wpilog").code == 0
    change(project, "robot.py", "STEP = 2", "STEP = 7")
    said = log_of(project, "match.wpilog")
    assert "no difference: " in said
    assert "encoder[0]" in said.partition("sensors from the log")[2]


WRIST = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            wpilib.DataLogManager.start()
            wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
            self.wrist = wpilib.DutyCycleEncoder(8)

        def robotPeriodic(self):
            wpilib.SmartDashboard.putNumber("wrist", self.wrist.get())

        def disabledInit(self):
            print("wrist", self.wrist.get())
"""
TURNING = """
    from wpilib.simulation import DutyCycleEncoderSim

    class PhysicsEngine:
        def __init__(self, physics_controller):
            pass

        def update_sim(self, hal_data, now, tm_diff):
            DutyCycleEncoderSim(8).set(now % 1)
"""


@pytest.mark.slow
def test_a_sensor_can_freeze_in_the_match_of_a_log(make_project: MakeProject) -> None:
    """As `docs/how_to/compare_with_a_log.md` says: the log as a script, to which a line is added."""
    guide = (Path(__file__).parents[1] / "docs/how_to/compare_with_a_log.md").read_text("utf-8")
    (line,) = re.findall(r"^```json\n(.*)\n```$", guide, re.MULTILINE)
    project = make_project({"robot.py": WRIST, "physics.py": TURNING, "drive.jsonl": DRIVEN})
    assert project.run(*SIM, "--script", "drive.jsonl").code == 0
    (log,) = (project.path / ".pyfrc" / "logs").glob("*.wpilog")
    result = project.run("-v", *SIM, "--log", str(log), "--record", "frozen.jsonl")
    path = 'CAN["DutyCycle:DutyCycleEncoder[8]"].Position'
    assert f"  {path}\n" in result.stdout.partition("sensors from physics:\n")[2].partition(":\n")[0]
    assert path in json.loads(line)["set"].popitem()[0]
    script = project.path / "frozen.jsonl"
    head, *steps = script.read_text("utf-8").splitlines()
    steps = sorted([*steps, line], key=lambda step: json.loads(step)["t"])
    script.write_text("\n".join([head, *steps]), "utf-8")
    result = project.run(*SIM, "--script", "frozen.jsonl")
    assert result.code == 0, result.output
    assert result.stdout.count("wrist 0.25\n") == 1  # at the end; at the beginning, it has not frozen


def test_a_log_that_is_cut_says_so(recorded: RobotProject) -> None:
    log, trace = recorded.path / "match.wpilog", recorded.path / "match.trace.jsonl"
    log.write_bytes(log.read_bytes()[:-2])
    assert log_of(recorded, "match.wpilog").count("match.wpilog: it is cut at byte") == 1
    trace.write_bytes(trace.read_bytes()[:-70])  # within its last change: the hash has a line of its own
    cut = log_run(find_project(recorded.path), recorded.path / "match.jsonl")
    assert re.fullmatch(r"line \d+ is cut", cut.script.problem)
    result = recorded.run("replay", "match.jsonl")
    assert result.code == 2
    assert re.match(r"match.trace.jsonl:\d+: this trace is cut or damaged", result.first_error)


REPLAYING = """
    from pathlib import Path

    def test_the_match(control, robot):
        control.replay(Path(__file__).with_name("match.wpilog"))
"""


def test_a_log_of_another_year_says_so(make_project: MakeProject) -> None:
    project = make_project({"robot.py": PUBLISHING, "tests/replay_test.py": REPLAYING})
    year = CURRENT.year - 1
    log = a_match()
    log.values("systemTime", "int64", "q", (5, round(datetime(year, 3, 7, tzinfo=timezone.utc).timestamp() * 1e6)))
    log.save(project.path / "match.wpilog")
    log.save(project.path / "tests" / "match.wpilog")
    sentence = f"match.wpilog is of {year}, and WPILib {CURRENT.year} is installed here: the field, devices and"
    assert project.run("replay", "match.wpilog").stdout.startswith(sentence)
    tested = project.run("test")
    assert tested.code == 0, tested.output
    assert sentence in tested.stdout.replace("\n", " ")
    script = DRIVEN.replace('"end": 4.0', f'"end": 4.0, "packages": {{"wpilib": "{year}.3.1"}}')
    (project.path / "drive.jsonl").write_text(script, encoding="utf-8")
    assert project.run("replay", "drive.jsonl").stdout.startswith(f"drive.jsonl is of {year}, and")


def test_a_trace_stands_for_the_script_beside_it(recorded: RobotProject) -> None:
    script, trace = (recorded.path / name for name in ("match.jsonl", "match.trace.jsonl"))
    project = find_project(recorded.path)
    assert log_run(project, trace).script == log_run(project, script).script
    script.unlink()
    result = recorded.run_here(*SIM, "--log", "match.trace.jsonl")
    assert result.code == 2
    assert "match.trace.jsonl: a trace has no inputs, and its input script is not beside it" in result.output


class Log:
    """A log of a robot that was switched on before time `began`, in seconds."""

    def __init__(self, file: Path, began: float = 100.0) -> None:
        self._log = DataLogWriter(str(file))
        self.began = began
        entries = {
            "DS:enabled": BooleanLogEntry,
            "DS:autonomous": BooleanLogEntry,
            "DS:test": BooleanLogEntry,
            "DS:estop": BooleanLogEntry,
            "NT:/FMSInfo/GameSpecificMessage": StringLogEntry,
            "DS:joystick0/axes": DoubleArrayLogEntry,
            "NT:/SmartDashboard/Elevator/setpoint": DoubleLogEntry,
            "NT:/SmartDashboard/kP": DoubleLogEntry,
            "NT:/SmartDashboard/Field/Robot": DoubleArrayLogEntry,
        }
        self._entries = {name: kind(self._log, name) for name, kind in entries.items()}

    def at(self, seconds: float, **values: object) -> None:
        for name, value in values.items():
            entry = next(each for full, each in self._entries.items() if full.rsplit("/", 1)[-1].endswith(name))
            entry.append(value, round((self.began + seconds) * 1e6))

    def close(self) -> None:
        self._log.flush()
        self._log.stop()


PUBLISHING = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.pad = wpilib.Joystick(0)
            wpilib.SmartDashboard.putNumber("kP", 1.0)

        def teleopPeriodic(self):
            asked = wpilib.SmartDashboard.getNumber("kP", 1.0) * self.pad.getRawAxis(0)
            wpilib.SmartDashboard.putNumber("Elevator/setpoint", min(asked, 0.8))
"""


@pytest.fixture
def played(make_project: MakeProject) -> RobotProject:
    """Return a project with the log of a real robot: it waited for a minute, and its loop jitters."""
    project = make_project({"robot.py": PUBLISHING})
    log = Log(project.path / "match.wpilog")
    log.at(0.0, enabled=False, autonomous=False, test=False, estop=False, kP=1.0, setpoint=0.0)
    log.at(0.0, axes=[0.0, 0.0], Robot=[0.0, 0.0, 0.0])
    log.at(60.004, enabled=True)
    log.at(61.0, Robot=[0.1, 0.0, 0.0])
    for number in range(100):
        axis = number / 100
        log.at(60.1 + 0.02 * number, axes=[axis, 0.0])
        # One loop late, and with the noise of a sensor.
        log.at(60.1 + 0.02 * (number + 1) + 0.003 * (number % 3), setpoint=axis + 0.004 * (number % 2))
    log.at(63.0, enabled=False)
    log.at(300.0, setpoint=5.0)
    log.close()
    return project


def test_the_log_of_a_robot_is_shown_on_the_times_of_the_simulation(played: RobotProject) -> None:
    script = load_inputs(played.path / "match.wpilog")
    # It begins five seconds before the robot was enabled, and ends three seconds after it was disabled.
    assert [step.at_us for step in script.steps if step.writes.get("mode") == "teleop"] == [5_020_000]
    assert 11.0 <= script.end_us / 1e6 <= 11.1
    said = log_of(played, "match.wpilog", "--record", "again.jsonl")
    # Its code has not set the robot's place, so the log has it in a corner.
    assert "Field/Robot" not in (played.path / "again.jsonl").read_text("utf-8")
    # At 0.85, since 5 % of the range are 0.05.
    assert "\n  Elevator/setpoint (0:06.84): 0.854 in match.wpilog, 0.8 here" in said
    assert "--ignore" not in said
    assert "differs slightly" not in said
    said = log_of(played, "match.wpilog", "--tolerance", "25")
    assert "no difference: 2 values" in said
    slightly = r"^differs slightly, at most by this share of its range: Elevator/setpoint \((\d+) % at 0:07\.\d\d\)$"
    found = re.search(slightly, said, re.MULTILINE)
    assert found is not None
    assert 15 <= int(found[1]) <= 20  # 0.994 in the log, 0.8 here, in which there are 0.004 of noise


def test_what_a_person_has_set_on_a_dashboard_is_named(played: RobotProject) -> None:
    change(played, "robot.py", '"kP", 1.0)\n\n', '"kP", 0.5)\n\n')
    said = log_of(played, "match.wpilog")
    assert re.search(r"  kP \(.*\): 1 in match.wpilog, 0.5 here\n", said)
    said = log_of(played, "match.wpilog", "--input", "SmartDashboard/kP")
    assert "\n  Elevator/setpoint (" in said
    assert "\n  kP (" not in said
    result = played.run_here(*SIM, "--log", "match.wpilog", "--input", "Nope/kP")
    assert (result.code, result.first_error) == (2, "--input Nope/kP: match.wpilog has no value of this name")
    assert "It has SmartDashboard/kP." in result.stderr


TUNED = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motors = [wpilib.PWMSparkMax(channel) for channel in range(2)]
            wpilib.Preferences.initDouble("top", 0.5)
            wpilib.SmartDashboard.putNumber("kP", 0.25)
            self.modes = wpilib.SendableChooser()
            self.modes.setDefaultOption("slow", 1.0)
            self.modes.addOption("fast", 2.0)
            wpilib.SmartDashboard.putData("Modes", self.modes)

        def teleopPeriodic(self):
            self.motors[0].set(wpilib.Preferences.getDouble("top", 0.0))
            self.motors[1].set(wpilib.SmartDashboard.getNumber("kP", 0.0) * self.modes.getSelected())
"""
TUNING = """{"format": "pyfrc-input 1", "end": 3.0}
{"t": 0.5, "set": {"mode": "teleop"}}
{"t": 1.0, "set": {"nt:/SmartDashboard/kP": 0.3, "nt:/SmartDashboard/Modes/selected": "fast"}}
{"t": 2.0, "set": {"nt:/Preferences/top": 0.75}}
"""


@pytest.mark.slow
def test_the_log_of_a_simulation_says_what_a_person_has_set(make_project: MakeProject) -> None:
    project = make_project({"robot.py": TUNED, "tuning.jsonl": TUNING})
    result = project.run(*SIM, "--script", "tuning.jsonl", "--wpilog", "match.wpilog")
    assert result.code == 0, result.output
    said = log_of(project, "match.wpilog", "--wpilog", "again.wpilog")
    assert "no difference: " in said
    assert "exactly the same" in said
    assert "no difference: " in log_of(project, "again.wpilog")
    change(project, "robot.py", '"fast", 2.0', '"fast", 3.0')
    said = log_of(project, "match.wpilog")
    assert re.search(r"differs first at 0:01.0\d, in pwm\[1\].value: 0\.6 in match.wpilog, 0\.9 here", rounded(said))
    change(project, "robot.py", '"top", 0.5', '"top", 0.7')  # what a person sets later is no default
    said = log_of(project, "match.wpilog")
    assert "differs first at 0:00.50, in pwm[0].value: 0.5 in match.wpilog, 0.7 here" in rounded(said)


TOPICS = """
    import ntcore
    import wpilib
    from wpimath.controller import PIDController
    from wpimath.geometry import Pose2d
    from wpimath.kinematics import ChassisSpeeds

    GAIN = 1.0

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            wpilib.DataLogManager.start()
            wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
            tables = ntcore.NetworkTableInstance.getDefault()
            self.speed = tables.getStructTopic("Speed", ChassisSpeeds).publish()
            self.plain = tables.getDoubleTopic("plain_time").publish()
            self.seen = tables.getStructArrayTopic("/Seen", Pose2d).publish()
            self.limit = tables.getDoubleTopic("Arm/limit").getEntry(1.0)
            self.limit.set(1.0)
            self.turn = PIDController(1, 0, 0)
            wpilib.SmartDashboard.putData("first name", self.turn)
            wpilib.SmartDashboard.putData("second name", self.turn)

        def robotPeriodic(self):
            now = round(wpilib.Timer.getFPGATimestamp(), 2)
            self.speed.set(ChassisSpeeds(now, 0, 0))
            self.plain.set(GAIN * now * self.limit.get())
            self.seen.set([Pose2d(now, 0, 0)] if 0.5 < now < 1.5 else [])

        def teleopInit(self):
            wpilib.SmartDashboard.putBoolean("Commands/Reset", True)

        def teleopPeriodic(self):
            if wpilib.Timer.getFPGATimestamp() > 1.5:
                wpilib.SmartDashboard.putBoolean("Commands/Climb", True)
"""
LIMITED = """{"format": "pyfrc-input 1", "end": 2.0}
{"t": 0.5, "set": {"nt:Arm/limit": 0.5}}
{"t": 1.0, "set": {"mode": "teleop"}}
"""


def test_every_topic_is_compared_and_those_of_one_run_only_have_a_time(make_project: MakeProject) -> None:
    project = make_project({"robot.py": TOPICS, "limited.jsonl": LIMITED})
    result = project.run(*SIM, "--script", "limited.jsonl", "--wpilog", "match.wpilog")
    assert result.code == 0, result.output
    (own,) = (project.path / ".pyfrc" / "logs").glob("*.wpilog")
    own.rename(project.path / "robot.wpilog")
    # Names without a slash, structs, empty lists of them, and a Sendable that has lost its first name.
    said = log_of(project, "match.wpilog")
    assert "no difference: " in said
    assert " only: " not in said
    change(project, "robot.py", "GAIN = 1.0", "GAIN = 2.0")
    change(project, "robot.py", "Commands/Reset", "Commands/Set")
    said = log_of(project, "match.wpilog", "--seconds", "1.2")
    assert "differs first at 0:00.02, in plain_time: 0.02 in match.wpilog, 0.04 here" in said
    assert "if plain_time differs in each run, such as a time that code took: --ignore plain_time\n" in said
    assert "compared up to 0:01.20 of 0:01.98\n" in said
    assert "in match.wpilog only: Commands/Reset (0:01.00)\nhere only: Commands/Set (0:01.00)\n" in said
    (project.path / "pyproject.toml").write_text('[tool.pyfrc.sim]\nignore = ["pl*e"]\n', encoding="utf-8")
    said = log_of(project, "robot.wpilog", "--input", "Arm/limit", "--ignore", "Commands", "--seconds", "1.2")
    assert "no difference up to 0:01.20 of 0:01.98: " in said
    assert " only: " not in said
    assert "not compared, as you asked: pl*e, Commands\n" in said


def test_options_that_contradict_each_other_are_refused(make_project: MakeProject) -> None:
    project = make_project({"robot.py": PUBLISHING, "drive.jsonl": DRIVEN})
    for arguments, sentence in (
        (("--log", "drive.jsonl"), "this input script has no trace beside it"),
        (("--log", "drive.jsonl", "--mode", "auto"), "--log has the modes and all inputs Leave out --mode."),
        (("--log", "drive.jsonl", "--script", "drive.jsonl"), "--log FILE --record NEW.jsonl writes them as a script"),
        (("--mode", "auto", "--tolerance", "5"), "--tolerance, --input, --ignore and --sensors are for a log"),
    ):
        result = project.run_here(*SIM, *arguments)
        assert result.code == 2, result.output
        assert sentence in " ".join(result.output.split())


def history(*changes: tuple[float, object]) -> ValueHistory:
    made = ValueHistory()
    for time, value in changes:
        made.add(time, {"nt:/x": value})
    return made


STEPS = [(0.02 * number, float(number % 10)) for number in range(200)]


@for_each(
    "here, log, differs",
    [
        (STEPS, STEPS, None),
        (STEPS, [(time + 0.04, value) for time, value in STEPS], None),  # late
        (STEPS, [(time, value + 0.4) for time, value in STEPS], None),  # within 5 % of 9.4
        ([(0.0, 0.0), (1.0, 1.0)], [(0.0, 0.0), (1.05, 1.0), (4.0, 1.0)], None),
        ([(0.0, 0.0), (1.0, 1.0), (4.0, 1.0)], [(0.0, 0.0), (4.0, 0.0)], 1.0),
        (
            [(0.0, 0.0), (1.0, 1.0), (1.02, 0.0), (4.0, 0.0)],
            [(0.0, 0.0), (4.0, 0.0)],
            1.0,
        ),  # a button that was not seen
        ([(0.0, True), (1.0, False), (4.0, False)], [(0.0, False), (1.0, True), (4.0, True)], 0.0),
        ([(0.0, "up"), (1.0, "down"), (4.0, "down")], [(0.0, "up"), (4.0, "up")], 1.0),
        ([(0.0, (1.0, 2.0)), (4.0, (1.0, 2.0))], [(0.0, (1.0, 2.02)), (4.0, (1.0, 2.02))], None),
        ([(0.0, (1.0, 2.0)), (4.0, (1.0, 2.0))], [(0.0, (1.0,)), (4.0, (1.0,))], 0.0),
        # Only one of them has it at first.
        ([(0.0, 1.0), (4.0, 1.0)], [(2.0, 1.0), (4.0, 1.0)], None),
    ],
)
def test_a_value_of_a_log_may_be_late_and_noisy(here: list, log: list, differs: float | None) -> None:
    found = FirstDifference(0.0, 4.0, Comparison(True, 0.05, 0.06))
    found.compare(history(*here), history(*log), "nt:/x")
    assert found.time == differs
    assert found.compared == 1


@for_each("share, first, time", [(0.05, "nt:/limit", 3.0), (0.0, "nt:/battery", 0.0)])
def test_where_runs_do_not_repeat_what_changes_rarely_comes_first(share: float, first: str, time: float) -> None:
    found = FirstDifference(0.0, 4.0, Comparison(True, share, 0.06))
    here, log = ValueHistory(), ValueHistory()
    for now, value in STEPS:
        here.add(now, {"nt:/battery": 12.0, "nt:/limit": 2.0})
        log.add(now, {"nt:/battery": value, "nt:/limit": 2.0 if now < 3.0 else 1.0})
    for path in ("nt:/battery", "nt:/limit"):
        found.compare(here, log, path)
    plain = found.plain(str)
    assert (plain["t"], plain["paths"], plain["count"]) == (time, [first], 2)


@for_each(
    "here, log, slight",
    [
        (STEPS, [(time, value + 0.4) for time, value in STEPS], 0.4 / 9.4),
        (STEPS, [(time + 0.04, value) for time, value in STEPS], None),
        ([(0.0, (1.0, 2.0))], [(0.0, (1.0, 2.02))], 0.02 / 1.02),
    ],
)
def test_how_much_a_value_differs_that_does_not_count(here: list, log: list, slight: float | None) -> None:
    found = FirstDifference(0.0, 4.0, Comparison(True, 0.05, 0.06))
    found.compare(history(*here), history(*log), "nt:/x")
    assert [share for _, share, _ in found.sorted_slight()] == ([] if slight is None else [pytest.approx(slight)])


@for_each(
    "values, differs",
    [
        ([(3.0, 3.0), (3.14, -3.14), (-3.0, -3.0)], None),
        ([(179.0, 179.0), (-180.0, 179.98), (-179.0, -179.0)], None),
        (
            [((1.0, 2.0, 179.0),) * 2, ((1.0, 2.0, 179.9), (1.0, 2.0, -179.9)), ((1.0, 2.0, -170.0),) * 2],
            None,
        ),  # a Field2d
        ([(3.0, 3.0), (3.0, -3.0), (-3.0, -3.0)], 1.0),
    ],
)
def test_an_angle_goes_on_after_half_a_turn(values: list, differs: float | None) -> None:
    found = FirstDifference(0.0, 4.0, Comparison(True, 0.05, 0.06))
    here, log = (history(*((float(time), each[run]) for time, each in enumerate(values))) for run in (0, 1))
    found.compare(here, log, "nt:/x")
    assert found.time == differs


def test_the_times_of_a_log_are_those_of_another_clock() -> None:
    found = FirstDifference(0.0, 4.0, Comparison(True), offset=-10.0)
    log = [(time + 10.0, value) for time, value in STEPS]
    found.compare(history(*STEPS), history(*log), "nt:/x")
    assert found.time is None
    log[50] = (log[50][0], 7.5)
    found.compare(history(*STEPS), history(*log), "nt:/x")
    assert found.time == pytest.approx(1.0)
    assert found.paths == ["nt:/x"]


# -- what is said ------------------------------------------------------------------------------------------------------

Values = dict[str, list[tuple[float, object]]]


def said_of(directory: Path, here: Values, log: Values, share: float, names_all: bool = False) -> list[str]:
    """Return what is said of a simulation of 7 s, and of the log that drives it, with these values of both."""

    def changes(values: Values, of_network: bool) -> Iterator[Change]:
        chosen = {
            path: all_of for path, all_of in values.items() if path.startswith(("nt:", "type:", "sim.")) is of_network
        }
        for moment in sorted({at for all_of in chosen.values() for at, _ in all_of}):
            yield Change(moment, {path: each for path, all_of in chosen.items() for at, each in all_of if at == moment})

    histories = {"hal": ValueHistory(), "network": ValueHistory()}
    for name, history in histories.items():
        for change in changes(log, name == "network"):
            history.add(change.time, change.values)
    past = PastRun("match.wpilog", 7.0, histories, (), compared=Comparison(True, share, 0.06))
    source = Elsewhere(directory, Abilities("simulation"))
    source.branches = (past,)
    report = LogReport(source, LogRun(InputScript((), 7_000_000), past), names_all)
    for name, feed in (("hal", source.hal), ("network", source.network)):
        feed.add(RunBegan(1, 0.0, {}))
        for change in changes(here, name == "network"):
            feed.add(change)
    source.snapshot = Snapshot(7.0, "disabled", Scene(source.field))
    return list(report.lines())


def twice(goal: float, setpoint: str = "/SmartDashboard/Elevator/setpoint", of: str = "") -> Values:
    """Return the values of a robot that is enabled twice, and moves its lift to a goal each time."""
    steps: list[tuple[float, object]] = [(0.0, 0.0), (2.0, goal), (2.5, 0.0), (5.0, goal), (5.5, 0.0)]
    modes: list[tuple[float, object]] = [(0.0, "disabled"), (1.0, "teleop"), (3.0, "disabled"), (4.0, "teleop")]
    return {
        "sim.mode": modes,
        f"nt:{setpoint}": [(1.0, 0.0), *steps[1:]],
        f"type:{setpoint}": [(1.0, "double")],
        "pwm[1].value": [*steps, (6.0, 0.1), (6.1, 0.0)],  # changes more often
        "pwm[1].raw_value": [*steps, (6.0, 0.1), (6.1, 0.0)],
        'CAN["CANMotor:Talon FX (v6)[11]"].rotorPos': [(0.0, 0.0)],
        **{f"nt:/SmartDashboard/name {n}": [(0.0, "the name of part " * 4 + of)] for n in range(12)},
    }


def test_what_differs_is_named_anew_after_each_enabling_and_shortly(tmp_path: Path) -> None:
    said = said_of(tmp_path, twice(0.75), twice(0.5), 0.05)
    # The lift's output is one value of a device that has more, which are named once.
    lift = "pwm[1].value (0:02.00): 0.5 in match.wpilog, 0.75 here"
    differing = (
        "differs in 2 values, those that change rarely first:\n  Elevator/setpoint (0:02.00): 0.5 in match.wpilog"
    )
    assert f"{differing}, 0.75 here\n  {lift}" in said
    assert "after it was enabled at 0:04.00, in Elevator/setpoint (0:05.00), pwm[1].value (0:05.00)" in said
    assert not any(" only: " in line for line in said)
    late = {"nt:/SmartDashboard/late": [(0.0, 1.0)]}, {"nt:/SmartDashboard/late": [(0.0, 1.0), (5.0, 2.0)]}
    said = said_of(tmp_path, twice(0.75) | late[1], twice(0.5) | late[0], 0.05)
    assert "\n".join(said).count("late (0:05.00)") == 1  # it was equal until then, so it is not named again
    changed = twice(0.75, setpoint="/SmartDashboard/Elevator/goal", of="now"), twice(0.5, of="then")
    shortly, whole = ("\n".join(said_of(tmp_path, *changed, 0.05, names_all)) for names_all in (False, True))
    for text in (shortly, whole):
        assert len(re.findall(r"  name \d+ \(.*: \.\.\..{,20}then in match.wpilog, \.\.\..{,20}now here\n", text)) == 12
    assert "in match.wpilog only: Elevator/setpoint (0:01.00)\nhere only: Elevator/goal (0:01.00)" in shortly
    assert "in match.wpilog only:\n  Elevator/setpoint (0:01.00)\nhere only:\n" in whole


# -- the page ---------------------------------------------------------------------------------------------------------


@contextmanager
def page_with(project: RobotProject, log: str) -> Iterator[Served]:
    """Serve what ``pyfrc sim --log`` shows."""
    found = find_project(project.path)
    run = log_run(found, project.path / log)
    options = SimOptions(speed=1, paused=True, script=run.script, start_at=run.end, network_values=True)
    simulation = Simulation(found, options, run.run)
    with served_source(simulation) as server:
        assert simulation.wait_for(lambda: simulation.status.state == "paused", PATIENCE)
        yield server


def test_the_page_gets_the_first_difference_and_what_moves_the_sensors(recorded: RobotProject) -> None:
    change(recorded, "robot.py", "GAIN = 0.5", "GAIN = 0.75")
    with page_with(recorded, "match.wpilog") as server, server.page() as page:
        (branch,) = page.parts["branches"]
        assert (branch["name"], branch["offset"], branch["compared"]) == ("match.wpilog", 0.0, True)
        page.until(lambda: page.time > 3.49)  # what is compared comes after the simulation has paused
        found = page.ask(type="first_difference", branch=branch["id"], paths=None)
        assert found["until"] == pytest.approx(3.5, abs=0.001)
        assert (found["t"], found["paths"][:2]) == (2.5, ["nt:/SmartDashboard/Elevator/setpoint", "pwm[1].value"])
        assert [path for path, *_ in found["others"]] == [*found["paths"][:2], "pwm[1].raw_value"]
        for path, time, *texts in found["others"][1:]:
            both = [page.ask(type="values", t=time, branch=each)["values"][path] for each in (branch["id"], None)]
            assert texts == [f"{value:.6g}" for value in both]
        assert "encoder[0].count" in found["sensors"]["log"]
        assert found["sensors"]["physics"] == []
        # From the past on, a person drives: then physics moves the encoder again.
        page.command("rewind", t=2.0)
        page.until(lambda: page.status["state"] == "paused" and page.time == 2.0)
        page.command("axis", stick=0, axis=1, value=-1.0)
        held = page.values["encoder[0].count"]
        page.run_for(0.5)
        page.until(lambda: page.values["encoder[0].count"] > held + 15)


@pytest.mark.slow
def test_a_person_sees_where_the_log_differs(recorded: RobotProject, browser: Browser) -> None:
    change(recorded, "robot.py", "GAIN = 0.5", "GAIN = 0.75")
    with page_with(recorded, "match.wpilog") as server, opened_page(browser, server.address) as page:
        sentence = page.get_by_role("button", name="Differs first at 0:02.50, in Elevator/setpoint")
        sentence.click()
        page.locator("time.clock", has_text="0:02.50").wait_for()
        # Its curves around that moment, with both values, and its row, with the value of that moment.
        legend = page.locator("[data-panel='plot:1'] .legend li", has_text="Elevator/setpoint")
        legend.locator(".in-branch", has_text="0.5").wait_for()
        page.get_by_role("button", name="Follow again").wait_for()
        page.locator(".networktables .found", has_text="setpoint").locator("input").wait_for()
        row = page.locator(".differences li", has_text="pwm[1].value")
        assert row.inner_text().split("\n")[0].startswith("pwm[1].value")
        assert row.locator("b").all_inner_texts() == ["0.278884", "0.52988"]
        row.locator("button").click()
        page.locator(".devices .found").wait_for()
        page.locator("[data-panel='plot:1'] .legend li", has_text="setpoint").wait_for(state="detached")
        sensors = page.locator(".differences details", has_text="From the log")
        sensors.locator("summary").click()
        sensors.get_by_text("encoder[0].count").wait_for()


def test_a_person_sees_first_what_cannot_be_compared(make_project: MakeProject, browser: Browser) -> None:
    project = make_project({"robot.py": PUBLISHING})
    a_match().save(project.path / "match.wpilog")
    with page_with(project, "match.wpilog") as server, opened_page(browser, server.address) as page:
        page.get_by_role("button", name="Nothing to compare up to 0:1").click()
        limit = "match.wpilog has no joysticks from 10 s on: what follows from that cannot be compared."
        page.locator(".differences p").first.get_by_text(limit).wait_for()


CAMERAS = """
    import ntcore
    import wpilib
    from wpimath.geometry import Pose2d

    TABLES = ntcore.NetworkTableInstance.getDefault()
    TABLE = TABLES.getTable("limelight")
    GAIN = 1.0

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            wpilib.DataLogManager.start()
            wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())
            self.poses = TABLE.getDoubleArrayTopic("botpose").subscribe([])
            self.angle = TABLE.getEntry("tx")
            self.tag = TABLE.getIntegerTopic("tid").subscribe(0)
            self.place = TABLES.getStructTopic("/photonvision/front/pose", Pose2d).subscribe(Pose2d())
            self.seen = 0

        def robotPeriodic(self):
            for pose in self.poses.readQueue():
                self.seen += 1
                wpilib.SmartDashboard.putNumber("sum", sum(pose.value))
                wpilib.SmartDashboard.putNumber("at", pose.time)
            wpilib.SmartDashboard.putNumber("seen", self.seen)
            wpilib.SmartDashboard.putNumber("angle", GAIN * self.angle.getDouble(0))
            wpilib.SmartDashboard.putNumber("tag", self.tag.get())
            wpilib.SmartDashboard.putNumber("x", self.place.get().X())
"""
#: A camera that measures by chance, as one does that sees a robot whose motors have the noise of SPARKs.
CHANCE = """
    import random

    import ntcore
    from wpimath.geometry import Pose2d, Rotation3d

    class PhysicsEngine:
        def __init__(self, physics_controller):
            self.chance = random.SystemRandom()
            tables = ntcore.NetworkTableInstance.getDefault()
            table = tables.getTable("limelight")
            self.seen_at = tables.getStructTopic("/photonvision/front/pose", Pose2d).publish()
            self.tilt = tables.getStructTopic("/photonvision/front/tilt", Rotation3d).publish()  # no schema
            self.table, self.angle = table, table.getEntry("tx")
            self.poses = table.getDoubleArrayTopic("botpose").publish()
            self.tag = table.getIntegerTopic("tid").publish()

        def update_sim(self, hal_data, now, tm_diff):
            noise = [self.chance.uniform(-0.5, 0.5) for _ in range(3)]
            self.poses.set(noise, round(now * 1e6) - 3_000)  # when the picture was taken
            self.seen_at.set(Pose2d(noise[1], 0.0, 0.0))
            self.tilt.set(Rotation3d(noise[2], 0.0, 0.0))
            self.tag.set(self.chance.randint(1, 30))
            if now < 1.0:
                self.angle.setDouble(noise[0])
            else:
                self.table.putNumber("tx", noise[0])
"""


def test_cameras_measure_what_they_measured_in_the_log(make_project: MakeProject) -> None:
    project = make_project({"robot.py": CAMERAS, "physics.py": CHANCE, "drive.jsonl": DRIVEN})
    result = project.run(*SIM, "--script", "drive.jsonl", "--wpilog", "match.wpilog")
    assert result.code == 0, result.output
    said = log_of(project, "match.wpilog", "--tolerance", "0", "--record", "again.jsonl")
    assert "no difference: " in said
    assert "sensors from the log, whatever today's code does: limelight, photonvision/front" in said
    assert " only: " not in said
    result = project.run("replay", "again.jsonl")  # the recording of this run has them, too
    assert result.code == 0, result.output
    change(project, "robot.py", "GAIN = 1.0", "GAIN = 0.5")
    assert re.search(r"angle(: | \(0:00\.\d\d\): )", log_of(project, "match.wpilog"))


@pytest.mark.slow
def test_a_camera_that_a_log_does_not_have_comes_from_physics(make_project: MakeProject) -> None:
    project = make_project({"robot.py": CAMERAS, "physics.py": CHANCE, "drive.jsonl": DRIVEN})
    files = ("--record", "match.jsonl", "--wpilog", "match.wpilog")
    result = project.run(*SIM, "--script", "drive.jsonl", *files)
    assert result.code == 0, result.output
    assert "sensors from physics: limelight, photonvision/front" in log_of(project, "match.jsonl")
    said = log_of(project, "match.wpilog", "--sensors", "physics")
    assert "sensors from physics: limelight, photonvision/front" in said
    assert "limelight/" not in said.partition("sensors from physics")[0]  # what a camera measured is not compared
