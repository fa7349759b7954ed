"""What robot code reads, publishes and logs in each turn, beside WPILib's own loop."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from conftest import MakeProject
from wpilog import DataLogReader

from .beside_wpilib import compare

ROBOT = """
    import telemetry
    import tunables
    import wpilib
    import wpilog
    import wpimath
    from wpiutil import Alert

    calls = []
    LOGS = "logs_of_pyfrc"


    def note(*what):
        calls.append(" ".join(map(str, what)))


    class Arm(tunables.ComplexTunable, telemetry.TelemetryLoggable):
        def __init__(self):
            super().__init__()
            self.angle = 0.0

        def publish_tunables(self, table):
            table.publish("angle", tunables.Tunable(0.0, getter=lambda: self.angle, setter=self.turn))

        def turn(self, angle):
            note("arm turned to", angle)
            self.angle = angle

        def log_to(self, table):
            table.log("angle", self.angle)


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            wpilib.DataLogManager.start(LOGS, "robot.wpilog")
            wpilib.DriverStation.start_data_log(wpilib.DataLogManager.get_log())
            self.own_entry = wpilog.DoubleLogEntry(wpilib.DataLogManager.get_log(), "/own")
            self.pad, self.xbox = wpilib.Gamepad(0), wpilib.XboxController(0)
            self.exact = wpilib.Gamepad(0)
            self.exact.set_left_x_deadband(0.0)
            self.exact.set_left_y_deadband(0.3)
            self.gain = tunables.add_double("gain", 1.5)
            self.count = tunables.add_int("count", 3)
            self.on = tunables.Tunable(False, on_tune=lambda value: note("on_tune", value))
            tunables.publish("on", self.on)
            self.arm = Arm()
            tunables.publish("arm", self.arm)
            self.start = tunables.Selectable()
            self.start.add_default("left", 1)
            self.start.add("right", 2)
            self.start.on_change(lambda value: note("start", value))
            tunables.publish("start", self.start)
            self.alert = Alert("arms", "lost", "no arm", Alert.Level.HIGH)
            self.turns = 0
            telemetry.keep_duplicates("kept")

        def robot_periodic(self):
            self.turns += 1
            pad, exact = self.pad, self.exact
            note("axes", pad.get_left_x(), pad.get_left_y(), pad.get_left_trigger(), pad.get_axis(pad.Axis.LEFT_X))
            note("deadbands of its own", exact.get_left_x(), exact.get_left_y(), self.xbox.get_left_x())
            note("button", pad.get_face_down_button(), pad.get_face_down_button_pressed())
            note("button", exact.get_face_down_button_released(), self.xbox.get_a_button(), pad.get_hid().get_pov())
            note("tuned", self.gain.get(), self.count.get(), self.on.get(), self.arm.angle, self.start.get_selected())
            self.alert.set(self.turns % 4 > 1)
            self.alert.set_text(f"no arm {self.turns // 8}")
            note("alert", self.alert.get(), self.alert.get_text())
            if self.turns == 9:
                self.gain.set(2.5)
            telemetry.log("turns", self.turns)
            telemetry.log("half", self.turns / 2)
            telemetry.log("same", "text")
            telemetry.log("kept", self.turns // 4)
            telemetry.log("flags", [True, self.turns % 2 == 0], element_type=bool)
            telemetry.log("pose", wpimath.Pose2d(self.turns, 1, 0))
            telemetry.log("arm", self.arm)
            telemetry.log("pad", self.pad)
            telemetry.get_table("deep").get_table("deeper").log("name", f"turn {self.turns}")
            self.own_entry.append(self.turns)
            wpilib.DataLogManager.log(f"turn {self.turns}")

        def end_competition(self):
            super().end_competition()
            wpilib.DataLogManager.log("complete")
"""

PLAN = """
    import hal
    import ntcore
    from wpilib.simulation import AlertSim, GamepadSim
    from wpilib.simulation import DriverStationSim as Station

    INPUTS = [0.0, 0.05, 0.1, 0.11, -0.55, 1.0, -1.0, 0.01, 0.005, 0.0, 0.2]


    def play(note, packet):
        network = ntcore.NetworkTableInstance.get_default()
        pad = GamepadSim(0)
        Station.set_robot_mode(hal.RobotMode.TELEOPERATED)
        Station.set_alliance_station_id(hal.AllianceStationID.BLUE_2)
        Station.set_event_name("event")
        Station.set_game_data("LR")
        Station.set_enabled(True)
        Station.set_ds_attached(True)
        packet()
        for number, value in enumerate(INPUTS):
            pad.set_left_x(value)
            pad.set_left_y(-value)
            pad.set_left_trigger_axis(value)
            pad.set_face_down_button(value < -0.5)
            if number == 4:
                network.get_entry("/Tunables/gain").set_double(7.5)
                network.get_entry("/Tunables/count").set_integer(8)
                network.get_entry("/Tunables/on").set_boolean(True)
                network.get_entry("/Tunables/start/selected/tune").set_string("right")
                network.get_entry("/Tunables/arm/angle").set_double(0.25)
            packet()
            note("alerts", [(each.group, each.id, each.text, each.level) for each in AlertSim.get_active()])
            for topic in sorted(network.get_topics(), key=lambda topic: topic.get_name()):
                name = topic.get_name()
                entry = network.get_entry(name)
                value = "" if name == "/Robot/ProgramStartTime" else entry.get_value().value()
                note(name, topic.get_type_string(), topic.get_properties(), value)
"""

#: What differs: times of day; joysticks, of which pyfrc has plugged in six; the event, which has a name in pyfrc.
OTHERWISE = re.compile(r"systemTime|.*/ProgramStartTime|DS:joystick[1-5]/.*|.*/EventName")


def test_what_robots_read_publish_and_log_is_as_in_wpilibs_loop(make_project: MakeProject) -> None:
    project = compare(make_project, ROBOT, PLAN)
    by_wpilib, ours = (records(project.path / f"logs_of_{who}" / "robot.wpilog") for who in ("wpilib", "pyfrc"))
    assert ours == by_wpilib
    assert {"/own", "messages", "DS:controlWord", "NT:/Telemetry/pose", "NT:/Tunables/gain"} <= {*ours}


def records(file: Path) -> dict[str, list[Any]]:
    """Of each entry of a log: its type and metadata; time and value of each record.

    A schema has no time here: a thread of WPILib writes it, before or after the next packet.
    """
    reader = DataLogReader(str(file))
    assert reader.is_valid(), file
    names: dict[int, str] = {}
    found: dict[str, list[Any]] = {}
    for record in reader:
        if record.is_start():
            start = record.get_start_data()
            names[start.entry] = start.name
            found[start.name] = [(start.type, start.metadata)]
        elif not record.is_control():
            found[names[record.get_entry()]].append((record.get_timestamp(), bytes(record.get_raw())))
    began = found["/own"][1][0]
    return {
        name: [first, *((0 if name.startswith("/.schema/") else time - began, value) for time, value in rest)]
        for name, (first, *rest) in found.items()
        if not OTHERWISE.fullmatch(name)
    }
