"""Physics: turns what the robot's motors do into what its sensors see, in tests as in the simulator."""
