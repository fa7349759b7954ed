"""How quickly the page of `pyfrc sim --ui web` shows what happens, and what its server costs.

    python benchmarks/sim_page.py [--robot tests/robots/competition/rev_swerve] [--minutes 30] [--speed 1]

Needs Chromium, and pyfrc's development requirements.

The robot is a copy that has one motor more, which follows a key at once. In real time: from the key to the end of the
frame that paints the motor's number, 40 times; frames a second for 5 s while 8 values are plotted and the robot drives;
meanwhile, the processor time of the server's process. Then, in a practice match at `--speed` (0: as fast as it goes),
and for the rest of `--minutes` disabled: the memory of the page, of the server and of its other processes at some
moments, and the processor time since the moment before; at the end, from choosing a moment to the end of the frame that
paints its values in every panel, 60 times.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import statistics
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

CHECKOUT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(CHECKOUT / "tests"))

from browser_pages import open_browser  # noqa: E402

ROBOT = CHECKOUT / "tests/robots/competition/rev_swerve"
#: A motor that follows the key W at once, after the line in `robotInit` and before the end of `robotPeriodic`.
MOTOR = (
    ("    def robotInit(self) -> None:\n", "        self.at_once = wpilib.PWMSparkMax(19)\n"),
    ("    def robotPeriodic(self) -> None:\n", "        self.at_once.set(-wpilib.DriverStation.getStickAxis(0, 1))\n"),
)
PRESSES, MOMENTS, SECONDS = 40, 60, 5.0
#: When memory is measured, in minutes of robot time.
MARKS = (1, 4, 10, 20, 30)

#: A promise of the end of the frame that is being made: its task runs after the browser has painted.
PAINTED = """const painted = () => new Promise((resolve) => {
    const after = new MessageChannel();
    after.port1.onmessage = resolve;
    after.port2.postMessage(null);
  });"""

#: Press and release a key, and wait until the motor's number is painted: milliseconds of each.
KEY_TO_MOTOR = f"""async (presses) => {{
  {PAINTED}
  const number = document.querySelector("[data-path='pwm[19].value'] .number");
  const shows = (wanted) => new Promise((resolve) => {{
    const observer = new MutationObserver(() => number.textContent === wanted && (observer.disconnect(), resolve()));
    observer.observe(number, {{ childList: true, characterData: true, subtree: true }});
  }});
  const found = [];
  for (let press = 0; press < presses; press++) {{
    await new Promise((resolve) => setTimeout(resolve, 130 + 40 * Math.random()));
    const [kind, wanted] = press % 2 ? ["keyup", "0.00"] : ["keydown", "1.00"];
    const shown = shows(wanted);
    const began = performance.now();
    dispatchEvent(new KeyboardEvent(kind, {{ key: "w", code: "KeyW", bubbles: true }}));
    await shown;
    await painted();
    found.push(performance.now() - began);
  }}
  return found;
}}"""

#: Count the values that come in some seconds: those of one update in the median.
CHANGED = """async (seconds) => {
  const { model } = await import("/static/js/model.js");
  const { take } = model;
  const counts = [];
  model.take = (message) => {
    if (message.values) counts.push(Object.keys(message.values).length);
    take.call(model, message);
  };
  await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
  model.take = take;
  return counts.sort((one, other) => one - other)[counts.length >> 1];
}"""

#: Count frames for some seconds: frames a second, and the longest, in milliseconds.
FRAMES = """(seconds) => new Promise((resolve) => {
  const began = performance.now();
  let last = began, count = 0, longest = 0;
  const frame = () => {
    const now = performance.now();
    count += 1;
    longest = Math.max(longest, now - last);
    last = now;
    if (now - began < 1000 * seconds) requestAnimationFrame(frame);
    else resolve([count / ((now - began) / 1000), longest]);
  };
  requestAnimationFrame(frame);
})"""

PLOT = """(paths) => import("/static/js/plotting.js").then(({ addToPlot }) => {
  paths.forEach((path, index) => addToPlot(path, index % 2 ? "plot:1" : "plot:2"));
})"""

#: Look at moments of the whole run at random, until every panel has painted its values: milliseconds of each.
SEEK = f"""async (moments) => {{
  {PAINTED}
  const {{ model }} = await import("/static/js/model.js");
  const {{ look, length }} = await import("/static/js/past.js");
  const found = [];
  for (let index = 0; index < moments; index++) {{
    const t = Math.round(Math.random() * length() / 0.02) * 0.02;
    const began = performance.now();
    const shown = new Promise((resolve) => {{
      const stop = model.listen(() => model.past && Math.abs(model.past.t - t) < 1e-6 && (stop(), resolve()));
    }});
    look(t);
    await shown;
    await painted();
    found.push(performance.now() - began);
  }}
  return found;
}}"""

MODEL = "import('/static/js/model.js').then(({ model }) => [model.t, model.values.size])"


@contextmanager
def serving(robot: Path, *options: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Simulate a copy of a robot that has a motor of its own for the key W; the process, and the page's address."""
    with TemporaryDirectory() as directory:
        project = Path(shutil.copytree(robot, Path(directory) / "robot"))
        code = (project / "robot.py").read_text("utf-8")
        for place, line in MOTOR:
            heading, docstring = re.escape(place), r'(?:        """.*"""\n)?'
            code, count = re.subn(f"({heading}{docstring})", rf"\g<1>{line}", code)
            assert count == 1, f"{project / 'robot.py'} has no {place.strip()}"
        (project / "robot.py").write_text(code, "utf-8")
        command = [sys.executable, "-m", "pyfrc", "sim", "--ui", "web", "--nt-port", "0", *options]
        environment = {**os.environ, "DISPLAY": "", "WAYLAND_DISPLAY": "", "PYTHONUNBUFFERED": "1"}
        with subprocess.Popen(command, cwd=project, env=environment, text=True, stdout=subprocess.PIPE) as process:
            assert process.stdout is not None
            try:
                yield process, next(match[0] for line in process.stdout if (match := re.search(r"http://\S+", line)))
            finally:
                process.terminate()


def processor_seconds(process: int) -> float:
    """Return the processor time that a process has used, without its children, in seconds."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def children_of(process: int) -> list[int]:
    """Return a process with all that it has started."""
    children = Path(f"/proc/{process}/task/{process}/children").read_text(encoding="ascii").split()
    return [process, *(each for child in children for each in children_of(int(child)))]


def megabytes(process: int) -> float:
    """Return the memory of a process that is its own or in use, without what lies on a disk."""
    fields = re.findall(r"(RssAnon|VmSwap):\s+(\d+)", Path(f"/proc/{process}/status").read_text(encoding="utf-8"))
    return sum(int(size) for _, size in fields) / 1024


def watch_memory(page: Any, process: int, minutes: float) -> None:
    """Print memory and processor time until the robot has come to a moment."""
    tools = page.context.new_cdp_session(page)
    marks = [mark for mark in MARKS if mark < minutes] + [minutes]
    before, since = processor_seconds(process), monotonic()
    for mark in marks:
        while page.evaluate(MODEL)[0] < 60 * mark:
            page.wait_for_timeout(200)
        share = (processor_seconds(process) - before) / (monotonic() - since)
        before, since = processor_seconds(process), monotonic()
        tools.send("HeapProfiler.collectGarbage")
        heap = tools.send("Runtime.getHeapUsage")["usedSize"] / 2**20
        server, *others = (megabytes(each) for each in children_of(process))
        what = f"minute {mark:g}: page {heap:.1f} MB, server {server:.0f} MB, others {sum(others):.0f} MB"
        print(f"{what:62} server {100 * share:.1f} % of a core, load {os.getloadavg()[0]:.0f}", flush=True)


def opened(browser: Any, address: str, layout: str) -> Any:
    """Open the page with one of its layouts, when the robot has started."""
    page = browser.new_page(viewport={"width": 1366, "height": 768})
    page.goto(address)
    page.locator(".state.disabled").wait_for(timeout=60_000)
    page.get_by_title("Layout", exact=True).click()
    page.get_by_role("menuitemcheckbox", name=layout).click()
    return page


def line(what: str, found: list[float], unit: str) -> str:
    """Return the median, and what nine of ten are below."""
    return f"{what:46} {statistics.median(found):6.1f} {unit}, 90 %: {sorted(found)[len(found) * 9 // 10]:6.1f} {unit}"


def quick(browser: Any, robot: Path) -> None:
    """Measure keys, frames and the server's part of a core."""
    with serving(robot) as (process, address):
        page = opened(browser, address, "Driving")
        page.get_by_role("button", name="Enable", exact=True).click()
        page.locator(".state.enabled").wait_for()
        print(line("key to drawn motor", page.evaluate(KEY_TO_MOTOR, PRESSES), "ms"), flush=True)
        page.get_by_title("Layout", exact=True).click()
        page.get_by_role("menuitemcheckbox", name="Tuning").click()
        plot_eight(page)
        page.keyboard.down("w")
        before = processor_seconds(process.pid)
        frames, longest = page.evaluate(FRAMES, SECONDS)
        share = (processor_seconds(process.pid) - before) / SECONDS
        values, changed = page.evaluate(MODEL)[1], page.evaluate(CHANGED, 1)
        print(f"{'frames while 8 values are plotted':46} {frames:6.1f} a second, the longest {longest:.0f} ms")
        what = f"server, {values} values, {changed} in an update"
        print(f"{what:46} {100 * share:6.1f} % of a core", flush=True)


def plot_eight(page: Any) -> None:
    """Plot eight values."""
    axes = [f"joysticks[0].axes[{axis}]" for axis in range(4)]
    page.evaluate(PLOT, [*axes, "pwm[19].value", "sim.pose[0]", "sim.pose[1]", "sim.pose[2]"])


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", type=Path, default=ROBOT, help="a robot whose autonomous and teleop need no person")
    parser.add_argument("--minutes", type=float, default=2.5, help="the robot time after which moments are chosen")
    parser.add_argument("--speed", type=float, default=0.0, help="robot seconds per second until then")
    parser.add_argument("--only-long", action="store_true", help="without keys and frames")
    given = parser.parse_args()
    robot = given.robot
    with open_browser() as browser:
        if not given.only_long:
            quick(browser, robot)
        with serving(robot, "--speed", f"{given.speed:g}") as (process, address):
            page = opened(browser, address, "Driving")
            plot_eight(page)
            page.get_by_role("button", name="Practice", exact=True).click()
            page.locator(".state.enabled").wait_for(timeout=60_000)
            watch_memory(page, process.pid, given.minutes)
            page.keyboard.press("F5")
            page.get_by_role("button", name="Run", exact=True).first.wait_for()
            what = f"a moment of {given.minutes:g} minutes, in every panel"
            print(line(what, page.evaluate(SEEK, MOMENTS), "ms"))


if __name__ == "__main__":
    main()
