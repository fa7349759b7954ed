"""Logs of AdvantageKit and PyKit: they are shown, and drive today's code, whose outputs are compared with theirs."""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject, RobotProject
from written_logs import Written, a_kit_log

from pyfrc_core.runtime.scripts.inputs_file import load_inputs
from pyfrc_core.sim.engine.past_run import PastRun
from pyfrc_core.sim.logs import open_log

#: It publishes as PyKit does: its outputs and the schemas of structs are in a table of their own.
ROBOT = """
    import struct

    import ntcore
    import wpilib

    SCHEMAS = {
        "Rotation2d": b"double value",
        "Translation2d": b"double x;double y",
        "Pose2d": b"Translation2d translation;Rotation2d rotation",
    }


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            tables = ntcore.NetworkTableInstance.getDefault()
            self.pad = wpilib.XboxController(0)
            self.chooser = wpilib.SendableChooser()
            self.chooser.setDefaultOption("Slow", 0.2)
            self.chooser.addOption("Fast", 0.8)
            wpilib.SmartDashboard.putData("Auto", self.chooser)
            self.gain = tables.getDoubleTopic("/Tuning/gain").getEntry(1.0)
            self.gain.setDefault(1.0)
            self.offset = tables.getDoubleTopic("/Tuning/offset").getEntry(OFFSET)
            self.offset.setDefault(OFFSET)
            table = tables.getTable("AdvantageKit/RealOutputs")
            self.setpoint = table.getDoubleTopic("Arm/Setpoint").publish()
            self.took = table.getDoubleTopic("Logger/EntryUpdateMS").publish()
            self.yaw = tables.getDoubleTopic("/AdvantageKit/Drive/Gyro/yaw").publish()
            self.schemas = []
            for name, schema in SCHEMAS.items():
                topic = tables.getRawTopic(f"/AdvantageKit/.schema/struct:{name}")
                self.schemas.append(topic.publish("structschema"))
                self.schemas[-1].set(schema)
            self.pose = table.getRawTopic("Odometry/Robot").publish("struct:Pose2d")
            self.publish(0.0, 0.0)

        def publish(self, speed, setpoint):
            self.pose.set(struct.pack("<3d", 1.0 + speed, 2.0, 0.0))
            self.setpoint.set(setpoint)
            self.took.set(0.0)
            self.yaw.set(wpilib.Timer.getFPGATimestamp())

        def autonomousPeriodic(self):
            self.publish(self.chooser.getSelected(), 0.0)

        def teleopPeriodic(self):
            self.publish(-self.pad.getLeftY() * self.gain.get(), SETPOINT if self.pad.getBButton() else 0.0)

        def disabledInit(self):
            self.publish(0.0, self.offset.get() - 0.25)

    SETPOINT = 0.3
    OFFSET = 0.25
"""
SIM = ("sim", "--ui", "none", "--log")


@pytest.fixture
def project(make_project: MakeProject) -> RobotProject:
    made = make_project({"robot.py": ROBOT})
    a_kit_log().save(made.path / "match.wpilog")
    return made


def said_of(project: RobotProject, old: str = "", new: str = "") -> str:
    """Return what `pyfrc sim --log` says when a line of the robot was changed."""
    robot = project.path / "robot.py"
    text = robot.read_text(encoding="utf-8")
    assert old in text
    robot.write_text(text.replace(old, new), encoding="utf-8")
    result = project.run(*SIM, "match.wpilog")
    assert result.code == 0, result.output
    return result.stdout


def network(run: PastRun, path: str) -> list[tuple[float, Any]]:
    return list(zip(*run.histories["network"].changes(f"nt:/AdvantageKit{path}"), strict=True))


@pytest.mark.parametrize("begin", [0.0, 100.0])
def test_all_is_shown_under_the_names_that_a_live_robot_has(tmp_path: Path, begin: float) -> None:
    opened = open_log(a_kit_log(begin=begin).save(tmp_path / "match.wpilog"), 27.0)
    run = opened.run
    shift = 0.02 if begin else 0.0  # the times of a robot's log count from its first value
    network_now, hal_now = run.histories["network"].now, run.histories["hal"].now
    assert opened.problem == ""
    assert network(run, "/RealOutputs/Arm/Setpoint") == [(0.02 - shift, 0.0), (2.6 - shift, 0.3), (3.0 - shift, 0.0)]
    assert [value for _, value in network(run, "/RealOutputs/Odometry/Robot/translation/x")][:2] == [1.0, 1.8]
    assert network_now["nt:/AdvantageKit/RealMetadata/Git Hash"] == "abc123"
    assert network_now["type:/AdvantageKit/Arm/positionRad"] == "double"
    modes = run.histories["network"].changes("sim.mode")
    assert list(modes[1]) == ["disabled", "disabled autonomous", "autonomous", "disabled", "teleop", "disabled"]
    assert list(modes[0])[2] == 1.0 - shift
    assert network_now["sim.pose"] == pytest.approx((1 / 0.3048, 27 - 2 / 0.3048, 0.0))
    assert [each.text for each in run.happened] == ["auto begins with Fast", "brownout"]
    assert (hal_now["alliance_station"], hal_now["event.game_specific_message"]) == (5, "R")
    assert (hal_now["joysticks[0].axes"], hal_now["joysticks[2].axes"]) == ((0.0, -0.5), ())
    pressed = run.histories["hal"].value_at("joysticks[0].buttons", 2.8)
    assert [number for number, each in enumerate(pressed) if each] == [2]


@pytest.mark.parametrize("prefix", ["", "NT:/AdvantageKit"])
def test_its_inputs_are_those_of_the_driver_station_and_of_dashboards(tmp_path: Path, prefix: str) -> None:
    script = load_inputs(a_kit_log(prefix).save(tmp_path / "match.wpilog"))
    steps = {step.at_us / 1e6: dict(step.writes) for step in script.steps}
    assert steps == {
        0.02: {
            "event.name": "OHCL",
            "event.match_number": 12,
            "event.match_type": "qualification",
            "time.remaining": -1.0,
            "nt:/SmartDashboard/Auto/selected": "Slow",
            "nt:/Tuning/gain": 1.0,
            **{f"joysticks[{stick}].plugged": False for stick in range(2, 6)},
        },
        0.2: {"alliance_station": "blue2", "control.fmsAttached": True, "event.game_specific_message": "R"},
        0.3: {"nt:/SmartDashboard/Auto/selected": "Fast"},
        0.5: {"mode": "disabled autonomous"},
        1.0: {"mode": "autonomous", "time.remaining": 20.0},
        2.0: {"mode": "disabled", "time.remaining": 19.0},
        2.5: {"mode": "teleop"},
        2.6: {"joysticks[0].buttons[2]": True},
        3.0: {"joysticks[0].buttons[2]": False},
        3.2: {"joysticks[0].axes[1]": -0.5},
        3.4: {"nt:/Tuning/gain": 0.5},
        4.5: {"mode": "disabled"},
    }
    assert script.end_us == 5_000_000


def test_a_log_of_advantagekit_of_2024(tmp_path: Path) -> None:
    """What was read from dashboards has other names; the game message of its simulations is garbage."""
    log = Written("AdvantageKit", '{"source":"AdvantageKit"}')
    log.values("/DriverStation/Enabled", "boolean", "?", (0, False), (6, True), (8, False))
    log.values("/DriverStation/Joystick0/AxisValues", "float[]", "", (0, b""), (7, struct.pack("<2f", 0.5, -1)))
    log.values("/DriverStation/GameSpecificMessage", "string", "", (0, b""), (1, b"\xef\xbf\xbd" * 90))
    log.values("/DashboardInputs/Auto Choices", "string", "", (0, b"None"), (1, b"Example Auto"))
    log.values("/DashboardInputs/Flywheel Speed", "double", "d", (0, 1500.0), (7.5, 1600.0))
    script = load_inputs(log.save(tmp_path / "match.wpilog"))
    assert [(step.at_us, dict(step.writes)) for step in script.steps] == [
        (
            20_000,
            {
                "event.game_specific_message": "\ufffd" * 21,
                "joysticks[0].plugged": False,
                "nt:/SmartDashboard/Auto Choices/selected": "Example Auto",
                "nt:/SmartDashboard/Flywheel Speed": 1500.0,
            },
        ),
        (5_000_000, {"mode": "teleop"}),
        (6_000_000, {"joysticks[0].plugged": True, "joysticks[0].axes[0]": 0.5, "joysticks[0].axes[1]": -1.0}),
        (6_500_000, {"nt:/SmartDashboard/Flywheel Speed": 1600.0}),
        (7_000_000, {"mode": "disabled"}),
    ]


def test_unchanged_code_does_the_same(project: RobotProject) -> None:
    said = said_of(project)
    assert "no difference: 4 values that match.wpilog has, too" in said  # x, y and angle of the pose, and the setpoint
    assert "inputs of subsystems, which only the replay of AdvantageKit or PyKit gives to the code: Arm, Drive" in said


def test_changed_code_differs_where_the_change_acts(project: RobotProject) -> None:
    said = said_of(project, "OFFSET = 0.25", "OFFSET = 0.5")  # never changed in the log, so it was the code's default
    difference = re.escape("AdvantageKit/RealOutputs/Arm/Setpoint (0:00.02): 0 in match.wpilog")
    assert re.search(rf"differs in \d values?[^:]*:\n  {difference}", said), said


def test_a_robots_log_is_played_from_shortly_before_it_was_enabled(project: RobotProject) -> None:
    a_kit_log(begin=100.0).save(project.path / "match.wpilog")
    assert "no difference: 4 values" in said_of(project)


def test_a_library_finds_the_robots_objects_by_the_collector(make_project: MakeProject) -> None:
    """PyKit does, to log what code has marked as an output."""
    robot = """
        import gc

        import wpilib

        class Arm:
            pass

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.arm = Arm()

            def disabledInit(self):
                print("found" if any(each is self.arm for each in gc.get_objects()) else "hidden")
    """
    project = make_project({"robot.py": robot})
    assert "found" in project.run("sim", "--ui", "none", "--seconds", "0.1").stdout
