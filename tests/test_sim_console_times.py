"""The console of a page has each line at the robot time at which robot code printed it, however fast time went."""

from __future__ import annotations

from typing import Any

from conftest import MakeProject
from recorded_pages import run_in
from sim_robots import run
from web_pages import served

from pyfrc_core.project import find_project
from pyfrc_core.sim import SimOptions, Simulation

ROBOT = """
    import logging
    import os
    import subprocess
    import sys

    import wpilib

    logging.basicConfig(format="%(levelname)s %(message)s")
    print("imported")

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.turns = 0

        def robotPeriodic(self):
            self.turns += 1
            turn = f"turn {self.turns}"
            print(turn)
            if self.turns == 10:
                print("over", "the", end=" ")
            if self.turns == 12:
                print("line\\nand more: ä")
            if self.turns == 20:
                print("Warning: low", file=sys.stderr)
                logging.error("hot")
            if self.turns == 25:
                subprocess.run([sys.executable, "-c", "print('from a child')"], check=True)
            if self.turns == {end}:
                print("the last words")
                os._exit(3)
"""
#: A loop's period, in seconds.
PERIOD = 0.02


def expected(turns: int) -> list[tuple[str, float]]:
    """The lines until a turn, with the times of their ends."""
    lines = [("imported", 0.0)]
    for turn in range(1, turns + 1):
        at = round(turn * PERIOD, 3)
        begun = "over the " if turn == 11 else ""
        lines.append((f"{begun}turn {turn}", at))
        if turn == 12:
            lines += [("line", at), ("and more: ä", at)]
        if turn == 20:
            lines += [("Warning: low", at), ("ERROR hot", at)]
    return lines


def of_python(console: list[dict[str, Any]]) -> list[tuple[str, float]]:
    """The lines of the robot's code: not those of WPILib's C++ code and of a process that the robot has started."""
    own = [line for line in console if not line["text"].startswith(("Default ", "from a child"))]
    return [(line["text"], line["t"]) for line in own]


def test_the_file_of_a_run_at_full_speed(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT.replace("{end}", "900")})
    files = ("--wpilog", "run.wpilog", "--page", "run.html")
    result = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "30", "--speed", "0", *files)
    assert result.code == 1
    hello = run_in(project.path / "run.html")["hello"]
    console = [line for line in hello["console"] if line["level"] != "pyfrc"]
    assert of_python(console)[: len(expected(900)) + 1] == [*expected(900), ("the last words", 18.0)]
    assert any(line["text"] == "from a child" for line in console)
    marks = {mark["text"]: mark["t"] for mark in hello["marks"]}
    assert marks["Warning: low"] == marks["ERROR hot"] == 0.4
    # The terminal has the lines, and nothing else.
    assert "turn 1\nturn 2\n" in result.stdout
    assert "\0" not in result.stdout


def test_a_page_that_looks_on(make_project: MakeProject) -> None:
    with served(make_project({"robot.py": ROBOT.replace("{end}", "0")})) as server, server.page() as page:
        page.run_for(2.0)
        page.until(lambda: any(line["text"] == "turn 100" for line in page.console))
        assert of_python(page.console)[: len(expected(100))] == expected(100)


def test_who_reads_late_reads_the_same_times(make_project: MakeProject) -> None:
    project = find_project(make_project({"robot.py": ROBOT.replace("{end}", "0")}).path)
    with Simulation(project, SimOptions(speed=0, paused=True)) as simulation:
        early, late = simulation.output_cursor(), simulation.output_cursor()
        pieces = []
        for _ in range(5):
            run(simulation, 0.2)
            pieces += early.read_timed()
        simulation.close()
        pieces += early.read_timed()
        found = late.read_timed()
    assert "".join(text for text, _ in pieces) == "".join(text for text, _ in found)
    early_times, times = ({text.splitlines()[-1]: time for text, time in read} for read in (pieces, found))
    expected_times = {"imported": 0.0, "turn 5": 0.1, "turn 40": 0.8}
    assert times.items() >= expected_times.items()
    for line, time in expected_times.items():
        assert early_times.get(line) in (time, None)  # what is read as soon as it is printed may come before its time
