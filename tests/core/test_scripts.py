"""Input scripts: their lines, what is wrong with them, what they write, and what a recorder makes of a run."""

from __future__ import annotations

import json
import math
from pathlib import Path

import ntcore
import pytest
import wpilib
from hal import simulation as hs
from loops import for_each

from pyfrc_core.errors import PyfrcError, UsageError
from pyfrc_core.hal import HalData
from pyfrc_core.hal.change_reader import same
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.runtime.scripts.player import Player
from pyfrc_core.runtime.scripts.script import FORMAT, InputScript, ScriptError, Step, load_script, parse_script
from pyfrc_core.runtime.scripts.targets import Targets
from pyfrc_core.wpi import station

HEADER = {"format": FORMAT, "end": 1.0}


def parse(*lines: object, header: object = HEADER) -> InputScript:
    return parse_script([json.dumps(line) + "\n" for line in (header, *lines)], "a.jsonl")


# -- the form -----------------------------------------------------------------------------------------------------


def test_a_script_is_read_as_it_was_written(tmp_path: Path) -> None:
    script = InputScript(
        (Step(0, {"mode": "teleop"}), Step(1_500_001, {"dio[3].value": False, "joysticks[0].axes[1]": -0.5})),
        end_us=2_000_000,
        start_us=20_000,
        robot="robot.py",
        seed=7,
        packages={"wpilib": "2026"},
        trace="abc",
        story=("it drives",),
    )
    assert list(script.lines()) == [
        '{"format": "pyfrc-input 1", "robot": "robot.py", "seed": 7, "start": 0.02, "end": 2.0, '
        '"packages": {"wpilib": "2026"}, "trace": "abc", "story": ["it drives"]}',
        '{"t": 0.0, "set": {"mode": "teleop"}}',
        '{"t": 1.500001, "set": {"dio[3].value": false, "joysticks[0].axes[1]": -0.5}}',
    ]
    script.save(tmp_path / "a.jsonl")
    read = load_script(tmp_path / "a.jsonl")
    assert read == script
    assert (Path(read.file), [step.line for step in read.steps]) == (tmp_path / "a.jsonl", [2, 3])
    assert parse_script(["\n", json.dumps(HEADER) + "\n", "\n", '{"t": 0.5, "set": {}}\n']).steps[0].line == 4
    assert list(InputScript((), 5).lines()) == [
        '{"format": "pyfrc-input 1", "robot": "", "seed": 0, "end": 5e-06, "packages": {}}'
    ]


@for_each(
    "lines, message",
    [
        ([], "a.jsonl:1: the file is empty: its first line must be the header"),
        (["{}"], 'a.jsonl:1: the first line must be the header, with "format": "pyfrc-input 1"'),
        (['{"format": "x"}'], "a.jsonl:1: unknown format 'x': this pyfrc reads 'pyfrc-input 1'"),
        (['{"format": "pyfrc-input 1"}'], 'a.jsonl:1: "end" is missing'),
        (['{"format": "pyfrc-input 1", "end": 1, "start": 2}'], 'a.jsonl:1: "end" comes before "start"'),
        (['{"format": "pyfrc-input 1", "end": -1}'], 'a.jsonl:1: "end" must be from 0 to 86400 s, not -1'),
        (['{"format": "pyfrc-input 1", "end": 86401}'], 'a.jsonl:1: "end" must be from 0 to 86400 s, not 86401'),
        (['{"format": "pyfrc-input 1", "end": true}'], 'a.jsonl:1: "end" must be a time in seconds, not true'),
        (['{"format": "pyfrc-input 1", "end": 1, "seed": true}'], 'a.jsonl:1: "seed" must be a whole number, not true'),
        (['{"format": "pyfrc-input 1", "end": 1, "story": [1]}'], 'a.jsonl:1: "story" must be a list of texts'),
        ([json.dumps(HEADER), "[]"], "a.jsonl:2: each line must be a JSON object"),
        ([json.dumps(HEADER), "{"], "a.jsonl:2: not valid JSON"),
        ([json.dumps(HEADER), "[" * 100_000], "a.jsonl:2: not an input script"),
        ([json.dumps(HEADER), '{"t": 1' + "0" * 10_000 + "}"], "a.jsonl:2: not an input script"),
        ([json.dumps(HEADER), '{"t": 1.5, "set": {}}'], "a.jsonl:2: 1.5 s is after the end of the script, at 1 s"),
        ([json.dumps(HEADER), '{"t": 1, "set": {"a": NaN}}'], "a.jsonl:2: NaN is no number that can be written"),
        ([json.dumps(HEADER), '{"t": "1"}'], 'a.jsonl:2: "t" must be a time in seconds, not "1"'),
        ([json.dumps(HEADER), '{"t": 1}'], 'a.jsonl:2: "set" is missing: an object of what is written'),
        ([json.dumps(HEADER), '{"t": 1, "set": []}'], 'a.jsonl:2: "set" must be an object of what is written, not []'),
        (
            [json.dumps(HEADER), '{"t": 0.5, "set": {}}', '{"t": 0.25, "set": {}}'],
            "a.jsonl:3: time goes back from 0.5 s to 0.25 s",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_line(lines: list[str], message: str) -> None:
    with pytest.raises(ScriptError) as caught:
        parse_script([f"{line}\n" for line in lines], "a.jsonl")
    assert str(caught.value).startswith(message)


def test_the_longest_times_and_values(tmp_path: Path) -> None:
    assert parse(header={**HEADER, "end": 86_400}).end_us == 86_400_000_000
    assert parse(header={**HEADER, "start": 1}).start_us == 1_000_000
    with pytest.raises(ScriptError) as caught:
        parse({"t": 0, "set": "x" * 100})
    assert str(caught.value).endswith("xxx...")
    with pytest.raises(ScriptError, match="is the file cut off here"):
        parse_script([json.dumps(HEADER) + "\n", '{"t": 1'], "a.jsonl")
    with pytest.raises(ScriptError, match="there is no file"):
        load_script(tmp_path / "none.jsonl")
    with pytest.raises(ScriptError, match="this is a directory"):
        load_script(tmp_path)
    (tmp_path / "a").write_bytes(b"\xff\xfe\xff")
    with pytest.raises(ScriptError, match="not UTF-8 text"):
        load_script(tmp_path / "a")
    with (tmp_path / "long").open("wb") as stream:
        stream.truncate(64 * 1024 * 1024 + 1)
    with pytest.raises(ScriptError, match="64 MB are too many for an input script: at most 64 MB"):
        load_script(tmp_path / "long")


# -- targets --------------------------------------------------------------------------------------------------------


@pytest.fixture
def tree() -> HalData:
    station.reset_driver_station()
    return HalData(defaults=False)


def test_targets(tree: HalData) -> None:
    packets: list[int] = []
    targets = Targets(tree, lambda: packets.append(1))
    targets.write("mode", "autonomous", 0)
    assert station.mode_name() == "autonomous"
    targets.write("packet", True, 0)
    assert packets == [1]
    targets.write("joysticks[2].plugged", False, 0)
    assert hs.getJoystickCounts(2) == (0, 0, 0)
    targets.write("joysticks[2].plugged", True, 0)
    assert hs.getJoystickCounts(2) == (12, 12, 1)
    targets.write("joysticks[1].axes[2]", 0.5, 0)
    assert tree["joysticks"][1]["axes"][2] == 0.5
    for value, kept in ((1, 1.0), (True, True), ("text", "text"), ([1.0, 2.0], [1.0, 2.0])):
        targets.write(f"nt:/test/{kept}", value, 0)
        entry = ntcore.NetworkTableInstance.getDefault().getEntry(f"/test/{kept}")
        assert (entry.value, type(entry.value)) == (kept, type(kept))
    with pytest.raises(UsageError, match="/test/text is string, and cannot be"):
        targets.write("nt:/test/text", 1, 0)
    for wrong, message in (
        (("mode", "fast"), "there is no mode 'fast'"),
        (("match_time", True), "match_time is a number of seconds, not True"),
        (("match_time", "1"), "match_time is a number of seconds"),
    ):
        with pytest.raises(UsageError, match=message):
            targets.write(*wrong, 0)


def test_targets_that_there_never_are(tree: HalData) -> None:
    targets = Targets(tree)
    for fine in (
        "mode",
        "match_time",
        "packet",
        "nt:/x",
        "joysticks[5].plugged",
        'CAN["x"].y',
        "robot.x",
        "dio[3].value",
    ):
        targets.check(fine)
    for wrong in ("dio[99].value", "joysticks[6].plugged", "nothing", "dio[3].nothing"):
        with pytest.raises(PyfrcError):
            targets.check(wrong)
    switch = wpilib.DigitalInput(19)
    targets.check_made("dio[19].value")
    targets.check_made("mode")
    targets.check_made("joysticks[5].plugged")
    with pytest.raises(UsageError, match=r"^this robot has no dio\[18\]$"):
        targets.check_made("dio[18].value")
    del switch


# -- recording ------------------------------------------------------------------------------------------------------


def test_values_that_are_the_same() -> None:
    nan = float("nan")
    assert [same(*pair) for pair in ((1, 1), (1.5, 1.5), (nan, float("nan")), ("a", "a"), ([0.0], [0.0]))] == [True] * 5
    assert [same(*pair) for pair in ((0.0, -0.0), (1, True), (1, 1.0), (1, 2), ("1", 1), (0.0, nan))] == [False] * 6


class Robot(wpilib.TimedRobot):
    """Writes down what it sees."""

    def robotInit(self) -> None:
        self.stick = wpilib.Joystick(0)
        self.seen: list[tuple[object, ...]] = []

    def robotPeriodic(self) -> None:
        station = wpilib.DriverStation
        self.seen.append((station.isTeleopEnabled(), round(self.stick.getX(), 3), self.stick.getRawButton(2)))


def drive(run: RobotRun) -> None:
    """What a test does."""
    stick = run.hal_data["joysticks"][0]
    run.run_until(30_000)
    station.set_mode(enabled=True)
    stick["axes"][0] = 0.1
    run.run_until(70_000)
    stick["buttons"][2] = True
    run.run_until(90_000)
    stick["axes"][0] = -1.0
    station.set_mode(enabled=False)
    run.run_until(130_000)


def test_a_script_that_does_not_fit_the_robot_names_its_line(run: RobotRun) -> None:
    run.construct(Robot)
    with pytest.raises(ScriptError) as caught:
        Player(parse({"t": 0, "set": {"nothing": 1}}), run)
    assert str(caught.value).startswith("a.jsonl:2: there is no key 'nothing'")
    for wrong, message in (
        ({"dio[": True}, "cannot read"),
        ({"dio[4].valu": True}, r"there is no key 'valu' in dio\[4\]"),
        ({"dio[44].value": True}, ""),
        ({"dio[4].value": "up"}, r"dio\[4\]\.value: "),
        ({"mode": "teleoperated"}, "there is no mode 'teleoperated'"),
        ({"joysticks[0].axes[1]": 2}, r"joysticks\[0\]\.axes\[1\]: "),
        ({"nt:/wrong": 1.5, "nt:string:/wrong": "text"}, "/wrong is double, and cannot be 'text'"),
    ):
        with pytest.raises(ScriptError, match=rf"^a\.jsonl:2: {message}"):
            Player(parse({"t": 0, "set": wrong}), run).start()
    player = Player(parse({"t": 0.05, "set": {"dio[17].value": False}}), run)
    with pytest.raises(ScriptError, match=r"^a\.jsonl:2: this robot has no dio\[17\]"):
        player.play()
    assert run.clock.now_us == 999_999


def test_a_player_writes_when_it_is_due_and_stops_when_it_is_told(run: RobotRun) -> None:
    robot = run.construct(Robot)
    script = parse(
        {"t": 0, "set": {"mode": "disabled"}},
        {"t": 0.02, "set": {"mode": "teleop", "match_time": 10}},
        {"t": 0.06, "set": {"mode": "disabled"}},
        header={**HEADER, "start": 0.01},
    )
    Player(script, run).play(until_us=100_000)
    # What is written at 0.02 s is there with the packet of 0.02 s.
    assert [seen[0] for seen in robot.seen] == [True, True, False, False]
    assert run.clock.now_us == 99_999
    assert math.isclose(wpilib.DriverStation.getMatchTime(), 10 - 0.06, abs_tol=1e-6)
    station.deliver_packet()


def test_a_script_may_say_how_many_buttons_a_joystick_has() -> None:
    targets, hal_data = Targets(HalData()), HalData()
    targets.check("joysticks[0].buttons[14]")
    targets.write("joysticks[0].button_count", 14, 0)
    targets.write("joysticks[0].buttons[14]", True, 0)
    assert hal_data["joysticks"][0]["buttons"][14]
    with pytest.raises(LookupError):
        targets.check("joysticks[0].buttons[33]")
