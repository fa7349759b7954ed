"""One run of a robot program, in robot time.

In: a project's robot class, and whatever changes its inputs. Out: the robot's code has run; its failure, with the
user's line; a trace. Tests, fuzz, replay and the simulator all run robots through `robot.RobotRun`: none has a loop of
its own.

Time. `clock.Clock` is a number of microseconds and a queue of actions. Nothing waits for it: a caller lets time pass,
and all that is due is called on the caller's thread, in one order. This makes a run repeatable, and as fast as the
computer. The clock steps HAL time. A `TimedRobot` runs in place: the clock calls WPILib's loop function
(`time.timed_loop`). Other robots have a thread of their own. Callers see no difference.

Everything that waits. `patches` has one table of names that are replaced before the robot's modules are imported:
functions of `time` and `threading`, WPILib's waits, notifiers and watchdogs. While no robot runs, each does what the
original does. For Python's functions the calling file decides, not the thread: robot code, tests and pytest share the
main thread, and tests and libraries keep real time. A robot's threads are real threads that take turns (`threads`), so
that a run with threads repeats as well. WPILib's own C++ threads, for motor safety and watchdogs, follow the wall
clock: they are taken out, and their work is done in robot time (`time.motor_safety`, `patches.loop_watchdog`).

Like the robot. A run boots without a driver station; packets come only while one is attached (`connection`). A periodic
function that waits for too long has stopped the robot, and is a failure (`checks.loop_limit`).

Repeatable. Random generators are seeded (`seeds`), and a trace has one hash over all that happened
(`scripts.trace`). What a library simulates in real time, or with noise by chance (`patches.noise`), does not repeat: it
is marked. Robot time waits for what is simulated in real time where the robot depends on it (`real_time_pace`).

The end. `exceptions.TestEnded` is raised wherever code waits, until none waits. Code that catches it gains nothing:
each further wait raises it at once. The first failure is stored, so that no `except` hides it. `checks.hang_detector`
finds code that makes no progress; the time in which a busy computer did not let it run does not count.
"""
