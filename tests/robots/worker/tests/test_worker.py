"""Threads that sleep in robot time: what they did is a matter of counting, not of luck."""

import itertools

import pytest


def test_threads_keep_robot_time(control, robot):
    """In ten seconds: 100 samples, 200 heartbeats, 500 loops."""
    seen = {}

    def on_step(tm):
        # 40 ms after a full second nothing is due: the threads did all that they had to.
        with robot.lock:
            seen[round(tm, 2)] = (len(robot.received), robot.beats, robot.main_loops)
        return tm < 12

    control.run_test(on_step)

    assert seen[1.04][:2] == (10, 20)
    differences = [late - early for early, late in zip(seen[1.04], seen[11.04], strict=True)]
    assert differences == [100, 200, 500]


def test_samples_carry_the_time_they_were_taken(control, robot):
    """The sampler wakes up every 0.1 s exactly: what it does in between takes no robot time."""
    control.set_autonomous(enabled=True)
    control.run_test(lambda tm: tm < 3)

    times = [taken for taken, _ in robot.received]
    assert times[:25] == pytest.approx([0.1 * number for number in range(1, 26)], abs=1e-5)


def test_heartbeat_sees_the_main_loop_go_on(control, robot):
    """Between two beats, 50 ms apart, there are two or three loops of 20 ms."""
    control.run_test(lambda tm: tm < 5.04)

    loops = robot.loops_at_beat[:100]
    assert len(loops) == 100
    # Every second beat falls on a loop, and may come just before or just after it.
    assert {late - early for early, late in itertools.pairwise(loops)} <= {1, 2, 3, 4}
    assert loops[99] - loops[19] == pytest.approx(200, abs=1)


def test_threads_end_with_the_robot(control, robot):
    """Today's style: the threads run inside the block, and are told to end with it."""
    with control.run_robot():
        control.step_timing(seconds=1.04, autonomous=False, enabled=True)
        assert robot.sampler.is_alive()
        assert robot.heartbeat.is_alive()
        beats = robot.beats
        seconds = control.step_timing(seconds=1.0, autonomous=False, enabled=True)
        assert robot.beats - beats == round(seconds * 20)

    assert robot.stopping.is_set()
