"""Makes the pictures of the page of ``pyfrc sim`` in docs/images, in a real browser.

``python docs/screenshots.py`` runs it, too. It needs Chromium, playwright and Pillow.
"""

from __future__ import annotations

import io
import json
import shutil
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Literal

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from browser_pages import open_browser  # noqa: E402
from PIL import Image  # noqa: E402
from web_pages import Served, served  # noqa: E402

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

IMAGES = ROOT / "docs" / "images"
PATIENCE = 60.0


def save(page: Page, name: str) -> None:
    """Save a picture in few colours: a repository is no place for large files."""
    page.wait_for_timeout(800)  # until everything has been drawn
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    # The colours that most pixels have, as they are: those of lamps and warnings mean something.
    colors = sorted(picture.getcolors(picture.width * picture.height) or (), reverse=True)[:256]
    palette = Image.new("P", (1, 1))
    palette.putpalette([part for _, color in colors for part in color])
    picture = picture.quantize(palette=palette, dither=Image.Dither.NONE)
    picture.convert("RGB").save(IMAGES / f"{name}.webp", lossless=True, quality=100, method=6)


def run_for(server: Served, seconds: float) -> None:
    """Wait until this much robot time has passed."""
    simulation = server.simulation
    assert simulation.snapshot is not None
    end = simulation.snapshot.time + seconds
    simulation.wait_for(lambda: simulation.snapshot is not None and simulation.snapshot.time >= end, PATIENCE)


def open_page(browser: Browser, server: Served, theme: Literal["light", "dark"]) -> Page:
    page = browser.new_page(viewport={"width": 1366, "height": 768}, color_scheme=theme)
    page.goto(server.address)
    page.locator(".state.disabled").wait_for()
    return page


def choose_layout(page: Page, name: str) -> None:
    page.get_by_title("Layout", exact=True).click()
    page.get_by_role("menuitemcheckbox", name=name).click()


def plot(page: Page, panel: str, *paths: str) -> None:
    """Plot values, as dragging them to the plot does."""
    page.evaluate(
        "([panel, paths]) => import('#js/plotting.js').then(({ addToPlot }) => "
        "paths.forEach((path) => addToPlot(path, panel)))",
        [panel, list(paths)],
    )


def drive_in_a_curve(server: Served, last: float) -> None:
    """Drive a swerve robot forwards and to both sides.

    :param last: how long to the second side, in seconds
    """
    for sideways, turn, seconds in ((0.0, 0.0, 0.8), (0.35, 0.1, 1.2), (-0.5, -0.12, last)):
        for axis, value in ((1, -0.6), (0, sideways), (4, turn)):
            server.simulation.set_axis(0, axis, value)
        run_for(server, seconds)


def drive_swerve(browser: Browser, server: Served) -> None:
    """The driving layout: a swerve robot in a curve, with its arrows."""
    page = open_page(browser, server, "light")
    server.simulation.enable()
    drive_in_a_curve(server, 1.6)
    server.simulation.pause()
    save(page, "browser")
    page.close()


def tune_elevator(browser: Browser, server: Served) -> None:
    """The tuning layout in the dark, at an earlier moment: plots, the controllers' numbers, the mechanism."""
    page = open_page(browser, server, "dark")
    choose_layout(page, "Tuning")
    plot(page, "plot:1", "nt:/SmartDashboard/Elevator height", "nt:/SmartDashboard/Arm angle")
    plot(page, "plot:2", "pwm[0].value", "pwm[1].value")
    page.get_by_role("tab", name="Mechanism", exact=True).click()
    server.simulation.enable()
    for button in (1, 2, 4, 3):
        server.simulation.set_button(0, button, True)
        run_for(server, 0.1)
        server.simulation.set_button(0, button, False)
        run_for(server, 1.8)
    server.simulation.pause()
    page.wait_for_timeout(500)
    box = page.locator(".timeline").bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] * 0.62, box["y"] + 14)
    save(page, "browser-past")
    page.close()


#: The dashboard of the picture, as ``sim/dashboards.json`` has it: kind, topic, x, y, w, h, and settings.
_WIDGETS = (
    ("time", "", 0, 0, 2, 1, {}),
    ("state", "", 2, 0, 4, 1, {}),
    ("chooser", "/SmartDashboard/Autonomous", 6, 0, 4, 1, {}),
    ("lamp", "control.enabled", 10, 0, 2, 1, {}),
    ("field", "", 0, 1, 7, 5, {}),
    ("swerve", "/SwerveStates/Measured", 7, 1, 5, 4, {"title": "Swerve", "max": 4}),
    ("gauge", "/SwerveStates/Measured/0/speed", 7, 5, 2, 3, {"title": "Front left", "min": -4.0, "max": 4.0}),
    ("number", "sim.pose[0]", 9, 5, 3, 1, {"title": "x"}),
    ("number", "sim.pose[1]", 9, 6, 3, 1, {"title": "y"}),
    ("number", "sim.pose[2]", 9, 7, 3, 1, {"title": "angle"}),
    (
        "graph",
        "/SwerveStates/Measured/0/speed",
        *(0, 6, 7, 2),
        {"more": ["/SwerveStates/Target/0/speed"], "title": "Speed of the front left module", "seconds": 5},
    ),
)


def show_dashboard(browser: Browser, server: Served) -> None:
    """A dashboard of the team, beside NetworkTables."""
    keys = ("kind", "topic", "x", "y", "w", "h")
    widgets = [{**dict(zip(keys, widget[:-1], strict=True)), **widget[-1]} for widget in _WIDGETS]
    file = server.simulation.project.root / "sim" / "dashboards.json"
    file.write_text(json.dumps({"dashboards": {"Drive": {"widgets": widgets}}}), "utf-8")
    page = open_page(browser, server, "light")
    choose_layout(page, "Dashboard")
    server.simulation.practice()
    run_for(server, 19)
    drive_in_a_curve(server, 1.2)
    server.simulation.pause()
    save(page, "dashboard")
    page.close()


def take_page_pictures() -> None:
    """Take the pictures of the page, each of a new project."""
    with tempfile.TemporaryDirectory() as directory, open_browser() as browser:
        for template, take in (("swerve", drive_swerve), ("elevator-arm", tune_elevator), ("swerve", show_dashboard)):
            project = Path(directory, take.__name__, f"{template}-robot")
            shutil.copytree(ROOT / "templates" / template, project)
            with served(SimpleNamespace(path=project), speed=1, paused=False) as server:
                take(browser, server)


if __name__ == "__main__":
    take_page_pictures()
