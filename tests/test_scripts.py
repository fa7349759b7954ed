"""Input scripts: a recording's replay does what was recorded, and a script that is wrong says so with its line."""

from __future__ import annotations

import json
import signal
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from conftest import sample_robots, trace_hash
from hypothesis import given
from hypothesis import strategies as st

from pyfrc_core.runtime.scripts.script import FORMAT, InputScript, ScriptError, Step, load_script, parse_script

ROBOTS = Path(__file__).parent / "robots"
HEADER = {"format": FORMAT, "end": 1.0}

ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.stick = wpilib.Joystick(0)
            self.motor = wpilib.PWMSparkMax(0)
            self.switch = wpilib.DigitalInput(4)

        def teleopPeriodic(self):
            self.motor.set(self.stick.getY())
            if self.stick.getRawButton(3) and self.stick.getRawButton(2):
                raise RuntimeError("both at once")
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


@pytest.mark.parametrize("name", sample_robots("command"))
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


def test_a_matchs_time_is_one_countdown(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": "[tool.pyfrc.match]\nteleop = 4\n"})
    assert project.run("test", "--builtin", "--record", "recordings", "--", "-k", "practice").code == 0
    (script,) = (file for file in (project.path / "recordings").iterdir() if ".trace." not in file.name)
    assert [dict(step.writes) for step in load_script(script).steps] == [
        {"time.remaining": 0.0},
        {"mode": "autonomous", "match_time": 15.0},
        {"mode": "disabled"},
        {"mode": "teleop", "match_time": 4.0},
    ]
    replayed = project.run("replay", script)
    assert "The trace equals the recorded one." in replayed.stdout, replayed.output


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


@pytest.mark.season_2026
def test_whatever_a_test_does_is_recorded(make_project) -> None:
    project = make_project({"robot.py": CHOOSING, "tests/test_it.py": TODAYS_WAYS})
    assert project.run("test", "--record", "recordings").code == 0
    script = project.path / "recordings" / "tests_test_it.py.test_it.jsonl"
    replayed = project.run("replay", script)
    assert replayed.code == 0, replayed.output
    assert "equals" in replayed.stdout
    written = {target for line in script.read_text().splitlines()[1:] for target in json.loads(line)["set"]}
    assert written >= {
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
    assert (
        '"joysticks[0].axes[1]": -0.3,' in script.read_text() or '"joysticks[0].axes[1]": -0.3}' in script.read_text()
    )


def test_structs_that_a_test_publishes_are_recorded(make_project) -> None:
    """Such as the pose from a camera; what the robot publishes itself is not an input."""
    robot = """
        import ntcore
        import wpilib
        from wpimath.geometry import Pose2d

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                table = ntcore.NetworkTableInstance.getDefault().getTable("camera")
                self.pose = table.getStructTopic("pose", Pose2d).subscribe(Pose2d())
                self.tags = table.getStructArrayTopic("tags", Pose2d).subscribe([])
                self.own = table.getStructTopic("own", Pose2d).publish()
                self.motors = [wpilib.PWMSparkMax(port) for port in range(2)]

            def teleopPeriodic(self):
                self.motors[0].set(self.pose.get().x)
                self.motors[1].set(sum(tag.y for tag in self.tags.get()))
                self.own.set(self.pose.get())
        """
    test = """
        import ntcore
        from wpimath.geometry import Pose2d

        def test_it(control, hal_data):
            table = ntcore.NetworkTableInstance.getDefault().getTable("camera")
            pose = table.getStructTopic("pose", Pose2d).publish()
            tags = table.getStructArrayTopic("tags", Pose2d).publish()
            table.getRawTopic("image").publish("raw").set(b"12345678")
            with control.run_robot():
                pose.set(Pose2d(0.5, 0, 0))
                control.step_timing(seconds=0.1, autonomous=False, enabled=True)
                tags.set([Pose2d(0, 0.25, 0), Pose2d(0, -0.5, 1)])
                control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert hal_data["pwm"][0]["value"] == 0.5
        """
    project = make_project({"robot.py": robot, "tests/test_it.py": test})
    recorded = project.run("test", "--record", "recordings")
    assert recorded.code == 0, recorded.output
    script = project.path / "recordings" / "tests_test_it.py.test_it.jsonl"
    steps = [json.loads(line)["set"] for line in script.read_text().splitlines()[1:]]
    written = {target: value for step in steps for target, value in step.items() if target.startswith("nt:")}
    assert written == {
        "nt:struct:Pose2d:/camera/pose": [0.5, 0, 0],
        "nt:struct:Pose2d[]:/camera/tags": [0, 0.25, 0, 0, -0.5, 1],
    }
    replayed = project.run("replay", script)
    assert "The trace equals the recorded one." in replayed.stdout, replayed.output


@pytest.mark.parametrize("option", ["--record", "--trace"])
def test_where_nothing_can_be_written_is_told_once(option: str, make_project) -> None:
    project = make_project({"robot.py": "import wpilib\n\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n", "file": ""})
    result = project.run("test", "--builtin", option, "file/within")
    assert (result.code, result.first_error) == (2, f"{option} {Path('file/within')} cannot be written: file is a file")
    assert "test_practice" not in result.output


FAILING = """
    def test_it(control, hal_data, robot):
        control.set_operator_control()

        def on_step(tm):
            hal_data["joysticks"][0]["buttons"][3] = tm > 0.5
            hal_data["joysticks"][0]["buttons"][2] = tm > 0.7
            return tm < 1

        control.run_test(on_step)
    """


def test_a_failure_comes_back(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": FAILING})
    assert project.run("test", "--record", "recordings").code == 1
    script = project.path / "recordings" / "tests_test_it.py.test_it.jsonl"
    replayed = project.run("replay", script)
    assert replayed.code == 1
    assert "replayed 0.72 s" in replayed.stdout
    assert f"then {project.place('robot.py', 'raise RuntimeError')}: RuntimeError: both at once" in replayed.stdout
    assert "equals" in replayed.stdout
    assert project.run("replay", script, "--until", "0.7").code == 0


def test_where_a_changed_robot_first_differs_is_told(make_project) -> None:
    test = """
        def test_it(control, hal_data, robot):
            hal_data["joysticks"][0]["axes"][1] = 0.5
            control.set_operator_control()
            control.run_test(lambda tm: tm < 1)
        """
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": test})
    assert project.run("test", "--record", "recordings").code == 0
    project.write({"robot.py": ROBOT.replace("self.stick.getY()", "self.stick.getY() / 2")})
    script = project.path / "recordings" / "tests_test_it.py.test_it.jsonl"
    replayed = project.run("replay", script, "--trace", "now.jsonl")
    assert replayed.code == 1
    assert "first at 0.02 s:" in replayed.stdout
    assert "pwm[0].value was 0.5, is 0.25" in replayed.stdout, "what code sets comes before its consequences"
    digest = trace_hash(project.path / "now.jsonl")
    assert digest != load_script(script).trace

    script.with_name("tests_test_it.py.test_it.trace.jsonl").unlink()
    replayed = project.run("replay", script)
    assert replayed.code == 1
    assert "The trace differs from the recorded one." in replayed.stdout


# -- scripts written by hand ---------------------------------------------------------------------------------------


@pytest.mark.season_2026
def test_a_script_can_say_all_that_comes_from_outside(make_project) -> None:
    script = text(
        {"t": 0, "set": {"mode": "disabled autonomous", "nt:/SmartDashboard/gain": 3}},
        {"t": 0.1, "set": {"mode": "autonomous", "match_time": 15, "nt:/SmartDashboard/Auto/selected": "Right"}},
        {"t": 0.3, "set": {"mode": "teleop", "joysticks[0].axes[1]": -0.5}},
        {"t": 0.5, "set": {"joysticks[0].plugged": False, "dio[4].value": False}},
        {"t": 0.7, "set": {"joysticks[0].plugged": True}},
    )
    project = make_project(
        {
            "robot.py": CHOOSING,
            "script.jsonl": script,
            "tests/test_it.py": """
                def test_it(control, robot, robot_path, hal_data):
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
                """,
        }
    )
    result = project.run("test")
    assert result.code == 0, result.output


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
    import sys
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def autonomousInit(self):
            {}
    """


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("exit()", "exit() was called"),
        pytest.param("sys.exit(5)", "exit(5) was called", marks=pytest.mark.slow),
        pytest.param("sys.exit('enough')", "SystemExit: enough", marks=pytest.mark.slow),
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
