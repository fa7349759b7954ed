"""How the page writes places on the field."""

from __future__ import annotations

from typing import Any

from browser_pages import ROBOT, page_of
from web_pages import served


def test_the_project_says_how_places_are_written(browser: Any, make_shared_project: Any) -> None:
    config = ROBOT["sim/config.json"].replace('"robot":', '"field": {"coordinates": "alliance"}, "robot":')
    with (
        served(make_shared_project({**ROBOT, "sim/config.json": config}), speed=1, paused=False) as server,
        page_of(browser, server) as person,
    ):
        person.page.locator(".pose b", has_text="3.05 m").wait_for()
        person.simulation.set_alliance("red2")
        field = person.simulation.snapshot.scene.field
        person.page.locator(".pose b", has_text=f"{(field.width - 10) * 0.3048:.2f} m").wait_for()
        person.page.locator(".pose b", has_text="180.0°").wait_for()
