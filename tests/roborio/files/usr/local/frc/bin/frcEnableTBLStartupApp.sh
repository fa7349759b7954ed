#!/bin/sh
# A stand-in: the robot program is the startup application here anyway.
