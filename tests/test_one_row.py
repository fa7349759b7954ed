"""A device is one row of the device table: everything else follows from it."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from pyfrc_core.config.sim import SimConfig
from pyfrc_core.fuzz.inputs.finders import SensorFinder
from pyfrc_core.fuzz.inputs.values import Input, RobotConstants
from pyfrc_core.hal import accessors, device_table, rows, tree
from pyfrc_core.hal.fields import INITIALIZED, DeviceField, DeviceKind, Measured, Output, Shown
from pyfrc_core.hal.kinds import BOOL, FLOAT, text
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.runtime.scripts.boots import boots_of
from pyfrc_core.runtime.scripts.recorder import Recorder
from pyfrc_core.runtime.scripts.script import InputScript, Step
from pyfrc_core.runtime.scripts.sensors import is_sensor
from pyfrc_core.runtime.scripts.targets import Targets
from pyfrc_core.runtime.scripts.trace import Trace
from pyfrc_core.runtime.scripts.trace_difference import first_difference
from pyfrc_core.sim.ui.models.devices import Row, panels_of
from pyfrc_core.sim.ui.web.updates import _panel as page_panel

#: The values of the made-up devices, by number: what stands for the HAL.
_values: dict[int, dict[str, Any]] = {}
_listeners: list[Callable[..., object]] = []


class MadeUpSim:
    """As WPILib's classes for simulated devices: `getDepth`, or `get_depth` in 2027."""

    def __init__(self, number: int) -> None:
        self._number = number

    def __getattr__(self, name: str) -> Any:
        found = re.fullmatch(r"(get|set|register)_?(\w+?)(?:_?callback)?", name.lower())
        if found is None:
            raise AttributeError(name)
        verb, key = found.groups()
        values = _values[self._number]

        def put(value: object) -> None:
            values[key] = value
            for listener in _listeners:
                listener()

        def register(listener: Callable[..., object], notify: bool) -> object:
            _listeners.append(listener)
            return listener

        return {"get": lambda: values[key], "set": put, "register": register}[verb]


DEPTH = Shown("slider", "Sonar {}", "{}: metres", 0, 9, 1, "m")
ROW = DeviceKind(
    "sonar",
    (
        INITIALIZED,
        Measured("depth", "Depth", FLOAT, quantity="range", shown=DEPTH),
        Measured("heat", "Heat", FLOAT, quantity="celsius", asked_by="Heat"),
        Output("light", "Light", BOOL, unset=False, off=False, shown=Shown("lamp", "Light {}", "Of {}")),
        DeviceField("name", "Name", text(8), stays=True),
    ),
    MadeUpSim,
    3,
    title="Sonar",
    panel="Sonars",
    labels="dio",
)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Iterator[RobotRun]:
    """A run on a controller that has three sonars, of which the robot has made the second."""
    caches = rows._rows, rows._kinds, rows.row_of, rows.gyros, tree
    for number in range(3):
        _values[number] = {"initialized": number == 1, "depth": 0.0, "heat": 20.0, "light": False, "name": ""}
    monkeypatch.setattr(device_table, "KINDS", (*device_table.KINDS, ROW))
    for cached in caches:
        cached.cache_clear()
    run = RobotRun()
    run.open()
    try:
        yield run
    finally:
        run.close()
        monkeypatch.undo()
        for cached in caches:
            cached.cache_clear()
        _listeners.clear()


def trace_of(run: RobotRun, file: Path) -> Path:
    out = io.StringIO()
    trace = Trace(run.hal_data, out)
    trace.look(0.02)
    trace.finish()
    file.write_text(out.getvalue(), encoding="utf-8")
    return file


def test_a_device_is_one_row(run: RobotRun, tmp_path: Path) -> None:
    sonar, hardware = run.hal_data["sonar"][1], _values[1]
    # hal_data
    sonar["depth"] = 2.5
    assert (hardware["depth"], sonar["depth"], len(run.hal_data["sonar"])) == (2.5, 2.5, 3)
    with pytest.raises(TypeError, match=r"sonar\[1\].depth: expected a number"):
        sonar["depth"] = "deep"
    # recorded, and replayed
    recorder = Recorder(run)
    recorder.begin_outside()
    sonar["depth"] = 3.5
    recorder.end_outside()
    (step,) = recorder.script("robot.py", 0, None).steps
    assert step.writes == {"sonar[1].depth": 3.5}
    hardware["depth"] = 0.0
    targets = Targets(run.hal_data)
    for target, value in step.writes.items():
        targets.check(target)
        targets.check_made(target)
        targets.write(target, value, 0)
    assert hardware["depth"] == 3.5
    # in traces, and compared: what robot code sets comes first
    recorded = trace_of(run, tmp_path / "recorded.jsonl")
    hardware.update(depth=4.0, light=True)
    difference = first_difference(recorded, trace_of(run, tmp_path / "replayed.jsonl"))
    assert difference is not None
    assert (difference.path, difference.recorded, difference.replayed) == ("sonar[1].light", False, True)
    # held as a sensor
    paths = [path for path, _ in run.hal_data.leaves() if path.startswith("sonar")]
    assert [path for path in paths if is_sensor(path)] == ["sonar[1].depth", "sonar[1].heat"]
    targets.write("hold:sonar[1].depth", 7.0, 0)
    targets.held.apply()
    assert hardware["depth"] == 7.0
    # varied by fuzz
    assert Input("sonar[1].depth", "range", "sonar[1]") in SensorFinder().find()
    heat = Input("sonar[1].heat", "celsius", "sonar[1]")
    assert heat not in SensorFinder().find()
    assert heat in SensorFinder(RobotConstants(names=frozenset({accessors.getter_name("Heat")}))).find(), (
        "it is asked for"
    )
    # off while the robot is disabled
    with run.output_gate.closed_while_disabled():
        assert hardware["light"] is False
    assert hardware["light"] is True
    # drawn by Tk and the page, which have the same rows; a headless simulation has the values of `leaves`
    panel = list(panels_of(dict(run.hal_data.leaves()), SimConfig(dio={1: "Front"})))[-1]
    assert panel.title == "Sonars"
    assert panel.rows == (
        Row("slider", ("sonar[1].depth",), "Sonar 1  Front", 0, 9, 1, "m", "Sonar 1, Front: metres"),
        Row("lamp", ("sonar[1].light",), "Light 1  Front", tooltip="Of Sonar 1, Front"),
    )
    assert json.loads(json.dumps(page_panel(panel)))["rows"][0]["paths"] == ["sonar[1].depth"]
    # after a restart: a sensor begins again, a name stays
    writes = {"sonar[1].depth": 3.0, "sonar[1].name": "left"}
    script = InputScript((Step(0, writes), Step(40_000, {"restart": True})), 60_000)
    assert boots_of(script)[1].steps[0].writes == {"sonar[1].name": "left"}
