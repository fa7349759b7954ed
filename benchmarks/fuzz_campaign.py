"""How `pyfrc fuzz --seed 1` finds the bugs of the twelve robots in tests/robots/buggy: seconds, matches, writes, runs.

python benchmarks/fuzz_campaign.py [ROBOT ...]
"""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pyfrc_core.fuzz.match_executor import open_match_executor
from pyfrc_core.project import find_project
from pyfrc_core.runtime.scripts.script import load_script

ROBOTS = Path(__file__).parents[1] / "tests" / "robots" / "buggy"
JOBS = 2
SECONDS = 120
REPLAYS = 100

#: The robots that raise nothing, and what is found instead.
FOUND = {"crawl": "not_a_number", "limit_switch": "motors_while_disabled"}


def main() -> None:
    names = sys.argv[1:] or sorted(file.parent.name for file in ROBOTS.glob("*/robot.py"))
    print(f"load {os.getloadavg()[0]:.1f}; -j {JOBS}, Python {sys.version.split()[0]}")
    print(f"| {'robot':17} | {'found after':>11} | {'matches':>7} | {'runs':>4} | writes | {'ends at':>7} | replays |")
    print("| --- | --: | --: | --: | --: | --: | --: |")
    for name in names:
        with tempfile.TemporaryDirectory() as temporary:
            project = Path(temporary, name)
            shutil.copytree(ROBOTS / name, project, ignore=shutil.ignore_patterns("__pycache__", "tests", "*.jsonl"))
            print(measured(name, project), flush=True)


def measured(name: str, project: Path) -> str:
    """One robot's campaign, as a line of a table."""
    started = time.monotonic()
    command = [sys.executable, "-m", "pyfrc", "fuzz", "--seed", "1", "--time", str(SECONDS), "-j", str(JOBS)]
    with subprocess.Popen(command, cwd=project, stdout=subprocess.PIPE, text=True) as campaign:
        assert campaign.stdout is not None
        text, runs, kept, seconds = "", "?", None, 0.0
        for line in campaign.stdout:
            text += line
            if kept is None and (found := re.search(r"(\d[\d,]*) runs? of the robot", line)):
                runs = found[1]
            if kept is None and (found := re.search(r"pyfrc replay (\S+)", line)):
                file = project / found[1]
                if name not in FOUND or FOUND[name] in file.name:
                    kept, seconds = file, time.monotonic() - started
                    campaign.send_signal(signal.SIGINT)
    matches = re.findall(r"^([\d,]+) match", text, re.MULTILINE)[-1]
    if kept is None:
        return f"| {name:17} | not found in {SECONDS} s, {matches} matches |\n{text}"
    script = load_script(kept)
    writes = sum(len(step.writes) for step in script.steps)
    replayed = subprocess.run(
        [sys.executable, "-m", "pyfrc", "replay", kept], cwd=project, capture_output=True, text=True, check=False
    )
    replays = [sys.executable, __file__, "--replays", str(project), str(kept)]
    fails = (
        subprocess.run(replays, capture_output=True, text=True, check=True).stdout if replayed.returncode == 1 else "0"
    )
    return (
        f"| {name:17} | {seconds:9.1f} s | {matches:>7} | {runs:>4} | {writes:6} | {script.end_us / 1e6:5.2f} s | "
        f"{fails.strip()} of {REPLAYS} |\n"
        + "\n".join(f"    {line}" for line in json.loads(kept.read_text().split("\n")[0])["story"])
    )


def failing(project: Path, kept: Path) -> int:
    """How many of the replays fail in the same way as the first."""
    script = load_script(kept)
    with open_match_executor(find_project(project), JOBS) as executor:
        results = [[each.failure for each in executor.replay(script).each_failure()] for _ in range(REPLAYS)]
    first = next(iter(results[0]), None)
    return sum(first is not None and any(first.same_as(each) for each in failures) for failures in results)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--replays"]:
        print(failing(Path(sys.argv[2]), Path(sys.argv[3])))
    else:
        main()
