"""An exam for `pyfrc fuzz`: thirty planted bugs, and correct robots that must not get a finding.

    python benchmarks/fuzz_exam.py [NAME]... [--time SECONDS] [--seed N] [--replays N] [--until-found]
    python benchmarks/fuzz_exam.py --correct [NAME]... [--runs N]

The bugs in fuzz_exam/bugs.toml were planted without knowledge of fuzz's code: do not tune it to them. Each is a patch
to a template or to a robot in tests/robots, and needs two things to come together. fuzz_exam/witnesses has a test for
each that fails with the patch only. The first form plays a campaign on each and prints whether and when the bug was
found, how many writes its script has, and how many replays fail in the same way. With --until-found, a campaign ends
when its bug was printed, which takes a tenth of the time; other findings that would come later are not seen. The second
form plays matches on the robots in fuzz_exam/correct.toml and prints each finding: a false alarm, or a fault after all.
It needs Python 3.11 or newer, an environment with pyfrc's development requirements, the program patch, a POSIX system,
and an idle machine. Two replays run at once.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomllib

HERE = Path(__file__).resolve().parent
EXAM = HERE / "fuzz_exam"
ROBOTS = HERE.parent / "tests" / "robots"
PYFRC = [sys.executable, "-m", "pyfrc"]
_LEFT_OUT = shutil.ignore_patterns("__pycache__", ".*_cache", ".pyfrc", "ctre_sim", "fuzz")
_PROGRESS = re.compile(r"\d+ match(es)?, ")
_PLACE = re.compile(r"\S+\.py:\d+: ")
_REPLAY = re.compile(r"\s*pyfrc replay (\S+)")


@dataclass
class Finding:
    """A failure that a campaign has printed.

    :param seconds: when, since the start
    :param lines: what was printed
    :param script: the name of its script
    """

    seconds: float
    lines: list[str]
    script: str

    def has(self, pattern: str) -> bool:
        """Return whether one of the lines matches."""
        return any(re.search(pattern, line) for line in self.lines)


@dataclass
class Answer:
    """Result of a campaign on a robot with a planted bug."""

    found: Finding | None = None
    writes: int = 0
    replays: int = 0
    others: list[Finding] = field(default_factory=list)


def main() -> None:
    """Run the exam."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="a bug, or with --correct a robot; default: all")
    parser.add_argument("--correct", action="store_true", help="play matches on the correct robots instead")
    parser.add_argument("--time", type=float, default=120, help="seconds for each bug (default: 120)")
    parser.add_argument("--runs", type=int, default=1000, help="matches for each correct robot (default: 1000)")
    parser.add_argument("--replays", type=int, default=100, help="replays of each script (default: 100)")
    parser.add_argument("--until-found", action="store_true", help="end each campaign when its bug was printed")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    entries = read("correct.toml")["robot"] if options.correct else read("bugs.toml")["bug"]
    if unknown := set(options.names) - {entry["name"] for entry in entries}:
        parser.error(f"unknown: {', '.join(sorted(unknown))}")
    chosen = [entry for entry in entries if not options.names or entry["name"] in options.names]
    if options.correct:
        examine_correct_robots(chosen, options)
    else:
        examine_bugs(chosen, options)


def read(name: str) -> dict[str, Any]:
    """Return what is in one of the exam's files."""
    return tomllib.loads((EXAM / name).read_text("utf-8"))


def make_project(robot: str, directory: Path) -> Path:
    """Make the project of a robot: a template, one in tests/robots, or one of the exam's own.

    :param robot: such as ``template:tank``
    """
    kind, name = robot.split(":")
    project = directory / "robot"
    if kind == "template":
        subprocess.run([*PYFRC, "init", "--template", name, str(project)], check=True, capture_output=True)
    else:
        source = {"own": EXAM / "correct", "sample": ROBOTS, "competition": ROBOTS / "competition"}[kind] / name
        shutil.copytree(source, project, ignore=_LEFT_OUT)
    return project


def plant(bug: str, project: Path) -> None:
    """Apply the patch of a bug."""
    patch = EXAM / "patches" / f"{bug}.patch"
    subprocess.run(["patch", "-s", "-p1", "-i", str(patch)], cwd=project, check=True)


def examine_bugs(bugs: list[dict[str, Any]], options: argparse.Namespace) -> None:
    print(f"{'bug':28}{'found':>8}{'writes':>8}{'replays':>9}  other findings", flush=True)
    seconds, writes = [], []
    for bug in bugs:
        answer = examine_bug(bug, options)
        others = "; ".join(each.lines[0][:70] for each in answer.others)
        if answer.found is None:
            print(f"{bug['name']:28}{'NO':>8}{'':17}  {others}", flush=True)
            continue
        seconds.append(answer.found.seconds)
        writes.append(answer.writes)
        row = f"{bug['name']:28}{answer.found.seconds:7.1f}s{answer.writes:8}{answer.replays:5}/{options.replays}"
        print(f"{row}  {others}", flush=True)
    print(f"{len(seconds)} of {len(bugs)} found", end="")
    if seconds:
        print(f"; medians: {statistics.median(seconds):.1f} s, {statistics.median(writes):g} writes", end="")
    print()


def examine_bug(bug: dict[str, Any], options: argparse.Namespace) -> Answer:
    """Play a campaign on a robot with a planted bug, and replay the script that it finds."""
    answer = Answer()
    with tempfile.TemporaryDirectory(prefix="fuzz-exam-", ignore_cleanup_errors=True) as directory:
        project = make_project(bug["robot"], Path(directory))
        plant(bug["name"], project)
        campaign = "--seed", str(options.seed), "--time", f"{options.time:g}", "-j", "2"
        for finding in fuzz(project, *campaign, ends_with=bug["finding"] if options.until_found else None):
            if answer.found is None and finding.has(bug["finding"]):
                answer.found = finding
            else:
                answer.others.append(finding)
        if answer.found is not None:
            steps = map(json.loads, (project / answer.found.script).read_text("utf-8").splitlines())
            answer.writes = sum(len(step.get("set", ())) for step in steps)
            with ThreadPoolExecutor(2) as replays:
                outputs = replays.map(replay, [project] * options.replays, [answer.found.script] * options.replays)
                answer.replays = sum(re.search(bug["finding"], output) is not None for output in outputs)
    return answer


def replay(project: Path, script: str) -> str:
    """Replay a script in a process of its own; return what is printed."""
    return subprocess.run([*PYFRC, "replay", script], cwd=project, capture_output=True, text=True, check=False).stdout


def examine_correct_robots(robots: list[dict[str, Any]], options: argparse.Namespace) -> None:
    alarms = 0
    for robot in robots:
        with tempfile.TemporaryDirectory(prefix="fuzz-exam-", ignore_cleanup_errors=True) as directory:
            project = make_project(robot["robot"], Path(directory))
            begin = time.monotonic()
            found = fuzz(project, "--seed", str(options.seed), "--runs", str(options.runs))
        alarms += bool(found)
        doubt = robot.get("doubt", "") if found else ""
        print(f"{robot['name']:28}{time.monotonic() - begin:7.1f}s  {len(found)} findings  {doubt}", flush=True)
        for finding in found:
            print("    " + "\n    ".join(finding.lines), flush=True)
    print(f"{alarms} of {len(robots)} robots with findings")


def fuzz(project: Path, *options: str, ends_with: str | None = None) -> list[Finding]:
    """Play a campaign; return its findings in the order in which they are printed.

    :param ends_with: what the finding has that ends the campaign
    """
    ended = False
    begin = time.monotonic()
    found: list[Finding] = []
    lines: list[str] = []
    command = [*PYFRC, "fuzz", *options]
    with subprocess.Popen(
        command, cwd=project, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if _PROGRESS.match(line) or not line.strip():
                continue
            if _PLACE.match(line):
                lines = []  # what comes before is a warning
            lines.append(line.rstrip())
            if script := _REPLAY.match(line):
                found.append(Finding(time.monotonic() - begin, lines, script[1]))
                lines = []
                if ends_with is not None and not ended and found[-1].has(ends_with):
                    ended = True
                    process.send_signal(signal.SIGINT)
    if process.returncode not in (0, 1) and not ended:
        sys.exit(f"error: {' '.join(command)} in {project}:\n" + "\n".join(lines))
    return found


if __name__ == "__main__":
    main()
