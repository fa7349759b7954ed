"""The SystemCore: Linux on 64-bit ARM, one user with a password and ``sudo``, systemd, Python in the home directory.

Where its image says its version was not found in public (SystemcoreTesting issue 85), so no image is refused.
"""

from __future__ import annotations

import ipaddress
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..agent.layout import Layout
from .controller import (
    ControllerKind,
    DriverStation,
    PythonInstaller,
    address_of_team,
    remove_remains,
    team_of_address,
)
from .roborio import NI_STATION

_USER = "systemcore"
_HOME = f"/home/{_USER}"
_PYTHON = f"{_HOME}/venv/bin/python3"
_PYTHONS = f"{_HOME}/.pyfrc/pythons"
_SUDO = ("/usr/bin/sudo", "-n")
# systemd refuses to start a service that has crashed too often within a few seconds, until its failures are forgotten.
_RESTART = "systemctl stop robot; systemctl reset-failed robot; systemctl -q enable robot; exec systemctl start robot"
_NAME = "robot.local"
_WIFI = "172.30.0.1"
#: The sources differ in the address on USB, also by the computer's system.
_USB_CABLE = ("172.28.0.1", "172.29.0.1", "172.26.0.1", "172.27.0.1")

_LAYOUT = Layout(
    name="SystemCore",
    user=_USER,
    owner=f"{_USER}:{_USER}",
    administrator=_USER,
    home=_HOME,
    code=f"{_HOME}/py",
    start=f"{_PYTHON} -u -O -m robotpy --main {{main}} run\n",
    start_debug=f"{_PYTHON} -u -m robotpy --main {{main}} -v run\n",
    command="robotCommand",
    debug_command="",
    debug_flag="",
    stop=(*_SUDO, "systemctl", "stop", "robot"),
    restart=(*_SUDO, "/bin/sh", "-c", _RESTART),
    stopper="systemctl",
    profiles=(),
    texts={},
    command_mode=0o755,
    python=_PYTHON,
    installing=_PYTHONS,
    can_fail=True,
    # The messages of the program's processes; with --unit, those of systemd about it would come, too.
    output=("journalctl", "--follow", "--lines=0", "--output=cat", "_SYSTEMD_UNIT=robot.service"),
)


def _addresses(team: int) -> list[tuple[str, str]]:
    """Return where a team's robot may be, and how it is connected there. All but the first are any team's."""
    return [
        (address_of_team(team), "radio or Ethernet"),
        (_NAME, "name, by multicast"),
        (_WIFI, "Wi-Fi"),
        *((each, "USB cable") for each in _USB_CABLE),
    ]


def _station_robot(message: Mapping[str, Any]) -> tuple[str | None, bool]:
    host = message.get("robotIp")
    try:
        is_host = isinstance(host, str) and not ipaddress.IPv4Address(host).is_unspecified
    except ValueError:
        is_host = False
    return host if is_host else None, message.get("fmsControlled") is True


_INSTALL_PYTHON = f"""
set -e
umask 022
mkdir -p {_PYTHONS}
cd {_PYTHONS}
[ ! -e {{name}} ] || {{{{ echo there; exit 0; }}}}
{remove_remains(_PYTHONS)}
set -- $(df -Pk . | tail -n 1)
[ "$4" -ge {{kilobytes}} ] || {{{{ echo "full $4"; exit 0; }}}}
trap "rm -rf {_PYTHONS}/$$.new" EXIT
mkdir $$.new
cd $$.new
echo send
cat > archive
echo "{{sha256}}  archive" | sha256sum -c > /dev/null
tar -xzf archive
rm archive
set -- */
"$1/bin/python3" -c ""
sync
[ -e ../{{name}} ] || mv "$1" ../{{name}}
"""


def _needed_for_python(archive: Path) -> int:
    with archive.open("rb") as stream:
        stream.seek(-4, 2)
        (unpacked,) = struct.unpack("<I", stream.read())  # gzip's last field
    return archive.stat().st_size + int(unpacked) * 5 // 4


SYSTEMCORE = ControllerKind(
    layout=_LAYOUT,
    install_python=PythonInstaller(_INSTALL_PYTHON, _USER, _needed_for_python),
    password=_USER,
    shared_hosts=(_NAME, _WIFI, *_USB_CABLE),
    machine="aarch64",
    image_it=f'On its web page (http://{_NAME}), set your team number, and update its image in settings, "OS Update"',
    stations=(DriverStation(6770, _station_robot), NI_STATION),
    addresses=_addresses,
    team_of_host=team_of_address,
    radio="A radio VH-109 needs firmware 2.0.0 or newer, in SystemCore mode: otherwise, there is no 10.TE.AM.2.",
)
