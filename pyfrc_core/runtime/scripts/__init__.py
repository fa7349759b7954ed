"""Input scripts: the inputs of a robot, packet by packet, as lines that a person can read and diff.

In: what tests, people, dashboards and the field write. Out: a file of JSON lines that does the same again (`recorder`
writes it, `player` plays it), and the trace of what the robot did with it (`trace`). Fuzzing generates scripts and
makes them shorter, the simulator records and replays them, so a failure that fuzz has found is a file that reproduces
it.

The recorder needs no list of inputs: it takes whatever has changed between the end of the robot's turn and the end of
the external writes. What a test writes between two packets is recorded one microsecond after what was due before, so
that a replay writes it in the same order. Then a trace of the replay has the same hash.
"""
