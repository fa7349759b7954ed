"""What the files of a robot say about it: its image, and programs in Java and C++."""

from __future__ import annotations

import re

from .disk import text_of
from .places import COMMAND, DEBUG_COMMAND, HOME, Places
from .virtual import virtual_robot

IMAGE_FILE = "/etc/natinst/share/scs_imagemetadata.ini"
#: The start commands of such programs, as a regular expression that grep -E understands, too.
START_COMMAND = "[.]jar|frcUserProgram"
START_COMMAND_FILES = (f"{HOME}/{COMMAND}", f"{HOME}/{DEBUG_COMMAND}")
PROGRAMS = (f"{HOME}/*.jar", f"{HOME}/frcUserProgram")
#: A directory of the image, which is empty there.
LIBRARIES = "/usr/local/frc/third-party/lib"
JAVA = "/usr/local/frc/JRE/bin/java"


def image_in(text: str) -> str | None:
    """Return the version of the image, from the text of `IMAGE_FILE`."""
    found = re.search(r'IMAGEVERSION\s*=\s*"?([^"\n]*)', text)
    return found[1] if found else None


def find_other_languages(places: Places) -> list[str]:
    """Return the files and directories that programs in Java or C++ have brought: all that can be removed."""
    if virtual_robot() is not None:
        return []  # it runs programs in Python only
    found = [file for file in START_COMMAND_FILES if re.search(START_COMMAND, text_of(places.of(file)) or "")]
    for pattern in (*PROGRAMS, JAVA):
        parent, _, name = pattern.rpartition("/")
        found += sorted(f"{parent}/{each.name}" for each in places.of(parent).glob(name))
    libraries = places.of(LIBRARIES)
    if libraries.is_dir() and any(libraries.iterdir()):
        found.append(LIBRARIES)
    return found
