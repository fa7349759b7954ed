"""Files that the program has written beside its code: they are carried over into the next release."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import NamedTuple

from .activity import Activity
from .disk import SpecialFileError, everything_below, link_or_copy, remove

#: The longest file name to which a suffix is added, in bytes; longer names are cut to this number of characters.
_MAX_NAME_BYTES, _CUT_LENGTH = 220, 50
_OTHER_TOOLS_CODE = (".py", ".pyi", ".pyc")


class Carried(NamedTuple):
    """Files that were carried over.

    :param files:   the paths of files that both releases share, with their inode numbers
    :param skipped: the paths of pipes, sockets and devices that cannot be carried over
    :param renamed: the new paths of files and directories whose names are a directory or a file of the new release
    """

    files: dict[str, int]
    skipped: list[str]
    renamed: list[str]


def carry_over(
    old: Path,
    new: Path,
    manifests: tuple[set[str] | None, set[str]],
    before: dict[str, int] | None,
    between: Path,
    activity: Activity,
) -> Carried:
    """Link files that the program wrote in the release `old` into the release `new`.

    An existing file in `new` that the program wrote under the same name is kept under another name. So are a directory
    whose name is a file in `new`, and the other way round.

    :param manifests: the deployed files of both; None for another tool's directory
    :param before: the files that the first call for these releases carried over; then only files that the old program
        has written since are linked, and files that the new program has changed are kept
    :param between: the name of each link until it takes its place
    """
    old_manifest, new_manifest = manifests
    # Directories that contain only code belong to the manifest.
    code_in: set[str] = set()
    for name in old_manifest or ():
        above = name.rpartition("/")[0]
        while above and above not in code_in:
            code_in.add(above)
            above = above.rpartition("/")[0]
    carried = Carried({}, [], [])
    aside: dict[str, str] = {}
    activity.begin("carry")
    for name, entry in everything_below(old):
        activity.step()
        if old_manifest is None:
            is_code = name.endswith(_OTHER_TOOLS_CODE) or name == "deploy.json"
        else:
            is_code = name in old_manifest
        is_directory = entry.is_dir(follow_symlinks=False)
        if is_code or (name in new_manifest and not is_directory):
            continue
        parent = next((each for each in aside if name.startswith(f"{each}/")), None)
        target = new / (name if parent is None else aside[parent] + name[len(parent) :])
        if name in new_manifest or (not is_directory and target.is_dir() and not target.is_symlink()):
            aside[name] = f"{name}.release-{old.name}"
            target = new / aside[name]
            carried.renamed.append(aside[name])
        try:
            if is_directory:
                if before is None and old_manifest is not None and name not in code_in:
                    target.mkdir(parents=True, exist_ok=True)
                continue
            inode = os.lstat(entry.path).st_ino
            there = target.lstat().st_ino if target.exists() or target.is_symlink() else None
            if there == inode:
                carried.files[name] = inode
            elif before is None or before.get(name) == there:
                target.parent.mkdir(parents=True, exist_ok=True)
                if before is None and there is not None:
                    _keep_beside(target, Path(entry.path), new.name)
                remove(between)
                link_or_copy(entry.path, str(between))
                between.replace(target)
                carried.files[name] = inode
        except SpecialFileError:
            carried.skipped.append(name)
        except (FileNotFoundError, FileExistsError, NotADirectoryError, IsADirectoryError, PermissionError):
            # Removed or replaced by the program; or not readable for this user and therefore for the program.
            continue
    return carried


def _keep_beside(target: Path, replacement: Path, release: str) -> None:
    """Keep a file under another name before its replacement, unless the content is the same."""
    if target.is_dir() and not target.is_symlink():
        return  # directories are not replaced
    import filecmp

    if not (target.is_symlink() or replacement.is_symlink()) and filecmp.cmp(target, replacement, shallow=False):
        return
    name = target.name if len(os.fsencode(target.name)) <= _MAX_NAME_BYTES else target.name[:_CUT_LENGTH]
    for number in count(1):
        beside = target.with_name(f"{name}.release-{release}" + (f"-{number}" if number > 1 else ""))
        if not os.path.lexists(beside):
            link_or_copy(str(target), str(beside))
            return
