"""The emergency stop and the robot's state are in sight in windows of any size, in each layout."""

from __future__ import annotations

import pytest
from browser_pages import Seen

LAYOUTS = ["Driving", "Tablet", "Tuning", "Dashboard"]
#: Also those of 1366 by 768 at 150 %, and of 1280 by 800 at 133 %.
WIDTHS = [640, 700, 800, 853, 901, 961, 1024, 1100, 1180, 1281, 1500]
SIZES = [*((width, 400) for width in WIDTHS), (640, 900), (911, 512), (960, 600), (1366, 768)]
#: What is not whole in the window, or has something else before it.
LOOK = """(names) => names.flatMap((name) => {
  const element = document.querySelector(name);
  if (!element) return [`${name} is missing`];
  const box = element.getBoundingClientRect();
  const [across, down] = [box.left >= 0 && box.right <= innerWidth, box.top >= 0 && box.bottom <= innerHeight];
  if (!box.width || !across || !down) return [`${name} is at ${box.left}, ${box.top}, ${box.right}, ${box.bottom}`];
  const front = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
  if (!element.contains(front)) return [`${name} is behind ${front?.className}`];
  return element.scrollWidth > element.clientWidth + 1 ? [`${name} is cut`] : [];
})"""
ALWAYS = [".estop", ".state .lamp", ".state b"]


def out_of_sight(seen: Seen, width: int, height: int) -> list[str]:
    seen.page.set_viewport_size({"width": width, "height": height})
    seen.drawn()
    return [f"{width} x {height}: {each}" for each in seen.page.evaluate(LOOK, ALWAYS)]


#: What makes the bar longer: more windows, a hint, opmodes as robots of 2027 have, a match, the past.
CROWDED = """async () => {
  const { model } = await module("js/model.js");
  model.set("clients", 12);
  model.set("hint", "A joystick is not plugged in: port 0 of the driver station has none, and robot code reads it");
  model.set("opmodes", [{ mode: "teleop", name: "Everything at the same time", group: "", description: "" }]);
}"""


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_emergency_stop_is_in_sight_in_each_window(layout: str, person: Seen) -> None:
    person.choose("Layout", layout)
    person.button("Practice").click()
    person.state("Autonomous enabled")
    wrong = [wrong for size in SIZES for wrong in out_of_sight(person, *size)]
    person.page.evaluate(CROWDED)
    wrong += [wrong for size in SIZES for wrong in out_of_sight(person, *size)]
    person.button("E-STOP").click()
    person.state("Emergency stopped")
    wrong += [wrong for size in SIZES for wrong in out_of_sight(person, *size)]
    assert wrong == []
