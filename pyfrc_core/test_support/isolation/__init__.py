"""Each test that uses the robot in a process of its own.

`loop` replaces pytest's loop over the tests; `processes` are what it starts; `messages` is what they send; `spawned` is
for tests of what cannot be forked.
"""
