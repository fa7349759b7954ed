"""Threads of robot code, in robot time: they are real threads that take turns, so that a run with threads repeats.

In: what robot code starts, locks and waits for. Out: one thread runs at a time, in an order that depends on robot time
alone (`robot_threads`). Which thread belongs to the robot, and which line of code it stands in, is asked of
`cooperative`; `locks` and `event_loops` are the waits of Python's library.
"""
