"""Numbers on the page of `pyfrc sim`: what is shown, what is typed, and what reaches the robot."""

from __future__ import annotations

from typing import Any

from browser_pages import Seen

KP = "nt:/SmartDashboard/kP"


def written(person: Seen, target: str = KP) -> list[Any]:
    """Return what was written to a target in this run."""
    return [step.writes[target] for step in person.simulation.script().steps if target in step.writes]


def test_a_number_keeps_its_digits_unless_it_is_edited(person: Seen) -> None:
    person.tab("NetworkTables").click()
    box = person.row(KP).locator("input")
    for value, text in {6e-5: "0.00006", 1e-9: "1e-9", 12345678.5: "12345678.5", 1 / 3: "0.333333"}.items():
        person.simulation.write({KP: value})
        person.shows(box, text)
        box.click()
        box.press("Enter")
        box.click()
        box.press("Tab")
    person.set_number(box, "7e-5")
    person.until(lambda: written(person)[-1] == 7e-5)
    assert written(person) == [6e-5, 1e-9, 12345678.5, 1 / 3, 7e-5]


def test_tab_and_a_click_elsewhere_write_what_was_typed_and_escape_does_not(person: Seen) -> None:
    page = person.page
    person.tab("NetworkTables").click()
    box = person.row(KP).locator("input")
    for number, leave in enumerate((lambda: box.press("Tab"), lambda: page.locator(".clock").click()), 2):
        box.click()
        box.fill(str(number))
        leave()
        person.until(lambda number=number: written(person)[-1:] == [number])
    box.click()
    box.fill("9")
    box.press("Escape")
    person.shows(box, "3")
    assert written(person) == [2, 3]


def test_a_number_is_edited_while_the_robot_is_paused(person: Seen) -> None:
    person.tab("NetworkTables").click()
    person.pause()
    box = person.row(KP).locator("input")
    box.click()
    box.fill("4.5")
    box.press("Tab")
    person.shows(box, "4.5")


def test_what_is_no_number_is_refused_with_the_reason(person: Seen) -> None:
    page = person.page
    kp = person.row(KP).locator("input")
    voltage = person.row("analog_in[2].voltage").locator("input.number")
    for tab, box, name in (("NetworkTables", kp, "kP"), ("Devices", voltage, "2 range finder, as a number")):
        person.tab(tab).click()
        for text, reason in {
            "1,000": "write thousands without a comma and decimals with a point, not “1,000”.",
            "three": "a number is needed, not “three”.",
            "": "a number is needed, not “”.",
            "1e999": "“1e999” is too large.",
        }.items():
            person.set_number(box, text)
            page.locator(".notice", has_text=f"{name}: {reason}").wait_for()
            assert box.input_value() == text
        box.press("Escape")
        page.locator(".notice").wait_for(state="detached")
    assert written(person) == []


def test_a_list_is_edited_with_all_digits_of_its_numbers(person: Seen) -> None:
    page = person.page
    target = "nt:/SmartDashboard/gains"
    person.simulation.write({target: [1 / 3, 2.0]})
    person.tab("NetworkTables").click()
    box = person.row(target).locator("input")
    person.shows(box, "[0.333333,2]")
    box.click()
    person.shows(box, "[0.3333333333333333,2]")
    person.set_number(box, "[1, 2")
    page.locator(".notice", has_text="gains: a list such as [1, 2.5] is needed, not “[1, 2”.").wait_for()
    person.set_number(box, "[0.3333333333333333,0.5]")
    person.until(lambda: list(written(person, target)[-1]) == [1 / 3, 0.5])
