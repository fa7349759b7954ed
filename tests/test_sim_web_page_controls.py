"""The page of `pyfrc sim --ui web` in a real browser: all kinds of devices, controls by mouse, touch and keys."""

from __future__ import annotations

import math
from typing import Any

import pytest
from browser_pages import Seen, page_of
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

#: Two gamepads of the same name, and one that the browser has no layout for.
PADS = """
    window.fakePads = [0, 1].map((index) => ({
      id: "Twin Pad (STANDARD GAMEPAD Vendor: 1 Product: 2)", index, connected: true, mapping: "standard", timestamp: 1,
      axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 }, () => ({ pressed: false, value: 0, touched: false })),
    })).concat([{ id: "Old Stick", index: 2, connected: true, mapping: "", timestamp: 1,
                  axes: [0.25, 0.5], buttons: [{ pressed: true, value: 1, touched: true }] }]);
    Object.defineProperty(navigator, "getGamepads", { value: () => window.fakePads });
"""


#: Finds where the field's canvas shows the robot: the middle one of the places at which the pointer would be a hand. A
#: real mouse at each of these thousands of places would take a minute.
PLACE_OF_ROBOT = """(canvas) => {
    const box = canvas.getBoundingClientRect();
    const found = [];
    for (let y = 10; y < box.height; y += 12) {
        for (let x = 10; x < box.width; x += 12) {
            const place = { clientX: box.left + x, clientY: box.top + y, bubbles: true };
            canvas.dispatchEvent(new PointerEvent("pointermove", place));
            if (canvas.style.cursor === "grab") found.push([x, y]);
        }
    }
    return found[Math.floor(found.length / 2)];
}"""


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


def test_joysticks_by_keys(browser, server) -> None:
    with page_of(browser, server, script=PADS) as person:
        page = person.page
        person.button("Enable").click()
        trigger = page.locator(".stick-button", has_text="Trigger")
        for key in ("Enter", "Space"):  # neither disables nor stops the robot here
            trigger.focus()
            page.keyboard.down(key)
            person.until(lambda: person.value("joysticks[0].buttons")[1] is True)
            page.keyboard.up(key)
            person.until(lambda: person.value("joysticks[0].buttons")[1] is False)
        person.state("Teleoperated enabled")
        page.get_by_label("POV 90°").focus()
        page.keyboard.down("Enter")
        person.until(lambda: person.value("joysticks[0].povs")[0] == 90)
        page.keyboard.up("Enter")
        person.until(lambda: person.value("joysticks[0].povs")[0] == -1)
        page.get_by_label("POV 180°").click(button="right")
        person.until(lambda: person.value("joysticks[0].povs")[0] == 180)
        page.locator(".pov .pressed", has_text="↓").wait_for()
        page.get_by_label("POV 180°").click(button="right")
        person.until(lambda: person.value("joysticks[0].povs")[0] == -1)
        choice = page.get_by_label("Gamepad of joystick 0")
        choice.select_option("none")
        axis = page.get_by_role("slider", name="Axis").nth(1)
        axis.focus()
        axis.press("End")
        person.until(lambda: person.value("joysticks[0].axes")[1] == 1)
        axis.dblclick()
        person.until(lambda: person.value("joysticks[0].axes")[1] == 0)
        # Two of the same name can be chosen separately. A gamepad without a standard layout keeps its own numbers.
        names = ["Automatic: no gamepad", "Keyboard and mouse only", "Twin Pad", "Twin Pad", "Old Stick"]
        expect(choice.locator("option")).to_have_text(names)
        choice.select_option(label="Old Stick")
        person.until(lambda: list(person.value("joysticks[0].axes")[:2]) == [0.25, 0.5])
        person.until(lambda: person.value("joysticks[0].buttons")[1] is True)
        page.evaluate("window.fakePads = []")
        choice.locator("option", has_text="Old Stick (not connected)").wait_for(state="attached")


def test_menus_tabs_and_borders_by_keys_and_mouse(person: Seen) -> None:
    page = person.page
    menu = page.get_by_title("Layout", exact=True)
    menu.focus()
    for key in ("Enter", "ArrowDown", "ArrowDown", "ArrowUp", "Escape"):
        page.keyboard.press(key)
    page.locator(".menu-list:popover-open").wait_for(state="detached")
    expect(menu).to_be_focused()
    page.keyboard.press("Enter")
    page.locator(".menu-list:popover-open").wait_for()
    for key in ("ArrowDown", "ArrowDown", "ArrowDown", "Enter"):
        page.keyboard.press(key)
    expect(menu).to_have_text("Tuning")
    first = page.get_by_role("tablist").nth(0).get_by_role("tab").first
    border = page.locator("[role=separator][aria-orientation=vertical]").first
    before = border.bounding_box()["x"]
    person.drag(border, (0.5, 0.5), (-20, 0.5))
    page.wait_for_function(
        "x => document.querySelector('[role=separator][aria-orientation=vertical]').getBoundingClientRect().x < x - 20",
        arg=before,
    )
    first.focus()
    name = first.inner_text()
    page.keyboard.press("ArrowRight")
    expect(person.tab(name)).to_have_attribute("aria-selected", "false")
    page.keyboard.press("ArrowLeft")
    expect(person.tab(name)).to_be_focused()
    page.keyboard.press("Delete")
    person.tab(name).wait_for(state="detached")
    person.choose("Layout", "Reset this layout")
    person.tab(name).wait_for()


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


def test_the_field_is_moved_zoomed_and_turned_round(person: Seen) -> None:
    page = person.page
    field = page.locator(".field-canvas")
    box = field.bounding_box()
    page.keyboard.press("F5")

    def robot_at(x: float, y: float) -> str:
        """The pointer's form there: a hand on the robot only."""
        page.mouse.move(box["x"] + x, box["y"] + y)
        return field.evaluate("element => element.style.cursor")

    x, y = field.evaluate(PLACE_OF_ROBOT)
    assert robot_at(x, y) == "grab"
    robot = person.simulation.snapshot.scene.robot
    page.mouse.move(box["x"] + x + 80, box["y"] + y + 60)  # beside the robot
    page.mouse.down()
    page.mouse.move(box["x"] + x + 140, box["y"] + y + 60, steps=3)
    page.mouse.up()
    assert robot_at(x + 60, y) == "grab"
    page.get_by_label("Show the whole field").click()
    assert robot_at(x, y) == "grab"
    person.choose("What is drawn", "Turn the field round")
    assert robot_at(box["width"] - x, box["height"] - y) == "grab"
    person.choose("What is drawn", "Turn the field round")
    field.focus()
    page.keyboard.press("Shift+ArrowRight")
    person.until(lambda: person.simulation.snapshot.scene.robot.angle == pytest.approx(robot.angle + math.radians(15)))
    page.keyboard.press("ArrowUp")
    person.until(lambda: person.simulation.snapshot.scene.robot.y == pytest.approx(robot.y - 0.25))
