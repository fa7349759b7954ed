"""What the simulator's window shows and does, without a window: rows, keys, zoom, words."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import for_each
from skips import missing_tkinter, require
from virtual_display import WINDOW

if missing_tkinter():  # some imports below need it
    require(WINDOW, missing_tkinter())

from pyfrc_core.config.sim import SimConfig
from pyfrc_core.hal.fields import RowKind
from pyfrc_core.physics.pose import Pose
from pyfrc_core.processes.standstill import Standstill
from pyfrc_core.project import Project
from pyfrc_core.sim import Field, Scene, Snapshot, Status
from pyfrc_core.sim.engine.snapshot import Failure
from pyfrc_core.sim.ui.models.devices import SETTABLE, Row, panels_of
from pyfrc_core.sim.ui.models.driver_station_keys import DriverStationKeys
from pyfrc_core.sim.ui.models.joysticks import RELEASED, Joysticks, axis_labels, button_labels, joystick_classes
from pyfrc_core.sim.ui.models.keyboard import GENTLE, LAYOUTS, KeyDriver, canonical, layout_for
from pyfrc_core.sim.ui.models.viewport import Viewport
from pyfrc_core.sim.ui.models.wording import (
    mode_text,
    shown_number,
    status_texts,
    typed_number,
)
from pyfrc_core.sim.ui.tk.device_items import ITEMS

FIELD = Field(54.25, 26.5, 20.0, 2.0, 3.0, {"start": Pose(0.0, 0.0, 0.0)})


def snapshot(mode: str = "disabled", **changes: Any) -> Snapshot:
    return replace(Snapshot(time=1.5, mode=mode, scene=Scene(FIELD)), **changes)


# -- the device panels ------------------------------------------------------------------------------------------------

VALUES = {
    "control.enabled": False,
    "alliance_station": 1,
    "fpga_button": False,
    "user_program_state": None,
    "power.vin_voltage": 12.0,
    "pwm[3].value": 0.25,
    "pwm[3].raw_value": 1500,
    "pwm[0].value": 0.0,
    "dio[1].value": True,
    "dio[1].is_input": True,
    "dio[2].value": False,
    "dio[2].is_input": False,
    "encoder[0].count": 7,
    "encoder[0].distance_per_pulse": 0.5,
    "counter[1].count": 3,
    "analog_in[0].voltage": 1.25,
    "analog_out[1].voltage": 2.0,
    "analog_gyro[0].angle": 90.0,
    "relay[0].fwd": True,
    "relay[0].rev": False,
    "duty_cycle[0].output": 0.5,
    "d0_pwm[0].duty_cycle": 0.5,
    **{f"pcm[0][{channel}].value": channel == 2 for channel in range(8)},
    **{f"ph[1][{channel}].value": False for channel in range(16)},
    "pcm_compressor[0].on": True,
    "pcm_compressor[0].pressure_switch": False,
    "pdp[0].voltage": 12.0,
    "pdp[0].current": (0.0, 4.5),
    "addressable_led[0].data": ((0, 0, 255),),
    "accelerometer.x": 0.0,
    'CAN["Gyro:ADXRS450[0]"].angle_x': 45.0,
    'CAN["SPARK MAX [3]"].Velocity': 100.0,
    'CAN["SPARK MAX [3]"].Inverted': False,
    'CAN["SPARK MAX [3]"].Mode': "velocity",
    "robot.navx_spi_4_angle": 1.0,
    'custom["My Label"]': "---",
}

CONFIG = SimConfig.model_validate(
    {
        "pwm": {3: "Arm"},
        "dio": {1: "Limit switch"},
        "CAN": {3: "Shooter"},
        "solenoid": {2: "Claw"},
        "joysticks": {0: {"axes": {1: "Left side", 8: "Knob"}, "buttons": {3: "Shoot"}}},
    }
)


def rows(values: dict[str, Any], config: SimConfig = CONFIG) -> dict[str, dict[str, Row]]:
    """The rows by panel and label."""
    return {panel.title: {row.label.strip(): row for row in panel.rows} for panel in panels_of(values, config)}


def test_each_device_has_its_row() -> None:
    shown = {title: [(row.label.strip(), row.kind) for row in panel.values()] for title, panel in rows(VALUES).items()}
    assert shown == {
        "PWM": [("0", "meter"), ("3  Arm", "meter"), ("0  (DIO as PWM)", "meter")],
        "Digital I/O": [("1  Limit switch", "switch"), ("2", "lamp"), ("Duty cycle 0", "slider")],
        "Analog inputs": [("0", "slider")],
        "Analog outputs": [("1", "meter")],
        "Relays": [("0", "relay")],
        "Pneumatics": [
            ("PCM 0", "lamps"),
            ("PH 1", "lamps"),
            ("PCM 0 compressor", "lamp"),
            ("PCM 0 pressure switch", "switch"),
        ],
        "Encoders and counters": [("Encoder 0", "number"), ("Counter 1", "number")],
        "Gyros": [("Analog 0", "slider"), ("ADXRS450[0]", "text"), ("angle_x", "slider")],
        "CAN and SimDevices": [
            ("SPARK MAX [3]  Shooter", "text"),
            ("Velocity", "number"),
            ("Inverted", "switch"),
            ("Mode", "text"),
        ],
        "Power": [("Battery", "slider"), ("PDP 0", "slider"), ("Currents", "bars")],
        "roboRIO": [("User button", "switch"), ("Accelerometer x", "slider"), ("LEDs 0", "leds")],
        "Other values": [("navx_spi_4_angle", "number")],
        "Custom": [("My Label", "text")],
    }


def test_the_window_draws_each_kind_of_row() -> None:
    assert ITEMS.keys() == set(get_args(RowKind))
    assert set(get_args(RowKind)) >= SETTABLE


def test_only_what_the_robot_has_made_is_shown() -> None:
    assert rows({}) == {}
    assert list(rows({"pwm[0].value": 0.0})) == ["PWM"]


@given(st.text(min_size=1), st.one_of(st.text(), st.integers(), st.lists(st.integers()), st.none()))
def test_custom_labels_may_be_anything(label: str, value: object) -> None:
    from pyfrc_core.hal.paths import join

    path = join("custom", label)
    assert [row.paths for row in rows({path: value})["Custom"].values()] == [(path,)]


def spark(mode: int, velocity_factor: float = 1.0) -> dict[str, Any]:
    """Return the values of a SPARK MAX in one of REV's control modes."""
    return {
        'CAN["SPARK MAX [3]"].Setpoint': 3000.0,
        'CAN["SPARK MAX [3]"]["Applied Output"]': 0.5,
        'CAN["SPARK MAX [3]"]["Control Mode"]': mode,
        'CAN["SPARK MAX [3]"]["Motor Temperature"]': 25,
        'CAN["SPARK MAX [3] RELATIVE ENCODER"].Position': 1.0,
        'CAN["SPARK MAX [3] RELATIVE ENCODER"]["Velocity Conversion Factor"]': velocity_factor,
    }


@for_each(
    "values, label, unit",
    [
        (spark(0), "Setpoint (duty cycle)", ""),
        (spark(1), "Setpoint (velocity)", "rpm"),
        (spark(1, 0.05), "Setpoint (velocity)", ""),
        (spark(2), "Setpoint (voltage)", "V"),
        (spark(3), "Setpoint (position)", "turns"),
        (spark(6), "Setpoint (MAXMotion velocity)", "rpm"),
        (spark(9), "Setpoint (unknown mode)", ""),
    ],
)
def test_the_set_point_of_a_spark_has_its_mode_and_unit(values: dict[str, Any], label: str, unit: str) -> None:
    """What drives its motor is the applied output, whatever the mode."""
    (panel,) = panels_of(values, SimConfig())
    rows = {row.label.strip(): row for row in panel.rows}
    assert (rows[label].kind, rows[label].unit) == ("number", unit)
    applied = rows["Applied Output"]
    assert (applied.kind, applied.low, applied.high) == ("meter", -1, 1)
    assert rows["Motor Temperature"].unit == "°C"
    assert rows["Position"].kind in SETTABLE


def test_ctre_devices_have_the_names_that_people_know() -> None:
    values = {
        'CAN["CANMotor:Talon FX (v6)[3]"].dutyCycle': 0.5,
        'CAN["CANEncoder:Talon FX (v6)[3]/Rotor Sensor"].velocity': 1.0,
        'CAN["CANEncoder:CANcoder (v6)[4]"].rawPositionInput': 0.25,
        'CAN["CANGyro:Pigeon 2 (v6)[5]"].rawYawInput': 90.0,
    }
    panels = {panel.title: panel.rows for panel in panels_of(values, SimConfig(CAN={3: "arm"}))}
    titles = [row.label for row in panels["CAN and SimDevices"] if not row.paths]
    assert titles == ["Talon FX [3]  arm", "Talon FX [3] Rotor Sensor", "CANcoder [4]"]
    yaw = panels["Gyros"][1]
    assert (panels["Gyros"][0].label, yaw.kind, yaw.unit) == ("Pigeon 2 [5]", "slider", "°")


# -- zoom -------------------------------------------------------------------------------------------------------------

lengths = st.floats(1, 200)
pixels = st.integers(1, 4000)
near = st.floats(0.2, 5)


@st.composite
def viewports(draw: st.DrawFn) -> Viewport:
    view = Viewport.whole(draw(lengths), draw(lengths), draw(pixels), draw(pixels))
    view = view.zoomed(draw(near), draw(pixels), draw(pixels))
    return view.panned(draw(st.integers(-500, 500)), draw(st.integers(-500, 500)))


@given(viewports(), st.floats(-50, 250), st.floats(-50, 250))
def test_from_the_field_to_the_screen_and_back(view: Viewport, x: float, y: float) -> None:
    there = view.to_screen(x, y)
    assert view.to_field(*there) == pytest.approx((x, y), abs=1e-6)
    assert view.line([(x, y), (x, y)]) == pytest.approx([*there, *there], rel=1e-9, abs=1e-6)


# -- keys -------------------------------------------------------------------------------------------------------------


def driver(layout: str, *keys: str) -> KeyDriver:
    made = KeyDriver(next(each for each in LAYOUTS if each.name == layout))
    for key in keys:
        made.press(key)
    return made


@for_each(
    "layout, keys, axes",
    [
        ("Tank: both sides", "w", {(0, 1): -1.0, (1, 1): -1.0}),
        ("Tank: both sides", "s", {(0, 1): 1.0, (1, 1): 1.0}),
        ("Tank: both sides", "d", {(0, 1): -0.6, (1, 1): 0.6}),
        ("Tank: both sides", "wd", {(0, 1): -1.0, (1, 1): -0.4}),
        ("Tank: both sides", "ws", {}),
        ("Two joysticks", "wd", {(0, 0): 1.0, (0, 1): -1.0}),
        ("Two joysticks", "q", {(0, 2): -1.0}),
        ("Gamepad", "we", {(0, 1): -1.0, (0, 3): 1.0}),
        ("Tank: both sides", "xyz", {}),
    ],
)
def test_keys_move_axes(layout: str, keys: str, axes: dict[tuple[int, int], float]) -> None:
    moved = driver(layout, *keys).axes()
    assert {control: value for control, value in moved.items() if value} == pytest.approx(axes)


def test_arrows_and_shift() -> None:
    assert driver("Two joysticks", "Up", "Left").axes()[(1, 1)] == -1.0
    assert driver("Gamepad", "Right").axes()[(0, 4)] == 1.0
    assert driver("Two joysticks", "Shift_L", "W").axes()[(0, 1)] == -GENTLE


@pytest.mark.parametrize("layout", [each.name for each in LAYOUTS])
@given(keys=st.lists(st.sampled_from([*"wasdqe", "Up", "Down", "Left", "Right", "Shift_R", "space"])))
def test_axes_stay_between_their_ends_and_go_back(layout: str, keys: list[str]) -> None:
    made = driver(layout, *keys)
    assert all(-1 <= value <= 1 for value in made.axes().values())
    for key in keys:
        made.release(key.upper() if len(key) == 1 else key)  # Caps Lock may have been pressed in between
    assert not any(made.axes().values())
    assert not any(made.buttons().values())


def test_digits_are_buttons_whether_or_not_shift_is_held() -> None:
    made = driver("Gamepad", "4", "0")
    assert {button for button, pressed in made.buttons().items() if pressed} == {(0, 4), (0, 10)}
    made.release("dollar")
    made.release_all()
    assert not any(made.buttons().values())
    assert canonical("dollar") == "4"


@for_each(
    "joysticks, layout",
    [
        ({}, "Tank: both sides"),
        ({0: {"axes": {"y": "left side"}}, 1: {"axes": {"y": "right side"}}}, "Tank: both sides"),
        ({0: {"axes": {"x": "turn", "y": "drive"}}}, "Two joysticks"),
        ({0: {"axes": {1: "drive", 4: "turn"}}}, "Gamepad"),
    ],
)
def test_keys_are_laid_out_for_what_the_robot_is_driven_with(joysticks: dict[int, Any], layout: str) -> None:
    assert layout_for(SimConfig.model_validate({"joysticks": joysticks})).name == layout


# -- joysticks --------------------------------------------------------------------------------------------------------


class Told:
    """Stands in for a simulation: keeps what joysticks have been told."""

    def __init__(self) -> None:
        self.calls: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        return lambda *args: self.calls.append((name, *args))


def sticks() -> tuple[Joysticks, Told]:
    told = Told()
    return Joysticks(told), told  # type: ignore[arg-type]


def test_labels_of_joysticks() -> None:
    assert axis_labels(CONFIG, 0) == {0: "0 X", 1: "Left side", 2: "2 Z", 3: "3 Throttle", 4: "4", 5: "5", 8: "Knob"}
    flight, xbox = frozenset({"Joystick"}), frozenset({"XboxController"})
    assert button_labels(CONFIG, 0, flight) == {1: "Trigger", 2: "Top", 3: "Shoot"}
    assert button_labels(CONFIG, 5, flight) == {1: "Trigger", 2: "Top"}
    assert " ".join(button_labels(CONFIG, 5, xbox).values()) == "A B X Y LB RB Back Start LS RS"
    assert button_labels(CONFIG, 0, xbox)[3] == "Shoot"
    assert button_labels(CONFIG, 0, flight | xbox) == button_labels(CONFIG, 0, frozenset()) == {3: "Shoot"}


def test_the_classes_of_joysticks_are_those_that_the_code_creates(tmp_path: Path) -> None:
    project = Project(tmp_path / "robot.py")
    assert joystick_classes(project) == frozenset()
    project.main_file.write_text("stick = CommandXboxController(0)\nJoystickButton(stick, 1)\nPIDController(1, 0, 0)\n")
    assert joystick_classes(project) == {"XboxController"}
    (tmp_path / "oi.py").write_text("import wpilib\nleft = wpilib.Joystick(1)\n")
    assert joystick_classes(project) == {"XboxController", "Joystick"}


def test_what_the_robot_has_is_shown() -> None:
    made, told = sticks()
    values = {
        "joysticks[0].axes": (0.0, -0.5, *[0.0] * 10),
        "joysticks[0].buttons": (False, True, *[False] * 11),
        "joysticks[0].povs": (90,),
    }
    made.adopt(values)
    first, second = made.sticks[:2]
    assert (first.axes[1], first.buttons[1], first.pov, first.plugged) == (-0.5, True, 90, True)
    assert not second.plugged
    # What is moved here is not undone by a snapshot that says nothing new.
    made.move(0, 1, 1.0)
    made.adopt(values)
    assert first.axes[1] == 1.0
    assert told.calls == [("set_axis", 0, 1, 1.0)]
    made.adopt({**values, "joysticks[0].povs": (RELEASED,)})
    assert (first.axes[1], first.pov) == (-0.5, RELEASED)


def test_keys_that_are_held_are_passed_on_again() -> None:
    """To a robot that was restarted."""
    made, told = sticks()
    told.project = SimpleNamespace(sim_config=SimConfig())
    keys = DriverStationKeys(told, made, close=lambda: None)
    keys.press("w")
    keys.press("1")
    before = list(told.calls)
    assert ("set_axis", 0, 1, -1.0) in before
    told.calls.clear()
    keys.forget()
    assert sorted(told.calls) == sorted(before)
    keys.release_all()
    told.calls.clear()
    keys.forget()
    assert told.calls == []


# -- words ------------------------------------------------------------------------------------------------------------


@for_each(
    "shown, status, words",
    [
        (None, Status(), ("Starting…", "wait")),
        (None, Status(replayed=1.2, replaying_to=63.0), ("Replaying 0:01.20 of 1:03.00", "wait")),
        (snapshot(), Status("running"), ("Teleoperated disabled", "disabled")),
        (snapshot("disabled autonomous"), Status("paused"), ("Autonomous disabled", "disabled")),
        (snapshot("teleop"), Status("running"), ("Teleoperated enabled", "enabled")),
        # A practice match has the Driver Station's countdown.
        (
            snapshot("autonomous", practice_since=0.0, match_left=11.8),
            Status("running"),
            ("Autonomous enabled, 12 s", "enabled"),
        ),
        (snapshot("test", emergency_stopped=True), Status("running"), ("Emergency stopped", "error")),
        (snapshot("teleop"), Status("failed", failure=Failure("x", "", 1)), ("No robot code", "error")),
        (snapshot("teleop"), Status("running", responding=False), ("Not responding", "error")),
        (
            snapshot("teleop"),
            Status("running", responding=False, standstill=Standstill(3.0, "robot.py:7", 1.5)),
            ("Not responding: robot.py:7", "error"),
        ),
    ],
)
def test_what_the_robot_is_doing(shown: Snapshot | None, status: Status, words: tuple[str, str]) -> None:
    assert mode_text(shown, status) == words


def test_the_status_line() -> None:
    running = Status("running", reached=0.987, packet_seconds=0.0015, worst_packet_seconds=0.012, overruns=3)
    assert status_texts(snapshot(), running) == [
        "Robot time 1.50 s",
        "Speed 0.99x of 1x",
        "Computing 1.5 ms, worst 12.0 ms",
        "Overruns 3",
    ]
    served = status_texts(snapshot(), Status("paused", network_address="127.0.0.1:5810"))
    assert served[1::3] == ["Paused", "NetworkTables 127.0.0.1:5810"]
    assert status_texts(snapshot(), Status("running", speed=0, reached=431.2))[1] == "Speed 431x, as fast as it goes"


def test_numbers_are_shown_with_their_significant_digits() -> None:
    shown = {6e-5: "6e-05", 0.1234567: "0.123457", 2.0: "2", 1234567.0: "1234567", 1234.5678: "1234.568", 7: "7"}
    assert [shown_number(value) for value in shown] == list(shown.values())
    assert shown_number(math.inf) == "inf"


def test_typed_numbers_have_a_point_or_a_comma_and_nothing_else() -> None:
    typed = {"6e-5": 6e-5, " 2,5 ": 2.5, "-.5": -0.5, "1000": 1000.0, "0,125": 0.125, "1,0005": 1.0005, "1.": 1.0}
    assert [typed_number(text) for text in typed] == list(typed.values())
    for text, reason in {
        "1,000": "write thousands without a comma and decimals with a point, not “1,000”",
        "1,000,000": "thousands",
        "1,234.5": "thousands",
        "": "a number is needed, not “”",
        "nan": "a number is needed",
        "1_000": "a number is needed",
        "0x10": "a number is needed",
        "1e999": "“1e999” is too large",
    }.items():
        with pytest.raises(ValueError, match=reason):
            typed_number(text)
