"""`pyfrc sim --ui web`: what a page is sent, and what it can do; with real robots, HTTP and WebSockets."""

from __future__ import annotations

import json
import math
import threading
from functools import partial
from pathlib import Path

import pytest
from sim_robots import FILES
from web_pages import PATIENCE, Page, served
from websockets.exceptions import ConnectionClosed

from pyfrc_core.project import find_project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.ui.web.front_end import WebFrontEnd
from pyfrc_core.sim.ui.web.runs import Runs
from pyfrc_core.sim.ui.web.server import WebOptions
from pyfrc_core.sim.ui.web.updates import UpdateBuilder

DASHBOARD = {
    "robot.py": """
        import math

        import wpilib
        import wpimath.geometry


        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.motor = wpilib.PWMSparkMax(0)
                self.gain = 0.5
                wpilib.SmartDashboard.putNumber("kP", self.gain)
                self.mechanism = wpilib.Mechanism2d(3, 3)
                self.arm = self.mechanism.getRoot("pivot", 1, 1).appendLigament("arm", 2, 45)
                wpilib.SmartDashboard.putData("Arm", self.mechanism)
                self.alert = wpilib.Alert("the battery is low", wpilib.Alert.AlertType.kWarning)
                self.alert.set(True)
                self.count = 0
                import ntcore
                table = ntcore.NetworkTableInstance.getDefault()
                self.pose = table.getStructTopic("/pose", wpimath.geometry.Pose2d).publish()
                self.poses = table.getStructArrayTopic("/poses", wpimath.geometry.Pose2d).publish()
                self.odd = table.getDoubleTopic("/odd").publish()
                self.odd.set(math.nan)

            def robotPeriodic(self):
                self.count += 1
                self.gain = wpilib.SmartDashboard.getNumber("kP", 0)
                self.arm.setAngle(45 + self.count)
                self.motor.set(self.gain)
                self.pose.set(wpimath.geometry.Pose2d(1, self.count, wpimath.geometry.Rotation2d(0.5)))
                self.poses.set([wpimath.geometry.Pose2d(), wpimath.geometry.Pose2d(3, 4, 0)])
                if self.count == 3:
                    print("<script>alert(1)</script>")
                    print("Warning: brown out")
    """
}


@pytest.mark.bare
def test_a_page_drives_the_robot(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        page.run_for(0.1)
        page.command("choose_mode", mode="teleop")
        page.command("enable")
        page.command("axis", stick=0, axis=1, value=-0.5)
        page.run_for(1.0)
        assert page.station["enabled"]
        assert page.station["text"] == "Teleoperated enabled"
        assert page.values["pwm[0].value"] == pytest.approx(0.5)
        assert page.values["sim.mode"] == "teleop"
        x, y, angle = page.parts["robot"]
        assert x > 11
        assert (y, angle) == (12, 0)
        assert page.trail[-1] == pytest.approx([x, y], abs=0.2)
        page.command("e_stop")
        page.run_for(0.1)
        assert page.station["emergency_stopped"]
        assert page.values["pwm[0].value"] == 0


def test_a_page_sets_inputs_choosers_and_its_place(make_project) -> None:
    config = FILES["sim/config.json"].replace('"robot":', '"field": {"coordinates": "alliance"}, "robot":')
    with served(make_project({**FILES, "sim/config.json": config})) as server, server.page() as page:
        page.run_for(0.1)
        assert page.parts["field"]["coordinates"] == "alliance"
        page.command("write", values={"dio[3].value": False, "joysticks[2].axes[1]": 0.25})
        page.command("choose", chooser="/SmartDashboard/Auto", option="Forward")
        page.command("choose_mode", mode="autonomous")
        page.command("enable")
        page.command("alliance", station="blue2")
        page.command("game_message", text="RL")
        page.command("place", x=5, y=6, degrees=90)
        page.run_for(0.2)
        assert page.values["dio[3].value"] is False
        assert page.values["pwm[0].value"] == 1
        assert (page.station["alliance"], page.station["game_message"]) == ("blue2", "RL")
        assert page.parts["choosers"][0]["active"] == "Forward"
        assert page.parts["robot"][0] == pytest.approx(5, abs=0.1)
        assert page.parts["robot"][2] == pytest.approx(math.pi / 2)
        wrong = page.ask(type="command", name="write", values={})
        assert wrong["type"] == "error"
        page.command("write", values={"dio[99].value": True})
        page.until(lambda: "dio[99]" in page.status["note"])


def test_networktables_are_shown_and_edited_live(make_project) -> None:
    with served(make_project(DASHBOARD)) as server, server.page() as page:
        page.run_for(0.2)
        assert page.values["nt:/SmartDashboard/kP"] == 0.5
        assert page.types["nt:/SmartDashboard/kP"] == "double"
        page.command("write", values={"nt:/SmartDashboard/kP": 0.75})
        page.run_for(0.1)
        assert page.values["nt:/SmartDashboard/kP"] == 0.75
        assert page.values["pwm[0].value"] == pytest.approx(0.75, abs=0.01)
        assert page.values["nt:/SmartDashboard/Arm/.type"] == "Mechanism2d"
        assert page.values["nt:/SmartDashboard/Arm/pivot/arm/angle"] > 45
        assert page.values["nt:/SmartDashboard/Alerts/warnings"] == ["the battery is low"]
        assert page.types["nt:/pose"] == "struct:Pose2d"
        parts = {path: value for path, value in page.values.items() if path.startswith("nt:/pose")}
        assert parts == {
            "nt:/pose/translation/x": 1,
            "nt:/pose/translation/y": pytest.approx(page.values["nt:/pose/translation/y"]),
            "nt:/pose/rotation/value": pytest.approx(0.5),
            **{
                f"nt:/poses/{index}/{part}": value
                for index, pose in enumerate([(0, 0, 0), (3, 4, 0)])
                for part, value in zip(("translation/x", "translation/y", "rotation/value"), pose, strict=True)
            },
        }
        assert not parts.keys() & page.types.keys()  # only topics can be written to
        assert page.values["nt:/odd"] == {"$": "NaN"}


def test_output_has_times_levels_and_is_only_ever_text(make_project) -> None:
    with served(make_project(DASHBOARD)) as server, server.page() as page:
        page.run_for(0.2)
        page.until(lambda: any("brown out" in line["text"] for line in page.console))
        lines = {line["text"]: line for line in page.console}
        assert lines["<script>alert(1)</script>"]["level"] == "info"
        assert lines["Warning: brown out"]["level"] == "warning"
        assert [line["n"] for line in page.console] == list(range(1, len(page.console) + 1))
        assert any(mark["kind"] == "warning" for mark in page.marks)


def test_the_past_is_shown_without_disturbing_the_run(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        page.run_for(0.1)
        page.command("enable")
        for number in range(1, 6):
            page.command("axis", stick=0, axis=1, value=-number / 10)
            page.run_for(0.1)
        length = page.status["length"]
        then = page.ask(type="values", t=0.25)["values"]
        assert then["pwm[0].value"] == pytest.approx(0.2, abs=0.01)
        assert then["joysticks[0].axes"][1] == pytest.approx(-0.2)
        assert then["sim.mode"] == "teleop"
        assert page.ask(type="values", t=0.05)["values"]["sim.mode"] == "disabled"
        answer = page.ask(
            type="plot", paths=["pwm[0].value", "sim.mode", "joysticks[0].axes[1]"], **{"from": 0, "to": 9}, points=100
        )
        series = answer["series"]
        assert series["pwm[0].value"]["v"][-5:] == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5], abs=0.01)
        assert series["joysticks[0].axes[1]"]["v"][-5:] == pytest.approx([-0.1, -0.2, -0.3, -0.4, -0.5])
        assert (series["sim.mode"]["kind"], series["sim.mode"]["v"]) == ("text", ["disabled", "teleop"])
        assert page.status["length"] == length
        assert page.status["starts"] == 1


def test_every_change_of_a_subscribed_value_arrives_at_any_speed(make_project) -> None:
    with served(make_project(DASHBOARD)) as server, server.page() as page:
        page.run_for(0.1)
        page.ask(type="subscribe", paths=["nt:/SmartDashboard/Arm/pivot/arm/angle"])
        page.command("step", packets=500)
        page.until(lambda: len(page.samples.get("nt:/SmartDashboard/Arm/pivot/arm/angle", ())) >= 1000)
        flat = page.samples["nt:/SmartDashboard/Arm/pivot/arm/angle"]
        times, angles = flat[::2], flat[1::2]
        assert angles == [angles[0] + number for number in range(500)]
        assert times == pytest.approx([times[0] + 0.02 * number for number in range(500)])


def test_a_page_knows_from_when_on_values_are_kept(make_project, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.sim.ui.web.collector.Runs", partial(Runs, most_bytes=1))
    with served(make_project(DASHBOARD)) as server, server.page() as page:
        page.run_for(20)
        page.until(lambda: page.parts.get("known_from"))
        assert 0 < page.parts["known_from"] < 20


def drive_and_mark(page: Page) -> None:
    """Drive at half speed from 0.1 s to 1.1 s, and mark a moment."""
    page.run_for(0.1)
    page.command("enable")
    page.command("axis", stick=0, axis=1, value=-0.5)
    page.run_for(1.0)
    page.command("mark", t=0.9, text="here")
    page.until(lambda: any(mark["kind"] == "own" for mark in page.marks))


def test_driving_on_from_the_past_keeps_the_former_run_as_a_branch(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        drive_and_mark(page)
        page.command("rewind", t=0.5)
        page.until(lambda: page.parts["branches"] and page.status["state"] == "paused" and page.time == 0.5)
        assert (page.parts["run"]["number"], page.parts["run"]["t"]) == (2, 0.5)
        assert not any(mark["kind"] == "own" for mark in page.marks)
        (branch,) = page.parts["branches"]
        assert (branch["from"], branch["to"]) == (0.5, pytest.approx(1.1))
        page.command("axis", stick=0, axis=1, value=0.25)
        page.run_for(0.2)
        page.command("name_branch", branch=branch["id"], text="fast")
        page.until(lambda: page.parts["branches"][0]["name"] == "fast")
        now = page.ask(type="values", t=0.65)["values"]["pwm[0].value"]
        before = page.ask(type="values", t=0.65, branch=branch["id"])["values"]["pwm[0].value"]
        assert (now, before) == (pytest.approx(-0.25, abs=0.01), pytest.approx(0.5, abs=0.01))
        both = page.ask(type="values", t=0.45)["values"], page.ask(type="values", t=0.45, branch=branch["id"])["values"]
        assert both[0] == both[1]
        assert page.ask(type="values", t=0.65, branch=77)["type"] == "error"
        first = page.ask(type="first_difference", branch=branch["id"], paths=None)
        assert first["t"] == 0.5  # where the joystick was released
        assert "joysticks[0].axes" in first["paths"]
        only = page.ask(type="first_difference", branch=branch["id"], paths=["sim.mode", "dio[3].value"])
        assert (only["t"], only["paths"]) == (None, [])
        assert page.ask(type="first_difference", branch=77)["type"] == "error"


def test_other_questions_are_answered_while_runs_are_compared(make_project, monkeypatch) -> None:
    asked = threading.Event()

    def compare(*_: object) -> dict[str, object]:
        assert asked.wait(PATIENCE)
        return {"t": 7.0}

    monkeypatch.setattr(Runs, "plain_difference", compare)
    with served(make_project(DASHBOARD)) as server, server.page() as page:
        page.socket.send(json.dumps({"type": "first_difference", "branch": 1, "id": 9000}))
        assert page.ask(type="ping")["type"] == "answer"  # else the server ends the connection, since it reads nothing
        asked.set()
        while (answer := json.loads(page.socket.recv())).get("id") != 9000:
            pass
        assert answer["t"] == 7.0


def test_a_page_that_does_not_read_gets_merged_updates(make_project) -> None:
    with (
        served(make_project(DASHBOARD)) as server,
        server.page() as quick,
        server.page(max_queue=1) as slow,
    ):
        quick.command("speed", factor=1)
        quick.command("resume")
        quick.until(lambda: quick.time > 1)
        quick.command("pause")
        quick.until(lambda: quick.status["state"] == "paused")
        slow.until(lambda: slow.status["state"] == "paused" and slow.time == quick.time)
        assert slow.values == quick.values


@pytest.mark.bare
def test_a_layout_and_recordings_are_saved_in_the_project_and_nowhere_else(make_project) -> None:
    made = make_project(FILES)
    with served(made) as server:
        with server.page() as page:
            assert page.hello["layout"] is None
            page.ask(type="layout", layout={"panels": ["field", "plot"]})
        with server.page() as page:
            assert page.hello["layout"] == {"panels": ["field", "plot"]}
            too_large = page.ask(type="layout", layout={"x": "x" * 300_000})
            assert too_large["type"] == "error"
            page.run_for(0.2)
            assert page.command("save", file="drives/first")["file"] == "drives/first.jsonl"
            assert page.ask(type="command", name="save", file="../outside.jsonl")["type"] == "error"
    assert json.loads((made.path / ".pyfrc" / "sim-layout.json").read_text()) == {"panels": ["field", "plot"]}
    assert (made.path / "drives" / "first.jsonl").is_file()
    assert not (made.path.parent / "outside.jsonl").exists()


@pytest.mark.slow
def test_a_recording_that_is_there_is_replaced_only_when_that_is_wanted(make_project) -> None:
    made = make_project(FILES)
    with served(made) as server, server.page() as page:
        page.run_for(0.1)
        assert page.command("save", file="drive")["file"] == "drive.jsonl"
        before = (made.path / "drive.jsonl").read_text()
        page.run_for(0.1)
        assert page.command("save", file="drive")["exists"] == "drive.jsonl"
        assert (made.path / "drive.jsonl").read_text() == before
        assert page.command("save", file="drive", replace=True)["file"] == "drive.jsonl"
        assert (made.path / "drive.jsonl").read_text() != before
        (made.path / "other.trace.jsonl").touch()  # a recording has two files
        assert page.command("save", file="other")["exists"] == "other.trace.jsonl"


def test_messages_that_make_no_sense_are_errors_and_nothing_more(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        for wrong in (
            {"type": "command", "name": "launch"},
            {"type": "command", "name": "choose_mode", "mode": "sideways"},
            {"type": "command", "name": "axis", "stick": 9, "axis": 0, "value": 0},
            {"type": "command", "name": "axis", "stick": 0, "axis": 0, "value": "far"},
            {"type": "command", "name": "speed", "factor": -1},
            {"type": "plot", "paths": "all", "from": 0, "to": 1},
            {"type": "values", "t": None},
            {"type": "nonsense"},
            {"type": "command", "name": ["enable"]},
        ):
            assert page.ask(**wrong)["type"] == "error", wrong
        for text in ("", "nonsense", "[1]", "7", '"x"'):
            page.socket.send(text)
            page.until_type("error")  # which belongs to no question
        page.run_for(0.1)
        page.quit()


def test_a_mistake_of_pyfrcs_own_is_printed_and_ends_one_connection(make_project, monkeypatch, capsys) -> None:
    def broken(self: object, clients: int, with_time: bool = True) -> dict[str, object]:
        raise ZeroDivisionError("a mistake")

    def enable_and_wait(page: Page) -> None:
        page.command("enable")  # its answer may come before the end
        page.until(lambda: False)

    with served(make_project(FILES)) as server, server.page() as page:
        with monkeypatch.context() as patched:
            patched.setattr("pyfrc_core.sim.ui.web.updates.UpdateBuilder.update", broken)
            with pytest.raises(ConnectionClosed) as closed:
                enable_and_wait(page)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1011
        with server.page() as again:
            again.run_for(0.1)
    assert "a mistake" in capsys.readouterr().err


def test_a_mistake_of_pyfrcs_own_that_would_stop_all_pages_ends_the_simulation(make_project, monkeypatch) -> None:
    monkeypatch.setattr(Runs, "take", lambda *_: 1 / 0)
    simulation = Simulation(find_project(make_project(FILES).path), SimOptions(paused=True, network_values=True))
    with pytest.raises(ZeroDivisionError):
        WebFrontEnd(lambda _: None, WebOptions(opens_browser=False)).run(simulation)


@pytest.mark.bare
def test_the_pages_files_are_served_with_their_types(make_project) -> None:
    with served(make_project(FILES)) as server:
        status, headers, content = server.get(server.address.partition(":")[2].partition("/?")[2].join(("/?", "")))
        assert (status, headers["content-type"]) == (200, "text/html; charset=utf-8")
        assert content.count(b"<script") == 2
        assert b'<script type="importmap">{' in content
        assert b'<script type="module" src="/static/js/main.js">' in content
        page = Path(__file__).parents[1] / "pyfrc_core" / "sim" / "ui" / "web" / "page"
        types = {".css": "text/css", ".js": "text/javascript", ".mjs": "text/javascript"}
        for file in page.rglob("*"):
            if file.suffix not in types:
                continue
            address = f"/static/{file.relative_to(page).as_posix()}"
            status, headers, content = server.get(address)
            assert status == 200
            assert content == file.read_bytes()
            assert headers["content-type"].startswith(types[file.suffix])
            assert headers["cache-control"] == "no-cache"
            assert headers["x-content-type-options"] == "nosniff"
        again = server.get("/static/js/main.js", {"If-None-Match": server.get("/static/js/main.js")[1]["etag"]})
        assert (again[0], again[2]) == (304, b"")
        assert server.get("/static/../app.py")[0] == 404
        assert server.get("/static/%2e%2e/app.py")[0] == 404


def test_only_what_a_page_shows_is_sent(make_project) -> None:
    with served(make_project(DASHBOARD)) as server, server.page() as page:
        page.run_for(0.1)
        page.ask(type="show", paths=["pwm[0].value"], beginnings=["nt:/SmartDashboard/Arm/"])
        before = dict(page.values)
        page.command("write", values={"nt:/SmartDashboard/kP": 0.75})
        page.run_for(0.2)
        changed = {path for path in page.values if page.values[path] != before.get(path)}
        assert changed == {"pwm[0].value", "nt:/SmartDashboard/Arm/pivot/arm/angle"}
        # A moment of the past has the same values, and those that are gone since.
        found = page.ask(type="values", t=0.1, shown=True)["values"]
        assert {"pwm[0].value", "sim.mode", "nt:/SmartDashboard/Arm/.type"} <= found.keys()
        assert "nt:/SmartDashboard/kP" not in found
        assert "nt:/SmartDashboard/kP" in page.ask(type="values", t=0.1)["values"]
        # What is shown from now on is up to date, although nothing changes any more.
        page.ask(type="show", paths=[], beginnings=["nt:/"])
        page.until(lambda: page.values["nt:/SmartDashboard/kP"] == 0.75)
        page.until(lambda: page.values["nt:/pose/translation/y"] > before["nt:/pose/translation/y"])


@pytest.mark.slow
def test_a_later_time_alone_may_wait(make_project) -> None:
    with served(make_project(FILES)) as server, server.page() as page:
        page.run_for(0.1)
        assert server.front_end.collector is not None
        builder = UpdateBuilder(server.front_end.collector, "")
        assert builder.update(1)["t"] == pytest.approx(0.1)
        page.run_for(0.1)
        assert (builder.update(1, with_time=False), builder.is_late) == ({}, True)
        assert builder.update(1)["t"] == pytest.approx(0.2)
        assert (builder.update(1), builder.is_late) == ({}, False)
        page.command("enable")
        page.run_for(0.1)
        found = builder.update(1, with_time=False)
        assert (found["t"], found["values"]["sim.mode"]) == (pytest.approx(0.3), "teleop")
