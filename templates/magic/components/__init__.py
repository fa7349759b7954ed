"""The parts of the robot. What a component needs, it names; magicbot hands it over."""
