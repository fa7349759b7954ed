"""Replacing the kill script of a robot's image by ours, where it has let a program survive.

The season's tools replace it on every robot, known by its hash, by one of their own. Here what it does counts, not what
it is: it is replaced after the robot program was seen to go on in spite of it. So the script of another tool that does
its work stays, and that tool may put its own in the place of ours whenever it likes.
"""

from __future__ import annotations

import shlex
from importlib.resources import files

from .connection import Connection
from .progress import Progress

_NAME = "frcKillRobot.sh"

# Each file is complete before it gets its name: power may be cut at any moment. The image's script is kept once.
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


def replace_kill_script(connection: Connection, progress: Progress) -> None:
    """Put our kill script in the place of the robot's, whose copy stays beside it.

    It needs the administrator, and so a connection of its own. When that fails, a warning says so.
    """
    text = files(__package__).joinpath(_NAME).read_text("utf-8")
    problem = connection.administer(_INSTALL.format(text=shlex.quote(text)))
    if problem is None:
        progress.note(f"  {_NAME} let it survive, and was replaced; its copy is frcKillRobot.image.sh")
    else:
        progress.warning(f"{_NAME}, which let the old program survive, could not be replaced: {problem}")
