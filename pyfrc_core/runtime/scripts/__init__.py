"""Input scripts: the inputs of a robot, packet by packet, as lines that a person can read and diff."""
