"""The page of `pyfrc sim` in a real browser: driving, the field, devices, NetworkTables, joysticks."""

from __future__ import annotations

import pytest
from browser_pages import CHOOSER, Seen, page_of

PADS = """
    window.fakePads = [];
    navigator.getGamepads = () => window.fakePads;
    window.plug = (axes, buttons) => {
      window.fakePads = [{
        id: "Test Pad (STANDARD GAMEPAD Vendor: 1234 Product: 5678)", index: 0, connected: true, mapping: "standard",
        vibrationActuator: { playEffect: async (kind, effect) => { window.rumbled = effect; } },
        axes, buttons: Array.from({ length: 17 }, (_, index) => ({
          pressed: buttons.includes(index), value: buttons.includes(index) ? 1 : 0, touched: false })),
      }];
    };
"""


def test_driving_by_buttons_and_keys(person: Seen) -> None:
    page = person.page
    person.state("Teleoperated disabled")
    person.button("Enable").click()
    person.state("Teleoperated enabled")
    page.keyboard.down("w")
    person.until(lambda: person.value("pwm[0].value") == 1)
    page.locator("[data-path='pwm[0].value'] .number", has_text="1.00").wait_for()
    page.keyboard.down("Shift")
    person.until(lambda: person.value("pwm[0].value") == pytest.approx(0.4, abs=0.01))
    page.keyboard.up("w")
    page.keyboard.up("Shift")
    person.until(lambda: person.value("pwm[0].value") == 0)
    page.keyboard.press("Enter")
    person.state("Teleoperated disabled")
    page.get_by_role("radio", name="Auto").click()
    person.state("Autonomous disabled")
    for key in ("[", "]", "\\"):
        page.keyboard.down(key)
    person.state("Autonomous enabled")
    for key in ("[", "]", "\\"):
        page.keyboard.up(key)
    person.button("Disable").click()
    page.keyboard.press("Control+e")
    person.state("Autonomous enabled")
    page.keyboard.press("F8")
    person.state("Driver station lost")
    page.keyboard.press("F8")
    person.state("Autonomous enabled")
    # The space bar is the emergency stop, also after a click on a button.
    page.keyboard.press(" ")
    person.state("Emergency stopped")
    assert person.button("Enable").is_disabled()
    page.keyboard.press("F9")
    person.state("disabled")


def test_keys_remind_that_the_robot_is_disabled(person: Seen) -> None:
    page = person.page
    page.keyboard.press("w")
    page.get_by_text("Enable the robot first: Ctrl+E").wait_for()
    page.keyboard.press("Control+e")
    person.state("Teleoperated enabled")
    page.get_by_text("Enable the robot first").wait_for(state="detached")
    page.keyboard.press("Enter")
    person.state("Teleoperated disabled")
    page.get_by_text("Enable the robot first").wait_for(state="detached")


def test_a_practice_match_and_the_choices_before_it(person: Seen) -> None:
    page = person.page
    page.get_by_label("Alliance").select_option("Blue 2")
    person.until(lambda: person.value("alliance_station") == 5)
    page.get_by_label("Game data").fill("LRL")
    page.get_by_label("Game data").press("Enter")
    person.until(lambda: person.value("event.game_specific_message") == "LRL")
    page.get_by_label("Start").select_option("right")
    person.until(lambda: person.simulation.snapshot.scene.robot.y == pytest.approx(20, abs=0.1))
    page.get_by_label(CHOOSER).select_option("Forward")
    person.until(lambda: person.simulation.snapshot.choosers[0].active == "Forward")
    person.button("Practice").click()
    person.state("Autonomous enabled")
    page.locator(".countdown", has_text=":").wait_for()
    person.until(lambda: person.value("pwm[0].value") == 1)
    person.button("Disable").click()
    page.locator(".countdown").wait_for(state="detached")


def test_time_is_paused_stepped_and_scaled(person: Seen) -> None:
    page = person.page
    page.keyboard.press("F5")
    page.get_by_role("button", name="Run", exact=True).first.wait_for()
    person.until(lambda: person.simulation.status.state == "paused")
    before = person.simulation.snapshot.time
    page.keyboard.press("F6")
    person.until(lambda: person.simulation.snapshot.time == pytest.approx(before + 0.02))
    person.button("Step").click()
    person.until(lambda: person.simulation.snapshot.time == pytest.approx(before + 0.04))
    slider = page.get_by_label("Speed", exact=True)
    slider.fill("1")
    person.until(lambda: person.simulation.status.speed == 0)
    page.locator(".speed b", has_text="max").wait_for()
    person.button("Real time").click()
    person.until(lambda: person.simulation.status.speed == 1)
    page.locator(".play").click()
    person.until(lambda: person.simulation.status.state == "running")


def test_the_robot_is_dragged_turned_and_moved_by_keys(person: Seen) -> None:
    field = person.page.locator(".field-canvas")
    person.page.locator(".pose b", has_text="10.00 ft").wait_for()
    person.drawn()
    # The robot at (10, 12) of the field of 54 by 26.4 feet, which has a margin around it.
    box = field.bounding_box()
    scale = 0.93 * min(box["width"] / 54.25, box["height"] / 26.417)

    def share(x: float, y: float) -> tuple[float, float]:
        field_size = person.simulation.field
        return (
            0.5 + (x - field_size.width / 2) * scale / box["width"],
            0.5 + (y - field_size.height / 2) * scale / box["height"],
        )

    def robot():
        return person.simulation.snapshot.scene.robot

    person.drag(field, share(10, 12), share(30, 10))
    person.until(lambda: robot().x == pytest.approx(30, abs=0.5) and robot().y == pytest.approx(10, abs=0.5))
    person.page.locator(".pose b", has_text=f"{robot().x:.2f} ft").wait_for()  # it is drawn there, too
    person.drag(field, share(robot().x, robot().y), share(robot().x - 8, robot().y), button="right")
    person.until(lambda: abs(robot().angle) == pytest.approx(3.14, abs=0.2))
    x = robot().x
    field.focus()
    person.page.keyboard.press("ArrowRight")
    person.until(lambda: robot().x == pytest.approx(x + 0.25, abs=0.01))
    person.page.mouse.wheel(0, -600)
    field.dblclick(position={"x": 5, "y": 5})
    person.page.get_by_title("What is drawn").click()
    person.page.get_by_role("menuitemcheckbox", name="AprilTags").click()


def test_devices_are_found_set_and_pinned(person: Seen) -> None:
    page = person.page
    page.get_by_label("Search devices").fill("range")
    page.locator("[data-path='pwm[0].value']").wait_for(state="detached")
    row = person.row("analog_in[2].voltage")
    person.set_number(row.locator("input.number"), "2,5")
    person.until(lambda: person.value("analog_in[2].voltage") == 2.5)
    slider = row.locator("input[type=range]")
    person.shows(slider, "2.5")
    slider.focus()
    slider.press("Home")
    person.until(lambda: person.value("analog_in[2].voltage") == 0)
    row.hover()
    row.get_by_role("button", name="Pin 2 range finder").click()
    page.get_by_label("Search devices").fill("")
    person.row("dio[3].value").locator("input").uncheck()
    person.until(lambda: person.value("dio[3].value") is False)
    page.locator(".group h3", has_text="Pinned").wait_for()
    # A reload loses nothing.
    page.reload()
    page.locator(".group h3", has_text="Pinned").wait_for()


def test_what_robot_code_publishes_for_the_field_is_understood(person: Seen) -> None:
    found = person.page.evaluate(
        """async () => {
          const { model } = await module("js/model.js");
          const { fieldObjects, swerveStates } = await module("js/field/published.js");
          const { mechanisms } = await module("js/panels/mechanism.js");
          const objects = fieldObjects(model.values, model.hello.field);
          // The physics' field has another name if robot code shows one of its own as "Field".
          const both = ["Field", "Field (physics)"].flatMap((name) => [
            [`nt:/SmartDashboard/${name}/.type`, "Field2d"], [`nt:/SmartDashboard/${name}/Robot`, [1, 2, 0]],
          ]);
          return {
            own: fieldObjects(new Map(both), model.hello.field).map(({ path }) => path),
            physics: fieldObjects(new Map(both.slice(0, 2)), model.hello.field).length,
            objects: objects.map(({ name, poses, isPath }) => [name, poses.length, isPath]).sort(),
            goal: objects.find(({ name }) => name === "goal").poses[0],
            swerve: swerveStates(model.values)[0].states[0],
            mechanism: mechanisms(model.values).map(({ name }) => name),
            alike: mechanisms(new Map([
              ["nt:/Elevator/Drawing/.type", "Mechanism2d"],
              ["nt:/Arm/Drawing/.type", "Mechanism2d"],
            ])).map(({ name }) => name),
          };
        }"""
    )
    assert found["own"] == ["nt:/SmartDashboard/Field/Robot"]
    assert found["physics"] == 0
    assert found["objects"] == [["goal", 1, False], ["path", 12, True], ["tags", 8, False]]
    # From WPILib's metres, y upwards, to feet, y downwards; angles are clockwise.
    height = person.simulation.field.height
    assert found["goal"] == pytest.approx([8 / 0.3048, height - 5.5 / 0.3048, -0.5])
    assert found["swerve"] == pytest.approx({"speed": 1.0, "angle": 0.7})
    assert found["mechanism"] == ["Arm"]
    assert found["alike"] == ["Elevator/Drawing", "Arm/Drawing"]


def test_joysticks_by_mouse(person: Seen) -> None:
    page = person.page
    person.button("Enable").click()
    pad = page.get_by_label("Axes 0 and 1")
    box = pad.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 16, steps=3)
    person.until(lambda: person.value("joysticks[0].axes")[1] == -1)
    page.mouse.up()
    person.until(lambda: person.value("joysticks[0].axes")[1] == 0)
    button = page.locator(".stick-button", has_text="Trigger")
    button.hover()
    page.mouse.down()
    person.until(lambda: person.value("joysticks[0].buttons")[1] is True)
    page.locator(".stick-button.pressed", has_text="Trigger").wait_for()
    page.mouse.up()
    person.until(lambda: person.value("joysticks[0].buttons")[1] is False)
    page.locator(".stick-button.pressed", has_text="Trigger").wait_for(state="detached")
    button.click(button="right")
    person.until(lambda: person.value("joysticks[0].buttons")[1] is True)
    page.get_by_label("POV 90°").hover()
    page.mouse.down()
    person.until(lambda: person.value("joysticks[0].povs")[0] == 90)
    page.mouse.up()
    person.until(lambda: person.value("joysticks[0].povs")[0] == -1)
    page.get_by_role("tab", name="1", exact=True).click()
    page.get_by_label("Plugged in").uncheck()
    person.until(lambda: person.value("joysticks[1].axes") is None)


def test_a_gamepad_moves_a_joystick_until_it_is_unplugged(browser, server) -> None:
    with page_of(browser, server, script=PADS) as person:
        page = person.page
        person.button("Enable").click()
        page.evaluate("plug([0.5, -0.75, 0, 0.25], [1, 5, 12])")
        person.until(lambda: person.value("joysticks[0].axes")[1] == pytest.approx(-0.75, abs=0.01))
        assert person.value("joysticks[0].axes")[5] == pytest.approx(0.25, abs=0.01)
        assert person.value("joysticks[0].povs")[0] == 0
        assert [number for number, pressed in enumerate(person.value("joysticks[0].buttons")) if pressed] == [2, 6]
        page.locator(".gamepad option", has_text="Test Pad").first.wait_for(state="attached")
        page.get_by_role("tab", name="2", exact=True).click()
        page.get_by_label("Gamepad of joystick 2").select_option(label="Test Pad")
        person.until(lambda: person.value("joysticks[2].axes")[1] == pytest.approx(-0.75, abs=0.01))
        person.until(lambda: person.value("joysticks[0].axes")[1] == 0)
        person.simulation.write({"joysticks[2].left_rumble": 65535})
        page.wait_for_function("() => window.rumbled && window.rumbled.strongMagnitude === 1")
        page.evaluate("window.fakePads = []")
        person.until(lambda: person.value("joysticks[2].axes")[1] == 0)


def test_keys_of_ones_own_and_touch_sticks(person: Seen) -> None:
    page = person.page
    person.tab("Keys").click()
    page.get_by_label("Key", exact=True).press("k")
    page.get_by_role("spinbutton", name="joystick").fill("0")
    page.get_by_role("spinbutton", name="number").fill("1")
    page.get_by_role("spinbutton", name="by").fill("-0.5")
    person.button("Add").click()
    person.button("Enable").click()
    page.keyboard.down("k")
    person.until(lambda: person.value("pwm[0].value") == pytest.approx(0.5, abs=0.01))
    page.keyboard.up("k")
    person.until(lambda: person.value("pwm[0].value") == 0)
    person.tab("Touch sticks").click()
    stick = page.get_by_label("Left stick")
    stick.focus()
    page.keyboard.down("ArrowUp")
    person.until(lambda: person.value("joysticks[0].axes")[1] == -1)
    page.keyboard.up("ArrowUp")
    person.until(lambda: person.value("joysticks[0].axes")[1] == 0)
