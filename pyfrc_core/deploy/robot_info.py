"""Information about a robot, as text or JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict

from ..project import Project
from .facts import Release, RobotFacts
from .progress import UserInterface
from .target_connection import connected_agent
from .team import RobotChoice, choose_target

_ENDED = "ended after its last start"


def show_info(project: Project | None, choice: RobotChoice, talk: UserInterface) -> None:
    """Show the robot's program, who deployed it, and the kept releases."""
    with connected_agent(choose_target(project, choice, talk.ask), choice, talk.progress) as (connection, robot):
        name, key = connection.recognized.name, connection.key.fingerprint
        info = {"host": connection.host, "robot_name": name or None, "host_key": key, **asdict(robot.facts)}
        talk.progress.result(info, info_text(robot.facts, name), requested=True)


def info_text(facts: RobotFacts, name: str) -> str:
    """Return the information as text.

    :param name: the robot's name; empty if it has none
    """
    lines = [
        *([f"name       {name}"] if name else []),
        f"robot      {facts.image or 'unknown image'}, Python {facts.python}, wpilib {facts.wpilib or 'missing'}",
        f"disk       {facts.free_bytes / 1e6:.1f} MB free",
    ]
    if facts.current is None and not facts.other_code:
        lines.append("program    none")
    else:
        by_whom = "deployed by another tool" if facts.current is None else f"release {facts.current}"
        lines.append(f"program    {by_whom}, {_program_state(facts)}")
        lines += [f"  {key:<12} {value}" for key, value in _deployed(facts.deploy_json)]
    lines += [_release_line(release, facts.current) for release in reversed(facts.releases)]
    return "\n".join(lines)


def _program_state(facts: RobotFacts) -> str:
    """Return the program's state. Robots restart a crashing program forever, so a process alone proves little."""
    age = "" if facts.program_age is None else f"{facts.program_age:.{0 if facts.program_age >= 10 else 1}f} s"
    if any(each.number == facts.current and each.ended for each in facts.releases):
        now = f"started again {age} ago" if age else "started again"
        return f"{_ENDED}; {now if facts.running else 'not running'}"
    if not facts.running:
        return "not running"
    return f"running for {age}" if age else "running"


def _release_line(release: Release, current: int | None) -> str:
    deployed = dict(_deployed(release.deploy_json))
    parts = [deployed.get("date", "date unknown"), deployed.get("by"), deployed.get("commit")]
    parts += ["left by another tool"] if release.taken else []
    if release.ran or release.ended:
        parts.append(_ENDED if release.ended else "seen to run")
    parts += ["its record is damaged"] if release.damaged else []
    mark = "*" if release.number == current else " "
    return f"{mark} release {release.number:<4}" + ", ".join(part for part in parts if part)


def _deployed(record: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the rows to show for a ``deploy.json``."""
    rows = []
    if "deploy-user" in record:
        rows.append(("by", f"{record['deploy-user']} on {record.get('deploy-host', 'an unknown computer')}"))
    if "deploy-date" in record:
        rows.append(("date", record["deploy-date"]))
    if "code-path" in record:
        rows.append(("from", record["code-path"]))
    if "git-desc" in record:
        description = record["git-desc"]
        dirty = ", with uncommitted changes" if description.endswith("-dirty") else ""
        branch = f" on {record['git-branch']}" if "git-branch" in record else ""
        rows.append(("commit", f"{description.removesuffix('-dirty')}{branch}{dirty}"))
    return rows
