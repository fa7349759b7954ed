#!/bin/sh
# Starts the robot program, by the supervisor (inside.py, outside of the look-alike).
echo start > /run/robot-program
