"""Measure the robot's code: which lines ran (`coverage`), and how long its functions took (`profile`).

In: any command that runs a robot. Out: a report. The rooms below do not know this one: it patches what it needs, and
only while it measures.

- Each process measures itself, and writes a file when it ends (`processes`): robots run in forks and new interpreters.
- Functions are timed where WPILib and command libraries call them (`user_functions`). A trace function would run for
  every line, and the robot would be another one.
- Times are processor time, with each wait replaced by its robot time: a busy computer changes neither. Overruns are
  found by wall time, since code that waits for a file uses no processor time.
- Where the time goes within a function is cProfile's work (`-o`).
"""
