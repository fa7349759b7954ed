"""Input scripts: a recording's replay does what was recorded, and a script that is wrong says so with its line."""

from __future__ import annotations

import json
import signal
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from conftest import MakeProject, RobotProject, sample_robots, trace_hash
from hypothesis import given
from hypothesis import strategies as st

from pyfrc_core.runtime.scripts.script import FORMAT, InputScript, ScriptError, Step, load_script, parse_script

ROBOTS = Path(__file__).parent / "robots"
HEADER = {"format": FORMAT, "end": 1.0}

ROBOT = """
    import ntcore
    import wpilib
    from wpimath.geometry import Pose2d

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.motors = [wpilib.PWMSparkMax(port) for port in range(3)]
            self.switch = wpilib.DigitalInput(4)
            table = ntcore.NetworkTableInstance.getDefault().getTable("camera")
            self.pose = table.getStructTopic("pose", Pose2d).subscribe(Pose2d())
            self.tags = table.getStructArrayTopic("tags", Pose2d).subscribe([])
            self.own = table.getStructTopic("own", Pose2d).publish()

        def teleopPeriodic(self):
            self.motors[0].set(self.stick.getY())
            self.motors[1].set(self.pose.get().x)
            self.motors[2].set(sum(tag.y for tag in self.tags.get()))
            self.own.set(self.pose.get())
            if self.stick.getRawButton(3) and self.stick.getRawButton(2):
                raise RuntimeError("both at once")
    """

#: A match; poses from a camera; a failure; a drive.
TESTS = """
    import ntcore
    from pyfrc.tests import test_practice
    from wpimath.geometry import Pose2d

    def test_camera(control, hal_data):
        table = ntcore.NetworkTableInstance.getDefault().getTable("camera")
        pose = table.getStructTopic("pose", Pose2d).publish()
        tags = table.getStructArrayTopic("tags", Pose2d).publish()
        table.getRawTopic("image").publish("raw").set(b"12345678")
        with control.run_robot():
            pose.set(Pose2d(0.5, 0, 0))
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            tags.set([Pose2d(0, 0.25, 0), Pose2d(0, -0.5, 1)])
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        assert hal_data["pwm"][1]["value"] == 0.5

    def test_failing(control, hal_data, robot):
        control.set_operator_control()

        def on_step(tm):
            hal_data["joysticks"][0]["buttons"][3] = tm > 0.5
            hal_data["joysticks"][0]["buttons"][2] = tm > 0.7
            return tm < 1

        control.run_test(on_step)

    def test_drive(control, hal_data, robot):
        hal_data["joysticks"][0]["axes"][1] = 0.5
        control.set_operator_control()
        control.run_test(lambda tm: tm < 1)
    """

# Season 2027 has no choosers; other tests have its opmodes and tunables.
CHOOSING = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(0)
            self.switch = wpilib.DigitalInput(4)
            self.chooser = wpilib.SendableChooser()
            self.chooser.setDefaultOption("Left", 0.25)
            self.chooser.addOption("Right", 0.75)
            wpilib.SmartDashboard.putData("Auto", self.chooser)
            self.seen = []

        def robotPeriodic(self):
            self.seen.append((
                wpilib.DriverStation.isEnabled(), wpilib.DriverStation.isAutonomous(),
                wpilib.DriverStation.getStickAxisCount(0), round(wpilib.DriverStation.getMatchTime(), 2),
                self.switch.get(), wpilib.SmartDashboard.getNumber("gain", 0),
            ))

        def autonomousPeriodic(self):
            self.motor.set(self.chooser.getSelected())

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())
    """


def text(*lines: object, header: object = HEADER) -> str:
    return "".join(json.dumps(line) + "\n" for line in (header, *lines))


# -- recordings ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", sample_robots())
def test_a_recordings_replay_does_the_same(name: str, make_project) -> None:
    """For each sample robot, the one of its own tests with the most inputs, but not a whole match."""
    project = make_project({})
    project.copy(ROBOTS / name)
    result = project.run("test", "--record", "recordings", "--", "--ignore=tests/pyfrc_test.py", "-k", "not match")
    assert result.code == 0, result.output
    scripts = [file for file in (project.path / "recordings").iterdir() if ".trace." not in file.name]
    replayed = project.run("replay", max(scripts, key=lambda file: file.stat().st_size))
    assert replayed.code == 0, replayed.output
    assert "The trace equals the recorded one." in replayed.stdout


@pytest.fixture(scope="module")
def recorded(make_shared_project: MakeProject) -> RobotProject:
    """A project whose tests were recorded, which tests do not change."""
    files = {"robot.py": ROBOT, "tests/test_it.py": TESTS, "pyproject.toml": "[tool.pyfrc.match]\nteleop = 4\n"}
    project = make_shared_project(files)
    result = project.run("test", "--record", "recordings")
    assert "1 failed, 3 passed" in result.stdout, result.output
    return project


def script_of(test: str) -> Path:
    return Path("recordings", f"tests_test_it.py.{test}.jsonl")


def steps_of(project: RobotProject, test: str) -> list[dict[str, object]]:
    return [dict(step.writes) for step in load_script(project.path / script_of(test)).steps]


def assert_replayed(project: RobotProject, test: str) -> None:
    replayed = project.run("replay", script_of(test))
    assert "The trace equals the recorded one." in replayed.stdout, replayed.output


def test_a_matchs_time_is_one_countdown(recorded: RobotProject) -> None:
    assert steps_of(recorded, "test_practice") == [
        {"time.remaining": 0.0},
        {"mode": "autonomous", "match_time": 15.0},
        {"mode": "disabled"},
        {"mode": "teleop", "match_time": 4.0},
    ]
    assert_replayed(recorded, "test_practice")


def test_structs_that_a_test_publishes_are_recorded(recorded: RobotProject) -> None:
    """Such as the pose from a camera; what the robot publishes itself is not an input."""
    steps = steps_of(recorded, "test_camera")
    written = {target: value for step in steps for target, value in step.items() if target.startswith("nt:")}
    assert written == {
        "nt:struct:Pose2d:/camera/pose": [0.5, 0, 0],
        "nt:struct:Pose2d[]:/camera/tags": [0, 0.25, 0, 0, -0.5, 1],
    }
    assert_replayed(recorded, "test_camera")


def test_a_failure_comes_back(recorded: RobotProject) -> None:
    replayed = recorded.run("replay", script_of("test_failing"))
    assert replayed.code == 1
    assert "replayed 0.72 s" in replayed.stdout
    assert f"then {recorded.place('robot.py', 'raise RuntimeError')}: RuntimeError: both at once" in replayed.stdout
    assert "equals" in replayed.stdout
    assert recorded.run("replay", script_of("test_failing"), "--until", "0.7").code == 0


def test_where_a_changed_robot_first_differs_is_told(recorded: RobotProject, make_project: MakeProject) -> None:
    project = make_project({})
    project.copy(recorded.path)
    project.write({"robot.py": ROBOT.replace("self.stick.getY()", "self.stick.getY() / 2")})
    script = project.path / script_of("test_drive")
    replayed = project.run("replay", script, "--trace", "now.jsonl")
    assert replayed.code == 1
    assert "first at 0.02 s:" in replayed.stdout
    assert "pwm[0].value was 0.5, is 0.25" in replayed.stdout, "what code sets comes before its consequences"
    assert trace_hash(project.path / "now.jsonl") != load_script(script).trace

    script.with_name(f"{script.stem}.trace.jsonl").unlink()
    replayed = project.run("replay", script)
    assert replayed.code == 1
    assert "The trace differs from the recorded one." in replayed.stdout


TODAYS_WAYS = """
    import ntcore, wpilib
    from wpilib.simulation import DIOSim, DriverStationSim, JoystickSim, stepTiming

    def test_it(control, robot, hal_data):
        switch = DIOSim(4)
        ntcore.NetworkTableInstance.getDefault().getTable("SmartDashboard").putNumber("gain", 1)
        with control.run_robot():
            control.step_timing(seconds=0.51, autonomous=True, enabled=True)
            wpilib.SmartDashboard.putString("Auto/selected", "Right")
            switch.setValue(False)
            control.step_timing(seconds=0.033, autonomous=True, enabled=True)
            stick = JoystickSim(0)
            stick.setAxisCount(0)
            stick.setButtonCount(0)
            stick.setPOVCount(0)
            DriverStationSim.notifyNewData()
            stepTiming(0.1)
            hal_data["joysticks"][0]["axes"][1] = -0.3
            DriverStationSim.setMatchTime(33)
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
            switch.setValue(True)
            hal_data["event"]["game_specific_message"] = "LRL"
            hal_data["control"]["eStop"] = True
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
    """


SCRIPT = text(
    {"t": 0, "set": {"mode": "disabled autonomous", "nt:/SmartDashboard/gain": 3}},
    {"t": 0.1, "set": {"mode": "autonomous", "match_time": 15, "nt:/SmartDashboard/Auto/selected": "Right"}},
    {"t": 0.3, "set": {"mode": "teleop", "joysticks[0].axes[1]": -0.5}},
    {"t": 0.5, "set": {"joysticks[0].plugged": False, "dio[4].value": False}},
    {"t": 0.7, "set": {"joysticks[0].plugged": True}},
)
PLAYED = """
    def test_script(control, robot, robot_path, hal_data):
        control.replay(robot_path + "/script.jsonl")
        seen = dict(zip([round(0.02 * (n + 1), 2) for n in range(len(robot.seen))], robot.seen))
        assert seen[0.08] == (False, True, 12, -1.0, True, 3)
        assert seen[0.1] == (True, True, 12, 15.0, True, 3)
        assert seen[0.28] == (True, True, 12, 14.82, True, 3)
        assert seen[0.48][:3] == (True, False, 12)
        assert seen[0.5][2:] == (0, 14.6, False, 3)
        assert seen[0.7][2] == 12
        assert len(seen) == 49
        assert hal_data["pwm"][0]["value"] == 0  # plugged in again, nothing is pushed
    """


@pytest.mark.season_2026
def test_all_that_comes_from_outside_is_recorded_and_can_be_in_a_script(make_project: MakeProject) -> None:
    tests = {"tests/test_it.py": TODAYS_WAYS, "tests/test_script.py": PLAYED}
    project = make_project({"robot.py": CHOOSING, "script.jsonl": SCRIPT, **tests})
    result = project.run("test", "--record", "recordings")
    assert result.code == 0, result.output
    assert_replayed(project, "test_it")
    steps = steps_of(project, "test_it")
    assert {target for step in steps for target in step} >= {
        "mode",
        "nt:/SmartDashboard/gain",
        "nt:/SmartDashboard/Auto/selected",
        "dio[4].value",
        "joysticks[0].plugged",
        "packet",
        "joysticks[0].axes[1]",
        "time.remaining",
        "event.game_specific_message",
        "control.eStop",
    }
    assert -0.3 in [step.get("joysticks[0].axes[1]") for step in steps]


def test_where_nothing_can_be_written_is_told_once(make_project: MakeProject) -> None:
    project = make_project({"robot.py": "raise Exception('this has run')\n", "file": ""})
    said = f"{Path('file/within')} cannot be written: file is a file"
    for option in ("--record", "--trace"):
        result = project.run_here("test", "--builtin", option, "file/within")
        assert (result.code, result.first_error) == (2, f"{option} {said}")
        assert "this has run" not in result.output


# -- scripts written by hand ---------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_script_may_be_longer_than_a_test_without_it(make_project) -> None:
    long = text({"t": 0, "set": {"mode": "disabled"}}, header=HEADER | {"end": 601})
    robot = "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
    project = make_project({"robot.py": robot, "script.jsonl": long})
    result = project.run("replay", "script.jsonl")
    assert result.code == 0, result.output
    assert "replayed 601.00 s" in result.stdout


def test_a_bad_script_is_named_as_it_is_opened(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "scripts/bad.jsonl": "hello\n"})
    result = project.run_here("replay", "scripts/bad.jsonl")
    assert result.code == 2, result.output
    assert result.first_error.startswith("scripts/bad.jsonl:1: not valid JSON")
    assert "Traceback" not in result.output


@given(st.lists(st.text(max_size=40) | st.just(json.dumps(HEADER)), max_size=4))
def test_whatever_it_is_it_is_a_script_or_says_what_is_wrong(lines: list[str]) -> None:
    with suppress(ScriptError):
        parse_script(f"{line}\n" for line in lines)


# -- robots that end their process ----------------------------------------------------------------------------------

EXITING = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def autonomousInit(self):
            {}
    """


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("exit()", "exit() was called"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    ],
)
def test_a_robot_that_exits_has_failed(code: str, message: str, make_project) -> None:
    script = text({"t": 0, "set": {"mode": "autonomous"}})
    project = make_project({"robot.py": EXITING.format(code), "script.jsonl": script})
    result = project.run("replay", "script.jsonl")
    assert result.code == 1, result.output
    assert f"then {project.place('robot.py', code)}: {message}" in result.stdout.splitlines()


def test_a_robot_with_a_loop_of_its_own_may_not_exit_either(make_project) -> None:
    robot = """
        import wpilib

        class MyRobot(wpilib.RobotBase):
            def startCompetition(self):
                wpilib.wait(0.1)
                exit()
    """
    project = make_project({"robot.py": robot, "script.jsonl": text()})
    result = project.run("replay", "script.jsonl")
    assert result.code == 1
    assert f"{project.place('robot.py', 'exit()')}: exit() was called" in result.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_ctrl_c_ends_a_replay(make_project) -> None:
    robot = EXITING.format("print('here', flush=True)\n            while True: pass")
    project = make_project({"robot.py": robot, "script.jsonl": text({"t": 0, "set": {"mode": "autonomous"}})})
    with project.start("replay", "script.jsonl", apart=True) as command:
        while command.stdout.readline() != "here\n":
            assert command.poll() is None
        command.send_signal(signal.SIGINT)
        _, said = command.rest()
        assert (command.wait(), said.splitlines()[-1:]) == (130, ["interrupted"]), said


values = st.booleans() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=9) | st.integers(-9, 9)
times = st.lists(st.integers(0, 10**9), max_size=9).map(sorted)


@given(times, st.dictionaries(st.text(max_size=20), values), st.integers(0, 10**9), st.text(max_size=9))
def test_a_script_written_and_read_is_the_same(at: list[int], writes: dict, end: int, robot: str) -> None:
    end = max([end, *at])
    script = InputScript(tuple(Step(each, writes) for each in at), end, min(end, 5), robot, 7, {"pyfrc": "1"}, "ab")
    assert parse_script(script.lines()) == script
