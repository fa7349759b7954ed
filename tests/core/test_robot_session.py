"""The robot's side of a simulation, in this process: its commands come from a list, its time on the wall is given."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import wpilib

from pyfrc_core.config.settings import MatchSettings
from pyfrc_core.config.sim import FieldConfig
from pyfrc_core.errors import UsageError
from pyfrc_core.project import Project
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.runtime.scripts.script import InputScript, Step
from pyfrc_core.sim import SimOptions
from pyfrc_core.sim.engine import commands
from pyfrc_core.sim.engine.messages import Job, Ready, Replayed, StationState, Update, WindowClosed
from pyfrc_core.sim.engine.robot_side import pace, robot_process, session
from pyfrc_core.sim.engine.robot_side import station as robot_side
from pyfrc_core.sim.engine.robot_side.session import Ended, Session
from pyfrc_core.wpi.opmodes import PublishedOpmode

PACKET = 0.02


class World:
    """The other end of a session's connection, and the wall clock.

    The commands of `script` come one by one, each when the session waits for one; then the simulation ends.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 100.0
        self.script: list[object] = []
        self.sent: list[Any] = []
        self.waits: list[float] = []
        self._arrived: list[object] = []
        monkeypatch.setattr(pace, "wall", lambda: self.now)
        monkeypatch.setattr(session, "wall", lambda: self.now)

    def poll(self, timeout: float | None = 0.0) -> bool:
        if timeout:
            self.waits.append(round(timeout, 6))
            self.now += timeout
        if timeout is None and not self._arrived:
            self._arrived.append(self.script.pop(0) if self.script else commands.Quit())
        return bool(self._arrived)

    def recv(self) -> object:
        command = self._arrived.pop(0)
        if isinstance(command, EOFError):
            raise command
        return command

    def send(self, message: object) -> None:
        self.sent.append(message)

    @property
    def updates(self) -> list[Update]:
        return [each for each in self.sent if isinstance(each, Update)]

    @property
    def last(self) -> Update:
        return self.updates[-1]


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> World:
    return World(monkeypatch)


def robot_class(periodic: Callable[[wpilib.PWMSparkMax], object]) -> type[wpilib.TimedRobot]:
    class Robot(wpilib.TimedRobot):
        def robotInit(self) -> None:
            self.motor = wpilib.PWMSparkMax(7)

        def robotPeriodic(self) -> None:
            periodic(self.motor)

    return Robot


Play = Callable[..., World]


@pytest.fixture
def play(run: RobotRun, world: World, tmp_path: Path) -> Play:
    """Plays a session with these commands until it ends."""

    def play(
        *script: object,
        periodic: Callable[[wpilib.PWMSparkMax], object] = lambda motor: None,
        job: dict[str, Any] | None = None,
        robot: type[wpilib.RobotBase] | None = None,
        **options: Any,
    ) -> World:
        world.script += script
        project = Project(tmp_path / "robot.py")
        inputs = InputScript((), 0)
        made = Job(**{"project": project, "options": SimOptions(**options), "script": inputs, **(job or {})})
        connection: Any = world
        Session(run, made, connection).go(
            lambda: run.construct(robot or robot_class(periodic)), lambda: Ready((), (), None, ())
        )
        return world

    return play


PAUSED = {"time_state": commands.TimeState(paused=True, speed=0)}


def test_a_session_begins_with_all_values_and_ends_when_it_is_left(play: Play) -> None:
    seen = play(job=PAUSED)
    ready, update = seen.sent
    assert isinstance(ready, Ready)
    assert (update.time_us, update.mode, update.carried_out, update.changes, update.steps) == (0, "disabled", 0, (), ())
    assert update.base["pwm[7].value"] == 0
    assert seen.waits == []


def test_it_ends_with_the_process_of_the_simulation(play: Play) -> None:
    assert play(EOFError(), job=PAUSED).last.time_us == 0


def test_steps_are_packets_and_what_the_robot_does_in_them_is_a_line(play: Play) -> None:
    outputs = iter([0.0, 0.25, 0.25, 0.5])
    seen = play(
        commands.Resume(packets=1),
        commands.Resume(packets=3),
        periodic=lambda motor: motor.set(next(outputs)),
        job=PAUSED,
    )
    assert [(each.time_us, each.carried_out) for each in seen.updates if each.time_state.paused] == [
        (0, 0),
        (20_000, 1),
        (80_000, 2),
    ]
    found = [change for each in seen.updates for change in each.changes]
    assert [(each.time, each.values["pwm[7].value"]) for each in found] == [
        (0.02, 0.0),
        (0.04, pytest.approx(0.25, abs=0.01)),
        (0.08, 0.5),
    ]
    assert seen.last.mode_seconds == {"disabled": pytest.approx(0.08)}
    assert seen.last.recorded == 2


def test_the_time_that_the_robot_takes_for_a_packet_is_measured(play: Play, world: World) -> None:
    takes = iter([0.001, 0.025, 0.004])

    def periodic(motor: object) -> None:
        world.now += next(takes)

    play(*[commands.Resume(packets=1)] * 3, periodic=periodic, job=PAUSED)
    measured = [
        (round(each.packet_seconds, 6), round(each.worst_packet_seconds, 6), each.late_packets)
        for each in world.updates
        if each.time_state.paused
    ]
    assert measured == [(0, 0, 0), (0.001, 0.001, 0), (0.025, 0.025, 1), (0.004, 0.025, 1)]


def test_in_real_time_it_waits_for_each_packet(play: Play, world: World) -> None:
    started = {"time_state": commands.TimeState(until_us=100_000)}
    play(periodic=lambda motor: setattr(world, "now", world.now + 0.005), job=started)
    # The first packet is due 20 ms after the beginning, and each later one when 5 ms of it are used.
    assert world.waits == [0.02, *[0.015] * 4]
    assert (world.last.time_us, world.last.time_state.paused) == (100_000, True)
    assert world.last.reached == 0.0
    assert world.updates[-2].reached == pytest.approx(1.0, rel=0.1)


def test_without_a_recording_the_mean_of_several_packets_is_measured(play: Play, world: World) -> None:
    def periodic(motor: object) -> None:
        world.now += 0.001

    play(commands.Resume(until_us=400_000), periodic=periodic, job=PAUSED, recording=False)
    assert world.last.time_us == 400_000
    assert world.last.packet_seconds == pytest.approx(0.001)
    # As fast as possible, it looks at commands after 1, 2, 4, 8 packets, and updates come every 100 ms at most.
    assert len(world.updates) <= 4
    assert world.last.steps == ()


def test_inputs_are_written_and_wrong_ones_are_noted(play: Play) -> None:
    seen = play(
        commands.Write({"fpga_button": True, "fpga_buton": 1}),
        commands.Enable(True),
        commands.Write({"joysticks[0].axes[1]": "up"}),
        commands.Write({"joysticks[0].axes[1]": 0.5}),
        commands.Resume(packets=2),
        job=PAUSED,
    )
    notes = [note for each in seen.updates for note in each.notes]
    assert [note.partition(" = ")[0] for note in notes] == ["fpga_buton", "joysticks[0].axes[1]"]
    bases = [each.base for each in seen.updates if each.base is not None]
    assert bases[1]["fpga_button"] is True
    assert seen.last.mode == "teleop"
    assert seen.last.station.sticks == {"joysticks[0].axes[1]": 0.5}
    written = {target: value for each in seen.updates for step in each.steps for target, value in step.writes.items()}
    assert written["fpga_button"] is True
    assert written["joysticks[0].axes[1]"] == 0.5


def test_a_wrong_joystick_value_is_refused_while_the_robot_is_disabled(play: Play) -> None:
    seen = play(
        *(
            commands.Write({target: value})
            for target, value in (("joysticks[0].axes[1]", "up"), ("joysticks[0].axes[99]", 0.5))
        ),
        commands.Write({"joysticks[0].axes[1]": 2}),
        commands.Enable(True),
        commands.Resume(packets=2),
        job=PAUSED,
    )
    notes = [note for each in seen.updates for note in each.notes]
    assert [note.partition(" = ")[0] for note in notes] == [f"joysticks[0].axes[{axis}]" for axis in (1, 99, 1)]
    assert "expected a number from -1 to 1, not 'up' (str)" in notes[0]
    assert (seen.last.mode, seen.last.station.sticks) == ("teleop", {})


PRACTICE = "[tool.pyfrc.match]\nbefore = 0.02\nautonomous = 0.04\npause = 0.02\nteleop = 0.06\n"


def test_a_practice_match_has_all_periods_until_the_driver_station_is_used(play: Play, tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text(PRACTICE)
    seen = play(commands.Practice(), *[commands.Resume(packets=1)] * 9, job=PAUSED)
    found = [(each.mode, each.station.practice_since_us) for each in seen.updates if each.time_state.paused]
    periods = ["disabled", "disabled", "autonomous", "autonomous", "disabled", *["teleop"] * 3]
    assert found == [("disabled", None), *[(mode, 20_000) for mode in periods], *[("disabled", None)] * 2]


@pytest.mark.parametrize("ends_it", [commands.ChooseMode("test"), commands.EmergencyStop(), commands.Enable(False)])
def test_a_practice_match_ends_when_the_driver_station_is_used(ends_it: object, play: Play, tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text(PRACTICE)
    seen = play(commands.Practice(), *[commands.Resume(packets=1)] * 3, ends_it, commands.Resume(packets=2), job=PAUSED)
    assert seen.last.mode.startswith("disabled")
    assert seen.last.station.practice_since_us is None


def test_the_opmode_of_a_mode_is_the_one_that_was_chosen_or_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    names, selected = ["Drive", "Aim"], [""]
    theirs = robot_side.station
    monkeypatch.setattr(theirs, "mode_name", lambda: "disabled teleop")
    monkeypatch.setattr(theirs, "opmode_name", lambda: selected[-1])
    monkeypatch.setattr(
        theirs, "published_opmodes", lambda: [PublishedOpmode(each, "teleop", 1, "g") for each in names]
    )
    run: Any = SimpleNamespace(clock=SimpleNamespace(before_packet=[]))

    def write(target: str, value: object) -> None:
        assert target == "control.opmode"
        selected.append(str(value))

    def connected(script: InputScript, *opmodes: str) -> robot_side.Station:
        selected[:] = [""]
        made = robot_side.Station(run, MatchSettings(), FieldConfig(), write, StationState())
        made.connect(script, opmodes)
        return made

    first = connected(InputScript((), 0))
    assert [each.name for each in first.opmodes()] == ["Aim", "Drive"]
    assert selected == ["", "Aim"]
    assert first.carry_out(commands.ChooseOpmode("Drive", "teleop")) == ""
    assert first.carry_out(commands.ChooseOpmode("Drive", "teleop")) == ""
    assert selected == ["", "Aim", "Drive"]
    refused = "There is no opmode 'Drve' for teleop: the robot has published 'Aim', 'Drive'."
    assert first.carry_out(commands.ChooseOpmode("Drve", "teleop")) == refused
    assert first.carry_out(commands.ChooseOpmode("x", "test")).endswith("for test: the robot has published none.")
    names.remove("Drive")  # after a change of the code
    selected.append("")
    first._select_opmode("teleop")
    assert selected[-1] == "Aim"
    assert first.carry_out(commands.ChooseOpmode("", "teleop")) == ""
    assert (selected[-1], first.state.opmodes) == ("", {"teleop": ""})
    connected(InputScript((Step(0, {"control.opmode": "Drive"}),), 0))
    assert selected == [""]
    with pytest.raises(UsageError, match="there is no opmode 'None': the robot has published 'Aim'"):
        connected(InputScript((), 0), "None")


def test_all_values_are_sent_only_while_time_stands(play: Play, world: World) -> None:
    world._arrived += [commands.Resume(packets=1), commands.Write({"fpga_button": True})]
    play(commands.Write({"fpga_button": False}), job=PAUSED)
    assert [(each.time_us, each.base is not None) for each in world.updates] == [
        (0, True),
        (20_000, False),
        (20_000, True),
    ]


def test_what_a_replay_does_in_networktables_is_known(play: Play) -> None:
    values = iter(range(99))
    seen = play(
        commands.Resume(packets=1),
        periodic=lambda motor: wpilib.SmartDashboard.putNumber("turn", next(values)),
        job={**PAUSED, "forward_to_us": 100_000},
        network_values=True,
    )
    first, *others = seen.updates
    assert first.network_base is not None
    assert (first.network_base["nt:/SmartDashboard/turn"], first.network_changes) == (4, ())
    assert [change.values["nt:/SmartDashboard/turn"] for each in others for change in each.network_changes] == [5]


def test_a_replay_is_reported_only_where_code_has_changed(play: Play, world: World) -> None:
    inputs = InputScript((Step(20_000, {"mode": "teleop"}), Step(40_000, {"fpga_button": True})), 100_000)

    def periodic(motor: wpilib.PWMSparkMax) -> None:
        motor.set(0.5)
        world.now += 1.0

    play(periodic=periodic, job={**PAUSED, "script": inputs, "forward_to_us": 100_000, "reports_replay": True})
    reports = [each for each in world.sent if isinstance(each, Replayed)]
    assert [each.time_us for each in reports] == [40_000, 80_000]
    found = [change for each in reports for change in each.changes]
    values = [(each.time, each.values.get("pwm[7].value"), each.values.get("fpga_button")) for each in found]
    assert values == [(0.0, 0.0, False), (0.02, 0.5, None), (0.04, None, True)]
    assert (world.last.time_us, world.last.mode) == (100_000, "teleop")
    assert world.last.base is not None
    assert world.last.base["fpga_button"] is True


def test_a_robot_that_ends_by_itself_ends_the_session(play: Play) -> None:
    class Robot(wpilib.RobotBase):
        def startCompetition(self) -> None:
            pass

        def endCompetition(self) -> None:
            pass

    with pytest.raises(Ended):
        play(commands.Resume(packets=9), robot=Robot, job=PAUSED)


def test_a_robot_that_waits_is_paused_and_left_within_its_wait(play: Play, run: RobotRun) -> None:
    def periodic(motor: object) -> None:
        run.threads.sleep_until(run.clock.now_us + 50_000)

    seen = play(*[commands.Resume(packets=1)] * 3, periodic=periodic, job=PAUSED)
    assert [each.time_us for each in seen.updates if each.time_state.paused] == [0, 20_000, 40_000, 60_000]


# -- WPILib's own window -----------------------------------------------------------------------------------------------


def test_under_wpilibs_window_the_robot_has_a_thread_and_the_window_this_one(
    monkeypatch: pytest.MonkeyPatch, world: World
) -> None:
    import threading

    log: list[tuple[str, object]] = []
    ran = threading.Event()

    def robot(*arguments: object) -> None:
        thread = threading.current_thread()
        assert thread is threading.main_thread() or (thread.name, thread.daemon) == ("robot", True)
        log.append(("robot", thread is threading.main_thread()))
        ran.set()

    def window() -> None:
        assert ran.wait(60)
        log.append(("window", threading.current_thread() is threading.main_thread()))

    monkeypatch.setattr(robot_process, "_run", robot)
    monkeypatch.setattr(robot_process.robots, "load_extension", lambda module: log.append(("extension", module)))
    monkeypatch.setattr(robot_process.robots, "show_window", window)
    monkeypatch.setattr(
        robot_process, "LOADABLE", {"w": SimpleNamespace(module="w.module"), "x": SimpleNamespace(module="x")}
    )
    monkeypatch.setattr(robot_process, "WINDOW", "w")
    connection: Any = world

    def run(*extensions: str) -> list[tuple[str, object]]:
        log.clear()
        job: Any = SimpleNamespace(options=SimpleNamespace(extensions=extensions))
        crash_log: Any = None
        robot_process.run_robot(job, connection, crash_log, "")
        return log

    assert run("x") == [("extension", "x"), ("robot", True)]
    assert world.sent == []
    assert run("x", "w") == [("extension", "x"), ("extension", "w.module"), ("robot", False), ("window", True)]
    assert world.sent == [WindowClosed()]

    def gone(message: object) -> None:
        raise BrokenPipeError

    monkeypatch.setattr(world, "send", gone)
    run("w")  # the simulation has ended before
