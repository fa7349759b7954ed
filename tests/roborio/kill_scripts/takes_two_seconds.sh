#!/bin/bash
# Stops the robot program (-t) and starts it again (-r), with the pauses that a roboRIO's script makes.
stop=
start=
for option in "$@"; do
    case "$option" in
        -t) stop=stop ;;
        -r) start=start ;;
    esac
done
if [ -n "$stop" ]; then
    echo stop > /run/robot-program
    sleep 1
fi
if [ -n "$start" ]; then
    sleep 1
    echo start > /run/robot-program
fi
