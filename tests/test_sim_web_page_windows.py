"""The page of `pyfrc sim` in a real browser: two windows that arrange it, files that are there already, floods."""

from __future__ import annotations

import json
from typing import Any

from browser_pages import Seen
from web_pages import Served


def saved_layout(server: Served) -> Any:
    file = server.simulation.project.root / ".pyfrc" / "sim-layout.json"
    return json.loads(file.read_text()) if file.is_file() else {}


def test_two_windows_arrange_the_page_together(person: Seen) -> None:
    with person.page.context.new_page() as second:
        other = Seen(second, person.server).open()
        person.page.get_by_label("Dark colours").click()
        person.until(lambda: saved_layout(person.server).get("theme") == "dark")
        other.choose("Layout", "Tuning")
        other.tab("Mechanism").click()
        person.until(lambda: saved_layout(person.server).get("trees"))
    found = saved_layout(person.server)
    assert (found["theme"], found["layout"], list(found["trees"])) == ("dark", "tuning", ["tuning"])
    person.page.reload()
    person.page.get_by_label("Light colours").wait_for()
    person.page.get_by_title("Layout", exact=True).get_by_text("Tuning").wait_for()


def test_a_file_that_is_there_is_replaced_after_a_question(person: Seen) -> None:
    file = person.simulation.project.root / "drive.jsonl"
    file.write_text("mine")
    for answer in ("Cancel", "Replace"):
        assert file.read_text() == "mine"
        person.choose("Restart, save, end", "Save the recording")
        person.page.locator("dialog input").press("Enter")
        person.page.get_by_text("drive.jsonl exists. Replace it?").wait_for()
        person.button(answer).click()
        person.page.locator("dialog").wait_for(state="detached")
    person.page.get_by_text("Saved drive.jsonl").wait_for()
    assert file.read_text() != "mine"
