"""`pyfrc sim` with an `OpModeRobot`: opmodes are chosen, kept by recordings and going back, and shown on the page."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject
from test_docs import commands, files
from web_pages import Page, served

ROBOT = {
    "robot.py": """
        import wpilib
        import wpilib_drivers


        class MyRobot(wpilib.OpModeRobot):
            def __init__(self):
                super().__init__()
                self.motor = wpilib_drivers.PWMSparkMax(1)


        class Turning(wpilib.PeriodicOpMode):
            speed = 0.0

            def __init__(self, robot: MyRobot):
                super().__init__()
                self.robot = robot

            def periodic(self):
                self.robot.motor.set_throttle(self.speed)


        @wpilib.autonomous(name="Left", group="Turns", description="Turn to the left")
        class Left(Turning):
            speed = -0.5


        @wpilib.autonomous
        class Forward(Turning):
            speed = 0.25


        @wpilib.teleop
        class Drive(Turning):
            speed = 1.0


        @wpilib.utility
        class Check(Turning):
            speed = 0.125
    """
}
MOTOR = "pwm[1].value"


def changes_of(script: Path, path: str) -> list[tuple[float, Any]]:
    """Return the moments and values of what a recorded robot wrote."""
    trace = script.with_suffix(".trace.jsonl").read_text("utf-8").splitlines()[1:-1]
    lines = [json.loads(line) for line in trace]
    return [(line["t"], line["set"][path]) for line in lines if path in line["set"]]


@pytest.mark.parametrize(
    ("arguments", "motor"),
    [
        (("--mode", "auto"), 0.25),  # the first one: those without a group come first
        (("--mode", "auto", "--opmode", "Left", "--opmode", "Drive"), -0.5),
        (("--mode", "teleop", "--opmode", "Left", "--opmode", "Drive"), 1.0),
        (("--mode", "test"), 0.125),
    ],
)
def test_a_mode_without_a_window_runs_its_opmode(
    arguments: tuple[str, ...], motor: float, make_project: MakeProject
) -> None:
    project = make_project(ROBOT)
    result = project.run("sim", *arguments, "--seconds", "1", "--record", "run.jsonl")
    assert result.code == 0, result.output
    assert changes_of(project.path / "run.jsonl", MOTOR)[-1][1] == motor
    assert "The trace equals the recorded one." in project.run("replay", "run.jsonl").stdout


@pytest.mark.slow
def test_a_practice_match_runs_the_opmode_of_each_mode(make_project: MakeProject) -> None:
    project = make_project(ROBOT)
    result = project.run("sim", "--mode", "practice", "--opmode", "Left", "--record", "run.jsonl")
    assert result.code == 0, result.output
    chosen = [name for _, name in changes_of(project.path / "run.jsonl", "control.opmode")]
    assert chosen == ["Left", "Drive"]  # each from the pause before its mode
    assert "The trace equals the recorded one." in project.run("replay", "run.jsonl").stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--mode", "auto", "--opmode", "Right"), "no opmode 'Right': the robot has published 'Forward', 'Left'"),
        (("--mode", "auto", "--opmode", "Drive"), "'Drive' is not for it"),
        (("--ui", "none", "--opmode", "Left"), "without a window, --opmode needs --mode"),
        (("--mode", "auto", "--opmode", "Left", "--script", "run.jsonl"), "--script are mutually exclusive"),
    ],
)  # fmt: skip
def test_what_cannot_be_chosen(arguments: tuple[str, ...], said: str, make_project: MakeProject) -> None:
    project = make_project({**ROBOT, "run.jsonl": '{"format": "pyfrc-input 1", "robot": "robot.py", "end": 1}\n'})
    result = project.run("sim", *arguments)
    assert result.code == 2
    assert said in result.output


@pytest.mark.slow
def test_the_guides_example_works(make_project: MakeProject) -> None:
    project = make_project(files("docs/how_to/use_opmodes.md"))
    guide = commands("docs/how_to/use_opmodes.md")
    assert len(guide) == 2
    for command in guide:
        result = project.run(*shlex.split(command)[1:], "--record", "run.jsonl")
        assert result.code == 0, result.output
        assert "Leave the line" in dict(map(reversed, changes_of(project.path / "run.jsonl", "control.opmode")))


def runs(page: Page, mode: str, opmode: str, motor: float) -> None:
    page.command("enable")
    page.run_for(0.1)
    page.until(lambda: (page.station["mode"], page.station["opmode"]) == (mode, opmode))
    assert page.values[MOTOR] == motor


def test_the_page_offers_opmodes_and_chooses_them(make_project: MakeProject) -> None:
    with served(make_project(ROBOT)) as server, server.page() as page:
        assert page.hello["options"]["modes"]["test"] == "Utility"
        page.until(lambda: page.parts.get("opmodes"))
        offered = [(each["mode"], each["group"], each["name"]) for each in page.parts["opmodes"]]
        assert offered == [
            ("autonomous", "", "Forward"),
            ("autonomous", "Turns", "Left"),
            ("teleop", "", "Drive"),
            ("test", "", "Check"),
        ]
        page.until(lambda: page.station["opmode"] == "Drive")  # as soon as the robot runs
        runs(page, "teleop", "Drive", 1.0)
        page.command("choose_mode", mode="autonomous")
        page.command("choose_opmode", mode="autonomous", opmode="Left")
        runs(page, "autonomous", "Left", -0.5)
        page.command("choose_opmode", mode="autonomous", opmode="Forward")
        page.until(lambda: (page.station["mode"], page.station["opmode"]) == ("disabled autonomous", "Forward"))
        page.command("choose_opmode", mode="teleop", opmode="")  # for later: the robot's mode is another one
        runs(page, "autonomous", "Forward", 0.25)
        page.command("choose_mode", mode="teleop")
        runs(page, "teleop", "", 0.25)  # no opmode sets the motor
        page.command("choose_opmode", mode="teleop", opmode="Left")
        page.until(lambda: "no opmode 'Left' for teleop" in page.status["note"])


def test_a_choice_is_kept_by_a_restart_and_by_going_back(make_project: MakeProject) -> None:
    with served(make_project(ROBOT)) as server, server.page() as page:
        page.until(lambda: page.station.get("opmode") == "Drive")
        page.command("choose_mode", mode="autonomous")
        page.command("choose_opmode", mode="autonomous", opmode="Left")
        runs(page, "autonomous", "Left", -0.5)
        page.command("choose_opmode", mode="autonomous", opmode="Forward")
        runs(page, "autonomous", "Forward", 0.25)
        page.command("rewind", t=0.1)
        page.until(lambda: page.parts["run"]["number"] == 2 and page.station["opmode"] == "Left")
        page.run_for(0.1)  # the robot is enabled, as it was at that moment
        assert page.values[MOTOR] == -0.5
        page.command("choose_mode", mode="test")
        page.command("restart")
        page.until(lambda: page.parts["run"]["number"] == 3 and page.station["opmode"] == "Check")
        page.command("choose_mode", mode="autonomous")
        page.until(lambda: page.station["opmode"] == "Left")


def test_a_robot_without_opmodes_offers_none(make_project: MakeProject) -> None:
    robot = {"robot.py": "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"}
    with served(make_project(robot)) as server, server.page() as page:
        page.command("enable")
        page.run_for(0.1)
        assert (page.parts["opmodes"], page.station["opmode"]) == ([], "")


DEVICES = {
    "robot.py": """
        import telemetry
        import wpilib


        class MyRobot(wpilib.TimedRobot):
            def __init__(self):
                super().__init__()
                self.stick = wpilib.Gamepad(0)
                self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)

            def robot_periodic(self):
                telemetry.log("down", self.stick.get_face_down_button())
                telemetry.log("dpad", self.stick.get_dpad_right_button())
                telemetry.log("right", self.stick.get_right_x())
                telemetry.log("yaw", self.imu.get_yaw())
    """
}


def test_joysticks_have_the_numbers_of_2027(make_project: MakeProject) -> None:
    with served(make_project(DEVICES)) as server, server.page() as page:
        options = page.hello["options"]
        assert options["buttons"] == {"first": 0, "most": 32}
        assert options["joysticks"][0]["buttons"] == {}  # a Gamepad's
        assert (options["keyboard"]["button_keys"]["0"], options["keyboard"]["button_keys"]["9"]) == (0, 9)
        order = options["gamepad"]
        page.command("enable")
        for name in ("a", "right"):
            page.command("button", stick=0, button=order["buttons"].index(name), pressed=True)
        page.command("axis", stick=0, axis=order["axes"].index("right_x"), value=-1)
        page.run_for(0.1)
        assert page.values["nt:/Telemetry/down"]
        assert page.values["nt:/Telemetry/dpad"]
        assert page.values["nt:/Telemetry/right"] == -1
        page.until(lambda: {"press"} <= {mark["kind"] for mark in page.marks})
        assert "joystick 0, button 0" in [mark["text"] for mark in page.marks]


def test_the_controllers_imu_is_among_the_gyros(make_project: MakeProject) -> None:
    with served(make_project(DEVICES)) as server, server.page() as page:
        page.run_for(0.1)
        panels = {panel["title"]: [row["label"] for row in panel["rows"]] for panel in page.parts["panels"]}
        assert panels["Gyros"][:2] == ["Yaw", "Angle x"]
        assert len(panels["Gyros"]) == 10
        assert "Relays" not in panels
        page.command("write", values={"onboard_imu.yaw": 0.5})
        page.run_for(0.1)
        assert page.values["nt:/Telemetry/yaw"] == 0.5
