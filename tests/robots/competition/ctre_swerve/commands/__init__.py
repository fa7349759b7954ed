"""The commands, and the autonomous routines made of them."""
