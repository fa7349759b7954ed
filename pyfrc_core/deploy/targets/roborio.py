"""The roboRIO: NI's Linux on ARM, two users without passwords, a kill script, `lvrt` as supervisor."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from shlex import quote
from typing import Any

from ..agent.layout import Layout
from .controller import (
    AdministratorTask,
    ControllerKind,
    DriverStation,
    PythonInstaller,
    Texts,
    address_of_team,
    remove_remains,
    team_of_address,
)

_HOME = "/home/lvuser"
_PYTHON = "/usr/local/bin/python3"
_START = f"env LD_LIBRARY_PATH=/usr/local/frc/lib/ {_PYTHON} -u"
_KILL_SCRIPT = "/usr/local/frc/bin/frcKillRobot.sh"
# They set PATH for NI's programs and FRC_ConsoleTee.
_PROFILES = ("/etc/profile.d/frc-path.sh", "/etc/profile.d/natinst-path.sh")
_USB_CABLE = "172.22.11.2"
_MEMORY_SETTINGS = "/etc/natinst/share/ni-rt.ini"
#: The directory of files that the administrator writes for pyfrc.
_OWN = "/usr/local/pyfrc"

_LAYOUT = Layout(
    name="roboRIO",
    user="lvuser",
    owner="lvuser:ni",
    administrator="admin",
    home=_HOME,
    code=f"{_HOME}/py",
    start=f"{_START} -O -m robotpy --main {{main}} run\n",
    start_debug=f"{_START} -m robotpy --main {{main}} -v run\n",
    command="robotCommand",
    debug_command="robotDebugCommand",
    debug_flag="/tmp/frcdebug",
    stop=(_KILL_SCRIPT, "-t"),
    restart=(_KILL_SCRIPT, "-t", "-r"),
    stopper="frcKillRobot.sh",
    profiles=_PROFILES,
    texts={"image": "/etc/natinst/share/scs_imagemetadata.ini", "memory": _MEMORY_SETTINGS},
    python=_PYTHON,
    installing=_OWN,
)


def _addresses(team: int) -> list[tuple[str, str]]:
    """Return where a team's robot may be, and how it is connected there.

    An address that robots of several teams can have is one of `shared_hosts`, too: its host key is of no one team.
    """
    name = f"roboRIO-{team}-FRC"
    return [
        (address_of_team(team), "radio or Ethernet"),
        (f"{name}.local", "name, by multicast"),
        (_USB_CABLE, "USB cable"),
        (name, "name"),
        (f"{name}.lan", "name, by the router"),
        (f"{name}.frc-field.local", "name, on a field"),
    ]


def _team_of_host(host: str) -> int | None:
    if named := re.fullmatch(r"roborio-([0-9]{1,5})-frc(?:\.local|\.lan|\.frc-field\.local)?", host, re.IGNORECASE):
        return int(named[1])
    return team_of_address(host)


def _station_robot(message: Mapping[str, Any]) -> tuple[str | None, bool]:
    number = message.get("robotIP")
    is_host = type(number) is int and 0 < number < 1 << 32
    host = str(ipaddress.IPv4Address(number)) if is_host else None
    return host, message.get("FMS Connected") is True


#: NI's Driver Station, for Windows.
NI_STATION = DriverStation(1742, _station_robot)


def _image_in(texts: Texts) -> str | None:
    found = re.search(r'IMAGEVERSION\s*=\s*"?([^"\n]*)', texts.get("image") or "")
    return found[1] if found else None


def _image_problem(image: str | None, wpilib: str, accepted: Sequence[str]) -> str | None:
    found = re.fullmatch(r"FRC_roboRIO2?_((20[0-9]{2})_v[0-9.]+)", image or "")
    if found is None:
        return f"the robot's image is unknown ({image!r})"
    version, year = found.groups()
    if version in accepted:
        return None
    season = wpilib.partition(".")[0]
    if year != season:
        return f"the robot's image is of {year} ({version}), but wpilib {wpilib} needs the image of {season}"
    return f"the robot's image is {version}, but this season's image is {accepted[-1]}"


def _wastes_memory(texts: Texts) -> bool:
    # With this line, services of the image load libraries that robots do not use.
    return any(line.startswith("StartupDLLs") for line in (texts.get("memory") or "").splitlines())


# Each file is complete before it gets its final name, since power may be cut. The image's script is kept once.
_REPLACE_KILL_SCRIPT = """
set -e
mkdir -p {own}
cd /usr/local/frc/bin
if [ ! -e frcKillRobot.image.sh ]; then
    cp -p frcKillRobot.sh {own}/$$.image
    chmod 755 {own}/$$.image
    sync
    mv {own}/$$.image frcKillRobot.image.sh
fi
printf %s {text} > {own}/$$.new
chmod 755 {own}/$$.new
sync
mv {own}/$$.new frcKillRobot.sh
"""


def _repair_stop() -> AdministratorTask:
    """Return the task that installs pyfrc's kill script.

    The season's own tools recognize the image's script by its hash and always replace it. pyfrc replaces a script only
    after it has failed. The working script of another tool therefore stays, and other tools may replace pyfrc's script.
    """
    text = files(__package__).joinpath("frcKillRobot.sh").read_text("utf-8")
    return AdministratorTask(
        _REPLACE_KILL_SCRIPT.format(text=quote(text), own=_OWN),
        "frcKillRobot.sh was replaced; the old script is kept as frcKillRobot.image.sh",
        "frcKillRobot.sh, which did not end the old program, could not be replaced",
    )


# Files are in /usr/local/pyfrc, named by the number of the process that writes them: on the disk of what they replace.
# While the file `installing` is there, Python is not complete: opkg was interrupted, and runs again. Then it finds
# files that no package has, so it must overwrite. Its messages go to a file: it must not end with the connection. Its
# usual directory for temporary files is in memory.
_INSTALL_PYTHON = f"""
set -e
umask 022
mkdir -p {_OWN}
cd {_OWN}
{remove_remains(_OWN)}
set -- $(df -Pk . | tail -n 1)
[ "$4" -ge {{kilobytes}} ] || {{{{ echo "full $4"; exit 0; }}}}
echo send
trap "rm -rf {_OWN}/$$.*" EXIT
mkdir $$.tmp
cat > $$.ipk
[ "$(wc -c < $$.ipk)" -eq {{size}} ]
: > installing
sync
if ! opkg --tmp-dir {_OWN}/$$.tmp --force-overwrite install ./$$.ipk > $$.log 2>&1 || ! {_PYTHON} -c "" 2> $$.log; then
    tail -n 1 $$.log >&2
    exit 1
fi
sync
rm -f installing
"""


def _needed_for_python(package: Path) -> int:
    return package.stat().st_size * 5  # estimated: what is in it is compressed about as much as other Pythons


ROBORIO = ControllerKind(
    layout=_LAYOUT,
    install_python=PythonInstaller(_INSTALL_PYTHON, _LAYOUT.administrator, _needed_for_python, is_system=True),
    check_python=f"[ ! -e {_OWN}/installing ] || exit 127; ",
    password="",
    shared_hosts=(_USB_CABLE,),
    machine="arm",
    image_it="Image it with the roboRIO Imaging Tool of this season",
    save_memory=AdministratorTask(
        f"sed -i -e 's/^StartupDLLs/;StartupDLLs/' {_MEMORY_SETTINGS}",
        "StartupDLLs was switched off: 24 MB more memory after the robot's next start",
        "StartupDLLs, which costs 24 MB of memory, could not be switched off",
    ),
    stations=(NI_STATION,),
    addresses=_addresses,
    team_of_host=_team_of_host,
    has_image_file=True,
    image_in=_image_in,
    image_problem=_image_problem,
    wastes_memory=_wastes_memory,
    repair_stop=_repair_stop,
)
