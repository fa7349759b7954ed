"""The image version of a robot, and files of programs in Java and C++."""

from __future__ import annotations

import re

from .disk import text_of
from .robot_paths import COMMAND, DEBUG_COMMAND, HOME, RobotPaths

IMAGE_FILE = "/etc/natinst/share/scs_imagemetadata.ini"
#: The start commands of programs in Java and C++, as a regular expression for Python and for grep -E.
START_COMMAND = "[.]jar|frcUserProgram"
START_COMMAND_FILES = (f"{HOME}/{COMMAND}", f"{HOME}/{DEBUG_COMMAND}")
PROGRAMS = (f"{HOME}/*.jar", f"{HOME}/frcUserProgram")
#: Libraries of programs in Java and C++. The directory is empty in the image.
LIBRARIES = "/usr/local/frc/third-party/lib"
JAVA = "/usr/local/frc/JRE/bin/java"


def image_in(text: str) -> str | None:
    """Return the version of the image from the content of `IMAGE_FILE`."""
    found = re.search(r'IMAGEVERSION\s*=\s*"?([^"\n]*)', text)
    return found[1] if found else None


def find_other_languages(paths: RobotPaths) -> list[str]:
    """Return the files and directories of programs in Java and C++ that can be removed."""
    found = [file for file in START_COMMAND_FILES if re.search(START_COMMAND, text_of(paths.of(file)) or "")]
    for pattern in (*PROGRAMS, JAVA):
        parent, _, name = pattern.rpartition("/")
        found += sorted(f"{parent}/{each.name}" for each in paths.of(parent).glob(name))
    libraries = paths.of(LIBRARIES)
    if libraries.is_dir() and any(libraries.iterdir()):
        found.append(LIBRARIES)
    return found
