"""What a drive team brings along: a layout for Elastic becomes dashboards, with its widgets."""

from __future__ import annotations

import json
from typing import Any

from browser_pages import ROBOT, page_of
from picture_server import camera
from test_elastic_layouts import layout, part
from web_pages import served

from pyfrc_core.config.dashboards import DASHBOARDS
from pyfrc_core.config.elastic_layout import ELASTIC_LAYOUT

TABLE = "/SmartDashboard/"
DEVICES = """def robotInit(self):
                self.gyro = wpilib.ADXRS450_Gyro()
                self.power = wpilib.PowerDistribution(1, wpilib.PowerDistribution.ModuleType.kRev)
                wpilib.simulation.ADXRS450_GyroSim(self.gyro).setAngle(405)
                wpilib.simulation.PowerDistributionSim(1).setCurrent(7, 31.5)
                wpilib.SmartDashboard.putData("Gyro", self.gyro)
                wpilib.SmartDashboard.putData("PDH", self.power)
                wpilib.SmartDashboard.putString("light", wpilib.Color(1, 0.5, 0).hexString())
                cameras = ntcore.NetworkTableInstance.getDefault().getStringArrayTopic("/CameraPublisher/front/streams")
                self.camera = cameras.publish()
                self.camera.set(["mjpg:http://{address}/stream"])
"""
LAYOUT = layout(
    part("Gyro", (0, 0, 2, 2), topic=f"{TABLE}Gyro"),
    part("PowerDistribution", (2, 0, 3, 4), topic=f"{TABLE}PDH"),
    part("Number Slider", (0, 2, 2, 1), topic=f"{TABLE}kP", min_value=0.0, max_value=4.0, divisions=8),
    part("Single Color View", (0, 3, 1, 1), topic=f"{TABLE}light"),
    part("Camera Stream", (5, 0, 3, 2), topic="/CameraPublisher/front"),
    part("Scheduler", (5, 2, 3, 2), topic=f"{TABLE}Scheduler"),
)


def test_a_team_brings_its_layout_along(browser: Any, make_project: Any) -> None:
    with camera() as address:
        devices = DEVICES.replace("{address}", address)
        made = make_project(
            {
                **ROBOT,
                "robot.py": ROBOT["robot.py"].replace("def robotInit(self):\n", devices),
                ELASTIC_LAYOUT.as_posix(): LAYOUT.decode(),
            }
        )
        with served(made, speed=1, paused=False) as server, page_of(browser, server) as person:
            page = person.page
            person.choose("Layout", "Dashboard")
            person.button("From a layout of Elastic").click()
            page.get_by_text("From deploy/elastic-layout.json: Teleoperated. Not shown, since").wait_for()
            page.locator(".notice", has_text='Scheduler "A" in Teleoperated').wait_for()
            page.get_by_role("img", name="A: 45.0°").wait_for()
            page.get_by_role("img", name="A: #FF7F00").wait_for()
            page.locator(".power .row", has_text="31.5").get_by_text("7", exact=True).wait_for()
            page.frame_locator("iframe").locator("img").wait_for()
            # A slider in its steps; the robot sees what it says.
            slider = page.locator(".widget[data-kind=slider] input[type=range]")
            slider.focus()
            for key in ("ArrowRight", "ArrowRight"):
                slider.press(key)
            person.until(lambda: person.written("kP")[-1:] == [1.5])
            person.shows(page.get_by_label("A, as a number"), "1.5")
            person.eventually(
                "async () => (await module('js/model.js')).model.values.get('nt:/SmartDashboard/doubled') === 3"
            )
            # Brought along again, it asks before it replaces what was arranged meanwhile; undo removes it.
            written = json.loads((made.path / DASHBOARDS).read_text("utf-8"))
            written["dashboards"]["Teleoperated"]["widgets"].pop()
            (made.path / DASHBOARDS).write_text(json.dumps(written), "utf-8")
            page.locator(".widget[data-kind=camera]").wait_for(state="detached")
            person.choose("Dashboards of this project", "From a layout of Elastic")
            page.locator("dialog").get_by_text("Replace it", exact=True).click()
            page.locator(".widget[data-kind=camera]").wait_for()
            person.page.get_by_role("button", name="Undo").click()
            page.locator(".widget[data-kind=camera]").wait_for(state="detached")
