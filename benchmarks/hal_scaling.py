"""What a packet costs on robots with many devices: the looks of `--trace` and `--record`.

    pip install robotpy-rev phoenix6
    python benchmarks/hal_scaling.py

Each row is a process of its own, with so many devices and nothing else. The figures are microseconds, medians. A look
reads every value, so they grow with the number of values.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

#: Kinds of devices, and how many of each are measured.
CASES = {"SPARK MAX": (0, 8, 14, 40), "TalonFX": (0, 8, 14, 40), "LED": (0, 60, 300), "SimDevice of 25": (0, 8, 14, 40)}

#: Looks before the first one that counts, looks in a sample, and samples.
WARM_UP, LOOKS, SAMPLES = 150, 20, 9

COLUMNS = ("signature", "leaves", "trace", "record", "changing")


def make(kind: str, count: int) -> tuple[list[Any], Callable[[int], object]]:
    """Create the devices. Return them, and a function that changes one value of one of them."""
    if kind == "SPARK MAX":
        import rev

        sparks = [rev.SparkMax(number, rev.SparkMax.MotorType.kBrushless) for number in range(1, count + 1)]
        return sparks, lambda turn: sparks[0].set(turn % 100 / 100) if sparks else None
    if kind == "TalonFX":
        import phoenix6

        talons = [phoenix6.hardware.TalonFX(number) for number in range(1, count + 1)]
        return talons, lambda turn: talons[0].sim_state.set_supply_voltage(10 + turn % 3) if talons else None
    if kind == "LED":
        import wpilib

        if not count:
            return [], lambda turn: None
        strip = wpilib.AddressableLED(9)
        strip.setLength(count)
        lights = [wpilib.AddressableLED.LEDData(10, 20, 30) for _ in range(count)]
        strip.setData(lights)
        strip.start()

        def change(turn: int) -> None:
            lights[0].setRGB(turn % 256, 0, 0)
            strip.setData(lights)

        return [strip], change
    import hal

    devices = [hal.SimDevice(f"Device[{number}]") for number in range(count)]
    values = [device.createDouble(f"value {n}", 2, 1.0 + n) for device in devices for n in range(25)]
    return [devices, values], lambda turn: values[0].set(turn) if values else None


def median_us(look: Callable[[], object]) -> float:
    """Return the median time of one call, in microseconds."""
    for _ in range(WARM_UP):
        look()
    samples = []
    for _ in range(SAMPLES):
        begin = time.process_time()
        for _ in range(LOOKS):
            look()
        samples.append((time.process_time() - begin) / LOOKS * 1e6)
    return statistics.median(samples)


def measure(kind: str, count: int) -> dict[str, Any]:
    """Return the figures of one row: to be called in a process of its own."""
    from pyfrc_core.project.robot_files import RobotFiles
    from pyfrc_core.runtime.patches.install import patches
    from pyfrc_core.runtime.robot import RobotRun
    from pyfrc_core.runtime.scripts.recorder import Recorder
    from pyfrc_core.runtime.scripts.trace import Trace

    patches.install(RobotFiles(Path.cwd()))
    run = RobotRun()
    run.open()
    devices, change = make(kind, count)
    tree = run.hal_data
    row: dict[str, Any] = {"kind": kind, "count": count, "values": len(tree.leaves())}
    row["signature"] = median_us(tree["CAN"].signature)
    row["leaves"] = median_us(tree.paths_and_values)
    trace = Trace(tree)
    row["trace"] = median_us(lambda: trace.look(0.0))
    recorder = Recorder(run)

    def packet() -> None:
        recorder.begin_outside()
        recorder.end_outside()

    row["record"] = median_us(packet)
    run.recorder = None
    turn = 0

    def changing() -> None:
        nonlocal turn
        turn += 1
        change(turn)
        trace.look(0.0)

    row["changing"] = median_us(changing)
    del devices
    return row


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=CASES, action="append", help="only this kind of device; may be repeated")
    parser.add_argument("--row", nargs=2, metavar=("KIND", "COUNT"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.row:
        print(json.dumps(measure(options.row[0], int(options.row[1]))), flush=True)
        os._exit(0)  # without taking the HAL down, which is not what is measured
    print("| devices | values |" + "".join(f" {column} |" for column in COLUMNS))
    print("|---|--:|" + "--:|" * len(COLUMNS))
    for kind in options.only or CASES:
        for count in CASES[kind]:
            command = [sys.executable, __file__, "--row", kind, str(count)]
            child = subprocess.run(command, capture_output=True, text=True)
            if child.returncode:
                print(f"{kind}: {child.stderr.strip().splitlines()[-1]}", file=sys.stderr)
                break
            row = json.loads(child.stdout.splitlines()[-1])
            figures = "".join(f" {row[column]:.1f} |" for column in COLUMNS)
            print(f"| {count} {kind} | {row['values']} |{figures}", flush=True)


if __name__ == "__main__":
    main()
