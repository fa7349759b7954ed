"""A simulation session: commands in, snapshots out; time travel; robots that fail."""

from __future__ import annotations

import json
import math
import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, replace
from types import MappingProxyType
from typing import Any

import ntcore
import pytest
from conftest import sampled
from loops import for_each
from ports import lasting_port
from sim_robots import FILES, PATIENCE, run, settle, wait
from spelling import spelled

from pyfrc_core.errors import UsageError
from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.processes.spawn import StartedProcess
from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts.script import InputScript, Step, parse_script
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.sim.engine import processes
from pyfrc_core.sim.engine.commands import Write
from pyfrc_core.sim.engine.first_script import ending_released, first_script, releases_after
from pyfrc_core.sim.engine.recording import Recording
from pyfrc_core.sim.engine.scene import Field, Pose
from pyfrc_core.sim.engine.snapshot import Snapshot
from pyfrc_core.sim.engine.watch import Watch

STILL = SimOptions(paused=True, speed=0)


@pytest.fixture
def project(make_project) -> Project:
    made = make_project(FILES)
    return Project(made.path / "robot.py")


@pytest.fixture
def simulation(project: Project) -> Iterator[Simulation]:
    """The robot, at time 0."""
    with Simulation(project, STILL) as simulation:
        settle(simulation)
        yield simulation


def released(snapshot: Snapshot) -> Snapshot:
    """Return the snapshot without what the joysticks do: going back releases them."""
    values = {path: value for path, value in snapshot.values.items() if not path.startswith("joysticks")}
    return replace(snapshot, values=MappingProxyType(values))


def drive_forward(simulation: Simulation) -> None:
    simulation.enable()
    simulation.set_axis(0, 1, -1.0)


def test_a_robot_that_has_just_been_switched_on(simulation: Simulation) -> None:
    snapshot = simulation.snapshot
    assert snapshot is not None
    assert (snapshot.time, snapshot.mode, snapshot.enabled, snapshot.chosen_mode) == (0.0, "disabled", False, "teleop")
    assert snapshot.values["pwm[0].value"] == 0
    assert snapshot.values["dio[3].is_input"] is True
    assert "pwm[2].value" not in snapshot.values  # the robot has made no such motor
    assert snapshot.values["alliance_station"] == 4
    assert snapshot.scene.robot == (10, 12, 0)
    assert [text.text for text in snapshot.scene.drawings] == ["hello"]
    assert (snapshot.scene.field.width, list(snapshot.scene.field.starts)) == (54.25, ["start", "left", "right"])
    wait(simulation, lambda: "the robot is there" in simulation.output_cursor().read())
    with pytest.raises(FrozenInstanceError):
        snapshot.time = 1.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        snapshot.values["pwm[0].value"] = 1  # type: ignore[index]


def test_driving_as_from_a_driver_station(simulation: Simulation) -> None:
    simulation.enable()
    simulation.set_axis(0, 1, -0.5)
    simulation.set_alliance("blue2")
    simulation.set_game_message("LRL")
    simulation.write({"dio[3].value": False})
    wait(simulation, lambda: simulation.snapshot.values.get("dio[3].value") is False)  # also while time stands still
    run(simulation, 2)
    snapshot = simulation.snapshot
    assert (snapshot.mode, snapshot.enabled) == ("teleop", True)
    assert snapshot.values["pwm[0].value"] == pytest.approx(0.5, abs=0.01)
    assert snapshot.values["alliance_station"] == 5  # as in traces
    assert snapshot.values["event.game_specific_message"] == "LRL"
    x, y, angle = snapshot.scene.robot
    assert (x, y, angle) == pytest.approx((15, 12, 0), abs=0.2)  # 2 s at half of 5 ft/s
    assert snapshot.distance == pytest.approx(x - 10, abs=0.1)
    assert snapshot.mode_seconds["teleop"] == pytest.approx(2, abs=0.05)
    assert snapshot.scene.trail[0] == pytest.approx((10, 12), abs=0.1)
    simulation.disable()
    run(simulation, 0.1)
    assert (simulation.snapshot.mode, simulation.snapshot.values["pwm[0].value"]) == ("disabled", 0)
    # Joystick data come in teleop only, unless sim/config.json says otherwise.
    assert simulation.snapshot.values["joysticks[0].axes"][1] == 0


def test_one_packet_is_a_fiftieth_of_a_second(simulation: Simulation) -> None:
    for packets in (1, 2, 3):
        simulation.step()
        wait(simulation, lambda: simulation.snapshot.time == packets * 0.02)  # noqa: B023
    simulation.step(5)
    wait(simulation, lambda: simulation.snapshot.time == 0.16 and simulation.status.state == "paused")
    simulation.run_until(1.0)
    wait(simulation, lambda: simulation.snapshot.time == 1.0 and simulation.status.state == "paused")


@pytest.mark.slow
def test_a_button_that_is_pressed_for_less_than_a_packet_is_seen_in_one(simulation: Simulation) -> None:
    def after_a_packet() -> tuple[bool, int]:
        then = simulation.snapshot.time + 0.02
        simulation.step()
        wait(simulation, lambda: simulation.snapshot.time == pytest.approx(then))
        return simulation.snapshot.values["joysticks[0].buttons"][3], simulation.snapshot.values["joysticks[0].povs"][0]

    simulation.enable()
    after_a_packet()
    for pressed, angle in ((True, 90), (False, -1)):
        simulation.set_button(0, 3, pressed)
        simulation.set_pov(0, 0, angle)
    assert after_a_packet() == (True, 90)
    assert after_a_packet() == (False, -1)
    # One that is pressed again at once stays pressed, and one that is held for packets is released at once.
    for pressed in (True, False, True):
        simulation.set_button(0, 3, pressed)
    assert [after_a_packet()[0] for _ in range(3)] == [True, True, True]
    simulation.set_button(0, 3, False)
    assert not after_a_packet()[0]
    # The recording has the press and the release, in packets that follow each other.
    changes = [
        step.writes["joysticks[0].buttons[3]"]
        for step in simulation.script().steps
        if "joysticks[0].buttons[3]" in step.writes
    ]
    assert changes == [True, False, True, False]


@pytest.mark.season_2026  # choosers
def test_autonomous_goes_by_the_chooser(simulation: Simulation) -> None:
    (chooser,) = simulation.snapshot.choosers
    assert (chooser.name, chooser.options, chooser.default) == (
        "/SmartDashboard/Auto",
        ("Forward", "Nothing"),
        "Nothing",
    )
    simulation.choose(chooser.name, "Forward")
    simulation.choose_mode("autonomous")
    wait(simulation, lambda: simulation.snapshot.mode == "disabled autonomous")
    assert simulation.snapshot.chosen_mode == "autonomous"
    simulation.enable()
    run(simulation, 1)
    assert simulation.snapshot.mode == "autonomous"
    assert simulation.snapshot.scene.robot.x > 14
    assert simulation.snapshot.choosers[0].active == "Forward"


def test_a_practice_match(simulation: Simulation) -> None:
    simulation.practice()
    seen = []
    for _ in range(9):
        run(simulation, 0.4)
        snapshot = simulation.snapshot
        seen.append((round(snapshot.time, 2), snapshot.mode, round(snapshot.match_left, 2)))
    assert seen[1] == (0.8, "autonomous", 0.42)  # it began with the packet of 0.02 s
    assert seen[2] == (1.2, "autonomous", 0.02)
    assert seen[3] == (1.6, "teleop", 1.82)
    assert seen[-1] == (3.6, "disabled", 0.0)
    assert simulation.snapshot.practice_since is None


def test_an_emergency_stop_lasts_until_the_robot_is_restarted(simulation: Simulation) -> None:
    drive_forward(simulation)
    run(simulation, 0.5)
    simulation.emergency_stop()
    run(simulation, 0.1)
    assert simulation.snapshot.emergency_stopped
    assert simulation.snapshot.values["pwm[0].value"] == 0
    simulation.enable()
    wait(simulation, lambda: "restart" in simulation.status.note)
    assert not simulation.snapshot.enabled
    simulation.restart()
    wait(simulation, lambda: simulation.status.state == "paused" and simulation.snapshot.time == 0)
    drive_forward(simulation)
    run(simulation, 0.5)
    assert not simulation.snapshot.emergency_stopped
    assert simulation.snapshot.scene.robot.x > 11


@pytest.mark.season_2026  # where its dashboard has the field
def test_putting_the_robot_elsewhere(simulation: Simulation) -> None:
    simulation.place(20, 5, 90)
    wait(simulation, lambda: simulation.snapshot.scene.robot == pytest.approx((20, 5, math.pi / 2)))
    drive_forward(simulation)
    run(simulation, 1)
    assert simulation.snapshot.scene.robot == pytest.approx((20, 10, math.pi / 2), abs=0.2)  # 90 degrees is down
    simulation.reset_position("right")
    wait(simulation, lambda: simulation.snapshot.scene.robot == pytest.approx((2, 20, 0)))
    with pytest.raises(UsageError, match="left"):
        simulation.reset_position("lft")


@pytest.mark.season_2026  # where its dashboard has the field
@pytest.mark.slow
def test_putting_a_robot_elsewhere_that_shows_a_field_of_its_own(make_project) -> None:
    robot = """
        import wpilib
        from wpimath.geometry import Pose2d

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.field = wpilib.Field2d()
                wpilib.SmartDashboard.putData("Field", self.field)

            def robotPeriodic(self):
                self.field.setRobotPose(Pose2d(1, 2, 0))
    """
    physics = """
        class PhysicsEngine:
            def __init__(self, controller, robot):
                pass

            def update_sim(self, now, tm_diff):
                pass
    """
    made = make_project({"robot.py": robot, "physics.py": physics})
    with Simulation(Project(made.path / "robot.py"), STILL) as simulation:
        settle(simulation)
        run(simulation, 0.5)
        simulation.place(20, 5, 90)
        run(simulation, 0.5)
        assert simulation.snapshot.scene.robot == pytest.approx((20, 5, math.pi / 2))


def test_going_back_lands_on_the_same_snapshot(simulation: Simulation) -> None:
    """In the middle of a match; and what was driven from there on can be driven again."""
    simulation.practice()
    run(simulation, 1)
    there = simulation.snapshot
    simulation.set_axis(0, 1, -1.0)
    run(simulation, 2)
    later, script = simulation.snapshot, simulation.script()
    simulation.rewind(1.0)
    wait(simulation, lambda: simulation.status.state == "paused")
    assert simulation.snapshot == there
    assert [recording.steps for recording in simulation.recordings] == [script.steps]
    assert simulation.status.former_trail == later.scene.trail
    simulation.set_axis(0, 1, -1.0)
    run(simulation, 2)
    assert simulation.snapshot == later
    assert simulation.script().trace == script.trace
    assert sum("alliance_station" in step.writes for step in simulation.script().steps) == 1
    simulation.rewind(0)
    wait(simulation, lambda: simulation.status.state == "paused")
    assert (simulation.snapshot.time, simulation.snapshot.mode) == (0, "disabled")


def test_a_script_is_played_and_can_be_taken_over(project: Project) -> None:
    script = parse_script(
        [
            '{"format": "pyfrc-input 1", "end": 10}',
            '{"t": 0, "set": {"mode": "teleop"}}',
            '{"t": 1, "set": {"joysticks[0].axes[1]": -1.0}}',
        ]
    )
    with Simulation(project, replace(STILL, script=script, start_at=2.0)) as simulation:
        settle(simulation)
        assert simulation.snapshot.time == 2.0
        assert simulation.snapshot.scene.robot.x == pytest.approx(15, abs=0.2)
        simulation.set_axis(0, 1, 0.0)
        run(simulation, 1)
        assert simulation.snapshot.scene.robot.x == pytest.approx(15, abs=0.2)
    with pytest.raises(UsageError, match="script's end"):
        Simulation(project, replace(STILL, script=script, start_at=11.0))


@pytest.mark.parametrize(
    ("button", "headline"),
    [
        (5, "ZeroDivisionError: division by zero"),
        pytest.param(6, "hangs here", marks=pytest.mark.slow),
        (7, "exit code 3"),
    ],
)
def test_a_robot_that_fails_takes_nothing_with_it(
    button: int, headline: str, simulation: Simulation, project: Project
) -> None:
    drive_forward(simulation)
    run(simulation, 1)
    before = simulation.snapshot
    simulation.set_button(0, button, True)
    run(simulation, 5)
    status = simulation.status
    assert status.state == "failed"
    assert headline in status.failure.headline
    line = next(
        number
        for number, text in enumerate(spelled(FILES["robot.py"]).strip().splitlines(), 1)
        if {5: "1 / 0", 6: "while True", 7: "os._exit"}[button] in text
    )
    place, _, what = status.failure.headline.partition(": ")
    assert place in (f"robot.py:{line}", f"robot.py:{line + 1}"), what
    if button == 5:
        assert f'\n  File "robot.py", line {line}, in ' in status.failure.details
        assert str(project.root) not in status.failure.details
    simulation.rewind(1.0)
    wait(simulation, lambda: simulation.status.state == "paused")
    assert released(simulation.snapshot) == released(before)
    run(simulation, 1)
    assert simulation.status.state == "paused"
    assert simulation.snapshot.enabled
    assert simulation.snapshot.values["pwm[0].value"] == 0  # what was held there is released


def test_code_that_cannot_be_imported_says_where(make_project) -> None:
    made = make_project({"robot.py": "import wpilib\n\n1 / 0\n"})
    with Simulation(Project(made.path / "robot.py"), STILL) as simulation:
        settle(simulation)
        assert simulation.status.failure.headline.startswith("robot.py:3: ZeroDivisionError")


def test_new_code_is_brought_to_the_same_moment(simulation: Simulation, project: Project) -> None:
    drive_forward(simulation)
    run(simulation, 2)
    before = simulation.snapshot
    watch = Watch(project.root)
    assert not watch.changed()
    robot = project.root / "robot.py"
    robot.write_text(robot.read_text().replace("SPEED = 1.0", "SPEED = 0.5  # slower"))
    assert watch.changed()
    assert not watch.changed()
    simulation.reload()
    wait(simulation, lambda: simulation.status.state == "paused")
    assert simulation.snapshot.time == pytest.approx(before.time, abs=1e-5)
    assert simulation.snapshot.scene.robot.x == pytest.approx(15, abs=0.2)
    assert simulation.status.former_trail == before.scene.trail
    # A mistake that is saved, and corrected: the moment is not lost.
    text = robot.read_text()
    robot.write_text(text.replace("SPEED = 0.5", "SPEED = 0.5 / 0"))
    simulation.reload()
    wait(simulation, lambda: simulation.status.state == "failed")
    robot.write_text(text.replace("SPEED = 0.5", "SPEED = 1.00"))
    simulation.reload()
    wait(simulation, lambda: simulation.status.state == "paused")
    assert simulation.snapshot.scene.robot == pytest.approx(before.scene.robot)


@pytest.mark.slow
def test_a_file_that_is_saved_twice_in_a_second(project: Project, monkeypatch) -> None:
    """Python would take the first one's compiled form for the second's: time, in seconds, and size are the same."""
    monkeypatch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
    robot = project.root / "robot.py"
    text = robot.read_text()
    second = (int(time.time()) + 3600) * 1_000_000_000  # in the future: not over, however long the first start takes
    reached = []
    with Simulation(project, STILL) as simulation:
        for speed in ("0.5", "1.0"):
            robot.write_text(text.replace("SPEED = 1.0", f"SPEED = {speed}"))
            os.utime(robot, ns=(second, second))
            simulation.restart()
            drive_forward(simulation)
            run(simulation, 2)
            reached.append(simulation.snapshot.scene.robot.x)
    assert reached[1] > reached[0] + 1


def test_real_time_goes_on_by_itself(project: Project) -> None:
    with Simulation(project, SimOptions(recording=False)) as simulation:
        wait(simulation, lambda: simulation.snapshot is not None and simulation.snapshot.time > 0.1)
        assert simulation.status.state == "running"
        simulation.rewind(0.0)
        assert "not recorded" in simulation.status.note
        with pytest.raises(UsageError, match="not recorded"):
            simulation.save(project.root / "script.jsonl")


@pytest.mark.skipif(not FORK_IS_SAFE, reason="it is the only way here, and so tested by all others")
def test_where_processes_cannot_be_forked(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    """The next one is started ahead, and takes over."""
    started: list[StartedProcess] = []
    start_host = processes.start_host

    def start(*arguments: Any) -> StartedProcess:
        started.append(start_host(*arguments))
        return started[-1]

    monkeypatch.setattr(processes, "start_host", start)
    with Simulation(project, replace(STILL, fork=False)) as simulation:
        drive_forward(simulation)
        run(simulation, 1)
        there = simulation.snapshot
        run(simulation, 1)
        assert [host.poll() for host in started] == [None, None]
        simulation.rewind(1.0)
        wait(simulation, lambda: simulation.status.state == "paused")
        assert released(simulation.snapshot) == released(there)
        assert [host.poll() is None for host in started] == [False, True, True]


@pytest.mark.parametrize(
    "fork", [False, pytest.param(True, marks=pytest.mark.skipif(not FORK_IS_SAFE, reason="no fork"))]
)
def test_closed_right_after_the_start(fork: bool, project: Project, tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[subprocess.Popen[bytes]] = []

    class Noted(subprocess.Popen):  # type: ignore[type-arg]
        def __init__(self, *args: object, **options: object) -> None:
            super().__init__(*args, **options)  # type: ignore[call-overload]
            made.append(self)

    monkeypatch.setattr("pyfrc_core.processes.spawn.popen", Noted)
    kept = tmp_path / "kept"
    kept.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(kept))
    simulation = Simulation(project, replace(STILL, fork=fork))
    simulation.start()
    simulation.enable()
    simulation.close()
    simulation.close()
    assert simulation.status.state == "closed"
    assert simulation.snapshot is None
    assert made
    assert all(process.returncode is not None for process in made)
    assert list(kept.iterdir()) == []
    simulation.restart()  # nothing comes of it any more
    assert simulation.status.state == "closed"


@pytest.mark.parametrize("speed", [-1, 0.001, 1e6, math.nan])
def test_speeds_that_cannot_be(speed: float, project: Project) -> None:
    with pytest.raises(UsageError, match="speed"):
        Simulation(project, SimOptions(speed=speed))


@pytest.mark.season_2026  # where its dashboard has the field
def test_dashboards_see_the_robot_and_are_recorded(project: Project) -> None:
    port = lasting_port()
    dashboard = ntcore.NetworkTableInstance.create()
    heard = threading.Event()

    def hear(event: ntcore.Event) -> None:
        if event.data.value.value() == "Nothing":
            heard.set()

    choice = "/SmartDashboard/Auto/selected"
    dashboard.addListener(
        dashboard.getEntry("/SmartDashboard/Auto/active"),
        ntcore.EventFlags.kValueAll | ntcore.EventFlags.kImmediate,
        hear,
    )
    try:
        with Simulation(project, replace(STILL, nt_port=port)) as simulation:
            settle(simulation)
            assert simulation.status.network_address == f"localhost:{port}"
            dashboard.setServer("127.0.0.1", port)
            dashboard.startClient4("dashboard")
            assert heard.wait(PATIENCE)
            dashboard.getEntry(choice).setString("Forward")
            dashboard.flush()
            told = {f"nt:{choice}": "Forward"}

            def chosen() -> bool:
                simulation.step()
                return simulation.snapshot.choosers[0].active == "Forward"

            wait(simulation, chosen)
            assert told in [step.writes for step in simulation.script().steps]
            # A second one finds the port taken, and says so.
            with Simulation(project, replace(STILL, nt_port=port)) as another:
                settle(another)
                assert another.status.network_address is None
                assert f"port {port} is taken" in another.status.note
    finally:
        ntcore.NetworkTableInstance.destroy(dashboard)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has a second address that is this computer's alone")
@pytest.mark.parametrize("shared", sampled([False, True], False))
def test_other_computers_reach_networktables_only_if_they_are_shared(shared: bool, project: Project) -> None:
    port = lasting_port()
    with Simulation(project, replace(STILL, nt_port=port, nt_shared=shared)) as simulation:
        settle(simulation)

        def listens() -> bool:  # its server does so in a thread of its own, a moment later
            simulation.step()
            return answers("127.0.0.1", port)

        wait(simulation, listens)
        assert answers("127.0.0.2", port) == shared


def answers(address: str, port: int) -> bool:
    """Return whether someone listens there."""
    with socket.socket() as connection:
        return connection.connect_ex((address, port)) == 0


DRIVEN = {"joysticks[0].axes[1]": -1.0, "joysticks[1].buttons[3]": True, "joysticks[1].povs[0]": 90}
RELEASED = {"joysticks[0].axes[1]": 0.0, "joysticks[1].buttons[3]": False, "joysticks[1].povs[0]": -1}


def test_what_was_held_is_released_where_a_moment_is_left_and_where_a_script_ends() -> None:
    held = Step(20_000, {"mode": "teleop", **DRIVEN})
    assert releases_after(Recording(InputScript((held,), 60_000))) == (Write(RELEASED),)
    assert releases_after(Recording(InputScript((held, Step(40_000, RELEASED)), 60_000))) == ()
    assert ending_released(InputScript((held,), 60_000)).steps == (held, Step(60_001, RELEASED))


@for_each("start, station", [(None, "blue1"), ("left", "blue1"), ("far", "red1")])
def test_the_alliance_is_that_of_the_wall_where_the_robot_starts(start: str | None, station: str) -> None:
    starts = {"start": Pose(0, 0, 0), "left": Pose(2, 3, 0), "far": Pose(50, 3, math.pi)}
    field = Field(54.25, 26.4, 20.0, 2.0, 3.0, starts)
    steps = first_script(replace(STILL, start_position=start), "robot.py", field).steps
    assert [step.writes["alliance_station"] for step in steps if "alliance_station" in step.writes] == [station]


def stands(simulation: Simulation) -> bool:
    """Whether the robot stays where it is, and no motor runs."""
    before = simulation.snapshot
    run(simulation, 0.5)
    now = simulation.snapshot
    return before.scene.robot == now.scene.robot and now.values["pwm[0].value"] == 0


def test_who_leaves_releases_what_they_held_and_the_last_one_disables(simulation: Simulation) -> None:
    one, other = simulation.attach(), simulation.attach()
    other.enable()
    one.set_axis(0, 1, -1.0)
    other.set_button(0, 2, True)
    run(simulation, 0.5)
    assert simulation.snapshot.values["pwm[0].value"] == 1
    one.leave()
    run(simulation, 0.1)
    assert simulation.snapshot.enabled
    assert simulation.snapshot.values["joysticks[0].buttons"][2]
    assert stands(simulation)
    other.leave()
    run(simulation, 0.1)
    assert not simulation.snapshot.enabled
    assert not any(simulation.snapshot.values["joysticks[0].buttons"])


@pytest.mark.season_2026  # choosers
def test_a_restart_keeps_what_was_chosen(simulation: Simulation) -> None:
    simulation.set_alliance("blue3")
    simulation.set_game_message("RLR")
    simulation.choose("/SmartDashboard/Auto", "Forward")
    simulation.choose_mode("autonomous")
    run(simulation, 0.5)
    simulation.set_alliance("blue2")  # also what the robot has not seen yet
    simulation.restart()
    settle(simulation)
    run(simulation, 0.1)
    now = simulation.snapshot
    assert now.time == pytest.approx(0.1)
    assert now.values["alliance_station"] == 5
    assert now.values["event.game_specific_message"] == "RLR"
    assert now.choosers[0].active == "Forward"
    assert (now.mode, now.chosen_mode) == ("disabled autonomous", "autonomous")
    simulation.choose_mode("teleop")
    simulation.restart()
    settle(simulation)
    run(simulation, 0.1)
    assert simulation.snapshot.chosen_mode == "teleop"


def test_the_robot_of_todays_physics_begins_at_the_start_that_is_chosen(make_project) -> None:
    physics = """
        class PhysicsEngine:
            def __init__(self, controller, robot):
                pass

            def update_sim(self, now, tm_diff):
                pass
    """
    positions = """{"pyfrc": {"robot": {"start_positions": [
        {"name": "left", "x": 2, "y": 3}, {"name": "far", "x": 50, "y": 3, "angle": 180}]}}}"""
    made = make_project({**FILES, "physics.py": physics, "sim/config.json": positions})
    with Simulation(Project(made.path / "robot.py"), replace(STILL, start_position="far")) as simulation:
        for _ in range(2):
            run(simulation, 0.1)
            assert simulation.snapshot.scene.robot == Pose(50, 3, pytest.approx(math.pi))
            simulation.restart()
            settle(simulation)


FORWARD = {"starting_x": 50, "starting_y": 12, "starting_angle": 0, "w": 2, "l": 3}


@pytest.mark.parametrize("walls", [False, True])
def test_walls_hold_the_robot_or_the_user_is_told(make_project, walls: bool) -> None:
    config = {"pyfrc": {"robot": FORWARD, "field": {"w": 54, "h": 27, "walls": walls}}}
    made = make_project({**FILES, "sim/config.json": json.dumps(config)})
    with Simulation(Project(made.path / "robot.py"), STILL) as simulation:
        drive_forward(simulation)
        run(simulation, 4)
        x = simulation.snapshot.scene.robot.x
        note = simulation.status.note
        if walls:
            assert (x, note) == (pytest.approx(54 - 3 / 2), "")
        else:
            assert x > 60
            assert re.search(
                r"\d\.\d\d s: The robot has left the field: x = 5[56]\.\d ft of 54\.0, y = 12\.0 ft of 27\.0", note
            )
            assert '"walls": true' in note
        simulation.set_axis(0, 1, 1.0)
        run(simulation, 1)
        assert simulation.snapshot.scene.robot.x < x - 2
