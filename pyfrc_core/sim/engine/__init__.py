"""The engine of a simulation: the session, its recording and what it shows. Knows no front end.

In: commands. Out: snapshots, changes, output (`simulation`). There are three processes. The front end's never imports
robot code or WPILib. It starts a `host`, an interpreter with WPILib and without threads of it, which forks a robot's
process for each run; where that is not safe, the host becomes that process. `robot_side` runs there. Closing never
waits for robot code: a process that does not end when it is asked to is ended.

- What the robot did is the lines of its trace. `changes` gives each reader all of them by a cursor; the recording keeps
  them.
- Going back in time is a new run that replays the recorded inputs up to that moment, so it needs no copy of a robot's
  state. The same with changed code is `--watch`. What was held then is released (`left_behind`).
- Messages, output and exit of a robot's process come in one order (`processes.channel`): the last print before a crash
  is not lost.
"""
