"""Each test that uses the robot in a process of its own.

`loop` replaces pytest's loop over the tests; `processes` are what it starts; `messages` is what they tell; `spare` and
`spawned` are the two answers to a robot that cannot be forked.
"""
