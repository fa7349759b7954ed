"""Each test that uses the robot in a process of its own.

In: pytest's session. Out: the reports of its tests, in their order. WPILib's HAL, and robots that keep devices in
classes and modules, do not survive a second robot in one process.

`loop` replaces pytest's loop over the tests; `processes` are what it starts; `messages` is what they send; `spawned` is
for tests of what cannot be forked. What a test shares with others is set up before the fork, and torn down by the
process that has made it: so a fork runs pytest's protocol with the test's parent as the next item.
"""
