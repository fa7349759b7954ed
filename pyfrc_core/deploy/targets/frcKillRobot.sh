#!/bin/bash
# pyfrc's frcKillRobot.sh: stops the robot program (-t), starts it again (-r).
#
# The script of the robot's image is kept as frcKillRobot.image.sh. It sometimes returns while the program still runs.
# This script calls it, waits for the program's end, and kills the program if necessary. To restore the image's script,
# as admin:
#   mv /usr/local/frc/bin/frcKillRobot.image.sh /usr/local/frc/bin/frcKillRobot.sh

image=/usr/local/frc/bin/frcKillRobot.image.sh
[ ! -r /etc/profile.d/frc-path.sh ] || . /etc/profile.d/frc-path.sh
[ ! -r /etc/profile.d/natinst-path.sh ] || . /etc/profile.d/natinst-path.sh

stop=
start=
while getopts tr option; do
    case "$option" in
        t) stop=yes ;;
        r) start=yes ;;
        *) exit 2 ;;
    esac
done

# Prints the process ids of robot programs in Python, Java and C++.
programs() {
    local directory words
    for directory in /proc/[0-9]*; do
        { mapfile -d '' -t words < "$directory/cmdline"; } 2> /dev/null || continue
        case "${words[0]##*/} ${words[*]:1}" in
            python*\ /home/lvuser/py/* | python*\ /home/lvuser/.pyfrc/releases/* | java*\ /home/lvuser/*.jar* | frcUserProgram\ *)
                echo "${directory#/proc/}" ;;
        esac
    done
}

# Waits up to one second. Succeeds if one of the given processes still runs.
left() {
    local turn process
    for turn in 1 2 3 4 5 6 7 8 9 10; do
        remaining=
        for process in "$@"; do
            [ ! -d "/proc/$process" ] || remaining="$remaining $process"
        done
        [ -n "$remaining" ] || return 1
        sleep 0.1
    done
}

if [ -n "$stop" ]; then
    remaining=$(programs)
    "$image" -t
    if left $remaining; then
        kill -TERM $remaining
        if left $remaining; then
            kill -KILL $remaining
            left $remaining
        fi
    fi
fi
if [ -n "$start" ]; then
    "$image" -r
fi
