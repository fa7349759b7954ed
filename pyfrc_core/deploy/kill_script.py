"""Replacing the kill script of a robot's image if it has not ended the program.

The season's own tools recognize the image's script by its hash and always replace it. pyfrc replaces a script only
after it has failed. The working script of another tool therefore stays, and other tools may replace pyfrc's script.
"""

from __future__ import annotations

import shlex
from importlib.resources import files

from .connection import Connection
from .progress import DeployProgress

_NAME = "frcKillRobot.sh"

# Each file is complete before it gets its final name, since power may be cut. The image's script is kept once.
_INSTALL = """
set -e
cd /usr/local/frc/bin
if [ ! -e frcKillRobot.image.sh ]; then
    cp -p frcKillRobot.sh frcKillRobot.image.new
    chmod 755 frcKillRobot.image.new
    sync
    mv frcKillRobot.image.new frcKillRobot.image.sh
fi
printf %s {text} > frcKillRobot.new
chmod 755 frcKillRobot.new
sync
mv frcKillRobot.new frcKillRobot.sh
"""


def replace_kill_script(connection: Connection, progress: DeployProgress) -> None:
    """Replace the robot's kill script by pyfrc's, and keep a copy of the old one.

    This needs a second connection, as administrator. A failure only causes a warning.
    """
    text = files(__package__).joinpath(_NAME).read_text("utf-8")
    problem = connection.administer(_INSTALL.format(text=shlex.quote(text)))
    if problem is None:
        progress.note(f"  {_NAME} was replaced; the old script is kept as frcKillRobot.image.sh")
    else:
        progress.warning(f"{_NAME}, which did not end the old program, could not be replaced: {problem}")
