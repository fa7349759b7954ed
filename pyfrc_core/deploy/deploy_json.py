"""The content of ``deploy.json`` on the robot: who deployed the program, when, from where and from which commit."""

from __future__ import annotations

import getpass
import socket
import subprocess
from datetime import datetime
from pathlib import Path

_GIT_SECONDS = 5.0


def deploy_json(root: Path) -> dict[str, str]:
    """Return the record, with the same keys as other tools. The git keys exist only in a git checkout.

    :param root: the code's directory
    """
    record = {
        "deploy-host": socket.gethostname(),
        "deploy-user": _user(),
        "deploy-date": datetime.now().isoformat(timespec="seconds"),
        "code-path": str(root),
    }
    commit = _git(root, "rev-parse", "HEAD")
    if commit:
        record["git-hash"] = commit
        # Ends in "-dirty" if there are uncommitted changes.
        record["git-desc"] = _git(root, "describe", "--dirty=-dirty", "--always") or commit
        record["git-branch"] = _git(root, "rev-parse", "--abbrev-ref", "HEAD") or "HEAD"
    return record


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return "unknown"


def _git(root: Path, *arguments: str) -> str | None:
    """Return the output of git, or None without git, a checkout or a commit."""
    try:
        done = subprocess.run(
            ["git", "-C", str(root), *arguments],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=_GIT_SECONDS,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip()
