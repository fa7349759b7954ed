"""Child processes: how they start, what they send, how they end, and what is known when they crash.

In: a function to run in a process of its own. Out: the objects that it sends, in their order, then its exit; if it has
crashed, one sentence with the user's line (`crash_report`). Tests, matches of fuzz and simulated robots run this way.
Imports nothing of what runs in them: no WPILib, no pytest.

- Three ways to start: a fork where everything is imported (`fork`), a new interpreter (`spawn`), and a fork made before
  an import that may make forks impossible (`prefork`). Fork is Linux's alone: on macOS it is not safe, and Windows
  lacks it.
- `worker` hides the difference: messages first, then the exit. A message that a crash has cut off is left out.
- A crash log is a file that outlives its process, so that a signal in C code still leads to the user's line.
- No process outlives its owner (`owner`). What a fork finds of its parent, such as objects of WPILib, it leaves alone:
  their locks belong to threads that it does not have.
"""
