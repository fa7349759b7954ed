#!/bin/bash
# As the image's, but it waits as long as there is a file "hold" in lvuser's home.
while [ -e /home/lvuser/hold ]; do sleep 0.02; done
stop=
start=
for option in "$@"; do
    case "$option" in
        -t) stop=stop ;;
        -r) start=start ;;
    esac
done
echo $stop $start > /run/robot-program
