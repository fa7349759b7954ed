"""A robot on the network, as a source of the page: what it publishes, while it drives.

In: its NetworkTables, by a client of `wpi`, and its console. Out: the runs, changes and states that front ends read of
any source. `runs` puts what arrives on one timeline, and knows no network; `robot` has the thread and the connections.

- Nothing here enables a robot, or writes to it without being asked: a page that may drive has a switch, off at first.
- A lost connection is a mode of its own on the timeline, `NO_CONNECTION`: between its ends, nothing is known.
- A robot program that was started again begins another run, as in a simulation; the one before is kept as a branch.
"""
