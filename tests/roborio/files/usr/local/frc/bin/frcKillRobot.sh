#!/bin/bash
# Stops the robot program (-t), and starts it again (-r): says so to what looks after it.
stop=
start=
for option in "$@"; do
    case "$option" in
        -t) stop=stop ;;
        -r) start=start ;;
    esac
done
echo $stop $start > /run/robot-program
