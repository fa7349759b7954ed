"""The parts of structs and lists on the page: found, plotted, saved; only robot code changes them."""

from __future__ import annotations

from typing import Any

import pytest
from browser_pages import Seen

MODULES = "nt:/SmartDashboard/Modules"
GOAL = "nt:/SmartDashboard/Plan/goal"


def test_structs_and_lists_unfold_into_parts_that_are_plotted_and_saved(person: Seen) -> None:
    page = person.page
    person.choose("Layout", "Tuning")
    person.tab("NetworkTables").click()
    page.locator(".nt-row.folder", has_text="SwerveModuleState[]").get_by_role("button").click()
    page.get_by_role("button", name="0", exact=True).click()
    speed = person.row(f"{MODULES}/0/speed")
    speed.locator(".nt-value", has_text="1").wait_for()
    person.set_number(person.row("nt:/SmartDashboard/kP").locator("input"), "1.5")
    speed.locator(".nt-value", has_text="3").wait_for()
    assert speed.locator("input").count() == 0
    speed.hover()
    speed.get_by_label("Plot speed").click()
    # The picker offers parts and elements by their names.
    page.locator("[data-panel='plot:1']").get_by_role("button", name="Add value").click()
    page.get_by_label("Search all values").fill("modules 3 angle")
    page.get_by_label("Search all values").press("Enter")
    page.locator(".nt-row.folder", has_text="Field2d").filter(has_text="Plan").get_by_role("button").click()
    person.row(GOAL).get_by_title("The elements of this list").click()
    element = person.row(f"{GOAL}[1]")
    element.locator(".nt-value", has_text="5.5").wait_for()
    assert element.locator("input").count() == 0
    element.hover()
    element.get_by_label("Plot [1]").click()
    for text in ("5.5", "0.7"):
        page.locator(".legend b", has_text=text).first.wait_for()
    with page.expect_download() as download:
        person.button("Save the values as CSV").first.click()
    lines = download.value.path().read_text("utf-8").splitlines()
    assert lines[0] == f"t,{MODULES}/0/speed,{MODULES}/3/angle/value,{GOAL}[1]"
    assert lines[-1].split(",")[1:] == ["3", "0.7", "5.5"]


def test_poses_are_drawn_whatever_they_are_published_as(person: Seen) -> None:
    found: Any = person.page.evaluate(
        """async () => {
          const { model } = await module("js/model.js");
          const { fieldObjects } = await module("js/field/published.js");
          const types = { flat: "Pose2d", solid: "Pose3d", none: "Pose2d" };
          for (const [name, type] of Object.entries(types)) model.types[`nt:/${name}`] = `struct:${type}`;
          const values = new Map(Object.entries({
            "nt:/flat/translation/x": 0.3048, "nt:/flat/translation/y": 0, "nt:/flat/rotation/value": 1,
            "nt:/solid/translation/x": 0, "nt:/solid/translation/y": 0, "nt:/solid/translation/z": 2,
            "nt:/solid/rotation/q/w": Math.cos(0.25), "nt:/solid/rotation/q/x": 0, "nt:/solid/rotation/q/y": 0,
            "nt:/solid/rotation/q/z": Math.sin(0.25),
            "nt:/none": { $: "struct", type: "Pose2d", size: 3 },
          }));
          return Object.fromEntries(fieldObjects(values, { height: 0 }).map(({ name, poses }) => [name, poses]));
        }"""
    )
    assert found == {"flat": [pytest.approx([1, 0, -1])], "solid": [pytest.approx([0, 0, -0.5])]}
