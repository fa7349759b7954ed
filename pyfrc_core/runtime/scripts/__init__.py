"""Input scripts: what a robot is told from outside, packet by packet, as lines that a person can read and diff."""
