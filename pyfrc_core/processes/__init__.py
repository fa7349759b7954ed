"""Child processes: how they start, what they send, how they end, and what is known when they crash.

In: a function to run in a process of its own. Out: the objects that it sends, in their order, then its exit; if it has
crashed, one sentence with the user's line (`crash_report`). Tests, matches of fuzz and simulated robots run this way.
Imports nothing of what runs in them: no WPILib, no pytest.

Which child is used for what:

- a fork (`fork`): each test and match, where forks are safe and the robot's import has made no thread or device. It has
  everything imported, so it takes milliseconds. It sends frames through a pipe.
- an interpreter that is used again (`interpreter`, `reuse`): the same on Windows, on macOS, and after such an import.
  Also one call of a function that must not change this process, as for `deploy` and `doctor` (`call`); and matches in a
  Dask worker, which has threads. It gets frames on its standard input. What it sends is in files, since Windows can
  wait for no pipe together with others, and a file stays when its process crashes.
- the simulator's host (`sim.engine.host`), which forks robots, or becomes one. Only here, both sides speak at any time:
  over a socket (`channel`), as a robot that hangs reads nothing.

Not used: `multiprocessing`, whose processes leave no crash report; and a fork that waits, made before the robot is
imported: it did what `reuse` does, a second time, and only on Linux.

- `worker` hides the difference: messages first, then the exit. A message that a crash has cut off is left out.
- A crash log is a file that outlives its process, so that a signal in C code still leads to the user's line.
- No process outlives its owner (`owner`). What a fork finds of its parent, such as objects of WPILib, it leaves alone:
  their locks belong to threads that it does not have.
"""
