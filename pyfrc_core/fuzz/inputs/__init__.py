"""What is varied: the inputs of a match, packet by packet.

In: the robot's run, which is only read, one generator of random numbers, and what the robot's code asks for. Out: the
writes of each packet, by target, as people, gamepads, sensors, dashboards and the field make them. `input_generator`
is the whole; `match_plan` draws the modes and the field's messages, and a generator each the rest.

What this robot cannot notice is not varied: `finders` looks at the devices that exist, `asked_controls` and
`network_reads` intercept what its code reads, and `robot_constants` has the numbers at which its decisions change.
"""
