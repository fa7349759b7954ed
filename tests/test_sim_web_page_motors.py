"""The table of motors above the devices of the CAN bus."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from browser_pages import CHOOSER, Seen, page_of
from web_pages import served

#: Twelve motors whose devices have as many values as REV's: more rows than anyone can look through.
ROBOT = {
    "robot.py": f"""
        import hal
        import wpilib

        OUTPUT = hal.SimDevice.Direction.kOutput


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.chooser = wpilib.SendableChooser()
                self.chooser.setDefaultOption("Nothing", 0)
                wpilib.SmartDashboard.putData({CHOOSER!r}, self.chooser)
                self.devices, self.outputs = [], []
                for number in range(12):
                    device = hal.SimDevice(f"SPARK MAX [{{number}}]")
                    self.outputs.append(device.createDouble("Applied Output", OUTPUT, 0.0))
                    device.createDouble("Velocity", OUTPUT, 100.0 * number)
                    device.createDouble("Motor Temperature", OUTPUT, 25.0)
                    device.createDouble("Motor Current", OUTPUT, number / 4)
                    for value in range(8):
                        device.createDouble(f"Other {{value}}", OUTPUT, 0.0)
                    self.devices.append(device)

            def teleopPeriodic(self):
                self.outputs[2].set(0.5)
    """,
    "sim/config.json": '{"pyfrc": {"CAN": {"2": "front left drive"}}}',
}


@pytest.fixture(name="person")
def person_with_motors(browser: Any, make_shared_project: Any) -> Iterator[Seen]:
    with (
        served(make_shared_project(ROBOT), speed=1, paused=False) as server,
        page_of(browser, server) as person,
    ):
        yield person


def test_each_motor_has_one_row_above_closed_devices(person: Seen) -> None:
    page = person.page
    motors = page.get_by_role("table", name="Motors")
    motors.get_by_role("row").nth(12).wait_for()
    assert motors.get_by_role("row").count() == 13
    row = motors.get_by_role("row", name="front left drive")
    row.locator("[data-reading*=Current]", has_text="0.5").wait_for()
    row.get_by_text("200", exact=True).wait_for()
    row.locator("[data-reading*=Temperature]", has_text="25.0").wait_for()
    person.simulation.enable()
    row.locator(".meter .number", has_text="0.50").wait_for()
    # The values of the devices are a click away, or a search.
    devices = page.get_by_role("button", name="CAN and SimDevices")
    assert devices.get_attribute("aria-expanded") == "false"
    assert page.locator(".devices .row").count() < 10
    page.get_by_label("Search devices").fill("front left")
    page.locator("[data-path*='Other 7']").wait_for()
    assert motors.get_by_role("row").count() == 2
    page.get_by_label("Search devices").fill("")
    devices.click()
    page.locator("[data-path*='SPARK MAX [11]']").first.wait_for()
    row.get_by_label("Plot SPARK MAX [2]").click()
    page.locator(".curve-name").nth(3).wait_for()
