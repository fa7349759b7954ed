"""`--page` of `pyfrc sim`, `replay` and `fuzz`: a whole run as one file, in a real browser, from disk."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import pytest
from browser_pages import HOSTILE, INJECTED, REFUSED, ROBOT
from recorded_pages import run_in
from sim_robots import FILES

from pyfrc_core.sim.engine.value_history import MISSING, ValueHistory, packed

SCRIPT = """\
{"format": "pyfrc-input 1", "end": 4.0}
{"t": 0, "set": {"mode": "teleop"}}
{"t": 1, "set": {"joysticks[0].axes[1]": -0.5}}
{"t": 2, "set": {"joysticks[0].buttons[5]": true}}
"""

DASHBOARD = """
{"dashboards": {"Drive": {"widgets": [{"kind": "number", "topic": "pwm[0].value", "x": 0, "y": 0, "w": 3, "h": 2}]}}}
"""

#: Whether the field is drawn: how many colours there are.
COLORS = """() => {
    const canvas = document.querySelector(".field canvas");
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    return new Set(new Uint32Array(pixels.buffer)).size > 20;
}"""


@pytest.fixture(scope="module")
def recorded(make_shared_project: Any) -> Any:
    """A project in which a failing run was written as a page."""
    project = make_shared_project({**ROBOT, "drive.jsonl": SCRIPT, "sim/dashboards.json": DASHBOARD})
    result = project.run("sim", "--ui", "none", "--script", "drive.jsonl", "--page", "pages/run.html")
    assert result.code == 1, result.output
    assert "wrote pages" in result.output
    return project


@pytest.fixture
def page(recorded: Any, browser: Any) -> Iterator[Any]:
    """The page, opened from disk without a network; it may report no error, and may ask for nothing."""
    context = browser.new_context(viewport={"width": 1366, "height": 768}, offline=True)
    try:
        page = context.new_page()
        wrong: list[str] = []
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda message: message.type in ("error", "warning") and wrong.append(message.text))
        page.on("requestfailed", lambda request: wrong.append(request.url[:200]))
        page.goto((recorded.path / "pages" / "run.html").as_uri())
        page.locator(".recorded", has_text="pyfrc sim --script drive.jsonl").wait_for()
        yield page
        assert not wrong
    finally:
        context.close()


def test_a_mentor_looks_through_a_run_that_failed(page: Any, recorded: Any) -> None:
    # What happened: the line, the console; and nothing that drives.
    page.locator(".failure strong", has_text=f"{recorded.place('robot.py', '1 / 0')}: ZeroDivisionError").wait_for()
    page.locator(".line-text").get_by_text(HOSTILE, exact=True).wait_for()
    for name in ("Enable", "Practice", "E-STOP", "Restart"):
        assert page.get_by_role("button", name=name).count() == 0, name
    assert page.title() != "broken"
    assert page.locator("b", has_text="bold").count() == 0
    # The field has a robot, and colours.
    page.locator(".pose", has_text="ft").wait_for()
    page.wait_for_function(COLORS)
    # Moving along the timeline shows the past in each panel, the plot that is suggested included.
    value, plotted = (
        page.locator("[data-path='pwm[0].value'] .number"),
        page.locator(".legend li", has_text="left motor"),
    )
    page.get_by_role("tab", name="Devices").click()
    timeline = page.locator(".timeline")
    timeline.press("Home")
    page.locator(".clock", has_text="0:00.00").wait_for()
    timeline.press("Shift+ArrowRight")
    timeline.press("ArrowLeft")
    page.locator(".clock", has_text="0:00.98").wait_for()
    value.get_by_text("0.00").wait_for()
    timeline.press("Shift+ArrowRight")
    page.locator(".clock", has_text="0:01.98").wait_for()
    value.get_by_text("0.50").wait_for()
    plotted.locator("b", has_text="0.5").wait_for()
    assert page.locator(".uplot canvas").count() > 0
    # It plays to the end.
    page.get_by_role("button", name="Play", exact=True).click()
    page.locator(".run-end", has_text="End of the run").wait_for()
    page.get_by_role("button", name="Play", exact=True).wait_for()
    # NetworkTables, as text.
    page.get_by_role("tab", name="NetworkTables").click()
    page.wait_for_function(
        "text => [...document.querySelectorAll('.nt-value')].some(each => each.value === text)", arg=HOSTILE
    )
    assert page.locator("input.nt-value:enabled").count() == 0
    for name in ("Modules", "0"):
        page.locator(".nt-row.folder").get_by_role("button", name=name, exact=True).click()
    page.locator("[data-path='nt:/SmartDashboard/Modules/0/speed'] .nt-value", has_text="1").wait_for()
    # The team's dashboard, which is not changed here.
    page.get_by_title("Layout", exact=True).click()
    page.get_by_role("menuitemcheckbox", name="Dashboard").click()
    page.locator(".widget", has_text="pwm[0].value").locator("b", has_text="0.50").wait_for()
    assert page.get_by_role("button", name="Arrange").count() == 0


def test_a_page_from_disk_runs_its_own_scripts_only(recorded: Any, browser: Any) -> None:
    context = browser.new_context(offline=True)
    try:
        page = context.new_page()
        page.goto((recorded.path / "pages" / "run.html").as_uri())
        page.locator(".recorded").wait_for()
        assert page.evaluate(INJECTED) == REFUSED
    finally:
        context.close()


def test_nothing_of_this_computer_is_in_a_page(recorded: Any) -> None:
    file = recorded.path / "pages" / "run.html"
    run = run_in(file)
    assert run["hello"]["status"]["failure"]["t"] == pytest.approx(2, abs=0.1)
    assert run["hello"]["project"]["root"] == ""
    for text in (repr(run), file.read_text("utf-8")):
        assert str(recorded.path) not in text
        assert str(recorded.path.resolve()) not in text
        assert sys.prefix not in text
    assert file.stat().st_size < 2_000_000
    assert [each.name for each in file.parent.iterdir()] == ["run.html"]


@pytest.mark.slow
def test_a_page_of_a_replay_and_of_a_failure_that_fuzz_has_found(make_project: Any) -> None:
    broken = FILES["robot.py"].replace("print(", "{}[5]\n                print(", 1)
    project = make_project({**FILES, "robot.py": broken})
    assert project.run("fuzz", "--runs", "1", "-j", "1", "--pages", "pages").code == 1
    (page,) = (project.path / "pages").glob("*.html")
    hello = run_in(page)["hello"]
    place = project.place("robot.py", "{}[5]")
    assert hello["status"]["failure"]["headline"].startswith(f"{place}: KeyError")
    assert hello["status"]["state"] == "failed"
    assert hello["source"]["title"] == f"pyfrc fuzz: tests/fuzz/{page.stem}.jsonl"
    result = project.run("replay", f"tests/fuzz/{page.stem}.jsonl", "--page", "replayed.html")
    assert result.code == 1
    assert "wrote replayed.html" in result.output
    hello = run_in(project.path / "replayed.html")["hello"]
    assert hello["source"]["title"] == f"pyfrc replay tests/fuzz/{page.stem}.jsonl"


def test_a_page_that_cannot_be_written_is_an_error_before_the_run(make_project: Any) -> None:
    project = make_project({**FILES, "drive.jsonl": SCRIPT})
    for command in (["sim", "--ui", "none", "--mode", "auto"], ["replay", "drive.jsonl"]):
        result = project.run_here(*command, "--page", "robot.py/run.html")
        assert result.code == 2
        assert "cannot be written" in result.output
        assert "the robot is there" not in result.output
    assert project.run_here("fuzz", "--merge", "--pages", "pages", "sim").code == 2


def test_values_are_stored_with_seven_digits() -> None:
    history = ValueHistory()
    history.add(0.0, {"a": 0.1, "b": True, "c": ({"x": 1.0, "name": "/home/me"}, 2), "d": 1.0})
    history.add(0.02, {"a": 1 / 3, "b": False, "d": float("nan")})
    history.add(0.04, {"a": -2.5, "c": ({"x": 1.5, "name": "/home/me"}, 3)}, ["b"])
    found = packed(history, lambda text: text.replace("/home/me", "~"))
    assert found["times"] == [0, 0.02, 0.04]
    assert found["values"] == {
        "a": {"p": [0, 1, 2], "v": [0.1, 0.3333333, -2.5]},
        "b": {"p": [0, 1, 2], "v": [True, False, {"$": "gone"}]},
        "c": {"p": [0, 2], "v": [[{"x": 1.0, "name": "~"}, 2], [{"x": 1.5, "name": "~"}, 3]]},
        "d": {"p": [0, 1], "v": [1.0, pytest.approx(float("nan"), nan_ok=True)]},
    }
    assert history.values_at(0.04).get("b", MISSING) is MISSING
