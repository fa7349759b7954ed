"""Telemetry and Tunables of a 2027 robot: on the page, in choosers, on the field, and in fuzz."""

from __future__ import annotations

import re

import ntcore
import pytest
from conftest import MakeProject
from ports import lasting_port
from web_pages import served

ROBOT = {
    "robot.py": """
        import commands2
        import telemetry
        import tunables
        import wpilib
        import wpilib_drivers
        from wpimath import PIDController


        class MyRobot(wpilib.TimedRobot):
            def __init__(self):
                super().__init__()
                self.motor = wpilib_drivers.PWMSparkMax(0)
                self.gain = tunables.add_double("Drive/kP", 0.5)
                self.fast = tunables.add_boolean("fast", False)
                self.count = tunables.add_int("count", 3)
                self.limit = tunables.get_table("Arm").add_double("limit", 2.5, robust=True)
                self.fixed = tunables.add_double("fixed", 7.0, mutable=False)
                self.turn = PIDController(1, 0, 0)
                tunables.publish("Turn", self.turn)
                self.auto = tunables.Selectable()
                self.auto.add_default("Nothing", 0.0)
                self.auto.add("Forward", 1.0)
                tunables.publish("Auto", self.auto)

            def robot_periodic(self):
                telemetry.log("sum", self.gain.get() + self.limit.get() + self.fixed.get() + self.turn.get_p())

            def disabled_periodic(self):
                pass

            def autonomous_periodic(self):
                self.motor.set_throttle(self.auto.get_selected())

            def teleop_periodic(self):
                if self.fast.get() and self.count.get() == 0:
                    raise ValueError("no count")
    """,
    "physics.py": """
        class PhysicsEngine:
            def __init__(self, controller, robot):
                pass

            def update_sim(self, now, tm_diff):
                pass
    """,
    "sim/config.json": """
        {"pyfrc": {"robot": {"start_positions": [{"name": "left", "x": 2, "y": 3},
                                                 {"name": "far", "x": 50, "y": 3, "angle": 180}]}}}
    """,
}


def test_what_is_tuned_on_the_page_reaches_the_robot(make_project: MakeProject) -> None:
    with served(make_project(ROBOT)) as server, server.page() as page:
        page.run_for(0.1)
        assert page.values["nt:/Telemetry/sum"] == 0.5 + 2.5 + 7 + 1
        tuned = {"nt:/Tunables/Drive/kP": 10, "nt:/Tunables/Arm/limit/value": 100, "nt:/Tunables/Turn/p": 1000}
        page.command("write", values=tuned)
        page.run_for(0.1)
        assert page.values["nt:/Telemetry/sum"] == 10 + 100 + 7 + 1000
        assert page.values["nt:/Tunables/Arm/limit/value"] == 100  # a robust one: the robot says what it has taken


@pytest.mark.parametrize("entry", ["/Tunables/fixed", "/Telemetry/sum"])
def test_what_cannot_be_tuned_is_said(entry: str, make_project: MakeProject) -> None:
    with served(make_project(ROBOT)) as server, server.page() as page:
        page.run_for(0.1)
        page.command("write", values={f"nt:{entry}": 1.0})
        page.run_for(0.1)
        assert f"nt:{entry} = 1.0: robot code" in page.status["note"]
        assert page.values["nt:/Telemetry/sum"] == 11


def test_a_chooser_is_chosen_and_stays_chosen_when_the_robot_restarts(make_project: MakeProject) -> None:
    chooser = {"name": "/Tunables/Auto", "options": ["Nothing", "Forward"], "default": "Nothing"}
    with served(make_project(ROBOT)) as server, server.page() as page:
        page.run_for(0.1)
        assert page.parts["choosers"] == [{**chooser, "active": "Nothing"}]
        page.command("choose", chooser="/Tunables/Auto", option="Forward")
        page.command("choose_mode", mode="autonomous")
        page.command("enable")
        page.run_for(0.1)
        assert page.parts["choosers"] == [{**chooser, "active": "Forward"}]
        assert page.values["pwm[0].value"] == 1
        page.command("restart")
        page.until(lambda: page.parts["run"]["number"] == 2)
        page.command("enable")
        page.run_for(0.1)
        assert page.values["pwm[0].value"] == 1


def test_a_dashboard_tunes_and_chooses(make_project: MakeProject) -> None:
    port = lasting_port()
    with served(make_project(ROBOT), nt_port=port, speed=1, paused=False) as server, server.page() as page:
        tables = ntcore.NetworkTableInstance.create()
        try:
            tables.start_client("dashboard")
            tables.set_server("127.0.0.1", port)
            seen = ntcore.MultiSubscriber(tables, ["/Tunables/"])
            page.until(lambda: tables.get_topic("/Tunables/Auto/options").exists())
            # What WPILib's dashboards write: of robust tunables, as of a chooser, the entry "tune".
            publishers = [
                tables.get_string_topic("/Tunables/Auto/selected/tune").publish(),
                tables.get_double_topic("/Tunables/Arm/limit/tune").publish(),
                tables.get_double_topic("/Tunables/Drive/kP").publish(),
            ]
            for publisher, value in zip(publishers, ("Forward", 100.0, 10.0), strict=True):
                publisher.set(value)
            page.until(lambda: page.values.get("nt:/Telemetry/sum") == 10 + 100 + 7 + 1)
            page.until(lambda: page.parts["choosers"][0]["active"] == "Forward")
            seen.close()
        finally:
            ntcore.NetworkTableInstance.destroy(tables)


def test_the_robot_begins_at_its_start_and_is_placed_on_the_field(make_project: MakeProject) -> None:
    with served(make_project(ROBOT), start_position="far") as server, server.page() as page:
        page.run_for(0.1)
        assert page.parts["robot"] == pytest.approx([50, 3, 3.14159265])
        page.command("place", x=10, y=12, degrees=90)
        page.run_for(0.1)
        assert page.parts["robot"] == pytest.approx([10, 12, 1.57079632])
        assert page.values["nt:/Tunables/Field/Robot/0/translation/x"] == pytest.approx(3.048)


@pytest.mark.slow
def test_fuzz_varies_what_the_robot_tunes(make_project: MakeProject) -> None:
    project = make_project(ROBOT)
    result = project.run("fuzz", "--runs", "100", "--seed", "1", "-j", "1")
    assert re.search(r"robot\.py:\d+: ValueError: no count", result.output), result.output
    (script,) = (project.path / "tests" / "fuzz").glob("valueerror*.jsonl")
    assert '/Tunables/count": 0' in script.read_text("utf-8")
    assert "ValueError: no count" in project.run("replay", f"tests/fuzz/{script.name}").output
