"""How `pyfrc deploy` copes with 5,000 files, 60 MB, to a look-alike of a roboRIO over a field's radio.

Run it as root on Linux with ``python benchmarks/deploy_large.py``, from an environment with pyfrc's development
requirements. It takes three minutes.

4,889 Python files (10 MB), 10 networks of random bytes (40 MB) and 100 paths as JSON (10 MB). Printed are the time of
the first deploy, to the time that the link needs for the bytes that were sent (compressed, with agent, SSH and
manifest); the time for one changed file; and the most memory of the agent and of its compiler. All files are compared
after each deploy.
"""

from __future__ import annotations

import random
import sys
import tempfile
import threading
import time
from importlib.metadata import version
from pathlib import Path

from comparison import CHECKOUT, BenchmarkError, run
from deploy_speed import RATE, ROBOT, ROUND_TRIP

sys.path.insert(0, str(CHECKOUT / "tests"))
from roborio import Proxy, Roborio, missing_here

FILES, SIZE = 5_000, 60_000_000
#: In one directory.
CROWD = 3_000


def write_project(directory: Path, files: int = FILES, size: int = SIZE) -> Path:
    """A robot program of `files` files, `size` bytes in all; the same each time.

    A sixth of the bytes are Python modules, most of them in one directory; two thirds, networks that do not compress;
    the rest, paths as JSON.
    """
    numbers = random.Random(1)
    (directory / "deploy").mkdir(parents=True)
    (directory / "robot.py").write_text(ROBOT)
    networks, paths = max(1, files // 500), max(1, files // 50)
    modules = files - networks - paths - 1
    crowd = modules * CROWD // FILES
    for number in range(modules):
        package = directory / ("generated" if number < crowd else f"package_{number % 20}")
        package.mkdir(exist_ok=True)
        (package / f"module_{number}.py").write_text(_module(numbers, number, size // 6 // modules))
    for number in range(networks):
        (directory / f"deploy/network_{number}.onnx").write_bytes(numbers.randbytes(size * 2 // 3 // networks))
    for number in range(paths):
        (directory / f"deploy/path_{number}.json").write_text(_path(numbers, size // 6 // paths))
    return directory


def _module(numbers: random.Random, number: int, size: int) -> str:
    lines = [f'"""Module {number}."""\n']
    while sum(map(len, lines)) < size - 100:
        name = "".join(numbers.choices("abcdefghijklmnopqrstuvwxyz_", k=12))
        lines.append(f"\ndef {name}(x):\n    return x * {numbers.random()} + {numbers.randrange(10**6)}\n")
    return "".join(lines)


def _path(numbers: random.Random, size: int) -> str:
    points = ",\n".join(
        f'{{"t": {turn / 50}, "x": {numbers.random()}, "y": {numbers.random()}}}' for turn in range(size // 60)
    )
    return f"[{points}]\n"


class Memory:
    """The most memory that the agent and its compiler have had, by their VmHWM, until the end of the ``with`` block."""

    def __init__(self) -> None:
        self.agent = self.compiler = 0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch)

    def __enter__(self) -> Memory:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._over.wait(0.05):
            agents = {}
            for process in Path("/proc").glob("[0-9]*"):
                try:
                    words = (process / "cmdline").read_bytes().split(b"\0")
                    if b"python" in words[0] and any(b"the agent has not arrived" in word for word in words):
                        lines = (process / "status").read_text().splitlines()
                        agents[process.name] = dict(line.split(":\t", 1) for line in lines if ":\t" in line)
                except OSError:
                    continue  # it has ended
            for status in agents.values():
                peak = int(status.get("VmHWM", "0").split()[0]) * 1024
                if status["PPid"] in agents:
                    self.compiler = max(self.compiler, peak)
                else:
                    self.agent = max(self.agent, peak)


def deploy(project: Path, robot: Roborio, what: str) -> tuple[float, int]:
    """Deploy and print the figures: the seconds from the command's start to its end, and the bytes sent."""
    command = [sys.executable, "-m", "pyfrc", "deploy", "--skip-tests", "--large", "-n", "--robot"]
    with Proxy((robot.host, robot.port), round_trip=ROUND_TRIP, rate=RATE) as proxy, Memory() as memory:
        begin = time.perf_counter()
        output = run([*command, f"{proxy.host}:{proxy.port}"], project)
        seconds = time.perf_counter() - begin
        sent = proxy.bytes_to_robot
    for file in project.rglob("*"):
        copy = robot.home / "py" / file.relative_to(project)
        visible = ".pyfrc" not in file.parts and "__pycache__" not in file.parts
        if file.is_file() and visible and (not copy.is_file() or copy.read_bytes() != file.read_bytes()):
            raise BenchmarkError(f"{file.name} has not been deployed:\n{output}")
    print(
        f"{what:<18} {seconds:7.2f} s  {sent / 1e6:6.2f} MB sent, which take the link {sent / RATE:6.2f} s  "
        f"memory of the agent {memory.agent / 1e6:4.1f} MB, of the compiler {memory.compiler / 1e6:4.1f} MB",
        flush=True,
    )
    if max(memory.agent, memory.compiler) > 40e6:
        print("memory: MISSED (<= 40 MB each)")
    return seconds, sent


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="pyfrc-large-") as directory:
        project = write_project(Path(directory, "project"))
        files = [file for file in project.rglob("*") if file.is_file()]
        size = sum(file.stat().st_size for file in files)
        print(f"{len(files):,} files, {size / 1e6:.1f} MB; {ROUND_TRIP * 1000:.0f} ms, {RATE * 8 / 1e6:g} Mbit/s")
        with Roborio(wpilib=version("wpilib"), disk_size="400m") as robot:
            seconds, sent = deploy(project, robot, "first deploy")
            ratio = seconds * RATE / sent
            print(f"first deploy: {'met' if ratio <= 1.15 else 'MISSED'} ({ratio:.3f} of the link's time, <= 1.15;")
            print(f"    {seconds * RATE / size:.3f} of its time for the bytes as they are, not compressed)")
            deploy(project, robot, "unchanged redeploy")
            for number in range(3):
                with (project / "generated/module_70.py").open("a") as file:
                    file.write(f"\nCHANGE = {number}\n")
                seconds, _ = deploy(project, robot, "one changed file")
                print(f"one changed file: {'met' if seconds <= 5 else 'MISSED'} (<= 5 s)")


if __name__ == "__main__":
    if missing := missing_here():
        sys.exit(f"error: a look-alike of a roboRIO needs {', '.join(missing)}")
    try:
        main()
    except BenchmarkError as error:
        sys.exit(f"error: {error}")
