"""Keep in ``.pyfrc/fuzz/corpus`` which matches were worth continuing: ``--continue`` plays them first."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from ...project import Project
from ...text_files import keep_out_of_version_control, write_whole
from .results import Shard

DIRECTORY = Path(".pyfrc", "fuzz", "corpus")


def read_guidance(project: Project, seed: int, shard: Shard) -> dict[str, Any]:
    """Return what `write_guidance` has kept of the campaign with this seed; empty if there is nothing valid."""
    with suppress(OSError, ValueError):
        kept = json.loads(_file(project, seed, shard).read_text("utf-8"))
        return kept if isinstance(kept, dict) else {}
    return {}


def write_guidance(project: Project, seed: int, shard: Shard, kept: dict[str, Any]) -> None:
    """Keep these values of JSON. If they cannot be written, the next campaign begins at its first match."""
    file = _file(project, seed, shard)
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        keep_out_of_version_control(project.root / DIRECTORY.parts[0])
        write_whole(file, [json.dumps(kept)])


def _file(project: Project, seed: int, shard: Shard) -> Path:
    part = f"-part-{shard.number}-of-{shard.count}" if shard.count > 1 else ""
    return project.root / DIRECTORY / f"seed-{seed}{part}.json"
