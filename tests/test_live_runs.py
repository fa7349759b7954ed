"""What a robot publishes, on one timeline: without a network, as a client would receive it."""

from __future__ import annotations

from collections.abc import Iterable

from loops import for_each

from pyfrc_core.sim.engine.changes import Change, RunBegan
from pyfrc_core.sim.engine.choosers import choosers_in
from pyfrc_core.sim.engine.messages import MODE, NO_CONNECTION, UNKNOWN_MODE
from pyfrc_core.sim.live.runs import RobotRuns
from pyfrc_core.wpi.network_news import Gone, Received

#: The robot's clock when the connection is made, in microseconds: it has been on for an hour.
ON = 3_600_000_000
WORD = "/FMSInfo/FMSControlData"
TYPE = Received("/FMSInfo/.type", "string", "FMSInfo", ON - 50_000_000)


class Robot:
    """Runs, and what was read of them."""

    def __init__(self) -> None:
        self.read: list[RunBegan | Change] = []
        self.runs = RobotRuns(lambda entry: None, self.read.append)
        self.wall = 0.0

    def connect(self, *first: Received, clock_us: int = ON) -> bool:
        """Connect, and return whether the program is another one."""
        self.runs.connect(self.wall, clock_us)
        self.runs.take(first, self.wall, clock_us)
        self.wall += 1
        return self.runs.take([], self.wall, clock_us)

    def take(self, *news: Received | Gone, clock_us: int | None = None) -> None:
        """Receive values."""
        times = [each.time_us for each in news if isinstance(each, Received)]
        self.wall += 1
        self.runs.take(news, self.wall, clock_us or max(times, default=0) or None)

    def changes(self, path: str) -> list[tuple[float, object]]:
        """Return when a value has changed in the last run, and to what."""
        begin = max(index for index, each in enumerate(self.read) if isinstance(each, RunBegan))
        changes = [each for each in self.read[begin:] if isinstance(each, Change)]
        return [(change.time, change.values[path]) for change in changes if path in change.values]


def number(name: str, value: float, time_us: int) -> Received:
    return Received(name, "double", value, time_us)


def test_times_are_those_of_the_robots_clock_from_the_connection_on() -> None:
    robot = Robot()
    robot.connect(TYPE, number("/x", 1.0, ON - 5_000_000))
    robot.take(number("/x", 2.0, ON + 1_234_567), number("/x", 3.0, ON + 1_244_567))
    assert robot.changes("nt:/x") == [(0.0, 1.0), (1.234567, 2.0), (1.244567, 3.0)]
    assert robot.runs.now == 1.244567
    robot.take(clock_us=ON + 5_000_000)
    assert robot.runs.now == 5.0


def test_values_of_one_loop_are_one_change() -> None:
    robot = Robot()
    robot.connect(TYPE)
    before = len(robot.read)
    robot.take(*(number(f"/{name}", 1.0, ON + 1_000_000 + 10 * name) for name in range(100)))
    assert [len(each.values) for each in robot.read[before:] if isinstance(each, Change)] == [200]  # and their types


def test_values_that_arrive_late_do_not_go_back() -> None:
    robot = Robot()
    robot.connect(TYPE)
    robot.take(number("/x", 1.0, ON + 2_000_000))
    robot.take(number("/y", 1.0, ON + 1_900_000), number("/x", 2.0, ON + 2_100_000))
    times = [each.time for each in robot.read if isinstance(each, Change)]
    assert times == sorted(times)
    assert robot.changes("nt:/y") == [(2.0, 1.0)]


def test_the_mode_is_that_of_the_control_word() -> None:
    robot = Robot()
    robot.connect(Received(WORD, "int", 32, ON - 1))
    for index, word in enumerate((32 | 3, 32 | 2, 32 | 1, 32 | 5, 32)):
        robot.take(Received(WORD, "int", word, ON + 1_000_000 * (index + 1)))
    modes = ["disabled", "autonomous", "disabled autonomous", "teleop", "test", "disabled"]
    assert robot.changes(MODE) == [(float(second), mode) for second, mode in enumerate(modes)]


def test_a_server_that_is_no_robot_has_no_mode() -> None:
    robot = Robot()
    robot.connect(number("/x", 1.0, ON))
    assert robot.changes(MODE) == [(0.0, UNKNOWN_MODE)]


def test_the_station_of_2027() -> None:
    robot = Robot()
    schema = b"uint64 opModeHash:56;enum{unknown=0,autonomous=1,teleoperated=2,utility=3}uint64 robotMode:2;" + (
        b"bool enabled:1;bool eStop:1;bool fmsAttached:1;bool dsAttached:1;"
    )
    word = (1 << 56 | 1 << 58 | 1 << 61).to_bytes(8, "little")  # autonomous, enabled, attached
    robot.connect(  # a value may arrive before the schema that describes it
        Received("/DriverStation/ControlWord", "struct:ControlWord", word, ON - 2),
        Received("/.schema/struct:ControlWord", "structschema", schema, ON - 1),
        Received("/DriverStation/StationNumber", "int", 2, ON - 1),
        Received("/DriverStation/IsRedAlliance", "boolean", False, ON - 1),
    )
    assert robot.changes(MODE) == [(0.0, "autonomous")]
    assert robot.runs.station.alliance_station == 5


def test_a_lost_connection_is_a_mode_and_history_goes_on_after_it() -> None:
    robot = Robot()
    robot.connect(TYPE, Received(WORD, "int", 33, ON - 1), number("/x", 1.0, ON - 1))
    robot.take(number("/x", 2.0, ON + 3_000_000))
    robot.take(clock_us=ON + 4_000_000)
    robot.runs.lose()
    # Between the two, the robot has set x at 5 s, and y for the first time.
    again = ON + 8_000_000
    assert not robot.connect(
        TYPE, number("/x", 3.0, ON + 5_000_000), number("/y", 1.0, ON + 6_000_000),
        Received(WORD, "int", 33, ON - 1), number("/x", 4.0, again + 100_000), clock_us=again,
    )  # fmt: skip
    assert robot.changes(MODE) == [(0.0, "teleop"), (4.0, NO_CONNECTION), (8.0, "teleop")]
    assert robot.changes("nt:/x") == [(0.0, 1.0), (3.0, 2.0), (5.0, 3.0), (8.1, 4.0)]
    assert robot.changes("nt:/y") == [(6.0, 1.0)]
    assert sum(isinstance(each, RunBegan) for each in robot.read) == 1


def test_topics_that_went_away_without_a_connection_are_gone_after_it() -> None:
    robot = Robot()
    robot.connect(TYPE, number("/x", 1.0, ON - 1))
    robot.runs.lose()
    robot.connect(TYPE, clock_us=ON + 1_000_000)
    robot.take()
    assert "nt:/x" not in robot.runs.values
    assert "nt:/FMSInfo/.type" in robot.runs.values


def test_topics_are_gone_but_not_those_of_a_connection_that_is_being_lost() -> None:
    robot = Robot()
    robot.connect(TYPE, number("/x", 1.0, ON - 1), number("/y", 1.0, ON - 1))
    robot.take(Gone("/x"), clock_us=ON + 1)
    robot.take(Gone("/y"), clock_us=ON + 2)  # as the first part of a loss
    assert robot.runs.values.keys() >= {"nt:/y"}
    assert "nt:/x" not in robot.runs.values
    robot.runs.lose()
    assert "nt:/y" in robot.runs.values


def test_a_chooser_that_went_away_and_is_back_is_one_chooser() -> None:
    robot = Robot()
    options = Received("/SmartDashboard/Auto/options", "string[]", ["a", "b"], ON - 1)
    robot.connect(TYPE, options, Received("/SmartDashboard/Auto/.type", "string", "String Chooser", ON - 1))
    for second in range(1, 4):
        robot.take(Gone(options.name), clock_us=ON + second * 1_000_000)
        robot.take(clock_us=ON + second * 1_000_000 + 1)
        robot.take(options._replace(time_us=ON + second * 1_000_000 + 2))
    assert [each.name for each in choosers_in(robot.runs.values)] == ["/SmartDashboard/Auto"]


def test_a_program_that_started_again_is_another_run() -> None:
    robot = Robot()
    robot.connect(TYPE, number("/x", 1.0, ON - 1))
    robot.take(number("/x", 2.0, ON + 60_000_000))
    robot.runs.lose()
    # The clock of a roboRIO goes on; all that the new program has published is newer.
    later = ON + 90_000_000
    assert robot.connect(TYPE._replace(time_us=later - 2_000_000), number("/x", 0.0, later - 1), clock_us=later)
    assert robot.changes("nt:/x") == [(0.0, 0.0)]
    assert [each.number for each in robot.read if isinstance(each, RunBegan)] == [1, 2]


def test_a_clock_that_is_back_is_another_run() -> None:
    """A simulation begins at 0 each time, so its first values have the same times as before."""
    robot = Robot()
    first = TYPE._replace(time_us=20_000)
    robot.connect(first, clock_us=1_000_000)
    robot.take(number("/x", 2.0, 30_000_000))
    robot.runs.lose()
    assert robot.connect(first, clock_us=900_000)


def test_nothing_is_decided_before_the_first_values_have_come() -> None:
    robot = Robot()
    robot.connect(TYPE)
    robot.runs.lose()
    assert not robot.connect(clock_us=ON + 1_000_000)
    robot.take(clock_us=ON + 9_000_000)
    assert robot.runs.station.mode == NO_CONNECTION
    robot.take(TYPE, clock_us=ON + 10_000_000)
    assert robot.changes(MODE)[-1] == (1.0, UNKNOWN_MODE)


def test_what_this_computer_sets_has_the_present_moment() -> None:
    robot = Robot()
    robot.connect(TYPE, number("/kP", 1.0, ON - 1))
    robot.take(number("/kP", 2.0, 0), clock_us=ON + 4_000_000)
    assert robot.changes("nt:/kP") == [(0.0, 1.0), (4.0, 2.0)]


def values_of(changes: Iterable[RunBegan | Change]) -> set[str]:
    return {path for each in changes for path in each.values}


@for_each("table", ["", "/AdvantageKit"])
def test_structs_come_as_their_parts(table: str) -> None:
    robot = Robot()
    schema = Received(f"{table}/.schema/struct:Point", "structschema", b"float x;float y", ON - 1)
    point = Received("/p", "struct:Point", b"\0\0\x80?\0\0\0@", ON - 2)
    robot.connect(point, schema)
    assert robot.changes("nt:/p/x") == [(0.0, 1.0)]
    assert "nt:/p" not in values_of(robot.read)


def test_how_late_many_values_are_is_known() -> None:
    robot = Robot()
    robot.connect(TYPE)
    many = [number(f"/{each}", 1.0, ON + 1_000_000) for each in range(2000)]
    robot.take(*many, clock_us=ON + 9_000_000)
    assert robot.runs.behind == 8
    robot.take(number("/0", 2.0, ON + 2_000_000), clock_us=ON + 10_000_000)  # one value may have any time
    assert robot.runs.behind == 0
