"""The page of a robot on the network, in a real browser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from browser_pages import MODULE, Seen
from network_robots import TELEOP, WORD, link_to, network_robot
from picture_server import camera
from ports import lasting_port, refusing_port
from test_live_robot import shown

CAMERA = "/CameraPublisher/Front/streams"


def test_a_person_looks_at_a_robot(browser: Any, tmp_path: Path) -> None:
    port = lasting_port()
    with network_robot(tmp_path, port) as robot, link_to(port) as link, shown(tmp_path, link.port) as there:
        robot.set("/SmartDashboard/kP", "double", 0.5)
        context = browser.new_context(viewport={"width": 1366, "height": 768})
        page = context.new_page()
        page.add_init_script(MODULE)
        person = Seen(page, there)
        person.open()
        robot.set(WORD, "int", TELEOP)
        person.state("Teleoperated enabled")
        # Nothing drives.
        for name in ("Enable", "Disable", "E-STOP", "Practice", "Pause"):
            assert person.button(name).count() == 0, name
        page.keyboard.press("Control+e")
        page.keyboard.press(" ")
        # Values are set after the switch only.
        person.tab("NetworkTables").click()
        box = person.row("nt:/SmartDashboard/kP").get_by_role("textbox")
        person.shows(box, "0.5")
        assert box.is_disabled()
        page.get_by_role("switch", name="Tune").check(force=True)
        person.set_number(box, "0.25")
        page.wait_for_function("() => !document.querySelector('.notice')")
        robot.until("/SmartDashboard/kP", 0.25)
        page.get_by_role("switch", name="Tune").uncheck(force=True)
        page.locator("[data-path='nt:/SmartDashboard/kP'] input:disabled").wait_for()
        # A connection that is lost is said, and what is known stays.
        badge = page.locator(".live-now")
        badge.and_(page.locator(".live")).get_by_text("Live").wait_for()
        link.cut()
        person.state("No connection")
        badge.and_(page.locator(".lost")).get_by_text("No connection").wait_for()
        person.shows(box, "0.25")
        page.locator(".timeline").press("Home")  # in the past, too, the present is not promised
        page.get_by_role("button", name="Live").and_(page.locator(".lost")).click()
        badge.get_by_text("No connection").wait_for()
        link.mend()
        person.state("Teleoperated enabled")
        badge.and_(page.locator(".live")).get_by_text("Live").wait_for()
        page.locator(".line.pyfrc", has_text="was lost").wait_for()
        page.locator(".timeline").press("Home")
        person.state("Teleoperated disabled")
        page.get_by_role("button", name="Live").click()
        # A curve of the simulation, in the same arrangement: a robot publishes no devices.
        page.evaluate("module('js/plotting.js').then(({ addToPlot }) => addToPlot('pwm[0].value'))")
        page.get_by_text("1 not from this robot").wait_for()
        page.locator(".plot .empty").wait_for()
        # The pictures of a camera, and where none comes.
        with camera() as host, refusing_port() as silent:
            robot.set(CAMERA, "string[]", [f"mjpg:http://{host}/?action=stream"])
            robot.set("/CameraPublisher/Back/streams", "string[]", [f"mjpg:http://127.0.0.1:{silent}/stream.mjpg"])
            person.tab("Cameras").click()
            front = page.frame_locator("iframe[title='Camera Front']")
            front.locator("img").wait_for(state="visible")
            assert front.locator("img").evaluate("(image) => image.naturalWidth") == 32
            back = page.frame_locator("iframe[title='Camera Back']")
            back.get_by_text(f"No picture from 127.0.0.1:{silent}").wait_for()
        # It ends while it is shown: its last picture does not stay as if it were the present.
        front.get_by_text(f"No picture from {host}").wait_for()
        assert robot.get(WORD) == TELEOP
        # pyfrc has ended: what the robot does is not known any more.
        there.front_end.close()
        badge.and_(page.locator(".over")).get_by_text("Ended").wait_for()
        person.state("Ended")
        assert not [text for text in person.wrong if "ERR_CONNECTION_REFUSED" not in text]
        context.close()
