"""Robot time, as tests and robot code see it: one clock for packets, loops, threads, notifiers and whatever waits.

Each project here is run once; its tests are the assertions.
"""

from __future__ import annotations

import pytest
from conftest import sampled

from pyfrc_core.processes.fork import FORK_IS_SAFE

ROBOT = """
    import concurrent.futures, queue, threading, time
    import hal, wpilib

    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.log = [("made", self.now())]
            self.each_loop = lambda: None
            self.addPeriodic(lambda: self.fast.append(self.now()), 0.005, 0.002)
            self.fast = []

        def now(self):
            return round(wpilib.Timer.getFPGATimestamp(), 6)

        def robotPeriodic(self):
            self.each_loop()
"""


def passes(make_project, tests: str, robot: str = ROBOT, **files: str) -> None:
    project = make_project({"robot.py": robot, "tests/test_it.py": tests, **files})
    result = project.run("test", "--", "-q")
    assert result.code == 0, result.output


def test_fake_time_the_rates_of_loops_and_waits_in_them(make_project) -> None:
    passes(
        make_project,
        """
        import pytest

        def test_starts_at_zero_and_moves_when_told(fake_time):
            assert fake_time.get() == 0
            fake_time.increment_time_by(1.5)
            assert fake_time.get() == 1.5

        def test_time_cannot_go_back(fake_time, control, robot):
            with pytest.raises(ValueError, match="not negative"):
                fake_time.increment_time_by(-1)
            assert fake_time.get() == 0
            with control.run_robot():
                with pytest.raises(RuntimeError, match="running"):
                    fake_time.reset()

        def test_moves_the_robot(fake_time, control, robot):
            with control.run_robot():
                fake_time.increment_time_by(1)
                assert len(robot.fast) == 199

        def test_offsets(control, robot):
            loops = []
            robot.each_loop = lambda: loops.append(robot.now())
            control.run_test(lambda tm: tm < 0.1)
            assert robot.log == [("made", 0.0)]
            assert loops == [0.02, 0.04, 0.06, 0.08]
            assert robot.fast[:4] == [0.007, 0.012, 0.017, 0.022]

        def test_added_later(control, robot):
            calls = []
            with control.run_robot():
                control.step_timing(seconds=0.05, autonomous=False, enabled=True)
                robot.addPeriodic(lambda: calls.append(robot.now()), 0.01)
                control.step_timing(seconds=0.03, autonomous=False, enabled=True)
            assert calls == [0.06, 0.07, 0.08]

        def test_wpilibs_own_stepping_moves_the_robot(control, robot):
            from wpilib.simulation import DriverStationSim, stepTiming
            loops = []
            robot.each_loop = lambda: loops.append(robot.isEnabled())
            with control.run_robot():
                DriverStationSim.setEnabled(True)
                DriverStationSim.notifyNewData()
                stepTiming(0.1)
            assert loops == [True] * 5

        def test_steps_are_called_while_the_robot_sleeps(control, robot):
            import robot as module
            steps = []
            woke = []
            def nap():
                if not woke:
                    module.time.sleep(0)
                    module.wpilib.wait(0.2)
                    woke.append(robot.now())
            robot.each_loop = nap
            def step(tm):
                steps.append(tm)
                return tm < 0.3
            control.run_test(step)
            assert woke == [0.22]
            assert steps == [pytest.approx(0.02 * n) for n in range(1, 16)]

        def test_an_assertion_meanwhile_is_not_for_the_robot_to_swallow(control, robot):
            def careless():
                try:
                    wait(1)
                except Exception:
                    robot.log.append("swallowed")
            from wpilib import wait
            robot.each_loop = careless
            def step(tm):
                assert tm < 0.5, "seen"
                return True
            with pytest.raises(AssertionError, match="seen"):
                control.run_test(step)
            assert "swallowed" not in robot.log
        """,
    )


@pytest.mark.season_2026  # 2027 has no robotInit, and counts in nanoseconds
def test_the_init_and_the_starts_of_loops(make_project) -> None:
    passes(
        make_project,
        """
        def test_it(control, robot):
            starts = []
            robot.each_loop = lambda: starts.append(robot.getLoopStartTime())
            control.run_test(lambda tm: tm < 0.06)
            assert starts == [20000, 40000]
            assert robot.init == 0.0
        """,
        ROBOT + "\n        def robotInit(self):\n            self.init = self.now()\n",
    )


def test_python_time_is_robot_time_in_robot_code_only(make_project) -> None:
    passes(
        make_project,
        """
        import time
        import helper

        def test_readings(control, robot):
            seen = []
            robot.each_loop = lambda: seen.append(helper.readings())
            before = time.monotonic()
            control.run_test(lambda tm: tm < 20)
            assert time.monotonic() - before < 10, "a test's own clock is the real one"
            first, last = seen[0], seen[-1]
            for name in first:
                assert abs(last[name] - first[name] - 19.96) < 1e-3, name
            assert first["monotonic"] == 0.02
            assert helper.Holder().clock() >= 0, "a function of time kept in a class is not bound"

        def test_sleep(control, robot, fake_time):
            slept = []
            def nap():
                if not slept:
                    slept.append(helper.nap(3600))
            robot.each_loop = nap
            fake_time.set_time_limit(1e7)
            control.run_test(lambda tm: not slept)
            assert slept == [3600.0]
        """,
        **{
            "helper.py": """
            import time
            from time import sleep

            class Holder:
                clock = time.monotonic

            def readings():
                return {
                    "time": time.time(), "time_ns": time.time_ns() / 1e9, "monotonic": time.monotonic(),
                    "monotonic_ns": time.monotonic_ns() / 1e9, "perf_counter": time.perf_counter(),
                    "perf_counter_ns": time.perf_counter_ns() / 1e9,
                }

            def nap(seconds):
                before = time.monotonic()
                sleep(seconds)
                return time.monotonic() - before
            """,
            "pyproject.toml": """
            [tool.pyfrc.test]
            loop_seconds = 3600
            """,
        },
    )


THREADS = """
    import concurrent.futures, queue, threading, time
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.log = []
            self.lock = threading.Lock()
            self.queue = queue.Queue()
            self.event = threading.Event()
            self.pool = concurrent.futures.ThreadPoolExecutor(2)
            for work in (self.holder, self.consumer, self.waiter):
                threading.Thread(target=work, daemon=True).start()
            threading.Timer(0.75, lambda: self.say("timer")).start()

        def say(self, what):
            self.log.append((what, round(time.monotonic(), 3)))

        def holder(self):
            time.sleep(0.1)
            with self.lock:
                time.sleep(0.2)
            self.say("released")

        def consumer(self):
            while True:
                try:
                    self.say(self.queue.get(timeout=0.5))
                except queue.Empty:
                    self.say("nothing came")

        def waiter(self):
            self.event.wait()
            self.say("event")
            helper = threading.Thread(target=time.sleep, args=(0.1,))
            helper.start()
            helper.join(0.04)
            self.say("still there" if helper.is_alive() else "gone")
            helper.join()
            self.say("gone" if not helper.is_alive() else "still there")

        def once(self, at, do):
            if round(wpilib.Timer.getFPGATimestamp(), 3) == at:
                do()

        def robotPeriodic(self):
            self.once(0.2, self.take)
            self.once(0.4, lambda: self.queue.put("message"))
            self.once(0.6, self.event.set)
            self.once(1.0, lambda: self.say(("pool", self.pool.submit(self.work, 0.25).result())))

        def take(self):
            with self.lock:
                self.say("loop has the lock")

        def work(self, seconds):
            time.sleep(seconds)
            return "worked"
"""


def test_threads_locks_queues_events_timers_and_pools_keep_robot_time(make_project) -> None:
    passes(
        make_project,
        """
        import threading

        def test_all_of_it(control, robot):
            control.run_test(lambda tm: tm < 1.4)
            assert sorted(robot.log[:2]) == [("loop has the lock", 0.3), ("released", 0.3)]
            assert robot.log[2:9] == [
                ("message", 0.4),
                ("event", 0.6),
                ("still there", 0.64),
                ("gone", 0.7),
                ("timer", 0.75),
                ("nothing came", 0.9),
                (("pool", "worked"), 1.25),
            ]
        """,
        THREADS,
    )


STEPPED_IN_BOTH_STYLES = """
    from wpilib.simulation import JoystickSim, PWMSim

    def test_documented(control, robot, hal_data):
        seen = []
        def step(tm):
            seen.append(hal_data["pwm"][0]["value"])
            hal_data["joysticks"][0]["axes"][1] = -1 if tm >= 0.5 else 0
            return tm < 1
        control.set_operator_control()
        control.run_test(step)
        assert seen == [0.0] * 25 + [1.0] * 25

    def test_today(control, robot):
        with control.run_robot():
            stick = JoystickSim(0)
            assert control.step_timing(seconds=0.5, autonomous=False, enabled=True) == 0.5
            assert PWMSim(0).getSpeed() == 0.0
            stick.setRawAxis(1, -1)
            control.step_timing(seconds=0.5, autonomous=False, enabled=True)
            assert PWMSim(0).getSpeed() == 1.0
            assert control.robot_is_alive
        assert not control.robot_is_alive
"""

DRIVES = """
        def robotInit(self):
            self.motor = wpilib.PWMSparkMax(0)
            self.stick = wpilib.Joystick(0)

        def teleopPeriodic(self):
            self.motor.set(-self.stick.getRawAxis(1))
"""

OWN_BODY = "its own, by wpilib's body"
LOOPS = {
    "wpilib's": f"""
    import wpilib

    class MyRobot(wpilib.TimedRobot):{DRIVES}
    """,
    "wpilib's, started by the robot": f"""
    import wpilib

    class MyRobot(wpilib.TimedRobot):{DRIVES}
        def startCompetition(self):
            super().startCompetition()
    """,
    "its own": f"""
    import wpilib

    class MyRobot(wpilib.RobotBase):{DRIVES}
        def startCompetition(self):
            self.robotInit()
            self.running = True
            while self.running:
                wpilib.wait(0.02)
                wpilib.DriverStation.refreshData()
                if self.isTeleopEnabled():
                    self.teleopPeriodic()

        def endCompetition(self):
            self.running = False
    """,
    OWN_BODY: f"""
    import wpilib

    class MyRobot(wpilib.IterativeRobotBase):{DRIVES}
        def __init__(self):
            super().__init__(0.02)

        def startCompetition(self):
            self.robotInit()
            while True:
                wpilib.wait(0.02)
                self._loopFunc()

        def endCompetition(self):
            pass
    """,
}


@pytest.mark.parametrize(
    "loop",
    [
        *sampled([loop for loop in LOOPS if loop != OWN_BODY], "wpilib's", "its own"),
        pytest.param(OWN_BODY, marks=[pytest.mark.season_2026, pytest.mark.slow]),
    ],
)
def test_whose_loop_it_is_shows_nowhere_outside(loop: str, make_project) -> None:
    passes(make_project, STEPPED_IN_BOTH_STYLES, LOOPS[loop])


@pytest.mark.season_2026  # season_2027/test_turns_of_robots.py has the same of 2027, beside WPILib's own loop
def test_slices_of_a_timeslice_robot_have_their_places_in_its_period(make_project) -> None:
    robot = """
        import pytest, wpilib

        class MyRobot(wpilib.TimesliceRobot):
            def __init__(self):
                super().__init__(0.002, controllerPeriod=0.01)
                wpilib.wait(0.015)
                self.log = []
                self.schedule(lambda: self.note("first"), 0.003)
                self.schedule(lambda: self.note("second"), 0.003)
                with pytest.raises(RuntimeError, match="exceeded controller period"):
                    self.schedule(lambda: self.note("third"), 0.003)

            def note(self, what):
                self.log.append((what, round(wpilib.Timer.getFPGATimestamp(), 6)))
    """
    test = """
        def test_slices(control, fake_time, robot):
            with control.run_robot():
                fake_time.increment_time_by(0.025)
            assert robot.log == [("first", 0.022), ("second", 0.025), ("first", 0.032), ("second", 0.035)]
    """
    passes(make_project, test, robot)


@pytest.mark.season_2026  # as above
def test_a_loop_by_the_driver_stations_event_has_a_turn_for_each_packet(make_project) -> None:
    robot = """
        import hal, wpilib
        from wpiutil import sync

        class MyRobot(wpilib.RobotBase):
            def startCompetition(self):
                self.log, self.event = [], sync.createEvent()
                hal.provideNewDataEventHandle(self.event)
                hal.observeUserProgramStarting()
                self.note(sync.waitForObject(self.event, 0.005))
                while sync.waitForObject(self.event):
                    self.note("packet")
                self.note("ends")

            def endCompetition(self):
                sync.destroyEvent(self.event)

            def note(self, what):
                self.log.append((what, round(wpilib.Timer.getFPGATimestamp(), 6)))
    """
    test = """
        def test_loop(control, fake_time, robot):
            with control.run_robot():
                fake_time.increment_time_by(0.05)
            assert robot.log == [((False, True), 0.005), ("packet", 0.02), ("packet", 0.04), ("ends", 0.05)]
    """
    passes(make_project, test, robot)


def test_practice_match_of_another_season(make_project) -> None:
    passes(
        make_project,
        """
        import wpilib

        def test_match(control, robot):
            seen = []
            def look():
                mode = control.get_mode()
                if not seen or seen[-1][0] != mode:
                    seen.append([mode, 0, wpilib.DriverStation.getMatchTime()])
                seen[-1][1] += 1
            robot.each_loop = look
            control.set_practice_match()
            control.run_test()
            assert [(mode, loops) for mode, loops, _ in seen] == [
                ("disabled", 49), ("autonomous", 1000), ("disabled", 25), ("teleop", 500)
            ]
            assert seen[1][2] == 20.0 and seen[3][2] == 10.0
        """,
        **{"pyproject.toml": "[tool.pyfrc.match]\nautonomous = 20\npause = 0.5\nteleop = 10\n"},
    )


def test_autonomous_runs_once_for_each_message_of_the_game(make_project) -> None:
    project = make_project(
        {
            "robot.py": ROBOT,
            "tests/pyfrc_test.py": "from pyfrc.tests import *\n",
            "sim/config.json": '{"pyfrc": {"game_specific_messages": ["LLL", "RRR"]}}',
        }
    )
    result = project.run("test", "--", "-v", "-k", "autonomous")
    assert result.code == 0
    assert [name.partition("::")[2] for name in result.outcomes()] == ["test_autonomous[LLL]", "test_autonomous[RRR]"]


def test_waits_that_python_computes_the_rest_of_end_on_time(make_project) -> None:
    """What is left of a time-out is computed in floating point; it must come to nothing at last."""
    passes(
        make_project,
        """
        def test_it(control, robot):
            control.run_test(lambda tm: tm < 2)
            assert robot.ends["queue"] == [round(0.1 * n, 6) for n in range(1, 20)]
            assert robot.ends["condition"] == [round(0.07 * n, 6) for n in range(1, 29)]
        """,
        """
        import queue, threading, time
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                self.ends = {}
                nothing = queue.Queue()
                condition = threading.Condition()

                def get():
                    try:
                        nothing.get(timeout=0.1)
                    except queue.Empty:
                        pass

                def wait_for():
                    with condition:
                        assert not condition.wait_for(lambda: False, 0.07)

                self.repeat("queue", get)
                self.repeat("condition", wait_for)

            def repeat(self, name, wait):
                ends = self.ends[name] = []

                def body():
                    while True:
                        wait()
                        ends.append(round(time.monotonic(), 6))

                threading.Thread(target=body, daemon=True).start()
        """,
    )


def test_what_the_robot_has_from_its_import_to_its_end(make_project) -> None:
    passes(
        make_project,
        """
        import pytest

        def test_its_end_is_called_once_and_what_it_leaves_can_be_waited_for(control, robot):
            with control.run_robot():
                control.step_timing(seconds=0.5, autonomous=False, enabled=True)
                assert robot.ended == 0
            assert robot.ended == 1
            robot.thread.join(5)
            assert not robot.thread.is_alive()
            assert robot.event.wait(1)
            assert robot.lock.acquire(timeout=1)
            robot.pool.shutdown()

        def test_a_filter_that_is_made_while_the_robot_is_imported_begins_with_the_run(control, robot):
            control.set_operator_control(enabled=True)
            control.run_test(lambda tm: tm < 0.1)
            assert robot.values == pytest.approx([0.06, 0.12, 0.18, 0.24])
        """,
        """
        import concurrent.futures, threading, time
        import wpilib
        from wpimath.filter import SlewRateLimiter

        class MyRobot(wpilib.TimedRobot):
            limiter = SlewRateLimiter(3.0)
            values = []
            ended = 0

            def robotInit(self):
                self.lock, self.event = threading.Lock(), threading.Event()
                self.event.set()
                self.thread = threading.Thread(target=lambda: time.sleep(1000))
                self.thread.start()
                self.pool = concurrent.futures.ThreadPoolExecutor(1)
                for _ in range(50):
                    self.pool.submit(time.sleep, 1)

            def teleopPeriodic(self):
                self.values.append(self.limiter.calculate(1.0))

            def endCompetition(self):
                self.ended += 1
        """,
    )


@pytest.mark.skipif(not FORK_IS_SAFE, reason="processes are not forked here")
@pytest.mark.parametrize(
    ("end", "status", "said"),
    [
        pytest.param("sys.exit(3)", 3, "", marks=pytest.mark.slow),
        ("raise ValueError('in the other')", 1, "ValueError: in the other"),
        ("return", 1, "a process that robot code has forked goes on as the robot"),
    ],
)
def test_a_forked_process_ends_where_it_leaves_the_robots_code(make_project, end: str, status: int, said: str) -> None:
    project = make_project(
        {
            "robot.py": f"""
            import os, sys
            import wpilib

            class MyRobot(wpilib.TimedRobot):
                def robotInit(self):
                    process = os.fork()
                    if process == 0:
                        {end}
                    self.status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
            """,
            "tests/test_it.py": f"""
            def test_it(control, robot):
                control.run_test(lambda tm: tm < 1)
                assert robot.status == {status}
            """,
        }
    )
    result = project.run("test", "--", "-s")
    assert result.code == 0, result.output
    assert said in result.output
    assert "pyfrc_core" not in result.output


def test_a_test_in_wpilibs_own_way_runs_the_robot(make_project) -> None:
    passes(
        make_project,
        """
        import threading
        from wpilib import simulation
        import robot

        def test_it():
            simulation.pauseTiming()
            simulation.DriverStationSim.resetData()
            robot_program = robot.MyRobot()
            thread = threading.Thread(target=robot_program.startCompetition, daemon=True)
            thread.start()
            simulation.waitForProgramStart()
            simulation.stepTiming(0.1)
            robot_program.endCompetition()
            thread.join(60)
            assert not thread.is_alive()
            assert robot_program.count in (4, 5)
        """,
        """
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            count = 0

            def robotPeriodic(self):
                self.count += 1
        """,
    )


def test_a_robot_that_ends_its_own_program_has_ended(make_project) -> None:
    passes(
        make_project,
        """
        def test_it(control, robot):
            with control.run_robot():
                control.step_timing(seconds=0.08, autonomous=False, enabled=True)
                assert control.robot_is_alive
                control.step_timing(seconds=0.2, autonomous=False, enabled=True, assert_alive=False)
                assert not control.robot_is_alive
                assert robot.count == 5
        """,
        """
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            count = 0

            def robotPeriodic(self):
                self.count += 1
                if self.count == 5:
                    self.endCompetition()
        """,
    )
