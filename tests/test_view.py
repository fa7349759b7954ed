"""`pyfrc view`: logs on the page, without a robot program."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import pytest
from browser_pages import opened_page
from recorded_pages import run_in
from sim_robots import PATIENCE
from web_pages import Page, send_log, served_source
from websockets.sync.client import connect
from written_logs import Written, a_match

from pyfrc_core.errors import PyfrcError
from pyfrc_core.project import Project
from pyfrc_core.sim.logs import open_log
from pyfrc_core.sim.logs.source import LogSource
from pyfrc_core.sim.what_if import WhatIf

if TYPE_CHECKING:
    from playwright.sync_api import Browser

HEIGHT = 27.0


def practice() -> Written:
    """Return a log of another robot, which is enabled after 5 s."""
    log = Written()
    log.values("DS:enabled", "boolean", "?", (0, False), (5, True), (9, False))
    log.values("NT:/SmartDashboard/speed", "double", "d", *((step / 10, step / 2) for step in range(100)))
    return log


def source_of(directory: Path) -> LogSource:
    log = open_log(a_match().save(directory / "match.wpilog"), HEIGHT)
    return LogSource(Project(directory / "robot.py"), log)


# -- the command ------------------------------------------------------------------------------------------------------


def test_a_log_becomes_a_page_also_outside_of_a_project(make_project: Any) -> None:
    made = make_project({"readme.txt": "no robot here"})
    a_match().save(made.path / "match.wpilog")
    result = made.run("view", "match.wpilog", "--page", "match.html")
    assert (result.code, result.output) == (0, "wrote match.html\n")
    run = run_in(made.path / "match.html")
    assert run["hello"]["source"]["title"] == "pyfrc view match.wpilog"
    assert (run["hello"]["source"]["kind"], run["hello"]["source"]["over"]) == ("log", True)
    assert run["network"]["values"]["sim.mode"]["v"][:3] == ["disabled", "disabled autonomous", "autonomous"]
    assert [line["text"] for line in run["hello"]["console"]] == ["hello", "ValueError: it broke"]
    assert [mark["text"] for mark in run["hello"]["marks"] if mark["kind"] == "error"] == ["ValueError: it broke"]
    assert not (made.path / ".pyfrc").exists()


def test_a_page_has_the_other_logs_too(make_project: Any) -> None:
    made = make_project({})
    a_match().save(made.path / "match.wpilog")
    practice().save(made.path / "practice.wpilog")
    result = made.run("view", "match.wpilog", "practice.wpilog", "--offset", "1.5", "--page", "both.html", "-q")
    assert (result.code, result.output) == (0, "")
    run = run_in(made.path / "both.html")
    (branch,) = run["hello"]["branches"]
    assert (branch["name"], branch["offset"]) == ("practice.wpilog", 1.5)
    assert run["branches"][0]["id"] == branch["id"]
    assert run["branches"][0]["network"]["values"]["nt:/SmartDashboard/speed"]["v"][:2] == [0.0, 0.5]


def test_logs_of_the_same_name_are_told_apart_by_their_directories(make_project: Any) -> None:
    made = make_project({"a/match1/readme.txt": "", "a/match2/readme.txt": "", "b/match2/readme.txt": ""})
    files = ["a/match1/Q12.wpilog", "a/match2/Q12.wpilog", "b/match2/Q12.wpilog", "other.wpilog"]
    for file in files:
        a_match().save(made.path / file)
    assert made.run("view", *files, "--page", "all.html", "-q").code == 0
    hello = run_in(made.path / "all.html")["hello"]
    assert hello["source"]["title"] == "pyfrc view match1/Q12.wpilog"
    assert [each["name"] for each in hello["branches"]] == [
        "a/match2/Q12.wpilog",
        "b/match2/Q12.wpilog",
        "other.wpilog",
    ]


def test_what_cannot_be_shown_is_said_in_a_sentence(make_project: Any) -> None:
    made = make_project({"photo.png": "no log"})
    a_match().save(made.path / "match.wpilog")
    (made.path / "cut.wpilog").write_bytes(a_match().data[:-2])
    for arguments, code, message in (
        (("photo.png",), 1, "photo.png: this is text, not a log"),
        (("gone.wpilog",), 2, "there is no file gone.wpilog"),
        (("match.wpilog", "--offset", "1"), 2, "--offset is given 1 time, for 0 logs beside the first one"),
        (("match.wpilog", "--page", "a.html", "--port", "8000"), 2, "--page writes a file, and serves no page"),
    ):
        result = made.run_here("view", *arguments)
        assert (result.code, result.first_error) == (code, message)
    result = made.run("view", "cut.wpilog", "match.wpilog", "--page", "a.html")
    assert result.code == 0
    assert "cut.wpilog: it is cut at byte" in result.output


def test_a_page_does_not_overwrite_a_log_that_it_shows(make_project: Any) -> None:
    made = make_project({})
    a_match().save(made.path / "match.wpilog")
    log = (made.path / "match.wpilog").read_bytes()
    for name in ("match.wpilog", f"../{made.path.name}/match.wpilog"):
        result = made.run_here("view", "match.wpilog", "--page", name)
        assert result.code == 2, result.output
        assert "cannot be written: this command reads it" in result.output
    assert (made.path / "match.wpilog").read_bytes() == log
    outside = made.path.parent / "none" / "a.html"
    result = made.run_here("view", "match.wpilog", "--page", outside)
    assert (result.code, result.first_error) == (
        2,
        f"--page {outside} cannot be written: there is no directory {outside.parent}",
    )
    assert not outside.parent.exists()
    assert made.run("view", "match.wpilog", "--page", "pages/a.html").code == 0


def test_the_page_says_that_the_project_is_below_the_current_directory(make_project: Any) -> None:
    made = make_project({"src/robot.py": ""})
    a_match().save(made.path / "match.wpilog")
    with made.start("view", "match.wpilog") as view:
        said = iter(view.stdout.readline, "")
        assert next(said) == "there is no robot.py here, but there is one in ./src\n"
        address = urlsplit(next(line for line in said if "is at" in line).split()[-1])
        with connect(f"ws://{address.netloc}/ws?{address.query}", max_size=None) as socket:
            answer = Page(socket).ask(type="command", name="what_if")
    assert answer["message"].startswith("there is no robot.py here, but there is one in ./src\n")


# -- the page ---------------------------------------------------------------------------------------------------------


def test_a_log_that_is_dropped_on_the_page_becomes_a_branch(tmp_path: Path) -> None:
    with served_source(source_of(tmp_path)) as server, server.page() as page:
        assert page.values["nt:/SmartDashboard/speed"] == pytest.approx(199 / 7)
        status, answer = send_log(server, "C:\\logs\\practice.wpilog", practice().data)
        assert (status, "practice.wpilog is shown beside this" in answer["text"]) == (200, True)
        page.until(lambda: page.parts.get("branches"))
        (branch,) = page.parts["branches"]
        assert (branch["id"], branch["name"], branch["offset"]) == (answer["branch"], "practice.wpilog", -3.0)
        asked = {"paths": ["nt:/SmartDashboard/speed"], "from": 2.0, "to": 2.5, "points": 99, "branch": branch["id"]}
        assert page.ask(type="plot", **asked)["series"]["nt:/SmartDashboard/speed"]["v"][0] == 25.0
        for name, data in (("photo.png", b"PNG"), ("empty.wpilog", b""), ("a.hoot", b"x")):
            status, answer = send_log(server, name, data)
            assert (status, "branch" in answer) == (200, False)
            assert answer["text"].startswith(name)
        send_log(server, "practice.wpilog", practice().data)  # of another directory, which a browser does not tell
        page.until(lambda: len(page.parts["branches"]) == 2)
        assert [each["name"] for each in page.parts["branches"]] == ["practice.wpilog", "practice (2).wpilog"]


def test_what_changes_rarely_comes_first_among_the_changes_around_a_moment(tmp_path: Path) -> None:
    log = a_match()
    log.values("NT:/SmartDashboard/state", "string", "", (0, b"DRIVING"), (5.2, b"BLOCKED"))
    log.values("NT:/SmartDashboard/same", "double", "d", *((step / 10, 1.0) for step in range(100)))
    opened = open_log(log.save(tmp_path / "match.wpilog"), HEIGHT)
    with served_source(LogSource(Project(tmp_path / "robot.py"), opened)) as server, server.page() as page:
        changes = page.ask(type="changes", t=5.0, reach=0.5)["changes"]
        assert changes[0] == {
            "path": "nt:/SmartDashboard/state",
            "t": 5.2,
            "before": "DRIVING",
            "after": "BLOCKED",
            "count": 2,
            "near": 1,
        }
        (often,) = changes[1:]  # of many changes, the first
        assert (often["path"], often["near"] > 8) == ("nt:/SmartDashboard/speed", True)
        few = page.ask(type="changes", t=5.0, reach=0.15)["changes"]
        assert len(few) == few[-1]["near"] == 3
        assert few[0]["after"] == few[1]["before"]


def test_only_who_may_drive_can_drop_a_log(tmp_path: Path) -> None:
    with served_source(source_of(tmp_path)) as server:
        viewing = urlsplit(server.viewing_address).query
        for token in (viewing, "token=wrong"):
            assert send_log(server, "practice.wpilog", practice().data, token)[0] == 403


def test_a_person_looks_at_a_log(tmp_path: Path, browser: Browser) -> None:
    with served_source(source_of(tmp_path)) as server, opened_page(browser, server.address) as page:
        page.locator(".recorded code", has_text="match.wpilog").wait_for()
        page.locator(".run-end", has_text="match 0:00.0").wait_for()  # where autonomous was enabled
        assert page.get_by_role("button", name="Enable", exact=True).count() == 0
        assert page.get_by_role("tab", name="Keys", exact=True).count() == 0
        page.get_by_role("tab", name="NetworkTables", exact=True).click()
        page.locator("[data-path='nt:/SmartDashboard/speed']").first.wait_for()
        timeline = page.locator(".timeline")
        box = timeline.bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + box["width"] * 0.25, box["y"] + 12)
        page.locator(".state b", has_text="Autonomous enabled").wait_for()
        page.locator(".console", has_text="ValueError: it broke").wait_for()
        page.get_by_role("tab", name="Changes", exact=True).click()
        page.locator(".change", has_text="speed").first.wait_for()
        page.mouse.click(box["x"] + box["width"] - 1, box["y"] + 12)
        page.locator(".state b", has_text="Autonomous enabled").wait_for(state="detached")
        page.get_by_role("button", name="Add value").first.click()
        page.keyboard.type("speed")
        page.keyboard.press("Enter")
        plot = page.locator(".u-over").first
        box = plot.bounding_box()
        assert box is not None
        plot.click(position={"x": box["width"] * 0.25, "y": box["height"] / 2})
        page.locator(".state b", has_text="Autonomous enabled").wait_for()
        drop = """([name, bytes]) => {
          const transfer = new DataTransfer();
          transfer.items.add(new File([new Uint8Array(bytes)], name));
          document.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
        }"""
        page.evaluate(drop, ["practice.wpilog", list(practice().data)])
        page.locator(".notice", has_text="practice.wpilog is shown beside this").wait_for()
        page.get_by_title("Compare with another log", exact=True).click()
        page.locator(".menu-list button", has_text="practice.wpilog").first.wait_for()
        page.keyboard.press("Escape")
        page.evaluate(drop, ["practice.wpilog", list(practice().data)])
        page.locator(".notice", has_text="practice (2).wpilog is shown beside this").wait_for()


def test_arrow_keys_go_on_from_where_a_person_has_clicked(tmp_path: Path, browser: Browser) -> None:
    with served_source(source_of(tmp_path)) as server, opened_page(browser, server.address) as page:
        timeline = page.get_by_role("slider", name="Timeline")

        def moment() -> float:
            return float(timeline.get_attribute("aria-valuenow") or 0)

        def goes(key: str, by: float, press: Any = page.keyboard.press) -> None:
            expected = f"{moment() + by:.2f}"
            press(key)
            page.locator(f".timeline[aria-valuenow='{expected}']").wait_for()

        page.locator(".timeline[aria-valuenow='2.02']").wait_for()
        box = timeline.bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + box["width"] * 0.3, box["y"] + 14)
        page.locator(".timeline:not([aria-valuenow='2.02'])").wait_for()
        goes("ArrowRight", 0.02)
        goes("PageUp", 1)
        goes("ArrowLeft", -0.02)
        # A button takes no keys away; a box for text does.
        goes("Look at the packet before", -0.02, lambda name: page.get_by_label(name).click())
        goes("PageDown", -1)
        page.get_by_role("button", name="Add value").first.click()
        page.keyboard.type("speed")
        before = moment()
        page.keyboard.press("ArrowLeft")
        page.keyboard.press("Enter")
        plot = page.locator(".u-over").first
        plot.wait_for()
        assert moment() == before
        plot.click(position={"x": 100, "y": 20})
        page.wait_for_function(f"() => document.querySelector('.timeline').ariaValueNow !== '{before:.2f}'")
        goes("Shift+ArrowRight", 1)


def test_curves_of_another_log_are_kept_for_it_and_not_shown(tmp_path: Path, browser: Browser) -> None:
    first, second = a_match(), practice()
    for log, name in ((first, "BatteryVoltage"), (second, "arm")):
        log.values(f"NT:/{name}", "double", "d", *((step / 10, 12.0) for step in range(90)))
    first.values("NT:/BatteryVolts", "double[]", "", (0, b""))  # not a number
    logs = {
        name: open_log(log.save(tmp_path / name), HEIGHT) for name, log in (("a.wpilog", first), ("b.wpilog", second))
    }
    opened: list[Any] = []

    def shown(name: str, expected: list[str]) -> Any:
        """Open a log, and wait for its curves."""
        page = browser.new_page(viewport={"width": 1180, "height": 820})
        page.set_default_timeout(PATIENCE * 1000)
        opened.append(page)
        page.goto(opened_server.address)
        page.locator(".recorded code", has_text=name).wait_for()
        page.get_by_role("button", name="Remove nt:").first.wait_for()
        names = "[...document.querySelectorAll(`[data-panel='plot:1'] .legend .curve`)].map((each) => each.innerText)"
        page.wait_for_function(f"() => JSON.stringify({names}) === `{json.dumps(expected, separators=(',', ':'))}`")
        return page

    def add(page: Any, name: str) -> None:
        page.get_by_role("button", name="Add value").first.click()
        page.keyboard.type(name)
        page.keyboard.press("Enter")
        page.get_by_role("button", name=f"Remove nt:/{name}").wait_for()
        page.wait_for_function("() => !sessionStorage.getItem('pyfrc-unsaved')")  # it is saved

    project = Project(tmp_path / "robot.py")
    with served_source(LogSource(project, logs["a.wpilog"])) as opened_server:
        add(shown("a.wpilog", ["BatteryVoltage"]), "SmartDashboard/speed")
    with served_source(LogSource(project, logs["b.wpilog"])) as opened_server:
        # It has the speed, too.
        page = shown("b.wpilog", ["speed"])
        add(page, "arm")
        page.get_by_role("button", name="1 not in this log").click()
        page.locator(".absent-list", has_text="BatteryVoltage").wait_for()
    with served_source(LogSource(project, logs["a.wpilog"])) as opened_server:
        page = shown("a.wpilog", ["BatteryVoltage", "speed"])
        page.get_by_role("button", name="1 not in this log").click()
        page.get_by_role("button", name="Remove it").click()
        page.locator(".absent").wait_for(state="detached")
        assert page.locator("[data-panel='plot:1'] .legend .curve").count() == 2
    for page in opened:
        page.close()


#: The colours in the middle of each band below a plot, at a share of its width.
BANDS = """([share, count]) => {
  const canvas = document.querySelector("[data-panel='plot:1'] .plot-bands");
  const top = count > 2 ? 15 : 0; // the name of the branch
  const [x, step] = [canvas.width * share, (canvas.height - top) / count];
  const colorAt = (y) => canvas.getContext("2d").getImageData(x, y, 1, 1).data.join();
  return Array.from({ length: count }, (_, n) => colorAt(top + step * (n + 0.3)));
}"""


def test_a_robot_is_chosen_and_states_of_the_other_log_are_drawn_below_those_of_the_first(
    tmp_path: Path, browser: Browser
) -> None:
    opened = []
    for name, (until, state) in {"a.wpilog": (4, b"IDLE"), "b.wpilog": (6, b"AIMING")}.items():
        log = Written()
        log.values("NT:/on", "boolean", "?", (0, True), (until, False), (10, False))
        log.values("NT:/state", "string", "", (0, b"START"), (2, state), (10, b"END"))
        for number, table in enumerate(("Mine", "Other"), 1):
            log.values(f"NT:/{table}/.type", "string", "", (0, b"Field2d"))
            log.values(f"NT:/{table}/Robot", "double[]", "", (0, struct.pack("<3d", number * 3.048, 3.048, 0)))
        opened.append(open_log(log.save(tmp_path / name), HEIGHT))
    source = LogSource(Project(tmp_path / "robot.py"), opened[0], (opened[1].run,))
    with served_source(source) as server, opened_page(browser, server.address, 1600, 1000) as page:
        page.locator(".recorded code", has_text="a.wpilog").wait_for()
        # A person says which pose is the robot; those of the same name have their table.
        for item, x in (("Robot: Other/Robot", "6.10 m"), ("Robot: Mine/Robot", "3.05 m")):
            page.get_by_title("What is drawn", exact=True).click()
            page.locator(".menu-list button", has_text=item).click()
            page.locator(".pose", has_text=x).wait_for()
        for name in ("nt:/on", "nt:/state"):
            page.get_by_role("button", name="Add value").first.click()
            page.keyboard.type(name)
            page.keyboard.press("Enter")
        page.locator("[data-panel='plot:1']").get_by_role("button", name="All", exact=True).click()
        bands = page.locator("[data-panel='plot:1'] .plot-bands")
        page.wait_for_function("() => document.querySelector(`[data-panel='plot:1'] .plot-bands`).clientHeight === 49")
        box = bands.bounding_box()
        assert box is not None
        bands.click(position={"x": box["width"] / 4, "y": 10})
        page.locator(".clock", has_text="0:02.4").wait_for()
        page.get_by_title("Compare with another log", exact=True).click()
        page.locator(".menu-list button", has_text="b.wpilog").first.click()
        page.wait_for_function("() => document.querySelector(`[data-panel='plot:1'] .plot-bands`).clientHeight === 110")
        page.wait_for_function(  # until the curves are there, and drawn; those of the branch are fainter
            f"""() => {{
                    const [on, onThere] = ({BANDS})([0.3, 4]), [off, stillOn, idle, aiming] = ({BANDS})([0.5, 4]);
                    return on !== onThere && off !== on && stillOn === onThere && idle !== aiming;
                }}"""
        )
        # Nothing covers the last state of the branch.
        page.wait_for_function(f"() => {{ const [off, , , last] = ({BANDS})([0.97, 4]); return last !== off; }}")
        page.locator("[data-panel='plot:1']").get_by_role("button", name="Table").click()
        page.locator(".timeline").focus()
        page.keyboard.press("Home")
        for _ in range(3):
            page.keyboard.press("PageUp")
        rows = page.locator("[data-panel='plot:1'] .curve-table tr")
        rows.filter(has_text="state").filter(has_text="IDLE").wait_for()
        rows.filter(has_text="in the branch").filter(has_text="AIMING").wait_for()
        assert bands.is_visible()


def test_the_code_of_a_project_can_be_run_with_a_log(tmp_path: Path) -> None:
    log, project = open_log(a_match().save(tmp_path / "match.wpilog"), HEIGHT), Project(tmp_path / "robot.py")
    with served_source(LogSource(project, log)) as server, server.page() as page:
        assert page.hello["source"]["replays"] is False
        assert page.ask(type="command", name="what_if")["type"] == "error"
    with served_source(LogSource(project, log, what_if=lambda: "its address")) as server, server.page() as page:
        assert page.hello["source"]["replays"] is True
        assert page.command("what_if")["address"] == "its address"


def test_the_page_goes_to_the_simulation_that_runs_the_code(tmp_path: Path, browser: Browser) -> None:
    log, project = open_log(a_match().save(tmp_path / "match.wpilog"), HEIGHT), Project(tmp_path / "robot.py")
    with served_source(LogSource(project, log)) as server:
        address = f"{server.address}&there"
        answers = iter(["", "", address])
        with (
            served_source(LogSource(project, log, what_if=lambda: next(answers))) as before,
            opened_page(browser, before.address) as page,
        ):
            page.get_by_role("button", name="What would my code have done?").click()
            page.wait_for_url(address)
            page.locator(".recorded code", has_text="match.wpilog").wait_for()


def started(what_if: WhatIf) -> str:
    """Return the address, asking again as a page does."""
    while not (address := what_if.start()):
        pass
    return address


def test_a_simulation_that_a_log_drives_is_started_and_ended(make_project: Any, monkeypatch: Any) -> None:
    made = make_project({"robot.py": "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"})
    log = a_match().save(made.path / "match.wpilog")
    said: list[str] = []
    what_if = WhatIf(Project(made.path / "robot.py"), log, said.append)
    try:
        address = urlsplit(started(what_if))
        assert what_if.start() == address.geturl()
        with connect(f"ws://{address.netloc}/ws?{address.query}", max_size=None) as socket:
            page = Page(socket)
            page.until(lambda: [branch["name"] for branch in page.parts["branches"]] == ["match.wpilog"])
    finally:
        what_if.close()
    assert f"The simulator is at {address.geturl()}\n" in said
    # What a simulation that does not start prints is the reason: here, its command.
    monkeypatch.setattr("pyfrc_core.sim.what_if.sys", SimpleNamespace(executable="echo"))
    broken = WhatIf(Project(made.path / "robot.py"), log, said.append)
    with pytest.raises(PyfrcError, match=r"The simulation did not start: -m pyfrc sim .* --log .*match.wpilog"):
        started(broken)
    broken.close()


def test_a_log_that_is_overwritten_while_it_is_shown_stays(tmp_path: Path) -> None:
    """Another program may write the file again, such as a simulation, or a copy of the next match."""
    with served_source(source_of(tmp_path)) as server, server.page() as page:
        (tmp_path / "match.wpilog").write_bytes(b"")
        asked = {"from": 0, "to": 100, "points": 1000}
        found = page.ask(type="plot", paths=["nt:/SmartDashboard/speed"], **asked)
        assert len(found["series"]["nt:/SmartDashboard/speed"]["v"]) > 10
