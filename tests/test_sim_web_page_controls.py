"""The page of `pyfrc sim --ui web` in a real browser: all kinds of devices, controls by mouse, touch and keys."""

from __future__ import annotations

import math
from typing import Any

import pytest
from browser_pages import Seen
from playwright.sync_api import expect
from web_pages import served

#: A robot with a device of each kind that the page draws in its own way, and with what has a card on the dashboard.
ROBOT = {
    "robot.py": """
        import commands2
        import wpilib
        import wpiutil
        from wpimath.controller import PIDController


        class Lamp(wpiutil.Sendable):
            on = False

            def initSendable(self, builder):
                builder.setSmartDashboardType("Lamp")
                builder.addBooleanProperty("on", lambda: self.on, lambda on: setattr(self, "on", on))
                builder.addStringProperty("colour", lambda: "red", lambda _: None)


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.stick = wpilib.Joystick(0)
                self.motor = wpilib.PWMSparkMax(0)
                self.relay = wpilib.Relay(0)
                self.solenoid = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.CTREPCM, 0, 1)
                self.power = wpilib.PowerDistribution(0, wpilib.PowerDistribution.ModuleType.kCTRE)
                self.encoder = wpilib.Encoder(0, 1)
                self.strip = wpilib.AddressableLED(9)
                self.strip.setLength(3)
                self.strip.setData([wpilib.AddressableLED.LEDData(255, 0, 0)] * 3)
                self.strip.start()
                self.turn, self.lamp = PIDController(2, 0, 0), Lamp()
                wpilib.SmartDashboard.putData("Turn", self.turn)
                wpilib.SmartDashboard.putData("Lamp", self.lamp)
                wpilib.SmartDashboard.putNumberArray("gains", [1.0, 2.0])
                self.score = commands2.cmd.run(lambda: None).ignoringDisable(True).withName("Score")
                wpilib.SmartDashboard.putData("Score", self.score)
                for number in range(200):
                    print("line", number)

            def robotPeriodic(self):
                commands2.CommandScheduler.getInstance().run()

            def disabledPeriodic(self):
                pass

            def teleopPeriodic(self):
                self.motor.set(-self.stick.getY())
                self.relay.set(wpilib.Relay.Value.kReverse)
                self.solenoid.set(wpilib.DoubleSolenoid.Value.kForward)
                if self.stick.getRawButton(5):
                    raise ValueError("button 5")
    """,
    "physics.py": """
        class PhysicsEngine:
            def __init__(self, controller, robot):
                pass

            def update_sim(self, now, tm_diff):
                pass
    """,
    "sim/config.json": """
        {"pyfrc": {"robot": {"starting_x": 10, "starting_y": 12, "starting_angle": 0},
                   "field": {"objects": [{"color": "gray", "points": [[1, 1], [5, 1], [5, 5]]}]}}}
    """,
}


@pytest.fixture(scope="module", name="server")
def server_of_many_devices(make_shared_project):
    with served(make_shared_project(ROBOT), speed=1, paused=False) as server:
        yield server


def script_writes(person: Seen, path: str) -> list[Any]:
    """Return what was set so far in this run."""
    return [step.writes[path] for step in person.simulation.script().steps if path in step.writes]


def test_each_kind_of_device_shows_and_takes_its_value(person: Seen) -> None:
    page = person.page
    person.button("Enable").click()
    expect(person.row("relay[0].fwd").locator(".word")).to_have_text("reverse")
    expect(person.row("pcm[0][0].value").locator(".lamp").first).to_have_class("lamp on")
    expect(person.row("pcm[0][0].value").locator(".lamp.on")).to_have_count(1)
    expect(person.row("addressable_led[0].data").locator("i").first).to_have_attribute(
        "style", "background: rgb(255, 0, 0);"
    )
    person.simulation.write({"pdp[0].current": [40.0, *[0.0] * (len(person.value("pdp[0].current")) - 1)]})
    page.wait_for_function(
        "() => parseFloat(document.querySelector(\"[data-path='pdp[0].current'] i\")?.style.height) > 5"
    )
    count = person.row("encoder[0].count").locator("input")
    person.set_number(count, "12")
    person.until(lambda: person.value("encoder[0].count") == 12)
    count.click()
    count.fill("99")
    count.press("Escape")
    person.shows(count, "12")
    person.row("fpga_button").locator("input").check()
    person.until(lambda: person.value("fpga_button") is True)
    fold = page.locator(".fold", has_text="Relay")
    fold.click()
    person.row("relay[0].fwd").wait_for(state="detached")
    fold.click()
    person.row("relay[0].fwd").wait_for()
    person.row("relay[0].fwd").hover()
    person.row("relay[0].fwd").get_by_title("Plot this value").click()
    page.locator(".curve-name").first.wait_for()
    person.button("Clear").first.click()
    page.locator(".curve-name").first.wait_for(state="detached")


def test_joysticks_by_mouse_and_keys(person: Seen) -> None:
    page = person.page

    def value(kind: str, number: int = 0) -> Any:
        return person.value(f"joysticks[0].{kind}")[number]

    person.button("Enable").click()
    box = page.get_by_label("Axes 0 and 1").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 16, steps=3)
    person.until(lambda: value("axes", 1) == -1)
    page.mouse.up()
    person.until(lambda: value("axes", 1) == 0)
    trigger = page.locator(".stick-button", has_text="Trigger")
    trigger.hover()
    page.mouse.down()
    person.until(lambda: value("buttons", 1))
    page.locator(".stick-button.pressed", has_text="Trigger").wait_for()
    page.mouse.up()
    person.until(lambda: not value("buttons", 1))
    page.locator(".stick-button.pressed", has_text="Trigger").wait_for(state="detached")
    for key in ("Enter", "Space"):  # neither disables nor stops the robot here
        trigger.focus()
        page.keyboard.down(key)
        person.until(lambda: value("buttons", 1))
        page.keyboard.up(key)
        person.until(lambda: not value("buttons", 1))
    person.state("Teleoperated enabled")
    trigger.click(button="right")
    person.until(lambda: value("buttons", 1))
    right = page.get_by_label("POV 90°")
    right.hover()
    page.mouse.down()
    person.until(lambda: value("povs") == 90)
    page.mouse.up()
    person.until(lambda: value("povs") == -1)
    right.focus()
    page.keyboard.down("Enter")
    person.until(lambda: value("povs") == 90)
    page.keyboard.up("Enter")
    person.until(lambda: value("povs") == -1)
    page.get_by_label("POV 180°").click(button="right")
    person.until(lambda: value("povs") == 180)
    page.locator(".pov .pressed", has_text="↓").wait_for()
    page.get_by_label("POV 180°").click(button="right")
    person.until(lambda: value("povs") == -1)
    axis = page.get_by_role("slider", name="Axis").nth(1)
    axis.focus()
    axis.press("End")
    person.until(lambda: value("axes", 1) == 1)
    axis.dblclick()
    person.until(lambda: value("axes", 1) == 0)
    page.get_by_role("tab", name="1", exact=True).click()
    page.get_by_label("Plugged in").uncheck()
    person.until(lambda: person.value("joysticks[1].axes") is None)
    # A control that loses the keyboard is released.
    person.tab("Touch sticks").click()
    for control, key, kind in (
        (page.get_by_label("Left stick"), "ArrowUp", "axes"),
        (page.get_by_role("button", name="2", exact=True), "Enter", "buttons"),
    ):
        control.focus()
        page.keyboard.down(key)
        person.until(lambda kind=kind: any(person.value(f"joysticks[0].{kind}")[2 * (kind == "buttons") :]))
        control.blur()
        person.until(lambda kind=kind: not any(person.value(f"joysticks[0].{kind}")[2 * (kind == "buttons") :]))


def test_the_dashboard_runs_commands_and_sets_values(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Tuning")
    command = page.locator(".card.command", has_text="Score")
    command.get_by_role("button", name="Run").click()
    command.get_by_role("button", name="Cancel").click()
    command.get_by_role("button", name="Run").wait_for()
    turn = page.locator(".card", has_text="PIDController")
    turn.get_by_label("More p", exact=True).click()
    person.shows(turn.get_by_label("p", exact=True), "2.1")
    turn.get_by_label("Less p", exact=True).click()
    person.shows(turn.get_by_label("p", exact=True), "2")
    lamp = page.locator(".card", has_text="Lamp")
    lamp.get_by_role("switch", name="on").check()
    person.until(lambda: script_writes(person, "nt:/SmartDashboard/Lamp/on") == [True])
    person.tab("NetworkTables").click()
    gains = person.row("nt:/SmartDashboard/gains").locator("input")
    for wrong in ("[1, 2", '["one"]', "3"):
        person.set_number(gains, wrong)
        page.locator("[data-path='nt:/SmartDashboard/gains'] input.wrong").wait_for()
        gains.press("Escape")
    person.set_number(gains, "[3, 4.5]")
    person.until(lambda: [list(each) for each in script_writes(person, "nt:/SmartDashboard/gains")] == [[3, 4.5]])
    folder = page.locator(".nt-row.folder button", has_text="Turn")
    row = page.locator("[data-path='nt:/SmartDashboard/Turn/p']")
    folder.click()
    row.wait_for()
    folder.click()
    row.wait_for(state="detached")


def test_the_field_is_moved_zoomed_and_turned_round_and_the_robot_on_it_is_placed(person: Seen) -> None:
    page = person.page
    field = page.locator(".field-canvas")
    box = field.bounding_box()
    page.keyboard.press("F5")
    page.locator(".pose b", has_text="10.00 ft").wait_for()

    def robot() -> Any:
        return person.simulation.snapshot.scene.robot

    def at(x: float, y: float) -> tuple[float, float]:
        """Return where a place on the field is on the page: the field of 54 by 26.4 feet has a margin around it."""
        size = person.simulation.field
        scale = 0.93 * min(box["width"] / size.width, box["height"] / size.height)
        return box["width"] / 2 + (x - size.width / 2) * scale, box["height"] / 2 + (y - size.height / 2) * scale

    def pointer_at(x: float, y: float) -> str:
        """Return the pointer's form there: a hand on the robot only."""
        page.mouse.move(box["x"] + x, box["y"] + y)
        return field.evaluate("element => element.style.cursor")

    def drag(start: tuple[float, float], end: tuple[float, float], button: str = "left") -> None:
        shares = [(x / box["width"], y / box["height"]) for x, y in (start, end)]
        person.drag(field, *shares, button=button)

    x, y = at(10, 12)
    assert pointer_at(x, y) == "grab"
    drag((x + 80, y + 60), (x + 140, y + 60))  # beside the robot
    assert pointer_at(x + 60, y) == "grab"
    page.mouse.wheel(0, -600)
    page.get_by_label("Show the whole field").click()
    assert pointer_at(x, y) == "grab"
    person.choose("What is drawn", "Turn the field round")
    assert pointer_at(box["width"] - x, box["height"] - y) == "grab"
    person.choose("What is drawn", "Turn the field round")
    page.get_by_title("What is drawn").click()
    page.get_by_role("menuitemcheckbox", name="AprilTags").click()
    drag((x, y), at(30, 10))
    person.until(lambda: robot()[:2] == pytest.approx((30, 10), abs=0.5))
    page.locator(".pose b", has_text=f"{robot().x:.2f} ft").wait_for()  # it is drawn there, too
    drag(at(*robot()[:2]), at(robot().x - 8, robot().y), button="right")
    person.until(lambda: abs(robot().angle) == pytest.approx(math.pi, abs=0.2))
    before = robot()
    field.focus()
    for key, moved in (
        ("ArrowRight", (0.25, 0, 0)),
        ("ArrowUp", (0.25, -0.25, 0)),
        ("Shift+ArrowLeft", (0.25, -0.25, -math.radians(15))),
    ):
        page.keyboard.press(key)
        there = [each + by for each, by in zip(before, moved, strict=True)]
        person.until(lambda there=there: robot() == pytest.approx(there, abs=0.01))
        person.drawn()  # the next key moves it from where the page has it
